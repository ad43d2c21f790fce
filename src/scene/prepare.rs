//! From description to runtime scene.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::emitters::{Emitters, EmittingRectangle, SurfaceEmission, emitters};
use super::instancing::{Instancing, shared};
use super::lights::{LightTable, light_nodes};
use super::photons::guide;
use super::placed_mesh::PlacedMesh;
use super::plain::plain_reflectances;
use super::prepare_cache::PrepareCache;
use super::prepared::{DARK, FLAT, Owner, PreparedMaterial, Tables};
use super::shading_normals::NormalRule;
use super::shared_mesh::{MeshTables, SharedMesh};
use super::{Geometry, Instance, PreparedScene, Scene, Surface};
use crate::bsdf::{Bsdf, Diffuse, Glass, Microfacet, Mirror, Refraction};
use crate::bvh::BvhSettings;
use crate::color::Rgb;
use crate::geometry::{Aggregate, Mesh, Placement, Shapes, Sphere};
use crate::light::{AreaLight, AreaShape, Light, SphereLight};
use crate::math::{Isa, Normalization};

/// The choices that shape the runtime scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PrepareSettings {
    /// BVH build.
    pub bvh: BvhSettings,
    /// Reproduce the course program's picture with its errors.
    pub course_compatible: bool,
    /// Instruction set to trace with; the best of this processor when `None`. Must be available.
    pub isa: Option<Isa>,
    /// Which meshes are shared.
    pub instancing: Instancing,
}

/// Asked with a stage and its finished fraction, 0..1, from any thread: whether to go on.
pub type PrepareProgress<'a> = dyn Fn(&'static str, f32) -> ControlFlow<()> + Sync + 'a;

/// Makes `scene` ready for tracing; `None` when `progress` (stage, fraction 0..1) breaks.
pub fn prepare(
    scene: &Scene,
    settings: &PrepareSettings,
    progress: &PrepareProgress<'_>,
) -> Option<PreparedScene> {
    prepare_with(scene, settings, &mut PrepareCache::default(), progress)
}

/// The same, with what the preparation of the scene before an edit has left in `cache`.
pub fn prepare_with(
    scene: &Scene,
    settings: &PrepareSettings,
    cache: &mut PrepareCache,
    progress: &PrepareProgress<'_>,
) -> Option<PreparedScene> {
    cache.begin();
    let assembly = assemble(scene, settings, cache, progress)?;
    let Assembly {
        normalization,
        shapes,
        owners,
        owner_of,
        smooth,
        corner_normals,
        mut table,
        emitters,
        shared,
        placed,
        ..
    } = assembly.into_primitive_order();
    light_nodes(
        scene,
        settings.course_compatible,
        &normalization,
        &mut table,
    );
    let sampler = table.sampler(&shapes);
    let aggregate = cache
        .own(shapes, settings.bvh, &|fraction| {
            progress("building the BVH", fraction)
        })?
        .with_instances(placed)
        .with_isa(settings.isa.unwrap_or_else(Isa::best));
    cache.end();
    let instance_names = scene
        .instances
        .iter()
        .map(|instance| instance.name.clone())
        .chain(
            emitters
                .rectangles
                .iter()
                .map(|rectangle| rectangle.name.clone()),
        )
        .collect();
    let materials = materials(scene);
    let tables = Tables {
        normalization,
        plain: plain_reflectances(&owners, &materials),
        owners,
        owner_of,
        smooth,
        corner_normals,
        shared,
        materials,
        instance_names,
        lights: table.lights,
        sampled: table.sampled,
        sampler,
        environment: table.environment,
        course_compatible: settings.course_compatible,
        notes: emitters.notes,
    };
    let mut prepared = PreparedScene {
        aggregate,
        guide: None,
        tables: Arc::new(tables),
    };
    prepared.guide = guide(&prepared, progress).continue_value()?.map(Arc::new);
    Some(prepared)
}

/// Places everything, and builds what is shared.
fn assemble<'a>(
    scene: &'a Scene,
    settings: &PrepareSettings,
    cache: &mut PrepareCache,
    progress: &PrepareProgress<'_>,
) -> Option<Assembly<'a>> {
    let mut assembly = Assembly::new(scene, settings.course_compatible);
    let rule = assembly.normal_rule;
    let shares = shared(scene, &assembly.emitters, rule, settings.instancing);
    for (index, (instance, shares)) in scene.instances.iter().zip(shares).enumerate() {
        let fraction = index as f32 / scene.instances.len() as f32;
        progress("placing geometry", fraction).continue_value()?;
        let geometry = &scene.geometries[instance.geometry];
        if let (true, Geometry::Mesh(mesh)) = (shares, geometry.as_ref()) {
            let building = |fraction| progress("building shared meshes", fraction);
            let (tables, tree) = cache.mesh((geometry, mesh), rule, settings.bvh, &building)?;
            let normalization = &assembly.normalization;
            if let Some(placement) = tables.placement(instance.world_from_object, normalization) {
                assembly.share((index, instance), tables, (tree, placement));
                continue;
            }
        }
        assembly.place(index, instance);
    }
    assembly.place_rectangles();
    Some(assembly)
}

