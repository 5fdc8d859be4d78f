//! The grammar of OptiX shaders in Rust: derives for what crosses between host and device, attributes for the kinds of
//! device program, and `pipeline!`, which ties them together.
//!
//! Use them through `optix_device_rs::prelude`. Every macro parses into a model, checks it, and then emits; mistakes are
//! collected and reported together, at the words they are in, and a declaration with a mistake still gives its users
//! what they need to compile, so that one mistake is one error.
//!
//! What they make refers to optix-device-rs, which they find under whatever name the crate has it.

mod compiler;
mod data;
mod depth;
mod element;
mod exception;
#[cfg(test)]
mod fuzz;
mod limits;
mod params;
mod payload;
mod pipeline;
mod place;
mod program;
mod record;
mod shape;
mod source;
mod support;
mod words;

use proc_macro::TokenStream;

/// Makes a struct a ray payload: who reads and who writes each field is declared once and proved at the declaration.
///
/// ```
/// use optix_device_rs::prelude::*;
///
/// #[derive(Payload)]
/// pub struct Radiance {
///     /// Set by whatever ends the ray.
///     #[payload(write(closesthit, miss), read(caller))]
///     pub light: Vec3,
///     /// Goes in, is advanced by the closest-hit program, and comes back.
///     #[payload(write(caller, closesthit), read(closesthit, caller))]
///     pub rng: Pcg32,
/// }
///
/// // What `trace` takes and returns, and what programs receive and return, are structs of their own:
/// let _ = RadianceFromCaller { rng: Pcg32::new(1, 2) };
/// fn shade(ray: RadianceAtClosestHit) -> RadianceFromClosestHit {
///     RadianceFromClosestHit { light: Vec3::ONE, rng: ray.rng }
/// }
/// assert_eq!(Radiance::WORDS, 7);
/// ```
///
/// # Grammar
/// Every field has `#[payload(write(..), read(..))]` with one party or more in each list: `caller`, `closesthit`, `miss`,
/// `anyhit`, `intersection`. For each party `X` that reads something there is a struct `..AtX`, for each that writes
/// something a struct `..FromX`; the others have `()`.
///
/// # Rules
/// A ray goes from the caller through traversal, where intersection and any-hit programs run as often as there are
/// candidates, perhaps never, to closest-hit or miss, and back to the caller. On every such path a read has a write
/// before it:
///
/// | read by | written by |
/// | --- | --- |
/// | `closesthit`, `miss`, `anyhit`, `intersection` | `caller` |
/// | `caller` | `caller`, or both `closesthit` and `miss` |
///
/// Every write has a read after it: what `closesthit` or `miss` writes the caller reads. A ray without its closest-hit program,
/// of `trace_without_closesthit`, is only for payloads whose caller writes all that it reads.
///
/// A program takes fields as they are when it begins, and what it gives is stored when it ends, after the programs that it
/// caused. So where an intersection program and the any-hit program of its reports write the same field, the intersection
/// program's value stays, on either machine: two fields keep both.
///
/// # Transport
/// The fields travel in registers, 32 words at most (guide 14), or in the caller's local memory, whose address is in two
/// registers; then there may be any number of them. Programs are the same either way.
///
/// ```
/// use optix_device_rs::prelude::*;
///
/// #[derive(Payload)]
/// #[payload(transport = pointer)] // `registers`, if nothing is said
/// pub struct Layers {
///     #[payload(write(caller, anyhit), read(anyhit, caller))]
///     pub t: [f32; 40],
/// }
/// assert_eq!((Layers::WORDS, Layers::SEMANTICS.len()), (40, 2));
/// ```
#[proc_macro_derive(Payload, attributes(payload))]
pub fn derive_payload(input: TokenStream) -> TokenStream {
    support::derive(input.into(), payload::derive).into()
}

