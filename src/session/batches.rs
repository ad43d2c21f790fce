use std::ops::Range;

use crate::film::{Cluster, PixelStats, Tile};
use crate::integrator::PathId;

/// The samples that a tile lacks, batch by batch: lowest numbers first, in whole clusters of pixels.
/// Made once for a pass, in which nothing else adds to the tile.
#[derive(Debug)]
pub(super) struct Batches {
    /// Of all open clusters, one after the other.
    pixels: Vec<[u32; 2]>,
    cluster_size: usize,
    /// By cluster, from the first that one of its open pixels lacks. Pixels that have a sample are
    /// needed as long as others share theirs.
    lacking: Vec<Range<u32>>,
    /// Of all clusters together; begins with the next sample.
    samples: Range<u32>,
    /// The next cluster.
    cluster: usize,
}

impl Batches {
    /// All that `tile` lacks of the first `target` samples, in clusters of `cluster_size` pixels.
    pub(super) fn new(tile: &Tile, target: u32, cluster_size: u32) -> Self {
        let mut pixels = Vec::with_capacity(tile.pixels().len());
        let mut all_lacking = Vec::new();
        for cluster in tile.clusters(cluster_size) {
            let lacking = lacking(tile, &cluster, target);
            if !lacking.is_empty() {
                pixels.extend(cluster.pixels());
                all_lacking.push(lacking);
            }
        }
        Self {
            pixels,
            cluster_size: cluster_size as usize,
            samples: hull(all_lacking.iter().cloned()),
            lacking: all_lacking,
            cluster: 0,
        }
    }

    /// Writes the next paths, `size` of them or, if that is no multiple of the size of clusters, so
    /// many more that the last cluster is whole; false when there are none.
    pub(super) fn next(&mut self, size: usize, ids: &mut Vec<PathId>) -> bool {
        ids.clear();
        while !self.samples.is_empty() && ids.len() < size {
            let sample = self.samples.start;
            let left = self.lacking[self.cluster..].iter();
            let pixels = self.pixels[self.cluster * self.cluster_size..].chunks(self.cluster_size);
            for (lacking, pixels) in left.zip(pixels) {
                if ids.len() >= size {
                    return true;
                }
                self.cluster += 1;
                if lacking.contains(&sample) {
                    ids.extend(pixels.iter().map(|&pixel| PathId { pixel, sample }));
                }
            }
            self.cluster = 0;
            self.samples.start += 1;
        }
        !ids.is_empty()
    }
}

/// The samples below `target` that some open pixel of the cluster lacks, and what lies between.
fn lacking(tile: &Tile, cluster: &Cluster, target: u32) -> Range<u32> {
    let inside = (cluster.pixels()).filter(|&[x, y]| tile.area().contains(x, y));
    let pixels = inside.map(|[x, y]| &tile.pixels()[tile.index(x, y)]);
    let of_pixel = |pixel: &PixelStats| pixel.count()..pixel.limit().min(target);
    hull(pixels.map(of_pixel).filter(|own| !own.is_empty()))
}

/// From where the first range begins to where the last one ends.
fn hull(ranges: impl Iterator<Item = Range<u32>>) -> Range<u32> {
    ranges
        .reduce(|all, own| all.start.min(own.start)..all.end.max(own.end))
        .unwrap_or(0..0)
}

#[cfg(test)]
mod tests {
    use super::super::pass::add_batch;
    use super::*;
    use crate::color::Rgb;
    use crate::film::Film;
    use crate::image::Region;

    fn film() -> Film {
        Film::new(Region {
            x: 3,
            y: 2,
            width: 29,
            height: 30,
        })
    }

    /// All paths, batch by batch, each of which is added to the tile as a pass does.
    fn all(tile: &mut Tile, target: u32, (size, cluster_size): (usize, u32)) -> Vec<PathId> {
        let mut batches = Batches::new(tile, target, cluster_size);
        let (mut ids, mut all) = (Vec::new(), Vec::new());
        while batches.next(size, &mut ids) {
            let whole = size.next_multiple_of(cluster_size as usize);
            assert!(ids.len() <= whole && !ids.is_empty());
            all.extend_from_slice(&ids);
            add_batch(tile, &ids, &vec![Rgb::ONE; ids.len()]);
        }
        assert!(!batches.next(size, &mut ids));
        all
    }

    #[test]
    fn every_pixel_gets_every_sample_in_whole_clusters_and_in_order() {
        for sizes in [(512, 1), (512, 16), (100, 8), (1, 4), (4096, 2)] {
            let mut film = film();
            let tile = &mut film.tiles_mut()[0];
            // As after a pass that was cut short.
            (0..100).for_each(|index| tile.add(index, Rgb::ONE));
            let ids = all(tile, 3, sizes);
            assert!(tile.pixels().iter().all(|pixel| pixel.count() == 3));
            assert!(ids.is_sorted_by_key(|id| id.sample));
            let clusters: Vec<Vec<_>> = (tile.clusters(sizes.1))
                .map(|cluster| cluster.pixels().collect())
                .collect();
            for paths in ids.chunks(sizes.1 as usize) {
                let pixels: Vec<_> = paths.iter().map(|id| id.pixel).collect();
                assert!(clusters.contains(&pixels));
                assert!(paths.iter().all(|id| id.sample == paths[0].sample));
            }
            let mut keys: Vec<_> = ids.iter().map(|id| (id.sample, id.pixel)).collect();
            keys.sort_unstable();
            keys.dedup();
            assert_eq!(keys.len(), ids.len());
        }
    }

    #[test]
    fn clusters_whose_pixels_are_all_closed_or_full_get_nothing() {
        for (cluster_size, paths) in [(1, 5 + 2), (8, 8 * 5)] {
            let mut film = film();
            let tile = &mut film.tiles_mut()[0];
            let area = tile.area();
            let cluster = (tile.clusters(8))
                .find(|cluster| cluster.pixels().all(|[x, y]| area.contains(x, y)))
                .expect("one that does not reach over the edge");
            let cluster: Vec<_> = cluster.pixels().map(|[x, y]| tile.index(x, y)).collect();
            tile.pixels_mut().iter_mut().for_each(PixelStats::close);
            tile.pixels_mut()[cluster[2]].set_limit(7);
            tile.pixels_mut()[cluster[5]].set_limit(2);
            assert_eq!(all(tile, 5, (64, cluster_size)).len(), paths);
            let counts = [2, 5, 0].map(|place| tile.pixels()[cluster[place]].count());
            assert_eq!(counts, [5, 2, 0]);
            assert!(all(tile, 5, (64, cluster_size)).is_empty());
        }
    }
}
