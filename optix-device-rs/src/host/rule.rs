//! What ends a launch index on the CPU: the rules that programs are held to while they run. `docs/checked.md` is made of this.

/// In which mode of the CPU executor a rule is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Checked {
    /// In both: without the check the executor could not go on.
    Always,
    /// In the checked mode.
    OnRequest,
}

macro_rules! rules {
    ($($name:ident, $checked:ident, $guide:literal, $what:literal, $remedy:literal;)*) => {
        /// A rule that a program broke while it ran on the CPU.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Rule {
            $(
                #[doc = concat!("Broken where ", $what, ".")]
                $name,
            )*
        }

        impl Rule {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// The section of the OptiX guide that has it; empty for a rule of Rust or of this toolkit.
            pub const fn guide(self) -> &'static str {
                match self {
                    $(Self::$name => $guide,)*
                }
            }

            /// What a program does that breaks it.
            pub const fn what(self) -> &'static str {
                match self {
                    $(Self::$name => $what,)*
                }
            }

            /// What to do about it.
            pub const fn remedy(self) -> &'static str {
                match self {
                    $(Self::$name => $remedy,)*
                }
            }

            /// In which mode it is checked.
            pub const fn checked(self) -> Checked {
                match self {
                    $(Self::$name => Checked::$checked,)*
                }
            }
        }
    };
}

rules! {
    Ray, OnRequest, "13.2",
        "a ray's origin or direction is not finite, or the direction is zero",
        "look for a division by 0, or for a vector without length that is normalised, where the ray is made";
    ObjectRay, OnRequest, "13.2",
        "a ray meets the box of an instance in whose object space its origin or direction is not finite, or its direction is zero; unchecked, it misses what the instance holds",
        "scale the scene, or the instance's transform, to sizes that 32 bits can have";
    Interval, OnRequest, "13.2",
        "`tmin` is negative, infinite or NaN; `tmax` is NaN or minus infinity",
        "give a finite `tmin` of 0 or more; a ray without end has `tmax` infinite";
    AnyHitFlags, OnRequest, "13.2",
        "two of a ray's any-hit flags exclude each other",
        "leave one of the flags out";
    CullFlags, OnRequest, "13.2",
        "a ray culls both faces of triangles",
        "leave one of the flags out; to see no triangles at all use the visibility mask";
    PayloadType, OnRequest, "14",
        "a program runs for a trace call with another payload type than its own",
        "trace with the offset, stride and miss index of the payload's ray type";
    PayloadUnwritten, OnRequest, "14",
        "a program reads a payload field that nobody wrote, or one comes back unwritten to a caller that reads it",
        "have the caller write the field, or each program that a ray may end in";
    HitKind, OnRequest, "13.4",
        "an intersection program reports a hit kind above 127",
        "report kinds from 0 to 127";
    HitNan, OnRequest, "13.4",
        "an intersection program reports a hit at `t` = NaN",
        "look for a division by 0, or for the root of a negative number, where `t` is computed";
    OutsideBox, OnRequest, "5.1",
        "an intersection program reports a hit outside of its primitive's box",
        "make the box larger, or report only hits inside of it: rays that pass the box by don't find what is outside";
    TraceDepth, Always, "12",
        "trace calls nest deeper than the pipeline's trace depth, and no exception says so",
        "state a greater `trace_depth` in `pipeline!`, or end the recursion of the programs earlier";
    CallableDepth, Always, "6.8",
        "callables nest deeper than the pipeline's callable depth",
        "state a greater `callable_depth: N` in `pipeline!`, or end the recursion of the callables earlier";
    Stack, Always, "6.8",
        "programs that call each other use up the thread's stack, and no exception says so",
        "lower `trace_depth` or `callable_depth` in `pipeline!`, or give the threads larger stacks (`RUST_MIN_STACK=16777216` in the environment, or `stack_size` of a rayon pool that the launch is made in)";
    OtherStack, Always, "6.8",
        "a program traces, calls or launches on another stack than its thread's, and nobody knows how deep that goes",
        "have the thread's own stack larger (`RUST_MIN_STACK=16777216` in the environment, or `stack_size` of a rayon pool that the launch is made in)";
    MissRecord, Always, "13.2",
        "a trace call names a miss record that is not there",
        "trace with the miss index of the payload's ray type";
    HitRecord, Always, "7.3",
        "a hit asks for a hit-group record that is not there",
        "trace with the offset and stride of the payload's ray type, against a structure of the pipeline's scene";
    CallableRecord, Always, "7.2",
        "a call names a callable's record that is not there",
        "make the callable with the pipeline's scene, before the pipeline, and pass it to this launch";
    CallableSignature, Always, "15.2",
        "a callable is called with another signature or as another kind",
        "call it by the reference that the scene gave for it";
    Held, Always, "5",
        "a traversable, or a table of instances or triangles, is used that this launch was not given",
        "pass the structure to this launch, in its parameters or in a record";
    InstanceHandle, Always, "13.11",
        "a handle that is taken for an instance's is of none",
        "ask the transform list of a hit, or a table of instances, for it";
    TriangleIndex, Always, "13.9",
        "a triangle is read that is not there",
        "compare the index with the number of triangles";
    Kind, Always, "13",
        "a program asks what programs of its kind can't",
        "ask in a program that has what is asked for, and pass it on in the payload";
    Index, Always, "",
        "an index is out of range of a buffer or table",
        "compare the index with the view's length, or give a larger buffer";
    View, Always, "",
        "a view of device memory is used that this launch was not given, or outside of a launch",
        "pass the buffer to this launch, in its parameters or in a record; outside of a launch read it with `Buffer::read`";
    Context, Always, "",
        "a context is used while another program runs than the one that it was given to",
        "use the context of the program that runs";
    Panic, Always, "",
        "a program panics",
        "mend what the program's words and place say; on a GPU a panic ends the launch without words";
}
