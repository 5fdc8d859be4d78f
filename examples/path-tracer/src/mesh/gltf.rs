//! glTF 2.0 and GLB, through `gltf`.
//!
//! `gltf` parses and validates the JSON. Its accessor readers trust counts, offsets and types that validation does not
//! look at, and panic where these are wrong; so [`accessor`] reads the buffers here.

mod accessor;
mod buffers;

use std::path::Path;

use gltf::json::validation::Checked;
use gltf::json::{Index, Value};
use gltf::mesh::{Mode, Primitive, Semantic};
use gltf::{Document, Gltf, Node};

use super::{Fault, Mesh, append, cross, unit};

/// Column-major, as in the file: `m[column][row]`.
type Matrix = [[f64; 4]; 4];

const IDENTITY: Matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// Extensions that change nothing in how positions, indices and normals are stored.
const HARMLESS: [&str; 2] = ["KHR_materials_", "KHR_texture_"];

pub(super) fn parse(bytes: &[u8], folder: &Path) -> Result<Mesh, Fault> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(Fault::new("as a whole", "it is in UTF-16; glTF is in UTF-8"));
    }
    let bytes = bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(bytes);
    // gltf subtracts the header's 12 bytes from the length that the header states.
    if bytes.starts_with(b"glTF") && bytes.get(8..12).is_none_or(|n| u32::from_le_bytes([n[0], n[1], n[2], n[3]]) < 12)
    {
        return Err(Fault::new("header", "the binary glTF header is cut short"));
    }
    let Gltf { document, blob } = Gltf::from_slice_without_validation(bytes).map_err(|e| describe(&e))?;
    for extension in document.extensions_required() {
        if !HARMLESS.iter().any(|h| extension.starts_with(h)) {
            return Err(Fault::new("extensionsRequired", format!("{extension:?} is not supported")));
        }
    }
    let mut left_out = LeftOut::default();
    let document = revalidate(document, &mut left_out)?;
    let buffers = buffers::load(&document, blob, folder)?;
    let mut mesh = Mesh::default();
    for (node, world) in placed_nodes(&document)? {
        let Some(part) = node.mesh() else { continue };
        for primitive in part.primitives() {
            add_primitive(&mut mesh, part.index(), &primitive, &world, &buffers)?;
        }
    }
    left_out.count_scenes(&document);
    if document.nodes().len() == 0 {
        for part in document.meshes() {
            for primitive in part.primitives() {
                add_primitive(&mut mesh, part.index(), &primitive, &IDENTITY, &buffers)?;
            }
        }
    }
    mesh.left_out = left_out.in_words();
    Ok(mesh)
}

/// Runs the crate's validation, which makes its accessors safe to call, on what is used of the file.
fn revalidate(document: Document, left_out: &mut LeftOut) -> Result<Document, Fault> {
    let mut json = document.into_json();
    // It knows no extension that it was not compiled with; those that are left are harmless.
    json.extensions_required.clear();
    left_out.has_copies = json.extensions_used.iter().any(|name| name == "EXT_mesh_gpu_instancing");
    only_shapes(&mut json, left_out);
    // It looks positions up before it has checked their index.
    for (m, mesh) in json.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let there = json.accessors.len();
            if let Some(index) = primitive.attributes.values().find(|i| i.value() >= there) {
                let why = format!("accessor {} is asked for, there are {there}", index.value());
                return Err(Fault::new(format!("mesh {m}, primitive {p}"), why));
            }
        }
    }
    Document::from_json(json).map_err(|e| describe(&e))
}

