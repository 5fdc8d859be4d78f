//! Error against run time: how far a Monte Carlo picture still is from its limit, and how it got there.
//!
//! A renderer draws its samples in passes. After each pass the film holds, for every pixel, the **sum** of the
//! radiance samples and the **sum of their squares**; [`Moments`] takes those in and keeps mean and variance in
//! `f64`. From them follow the picture ([`Moments::mean_image`]), its estimated error ([`Moments::estimate`]), and,
//! where a converged picture is known, its true error and bias ([`Moments::compare`]). An [`ErrorCurve`] holds one
//! [`Row`] for every power of two of the samples, fits the slope of error against samples, and writes a CSV.
//!
//! ```
//! use optix_report::{ErrorCurve, Moments, pass_sizes};
//!
//! let (pixels, total) = (4, 16);
//! let mut moments = Moments::new(pixels);
//! let mut curve = ErrorCurve::new();
//! let mut done = 0;
//! for size in pass_sizes(total, 64) {
//!     // A device would trace `size` samples a pixel here. These are 0, 1, 0, 1, ...
//!     let ones: u32 = (done..done + u64::from(size)).map(|i| (i % 2) as u32).sum();
//!     let film = vec![[ones as f32; 4]; pixels];
//!     moments.add_pass(size, &film, &film)?;
//!     done += u64::from(size);
//!     if ErrorCurve::is_due(done, total) {
//!         curve.record(done, 0.5, done * 4, &moments, None)?;
//!     }
//! }
//! let last = curve.rows().last().unwrap();
//! assert_eq!(last.samples, 16);
//! // Variance of 0, 1, 0, 1, ... is n / (4 (n - 1)); the mean of 16 has a standard error of sqrt(that / 16).
//! assert!((last.estimated_rmse.unwrap() - (4.0 / 15.0_f64 / 16.0).sqrt()).abs() < 1e-12);
//! # Ok::<(), optix_report::ReportError>(())
//! ```
//!
//! What the numbers assume: samples of a pixel are independent and of one distribution. With samples stratified
//! across passes the estimate is too large; with samples that share random numbers between pixels the estimate of a
//! pixel holds, but [`Estimate::mean_error`] does not.
#![warn(missing_docs)]

mod curve;
mod estimate;
mod fit;
mod moments;

pub use curve::{CSV_HEADER, ErrorCurve, Row, pass_sizes};
pub use estimate::{Comparison, Estimate, Reference};
pub use fit::PowerLaw;
pub use moments::{Moments, Rejected};

/// What can be wrong with the numbers handed to this crate.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A slice has another number of pixels than the accumulator.
    #[error("{what} has {got} pixels, {expected} were expected")]
    PixelCount {
        /// Which input.
        what: &'static str,
        /// Pixels of the accumulator.
        expected: usize,
        /// Pixels of the input.
        got: usize,
    },
    /// Rows must come in the order of their samples.
    #[error("a row at {got} samples was recorded after one at {last}")]
    RowOrder {
        /// Samples of the last row.
        last: u64,
        /// Samples of the refused row.
        got: u64,
    },
}

#[cfg(test)]
mod tests;
