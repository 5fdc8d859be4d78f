//! The stack of a traversal.

use std::mem::MaybeUninit;

use super::bvh::{Child, STACK};

/// A child and where the ray enters it, in one number that sorts by depth; depths are not negative, so their bits sort
/// as they do.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry(u64);

impl Entry {
    #[inline(always)]
    pub fn new(depth: f32, child: Child) -> Self {
        Self(u64::from(depth.to_bits()) << 32 | u64::from(child.0))
    }

    #[inline(always)]
    pub fn depth(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    pub fn child(self) -> Child {
        Child(self.0 as u32)
    }
}

/// Children that wait for a visit. Not initialised: every structure that a ray enters has one, and filling it takes
/// longer than most of them.
pub struct Stack {
    /// Those below `len` are written.
    entries: [MaybeUninit<Entry>; STACK],
    len: usize,
}

impl Stack {
    #[inline(always)]
    pub fn new() -> Self {
        Self { entries: [const { MaybeUninit::uninit() }; STACK], len: 0 }
    }

    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Puts an entry among those from `base` upwards, which are sorted, the farthest lowest.
    #[inline(always)]
    pub fn insert(&mut self, entry: Entry, base: usize) {
        let mut place = self.len;
        while place > base && self.get(place - 1) < entry {
            self.entries[place] = self.entries[place - 1];
            place -= 1;
        }
        self.entries[place].write(entry);
        self.len += 1;
    }

    #[inline(always)]
    pub fn push(&mut self, entry: Entry) {
        self.entries[self.len].write(entry);
        self.len += 1;
    }

    #[inline(always)]
    pub fn pop(&mut self) -> Option<Entry> {
        let last = self.len.checked_sub(1)?;
        let entry = self.get(last);
        self.len = last;
        Some(entry)
    }

    #[inline(always)]
    fn get(&self, place: usize) -> Entry {
        debug_assert!(place < self.len);
        // SAFETY: entries below `len` are written, and both callers ask for one of these: `push` and
        // `insert`, which alone raise `len`, write every entry from the place of the new one to the old `len` first.
        unsafe { self.entries[place].assume_init() }
    }
}
