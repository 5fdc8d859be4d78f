//! Wavefront OBJ, through `tobj`.
//!
//! `tobj` resolves the indices. It does not say on which line an error is, takes coordinates that are not finite, has index
//! arithmetic that overflows, refuses some harmless lines and cuts polygons that are not convex wrongly. So [`clean`] goes
//! over the lines first: it finds the first that is wrong, and passes on those that make polygons, which
//! [`polygon`](super::polygon) cuts.

use std::borrow::Cow;
use std::collections::HashMap;

use super::polygon::{Cutter, MAX_CORNERS};
use super::{Fault, Mesh};

const OPTIONS: tobj::LoadOptions =
    tobj::LoadOptions { single_index: false, triangulate: false, ignore_points: true, ignore_lines: true };

/// Keywords without a shape: names, groups, materials, and how it is shaded and drawn.
const WITHOUT_SHAPE: [&str; 21] = [
    "o",
    "g",
    "s",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "vp",
    "bmat",
    "step",
    "cstype",
    "deg",
];

/// Keywords of shapes that are not made of polygons, and of what belongs to these.
const OTHER_SHAPES: [(&str, &str); 12] = [
    ("l", "lines"),
    ("p", "points"),
    ("curv", "curves"),
    ("curv2", "curves"),
    ("surf", "curved surfaces"),
    ("parm", "curved surfaces"),
    ("trim", "curved surfaces"),
    ("hole", "curved surfaces"),
    ("scrv", "curved surfaces"),
    ("sp", "curved surfaces"),
    ("con", "curved surfaces"),
    ("end", "curved surfaces"),
];

pub(super) fn parse(bytes: &[u8]) -> Result<Mesh, Fault> {
    let text = with_one_kind_of_line_end(decoded(bytes)?);
    let text = join_continued_lines(text);
    let cleaned = clean(&text)?;
    let whole = |why: &str| Fault::new("as a whole", why);
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let (models, _) =
        tobj::load_obj_buf(&mut cleaned.text.as_bytes(), &OPTIONS, no_materials).map_err(|e| whole(&e.to_string()))?;
    // Without `o` and `g` lines there is one model.
    let model = models.first().ok_or_else(|| whole("nothing was read"))?;
    let mut mesh = convert(&model.mesh, &cleaned).ok_or_else(|| whole("its indices are inconsistent"))?;
    mesh.left_out.splice(0..0, cleaned.left_out);
    Ok(mesh)
}

/// The text of a file in UTF-8, with or without a mark in front, in UTF-16 or in an encoding that has ASCII in it: names and
/// comments may be in any; the rest is ASCII.
fn decoded(bytes: &[u8]) -> Result<Cow<'_, str>, Fault> {
    let wide = |bytes: &[u8], word: fn([u8; 2]) -> u16| {
        let (pairs, _) = bytes.as_chunks::<2>();
        let words: Vec<u16> = pairs.iter().map(|pair| word(*pair)).collect();
        Cow::Owned(String::from_utf16_lossy(&words))
    };
    let text = match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest),
        [0xff, 0xfe, rest @ ..] => wide(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => wide(rest, u16::from_be_bytes),
        // Without a mark, by the zero half of the first letter.
        [1..=255, 0, ..] => wide(bytes, u16::from_le_bytes),
        [0, 1..=255, ..] => wide(bytes, u16::from_be_bytes),
        _ => String::from_utf8_lossy(bytes),
    };
    match text.split('\0').next() {
        Some(before) if before.len() < text.len() => {
            let line = before.lines().count().max(1);
            Err(Fault::new(format!("line {line}"), "a zero byte: this is no text in UTF-8, UTF-16 or the like"))
        }
        _ => Ok(text),
    }
}

