//! Kinds of instructions.

/// Which part of a GPU an instruction mainly uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Class {
    /// Arithmetic, comparison and logic on integers and bits.
    Integer,
    /// Arithmetic and comparison of `f32` and `f16`.
    Float,
    /// Arithmetic and comparison of `f64`: 32 to 64 times slower than `f32` on most GPUs.
    Double,
    /// `sin`, `ex2`, `lg2`, `rcp`, `rsqrt`, and also division and square root, which start from one of them. The
    /// exactly rounded forms of those take 8 instructions and more.
    Special,
    /// Conversions between types.
    Convert,
    /// Moves between registers, and selection by a predicate. Most of them vanish in machine code.
    Move,
    /// Constant memory: launch parameters.
    Constant,
    /// Global memory.
    Global,
    /// Local memory, which belongs to one thread.
    Local,
    /// Shared memory.
    Shared,
    /// Arguments and results of functions.
    Param,
    /// Memory whose space is only known at run time.
    Generic,
    /// Textures and surfaces.
    Texture,
    /// Branches, returns, barriers.
    Control,
    /// Calls.
    Call,
}

impl Class {
    /// Every class, in the order in which reports show them.
    pub const ALL: [Self; 15] = [
        Self::Integer,
        Self::Float,
        Self::Double,
        Self::Special,
        Self::Convert,
        Self::Move,
        Self::Constant,
        Self::Global,
        Self::Local,
        Self::Shared,
        Self::Param,
        Self::Generic,
        Self::Texture,
        Self::Control,
        Self::Call,
    ];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Integer => "integer",
            Self::Float => "f32",
            Self::Double => "f64",
            Self::Special => "special",
            Self::Convert => "convert",
            Self::Move => "move",
            Self::Constant => "constant",
            Self::Global => "global",
            Self::Local => "local",
            Self::Shared => "shared",
            Self::Param => "param",
            Self::Generic => "generic",
            Self::Texture => "texture",
            Self::Control => "control",
            Self::Call => "call",
        }
    }

    /// The class of `fma.rn.f32`.
    pub(super) fn of(op: &str) -> Self {
        let mut parts = op.split('.');
        let has = |part: &str| op.split('.').any(|other| other == part);
        match parts.next().unwrap_or_default() {
            "call" => Self::Call,
            "bra" | "brx" | "ret" | "exit" | "trap" | "brkpt" | "bar" | "barrier" | "membar" | "fence"
            | "nanosleep" => Self::Control,
            "ld" | "ldu" | "st" | "atom" | "red" | "prefetch" | "prefetchu" => Self::memory(op),
            "tex" | "tld4" | "txq" | "suld" | "sust" | "sured" | "suq" => Self::Texture,
            "cvt" => Self::Convert,
            "mov" | "selp" | "slct" | "cvta" => Self::Move,
            "sin" | "cos" | "ex2" | "lg2" | "tanh" | "rcp" | "rsqrt" | "sqrt" => Self::Special,
            "div" if has("f32") || has("f64") => Self::Special,
            _ if has("f64") => Self::Double,
            _ if ["f32", "f16", "f16x2", "bf16", "bf16x2", "f32x2"].iter().any(|float| has(float)) => Self::Float,
            _ => Self::Integer,
        }
    }

    /// The class of a memory instruction by its space: `ld.global.nc.v4.f32`.
    fn memory(op: &str) -> Self {
        let space = op.split('.').find_map(|part| match part.split("::").next()? {
            "const" => Some(Self::Constant),
            "global" => Some(Self::Global),
            "local" => Some(Self::Local),
            "shared" => Some(Self::Shared),
            "param" => Some(Self::Param),
            _ => None,
        });
        space.unwrap_or(Self::Generic)
    }
}
