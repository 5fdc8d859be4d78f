//! Every kind of file, every kind of fault, and some thousand mutated files.

use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::*;

const SQUARE_OBJ: &str = "# two triangles\nmtllib none.mtl\no square\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\n\
                          vt 0 0\nvn 0 0 2\ng side\nusemtl\tred\ns off\nf 1/1/1 2/1/1 3/1/1 4/1/1\n";

fn write(folder: &tempfile::TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    path
}

fn load_bytes(name: &str, bytes: &[u8]) -> Result<Mesh, MeshError> {
    let folder = tempfile::tempdir().unwrap();
    load(&write(&folder, name, bytes))
}

/// The message without the folder, and proof that it is one line.
fn message(name: &str, bytes: &[u8]) -> String {
    let message = load_bytes(name, bytes).expect_err("must be refused").to_string();
    assert!(!message.contains('\n'), "{message:?}");
    message[message.find(name).unwrap()..].to_owned()
}

fn assert_sound(mesh: &Mesh) {
    assert!(mesh.positions.iter().flatten().all(|x| x.is_finite()));
    assert!(mesh.indices.iter().flatten().all(|&i| (i as usize) < mesh.positions.len()));
    if let Some(normals) = &mesh.normals {
        assert_eq!(normals.len(), mesh.positions.len());
        for n in normals {
            let length = n.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>();
            assert!((length - 1.0).abs() < 1e-5, "{n:?}");
        }
    }
}

#[test]
fn obj_square() {
    let mesh = load_bytes("square.obj", SQUARE_OBJ.as_bytes()).unwrap();
    assert_eq!(mesh.name, "square");
    assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(mesh.indices, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.normals, Some(vec![[0.0, 0.0, 1.0]; 4]));
}

#[test]
fn obj_variants_give_the_same_square() {
    let expected = load_bytes("a.obj", SQUARE_OBJ.as_bytes()).unwrap();
    let variants = [
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1\n",
        "v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4",
        "v 0 0 0\nv 1 0 0\nv 1 \\\n1 0\nv 0 1 0\nf 1 2 \\\r\n 3 4\n",
        "  v 0 0 0\n\tv 2 0 0 2\nv 1 1 0\nv 0 1 0\nvt 0.5\nf 1/1 2/1 3/1 4/1\nl 1 2\np 1\n",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3\nf 1 3 4\n",
    ];
    for text in variants {
        let mesh = load_bytes("a.obj", text.as_bytes()).unwrap();
        assert_eq!((&mesh.positions, &mesh.indices), (&expected.positions, &expected.indices), "{text}");
        assert_eq!(mesh.normals, None, "not every corner has one: {text}");
    }
}

#[test]
fn obj_objects_are_merged_and_share_vertices() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\no a\nf 1 2 3\nv 5 5 5\no b\ng c\nf 1 2 4\nusemtl d\nf -1 -2 -3\n";
    let mesh = load_bytes("two.obj", text.as_bytes()).unwrap();
    assert_eq!(mesh.positions.len(), 4);
    assert_eq!(mesh.indices, [[0, 1, 2], [0, 1, 3], [3, 2, 1]]);
}

#[test]
fn obj_corners_are_split_by_normal() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 3\nvn 0 0 0\nf 1//1 2//1 3//1\nf 1//2 3//2 2//2\n";
    let mesh = load_bytes("fold.obj", text.as_bytes()).unwrap();
    assert_eq!(mesh.positions.len(), 6);
    // The normal of no length became that of its triangle.
    assert_eq!(mesh.normals.unwrap()[3], [0.0, 0.0, -1.0]);
}

