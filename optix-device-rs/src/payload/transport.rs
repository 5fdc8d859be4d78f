//! How a payload gets from party to party.

use super::Part;
use crate::intrinsics::{Invocation, TraceCall, UNWRITTEN, unwritten};
use crate::limits::MAX_PAYLOAD_WORDS;
use crate::sealed::Sealed;
use crate::words::{WordBuffer, Words, part, part_mut};
use core::mem::MaybeUninit;

/// How a payload gets from party to party; chosen by `#[payload(transport = ..)]`, the same for every program's source.
pub trait Transport: Sealed + 'static {
    /// Whether the registers hold an address, and not the payload.
    const POINTER: bool;

    /// Traces a ray: gives the caller's part, returns what comes back to it.
    ///
    /// # Safety
    /// The call is of a ray whose payload has the two parts, and the program that runs may trace.
    #[doc(hidden)]
    unsafe fn trace<From: Part, At: Part>(invocation: &Invocation, call: &TraceCall, given: From) -> At;

    /// The payload of the running program, where it is in memory; otherwise nothing.
    ///
    /// # Safety
    /// The running program's payload travels by this transport, and there is no other reference to it.
    #[doc(hidden)]
    #[expect(clippy::mut_from_ref, reason = "the memory is the caller's, not the context's")]
    unsafe fn memory(invocation: &Invocation) -> &mut [u32];

    /// Puts what the running program returned into [`Transport::memory`]. A method, and by reference: so it is resolved late
    /// and leaves the code of payloads in registers as it would be without it (the golden tests tell).
    ///
    /// # Safety
    /// As for [`Transport::memory`].
    #[doc(hidden)]
    #[inline(always)]
    unsafe fn give<From: Part>(invocation: &Invocation, given: &From) {
        // SAFETY: the caller's.
        given.store(unsafe { Self::memory(invocation) });
    }
}

/// Every word in a register of its own, 32 at most: what the hardware is made for (guide 14).
#[derive(Clone, Copy, Debug)]
pub enum Registers {}

impl Sealed for Registers {}
impl<const WORDS: usize> Sealed for Pointer<WORDS> {}
impl Transport for Registers {
    const POINTER: bool = false;

    #[inline(always)]
    unsafe fn trace<From: Part, At: Part>(invocation: &Invocation, call: &TraceCall, given: From) -> At {
        let mut registers = WordBuffer([UNWRITTEN; MAX_PAYLOAD_WORDS]);
        given.store(&mut registers.0);
        let registers = invocation.trace(call, registers);
        // SAFETY: the payload's flow was proved (`Payload`), and the programs of a ray are its own.
        unsafe { At::load(&registers.0) }
    }

    #[inline(always)]
    unsafe fn memory(_: &Invocation) -> &mut [u32] {
        &mut []
    }
}

/// `WORDS` words in local memory of the caller, whose address is in two registers (guide 14): for payloads that don't fit
/// into registers, at the price of a load or store for each field that a program takes or gives.
#[derive(Clone, Copy, Debug)]
pub enum Pointer<const WORDS: usize> {}

/// A payload in memory. The alignment lets several words go at once.
#[repr(C, align(16))]
struct Memory<const WORDS: usize>([u32; WORDS]);

impl<const WORDS: usize> Transport for Pointer<WORDS> {
    const POINTER: bool = true;

    #[inline(always)]
    unsafe fn trace<From: Part, At: Part>(invocation: &Invocation, call: &TraceCall, given: From) -> At {
        let mut memory = MaybeUninit::<Memory<WORDS>>::uninit();
        // SAFETY: any bytes are words.
        let memory = unsafe { unwritten(&mut memory) };
        given.store(&mut memory.0);
        let memory: *mut Memory<WORDS> = memory;
        let mut registers = WordBuffer::ZERO;
        memory.store(part_mut(&mut registers.0, 0, 2));
        invocation.trace(call, registers);
        #[cfg(not(target_arch = "nvptx64"))]
        if !crate::host::end::goes_on() {
            // No program ran: zeros, as in registers.
            // SAFETY: the memory is this function's, and nobody else refers to it.
            unsafe { (*memory).0.fill(0) };
        }
        // SAFETY: the memory is this function's, and no program of the ray runs any more. As to the words, the payload's flow
        // was proved (`Payload`), and the programs of a ray are its own.
        unsafe { At::load(&(*memory).0) }
    }

    #[inline(always)]
    unsafe fn memory(invocation: &Invocation) -> &mut [u32] {
        let registers = invocation.payload(0b11);
        // SAFETY: the caller of trace stored an address, and its memory lives until trace returns.
        unsafe {
            let memory: *mut Memory<WORDS> = Words::load(part(&registers.0, 0, 2));
            core::hint::assert_unchecked(memory.is_aligned());
            &mut (*memory).0
        }
    }
}
