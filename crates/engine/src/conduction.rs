//! A wall as finite volumes, eliminated onto its two faces.
//!
//! Cells hold enthalpy per volume; links between neighbours carry heat in flux form. One implicit stage is the
//! tridiagonal system of the cells with the two face temperatures as right-hand sides; one forward sweep gives the heat
//! that the wall sends into each face as an affine function of both face temperatures.

use crate::coefficients::{Matter, Wall};
use crate::pcm::{PcmMemory, PcmPoint};
use crate::real::Real;

/// Heat flux along a link, `left x_left - right x_right + offset` [W/m2], positive towards the inside; x is the
/// temperature above the place about which the end is linearised, see [`Storage`].
#[derive(Debug, Clone, Copy)]
pub struct Link<S> {
    /// Gain of the temperature on the outer side [W/(m2 K)].
    pub left: S,

    /// Gain of the temperature on the inner side [W/(m2 K)].
    pub right: S,

    /// Part that depends on neither [W/m2].
    pub offset: S,
}

impl<S: Real> Link<S> {
    /// Flux between two temperatures above their places.
    #[inline(always)]
    pub fn flux(&self, left: S, right: S) -> S {
        self.left * left - self.right * right + self.offset
    }
}

/// Enthalpy of a cell near the current iterate, `offset + capacity (T - place)` [J/m3].
///
/// A phase-change cell is linearised about its iterate, and what the elimination finds is its way from there: with a
/// sharp law the capacity is so large that the enthalpy could not be told from a rounded temperature.
#[derive(Debug, Clone, Copy)]
pub struct Storage<S> {
    /// Temperature that the tangent touches at; 0 where the capacity is constant [degC].
    pub place: S,

    /// Enthalpy there [J/m3].
    pub offset: S,

    /// Slope [J/(m3 K)].
    pub capacity: S,

    /// Way from the place to the solution [K].
    moved: S,
}

impl<S: Real> Storage<S> {
    /// Constant properties.
    #[inline(always)]
    fn constant(capacity: S) -> Self {
        Self { place: S::zero(), offset: S::zero(), capacity, moved: S::zero() }
    }

    /// Enthalpy at the solution.
    #[inline(always)]
    pub fn reached(&self) -> S {
        self.offset + self.capacity * self.moved
    }
}

/// The linearised wall of one Newton iteration and its elimination.
#[derive(Debug, Clone)]
pub struct Chain<S> {
    /// Cells + 1 links; the first touches the outside face, the last the inside face.
    pub links: Vec<Link<S>>,
    /// Storage law of each cell.
    pub storage: Vec<Storage<S>>,
    /// Thickness over stage length [m/s].
    pub(crate) rate: Vec<S>,
    pub(crate) inverse: Vec<S>,
    /// `T_i` = known + `to_outside` `T_outside` + next T_(i+1).
    known: Vec<S>,
    pub(crate) to_outside: Vec<S>,
    pub(crate) next: Vec<S>,
    /// `T_1` = sum of `path_i known_i` + ...: product of `next` up to the cell.
    pub(crate) path: Vec<S>,
    /// Response of the first cell to the two faces.
    first: [S; 2],
    /// Properties of the phase-change cells at the iterate.
    points: Vec<PcmPoint<S>>,
    ways: Vec<Way>,
    /// One over the distance between the ends of each link within a phase-change layer [1/m].
    inverse_lengths: Vec<S>,
}

/// Heat that the wall sends into its faces, `source_e + sum_o response_eo T_o` [W/m2].
#[derive(Debug, Clone, Copy)]
pub struct Condensed<S> {
    /// Heat into the outside and the inside face at faces of 0 degC [W/m2].
    pub source: [S; 2],

    /// Heat into face e per degree of face o [W/(m2 K)].
    pub response: [[S; 2]; 2],
}

