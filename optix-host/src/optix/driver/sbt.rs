//! The shader binding table in device memory (guide 7).

use std::fmt;
use std::sync::Arc;

use super::KeepAlive;
use super::buffer::DeviceBuffer;
use super::context::Context;
use super::sys::{self, OPTIX_SBT_RECORD_ALIGNMENT, OPTIX_SBT_RECORD_HEADER_SIZE};
use crate::error::DriverError as Error;

/// The records of a section, packed on the host. Each consists of a 32-byte header from
/// [`ProgramGroup::pack_header`](super::ProgramGroup::pack_header) and the application's data.
#[derive(Clone, Copy, Debug, Default)]
pub struct SbtSection<'a> {
    /// The records, one after another.
    pub bytes: &'a [u8],
    /// Bytes from one record to the next, a multiple of 16.
    pub stride: usize,
}

/// The sections of a table.
#[derive(Clone, Copy, Debug, Default)]
pub struct SbtSections<'a> {
    /// The ray-generation records, at least one. A launch runs one of them.
    pub raygen: SbtSection<'a>,
    /// The exception record, at most one. Without it, the driver's own program handles exceptions.
    pub exception: SbtSection<'a>,
    /// The miss records. The miss index of a trace chooses one of them.
    pub miss: SbtSection<'a>,
    /// The hit-group records. The formula of guide 7.3 chooses one of them.
    pub hitgroup: SbtSection<'a>,
    /// The callables' records. The index of a call chooses one of them.
    pub callables: SbtSection<'a>,
}

/// A shader binding table in device memory. Cheap to clone.
#[derive(Clone)]
pub struct ShaderBindingTable(Arc<Inner>);

struct Inner {
    buffer: DeviceBuffer,
    raw: sys::OptixShaderBindingTable,
    raygen_count: u32,
    raygen_stride: usize,
    _keep: KeepAlive,
}

impl fmt::Debug for ShaderBindingTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ShaderBindingTable").field("raw", &self.0.raw).finish_non_exhaustive()
    }
}

impl ShaderBindingTable {
    /// Copies the sections to the device. `keep` is held as long as the table: the program groups of its headers, and
    /// whatever its records point to.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a stride that is no multiple of 16 or shorter than a header, for a section that is not
    /// whole records, and without a ray-generation record.
    pub fn new(context: &Context, sections: &SbtSections<'_>, keep: KeepAlive) -> Result<Self, Error> {
        let layout = Layout::new(sections)?;
        let mut bytes = vec![0u8; layout.size];
        let all = [sections.raygen, sections.exception, sections.miss, sections.hitgroup, sections.callables];
        for (section, place) in all.iter().zip(&layout.places) {
            bytes[place.offset..place.offset + section.bytes.len()].copy_from_slice(section.bytes);
        }
        let buffer = DeviceBuffer::from_bytes(context, &bytes)?;
        let raw = layout.raw(buffer.address());
        let raygen_count = layout.places[0].count;
        let raygen_stride = sections.raygen.stride;
        Ok(Self(Arc::new(Inner { buffer, raw, raygen_count, raygen_stride, _keep: keep })))
    }

    /// Size in bytes.
    pub fn size(&self) -> usize {
        self.0.buffer.len()
    }

    /// Ray-generation records.
    pub fn raygen_count(&self) -> u32 {
        self.0.raygen_count
    }

    pub(super) fn context(&self) -> &Context {
        self.0.buffer.context()
    }

    /// The table for a launch of one of the ray-generation records.
    pub(super) fn raw(&self, raygen: u32) -> Result<sys::OptixShaderBindingTable, Error> {
        if raygen >= self.0.raygen_count {
            let problem = format!("ray-generation record {raygen} of {}", self.0.raygen_count);
            return Err(Error::invalid("a launch", problem, "count the ray-generation records from 0"));
        }
        let mut raw = self.0.raw;
        raw.raygen_record += u64::from(raygen) * self.0.raygen_stride as u64;
        Ok(raw)
    }
}

/// The place of a section in the buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Place {
    offset: usize,
    stride: u32,
    count: u32,
}

impl Place {
    fn address(self, base: u64) -> u64 {
        if self.count == 0 { 0 } else { base + self.offset as u64 }
    }
}

/// All sections one after the other, each aligned to 16 bytes: raygen, exception, miss, hitgroup, callables.
#[derive(Debug)]
struct Layout {
    places: [Place; 5],
    size: usize,
}

