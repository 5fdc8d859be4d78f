//! The known ABI versions, and how the driver is asked for one.
//!
//! A driver also serves the ABI versions of older SDKs. So the newest known version is asked for first and then older
//! ones, which finds the best that both sides know. An older version is listed only if its table and structures are
//! known from the public headers of that release (NVIDIA/optix-dev, tags v7.7.0 to v9.0.0). Between ABI 84 and 105:
//!
//! - the table grew by placeholders in ABI 93 and by two cluster functions in the middle in ABI 105, so slots from 38 on
//!   moved; the signatures of the functions used here did not change;
//! - of the structures used here only `OptixPipelineCompileOptions` changed: ABI 105 appended one field;
//! - byte indices came with ABI 93, the `ROCAPS` curves and the cluster and cooperative-vector properties with ABI 105.
//!
//! ABI 68 (OptiX 7.6) has another module API and is not listed.

use core::ffi::c_void;
use std::ptr;

use super::{
    FunctionTable, OptixPipelineCompileOptions, OptixPipelineCompileOptionsV84, OptixResult, QueryFunctionTable,
};

/// One ABI version and how its table maps to that of ABI 105.
#[derive(Debug)]
pub struct Abi {
    /// `OPTIX_ABI_VERSION`.
    pub version: i32,
    /// The OptiX release that introduced it.
    pub release: &'static str,
    /// The first Linux driver branch that serves it.
    pub driver_branch: u32,
    /// Slots of its table.
    slots: usize,
    /// Runs of slots to keep: first slot in this version, first slot in ABI 105, length. Others stay empty.
    moved: &'static [(usize, usize, usize)],
}

/// The known versions, newest first.
pub static ABIS: [Abi; 4] = [
    Abi {
        version: 105,
        release: "9.0",
        driver_branch: 570,
        slots: FunctionTable::SLOTS,
        moved: &[(0, 0, FunctionTable::SLOTS)],
    },
    Abi { version: 93, release: "8.1", driver_branch: 555, slots: 50, moved: &[(0, 0, 38), (38, 40, 2)] },
    Abi { version: 87, release: "8.0", driver_branch: 535, slots: 48, moved: &[(0, 0, 38), (38, 40, 2)] },
    Abi { version: 84, release: "7.7", driver_branch: 530, slots: 48, moved: &[(0, 0, 38), (38, 40, 2)] },
];

// A driver of an older ABI reads a prefix of the newer options.
const _: () = {
    use core::mem::offset_of;
    assert!(
        offset_of!(OptixPipelineCompileOptions, allow_opacity_micromaps)
            == offset_of!(OptixPipelineCompileOptionsV84, allow_opacity_micromaps)
    );
    assert!(
        offset_of!(OptixPipelineCompileOptions, allow_clustered_geometry)
            == size_of::<OptixPipelineCompileOptionsV84>()
    );
};

