//! Integer operations that LLVM 7 does not know, or not in every width.

use super::builder::{Builder, constant};
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Type, Typed};
use optix_llvm_ir::opcode::{Binary, Cast, IntPredicate};

/// What to do about arithmetic of more than 64 bits.
const NARROWER: &str = "use integers of up to 64 bits there";

fn bits(value: &Typed) -> Result<u32, Unknown> {
    match value.ty {
        Type::Int(bits) => Ok(bits),
        _ => Err(Unknown::new(format!("an integer operation on {:?}", value.ty))),
    }
}

/// The largest signed value of that many bits.
fn signed_max(bits: u32) -> i128 {
    i128::MAX >> (128 - bits)
}

/// `umin`, `smax` and the like. The result is the first operand if `predicate` holds between the operands, and
/// otherwise the second.
pub(super) fn least(builder: &mut Builder<'_>, predicate: IntPredicate, a: &Typed, b: &Typed) -> Typed {
    builder.select_by(predicate, a, b)
}

/// `abs`. The absolute value of the smallest integer is that integer.
pub(super) fn abs(builder: &mut Builder<'_>, a: &Typed) -> Typed {
    let zero = constant(&a.ty, 0);
    let negated = builder.binary(Binary::Sub, &zero, a);
    let negative = builder.compare(IntPredicate::Slt, a, &zero);
    builder.select(&negative, &negated, a)
}

/// `ucmp` and `scmp`: -1, 0 or 1, of the type `to`.
pub(super) fn three_way(builder: &mut Builder<'_>, signed: bool, a: &Typed, b: &Typed, to: &Type) -> Typed {
    let (less, greater) =
        if signed { (IntPredicate::Slt, IntPredicate::Sgt) } else { (IntPredicate::Ult, IntPredicate::Ugt) };
    let less = builder.compare(less, a, b);
    let less = builder.select(&less, &constant(to, -1), &constant(to, 0));
    let greater = builder.compare(greater, a, b);
    builder.select(&greater, &constant(to, 1), &less)
}

/// `fshl` and `fshr`: two integers side by side are shifted by `amount` modulo their bits, and the result is the high
/// or the low half.
pub(super) fn funnel(
    builder: &mut Builder<'_>,
    left: bool,
    high: &Typed,
    low: &Typed,
    amount: &Typed,
) -> Result<Typed, Unknown> {
    let bits = bits(high)?;
    let (there, back) = if left { (Binary::Shl, Binary::LShr) } else { (Binary::LShr, Binary::Shl) };
    let (near, far) = if left { (high, low) } else { (low, high) };
    if let Some(amount) = amount.value.as_int() {
        let amount = amount.rem_euclid(i128::from(bits));
        if amount == 0 {
            return Ok(near.clone());
        }
        let near = builder.with(there, near, amount);
        let far = builder.with(back, far, i128::from(bits) - amount);
        return Ok(builder.binary(Binary::Or, &near, &far));
    }
    if bits == 32 {
        // A single instruction does this; it takes the amount modulo 32.
        let text = format!("shf.{}.wrap.b32 $0, $1, $2, $3;", if left { 'l' } else { 'r' });
        return Ok(builder.asm(&text, "=r,r,r,r", &high.ty, &[low, high, amount]));
    }
    let most = i128::from(bits) - 1;
    let amount = if bits.is_power_of_two() {
        builder.with(Binary::And, amount, most)
    } else {
        builder.with(Binary::URem, amount, i128::from(bits))
    };
    // A shift by the full number of bits is undefined, so the other half is shifted by one first.
    let rest = builder.binary(Binary::Sub, &constant(&amount.ty, most), &amount);
    let near = builder.binary(there, near, &amount);
    let far = builder.with(back, far, 1);
    let far = builder.binary(back, &far, &rest);
    Ok(builder.binary(Binary::Or, &near, &far))
}

/// The result of an operation, and whether it overflowed.
pub(super) struct Overflowing {
    pub result: Typed,
    pub out: Typed,
}

