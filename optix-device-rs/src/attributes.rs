//! What a hit carries from intersection to closest-hit and any-hit programs (guide 13.4).

use crate::layout::Layout;
use crate::sealed::Sealed;
use crate::words::Words;

/// The attributes of a kind of hit: what `report` takes and what closest-hit and any-hit programs of that geometry read.
///
/// [`Triangles`] is the built-in kind; a struct with `#[derive(Attributes)]` is one for custom primitives.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a kind of hit",
    label = "expected `Triangles` or a struct with `#[derive(Attributes)]`"
)]
pub trait Attributes: Copy + 'static {
    /// The name, for messages.
    const NAME: &'static str;
    /// Attribute words, 0 to 8.
    const WORDS: usize;
    /// How they are made up.
    #[doc(hidden)]
    const LAYOUT: Layout = Layout::of("attributes").number(Self::WORDS);
    /// Reads the attributes from their words.
    ///
    /// # Safety
    /// [`Attributes::store`] of the same type wrote the words.
    unsafe fn load(words: &[u32]) -> Self;
    /// Writes the attributes to their words.
    fn store(self, words: &mut [u32]);
}

/// Attributes that an intersection program may report: those of custom primitives, by `#[derive(Attributes)]`.
///
/// [`Triangles`] are not among them. Closest-hit and any-hit programs of such hits ask for vertices and faces, which custom
/// primitives do not have (guide 13.9).
///
/// # Safety
/// No trait of built-in primitives, as [`OnTriangles`](crate::check::OnTriangles), is implemented for them.
#[diagnostic::on_unimplemented(
    message = "an intersection program can't report hits that carry `{Self}`",
    label = "expected attributes of a custom primitive, a struct with `#[derive(Attributes)]`",
    note = "`Triangles` are hits on built-in triangles, whose vertices a closest-hit program may ask for: declare attributes of your own, `#[derive(Clone, Copy, Attributes)] pub struct BallHit {{ pub uv: Vec2 }}`, and name them in the context, `&Intersection<PathTracer, BallHit>`"
)]
pub unsafe trait Reported: Attributes {}

/// A hit on a built-in triangle; its attributes are the barycentrics.
///
/// The hit point is `(1 - u - v) * p0 + u * p1 + v * p2` (guide 13.4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangles {
    /// Weight of the second vertex, 0 to 1.
    pub u: f32,
    /// Weight of the third vertex, 0 to 1.
    pub v: f32,
}

impl Attributes for Triangles {
    const NAME: &'static str = "Triangles";
    const WORDS: usize = 2;
    #[inline(always)]
    unsafe fn load(words: &[u32]) -> Self {
        // SAFETY: two numbers were stored, or a backend wrote their bits.
        let [u, v] = unsafe { Words::load(words) };
        Self { u, v }
    }
    #[inline(always)]
    fn store(self, words: &mut [u32]) {
        [self.u, self.v].store(words);
    }
}

/// A geometry kind as `pipeline!` names it after `on`.
pub trait Geometry: Sealed + 'static {
    /// Which of the kinds it is.
    const KIND: GeometryKind;
}

/// Primitives whose intersection program the user writes.
#[derive(Clone, Copy, Debug)]
pub enum Custom {}

impl Sealed for Triangles {}
impl Sealed for Custom {}
impl Geometry for Triangles {
    const KIND: GeometryKind = GeometryKind::Triangles;
}

impl Geometry for Custom {
    const KIND: GeometryKind = GeometryKind::Custom;
}

/// The kinds of geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GeometryKind {
    /// Built-in triangles.
    Triangles,
    /// Boxes with a user's intersection program.
    Custom,
}
