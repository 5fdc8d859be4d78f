//! Float operations that LLVM 7 or libNVVM does not know.

use super::builder::{Builder, constant, float};
use super::libdevice;
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Op, Type, Typed, Value};
use optix_llvm_ir::opcode::{Binary, Cast, FloatPredicate, IntPredicate};

/// Avoids two things at which libNVVM fails: it joins stores to a vector of eight halves, which it then can't store,
/// and it has no conversion of a half to 128 bits.
pub(super) fn avoid_halves(builder: &mut Builder<'_>, op: &mut Op) {
    match op {
        // It joins only as many stores as the alignment is known to allow.
        Op::Store { value, align: Some(align), .. } if value.ty == Type::Half => *align = (*align).min(8),
        Op::Cast { op: op @ (Cast::FPToUI | Cast::FPToSI), value, to: Type::Int(65..) } if value.ty == Type::Half => {
            // The greatest half is 65,504, so 32 bits hold any that can be converted; others are undefined.
            let extend = if *op == Cast::FPToSI { Cast::SExt } else { Cast::ZExt };
            *value = builder.cast(*op, value, &Type::Int(32));
            *op = extend;
        }
        _ => {}
    }
}

/// The greatest number below one half, in either type. Added before the fraction is cut off, it rounds to the nearest
/// integer, with ties away from zero.
const BELOW_HALF: (f64, f64) = (f32::from_bits(0x3eff_ffff) as f64, 0.499_999_999_999_999_94);

/// The names that NVVM's intrinsics have for the two types.
fn letter(ty: &Type) -> Result<char, Unknown> {
    match ty {
        Type::Float => Ok('f'),
        Type::Double => Ok('d'),
        _ => Err(Unknown::new(format!("a float operation on {ty:?}")).hint("use `f32` there")),
    }
}

pub(super) fn negate(builder: &mut Builder<'_>, value: &Typed) -> Result<Typed, Unknown> {
    if *value.ty.element() == Type::Half {
        let ty = value.ty.with_element(Type::Int(16));
        let bits = builder.cast(Cast::Bitcast, value, &ty);
        let bits = builder.with(Binary::Xor, &bits, -0x8000);
        return Ok(builder.cast(Cast::Bitcast, &bits, &value.ty));
    }
    // LLVM 7 recognises this as a negation.
    Ok(builder.binary(Binary::FSub, &float(&value.ty, -0.0), value))
}

/// `frem`, which LLVM 7 would compute from a rounded division, and so inexactly.
pub(super) fn remainder(builder: &mut Builder<'_>, a: &Typed, b: &Typed) -> Result<Typed, Unknown> {
    elementwise(builder, &[a.clone(), b.clone()], &|builder, args| {
        libdevice::call(builder, "fmod", &[&args[0], &args[1]])
    })
}

/// An operation on scalars of one type.
type Scalar<'f> = dyn Fn(&mut Builder<'_>, &[Typed]) -> Result<Typed, Unknown> + 'f;

/// Applies `f` to each element, as `float` if the elements are `half`. The results are exact, or rounding them twice
/// does no harm for what this is used for.
fn elementwise(builder: &mut Builder<'_>, arguments: &[Typed], f: &Scalar<'_>) -> Result<Typed, Unknown> {
    let ty = arguments[0].ty.clone();
    match &ty {
        Type::Vector(count, _) => {
            let mut result = Typed::new(ty.clone(), Value::Undef);
            for index in 0..*count {
                let of: Vec<_> = arguments.iter().map(|argument| builder.extract(argument, index)).collect();
                let element = elementwise(builder, &of, f)?;
                result = builder.insert(&result, element, index);
            }
            Ok(result)
        }
        Type::Half => {
            let wide: Vec<_> = arguments.iter().map(|value| builder.cast(Cast::FPExt, value, &Type::Float)).collect();
            let result = f(builder, &wide)?;
            Ok(builder.cast(Cast::FPTrunc, &result, &ty))
        }
        _ => f(builder, arguments),
    }
}

