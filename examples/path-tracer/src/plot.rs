//! The report as a picture: error against samples and against run time, on log-log axes.
//!
//! Drawn by `plotters` with a font that is compiled in (DejaVu Sans, which has the superscripts), so that it looks the same on
//! a machine without fonts.

mod axis;
#[cfg(test)]
mod tests;

use std::path::Path;
use std::sync::Once;

use optix_host::report::{ErrorCurve, PowerLaw, Row};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::register_font;

use crate::image_file::{ImageError, encode_rgb, write_beside};
use axis::{Axis, Base};

const SIZE: (u32, u32) = (1600, 800);
const FONT: &str = "sans-serif";
const INK: RGBColor = RGBColor(40, 40, 40);
const GRID: RGBColor = RGBColor(216, 216, 216);
const FAINT: RGBColor = RGBColor(238, 238, 238);
const ESTIMATED: RGBColor = RGBColor(0, 95, 175);
const TRUE: RGBColor = RGBColor(200, 75, 0);
const IDEAL: RGBColor = RGBColor(130, 130, 130);

/// Draws the curve and writes it as a PNG: estimated RMSE, true RMSE where it is known, and the line of slope -1/2
/// nearest to the estimates. `title` is a line above the panels, such as the scene, the size and the device.
///
/// # Errors
/// [`ImageError`]; the target is then as it was. A curve with no estimate yet gives an empty plot that says so.
pub fn write_plot(curve: &ErrorCurve, title: &str, path: &Path) -> Result<(), ImageError> {
    let fail = |why: String| ImageError::Io { path: path.to_owned(), verb: "written", why };
    let pixels = draw(curve, title).map_err(fail)?;
    write_beside(path, |to| encode_rgb(SIZE.0, SIZE.1, &pixels, to))
}

/// The plot's pixels, 3 bytes each.
fn draw(curve: &ErrorCurve, title: &str) -> Result<Vec<u8>, String> {
    static FONT_IS_KNOWN: Once = Once::new();
    FONT_IS_KNOWN.call_once(|| {
        // Were the font broken, drawing would return an error.
        let _ = register_font(FONT, FontStyle::Normal, dejavu::sans::regular());
    });
    let mut pixels = vec![0; 3 * (SIZE.0 * SIZE.1) as usize];
    {
        let root = BitMapBackend::with_buffer(&mut pixels, SIZE).into_drawing_area();
        draw_on(&root, curve, title).map_err(|e| e.to_string())?;
        root.present().map_err(|e| e.to_string())?;
    }
    Ok(pixels)
}

type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw_on(root: &Area<'_>, curve: &ErrorCurve, title: &str) -> Drawn {
    root.fill(&WHITE)?;
    let heading = (FONT, 30).into_font().color(&INK);
    root.draw(&Text::new(shortened(title), (28, 18), heading))?;
    let note = (FONT, 22).into_font().color(&INK);
    root.draw(&Text::new(subtitle(curve), (28, 56), note))?;
    let (left, right) = root.margin(96, 16, 12, 12).split_horizontally(50.percent_width());
    let errors: Vec<f64> = curve.rows().iter().flat_map(|r| [r.estimated_rmse, r.true_rmse]).flatten().collect();
    let Some(vertical) = Axis::over("RMSE (radiance)", Base::Ten, errors) else {
        root.draw(&Text::new("no estimate yet: it takes two samples a pixel", (28, 110), note_style()))?;
        return Ok(());
    };
    let samples = |r: &Row| r.samples as f64;
    panel(&left, curve, &vertical, Base::Two, "samples per pixel", "1/√n", samples)?;
    panel(&right, curve, &vertical, Base::Ten, "render time (s)", "1/√t", |r: &Row| r.seconds)
}

fn note_style() -> TextStyle<'static> {
    (FONT, 24).into_font().color(&INK)
}

/// A line that fits; control characters would draw as boxes.
fn shortened(title: &str) -> String {
    let clean = || title.chars().map(|c| if c.is_control() { ' ' } else { c });
    if clean().count() <= 100 { clean().collect() } else { clean().take(99).chain(['…']).collect() }
}

