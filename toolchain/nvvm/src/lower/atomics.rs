//! Atomic memory operations, as PTX has them from `sm_70` on.
//!
//! LLVM 7 knows few atomic operations and no ordering for them, so all of them become inline assembly. Rust's memory
//! model maps to that of PTX.

use super::builder::{Builder, constant};
use optix_llvm_ir::Unknown;
use optix_llvm_ir::model::{Ordering, Type, Typed};
use optix_llvm_ir::opcode::{Atomic, Binary, Cast, IntPredicate, Order};

/// What to do about operations that the GPU has no instruction for.
const WIDER: &str = "use an atomic of 32 or 64 bits";

pub(super) fn load(
    builder: &mut Builder<'_>,
    ty: &Type,
    pointer: &Typed,
    ordering: &Ordering,
) -> Result<Typed, Unknown> {
    let access = Access::of(ty, pointer, ordering)?;
    let order = if matches!(ordering.order, Order::Acquire | Order::SeqCst) { "acquire" } else { "relaxed" };
    let text = format!("{}ld.{order}.{}{}.{} $0, [$1];", access.fence, access.scope, access.space, access.ty);
    let constraints = format!("={},l", access.class);
    let result = builder.asm_memory(&text, &constraints, &access.register, &[pointer]);
    Ok(access.narrow(builder, result, ty))
}

pub(super) fn store(
    builder: &mut Builder<'_>,
    value: &Typed,
    pointer: &Typed,
    ordering: &Ordering,
) -> Result<(), Unknown> {
    let access = Access::of(&value.ty, pointer, ordering)?;
    let order = if matches!(ordering.order, Order::Release | Order::SeqCst) { "release" } else { "relaxed" };
    let value = access.widen(builder, value);
    let text = format!("{}st.{order}.{}{}.{} [$0], $1;", access.fence, access.scope, access.space, access.ty);
    builder.asm_memory(&text, &format!("l,{}", access.class), &Type::Void, &[pointer, &value]);
    Ok(())
}

pub(super) fn read_modify_write(
    builder: &mut Builder<'_>,
    op: Atomic,
    pointer: &Typed,
    value: &Typed,
    ordering: &Ordering,
) -> Result<Typed, Unknown> {
    let access = Access::of(&value.ty, pointer, ordering)?;
    let bits = access.at_least_32(&value.ty)?;
    // PTX has no atomic subtraction, so the negative is added.
    let operand =
        if op == Atomic::Sub { builder.binary(Binary::Sub, &constant(&value.ty, 0), value) } else { value.clone() };
    let (op, ty) = match op {
        Atomic::Xchg => ("exch", format!("b{bits}")),
        Atomic::Add | Atomic::Sub => ("add", format!("u{bits}")),
        Atomic::FAdd => ("add", format!("f{bits}")),
        Atomic::And | Atomic::Or | Atomic::Xor => (op.word(), format!("b{bits}")),
        Atomic::Max | Atomic::Min => (op.word(), format!("s{bits}")),
        Atomic::UMax => ("max", format!("u{bits}")),
        Atomic::UMin => ("min", format!("u{bits}")),
    };
    let text =
        format!("{}atom.{}.{}{}.{op}.{ty} $0, [$1], $2;", access.fence, access.order, access.scope, access.space);
    let class = access.class;
    Ok(builder.asm_memory(&text, &format!("={class},l,{class}"), &access.register, &[pointer, &operand]))
}

/// The result of a compare-exchange: the old value, and whether it was replaced.
pub(super) fn compare_exchange(
    builder: &mut Builder<'_>,
    pointer: &Typed,
    expected: &Typed,
    new: &Typed,
    ordering: &Ordering,
) -> Result<Typed, Unknown> {
    let access = Access::of(&new.ty, pointer, ordering)?;
    let bits = match new.ty.bits() {
        Some(16) => 16,
        _ => access.at_least_32(&new.ty)?,
    };
    let class = access.class;
    let text =
        format!("{}atom.{}.{}{}.cas.b{bits} $0, [$1], $2, $3;", access.fence, access.order, access.scope, access.space);
    let constraints = format!("={class},l,{class},{class}");
    let result = builder.asm_memory(&text, &constraints, &access.register, &[pointer, expected, new]);
    let same = builder.compare(IntPredicate::Eq, &result, expected);
    Ok(builder.pair(&result, &same))
}