/// A function of one float type with one to three arguments, by its name in LLVM. `None` if it is no such function.
pub(super) fn function(builder: &mut Builder<'_>, name: &str, arguments: &[Typed]) -> Option<Result<Typed, Unknown>> {
    if arguments[0].ty == Type::Half && matches!(name, "fma" | "fmuladd") {
        return Some(Err(Unknown::new("`fma` of `f16`").hint("use `f32` there")));
    }
    let known = match (name, arguments.len()) {
        ("sqrt" | "floor" | "ceil", 1) | ("copysign", 2) | ("fma", 3) => native,
        ("fabs" | "trunc" | "rint" | "nearbyint" | "roundeven", 1) => of_nvvm,
        ("maxnum" | "maximumnum" | "minnum" | "minimumnum", 2) => of_nvvm,
        ("round", 1) => round,
        ("maximum" | "minimum", 2) => with_nan,
        ("fmuladd", 3) => |builder: &mut Builder<'_>, _: &str, a: &[Typed]| {
            let product = builder.binary(Binary::FMul, &a[0], &a[1]);
            Ok(builder.binary(Binary::FAdd, &product, &a[2]))
        },
        ("canonicalize", 1) => |builder: &mut Builder<'_>, _: &str, a: &[Typed]| {
            let name = format!("llvm.nvvm.mul.rn.{}", letter(&a[0].ty)?);
            builder.pure(&name, &a[0].ty, &[&a[0], &float(&a[0].ty, 1.0)])
        },
        (name, count) if libdevice::knows(name, count) => |builder: &mut Builder<'_>, name: &str, a: &[Typed]| {
            libdevice::call(builder, name, &a.iter().collect::<Vec<_>>())
        },
        _ => return None,
    };
    Some(elementwise(builder, arguments, &|builder, arguments| known(builder, name, arguments)))
}

fn native(builder: &mut Builder<'_>, name: &str, arguments: &[Typed]) -> Result<Typed, Unknown> {
    let ty = &arguments[0].ty;
    let bits = if letter(ty)? == 'f' { 32 } else { 64 };
    builder.pure(&format!("llvm.{name}.f{bits}"), ty, &arguments.iter().collect::<Vec<_>>())
}

fn of_nvvm(builder: &mut Builder<'_>, name: &str, arguments: &[Typed]) -> Result<Typed, Unknown> {
    let ty = &arguments[0].ty;
    let name = match name {
        "maxnum" | "maximumnum" => "fmax",
        "minnum" | "minimumnum" => "fmin",
        // NVVM's `round` rounds ties to the even integer, so it does not serve.
        "rint" | "nearbyint" | "roundeven" => "round",
        name => name,
    };
    builder.pure(&format!("llvm.nvvm.{name}.{}", letter(ty)?), ty, &arguments.iter().collect::<Vec<_>>())
}

/// Rounds to the nearest integer, with ties away from zero.
fn round(builder: &mut Builder<'_>, _: &str, arguments: &[Typed]) -> Result<Typed, Unknown> {
    let (a, letter) = (&arguments[0], letter(&arguments[0].ty)?);
    let half = float(&a.ty, if letter == 'f' { BELOW_HALF.0 } else { BELOW_HALF.1 });
    let half = native(builder, "copysign", &[half, a.clone()])?;
    // An addition by an intrinsic is never contracted with a product before it.
    let sum = builder.pure(&format!("llvm.nvvm.add.rn.{letter}"), &a.ty, &[a, &half])?;
    builder.pure(&format!("llvm.nvvm.trunc.{letter}"), &a.ty, &[&sum])
}

/// `maximum` and `minimum`, whose result is NaN if one of the operands is.
fn with_nan(builder: &mut Builder<'_>, name: &str, arguments: &[Typed]) -> Result<Typed, Unknown> {
    let (a, b) = (&arguments[0], &arguments[1]);
    let number = of_nvvm(builder, if name == "maximum" { "maxnum" } else { "minnum" }, arguments)?;
    let unordered = builder.compare(FloatPredicate::Uno, a, b);
    let nan = builder.binary(Binary::FAdd, a, b);
    Ok(builder.select(&unordered, &nan, &number))
}