impl Layout {
    fn new(sections: &SbtSections<'_>) -> Result<Self, Error> {
        let named = [
            ("the ray-generation section", sections.raygen),
            ("the exception section", sections.exception),
            ("the miss section", sections.miss),
            ("the hit-group section", sections.hitgroup),
            ("the callables section", sections.callables),
        ];
        let mut places = [Place::default(); 5];
        let mut size = 0usize;
        for ((name, section), place) in named.into_iter().zip(&mut places) {
            *place = Self::place(name, section, size)?;
            // Strides are multiples of 16, so the next section is aligned as this one is.
            size = size.checked_add(section.bytes.len()).ok_or_else(|| too_large(name))?;
        }
        let invalid =
            |what, problem| Err(Error::invalid(what, problem, "pack one record for each program that is to run"));
        if places[0].count == 0 {
            return invalid(named[0].0, "it has no record");
        }
        if places[1].count > 1 {
            return invalid(named[1].0, "it has more than one record");
        }
        Ok(Self { places, size })
    }

    fn place(what: &'static str, section: SbtSection<'_>, offset: usize) -> Result<Place, Error> {
        let SbtSection { bytes, stride } = section;
        if bytes.is_empty() {
            return Ok(Place::default());
        }
        if stride < OPTIX_SBT_RECORD_HEADER_SIZE || !stride.is_multiple_of(OPTIX_SBT_RECORD_ALIGNMENT) {
            let problem = format!("its stride is {stride} bytes");
            let remedy =
                "round header (32 bytes) and data up to a multiple of 16, the largest record of the section first";
            return Err(Error::invalid(what, problem, remedy));
        }
        if !bytes.len().is_multiple_of(stride) {
            let problem = format!("its {} bytes are not whole records of {stride}", bytes.len());
            return Err(Error::invalid(what, problem, "pad every record of a section to the same stride"));
        }
        let count = u32::try_from(bytes.len() / stride).map_err(|_| too_large(what))?;
        Ok(Place { offset, stride: u32::try_from(stride).map_err(|_| too_large(what))?, count })
    }

    fn raw(&self, base: u64) -> sys::OptixShaderBindingTable {
        let [raygen, exception, miss, hitgroup, callables] = self.places;
        // OptiX asks for these two even if a pipeline traces no rays. Nothing reads them then.
        let [miss, hitgroup] = [miss, hitgroup].map(|place| if place.count == 0 { raygen } else { place });
        sys::OptixShaderBindingTable {
            raygen_record: raygen.address(base),
            exception_record: exception.address(base),
            miss_record_base: miss.address(base),
            miss_record_stride_in_bytes: miss.stride,
            miss_record_count: miss.count,
            hitgroup_record_base: hitgroup.address(base),
            hitgroup_record_stride_in_bytes: hitgroup.stride,
            hitgroup_record_count: hitgroup.count,
            callables_record_base: callables.address(base),
            callables_record_stride_in_bytes: callables.stride,
            callables_record_count: callables.count,
        }
    }
}

fn too_large(what: &'static str) -> Error {
    Error::invalid(what, "it is larger than 32-bit counts and strides allow", "put large data behind a pointer")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section(bytes: &[u8], stride: usize) -> SbtSection<'_> {
        SbtSection { bytes, stride }
    }

    #[test]
    fn sections_follow_one_another() {
        let bytes = [0u8; 192];
        let sections = SbtSections {
            raygen: section(&bytes[..64], 32),
            miss: section(&bytes[..96], 48),
            hitgroup: section(&bytes, 64),
            ..Default::default()
        };
        let raw = Layout::new(&sections).unwrap().raw(0x1000);
        assert_eq!((raw.raygen_record, raw.exception_record), (0x1000, 0));
        assert_eq!((raw.miss_record_base, raw.miss_record_stride_in_bytes, raw.miss_record_count), (0x1040, 48, 2));
        assert_eq!((raw.hitgroup_record_base, raw.hitgroup_record_count), (0x10a0, 3));
        assert_eq!((raw.callables_record_base, raw.callables_record_count), (0, 0));
    }

    #[test]
    fn malformed_sections_are_refused() {
        let bytes = [0u8; 96];
        let good = SbtSections { raygen: section(&bytes[..32], 32), ..Default::default() };
        assert!(Layout::new(&good).is_ok());
        assert!(Layout::new(&SbtSections { raygen: SbtSection::default(), ..good }).is_err());
        assert!(Layout::new(&SbtSections { exception: section(&bytes[..64], 32), ..good }).is_err());
        for (len, stride) in [(96, 16), (96, 40), (96, 64), (96, 0), (96, 33)] {
            let miss = section(&bytes[..len], stride);
            assert!(Layout::new(&SbtSections { miss, ..good }).is_err(), "{len} {stride}");
        }
    }
}