/// How storage is linearised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StorageRule {
    /// Enthalpy and its slope at the iterate: conserves heat.
    Enthalpy,
    /// The apparent capacity at the old temperature, as in the paper: does not.
    ApparentCapacity,
}

/// Temperatures about which a wall is linearised [degC].
#[derive(Debug, Clone, Copy)]
pub struct Iterate<'a, S> {
    /// Its cells, outside to inside.
    pub cells: &'a [S],

    /// Its outside and inside face.
    pub faces: [S; 2],

    /// Cells about which the concave part of the enthalpy is linearised; none: the iterate itself.
    pub outer: Option<&'a [S]>,
}

/// A wall at the start of the step: temperatures [degC], enthalpies [J/m3], memory.
#[derive(Debug, Clone, Copy)]
pub struct Start<'a, S> {
    /// Temperatures [degC].
    pub cells: &'a [S],

    /// Enthalpies [J/m3].
    pub enthalpy: &'a [S],

    /// What the cells remember.
    pub memory: &'a [PcmMemory<S>],
}

/// Resistance of half a cell [m2 K/W], `-d(resistance)/dT`, and the place it is linearised about [degC].
struct End<S> {
    resistance: S,
    gain: S,
    place: S,
}

/// What a link runs through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    /// Constant properties.
    Solid,
    /// One phase-change layer, from cell to cell or from a cell to a bare face: index of the law.
    Pcm(usize),
    /// Half cells of two layers, or a massless layer, with phase change at one end or both.
    Mixed,
}

impl Way {
    fn of<S: Real>(wall: &Wall<S>, i: usize) -> Self {
        let law = |cell: usize| match wall.cells[cell].matter {
            Matter::Pcm(law) => Some(law),
            Matter::Solid { .. } => None,
        };
        let Some(last) = wall.cells.len().checked_sub(1) else { return Self::Solid };
        // The face belongs to the layer behind it.
        match (law(i.saturating_sub(1)), law(i.min(last))) {
            (None, None) => Self::Solid,
            (Some(left), Some(right))
                if left == right && !wall.massless[i] && wall.pcm[left].integrable() =>
            {
                Self::Pcm(left)
            }
            _ => Self::Mixed,
        }
    }
}

impl<S: Real> End<S> {
    #[inline(always)]
    fn face() -> Self {
        Self { resistance: S::zero(), gain: S::zero(), place: S::zero() }
    }
}

impl<S: Real> Chain<S> {
    /// A chain for a wall, linearised once where its properties are constant.
    pub fn new(wall: &Wall<S>) -> Self {
        let n = wall.cells.len();
        let zeros = vec![S::zero(); n];
        let none = Link { left: S::zero(), right: S::zero(), offset: S::zero() };
        let mut chain = Self {
            links: vec![none; n + 1],
            storage: vec![Storage::constant(S::zero()); n],
            rate: zeros.clone(),
            inverse: zeros.clone(),
            known: zeros.clone(),
            to_outside: zeros.clone(),
            next: zeros.clone(),
            path: zeros,
            first: [S::zero(); 2],
            points: vec![PcmPoint::zero(); n],
            ways: (0..=n).map(|i| Way::of(wall, i)).collect(),
            inverse_lengths: vec![S::zero(); n + 1],
        };
        chain.link_solids(wall);
        chain.measure_links(wall);
        chain
    }

    /// Links and storage that do not depend on temperature.
    fn link_solids(&mut self, wall: &Wall<S>) {
        for (storage, cell) in self.storage.iter_mut().zip(&wall.cells) {
            if let Matter::Solid { capacity, .. } = cell.matter {
                *storage = Storage::constant(capacity);
            }
        }
        let half = |i: usize| match wall.cells[i].matter {
            Matter::Solid { conductivity, .. } => Some(wall.cells[i].thickness.scale(0.5) / conductivity),
            Matter::Pcm(_) => None,
        };
        let n = wall.cells.len();
        for i in 0..=n {
            let left = if i > 0 { half(i - 1) } else { Some(S::zero()) };
            let right = if i < n { half(i) } else { Some(S::zero()) };
            if let (Some(left), Some(right)) = (left, right) {
                let conductance = S::one() / (left + wall.extra[i] + right);
                self.links[i] = Link { left: conductance, right: conductance, offset: S::zero() };
            }
        }
    }