/// Lines end with `\n`, `\r\n` or `\r`.
fn with_one_kind_of_line_end(text: Cow<'_, str>) -> Cow<'_, str> {
    if text.contains('\r') { Cow::Owned(text.replace("\r\n", "\n").replace('\r', "\n")) } else { text }
}

/// A backslash at the end of a line continues it, but not in a comment. The joined line is followed by empty ones, so that
/// lines keep their numbers.
fn join_continued_lines(text: Cow<'_, str>) -> Cow<'_, str> {
    if !text.contains('\\') {
        return text;
    }
    let (mut joined, mut continued) = (String::with_capacity(text.len() + 1), 0);
    for line in text.lines() {
        let start = line.trim_end().strip_suffix('\\');
        if let Some(start) = start.filter(|start| !start.contains('#')) {
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
    /// The line of each face.
    lines: Vec<usize>,
    left_out: Vec<String>,
}

/// Finds the first line that is wrong; drops what is not needed.
fn clean(text: &str) -> Result<Cleaned, Fault> {
    let mut out = String::with_capacity(text.len() + 1);
    let mut counts = [0_usize; 3];
    let (mut corners, mut with_normal) = (0_usize, 0_usize);
    let (mut lines, mut others) = (Vec::new(), Others::default());
    for (number, line) in text.lines().enumerate() {
        let fault = |why: String| Fault::new(format!("line {}", number + 1), why);
        let line = line.split('#').next().unwrap_or_default();
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
                // Nothing here reads them.
                counts[1] += 1;
                out.push_str("vt 0 0\n");
                continue;
            }
            Some("vn") => {
                let normal = numbers(words, 3, "normal").map_err(fault)?;
                counts[2] += 1;
                out.push_str(&format!("vn {} {} {}\n", normal[0], normal[1], normal[2]));
                continue;
            }
            // `fo` is what it was called once.
            Some("f" | "fo") => {
                let mut size = 0;
                out.push('f');
                for word in words {
                    out.push(' ');
                    out.push_str(word);
                    with_normal += usize::from(corner(word, counts).map_err(fault)?);
                    size += 1;
                }
                if size < 3 {
                    return Err(fault(format!("a face of {size} vertices, at least 3 are needed")));
                }
                if size > MAX_CORNERS {
                    return Err(fault(format!("a face of {size} vertices, at most {MAX_CORNERS} are possible")));
                }
                corners += size;
                lines.push(number + 1);
                out.push('\n');
            }
            Some(word) => others.add(word, number + 1).map_err(fault)?,
            None => {}
        }
    }
    let all_have_normals = corners > 0 && with_normal == corners;
    Ok(Cleaned { text: out, all_have_normals, lines, left_out: others.in_words() })
}

/// Lines that make no triangles, with the first line and the number of each kind.
#[derive(Default)]
struct Others(Vec<(String, usize, usize)>);

impl Others {
    fn add(&mut self, keyword: &str, line: usize) -> Result<(), String> {
        if WITHOUT_SHAPE.contains(&keyword) {
            return Ok(());
        }
        let known = ["v", "vt", "vn", "f"].into_iter().find(|known| keyword.eq_ignore_ascii_case(known));
        if let Some(known) = known {
            return Err(format!("'{keyword}' is no keyword; perhaps '{known}' is meant"));
        }
        // The rest of a line that was broken.
        if keyword.starts_with(|c: char| c.is_ascii_digit() || "+-./\\".contains(c)) {
            return Err(format!("'{}' is no keyword; does this belong to the line before?", shown(keyword)));
        }
        let shape = OTHER_SHAPES.iter().find(|(other, _)| *other == keyword);
        let kind =
            shape.map_or_else(|| format!("'{}', which is no keyword", shown(keyword)), |(_, kind)| kind.to_string());
        let is_full = self.0.len() == 16;
        match self.0.iter_mut().find(|(known, ..)| *known == kind) {
            Some((_, _, count)) => *count += 1,
            // A file of noise has many.
            None if is_full => {}
            None => self.0.push((kind, line, 1)),
        }
        Ok(())
    }

    fn in_words(self) -> Vec<String> {
        let words = self.0.into_iter().map(|(kind, line, count)| match count {
            1 => format!("line {line}, {kind}, is left out"),
            _ => format!("{count} lines from line {line} on, {kind}, are left out"),
        });
        words.collect()
    }
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

/// Cuts the polygons, and makes one index a corner of the separate indices for positions and normals. `None` if they do not
/// belong together.
fn convert(from: &tobj::Mesh, cleaned: &Cleaned) -> Option<Mesh> {
    let (positions, []) = from.positions.as_chunks::<3>() else {
        return None;
    };
    let (normals, _) = from.normals.as_chunks::<3>();
    let with_normals = cleaned.all_have_normals;
    if with_normals && from.normal_indices.len() != from.indices.len() {
        return None;
    }
    let mut mesh = Mesh::default();
    if !with_normals {
        mesh.positions = positions.to_vec();
    }
    let (mut split, mut vertices) = (Vec::new(), HashMap::new());
    let (mut cutter, mut corners, mut crossing) = (Cutter::new(), Vec::new(), Vec::new());
    let mut begin = 0;
    for (face, line) in cleaned.lines.iter().enumerate() {
        // Where all are triangles, tobj does not say so.
        let end = begin + from.face_arities.get(face).map_or(3, |size| *size as usize);
        corners.clear();
        for &index in from.indices.get(begin..end)? {
            corners.push(*positions.get(index as usize)?);
        }
        let cut = cutter.cut(&corners);
        if !cut.covers {
            crossing.push(*line);
        }
        for triangle in cut.triangles {
            let mut indices = [0; 3];
            for (index, corner) in indices.iter_mut().zip(triangle) {
                let place = begin + corner as usize;
                *index = if with_normals {
                    let (position, normal) = (from.indices[place], *from.normal_indices.get(place)?);
                    let new = u32::try_from(vertices.len()).ok()?;
                    *vertices.entry((position, normal)).or_insert_with(|| {
                        mesh.positions.push(positions[position as usize]);
                        split.push(normal);
                        new
                    })
                } else {
                    from.indices[place]
                };
            }
            mesh.indices.push(indices);
        }
        begin = end;
    }
    if with_normals {
        mesh.normals = Some(split.into_iter().map(|n| normals.get(n as usize).copied()).collect::<Option<_>>()?);
    }
    if let Some(line) = crossing.first() {
        let count = crossing.len();
        mesh.left_out.push(format!(
            "{count} faces, the first in line {line}, have sides that cross; parts of them may be missing"
        ));
    }
    Some(mesh)
}
