//! A wall as finite volumes, eliminated onto its two surfaces.
//!
//! Cells hold enthalpy per volume; links between neighbours carry heat in flux form. What depends on temperature is linearised
//! about an iterate ([`wall_linearisation`](super::wall_linearisation)); one implicit stage is then a tridiagonal system
//! with the two surface temperatures as unknowns that are left ([`tridiagonal`](super::tridiagonal)).

use crate::building::coefficients::{Matter, WallCoefficients};
use crate::linear::product::{PlainMatrix, SameKind};
use crate::linear::tridiagonal::Tridiagonal;
use crate::linear::wall_linearisation::PhaseChange;
use crate::number::real::Real;
use crate::physics::pcm::PcmHistory;
use crate::weather::heat_sources::SourceConditions;

pub use crate::linear::tridiagonal::{Condensed, Link, Response};
pub use crate::linear::wall_linearisation::{Iterate, Start, Storage, StorageRule};

/// The linearised wall of one Newton iteration and its elimination.
#[derive(Debug, Clone)]
pub struct WallSystem<S> {
    /// Cells + 1 links; the first touches the outside surface, the last the inside surface.
    pub links: Vec<Link<S>>,
    /// Storage law of each cell.
    pub storage: Vec<Storage<S>>,
    /// Thickness over stage length [m/s].
    pub(crate) rate: Vec<S>,
    /// Heat released in each cell [W/m2], and what more of it a colder cell takes [W/(m2 K)]; empty in a wall without heat sources.
    released: Vec<S>,
    taken: Vec<S>,
    elimination: Tridiagonal<S>,
    phase_change: PhaseChange<S>,
}

