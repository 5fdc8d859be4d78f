//! The error curve: one row at every power of two of the samples.

use std::io::{self, Write};

use super::{Moments, PowerLaw, Reference, Rejected, ReportError};

/// First line of the CSV that [`ErrorCurve::write_csv`] writes.
///
/// | column | unit |
/// | --- | --- |
/// | `samples` | samples a pixel so far |
/// | `seconds` | time spent rendering so far |
/// | `rays` | rays traced so far, of all kinds |
/// | `estimated_rmse` | linear radiance; see [`Estimate::rmse`](super::Estimate::rmse) |
/// | `relative_error` | `estimated_rmse` over the picture's mean radiance |
/// | `true_rmse` | linear radiance, against the reference; see [`Comparison::true_rmse`](super::Comparison::true_rmse) |
/// | `bias` | linear radiance, picture minus reference |
/// | `bias_error` | linear radiance, standard error of `bias` |
/// | `rejected_samples` | samples left out so far; see [`Rejected::samples`] |
/// | `slope` | exponent of `estimated_rmse` against `samples`, over the rows so far |
/// | `slope_error` | standard error of `slope` |
///
/// A field is empty where its value is unknown: the estimates at one sample, the true error without a reference.
pub const CSV_HEADER: &str = "samples,seconds,rays,estimated_rmse,relative_error,true_rmse,bias,bias_error,\
                              rejected_samples,slope,slope_error";

/// The error of a picture at one moment. Units as in [`CSV_HEADER`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Samples a pixel so far.
    pub samples: u64,
    /// Seconds spent rendering so far.
    pub seconds: f64,
    /// Rays traced so far.
    pub rays: u64,
    /// Estimated RMSE in radiance; `None` below two samples.
    pub estimated_rmse: Option<f64>,
    /// Estimated RMSE over mean radiance; `None` below two samples and for a black picture.
    pub relative_error: Option<f64>,
    /// RMSE against the reference, in radiance.
    pub true_rmse: Option<f64>,
    /// Mean of picture minus reference, in radiance.
    pub bias: Option<f64>,
    /// Standard error of [`bias`](Self::bias).
    pub bias_error: Option<f64>,
    /// What was left out because it was not finite.
    pub rejected: Rejected,
}

/// Rows of growing samples, and the slope through them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorCurve {
    rows: Vec<Row>,
}

impl ErrorCurve {
    /// A curve without rows.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether a row belongs here: at every power of two of the samples, and at the end.
    #[must_use]
    pub fn is_due(samples: u64, total: u64) -> bool {
        samples.is_power_of_two() || (samples == total && samples > 0)
    }

    /// Adds a row for the state of `moments` after `samples` samples a pixel, `seconds` and `rays`, and returns it.
    ///
    /// # Errors
    /// [`ReportError::RowOrder`] unless `samples` exceeds those of the last row, and [`ReportError::PixelCount`]
    /// where the reference has another size; no row was added.
    pub fn record(
        &mut self,
        samples: u64,
        seconds: f64,
        rays: u64,
        moments: &Moments,
        reference: Option<&Reference<'_>>,
    ) -> Result<Row, ReportError> {
        let estimate = moments.estimate();
        let comparison = reference.map(|r| moments.compare(r)).transpose()?;
        let row = Row {
            samples,
            seconds,
            rays,
            estimated_rmse: estimate.rmse,
            relative_error: estimate.relative,
            true_rmse: comparison.map(|c| c.true_rmse()),
            bias: comparison.map(|c| c.bias),
            bias_error: comparison.and_then(|c| c.bias_error),
            rejected: moments.rejected(),
        };
        self.push(row)?;
        Ok(row)
    }

    /// Adds a row.
    ///
    /// # Errors
    /// [`ReportError::RowOrder`] unless its samples exceed those of the last row.
    pub fn push(&mut self, row: Row) -> Result<(), ReportError> {
        if let Some(last) = self.rows.last()
            && row.samples <= last.samples
        {
            return Err(ReportError::RowOrder { last: last.samples, got: row.samples });
        }
        self.rows.push(row);
        Ok(())
    }

    /// The rows, in the order of their samples.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Estimated RMSE against samples, fitted; `None` below two rows that have an estimate. An unbiased renderer has a
    /// slope of -0.5.
    #[must_use]
    pub fn slope(&self) -> Option<PowerLaw> {
        slope(&self.rows)
    }

    /// True RMSE against samples, fitted; `None` without a reference. Flattens where bias or the reference's own noise
    /// takes over.
    #[must_use]
    pub fn true_slope(&self) -> Option<PowerLaw> {
        PowerLaw::fit(self.rows.iter().filter_map(|r| Some((r.samples as f64, r.true_rmse?))))
    }

    /// Writes the curve as CSV: [`CSV_HEADER`], then a line a row.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_csv(&self, mut to: impl Write) -> io::Result<()> {
        writeln!(to, "{CSV_HEADER}")?;
        let field = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.9e}"));
        for (i, row) in self.rows.iter().enumerate() {
            let law = slope(&self.rows[..=i]);
            writeln!(
                to,
                "{},{:.6},{},{},{},{},{},{},{},{},{}",
                row.samples,
                row.seconds,
                row.rays,
                field(row.estimated_rmse),
                field(row.relative_error),
                field(row.true_rmse),
                field(row.bias),
                field(row.bias_error),
                row.rejected.samples,
                field(law.map(|l| l.slope)),
                field(law.and_then(|l| l.slope_error)),
            )?;
        }
        to.flush()
    }
}

fn slope(rows: &[Row]) -> Option<PowerLaw> {
    PowerLaw::fit(rows.iter().filter_map(|r| Some((r.samples as f64, r.estimated_rmse?))))
}

/// Splits `total` samples into passes of at most `largest` (at least 1) samples that end at every power of two, so that
/// an [`ErrorCurve`] can have its rows: 1, 1, 2, 4, 8 and so on.
///
/// ```
/// # use optix_report::pass_sizes;
/// assert!(pass_sizes(20, 64).eq([1, 1, 2, 4, 8, 4]));
/// assert!(pass_sizes(20, 4).eq([1, 1, 2, 4, 4, 4, 4]));
/// ```
pub fn pass_sizes(total: u64, largest: u32) -> impl Iterator<Item = u32> {
    let mut done = 0_u64;
    std::iter::from_fn(move || {
        let next_row = done.checked_add(1)?.checked_next_power_of_two().unwrap_or(total);
        let size = (next_row.min(total).saturating_sub(done)).min(u64::from(largest.max(1)));
        done += size;
        (size > 0).then_some(size as u32)
    })
}
