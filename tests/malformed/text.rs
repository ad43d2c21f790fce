//! Broken XML and text.

use crate::collada_text::load_bytes;
use crate::{assert_error, good};
use softbox::io::Severity;

#[test]
fn broken_xml_is_named_by_line() {
    let text = good();
    // Cut off after every eighth part.
    for eighth in 1..8 {
        let cut = text.len() * eighth / 8;
        assert_error("cut off", &text.as_bytes()[..cut], "line ");
    }
    let swapped = text.replace("</mesh></geometry>", "</geometry></mesh>");
    assert_error("swapped tags", swapped.as_bytes(), "line 9, column");
    let twice = text.replace("id=\"g\"", "id=\"g\" id=\"g\"");
    assert_error("attribute twice", twice.as_bytes(), "line 4, column");
    let open = text.replace("id=\"g\"", "id=\"g");
    assert_error("open quote", open.as_bytes(), "line ");
    let after = format!("{text}<more/>");
    assert_error("second root", after.as_bytes(), "line ");
    let prefix = text
        .replace("<mesh>", "<x:mesh>")
        .replace("</mesh>", "</x:mesh>");
    assert_error("unknown prefix", prefix.as_bytes(), "line 4, column");
    let comment = text.replace("<mesh>", "<mesh><!-- a -- b -->");
    assert_error("double dash", comment.as_bytes(), "line 4, column");
}

#[test]
fn entities_cannot_blow_up() {
    let mut definitions = "<!ENTITY a0 \"0 \">".to_owned();
    for level in 1..40 {
        let previous = format!("&a{};", level - 1).repeat(10);
        definitions += &format!("<!ENTITY a{level} \"{previous}\">");
    }
    let bomb = good()
        .replace("?>\n", &format!("?>\n<!DOCTYPE COLLADA [{definitions}]>\n"))
        .replace("0 1 2</p>", "&a39;</p>");
    assert_error("billion laughs", bomb.as_bytes(), "line 2");
    let external = good().replace(
        "?>\n",
        "?>\n<!DOCTYPE COLLADA [<!ENTITY x SYSTEM \"file:///etc/passwd\">]>\n",
    );
    assert_error("external entity", external.as_bytes(), "line 2");
}

#[test]
fn text_faults_are_repaired_with_a_warning() {
    let whole = |bytes: &[u8], part: &str| {
        let loaded = load_bytes(bytes).expect("a repaired scene");
        let mut notes = loaded.report.notes.iter();
        let is_warned = notes.any(|n| n.severity == Severity::Warning && n.message.contains(part));
        assert!(is_warned, "{part}: {}", loaded.report);
        assert_eq!(loaded.report.read.triangles, 1);
    };
    let text = good();
    whole(
        text.replace("name=\"square\"", "name=\"R&D\"").as_bytes(),
        "1 bare &",
    );
    whole(
        text.replace("name=\"square\"", "name=\"a\u{1}b\"")
            .as_bytes(),
        "1 control characters",
    );
    whole(
        text.replace("name=\"square\"", "name=\"&nbsp;&#0;\"")
            .as_bytes(),
        "2 bare &",
    );
    let at = text.find("square").expect("the name");
    let mut broken = text.clone().into_bytes();
    broken[at] = 0xFC;
    whole(&broken, "read as Latin-1");
    let mut wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    wide[2 * at..2 * at + 2].copy_from_slice(&[0xD8, 0x00]);
    whole(&wide, "code units are invalid");
    let twice = text.replace("id=\"n\"", "id=\"p\"");
    whole(twice.as_bytes(), "more than once");
    whole(text.replace("Y_UP", "sideways").as_bytes(), "<up_axis>");
    whole(text.replace("\"0.01\"", "\"-1\"").as_bytes(), "unit");
    whole(
        text.replace("url=\"#scene\"", "url=\"#none\"").as_bytes(),
        "no <visual_scene> has the id",
    );
}

#[test]
fn other_elements_may_nest_as_they_like() {
    let deep = format!("{}{}", "<x>".repeat(100_000), "</x>".repeat(100_000));
    let text = good().replace("<asset>", &format!("<asset><extra>{deep}</extra>"));
    let loaded = load_bytes(text.as_bytes()).expect("a scene");
    assert_eq!(loaded.report.read.triangles, 1);
}
