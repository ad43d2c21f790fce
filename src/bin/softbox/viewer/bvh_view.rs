//! The boxes of the hierarchy over the picture: one level of them, or one box with its children as
//! in the course.

use std::fmt;
use std::sync::Arc;

use eframe::egui::{self, Color32, Mesh, Shape, Stroke};
use glam::Vec3;
use softbox::bvh::{Bvh, BvhStats, NodeId};
use softbox::camera::Camera;
use softbox::math::Aabb;
use softbox::scene::PreparedScene;

use super::letterbox::Letterbox;
use super::projection::{Projector, add_line, add_triangle};

/// The most boxes of a level that are drawn, the largest first: above it software drivers crawl.
const MOST_BOXES: usize = 1_500;
/// The most tinted triangles.
const MOST_TRIANGLES: usize = 6_000;

const GREY: Color32 = Color32::from_rgba_premultiplied(64, 64, 64, 64);
const SELECTED: Color32 = Color32::from_rgb(255, 64, 0);
const CHILD: Color32 = Color32::from_rgb(255, 255, 255);
const LEFT: Color32 = Color32::from_rgba_premultiplied(84, 84, 140, 140);
const RIGHT: Color32 = Color32::from_rgba_premultiplied(140, 105, 60, 140);

/// Which boxes are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Boxes {
    /// The selected box, its children, and the boxes on the way to it.
    #[default]
    Walk,
    /// All boxes of one level.
    Level,
}

/// The state of the view, and what was drawn last.
#[derive(Debug, Default)]
pub(super) struct BvhView {
    /// True when boxes are drawn.
    pub(super) is_on: bool,
    /// Which.
    pub(super) boxes: Boxes,
    /// The level to draw.
    pub(super) level: usize,
    selected: Option<NodeId>,
    scene: Option<Arc<PreparedScene>>,
    stats: Option<BvhStats>,
    level_size: usize,
    drawn: Option<(Key, Arc<Mesh>)>,
}

/// What a drawing depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    camera: Camera,
    letterbox: Letterbox,
    boxes: Boxes,
    level: usize,
    selected: Option<NodeId>,
}

/// Facts of the selected box.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct NodeFacts {
    depth: usize,
    primitives: usize,
    children: Option<[usize; 2]>,
    /// Boxes of the level, and how many of them are drawn.
    level: Option<(usize, usize)>,
}

impl fmt::Display for NodeFacts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((all, drawn)) = self.level {
            write!(f, "boxes on this level: {all}")?;
            if drawn < all {
                write!(f, "\ndrawn: the {drawn} largest")?;
            }
            return Ok(());
        }
        writeln!(f, "depth {}, primitives {}", self.depth, self.primitives)?;
        match self.children {
            Some([left, right]) => write!(f, "split {left} | {right}"),
            None => f.write_str("a leaf"),
        }
    }
}

impl BvhView {
    /// Follows the scene that is shown; a new one starts at its root.
    pub(super) fn set_scene(&mut self, scene: Option<&Arc<PreparedScene>>) {
        let is_same = match (&self.scene, scene) {
            (Some(old), Some(new)) => Arc::ptr_eq(old, new),
            (None, None) => true,
            _ => false,
        };
        if is_same {
            return;
        }
        self.scene = scene.cloned();
        self.drawn = None;
        let bvh = self.scene.as_ref().map(|scene| scene.aggregate().bvh());
        self.selected = bvh.and_then(Bvh::root);
        self.stats = self.scene.as_ref().map(|scene| scene.aggregate().stats());
        self.level = self.level.min(self.deepest());
    }

    /// Depth of the deepest leaf.
    pub(super) fn deepest(&self) -> usize {
        self.stats.as_ref().map_or(0, |stats| stats.max_depth)
    }

    /// Shape and cost of the hierarchy.
    pub(super) fn stats(&self) -> Option<&BvhStats> {
        self.stats.as_ref()
    }

    /// To the parent of the selected box.
    pub(super) fn select_parent(&mut self) {
        self.walk(|bvh, node| bvh.parent(node));
    }

    /// To the first (0) or second (1) child.
    pub(super) fn select_child(&mut self, which: usize) {
        self.walk(|bvh, node| bvh.children(node).map(|children| children[which]));
    }

    fn walk(&mut self, step: impl Fn(&Bvh, NodeId) -> Option<NodeId>) {
        self.is_on = true;
        self.boxes = Boxes::Walk;
        if let (Some(scene), Some(node)) = (&self.scene, self.selected) {
            self.selected = step(scene.aggregate().bvh(), node).or(Some(node));
        }
    }

