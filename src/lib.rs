//! softbox: an interactive progressive path tracer for the CPU. This page is the architecture.
//!
//! # Bird's-eye view
//! A file becomes a [`scene::Scene`] (plain, editable, double precision). [`scene::prepare`] makes
//! it a [`scene::PreparedScene`] (immutable, single precision, recentred and scaled to unit size).
//! A [`session::RenderSession`] takes [`session::RenderJob`]s (scene, camera, settings), renders
//! passes over the tiles of a [`film::Film`] on its own threads, and publishes
//! [`session::Snapshot`]s. The window and the command line are two faces over the same session.
//!
//! # Floors
//! A module uses only modules on lower floors; `tests/architecture.rs` holds it to that.
//! ```text
//!  8  bin/softbox      the program: viewer and headless
//!  7  session   io     session never reads files; io never renders
//!  6  integrator       one path
//!  5  scene            description → runtime
//!  4  light  guide  display  settings
//!  3  geometry  bsdf  camera  film  study
//!  2  bvh  image
//!  1  sampling
//!  0  math  color
//! ```
//!
//! # One sample
//! ```text
//! pass (all tiles once)                                            session
//!  └ tile: batches of paths, each a (pixel, sample number)         session, film
//!     └ start: camera ray                                          integrator, camera
//!        trace a batch of rays for their closest hits              geometry → bvh
//!        arrive: emission, surface, material                       scene, light, bsdf
//!        direct light: a light from the tree, a point on it        light
//!        … shadow rays, traced as a batch for any hit              geometry
//!        scatter: next ray, Russian roulette                       bsdf, sampling
//!        exchange: what leaves the second surfaces of a cluster    integrator
//!     add the finished paths in the order of their numbers         film
//! pass done → snapshot → host                                      session
//! ```
//! Plain surfaces (diffuse, without emission, not of an instance) are shaded eight or sixteen paths
//! at a time, the others one by one. A kernel is written once over [`math::Lanes`] and compiled for each
//! instruction set ([`math::run_lanes`]); `wavefront`, `light`, `sampling` and the sweep have such.
//!
//! # Noise
//! - The samples of a pixel are points of an Owen-scrambled net ([`sampling::PathSampler`]), not
//!   independent numbers; `replicates` deals them out to sequences that are, for honest intervals.
//! - A picture tells its error by the halves of each pixel's samples ([`film::PixelStats::squared_error`]),
//!   or by its replicates; adaptive sampling ([`settings::AdaptiveGoal`]) decides between passes, from
//!   the film alone.
//! - One light is chosen per sample, by what it may give at the vertex ([`light::LightTree`]), and a
//!   point on it by solid angle or nearly so; parallelograms are sampled as a whole. Where all lights
//!   are a few without extent, each is sampled.
//! - A diffuse vertex under a single parallelogram takes light samples alone; elsewhere they share with
//!   the scattered ray by multiple importance. A constant sky is left to the scattered ray.
//! - The paths of a cluster of up to 16 pixels ([`film::Cluster`]) share the light that leaves the
//!   second diffuse surface of each, weighted so that the mean stays; what they draw for it are points
//!   of one net ([`sampling::PathSampler::in_cluster`]). Only in mode best. Under a constant sky what the
//!   weights fall short of their mean corrects the sum (`integrator/furnace.rs`); samples may be negative
//!   there.
//! - Diffuse vertices that see an area light through mirrors or glass aim some of their rays at it: light
//!   paths, traced when the scene is prepared, have told where ([`guide`]).
//! - Roulette lets every path of at least a quarter of the full throughput live.
//!
//! # Invariants
//! - A sample is a pure function of (scene, settings, seed, pixel, sample number), which also tell the
//!   other paths of its cluster: they are traced along where they are not part of the picture. Random numbers
//!   are addressed by bounce and [`sampling::Slot`], never drawn in sequence. Threads, tiles,
//!   passes and pauses change no bit of the picture.
//! - [`integrator::reference_cluster`] and [`integrator::Wavefront`] give the same bits with every
//!   instruction set ([`math::Isa`]) and any length of batch.
//! - [`integrator::reference_f64`] repeats every path in double precision with formulas of its own;
//!   but for the few that rounding sends elsewhere, both give the same radiance.
//! - Tracing is a batch: [`geometry::Aggregate::closest_hit`], [`geometry::Aggregate::any_hit`].
//!   It is watertight, and gives what testing every primitive gives, bit for bit.
//!   Scenes of a few dozen primitives are swept without a tree, with the same hits.
//! - A mesh with many copies is prepared once ([`geometry::Instances`], [`scene::Instancing`]): a ray
//!   that meets the box of an instance goes on in the space of the mesh. Copies and instances give
//!   the same picture up to rounding, and up to noise where rays are aimed. An edit that moves an object keeps its hierarchy
//!   ([`scene::PrepareCache`]).
//! - [`scene::PreparedScene`] is immutable and shared by `Arc`. A better hierarchy, made in the
//!   background, makes another one over the same tables; renders change over between two batches.
//! - No module below the program knows windows, threads (but for `session`), the clock (but for
//!   `session` and build times) or files (but for `io`).
//! - A [`session::Workbench`] renders the same pictures in steps, for `bench` to score.
//! - `unsafe` has two rooms: `math::lanes` and `bvh::simd`, for instructions of the processor.
//! - The host says every frame what it wants to see; only `session` decides what that costs.
//! - Radiance that is NaN, infinite or negative never reaches the film; it is counted.
//!
//! # Conventions
//! Linear Rec.709 radiance; radians; y up in the world, y down in pictures. `wo` and `wi` point
//! away from the surface. `eval` has no cosine. Depth counts bounces: 0 is emission seen directly.
//!
//! # Where a change goes
//! | to add | touch |
//! |---|---|
//! | a material | `bsdf/`: its file and variant; `scene::Surface`; `io` reads it; a chi-square case |
//! | a light | `light/`: its file, variant and bounds for the tree; `scene::LightKind`; a chi-square case; once more in `integrator/double/` |
//! | a random number | a variant of [`sampling::Slot`] |
//! | a step of the path | `integrator/path.rs`, and in lanes where `wavefront/shade.rs` takes it; `tests/both_tracers` |
//! | an instruction set | [`math::Isa`] and an implementation of [`math::Lanes`] |
//! | where rays are aimed | `guide/`, `scene/photons.rs`, `integrator/guided.rs`; once more in `integrator/double/` |
//! | a setting | [`settings`]; a flag in the program's `args`, a row in a panel |
//! | a figure of `bench` | [`study`]; the program's `bench/` prints it |
//! | a file format | `io/`: a file, and a line where the extension is looked up |
//! | a faster traversal | `bvh/`, `geometry/aggregate.rs`, `geometry/sweep/`; callers see the batch interface |

pub mod bsdf;
pub mod bvh;
pub mod camera;
pub mod color;
pub mod display;
pub mod film;
pub mod geometry;
pub mod guide;
pub mod image;
pub mod integrator;
pub mod io;
pub mod light;
pub mod math;
pub mod sampling;
pub mod scene;
pub mod session;
pub mod settings;
pub mod study;
