//! Power laws through measured points.

/// `y = exp(intercept) * x^slope`, fitted by least squares in the logarithms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// Exponent; -0.5 for the error of an unbiased Monte Carlo estimate against its samples.
    pub slope: f64,
    /// Standard error of [`slope`](Self::slope) from the scatter of the points about the line; `None` below three points. The
    /// rows of an error curve share their samples, which this does not know: it tells how straight the curve is.
    pub slope_error: Option<f64>,
    /// Natural logarithm of `y` at `x = 1`.
    pub intercept: f64,
    /// Points that were used.
    pub points: usize,
}

impl PowerLaw {
    /// Fits the points `(x, y)`. Points with a coordinate that is not positive and finite have no logarithm and are
    /// left out. `None` below two different `x`.
    #[must_use]
    pub fn fit(points: impl IntoIterator<Item = (f64, f64)>) -> Option<Self> {
        let logs = logarithms(points);
        let n = logs.len() as f64;
        let (mx, my) = (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
        let sxx: f64 = logs.iter().map(|p| (p.0 - mx).powi(2)).sum();
        let sxy: f64 = logs.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
        if logs.len() < 2 || sxx <= 0.0 {
            return None;
        }
        let slope = sxy / sxx;
        let residual: f64 = logs.iter().map(|p| (p.1 - my - slope * (p.0 - mx)).powi(2)).sum();
        Some(Self {
            slope,
            slope_error: (logs.len() > 2).then(|| (residual / (n - 2.0) / sxx).sqrt()),
            intercept: my - slope * mx,
            points: logs.len(),
        })
    }

    /// The line of a given slope that lies nearest to the points; `None` without points.
    #[must_use]
    pub fn through(slope: f64, points: impl IntoIterator<Item = (f64, f64)>) -> Option<Self> {
        let logs = logarithms(points);
        let sum: f64 = logs.iter().map(|p| p.1 - slope * p.0).sum();
        (!logs.is_empty()).then(|| Self {
            slope,
            slope_error: None,
            intercept: sum / logs.len() as f64,
            points: logs.len(),
        })
    }

    /// The law's value at `x`, which must be positive.
    #[must_use]
    pub fn at(&self, x: f64) -> f64 {
        (self.intercept + self.slope * x.ln()).exp()
    }
}

fn logarithms(points: impl IntoIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let usable = |v: f64| v > 0.0 && v.is_finite();
    points.into_iter().filter(|p| usable(p.0) && usable(p.1)).map(|p| (p.0.ln(), p.1.ln())).collect()
}
