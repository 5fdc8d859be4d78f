//! How deep the nodes of a graph nest: the longest path, which may have no end.

use std::collections::{BTreeSet, VecDeque};

/// How deep nodes nest.
pub(super) enum Nesting {
    /// As deep as the longest path.
    Known(u32),
    /// The paths have no end, and this deep is stated.
    Stated(u32),
}

/// Why it can't be said how deep.
pub(super) enum NestingError {
    /// The node leads to itself, and nothing is stated.
    Endless(usize),
    /// A path that is longer than what is stated.
    Deeper(Vec<usize>, u32),
}

/// How deep nodes nest, from these. Where they nest without end, what is stated is believed, unless it is too little for a step
/// on the shortest path to it.
pub(super) fn nesting(
    leads_to: &[BTreeSet<usize>],
    from: &BTreeSet<usize>,
    stated: Option<u32>,
) -> Result<Nesting, NestingError> {
    let found = longest(leads_to, from, &mut vec![Visit::New; leads_to.len()]);
    let chain = match (&found, stated) {
        (Ok(chain), _) => chain,
        (Err(node), None) => return Err(NestingError::Endless(*node)),
        (Err(_), Some(_)) => &shortest(leads_to, from),
    };
    let depth = chain.len() as u32;
    match stated {
        Some(stated) if stated < depth => Err(NestingError::Deeper(chain.clone(), stated)),
        Some(stated) if found.is_err() => Ok(Nesting::Stated(stated)),
        _ => Ok(Nesting::Known(depth)),
    }
}

/// The path that is longest of those that lead to a step as soon as can be.
fn shortest(leads_to: &[BTreeSet<usize>], from: &BTreeSet<usize>) -> Vec<usize> {
    let mut met = BTreeSet::new();
    let mut queue: VecDeque<Vec<usize>> = from.iter().map(|&node| vec![node]).collect();
    let mut last = Vec::new();
    while let Some(path) = queue.pop_front() {
        if let Some(&node) = path.last()
            && met.insert(node)
        {
            queue.extend(leads_to[node].iter().map(|&next| [&path[..], &[next]].concat()));
        }
        // In order of their lengths.
        last = path;
    }
    last
}

/// What is known of a node.
#[derive(Clone)]
enum Visit {
    New,
    OnPath,
    /// The longest path from here, without this.
    Done(Vec<usize>),
}

/// The longest path from any of `from`; the error is a node that leads to itself.
fn longest(leads_to: &[BTreeSet<usize>], from: &BTreeSet<usize>, visits: &mut [Visit]) -> Result<Vec<usize>, usize> {
    let mut path = Vec::new();
    for &node in from {
        let below = match &visits[node] {
            Visit::OnPath => return Err(node),
            Visit::Done(below) => below.clone(),
            Visit::New => {
                visits[node] = Visit::OnPath;
                let below = longest(leads_to, &leads_to[node], visits)?;
                visits[node] = Visit::Done(below.clone());
                below
            }
        };
        if below.len() >= path.len() {
            path = [&[node], &below[..]].concat();
        }
    }
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longest_chain_of_ray_types() {
        let set = |items: &[usize]| items.iter().copied().collect::<BTreeSet<_>>();
        let path = |edges: &[&[usize]], roots: &[usize]| {
            let edges: Vec<_> = edges.iter().map(|e| set(e)).collect();
            longest(&edges, &set(roots), &mut vec![Visit::New; edges.len()]).map(|path| path.len())
        };
        assert_eq!(path(&[&[1], &[]], &[0]), Ok(2));
        assert_eq!(path(&[&[], &[]], &[0, 1]), Ok(1));
        assert_eq!(path(&[&[1], &[0]], &[0]), Err(0));
        assert_eq!(path(&[&[1], &[1]], &[]), Ok(0));
        assert_eq!(path(&[&[1, 2], &[2], &[]], &[0, 2]), Ok(3));
    }

    #[test]
    fn shortest_ways_to_each_step() {
        let set = |items: &[usize]| items.iter().copied().collect::<BTreeSet<_>>();
        let path = |edges: &[&[usize]], roots: &[usize]| {
            shortest(&edges.iter().map(|e| set(e)).collect::<Vec<_>>(), &set(roots))
        };
        assert_eq!(path(&[&[0]], &[0]), [0, 0]);
        assert_eq!(path(&[&[1], &[2], &[0]], &[0]), [0, 1, 2, 0]);
        assert_eq!(path(&[&[1, 2], &[2], &[]], &[0]), [0, 1, 2]);
        assert_eq!(path(&[&[1], &[1]], &[]), [0; 0]);
    }
}
