//! Faulty meshes.

use crate::collada_text::{PLACE, VERTEX, document, load_bytes, square};
use crate::{good, warned};

fn with_primitive(primitive: &str) -> String {
    document(&square(primitive), PLACE)
}

/// A square with a good triangle and another primitive.
fn with_good_and(primitive: &str) -> String {
    with_primitive(&format!(
        "<triangles count='1'>{VERTEX}<p>0 1 2</p></triangles>{primitive}"
    ))
}

#[test]
fn bad_indices_drop_their_faces_only() {
    for (name, list, part, left) in [
        ("negative", "0 1 2 0 -2 3", "1 faces with an index", 1),
        ("past the end", "0 1 2 0 2 5", "1 faces with an index", 1),
        (
            "u32::MAX",
            "0 1 2 0 2 4294967295",
            "1 faces with an index",
            1,
        ),
        (
            "huge",
            "0 1 2 0 2 99999999999999999999",
            "1 faces with an index",
            1,
        ),
        ("fraction", "0 1 2 0 2 3.5", "1 faces with an index", 1),
        ("word", "0 1 2 0 two 3", "1 faces with an index", 1),
        ("short list", "0 1 2 0 2", "ends before", 1),
        ("repeated corner", "0 1 2 3 3 0", "without area", 1),
        ("all bad", "9 9 9 -1 -1 -1", "no usable faces", 0),
        ("empty list", "", "no usable faces", 0),
    ] {
        let text = with_primitive(&format!("<triangles>{VERTEX}<p>{list}</p></triangles>"));
        assert_eq!(warned(name, &text, part), left, "{name}");
    }
}

/// Sizes and indices of a polylist beside a good triangle; the warning; the triangles left.
const POLYLISTS: [(&str, &str, &str, usize); 8] = [
    ("3 4 3", "0 1 2 0 1", "2 faces were dropped because", 2),
    ("1000000000000000000", "0 1 2", "were dropped because", 1),
    ("4294967294", "0 1 2", "were dropped because", 1),
    ("-3 3", "0 1 2", "2 faces were dropped because", 1),
    ("2 1 0 3", "0 1 2 0 1 2", "3 faces with fewer", 2),
    ("3", "0 1 2 0 2 3", "3 indices after", 2),
    ("4", "0 4 2 4", "without area", 1),
    ("3", "0 1 2 0", "1 indices after", 2),
];

#[test]
fn polylists_with_wrong_sizes_are_survived() {
    for (sizes, list, part, left) in POLYLISTS {
        let text = with_good_and(&format!(
            "<polylist>{VERTEX}<vcount>{sizes}</vcount><p>{list}</p></polylist>"
        ));
        assert_eq!(warned(sizes, &text, part), left, "{sizes}: {list}");
    }
}

/// A primitive beside a good triangle, VERTEX for the usual input; the warning; the triangles left.
const PRIMITIVES: [(&str, &str, usize); 9] = [
    (
        "<triangles count='1000000000000000000'>VERTEX<p>0 1 2</p></triangles>",
        "count says 1000000000000000000",
        2,
    ),
    (
        "<triangles><input semantic='VERTEX' source='#v' offset='1000000000'/><p>0 1 2</p></triangles>",
        "offset",
        1,
    ),
    (
        "<triangles><input semantic='VERTEX' source='#v' offset='-1'/><p>0 1 2</p></triangles>",
        "offset",
        1,
    ),
    ("<triangles><p>0 1 2</p></triangles>", "no positions", 1),
    ("<triangles count='4'>VERTEX</triangles>", "no <p>", 1),
    (
        "<polygons>VERTEX<ph><p>0 1 4</p><h>2 3 3</h></ph></polygons>",
        "impossible hole",
        2,
    ),
    (
        "<tristrips>VERTEX<p>0 1</p></tristrips>",
        "fewer than three",
        1,
    ),
    (
        "<polygons>VERTEX<p/><ph/></polygons>",
        "2 faces with fewer",
        1,
    ),
    (
        "<polygons>VERTEX<p>0 1 2 77 3</p></polygons>",
        "1 faces with an index",
        1,
    ),
];

#[test]
fn wrong_counts_and_inputs_are_survived() {
    for (primitive, part, left) in PRIMITIVES {
        let text = with_good_and(&primitive.replace("VERTEX<", &format!("{VERTEX}<")));
        assert_eq!(warned(primitive, &text, part), left, "{primitive}");
    }
}

const ARRAY: &str =
    "<float_array id=\"pa\" count=\"15\">0 0 0 1 0 0 1 1 0 0 1 0 0.5 0.5 0</float_array>";

