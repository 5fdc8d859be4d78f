//! What a pipeline's declaration promises about its PTX, in numbers that the host computed.

use crate::error::Error;
use crate::json::Json;

/// A pipeline, as `<P as Pipeline>::DESCRIPTION` has it on the host.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pipeline {
    /// The type's name.
    pub name: String,
    /// The launch parameters.
    pub params: Params,
    /// The ray types; the index is SBT offset, miss index and payload type.
    pub rays: Vec<Ray>,
    /// What its programs may throw, if anything.
    pub throws: Option<String>,
    /// The PTX's variable that holds the layouts of `crossings`.
    pub layouts: String,
    /// The types that cross between host and device.
    pub crossings: Vec<Crossing>,
    /// The programs, one per entry.
    pub programs: Vec<Program>,
}

/// A type that crosses between host and device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Crossing {
    /// What it is: "record".
    pub what: String,
    /// Its name.
    pub name: String,
    /// How many bytes or words it has.
    pub size: usize,
    /// Whether these are bytes or words.
    pub unit: String,
    /// A number that stands for its layout.
    pub layout: u64,
}

/// A launch-parameter struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Params {
    /// The type's name.
    pub name: String,
    /// The constant-memory variable.
    pub symbol: String,
    /// Bytes.
    pub size: usize,
    /// Bytes.
    pub align: usize,
    /// The fields.
    pub fields: Vec<Field>,
}

/// A field of a launch-parameter struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// The name.
    pub name: String,
    /// Bytes from the beginning.
    pub offset: usize,
    /// Bytes.
    pub size: usize,
    /// Whether it is `#[bound]`.
    pub bound: bool,
}

/// A ray type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ray {
    /// The payload's name.
    pub payload: String,
    /// `OptixPayloadSemantics` bits per payload word.
    pub semantics: Vec<u32>,
    /// Words that the tracing program keeps in local memory, if the payload travels by pointer.
    pub memory_words: usize,
}

/// A device program, with its place in a pipeline.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// Its kind.
    pub kind: Kind,
    /// Its entry in the PTX.
    pub entry: String,
    /// The Rust function as `pipeline!` names it: `surface::lambert`.
    pub function: String,
    /// The ray type it runs for; none for ray generation, callables and exceptions.
    pub ray: Option<usize>,
    /// The material of its hit group: the record's name. None for others.
    pub material: Option<String>,
    /// The kind of primitive of its hit group, as `pipeline!` has it after `on`. None for others.
    pub primitive: Option<String>,
    /// Functions in the PTX that ask about hits on other kinds of primitive.
    pub undefined: Vec<String>,
}

/// The kind of a device program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Ray generation.
    RayGen,
    /// Miss.
    Miss,
    /// Closest hit.
    ClosestHit,
    /// Any hit.
    AnyHit,
    /// Intersection.
    Intersection,
    /// Direct callable.
    DirectCallable,
    /// Continuation callable.
    ContinuationCallable,
    /// Exception.
    Exception,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Self; 8] = [
        Self::RayGen,
        Self::Miss,
        Self::ClosestHit,
        Self::AnyHit,
        Self::Intersection,
        Self::DirectCallable,
        Self::ContinuationCallable,
        Self::Exception,
    ];

    /// As the attribute is called: `closesthit`.
    pub const fn word(self) -> &'static str {
        match self {
            Self::RayGen => "raygen",
            Self::Miss => "miss",
            Self::ClosestHit => "closesthit",
            Self::AnyHit => "anyhit",
            Self::Intersection => "intersection",
            Self::DirectCallable => "direct_callable",
            Self::ContinuationCallable => "continuation_callable",
            Self::Exception => "exception",
        }
    }

    /// The prefix that OptiX asks for in the entry's name.
    pub fn prefix(self) -> String {
        format!("__{}__", self.word())
    }

    /// The `OptixPayloadSemantics` bits that allow it to read and write a payload word. `None` if this kind has no
    /// payload.
    pub const fn semantics(self) -> Option<(u32, u32)> {
        match self {
            Self::RayGen | Self::DirectCallable | Self::ContinuationCallable | Self::Exception => None,
            Self::ClosestHit => Some((4, 8)),
            Self::Miss => Some((16, 32)),
            Self::AnyHit => Some((64, 128)),
            Self::Intersection => Some((256, 512)),
        }
    }

    /// Whether it may trace rays.
    pub const fn may_trace(self) -> bool {
        matches!(self, Self::RayGen | Self::ClosestHit | Self::Miss | Self::ContinuationCallable)
    }

    /// Whether it is a callable: a function with arguments, which programs call.
    pub const fn is_callable(self) -> bool {
        matches!(self, Self::DirectCallable | Self::ContinuationCallable)
    }
}

/// Reads what the program in `templates/facts` prints.
pub(super) fn parse(text: &str) -> Result<Vec<Pipeline>, Error> {
    let bad = |reason: String| Error::Output { of: "the pipelines' descriptions".into(), reason };
    let json = Json::parse(text).map_err(bad)?;
    let pipelines: Option<Vec<_>> = json.items().iter().map(pipeline).collect();
    pipelines.ok_or_else(|| bad("a field is missing".into()))
}

fn pipeline(json: &Json) -> Option<Pipeline> {
    let params = json.get("params");
    Some(Pipeline {
        name: text(json, "name")?,
        params: Params {
            name: text(params, "name")?,
            symbol: text(params, "symbol")?,
            size: params.get("size").number()?,
            align: params.get("align").number()?,
            fields: params.get("fields").items().iter().map(field).collect::<Option<_>>()?,
        },
        rays: json.get("rays").items().iter().map(ray).collect::<Option<_>>()?,
        throws: text(json, "throws"),
        layouts: text(json, "layouts")?,
        crossings: json.get("crossings").items().iter().map(crossing).collect::<Option<_>>()?,
        programs: json.get("programs").items().iter().map(program).collect::<Option<_>>()?,
    })
}

fn text(json: &Json, key: &str) -> Option<String> {
    json.get(key).str().map(str::to_string)
}

fn crossing(json: &Json) -> Option<Crossing> {
    Some(Crossing {
        what: text(json, "what")?,
        name: text(json, "name")?,
        size: json.get("size").number()?,
        unit: text(json, "unit")?,
        layout: json.get("layout").str()?.parse().ok()?,
    })
}

fn field(json: &Json) -> Option<Field> {
    Some(Field {
        name: text(json, "name")?,
        offset: json.get("offset").number()?,
        size: json.get("size").number()?,
        bound: json.get("bound") == &Json::Bool(true),
    })
}

fn ray(json: &Json) -> Option<Ray> {
    let word = |json: &Json| json.number().and_then(|word| u32::try_from(word).ok());
    let semantics = json.get("semantics").items().iter().map(word).collect::<Option<_>>()?;
    Some(Ray { payload: text(json, "payload")?, semantics, memory_words: json.get("memory_words").number()? })
}

fn program(json: &Json) -> Option<Program> {
    let kind = json.get("kind").str()?;
    Some(Program {
        kind: Kind::ALL.into_iter().find(|known| known.word() == kind)?,
        entry: text(json, "entry")?,
        function: text(json, "function")?,
        ray: json.get("ray").number(),
        material: text(json, "material"),
        primitive: text(json, "primitive"),
        undefined: json
            .get("undefined")
            .items()
            .iter()
            .map(|name| name.str().map(str::to_string))
            .collect::<Option<_>>()?,
    })
}
