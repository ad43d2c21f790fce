use super::range::{Depth, Plan, Range, Rule};
use crate::bvh::node::{Part, WIDTH};

/// The children of one wide node, and the binary tree between them.
#[derive(Debug)]
pub(super) struct Family<'a> {
    /// Left to right once [`Family::of`] is done.
    pub(super) members: Vec<Member<'a>>,
    /// As [`crate::bvh::node::WideNode::new`] wants it.
    pub(super) inner: Vec<[Part; 2]>,
}

/// A range that becomes one child.
#[derive(Debug)]
pub(super) struct Member<'a> {
    pub(super) range: Range<'a>,
    pub(super) is_leaf: bool,
    /// Nodes above in the binary tree.
    pub(super) depth: usize,
    /// Its place in `inner`.
    place: (usize, usize),
}

impl<'a> Family<'a> {
    /// Splits `range` until there are eight children or only leaves: the one with the largest box
    /// first, because rays meet it most often (but see [`eagerness`]). A single member is a leaf.
    pub(super) fn of(range: Range<'a>, rule: &Rule<'_>, depth: Depth) -> Self {
        let mut members = Vec::with_capacity(WIDTH);
        members.push(Member {
            is_leaf: rule.is_leaf(range.len()),
            range,
            depth: depth.binary,
            place: (0, 0),
        });
        let mut inner: Vec<[Part; 2]> = Vec::with_capacity(WIDTH - 1);
        while members.len() < WIDTH {
            let mut largest = (f32::NEG_INFINITY, WIDTH);
            for (i, member) in members.iter().enumerate() {
                // An area that overflows is still larger than others.
                let area = member.range.extents.bounds.half_area().max(f32::MIN);
                let urgency = area * eagerness(rule.blocks(member.range.len()));
                if !member.is_leaf && urgency > largest.0 {
                    largest = (urgency, i);
                }
            }
            let Some(member) = members.get_mut(largest.1) else {
                break;
            };
            let at = Depth {
                binary: member.depth,
                ..depth
            };
            let right = match rule.plan(&member.range, at) {
                Plan::Leaf => {
                    member.is_leaf = true;
                    continue;
                }
                Plan::Halves => member.range.halve(),
                Plan::Sides(split) => member.range.part(&split),
            };
            let index = inner.len();
            if let Some(above) = inner.get_mut(member.place.0) {
                above[member.place.1] = (WIDTH + index) as Part;
            }
            member.is_leaf = rule.is_leaf(member.range.len());
            member.depth += 1;
            member.place = (index, 0);
            let member = Member {
                is_leaf: rule.is_leaf(right.len()),
                range: right,
                depth: member.depth,
                place: (index, 1),
            };
            inner.push([largest.1 as Part, members.len() as Part]);
            members.push(member);
        }
        Self { members, inner }
    }

    /// The members' places in `members`, left to right, and `inner` with the members numbered so.
    pub(super) fn left_to_right(&self) -> (Vec<usize>, Vec<[Part; 2]>) {
        let mut order = Vec::with_capacity(WIDTH);
        let mut inner = self.inner.clone();
        if inner.is_empty() {
            return (vec![0], inner);
        }
        let mut open: Vec<(usize, usize)> = Vec::with_capacity(WIDTH);
        open.extend([(0, 1), (0, 0)]);
        while let Some((index, side)) = open.pop() {
            let part = self.inner[index][side] as usize;
            if part < WIDTH {
                inner[index][side] = order.len() as Part;
                order.push(part);
            } else {
                open.extend([(part - WIDTH, 1), (part - WIDTH, 0)]);
            }
        }
        (order, inner)
    }
}

/// Factor on the area of a range of so many blocks that shall be split. Few primitives left alone
/// would make a node with few children, of which there would be many.
///
/// Of ten rules, this and its like gave the fewest nodes met by rays (1 to 10 % fewer than area
/// alone) and 5 to 17 % less memory.
fn eagerness(blocks: usize) -> f32 {
    match blocks {
        0..=2 => 4.0,
        3..=4 => 2.0,
        _ => 1.0,
    }
}
