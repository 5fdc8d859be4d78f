//! Build options (guide 5.5, 5.10).

use super::super::sys::{
    OptixAccelBuildOptions, OptixBuildFlags, OptixBuildOperation, OptixMotionFlags, OptixMotionOptions,
};
use crate::error::DriverError as Error;

/// How an acceleration structure is built.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AccelOptions {
    /// What matters more.
    pub preference: Preference,
    /// Copy the structure to a smaller buffer after the build, when it is smaller.
    pub compact: bool,
    /// Programs may read vertices by handle.
    pub random_vertex_access: bool,
    /// Programs may read instances by handle.
    pub random_instance_access: bool,
    /// Motion keys; `None` for a static structure.
    pub motion: Option<Motion>,
}

/// What matters more. The two are mutually exclusive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preference {
    /// Neither.
    #[default]
    None,
    /// The speed of traces.
    FastTrace,
    /// The speed of the build.
    FastBuild,
}

/// Motion keys, at equal steps of time from `begin` to `end` (guide 5.10.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Number of keys, at least 2.
    pub keys: u16,
    /// Time of the first key, in the unit of ray times.
    pub begin: f32,
    /// Time of the last key, after `begin`.
    pub end: f32,
    /// Whether it is absent before `begin`, instead of standing as at `begin`.
    pub start_vanish: bool,
    /// Whether it is absent after `end`.
    pub end_vanish: bool,
}

impl Motion {
    pub(in super::super) fn raw(&self) -> Result<OptixMotionOptions, Error> {
        // Written so that a NaN is refused.
        if self.keys < 2 || !(self.begin < self.end && self.begin.is_finite() && self.end.is_finite()) {
            let problem = format!("{} keys from time {} to {}", self.keys, self.begin, self.end);
            return Err(Error::invalid("motion", problem, "give at least 2 keys and an end after the begin"));
        }
        let flag = |on: bool, flag: OptixMotionFlags| if on { flag.0 } else { 0 };
        let start = flag(self.start_vanish, OptixMotionFlags::START_VANISH);
        let end = flag(self.end_vanish, OptixMotionFlags::END_VANISH);
        let flags = OptixMotionFlags(start | end);
        Ok(OptixMotionOptions { num_keys: self.keys, flags, time_begin: self.begin, time_end: self.end })
    }
}

impl AccelOptions {
    pub(in super::super) fn flags(&self) -> u32 {
        use OptixBuildFlags as Flags;
        let preference = match self.preference {
            Preference::None => Flags::NONE,
            Preference::FastTrace => Flags::PREFER_FAST_TRACE,
            Preference::FastBuild => Flags::PREFER_FAST_BUILD,
        };
        [
            (self.compact, Flags::ALLOW_COMPACTION),
            (self.random_vertex_access, Flags::ALLOW_RANDOM_VERTEX_ACCESS),
            (self.random_instance_access, Flags::ALLOW_RANDOM_INSTANCE_ACCESS),
        ]
        .into_iter()
        .filter(|(on, _)| *on)
        .fold(preference.0, |bits, (_, flag)| bits | flag.0)
    }

    pub(super) fn raw(&self) -> Result<OptixAccelBuildOptions, Error> {
        Ok(OptixAccelBuildOptions {
            build_flags: self.flags(),
            operation: OptixBuildOperation::BUILD,
            motion_options: self.motion.as_ref().map_or(Ok(OptixMotionOptions::default()), Motion::raw)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTION: Motion = Motion { keys: 3, begin: 0.0, end: 1.0, start_vanish: false, end_vanish: true };

    #[test]
    fn options_become_bits() {
        let options = AccelOptions {
            preference: Preference::FastTrace,
            compact: true,
            random_vertex_access: true,
            motion: Some(MOTION),
            ..Default::default()
        };
        let raw = options.raw().unwrap();
        assert_eq!((raw.build_flags, raw.operation.0), (2 | 4 | 16, 8545));
        assert_eq!((raw.motion_options.num_keys, raw.motion_options.flags.0), (3, 2));
        assert_eq!(AccelOptions::default().raw().unwrap().motion_options.num_keys, 0);
    }

    #[test]
    fn motion_needs_two_keys_and_a_span_of_time() {
        for motion in [
            Motion { keys: 1, ..MOTION },
            Motion { begin: 1.0, ..MOTION },
            Motion { end: f32::NAN, ..MOTION },
            Motion { end: f32::INFINITY, ..MOTION },
        ] {
            assert!(motion.raw().is_err(), "{motion:?}");
        }
    }
}