fn subtitle(curve: &ErrorCurve) -> String {
    let slope = |law: PowerLaw| match law.slope_error {
        Some(error) => format!("{:.3} ± {error:.3}", law.slope),
        None => format!("{:.3}", law.slope),
    };
    let mut parts = Vec::new();
    parts.extend(curve.slope().map(|l| format!("slope of the estimated error against samples: {}", slope(l))));
    parts.extend(curve.true_slope().map(|l| format!("slope of the true error: {}", slope(l))));
    let rejected = curve.rows().last().map_or(0, |r| r.rejected.samples);
    if rejected > 0 {
        parts.push(format!("{rejected} samples were not finite"));
    }
    parts.join("; ")
}

fn panel(
    area: &Area<'_>,
    curve: &ErrorCurve,
    vertical: &Axis,
    base: Base,
    label: &str,
    ideal_name: &str,
    x_of: impl Fn(&Row) -> f64,
) -> Drawn {
    let points = |y_of: fn(&Row) -> Option<f64>| -> Vec<(f64, f64)> {
        let usable = |v: f64| v > 0.0 && v.is_finite();
        let all = curve.rows().iter().filter_map(|r| Some((x_of(r), y_of(r)?)));
        all.filter(|&(x, y)| usable(x) && usable(y)).collect()
    };
    let (estimated, measured) = (points(|r| r.estimated_rmse), points(|r| r.true_rmse));
    let all_x = estimated.iter().chain(&measured).map(|p| p.0);
    let Some(horizontal) = Axis::over(label, base, all_x) else {
        area.draw(&Text::new("no run time was recorded", (80, 40), note_style()))?;
        return Ok(());
    };
    let mut chart = ChartBuilder::on(area)
        .margin_right(24)
        .x_label_area_size(72)
        .y_label_area_size(104)
        .build_cartesian_2d(horizontal.clone(), vertical.clone())?;
    chart
        .configure_mesh()
        .bold_line_style(GRID)
        .light_line_style(FAINT)
        .axis_style(INK.stroke_width(2))
        .x_label_formatter(&|v| horizontal.tick_label(*v))
        .y_label_formatter(&|v| vertical.tick_label(*v))
        .label_style((FONT, 22).into_font().color(&INK))
        .axis_desc_style((FONT, 25).into_font().color(&INK))
        .x_desc(horizontal.label())
        .y_desc(vertical.label())
        .draw()?;

    let logs = |p: &[(f64, f64)]| p.iter().map(|p| (p.0.log10(), p.1.log10())).collect::<Vec<_>>();
    if let Some(ideal) = PowerLaw::through(-0.5, estimated.iter().copied()) {
        // In logarithms y = offset - x / 2. What lies outside the panel would be drawn along its border.
        let offset = ideal.at(1.0).log10();
        let from = horizontal.low().max(2.0 * (offset - vertical.high()));
        let to = horizontal.high().min(2.0 * (offset - vertical.low()));
        let inside = [from, to].map(|x| (x, offset - x / 2.0)).into_iter().filter(|_| from < to);
        chart
            .draw_series(DashedLineSeries::new(inside, 12, 8, IDEAL.stroke_width(3)))?
            .label(ideal_name)
            .legend(|(x, y)| PathElement::new([(x, y), (x + 36, y)], IDEAL.stroke_width(3)));
    }
    for (points, colour, name) in [(measured, TRUE, "true RMSE"), (estimated, ESTIMATED, "estimated RMSE")] {
        if points.is_empty() {
            continue;
        }
        let points = logs(&points);
        chart
            .draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(3)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 36, y)], colour.stroke_width(4)));
        chart.draw_series(points.iter().map(|&p| Circle::new(p, 6, colour.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .margin(16)
        .legend_area_size(48)
        .label_font((FONT, 22).into_font().color(&INK))
        .background_style(WHITE.mix(0.9))
        .border_style(GRID)
        .draw()?;
    Ok(())
}