    fn measure_links(&mut self, wall: &Wall<S>) {
        let n = wall.cells.len();
        for i in (0..=n).filter(|&i| matches!(self.ways[i], Way::Pcm(_))) {
            let share = if i == 0 || i == n { 0.5 } else { 1.0 };
            self.inverse_lengths[i] = S::one() / wall.cells[i.min(n - 1)].thickness.scale(share);
        }
    }

    /// Linearises the phase-change cells about an iterate of the cells and the two faces.
    #[inline(always)]
    pub fn linearise(
        &mut self,
        wall: &Wall<S>,
        at: &Iterate<'_, S>,
        start: &Start<'_, S>,
        rule: StorageRule,
    ) {
        for (i, cell) in wall.cells.iter().enumerate() {
            let Matter::Pcm(law) = cell.matter else { continue };
            let (temperature, memory) = (at.cells[i], &start.memory[i]);
            let point = wall.pcm[law].at(temperature, memory);
            let (offset, capacity) = match (rule, at.outer) {
                (StorageRule::Enthalpy, None) => (point.enthalpy, point.capacity),
                (StorageRule::Enthalpy, Some(outer)) => {
                    split_tangent(&wall.pcm[law], temperature, outer[i], memory)
                }
                (StorageRule::ApparentCapacity, _) => {
                    let capacity = wall.pcm[law].at(start.cells[i], memory).capacity;
                    (start.enthalpy[i] + capacity * (temperature - start.cells[i]), capacity)
                }
            };
            self.storage[i] = Storage { place: temperature, offset, capacity, moved: S::zero() };
            self.points[i] = point;
        }
        for i in 0..self.links.len() {
            match self.ways[i] {
                Way::Solid => {}
                Way::Pcm(law) => self.links[i] = self.link_in_pcm(wall, i, law, at, start),
                Way::Mixed => self.links[i] = self.link_of_halves(wall, i, at),
            }
        }
    }

    /// Newton form of the flux between two points of one phase-change layer, or of its cell and a bare face.
    ///
    /// The flux is the difference of the integrals of the conductivity (Kirchhoff's transformation) over the
    /// distance: exact in a steady state, however much the conductivity changes in between, and its derivatives
    /// keep the sign of the conductivity, so that Newton's matrix stays an M-matrix.
    #[inline(always)]
    fn link_in_pcm(
        &self,
        wall: &Wall<S>,
        i: usize,
        law: usize,
        at: &Iterate<'_, S>,
        start: &Start<'_, S>,
    ) -> Link<S> {
        let last = wall.cells.len() - 1;
        // Cells are reckoned from their iterate, faces from zero.
        let (left_above, left) = if i == 0 {
            (at.faces[0], wall.pcm[law].at(at.faces[0], &start.memory[0]))
        } else {
            (S::zero(), self.points[i - 1])
        };
        let (right_above, right) = if i > last {
            (at.faces[1], wall.pcm[law].at(at.faces[1], &start.memory[last]))
        } else {
            (S::zero(), self.points[i])
        };
        let inverse = self.inverse_lengths[i];
        let (by_left, by_right) = (left.conductivity * inverse, right.conductivity * inverse);
        Link {
            left: by_left,
            right: by_right,
            offset: (left.potential - right.potential) * inverse - by_left * left_above
                + by_right * right_above,
        }
    }