impl<S: Real> WallSystem<S> {
    /// The system of a wall, written once where its properties are constant.
    pub fn new(wall: &WallCoefficients<S>) -> Self {
        let n = wall.cells.len();
        Self {
            links: solid_links(wall),
            storage: wall.cells.iter().map(|cell| Storage::constant(solid_capacity(&cell.matter))).collect(),
            rate: vec![S::zero(); n],
            released: vec![S::zero(); if wall.planes { n } else { 0 }],
            taken: vec![S::zero(); if wall.planes { n } else { 0 }],
            elimination: Tridiagonal::new(n),
            phase_change: PhaseChange::new(wall),
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
        self.phase_change.linearise(wall, at, start, rule, (&mut self.links, &mut self.storage));
    }

    /// Eliminates the cells for a stage of effective length `stage` [s]. Called again only when a coefficient changes.
    #[inline(always)]
    pub fn factor(&mut self, wall: &WallCoefficients<S>, stage: f64) -> Response<S> {
        self.set_stage_length(wall, stage);
        let (storage, rate) = (&self.storage, &self.rate);
        if !self.taken.is_empty() {
            let taken = &self.taken;
            return self.elimination.factor(&self.links, |i| storage[i].capacity * rate[i] + taken[i]);
        }
        self.elimination.factor(
            &self.links,
            #[inline(always)]
            |i| storage[i].capacity * rate[i],
        )
    }

    /// Sets the stage length that cells are eliminated for by [`Self::condense`] [s].
    #[inline(always)]
    pub fn set_stage_length(&mut self, wall: &WallCoefficients<S>, stage: f64) {
        for (rate, cell) in self.rate.iter_mut().zip(&wall.cells) {
            *rate = cell.thickness.scale(1.0 / stage);
        }
    }

    /// Eliminates the cells, and with them the heat that they hold: `held` is the right-hand enthalpy [J/m3]. The stage length is
    /// that of [`Self::set_stage_length`].
    #[inline(always)]
    pub fn condense(&mut self, held: &[S]) -> Condensed<S> {
        self.condense_with(
            held,
            #[inline(always)]
            |heat, _| heat,
        )
    }

    /// The same with heat released in the cells [W/m2].
    #[inline(always)]
    pub fn condense_heated(&mut self, held: &[S], gains: &[S]) -> Condensed<S> {
        self.condense_with(
            held,
            #[inline(always)]
            |heat, i| heat + gains[i],
        )
    }

    /// Sets what heat sources release in planes of the wall, by their positions.
    pub(crate) fn set_sources(&mut self, planes: &[(usize, usize)], sources: &[SourceConditions<S>]) {
        self.released.fill(S::zero());
        self.taken.fill(S::zero());
        for &(source, cell) in planes {
            let at = &sources[source];
            self.released[cell] += at.released(S::zero());
            self.taken[cell] += at.conductance;
        }
    }

    /// Whether heat sources are in it.
    #[inline(always)]
    pub(crate) fn has_sources(&self) -> bool {
        !self.taken.is_empty()
    }

    /// [`Self::condense`] with what heat sources release.
    // One copy only: few walls have heat sources.
    #[inline(never)]
    pub(crate) fn condense_with_sources(&mut self, held: &[S]) -> Condensed<S> {
        let (storage, rate, taken, released) = (&self.storage, &self.rate, &self.taken, &self.released);
        self.elimination.condense(
            &self.links,
            |i| storage[i].capacity * rate[i] + taken[i],
            |i| (held[i] - storage[i].offset) * rate[i] + released[i] - taken[i] * storage[i].reference,
        )
    }

    #[inline(always)]
    fn condense_with(&mut self, held: &[S], add: impl Fn(S, usize) -> S) -> Condensed<S> {
        let n = held.len();
        let (storage, rate) = (&self.storage[..n], &self.rate[..n]);
        self.elimination.condense(
            &self.links,
            #[inline(always)]
            |i| storage[i].capacity * rate[i],
            #[inline(always)]
            |i| add((held[i] - storage[i].offset) * rate[i], i),
        )
    }

    /// Cell temperatures from the surface temperatures.
    #[inline(always)]
    pub fn temperatures(&mut self, [outside, inside]: [S; 2], cells: &mut [S]) {
        let places = self.storage.iter_mut().zip(cells);
        self.elimination.cells(
            [outside, inside],
            places,
            #[inline(always)]
            |(storage, cell), change| {
                storage.change = change;
                *cell = storage.reference + change;
            },
        );
    }

    /// Replaces the temperatures of cells of constant properties by those at the end of a stage that starts from them, between
    /// surfaces at 0 degC.
    #[inline(always)]
    pub(crate) fn free_stage(&self, cells: &mut [S]) {
        let (storage, rate) = (&self.storage[..cells.len()], &self.rate[..cells.len()]);
        self.elimination.forward::<SameKind, _>(
            &self.links,
            cells,
            #[inline(always)]
            |i, cell| storage[i].capacity * rate[i] * cell,
        );
        self.elimination.back_between_zeros(cells);
    }

    /// How the heat into the surfaces [W/m2] changes with heat that is released in the cells [W/m2]; `known` takes what
    /// [`Self::temperature_changes`] needs.
    #[inline(always)]
    pub(crate) fn heat_changes(&self, heat: &[S], known: &mut [S]) -> [S; 2] {
        self.elimination.forward::<SameKind, _>(
            &self.links,
            known,
            #[inline(always)]
            |i, _| heat[i],
        )
    }

    /// How the heat into the surfaces [W/m2] changes with the enthalpies of the cells [J/m3]; `known` takes what
    /// [`Self::temperature_changes`] needs.
    #[inline(always)]
    pub fn source_changes(&self, held: &[S], known: &mut [S]) -> [S; 2] {
        self.elimination.forward::<SameKind, _>(
            &self.links,
            known,
            #[inline(always)]
            |i, _| held[i] * self.rate[i],
        )
    }

    /// How cell temperatures change with those of the surfaces and with the enthalpies of the cells.
    #[inline(always)]
    pub fn temperature_changes(&self, known: &[S], surfaces: [S; 2], cells: &mut [S]) {
        self.elimination.back::<SameKind, _>(
            #[inline(always)]
            |i, _| known[i],
            surfaces,
            cells,
        );
    }

    /// Sets a solution that was found elsewhere.
    #[inline(always)]
    pub(crate) fn set_solution(&mut self, cells: &[S]) {
        for (storage, &cell) in self.storage.iter_mut().zip(cells) {
            storage.change = cell - storage.reference;
        }
    }

    /// Flux along link `i` at the solution with these surface temperatures [W/m2], positive towards the inside.
    #[inline(always)]
    pub fn link_flux(&self, i: usize, surfaces: [S; 2]) -> S {
        let left = if i == 0 { surfaces[0] } else { self.storage[i - 1].change };
        let right = if i == self.storage.len() { surfaces[1] } else { self.storage[i].change };
        self.links[i].flux(left, right)
    }

    /// What the tangents of melting curves leave out of the balances of cells at the solution, estimated: the largest
    /// [W/m2].
    #[inline(always)]
    pub(crate) fn estimated_remainder(&self) -> S {
        self.phase_change.estimated_remainder(&self.storage, &self.rate)
    }

    /// The same evaluated, to rounding: the largest [W/m2]. Cells at the start of the step have a memory.
    #[inline(always)]
    pub(crate) fn linearization_error(
        &self,
        wall: &WallCoefficients<S>,
        memory: &[PcmHistory<S>],
        surfaces: [S; 2],
    ) -> S {
        self.phase_change.linearization_error(
            wall,
            memory,
            (&self.storage, &self.rate),
            #[inline(always)]
            |link| self.link_flux(link, surfaces),
        )
    }

    /// Liquid fraction of a phase-change cell at the solution, along the last tangent.
    #[inline(always)]
    pub fn fraction_at_solution(&self, i: usize) -> S {
        self.phase_change.fraction_after(i, self.storage[i].change)
    }

    /// Liquid fraction of a phase-change cell at the last linearisation.
    #[inline(always)]
    pub fn liquid_fraction(&self, i: usize) -> S {
        self.phase_change.liquid_fraction(i)
    }
}

/// A plain wall: what is solved with its factors may carry derivatives.
impl WallSystem<f64> {
    /// Copies the values of another linearisation.
    #[inline(always)]
    pub(crate) fn copy_values<S: Real>(&mut self, other: &WallSystem<S>) {
        for (mine, theirs) in self.links.iter_mut().zip(&other.links) {
            (mine.left, mine.right) = (theirs.left.lane(0), theirs.right.lane(0));
        }
        for (mine, theirs) in self.storage.iter_mut().zip(&other.storage) {
            mine.capacity = theirs.capacity.lane(0);
        }
        for (mine, theirs) in self.taken.iter_mut().zip(&other.taken) {
            *mine = theirs.lane(0);
        }
    }

