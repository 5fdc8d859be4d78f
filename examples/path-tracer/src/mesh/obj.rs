//! Wavefront OBJ, through `tobj`.
//!
//! `tobj` resolves the indices and cuts the polygons. It does not say on which line an error is, takes coordinates that
//! are not finite, has index arithmetic that overflows, and refuses some harmless lines. So [`clean`] goes over the
//! lines first: it finds the first that is wrong, and passes on those that make triangles.

use std::borrow::Cow;
use std::collections::HashMap;

use super::{Fault, Mesh};

const OPTIONS: tobj::LoadOptions =
    tobj::LoadOptions { single_index: false, triangulate: true, ignore_points: true, ignore_lines: true };

pub(super) fn parse(bytes: &[u8]) -> Result<Mesh, Fault> {
    // Names and comments may be in any encoding; the rest is ASCII.
    let text = join_continued_lines(String::from_utf8_lossy(bytes));
    let cleaned = clean(&text)?;
    let whole = |why: &str| Fault::new("as a whole", why);
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let (models, _) =
        tobj::load_obj_buf(&mut cleaned.text.as_bytes(), &OPTIONS, no_materials).map_err(|e| whole(&e.to_string()))?;
    // Without `o` and `g` lines there is one model.
    let model = models.first().ok_or_else(|| whole("nothing was read"))?;
    convert(&model.mesh, cleaned.all_have_normals).ok_or_else(|| whole("its indices are inconsistent"))
}

/// A backslash at the end of a line continues it. The joined line is followed by empty ones, so that lines keep their
/// numbers.
fn join_continued_lines(text: Cow<'_, str>) -> Cow<'_, str> {
    if !text.contains("\\\n") && !text.contains("\\\r\n") {
        return text;
    }
    let (mut joined, mut continued) = (String::with_capacity(text.len() + 1), 0);
    for line in text.lines() {
        if let Some(start) = line.strip_suffix('\\') {
            joined.push_str(start);
            joined.push(' ');
            continued += 1;
        } else {
            joined.push_str(line);
            joined.extend(std::iter::repeat_n('\n', continued + 1));
            continued = 0;
        }
    }
    Cow::Owned(joined)
}

struct Cleaned {
    /// The lines `v`, `vt`, `vn` and `f`, without colours. Objects, groups and materials mean nothing here, and would keep
    /// triangles from sharing vertices.
    text: String,
    /// Whether there are faces, and every corner of every face has a normal.
    all_have_normals: bool,
}

/// Finds the first line that is wrong; drops what is not needed.
fn clean(text: &str) -> Result<Cleaned, Fault> {
    let mut out = String::with_capacity(text.len() + 1);
    let mut counts = [0_usize; 3];
    let (mut corners, mut with_normal) = (0_usize, 0_usize);
    for (number, line) in text.lines().enumerate() {
        let fault = |why: String| Fault::new(format!("line {}", number + 1), why);
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let words: Vec<&str> = words.collect();
                let used = vertex(&words).map_err(fault)?;
                counts[0] += 1;
                out.push('v');
                for word in used {
                    out.push(' ');
                    out.push_str(word);
                }
                out.push('\n');
                continue;
            }
            Some("vt") => {
                // The second coordinate may be left out, which tobj does not know; nothing here reads them.
                numbers(words, 1, "texture coordinate").map_err(fault)?;
                counts[1] += 1;
                out.push_str("vt 0 0\n");
                continue;
            }
            Some("vn") => {
                numbers(words, 3, "normal").map_err(fault)?;
                counts[2] += 1;
            }
            Some("f") => {
                let mut size = 0;
                for word in words {
                    with_normal += usize::from(corner(word, counts).map_err(fault)?);
                    size += 1;
                }
                if size < 3 {
                    return Err(fault(format!("a face of {size} vertices, at least 3 are needed")));
                }
                corners += size;
            }
            _ => continue,
        }
        out.push_str(line);
        out.push('\n');
    }
    Ok(Cleaned { text: out, all_have_normals: corners > 0 && with_normal == corners })
}

