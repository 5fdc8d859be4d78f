//! Expansions compute what the instruction does.
//!
//! libNVVM folds constants, so a function of constants is compiled to its result: that is compared with what Rust computes.
//! An operand that is to be no constant for the lowering is one plus zero.

use std::fmt::Write;

use super::{compile, library};

/// Functions without arguments, and what they return as 64 bits.
#[derive(Default)]
struct Cases {
    ir: String,
    declared: Vec<String>,
    expected: Vec<(String, u64)>,
}

impl Cases {
    /// A case whose body computes `%r` of the type.
    fn add(&mut self, what: String, ty: &str, body: &str, expected: u64) {
        let widen = match ty {
            "i64" => "  %w = add i64 %r, 0".to_string(),
            "i128" => "  %w = trunc i128 %r to i64".to_string(),
            "float" => "  %b = bitcast float %r to i32\n  %w = zext i32 %b to i64".to_string(),
            "double" => "  %w = bitcast double %r to i64".to_string(),
            ty => format!("  %w = zext {ty} %r to i64"),
        };
        let _ = write!(self.ir, "define i64 @case{}() {{\n{body}\n{widen}\n  ret i64 %w\n}}\n", self.expected.len());
        self.expected.push((what, expected));
    }

    /// A call of `llvm.name.type` with constants; with `hidden`, the lowering does not see them.
    fn call(&mut self, name: &str, ty: &str, result: &str, arguments: &[&str], hidden: bool, expected: u64) {
        let types = vec![ty; arguments.len()].join(", ");
        let declaration = format!("declare {result} @{name}({types})\n");
        if !self.declared.contains(&declaration) {
            self.declared.push(declaration);
        }
        let mut body = String::new();
        let mut list = Vec::new();
        for (at, argument) in arguments.iter().enumerate() {
            if hidden {
                let _ = writeln!(body, "  %a{at} = add {ty} {argument}, 0");
                list.push(format!("{ty} %a{at}"));
            } else {
                list.push(format!("{ty} {argument}"));
            }
        }
        let list = list.join(", ");
        let _ = write!(body, "  %r = call {result} @{name}({list})");
        self.add(format!("{name}({list}), {arguments:?}"), result, &body, expected);
    }

    fn check(self, test: &str) {
        let Some(library) = library(test) else { return };
        let ptx = compile(&library, &format!("{}{}", self.ir, self.declared.concat()), "75");
        for (at, (what, expected)) in self.expected.iter().enumerate() {
            let result = returned(&ptx, &format!("case{at}"));
            assert_eq!(result, Some(*expected), "{what}");
        }
        println!("{test}: {} cases", self.expected.len());
    }
}

/// The constant that a function returns.
fn returned(ptx: &str, function: &str) -> Option<u64> {
    let begin = ptx.find(&format!(") {function}("))?;
    let body = &ptx[begin..begin + ptx[begin..].find("ret;")?];
    let line = body.lines().find_map(|line| line.trim().strip_prefix("st.param.b64"))?;
    let register = line.split_once(',')?.1.trim().trim_end_matches(';');
    let moved = body.lines().find_map(|line| {
        let (target, source) = line.trim().strip_prefix("mov.")?.split_once(char::is_whitespace)?.1.split_once(',')?;
        (target.trim() == register).then(|| source.trim().trim_end_matches(';').to_string())
    });
    let constant = moved.unwrap_or_else(|| register.to_string());
    constant.parse::<i64>().map(i64::cast_unsigned).or_else(|_| constant.parse()).ok()
}

