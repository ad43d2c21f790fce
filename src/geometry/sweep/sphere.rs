use super::Ball;
use super::packet::Packet;
use crate::math::{DoubleLanes, Lanes};

impl<V: Lanes> Packet<V> {
    /// Tests a sphere: [`super::super::Sphere::meet`] with the same operations in the same order, then
    /// what [`super::super::leaf::Query`] does with both roots.
    #[inline(always)]
    pub(super) fn meet_sphere(&mut self, ball: &Ball) {
        let (front, meets) = self.enter(&ball.bounds);
        let wanted = meets & front.le(self.t);
        if V::bits(wanted) == 0 {
            return;
        }
        let wide = |value: V| V::Doubles::widen(value);
        let [cx, cy, cz] = ball.sphere.center.to_array();
        let to = |center: f32, origin: V| V::Doubles::splat(center.into()) - wide(origin);
        let [ox, oy, oz] = self.origin;
        let (x, y, z) = (to(cx, ox), to(cy, oy), to(cz, oz));
        let [dx, dy, dz] = self.direction;
        let (dx, dy, dz) = (wide(dx), wide(dy), wide(dz));
        let radius = f64::from(ball.sphere.radius);
        let radius_squared = V::Doubles::splat(radius * radius);
        let a = dx * dx + dy * dy + dz * dz;
        let b = x * dx + y * dy + z * dz;
        let along = b / a;
        let (fx, fy, fz) = (x - dx * along, y - dy * along, z - dz * along);
        let discriminant = radius_squared - (fx * fx + fy * fy + fz * fz);
        // In single precision it keeps its sign; of negative numbers the root is NaN, which fails
        // every comparison.
        let crosses = discriminant.narrow().ge(V::splat(0.0));
        let c = x * x + y * y + z * z - radius_squared;
        let sign = wide(V::splat(1.0).copysign(b.narrow()));
        let q = b + (a * discriminant).sqrt() * sign;
        let (t0, t1) = ((c / q).narrow(), (q / a).narrow());
        let wanted = wanted & crosses & t0.eq(t0);
        self.offer(t0.min(t1), front, wanted, ball.id);
        self.offer(t0.max(t1), front, wanted, ball.id);
    }

    /// Takes a hit of a sphere where it is `wanted`, valid and better than the best so far.
    #[inline(always)]
    fn offer(&mut self, t: V, front: V, wanted: V::Mask, id: f32) {
        let id = V::splat(id);
        let possible = wanted & t.gt(self.t_min) & t.lt(self.t_max) & t.le(self.t);
        let t = t.max(front);
        let better = t.lt(self.t) | (t.eq(self.t) & id.lt(self.primitive));
        let met = possible & t.lt(self.t_max) & better;
        self.t = V::select(met, t, self.t);
        self.primitive = V::select(met, id, self.primitive);
        self.det = V::select(met, V::splat(1.0), self.det);
        self.b1 = V::select(met, V::splat(0.0), self.b1);
        self.b2 = V::select(met, V::splat(0.0), self.b2);
    }
}
