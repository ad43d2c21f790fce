use std::collections::HashMap;

use roxmltree::{Node, NodeId};

use super::effect::read_material;
use super::xml::Xml;
use crate::io::report::{Notes, Severity};
use crate::scene::Material;

/// The materials in use, each read once.
#[derive(Default)]
pub(super) struct Materials {
    pub(super) list: Vec<Material>,
    by_element: HashMap<NodeId, usize>,
    /// What an instance element binds; nodes that are instanced repeat it.
    by_instance: HashMap<NodeId, Vec<usize>>,
    default: Option<usize>,
}

impl Materials {
    /// The material of each slot of an instance. A symbol is looked up in the `<instance_material>`
    /// elements, then taken for a material's id; at last the default is taken, with a note.
    pub(super) fn bind(
        &mut self,
        xml: &Xml<'_, '_>,
        notes: &mut Notes,
        instance: Node<'_, '_>,
        symbols: &[Option<String>],
    ) -> Vec<usize> {
        if let Some(known) = self.by_instance.get(&instance.id()) {
            return known.clone();
        }
        let bound: Vec<Node<'_, '_>> = instance
            .descendants()
            .filter(|node| node.tag_name().name() == "instance_material")
            .collect();
        let slots = symbols.iter();
        let indices: Vec<usize> = slots
            .map(|symbol| self.bind_slot(xml, notes, instance, &bound, symbol.as_deref()))
            .collect();
        self.by_instance.insert(instance.id(), indices.clone());
        indices
    }

    fn bind_slot(
        &mut self,
        xml: &Xml<'_, '_>,
        notes: &mut Notes,
        instance: Node<'_, '_>,
        bound: &[Node<'_, '_>],
        symbol: Option<&str>,
    ) -> usize {
        let by_symbol = symbol.and_then(|symbol| {
            let is_same = |node: &&Node<'_, '_>| {
                let other = node.attribute("symbol");
                other.is_some_and(|other| other == symbol || other.trim() == symbol.trim())
            };
            bound.iter().find(is_same)
        });
        if let Some(binding) = by_symbol {
            let target = xml.follow(notes, *binding, "target", "material");
            return self.of_element(xml, notes, target);
        }
        if let Some(material) = symbol.and_then(|symbol| xml.find("material", symbol)) {
            return self.of_element(xml, notes, Some(material));
        }
        let Some(first) = bound.first() else {
            let message = "no material is bound; grey 0.5 was taken";
            xml.note(notes, Severity::Guessed, instance, message);
            return self.default_index();
        };
        if symbol.is_some() {
            let message = "no bound material has the mesh's symbol; the first one was taken";
            xml.note(notes, Severity::Guessed, instance, message);
        }
        let target = xml.follow(notes, *first, "target", "material");
        self.of_element(xml, notes, target)
    }

    fn of_element(
        &mut self,
        xml: &Xml<'_, '_>,
        notes: &mut Notes,
        element: Option<Node<'_, '_>>,
    ) -> usize {
        let Some(element) = element else {
            return self.default_index();
        };
        if let Some(&index) = self.by_element.get(&element.id()) {
            return index;
        }
        self.list.push(read_material(xml, notes, element));
        self.by_element.insert(element.id(), self.list.len() - 1);
        self.list.len() - 1
    }

    fn default_index(&mut self) -> usize {
        *self.default.get_or_insert_with(|| {
            self.list.push(Material::default());
            self.list.len() - 1
        })
    }
}
