//! glTF 2.0 and GLB, through `gltf`.
//!
//! `gltf` parses and validates the JSON. Its accessor readers trust counts, offsets and types that validation does not
//! look at, and panic where these are wrong; so [`accessor`] reads the buffers here.

mod accessor;
mod buffers;

use std::path::Path;

use gltf::mesh::{Mode, Primitive, Semantic};
use gltf::{Document, Gltf, Node};

use super::{Fault, Mesh, append, cross, unit};

/// Column-major, as in the file: `m[column][row]`.
type Matrix = [[f64; 4]; 4];

const IDENTITY: Matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// Extensions that change nothing in how positions, indices and normals are stored.
const HARMLESS: [&str; 2] = ["KHR_materials_", "KHR_texture_"];

pub(super) fn parse(bytes: &[u8], folder: &Path) -> Result<Mesh, Fault> {
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
    let document = revalidate(document)?;
    let buffers = buffers::load(&document, blob, folder)?;
    let mut mesh = Mesh::default();
    for (node, world) in placed_nodes(&document)? {
        let Some(part) = node.mesh() else { continue };
        for primitive in part.primitives() {
            add_primitive(&mut mesh, part.index(), &primitive, &world, &buffers)?;
        }
    }
    if document.nodes().len() == 0 {
        for part in document.meshes() {
            for primitive in part.primitives() {
                add_primitive(&mut mesh, part.index(), &primitive, &IDENTITY, &buffers)?;
            }
        }
    }
    Ok(mesh)
}

/// Runs the crate's validation, which makes its accessors safe to call.
fn revalidate(document: Document) -> Result<Document, Fault> {
    let mut json = document.into_json();
    // It knows no extension that it was not compiled with; those that are left are harmless.
    json.extensions_required.clear();
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
        other => Err(format!("its mode is {other:?}; only Triangles, TriangleStrip and TriangleFan can be drawn")),
    }
}