/// Makes a struct the data of a shader-binding-table record: a material, a light, a sky.
///
/// ```
/// use optix_device_rs::prelude::*;
///
/// #[derive(Clone, Copy, SbtRecord)]
/// #[repr(C)]
/// pub struct Lambert {
///     pub albedo: Vec3,
///     pub normals: Slice<Vec3>,
/// }
///
/// // An application fills in the host counterpart, in which a buffer stands in the view's place.
/// fn paint(normals: optix_device_rs::host::Buffer<Vec3>) -> LambertHost {
///     LambertHost { albedo: Vec3::ONE, normals }
/// }
/// ```
///
/// The struct has `#[repr(C)]`, since host and device are compiled by different compilers, and is `Clone` and `Copy`. The
/// derive includes [`DeviceData`](macro@DeviceData).
///
/// # Views and twins
/// A field is a view if its type's name is `Slice`, `SliceMut`, `SliceMut2d`, `Texture1d`, `Texture2d`, `Texture2dArray`, `Texture3d`,
/// `TextureCube`, `Traversable`, `Instances`,
/// `TriangleVertices`, `Callable` or `Callables`, or an array of these. A view under another name, and a struct with views that derives `DeviceData`, needs `#[view]` on the
/// field; without it the field does not compile. A struct with views has a host counterpart, `LambertHost`, with the same fields and visibilities; one
/// without is its own. In a device build the host counterpart's name stands for a type without values, so that `pub use
/// materials::LambertHost;` needs no `#[cfg]`.
#[proc_macro_derive(SbtRecord, attributes(view))]
pub fn derive_sbt_record(input: TokenStream) -> TokenStream {
    support::derive(input.into(), record::derive).into()
}

/// Lets a struct cross from host to device: as a field of parameters, of records, and of other such structs.
///
/// ```
/// use optix_device_rs::prelude::*;
///
/// #[derive(Clone, Copy, DeviceData)]
/// #[repr(C)]
/// pub struct Pinhole {
///     pub eye: Vec3,
///     pub half_width: f32,
/// }
///
/// #[derive(Clone, Copy, DeviceData)]
/// #[repr(C)]
/// pub struct Texture {
///     pub texels: Slice<Vec4>,
///     pub width: u32,
/// }
///
/// #[derive(Clone, Copy, SbtRecord)]
/// #[repr(C)]
/// pub struct Painted {
///     #[view]
///     pub texture: Texture, // in `PaintedHost`, a `TextureHost`
/// }
/// ```
///
/// The struct has `#[repr(C)]` and is `Clone` and `Copy`. Padding is written as zeros.
#[proc_macro_derive(DeviceData, attributes(view))]
pub fn derive_device_data(input: TokenStream) -> TokenStream {
    support::derive(input.into(), data::derive).into()
}

/// Lets a struct be an element of a device buffer: `Slice<Vertex>`, `SliceMut<Vertex>`.
///
/// ```
/// use optix_device_rs::prelude::*;
///
/// #[derive(Clone, Copy, Element)]
/// #[repr(C)]
/// pub struct Vertex {
///     pub position: Vec3,
///     pub weight: f32,
/// }
/// fn first(vertices: Slice<Vertex>) -> Vec3 {
///     vertices.get(0).position
/// }
/// ```
///
/// The struct has `#[repr(C)]`, no padding (asserted when it is compiled), and only elements as fields: no views, no
/// `bool`, since any bytes must be a valid value. The derive includes [`DeviceData`](macro@DeviceData).
#[proc_macro_derive(Element)]
pub fn derive_element(input: TokenStream) -> TokenStream {
    support::derive(input.into(), element::derive).into()
}

/// Lets a struct travel in payloads and attributes, field after field.
///
/// ```
/// use optix_device_rs::prelude::*;
///
/// #[derive(Clone, Copy, Words)]
/// pub struct Spectrum {
///     pub bands: [f32; 4],
///     pub first: u16, // takes a whole word
/// }
/// assert_eq!(Spectrum::COUNT, 5);
/// ```
#[proc_macro_derive(Words)]
pub fn derive_words(input: TokenStream) -> TokenStream {
    support::derive(input.into(), words::derive_words).into()
}

/// Makes a struct what a custom primitive's hits carry: what `report` takes and `attributes()` returns.
///
/// ```
/// use optix_device_rs::prelude::*;
///
/// #[derive(Clone, Copy, Attributes)]
/// pub struct BallHit {
///     pub normal: Vec3,
/// }
/// assert_eq!(BallHit::WORDS, 3);
/// ```
///
/// The fields take 8 words at most (guide 13.4; asserted when the struct is compiled).
#[proc_macro_derive(Attributes)]
pub fn derive_attributes(input: TokenStream) -> TokenStream {
    support::derive(input.into(), words::derive_attributes).into()
}

