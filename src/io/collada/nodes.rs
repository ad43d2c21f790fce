use std::collections::HashMap;

use glam::DMat4;
use roxmltree::{Node, NodeId};

use super::camera::read_camera;
use super::controller::resolve_controller;
use super::light::{Light, read_light};
use super::transform::{is_singular, is_usable, parent_from_node};
use super::xml::{Xml, children, describe, name_of};
use crate::color::Rgb;
use crate::io::ImportError;
use crate::io::progress::{LoadStage, Reporter};
use crate::io::report::{Notes, Severity};
use crate::scene::{FieldOfView, FileCamera, LightKind, LightNode};

/// The deepest nesting of nodes that is followed.
const DEPTH_LIMIT: usize = 400;
/// The most nodes that are visited, counting every instance.
const NODE_LIMIT: usize = 1_000_000;
/// The most elements inside nodes that are looked at, counting every instance.
const ELEMENT_LIMIT: usize = 20 * NODE_LIMIT;

/// A geometry in its place, before it is read.
pub(super) struct Placement<'a, 'input> {
    /// Name of the node.
    pub(super) name: String,
    /// `<instance_geometry>` or `<instance_controller>`, which binds materials.
    pub(super) instance: Node<'a, 'input>,
    /// The `<geometry>`.
    pub(super) geometry: Node<'a, 'input>,
    pub(super) world_from_object: DMat4,
}

/// What the node hierarchy places.
#[derive(Default)]
pub(super) struct Placed<'a, 'input> {
    pub(super) geometry: Vec<Placement<'a, 'input>>,
    pub(super) lights: Vec<LightNode>,
    pub(super) ambient: Rgb,
    pub(super) cameras: Vec<FileCamera>,
    /// Nodes visited.
    pub(super) nodes: usize,
}

/// Walks the nodes of a visual scene in the order of the file.
///
/// # Errors
/// Cycles, too deep or too many nodes, and cancellation.
pub(super) fn place_all<'a, 'input>(
    xml: &Xml<'a, 'input>,
    notes: &mut Notes,
    reporter: &mut Reporter<'_>,
    visual_scene: Node<'a, 'input>,
    world_from_file: DMat4,
) -> Result<Placed<'a, 'input>, ImportError> {
    let mut walk = Walk {
        xml,
        notes,
        reporter,
        path: Vec::new(),
        elements: 0,
        lights: HashMap::new(),
        cameras: HashMap::new(),
        placed: Placed::default(),
    };
    for node in children(visual_scene, "node") {
        walk.visit(node, node, world_from_file)?;
    }
    Ok(walk.placed)
}

struct Walk<'w, 'r, 'a, 'input> {
    xml: &'w Xml<'a, 'input>,
    notes: &'w mut Notes,
    reporter: &'w mut Reporter<'r>,
    /// The nodes from the root to here.
    path: Vec<NodeId>,
    /// Elements inside nodes looked at.
    elements: usize,
    lights: HashMap<NodeId, Option<Light>>,
    cameras: HashMap<NodeId, FieldOfView>,
    placed: Placed<'a, 'input>,
}

impl<'a, 'input> Walk<'_, '_, 'a, 'input> {
    /// Places a node and what is below it. `from` is the node itself or the `<instance_node>` that
    /// led to it.
    fn visit(
        &mut self,
        node: Node<'a, 'input>,
        from: Node<'a, 'input>,
        world_from_parent: DMat4,
    ) -> Result<(), ImportError> {
        self.check_limits(node, from)?;
        self.path.push(node.id());
        let world_from_node = world_from_parent * parent_from_node(self.xml, self.notes, node);
        for element in node.children().filter(Node::is_element) {
            self.elements += 1;
            match element.tag_name().name() {
                "node" => self.visit(element, element, world_from_node)?,
                "instance_node" => {
                    let target = self.xml.follow(self.notes, element, "url", "node");
                    if let Some(target) = target {
                        self.visit(target, element, world_from_node)?;
                    }
                }
                "instance_geometry" => {
                    let target = self.xml.follow(self.notes, element, "url", "geometry");
                    if let Some(geometry) = target {
                        self.place_geometry(node, element, geometry, world_from_node);
                    }
                }
                "instance_controller" => self.place_controller(node, element, world_from_node),
                "instance_light" => self.place_light(node, element, world_from_node),
                "instance_camera" => self.place_camera(node, element, world_from_node),
                _ => {}
            }
        }
        self.path.pop();
        Ok(())
    }

