//! Stack sizes: pure functions that compute what a pipeline is given from what its programs need (guide 6.8), and what traversal
//! needs besides (measured).
//!
//! All sizes are bytes. A sum beyond `u32` saturates; the driver refuses such a size.

/// Stack use of one program group, or the maximum over several. A field is 0 where there is no such program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GroupStack {
    /// Continuation stack of the ray-generation program.
    pub css_rg: u32,
    /// Continuation stack of the miss program.
    pub css_ms: u32,
    /// Continuation stack of the closest-hit program.
    pub css_ch: u32,
    /// Continuation stack of the any-hit program.
    pub css_ah: u32,
    /// Continuation stack of the intersection program.
    pub css_is: u32,
    /// Continuation stack of the continuation callable.
    pub css_cc: u32,
    /// Direct stack of the direct callable.
    pub dss_dc: u32,
}

impl GroupStack {
    /// The maximum of each field.
    pub fn max(self, other: Self) -> Self {
        Self {
            css_rg: self.css_rg.max(other.css_rg),
            css_ms: self.css_ms.max(other.css_ms),
            css_ch: self.css_ch.max(other.css_ch),
            css_ah: self.css_ah.max(other.css_ah),
            css_is: self.css_is.max(other.css_is),
            css_cc: self.css_cc.max(other.css_cc),
            dss_dc: self.dss_dc.max(other.dss_dc),
        }
    }
}

impl FromIterator<GroupStack> for GroupStack {
    /// The maximum over groups.
    fn from_iter<I: IntoIterator<Item = GroupStack>>(groups: I) -> Self {
        groups.into_iter().fold(Self::default(), Self::max)
    }
}

/// How deep calls nest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CallDepths {
    /// Recursive traces; 0 when no program traces.
    pub trace: u32,
    /// Continuation callables calling each other.
    pub continuation_callables: u32,
    /// Direct callables below any-hit and intersection programs.
    pub direct_callables_from_traversal: u32,
    /// Direct callables below ray-generation, miss and closest-hit programs.
    pub direct_callables_from_state: u32,
}

/// The stack sizes of a pipeline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StackSizes {
    /// Direct stack of callables called from any-hit and intersection programs.
    pub direct_from_traversal: u32,
    /// Direct stack of callables called from ray-generation, miss and closest-hit programs.
    pub direct_from_state: u32,
    /// Continuation stack.
    pub continuation: u32,
}

/// An upper bound for any pipeline of these programs: at every trace level the larger of the closest-hit and miss
/// programs, and one intersection and any-hit program besides.
pub fn conservative(max: GroupStack, depths: CallDepths) -> StackSizes {
    let tree = css_cc_tree(&[(depths.continuation_callables, max.css_cc)]);
    let state = max.css_ch.max(max.css_ms).saturating_add(tree);
    let continuation = max
        .css_rg
        .saturating_add(tree)
        .saturating_add(depths.trace.saturating_mul(state))
        .saturating_add(max.css_is)
        .saturating_add(max.css_ah);
    with_direct(max.dss_dc, max.dss_dc, depths, continuation)
}

/// A smaller bound: intersection and any-hit run at the deepest level only while no closest-hit or miss program
/// does, so the larger of the two counts there.
pub fn compute(max: GroupStack, depths: CallDepths) -> StackSizes {
    let tree = css_cc_tree(&[(depths.continuation_callables, max.css_cc)]);
    with_direct(max.dss_dc, max.dss_dc, depths, continuation(max, tree, depths.trace))
}

/// As [`compute`], when the direct callables reached from traversal and those reached from state are known.
pub fn compute_split(max: GroupStack, dss_from_traversal: u32, dss_from_state: u32, depths: CallDepths) -> StackSizes {
    let tree = css_cc_tree(&[(depths.continuation_callables, max.css_cc)]);
    with_direct(dss_from_traversal, dss_from_state, depths, continuation(max, tree, depths.trace))
}

/// As [`compute`], when the stack of the largest tree of continuation callables is known ([`css_cc_tree`]).
pub fn compute_with_tree(max: GroupStack, css_cc_tree: u32, depths: CallDepths) -> StackSizes {
    with_direct(max.dss_dc, max.dss_dc, depths, continuation(max, css_cc_tree, depths.trace))
}

/// The stack of the largest tree of continuation callables, given depth and size of each kind of tree.
pub fn css_cc_tree(trees: &[(u32, u32)]) -> u32 {
    trees.iter().map(|&(depth, css)| depth.saturating_mul(css)).max().unwrap_or(0)
}

/// What the continuation stack needs beyond the programs' own use on a GPU whose ray-tracing cores have this version
/// ([`Limits::rt_core_version`](super::Limits::rt_core_version)), for graphs of this depth.
///
/// Without ray-tracing cores the driver walks structures by a program, whose own stack is too small for structures of many
/// levels, as geometry over many scales makes them: it overwrites what lies beside it, silently, and that is the free end of the
/// continuation stack. Validation mode reports it as an internal traversal stack overflow, however much is free. The guide does
/// not mention it. By measurement (docs/measurements.md) one level takes up to 1,024 bytes over 60 powers of two, and levels of
/// instances add up; this is twice that for the first level. With ray-tracing cores nothing of the kind was measured, nor could be.
pub fn traversal_reserve(rt_core_version: u32, graph_depth: u32) -> u32 {
    if rt_core_version > 0 { 0 } else { graph_depth.saturating_add(1).saturating_mul(1024) }
}