macro_rules! integers {
    ($cases:ident, $($signed:ident $unsigned:ident $ty:literal),+) => {$(
        let values = [0, 1, 2, 5, 100, -1, -2, -77, $signed::MAX, $signed::MIN, $signed::MAX - 3, $signed::MIN + 3];
        let bits = $signed::BITS;
        for a in values {
            let text_a = a.to_string();
            let u = a as $unsigned;
            let one = |cases: &mut Cases, name: &str, result: u64| {
                cases.call(&format!("llvm.{name}.{}", $ty), $ty, $ty, &[&text_a], true, result);
            };
            one(&mut $cases, "ctpop", u.count_ones().into());
            one(&mut $cases, "bitreverse", u.reverse_bits() as u64);
            if bits > 8 {
                one(&mut $cases, "bswap", u.swap_bytes() as u64);
            }
            for (name, result) in
                [("abs", a.wrapping_abs() as $unsigned), ("ctlz", u.leading_zeros() as $unsigned), ("cttz", u.trailing_zeros() as $unsigned)]
            {
                let body = format!("  %a = add {0} {a}, 0\n  %r = call {0} @llvm.{name}.{0}({0} %a, i1 false)", $ty);
                let declaration = format!("declare {0} @llvm.{name}.{0}({0}, i1)\n", $ty);
                if !$cases.declared.contains(&declaration) {
                    $cases.declared.push(declaration);
                }
                $cases.add(format!("{name} {a}"), $ty, &body, result as u64);
            }
            for b in values {
                let text_b = b.to_string();
                let v = b as $unsigned;
                let two: [(&str, $unsigned); 10] = [
                    ("smax", a.max(b) as $unsigned),
                    ("smin", a.min(b) as $unsigned),
                    ("umax", u.max(v)),
                    ("umin", u.min(v)),
                    ("sadd.sat", a.saturating_add(b) as $unsigned),
                    ("ssub.sat", a.saturating_sub(b) as $unsigned),
                    ("uadd.sat", u.saturating_add(v)),
                    ("usub.sat", u.saturating_sub(v)),
                    ("scmp", a.cmp(&b) as $signed as $unsigned),
                    ("ucmp", u.cmp(&v) as $signed as $unsigned),
                ];
                for (name, result) in two {
                    let name = match name {
                        "scmp" | "ucmp" => format!("llvm.{name}.{0}.{0}", $ty),
                        name => format!("llvm.{name}.{}", $ty),
                    };
                    $cases.call(&name, $ty, $ty, &[&text_a, &text_b], true, result as u64);
                }
                let overflowing = [
                    ("sadd", a.overflowing_add(b)),
                    ("ssub", a.overflowing_sub(b)),
                    ("smul", a.overflowing_mul(b)),
                    ("uadd", { let (r, o) = u.overflowing_add(v); (r as $signed, o) }),
                    ("usub", { let (r, o) = u.overflowing_sub(v); (r as $signed, o) }),
                    ("umul", { let (r, o) = u.overflowing_mul(v); (r as $signed, o) }),
                ];
                for (name, (result, out)) in overflowing {
                    let declaration = format!("declare {{ {0}, i1 }} @llvm.{name}.with.overflow.{0}({0}, {0})\n", $ty);
                    if !$cases.declared.contains(&declaration) {
                        $cases.declared.push(declaration);
                    }
                    let call = format!(
                        "  %a = add {0} {a}, 0\n  %p = call {{ {0}, i1 }} @llvm.{name}.with.overflow.{0}({0} %a, {0} {b})\n",
                        $ty
                    );
                    let first = format!("{call}  %r = extractvalue {{ {0}, i1 }} %p, 0", $ty);
                    $cases.add(format!("{name} {a} {b}"), $ty, &first, result as $unsigned as u64);
                    let second = format!("{call}  %r = extractvalue {{ {0}, i1 }} %p, 1", $ty);
                    $cases.add(format!("{name} {a} {b} overflows"), "i1", &second, out.into());
                }
            }
        }
        // 32 bits with an amount that is no constant are inline assembly, which nobody folds.
        for (amount, hidden) in [(0, false), (1, false), (7, false), (bits + 3, false), (0, true), (5, true), (bits - 1, true)] {
            if hidden && bits == 32 {
                continue;
            }
            let (high, low): ($unsigned, $unsigned) = ((0x123456789abcdef0_u64 as $unsigned) | 1, 0xfedcba9876543210_u64 as $unsigned);
            let within = amount % bits;
            let (left, right) = match within {
                0 => (high, low),
                n => (high << n | low >> (bits - n), high << (bits - n) | low >> n),
            };
            let arguments = [high.to_string(), low.to_string(), amount.to_string()];
            let arguments = [arguments[0].as_str(), arguments[1].as_str(), arguments[2].as_str()];
            $cases.call(concat!("llvm.fshl.", $ty), $ty, $ty, &arguments, hidden, left as u64);
            $cases.call(concat!("llvm.fshr.", $ty), $ty, $ty, &arguments, hidden, right as u64);
        }
    )+};
}

#[test]
fn integers_of_up_to_32_bits() {
    let mut cases = Cases::default();
    integers!(cases, i8 u8 "i8", i16 u16 "i16", i32 u32 "i32");
    cases.check("integers_of_up_to_32_bits");
}

#[test]
fn integers_of_more_bits() {
    let mut cases = Cases::default();
    integers!(cases, i64 u64 "i64", i128 u128 "i128");
    cases.check("integers_of_more_bits");
}

/// How LLVM writes a `float`.
fn float(value: f32) -> String {
    format!("0x{:016X}", f64::from(value).to_bits())
}

const FLOATS: [f32; 18] = [
    0.0,
    -0.0,
    1.0,
    -1.5,
    0.5,
    -0.5,
    0.499_999_97,
    2.5,
    -3.5,
    8_388_607.5,
    1e30,
    -1e30,
    f32::MIN_POSITIVE,
    1e-40,
    -1e-40,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
];

#[test]
fn classes_of_floats() {
    let mut cases = Cases::default();
    cases.declared.push("declare i1 @llvm.is.fpclass.f32(float, i32 immarg)\n".into());
    for value in FLOATS {
        // In the order of LLVM's bits, without signalling NaN.
        let negative = value.is_sign_negative();
        let class = match (value.classify(), negative) {
            (std::num::FpCategory::Nan, _) => 1,
            (std::num::FpCategory::Infinite, true) => 2,
            (std::num::FpCategory::Normal, true) => 3,
            (std::num::FpCategory::Subnormal, true) => 4,
            (std::num::FpCategory::Zero, true) => 5,
            (std::num::FpCategory::Zero, false) => 6,
            (std::num::FpCategory::Subnormal, false) => 7,
            (std::num::FpCategory::Normal, false) => 8,
            (std::num::FpCategory::Infinite, false) => 9,
        };
        for mask in [1, 2, 3, 4, 8, 16, 32, 64, 96, 128, 144, 256, 264, 512, 516, 504, 1023] {
            let body = format!("  %r = call i1 @llvm.is.fpclass.f32(float {}, i32 {mask})", float(value));
            cases.add(format!("{value} in {mask}"), "i1", &body, u64::from(mask >> class & 1 == 1));
        }
    }
    cases.check("classes_of_floats");
}

#[test]
fn signs_of_floats() {
    let mut cases = Cases::default();
    cases.declared.push("declare float @llvm.copysign.f32(float, float)\n".into());
    for value in FLOATS.into_iter().filter(|value| !value.is_nan()) {
        let body = format!("  %a = fneg float {}\n  %r = fadd float %a, 0x8000000000000000", float(value));
        cases.add(format!("-({value})"), "float", &body, u64::from((-value).to_bits()));
        let body = format!("  %r = call float @llvm.copysign.f32(float {}, float -2.000000e+00)", float(value));
        cases.add(format!("copysign {value}"), "float", &body, u64::from(value.copysign(-2.0).to_bits()));
    }
    cases.check("signs_of_floats");
}