    /// Heat into the surfaces [W/m2] from heat released in the cells [W/m2], which is replaced by what [`Self::back`] needs.
    #[inline(always)]
    pub(crate) fn forward<R: Real>(&self, cells: &mut [R]) -> [R; 2] {
        self.elimination.forward::<PlainMatrix, _>(
            &self.links,
            cells,
            #[inline(always)]
            |_, heat| heat,
        )
    }

    /// Cell temperatures from what [`Self::forward`] left and those of the surfaces.
    #[inline(always)]
    pub(crate) fn back<R: Real>(&self, surfaces: [R; 2], cells: &mut [R]) {
        self.elimination.back::<PlainMatrix, _>(
            #[inline(always)]
            |_, known| known,
            surfaces,
            cells,
        );
    }

    /// The transpose of [`Self::back`].
    #[inline(always)]
    pub(crate) fn back_transposed(&self, cells: &mut [f64]) -> [f64; 2] {
        self.elimination.back_transposed(cells)
    }

    /// The transpose of [`Self::forward`].
    #[inline(always)]
    pub(crate) fn forward_transposed(&self, surfaces: [f64; 2], cells: &mut [f64]) {
        self.elimination.forward_transposed(&self.links, surfaces, cells);
    }
}

/// Capacity of a cell that does not depend on temperature, else zero [J/(m3 K)].
fn solid_capacity<S: Real>(matter: &Matter<S>) -> S {
    match matter {
        Matter::Solid { capacity, .. } => *capacity,
        Matter::Pcm(_) => S::zero(),
    }
}

/// Links that do not depend on temperature: half cells and massless layers in series. Other links are zero.
fn solid_links<S: Real>(wall: &WallCoefficients<S>) -> Vec<Link<S>> {
    let n = wall.cells.len();
    let half = |i: usize| match wall.cells[i].matter {
        Matter::Solid { conductivity, .. } => Some(wall.cells[i].thickness.scale(0.5) / conductivity),
        Matter::Pcm(_) => None,
    };
    let link = |i: usize| {
        let left = if i > 0 { half(i - 1) } else { Some(S::zero()) };
        let right = if i < n { half(i) } else { Some(S::zero()) };
        let conductance = match (left, right) {
            (Some(left), Some(right)) => S::one() / (left + wall.extra[i] + right),
            _ => S::zero(),
        };
        Link { left: conductance, right: conductance, offset: S::zero() }
    };
    (0..=n).map(link).collect()
}

#[cfg(test)]
mod tests;
