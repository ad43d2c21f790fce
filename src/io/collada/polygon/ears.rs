use glam::DVec2;

use super::{Quality, turn};

/// A ring that loses corners: doubly linked places.
struct Shrinking<'a> {
    points: &'a [DVec2],
    ring: &'a [usize],
    previous: Vec<usize>,
    next: Vec<usize>,
    left: usize,
}

impl Shrinking<'_> {
    fn point(&self, place: usize) -> DVec2 {
        self.points[self.ring[place]]
    }

    fn corner(&self, place: usize) -> [DVec2; 3] {
        [self.previous[place], place, self.next[place]].map(|at| self.point(at))
    }

    fn turn_at(&self, place: usize) -> f64 {
        let [a, b, c] = self.corner(place);
        turn(a, b, c)
    }

    /// A left turn with no other corner inside. Corners at the same point as one of the three,
    /// which bridges to holes make, do not count.
    fn is_ear(&self, place: usize) -> bool {
        let [a, b, c] = self.corner(place);
        if turn(a, b, c) <= 0.0 {
            return false;
        }
        let mut other = self.next[self.next[place]];
        while other != self.previous[place] {
            let p = self.point(other);
            let is_corner = p == a || p == b || p == c;
            let is_inside = turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
            if is_inside && !is_corner {
                return false;
            }
            other = self.next[other];
        }
        true
    }

    /// Takes a corner off and returns its triangle.
    fn cut(&mut self, place: usize) -> [usize; 3] {
        let (before, after) = (self.previous[place], self.next[place]);
        self.next[before] = after;
        self.previous[after] = before;
        self.left -= 1;
        [before, place, after].map(|at| self.ring[at])
    }

    /// The first corner from `start` on that passes.
    fn find(&self, start: usize, passes: impl Fn(&Self, usize) -> bool) -> Option<usize> {
        let mut place = start;
        for _ in 0..self.left {
            if passes(self, place) {
                return Some(place);
            }
            place = self.next[place];
        }
        None
    }
}

/// Triangles of an anticlockwise ring by ear clipping (Meisters, "Polygons have ears", 1975).
/// `budget` counts point tests down.
pub(super) fn clip(
    points: &[DVec2],
    ring: &[usize],
    budget: &mut u64,
    triangles: &mut Vec<[usize; 3]>,
) -> Quality {
    let n = ring.len();
    let mut rest = Shrinking {
        points,
        ring,
        previous: (0..n).map(|i| (i + n - 1) % n).collect(),
        next: (0..n).map(|i| (i + 1) % n).collect(),
        left: n,
    };
    let mut quality = Quality::Clean;
    let mut place = 0;
    let mut tried = 0;
    while rest.left > 3 {
        *budget = budget.saturating_sub(rest.left as u64);
        if *budget == 0 {
            fan(&mut rest, place, triangles);
            return Quality::TooComplex;
        }
        let mut found = rest.is_ear(place).then_some(place);
        if found.is_none() && tried < rest.left {
            tried += 1;
            place = rest.next[place];
            continue;
        }
        if found.is_none() {
            // No ear is left: straight corners go first, they change nothing.
            found = rest.find(place, |rest, at| rest.turn_at(at) == 0.0);
        }
        if found.is_none() {
            quality = Quality::SelfCrossing;
            found = rest.find(place, |rest, at| rest.turn_at(at) > 0.0);
        }
        let ear = found.unwrap_or(place);
        // Every other corner next, which keeps triangles from becoming slivers.
        place = rest.next[rest.next[ear]];
        tried = 0;
        let has_area = rest.turn_at(ear) != 0.0;
        let triangle = rest.cut(ear);
        if has_area {
            triangles.push(triangle);
        }
    }
    if rest.turn_at(place) < 0.0 {
        quality = Quality::SelfCrossing;
    }
    fan(&mut rest, place, triangles);
    quality
}

fn fan(rest: &mut Shrinking<'_>, place: usize, triangles: &mut Vec<[usize; 3]>) {
    while rest.left >= 3 {
        let place = rest.next[place];
        let triangle = rest.cut(place);
        triangles.push(triangle);
    }
}
