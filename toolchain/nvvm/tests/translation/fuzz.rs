//! Mutated IR: whatever comes, it is translated or refused, and what is known of it is read, without a panic.
//!
//! `FUZZ_SECONDS=600 cargo test -p optix-nvvm --release --test translation fuzz -- --nocapture` runs longer than tests do.
//! What is accepted by mistake is libNVVM's to refuse: this looks at the reader only.

use std::time::{Duration, Instant};

use optix_llvm_ir::{Origins, known, module};
use optix_nvvm::{Dialect, translate};

use super::accepted;

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }
}

/// The words and the spaces between them.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut kind = None;
    for c in text.chars() {
        let now =
            if c.is_alphanumeric() || "._-%@!#".contains(c) { Some(true) } else { c.is_whitespace().then_some(false) };
        match words.last_mut() {
            Some(word) if now.is_some() && now == kind => word.push(c),
            _ => words.push(c.to_string()),
        }
        kind = now;
    }
    words
}

fn mutate(words: &mut Vec<String>, other: &[String], random: &mut Random) {
    const INTERESTING: [&str; 16] = [
        "-1",
        "0",
        "99999999999999999999",
        "i0",
        "i129",
        "<0 x i8>",
        "[18446744073709551615 x i8]",
        "ptr",
        "poison",
        "{",
        "(",
        "\"",
        "ß",
        "half",
        "!",
        "@llvm.",
    ];
    let (at, from) = (random.below(words.len()), random.below(other.len()));
    match random.below(6) {
        0 if !words.is_empty() => drop(words.remove(at)),
        1 if !words.is_empty() => {
            let other = random.below(words.len());
            words.swap(at, other);
        }
        2 if !words.is_empty() => words[at] = other[from].clone(),
        3 => words.insert(at, INTERESTING[random.below(INTERESTING.len())].to_string()),
        4 => {
            let count = random.below(24).min(other.len() - from);
            words.splice(at..at, other[from..from + count].iter().cloned());
        }
        _ => {
            let end = (at + random.below(16)).min(words.len());
            words.drain(at..end);
        }
    }
}

#[test]
fn fuzz() {
    let seconds = std::env::var("FUZZ_SECONDS").ok().and_then(|seconds| seconds.parse().ok());
    let end = Instant::now() + Duration::from_secs(seconds.unwrap_or(60));
    // Without a wish for more time, a number of inputs, so that every run is the same.
    let most = if seconds.is_some() { u64::MAX } else { 4_000 };
    let seeds: Vec<Vec<String>> = accepted::seeds().iter().map(|text| words(text)).collect();
    let mut random = Random(0x4e56_564d);
    let (mut count, mut accepted) = (0, 0);
    while count < most && Instant::now() < end {
        let mut input = seeds[random.below(seeds.len())].clone();
        for _ in 0..1 + random.below(4) {
            let other = &seeds[random.below(seeds.len())];
            mutate(&mut input, other, &mut random);
        }
        let text = input.concat();
        let dialect = if random.below(4) == 0 { Dialect::Modern } else { Dialect::Llvm7 };
        let result = std::panic::catch_unwind(|| {
            let known = known(&text);
            let origins = Origins::new(&known);
            known.instructions().for_each(|(function, instruction)| drop(origins.of(function, instruction)));
            if let Ok(module) = module(&text) {
                assert!(module == known, "what is known is read by both");
            }
            translate(&text, dialect).is_ok()
        });
        accepted += u64::from(result.unwrap_or_else(|_| panic!("a panic for:\n{text}")));
        count += 1;
    }
    println!("{count} inputs, {accepted} of them accepted");
}
