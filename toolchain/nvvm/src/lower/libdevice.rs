//! Calls of libdevice, NVIDIA's library of mathematical functions, which comes with libNVVM.

use super::Lowered;
use super::builder::Builder;
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Call, Type, Typed};

/// The prefix of the names of its functions.
pub(super) const PREFIX: &str = "__nv_";

/// Functions of one type, by their names in C, with the number of arguments.
const FUNCTIONS: [(&str, usize); 30] = [
    ("sin", 1),
    ("cos", 1),
    ("tan", 1),
    ("asin", 1),
    ("acos", 1),
    ("atan", 1),
    ("sinh", 1),
    ("cosh", 1),
    ("tanh", 1),
    ("asinh", 1),
    ("acosh", 1),
    ("atanh", 1),
    ("exp", 1),
    ("exp2", 1),
    ("exp10", 1),
    ("expm1", 1),
    ("log", 1),
    ("log2", 1),
    ("log10", 1),
    ("log1p", 1),
    ("cbrt", 1),
    ("erf", 1),
    ("erfc", 1),
    ("tgamma", 1),
    ("lgamma", 1),
    ("atan2", 2),
    ("hypot", 2),
    ("pow", 2),
    ("fmod", 2),
    ("fdim", 2),
];

/// The name in libdevice of C's `sinf` or `sin`.
pub(super) fn of_symbol(symbol: &str) -> Option<String> {
    let is = |name: &str| FUNCTIONS.iter().any(|(known, _)| *known == name);
    (is(symbol) || symbol.strip_suffix('f').is_some_and(is)).then(|| format!("{PREFIX}{symbol}"))
}

/// Whether `name` is a function of C with that many arguments.
pub(super) fn knows(name: &str, arguments: usize) -> bool {
    FUNCTIONS.contains(&(name, arguments))
}

/// Calls the function of `f32` or `f64` that has this name in C.
pub(super) fn call(builder: &mut Builder<'_>, name: &str, arguments: &[&Typed]) -> Result<Typed, Unknown> {
    let ty = &arguments[0].ty;
    let suffix = if *ty == Type::Float { "f" } else { "" };
    builder.pure(&format!("{PREFIX}{name}{suffix}"), ty, arguments)
}

/// A call of a C function such as `sinf`, which rustc expects to be linked.
pub(super) fn call_of_symbol(builder: &mut Builder<'_>, call: &Call, symbol: &str) -> Lowered {
    let name = of_symbol(symbol).unwrap_or_default();
    builder.call(&name, call)
}
