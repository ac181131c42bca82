//! A wall as finite volumes, eliminated onto its two surfaces.
//!
//! Cells hold enthalpy per volume; links between neighbours carry heat in flux form. One implicit stage is the
//! tridiagonal system of the cells with the two surface temperatures as right-hand sides; one forward sweep gives the heat
//! that the wall sends into each surface as an affine function of both surface temperatures.

use core::ops::Range;

use crate::building::coefficients::{Matter, WallCoefficients};
use crate::number::real::Real;
use crate::physics::pcm::{PcmMemory, PcmPoint};

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
    /// Cells + 1 links; the first touches the outside surface, the last the inside surface.
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
    /// Properties of the phase-change cells at the iterate.
    points: Vec<PcmPoint<S>>,
    melting: Vec<Melting>,
    /// Links from cell to cell of one law, and those of such a cell with a bare surface.
    within: Vec<Within<S>>,
    bare: Vec<Within<S>>,
    mixed: Vec<Mixed<S>>,
}

/// Heat that the wall sends into its surfaces, `source_e + sum_o response_eo T_o` [W/m2].
#[derive(Debug, Clone, Copy)]
pub struct Condensed<S> {
    /// Heat into the outside and the inside surface at surfaces of 0 degC [W/m2].
    pub source: [S; 2],

    /// Heat into surface e per degree of surface o [W/(m2 K)].
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

    /// Its outside and inside surface.
    pub surfaces: [S; 2],

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

/// Neighbouring cells of one law.
#[derive(Debug, Clone)]
struct Melting {
    law: usize,
    cells: Range<usize>,
}

/// A link through one phase-change layer: between two of its cells, or from a cell to a bare surface.
#[derive(Debug, Clone, Copy)]
struct Within<S> {
    link: usize,
    law: usize,
    /// One over the distance between its ends [1/m].
    inverse_length: S,
}

/// A link through half cells of two layers, or a massless layer, with phase change at one end or both.
#[derive(Debug, Clone, Copy)]
struct Mixed<S> {
    link: usize,
    /// What does not change [m2 K/W].
    resistance: S,
    /// Thickness of the half cell at either end where it changes phase [m].
    halves: [Option<S>; 2],
}

/// One end of such a link.
struct End<S> {
    /// Thickness [m], conductivity [W/(m K)] and its slope [W/(m K2)] of what changes phase.
    half: S,
    conductivity: S,
    slope: S,
    /// Temperature [degC], and how far it is above the place about which the end is linearised [K].
    temperature: S,
    above: S,
}

impl<S: Real> Mixed<S> {
    fn new(wall: &WallCoefficients<S>, link: usize) -> Self {
        let mut mixed = Self { link, resistance: wall.extra[link], halves: [None; 2] };
        for (side, half) in mixed.halves.iter_mut().enumerate() {
            let Some(cell) = link.checked_sub(1 - side).and_then(|cell| wall.cells.get(cell)) else {
                continue;
            };
            let thickness = cell.thickness.scale(0.5);
            match cell.matter {
                Matter::Pcm(_) => *half = Some(thickness),
                Matter::Solid { conductivity, .. } => mixed.resistance += thickness / conductivity,
            }
        }
        mixed
    }
}

impl<S: Real> Chain<S> {
    /// A chain for a wall, linearised once where its properties are constant.
    pub fn new(wall: &WallCoefficients<S>) -> Self {
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
            points: vec![PcmPoint::zero(); n],
            melting: Vec::new(),
            within: Vec::new(),
            bare: Vec::new(),
            mixed: Vec::new(),
        };
        chain.link_solids(wall);
        chain.link_changing(wall);
        chain
    }

