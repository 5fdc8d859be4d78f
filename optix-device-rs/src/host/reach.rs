//! What the programs of a launch reach on the CPU: a view holds a number there, not an address, and what the number names
//! is looked up among what the running launch keeps alive.
//!
//! So a program that hides a view where a later program finds it, in a variable of its thread say, has hidden a number. A
//! launch that keeps the memory alive knows the number, and any other ends with an error that says so.

use super::{Rule, Sampler, end};
use crate::params::Field;
use crate::texture::Lookup;
use core::cell::Cell;
use core::ptr::NonNull;
use std::format;
use std::string::String;
use std::sync::{Mutex, PoisonError};
use std::vec::Vec;

/// A number that names memory or a structure while this value lives, and nothing after that.
#[derive(Debug)]
pub struct Handle(u64);

/// Slots, so that what has a number is found by indexing: the low half of a handle is its slot and 1, the high half how
/// often the slot was used before.
struct Slots {
    /// The next use of each slot.
    uses: Vec<u32>,
    free: Vec<u32>,
}

static SLOTS: Mutex<Slots> = Mutex::new(Slots { uses: Vec::new(), free: Vec::new() });

impl Handle {
    /// One that was not there before.
    ///
    /// # Panics
    /// If 2^32 - 1 of them live.
    pub fn issue() -> Self {
        let mut slots = SLOTS.lock().unwrap_or_else(PoisonError::into_inner);
        let slot = slots.free.pop().unwrap_or_else(|| {
            let slot = u32::try_from(slots.uses.len()).expect("fewer than 2^32 buffers and structures live");
            slots.uses.push(0);
            slot
        });
        Self(u64::from(slots.uses[slot as usize]) << 32 | (u64::from(slot) + 1))
    }

    /// The number; never 0.
    pub fn number(&self) -> u64 {
        self.0
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        let mut slots = SLOTS.lock().unwrap_or_else(PoisonError::into_inner);
        let slot = slot_of(self.0);
        // A slot that was used 2^32 times rests, so that no number comes twice.
        if let Some(next) = slots.uses[slot].checked_add(1) {
            slots.uses[slot] = next;
            slots.free.push(slot as u32);
        }
    }
}

#[inline(always)]
fn slot_of(number: u64) -> usize {
    // 0 names nothing, and wraps to a slot beyond any table.
    (number as u32).wrapping_sub(1) as usize
}

/// Things by the number that names them.
#[derive(Clone, Debug)]
pub struct ByHandle<T> {
    slots: Vec<Option<(u64, T)>>,
}

impl<T> Default for ByHandle<T> {
    fn default() -> Self {
        Self { slots: Vec::new() }
    }
}

impl<T: Copy> ByHandle<T> {
    /// Adds a thing; once more changes nothing.
    pub fn insert(&mut self, handle: &Handle, thing: T) {
        let slot = slot_of(handle.0);
        if slot >= self.slots.len() {
            self.slots.resize(slot + 1, None);
        }
        self.slots[slot] = Some((handle.0, thing));
    }

    /// The thing of this number, if it is among these.
    #[inline(always)]
    pub fn get(&self, number: u64) -> Option<T> {
        match self.slots.get(slot_of(number)) {
            Some(&Some((of, thing))) if of == number => Some(thing),
            _ => None,
        }
    }
}

/// The memory and the textures that a launch keeps alive.
#[derive(Clone, Debug, Default)]
pub struct Reach {
    memory: ByHandle<NonNull<u8>>,
    textures: ByHandle<NonNull<dyn Sampler>>,
    /// The launch parameters that are views, by their numbers; for messages.
    parameters: Vec<(u64, &'static str)>,
}

// SAFETY: addresses; the memory is shared by design, and read and written with atomics only (`insert`), and samplers are `Sync`.
unsafe impl Send for Reach {}
// SAFETY: as above.
unsafe impl Sync for Reach {}

std::thread_local! {
    /// The memory of the launch whose programs run on this thread.
    static RUNNING: Cell<Option<NonNull<Reach>>> = const { Cell::new(None) };
}

impl Reach {
    /// Adds memory.
    ///
    /// # Safety
    /// While this value or a clone of it lives, as much as the views with this handle show is there, and everybody reads and writes
    /// it with atomics of the views' width ([`Element`](crate::view::Element)).
    pub unsafe fn insert(&mut self, handle: &Handle, memory: NonNull<u8>) {
        self.memory.insert(handle, memory);
    }

    /// Adds a texture.
    ///
    /// # Safety
    /// The texture is there while this value or a clone of it lives.
    pub unsafe fn insert_texture(&mut self, handle: &Handle, texture: NonNull<dyn Sampler>) {
        self.textures.insert(handle, texture);
    }

    /// Notes which launch parameters are views of this memory, for messages: of `params`, the bytes of the launch's.
    pub fn name(&mut self, fields: &[Field], params: &[u8]) {
        // A view begins with its number.
        let slices = fields.iter().filter(|field| field.slice).filter_map(|field| {
            let number = params.get(field.offset..)?.first_chunk()?;
            Some((u64::from_le_bytes(*number), field.name))
        });
        self.parameters.extend(slices);
    }

