use super::node::WIDTH;

/// For a ray's octant and a set of slots (a bit each): the slots of the set, a byte each, far to
/// near, from the lowest byte; zeros above.
///
/// The octant has a bit for each axis on which the direction is negative. Near means that slot XOR
/// octant is small; see [`super::node::WideNode`].
pub(super) static FAR_TO_NEAR: [[u64; 1 << WIDTH]; 8] = {
    let mut table = [[0; 1 << WIDTH]; 8];
    let mut octant = 0;
    while octant < 8 {
        let mut set = 0;
        while set < 1 << WIDTH {
            let (mut rank, mut byte) = (WIDTH, 0);
            while rank > 0 {
                rank -= 1;
                let slot = rank ^ octant;
                if set >> slot & 1 == 1 {
                    table[octant][set] |= (slot as u64) << byte;
                    byte += 8;
                }
            }
            set += 1;
        }
        octant += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_comes_once_each_and_far_to_near() {
        assert_eq!(FAR_TO_NEAR[0][0b1000_0101], 0x00_02_07);
        assert_eq!(FAR_TO_NEAR[7][0b1000_0101], 0x07_02_00);
        for (octant, sets) in FAR_TO_NEAR.iter().enumerate() {
            for (set, &order) in sets.iter().enumerate() {
                let count = set.count_ones() as usize;
                let slots: Vec<_> = order.to_le_bytes()[..count].to_vec();
                assert_eq!(slots.iter().map(|s| 1 << s).sum::<usize>(), set);
                assert!(slots.is_sorted_by_key(|s| 7 - (*s as usize ^ octant)));
            }
        }
    }
}