    /// Links and storage that do not depend on temperature.
    fn link_solids(&mut self, wall: &WallCoefficients<S>) {
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

    /// Sorts cells and links that change.
    fn link_changing(&mut self, wall: &WallCoefficients<S>) {
        let n = wall.cells.len();
        let law = |cell: usize| match wall.cells[cell].matter {
            Matter::Pcm(law) => Some(law),
            Matter::Solid { .. } => None,
        };
        for (cell, of_cell) in (0..n).filter_map(|cell| Some((cell, law(cell)?))) {
            match self.melting.last_mut() {
                Some(run) if run.law == of_cell && run.cells.end == cell => run.cells.end += 1,
                _ => self.melting.push(Melting { law: of_cell, cells: cell..cell + 1 }),
            }
        }
        if n == 0 {
            return;
        }
        for link in 0..=n {
            // The surface belongs to the layer behind it.
            let ends = [law(link.saturating_sub(1)), law(link.min(n - 1))];
            let surface = link == 0 || link == n;
            match ends {
                [None, None] => {}
                [Some(left), Some(right)]
                    if left == right && !wall.massless[link] && wall.pcm[left].integrable() =>
                {
                    let share = if surface { 0.5 } else { 1.0 };
                    let inverse_length = S::one() / wall.cells[link.min(n - 1)].thickness.scale(share);
                    let links = if surface { &mut self.bare } else { &mut self.within };
                    links.push(Within { link, law: left, inverse_length });
                }
                _ => self.mixed.push(Mixed::new(wall, link)),
            }
        }
    }

    /// Linearises the phase-change cells about an iterate of the cells and the two surfaces.
    #[inline(always)]
    pub fn linearise(
        &mut self,
        wall: &WallCoefficients<S>,
        at: &Iterate<'_, S>,
        start: &Start<'_, S>,
        rule: StorageRule,
    ) {
        for Melting { law, cells } in &self.melting {
            let places = &at.cells[cells.clone()];
            let (points, storage) = (&mut self.points[cells.clone()], &mut self.storage[cells.clone()]);
            wall.pcm[*law].at_all(places, &start.memory[cells.clone()], points);
            for ((storage, point), &place) in storage.iter_mut().zip(points).zip(places) {
                let (offset, capacity) = (point.enthalpy, point.capacity);
                *storage = Storage { place, offset, capacity: capacity.fixed(), moved: S::zero() };
            }
        }
        if at.outer.is_some() || rule == StorageRule::ApparentCapacity {
            self.store_otherwise(wall, at, start);
        }
        for within in &self.within {
            let (left, right) = (&self.points[within.link - 1], &self.points[within.link]);
            let inverse = within.inverse_length.fixed();
            self.links[within.link] = Link {
                left: left.conductivity.fixed() * inverse,
                right: right.conductivity.fixed() * inverse,
                offset: (left.potential - right.potential) * within.inverse_length,
            };
        }
        for bare in &self.bare {
            self.links[bare.link] = self.link_to_surface(wall, bare, at, start);
        }
        for mixed in &self.mixed {
            self.links[mixed.link] = self.link_of_halves(mixed, at);
        }
    }

    /// Storage along two tangents, or by the apparent capacity.
    #[cold]
    #[inline(never)]
    fn store_otherwise(&mut self, wall: &WallCoefficients<S>, at: &Iterate<'_, S>, start: &Start<'_, S>) {
        for run in &self.melting {
            let law = &wall.pcm[run.law];
            for i in run.cells.clone() {
                let (temperature, memory) = (at.cells[i], &start.memory[i]);
                let (offset, capacity) = if let Some(outer) = at.outer {
                    split_tangent(law, temperature, outer[i], memory)
                } else {
                    let capacity = law.at(start.cells[i], memory).capacity;
                    (start.enthalpy[i] + capacity * (temperature - start.cells[i]), capacity)
                };
                self.storage[i] =
                    Storage { place: temperature, offset, capacity: capacity.fixed(), moved: S::zero() };
            }
        }
    }

    /// Newton form of the flux between a cell and the bare surface of its layer; that between two of its cells is alike.
    ///
    /// The flux is the difference of the integrals of the conductivity (Kirchhoff's transformation) over the
    /// distance: exact in a steady state, however much the conductivity changes in between, and its derivatives
    /// keep the sign of the conductivity, so that Newton's matrix stays an M-matrix.
    #[inline(always)]
    fn link_to_surface(
        &self,
        wall: &WallCoefficients<S>,
        bare: &Within<S>,
        at: &Iterate<'_, S>,
        start: &Start<'_, S>,
    ) -> Link<S> {
        let outside = bare.link == 0;
        let (cell, surface) = if outside { (0, at.surfaces[0]) } else { (bare.link - 1, at.surfaces[1]) };
        let (bare_point, point) = (wall.pcm[bare.law].at(surface, &start.memory[cell]), &self.points[cell]);
        let inverse = bare.inverse_length;
        let steady = inverse.fixed();
        let (by_surface, by_cell) =
            (bare_point.conductivity.fixed() * steady, point.conductivity.fixed() * steady);
        // Cells are reckoned from their iterate, surfaces from zero.
        let inwards = (bare_point.potential - point.potential) * inverse - by_surface * surface;
        if outside {
            Link { left: by_surface, right: by_cell, offset: inwards }
        } else {
            Link { left: by_cell, right: by_surface, offset: -inwards }
        }
    }

    /// Newton form of `K (T_left - T_right)` with K from the half cells at their own temperatures. Its derivatives are
    /// kept from turning their sign where the conductivity changes steeply: the flux stays what it is.
    #[inline(always)]
    fn link_of_halves(&self, mixed: &Mixed<S>, at: &Iterate<'_, S>) -> Link<S> {
        const LEAST: f64 = 0.9;
        let (left, right) = (self.end(mixed, 0, at), self.end(mixed, 1, at));
        // K = 1/(R + a_left/k_left + a_right/k_right), with one division.
        let both = left.conductivity * right.conductivity;
        let thickness = left.half * right.conductivity + right.half * left.conductivity;
        let inverse = S::one() / (mixed.resistance * both + thickness);
        let conductance = both * inverse;
        let difference = left.temperature - right.temperature;
        let (steady, inverse, apart) = (conductance.fixed(), inverse.fixed(), difference.fixed());
        let (by_left, by_right) = (right.conductivity.fixed() * inverse, left.conductivity.fixed() * inverse);
        let most = steady.scale(LEAST);
        let gain = (apart * left.half.fixed() * left.slope.fixed() * (by_left * by_left)).max(-most);
        let loss = (apart * right.half.fixed() * right.slope.fixed() * (by_right * by_right)).min(most);
        let (by_left, by_right) = (steady + gain, steady - loss);
        Link {
            left: by_left,
            right: by_right,
            offset: conductance * difference - by_left * left.above + by_right * right.above,
        }
    }

    #[inline(always)]
    fn end(&self, mixed: &Mixed<S>, side: usize, at: &Iterate<'_, S>) -> End<S> {
        // Before the first cell and after the last lie the surfaces.
        let cell = (mixed.link + side).checked_sub(1).filter(|&cell| cell < at.cells.len());
        let temperature = cell.map_or(at.surfaces[side], |cell| at.cells[cell]);
        let (Some(half), Some(cell)) = (mixed.halves[side], cell) else {
            let (half, conductivity, slope) = (S::zero(), S::one(), S::zero());
            return End { half, conductivity, slope, temperature, above: temperature };
        };
        let PcmPoint { conductivity, conductivity_slope: slope, .. } = self.points[cell];
        End { half, conductivity, slope, temperature, above: S::zero() }
    }

    /// Eliminates the cells for a stage of effective length `stage` [s]. Called again only when a coefficient changes.
    #[inline(always)]
    pub fn factor(&mut self, wall: &WallCoefficients<S>, stage: f64) -> [[S; 2]; 2] {
        let n = self.storage.len();
        if n == 0 {
            let link = self.links[0];
            return [[-link.left, link.right], [link.left, -link.right]];
        }
        self.pace(wall, stage);
        let mut path = S::one();
        let (mut first_outside, mut to_outside) = (S::zero(), S::zero());
        for i in 0..n {
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
        let (outer, inner) = (self.links[0], self.links[n]);
        [
            [outer.right * first_outside - outer.left, outer.right * path],
            [inner.left * to_outside, inner.left * self.next[n - 1] - inner.right],
        ]
    }

    /// Sets the stage length that cells are eliminated for by [`Self::condense`] [s].
    #[inline(always)]
    pub fn pace(&mut self, wall: &WallCoefficients<S>, stage: f64) {
        for (rate, cell) in self.rate.iter_mut().zip(&wall.cells) {
            *rate = cell.thickness.scale(1.0 / stage);
        }
    }

    /// Eliminates the cells, and with them what they held: `held` is the right-hand enthalpy [J/m3]. The stage length is
    /// that of [`Self::pace`].
    #[inline(always)]
    pub fn condense(&mut self, held: &[S]) -> Condensed<S> {
        self.condense_with(held, |right, _| right)
    }

    /// The same with heat released in the cells [W/m2].
    #[inline(always)]
    pub fn condense_heated(&mut self, held: &[S], gains: &[S]) -> Condensed<S> {
        self.condense_with(held, |right, i| right + gains[i])
    }

    #[inline(always)]
    fn condense_with(&mut self, held: &[S], add: impl Fn(S, usize) -> S) -> Condensed<S> {
        let n = held.len();
        let (links, storage, rate) = (&self.links[..=n], &self.storage[..n], &self.rate[..n]);
        let (inverses, nexts) = (&mut self.inverse[..n], &mut self.next[..n]);
        let (to_outsides, knowns) = (&mut self.to_outside[..n], &mut self.known[..n]);
        let paths = &mut self.path[..n];
        // Of the node before: the outside surface is its own.
        let (mut known, mut to_outside, mut next) = (S::zero(), S::one(), S::zero());
        // Of the first cell: its part that is known, its gains of the outside surface and of the next node.
        let (mut first, mut first_outside, mut path) = (S::zero(), S::zero(), S::one());
        for i in 0..n {
            let (before, after) = (&links[i], &links[i + 1]);
            let carried = storage[i].capacity * rate[i] + before.right + after.left;
            let inverse = S::one() / (carried - before.left * next);
            let right = add((held[i] - storage[i].offset) * rate[i], i) + before.offset - after.offset;
            known = (right + before.left * known) * inverse;
            to_outside = before.left * to_outside * inverse;
            next = after.right * inverse;
            first += path * known;
            first_outside += path * to_outside;
            (inverses[i], nexts[i], to_outsides[i], knowns[i], paths[i]) =
                (inverse, next, to_outside, known, path);
            path = path * next;
        }
        let (outer, inner) = (&links[0], &links[n]);
        if n == 0 {
            let source = [-outer.offset, outer.offset];
            return Condensed { source, response: [[-outer.left, outer.right], [outer.left, -outer.right]] };
        }
        Condensed {
            source: [outer.right * first - outer.offset, inner.left * known + inner.offset],
            response: [
                [outer.right * first_outside - outer.left, outer.right * path],
                [inner.left * to_outside, inner.left * next - inner.right],
            ],
        }
    }

    /// Cell temperatures from the surface temperatures.
    #[inline(always)]
    pub fn temperatures(&mut self, surfaces: [S; 2], cells: &mut [S]) {
        let mut next = surfaces[1];
        for i in (0..cells.len()).rev() {
            next = self.known[i] + self.to_outside[i] * surfaces[0] + self.next[i] * next;
            self.storage[i].moved = next;
            cells[i] = self.storage[i].place + next;
        }
    }

    #[inline(always)]
    fn back_substitute(&self, known: &[S], surfaces: [S; 2], cells: &mut [S]) {
        let mut next = surfaces[1];
        for i in (0..cells.len()).rev() {
            next = known[i] + self.to_outside[i] * surfaces[0] + self.next[i] * next;
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

    /// How cell temperatures change with those of the surfaces and with what the cells held.
    #[inline(always)]
    pub fn temperature_changes(&self, known: &[S], surfaces: [S; 2], cells: &mut [S]) {
        self.back_substitute(known, surfaces, cells);
    }

    /// Takes over the way from the iterate to a solution found elsewhere.
    #[inline(always)]
    pub(crate) fn arrive(&mut self, cells: &[S]) {
        for (storage, &cell) in self.storage.iter_mut().zip(cells) {
            storage.moved = cell - storage.place;
        }
    }

    /// Flux along link `i` at the solution with these surface temperatures [W/m2], positive towards the inside.
    #[inline(always)]
    pub fn link_flux(&self, i: usize, surfaces: [S; 2]) -> S {
        let left = if i == 0 { surfaces[0] } else { self.storage[i - 1].moved };
        let right = if i == self.storage.len() { surfaces[1] } else { self.storage[i].moved };
        self.links[i].flux(left, right)
    }

    /// Liquid fraction of a phase-change cell at the solution, along the last tangent.
    #[inline(always)]
    pub fn reached_fraction(&self, i: usize) -> S {
        let point = &self.points[i];
        let reached = point.liquid_fraction + point.fraction_slope * self.storage[i].moved;
        reached.max(S::zero()).min(S::one())
    }

    /// Liquid fraction of a phase-change cell at the last linearisation.
    #[inline(always)]
    pub fn liquid_fraction(&self, i: usize) -> S {
        self.points[i].liquid_fraction
    }
}

impl Chain<f64> {
    /// Takes over the values of another linearisation.
    #[inline(always)]
    pub(crate) fn adopt<S: Real>(&mut self, other: &Chain<S>) {
        for (mine, theirs) in self.links.iter_mut().zip(&other.links) {
            (mine.left, mine.right) = (theirs.left.lane(0), theirs.right.lane(0));
        }
        for (mine, theirs) in self.storage.iter_mut().zip(&other.storage) {
            mine.capacity = theirs.capacity.lane(0);
        }
    }

    /// Heat into the surfaces [W/m2] from heat released in the cells [W/m2], which [`Self::back`] needs in its place.
    #[inline(always)]
    pub(crate) fn forward<R: Real>(&self, cells: &mut [R]) -> [R; 2] {
        let (mut first, mut known) = (R::zero(), R::zero());
        for (i, cell) in cells.iter_mut().enumerate() {
            known = (*cell + known.scale(self.links[i].left)).scale(self.inverse[i]);
            *cell = known;
            first += known.scale(self.path[i]);
        }
        let inner = self.links.last().map_or(0.0, |link| link.left);
        [first.scale(self.links[0].right), known.scale(inner)]
    }

    /// Cell temperatures from what [`Self::forward`] left and those of the surfaces.
    #[inline(always)]
    pub(crate) fn back<R: Real>(&self, [outside, mut next]: [R; 2], cells: &mut [R]) {
        for (i, cell) in cells.iter_mut().enumerate().rev() {
            next = *cell + outside.scale(self.to_outside[i]) + next.scale(self.next[i]);
            *cell = next;
        }
    }

    /// The transpose of [`Self::back`]: weights on the surfaces from weights on the cells, which become weights on what
    /// `forward` left.
    #[inline(always)]
    pub(crate) fn back_transposed(&self, cells: &mut [f64]) -> [f64; 2] {
        let (mut outside, mut next) = (0.0, 0.0);
        for (i, cell) in cells.iter_mut().enumerate() {
            *cell += next;
            outside += self.to_outside[i] * *cell;
            next = self.next[i] * *cell;
        }
        [outside, next]
    }

    /// The transpose of [`Self::forward`]: weights on heat released in the cells from weights on heat into the surfaces and
    /// on what `forward` left.
    #[inline(always)]
    pub(crate) fn forward_transposed(&self, [outside, inside]: [f64; 2], cells: &mut [f64]) {
        let outside = self.links[0].right * outside;
        let mut known = self.links.last().map_or(0.0, |link| link.left) * inside;
        for (i, cell) in cells.iter_mut().enumerate().rev() {
            let weight = (*cell + known + outside * self.path[i]) * self.inverse[i];
            *cell = weight;
            known = self.links[i].left * weight;
        }
    }
}

/// Enthalpy and slope at a temperature, the concave part of the enthalpy taken along its tangent at another one.
fn split_tangent<S: Real>(
    law: &crate::physics::pcm::PcmCoefficients<S>,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::coefficients::Cell;

    /// Cells and surfaces of walls without symmetry, and the transpose: `w . (A^-1 b) = (A^-T w) . b`.
    #[test]
    fn sweeps_solve_and_transpose() {
        const STAGE: f64 = 300.0;
        for n in [0, 1, 2, 6] {
            let vary = |i: usize, by: f64| 1.0 + Real::sin(by * (i + 1) as f64).abs();
            let cell = |i| {
                let matter =
                    Matter::Solid { conductivity: 0.3 * vary(i, 1.3), capacity: 1.2e6 * vary(i, 0.7) };
                Cell { thickness: 0.02 * vary(i, 2.1), matter }
            };
            let wall = WallCoefficients {
                area: 1.0,
                cells: (0..n).map(cell).collect(),
                extra: vec![0.05; n + 1],
                massless: vec![true; n + 1],
                pcm: Vec::new(),
                layer_resistance: Vec::new(),
                glass: None,
            };
            let mut chain = Chain::<f64>::new(&wall);
            for (i, link) in chain.links.iter_mut().enumerate() {
                link.left *= vary(i, 0.4);
            }
            let response = chain.factor(&wall, STAGE);
            let released: Vec<f64> = (0..n).map(|i| 10.0 * vary(i, 3.1) - 14.0).collect();
            let surfaces = [3.0, -1.5];
            let mut cells = released.clone();
            let sources = chain.forward(&mut cells);
            chain.back(surfaces, &mut cells);
            // Heat into each cell and surface along the links.
            let at = |k: usize| if k == 0 { surfaces[0] } else { *cells.get(k - 1).unwrap_or(&surfaces[1]) };
            let flux = |link: usize| chain.links[link].flux(at(link), at(link + 1));
            for i in 0..n {
                let stored = chain.storage[i].capacity * chain.rate[i] * cells[i];
                assert!((released[i] + flux(i) - flux(i + 1) - stored).abs() < 1e-9, "cell {i} of {n}");
            }
            let heat = [-flux(0), flux(n)];
            for e in 0..2 {
                let expected = sources[e] + response[e][0] * surfaces[0] + response[e][1] * surfaces[1];
                assert!((heat[e] - expected).abs() < 1e-9, "face {e} of {n}");
            }
            let (weights, outer) = ((0..n).map(|i| vary(i, 5.0)).collect::<Vec<_>>(), [0.7, -0.4]);
            let mut back = weights.clone();
            let by_surfaces = chain.back_transposed(&mut back);
            chain.forward_transposed(outer, &mut back);
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let forth = dot(&weights, &cells) + dot(&outer, &sources);
            let back = dot(&back, &released) + dot(&by_surfaces, &surfaces);
            assert!((forth - back).abs() < 1e-9, "{forth} is not {back} with {n} cells");
        }
    }
}
