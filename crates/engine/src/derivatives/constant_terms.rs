//! Terms of the balances that are the same in all stages but for the solution.
//!
//! Conduction along walls of constant properties, storage in their cells and the radiation between the surfaces of a zone are products
//! of a number that stays the same during a run and a difference of values that the solution gives. They are found once, with the
//! numbers that have derivatives only. A stage then takes its values ([`KnownValues`]) and no law: forward derivatives add the terms to the equations, reverse
//! derivatives multiply them with the weights on the equations, without a place on the tape.

use crate::balance::terms::{Contents, End, Held, Node, Origin, OutdoorRadiation, Sink, Stage};
use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::linear::unknowns::Unknowns;
use crate::linear::wall::{Link, Storage};
use crate::number::line::Line;
use crate::number::real::{ConstantTerm, Real};

use crate::step::linearized_stepper::TangentStepper;

use super::equation_slopes::Scale;

/// The values of a stage that steady terms multiply, in one list, see [`Parts`]; behind them a zero.
#[derive(Debug, Clone)]
pub(super) struct KnownValues {
    values: Vec<f64>,
    /// Where the parts behind the first begin, and the zero.
    cooling: usize,
    emission: usize,
    nothing: usize,
}

/// The parts of [`KnownValues`].
pub(super) struct Parts<'a> {
    /// Cells, surfaces and airs [degC].
    pub(super) solution: &'a mut [f64],
    /// How fast each cell of a wall of constant properties has cooled since the stage began [K/s].
    pub(super) cooling: &'a mut [f64],
    /// Black emission of each surface [W/m2].
    pub(super) emission: &'a mut [f64],
}

impl KnownValues {
    pub(super) fn new<S: Real>(model: &Model<'_, S>) -> Self {
        let plan = model.plan;
        let cooling = plan.n_cells + plan.surfaces.len() + plan.zones.len();
        let emission = cooling + plan.n_cells;
        let nothing = emission + plan.surfaces.len();
        Self { values: vec![0.0; nothing + 1], cooling, emission, nothing }
    }

    #[inline(always)]
    pub(super) fn all(&self) -> &[f64] {
        &self.values
    }

    #[inline(always)]
    pub(super) fn solution(&self) -> &[f64] {
        &self.values[..self.cooling]
    }

    #[inline(always)]
    pub(super) fn parts(&mut self) -> Parts<'_> {
        let (solution, rest) = self.values.split_at_mut(self.cooling);
        let (cooling, rest) = rest.split_at_mut(self.emission - self.cooling);
        Parts { solution, cooling, emission: &mut rest[..self.nothing - self.emission] }
    }
}

/// The steady terms of a building, and what they need.
#[derive(Debug, Clone)]
pub(super) struct ConstantTerms<S> {
    pub(super) terms: Vec<ConstantTerm<S>>,
    /// Walls of constant properties whose cells they need.
    pub(super) walls: Vec<usize>,
    /// Surfaces whose emission they need.
    pub(super) surfaces: Vec<SideId>,
}

impl<S: Real> ConstantTerms<S> {
    /// The steady terms of a building, by places in [`KnownValues`].
    pub(super) fn find(linearized_stepper: &TangentStepper<'_, S>, places: &KnownValues) -> Self {
        let zeros = Unknowns::zero(places.cooling, 0, linearized_stepper.model.plan.zones.len());
        let contents = Contents { cells: &zeros.cells, enthalpy: &zeros.cells, air: &zeros.air };
        let stage = Stage { length: 1.0, ratio: 0.0, start: contents, first: contents };
        let found = Self { terms: Vec::new(), walls: Vec::new(), surfaces: Vec::new() };
        let mut finding = FindSteadyTerms { model: &linearized_stepper.model, places, found, wall: 0 };
        linearized_stepper.balances().visit(&stage, &mut finding);
        let mut found = finding.found;
        found.surfaces.sort_unstable_by_key(|surface| surface.index());
        found.surfaces.dedup();
        found
    }
}

/// Takes the steady terms out of all terms.
struct FindSteadyTerms<'a, S> {
    model: &'a Model<'a, S>,
    places: &'a KnownValues,
    found: ConstantTerms<S>,
    wall: usize,
}

