use std::collections::HashMap;

use glam::DVec3;
use roxmltree::{Node, NodeId};

use super::faults::{Fault, Faults};
use super::inputs::{Inputs, Stream};
use crate::geometry::{Corner, Mesh, MeshTriangle};
use crate::io::collada::numbers::BAD_INDEX;
use crate::io::collada::polygon::{Quality, Triangulator};
use crate::io::collada::source::read_source;
use crate::io::collada::transform::LARGEST;
use crate::io::collada::xml::Xml;
use crate::io::report::{Notes, Severity};

/// A mesh in the making.
pub(super) struct MeshBuilder<'b, 'a, 'input> {
    pub(super) xml: &'b Xml<'a, 'input>,
    notes: &'b mut Notes,
    triangulator: &'b mut Triangulator,
    mesh: Mesh,
    /// False for positions that are not finite.
    is_usable: Vec<bool>,
    /// False for normals without a direction.
    has_direction: Vec<bool>,
    /// Where each source starts in the mesh's lists, with its length.
    positions_of: HashMap<NodeId, (u32, u32)>,
    normals_of: HashMap<NodeId, (u32, u32)>,
    symbols: Vec<Option<String>>,
    slot_of: HashMap<Option<String>, u16>,
    slot: u16,
    faults: Faults,
    corners: Vec<Corner>,
    points: Vec<DVec3>,
    cut: Vec<[usize; 3]>,
}

impl<'b, 'a, 'input> MeshBuilder<'b, 'a, 'input> {
    pub(super) fn new(
        xml: &'b Xml<'a, 'input>,
        notes: &'b mut Notes,
        triangulator: &'b mut Triangulator,
    ) -> Self {
        Self {
            xml,
            notes,
            triangulator,
            mesh: Mesh::default(),
            is_usable: Vec::new(),
            has_direction: Vec::new(),
            positions_of: HashMap::new(),
            normals_of: HashMap::new(),
            symbols: Vec::new(),
            slot_of: HashMap::new(),
            slot: 0,
            faults: Faults::default(),
            corners: Vec::new(),
            points: Vec::new(),
            cut: Vec::new(),
        }
    }

    pub(super) fn note(
        &mut self,
        severity: Severity,
        node: Node<'_, '_>,
        message: impl Into<String>,
    ) {
        self.xml.note(self.notes, severity, node, message);
    }

    /// The source that an `<input>` names, as positions; read once.
    pub(super) fn position_stream(&mut self, input: Node<'_, '_>, offset: usize) -> Option<Stream> {
        let source = self.xml.follow(self.notes, input, "source", "source")?;
        if !self.positions_of.contains_key(&source.id()) {
            let read = read_source(self.xml, self.notes, source)?;
            let base = self.mesh.positions.len() as u32;
            let count = read.vectors.len() as u32;
            let usable = |p: &DVec3| p.abs().max_element() <= LARGEST && p.is_finite();
            self.is_usable.extend(read.vectors.iter().map(usable));
            self.mesh.positions.extend(read.vectors);
            self.positions_of.insert(source.id(), (base, count));
        }
        let (base, count) = *self.positions_of.get(&source.id())?;
        Some(Stream {
            offset,
            base,
            count,
        })
    }

    /// The source that an `<input>` names, as normals; read once.
    pub(super) fn normal_stream(&mut self, input: Node<'_, '_>, offset: usize) -> Option<Stream> {
        let source = self.xml.follow(self.notes, input, "source", "source")?;
        if !self.normals_of.contains_key(&source.id()) {
            let read = read_source(self.xml, self.notes, source)?;
            let base = self.mesh.normals.len() as u32;
            let count = read.vectors.len() as u32;
            for normal in read.vectors {
                let unit = normal.try_normalize().filter(|unit| unit.is_finite());
                self.has_direction.push(unit.is_some());
                self.mesh.normals.push(unit.unwrap_or(DVec3::Y).as_vec3());
            }
            self.normals_of.insert(source.id(), (base, count));
        }
        let (base, count) = *self.normals_of.get(&source.id())?;
        Some(Stream {
            offset,
            base,
            count,
        })
    }

    /// Faces from here on have the material of that symbol; false when there are too many symbols.
    pub(super) fn use_material(&mut self, symbol: Option<&str>) -> bool {
        let symbol = symbol.map(str::to_owned);
        if let Some(&slot) = self.slot_of.get(&symbol) {
            self.slot = slot;
            return true;
        }
        let Ok(slot) = u16::try_from(self.symbols.len()) else {
            return false;
        };
        self.slot = slot;
        self.slot_of.insert(symbol.clone(), slot);
        self.symbols.push(symbol);
        true
    }

    pub(super) fn fault(&mut self, fault: Fault, count: usize) {
        self.faults.add(fault, count);
    }

