//! The plot is drawn for every kind of curve. Set `PLOT_DIR` to look at them.

use optix_host::report::Rejected;

use super::*;

fn curve(rows: u32, with_reference: bool, second: f64) -> ErrorCurve {
    let mut curve = ErrorCurve::new();
    for k in 0..rows {
        let n = f64::from(k).exp2();
        let wobble = 1.0 + 0.08 * f64::from(k * 7 % 5) / f64::from(k + 1);
        let error = 0.8 * n.powf(-0.5) * wobble;
        let row = Row {
            samples: 1 << k,
            seconds: second * (n + 0.5),
            rays: 1_000_000 << k,
            estimated_rmse: (k > 0).then_some(error),
            relative_error: (k > 0).then_some(error / 0.4),
            true_rmse: with_reference.then_some((error * error * 1.05 + 1e-4).sqrt()),
            bias: with_reference.then_some(1e-3),
            bias_error: with_reference.then_some(1e-3),
            rejected: Rejected { pixel_passes: u64::from(with_reference), samples: u64::from(with_reference) * 3 },
        };
        curve.push(row).unwrap();
    }
    curve
}

#[test]
fn every_curve_can_be_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let keep = std::env::var_os("PLOT_DIR").map(std::path::PathBuf::from);
    let folder = keep.as_deref().unwrap_or(folder.path());
    let cases = [
        ("both", curve(14, true, 0.011)),
        ("estimate", curve(7, false, 0.4)),
        ("long", curve(33, false, 1e-4)),
        ("two", curve(2, true, 0.01)),
        ("one", curve(1, false, 0.01)),
        ("empty", ErrorCurve::new()),
        ("timeless", curve(6, true, 0.0)),
        ("eternal", curve(6, true, 1e300)),
    ];
    for (name, curve) in cases {
        let path = folder.join(format!("{name}.png"));
        let title = "Cornell box, 512x512, 8 bounces — CPU executor, 16 threads";
        write_plot(&curve, title, &path).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(std::fs::read(&path).unwrap().starts_with(b"\x89PNG"));
    }
    let unwritable = write_plot(&ErrorCurve::new(), "", &folder.join("missing/a.png")).unwrap_err();
    assert!(unwritable.to_string().contains("cannot be written"));
}

#[test]
fn text_is_drawn_without_system_fonts() {
    let (with, without) = (draw(&ErrorCurve::new(), "title").unwrap(), draw(&ErrorCurve::new(), "").unwrap());
    assert_ne!(with, without);
}