pub(super) fn fence(builder: &mut Builder<'_>, ordering: &Ordering) -> Result<(), Unknown> {
    if ordering.scope == "singlethread" {
        // This fence is for the compiler only, which moves no memory access across it.
        builder.asm_memory("", "", &Type::Void, &[]);
        return Ok(());
    }
    let kind = if ordering.order == Order::SeqCst { "sc" } else { "acq_rel" };
    builder.asm_memory(&format!("fence.{kind}.{};", scope(&ordering.scope)?), "", &Type::Void, &[]);
    Ok(())
}

/// The parts of an instruction.
struct Access {
    /// The fence that comes before the instruction.
    fence: String,
    /// The operation of a read-modify-write instruction.
    order: &'static str,
    scope: &'static str,
    space: &'static str,
    /// PTX's type of the memory.
    ty: String,
    /// The constraint of a register that holds the value, and the type that such a register has.
    class: char,
    register: Type,
}

impl Access {
    fn of(ty: &Type, pointer: &Typed, ordering: &Ordering) -> Result<Self, Unknown> {
        let scope = scope(&ordering.scope)?;
        let sequential = ordering.order == Order::SeqCst;
        let (class, register) = match ty {
            Type::Int(8 | 16) => ('h', Type::Int(16)),
            Type::Int(32) => ('r', Type::Int(32)),
            Type::Int(64) => ('l', Type::Int(64)),
            Type::Pointer(_) => ('l', ty.clone()),
            Type::Float => ('f', Type::Float),
            Type::Double => ('d', Type::Double),
            _ => return Err(Unknown::new(format!("an atomic {ty:?}")).hint(WIDER)),
        };
        let bits = if *ty == Type::Int(8) { 8 } else { register.bits().unwrap_or(64) };
        Ok(Self {
            fence: if sequential { format!("fence.sc.{scope}; ") } else { String::new() },
            order: match ordering.order {
                Order::Acquire => "acquire",
                Order::Release => "release",
                Order::AcqRel | Order::SeqCst => "acq_rel",
                Order::Unordered | Order::Monotonic => "relaxed",
            },
            scope,
            space: match pointer.ty {
                Type::Pointer(0) => "",
                Type::Pointer(1) => ".global",
                Type::Pointer(3) => ".shared",
                _ => return Err(Unknown::new(format!("an atomic operation on {:?}", pointer.ty))),
            },
            ty: format!(
                "{}{bits}",
                if register.is_float() {
                    'f'
                } else if bits == 8 {
                    'u'
                } else {
                    'b'
                }
            ),
            class,
            register,
        })
    }

    fn at_least_32(&self, ty: &Type) -> Result<u32, Unknown> {
        match ty.bits() {
            Some(bits @ (32 | 64)) => Ok(bits),
            _ => Err(Unknown::new(format!("an atomic {ty:?}")).hint(WIDER)),
        }
    }

    fn widen(&self, builder: &mut Builder<'_>, value: &Typed) -> Typed {
        builder.cast(Cast::ZExt, value, &self.register)
    }

    fn narrow(&self, builder: &mut Builder<'_>, value: Typed, ty: &Type) -> Typed {
        builder.cast(Cast::Trunc, &value, ty)
    }
}

fn scope(name: &str) -> Result<&'static str, Unknown> {
    match name {
        "" => Ok("sys"),
        "device" => Ok("gpu"),
        "block" => Ok("cta"),
        _ => Err(Unknown::new(format!("the scope `{name}`"))),
    }
}