    /// Runs programs of the launch that keeps this memory.
    ///
    /// # Safety
    /// The caller is an executor, and not a program; the value lives until the launch index is over, with all that
    /// [`end::catch`](super::end::catch) does for it.
    pub unsafe fn enter<R>(&self, programs: impl FnOnce() -> R) -> R {
        struct Leave(Option<NonNull<Reach>>);
        impl Drop for Leave {
            fn drop(&mut self) {
                RUNNING.set(self.0);
            }
        }
        // A program may launch: then the inner launch's programs have its memory, and the outer program its own afterwards.
        let _leave = Leave(RUNNING.replace(Some(NonNull::from(self))));
        programs()
    }
}

/// The memory that a view of the running program shows. Any other use of a view ends it.
#[inline(always)]
#[track_caller]
pub(crate) fn memory(handle: u64) -> NonNull<u8> {
    held(|reach| reach.memory.get(handle))
}

/// Looks up the texture of a view of the running program. Any other use of a view ends it.
#[inline(always)]
#[track_caller]
pub(crate) fn sample(handle: u64, lookup: &Lookup) -> [f32; 4] {
    let texture = held(|reach| reach.textures.get(handle));
    // SAFETY: it is there while the running launch is (`insert_texture`).
    unsafe { texture.as_ref() }.sample(lookup)
}

/// What the running launch has by this number.
#[inline(always)]
#[track_caller]
fn held<T>(get: impl Fn(&Reach) -> Option<T>) -> T {
    // SAFETY: `enter` borrows the value for as long as it stands there.
    let running = RUNNING.get().map(|reach| unsafe { reach.as_ref() });
    match running.and_then(&get) {
        Some(thing) => thing,
        None => not_held(get, running.is_some()),
    }
}

/// The launch parameters that are a view of the running program, in words that end a message. A view in a record or in a struct
/// of views has none.
pub(crate) fn name_of(handle: u64) -> String {
    // SAFETY: `enter` borrows the value for as long as it stands there.
    let running = RUNNING.get().map(|reach| unsafe { reach.as_ref() });
    let parameters = running.into_iter().flat_map(|reach| &reach.parameters);
    let names: Vec<&str> = parameters.filter(|(number, _)| *number == handle).map(|(_, name)| *name).collect();
    if names.is_empty() { String::new() } else { format!(" (launch parameter `{}`)", names.join("` or `")) }
}

/// Takes the memory from the programs of this thread, whose launch index has ended.
pub(super) fn close() -> Option<NonNull<Reach>> {
    RUNNING.take()
}

/// Gives it back, to the programs of the next launch index.
pub(super) fn reopen(reach: Option<NonNull<Reach>>) {
    RUNNING.set(reach);
}

#[cold]
#[inline(never)]
#[track_caller]
fn not_held<T>(get: impl Fn(&Reach) -> Option<T>, running: bool) -> T {
    // Destructors that run while their program is unwound use views as ever.
    // SAFETY: `enter` borrows the value until the programs of the launch index are left.
    let closed = end::closed().map(|reach| unsafe { reach.as_ref() });
    if let Some(thing) = closed.and_then(get) {
        return thing;
    }
    let what = if running || closed.is_some() {
        "a view is used that this launch's parameters and records do not hold: it was kept from another launch"
    } else {
        "a view of device memory is used outside of a launch: read the buffer with `Buffer::read`"
    };
    end::fail(Rule::View, what.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a program is told that uses a view with this number.
    fn ends(number: u64) -> std::string::String {
        let panic = std::panic::catch_unwind(|| memory(number)).unwrap_err();
        *panic.downcast().unwrap()
    }

    fn within(reach: &Reach, programs: impl FnOnce()) {
        // SAFETY: this is no program, and the values of these tests outlive the calls.
        unsafe { reach.enter(programs) }
    }

    #[test]
    fn a_message_names_the_parameters_that_are_the_view() {
        let (handle, other) = (Handle::issue(), Handle::issue());
        let mut reach = Reach::default();
        let field = |name, offset, slice| Field { name, offset, size: 16, bound: false, slice };
        let fields =
            [field("count", 0, false), field("first", 16, true), field("second", 32, true), field("third", 48, true)];
        // A number that is the view's by chance, the view twice, and another view, as long as the view's number.
        let words = [handle.number(), 0, handle.number(), 7, handle.number(), 7, other.number(), handle.number()];
        reach.name(&fields, words.map(u64::to_le_bytes).as_flattened());
        within(&reach, || {
            assert_eq!(name_of(handle.number()), " (launch parameter `first` or `second`)");
            assert_eq!(name_of(other.number()), " (launch parameter `third`)");
            assert_eq!(name_of(0), "");
        });
        assert_eq!(name_of(handle.number()), "");
    }

    #[test]
    fn a_number_never_comes_twice() {
        let mut seen = std::collections::HashSet::new();
        for round in 0..100 {
            let handles: Vec<Handle> = (0..round % 7 + 1).map(|_| Handle::issue()).collect();
            for handle in &handles {
                assert!(handle.number() != 0 && seen.insert(handle.number()));
            }
        }
    }

    #[test]
    fn only_the_running_launch_reaches_its_memory() {
        let (mine, other) = (Handle::issue(), Handle::issue());
        let mut place = 0u8;
        let at = NonNull::from(&mut place);
        let (mut reach, mut inner) = (Reach::default(), Reach::default());
        // SAFETY: no view shows anything of it.
        unsafe {
            reach.insert(&mine, at);
            inner.insert(&other, at);
        }
        assert!(ends(1).contains("outside of a launch"));
        let (number, foreign) = (mine.number(), other.number());
        within(&reach, || {
            assert_eq!(memory(number), at);
            for stale in [0, foreign, number + (1 << 32), u64::MAX] {
                assert!(ends(stale).contains("kept from another launch"), "{stale:x}");
            }
            within(&inner, || {
                assert_eq!(memory(foreign), at);
                assert!(ends(number).contains("kept from another launch"));
            });
            assert_eq!(memory(number), at);
        });
        let _ = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| within(&reach, || panic!("a program"))));
        assert!(ends(number).contains("outside of a launch"));
    }
}
