//! OpenEXR, through `exr`.

use std::io::{self, Cursor, Seek, Write};

use exr::prelude::{
    Encoding, MetaData, ReadChannels, ReadLayers, SpecificChannels, Vec2, WritableImage, read as read_exr,
};

use super::{Image, MAX_PIXELS};

pub(super) fn write(image: &Image, to: &mut (impl Write + Seek)) -> io::Result<()> {
    let (width, height) = (image.width as usize, image.height as usize);
    let channels = SpecificChannels::rgb(|at: Vec2<usize>| {
        let [r, g, b] = image.pixels[at.y() * width + at.x()];
        (r, g, b)
    });
    let layer = exr::prelude::Layer::new(
        (width, height),
        exr::prelude::LayerAttributes::default(),
        Encoding::SMALL_LOSSLESS,
        channels,
    );
    exr::prelude::Image::from_layer(layer).write().non_parallel().to_buffered(to).map_err(io::Error::other)
}

pub(super) fn size(bytes: &[u8]) -> Result<(u32, u32), String> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|e| describe(&e))?;
    let size = meta.headers.first().ok_or("has no layer")?.layer_size;
    if size.area() as u64 > MAX_PIXELS {
        return Err(format!("{}x{} is more than 2^30 pixels", size.width(), size.height()));
    }
    // Each is at least 1, so neither exceeds the product.
    Ok((size.width() as u32, size.height() as u32))
}

pub(super) fn read(bytes: &[u8]) -> Result<Image, String> {
    let image = read_exr()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| Image {
                width: size.width() as u32,
                height: size.height() as u32,
                pixels: vec![[0.0; 3]; size.area()],
            },
            |image: &mut Image, at, (r, g, b): (f32, f32, f32)| {
                image.pixels[at.y() * image.width as usize + at.x()] = [r, g, b];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| describe(&e))?;
    Ok(image.layer_data.channel_data.pixels)
}

fn describe(error: &exr::error::Error) -> String {
    format!("is not a readable OpenEXR picture with channels R, G and B: {error}").replace('\n', " ")
}
