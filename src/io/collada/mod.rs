//! COLLADA 1.4 and 1.5, with the course's extensions (profiles CGL and CMU462).

mod binding;
mod camera;
mod common_effect;
mod controller;
mod decode;
mod effect;
mod light;
mod matrix;
mod mesh;
mod nodes;
mod numbers;
mod polygon;
mod read;
mod repair;
mod scene;
mod source;
mod text;
mod transform;
mod values;
mod xml;

pub use read::read_collada;
