//! What the host side of a shader crate shares with `optix-host`: the description of a pipeline, the frame of a program
//! call, and the owning twins of device views.

mod callable;
mod data;
mod description;
pub mod end;
mod frame;
mod memory;
mod reach;
mod rule;
pub mod shared;
mod texture;

pub use crate::intrinsics::TraceCall;
pub use crate::primitive::PrimitiveType;
pub use callable::{CallableRecord, CallableTable};
pub use data::{HostData, KeepAlive, Kept, View};
pub use description::{
    CallableDescription, Entry, ExceptionsDescription, HitGroupDescription, HitPrograms, ParamsDescription,
    PayloadDescription, PipelineDescription, ProgramDescription, RayDescription, RecordLayout,
};
pub use frame::{
    CallableCall, ExceptionState, Executor, Frame, HitState, InstanceState, PayloadWatch, Turn, no_answer,
};
pub use memory::{Buffer, Buffer2d, DeviceId, InstanceTable, Memory, MemoryError, TriangleTable, World};
pub use reach::{ByHandle, Handle, Reach};
pub(crate) use reach::{memory, name_of, sample};
pub use rule::{Checked, Rule};
pub use texture::{Sampler, Texture, TextureMemory};