#[test]
fn obj_faults_name_their_line() {
    let three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let cases = [
        ("f 1 2 4\n", "line 4: vertex 4 is asked for, 3 are defined above"),
        ("f 1 2 0\n", "line 4: vertex 0 is asked for, 3 are defined above"),
        ("f -4 1 2\n", "line 4: vertex -4 is asked for, 3 are defined above"),
        ("f 1//1 2 3\n", "line 4: normal 1 is asked for, 0 are defined above"),
        (
            "f 1/9223372036854775807 2 3\n",
            "line 4: texture coordinate 9223372036854775807 is asked for, 0 are defined above",
        ),
        ("f 1 2 -9223372036854775808\n", "line 4: vertex -9223372036854775808 is asked for, 3 are defined above"),
        ("f 1 2 9223372036854775808\n", "line 4: '9223372036854775808' is not an index"),
        ("\n\nf 1 2 x\n", "line 6: 'x' is not an index"),
        ("f 1 2 3/1/1/1\n", "line 4: texture coordinate 1 is asked for, 0 are defined above"),
        ("vt 0\nvn 0 0 1\nf 1 2 3/1/1/1\n", "line 6: '3/1/1/1' has more than three indices"),
        ("f 1 2\n", "line 4: a face of 2 vertices, at least 3 are needed"),
        ("f\n", "line 4: a face of 0 vertices, at least 3 are needed"),
        ("v 0 0\n", "line 4: a vertex of 2 numbers, 3 are needed"),
        ("v 0 0 0 1 1\n", "line 4: a vertex of 5 numbers; 3, 4 (with a weight) or 6 (with a colour) are known"),
        ("v 0 nan 0\n", "line 4: a vertex with the coordinate nan is not finite"),
        ("v 0 1e39 0\n", "line 4: a vertex with the coordinate 1e39 is not finite"),
        ("v 0 0 0 0\n", "line 4: a vertex with the weight 0 is not finite"),
        ("v 0 1,5 0\n", "line 4: '1,5' is not a number"),
        ("vn 0 -inf 0\n", "line 4: a normal with the coordinate -inf is not finite"),
        ("vn 0 0\n", "line 4: a normal of fewer than 3 numbers"),
        ("v 1 \\\n 2\nv 1 2 3\n", "line 4: a vertex of 2 numbers, 3 are needed"),
    ];
    for (text, expected) in cases {
        assert_eq!(message("bad.obj", format!("{three}{text}").as_bytes()), format!("bad.obj, {expected}"));
    }
    assert_eq!(message("bad.obj", three.as_bytes()), "bad.obj: holds no triangles");
    assert_eq!(message("bad.obj", b""), "bad.obj: holds no triangles");
    let zero = "bad.obj, line 2: a zero byte: this is no text in UTF-8, UTF-16 or the like";
    assert_eq!(message("bad.obj", b"v 0 0 0\nv \0 0 0\n"), zero);
    assert!(message("bad.obj", b"\xff\xfe\x00\x00").contains("a zero byte"));
}

#[test]
fn obj_in_every_encoding_and_with_every_line_end() {
    let expected = load_bytes("a.obj", SQUARE_OBJ.as_bytes()).unwrap();
    let comment = "# not ASCII: ü 点\n";
    for end in ["\n", "\r\n", "\r"] {
        for text in [format!("{comment}{SQUARE_OBJ}"), format!("{SQUARE_OBJ}{comment}")] {
            let text = text.replace('\n', end);
            let wide = |word: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(word).collect::<Vec<u8>>();
            let with_mark = |mark: &[u8], bytes: &[u8]| [mark, bytes].concat();
            let (little, big) = (wide(u16::to_le_bytes), wide(u16::to_be_bytes));
            for bytes in [
                text.clone().into_bytes(),
                with_mark(b"\xef\xbb\xbf", text.as_bytes()),
                text.chars().map(|c| u8::try_from(c).unwrap_or(b'?')).collect(),
                with_mark(b"\xff\xfe", &little),
                with_mark(b"\xfe\xff", &big),
                little,
                big,
            ] {
                assert_eq!(load_bytes("a.obj", &bytes).unwrap(), expected, "{end:?} {:?}", &bytes[..8]);
            }
        }
    }
    // The first line may be the one that counts.
    let marked = "\u{feff}v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(load_bytes("a.obj", marked.as_bytes()).unwrap().positions.len(), 3);
}

#[test]
fn obj_comments_and_continued_lines() {
    let expected = load_bytes("a.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").unwrap();
    for text in [
        "v 0 0 0 # one\nv 1 0 0#two\nv 1 1 0\nv 0 1 0\nf 1 2 3 4 # five 5\n",
        "# C:\\meshes\\\nv 0 0 0\nv 1 0 0 # \\\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
        "v 0 0 0\nv 1 0 \\ \n0\nv 1 1 0\nv 0 1 0\nf 1 \\\n2 \\\n3 4\n",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt nan\nvt x y z\nfo 1 2 3 4\n",
    ] {
        assert_eq!(load_bytes("a.obj", text.as_bytes()).unwrap(), expected, "{text}");
    }
}

