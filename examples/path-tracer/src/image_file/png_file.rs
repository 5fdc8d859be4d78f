//! PNG: 8 bits a channel, sRGB.

use std::io::{self, Write};

use super::Image;

/// Linear radiance to display-linear light in 0 to 1, a channel: the fit of the ACES filmic curve by Krzysztof
/// Narkowicz, "ACES Filmic Tone Mapping Curve" (2016), <https://knarkowicz.wordpress.com/2016/01/06/>.
///
/// Rises monotonically from 0, has a soft toe, takes 1 to 0.80 and reaches 1 near 6. Negative values and NaN become 0,
/// infinity 1.
#[must_use]
pub fn tone_map(radiance: f32) -> f32 {
    if radiance.is_nan() {
        return 0.0;
    }
    // Beyond the clamp the curve is 1, and inf / inf would be NaN.
    let x = radiance.clamp(0.0, 1e4);
    ((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)).min(1.0)
}

/// Light in 0 to 1 to an sRGB code (IEC 61966-2-1), rounded.
fn srgb(light: f32) -> u8 {
    let encoded = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}

pub(super) fn write(image: &Image, exposure: f32, to: impl Write) -> io::Result<()> {
    let gain = exposure.exp2();
    let bytes: Vec<u8> = image.pixels.iter().flatten().map(|&x| srgb(tone_map(x * gain))).collect();
    encode_rgb(image.width, image.height, &bytes, to)
}

/// Writes `3 * width * height` bytes of sRGB as a PNG.
///
/// # Errors
/// Those of the writer, and a size that is zero or not that of `bytes`.
pub fn encode_rgb(width: u32, height: u32, bytes: &[u8], to: impl Write) -> io::Result<()> {
    let mut encoder = png::Encoder::new(to, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()?;
    Ok(())
}
