//! Program groups: the programs that one kind of record runs (guide 6.6).

use std::ffi::{CString, c_char};
use std::ptr;
use std::sync::Arc;

use super::compile_log::CompileLog;
use super::context::Context;
use super::module::Module;
use super::options::c_name;
use super::payload::PayloadType;
use super::stack::GroupStack;
use super::sys;
use crate::error::DriverError as Error;

/// An entry function of a module.
#[derive(Clone, Copy, Debug)]
pub struct Entry<'a> {
    /// The module.
    pub module: &'a Module,
    /// The function's name, with the prefix of its kind such as `__raygen__`.
    pub name: &'a str,
}

/// The intersection program of a hit group.
#[derive(Clone, Copy, Debug)]
pub enum Intersection<'a> {
    /// A program of the application, for custom primitives.
    Program(Entry<'a>),
    /// A module from [`Module::builtin_intersection`], for curves and spheres.
    Builtin(&'a Module),
}

/// The programs of a group.
#[derive(Clone, Copy, Debug)]
pub enum Programs<'a> {
    /// A ray-generation program.
    Raygen(Entry<'a>),
    /// A miss program. If there is none, a miss does nothing.
    Miss(Option<Entry<'a>>),
    /// An exception program.
    Exception(Entry<'a>),
    /// Programs for hits. Triangles need no intersection.
    HitGroup {
        /// Runs for the closest hit.
        closesthit: Option<Entry<'a>>,
        /// Runs for every hit found on the way.
        anyhit: Option<Entry<'a>>,
        /// Intersects the primitives.
        intersection: Option<Intersection<'a>>,
    },
    /// Callables that share a record, at least one.
    Callables {
        /// The direct callable.
        direct: Option<Entry<'a>>,
        /// The continuation callable, which OptiX's scheduler calls.
        continuation: Option<Entry<'a>>,
    },
}

/// A program group. Cheap to clone; keeps its modules alive.
#[derive(Clone, Debug)]
pub struct ProgramGroup(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    raw: sys::OptixProgramGroup,
    modules: Vec<Module>,
    context: Context,
}

impl ProgramGroup {
    /// Makes a group. `payload` chooses the payload type, and may be `None` where exactly one of the module's fits all
    /// programs of the group.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a name without the prefix of its kind, modules of another context and callables without a
    /// callable; [`Error::Optix`] with the log otherwise.
    pub fn new(context: &Context, programs: &Programs<'_>, payload: Option<&PayloadType>) -> Result<Self, Error> {
        let mut builder = Builder { context, names: Vec::new(), modules: Vec::new() };
        let description = builder.describe(programs)?;
        if let Some(payload) = payload {
            payload.check()?;
        }
        let payload = payload.map(PayloadType::raw);
        let options = sys::OptixProgramGroupOptions {
            payload_type: payload.as_ref().map_or(ptr::null(), |payload| &raw const *payload),
        };
        let mut log = CompileLog::new();
        let mut raw = sys::OptixProgramGroup::NULL;
        let _current = context.enter()?;
        let (log_text, log_size) = log.parts();
        // SAFETY: the context is live; the description, its names and modules and the options live until the end of
        // this block; the log buffer is as long as its size says.
        let result = unsafe {
            let table = context.table();
            table.program_group_create(context.raw(), &description, 1, &options, log_text, log_size, &mut raw)
        };
        context.check_compile("optixProgramGroupCreate", result, &log)?;
        Ok(Self(Arc::new(Inner { raw, modules: builder.modules, context: context.clone() })))
    }

    /// Writes the header of a record that runs this group (guide 7.1). The bytes may be copied and used for any number
    /// of records.
    ///
    /// # Errors
    /// [`Error::Optix`].
    pub fn pack_header(&self, header: &mut [u8; sys::OPTIX_SBT_RECORD_HEADER_SIZE]) -> Result<(), Error> {
        let context = &self.0.context;
        let _current = context.enter()?;
        // SAFETY: the group is live and the header has the 32 bytes that are written.
        let result = unsafe { context.table().sbt_record_pack_header(self.0.raw, header.as_mut_ptr().cast()) };
        context.check("optixSbtRecordPackHeader", result)
    }

    /// The stack use of its programs; `pipeline` is the one they are linked into.
    pub(super) fn stack(&self, pipeline: sys::OptixPipeline) -> Result<GroupStack, Error> {
        let context = &self.0.context;
        let mut sizes = sys::OptixStackSizes::default();
        // SAFETY: the group and the pipeline are live, and `sizes` is valid for a write.
        let result = unsafe { context.table().program_group_get_stack_size(self.0.raw, &mut sizes, pipeline) };
        context.check("optixProgramGroupGetStackSize", result)?;
        Ok(GroupStack {
            css_rg: sizes.css_rg,
            css_ms: sizes.css_ms,
            css_ch: sizes.css_ch,
            css_ah: sizes.css_ah,
            css_is: sizes.css_is,
            css_cc: sizes.css_cc,
            dss_dc: sizes.dss_dc,
        })
    }

    pub(super) fn raw(&self) -> sys::OptixProgramGroup {
        self.0.raw
    }

    pub(super) fn modules(&self) -> &[Module] {
        &self.0.modules
    }

    pub(super) fn context(&self) -> &Context {
        &self.0.context
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        if let Ok(_current) = self.context.enter() {
            // SAFETY: made by this context and destroyed here only; pipelines hold their groups.
            let _ = unsafe { self.context.table().program_group_destroy(self.raw) };
        }
    }
}

/// Collects what a description points to.
struct Builder<'c> {
    context: &'c Context,
    // A CString's characters stay where they are when the vector grows.
    names: Vec<CString>,
    modules: Vec<Module>,
}

impl Builder<'_> {
    fn describe(&mut self, programs: &Programs<'_>) -> Result<sys::OptixProgramGroupDesc, Error> {
        use sys::{OptixProgramGroupKind as Kind, OptixProgramGroupPrograms as Union};
        let (kind, programs) = match *programs {
            Programs::Raygen(entry) => (Kind::RAYGEN, self.single("__raygen__", Some(entry))?),
            Programs::Miss(entry) => (Kind::MISS, self.single("__miss__", entry)?),
            Programs::Exception(entry) => (Kind::EXCEPTION, self.single("__exception__", Some(entry))?),
            Programs::HitGroup { closesthit, anyhit, intersection } => {
                let (module_ch, entry_function_name_ch) = self.entry("__closesthit__", closesthit)?;
                let (module_ah, entry_function_name_ah) = self.entry("__anyhit__", anyhit)?;
                let (module_is, entry_function_name_is) = match intersection {
                    Some(Intersection::Builtin(module)) => (self.module(module)?, ptr::null()),
                    Some(Intersection::Program(entry)) => self.entry("__intersection__", Some(entry))?,
                    None => self.entry("__intersection__", None)?,
                };
                let hitgroup = sys::OptixProgramGroupHitgroup {
                    module_ch,
                    entry_function_name_ch,
                    module_ah,
                    entry_function_name_ah,
                    module_is,
                    entry_function_name_is,
                };
                (Kind::HITGROUP, Union { hitgroup })
            }
            Programs::Callables { direct: None, continuation: None } => {
                let remedy = "name a direct callable, a continuation callable, or both";
                return Err(Error::invalid("a callables group", "it has no callable", remedy));
            }
            Programs::Callables { direct, continuation } => {
                let (module_dc, entry_function_name_dc) = self.entry("__direct_callable__", direct)?;
                let (module_cc, entry_function_name_cc) = self.entry("__continuation_callable__", continuation)?;
                let callables = sys::OptixProgramGroupCallables {
                    module_dc,
                    entry_function_name_dc,
                    module_cc,
                    entry_function_name_cc,
                };
                (Kind::CALLABLES, Union { callables })
            }
        };
        Ok(sys::OptixProgramGroupDesc { kind, flags: 0, programs })
    }

    fn single(&mut self, prefix: &str, entry: Option<Entry<'_>>) -> Result<sys::OptixProgramGroupPrograms, Error> {
        let (module, entry_function_name) = self.entry(prefix, entry)?;
        // All bytes of the union are zero before one member is set, since the driver may look at the whole of it.
        let mut programs = sys::OptixProgramGroupPrograms { hitgroup: Default::default() };
        programs.single = sys::OptixProgramGroupSingleModule { module, entry_function_name };
        Ok(programs)
    }

    fn entry(&mut self, prefix: &str, entry: Option<Entry<'_>>) -> Result<(sys::OptixModule, *const c_char), Error> {
        let Some(Entry { module, name }) = entry else {
            return Ok((sys::OptixModule::NULL, ptr::null()));
        };
        check_prefix(prefix, name)?;
        let name = c_name("a program group", name)?;
        let pointer = name.as_ptr();
        self.names.push(name);
        Ok((self.module(module)?, pointer))
    }

    fn module(&mut self, module: &Module) -> Result<sys::OptixModule, Error> {
        self.context.owns("a program group", module.context())?;
        self.modules.push(module.clone());
        Ok(module.raw())
    }
}

fn check_prefix(prefix: &str, name: &str) -> Result<(), Error> {
    if name.starts_with(prefix) {
        return Ok(());
    }
    let problem = format!("the entry {name:?} does not begin with {prefix}");
    Err(Error::invalid(
        "a program group",
        problem,
        "give the name of a program of that kind, as it is in the PTX (guide 6.2)",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_must_have_the_prefix_of_its_kind() {
        assert!(check_prefix("__miss__", "__miss__sky").is_ok());
        let text = check_prefix("__miss__", "__raygen__camera").unwrap_err().to_string();
        assert!(text.contains("__raygen__camera") && text.contains("__miss__"), "{text}");
    }
}
