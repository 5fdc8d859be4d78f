//! Writes the functions: random expressions of every integer width, floats, vectors, control flow and memory. The seed is
//! fixed, so host and device get the same ones.

use std::fmt::Write;

const FUNCTIONS: usize = 96;
const INTEGERS: [&str; 10] = ["u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "u128", "i128"];

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) % end as u64) as usize
    }

    fn of<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.below(list.len())]
    }

    /// An expression of the type, over the inputs `x`.
    fn value(&mut self, ty: &str, depth: usize) -> String {
        match ty {
            "f32" | "f64" => self.float(ty, depth),
            _ => self.integer(ty, depth),
        }
    }

    fn integer(&mut self, ty: &str, depth: usize) -> String {
        if depth == 0 {
            return match self.below(4) {
                0 => format!("({}_i64 as {ty})", self.below(256) as i64 - 128),
                // Both halves of a wide integer.
                1 => format!("((x[{}] as u128) << 64 | x[{}] as u128) as {ty}", self.below(4), self.below(4)),
                _ => format!("(x[{}] as {ty})", self.below(4)),
            };
        }
        let a = format!("({})", self.value(ty, depth - 1));
        let b = format!("({})", self.value(ty, depth - 1));
        let amount = format!("(x[{}] as u32)", self.below(4));
        let unsigned = ty.starts_with('u');
        match self.below(18) {
            0 => format!("{a}.wrapping_add({b})"),
            1 => format!("{a}.wrapping_sub({b})"),
            2 => format!("{a}.wrapping_mul({b})"),
            // The device has no division of 128 bits in both generators.
            3 if !ty.ends_with("128") => format!("{a}.checked_div({b}).unwrap_or({a})"),
            4 if !ty.ends_with("128") => format!("{a}.checked_rem({b}).unwrap_or({b})"),
            5 => format!("{a}.saturating_add({b})"),
            6 => format!("{a}.saturating_sub({b})"),
            7 => format!("{a} {} {b}", self.of(&["&", "|", "^"])),
            8 => format!("{a}.{}({amount})", self.of(&["wrapping_shl", "wrapping_shr"])),
            9 => format!("{a}.{}({amount})", self.of(&["rotate_left", "rotate_right"])),
            10 => format!("{a}.{}({b})", self.of(&["min", "max"])),
            11 => format!("{a}.cmp(&{b}) as i8 as {ty}"),
            12 => format!("{a}.{}() as {ty}", self.of(&["count_ones", "leading_zeros", "trailing_zeros"])),
            13 => format!("{a}.{}()", self.of(&["swap_bytes", "reverse_bits"])),
            14 if unsigned => format!("{a}.abs_diff({b})"),
            14 => format!("{a}.wrapping_abs().wrapping_neg()"),
            15 => {
                let from = self.of(&INTEGERS);
                format!("({}) as {ty}", self.integer(from, depth - 1))
            }
            16 => {
                let from = self.of(&["f32", "f64"]);
                // A cast to 128 bits is a function that the device does not have.
                let to = if ty.ends_with("128") { "i64" } else { ty };
                format!("({}) as {to} as {ty}", self.float(from, depth - 1))
            }
            _ => format!("if {a} < {b} {{ {a} }} else {{ {b}.overflowing_add({a}).0 }}"),
        }
    }

    fn float(&mut self, ty: &str, depth: usize) -> String {
        let bits = if ty == "f32" { "u32" } else { "u64" };
        if depth == 0 {
            return match self.below(4) {
                0 => format!("{ty}::from_bits(x[{}] as {bits})", self.below(4)),
                1 => format!("{}.{}_{ty}", self.below(100), self.below(1000)),
                _ => format!("(x[{}] as i16 as {ty} * 0.0625)", self.below(4)),
            };
        }
        let a = format!("({})", self.value(ty, depth - 1));
        let b = format!("({})", self.value(ty, depth - 1));
        match self.below(9) {
            0..=3 => format!("{a} {} {b}", self.of(&["+", "-", "*", "/"])),
            4 => format!("-{a}"),
            // The sign of a NaN that arithmetic made is not defined.
            5 => format!("{a}.abs().copysign({{ let s: {ty} = {b}; if s.is_nan() {{ 1.0 }} else {{ s }} }})"),
            6 => format!("if {a} < {b} {{ {a} }} else {{ {b} }}"),
            7 => {
                let from = self.of(&INTEGERS[..8]);
                format!("({}) as {ty}", self.integer(from, depth - 1))
            }
            _ if ty == "f32" => format!("({}) as f32", self.float("f64", depth - 1)),
            _ => format!("({}) as f64", self.float("f32", depth - 1)),
        }
    }

    /// A function's body.
    fn body(&mut self) -> String {
        let ty = if self.below(3) == 0 { self.of(&["f32", "f64"]) } else { self.of(&INTEGERS) };
        let (a, b) = (self.value(ty, 2), self.value(ty, 2));
        let step = |of: &str| match ty {
            "f32" | "f64" => format!("{of} * 0.5 + b"),
            _ => format!("{of}.rotate_left(3).wrapping_add(b)"),
        };
        match self.below(5) {
            0 => format!("result({})", self.value(ty, 3)),
            1 => format!(
                "let (mut a, b, mut i): ({ty}, {ty}, u64) = ({a}, {b}, 0);\n\
                 while i < x[0] % 9 {{ a = {}; if a > b {{ break; }} i += 1; }}\nresult(a)",
                step("a")
            ),
            2 => format!(
                "let b: {ty} = {b};\nlet mut array: [{ty}; 4] = [{a}, b, b, {}];\n\
                 array[(x[1] % 4) as usize] = {};\n\
                 for i in 0..3 {{ array[i + 1] = {}; }}\nresult(array[(x[2] % 4) as usize])",
                self.value(ty, 1),
                self.value(ty, 1),
                step("array[i]"),
            ),
            3 => format!(
                "result(match x[3] % 5 {{ 0 => {a}, 1 => {b}, 3 => {}, _ => {} }})",
                self.value(ty, 1),
                self.value(ty, 1)
            ),
            _ => {
                let [a, b, c] = [0; 3].map(|_| self.float("f32", 1));
                let op = self.of(&["v.cross(w)", "v * w - w", "v.normalize()", "v.floor() + w.abs()", "v.reflect(w)"]);
                format!(
                    "let (v, w) = (Vec3::new({a}, {b}, {c}), Vec3::splat({a}) + Vec3::X);\nlet v = {op};\nresult(v.dot(w))"
                )
            }
        }
    }
}

fn main() {
    let mut random = Random(0x0970_0490);
    let mut text = format!("pub const FUNCTIONS: u32 = {FUNCTIONS};\n");
    let mut arms = String::new();
    for function in 0..FUNCTIONS {
        let _ = write!(text, "#[inline(never)]\nfn f{function}(x: &[u64; 4]) -> u64 {{\n{}\n}}\n", random.body());
        let _ = writeln!(arms, "{function} => f{function}(x),");
    }
    let _ =
        write!(text, "pub fn call(function: u32, x: &[u64; 4]) -> u64 {{\nmatch function {{\n{arms}_ => 0,\n}}\n}}\n");
    let out = std::path::PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it"));
    std::fs::write(out.join("functions.rs"), text).expect("writable");
    println!("cargo::rerun-if-changed=build.rs");
}
