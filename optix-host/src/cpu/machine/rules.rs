//! What launches end for: the rules that programs are held to while they run. `docs/checked.md` is made of this.

/// A rule of the guide that the executor holds programs to.
pub(super) struct Rule {
    /// The section of the guide that has it.
    pub guide: &'static str,
    #[cfg(test)]
    pub when: When,
    /// What a program does that breaks it.
    #[cfg(test)]
    pub what: &'static str,
}

/// In which mode a rule is checked.
#[cfg(test)]
#[derive(Clone, Copy, PartialEq)]
pub(super) enum When {
    /// Without the check the executor could not go on.
    Always,
    Checked,
}

macro_rules! rules {
    ($($name:ident, $when:ident, $guide:literal, $what:literal;)*) => {
        $(
            #[doc = $what]
            pub(super) const $name: Rule = Rule {
                guide: $guide,
                #[cfg(test)]
                when: When::$when,
                #[cfg(test)]
                what: $what,
            };
        )*

        /// All of them, with their names.
        #[cfg(test)]
        pub(super) const ALL: &[(&str, Rule)] = &[$((stringify!($name), $name)),*];
    };
}

rules! {
    RAY, Checked, "13.2", "a ray's origin or direction is not finite, or the direction is zero";
    OBJECT_RAY, Checked, "13.2", "a ray meets the box of an instance in whose object space its origin or direction is not finite, or its direction is zero; unchecked, it misses what the instance holds";
    INTERVAL, Checked, "13.2", "`tmin` is negative, infinite or NaN; `tmax` is NaN or minus infinity";
    ANYHIT_FLAGS, Checked, "13.2", "two of a ray's any-hit flags exclude each other";
    CULL_FLAGS, Checked, "13.2", "a ray culls both faces of triangles";
    PAYLOAD_TYPE, Checked, "14", "a program runs for a trace call with another payload type than its own";
    PAYLOAD_UNWRITTEN, Checked, "14", "a program reads a payload field that nobody wrote, or one comes back unwritten to a caller that reads it";
    HIT_KIND, Checked, "13.4", "an intersection program reports a hit kind above 127";
    HIT_NAN, Checked, "13.4", "an intersection program reports a hit at `t` = NaN";
    OUTSIDE_BOX, Checked, "5.1", "an intersection program reports a hit outside of its primitive's box";
    TRACE_DEPTH, Always, "12", "trace calls nest deeper than the pipeline's trace depth, and no exception says so";
    CALLABLE_DEPTH, Always, "6.8", "callables nest deeper than the pipeline's callable depth";
    STACK, Always, "6.8", "programs that call each other use up the thread's stack, and no exception says so";
    MISS_RECORD, Always, "13.2", "a trace call names a miss record that is not there";
    HIT_RECORD, Always, "7.3", "a hit asks for a hit-group record that is not there";
    CALLABLE_RECORD, Always, "7.2", "a call names a callable's record that is not there";
    CALLABLE_SIGNATURE, Always, "15.2", "a callable is called with another signature or as another kind";
    HELD, Always, "5", "a traversable, or a table of instances or triangles, is used that this launch was not given";
    INSTANCE_HANDLE, Always, "13.11", "a handle that is taken for an instance's is of none";
    TRIANGLE_INDEX, Always, "13.9", "a triangle is read that is not there";
    KIND, Always, "13", "a program asks what programs of its kind can't";
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::fmt::Write as _;

    /// What else the guide leaves undefined, and why no program gets there.
    const ELSEWHERE: &[(&str, &str, &str)] = &[
        (
            "5, 5.6, 5.7",
            "a child structure that is freed, moved or updated",
            "structures own their children; nothing is moved or updated",
        ),
        ("5.1", "an index of a primitive's record that is not there", "refused when the structure is built"),
        ("5.4", "any-hit both enforced and disabled on an instance", "refused when the structure is built"),
        (
            "5.5, 13.9, 13.12",
            "triangles or instances read by number without the build flag, or out of range",
            "only structures that are built for it give the table, whose indices are checked in either mode",
        ),
        (
            "5.9, 6.3, 13.11",
            "a graph or a kind of primitive that the pipeline's options leave out",
            "the options follow from the scene, and a launch refuses structures that they don't cover",
        ),
        (
            "6.2",
            "what launch indices see of each other's writes",
            "nothing to trap: each order that the CPU's threads make is one that a GPU may",
        ),
        (
            "6.5, 10",
            "launch parameters of another type or size",
            "a launch takes the pipeline's type, whose layout is compared with the PTX",
        ),
        ("6.5.1", "another value than the bound one", "refused by the launch"),
        (
            "7.2, 7.4",
            "a record of another type, or data that is not there",
            "`pipeline!` ties programs to the records of their materials",
        ),
        ("13.4, 13.9", "triangle queries about other primitives", "the methods are there for hits on triangles only"),
        ("13.11", "a structure that is written during a launch", "nothing writes one"),
        ("13.14", "details of another exception than the one thrown", "`raised()` decodes them by the code"),
        (
            "",
            "an index out of range of a buffer",
            "ends the launch in either mode; the functions that leave the check out are `unsafe`",
        ),
        ("5.10, 5.11, 5.12, 8, 9", "motion, micromaps, clusters, hit objects, curves and spheres", "not there yet"),
    ];

    fn document() -> String {
        let mut text = String::from(
            "# What ends a launch on the CPU\n\n\
             Generated from the executor's rules by `CHECKED=overwrite cargo test -p optix-host --lib rules`; do not edit.\n\n\
             A launch on `Device::cpu_checked()` ends at each of these, with an error that names the launch index, the program and \
             the rule. On `Device::cpu()` it ends only at those that the executor could not go on from.\n\n\
             | guide | what a program does | `cpu_checked()` | `cpu()` |\n| --- | --- | --- | --- |\n",
        );
        for (_, rule) in ALL {
            let unchecked = if rule.when == When::Always { "ends" } else { "" };
            writeln!(text, "| {} | {} | ends | {unchecked} |", rule.guide, rule.what).unwrap();
        }
        text.push_str(
            "\nWhat else the guide leaves undefined, of what this toolkit has, is not for a program to do:\n\n\
             | guide | what is undefined | why it does not happen |\n| --- | --- | --- |\n",
        );
        for (section, what, why) in ELSEWHERE {
            writeln!(text, "| {section} | {what} | {why} |").unwrap();
        }
        text
    }

    #[test]
    fn the_document_is_of_these_rules() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/checked.md");
        let expected = document();
        if std::env::var_os("CHECKED").is_some_and(|v| v == "overwrite") {
            std::fs::write(path, &expected).unwrap();
        }
        // As it was when this was compiled: the tests run on machines without the sources, too.
        assert!(
            include_str!("../../../../docs/checked.md") == expected,
            "{path} is of other rules: run `CHECKED=overwrite cargo test -p optix-host --lib rules`"
        );
    }

    /// `tests.rs` has a program that breaks each rule, and checks that its message ends with where the guide has it.
    #[test]
    fn each_rule_has_a_test() {
        let tested: BTreeSet<_> = include_str!("tests.rs")
            .split("rules::")
            .skip(1)
            .filter_map(|text| text.split(|c: char| !c.is_ascii_uppercase() && c != '_').next())
            .collect();
        let all: BTreeSet<_> = ALL.iter().map(|(name, _)| *name).collect();
        assert_eq!(all, tested);
    }
}
