use glam::Vec3;

/// Levels of cells, each half as wide as the one before; caustics are fine.
pub(super) const LEVELS: u32 = 5;

/// The width of the largest.
const WIDEST: f32 = 0.1;

/// Where the grid starts: scenes lie within −1..1, and walls at round numbers should not lie between two
/// cells.
const ORIGIN: Vec3 = Vec3::new(-1.0173, -1.0091, -1.0219);

/// Factors by which the components of a normal compete, so that planes at 45° do not lie between two
/// cells either.
const COMPETE: Vec3 = Vec3::new(1.0, 1.07, 1.13);

/// In place of a key.
const FREE: u64 = u64::MAX;

/// Marks cells that have smaller ones inside.
const SPLIT: u32 = 1 << 31;

/// The width of the cells of `level`.
pub(super) fn width(level: u32) -> f32 {
    WIDEST / (1_u32 << level) as f32
}

/// The cell of `level` that a point belongs to, with the side on which it is lit.
pub(super) fn key(level: u32, point: Vec3, normal: Vec3) -> u64 {
    let place = (point - ORIGIN) / width(level);
    let at = |x: f32| u64::from(x.clamp(0.0, 1023.0) as u16);
    at(place.x)
        | at(place.y) << 10
        | at(place.z) << 20
        | side(normal) << 30
        | u64::from(level) << 33
}

/// Which of the six directions along an axis is closest to `normal`, roughly.
fn side(normal: Vec3) -> u64 {
    let size = normal.abs() * COMPETE;
    let axis = if size.x > size.y && size.x > size.z {
        0
    } else if size.y > size.z {
        1
    } else {
        2
    };
    2 * axis + u64::from(normal[axis as usize] < 0.0)
}

/// Numbers of cells by key: a hash table with open addressing, at most half full.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CellTable {
    entries: Vec<(u64, u32)>,
    count: usize,
}

impl CellTable {
    pub(super) fn new() -> Self {
        Self {
            entries: vec![(FREE, 0); 64],
            count: 0,
        }
    }

    /// The number of the smallest cell that is there for a point.
    #[inline]
    pub(super) fn find(&self, point: Vec3, normal: Vec3) -> Option<u32> {
        let mut found = None;
        for level in 0..LEVELS {
            let Some(cell) = self.get(key(level, point, normal)) else {
                break;
            };
            found = Some(cell & !SPLIT);
            if cell & SPLIT == 0 {
                break;
            }
        }
        found
    }

    #[inline]
    fn get(&self, key: u64) -> Option<u32> {
        let (found, cell) = self.entries[self.place(key)];
        (found == key).then_some(cell)
    }

    /// Where `key` is, or would be.
    #[inline]
    fn place(&self, key: u64) -> usize {
        let mask = self.entries.len() - 1;
        let mut place = (key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32) as usize & mask;
        while self.entries[place].0 != key && self.entries[place].0 != FREE {
            place = (place + 1) & mask;
        }
        place
    }

    /// Adds cell number `cell`, below 2³¹, under a key that is new.
    pub(super) fn insert(&mut self, key: u64, cell: u32, is_split: bool) {
        if 2 * (self.count + 1) > self.entries.len() {
            let larger = vec![(FREE, 0); 2 * self.entries.len()];
            for (key, cell) in std::mem::replace(&mut self.entries, larger) {
                if key != FREE {
                    let place = self.place(key);
                    self.entries[place] = (key, cell);
                }
            }
        }
        let place = self.place(key);
        self.entries[place] = (key, cell | if is_split { SPLIT } else { 0 });
        self.count += 1;
    }
}
