//! Slopes of the balances of a stage at its solution.
//!
//! Each term of each balance ([`crate::balance::terms`]) is differentiated by its coefficients with the product rule; the
//! temperatures are constants, those of the solution. Equations count heat into a node as positive, in the order and scale of
//! [`crate::linear::stage_matrix`]: of cells and of surfaces outside the zones per square metre, of all others whole; the equation
//! of a surface held at a temperature is that temperature. Terms that are the same in all stages but for the solution are left to
//! [`super::constant_terms`].

use crate::balance::terms::{End, Held, Node, Origin, OutdoorRadiation, Sink, Stage};
use crate::building::ids::{BySide, SideId};
use crate::building::model::Model;
use crate::building::plan::SideRole;
use crate::linear::building_system::is_held;
use crate::linear::stage_matrix::StageMatrix;
use crate::linear::wall::{Link, Storage};
use crate::number::line::Line;
use crate::number::real::{Equations, Real};

/// Which areas have derivatives (terms are not differentiated by the others), and scales.
#[derive(Debug, Clone)]
pub(super) struct Carries {
    /// By wall: its area.
    area: Vec<bool>,
    /// Scales of the equations of surfaces.
    scales: BySide<Scale>,
}

impl Carries {
    pub(super) fn new<S: Real>(model: &Model<'_, S>) -> Self {
        Self {
            area: model.coefficients.walls.iter().map(|wall| wall.area.carries()).collect(),
            scales: model
                .plan
                .surfaces
                .ids()
                .map(|surface| Scale::of(model, surface))
                .collect::<Vec<_>>()
                .into(),
        }
    }
}

/// Scale of an equation.
#[derive(Debug, Clone, Copy)]
pub(super) enum Scale {
    /// Heat per square metre [W/m2].
    PerArea,
    /// Heat [W].
    Whole,
    /// A temperature [degC].
    Held,
}

impl Scale {
    pub(super) fn of<S: Real>(model: &Model<'_, S>, surface: SideId) -> Self {
        match model.plan.surfaces[surface].role {
            SideRole::Zone { .. } => Self::Whole,
            _ if is_held(model, surface) => Self::Held,
            SideRole::Exterior => Self::PerArea,
        }
    }
}

/// Differentiates terms.
pub(super) struct EquationSlopes<'a, S: Real> {
    model: &'a Model<'a, S>,
    carries: &'a Carries,
    equations: &'a mut S::Equations,
    /// The solution: cells, surfaces, airs [degC].
    at: &'a [f64],
    /// Whether the size of the current term has derivatives: an area, a share, or the number 1.
    size_carries: bool,
    /// The current wall.
    wall: usize,
}

impl<'a, S: Real> EquationSlopes<'a, S> {
    #[inline(always)]
    pub(super) fn new(
        model: &'a Model<'a, S>,
        carries: &'a Carries,
        equations: &'a mut S::Equations,
        at: &'a [f64],
    ) -> Self {
        equations.begin(at.len());
        Self { model, carries, equations, at, size_carries: false, wall: 0 }
    }

    /// Heat that the cells of the walls of constant properties hold when the stage begins.
    #[inline(always)]
    pub(super) fn hold_heat(&mut self, stage: &Stage<'_, S>, matrix: &StageMatrix<'_>) {
        for &w in &self.model.parts.linear_walls {
            let (cells, chain) = (self.model.cells(w), &matrix.system.walls[w]);
            let contents = stage.start.cells[cells.clone()].iter().zip(&stage.first.cells[cells.clone()]);
            let laws = chain.rate.iter().zip(&chain.storage);
            for ((cell, (&start, &first)), (rate, storage)) in cells.zip(contents).zip(laws) {
                let heat = rate * storage.capacity;
                self.equations.add(cell, start, heat * (1.0 - stage.ratio));
                // In the first stage `first` has no meaning yet.
                if stage.ratio != 0.0 {
                    self.equations.add(cell, first, heat * stage.ratio);
                }
            }
        }
    }

