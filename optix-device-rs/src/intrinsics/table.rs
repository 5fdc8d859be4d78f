//! The table of device functions: what the files of this folder, and those of `primitive/`, are written with.
//!
//! A row is all there is to say of a device function: its OptiX names, its documentation, its signature, and what it does on
//! either machine. The section it stands in says which kinds of program may call it:
//!
//! ```text
//! device_functions! {
//!     in ray else HasRay {
//!         /// Least `t`, as passed to trace.
//!         "optixGetRayTmin"
//!         fn ray_tmin(&self) -> f32 {
//!             ptx { get_f32!("_optix_get_ray_tmin") }
//!             host { self.frame().ray.tmin }
//!         }
//!     }
//! }
//! ```
//!
//! Each context of the group `ray` gets a method `ray_tmin`, and each other context one that is there for the message it
//! fails with: that of the trait [`HasRay`](crate::check::HasRay). A function that is made of others has an ordinary body, the
//! same on both machines. Functions that are generic, such as `trace`, are written out, with [`methods!`].

/// The groups of program kinds, which the table of guide 13 has as its columns: `$then!` is given the contexts of the kinds in
/// the group, those of all others, and what else is here.
macro_rules! group {
    (anywhere $then:ident $($rest:tt)*) => { $then! {
        [RayGen<P>, Intersection<P, A>, AnyHit<P, A>, ClosestHit<P, A>, Miss<P>, Exception<P>, DirectCallable<P>, ContinuationCallable<P>]
        []
        $($rest)*
    } };
    // All that run for a launch index that has not ended.
    (running $then:ident $($rest:tt)*) => { $then! {
        [RayGen<P>, Intersection<P, A>, AnyHit<P, A>, ClosestHit<P, A>, Miss<P>, DirectCallable<P>, ContinuationCallable<P>]
        [Exception<P>]
        $($rest)*
    } };
    (tracing $then:ident $($rest:tt)*) => { $then! {
        [RayGen<P>, ClosestHit<P, A>, Miss<P>, ContinuationCallable<P>]
        [Intersection<P, A>, AnyHit<P, A>, Exception<P>, DirectCallable<P>]
        $($rest)*
    } };
    (ray $then:ident $($rest:tt)*) => { $then! {
        [Intersection<P, A>, AnyHit<P, A>, ClosestHit<P, A>, Miss<P>]
        [RayGen<P>, Exception<P>, DirectCallable<P>, ContinuationCallable<P>]
        $($rest)*
    } };
    (object_ray $then:ident $($rest:tt)*) => { $then! {
        [Intersection<P, A>, AnyHit<P, A>]
        [RayGen<P>, ClosestHit<P, A>, Miss<P>, Exception<P>, DirectCallable<P>, ContinuationCallable<P>]
        $($rest)*
    } };
    (primitive $then:ident $($rest:tt)*) => { $then! {
        [Intersection<P, A>, AnyHit<P, A>, ClosestHit<P, A>]
        [RayGen<P>, Miss<P>, Exception<P>, DirectCallable<P>, ContinuationCallable<P>]
        $($rest)*
    } };
    (hit $then:ident $($rest:tt)*) => { $then! {
        [AnyHit<P, A>, ClosestHit<P, A>]
        [RayGen<P>, Intersection<P, A>, Miss<P>, Exception<P>, DirectCallable<P>, ContinuationCallable<P>]
        $($rest)*
    } };
    (intersection $then:ident $($rest:tt)*) => { $then! {
        [Intersection<P, A>]
        [RayGen<P>, AnyHit<P, A>, ClosestHit<P, A>, Miss<P>, Exception<P>, DirectCallable<P>, ContinuationCallable<P>]
        $($rest)*
    } };
    (exception $then:ident $($rest:tt)*) => { $then! {
        [Exception<P>]
        [RayGen<P>, Intersection<P, A>, AnyHit<P, A>, ClosestHit<P, A>, Miss<P>, DirectCallable<P>, ContinuationCallable<P>]
        $($rest)*
    } };
}

/// `methods! { in GROUP { ITEMS } others { ITEMS } }`: items of the contexts in a group, and of all others.
macro_rules! methods {
    (in $group:ident $items:tt others $others:tt) => { group! { $group methods @ $items $others } };
    ([$($may:ident<P $(, $a:ident)?>),*] [$($may_not:ident<P $(, $b:ident)?>),*] @ $items:tt $others:tt) => {
        $(impl<P $(, $a)?> crate::program::$may<P $(, $a)?> $items)*
        $(impl<P $(, $b)?> crate::program::$may_not<P $(, $b)?> $others)*
    };
}

/// The names of the contexts in a group.
#[cfg(not(target_arch = "nvptx64"))]
macro_rules! contexts {
    ([$($may:ident<P $(, $a:ident)?>),*] $others:tt) => { &[$(stringify!($may)),*] };
}

/// Sections of the table; see the module.
macro_rules! device_functions {
    ($(in $group:ident else $bound:tt { $(
        $(#[$doc:meta])*
        $($optix:literal)*
        fn $name:ident(&$self:ident $(, $argument:ident: $ty:ty)*) -> $result:ty $(where $hits:ident: $kind:ident)? { $($body:tt)* }
    )* })*) => {
        $(methods! {
            in $group { $(
                $(#[$doc])*
                $(#[doc = concat!("\n\nIn OptiX `", $optix, "`.")])*
                #[inline(always)]
                pub fn $name(&$self $(, $argument: $ty)*) -> $result $(where $hits: $kind)? {
                    body! { $($body)* }
                }
            )* }
            others { $(
                #[doc(hidden)]
                pub fn $name(&self $(, _: $ty)*) -> $result where Self: crate::check::$bound {
                    unreachable!()
                }
            )* }
        })*

        /// The rows of this file.
        #[cfg(not(target_arch = "nvptx64"))]
        pub(crate) const FUNCTIONS: &[crate::intrinsics::DeviceFunction] = &[$($($(
            crate::intrinsics::DeviceFunction { optix: $optix, contexts: group! { $group contexts } },
        )*)*)*];
    };
}

/// The body of a function: that of the machine that it is compiled for, or one for both.
macro_rules! body {
    (ptx $ptx:block host $host:block) => {{
        #[cfg(target_arch = "nvptx64")]
        let result = $ptx;
        #[cfg(not(target_arch = "nvptx64"))]
        let result = $host;
        result
    }};
    ($($both:tt)*) => {{ $($both)* }};
}
