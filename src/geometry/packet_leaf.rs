use super::Hit;
use super::block::Block;
use super::leaf::{LeafOrder, Query};
use super::packet::{Corners, Packet, Planes, SharedEdge};
use crate::bvh::{BLOCK, PACKET, PacketAnswers, PacketLeaves, PacketRays, PerRay, groups};
use crate::math::{Lanes, Ray, set_bits};

impl PacketLeaves for LeafOrder {
    type Packet = Packet;

    #[inline(always)]
    fn set_packet<V: Lanes>(&self, rays: &PacketRays, packet: &mut Packet) -> bool {
        packet.set::<V>(rays)
    }

    #[inline(always)]
    fn limit(packet: &Packet) -> &PerRay {
        packet.limit()
    }

    #[inline(always)]
    fn visit_packet<V: Lanes, const SHARED: bool>(
        &self,
        first: u32,
        rays: (&[Ray], &PacketRays),
        packet: &mut Packet,
        active: u32,
    ) -> u64 {
        let mut count = 0;
        for block in &self.blocks()[first as usize..] {
            count += 1;
            packet.visit::<V, SHARED>(rays, block, active);
            if block.is_plain() {
                break;
            }
            if block.has_spheres() {
                for i in set_bits(active) {
                    packet.alone(rays, i, |query, ray| query.spheres(self, ray, block));
                }
            }
            if !block.has_more() {
                break;
            }
        }
        count
    }

    #[inline(always)]
    fn drop_ray(packet: &mut Packet, i: usize) {
        packet.drop_ray(i);
    }

    #[inline(always)]
    fn of_packet(&self, packet: &Packet, i: usize) -> Query {
        packet.query(i)
    }
}

/// The hits of rays that are traced in packets.
pub(super) struct PacketHits<'a>(pub(super) &'a mut [Hit]);

impl PacketAnswers<LeafOrder> for PacketHits<'_> {
    #[inline(always)]
    fn one(&mut self, number: usize, query: Option<&Query>) {
        self.0[number] = query.map_or(Hit::MISS, |query| query.hit);
    }

    #[inline(always)]
    fn all(&mut self, first: usize, packet: &Packet) {
        packet.write_hits(&mut self.0[first..first + PACKET]);
    }
}

impl Packet {
    /// Tests the triangles of a block, at least for the `active` rays.
    #[inline(always)]
    fn visit<V: Lanes, const SHARED: bool>(
        &mut self,
        rays: (&[Ray], &PacketRays),
        block: &Block,
        active: u32,
    ) {
        let corners = Corners::new::<V, SHARED>(block, self.axes(), rays.1);
        let mut planes = None;
        let len = block.len();
        for group in 0..groups::<V>() {
            let active = active >> (V::N * group) & V::ALL;
            if active == 0 {
                continue;
            }
            for place in 0..len {
                let edge = self.shared_edge::<V, SHARED>(rays.1, &corners, (place, group));
                let mut meet = |triangle: usize| {
                    self.meet::<V, SHARED>(
                        rays,
                        (block, &corners, &mut planes),
                        &edge,
                        (triangle, group, active),
                    );
                };
                meet(place);
                if block.is_quad(place) {
                    meet(BLOCK + place);
                }
            }
        }
    }

    /// Meets one triangle of a block.
    #[inline(always)]
    fn meet<V: Lanes, const SHARED: bool>(
        &mut self,
        rays: (&[Ray], &PacketRays),
        (block, corners, planes): (&Block, &Corners, &mut Option<Planes>),
        edge: &SharedEdge<V>,
        (triangle, group, active): (usize, usize, u32),
    ) {
        let place = (triangle, group);
        let edges = self.edges::<V, SHARED>(rays.1, corners, edge, place);
        let inside = edges.inside();
        if V::bits(inside) & active == 0 {
            return;
        }
        // One of zero may be a rounding; where the others differ in sign it does not matter.
        let on_edge = inside & edges.on_edge();
        if V::bits(on_edge) != 0 {
            self.on_edge(rays, (block, triangle), (V::N * group, V::bits(on_edge)));
        }
        let inside = V::without(inside, on_edge);
        // Not `get_or_insert_with`, which is not inlined.
        if planes.is_none() {
            *planes = Some(Planes::new::<V>(block, self.axes(), corners));
        }
        let Some(planes) = planes else { return };
        let hits = self.hits::<V, SHARED>(rays.1, (corners, planes), &edges, place);
        self.offer(rays.1, hits, inside, (planes, block.id(triangle), place));
    }

    /// The rays in `lanes` from the `first` on, one at a time with exact edge functions.
    #[cold]
    #[inline(never)]
    fn on_edge(
        &mut self,
        rays: (&[Ray], &PacketRays),
        (block, triangle): (&Block, usize),
        (first, lanes): (usize, u32),
    ) {
        for lane in set_bits(lanes) {
            self.alone(rays, first + lane, |query, ray| {
                query.triangles_on_edges(ray, block, 1 << triangle);
            });
        }
    }
}
