//! Synthetic noise of known variance, and hostile numbers.

use super::*;

/// SplitMix64: a small generator with good statistics, for reproducible noise.
struct Rng(u64);

impl Rng {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In (0, 1).
    fn uniform(&mut self) -> f64 {
        ((self.next() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }
}

/// Renders `total` samples of `draw` a pixel and channel in passes of at most `largest`, films in `f32` as a device has.
fn render(pixels: usize, total: u64, largest: u32, truth: f32, mut draw: impl FnMut() -> f64) -> (Moments, ErrorCurve) {
    let (mut moments, mut curve, mut done) = (Moments::new(pixels), ErrorCurve::new(), 0);
    let reference = vec![[truth; 3]; pixels];
    let reference = Reference { pixels: &reference, rmse: None };
    for size in pass_sizes(total, largest) {
        let (mut sums, mut squares) = (vec![[0.0_f32; 4]; pixels], vec![[0.0_f32; 4]; pixels]);
        for (sum, square) in sums.iter_mut().zip(&mut squares) {
            for _ in 0..size {
                for c in 0..3 {
                    let x = draw() as f32;
                    sum[c] += x;
                    square[c] += x * x;
                }
            }
        }
        moments.add_pass(size, &sums, &squares).unwrap();
        done += u64::from(size);
        if ErrorCurve::is_due(done, total) {
            curve.record(done, done as f64 * 1e-3, done * pixels as u64, &moments, Some(&reference)).unwrap();
        }
    }
    (moments, curve)
}

fn assert_close(a: f64, b: f64, relative: f64) {
    assert!((a - b).abs() <= relative * b.abs(), "{a} is not within {relative} of {b}");
}

#[test]
fn estimated_error_is_the_true_error_for_uniform_noise() {
    let mut rng = Rng(1);
    let (moments, curve) = render(4096, 256, 64, 0.5, || rng.uniform());
    let last = curve.rows().last().unwrap();
    let expected = (1.0 / 12.0 / 256.0_f64).sqrt();
    // 12288 terms: the RMSE of either kind has a relative deviation of about 1 / sqrt(2 * 12288) = 0.64 %.
    assert_close(last.estimated_rmse.unwrap(), expected, 0.01);
    assert_close(last.true_rmse.unwrap(), expected, 0.03);
    assert_close(last.relative_error.unwrap(), expected / 0.5, 0.01);
    assert!(last.bias.unwrap().abs() < 5.0 * last.bias_error.unwrap());
    assert_close(last.bias_error.unwrap(), expected / (12288.0_f64).sqrt(), 0.01);
    assert_eq!(moments.rejected(), Rejected::default());
    assert_close(moments.estimate().mean_error.unwrap(), last.bias_error.unwrap(), 1e-12);

    let slope = curve.slope().unwrap();
    assert!((slope.slope + 0.5).abs() < 0.005, "{slope:?}");
    assert!(slope.slope_error.unwrap() < 0.005, "{slope:?}");
    assert_eq!(slope.points, 8, "the row at one sample has no estimate");
    assert!((curve.true_slope().unwrap().slope + 0.5).abs() < 0.02);
}

#[test]
fn estimated_error_is_the_true_error_for_heavy_tails() {
    // Pareto with alpha = 4.5: mean 4.5 / 3.5, variance alpha / ((alpha - 1)² (alpha - 2)); the fourth moment only just
    // exists, so the estimate of the variance is itself heavy-tailed.
    let alpha = 4.5_f64;
    let mean = alpha / (alpha - 1.0);
    let deviation = (alpha / ((alpha - 1.0).powi(2) * (alpha - 2.0))).sqrt();
    let mut rng = Rng(2);
    let (_, curve) = render(4096, 128, 32, mean as f32, || rng.uniform().powf(-1.0 / alpha));
    let last = curve.rows().last().unwrap();
    assert_close(last.estimated_rmse.unwrap(), deviation / 128.0_f64.sqrt(), 0.05);
    assert_close(last.true_rmse.unwrap(), last.estimated_rmse.unwrap(), 0.05);
    assert!((curve.slope().unwrap().slope + 0.5).abs() < 0.02);
}

#[test]
fn rare_bright_samples_are_seen_where_they_fall() {
    // 1000 with probability 1/1000: variance 999.
    let mut rng = Rng(3);
    let (_, curve) = render(4096, 64, 64, 1.0, || if rng.uniform() < 1e-3 { 1000.0 } else { 0.0 });
    let last = curve.rows().last().unwrap();
    assert_close(last.estimated_rmse.unwrap(), (999.0 / 64.0_f64).sqrt(), 0.10);
    assert_close(last.true_rmse.unwrap(), last.estimated_rmse.unwrap(), 0.10);
}

#[test]
fn a_bias_is_found() {
    let mut rng = Rng(4);
    let (_, curve) = render(1024, 64, 64, 0.5, || rng.uniform() + 0.05);
    let last = curve.rows().last().unwrap();
    assert_close(last.bias.unwrap(), 0.05, 0.05);
    assert!(last.bias.unwrap() > 5.0 * last.bias_error.unwrap());
    assert!(last.true_rmse.unwrap() > 1.2 * last.estimated_rmse.unwrap());
}

#[test]
fn noise_of_the_reference_is_taken_out() {
    let (mut rng, mut other) = (Rng(5), Rng(6));
    let (moments, _) = render(4096, 64, 64, 0.5, || rng.uniform());
    let (reference, curve) = render(4096, 64, 64, 0.5, || other.uniform());
    let pixels = reference.mean_image();
    let known = curve.rows().last().unwrap().estimated_rmse;
    let blind = moments.compare(&Reference { pixels: &pixels, rmse: None }).unwrap();
    let told = moments.compare(&Reference { pixels: &pixels, rmse: known }).unwrap();
    let estimate = moments.estimate().rmse.unwrap();
    assert_close(blind.true_rmse(), estimate * 2.0_f64.sqrt(), 0.03);
    assert_close(told.true_rmse(), estimate, 0.04);
    assert_close(told.bias_error.unwrap(), blind.bias_error.unwrap() * 2.0_f64.sqrt(), 0.02);
    assert!(told.bias.abs() < 5.0 * told.bias_error.unwrap());
    let noisier = moments.compare(&Reference { pixels: &pixels, rmse: Some(1.0) }).unwrap();
    assert_eq!(noisier.true_rmse(), 0.0);
}

#[test]
fn huge_and_tiny_radiance() {
    for scale in [1e-20, 1.0, 1e20] {
        // Passes of one sample: squares of 1e20 do not fit in f32, and must not be needed.
        let mut rng = Rng(7);
        let (moments, curve) = render(512, 64, 1, 0.5 * scale as f32, || rng.uniform() * scale);
        assert_eq!(moments.rejected(), Rejected::default(), "{scale}");
        let last = curve.rows().last().unwrap();
        assert_close(last.estimated_rmse.unwrap(), scale * (1.0 / 12.0 / 64.0_f64).sqrt(), 0.05);
        assert_close(last.true_rmse.unwrap(), last.estimated_rmse.unwrap(), 0.05);
        assert_close(last.relative_error.unwrap(), (1.0 / 12.0 / 64.0_f64).sqrt() / 0.5, 0.05);
    }
    // In a pass of more samples the film's squares are infinite, which is counted, not averaged.
    let mut moments = Moments::new(1);
    moments.add_pass(2, &[[2e20_f32; 4]], &[[f32::INFINITY; 4]]).unwrap();
    assert_eq!(moments.rejected(), Rejected { pixel_passes: 1, samples: 2 });
    // In f64 they fit.
    moments.add(0, 2, [2e20; 3], [4e40; 3]);
    assert_close(moments.variance(0).unwrap()[0], 2e40, 1e-12);
}

#[test]
fn one_sample_has_no_variance() {
    let mut moments = Moments::new(2);
    let empty = moments.estimate();
    assert_eq!((empty.rmse, empty.mean_error, empty.pixels_without_samples), (None, None, 2));
    assert_eq!(moments.mean(0), None);
    moments.add_pass(1, &[[1.0_f32; 4]; 2], &[[1.0_f32; 4]; 2]).unwrap();
    assert_eq!(moments.mean(0), Some([1.0; 3]));
    assert_eq!((moments.variance(0), moments.standard_error(0)), (None, None));
    let one = moments.estimate();
    assert_eq!((one.mean_radiance, one.rmse, one.relative, one.mean_error), (1.0, None, None, None));
    assert_eq!((one.pixels_without_samples, one.pixels_without_variance), (0, 2));
    // A second sample for one of them only.
    moments.add(0, 1, [3.0; 3], [9.0; 3]);
    assert_eq!(moments.variance(0), Some([2.0; 3]));
    let two = moments.estimate();
    assert_eq!((two.rmse, two.mean_error, two.pixels_without_variance), (Some(1.0), None, 1));
    assert_eq!(moments.estimate_over([0, 99]).mean_error, Some((3.0_f64).sqrt() / 3.0));
}

#[test]
fn a_black_picture_has_no_relative_error() {
    let mut moments = Moments::new(1);
    moments.add_pass(4, &[[0.0_f32; 4]], &[[0.0_f32; 4]]).unwrap();
    let estimate = moments.estimate();
    assert_eq!((estimate.rmse, estimate.relative), (Some(0.0), None));
    let mut curve = ErrorCurve::new();
    curve.record(4, 1.0, 4, &moments, None).unwrap();
    assert_eq!(curve.slope(), None, "an error of zero has no logarithm");
}

#[test]
fn samples_that_are_not_finite_are_counted() {
    let mut moments = Moments::new(3);
    let one = [1.0_f32; 4];
    let bad = [one, [1.0, f32::NAN, 1.0, 1.0], [f32::NEG_INFINITY, 0.0, 0.0, 0.0]];
    moments.add_pass(4, &bad, &[one; 3]).unwrap();
    moments.add_pass(1, &[one; 3], &[one; 3]).unwrap();
    moments.add_pass(1, &[[2.0_f32; 4]; 3], &[[4.0_f32; 4]; 3]).unwrap();
    assert_eq!(moments.rejected(), Rejected { pixel_passes: 2, samples: 8 });
    assert_eq!([moments.count(0), moments.count(1), moments.count(2)], [6, 2, 2]);
    assert_eq!(moments.mean(1), Some([1.5; 3]));
    assert!(moments.mean_image().iter().flatten().all(|x| x.is_finite()));
    let reference = [[1.5; 3], [f32::NAN; 3], [1.5; 3]];
    let comparison = moments.compare(&Reference { pixels: &reference, rmse: None }).unwrap();
    assert_eq!(comparison.skipped, 1);
    assert!(comparison.measured_rmse.is_finite());
    // The fourth component is nobody's business.
    moments.add_pass(1, &[[1.0, 1.0, 1.0, f32::NAN]; 3], &[one; 3]).unwrap();
    assert_eq!(moments.rejected().samples, 8);
}

#[test]
fn variance_survives_a_large_mean() {
    // Deviation 1 on a mean of 1e9: the textbook formula in f64 would keep no digit of it for pass sums.
    let mut rng = Rng(8);
    let mut moments = Moments::new(1);
    for _ in 0..100_000 {
        let x = 1e9 + if rng.next() & 1 == 0 { 1.0 } else { -1.0 };
        moments.add(0, 1, [x; 3], [x * x; 3]);
    }
    assert_close(moments.variance(0).unwrap()[0], 1.0, 1e-3);
}

#[test]
fn the_split_into_passes_does_not_matter() {
    let draw = |largest| {
        let mut rng = Rng(9);
        render(1, 1024, largest, 0.5, || rng.uniform()).0
    };
    let (ones, mixed) = (draw(1), draw(100));
    assert_close(ones.variance(0).unwrap()[1], mixed.variance(0).unwrap()[1], 1e-4);
    assert_close(ones.mean(0).unwrap()[1], mixed.mean(0).unwrap()[1], 1e-6);

    let mut whole = Moments::new(1);
    let mut halves = [Moments::new(1), Moments::new(1)];
    let mut rng = Rng(10);
    for i in 0..1000 {
        let x = rng.uniform();
        whole.add(0, 1, [x; 3], [x * x; 3]);
        halves[usize::from(i >= 300)].add(0, 1, [x; 3], [x * x; 3]);
    }
    let [mut first, second] = halves;
    first.merge(&second).unwrap();
    assert_eq!(first.count(0), 1000);
    assert_close(first.variance(0).unwrap()[0], whole.variance(0).unwrap()[0], 1e-12);
}

#[test]
fn sizes_are_checked() {
    let mut moments = Moments::new(2);
    let film = [[0.0_f32; 4]; 3];
    let error = moments.add_pass(1, &film, &film).unwrap_err();
    assert_eq!(error.to_string(), "the film of sums has 3 pixels, 2 were expected");
    assert!(moments.add_pass(1, &film[..2], &film).is_err());
    assert!(moments.merge(&Moments::new(1)).is_err());
    assert!(moments.compare(&Reference { pixels: &[[0.0; 3]; 5], rmse: None }).is_err());
    assert_eq!(moments.count(0), 0);
    moments.add(7, 1, [1.0; 3], [1.0; 3]);
    moments.add_pass(0, &film[..2], &film[..2]).unwrap();
    assert_eq!(moments, Moments::new(2));
}

#[test]
fn slopes_are_exact_for_power_laws() {
    let law = |x: f64| 3.0 * x.powf(-0.5);
    let points = || (0..10).map(|k| f64::from(1 << k)).map(|x| (x, law(x)));
    let fit = PowerLaw::fit(points()).unwrap();
    assert!((fit.slope + 0.5).abs() < 1e-12 && fit.slope_error.unwrap() < 1e-7 && fit.points == 10);
    assert_close(fit.at(7.0), law(7.0), 1e-12);
    assert_close(PowerLaw::through(-0.5, points()).unwrap().at(100.0), law(100.0), 1e-12);
    assert_eq!(PowerLaw::fit([(1.0, 1.0)]), None);
    assert_eq!(PowerLaw::fit([(2.0, 1.0), (2.0, 3.0)]), None);
    assert_eq!(PowerLaw::fit([(0.0, 1.0), (2.0, f64::NAN), (-1.0, 3.0)]), None);
    assert_eq!(PowerLaw::fit([(1.0, 1.0), (2.0, 2.0)]).unwrap().slope_error, None);
}

#[test]
fn the_slope_error_covers_the_scatter() {
    // Known scatter: over many curves, the spread of the fitted slopes is what their standard errors say.
    let mut rng = Rng(11);
    let (mut squared_miss, mut claimed) = (0.0, 0.0);
    for _ in 0..2000 {
        let noisy = (0..10).map(|k| {
            let gauss: f64 = (0..12).map(|_| rng.uniform()).sum::<f64>() - 6.0;
            (f64::from(1 << k), (0.1 * gauss).exp() * f64::from(1 << k).powf(-0.5))
        });
        let fit = PowerLaw::fit(noisy.collect::<Vec<_>>()).unwrap();
        squared_miss += (fit.slope + 0.5).powi(2);
        claimed += fit.slope_error.unwrap().powi(2);
    }
    assert_close(squared_miss, claimed, 0.15);
}

#[test]
fn rows_fall_on_powers_of_two() {
    for (total, largest) in [(1, 1), (64, 64), (100, 7), (1000, 1), (65_536, 256), (0, 4), (5, 0)] {
        let mut done = 0;
        let mut rows = Vec::new();
        for size in pass_sizes(total, largest) {
            assert!(size >= 1 && size <= largest.max(1));
            done += u64::from(size);
            if ErrorCurve::is_due(done, total) {
                rows.push(done);
            }
        }
        assert_eq!(done, total);
        let mut expected: Vec<u64> = (0..64).map(|k| 1_u64 << k).take_while(|&s| s <= total).collect();
        if total > 0 && !total.is_power_of_two() {
            expected.push(total);
        }
        assert_eq!(rows, expected);
    }
    assert_eq!(pass_sizes(u64::MAX, u32::MAX).take(40).count(), 40);
}

#[test]
fn the_csv_has_a_line_a_row() {
    let mut rng = Rng(12);
    let (moments, mut curve) = render(16, 8, 8, 0.5, || rng.uniform());
    let mut csv = Vec::new();
    curve.write_csv(&mut csv).unwrap();
    let csv = String::from_utf8(csv).unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines[0], CSV_HEADER);
    assert_eq!(lines.len(), 5);
    let columns = CSV_HEADER.split(',').count();
    for line in &lines[1..] {
        assert_eq!(line.split(',').count(), columns, "{line}");
    }
    assert!(lines[1].starts_with("1,0.001000,16,,,"), "{}", lines[1]);
    let slope: f64 = lines[4].split(',').nth(9).unwrap().parse().unwrap();
    assert_close(slope, curve.slope().unwrap().slope, 1e-6);

    let error = curve.record(8, 0.0, 0, &moments, None).unwrap_err();
    assert_eq!(error.to_string(), "a row at 8 samples was recorded after one at 8");
}
