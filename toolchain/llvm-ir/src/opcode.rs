//! The opcodes of instructions: what is done, without the operands.

use std::fmt;

use crate::unknown::Unknown;

/// Declares an enumeration of words. If a variant has several words, the first one is printed.
macro_rules! words {
    ($(#[$doc:meta])* $name:ident { $($variant:ident = $word:literal $(| $other:literal)*,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $($variant,)*
        }

        impl $name {
            /// The variant that a word stands for.
            pub fn of(word: &str) -> Option<Self> {
                match word {
                    $($word $(| $other)* => Some(Self::$variant),)*
                    _ => None,
                }
            }

            pub fn word(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)*
                }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.word())
            }
        }
    };
}

words! {
    /// Arithmetic of two operands.
    Binary {
        Add = "add",
        Sub = "sub",
        Mul = "mul",
        UDiv = "udiv",
        SDiv = "sdiv",
        URem = "urem",
        SRem = "srem",
        Shl = "shl",
        LShr = "lshr",
        AShr = "ashr",
        And = "and",
        Or = "or",
        Xor = "xor",
        FAdd = "fadd",
        FSub = "fsub",
        FMul = "fmul",
        FDiv = "fdiv",
        FRem = "frem",
    }
}

impl Binary {
    /// Whether the operands are floats.
    pub fn is_float(self) -> bool {
        matches!(self, Self::FAdd | Self::FSub | Self::FMul | Self::FDiv | Self::FRem)
    }
}

words! {
    /// A conversion. `ptrtoaddr` differs from `ptrtoint` only in the provenance, which LLVM 7 does not know.
    Cast {
        Trunc = "trunc",
        ZExt = "zext",
        SExt = "sext",
        FPTrunc = "fptrunc",
        FPExt = "fpext",
        FPToUI = "fptoui",
        FPToSI = "fptosi",
        UIToFP = "uitofp",
        SIToFP = "sitofp",
        PtrToInt = "ptrtoint" | "ptrtoaddr",
        IntToPtr = "inttoptr",
        Bitcast = "bitcast",
        Addrspacecast = "addrspacecast",
    }
}

words! {
    /// The predicate of `icmp`.
    IntPredicate {
        Eq = "eq",
        Ne = "ne",
        Ugt = "ugt",
        Uge = "uge",
        Ult = "ult",
        Ule = "ule",
        Sgt = "sgt",
        Sge = "sge",
        Slt = "slt",
        Sle = "sle",
    }
}

words! {
    /// The predicate of `fcmp`.
    FloatPredicate {
        False = "false",
        Oeq = "oeq",
        Ogt = "ogt",
        Oge = "oge",
        Olt = "olt",
        Ole = "ole",
        One = "one",
        Ord = "ord",
        Ueq = "ueq",
        Ugt = "ugt",
        Uge = "uge",
        Ult = "ult",
        Ule = "ule",
        Une = "une",
        Uno = "uno",
        True = "true",
    }
}

/// The predicate of a comparison, of integers or of floats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Predicate {
    /// `icmp`
    Int(IntPredicate),
    /// `fcmp`
    Float(FloatPredicate),
}

impl fmt::Display for Predicate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Int(predicate) => predicate.fmt(f),
            Self::Float(predicate) => predicate.fmt(f),
        }
    }
}

impl From<IntPredicate> for Predicate {
    fn from(predicate: IntPredicate) -> Self {
        Self::Int(predicate)
    }
}

impl From<FloatPredicate> for Predicate {
    fn from(predicate: FloatPredicate) -> Self {
        Self::Float(predicate)
    }
}

words! {
    /// The operations of `atomicrmw` that the GPU has.
    Atomic {
        Xchg = "xchg",
        Add = "add",
        Sub = "sub",
        And = "and",
        Or = "or",
        Xor = "xor",
        Max = "max",
        Min = "min",
        UMax = "umax",
        UMin = "umin",
        FAdd = "fadd",
    }
}

words! {
    /// The memory ordering of an atomic operation.
    Order {
        Unordered = "unordered",
        Monotonic = "monotonic",
        Acquire = "acquire",
        Release = "release",
        AcqRel = "acq_rel",
        SeqCst = "seq_cst",
    }
}

impl Order {
    /// The ordering of a compare-exchange that has this ordering if it succeeds, and `failure` if it fails.
    pub fn or(self, failure: Self) -> Self {
        match (self, failure) {
            (Self::SeqCst, _) | (_, Self::SeqCst) => Self::SeqCst,
            (Self::Release, Self::Acquire) => Self::AcqRel,
            (Self::Monotonic, Self::Acquire) => Self::Acquire,
            (success, _) => success,
        }
    }
}

words! {
    /// The word of an instruction that is neither arithmetic of two operands nor a conversion.
    Other {
        FNeg = "fneg",
        Freeze = "freeze",
        ICmp = "icmp",
        FCmp = "fcmp",
        Select = "select",
        Phi = "phi",
        Load = "load",
        Store = "store",
        GetElementPtr = "getelementptr",
        Alloca = "alloca",
        ExtractValue = "extractvalue",
        InsertValue = "insertvalue",
        ExtractElement = "extractelement",
        InsertElement = "insertelement",
        ShuffleVector = "shufflevector",
        AtomicRmw = "atomicrmw",
        CmpXchg = "cmpxchg",
        Fence = "fence",
        Call = "call",
        Tail = "tail" | "musttail",
        NoTail = "notail",
        Ret = "ret",
        Br = "br",
        Switch = "switch",
        Unreachable = "unreachable",
    }
}

/// The first word of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Opcode {
    Binary(Binary),
    Cast(Cast),
    Other(Other),
}

impl Opcode {
    /// The opcode that the first word of an instruction stands for. This is the only place where an instruction is
    /// refused because of its word.
    pub fn of(word: &str) -> Result<Self, Unknown> {
        let binary = || Binary::of(word).map(Self::Binary);
        let cast = || Cast::of(word).map(Self::Cast);
        let other = || Other::of(word).map(Self::Other);
        binary().or_else(cast).or_else(other).ok_or_else(|| match word {
            "invoke" | "landingpad" | "resume" | "cleanuppad" | "catchswitch" => {
                Unknown::new("unwinding").hint("device code is compiled with `panic = \"abort\"`")
            }
            "va_arg" => Unknown::new("a list of variable arguments").hint("pass a slice"),
            word => Unknown::new(format!("the instruction `{word}`")),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_word_is_one_opcode() {
        assert_eq!(Opcode::of("frem"), Ok(Opcode::Binary(Binary::FRem)));
        assert_eq!(Opcode::of("ptrtoaddr"), Ok(Opcode::Cast(Cast::PtrToInt)));
        assert_eq!(Opcode::of("musttail"), Ok(Opcode::Other(Other::Tail)));
        assert_eq!(Cast::PtrToInt.to_string(), "ptrtoint");
        assert_eq!(
            Opcode::of("frobnicate").map_err(|unknown| unknown.reason),
            Err("the instruction `frobnicate`".into())
        );
        assert!(Opcode::of("invoke").is_err_and(|unknown| unknown.reason == "unwinding"));
    }

    #[test]
    fn a_compare_exchange_is_as_strong_as_both_of_its_orders() {
        assert_eq!(Order::Release.or(Order::Acquire), Order::AcqRel);
        assert_eq!(Order::Monotonic.or(Order::Acquire), Order::Acquire);
        assert_eq!(Order::Acquire.or(Order::Monotonic), Order::Acquire);
        assert_eq!(Order::AcqRel.or(Order::SeqCst), Order::SeqCst);
    }
}