/// The scene's materials, and a black one for the surfaces of area lights.
fn materials(scene: &Scene) -> Vec<PreparedMaterial> {
    let black = PreparedMaterial {
        name: "area light".to_owned(),
        bsdf: Bsdf::Diffuse(Diffuse::new(Rgb::ZERO)),
    };
    scene
        .materials
        .iter()
        .map(|material| PreparedMaterial {
            name: material.name.clone(),
            bsdf: bsdf(&material.surface),
        })
        .chain([black])
        .collect()
}

fn bsdf(surface: &Surface) -> Bsdf {
    match *surface {
        Surface::Diffuse { reflectance } => Bsdf::Diffuse(Diffuse::new(reflectance)),
        Surface::Mirror { reflectance } => Bsdf::Mirror(Mirror::new(reflectance)),
        Surface::Refraction { transmittance, ior } => {
            Bsdf::Refraction(Refraction::new(transmittance, ior))
        }
        Surface::Glass {
            reflectance,
            transmittance,
            ior,
        } => Bsdf::Glass(Glass::new(reflectance, transmittance, ior)),
        Surface::Microfacet { alpha, eta, k } => Bsdf::Microfacet(Microfacet::new(alpha, eta, k)),
    }
}

/// The runtime scene while it grows.
struct Assembly<'a> {
    scene: &'a Scene,
    normal_rule: NormalRule,
    normalization: Normalization,
    emitters: Emitters,
    shapes: Shapes,
    owners: Vec<Owner>,
    /// Owners of triangles, then of spheres once [`Self::into_primitive_order`] ran.
    owner_of: Vec<u32>,
    sphere_owner_of: Vec<u32>,
    smooth: Vec<u32>,
    corner_normals: Vec<[Vec3; 3]>,
    table: LightTable,
    /// Spheres that emit: index among the spheres, emission, owner.
    sphere_lights: Vec<(u32, SurfaceEmission, u32)>,
    /// Instances that share their meshes, and where those stand.
    shared: Vec<SharedMesh>,
    placed: Vec<(Arc<Aggregate>, Placement)>,
}

impl<'a> Assembly<'a> {
    fn new(scene: &'a Scene, course_compatible: bool) -> Self {
        let emitters = emitters(scene, course_compatible);
        let (mut min, mut max) = scene
            .bounds()
            .unwrap_or((DVec3::splat(-0.5), DVec3::splat(0.5)));
        for r in emitters.rectangles.iter().filter(|_| !course_compatible) {
            for corner in [
                r.corner,
                r.corner + r.edge_u,
                r.corner + r.edge_v,
                r.corner + r.edge_u + r.edge_v,
            ] {
                min = min.min(corner);
                max = max.max(corner);
            }
        }
        Self {
            scene,
            normal_rule: if course_compatible {
                NormalRule::AlwaysSmooth
            } else {
                NormalRule::File
            },
            normalization: Normalization::fit(min, max),
            emitters,
            shapes: Shapes::default(),
            owners: Vec::new(),
            owner_of: Vec::new(),
            sphere_owner_of: Vec::new(),
            smooth: Vec::new(),
            corner_normals: Vec::new(),
            table: LightTable::new(course_compatible),
            sphere_lights: Vec::new(),
            shared: Vec::new(),
            placed: Vec::new(),
        }
    }

    fn own(&mut self, material: usize, instance: usize) -> u32 {
        self.owners.push(Owner {
            material: material as u32,
            light: DARK,
            instance: instance as u32,
        });
        self.owners.len() as u32 - 1
    }

    /// An instance whose triangles are not copied.
    fn share(
        &mut self,
        (index, instance): (usize, &Instance),
        tables: Arc<MeshTables>,
        placed: (Arc<Aggregate>, Placement),
    ) {
        let slots = instance.materials.len().clamp(1, usize::from(u16::MAX));
        let first_owner = self.owners.len() as u32;
        for slot in 0..slots {
            self.own(instance.materials.get(slot).copied().unwrap_or(0), index);
        }
        self.shared.push(SharedMesh {
            tables,
            first_owner,
            slots: slots as u16,
        });
        self.placed.push(placed);
    }

    fn place(&mut self, index: usize, instance: &Instance) {
        let scene = self.scene;
        match scene.geometries[instance.geometry].as_ref() {
            Geometry::Mesh(mesh) => self.place_mesh(index, instance, mesh),
            Geometry::Sphere { radius, .. } => {
                let to_world = instance.world_from_object;
                let center = self
                    .normalization
                    .point_to_scene(to_world.transform_point3(DVec3::ZERO));
                // As in the course, the x scale decides.
                let radius =
                    radius * to_world.x_axis.truncate().length() * self.normalization.scale;
                let owner = self.own(instance.materials.first().copied().unwrap_or(0), index);
                if let Some(&emission) = self.emitters.surfaces.get(&(index, 0)) {
                    self.sphere_lights
                        .push((self.shapes.spheres.len() as u32, emission, owner));
                }
                self.shapes.spheres.push(Sphere {
                    center,
                    radius: radius as f32,
                });
                self.sphere_owner_of.push(owner);
            }
        }
    }

