//! Fingerprints of what crosses between host and device.
//!
//! Host and device are two compilations of one source, which a `#[cfg(..)]` or a constant can make differ: then one reads what
//! the other did not write. So each computes a number of every type that crosses. Those of the device are in the PTX, and a
//! host compares them with its own when it builds a pipeline, as `cargo optix verify` does.

/// A number that changes with how a type is laid out: its size and alignment, and name, place and layout of each field (FNV-1a, 64
/// bits).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout(u64);

impl Layout {
    /// Of a type that has no parts, by its name.
    pub const fn of(name: &str) -> Self {
        Self(0xcbf2_9ce4_8422_2325).text(name)
    }

    /// Of a type of which only that is known.
    pub const fn of_size(size: usize, align: usize) -> Self {
        Self::of("").number(size).number(align)
    }

    /// With a name.
    #[must_use]
    pub const fn text(mut self, text: &str) -> Self {
        let text = text.as_bytes();
        let mut i = 0;
        while i < text.len() {
            self = self.mix(text[i] as u64);
            i += 1;
        }
        self.number(text.len())
    }

    /// With a number.
    #[must_use]
    pub const fn number(self, number: usize) -> Self {
        self.mix(number as u64)
    }

    /// With numbers.
    #[must_use]
    pub const fn numbers(mut self, numbers: &[u32]) -> Self {
        let mut i = 0;
        while i < numbers.len() {
            self = self.number(numbers[i] as usize);
            i += 1;
        }
        self.number(numbers.len())
    }

    /// With that of a part, which comes after what is there: a step alone would not tell the two apart.
    #[must_use]
    pub const fn with(self, part: Self) -> Self {
        self.mix(1).mix(part.0)
    }

    /// With a field: its name, where it begins, and its own layout.
    #[must_use]
    pub const fn field(self, name: &str, at: usize, layout: Self) -> Self {
        self.text(name).number(at).with(layout)
    }

    /// The number.
    pub const fn get(self) -> u64 {
        self.0
    }

    /// A step of FNV-1a with a number in place of a byte.
    const fn mix(self, value: u64) -> Self {
        Self((self.0 ^ value).wrapping_mul(0x0000_0100_0000_01b3))
    }
}

/// A type that crosses between host and device in a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crossing {
    /// What it is there: "record", "payload".
    pub what: &'static str,
    /// The type's name; of a signature the callable's.
    pub name: &'static str,
    /// Bytes in memory, or words in registers.
    pub size: usize,
    /// Its layout.
    pub layout: Layout,
}

impl Crossing {
    /// A type by its parts.
    pub const fn new(what: &'static str, name: &'static str, size: usize, layout: Layout) -> Self {
        Self { what, name, size, layout: layout.text(name).number(size) }
    }

    /// Of launch parameters.
    pub const fn params<P: crate::params::LaunchParams>() -> Self {
        Self::new("launch parameters", P::NAME, size_of::<P>(), P::LAYOUT)
    }

    /// Of a record.
    pub const fn record<R: crate::record::SbtRecord>() -> Self {
        Self::new("record", R::NAME, size_of::<R>(), R::LAYOUT)
    }

    /// Of a payload.
    pub const fn payload<R: crate::payload::Payload>() -> Self {
        let pointer = <R::Transport as crate::payload::Transport>::POINTER;
        Self::new("payload", R::NAME, R::WORDS, R::LAYOUT.numbers(R::SEMANTICS).number(pointer as usize))
    }

    /// Of what hits carry.
    pub const fn attributes<A: crate::primitive::Attributes>() -> Self {
        Self::new("attributes", A::NAME, A::WORDS, A::LAYOUT)
    }

    /// Of the signature of the callable `name`.
    pub const fn signature<F: crate::callable::Signature>(name: &'static str) -> Self {
        let arguments = <F::Arguments as crate::words::Words>::COUNT;
        Self::new("signature of callable", name, arguments, F::LAYOUT)
    }

    /// Of what programs throw.
    pub const fn exception<E: crate::exception::UserException>() -> Self {
        Self::new("exception", E::NAME, E::DETAILS, E::LAYOUT)
    }

    /// What its size is counted in.
    pub const fn unit(&self) -> &'static str {
        match self.what.as_bytes() {
            b"record" | b"launch parameters" => "bytes",
            _ => "words",
        }
    }

    /// What the PTX has of `N` types: for each its size and its layout's number.
    pub const fn table<const N: usize>(crossings: [Self; N]) -> [[u64; 2]; N] {
        let mut table = [[0; 2]; N];
        let mut i = 0;
        while i < N {
            table[i] = [crossings[i].size as u64, crossings[i].layout.0];
            i += 1;
        }
        table
    }
}

#[cfg(test)]
mod tests {
    use super::Layout;

    #[test]
    fn what_differs_has_another_number() {
        let of = |fields: &[(&str, usize, &str)]| {
            fields.iter().fold(Layout::of_size(8, 4), |layout, (name, at, ty)| layout.field(name, *at, Layout::of(ty)))
        };
        let all = [
            of(&[("a", 0, "u32"), ("b", 4, "u32")]),
            of(&[("b", 0, "u32"), ("a", 4, "u32")]),
            of(&[("a", 0, "u32"), ("b", 4, "f32")]),
            of(&[("a", 0, "u32"), ("b", 8, "u32")]),
            of(&[("a", 0, "u32")]),
            of(&[("ab", 0, "u32"), ("", 4, "u32")]),
            Layout::of("u32").with(Layout::of("f32")),
            Layout::of("f32").with(Layout::of("u32")),
            Layout::of("").numbers(&[1, 2]),
            Layout::of("").numbers(&[1]).number(2),
        ];
        for (i, one) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|other| other != one), "{i}");
        }
    }
}