/// `x y z`, then nothing, a weight, or a colour. Returns what makes the position.
fn vertex<'a, 'w>(words: &'w [&'a str]) -> Result<&'w [&'a str], String> {
    let values = |n| numbers(words.iter().copied(), n, "vertex");
    match words.len() {
        3 | 6 => values(3).map(|_| &words[..3]),
        4 => {
            let [x, y, z, w] = values(4)?;
            let finite = [x, y, z].iter().all(|c| (c / w).is_finite());
            if finite { Ok(words) } else { Err(format!("a vertex with the weight {w} is not finite")) }
        }
        n @ 0..3 => Err(format!("a vertex of {n} numbers, 3 are needed")),
        n => Err(format!("a vertex of {n} numbers; 3, 4 (with a weight) or 6 (with a colour) are known")),
    }
}

/// The first `n` (at most 4) words as finite numbers, the rest of the result being zero.
fn numbers<'a>(mut words: impl Iterator<Item = &'a str>, n: usize, what: &str) -> Result<[f32; 4], String> {
    let mut values = [0.0_f32; 4];
    for value in values.iter_mut().take(n) {
        let word = words.next().ok_or_else(|| format!("a {what} of fewer than {n} numbers"))?;
        *value = word.parse().map_err(|_| format!("'{}' is not a number", shown(word)))?;
        if !value.is_finite() {
            return Err(format!("a {what} with the coordinate {} is not finite", shown(word)));
        }
    }
    Ok(values)
}

/// Checks `v`, `v/vt`, `v//vn` or `v/vt/vn` against the numbers of elements so far. Returns whether there is a normal.
fn corner(word: &str, counts: [usize; 3]) -> Result<bool, String> {
    let mut given = [false; 3];
    for (slot, part) in word.split('/').enumerate() {
        let name = *["vertex", "texture coordinate", "normal"]
            .get(slot)
            .ok_or_else(|| format!("'{}' has more than three indices", shown(word)))?;
        if part.is_empty() && slot > 0 {
            continue;
        }
        let index: i64 = part.parse().map_err(|_| format!("'{}' is not an index", shown(word)))?;
        let count = counts[slot];
        if index == 0 || index.unsigned_abs() > count as u64 {
            return Err(format!("{name} {index} is asked for, {count} are defined above"));
        }
        given[slot] = true;
    }
    Ok(given[2])
}

/// A word fit for an error message of one line.
fn shown(word: &str) -> String {
    word.chars().take(40).flat_map(char::escape_default).collect()
}

/// Makes one index a corner of the separate indices for positions and normals. `None` if they do not belong together.
fn convert(from: &tobj::Mesh, with_normals: bool) -> Option<Mesh> {
    let (positions, []) = from.positions.as_chunks::<3>() else {
        return None;
    };
    let (triangles, []) = from.indices.as_chunks::<3>() else {
        return None;
    };
    if from.indices.iter().any(|&i| i as usize >= positions.len()) {
        return None;
    }
    if !with_normals {
        let (positions, indices) = (positions.to_vec(), triangles.to_vec());
        return Some(Mesh { positions, indices, ..Mesh::default() });
    }
    let (normals, []) = from.normals.as_chunks::<3>() else {
        return None;
    };
    let (normal_triangles, []) = from.normal_indices.as_chunks::<3>() else {
        return None;
    };
    if normal_triangles.len() != triangles.len() {
        return None;
    }
    let (mut mesh, mut split) = (Mesh::default(), Vec::new());
    let mut vertices = HashMap::new();
    for (triangle, of_normals) in triangles.iter().zip(normal_triangles) {
        let mut corners = [0; 3];
        for (corner, pair) in corners.iter_mut().zip(triangle.iter().zip(of_normals)) {
            *corner = match vertices.get(&pair) {
                Some(&known) => known,
                None => {
                    let new = u32::try_from(vertices.len()).ok()?;
                    mesh.positions.push(positions[*pair.0 as usize]);
                    split.push(*normals.get(*pair.1 as usize)?);
                    vertices.insert(pair, new);
                    new
                }
            };
        }
        mesh.indices.push(corners);
    }
    mesh.normals = Some(split);
    Some(mesh)
}