    /// The facts of the selection.
    pub(super) fn facts(&self) -> Option<NodeFacts> {
        let bvh = self.scene.as_ref()?.aggregate().bvh();
        let node = self.selected?;
        let size = |node| bvh.primitives_below(node);
        Some(NodeFacts {
            depth: bvh.depth(node),
            primitives: size(node),
            children: bvh.children(node).map(|children| children.map(size)),
            level: (self.boxes == Boxes::Level)
                .then_some((self.level_size, self.level_size.min(MOST_BOXES))),
        })
    }

    /// Draws the boxes over the picture.
    pub(super) fn paint(&mut self, painter: &egui::Painter, camera: &Camera, at: Letterbox) {
        let (true, Some(scene)) = (self.is_on, self.scene.clone()) else {
            return;
        };
        let key = Key {
            camera: *camera,
            letterbox: at,
            boxes: self.boxes,
            level: self.level,
            selected: self.selected,
        };
        let mesh = match &self.drawn {
            Some((drawn, mesh)) if *drawn == key => Arc::clone(mesh),
            _ => Arc::new(self.draw(&scene, &key)),
        };
        self.drawn = Some((key, Arc::clone(&mesh)));
        painter.with_clip_rect(at.rect).add(Shape::mesh(mesh));
    }

    fn draw(&mut self, scene: &PreparedScene, key: &Key) -> Mesh {
        let projector = Projector::new(&key.camera, key.letterbox, scene.normalization());
        let bvh = scene.aggregate().bvh();
        let mut mesh = Mesh::default();
        match (self.boxes, self.selected) {
            (Boxes::Level, _) => {
                let mut boxes = boxes_of_level(bvh, self.level);
                self.level_size = boxes.len();
                boxes.sort_by(|a, b| b.half_area().total_cmp(&a.half_area()));
                for bounds in boxes.iter().take(MOST_BOXES) {
                    add_box(&mut mesh, &projector, bounds, Stroke::new(1.0, SELECTED));
                }
            }
            (Boxes::Walk, Some(node)) => draw_walk(&mut mesh, &projector, scene, node),
            (Boxes::Walk, None) => {}
        }
        mesh
    }
}

fn draw_walk(mesh: &mut Mesh, projector: &Projector, scene: &PreparedScene, node: NodeId) {
    let bvh = scene.aggregate().bvh();
    if let Some(children) = bvh.children(node) {
        for (child, tint) in children.into_iter().zip([LEFT, RIGHT]) {
            tint_triangles(mesh, projector, scene, child, tint);
        }
        for child in children {
            add_box(mesh, projector, &bvh.bounds(child), Stroke::new(1.0, CHILD));
        }
    } else {
        tint_triangles(mesh, projector, scene, node, LEFT);
    }
    for above in bvh.path(node) {
        if above != node {
            add_box(mesh, projector, &bvh.bounds(above), Stroke::new(1.0, GREY));
        }
    }
    add_box(
        mesh,
        projector,
        &bvh.bounds(node),
        Stroke::new(3.0, SELECTED),
    );
}

fn tint_triangles(
    mesh: &mut Mesh,
    projector: &Projector,
    scene: &PreparedScene,
    node: NodeId,
    tint: Color32,
) {
    let (shapes, aggregate) = (scene.shapes(), scene.aggregate());
    let step = aggregate
        .bvh()
        .primitives_below(node)
        // A quad is two.
        .div_ceil(MOST_TRIANGLES / 2)
        .max(1);
    let triangles = aggregate
        .primitives(node)
        .filter(|&p| (p as usize) < shapes.triangles.len());
    for primitive in triangles.step_by(step) {
        let vertices = aggregate.vertices(primitive).map(|v| v.as_vec3());
        add_triangle(mesh, projector, vertices, tint);
    }
}

fn boxes_of_level(bvh: &Bvh, level: usize) -> Vec<Aabb> {
    let mut nodes: Vec<NodeId> = bvh.root().into_iter().collect();
    for _ in 0..level {
        nodes = nodes
            .into_iter()
            .flat_map(|node| bvh.children(node).into_iter().flatten())
            .collect();
    }
    nodes.into_iter().map(|node| bvh.bounds(node)).collect()
}

fn add_box(mesh: &mut Mesh, projector: &Projector, bounds: &Aabb, stroke: Stroke) {
    let corner = |bits: usize| {
        let pick = |bit: usize, min: f32, max: f32| if bits & bit == 0 { min } else { max };
        Vec3::new(
            pick(1, bounds.min.x, bounds.max.x),
            pick(2, bounds.min.y, bounds.max.y),
            pick(4, bounds.min.z, bounds.max.z),
        )
    };
    for from in 0..8 {
        for bit in [1, 2, 4] {
            if from & bit == 0 {
                add_line(mesh, projector, [corner(from), corner(from | bit)], stroke);
            }
        }
    }
}
