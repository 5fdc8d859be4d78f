//! Mean and variance of every pixel, accumulated over passes.

use super::ReportError;

/// Mean and variance of the radiance of every pixel, in `f64`, from per-pass sums.
///
/// Passes are merged with the pairwise update of Chan, Golub and LeVeque, "Updating Formulae and a Pairwise Algorithm
/// for Computing Sample Variances" (1979): numerically stable whatever the ratio of mean to deviation, for any
/// split of the samples into passes. What a pass itself loses by summing squares in `f32` is not recovered: for a
/// pass of `n` samples, about `n * 6e-8` of the mean square. Passes of up to a few hundred samples are harmless.
///
/// 56 bytes a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Moments {
    pixels: Vec<Pixel>,
    rejected: Rejected,
}

/// Samples that were not finite, and were therefore left out of mean and variance.
///
/// A film holds sums, so one bad sample takes the others of its pixel and pass with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rejected {
    /// Pairs of pixel and pass with a NaN or an infinity in the sum of any channel, or, in a pass of more than one
    /// sample, in a sum of squares (which in `f32` overflows for radiance above 1.8e19).
    pub pixel_passes: u64,
    /// Samples in those passes: an upper bound of the number of bad samples, of which each of
    /// [`pixel_passes`](Self::pixel_passes) has at least one.
    pub samples: u64,
}

/// `m2` is the sum of squared differences from the mean.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pixel {
    pub(super) count: u64,
    mean: [f64; 3],
    m2: [f64; 3],
}

impl Pixel {
    fn merge(&mut self, other: &Pixel) {
        if other.count == 0 {
            return;
        }
        let (a, b) = (self.count as f64, other.count as f64);
        let n = a + b;
        for c in 0..3 {
            let delta = other.mean[c] - self.mean[c];
            self.m2[c] += other.m2[c] + delta * delta * (a * b / n);
            self.mean[c] += delta * (b / n);
        }
        self.count += other.count;
    }

    /// Mean radiance; `None` before the first good sample.
    pub(super) fn mean(&self) -> Option<[f64; 3]> {
        (self.count > 0).then_some(self.mean)
    }

    /// Unbiased variance of one sample; `None` below two samples.
    pub(super) fn variance(&self) -> Option<[f64; 3]> {
        (self.count > 1).then(|| self.m2.map(|m2| m2 / (self.count - 1) as f64))
    }

    /// Variance of the mean; `None` below two samples.
    pub(super) fn mean_variance(&self) -> Option<[f64; 3]> {
        self.variance().map(|v| v.map(|v| v / self.count as f64))
    }
}

impl Moments {
    /// An empty accumulator for a picture of `pixels` pixels. As a `Vec` of that size it panics or aborts where there is not so
    /// much memory.
    #[must_use]
    pub fn new(pixels: usize) -> Self {
        Self { pixels: vec![Pixel::default(); pixels], rejected: Rejected::default() }
    }

    /// Takes in one pass of `samples` samples a pixel.
    ///
    /// `sums` and `squares` have one entry a pixel, in the order of the picture: the sum of the pass's radiance samples
    /// and the sum of their squares, red, green, blue; the fourth component is ignored. `glam::Vec4` and `[f32; 4]`
    /// both serve. In a pass of one sample, `squares` is not read. A pixel whose sums are not finite is left out for
    /// this pass and counted in [`rejected`](Self::rejected). A pass of no samples changes nothing.
    ///
    /// # Errors
    /// [`ReportError::PixelCount`] where a slice has another length; nothing was taken in.
    pub fn add_pass<P: Copy + Into<[f32; 4]>>(
        &mut self,
        samples: u32,
        sums: &[P],
        squares: &[P],
    ) -> Result<(), ReportError> {
        self.check_len("the film of sums", sums.len())?;
        self.check_len("the film of squares", squares.len())?;
        for (pixel, (&sum, &square)) in sums.iter().zip(squares).enumerate() {
            let ([r, g, b, _], [r2, g2, b2, _]) = (sum.into(), square.into());
            self.add(pixel, samples, [r, g, b].map(f64::from), [r2, g2, b2].map(f64::from));
        }
        Ok(())
    }

