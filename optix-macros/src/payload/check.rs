//! The proof that every read has a write before it, on every path of a ray, and that every write has a read after it.
//!
//! A ray goes from the caller through traversal, where intersection and any-hit programs run as often as there are
//! candidates, perhaps never, to the closest-hit program or the miss program, and back to the caller. So what the caller
//! writes is there for everyone; what traversal writes is there for certain only if something was there before; and the
//! caller gets what both closest-hit and miss write.

use super::model::{Access, Party, Payload};
use crate::support::Errors;
use proc_macro2::Span;
use syn::Error;

pub fn check(payload: &Payload, errors: &mut Errors) {
    for (field, access) in payload.shape.fields.iter().zip(&payload.access) {
        if access.complete {
            reads(&field.name(), access, errors);
            writes(&field.name(), access, errors);
        }
    }
}

/// Every read has a write before it.
fn reads(name: &str, access: &Access, errors: &mut Errors) {
    let written = |party| access.write.has(party);
    if written(Party::Caller) {
        return;
    }
    let mut error = |span: Span, text: String| errors.push(Error::new(span, text));
    for &(party, span) in &access.read.0 {
        match party {
            Party::Caller => {
                let (hit, miss) = (written(Party::ClosestHit), written(Party::Miss));
                let (when, who) = match (hit, miss) {
                    (true, true) => continue,
                    (true, false) => ("when the ray misses", "`miss`"),
                    (false, true) => ("when the ray hits", "`closesthit`"),
                    (false, false) => ("when the ray ends", "`closesthit` and `miss`"),
                };
                let traversal = [Party::Intersection, Party::AnyHit].into_iter().find(|p| written(*p));
                let why = match traversal {
                    Some(party) => format!(" (`{}` does not run for every ray)", party.keyword()),
                    None => String::new(),
                };
                error(
                    span,
                    format!(
                        "the caller reads `{name}`, but {when} nobody has written it{why}\n\nhelp: add {who} to \
                         `write(..)`, or `caller` to give it a value before the ray"
                    ),
                );
            }
            Party::ClosestHit | Party::Miss => {
                let traversal = [Party::Intersection, Party::AnyHit].into_iter().find(|p| written(*p));
                let why = match traversal {
                    Some(writer) => {
                        format!(": `{}` does not run for every ray that comes to {}", writer.keyword(), party.phrase())
                    }
                    None => ": only the caller comes before it on every path".to_owned(),
                };
                error(
                    span,
                    format!(
                        "{} reads `{name}`, but nobody has written it for certain by then{why}\n\nhelp: add `caller` to \
                         `write(..)`, to give it a value before the ray",
                        party.phrase()
                    ),
                );
            }
            Party::AnyHit | Party::Intersection => error(
                span,
                format!(
                    "{} reads `{name}`, but when it first runs nobody has written it\n\nhelp: add `caller` to \
                     `write(..)`, to give it a value before the ray",
                    party.phrase()
                ),
            ),
        }
    }
}

/// Every write has a read after it.
fn writes(name: &str, access: &Access, errors: &mut Errors) {
    for &(party, span) in &access.write.0 {
        // Only the caller comes after the last program of a ray.
        if matches!(party, Party::ClosestHit | Party::Miss) && !access.read.has(Party::Caller) {
            errors.push(Error::new(
                span,
                format!(
                    "what {} writes to `{name}` is lost: only the caller comes after it, and the caller does not read \
                     it\n\nhelp: add `caller` to `read(..)`, or take `{}` out of `write(..)`",
                    party.phrase(),
                    party.keyword()
                ),
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::model::Parties;
    use super::*;

    /// Runs every path of a ray with up to three candidates; says whether a read finds nothing written.
    fn unwritten(read: &[Party], write: &[Party]) -> bool {
        let mut traversals: Vec<Vec<Party>> = vec![vec![]];
        for _ in 0..3 {
            let longer = traversals
                .clone()
                .into_iter()
                .flat_map(|t| [Party::Intersection, Party::AnyHit].map(|party| [t.as_slice(), &[party]].concat()));
            traversals.extend(longer.collect::<Vec<_>>());
        }
        let ends = [Party::ClosestHit, Party::Miss];
        traversals.iter().flat_map(|t| ends.map(|end| [t.as_slice(), &[end, Party::Caller]].concat())).any(|path| {
            let mut written = write.contains(&Party::Caller);
            path.into_iter().any(|party| {
                let fails = read.contains(&party) && !written;
                written |= write.contains(&party);
                fails
            })
        })
    }

    fn subsets() -> impl Iterator<Item = Vec<Party>> {
        (1..32u32).map(|bits| {
            Party::ALL.into_iter().enumerate().filter(|(i, _)| bits >> i & 1 == 1).map(|(_, p)| p).collect()
        })
    }

    #[test]
    fn the_proof_agrees_with_running_every_path() {
        for read in subsets() {
            for write in subsets() {
                let parties = |list: &[Party]| Parties(list.iter().map(|p| (*p, Span::call_site())).collect());
                let access = Access { read: parties(&read), write: parties(&write), complete: true };
                let mut errors = Errors::default();
                reads("field", &access, &mut errors);
                assert_eq!(!errors.is_empty(), unwritten(&read, &write), "read {read:?}, write {write:?}");

                let mut errors = Errors::default();
                writes("field", &access, &mut errors);
                let last = write.contains(&Party::ClosestHit) || write.contains(&Party::Miss);
                assert_eq!(!errors.is_empty(), last && !read.contains(&Party::Caller));
            }
        }
    }
}
