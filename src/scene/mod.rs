//! Floor 5: the editable description of a scene, its runtime form, the step between them, and the
//! scenes that come with the program.

mod description;

pub use description::{
    Dialect, Environment, EnvironmentMap, FieldOfView, FileCamera, Geometry, Instance, LightKind,
    LightNode, Material, Scene, Surface, UpAxis,
};