    /// Newton form of `K (T_left - T_right)` with K from the half cells at their own temperatures. Its derivatives are
    /// kept from turning their sign where the conductivity changes steeply: the flux stays what it is.
    #[inline(always)]
    fn link_of_halves(&self, wall: &Wall<S>, i: usize, at: &Iterate<'_, S>) -> Link<S> {
        const LEAST: f64 = 0.9;
        let n = wall.cells.len();
        let (left, left_temperature) =
            if i > 0 { (self.end(wall, i - 1), at.cells[i - 1]) } else { (End::face(), at.faces[0]) };
        let (right, right_temperature) =
            if i < n { (self.end(wall, i), at.cells[i]) } else { (End::face(), at.faces[1]) };
        let conductance = S::one() / (left.resistance + wall.extra[i] + right.resistance);
        let difference = left_temperature - right_temperature;
        let square = conductance * conductance * difference;
        let most = conductance.scale(LEAST);
        let by_left = conductance + (square * left.gain).max(-most);
        let by_right = conductance - (square * right.gain).min(most);
        let (left_above, right_above) = (left_temperature - left.place, right_temperature - right.place);
        Link {
            left: by_left,
            right: by_right,
            offset: conductance * difference - by_left * left_above + by_right * right_above,
        }
    }

    /// The half of a cell that a link crosses.
    #[inline(always)]
    fn end(&self, wall: &Wall<S>, cell: usize) -> End<S> {
        let half = wall.cells[cell].thickness.scale(0.5);
        match &wall.cells[cell].matter {
            Matter::Solid { conductivity, .. } => {
                End { resistance: half / *conductivity, gain: S::zero(), place: S::zero() }
            }
            Matter::Pcm(_) => {
                let point = &self.points[cell];
                let resistance = half / point.conductivity;
                let gain = resistance / point.conductivity * point.conductivity_slope;
                End { resistance, gain, place: self.storage[cell].place }
            }
        }
    }

    /// Eliminates the cells for a stage of effective length `stage` [s]. Called again only when a coefficient changes.
    #[inline(always)]
    pub fn factor(&mut self, wall: &Wall<S>, stage: f64) -> [[S; 2]; 2] {
        let n = self.storage.len();
        if n == 0 {
            let link = self.links[0];
            return [[-link.left, link.right], [link.left, -link.right]];
        }
        let mut path = S::one();
        let (mut first_outside, mut to_outside) = (S::zero(), S::zero());
        for i in 0..n {
            self.rate[i] = wall.cells[i].thickness.scale(1.0 / stage);
            let (before, after) = (self.links[i], self.links[i + 1]);
            let mut diagonal = self.storage[i].capacity * self.rate[i] + before.right + after.left;
            let mut outside = before.left;
            if i > 0 {
                diagonal = diagonal - before.left * self.next[i - 1];
                outside = before.left * to_outside;
            }
            self.inverse[i] = S::one() / diagonal;
            self.next[i] = after.right * self.inverse[i];
            to_outside = outside * self.inverse[i];
            self.to_outside[i] = to_outside;
            self.path[i] = path;
            first_outside += path * to_outside;
            path = path * self.next[i];
        }
        self.first = [first_outside, path];
        let (outer, inner) = (self.links[0], self.links[n]);
        [
            [outer.right * first_outside - outer.left, outer.right * path],
            [inner.left * to_outside, inner.left * self.next[n - 1] - inner.right],
        ]
    }

    /// The part of the face fluxes that comes from what the cells held: `held` is the right-hand enthalpy [J/m3].
    #[inline(always)]
    pub fn sources(&mut self, held: &[S]) -> [S; 2] {
        self.sweep(held, |right, _| right)
    }

    /// The same with heat released in the cells [W/m2].
    #[inline(always)]
    pub fn sources_with(&mut self, held: &[S], gains: &[S]) -> [S; 2] {
        self.sweep(held, |right, i| right + gains[i])
    }

