/// Takes the lowest bit out of a set that is not empty; returns its number.
#[inline(always)]
pub fn take_lowest(set: &mut u64) -> usize {
    let lowest = set.trailing_zeros();
    *set &= *set - 1;
    lowest as usize
}

/// The numbers of the bits of a set, from the lowest up.
#[inline(always)]
pub fn set_bits(set: u32) -> impl Iterator<Item = usize> {
    let mut left = u64::from(set);
    std::iter::from_fn(move || (left != 0).then(|| take_lowest(&mut left)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_comes_once_in_order() {
        for set in [0, 1, 0b1011, 1 << 31, 0x8000_0101, u32::MAX] {
            let expected: Vec<usize> = (0..32).filter(|i| set >> i & 1 == 1).collect();
            assert_eq!(set_bits(set).collect::<Vec<_>>(), expected);
        }
    }
}