#[test]
fn obj_says_what_it_leaves_out() {
    let left_out = |text: &str| load_bytes("a.obj", format!("{SQUARE_OBJ}{text}").as_bytes()).unwrap().left_out;
    assert_eq!(left_out("o x\nusemtl y\ns 1\nmtllib z.mtl\n"), [""; 0]);
    assert_eq!(
        left_out("l 1 2\nl 2 3\np 1\n"),
        ["2 lines from line 14 on, lines, are left out", "line 16, points, is left out"]
    );
    assert_eq!(
        left_out("xyzzy 1\nsurf 0 1\n"),
        ["line 14, 'xyzzy', which is no keyword, is left out", "line 15, curved surfaces, is left out"]
    );
    assert_eq!(
        message("a.obj", format!("{SQUARE_OBJ}V 0 0 0\n").as_bytes()),
        "a.obj, line 14: 'V' is no keyword; perhaps 'v' is meant"
    );
    assert!(
        message("a.obj", format!("{SQUARE_OBJ}0 1 2\n").as_bytes())
            .contains("line 14: '0' is no keyword; does this belong")
    );
    assert_eq!(message("a.obj", b"v 0 0 0\np 1\n"), "a.obj: holds no triangles (line 2, points, is left out)");
}

/// Twice the area of all triangles, and that of each beside a normal.
fn areas(mesh: &Mesh) -> (f64, Vec<f64>) {
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize].map(f64::from));
        cross(sub(b, a), sub(c, a))
    };
    let each: Vec<[f64; 3]> = mesh.indices.iter().map(area).collect();
    let length = |v: &[f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    (each.iter().map(length).sum(), each.iter().map(|v| v[0] + v[1] + v[2]).collect())
}

#[test]
fn obj_polygons_that_are_not_convex_are_covered() {
    // In the plane x + y + z = 0 and others, turned to begin at each corner, in both directions, of any size.
    let shapes: [(&[[f32; 2]], f64); 4] = [
        (&[[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]], 3.0),
        (&[[0., 0.], [4., 0.], [4., 4.], [2., 1.]], 6.0),
        (
            &[
                [0., 0.],
                [5., 0.],
                [5., 3.],
                [4., 3.],
                [4., 1.],
                [3., 1.],
                [3., 3.],
                [2., 3.],
                [2., 1.],
                [1., 1.],
                [1., 3.],
                [0., 3.],
            ],
            11.0,
        ),
        (&[[0., 0.], [1., 0.], [2., 0.], [2., 2.], [1., 2.], [0., 2.], [0., 1.]], 4.0),
    ];
    for (shape, area) in shapes {
        for (side, other) in
            [([1., 0., 0.], [0., 1., 0.]), ([0., 1., 0.], [1., 0., 0.]), ([1., -1., 0.], [0.5, 0.5, -1.])]
        {
            for size in [1.0_f32, 1e-30, 1e15] {
                for begin in 0..shape.len() {
                    let mut text = String::new();
                    for i in 0..shape.len() {
                        let [u, v] = shape[(begin + i) % shape.len()];
                        let p: [f32; 3] = std::array::from_fn(|k| size * (u * side[k] + v * other[k]));
                        text += &format!("v {:e} {:e} {:e}\n", p[0], p[1], p[2]);
                    }
                    text += "f";
                    (1..=shape.len()).for_each(|i| text += &format!(" {i}"));
                    let mesh = load_bytes("a.obj", text.as_bytes()).unwrap();
                    let (all, each) = areas(&mesh);
                    let unit: f64 = {
                        let c = cross(side.map(f64::from), other.map(f64::from));
                        c.iter().map(|x| x * x).sum::<f64>().sqrt()
                    };
                    let wanted = 2.0 * area * unit * f64::from(size).powi(2);
                    assert!((all / wanted - 1.0).abs() < 1e-4, "{all} {wanted}: {text}");
                    let sign = each.iter().copied().find(|x| *x != 0.0).unwrap_or(1.0).signum();
                    assert!(each.iter().all(|x| x * sign >= -1e-6 * wanted), "one direction: {each:?} {text}");
                    assert_eq!((mesh.indices.len(), mesh.left_out.len()), (shape.len() - 2, 0), "{text}");
                }
            }
        }
    }
    // Normals go with their corners.
    let text = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nvn 0 0 1\nvn 1 0 0\nf 1//1 2//2 3//1 4//2\n";
    let mesh = load_bytes("a.obj", text.as_bytes()).unwrap();
    for (position, normal) in mesh.positions.iter().zip(mesh.normals.as_ref().unwrap()) {
        let second = *position == [4.0, 0.0, 0.0] || *position == [2.0, 1.0, 0.0];
        assert_eq!(*normal, if second { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] });
    }
    // One that crosses itself is said to.
    let star = (0..5).map(|i| (f64::from(i) * 0.8 * std::f64::consts::PI).sin_cos());
    let star: String = star.map(|(y, x)| format!("v {x} {y} 0\n")).chain(["f 1 2 3 4 5\n".into()]).collect();
    let mesh = load_bytes("a.obj", star.as_bytes()).unwrap();
    assert!(mesh.left_out[0].starts_with("1 faces, the first in line 6, have sides that cross"), "{:?}", mesh.left_out);
}