/// Addition and subtraction.
pub(super) fn overflowing(builder: &mut Builder<'_>, signed: bool, op: Binary, a: &Typed, b: &Typed) -> Overflowing {
    let result = builder.binary(op, a, b);
    let out = match (signed, op) {
        (false, Binary::Add) => builder.compare(IntPredicate::Ult, &result, a),
        (false, _) => builder.compare(IntPredicate::Ult, a, b),
        (true, _) => {
            // It overflowed if the signs of the operands allow that, and the sign of the result differs from that of
            // the first.
            let one = builder.binary(Binary::Xor, a, &result);
            let other = if op == Binary::Add {
                builder.binary(Binary::Xor, b, &result)
            } else {
                builder.binary(Binary::Xor, a, b)
            };
            let both = builder.binary(Binary::And, &one, &other);
            builder.compare(IntPredicate::Slt, &both, &constant(&a.ty, 0))
        }
    };
    Overflowing { result, out }
}

/// `add`, `sub` or `mul` `.with.overflow`, in a width that LLVM 7 has. It has multiplications of 16 to 64 bits.
pub(super) fn with_overflow(
    builder: &mut Builder<'_>,
    signed: bool,
    op: Binary,
    a: &Typed,
    b: &Typed,
) -> Result<Typed, Unknown> {
    let overflowing = match (op, bits(a)?) {
        (Binary::Add | Binary::Sub, _) => overflowing(builder, signed, op, a, b),
        (_, bits @ (16 | 32 | 64)) => {
            let name = format!("llvm.{}mul.with.overflow.i{bits}", if signed { 's' } else { 'u' });
            let pair = Type::Struct { fields: vec![a.ty.clone(), Type::BOOL], packed: false };
            return builder.pure(&name, &pair, &[a, b]);
        }
        (_, bits) if bits <= 32 => {
            let wide = Type::Int(64);
            let extend = if signed { Cast::SExt } else { Cast::ZExt };
            let (wide_a, wide_b) = (builder.cast(extend, a, &wide), builder.cast(extend, b, &wide));
            let product = builder.binary(Binary::Mul, &wide_a, &wide_b);
            let result = builder.cast(Cast::Trunc, &product, &a.ty);
            let again = builder.cast(extend, &result, &wide);
            Overflowing { result, out: builder.compare(IntPredicate::Ne, &product, &again) }
        }
        (_, 128) => checked_product(builder, signed, a, b),
        (_, bits) => {
            return Err(Unknown::new(format!("a checked multiplication of {bits} bits")).hint(NARROWER));
        }
    };
    Ok(builder.pair(&overflowing.result, &overflowing.out))
}

/// A product, which did not overflow if dividing it by one factor gives the other.
fn checked_product(builder: &mut Builder<'_>, signed: bool, a: &Typed, b: &Typed) -> Overflowing {
    let result = builder.binary(Binary::Mul, a, b);
    let (zero, one, minus_one) = (constant(&a.ty, 0), constant(&a.ty, 1), constant(&a.ty, -1));
    let by_zero = builder.compare(IntPredicate::Eq, a, &zero);
    let mut divisor = builder.select(&by_zero, &one, a);
    let negates = builder.compare(IntPredicate::Eq, a, &minus_one);
    if signed {
        // The quotient of the least number and -1 overflows, so a factor of -1 is checked on its own: only the product
        // with the least number overflows.
        divisor = builder.select(&negates, &one, &divisor);
    }
    let quotient = builder.binary(if signed { Binary::SDiv } else { Binary::UDiv }, &result, &divisor);
    let differs = builder.compare(IntPredicate::Ne, &quotient, b);
    let not_zero = builder.compare(IntPredicate::Ne, a, &zero);
    let mut out = builder.binary(Binary::And, &differs, &not_zero);
    if signed {
        let least = builder.compare(IntPredicate::Eq, b, &constant(&a.ty, i128::MIN));
        out = builder.select(&negates, &least, &out);
    }
    Overflowing { result, out }
}