/// What is replaced in a good file, by what; the warning; the triangles left.
const SOURCES: [(&str, &str, &str, usize); 15] = [
    ("0.5 0.5 0<", "0.5 nan 0<", "1 numbers are not finite", 1),
    (
        ">0 0 0 1 0 0",
        ">0 NaN 0 1 0 0",
        "coordinate that is not finite",
        0,
    ),
    (
        ">0 0 0 1 0 0",
        ">0 -inf 0 1 0 0",
        "coordinate that is not finite",
        0,
    ),
    (
        ">0 0 0 1 0 0",
        ">0 1e999 0 1 0 0",
        "coordinate that is not finite",
        0,
    ),
    (">0 0 0 1 0 0", ">0 1e200 0 1 0 0", "beyond 1e30", 0),
    (
        ">0 0 0 1 0 0",
        ">0 0,5 0 1 0 0",
        "1 numbers are not finite",
        0,
    ),
    (
        "count=\"15\"",
        "count=\"1000000000000000000\"",
        "count says",
        1,
    ),
    (
        "count=\"5\" stride",
        "count=\"999999999999\" stride",
        "claims 999999999999",
        1,
    ),
    (
        "stride=\"3\"><param",
        "stride=\"0\"><param",
        "offset or stride",
        0,
    ),
    (
        "stride=\"3\"><param",
        "stride=\"18446744073709551615\"><param",
        "claims 5",
        0,
    ),
    (
        "0 0 0 1 0 0 1 1 0 0 1 0 0.5 0.5 0",
        "0 0 0 1",
        "an index that no vertex has",
        0,
    ),
    (ARRAY, "", "no array", 0),
    (
        "source=\"#p\"/>",
        "source=\"#q\"/>",
        "no <source> has the id",
        0,
    ),
    ("source=\"#p\"/>", "/>", "there is no source", 0),
    ("<param name=\"Z\"/>", "", "2 of the three coordinates", 1),
];

#[test]
fn faulty_sources_are_survived() {
    for (from, to, part, left) in SOURCES {
        let text = good();
        assert!(text.contains(from), "{from}");
        assert_eq!(
            warned(to, &text.replace(from, to), part),
            left,
            "{from} to {to}"
        );
    }
}

#[test]
fn a_hundred_thousand_bad_faces_make_one_note() {
    let list = "0 1 99 ".repeat(100_000);
    let text = with_good_and(&format!("<triangles>{VERTEX}<p>{list}</p></triangles>"));
    let loaded = load_bytes(text.as_bytes()).expect("a scene");
    assert!(loaded.report.notes.len() < 10, "{}", loaded.report);
    let each: String = (0..20_000)
        .map(|i| format!("<node id='i{i}'><instance_geometry url='#gone'/></node>"))
        .collect();
    let loaded = load_bytes(document("", &each).as_bytes()).expect("a scene");
    assert!(loaded.report.notes.len() < 10, "{}", loaded.report);
    assert!(loaded.report.to_string().contains("20000 times in all"));
}

#[test]
fn one_polygon_with_many_corners_does_not_hold_the_reader_up() {
    // A comb: every second corner is reflex.
    let n = 20_000;
    let mut positions = String::new();
    for i in 0..n {
        positions += &format!("{i} {} 0 ", 10 + 5 * (i % 2));
    }
    positions += &format!("{n} 0 0 0 0 0");
    let list: Vec<String> = (0..n + 2).rev().map(|i| i.to_string()).collect();
    let text = document(
        &format!(
            "<library_geometries><geometry id='g'><mesh><source id='p'><float_array>{positions}</float_array></source>\
             <vertices id='v'><input semantic='POSITION' source='#p'/></vertices>\
             <polygons>{VERTEX}<p>{}</p></polygons></mesh></geometry></library_geometries>",
            list.join(" ")
        ),
        PLACE,
    );
    let loaded = load_bytes(text.as_bytes()).expect("a scene");
    assert_eq!(loaded.report.read.triangles, n);
}

/// Four thousand sources that share one array of ninety thousand numbers would fill gigabytes.
#[test]
fn shared_arrays_do_not_fill_the_memory() {
    let numbers = "0 0 1 ".repeat(30_000);
    let mut mesh = format!("<float_array id='shared'>{numbers}</float_array>");
    for i in 0..4000 {
        mesh += &format!(
            "<source id='s{i}'><technique_common><accessor source='#shared' stride='3'/></technique_common></source>\
             <triangles><input semantic='POSITION' source='#s{i}'/><p>0 1 2</p></triangles>"
        );
    }
    let libraries = format!(
        "<library_geometries><geometry id='g'><mesh>{mesh}</mesh></geometry></library_geometries>"
    );
    let text = document(&libraries, PLACE);
    assert!(warned("shared array", &text, "shared too often") < 100);
}
