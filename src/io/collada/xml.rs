use std::borrow::Cow;
use std::cell::{Cell, OnceCell};
use std::collections::HashMap;

use roxmltree::{Document, Node};

use crate::io::report::{Notes, Severity};

/// A parsed file with its ids and line numbers.
pub(super) struct Xml<'a, 'input> {
    pub(super) root: Node<'a, 'input>,
    text: &'a str,
    /// First element with each local name and id.
    by_id: HashMap<(&'a str, &'a str), Node<'a, 'input>>,
    line_starts: OnceCell<Vec<usize>>,
    /// Bytes of number arrays that may still be read.
    array_bytes_left: Cell<usize>,
}

impl<'a, 'input> Xml<'a, 'input> {
    /// Indexes a document; an id that the same kind of element already has is noted, the first
    /// one counts.
    pub(super) fn new(document: &'a Document<'input>, notes: &mut Notes) -> Self {
        let mut xml = Self {
            root: document.root_element(),
            text: document.input_text(),
            by_id: HashMap::new(),
            line_starts: OnceCell::new(),
            array_bytes_left: Cell::new(document.input_text().len().saturating_mul(8)),
        };
        for node in xml.root.descendants().filter(Node::is_element) {
            let Some(id) = node.attribute("id") else {
                continue;
            };
            let first = xml.by_id.entry((node.tag_name().name(), id));
            let first = *first.or_insert(node);
            if first != node {
                let message = "the id is used more than once; the first element with it counts";
                xml.note(notes, Severity::Warning, node, message);
            }
        }
        xml
    }

    /// Line of an element, from 1.
    pub(super) fn line(&self, node: Node<'_, '_>) -> u32 {
        let starts = self.line_starts.get_or_init(|| {
            let newlines = self.text.bytes().enumerate().filter(|(_, b)| *b == b'\n');
            newlines.map(|(at, _)| at).collect()
        });
        1 + starts.partition_point(|&newline| newline < node.range().start) as u32
    }

    /// Whether an array of numbers may be read. Sources may share arrays, but not so often that a
    /// small file fills the memory: eight times its size is the limit.
    pub(super) fn may_read(&self, array: Node<'_, '_>) -> bool {
        let left = self.array_bytes_left.get().checked_sub(array.range().len());
        self.array_bytes_left.set(left.unwrap_or(0));
        left.is_some()
    }

    /// Adds a note about an element.
    pub(super) fn note(
        &self,
        notes: &mut Notes,
        severity: Severity,
        node: Node<'_, '_>,
        message: impl Into<String>,
    ) {
        notes.add(severity, Some(self.line(node)), describe(node), message);
    }

    /// The element of kind `tag` that `reference` names: the id as written, then percent-decoded,
    /// then without blanks around it.
    pub(super) fn find(&self, tag: &'static str, reference: &str) -> Option<Node<'a, 'input>> {
        let id = match reference.split_once('#') {
            Some((file, fragment)) if file.trim().is_empty() => fragment,
            Some(_) => return None,
            None => reference,
        };
        let get = |id: &str| self.by_id.get(&(tag, id)).copied();
        let decoded = percent_decode(id);
        get(id)
            .or_else(|| get(&decoded))
            .or_else(|| get(id.trim()))
            .or_else(|| get(decoded.trim()))
    }

    /// The element that attribute `attribute` of `node` names. A missing or dangling reference
    /// gives `None` and a note.
    pub(super) fn follow(
        &self,
        notes: &mut Notes,
        node: Node<'_, '_>,
        attribute: &str,
        tag: &'static str,
    ) -> Option<Node<'a, 'input>> {
        let Some(reference) = node.attribute(attribute) else {
            let message = format!("there is no {attribute}, so it names nothing and was left out");
            self.note(notes, Severity::Warning, node, message);
            return None;
        };
        let found = self.find(tag, reference);
        if found.is_none() {
            let is_external = reference.find('#').is_some_and(|at| at > 0);
            let message = if is_external {
                format!("\"{reference}\" is in another file, which is not read")
            } else {
                format!("no <{tag}> has the id \"{reference}\"; this was left out")
            };
            self.note(notes, Severity::Warning, node, message);
        }
        found
    }
}