impl<S: Real> FindSteadyTerms<'_, S> {
    /// Keeps a term whose number has derivatives. True where it has.
    fn keep(&mut self, number: S, between: [usize; 2], equations: [usize; 2], factors: [f64; 2]) -> bool {
        let keeps = number.carries() && factors != [0.0; 2];
        if keeps {
            self.found.terms.push(ConstantTerm { number, between, equations, factors });
        }
        keeps
    }

    /// The scale of the equation of a node, and the number that it is multiplied by.
    fn scale(&self, node: Node, area: S) -> (Scale, f64) {
        let scale = match node {
            Node::Cell(_) => Scale::PerArea,
            Node::Surface(surface) => Scale::of(self.model, surface),
            Node::Air(_) => Scale::Whole,
        };
        match scale {
            Scale::PerArea => (scale, 1.0),
            Scale::Whole => (scale, area.lane(0)),
            Scale::Held => (scale, 0.0),
        }
    }

    fn row(&self, node: Node) -> usize {
        match node {
            Node::Cell(cell) => cell,
            Node::Surface(surface) => self.model.plan.n_cells + surface.index(),
            Node::Air(zone) => self.model.plan.n_cells + self.model.plan.surfaces.len() + zone,
        }
    }

    fn need_cells(&mut self) {
        if self.found.walls.last() != Some(&self.wall) {
            self.found.walls.push(self.wall);
        }
    }
}

impl<S: Real> Sink<S> for FindSteadyTerms<'_, S> {
    fn begin_wall(&mut self, wall: usize) {
        self.wall = wall;
    }

    fn takes_wall(&self, wall: usize) -> bool {
        !self.model.plan.walls[wall].nonlinear
    }

    fn counts(&self) -> bool {
        false
    }

    fn store_heat(&mut self, node: Node, [_, thickness]: [S; 2], capacity: S, _held: Held<S>) {
        let Node::Cell(cell) = node else { return };
        let between = [self.places.cooling + cell, self.places.nothing];
        let by_capacity = self.keep(capacity, between, [cell; 2], [thickness.lane(0), 0.0]);
        let by_thickness = self.keep(thickness, between, [cell; 2], [capacity.lane(0), 0.0]);
        if by_capacity || by_thickness {
            self.need_cells();
        }
    }

    fn store_enthalpy(&mut self, _cell: usize, _sizes: [S; 2], _enthalpy: &Storage<S>, _held: Held<S>) {}

    fn conduct(&mut self, ends: [Node; 2], area: S, conductance: S) {
        if matches!(ends[0], Node::Air(_)) {
            return;
        }
        let rows = ends.map(|node| self.row(node));
        let [(from, by_from), (to, by_to)] = ends.map(|node| self.scale(node, area));
        let by_conductance = self.keep(conductance, rows, rows, [-by_from, by_to]);
        let whole = |scale| if matches!(scale, Scale::Whole) { conductance.lane(0) } else { 0.0 };
        let by_area = self.keep(area, rows, rows, [-whole(from), whole(to)]);
        if by_conductance || by_area {
            self.need_cells();
        }
    }

    fn conduct_linearised(&mut self, _ends: [Node; 2], _area: S, _link: &Link<S>, _places: [S; 2]) {}

    fn carry(&mut self, _ends: [Node; 2], _conductance: S, _reference: S) {}

    fn exchange(&mut self, _ends: [End<S>; 2], _area: S, _law: &Line<S>) {}

    fn radiate(&mut self, surfaces: [SideId; 2], area: S, [law, _]: [&Line<S>; 2]) {
        let rows = surfaces.map(|surface| self.row(Node::Surface(surface)));
        let emissions = surfaces.map(|surface| self.places.emission + surface.index());
        if self.keep(area, emissions, rows, [-1.0, 1.0]) {
            self.found.surfaces.extend(surfaces);
        }
        // The exact law depends on the solution only: its slope has no derivatives. A linear law is the same at both ends: its offsets
        // cancel.
        self.keep(law.slope, rows, rows, [-area.lane(0), area.lane(0)]);
    }

    fn radiate_outdoors(&mut self, _surface: SideId, _area: S, _radiation: &OutdoorRadiation<'_, S>) {}

    fn release(&mut self, _node: Node, _size: S, _heat: S, _origin: Origin<S>) {}

    fn impose(&mut self, _surface: SideId, _area: S, _temperature: S) {}
}
