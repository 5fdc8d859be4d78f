//! Any text is read, and in time that grows as the text does.

use std::time::{Duration, Instant};

use optix_ptx::{Module, Parts, Statement, plain};

const PTX: &str = include_str!("sample.ptx");

/// Reads all there is to read.
fn read(text: &str) -> usize {
    let plain = plain(text);
    assert_eq!(plain.len(), text.len());
    let module = Module::read(&plain);
    let mut calls = 0;
    for function in &module.functions {
        assert!(text.get(function.range.clone()).is_some(), "{:?} is not a part of the text", function.range);
        function.local_memory();
        calls += function.calls().len();
        let instructions = function.statements().iter().filter_map(|statement| match statement {
            Statement::Instruction(instruction) => Parts::of(instruction),
            _ => None,
        });
        assert_eq!(instructions.count(), function.calls().len());
        module.reached(function.name);
    }
    calls
}

/// Numbers that look random (splitmix64).
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end.max(1) as u64) as usize
    }
}

#[test]
fn changed_texts_are_read() {
    const PIECES: [&str; 24] = [
        "{",
        "}",
        "(",
        ")",
        "[",
        "]",
        ";",
        ":",
        ",",
        "=",
        "@",
        "//",
        "/*",
        "*/",
        "\n",
        "é",
        "\u{1f600}",
        ".func ",
        ".entry",
        ".loc 1",
        ".branchtargets",
        "call ",
        "mov.b32 %r1, ",
        "$L_1:",
    ];
    let mut random = Random(1);
    for _ in 0..3000 {
        let mut text: Vec<char> = PTX.chars().collect();
        for _ in 0..=random.below(8) {
            let (at, length) = (random.below(text.len()), random.below(40));
            let end = (at + length).min(text.len());
            match random.below(4) {
                0 => drop(text.drain(at..end)),
                1 => {
                    let piece = text[at..end].to_vec();
                    let to = random.below(text.len());
                    text.splice(to..to, piece);
                }
                2 => text.truncate(random.below(text.len() * 4)),
                _ => drop(text.splice(at..at, PIECES[random.below(PIECES.len())].chars())),
            }
        }
        read(&text.iter().collect::<String>());
    }
}

#[test]
fn pieces_in_any_order_are_read() {
    let words: Vec<&str> = PTX.split_inclusive([' ', '\n', ',', ';', '(']).collect();
    let mut random = Random(2);
    for _ in 0..3000 {
        let text: String = (0..random.below(200)).map(|_| words[random.below(words.len())]).collect();
        read(&text);
    }
}

/// A compiler's text, and texts that make work: 10 MB each, in seconds where nothing is optimised.
#[test]
fn ten_megabytes_are_read_soon() {
    let long = |piece: &dyn Fn(usize) -> String, around: [&str; 2]| {
        let mut text = around[0].to_string();
        for i in 0.. {
            if text.len() >= 10_000_000 {
                break;
            }
            text.push_str(&piece(i));
        }
        text + around[1]
    };
    let body = [".entry x()\n{\n", "}\n"];
    let texts = [
        ("many programs", long(&|i| PTX.replace("__raygen__", &format!("__raygen__{i}")), ["", ""])),
        ("one function", long(&|i| format!("mov.b32 %r{i}, {i};\ncall (%s{i}), f, (%r{i}, %s{i});\n"), body)),
        (
            "one register",
            long(&|i| format!("$L_{i}: mov.b32 %r1, {i};\n@%p1 bra $L_{};\ncall f, (%r1);\n", i / 2), body),
        ),
        (
            "a register for each loop",
            long(
                &|i| {
                    format!("mov.b32 %r{i}, 0;\n$L_{i}: call f, (%r{i});\nadd.s32 %r{i}, %r{i}, 1;\n@%p bra $L_{i};\n")
                },
                body,
            ),
        ),
        (
            "values that go back",
            long(&|i| format!("$L_{i}: mov.b32 %r{i}, %r{};\n@%p bra $L_0;\ncall f, (%r{i});\n", i + 1), body),
        ),
        ("functions in a chain", long(&|i| format!(".func f{i}()\n{{\ncall f{}, ();\n}}\n", i + 1), ["", ""])),
        ("braces", "{".repeat(10_000_000)),
        ("a function in braces", format!(".func f(){}", "{".repeat(10_000_000))),
        ("values in braces", long(&|i| format!(".global .b8 v{i}[] = {{1}}"), ["", ""])),
        ("parentheses", format!(".entry x(){{ call ({}; }}", "(,".repeat(5_000_000))),
        ("slashes", "/".repeat(10_000_000)),
        ("comments", "/* */".repeat(2_000_000)),
        ("a line of comment ends", "*/ /*".repeat(2_000_000)),
        ("labels", long(&|i| format!("$L_{i}:"), body)),
        ("words", long(&|_| "mov ".to_string(), body)),
        ("blank lines", format!("{}{}{}", body[0], "\n".repeat(10_000_000), body[1])),
        ("colons", format!("{}{}({}{}", body[0], "a".repeat(3_000_000), "b:".repeat(3_000_000), body[1])),
        ("lines in one statement", long(&|_| "mov\n".to_string(), body)),
    ];
    for (name, text) in texts {
        let begin = Instant::now();
        let text = plain(&text);
        let module = Module::read(&text);
        let declared = begin.elapsed();
        let calls: usize = module.functions.iter().map(|function| function.calls().len()).sum();
        if let Some(first) = module.functions.first() {
            module.reached(first.name);
        }
        let took = begin.elapsed();
        println!("{name}: {declared:.0?} to declarations, {took:.0?} in all, {calls} calls");
        assert!(took < Duration::from_secs(20), "{name}: {took:.1?}");
    }
}
