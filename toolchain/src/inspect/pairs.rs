//! Finds which programs of two builds are the same program.

use super::Program;

/// Pairs the programs of two builds by name. A program without a partner comes alone, those of the second build last.
///
/// The name of a Rust entry consists of pipeline, path and a hash, as in
/// `__closesthit__Tracer_lambert_Radiance_7f36cb79`, and changes with any of them; a person writes
/// `__closesthit__lambert`. So programs with different names are also paired if the words of one name are among those
/// of the other, and this holds for no other program of that kind.
pub fn pairs<'a>(ours: &'a [Program], theirs: &'a [Program]) -> Vec<(Option<&'a Program>, Option<&'a Program>)> {
    let exact = |one: &Program, among: &'a [Program]| among.iter().find(|other| other.name == one.name);
    let left = |of: &'a [Program], others| of.iter().filter(|one| exact(one, others).is_none()).collect::<Vec<_>>();
    let (ours_left, theirs_left) = (left(ours, theirs), left(theirs, ours));
    let alike = |one: &Program| {
        let partner = only(theirs_left.iter().filter(|other| is_alike(&one.name, &other.name)))?;
        only(ours_left.iter().filter(|other| is_alike(&partner.name, &other.name))).map(|_| *partner)
    };
    let partner = |one: &Program| exact(one, theirs).or_else(|| alike(one));
    let mut pairs: Vec<_> = ours.iter().map(|one| (Some(one), partner(one))).collect();
    let taken: Vec<&str> = pairs.iter().filter_map(|(_, partner)| Some(partner.as_ref()?.name.as_str())).collect();
    let alone = theirs.iter().filter(|one| !taken.contains(&one.name.as_str()));
    let alone: Vec<_> = alone.map(|one| (None, Some(one))).collect();
    pairs.extend(alone);
    pairs
}

/// The item, if it is the only one.
fn only<T>(mut items: impl Iterator<Item = T>) -> Option<T> {
    let first = items.next()?;
    items.next().is_none().then_some(first)
}

/// Whether both names begin with the same prefix, such as `__miss__`, and the further words of one are among those of
/// the other.
fn is_alike(a: &str, b: &str) -> bool {
    let words = |name: &'_ str| -> Option<(String, Vec<String>)> {
        let (kind, rest) = name.strip_prefix("__")?.split_once("__")?;
        Some((kind.into(), rest.split('_').map(String::from).collect()))
    };
    let (Some((kind, a)), Some((other_kind, b))) = (words(a), words(b)) else { return false };
    let within = |few: &[String], many: &[String]| few.iter().all(|word| many.contains(word));
    kind == other_kind && (within(&a, &b) || within(&b, &a))
}