    #[inline(always)]
    fn row(&self, node: Node) -> usize {
        match node {
            Node::Cell(cell) => cell,
            Node::Surface(surface) => self.model.plan.n_cells + surface.index(),
            Node::Air(zone) => self.model.plan.n_cells + self.model.plan.surfaces.len() + zone,
        }
    }

    #[inline(always)]
    fn temperature(&self, node: Node) -> f64 {
        self.at[self.row(node)]
    }

    #[inline(always)]
    fn scale(&self, node: Node) -> Scale {
        match node {
            Node::Cell(_) => Scale::PerArea,
            Node::Surface(surface) => self.carries.scales[surface],
            Node::Air(_) => Scale::Whole,
        }
    }

    /// `sign size heat` into a node, where `heat` has these slopes by these numbers.
    #[inline(always)]
    fn add<const N: usize>(&mut self, node: Node, sign: f64, size: S, heat: f64, slopes: [(S, f64); N]) {
        let row = self.row(node);
        match self.scale(node) {
            Scale::Held => {}
            Scale::PerArea => {
                for (number, slope) in slopes {
                    self.equations.add(row, number, sign * slope);
                }
            }
            Scale::Whole => {
                let whole = sign * size.lane(0);
                for (number, slope) in slopes {
                    self.equations.add(row, number, whole * slope);
                }
                if self.size_carries {
                    self.equations.add(row, size, sign * heat);
                }
            }
        }
    }

    /// The same from one node to another.
    #[inline(always)]
    fn between<const N: usize>(&mut self, ends: [Node; 2], size: S, heat: f64, slopes: [(S, f64); N]) {
        self.add(ends[0], -1.0, size, heat, slopes);
        self.add(ends[1], 1.0, size, heat, slopes);
    }
}