/// Makes an enum what programs throw: a variant for each thing that goes wrong, its fields the details (guide 13.14).
///
/// ```
/// use optix_device_rs::prelude::*;
///
/// #[derive(Clone, Copy, UserException)]
/// pub enum Fault {
///     NotANumber { pixel: UVec2, light: Vec3 },
///     BadMaterial(u32),
///     Lost,
/// }
/// assert_eq!(Fault::VARIANTS[1], (1, "BadMaterial"));
///
/// fn check<P: Throws<Fault>>(rg: &RayGen<P>, material: u32) {
///     if material > 9 {
///         rg.throw(Fault::BadMaterial(material));
///     }
/// }
/// ```
///
/// Codes are the variants' discriminants, from 0 to 2^30 - 1; with fields, rustc wants `#[repr(u32)]` for discriminants of
/// one's own. A variant's fields take 8 words at most. Both are asserted when the enum is compiled.
#[proc_macro_derive(UserException)]
pub fn derive_user_exception(input: TokenStream) -> TokenStream {
    support::derive(input.into(), exception::derive).into()
}

/// Makes a struct the launch parameters: what every program of a launch sees.
///
/// ```
/// use optix_device_rs::prelude::*;
///
/// #[launch_params]
/// pub struct Frame {
///     pub film: SliceMut2d<Vec4>,
///     pub world: Traversable,
///     /// When a path ends.
///     #[bound]
///     pub max_bounces: u32,
/// }
///
/// // Programs read field by field: each is a load from constant memory at a fixed address.
/// #[raygen]
/// fn clear<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
///     rg.params().film().set(rg.launch_index().xy(), Vec4::ZERO);
/// }
///
/// // What the host may bind to a constant when it builds the pipeline:
/// assert_eq!(Frame::MAX_BOUNCES.field().offset, 24);
/// ```
///
/// The attribute adds `#[repr(C)]`, `Clone` and `Copy`. Write it above any `#[derive(..)]`, at the level of a module. Its
/// fields have no `#[cfg(..)]`: host and device see the same ones.
/// `Frame` gets:
/// - a view, `FrameView`, with a method for each field: what `params()` returns in a program;
/// - a host counterpart, `FrameHost`, if it has views (see [`SbtRecord`](macro@SbtRecord)): what a launch takes;
/// - for each field with `#[bound]` a constant, `Frame::MAX_BOUNCES`, that names it with its type.
#[proc_macro_attribute]
pub fn launch_params(arguments: TokenStream, item: TokenStream) -> TokenStream {
    params::expand(arguments.into(), item.into()).into()
}

/// Makes a function a ray-generation program, where a launch begins: one call for each launch index.
///
/// ```
/// use optix_device_rs::prelude::*;
/// # #[launch_params] pub struct Frame { pub film: SliceMut2d<Vec4> }
///
/// #[raygen]
/// fn clear<P: Pipeline<Params = Frame>>(rg: &RayGen<P>) {
///     rg.params().film().set(rg.launch_index().xy(), Vec4::ZERO);
/// }
/// ```
///
/// # Programs
/// What a program may read are its arguments, what it must write is its return value:
///
/// | attribute | context | may take | returns |
/// | --- | --- | --- | --- |
/// | `#[raygen]` | `&RayGen<P>` | `record: &R` | nothing |
/// | `#[miss]` | `&Miss<P>` | `record: &R`, then `ray: XAtMiss` | `XFromMiss` or nothing |
/// | `#[closesthit]` | `&ClosestHit<P, A>` | `record: &R`, then `ray: XAtClosestHit` | `XFromClosestHit` or nothing |
/// | `#[anyhit]` | `&AnyHit<P, A>` | `record: &R`, then `ray: XAtAnyHit` | `Decision` or `(Decision, XFromAnyHit)` |
/// | `#[intersection]` | `&Intersection<P, A>` | `record: &R`, then `ray: XAtIntersection` | `XFromIntersection` or nothing |
/// | `#[direct_callable]` | `&DirectCallable<P>` | `record: &R`, then what its caller passes | what its caller takes |
/// | `#[continuation_callable]` | `&ContinuationCallable<P>` | the same | the same |
/// | `#[exception]` | `&Exception<P>` | `record: &R` | nothing |
///
/// The context comes first. A program that leaves out the record serves all materials; one that leaves out the payload
/// serves all ray types whose payload asks nothing of it. Pipeline `P`, hits `A` and record `R` may be type parameters, so
/// that a library of programs serves other people's pipelines.
///
/// What `pipeline!` can't tell, a program can't leave open: a ray-generation or miss program has a record of its own, so `R`
/// is a type there, and an intersection program says what hits carry, so `A` is. A program does not call itself (OptiX has
/// no recursive functions; a helper that calls back is found in the PTX). A `#[cfg(..)]` on the function holds for all that
/// is made of it; its arguments have none.
///
/// The function stays as it is. Beside it there is a type of the same name, by which `pipeline!` knows the program: where
/// a program is imported by name, both come.
#[proc_macro_attribute]
pub fn raygen(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::RayGen, arguments.into(), item.into()).into()
}

