//! What the user sees of a render: a bar while it runs, a few lines at its end.

use std::fmt;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Renders that are done sooner show no bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// A progress bar on standard error. Hidden where that is no terminal, and for the first half second.
///
/// Clears itself when finished or dropped, so that an error message starts on a line of its own.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    start: Instant,
    shown: bool,
}

impl Progress {
    /// A bar over `samples` samples a pixel.
    #[must_use]
    pub fn new(samples: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(samples), ProgressDrawTarget::hidden());
        let template = "{elapsed_precise} [{bar:40}] {pos}/{len} samples {msg} (about {eta} left)";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        Self { bar, start: Instant::now(), shown: false }
    }

    /// Shows that `samples` samples a pixel and `rays` rays are done, and the error if it is known.
    pub fn update(&mut self, samples: u64, rays: u64, relative_error: Option<f64>) {
        let elapsed = self.start.elapsed();
        if !self.shown && elapsed >= PATIENCE {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            self.shown = true;
        }
        let error = relative_error.map_or_else(String::new, |e| format!(", error {}", percent(e)));
        self.bar.set_message(format!("{}{error}", rate(rays, elapsed.as_secs_f64())));
        self.bar.set_position(samples);
    }

    /// Takes the bar away.
    pub fn finish(self) {}
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// The numbers of a finished render. Displays as the lines at its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// What rendered, such as `CPU executor, 16 threads` or `OptiX, NVIDIA H100 (driver 580.82)`.
    pub device: String,
    /// Width and height.
    pub size: (u32, u32),
    /// Wall time of the rendering, in seconds.
    pub seconds: f64,
    /// Samples a pixel.
    pub samples: u64,
    /// Rays traced, of all kinds.
    pub rays: u64,
    /// Estimated relative standard error of the picture; `None` below two samples and for a black picture.
    pub relative_error: Option<f64>,
    /// Samples left out because they were not finite.
    pub rejected_samples: u64,
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (width, height) = self.size;
        writeln!(f, "device:          {}", self.device)?;
        writeln!(f, "wall time:       {:.3} s", self.seconds)?;
        writeln!(f, "samples:         {} per pixel at {width}x{height}", grouped(self.samples))?;
        writeln!(f, "rays traced:     {} ({})", grouped(self.rays), rate(self.rays, self.seconds))?;
        write!(f, "estimated error: ")?;
        match self.relative_error {
            Some(error) => write!(f, "{} relative standard error", percent(error))?,
            None if self.samples < 2 => write!(f, "unknown, it takes two samples per pixel")?,
            None => write!(f, "unknown, the picture is black")?,
        }
        if self.rejected_samples > 0 {
            write!(f, "\nwarning: {} samples were not finite and were left out", grouped(self.rejected_samples))?;
        }
        Ok(())
    }
}

/// Rays a second, in millions.
fn rate(rays: u64, seconds: f64) -> String {
    if seconds > 0.0 { format!("{:.2} Mrays/s", rays as f64 / seconds / 1e6) } else { "- Mrays/s".into() }
}

/// Three significant digits.
fn percent(fraction: f64) -> String {
    let percent = fraction * 100.0;
    let digits = if percent > 0.0 { (2.0 - percent.log10().floor()).clamp(0.0, 12.0) as usize } else { 0 };
    format!("{percent:.digits$} %")
}

/// Thousands set apart: 1,234,567.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_has_every_number() {
        let mut summary = Summary {
            device: "CPU executor, 2 threads".into(),
            size: (512, 512),
            seconds: 12.3456,
            samples: 1024,
            rays: 1_234_567_890,
            relative_error: Some(0.012_345),
            rejected_samples: 0,
        };
        let expected = "device:          CPU executor, 2 threads\n\
                        wall time:       12.346 s\n\
                        samples:         1,024 per pixel at 512x512\n\
                        rays traced:     1,234,567,890 (100.00 Mrays/s)\n\
                        estimated error: 1.23 % relative standard error";
        assert_eq!(summary.to_string(), expected);
        (summary.relative_error, summary.rejected_samples) = (None, 3);
        let text = summary.to_string();
        assert!(text.ends_with("the picture is black\nwarning: 3 samples were not finite and were left out"));
        (summary.samples, summary.seconds) = (1, 0.0);
        let text = summary.to_string();
        assert!(text.contains("unknown, it takes two samples") && text.contains("(- Mrays/s)"), "{text}");
    }

    #[test]
    fn numbers_are_readable() {
        assert_eq!([0, 999, 1000, 1_000_000].map(grouped), ["0", "999", "1,000", "1,000,000"]);
        assert_eq!([0.0, 1.5, 0.1, 0.000_123_4, 1e-20].map(percent)[..4], ["0 %", "150 %", "10.0 %", "0.0123 %"]);
    }

    #[test]
    fn a_bar_can_run_without_a_terminal() {
        let mut progress = Progress::new(4);
        progress.start = Instant::now().checked_sub(PATIENCE).unwrap_or_else(Instant::now);
        for samples in 1..=5 {
            progress.update(samples, samples * 1000, (samples > 1).then_some(0.1));
        }
        progress.finish();
    }
}