    #[inline(always)]
    fn sweep(&mut self, held: &[S], add: impl Fn(S, usize) -> S) -> [S; 2] {
        let n = self.storage.len();
        if n == 0 {
            return [-self.links[0].offset, self.links[0].offset];
        }
        let mut first = S::zero();
        for (i, &held) in held.iter().enumerate() {
            let mut right = add((held - self.storage[i].offset) * self.rate[i], i);
            right = right + self.links[i].offset - self.links[i + 1].offset;
            if i > 0 {
                right += self.links[i].left * self.known[i - 1];
            }
            self.known[i] = right * self.inverse[i];
            first += self.path[i] * self.known[i];
        }
        let (outer, inner) = (self.links[0], self.links[n]);
        [outer.right * first - outer.offset, inner.left * self.known[n - 1] + inner.offset]
    }

    /// Cell temperatures from the face temperatures.
    #[inline(always)]
    pub fn temperatures(&mut self, faces: [S; 2], cells: &mut [S]) {
        let mut next = faces[1];
        for i in (0..cells.len()).rev() {
            next = self.known[i] + self.to_outside[i] * faces[0] + self.next[i] * next;
            self.storage[i].moved = next;
            cells[i] = self.storage[i].place + next;
        }
    }

    #[inline(always)]
    fn back_substitute(&self, known: &[S], faces: [S; 2], cells: &mut [S]) {
        let mut next = faces[1];
        for i in (0..cells.len()).rev() {
            next = known[i] + self.to_outside[i] * faces[0] + self.next[i] * next;
            cells[i] = next;
        }
    }

    /// How [`Self::sources`] change with what the cells held; `known` takes what [`Self::temperature_changes`] needs.
    #[inline(always)]
    pub fn source_changes(&self, held: &[S], known: &mut [S]) -> [S; 2] {
        let n = self.storage.len();
        if n == 0 {
            return [S::zero(); 2];
        }
        let mut first = S::zero();
        for (i, &held) in held.iter().enumerate() {
            let mut right = held * self.rate[i];
            if i > 0 {
                right += self.links[i].left * known[i - 1];
            }
            known[i] = right * self.inverse[i];
            first += self.path[i] * known[i];
        }
        [self.links[0].right * first, self.links[n].left * known[n - 1]]
    }

    /// How cell temperatures change with those of the faces and with what the cells held.
    #[inline(always)]
    pub fn temperature_changes(&self, known: &[S], faces: [S; 2], cells: &mut [S]) {
        self.back_substitute(known, faces, cells);
    }

    /// Flux along link `i` at the solution with these face temperatures [W/m2], positive towards the inside.
    #[inline(always)]
    pub fn link_flux(&self, i: usize, faces: [S; 2]) -> S {
        let left = if i == 0 { faces[0] } else { self.storage[i - 1].moved };
        let right = if i == self.storage.len() { faces[1] } else { self.storage[i].moved };
        self.links[i].flux(left, right)
    }

    /// Liquid fraction of a phase-change cell at the solution, along the last tangent.
    #[inline(always)]
    pub fn reached_fraction(&self, i: usize) -> S {
        let reached = self.points[i].liquid_fraction + self.points[i].fraction_slope * self.storage[i].moved;
        reached.max(S::zero()).min(S::one())
    }

    /// Liquid fraction of a phase-change cell at the last linearisation.
    #[inline(always)]
    pub fn liquid_fraction(&self, i: usize) -> S {
        self.points[i].liquid_fraction
    }
}

/// Enthalpy and slope at a temperature, the concave part of the enthalpy taken along its tangent at another one.
fn split_tangent<S: Real>(
    law: &crate::pcm::PcmCoefficients<S>,
    temperature: S,
    outer: S,
    memory: &PcmMemory<S>,
) -> (S, S) {
    let (convex, convex_slope) = law.rising(temperature, memory);
    let (all, (outer_convex, outer_slope)) = (law.at(outer, memory), law.rising(outer, memory));
    let concave_slope = outer_slope - all.capacity;
    let concave = outer_convex - all.enthalpy + concave_slope * (temperature - outer);
    (convex - concave, convex_slope - concave_slope)
}