/// Removes everything that is no shape: a fault in it is no reason to refuse the file.
fn only_shapes(json: &mut gltf::json::Root, left_out: &mut LeftOut) {
    json.animations.clear();
    json.cameras.clear();
    json.images.clear();
    json.materials.clear();
    json.samplers.clear();
    json.skins.clear();
    json.textures.clear();
    for node in &mut json.nodes {
        left_out.skins += usize::from(node.skin.take().is_some());
        (node.camera, node.weights) = (None, None);
    }
    let mut used = vec![false; json.accessors.len()];
    let mut positions = Vec::new();
    for mesh in &mut json.meshes {
        mesh.weights = None;
        for primitive in &mut mesh.primitives {
            primitive.material = None;
            left_out.morphs += usize::from(primitive.targets.take().is_some_and(|targets| !targets.is_empty()));
            let position = Checked::Valid(Semantic::Positions);
            let is_shape =
                |semantic: &Checked<Semantic>| *semantic == position || *semantic == Checked::Valid(Semantic::Normals);
            primitive.attributes.retain(|semantic, _| is_shape(semantic));
            let mode = match primitive.mode {
                Checked::Valid(mode) => mode,
                Checked::Invalid => continue,
            };
            if !is_drawn(mode) || !primitive.attributes.contains_key(&position) {
                // glTF 2.0, section 3.7.2.1: one without positions is skipped. Its place stays, for messages.
                if is_drawn(mode) {
                    left_out.without_positions += 1;
                } else {
                    left_out.add(mode);
                }
                primitive.mode = Checked::Valid(Mode::Points);
                (primitive.indices, primitive.attributes) = (None, [(position, Index::new(0))].into());
                positions.push(0);
                continue;
            }
            positions.extend(primitive.attributes.get(&position).map(Index::value));
            for index in primitive.attributes.values().chain(&primitive.indices) {
                if let Some(used) = used.get_mut(index.value()) {
                    *used = true;
                }
            }
        }
    }
    for (at, accessor) in json.accessors.iter_mut().enumerate() {
        // Nothing here reads them; exporters leave them out.
        let bound = positions.contains(&at).then(|| Value::from([0.0; 3].to_vec()));
        (accessor.min, accessor.max) = (bound.clone(), bound);
        if !used[at] {
            // Its place must stay; what it points to need not be there.
            accessor.sparse = None;
            accessor.buffer_view = (!json.buffer_views.is_empty()).then(|| Index::new(0));
        }
    }
}

fn is_drawn(mode: Mode) -> bool {
    matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)
}

/// What of a file is not drawn.
#[derive(Default)]
struct LeftOut {
    /// Primitives by mode.
    modes: Vec<(Mode, usize)>,
    without_positions: usize,
    skins: usize,
    morphs: usize,
    scenes: usize,
    has_copies: bool,
}

impl LeftOut {
    fn add(&mut self, mode: Mode) {
        match self.modes.iter_mut().find(|(known, _)| *known == mode) {
            Some((_, count)) => *count += 1,
            None => self.modes.push((mode, 1)),
        }
    }

    fn count_scenes(&mut self, document: &Document) {
        self.scenes = document.scenes().len().saturating_sub(1);
    }

    fn in_words(self) -> Vec<String> {
        let mut words: Vec<String> = Vec::new();
        let mut add = |count: usize, what: &str| {
            if count > 0 {
                words.push(format!("{count} {what}{} left out", if count == 1 { " is" } else { "s are" }));
            }
        };
        for (mode, count) in self.modes {
            add(count, &format!("{mode:?} primitive"));
        }
        add(self.without_positions, "primitive without POSITION");
        add(self.morphs, "primitive's morph target");
        add(self.skins, "node's skin");
        add(self.scenes, "further scene");
        if self.has_copies {
            words.push("copies by EXT_mesh_gpu_instancing are left out".into());
        }
        words
    }
}

/// The error in one line; of several, the first.
fn describe(error: &gltf::Error) -> Fault {
    match error {
        gltf::Error::Validation(all) => match all.first() {
            Some((path, error)) => Fault::new(path.to_string(), format!("the glTF is not valid: {error}")),
            None => Fault::new("as a whole", "the glTF is not valid"),
        },
        gltf::Error::Deserialize(e) => Fault::new(format!("line {} of the JSON", e.line()), e.to_string()),
        gltf::Error::Binary(e) => Fault::new("binary container", e.to_string()),
        other => Fault::new("as a whole", other.to_string()),
    }
}

/// The scene's nodes with their transforms to the world: of the default scene, else of the first, else of all roots.
fn placed_nodes(document: &Document) -> Result<Vec<(Node<'_>, Matrix)>, Fault> {
    let mut is_child = vec![false; document.nodes().len()];
    for child in document.nodes().flat_map(|n| n.children()) {
        is_child[child.index()] = true;
    }
    let roots: Vec<Node<'_>> = match document.default_scene().or_else(|| document.scenes().next()) {
        Some(scene) => scene.nodes().collect(),
        None => document.nodes().filter(|n| !is_child[n.index()]).collect(),
    };
    let mut seen = vec![false; is_child.len()];
    let mut open: Vec<_> = roots.into_iter().rev().map(|n| (n, IDENTITY)).collect();
    let mut placed = Vec::new();
    while let Some((node, parent)) = open.pop() {
        if std::mem::replace(&mut seen[node.index()], true) {
            let why = "is reached twice; nodes must form a tree";
            return Err(Fault::new(format!("node {}", node.index()), why));
        }
        let local = node.transform().matrix().map(|column| column.map(f64::from));
        let world = multiply(&parent, &local);
        open.extend(node.children().map(|child| (child, world)));
        placed.push((node, world));
    }
    Ok(placed)
}

