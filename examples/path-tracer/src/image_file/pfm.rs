//! PFM, portable float map: <https://www.pauldebevec.com/Research/HDR/PFM/>.
//!
//! `PF`, width and height, a scale that is negative for little-endian data, then rows from the bottom, each pixel three
//! `f32`. `Pf` has one `f32` a pixel, which is read as grey.

use std::io::{self, Write};

use super::Image;

pub(super) fn write(image: &Image, to: &mut impl Write) -> io::Result<()> {
    write!(to, "PF\n{} {}\n-1.0\n", image.width, image.height)?;
    for row in image.pixels.chunks_exact(image.width as usize).rev() {
        for value in row.iter().flatten() {
            to.write_all(&value.to_le_bytes())?;
        }
    }
    Ok(())
}

struct Header {
    width: u32,
    height: u32,
    channels: usize,
    little_endian: bool,
    /// Where the pixels begin.
    data: usize,
}

pub(super) fn size(bytes: &[u8]) -> Result<(u32, u32), String> {
    header(bytes).map(|h| (h.width, h.height))
}

fn header(bytes: &[u8]) -> Result<Header, String> {
    let mut at = 0;
    let mut word = || {
        // White space before a word; exactly one character after it.
        while bytes.get(at).is_some_and(u8::is_ascii_whitespace) {
            at += 1;
        }
        let start = at.min(bytes.len());
        at = start;
        while bytes.get(at).is_some_and(|b| !b.is_ascii_whitespace()) && at - start < 32 {
            at += 1;
        }
        let word = std::str::from_utf8(&bytes[start..at]).unwrap_or("?").to_owned();
        at += 1;
        (word, at)
    };
    let channels = match word().0.as_str() {
        "PF" => 3,
        "Pf" => 1,
        _ => return Err("does not begin with 'PF': it is not a portable float map".into()),
    };
    let mut extent = |what: &str| match word().0 {
        text if text.is_empty() => Err(format!("ends within the header: it has no {what}")),
        text => match text.parse::<u32>() {
            Ok(extent) if extent > 0 => Ok(extent),
            _ => Err(format!("the {what} in the header, {text:?}, is not a positive integer")),
        },
    };
    let (width, height) = (extent("width")?, extent("height")?);
    let (scale, data) = word();
    match scale.parse::<f32>() {
        Ok(s) if s.is_finite() && s != 0.0 => Ok(Header { width, height, channels, little_endian: s < 0.0, data }),
        _ => Err(format!("the scale in the header, {scale:?}, is neither a positive nor a negative number")),
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<Image, String> {
    let Header { width, height, channels, little_endian, data } = header(bytes)?;
    let data = bytes.get(data..).unwrap_or_default();
    // 2^32 * 2^32 * 12 fits in u128, and what fits in the file fits in memory.
    let needed = u128::from(width) * u128::from(height) * (4 * channels as u128);
    if data.len() as u128 != needed {
        let kind = if (data.len() as u128) < needed { "cut short" } else { "too long" };
        return Err(format!("is {kind}: {} bytes of pixels, {width}x{height} has {needed}", data.len()));
    }
    let value = |b: &[u8; 4]| {
        if little_endian { f32::from_le_bytes(*b) } else { f32::from_be_bytes(*b) }
    };
    let (values, _) = data.as_chunks::<4>();
    let pixel = |p: &[[u8; 4]]| {
        if let [r, g, b] = p { [r, g, b].map(value) } else { [value(&p[0]); 3] }
    };
    let rows = values.chunks_exact(width as usize * channels).rev();
    Ok(Image { width, height, pixels: rows.flat_map(|row| row.chunks_exact(channels).map(pixel)).collect() })
}
