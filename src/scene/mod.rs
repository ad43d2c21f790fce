//! Floor 5: the editable description of a scene, its runtime form, the step between them, and the
//! scenes that come with the program.

mod builder;
mod description;
mod emitters;
mod initial_camera;
mod interaction;
mod lights;
mod prepare;
mod prepared;
mod procedural;
mod shading_normals;

pub use builder::SceneBuilder;
pub use description::{
    Dialect, Environment, EnvironmentMap, FieldOfView, FileCamera, Geometry, Instance, LightKind,
    LightNode, Material, Scene, Surface, UpAxis,
};
pub use initial_camera::initial_camera;
pub use interaction::SurfaceInteraction;
pub use prepare::{PrepareSettings, prepare};
pub use prepared::PreparedScene;
pub use procedural::{PROCEDURAL, cornell_box, procedural};