fn multiply(a: &Matrix, b: &Matrix) -> Matrix {
    b.map(|column| std::array::from_fn(|row| (0..4).map(|k| a[k][row] * column[k]).sum()))
}

fn add_primitive(
    mesh: &mut Mesh,
    mesh_index: usize,
    primitive: &Primitive<'_>,
    world: &Matrix,
    buffers: &[Vec<u8>],
) -> Result<(), Fault> {
    let place = format!("mesh {mesh_index}, primitive {}", primitive.index());
    let fault = |why: String| Fault::new(&place, why);
    if !is_drawn(primitive.mode()) {
        return Ok(());
    }
    let positions = primitive.get(&Semantic::Positions).ok_or_else(|| fault("has no POSITION".into()))?;
    let positions = accessor::vectors(&positions, buffers).map_err(|e| fault(format!("POSITION: {e}")))?;
    let sequence: Vec<u32> = match primitive.indices() {
        Some(indices) => accessor::indices(&indices, buffers).map_err(|e| fault(format!("indices: {e}")))?,
        None => {
            let count = u32::try_from(positions.len()).map_err(|_| fault("has too many vertices".into()))?;
            (0..count).collect()
        }
    };
    if let Some((at, index)) = sequence.iter().enumerate().find(|(_, i)| **i as usize >= positions.len()) {
        return Err(fault(format!("index {at} is {index}, there are {} vertices", positions.len())));
    }
    let normals = primitive.get(&Semantic::Normals).map(|normals| {
        let normals = accessor::vectors(&normals, buffers).map_err(|e| fault(format!("NORMAL: {e}")))?;
        let (got, want) = (normals.len(), positions.len());
        if got == want { Ok(normals) } else { Err(fault(format!("{got} normals for {want} vertices"))) }
    });
    let mut indices = triangles(primitive.mode(), &sequence).map_err(fault)?;
    let [x, y, z] = [0, 1, 2].map(|c| [world[c][0], world[c][1], world[c][2]]);
    // Columns of the cofactor matrix: the determinant times the inverse transposed, which takes normals along.
    let cofactors = [cross(y, z), cross(z, x), cross(x, y)];
    let determinant: f64 = (0..3).map(|k| x[k] * cofactors[0][k]).sum();
    let side = if determinant < 0.0 { -1.0 } else { 1.0 };
    if determinant < 0.0 {
        // A mirror: the outside stays outside (glTF 2.0, section 3.7.4).
        indices.iter_mut().for_each(|t| t.swap(1, 2));
    }
    let place_point = |(i, p): (usize, [f32; 3])| {
        let moved: [f32; 3] = std::array::from_fn(|row| {
            ((0..3).map(|k| world[k][row] * f64::from(p[k])).sum::<f64>() + world[3][row]) as f32
        });
        let finite = moved.iter().all(|x| x.is_finite());
        if finite { Ok(moved) } else { Err(fault(format!("vertex {i} is not finite after the node's transform"))) }
    };
    let turn = |n: [f32; 3]| {
        unit([0, 1, 2].map(|row| side * (0..3).map(|k| cofactors[k][row] * f64::from(n[k])).sum::<f64>()))
            .unwrap_or([0.0; 3])
    };
    let part = Mesh {
        positions: positions.into_iter().enumerate().map(place_point).collect::<Result<_, _>>()?,
        indices,
        normals: normals.transpose()?.map(|n| n.into_iter().map(turn).collect()),
        ..Mesh::default()
    };
    append(mesh, part, &place)
}

/// The triangles of a sequence of vertices, in the order of glTF 2.0, section 3.7.2.1.
fn triangles(mode: Mode, sequence: &[u32]) -> Result<Vec<[u32; 3]>, String> {
    let corners = |window: &[u32]| [window[0], window[1], window[2]];
    match mode {
        Mode::Triangles => match sequence.as_chunks::<3>() {
            (triangles, []) => Ok(triangles.to_vec()),
            _ => Err(format!("{} indices do not make whole triangles", sequence.len())),
        },
        Mode::TriangleStrip => {
            let every_other_turned = |(i, window): (usize, &[u32])| {
                let [a, b, c] = corners(window);
                if i % 2 == 0 { [a, b, c] } else { [b, a, c] }
            };
            Ok(sequence.windows(3).enumerate().map(every_other_turned).collect())
        }
        Mode::TriangleFan => match sequence {
            [hub, rim @ ..] => Ok(rim.windows(2).map(|w| [*hub, w[0], w[1]]).collect()),
            [] => Ok(Vec::new()),
        },
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Ok(Vec::new()),
    }
}
