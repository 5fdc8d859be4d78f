//! The error of a picture: estimated from its own samples, and measured against a reference.

use super::{Moments, ReportError};

/// The error of a picture as its own samples tell it. See [`Moments::estimate`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Mean linear radiance over pixels and channels; 0 without samples.
    pub mean_radiance: f64,
    /// Estimated RMSE of the picture, in radiance: the root of the mean, over pixels and channels, of the variance of
    /// the pixel's mean. `None` while no pixel has two samples.
    pub rmse: Option<f64>,
    /// [`rmse`](Self::rmse) divided by [`mean_radiance`](Self::mean_radiance): the relative standard error. `None`
    /// also where the picture is black.
    pub relative: Option<f64>,
    /// Standard error of [`mean_radiance`](Self::mean_radiance), in radiance. `None` unless every pixel that has samples
    /// has two.
    pub mean_error: Option<f64>,
    /// Pixels with no good sample at all, which count nowhere.
    pub pixels_without_samples: u64,
    /// Pixels with one good sample, whose variance is unknown: they count in the mean, not in the RMSE.
    pub pixels_without_variance: u64,
}

/// A converged picture to compare with.
#[derive(Clone, Copy, Debug)]
pub struct Reference<'a> {
    /// Linear radiance, in the order of the picture.
    pub pixels: &'a [[f32; 3]],
    /// The reference's own RMSE in radiance, where it is known (the last row of the report it was rendered with). It is
    /// then taken out of the measured error, which holds both; the two must come from different seeds.
    pub rmse: Option<f64>,
}

/// The error of a picture against a [`Reference`]. See [`Moments::compare`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Root of the mean, over pixels and channels, of the squared difference, in radiance; holds the noise of the
    /// reference too.
    pub measured_rmse: f64,
    /// `sqrt(measured² - reference²)`, 0 where the reference is the noisier one; `None` where the reference's noise is
    /// unknown.
    pub corrected_rmse: Option<f64>,
    /// Mean over pixels and channels of picture minus reference, in radiance.
    pub bias: f64,
    /// Standard error of [`bias`](Self::bias) from the noise of the picture and, where known, of the reference; a bias
    /// within 3 of these is none that can be seen. `None` while a pixel has no variance.
    pub bias_error: Option<f64>,
    /// Pixels that have no good sample or no finite reference, which were left out.
    pub skipped: u64,
}

impl Comparison {
    /// The best known true RMSE: corrected for the noise of the reference where that is known, otherwise as measured.
    #[must_use]
    pub fn true_rmse(&self) -> f64 {
        self.corrected_rmse.unwrap_or(self.measured_rmse)
    }
}

impl Moments {
    /// The picture's mean and its estimated error.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        self.estimate_over(0..self.len())
    }

    /// As [`estimate`](Self::estimate), of some of the pixels, such as a tile. Indices outside the picture are ignored.
    #[must_use]
    pub fn estimate_over(&self, pixels: impl IntoIterator<Item = usize>) -> Estimate {
        let (mut radiance, mut sampled) = (0.0, 0_u64);
        let (mut variance, mut measured) = (0.0, 0_u64);
        let mut without_samples = 0;
        for pixel in pixels.into_iter().filter_map(|i| self.pixels().get(i)) {
            let Some(mean) = pixel.mean() else {
                without_samples += 1;
                continue;
            };
            sampled += 1;
            radiance += mean.iter().sum::<f64>();
            if let Some(v) = pixel.mean_variance() {
                measured += 1;
                variance += v.iter().sum::<f64>();
            }
        }
        let terms = |pixels: u64| 3.0 * pixels as f64;
        let mean_radiance = if sampled > 0 { radiance / terms(sampled) } else { 0.0 };
        let rmse = (measured > 0).then(|| (variance / terms(measured)).sqrt());
        Estimate {
            mean_radiance,
            rmse,
            relative: rmse.filter(|_| mean_radiance > 0.0).map(|e| e / mean_radiance),
            mean_error: (measured > 0 && measured == sampled).then(|| variance.sqrt() / terms(sampled)),
            pixels_without_samples: without_samples,
            pixels_without_variance: sampled - measured,
        }
    }

    /// The picture's error against a converged one.
    ///
    /// # Errors
    /// [`ReportError::PixelCount`] where the reference has another number of pixels.
    pub fn compare(&self, reference: &Reference<'_>) -> Result<Comparison, ReportError> {
        self.check_len("the reference", reference.pixels.len())?;
        let (mut squares, mut sum, mut variance) = (0.0, 0.0, Some(0.0));
        let mut compared = 0_u64;
        for (pixel, truth) in self.pixels().iter().zip(reference.pixels) {
            let Some(mean) = pixel.mean() else { continue };
            if !truth.iter().all(|t| t.is_finite()) {
                continue;
            }
            compared += 1;
            for (m, &t) in mean.iter().zip(truth) {
                let difference = m - f64::from(t);
                squares += difference * difference;
                sum += difference;
            }
            variance = variance.zip(pixel.mean_variance()).map(|(a, v)| a + v.iter().sum::<f64>());
        }
        let terms = (3 * compared).max(1) as f64;
        let measured_rmse = (squares / terms).sqrt();
        let own = reference.rmse.unwrap_or(0.0);
        Ok(Comparison {
            measured_rmse,
            corrected_rmse: reference.rmse.map(|r| (measured_rmse * measured_rmse - r * r).max(0.0).sqrt()),
            bias: sum / terms,
            // Independent pixels: the reference's mean over N terms has a variance of rmse² / N.
            bias_error: variance.filter(|_| compared > 0).map(|v| (v / terms + own * own).sqrt() / terms.sqrt()),
            skipped: self.len() as u64 - compared,
        })
    }
}