impl<S: Real> Sink<S> for EquationSlopes<'_, S> {
    #[inline(always)]
    fn begin_wall(&mut self, wall: usize) {
        self.wall = wall;
    }

    #[inline(always)]
    fn takes_wall(&self, wall: usize) -> bool {
        self.model.plan.walls[wall].nonlinear
    }

    #[inline(always)]
    fn takes_radiation(&self) -> bool {
        false
    }

    #[inline(always)]
    fn counts(&self) -> bool {
        false
    }

    /// Of the airs: cells of walls of constant properties are steady terms.
    #[inline(always)]
    fn store_heat(&mut self, node: Node, _sizes: [S; 2], capacity: S, held: Held<S>) {
        let heat = capacity.lane(0) / held.length;
        let mut start = held.start.lane(0);
        self.size_carries = false;
        if held.ratio == 0.0 {
            self.add(node, 1.0, S::one(), 0.0, [(held.start, heat)]);
        } else {
            start += (held.first.lane(0) - start) * held.ratio;
            let slopes = [(held.start, heat * (1.0 - held.ratio)), (held.first, heat * held.ratio)];
            self.add(node, 1.0, S::one(), 0.0, slopes);
        }
        self.equations.add(self.row(node), capacity, (start - self.temperature(node)) / held.length);
    }

    #[inline(always)]
    fn store_enthalpy(
        &mut self,
        cell: usize,
        [area, thickness]: [S; 2],
        enthalpy: &Storage<S>,
        held: Held<S>,
    ) {
        let rate = thickness.lane(0) / held.length;
        let above = self.at[cell] - enthalpy.reference.lane(0);
        let mut start = held.start.lane(0);
        if held.ratio != 0.0 {
            start += (held.first.lane(0) - start) * held.ratio;
            self.add(Node::Cell(cell), 1.0, area, 0.0, [(held.first, rate * held.ratio)]);
        }
        let reached = enthalpy.offset.lane(0) + enthalpy.capacity.lane(0) * above;
        let slopes = [
            (held.start, rate * (1.0 - held.ratio)),
            (enthalpy.offset, -rate),
            (enthalpy.capacity, -rate * above),
            (thickness, (start - reached) / held.length),
        ];
        self.add(Node::Cell(cell), 1.0, area, 0.0, slopes);
    }

    /// Between airs: links of walls of constant properties are steady terms.
    #[inline(always)]
    fn conduct(&mut self, ends: [Node; 2], area: S, conductance: S) {
        let difference = self.temperature(ends[0]) - self.temperature(ends[1]);
        self.size_carries = false;
        self.between(ends, area, conductance.lane(0) * difference, [(conductance, difference)]);
    }

    #[inline(always)]
    fn carry(&mut self, ends: [Node; 2], conductance: S, reference: S) {
        let excess = self.temperature(ends[0]) - reference.lane(0);
        let slope = conductance.lane(0);
        self.size_carries = false;
        self.between(ends, S::one(), slope * excess, [(conductance, excess), (reference, -slope)]);
    }

    #[inline(always)]
    fn conduct_linearised(&mut self, ends: [Node; 2], area: S, link: &Link<S>, places: [S; 2]) {
        let left = self.temperature(ends[0]) - places[0].lane(0);
        let right = self.temperature(ends[1]) - places[1].lane(0);
        self.size_carries = self.carries.area[self.wall];
        let heat = link.offset.lane(0) + link.left.lane(0) * left - link.right.lane(0) * right;
        self.between(ends, area, heat, [(link.offset, 1.0), (link.left, left), (link.right, -right)]);
    }

    #[inline(always)]
    fn exchange(&mut self, ends: [End<S>; 2], area: S, law: &Line<S>) {
        let temperature = |end: End<S>| match end {
            End::Node(node) => self.temperature(node),
            End::Environment { temperature, .. } => temperature.lane(0),
        };
        let difference = temperature(ends[0]) - temperature(ends[1]);
        let (heat, slope) = (Line::of(law).at(difference), law.slope.lane(0));
        let slopes = [(law.offset, 1.0), (law.slope, difference)];
        self.size_carries = match ends[0] {
            End::Node(Node::Surface(surface)) => self.carries.area[surface.wall()],
            // Outdoor air that flows into zones has no area.
            _ => false,
        };
        match ends {
            [End::Node(from), End::Node(to)] => self.between([from, to], area, heat, slopes),
            [End::Node(from), End::Environment { temperature, .. }] => {
                let [by_offset, by_slope] = slopes;
                self.add(from, -1.0, area, heat, [by_offset, by_slope, (temperature, -slope)]);
            }
            [End::Environment { temperature, .. }, End::Node(to)] => {
                let [by_offset, by_slope] = slopes;
                self.add(to, 1.0, area, heat, [by_offset, by_slope, (temperature, slope)]);
            }
            [End::Environment { .. }, End::Environment { .. }] => {}
        }
    }

    /// Steady terms.
    #[inline(always)]
    fn radiate(&mut self, _surfaces: [SideId; 2], _area: S, _emission: [&Line<S>; 2]) {}

    #[inline(always)]
    fn radiate_outdoors(&mut self, surface: SideId, area: S, radiation: &OutdoorRadiation<'_, S>) {
        let node = Node::Surface(surface);
        let (at, emissivity) = (self.temperature(node), radiation.emissivity.lane(0));
        let emitted = Line::of(radiation.emission).at(at);
        let slopes = [
            (radiation.arriving, 1.0),
            (radiation.emissivity, -emitted),
            (radiation.emission.offset, -emissivity),
            (radiation.emission.slope, -emissivity * at),
        ];
        self.add(node, 1.0, area, radiation.arriving.lane(0) - emissivity * emitted, slopes);
    }

    #[inline(always)]
    fn release(&mut self, node: Node, size: S, heat: S, origin: Origin<S>) {
        self.size_carries = match (node, origin) {
            (_, Origin::RadiantGains { .. }) | (Node::Surface(_), Origin::IdealLoad) => true,
            (Node::Surface(surface), _) => self.carries.area[surface.wall()],
            (Node::Cell(_) | Node::Air(_), _) => false,
        };
        self.add(node, 1.0, size, heat.lane(0), [(heat, 1.0)]);
    }

    #[inline(always)]
    fn impose(&mut self, surface: SideId, _area: S, temperature: S) {
        let row = self.row(Node::Surface(surface));
        self.equations.add(row, temperature, 1.0);
    }
}