/// A path tracer without callables: the ray-generation program traces camera rays, whose closest-hit program
/// traces shadow rays, whose programs trace nothing. `camera` and `shadow` hold the maxima of each ray type's programs.
pub fn simple_path_tracer(css_rg: u32, camera: GroupStack, shadow: GroupStack) -> StackSizes {
    let shadow_level = shadow.css_ms.max(shadow.css_ch).max(traversal(shadow));
    let camera_level = camera.css_ms.max(camera.css_ch.saturating_add(shadow_level)).max(traversal(camera));
    StackSizes { continuation: css_rg.saturating_add(camera_level), ..StackSizes::default() }
}

fn traversal(max: GroupStack) -> u32 {
    max.css_is.saturating_add(max.css_ah)
}

fn continuation(max: GroupStack, css_cc_tree: u32, trace_depth: u32) -> u32 {
    let state = max.css_ch.max(max.css_ms).saturating_add(css_cc_tree);
    let deepest = if trace_depth > 0 { state.max(traversal(max)) } else { 0 };
    max.css_rg
        .saturating_add(css_cc_tree)
        .saturating_add(trace_depth.saturating_sub(1).saturating_mul(state))
        .saturating_add(deepest)
}

fn with_direct(from_traversal: u32, from_state: u32, depths: CallDepths, continuation: u32) -> StackSizes {
    StackSizes {
        direct_from_traversal: depths.direct_callables_from_traversal.saturating_mul(from_traversal),
        direct_from_state: depths.direct_callables_from_state.saturating_mul(from_state),
        continuation,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAX: GroupStack =
        GroupStack { css_rg: 100, css_ms: 30, css_ch: 50, css_ah: 20, css_is: 40, css_cc: 7, dss_dc: 11 };
    const DEPTHS: CallDepths = CallDepths {
        trace: 3,
        continuation_callables: 2,
        direct_callables_from_traversal: 1,
        direct_callables_from_state: 4,
    };

    #[test]
    fn conservative_follows_the_guide() {
        // 100 + 14 + 3 * (50 + 14) + 40 + 20
        let sizes = conservative(MAX, DEPTHS);
        assert_eq!(sizes, StackSizes { direct_from_traversal: 11, direct_from_state: 44, continuation: 366 });
    }

    #[test]
    fn the_better_bound_follows_the_guide() {
        // 100 + 14 + 2 * 64 + max(64, 60)
        assert_eq!(compute(MAX, DEPTHS).continuation, 306);
        // A larger traversal decides the deepest level: 100 + 14 + 2 * 64 + (90 + 20)
        assert_eq!(compute(GroupStack { css_is: 90, ..MAX }, DEPTHS).continuation, 352);
        // Without traces only ray generation and its callables count.
        assert_eq!(compute(MAX, CallDepths { trace: 0, ..DEPTHS }).continuation, 114);
        assert_eq!(compute(MAX, CallDepths { trace: 1, ..DEPTHS }).continuation, 178);
    }

    #[test]
    fn traversal_by_a_program_has_a_reserve() {
        assert_eq!([1, 2, u32::MAX].map(|depth| traversal_reserve(0, depth)), [2048, 3072, u32::MAX]);
        assert_eq!(traversal_reserve(20, 2), 0);
    }

    #[test]
    fn the_better_bound_is_never_above_the_conservative_one() {
        for trace in 0..=31 {
            for css_is in [0, 1, 40, 500] {
                let max = GroupStack { css_is, ..MAX };
                let depths = CallDepths { trace, ..DEPTHS };
                assert!(compute(max, depths).continuation <= conservative(max, depths).continuation);
            }
        }
    }

    #[test]
    fn direct_callables_are_split_by_where_they_are_called() {
        let sizes = compute_split(MAX, 5, 9, DEPTHS);
        assert_eq!((sizes.direct_from_traversal, sizes.direct_from_state), (5, 36));
        assert_eq!(sizes.continuation, compute(MAX, DEPTHS).continuation);
    }

    #[test]
    fn the_largest_tree_of_callables_counts() {
        assert_eq!(css_cc_tree(&[(3, 10), (2, 16)]), 32);
        assert_eq!(css_cc_tree(&[]), 0);
        assert_eq!(compute_with_tree(MAX, 14, DEPTHS), compute(MAX, DEPTHS));
    }

    #[test]
    fn a_path_tracer_takes_camera_and_shadow_levels_one_above_the_other() {
        let camera = GroupStack { css_ms: 30, css_ch: 50, ..Default::default() };
        let shadow = GroupStack { css_ms: 8, css_ch: 12, ..Default::default() };
        assert_eq!(simple_path_tracer(100, camera, shadow).continuation, 100 + 50 + 12);
        let deep_miss = GroupStack { css_ms: 90, ..camera };
        assert_eq!(simple_path_tracer(100, deep_miss, shadow).continuation, 190);
    }

    #[test]
    fn sums_saturate() {
        let huge = GroupStack { css_rg: u32::MAX, css_ch: u32::MAX, dss_dc: u32::MAX, ..MAX };
        let depths = CallDepths { trace: u32::MAX, ..DEPTHS };
        assert_eq!(compute(huge, depths).continuation, u32::MAX);
        assert_eq!(conservative(huge, depths).direct_from_state, u32::MAX);
    }

    #[test]
    fn the_maximum_of_groups_is_by_field() {
        let a = GroupStack { css_rg: 5, ..Default::default() };
        let b = GroupStack { css_ch: 7, css_rg: 1, ..Default::default() };
        assert_eq!(
            [a, b].into_iter().collect::<GroupStack>(),
            GroupStack { css_rg: 5, css_ch: 7, ..Default::default() }
        );
        assert_eq!(std::iter::empty().collect::<GroupStack>(), GroupStack::default());
    }
}