#[test]
fn polygons_of_any_corners_never_panic() {
    let mut rng = Rng(7);
    let mut cutter = polygon::Cutter::new();
    let specials = [0.0, -0.0, 1.0, f32::MAX, f32::MIN, f32::MIN_POSITIVE, f32::from_bits(1), 1e-20, 0.5];
    for _ in 0..20_000 {
        let corners: Vec<[f32; 3]> = (0..3 + rng.below(12))
            .map(|_| {
                std::array::from_fn(|_| match rng.below(3) {
                    0 => specials[rng.below(specials.len())],
                    1 => rng.below(4) as f32,
                    _ => rng.below(1 << 20) as f32 / 3e5 - 1.0,
                })
            })
            .collect();
        let cut = cutter.cut(&corners);
        assert!(cut.triangles.iter().flatten().all(|&corner| (corner as usize) < corners.len()));
    }
}

#[test]
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let text = |path: &Path| load(path).unwrap_err().to_string();
    let missing = folder.path().join("missing.obj");
    assert!(text(&missing).contains("missing.obj: cannot be read: No such file"), "{}", text(&missing));
    fs::create_dir(folder.path().join("folder.glb")).unwrap();
    assert!(text(&folder.path().join("folder.glb")).ends_with("folder.glb: cannot be read: it is not a regular file"));
    for name in ["bunny.ply", "bunny", ".obj", ""] {
        assert!(text(Path::new(name)).ends_with(": a mesh file ends in .obj, .gltf or .glb"), "{name}");
    }
    assert_eq!(MeshFormat::of(Path::new("A.OBJ")).unwrap(), MeshFormat::Obj);
}

/// Positions of a square, then its 6 indices as u16, then normals.
fn square_buffer() -> Vec<u8> {
    let positions = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let normals = [0.0_f32, 0.0, 2.0];
    let mut bytes: Vec<u8> = positions.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    bytes.extend((0..4).flat_map(|_| normals).flat_map(f32::to_le_bytes));
    bytes
}

/// A glTF of one square; `extra` goes into its node, `primitive` into its primitive.
fn square_gltf(buffer: &str, node: &str, primitive: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
"nodes":[{{"children":[1]}},{{"mesh":0{node}}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":2}},"indices":1{primitive}}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
{{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}},
{{"bufferView":2,"componentType":5126,"count":4,"type":"VEC3"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":12}},
{{"buffer":0,"byteOffset":60,"byteLength":48}}],
"buffers":[{{"byteLength":108{buffer}}}]}}"#
    )
}