/// Makes a function a miss program: it runs when a ray hits nothing.
///
/// ```
/// use optix_device_rs::prelude::*;
/// # #[derive(Payload)] pub struct Radiance { #[payload(write(closesthit, miss), read(caller))] pub light: Vec3 }
///
/// #[derive(Clone, Copy, SbtRecord)]
/// #[repr(C)]
/// pub struct Sky {
///     pub zenith: Vec3,
/// }
///
/// #[miss]
/// fn sky<P: Pipeline>(ms: &Miss<P>, record: &Sky) -> RadianceFromMiss {
///     RadianceFromMiss { light: record.zenith * ms.world_ray_direction().y }
/// }
/// ```
///
/// [`raygen`](macro@raygen) says what arguments and results programs have.
#[proc_macro_attribute]
pub fn miss(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::Miss, arguments.into(), item.into()).into()
}

/// Makes a function a closest-hit program: it shades the nearest accepted hit and may trace further rays.
///
/// ```
/// use optix_device_rs::prelude::*;
/// # #[derive(Payload)] pub struct Radiance { #[payload(write(closesthit, miss), read(caller))] pub light: Vec3 }
/// # #[derive(Clone, Copy, SbtRecord)] #[repr(C)] pub struct Paint { pub colour: Vec3 }
///
/// #[closesthit]
/// fn paint<P: Pipeline>(_: &ClosestHit<P, Triangles>, record: &Paint) -> RadianceFromClosestHit {
///     RadianceFromClosestHit { light: record.colour }
/// }
/// ```
///
/// [`raygen`](macro@raygen) says what arguments and results programs have.
#[proc_macro_attribute]
pub fn closesthit(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::ClosestHit, arguments.into(), item.into()).into()
}

/// Makes a function an any-hit program: it decides about a candidate hit.
///
/// ```
/// use optix_device_rs::prelude::*;
/// # #[derive(Clone, Copy, SbtRecord)] #[repr(C)] pub struct Leaf { pub opacity: f32 }
///
/// #[anyhit]
/// fn alpha<P: Pipeline>(hit: &AnyHit<P, Triangles>, record: &Leaf) -> Decision {
///     if hit.barycentrics().x > record.opacity { Decision::Ignore } else { Decision::Accept }
/// }
/// ```
///
/// [`raygen`](macro@raygen) says what arguments and results programs have.
#[proc_macro_attribute]
pub fn anyhit(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::AnyHit, arguments.into(), item.into()).into()
}

/// Makes a function an intersection program: it finds the hits of a ray with a custom primitive.
///
/// ```
/// use optix_device_rs::prelude::*;
/// # #[derive(Clone, Copy, SbtRecord)] #[repr(C)] pub struct Plane { pub height: f32 }
///
/// #[derive(Clone, Copy, Attributes)]
/// pub struct PlaneHit {
///     pub up: Vec3,
/// }
///
/// #[intersection]
/// fn plane<P: Pipeline>(isect: &Intersection<P, PlaneHit>, record: &Plane) {
///     let t = (record.height - isect.object_ray_origin().y) / isect.object_ray_direction().y;
///     isect.report(t, 0, PlaneHit { up: Vec3::Y });
/// }
/// ```
///
/// [`raygen`](macro@raygen) says what arguments and results programs have.
#[proc_macro_attribute]
pub fn intersection(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::Intersection, arguments.into(), item.into()).into()
}