    /// Notes the faults of the faces since the last call.
    pub(super) fn end_primitive(&mut self, primitive: Node<'_, '_>) {
        std::mem::take(&mut self.faults).report(self.xml, self.notes, primitive);
    }

    /// A triangle from three corners' indices, `stride` indices each.
    pub(super) fn add_triangle(&mut self, inputs: &Inputs, corners: [&[u32]; 3]) {
        let mut found = [Corner {
            position: 0,
            normal: Corner::NO_NORMAL,
        }; 3];
        for (corner, indices) in found.iter_mut().zip(corners) {
            match self.corner(inputs, indices) {
                Ok(good) => *corner = good,
                Err(fault) => return self.faults.add(fault, 1),
            }
        }
        let [a, b, c] = found.map(|corner| corner.position);
        if a == b || b == c || c == a {
            return self.faults.add(Fault::NoArea, 1);
        }
        self.push(found);
    }

    /// A polygon: the outline's indices, then those of its holes.
    pub(super) fn add_polygon(&mut self, inputs: &Inputs, rings: &[&[u32]]) {
        if let [outline] = rings
            && outline.len() == 3 * inputs.stride
        {
            let (a, rest) = outline.split_at(inputs.stride);
            let (b, c) = rest.split_at(inputs.stride);
            return self.add_triangle(inputs, [a, b, c]);
        }
        self.corners.clear();
        let mut lengths = Vec::with_capacity(rings.len());
        for ring in rings {
            let start = self.corners.len();
            for indices in ring.chunks_exact(inputs.stride) {
                match self.corner(inputs, indices) {
                    Ok(corner) => self.corners.push(corner),
                    Err(fault) => return self.faults.add(fault, 1),
                }
            }
            self.drop_repeats_from(start);
            lengths.push(self.corners.len() - start);
        }
        let has_outline = lengths.first().is_some_and(|corners| *corners >= 3);
        if !has_outline {
            return self.faults.add(Fault::NoArea, 1);
        }
        self.points.clear();
        let positions = &self.mesh.positions;
        let position = |corner: &Corner| positions[corner.position as usize];
        self.points.extend(self.corners.iter().map(position));
        let quality = self
            .triangulator
            .triangulate(&self.points, &lengths, &mut self.cut);
        match quality {
            Quality::Clean => {}
            Quality::NoArea => self.faults.add(Fault::NoArea, 1),
            Quality::SelfCrossing => self.faults.add(Fault::SelfCrossing, 1),
            Quality::TooComplex => self.faults.add(Fault::TooComplex, 1),
        }
        for i in 0..self.cut.len() {
            self.push(self.cut[i].map(|corner| self.corners[corner]));
        }
    }

    /// The mesh and its material symbols. Positions that are not finite, which no face uses, are
    /// replaced by one that is, so that nobody trips over them.
    pub(super) fn finish(mut self) -> (Mesh, Vec<Option<String>>) {
        let good = self.is_usable.iter().position(|usable| *usable);
        let stand_in = good.map_or(DVec3::ZERO, |at| self.mesh.positions[at]);
        for (position, is_usable) in self.mesh.positions.iter_mut().zip(&self.is_usable) {
            if !is_usable {
                *position = stand_in;
            }
        }
        (self.mesh, self.symbols)
    }

    fn push(&mut self, corners: [Corner; 3]) {
        self.mesh.triangles.push(MeshTriangle {
            corners,
            material_slot: self.slot,
        });
    }

    fn corner(&mut self, inputs: &Inputs, indices: &[u32]) -> Result<Corner, Fault> {
        let stream = &inputs.position;
        let index = indices[stream.offset];
        if index == BAD_INDEX || index >= stream.count {
            return Err(Fault::BadIndex);
        }
        let position = stream.base + index;
        if !self.is_usable[position as usize] {
            return Err(Fault::BadNumber);
        }
        let mut normal = Corner::NO_NORMAL;
        if let Some(stream) = &inputs.normal {
            let index = indices[stream.offset];
            let is_good =
                index < stream.count && self.has_direction[(stream.base + index) as usize];
            if is_good {
                normal = stream.base + index;
            } else {
                self.faults.add(Fault::BadNormal, 1);
            }
        }
        Ok(Corner { position, normal })
    }

    /// Drops corners at the same vertex as the one before, around the ring that starts at `start`.
    fn drop_repeats_from(&mut self, start: usize) {
        let mut kept = start;
        for i in start..self.corners.len() {
            if kept == start || self.corners[kept - 1].position != self.corners[i].position {
                self.corners[kept] = self.corners[i];
                kept += 1;
            }
        }
        while kept > start + 1 && self.corners[kept - 1].position == self.corners[start].position {
            kept -= 1;
        }
        self.corners.truncate(kept);
    }
}