fn embedded(node: &str, primitive: &str) -> String {
    let uri = format!(r#","uri":"data:application/octet-stream;base64,{}""#, STANDARD.encode(square_buffer()));
    square_gltf(&uri, node, primitive)
}

fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], filler| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), filler);
        bytes
    };
    let (json, binary) = (padded(json.as_bytes(), b' '), padded(binary, 0));
    let mut out = b"glTF\x02\0\0\0".to_vec();
    out.extend((28 + json.len() as u32 + binary.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", binary)] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    out
}

fn assert_is_square(mesh: &Mesh) {
    assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(mesh.indices, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.normals, Some(vec![[0.0, 0.0, 1.0]; 4]));
}

#[test]
fn gltf_from_every_container() {
    assert_is_square(&load_bytes("a.gltf", embedded("", "").as_bytes()).unwrap());
    assert_is_square(&load_bytes("a.glb", &glb(&square_gltf("", "", ""), &square_buffer())).unwrap());

    let folder = tempfile::tempdir().unwrap();
    let uri = |uri: &str| square_gltf(&format!(r#","uri":"{uri}""#), "", "");
    write(&folder, "the square.bin", &square_buffer());
    let path = write(&folder, "a.gltf", uri("the%20square.bin").as_bytes());
    assert_is_square(&load(&path).unwrap());
    for (name, expected) in [
        ("missing.bin", "missing.bin: cannot be read: No such file"),
        ("../a.bin", "is not the name of a file beside"),
        ("/dev/zero", "is not the name of a file beside"),
        ("http://a.b/c", "is not the name of a file beside"),
        ("%zz", "is not valid"),
        ("a.gltf", "buffer 0: has "),
    ] {
        let path = write(&folder, "a.gltf", if name == "a.gltf" { uri("b.bin") } else { uri(name) }.as_bytes());
        write(&folder, "b.bin", b"short");
        let text = load(&path).unwrap_err().to_string();
        assert!(text.contains("a.gltf, buffer 0: ") && text.contains(expected), "{text}");
    }
}

#[test]
fn gltf_nodes_are_applied() {
    let moved = load_bytes("a.gltf", embedded(r#","translation":[1,2,3],"scale":[2,2,2]"#, "").as_bytes()).unwrap();
    assert_eq!(moved.positions[2], [3.0, 4.0, 3.0]);
    // A mirror: winding turns, normals stay on the outside of it.
    let mirrored = load_bytes("a.gltf", embedded(r#","scale":[-1,1,1]"#, "").as_bytes()).unwrap();
    assert_eq!(mirrored.positions[1], [-1.0, 0.0, 0.0]);
    assert_eq!(mirrored.indices[0], [0, 2, 1]);
    assert_eq!(mirrored.normals.unwrap()[0], [0.0, 0.0, 1.0]);
    // A shear, x += z, takes the plane's normal along; column-major.
    let sheared =
        load_bytes("a.gltf", embedded(r#","matrix":[1,0,1,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]"#, "").as_bytes()).unwrap();
    assert_eq!(sheared.positions[1], [1.0, 0.0, 1.0]);
    let n = sheared.normals.as_ref().unwrap()[0];
    assert!((n[0] + 0.5_f32.sqrt()).abs() < 1e-6 && (n[2] - 0.5_f32.sqrt()).abs() < 1e-6, "{n:?}");
    // Extremes keep their direction.
    let flat = load_bytes("a.gltf", embedded(r#","scale":[1e-30,1e-30,1e30]"#, "").as_bytes()).unwrap();
    assert_sound(&flat);
    // A node that flattens everything still leaves unit normals.
    assert_sound(&load_bytes("a.gltf", embedded(r#","scale":[0,0,0]"#, "").as_bytes()).unwrap());
}

#[test]
fn gltf_modes() {
    let mode = |m: u32| load_bytes("a.gltf", embedded("", &format!(r#","mode":{m}"#)).as_bytes());
    assert_eq!(mode(5).unwrap().indices, [[0, 1, 2], [2, 1, 0], [2, 0, 2], [2, 0, 3]]);
    assert_eq!(mode(6).unwrap().indices, [[0, 1, 2], [0, 2, 0], [0, 0, 2], [0, 2, 3]]);
    for (m, name) in [(0, "Points"), (1, "Lines"), (2, "LineLoop"), (3, "LineStrip")] {
        let expected = format!("a.gltf: holds no triangles (1 {name} primitive is left out)");
        assert!(mode(m).unwrap_err().to_string().ends_with(&expected), "{expected}");
    }
}

#[test]
fn gltf_shapes_beside_triangles_are_left_out_with_a_note() {
    let more = |primitive: &str| {
        let triangles = r#"{"attributes":{"POSITION":0,"NORMAL":2},"indices":1}"#;
        let text = embedded("", "").replace(&format!("[{triangles}]"), &format!("[{primitive},{triangles}]"));
        assert!(text.contains(primitive));
        load_bytes("a.gltf", text.as_bytes()).unwrap()
    };
    for (primitive, note) in [
        (r#"{"attributes":{"POSITION":0},"mode":1}"#, "1 Lines primitive is left out"),
        (r#"{"attributes":{"POSITION":77},"mode":0}"#, "1 Points primitive is left out"),
        (r#"{"attributes":{"NORMAL":2}}"#, "1 primitive without POSITION is left out"),
        (
            r#"{"attributes":{"POSITION":0},"mode":3,"indices":1},{"attributes":{"POSITION":0},"mode":3}"#,
            "2 LineStrip primitives are left out",
        ),
    ] {
        let mesh = more(primitive);
        assert_is_square(&mesh);
        assert_eq!(mesh.left_out, [note], "{primitive}");
    }
    assert_eq!(load_bytes("a.gltf", embedded("", "").as_bytes()).unwrap().left_out, [""; 0]);
    let skinned = embedded(r#","skin":0"#, r#","targets":[{"POSITION":0}]"#);
    let mesh = load_bytes("a.gltf", skinned.as_bytes()).unwrap();
    assert_eq!(mesh.left_out, ["1 primitive's morph target is left out", "1 node's skin is left out"]);
    let copies =
        embedded("", "").replacen(r#""asset":"#, r#""extensionsUsed":["EXT_mesh_gpu_instancing"],"asset":"#, 1);
    assert!(load_bytes("a.gltf", copies.as_bytes()).unwrap().left_out[0].contains("EXT_mesh_gpu_instancing"));
}

#[test]
fn gltf_faults_in_what_is_no_shape_do_not_matter() {
    let good = embedded(r#","camera":5"#, r#","material":9"#);
    for (from, to) in [
        ("", ""),
        (r#""NORMAL":2}"#, r#""NORMAL":2,"TEXCOORD_0":77,"_MINE":78}"#),
        (r#","min":[0,0,0],"max":[1,1,0]"#, ""),
        (r#""asset":"#, r#""images":[{"bufferView":7}],"textures":[{"source":3}],"asset":"#),
        (r#""asset":"#, r#""materials":[{"normalTexture":{"index":4}}],"asset":"#),
        (r#""asset":"#, r#""skins":[{"joints":[44]}],"asset":"#),
        (r#""accessors":["#, r#""animations":[{"channels":[],"samplers":[{"input":9,"output":8}]}],"accessors":["#),
        (r#""buffers":["#, r#""buffers":[{"byteLength":4,"uri":"missing.bin"},"#),
    ] {
        let mut text = good.replacen(from, to, usize::from(!from.is_empty()));
        if from.contains("buffers") {
            text = text.replace(r#"{"buffer":0,"#, r#"{"buffer":1,"#);
        }
        assert_is_square(&load_bytes("a.gltf", text.as_bytes()).unwrap_or_else(|error| panic!("{to}: {error}")));
    }
    assert_is_square(&load_bytes("a.gltf", format!("\u{feff}{}", embedded("", "")).as_bytes()).unwrap());
    assert!(message("a.gltf", b"\xff\xfe{\0}\0").contains("UTF-16"));
}

#[test]
fn gltf_sparse_accessors() {
    // Positions without a view, of which the sparse values set element 1 and 3.
    let mut buffer: Vec<u8> = [1_u8, 3, 0, 0].to_vec();
    buffer.extend([1.0_f32, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()));
    let json = |place: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"mode":6}}]}}],
"accessors":[{{"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0],"sparse":{{"count":2,
"indices":{{"bufferView":0,"componentType":5121,"byteOffset":{place}}},"values":{{"bufferView":1}}}}}}],
"bufferViews":[{{"buffer":0,"byteLength":4}},{{"buffer":0,"byteOffset":4,"byteLength":24}}],
"buffers":[{{"byteLength":28}}]}}"#
        )
    };
    let mesh = load_bytes("s.glb", &glb(&json("0"), &buffer)).unwrap();
    assert_eq!(mesh.positions, [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3], [0.0, 1.0, 0.0]]);
    assert_eq!(mesh.indices, [[0, 1, 2], [0, 2, 3]]);
    let past = message("s.glb", &glb(&json("3"), &buffer));
    assert_eq!(past, "s.glb, mesh 0, primitive 0: POSITION: sparse accessor 0 reaches past the end of its buffer");
    buffer[1] = 4;
    let outside = message("s.glb", &glb(&json("0"), &buffer));
    assert_eq!(
        outside,
        "s.glb, mesh 0, primitive 0: POSITION: sparse accessor 0 replaces element 4, which is not there"
    );
}

#[test]
fn gltf_faults_name_their_place() {
    let good = embedded("", "");
    let cases = [
        (
            r#""count":4"#,
            r#""count":400"#,
            "mesh 0, primitive 0: POSITION: accessor 0 reaches past the end of its buffer",
        ),
        (r#""count":6"#, r#""count":5"#, "mesh 0, primitive 0: 5 indices do not make whole triangles"),
        (
            r#""componentType":5123"#,
            r#""componentType":5126"#,
            "mesh 0, primitive 0: indices: accessor 1 holds F32, an unsigned integer is needed",
        ),
        (
            r#""byteOffset":48"#,
            r#""byteOffset":4800"#,
            "mesh 0, primitive 0: indices: accessor 1 reaches past the end of its buffer",
        ),
        (r#""byteOffset":48"#, r#""byteOffset":4"#, "mesh 0, primitive 0: index 5 is 16256, there are 4 vertices"),
        (r#""children":[1]"#, r#""children":[1,1]"#, "node 1: is reached twice; nodes must form a tree"),
        (r#""children":[1]"#, r#""children":[0]"#, "node 0: is reached twice; nodes must form a tree"),
        (r#""children":[1]"#, r#""children":[7]"#, "nodes[0].children[0]: the glTF is not valid: Index out of bounds"),
        (
            r#""asset":"#,
            r#""extensionsRequired":["KHR_draco_mesh_compression"],"asset":"#,
            "extensionsRequired: \"KHR_draco_mesh_compression\" is not supported",
        ),
        (r#"base64,"#, r#"base64,!"#, "buffer 0: its data URI is not valid base64: Invalid symbol 33, offset 0."),
        (r#";base64,"#, r#","#, "buffer 0: its data URI is not in base64"),
        (
            r#""NORMAL":2"#,
            r#""NORMAL":1"#,
            "mesh 0, primitive 0: NORMAL: accessor 1 holds U16 Scalar, F32 Vec3 is needed",
        ),
        (r#""POSITION":0"#, r#""POSITION":7"#, "mesh 0, primitive 0: accessor 7 is asked for, there are 3"),
        (r#""mesh":0"#, r#""mesh":0,"scale":[1e39,1,1]"#, ""),
        (
            r#""mesh":0"#,
            r#""mesh":0,"translation":[3e38,0,0],"scale":[3e38,1,1]"#,
            "mesh 0, primitive 0: vertex 1 is not finite after the node's transform",
        ),
    ];
    for (from, to, expected) in cases {
        assert!(good.contains(from), "{from}");
        let text = message("a.gltf", good.replacen(from, to, 1).as_bytes());
        if expected.is_empty() {
            assert!(text.starts_with("a.gltf, "), "{text}");
        } else {
            assert_eq!(text, format!("a.gltf, {expected}"));
        }
    }
    assert!(message("a.gltf", b"").starts_with("a.gltf, line 1 of the JSON: EOF"));
    assert!(message("a.gltf", b"[1, 2").starts_with("a.gltf, line 1 of the JSON: "));
    let whole = glb(&square_gltf("", "", ""), &square_buffer());
    for cut in [0, 3, 4, 11, 12, 19, 20, 100, whole.len() - 1] {
        assert!(message("a.glb", &whole[..cut]).starts_with("a.glb, "));
    }
    let mut nan = square_buffer();
    nan[16..20].copy_from_slice(&f32::NAN.to_le_bytes());
    let text = message("a.glb", &glb(&square_gltf("", "", ""), &nan));
    assert_eq!(text, "a.glb, mesh 0, primitive 0: POSITION: element 1 of accessor 0 is not finite: [1.0, NaN, 0.0]");
    assert_eq!(message("a.gltf", br#"{"asset":{"version":"2.0"}}"#), "a.gltf: holds no triangles");
}

/// SplitMix64.
struct Rng(u64);

impl Rng {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as usize % n.max(1)
    }
}

/// Words that have broken parsers before.
const NASTY: [&str; 20] = [
    "-1",
    "0",
    "4294967295",
    "-9223372036854775808",
    "18446744073709551615",
    "1e999",
    "nan",
    "\\\n",
    "f",
    "v",
    "/",
    "//",
    "null",
    "[]",
    "{}",
    "\"\"",
    "5121",
    "5125",
    "\u{2028}",
    "%",
];

fn mutated(valid: &[u8], rng: &mut Rng) -> Vec<u8> {
    let mut bytes = valid.to_vec();
    for _ in 0..=rng.below(4) {
        let at = rng.below(bytes.len() + 1);
        let until = (at + rng.below(12)).min(bytes.len());
        match rng.below(6) {
            0 if at < bytes.len() => bytes[at] = rng.below(256) as u8,
            1 if at < bytes.len() => bytes[at] ^= 1 << rng.below(8),
            2 => drop(bytes.drain(at..until)),
            3 => bytes.truncate(at),
            4 => drop(bytes.splice(at..until, NASTY[rng.below(NASTY.len())].bytes())),
            _ => {
                let copy = bytes[at..until].to_vec();
                let to = rng.below(bytes.len() + 1);
                drop(bytes.splice(to..to, copy));
            }
        }
    }
    // A number in its place, to get past the grammar.
    if rng.below(2) == 0 {
        let digits: Vec<usize> = (0..bytes.len()).filter(|&i| bytes[i].is_ascii_digit()).collect();
        if let Some(&at) = digits.get(rng.below(digits.len())) {
            let until = (at..bytes.len()).find(|&i| !bytes[i].is_ascii_digit()).unwrap_or(bytes.len());
            drop(bytes.splice(at..until, NASTY[rng.below(6)].bytes()));
        }
    }
    bytes
}

#[test]
fn mutated_files_never_panic() {
    let mut rng = Rng(2026);
    let folder = Path::new("/nonexistent");
    let (gltf_file, glb_file) = (embedded("", ""), glb(&square_gltf("", "", ""), &square_buffer()));
    let (mut good, mut bad) = (0, 0);
    for _ in 0..4000 {
        let results = [
            obj::parse(&mutated(SQUARE_OBJ.as_bytes(), &mut rng)),
            gltf::parse(&mutated(gltf_file.as_bytes(), &mut rng), folder),
            gltf::parse(&mutated(&glb_file, &mut rng), folder),
        ];
        for result in results {
            match result {
                Ok(mut mesh) => {
                    normalize_normals(&mut mesh);
                    assert_sound(&mesh);
                    good += 1;
                }
                Err(fault) => {
                    assert!(!fault.place.contains('\n') && !fault.why.contains('\n'), "{fault:?}");
                    bad += 1;
                }
            }
        }
    }
    // The mutations must neither miss nor destroy everything.
    assert!(good > 500 && bad > 500, "{good} good, {bad} bad");
}

#[test]
fn meshes_of_any_size_fit() {
    let corners = |s: [f32; 3]| vec![[-s[0], -s[1], -s[2]], [s[0], s[1], s[2]], [0.0, s[1], 0.0]];
    let shapes = [
        [1.0; 3],
        [1e30; 3],
        [1e-30; 3],
        [f32::MAX; 3],
        [f32::from_bits(1); 3],
        [1e30, 1e-30, 0.0],
        [0.0, 1e-38, 0.0],
        [0.0; 3],
    ];
    let (center, size) = ([1.0, 2.0, 3.0], [0.5, 1.0, 2.0]);
    for shape in shapes {
        let mut mesh = Mesh { positions: corners(shape), indices: vec![[0, 1, 2]], ..Mesh::default() };
        let scale = fit_into(&mut mesh, center, size);
        assert!(scale.is_finite() && scale > 0.0, "{shape:?}");
        assert_sound(&mesh);
        let extents: Vec<f32> = (0..3)
            .map(|axis| {
                let (low, high) = (center[axis] - size[axis] / 2.0, center[axis] + size[axis] / 2.0);
                let all = || mesh.positions.iter().map(|p| p[axis]);
                assert!(all().all(|x| x >= low && x <= high), "{shape:?}: {:?}", mesh.positions);
                (all().fold(f32::MIN, f32::max) - all().fold(f32::MAX, f32::min)) / size[axis]
            })
            .collect();
        // It fills the box along one axis, unless it is a point, and stands on the floor.
        let fill = extents.iter().copied().fold(0.0, f32::max);
        assert!(if shape == [0.0; 3] { fill == 0.0 } else { (fill - 1.0).abs() < 1e-5 }, "{shape:?}: {extents:?}");
        assert_eq!(mesh.positions[0][1], center[1] - size[1] / 2.0);
    }
    let mut mesh = Mesh { positions: corners([1.0, 0.25, 1.0]), ..Mesh::default() };
    fit_into(&mut mesh, [0.0; 3], [2.0; 3]);
    assert_eq!(mesh.positions[..2], [[-1.0, -1.0, -1.0], [1.0, -0.5, 1.0]]);
    let mut empty = Mesh::default();
    assert_eq!(fit_into(&mut empty, center, size), 1.0);
}

#[test]
fn real_meshes_load_where_present() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let Ok(entries) = fs::read_dir(&folder) else {
        eprintln!("real meshes: not loaded, no {}", folder.display());
        return;
    };
    for path in entries.map(|e| e.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "obj")) {
        let mut mesh = load(&path).unwrap();
        assert!(mesh.indices.len() > 100, "{}", path.display());
        assert_sound(&mesh);
        fit_into(&mut mesh, [0.0; 3], [1.0; 3]);
        assert_sound(&mesh);
    }
}