    fn check_limits(
        &mut self,
        node: Node<'a, 'input>,
        from: Node<'a, 'input>,
    ) -> Result<(), ImportError> {
        let path = || self.reporter.path.to_owned();
        let line = || self.xml.line(from);
        if self.path.contains(&node.id()) {
            return Err(ImportError::NodeCycle {
                path: path(),
                line: line(),
                element: format!("\"{}\"", name_of(node)),
            });
        }
        if self.path.len() >= DEPTH_LIMIT {
            return Err(ImportError::TooDeep {
                path: path(),
                line: line(),
                limit: DEPTH_LIMIT,
            });
        }
        self.placed.nodes += 1;
        if self.placed.nodes > NODE_LIMIT || self.elements > ELEMENT_LIMIT {
            return Err(ImportError::TooManyNodes {
                path: path(),
                line: line(),
                limit: NODE_LIMIT,
            });
        }
        if self.placed.nodes.is_multiple_of(256) {
            // How many nodes there are is only known at the end.
            let nodes = self.placed.nodes as f32;
            self.reporter
                .at(LoadStage::Nodes, nodes / (nodes + 10_000.0))?;
        }
        Ok(())
    }

    fn place_geometry(
        &mut self,
        node: Node<'a, 'input>,
        instance: Node<'a, 'input>,
        geometry: Node<'a, 'input>,
        world_from_object: DMat4,
    ) {
        if self.can_place(node, &world_from_object, is_singular(&world_from_object)) {
            self.placed.geometry.push(Placement {
                name: name_of(node),
                instance,
                geometry,
                world_from_object,
            });
        }
    }

    fn place_controller(
        &mut self,
        node: Node<'a, 'input>,
        instance: Node<'a, 'input>,
        world_from_node: DMat4,
    ) {
        let controller = self
            .xml
            .follow(self.notes, instance, "url", "controller")
            .and_then(|controller| resolve_controller(self.xml, self.notes, controller));
        if let Some((geometry, node_from_object)) = controller {
            let world_from_object = world_from_node * node_from_object;
            self.place_geometry(node, instance, geometry, world_from_object);
        }
    }

    fn place_light(
        &mut self,
        node: Node<'a, 'input>,
        instance: Node<'a, 'input>,
        world_from_light: DMat4,
    ) {
        let Some(light) = self.xml.follow(self.notes, instance, "url", "light") else {
            return;
        };
        let known = self.lights.entry(light.id());
        let light = *known.or_insert_with(|| read_light(self.xml, self.notes, light));
        match light {
            Some(Light::Ambient(radiance)) => self.placed.ambient += radiance,
            Some(Light::Placed(kind)) => {
                let axis = world_from_light.z_axis.truncate().length();
                let is_flat = match kind {
                    LightKind::Area { .. } => is_singular(&world_from_light),
                    LightKind::Point { .. } => false,
                    LightKind::Spot { .. } | LightKind::Directional { .. } => axis == 0.0,
                };
                if self.can_place(node, &world_from_light, is_flat) {
                    self.placed.lights.push(LightNode {
                        name: name_of(node),
                        kind,
                        world_from_light,
                    });
                }
            }
            None => {}
        }
    }

    fn place_camera(
        &mut self,
        node: Node<'a, 'input>,
        instance: Node<'a, 'input>,
        world_from_camera: DMat4,
    ) {
        let camera = self.xml.follow(self.notes, instance, "url", "camera");
        let Some(camera) = camera else { return };
        let known = self.cameras.entry(camera.id());
        let fov = *known.or_insert_with(|| read_camera(self.xml, self.notes, camera));
        if self.can_place(node, &world_from_camera, is_singular(&world_from_camera)) {
            self.placed.cameras.push(FileCamera {
                name: name_of(node),
                world_from_camera,
                fov,
            });
        }
    }

    /// False, with a note, when a matrix is of no use.
    fn can_place(&mut self, node: Node<'a, 'input>, matrix: &DMat4, is_flat: bool) -> bool {
        let message = if !is_usable(matrix) {
            "the node's transforms give a matrix that is not affine, not finite or beyond 1e30; what it places was left out"
        } else if is_flat {
            "the node's transforms flatten space (a scale of 0?); what it places was left out"
        } else {
            return true;
        };
        let line = Some(self.xml.line(node));
        self.notes
            .add(Severity::Warning, line, describe(node), message);
        false
    }
}