/// The first child element with that local name.
pub(super) fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    children(node, name).next()
}

/// All child elements with that local name.
pub(super) fn children<'a, 'input, 'n>(
    node: Node<'a, 'input>,
    name: &'n str,
) -> impl Iterator<Item = Node<'a, 'input>> + use<'a, 'input, 'n> {
    node.children()
        .filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// The element at the end of a path of local names.
pub(super) fn at_path<'a, 'input>(
    node: Node<'a, 'input>,
    path: &[&str],
) -> Option<Node<'a, 'input>> {
    path.iter()
        .try_fold(node, |parent, name| child(parent, name))
}

/// The course's block in an element's `<extra>`: profile CGL or CMU462.
pub(super) fn course_technique<'a, 'input>(node: Node<'a, 'input>) -> Option<Node<'a, 'input>> {
    node.descendants().find(|inner| is_course_technique(*inner))
}

/// True for `<technique profile="CGL">` and `<technique profile="CMU462">`.
pub(super) fn is_course_technique(node: Node<'_, '_>) -> bool {
    node.tag_name().name() == "technique"
        && matches!(node.attribute("profile"), Some("CGL" | "CMU462"))
}

/// Name or id of an element, else its tag.
pub(super) fn name_of(node: Node<'_, '_>) -> String {
    node.attribute("name")
        .or_else(|| node.attribute("id"))
        .filter(|name| !name.trim().is_empty())
        .unwrap_or_else(|| node.tag_name().name())
        .to_owned()
}

/// An element in words: its tag and the nearest name.
pub(super) fn describe(node: Node<'_, '_>) -> String {
    let tag = node.tag_name().name();
    let own = |node: Node<'_, '_>| {
        ["id", "name", "url", "symbol"]
            .iter()
            .find_map(|key| node.attribute(*key))
            .map(str::to_owned)
    };
    if let Some(name) = own(node) {
        return format!("{tag} \"{name}\"");
    }
    let named = node
        .ancestors()
        .skip(1)
        .find_map(|outer| own(outer).map(|name| (outer.tag_name().name(), name)));
    match named {
        Some((outer, name)) => format!("{tag} of {outer} \"{name}\""),
        None => tag.to_owned(),
    }
}

fn percent_decode(text: &str) -> Cow<'_, str> {
    if !text.contains('%') {
        return Cow::Borrowed(text);
    }
    let bytes = text.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while at < bytes.len() {
        let code = (bytes[at] == b'%')
            .then(|| bytes.get(at + 1..at + 3))
            .flatten()
            .and_then(|hex| std::str::from_utf8(hex).ok())
            .and_then(|hex| u8::from_str_radix(hex, 16).ok());
        out.push(code.unwrap_or(bytes[at]));
        at += if code.is_some() { 3 } else { 1 };
    }
    Cow::Owned(String::from_utf8_lossy(&out).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_codes_decode_and_stray_signs_stay() {
        assert_eq!(percent_decode("a%20b%C3%BC"), "a bü");
        assert_eq!(percent_decode("100%"), "100%");
        assert_eq!(percent_decode("%zz%4"), "%zz%4");
    }

    #[test]
    fn ids_match_raw_then_decoded_then_trimmed() {
        let text = "<r><mesh id='a b'/><mesh id='c'/><node id='c'/><mesh id='p%20q'/></r>";
        let document = Document::parse(text).unwrap();
        let xml = Xml::new(&document, &mut Notes::default());
        for (reference, id) in [
            ("#a b", "a b"),
            ("#a%20b", "a b"),
            ("# c ", "c"),
            ("c", "c"),
            ("#p%20q", "p%20q"),
        ] {
            let found = xml.find("mesh", reference).unwrap();
            assert_eq!(found.attribute("id"), Some(id));
        }
        assert!(xml.find("mesh", "other.dae#c").is_none());
        assert!(xml.find("mesh", "#d").is_none());
    }
}
