//! A logarithmic axis: its range, where its ticks are and what they say.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

/// Of what the ticks are powers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Base {
    Two,
    Ten,
}

impl Base {
    fn value(self) -> f64 {
        match self {
            Self::Two => 2.0,
            Self::Ten => 10.0,
        }
    }
}

/// An axis in decimal logarithms.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    label: String,
    base: Base,
    range: Range<f64>,
}

/// Most labelled ticks.
const MOST_TICKS: i32 = 9;

impl Axis {
    /// An axis that shows all positive, finite values, with a margin; `None` where there are none.
    pub(super) fn over(label: &str, base: Base, values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let logs = values.into_iter().filter(|v| *v > 0.0 && v.is_finite()).map(f64::log10);
        let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        if low > high {
            return None;
        }
        // Wide enough that a tick falls inside, even for a single value.
        let margin = (0.04 * (high - low)).max(0.5 * (base.value().log10() - (high - low))).max(0.05);
        Some(Self { label: label.to_owned(), base, range: low - margin..high + margin })
    }

    pub(super) fn label(&self) -> &str {
        &self.label
    }

    pub(super) fn low(&self) -> f64 {
        self.range.start
    }

    pub(super) fn high(&self) -> f64 {
        self.range.end
    }

    /// Labelled and faint ticks, in decimal logarithms; some lie outside the axis.
    fn ticks(&self) -> (Vec<f64>, Vec<f64>) {
        let unit = self.base.value().log10();
        let (first, last) = ((self.low() / unit).floor() as i32, (self.high() / unit).ceil() as i32);
        let every = (last - first) / MOST_TICKS + 1;
        let power = |k: i32| f64::from(k) * unit;
        let mut bold: Vec<f64> = (first..=last).filter(|k| k % every == 0).map(power).collect();
        let between = |factors: &'static [f64]| {
            (first..=last).flat_map(move |k| factors.iter().map(move |f| power(k) + f.log10()))
        };
        let mut light: Vec<f64> = match self.base {
            _ if every > 1 => (first..=last).map(power).collect(),
            Base::Ten => between(&[2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]).collect(),
            Base::Two => Vec::new(),
        };
        // Less than two decades: powers alone would be too few to read a value by.
        let shown = |v: &[f64]| v.iter().filter(|v| self.range.contains(v)).count();
        if self.base == Base::Ten && shown(&bold) < 3 {
            bold.extend(between(&[2.0, 5.0]));
            if shown(&bold) < 2 {
                bold.extend(between(&[3.0, 4.0, 6.0, 7.0, 8.0, 9.0]));
                light.clear();
            }
        }
        (bold, light)
    }

    /// The text of a labelled tick: `10⁻²`, `2⁷`, `5·10⁻²`; small powers of two and seconds near 1 as they are.
    pub(super) fn tick_label(&self, log: f64) -> String {
        let power = log / self.base.value().log10();
        let whole = power.round();
        if (power - whole).abs() < 1e-6 {
            return format!("{}{}", self.base.value(), superscript(whole as i32));
        }
        let exponent = log.floor();
        let digit = 10_f64.powf(log - exponent).round();
        format!("{digit}·10{}", superscript(exponent as i32))
    }
}

impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let along = (value - self.low()) / (self.high() - self.low());
        // A float cast saturates; the picture is far smaller.
        limit.0 + (along * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let (bold, light) = self.ticks();
        let mut ticks = if hint.weight().allow_light_points() { light } else { bold };
        ticks.retain(|v| self.range.contains(v));
        ticks
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

fn superscript(number: i32) -> String {
    let raise = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        // The others follow each other in Unicode, from U+2070.
        digit => char::from_u32(0x2070 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
    };
    number.to_string().chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(base: Base, values: [f64; 2]) -> Vec<String> {
        let axis = Axis::over("", base, values).unwrap();
        let (mut bold, _) = axis.ticks();
        bold.retain(|v| axis.range.contains(v));
        bold.sort_by(f64::total_cmp);
        bold.iter().map(|v| axis.tick_label(*v)).collect()
    }

    #[test]
    fn ticks_are_powers() {
        assert_eq!(labels(Base::Two, [2.0, 64.0]), ["2¹", "2²", "2³", "2⁴", "2⁵", "2⁶"]);
        assert_eq!(labels(Base::Ten, [1e-3, 2.0]), ["10⁻³", "10⁻²", "10⁻¹", "10⁰"]);
        assert_eq!(labels(Base::Ten, [0.04, 0.3]), ["5·10⁻²", "10⁻¹", "2·10⁻¹"]);
    }

    #[test]
    fn every_axis_has_a_few_ticks() {
        for base in [Base::Two, Base::Ten] {
            for values in
                [[1.0, 1.0], [0.3, 0.31], [7.0, 8.0], [1e-300, 1e300], [1.0, 1e6], [1.0, 1e38], [5e-324, 1e-323]]
            {
                let ticks = labels(base, values).len();
                assert!((1..=12).contains(&ticks), "{base:?} {values:?}: {ticks}");
            }
            assert!(Axis::over("", base, [0.0, -1.0, f64::NAN, f64::INFINITY]).is_none());
        }
    }
}