    /// Takes in `samples` samples of one pixel, by their sum and the sum of their squares, as
    /// [`add_pass`](Self::add_pass) does for all. A pixel outside the picture changes nothing.
    pub fn add(&mut self, pixel: usize, samples: u32, sum: [f64; 3], squares: [f64; 3]) {
        let Some(into) = self.pixels.get_mut(pixel) else {
            return;
        };
        if samples == 0 {
            return;
        }
        let finite = |v: [f64; 3]| v.iter().all(|x| x.is_finite());
        if !finite(sum) || (samples > 1 && !finite(squares)) {
            self.rejected.pixel_passes += 1;
            self.rejected.samples += u64::from(samples);
            return;
        }
        let n = f64::from(samples);
        let mean = sum.map(|s| s / n);
        let mut m2 = [0.0; 3];
        if samples > 1 {
            for c in 0..3 {
                // Rounding can make it negative where the samples hardly differ.
                m2[c] = (squares[c] - sum[c] * mean[c]).max(0.0);
            }
        }
        into.merge(&Pixel { count: u64::from(samples), mean, m2 });
    }

    /// Takes in all that `other` has, as if its passes had been added here.
    ///
    /// # Errors
    /// [`ReportError::PixelCount`] where `other` has another number of pixels.
    pub fn merge(&mut self, other: &Moments) -> Result<(), ReportError> {
        self.check_len("the other accumulator", other.pixels.len())?;
        for (a, b) in self.pixels.iter_mut().zip(&other.pixels) {
            a.merge(b);
        }
        self.rejected.pixel_passes += other.rejected.pixel_passes;
        self.rejected.samples += other.rejected.samples;
        Ok(())
    }

    /// Number of pixels.
    #[must_use]
    pub fn len(&self) -> usize {
        self.pixels.len()
    }

    /// Whether there are no pixels.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.pixels.is_empty()
    }

    /// What was left out because it was not finite.
    #[must_use]
    pub fn rejected(&self) -> Rejected {
        self.rejected
    }

    /// Good samples of a pixel; 0 outside the picture.
    #[must_use]
    pub fn count(&self, pixel: usize) -> u64 {
        self.pixels.get(pixel).map_or(0, |p| p.count)
    }

    /// Mean radiance of a pixel; `None` before its first good sample and outside the picture.
    #[must_use]
    pub fn mean(&self, pixel: usize) -> Option<[f64; 3]> {
        self.pixels.get(pixel)?.mean()
    }

    /// Unbiased variance of one radiance sample of a pixel; `None` below two good samples.
    #[must_use]
    pub fn variance(&self, pixel: usize) -> Option<[f64; 3]> {
        self.pixels.get(pixel)?.variance()
    }

    /// Standard error of a pixel's mean radiance, `sqrt(variance / n)`; `None` below two good samples.
    #[must_use]
    pub fn standard_error(&self, pixel: usize) -> Option<[f64; 3]> {
        Some(self.pixels.get(pixel)?.mean_variance()?.map(f64::sqrt))
    }

    /// The picture: mean linear radiance of every pixel. Black where a pixel has no good sample, which
    /// [`rejected`](Self::rejected) and [`Estimate::pixels_without_samples`](super::Estimate::pixels_without_samples)
    /// tell.
    #[must_use]
    pub fn mean_image(&self) -> Vec<[f32; 3]> {
        self.pixels.iter().map(|p| p.mean.map(|m| m as f32)).collect()
    }

    pub(super) fn pixels(&self) -> &[Pixel] {
        &self.pixels
    }

    pub(super) fn check_len(&self, what: &'static str, got: usize) -> Result<(), ReportError> {
        let expected = self.pixels.len();
        if got == expected { Ok(()) } else { Err(ReportError::PixelCount { what, expected, got }) }
    }
}
