//! The shader binding table as a pure value: the records and their order, before any device sees them (guide 7).
//!
//! The table of a scene with materials `m0, m1, ..` and `R` ray types has, for every use of a material by a GAS, `R`
//! consecutive hit records; a GAS knows where its first one is, and a trace call of ray type `r` uses offset `r` and
//! stride `R`. So the guide's formula (7.3) always ends at a record of the right material, geometry and ray type.

pub use crate::limits::{RECORD_ALIGNMENT, RECORD_HEADER_SIZE as HEADER_SIZE};

use crate::error::PipelineError;
use crate::plan::Plan;
use crate::scene::{SceneState, Slot};
use crate::{Error, Result};

/// Bytes at an address that is a multiple of 16.
#[derive(Clone, Debug, Default)]
struct AlignedBytes {
    blocks: Vec<u128>,
}

impl AlignedBytes {
    fn zeroed(len: usize) -> Self {
        Self { blocks: vec![0; len.div_ceil(RECORD_ALIGNMENT)] }
    }
    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.blocks)
    }
    fn bytes_mut(&mut self) -> &mut [u8] {
        bytemuck::cast_slice_mut(&mut self.blocks)
    }
}

/// Records of one kind, one after the other. Each consists of a header, which only OptiX reads, and the data. Padding
/// is zero.
#[derive(Clone, Debug)]
pub struct Section<K> {
    stride: usize,
    programs: Vec<K>,
    bytes: AlignedBytes,
}

impl<K> Section<K> {
    /// Lays out records, given the program and the data of each.
    pub fn new<'a>(records: impl IntoIterator<Item = (K, &'a [u8])>) -> Self {
        let (programs, data): (Vec<K>, Vec<&[u8]>) = records.into_iter().unzip();
        let largest = data.iter().map(|d| d.len()).max().unwrap_or(0);
        let stride = (HEADER_SIZE + largest).next_multiple_of(RECORD_ALIGNMENT);
        let mut bytes = AlignedBytes::zeroed(stride * programs.len());
        for (i, data) in data.iter().enumerate() {
            let begin = i * stride + HEADER_SIZE;
            bytes.bytes_mut()[begin..begin + data.len()].copy_from_slice(data);
        }
        Self { stride, programs, bytes }
    }

    /// Bytes from one record to the next: a multiple of 16 (guide 7.2).
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Which program each record is for.
    pub fn programs(&self) -> &[K] {
        &self.programs
    }

    /// All bytes of the section, as a device takes them.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes.bytes()[..self.stride * self.programs.len()]
    }

    /// The data of record `index`, padding included; begins at a multiple of 16.
    ///
    /// # Panics
    /// If there is no such record.
    pub fn data(&self, index: usize) -> &[u8] {
        let begin = index * self.stride;
        &self.bytes()[begin + HEADER_SIZE..begin + self.stride]
    }

    /// The header of record `index`, for the backend to fill in.
    ///
    /// # Panics
    /// If there is no such record.
    pub fn header_mut(&mut self, index: usize) -> &mut [u8] {
        let begin = index * self.stride;
        &mut self.bytes.bytes_mut()[begin..begin + HEADER_SIZE]
    }
}

/// The hit group of a record: which one of the pipeline, for which ray type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct HitProgram {
    /// Index in [`PipelineDescription::hitgroups`](optix_device_rs::host::PipelineDescription::hitgroups).
    pub group: usize,
    /// Ray type.
    pub ray: usize,
}

/// The program of a callable's record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CallableProgram {
    /// Index in [`PipelineDescription::callables`](optix_device_rs::host::PipelineDescription::callables).
    pub program: usize,
    /// The number by which programs know the record.
    pub number: u32,
}

/// A shader binding table.
#[derive(Clone, Debug)]
pub struct ShaderBindingTable {
    /// One record per ray-generation program.
    pub raygen: Section<usize>,
    /// One record per ray type.
    pub miss: Section<usize>,
    /// The records of materials, one for each ray type.
    pub hit: Section<HitProgram>,
    /// Records of callables, as the scene made them.
    pub callables: Section<CallableProgram>,
    /// The record of the exception program, if there is one.
    pub exception: Section<()>,
}

impl ShaderBindingTable {
    /// The table of a scene for a planned pipeline.
    pub(crate) fn of(scene: &SceneState, plan: &Plan) -> Result<Self> {
        let description = &plan.description;
        let missing = |kind, program, record, call| Error::Pipeline {
            pipeline: description.name,
            error: PipelineError::MissingRecord { kind, program, record, call },
        };
        for (given, ray) in scene.miss.iter().zip(description.rays) {
            if let (None, Some(miss)) = (&given.bytes, ray.miss) {
                let call = format!("scene.miss::<{}>(..)", ray.payload.name);
                return Err(missing("miss", miss.entry.function, miss.record.name, call));
            }
        }
        for (given, raygen) in scene.raygen.iter().zip(description.raygen) {
            if given.bytes.is_none() {
                let (function, record) = (raygen.entry.function, raygen.record.name);
                return Err(missing("ray-generation", function, record, format!("scene.raygen::<{function}>(..)")));
            }
        }
        if let (None, Some(program)) = (&scene.exception.bytes, description.exceptions.program) {
            let (function, record) = (program.entry.function, program.record.name);
            return Err(missing("exception", function, record, "scene.exception(..)".into()));
        }
        let data = |bytes: &'_ Option<Vec<u8>>| -> Vec<u8> { bytes.clone().unwrap_or_default() };
        let raygen: Vec<_> = scene.raygen.iter().map(|r| data(&r.bytes)).collect();
        let miss: Vec<_> = scene.miss.iter().map(|r| data(&r.bytes)).collect();
        let materials: Vec<_> = scene.materials.iter().map(|m| data(&m.record.bytes)).collect();
        let callables: Vec<_> = scene.callables.iter().map(|c| data(&c.record.bytes)).collect();
        let exception = description.exceptions.program.map(|_| data(&scene.exception.bytes));
        let rays = description.rays.len();
        Ok(Self {
            raygen: Section::new(raygen.iter().enumerate().map(|(i, bytes)| (i, &bytes[..]))),
            miss: Section::new(miss.iter().enumerate().map(|(i, bytes)| (i, &bytes[..]))),
            hit: Section::new(scene.slots.iter().flat_map(|&(material, group): &Slot| {
                let bytes = &materials[material as usize][..];
                (0..rays).map(move |ray| (HitProgram { group: group as usize, ray }, bytes))
            })),
            callables: Section::new(scene.callables.iter().zip(&callables).map(|(callable, bytes)| {
                (CallableProgram { program: callable.program, number: callable.number }, &bytes[..])
            })),
            exception: Section::new(exception.iter().map(|bytes| ((), &bytes[..]))),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_are_aligned_and_padded_with_zeros() {
        let records: [(u32, &[u8]); 3] = [(7, &[1, 2, 3]), (8, &[9; 17]), (9, &[])];
        let section = Section::new(records);
        assert_eq!(section.stride(), 64); // 32 + 17, to a multiple of 16
        assert_eq!(section.bytes().len(), 3 * 64);
        assert_eq!(section.data(0)[..4], [1, 2, 3, 0]);
        assert_eq!(section.data(1)[..17], [9; 17]);
        assert!(section.data(2).iter().all(|&b| b == 0));
        assert_eq!(section.data(1).as_ptr() as usize % 16, 0);
        assert_eq!(section.programs(), [7, 8, 9]);
    }
}