/// `uadd.sat` and its kin.
pub(super) fn saturating(
    builder: &mut Builder<'_>,
    signed: bool,
    op: Binary,
    a: &Typed,
    b: &Typed,
) -> Result<Typed, Unknown> {
    let bits = bits(a)?;
    let (result, out) = if op == Binary::Shl {
        let result = builder.binary(Binary::Shl, a, b);
        let back = builder.binary(if signed { Binary::AShr } else { Binary::LShr }, &result, b);
        let out = builder.compare(IntPredicate::Ne, &back, a);
        (result, out)
    } else {
        let Overflowing { result, out } = overflowing(builder, signed, op, a, b);
        (result, out)
    };
    let limit = if signed {
        // The limit has the sign of the first operand: its sign bit, spread over all bits, with all but the sign
        // inverted.
        let sign = builder.with(Binary::AShr, a, i128::from(bits) - 1);
        builder.with(Binary::Xor, &sign, signed_max(bits))
    } else {
        constant(&a.ty, if op == Binary::Sub { 0 } else { -1 })
    };
    Ok(builder.select(&out, &limit, &result))
}

/// `ctpop`, `ctlz`, `cttz`, `bswap` and `bitreverse`. Those of 128 bits are computed from two halves.
pub(super) fn bit_operation(builder: &mut Builder<'_>, op: &str, a: &Typed) -> Result<Typed, Unknown> {
    let known: &[u32] = if op == "bswap" { &[16, 32, 64] } else { &[8, 16, 32, 64] };
    match bits(a)? {
        bits if known.contains(&bits) => {
            let name = format!("llvm.{op}.i{bits}");
            if matches!(op, "ctlz" | "cttz") {
                // The result for zero is defined as the number of bits, which is still a single instruction.
                return builder.pure(&name, &a.ty, &[a, &Typed::int(1, 0)]);
            }
            builder.pure(&name, &a.ty, &[a])
        }
        128 => {
            let half = Type::Int(64);
            let low = builder.cast(Cast::Trunc, a, &half);
            let high = builder.with(Binary::LShr, a, 64);
            let high = builder.cast(Cast::Trunc, &high, &half);
            let of_low = bit_operation(builder, op, &low)?;
            let of_high = bit_operation(builder, op, &high)?;
            let wide_low = builder.cast(Cast::ZExt, &of_low, &a.ty);
            let wide_high = builder.cast(Cast::ZExt, &of_high, &a.ty);
            Ok(match op {
                "ctpop" => builder.binary(Binary::Add, &wide_low, &wide_high),
                "ctlz" | "cttz" => {
                    let (first, of_first, of_second) =
                        if op == "ctlz" { (high, wide_high, wide_low) } else { (low, wide_low, wide_high) };
                    let second = builder.with(Binary::Add, &of_second, 64);
                    let empty = builder.compare(IntPredicate::Eq, &first, &constant(&half, 0));
                    builder.select(&empty, &second, &of_first)
                }
                _ => {
                    let high = builder.with(Binary::Shl, &wide_low, 64);
                    builder.binary(Binary::Or, &high, &wide_high)
                }
            })
        }
        // Other widths are computed in the next larger width that is known.
        bits if bits < 64 && matches!(op, "ctpop" | "ctlz" | "cttz") => {
            let wide = builder.cast(Cast::ZExt, a, &Type::Int(64));
            let wide = match op {
                "ctlz" => {
                    let top = builder.with(Binary::Shl, &wide, i128::from(64 - bits));
                    builder.with(Binary::Or, &top, (1 << (64 - bits)) >> 1)
                }
                "cttz" => builder.with(Binary::Or, &wide, 1 << bits),
                _ => wide,
            };
            let count = bit_operation(builder, op, &wide)?;
            Ok(builder.cast(Cast::Trunc, &count, &a.ty))
        }
        bits => Err(Unknown::new(format!("`{op}` of {bits} bits")).hint(NARROWER)),
    }
}
