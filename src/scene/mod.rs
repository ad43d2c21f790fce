//! Floor 5: the editable description of a scene, its runtime form, the step between them, and the
//! scenes that come with the program.

mod builder;
mod description;
mod emitters;
mod initial_camera;
mod instancing;
mod interaction;
mod lights;
mod photons;
mod placed_mesh;
mod plain;
mod prepare;
mod prepare_cache;
mod prepared;
mod procedural;
mod shading_normals;
mod shared_mesh;
mod specular;

pub use builder::SceneBuilder;
pub use description::{
    Dialect, Environment, EnvironmentMap, FieldOfView, FileCamera, Geometry, Instance, LightKind,
    LightNode, Material, Scene, Surface, UpAxis,
};
pub use initial_camera::initial_camera;
pub use instancing::Instancing;
pub use interaction::SurfaceInteraction;
pub use plain::{PlainShape, PlainSurfaces};
pub use prepare::{PrepareProgress, PrepareSettings, prepare, prepare_with};
pub use prepare_cache::{PrepareCache, PrepareCounts};
pub use prepared::PreparedScene;
pub use procedural::{PROCEDURAL, cornell_box, procedural};
