//! The kinds of program, and what each is called.

use crate::support::ungroup;
use quote::format_ident;
use syn::{Ident, Type};

/// The kinds of program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    RayGen,
    Miss,
    ClosestHit,
    AnyHit,
    Intersection,
    DirectCallable,
    ContinuationCallable,
    Exception,
}

impl Kind {
    pub const ALL: [Self; 8] = [
        Self::RayGen,
        Self::Miss,
        Self::ClosestHit,
        Self::AnyHit,
        Self::Intersection,
        Self::DirectCallable,
        Self::ContinuationCallable,
        Self::Exception,
    ];

    /// The attribute, and the key in `pipeline!` where that takes one program.
    pub fn attribute(self) -> &'static str {
        match self {
            Self::RayGen => "raygen",
            Self::Miss => "miss",
            Self::ClosestHit => "closesthit",
            Self::AnyHit => "anyhit",
            Self::Intersection => "intersection",
            Self::DirectCallable => "direct_callable",
            Self::ContinuationCallable => "continuation_callable",
            Self::Exception => "exception",
        }
    }

    /// The context type, and the suffix of payload parts.
    pub fn context(self) -> &'static str {
        match self {
            Self::RayGen => "RayGen",
            Self::Miss => "Miss",
            Self::ClosestHit => "ClosestHit",
            Self::AnyHit => "AnyHit",
            Self::Intersection => "Intersection",
            Self::DirectCallable => "DirectCallable",
            Self::ContinuationCallable => "ContinuationCallable",
            Self::Exception => "Exception",
        }
    }

    /// The kind whose context a type is, by name.
    pub fn of_context(ty: &Type) -> Option<Self> {
        let Type::Path(path) = ungroup(ty) else { return None };
        let last = path.path.segments.last()?;
        Self::ALL.into_iter().find(|kind| last.ident == kind.context())
    }

    /// The trait of its programs.
    pub fn program_trait(self) -> Ident {
        format_ident!("{}Program", self.context())
    }

    /// In a sentence.
    pub fn phrase(self) -> &'static str {
        match self {
            Self::RayGen => "a ray-generation program",
            Self::Miss => "a miss program",
            Self::ClosestHit => "a closest-hit program",
            Self::AnyHit => "an any-hit program",
            Self::Intersection => "an intersection program",
            Self::DirectCallable => "a direct callable",
            Self::ContinuationCallable => "a continuation callable",
            Self::Exception => "an exception program",
        }
    }

    /// Whether the context says what hits carry.
    pub fn has_hits(self) -> bool {
        matches!(self, Self::ClosestHit | Self::AnyHit | Self::Intersection)
    }

    /// Whether it runs for a ray, so that it has a part of the payload.
    pub fn has_payload(self) -> bool {
        self.has_hits() || self == Self::Miss
    }

    /// Whether its caller passes arguments and takes a result.
    pub fn is_callable(self) -> bool {
        matches!(self, Self::DirectCallable | Self::ContinuationCallable)
    }

    /// The context as an argument.
    pub fn argument_name(self) -> &'static str {
        match self {
            Self::RayGen => "rg",
            Self::Miss => "ms",
            Self::ClosestHit | Self::AnyHit => "hit",
            Self::Intersection => "isect",
            Self::DirectCallable => "dc",
            Self::ContinuationCallable => "cc",
            Self::Exception => "ex",
        }
    }

    /// The context as a user writes it.
    pub fn context_example(self) -> &'static str {
        match self {
            Self::RayGen => "&RayGen<PathTracer>",
            Self::Miss => "&Miss<PathTracer>",
            Self::ClosestHit => "&ClosestHit<PathTracer, Triangles>",
            Self::AnyHit => "&AnyHit<PathTracer, Triangles>",
            Self::Intersection => "&Intersection<PathTracer, BallHit>",
            Self::DirectCallable => "&DirectCallable<PathTracer>",
            Self::ContinuationCallable => "&ContinuationCallable<PathTracer>",
            Self::Exception => "&Exception<PathTracer>",
        }
    }

    /// A signature.
    pub fn example(self) -> &'static str {
        match self {
            Self::RayGen => "`fn camera(rg: &RayGen<PathTracer>)`",
            Self::Miss => "`fn sky(ms: &Miss<PathTracer>, record: &Sky, ray: RadianceAtMiss) -> RadianceFromMiss`",
            Self::ClosestHit => {
                "`fn lambert(hit: &ClosestHit<PathTracer, Triangles>, record: &Lambert, ray: RadianceAtClosestHit) -> \
                 RadianceFromClosestHit`"
            }
            Self::AnyHit => "`fn alpha(hit: &AnyHit<PathTracer, Triangles>, record: &Leaf) -> Decision`",
            Self::Intersection => "`fn ball(isect: &Intersection<PathTracer, BallHit>, record: &Ball)`",
            Self::DirectCallable => "`fn wood(dc: &DirectCallable<PathTracer>, record: &Wood, uv: Vec2) -> Vec3`",
            Self::ContinuationCallable => {
                "`fn mirror(cc: &ContinuationCallable<PathTracer>, record: &Mirror, point: Vec3) -> Vec3`"
            }
            Self::Exception => "`fn report(ex: &Exception<PathTracer>)`",
        }
    }

    /// What `pipeline!` knows about a program of the kind.
    pub fn known(self) -> &'static str {
        match self {
            Self::RayGen | Self::Miss | Self::DirectCallable | Self::ContinuationCallable | Self::Exception => {
                "its pipeline and nothing else"
            }
            Self::ClosestHit | Self::AnyHit => "its pipeline, what hits carry and the record",
            Self::Intersection => "its pipeline and the record",
        }
    }

    /// Arguments with all type parameters that it may have.
    pub fn generic_example(self) -> &'static str {
        match self {
            Self::RayGen => "&RayGen<P>",
            Self::Miss => "&Miss<P>",
            Self::ClosestHit => "&ClosestHit<P, A>, &R",
            Self::AnyHit => "&AnyHit<P, A>, &R",
            Self::Intersection => "&Intersection<P, BallHit>, &R",
            Self::DirectCallable => "&DirectCallable<P>",
            Self::ContinuationCallable => "&ContinuationCallable<P>",
            Self::Exception => "&Exception<P>",
        }
    }

    /// The payload parts it has.
    pub fn roles(self) -> Option<Roles> {
        let ident = |word: &str| format_ident!("{word}{}", self.context());
        self.has_payload().then(|| Roles {
            at: ident("At"),
            from: ident("From"),
            received: ident("ReceivedBy"),
            returned: ident("ReturnedBy"),
        })
    }
}

/// Names of a kind's payload parts: the associated types, and the traits of what may take their place.
pub struct Roles {
    /// `AtClosestHit`.
    pub at: Ident,
    /// `FromClosestHit`.
    pub from: Ident,
    /// `ReceivedByClosestHit`.
    pub received: Ident,
    /// `ReturnedByClosestHit`.
    pub returned: Ident,
}
