use crate::film::Film;

/// Which pixels of a film are traced together, because their paths share light: what one of them needs
/// all of them get.
#[derive(Debug)]
pub(super) struct Companions {
    /// The number of its group, for each place in the region, row by row.
    group: Vec<u32>,
    groups: usize,
}

impl Companions {
    /// Groups of what lies in `film` of clusters of `size` pixels.
    pub(super) fn new(film: &Film, size: usize) -> Self {
        let region = film.region();
        let mut group = vec![0; region.width as usize * region.height as usize];
        let mut groups = 0;
        for tile in film.tiles() {
            for cluster in tile.clusters(size as u32) {
                for [x, y] in cluster
                    .pixels()
                    .filter(|&[x, y]| tile.area().contains(x, y))
                {
                    let place = (y - region.y) * region.width + (x - region.x);
                    group[place as usize] = groups;
                }
                groups += 1;
            }
        }
        Self {
            group,
            groups: groups as usize,
        }
    }

    /// The number of groups; some may be empty.
    pub(super) fn len(&self) -> usize {
        self.groups
    }

    /// The group of the pixel at `place`.
    pub(super) fn of(&self, place: usize) -> usize {
        self.group[place] as usize
    }
}
