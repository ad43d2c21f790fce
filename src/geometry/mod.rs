//! Floor 3: shapes. `Mesh` is what files hold; `Shapes` is what rays meet; `Aggregate` is shapes
//! under a BVH with the batch tracing interface.

mod aggregate;
mod block;
mod departure;
mod hit;
mod leaf;
mod mesh;
mod packet;
mod packet_leaf;
mod refine;
mod shapes;
mod sphere;
mod triangle;

pub use aggregate::{Aggregate, TraceCounts};
pub use departure::triangle_departure;
pub use hit::Hit;
pub use mesh::{Corner, Mesh, MeshTriangle};
pub use shapes::Shapes;
pub use sphere::Sphere;
pub use triangle::triangle_point_and_error;
