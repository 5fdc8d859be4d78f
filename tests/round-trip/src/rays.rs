//! Values through payloads: from the caller to every program of a ray and back.

use crate::Trip;
use crate::cargo::*;
use optix_device_rs::prelude::*;

/// Where a value arrives: the row of the output is `way * STATIONS + station`.
pub const STATIONS: usize = 7;
/// Ways, in the order of the pipeline's rays.
pub const WAYS: usize = 8;

/// Eight words of attributes, beside.
#[derive(Clone, Copy, Debug, PartialEq, Attributes)]
#[expect(missing_docs)]
pub struct Mark {
    pub half: u16,
    pub whole: f64,
    pub flag: bool,
    pub wide: u64,
    pub bytes: [i8; 2],
}

impl From<&Cargo> for Mark {
    fn from(cargo: &Cargo) -> Self {
        let Numbers { u16, f64, bool, u64, i8, .. } = cargo.numbers;
        Self { half: u16, whole: f64, flag: bool, wide: u64, bytes: [i8, !i8] }
    }
}

macro_rules! way {
    ($module:ident, $way:literal, $value:ty, |$cargo:ident, $world:ident| $from:expr $(, $transport:ident)?) => {
        #[expect(missing_docs)]
        pub mod $module {
            use super::*;

            /// Every party takes the value and gives it back.
            #[derive(Payload)]
            $(#[payload(transport = $transport)])?
            pub struct Ways {
                #[payload(
                    write(caller, intersection, anyhit, closesthit, miss),
                    read(caller, intersection, anyhit, closesthit, miss)
                )]
                pub value: $value,
            }

            pub fn of($cargo: &Cargo, $world: Traversable) -> $value {
                $from
            }

            const ROW: usize = $way * STATIONS;

            #[raygen]
            pub fn start(rg: &RayGen<There>) {
                let frame = rg.params();
                let value = of(&frame.cargo(), frame.world());
                frame.put(ROW, value);
                let hit = rg.trace::<Ways>(frame.world(), Ray::new(Vec3::NEG_Z * 2.0, Vec3::Z), WaysFromCaller { value });
                frame.put(ROW + 1, hit.value);
                let missed = rg.trace::<Ways>(frame.world(), Ray::new(Vec3::NEG_Z * 2.0, Vec3::X), WaysFromCaller { value });
                frame.put(ROW + 2, missed.value);
            }

            #[intersection]
            pub fn meet(isect: &Intersection<There, Mark>, record: &Cargo, ray: WaysAtIntersection) -> WaysFromIntersection {
                isect.params().put(ROW + 3, ray.value);
                isect.report(1.5, 3, record.into());
                WaysFromIntersection { value: ray.value }
            }

            #[anyhit]
            pub fn check(hit: &AnyHit<There, Mark>, ray: WaysAtAnyHit) -> (Decision, WaysFromAnyHit) {
                hit.params().put(ROW + 4, ray.value);
                (Decision::Accept, WaysFromAnyHit { value: ray.value })
            }

            #[closesthit]
            pub fn shade(hit: &ClosestHit<There, Mark>, record: &Cargo, ray: WaysAtClosestHit) -> WaysFromClosestHit {
                let frame = hit.params();
                frame.put(ROW + 5, ray.value);
                let same = hit.attributes() == record.into();
                // Not a number is not equal to itself; the words tell.
                if same || record.numbers.f64.is_nan() {
                    frame.put(ROW + 6, of(record, frame.world()));
                }
                WaysFromClosestHit { value: ray.value }
            }

            #[miss]
            pub fn pass(_: &Miss<There>, ray: WaysAtMiss) -> WaysFromMiss {
                WaysFromMiss { value: ray.value }
            }
        }
    };
}

way!(small, 0, (Numbers, Nested), |cargo, _world| (cargo.numbers, cargo.nested));
way!(floats, 1, Floats, |cargo, _world| cargo.floats);
way!(matrices, 2, Matrices, |cargo, _world| cargo.matrices);
way!(doubles, 3, Doubles, |cargo, _world| cargo.doubles);
way!(integers, 4, Integers, |cargo, _world| cargo.integers);
way!(optional, 5, Optional, |cargo, _world| cargo.into());
way!(addresses, 6, Addresses, |cargo, world| Addresses::new(cargo, world));
way!(everything, 7, Everything, |cargo, world| Everything::new(cargo, world), pointer);

pipeline! {
    /// Sends values through payloads.
    pub struct There {
        params: Trip,
        raygen: [
            small::start, floats::start, matrices::start, doubles::start,
            integers::start, optional::start, addresses::start, everything::start,
        ],
        rays: {
            small::Ways { miss: small::pass },
            floats::Ways { miss: floats::pass },
            matrices::Ways { miss: matrices::pass },
            doubles::Ways { miss: doubles::pass },
            integers::Ways { miss: integers::pass },
            optional::Ways { miss: optional::pass },
            addresses::Ways { miss: addresses::pass },
            everything::Ways { miss: everything::pass },
        },
        hitgroups: {
            Cargo on Custom => {
                small::Ways { intersection: small::meet, anyhit: small::check, closesthit: small::shade },
                floats::Ways { intersection: floats::meet, anyhit: floats::check, closesthit: floats::shade },
                matrices::Ways { intersection: matrices::meet, anyhit: matrices::check, closesthit: matrices::shade },
                doubles::Ways { intersection: doubles::meet, anyhit: doubles::check, closesthit: doubles::shade },
                integers::Ways { intersection: integers::meet, anyhit: integers::check, closesthit: integers::shade },
                optional::Ways { intersection: optional::meet, anyhit: optional::check, closesthit: optional::shade },
                addresses::Ways { intersection: addresses::meet, anyhit: addresses::check, closesthit: addresses::shade },
                everything::Ways { intersection: everything::meet, anyhit: everything::check, closesthit: everything::shade },
            },
        },
    }
}
