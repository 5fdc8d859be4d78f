//! The buffers of a glTF file: its binary chunk, `data:` URIs and files beside it.

use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::Document;
use gltf::buffer::Source;

use super::is_drawn;
use crate::mesh::{Fault, read_file};

/// Padding is left out by some exporters.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The contents of every buffer that an accessor reads, each at least as long as it is declared. The others are empty.
pub(super) fn load(document: &Document, mut blob: Option<Vec<u8>>, folder: &Path) -> Result<Vec<Vec<u8>>, Fault> {
    let mut used = vec![false; document.buffers().len()];
    let primitives = document.meshes().flat_map(|mesh| mesh.primitives()).filter(|one| is_drawn(one.mode()));
    let accessors = primitives
        .flat_map(|one| one.attributes().map(|(_, accessor)| accessor).chain(one.indices()).collect::<Vec<_>>());
    for accessor in accessors {
        let sparse = accessor.sparse().map(|sparse| [sparse.indices().view(), sparse.values().view()]);
        for view in accessor.view().into_iter().chain(sparse.into_iter().flatten()) {
            used[view.buffer().index()] = true;
        }
    }
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        if !used[buffer.index()] {
            buffers.push(Vec::new());
            continue;
        }
        let fault = |why: String| Fault::new(format!("buffer {}", buffer.index()), why);
        let bytes = match buffer.source() {
            Source::Bin => blob.take().ok_or_else(|| fault("the file has no binary chunk for it".into()))?,
            Source::Uri(uri) => read_uri(uri, folder).map_err(fault)?,
        };
        if bytes.len() < buffer.length() {
            return Err(fault(format!("has {} bytes, {} are declared", bytes.len(), buffer.length())));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

fn read_uri(uri: &str, folder: &Path) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (kind, encoded) = data.split_once(',').ok_or("its data URI has no comma")?;
        if !kind.ends_with(";base64") {
            return Err("its data URI is not in base64".into());
        }
        return BASE64.decode(encoded).map_err(|e| format!("its data URI is not valid base64: {e}"));
    }
    let name = percent_decoded(uri).ok_or_else(|| format!("its URI {uri:?} is not valid"))?;
    let relative = PathBuf::from(&name);
    if name.contains("://") || !relative.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir)) {
        return Err(format!("its URI {name:?} is not the name of a file beside the glTF file or below it"));
    }
    read_file(&folder.join(relative)).map_err(|e| e.to_string())
}

fn percent_decoded(uri: &str) -> Option<String> {
    let (mut out, mut bytes) = (Vec::with_capacity(uri.len()), uri.bytes());
    while let Some(byte) = bytes.next() {
        if byte == b'%' {
            let digit = |b: Option<u8>| char::from(b?).to_digit(16);
            let (high, low) = (digit(bytes.next())?, digit(bytes.next())?);
            out.push((high * 16 + low) as u8);
        } else {
            out.push(byte);
        }
    }
    String::from_utf8(out).ok()
}
