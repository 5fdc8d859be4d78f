//! Loading `libnvoptix.so.1` and choosing an ABI version.

use std::sync::OnceLock;

use libloading::Library;

use super::cuda;
use super::sys::{self, Abi, FunctionTable, QueryFunctionTable};
use crate::error::DriverError as Error;

const LIBRARY: &str = if cfg!(windows) { "nvoptix.dll" } else { "libnvoptix.so.1" };

/// The driver's functions and the ABI version they follow.
#[derive(Clone, Copy)]
pub(super) struct Api {
    pub table: FunctionTable,
    pub abi: &'static Abi,
}

/// The driver's functions. The library is loaded on the first success and stays loaded until the process ends, because
/// the driver has threads of its own that may still run.
pub(super) fn api() -> Result<&'static Api, Error> {
    static API: OnceLock<Api> = OnceLock::new();
    if let Some(api) = API.get() {
        return Ok(api);
    }
    let api = load(LIBRARY)?;
    Ok(API.get_or_init(|| api))
}

fn load(library: &'static str) -> Result<Api, Error> {
    let not_found = |detail: libloading::Error| Error::LibraryNotFound {
        library,
        detail: chain(&detail),
        remedy: "this file comes with the NVIDIA driver (530 or newer): install it; in a container set \
                 NVIDIA_DRIVER_CAPABILITIES=graphics,compute,utility so that it is mounted; without a GPU use the CPU \
                 executor",
    };
    // SAFETY: loading the NVIDIA driver's library runs its initialisers, which need nothing from us.
    let library = unsafe { Library::new(library) }.map_err(not_found)?;
    // SAFETY: the driver exports this function with this signature (guide 3.6).
    let query = *unsafe { library.get::<QueryFunctionTable>(b"optixQueryFunctionTable\0") }.map_err(not_found)?;
    // Never unloaded, so `query` and the table stay valid.
    std::mem::forget(library);
    // SAFETY: `query` is the driver's function of that name.
    let (table, abi) = unsafe { sys::negotiate(query) }.map_err(|result| Error::UnsupportedDriver {
        known: sys::ABIS.iter().map(|abi| abi.version).collect(),
        code: result.0,
        driver: cuda::display_driver_version().unwrap_or_else(|| "unknown".into()),
        needed: sys::ABIS.iter().map(|abi| abi.driver_branch).min().unwrap_or_default(),
    })?;
    Ok(Api { table, abi })
}

/// The error's text and those of its causes: the loader's own message is a cause.
pub(super) fn chain(error: &libloading::Error) -> String {
    let mut text = error.to_string();
    let mut cause = std::error::Error::source(error);
    while let Some(error) = cause {
        text.push_str(": ");
        text.push_str(&error.to_string());
        cause = error.source();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_library_is_named_with_what_to_do() {
        let text = load("libnvoptix-missing.so.1").err().unwrap().to_string();
        for part in ["libnvoptix-missing.so.1: cannot open", "NVIDIA driver", "NVIDIA_DRIVER_CAPABILITIES=graphics"] {
            assert!(text.contains(part), "{part} is missing in: {text}");
        }
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_library_without_the_entry_point_is_refused() {
        let text = load("libc.so.6").err().unwrap().to_string();
        assert!(text.contains("optixQueryFunctionTable"), "{text}");
    }
}