/// Makes a function a direct callable: programs call it through a [`Callable`], chosen while they run (guide 15).
///
/// ```
/// use optix_device_rs::prelude::*;
///
/// #[derive(Clone, Copy, SbtRecord)]
/// #[repr(C)]
/// pub struct Stripes {
///     pub width: f32,
/// }
///
/// #[direct_callable]
/// fn stripes<P: Pipeline>(_: &DirectCallable<P>, record: &Stripes, uv: Vec2) -> Vec3 {
///     if (uv.x / record.width).fract() < 0.5 { Vec3::ONE } else { Vec3::ZERO }
/// }
///
/// // A material that has some texture, and does not know which:
/// #[derive(Clone, Copy, SbtRecord)]
/// #[repr(C)]
/// pub struct Painted {
///     pub texture: Callable<fn(Vec2) -> Vec3>,
/// }
/// fn colour<P: Pipeline>(hit: &ClosestHit<P, Triangles>, record: &Painted) -> Vec3 {
///     record.texture.call(hit, hit.barycentrics())
/// }
/// ```
///
/// Arguments and result travel in registers: they are by value, of types that are `Words`, with 32 words each at most. A
/// direct callable traces no rays, and what it calls doesn't either: its context has no `trace`.
/// [`raygen`](macro@raygen) says what else holds for programs.
///
/// [`Callable`]: https://docs.rs/optix-device-rs/latest/optix_device_rs/callable/struct.Callable.html
#[proc_macro_attribute]
pub fn direct_callable(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::DirectCallable, arguments.into(), item.into()).into()
}

/// Makes a function a continuation callable: as a [direct one](macro@direct_callable), but it may trace rays (guide 15).
///
/// ```
/// use optix_device_rs::prelude::*;
/// # #[launch_params] pub struct Frame { pub world: Traversable }
/// # #[derive(Payload)] pub struct Radiance { #[payload(write(closesthit, miss), read(caller))] pub light: Vec3 }
///
/// #[continuation_callable]
/// fn mirror<P>(cc: &ContinuationCallable<P>, point: Vec3, direction: Vec3) -> Vec3
/// where
///     P: HasRay<Radiance> + Pipeline<Params = Frame>,
/// {
///     cc.trace::<Radiance>(cc.params().world(), Ray::new(point, direction), ()).light
/// }
///
/// // Its reference says so, and only programs that may trace can call it:
/// fn shade<P>(hit: &ClosestHit<P, Triangles>, how: Callable<fn(Vec3, Vec3) -> Vec3, Continuation>) -> Vec3 {
///     how.call(hit, hit.world_ray_origin(), -hit.world_ray_direction())
/// }
/// ```
///
/// A call costs more than a direct one, with what lives across it: shader networks do better to trace outside of their
/// nodes (guide 15.1).
#[proc_macro_attribute]
pub fn continuation_callable(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::ContinuationCallable, arguments.into(), item.into()).into()
}

/// Makes a function the exception program: it is told why a launch index ended (guide 13.14).
///
/// ```
/// use optix_device_rs::prelude::*;
/// # #[launch_params] pub struct Frame { pub film: SliceMut2d<Vec4> }
///
/// #[exception]
/// fn report<P: Pipeline<Params = Frame>>(ex: &Exception<P>) {
///     let colour = match ex.raised() {
///         Raised::StackOverflow | Raised::TraceDepthExceeded => Vec4::X,
///         _ => Vec4::Y,
///     };
///     ex.params().film().set(ex.launch_index().xy(), colour);
/// }
/// ```
///
/// It calls, traces and throws nothing. [`raygen`](macro@raygen) says what else holds for programs.
#[proc_macro_attribute]
pub fn exception(arguments: TokenStream, item: TokenStream) -> TokenStream {
    program::expand(program::Kind::Exception, arguments.into(), item.into()).into()
}

