//! Floor 3: shapes. `Mesh` is what files hold; `Shapes` is what rays meet; `Aggregate` is shapes
//! under a BVH with the batch tracing interface. `Instances` are meshes that stand beside them: a
//! hierarchy over their boxes, below which a ray goes on in the space of the mesh.

mod aggregate;
mod block;
mod departure;
mod hit;
mod instance;
mod instance_batch;
mod instance_trace;
mod instances;
mod leaf;
mod mesh;
mod overlap;
mod packet;
mod packet_leaf;
mod placement;
mod quads;
mod refine;
mod refit;
mod shapes;
mod sphere;
mod surface_point;
mod sweep;
mod triangle;

pub use aggregate::{Aggregate, TraceCounts};
pub use departure::{is_clear_of_edges, triangle_departure};
pub use hit::Hit;
pub use instance::Instance;
pub use instances::{InstanceStats, Instances};
pub use mesh::{Corner, Mesh, MeshTriangle};
pub use placement::Placement;
pub use quads::quad_turns;
pub use shapes::Shapes;
pub use sphere::Sphere;
pub use surface_point::SurfacePoint;
pub use triangle::triangle_point_and_error;