/// Asks for each known version, newest first, and returns the first table the driver gives.
///
/// # Errors
/// The driver's last answer, if it serves no known version.
///
/// # Safety
/// `query` must be the driver's `optixQueryFunctionTable`.
pub unsafe fn negotiate(query: QueryFunctionTable) -> Result<(FunctionTable, &'static Abi), OptixResult> {
    let mut last = OptixResult::UNSUPPORTED_ABI_VERSION;
    for abi in &ABIS {
        let mut raw = [ptr::null::<c_void>(); FunctionTable::SLOTS];
        // SAFETY: `raw` has room for `slots` pointers, which is at most its length; the caller promises the function.
        last = unsafe {
            query(
                abi.version,
                0,
                ptr::null_mut(),
                ptr::null_mut(),
                raw.as_mut_ptr().cast(),
                abi.slots * size_of::<*const c_void>(),
            )
        };
        if last == OptixResult::SUCCESS {
            let mut slots = [ptr::null::<c_void>(); FunctionTable::SLOTS];
            for &(from, to, count) in abi.moved {
                slots[to..to + count].copy_from_slice(&raw[from..from + count]);
            }
            // SAFETY: the table is exactly that many pointers in slot order (asserted beside it); a null one is `None`,
            // any other is the driver's function for that slot.
            let table = unsafe { std::mem::transmute::<[*const c_void; FunctionTable::SLOTS], FunctionTable>(slots) };
            return Ok((table, abi));
        }
        if last != OptixResult::UNSUPPORTED_ABI_VERSION && last != OptixResult::FUNCTION_TABLE_SIZE_MISMATCH {
            break;
        }
    }
    Err(last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::ffi::c_uint;
    use std::ffi::CStr;

    unsafe extern "C" fn name(_: OptixResult) -> *const core::ffi::c_char {
        c"OPTIX_TEST".as_ptr()
    }

    unsafe extern "C" fn pack(_: super::super::OptixProgramGroup, header: *mut c_void) -> OptixResult {
        // SAFETY: the test passes a pointer to 32 bytes.
        unsafe { header.cast::<u8>().write(7) };
        OptixResult::SUCCESS
    }

    /// A driver that serves one version only and fills slot 0 and the slot of `optixSbtRecordPackHeader`.
    fn serve(version: i32, slots: usize, pack_slot: usize, asked: (i32, *mut c_void, usize)) -> OptixResult {
        let (abi_id, table, size) = asked;
        if abi_id != version {
            return OptixResult::UNSUPPORTED_ABI_VERSION;
        }
        if size != slots * 8 {
            return OptixResult::FUNCTION_TABLE_SIZE_MISMATCH;
        }
        // SAFETY: the caller passes `size` bytes for the table.
        let table = unsafe { std::slice::from_raw_parts_mut(table.cast::<*const c_void>(), slots) };
        table[0] = name as *const c_void;
        table[pack_slot] = pack as *const c_void;
        OptixResult::SUCCESS
    }

    macro_rules! driver {
        ($name:ident, $version:literal, $slots:literal, $pack:literal) => {
            unsafe extern "C" fn $name(
                abi: i32,
                _: c_uint,
                _: *mut c_void,
                _: *mut *const c_void,
                table: *mut c_void,
                size: usize,
            ) -> OptixResult {
                serve($version, $slots, $pack, (abi, table, size))
            }
        };
    }
    driver!(driver_105, 105, 52, 40);
    driver!(driver_93, 93, 50, 38);
    driver!(driver_87, 87, 48, 38);
    driver!(driver_84, 84, 48, 38);
    driver!(driver_68, 68, 45, 35);

    #[test]
    fn functions_are_found_in_the_slot_of_each_version() {
        let drivers: [(QueryFunctionTable, i32); 4] =
            [(driver_105, 105), (driver_93, 93), (driver_87, 87), (driver_84, 84)];
        for (query, version) in drivers {
            // SAFETY: the function behaves as the driver's.
            let (table, abi) = unsafe { negotiate(query) }.unwrap();
            assert_eq!(abi.version, version);
            let text: &CStr = table.get_error_name(OptixResult::SUCCESS).unwrap();
            assert_eq!(text, c"OPTIX_TEST");
            let mut header = [0u8; 32];
            // SAFETY: the slot holds the test's function, which takes any group.
            let result = unsafe {
                table.sbt_record_pack_header(super::super::OptixProgramGroup::NULL, header.as_mut_ptr().cast())
            };
            assert_eq!((result, header[0]), (OptixResult::SUCCESS, 7));
        }
    }

    #[test]
    fn a_slot_the_driver_left_empty_is_an_error() {
        // SAFETY: the function behaves as the driver's.
        let (table, _) = unsafe { negotiate(driver_84) }.unwrap();
        assert!(table.get_error_string(OptixResult::SUCCESS).is_none());
        // SAFETY: the slot is empty, so nothing is called.
        let result = unsafe { table.module_destroy(super::super::OptixModule::NULL) };
        assert_eq!(result, OptixResult::ENTRY_SYMBOL_NOT_FOUND);
    }

    #[test]
    fn a_driver_older_than_every_known_version_is_refused() {
        // SAFETY: the function behaves as the driver's.
        let result = unsafe { negotiate(driver_68) };
        assert_eq!(result.err(), Some(OptixResult::UNSUPPORTED_ABI_VERSION));
    }
}