/// Converts a float to an integer, towards zero and saturating at the limits of the type; NaN becomes 0.
pub(super) fn to_integer(builder: &mut Builder<'_>, signed: bool, value: &Typed, to: &Type) -> Result<Typed, Unknown> {
    let value = &if value.ty == Type::Half { builder.cast(Cast::FPExt, value, &Type::Float) } else { value.clone() };
    let letter = letter(&value.ty)?;
    let bits = match to {
        Type::Int(bits @ 1..=64) => *bits,
        _ => return Err(Unknown::new(format!("a float to {to:?}")).hint("convert to 64 bits or fewer")),
    };
    let (wide, int) = if bits <= 32 { (32, "i") } else { (64, "ll") };
    let ty = Type::Int(wide);
    // The instruction saturates at the limits of its own type.
    let name = format!("llvm.nvvm.{letter}2{}{int}.rz", if signed { "" } else { "u" });
    let mut result = builder.pure(&name, &ty, &[value])?;
    if letter == 'd' || wide == 64 {
        // Only the conversion from `float` to 32 bits gives 0 for NaN.
        let nan = builder.compare(FloatPredicate::Uno, value, value);
        result = builder.select(&nan, &constant(&ty, 0), &result);
    }
    if bits < wide {
        let limits = if signed { (-(1_i128 << (bits - 1)), (1 << (bits - 1)) - 1) } else { (0, (1 << bits) - 1) };
        if signed {
            result = builder.select_by(IntPredicate::Sgt, &result, &constant(&ty, limits.0));
        }
        result = builder.select_by(
            if signed { IntPredicate::Slt } else { IntPredicate::Ult },
            &result,
            &constant(&ty, limits.1),
        );
    }
    Ok(builder.cast(Cast::Trunc, &result, to))
}

/// Whether a float is of one of the classes in the mask, whose bits are LLVM's.
pub(super) fn is_class(builder: &mut Builder<'_>, value: &Typed, mask: u32) -> Result<Typed, Unknown> {
    let (bits, mantissa) = match value.ty {
        Type::Half => (16, 10),
        Type::Float => (32, 23),
        Type::Double => (64, 52),
        _ => return Err(Unknown::new(format!("the class of {:?}", value.ty))),
    };
    let ty = Type::Int(bits);
    let number = |value: i128| constant(&ty, value);
    let infinity = ((1_i128 << (bits - 1 - mantissa)) - 1) << mantissa;
    let least_normal = 1_i128 << mantissa;
    let word = builder.cast(Cast::Bitcast, value, &ty);
    let magnitude = builder.with(Binary::And, &word, (1 << (bits - 1)) - 1);
    let negative = builder.compare(IntPredicate::Slt, &word, &number(0));

    let mut is = Typed::int(1, 0);
    // Signalling NaNs have 0 as the first bit of the mantissa.
    if mask & 3 == 3 {
        let nan = builder.compare(IntPredicate::Ugt, &magnitude, &number(infinity));
        is = builder.binary(Binary::Or, &is, &nan);
    } else if mask & 3 != 0 {
        let quiet = infinity | (least_normal >> 1);
        let nan = if mask & 3 == 2 {
            builder.compare(IntPredicate::Uge, &magnitude, &number(quiet))
        } else {
            let above = builder.compare(IntPredicate::Ugt, &magnitude, &number(infinity));
            let below = builder.compare(IntPredicate::Ult, &magnitude, &number(quiet));
            builder.binary(Binary::And, &above, &below)
        };
        is = builder.binary(Binary::Or, &is, &nan);
    }
    // For each class: the number of its bit for negative numbers and of that for positive ones, and the range of its
    // magnitudes, without the end.
    let classes =
        [(2, 9, infinity, infinity + 1), (3, 8, least_normal, infinity), (4, 7, 1, least_normal), (5, 6, 0, 1)];
    for (minus, plus, first, end) in classes {
        let (minus, plus) = (mask >> minus & 1 == 1, mask >> plus & 1 == 1);
        if !minus && !plus {
            continue;
        }
        let above = builder.with(Binary::Sub, &magnitude, first);
        let mut inside = builder.compare(IntPredicate::Ult, &above, &number(end - first));
        if minus != plus {
            let sign = if minus { negative.clone() } else { builder.with(Binary::Xor, &negative, 1) };
            inside = builder.binary(Binary::And, &inside, &sign);
        }
        is = builder.binary(Binary::Or, &is, &inside);
    }
    Ok(is)
}