/// Declares a pipeline: a type from which record types, SBT offsets and strides, payload types, entry points and
/// attribute counts follow, on both machines.
///
/// ```
/// # use optix_device_rs::prelude::*;
/// # #[launch_params] pub struct Frame { pub film: SliceMut2d<Vec4> }
/// # #[derive(Payload)] pub struct Radiance { #[payload(write(closesthit, miss), read(caller))] pub light: Vec3 }
/// # #[derive(Payload)] pub struct Shadow { #[payload(write(caller, miss), read(caller))] pub visible: bool }
/// # #[derive(Clone, Copy, SbtRecord)] #[repr(C)] pub struct Lambert { pub albedo: Vec3 }
/// # #[derive(Clone, Copy, SbtRecord)] #[repr(C)] pub struct Ball { pub sphere: Vec4 }
/// # #[derive(Clone, Copy, Attributes)] pub struct BallHit { pub normal: Vec3 }
/// # #[raygen] fn camera(_: &RayGen<PathTracer>) {}
/// # #[miss] fn sky(_: &Miss<PathTracer>) -> RadianceFromMiss { RadianceFromMiss { light: Vec3::ONE } }
/// # #[miss] fn lit(_: &Miss<PathTracer>) -> ShadowFromMiss { ShadowFromMiss { visible: true } }
/// # #[closesthit] fn lambert(_: &ClosestHit<PathTracer, Triangles>, record: &Lambert) -> RadianceFromClosestHit {
/// #     RadianceFromClosestHit { light: record.albedo }
/// # }
/// # #[closesthit] fn ball_shade(hit: &ClosestHit<PathTracer, BallHit>) -> RadianceFromClosestHit {
/// #     RadianceFromClosestHit { light: hit.attributes().normal }
/// # }
/// # #[intersection] fn ball(_: &Intersection<PathTracer, BallHit>, _: &Ball) {}
/// pipeline! {
///     /// A path tracer.
///     pub struct PathTracer {
///         params: Frame,
///         raygen: [camera],
///         rays: { Radiance { miss: sky }, Shadow { miss: lit } },
///         hitgroups: {
///             Lambert on Triangles => { Radiance { closesthit: lambert }, Shadow {} },
///             Ball on Custom => { Radiance { intersection: ball, closesthit: ball_shade }, Shadow { intersection: ball } },
///         },
///     }
/// }
/// # fn main() {
/// assert_eq!(PathTracer::RAY_TYPES, 2);
/// # }
/// ```
///
/// # Grammar
/// - `params: Type`: a struct with [`launch_params`](macro@launch_params).
/// - `raygen: [program, ..]`: one at least.
/// - `rays: { Payload { miss: program }, .. }`: at most 8 (guide 14). A ray type is named by its payload; `miss` may be left
///   out where the payload asks nothing of it.
/// - `hitgroups: { Record on Geometry => { Payload { closesthit: program, anyhit: program, intersection: program }, .. }, .. }`:
///   a material, named by its record, on `Triangles` or `Custom`. Each names every ray type, with `{}` for those it has no
///   programs for. Custom geometry has an intersection program for every ray type, all reporting the same attributes; a
///   closest-hit program may be left out where the payload asks nothing of it.
/// - `direct_callables: [program, ..]`, `continuation_callables: [program, ..]`, optional: the callables. A scene makes any
///   number of records of each.
/// - `throws: Enum`, optional: what programs may throw, an enum with [`UserException`](macro@UserException).
/// - `exception: program`, optional: the program that is told of exceptions. Without it, but with `throws`, the first five
///   exceptions of a launch are printed by OptiX, and are messages of the CPU's device.
/// - `callable_depth: N`, 1 to 31, optional: the most callables that run one inside of the other. It follows from the programs
///   and their signatures, unless a callable can come to be called inside of itself.
/// - `trace_depth: N`, 0 to 31, optional: how deep trace calls nest. It follows from the programs, unless rays lead to more of their
///   type, as in a path tracer that recurses. More than the programs need is taken as it is.
///
///   Where the pipeline is built with its PTX, a depth that is less than what the programs need is an error that names the chain of
///   programs. Without PTX, on the CPU, a launch ends where its programs nest deeper.
///
/// A program is the path of a function with its kind's attribute, without type arguments. "Expected type, found function" is
/// what rustc says of one without the attribute.
#[proc_macro]
pub fn pipeline(input: TokenStream) -> TokenStream {
    pipeline::expand(input.into()).into()
}