    fn place_mesh(&mut self, index: usize, instance: &Instance, mesh: &Mesh) {
        let placed = PlacedMesh::new(mesh, instance.world_from_object, self.normal_rule);
        let base = self.shapes.positions.len() as u32;
        self.shapes.positions.extend(
            placed
                .positions
                .iter()
                .map(|&p| self.normalization.point_to_scene(p)),
        );
        let slots: Vec<Slot> = (0..instance.materials.len().max(1))
            .map(|slot| Slot {
                owner: self.own(instance.materials.get(slot).copied().unwrap_or(0), index),
                emission: self.emitters.surfaces.get(&(index, slot as u16)).copied(),
                primitives: Vec::new(),
            })
            .collect();
        let mut slots = slots;
        for (face, triangle) in mesh.triangles.iter().enumerate() {
            let slot_index = usize::from(triangle.material_slot).min(slots.len() - 1);
            let slot = &mut slots[slot_index];
            let turns = slot.emission.is_some_and(|e| {
                e.towards
                    .is_some_and(|d| d.dot(placed.face_normals[face]) < 0.0)
            });
            let flip = turns != placed.is_mirrored;
            let [a, b, c] = placed.triangles[face].map(|vertex| base + vertex);
            slot.primitives.push(self.shapes.triangles.len() as u32);
            self.shapes
                .triangles
                .push(if flip { [a, c, b] } else { [a, b, c] });
            self.owner_of.push(slot.owner);
            self.push_normals(placed.corner_normals[face], flip, turns);
        }
        for slot in slots {
            self.add_surface_light(slot);
        }
    }

    fn push_normals(&mut self, normals: Option<[Vec3; 3]>, swaps_corners: bool, turns: bool) {
        let Some([a, b, c]) = normals else {
            return self.smooth.push(FLAT);
        };
        let sign = if turns { -1.0 } else { 1.0 };
        self.smooth.push(self.corner_normals.len() as u32);
        let (b, c) = if swaps_corners { (c, b) } else { (b, c) };
        self.corner_normals.push([a, b, c].map(|n| n * sign));
    }

    fn add_surface_light(&mut self, slot: Slot) {
        let Some(emission) = slot.emission.filter(|_| !slot.primitives.is_empty()) else {
            return;
        };
        let shape = AreaShape::Triangles {
            primitives: slot.primitives,
        };
        let light = AreaLight::new(&self.shapes, shape, emission.radiance, emission.two_sided);
        self.owners[slot.owner as usize].light = self.table.add_surface(Light::Area(light));
    }

    /// Area lights without a mesh become visible one-sided rectangles (not in the course's program).
    fn place_rectangles(&mut self) {
        let rectangles = self.emitters.rectangles.clone();
        for (number, rectangle) in rectangles.iter().enumerate() {
            if self.table.course_compatible {
                self.table
                    .add_course_rectangle(rectangle, &self.normalization, &self.shapes);
                continue;
            }
            let owner = self.own(
                self.scene.materials.len(),
                self.scene.instances.len() + number,
            );
            let primitives = self.push_rectangle(rectangle, owner);
            let emission = SurfaceEmission {
                radiance: rectangle.radiance,
                two_sided: false,
                towards: None,
            };
            self.add_surface_light(Slot {
                owner,
                emission: Some(emission),
                primitives,
            });
        }
    }

    fn push_rectangle(&mut self, rectangle: &EmittingRectangle, owner: u32) -> Vec<u32> {
        let base = self.shapes.positions.len() as u32;
        let EmittingRectangle {
            corner,
            edge_u,
            edge_v,
            ..
        } = *rectangle;
        let corners = [
            corner,
            corner + edge_u,
            corner + edge_u + edge_v,
            corner + edge_v,
        ];
        self.shapes
            .positions
            .extend(corners.map(|p| self.normalization.point_to_scene(p)));
        let first = self.shapes.triangles.len() as u32;
        for triangle in [[0, 1, 2], [0, 2, 3]] {
            self.shapes.triangles.push(triangle.map(|i| base + i));
            self.owner_of.push(owner);
            self.smooth.push(FLAT);
        }
        vec![first, first + 1]
    }

    /// Spheres come after the triangles; lights on spheres learn their primitive ids.
    fn into_primitive_order(mut self) -> Self {
        let triangles = self.shapes.triangles.len() as u32;
        self.owner_of.append(&mut self.sphere_owner_of);
        for (sphere, emission, owner) in std::mem::take(&mut self.sphere_lights) {
            let light = SphereLight {
                primitive: triangles + sphere,
                radiance: emission.radiance,
                two_sided: emission.two_sided,
            };
            self.owners[owner as usize].light = self.table.add_surface(Light::Sphere(light));
        }
        if self.corner_normals.is_empty() {
            self.smooth = Vec::new();
        }
        self
    }
}

/// One material slot of a mesh being placed.
struct Slot {
    owner: u32,
    emission: Option<SurfaceEmission>,
    primitives: Vec<u32>,
}
