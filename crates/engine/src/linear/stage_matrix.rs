//! The plain matrix of a stage, for derivatives: several right-hand sides at once, and the transposed system.
//!
//! Unknowns and equations are those of all cells, all surfaces and all airs, in this order. Heat released in cells and at
//! surfaces outside the zones counts per square metre, at surfaces and airs of zones whole; the equation of a surface that is held
//! at a temperature is that temperature.

use crate::building::coefficients::Coefficients;
use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::building::plan::{Plan, SideRole};
use crate::linear::building_system::{BuildingSystem, exterior_balance, is_held};
use crate::linear::laws::{LinearisedLaws, StageInputs};
use crate::linear::surface_balance::{ExteriorBalance, ExteriorSurfaces, determinant};
use crate::linear::wall::WallSystem;
use crate::number::real::{LinearSystem, Real};
use crate::weather::conditions::Conditions;
use crate::weather::index::WeatherIndex;

/// The linear system of a stage in plain numbers, with the values of a linearisation in other numbers.
#[derive(Debug, Clone)]
pub(crate) struct StageMatrix<'a> {
    model: Model<'a, f64>,
    laws: LinearisedLaws<f64>,
    conditions: Conditions<f64>,
    /// A zero for each zone: right-hand sides are given when the system is solved.
    zeros: Vec<f64>,
    pub(crate) system: BuildingSystem<'a, f64>,
}

impl LinearSystem for StageMatrix<'_> {
    #[inline(always)]
    fn solve<R: Real>(&self, rows: &mut [R], scratch: &mut Vec<R>) {
        self.solve_values(rows, scratch);
    }
}

impl<'a> StageMatrix<'a> {
    /// The matrix of a building at parameters, for a scheme's diagonal coefficient.
    pub(crate) fn new(plan: &'a Plan, parameters: &[f64], diagonal: f64) -> Self {
        let model = Model::new(plan, Coefficients::new(plan, parameters));
        let laws = LinearisedLaws::new(&model);
        let index = WeatherIndex::new(plan, &model.coefficients);
        Self {
            conditions: Conditions::new(plan, &model.coefficients, &index),
            zeros: vec![0.0; plan.zones.len()],
            system: BuildingSystem::new(&model, &laws, diagonal, false),
            laws,
            model,
        }
    }

    /// Keeps the factors of several stage lengths.
    pub(crate) fn keep_factors(&mut self) {
        self.system.factors.keep();
    }

    /// Factors the linear walls for a stage length [s]. True where that was not done before.
    #[inline(always)]
    pub(crate) fn factor_linear_walls(&mut self, length: f64) -> bool {
        self.system.factor_linear_walls(&self.model, length)
    }

    /// Copies the values of a linearisation and factors its matrix; `new`: the linear walls have been factored anew.
    #[inline(always)]
    pub(crate) fn factor<S: Real>(
        &mut self,
        (laws, walls, at): (&LinearisedLaws<S>, &[WallSystem<S>], &Conditions<S>),
        length: f64,
        new: bool,
    ) {
        self.laws.copy_values(laws);
        for (mine, theirs) in self.conditions.paths.iter_mut().zip(&at.paths) {
            *mine = theirs.lane(0);
        }
        let carried = &mut self.conditions.mechanical_air.carried;
        for (mine, theirs) in carried.iter_mut().zip(&at.mechanical_air.carried) {
            *mine = theirs.lane(0);
        }
        let Self { model, laws, conditions, zeros, system } = self;
        let inputs = StageInputs { model, conditions, laws, air: zeros, load: zeros, holding: &[], length };
        for &w in &model.parts.nonlinear_walls {
            system.walls[w].copy_values(&walls[w]);
            system.responses[w] = system.walls[w].factor(&model.coefficients.walls[w], length);
        }
        if !model.parts.balances_stay() || new {
            system.zone_fronts.copy_laws(&laws.surfaces);
            system.assemble_linear(&inputs, true, None);
            system.zone_fronts.write_exterior_surfaces(&mut system.exterior, &mut system.inverses);
        }
        system.assemble_nonlinear(&inputs);
        system.coupled.solve_rest();
    }

    /// Balance of an exterior surface.
    #[inline(always)]
    fn balance(&self, surface: SideId) -> ExteriorBalance<f64> {
        exterior_balance(&self.model, &self.conditions, &self.laws, surface)
    }

    /// Factor of the heat from a wall in the equation of its surface [-], in zones [m2].
    #[inline(always)]
    fn takes(&self, surface: SideId) -> f64 {
        match self.model.plan.surfaces[surface].role {
            SideRole::Zone { .. } => self.model.coefficients.walls[surface.wall()].area,
            SideRole::Exterior if is_held(&self.model, surface) => 0.0,
            SideRole::Exterior => 1.0,
        }
    }

    /// Rise of an exterior surface by heat, at a constant temperature of the other surface of its wall.
    #[inline(always)]
    fn yields(&self, surface: SideId) -> f64 {
        if is_held(&self.model, surface) { 1.0 } else { self.system.inverses[surface.wall()] }
    }

    /// The matrix of a wall that touches no zone, and one over its determinant.
    #[inline(always)]
    fn pair(&self, w: usize) -> ([[f64; 2]; 2], f64) {
        let response = self.system.responses[w];
        let (outer, inner) = (self.balance(SideId::outside(w)), self.balance(SideId::inside(w)));
        let ([a, b], _) = outer.equation(0, [0.0; 2], &response);
        let ([d, c], _) = inner.equation(1, [0.0; 2], &response);
        ([[a, b], [c, d]], 1.0 / determinant(outer, inner, &response))
    }

    /// Solves for the surfaces and airs of zones, without what the surfaces of thick walls add to each other.
    #[inline(always)]
    fn solve_rows<R: Real>(&self, rows: &mut [R]) {
        self.system.zone_fronts.forward_values(rows);
        self.system.coupled.solve_values(rows);
        self.system.zone_fronts.back_values(rows);
    }

    /// Replaces the right-hand sides of all equations (cells, surfaces, airs) by their solution.
    #[inline(always)]
    pub(crate) fn solve_values<R: Real>(&self, rows: &mut [R], block: &mut Vec<R>) {
        let (cells, rest) = rows.split_at_mut(self.model.plan.n_cells);
        let (surfaces, air) = rest.split_at_mut(self.model.plan.surfaces.len());
        block.clear();
        block.resize(self.model.plan.rows(), R::zero());
        for (w, wall) in self.model.plan.walls.iter().enumerate() {
            let heat =
                self.system.walls[w].forward(&mut cells[wall.first_cell..wall.first_cell + wall.len()]);
            for e in 0..2 {
                surfaces[SideId::new(w, e).index()] += heat[e].scale(self.takes(SideId::new(w, e)));
                if let SideRole::Zone { row, .. } = self.model.plan.surfaces[SideId::new(w, e)].role {
                    block[row] += surfaces[SideId::new(w, e).index()];
                }
            }
            match self.system.exterior[w] {
                ExteriorSurfaces::None => {}
                ExteriorSurfaces::One { side, .. } => {
                    let (local, zone) = (SideId::new(w, side), SideId::new(w, 1 - side));
                    surfaces[local.index()] = surfaces[local.index()].scale(self.yields(local));
                    let gain =
                        self.model.coefficients.walls[w].area * self.system.responses[w].other(1 - side);
                    block[self.model.plan.row(zone)] += surfaces[local.index()].scale(gain);
                }
                ExteriorSurfaces::Both(_) => {
                    let ([[a, b], [c, d]], inverse) = self.pair(w);
                    let [f, g] = [
                        surfaces[SideId::outside(w).index()].scale(inverse),
                        surfaces[SideId::inside(w).index()].scale(inverse),
                    ];
                    (surfaces[SideId::outside(w).index()], surfaces[SideId::inside(w).index()]) =
                        (f.scale(d) - g.scale(b), g.scale(a) - f.scale(c));
                }
            }
        }
        for (zone, &air) in self.model.plan.zones.iter().zip(air.iter()) {
            block[zone.air_row] = air;
        }
        self.solve_rows(block);
        self.system.thick_walls.complete_values(block, false, |block| self.solve_rows(block));
        for (zone, air) in self.model.plan.zones.iter().zip(air) {
            *air = block[zone.air_row];
        }
        for (w, wall) in self.model.plan.walls.iter().enumerate() {
            for surface in SideId::pair(w) {
                if let SideRole::Zone { row, .. } = self.model.plan.surfaces[surface].role {
                    surfaces[surface.index()] = block[row];
                }
            }
            if let ExteriorSurfaces::One { side, line } = self.system.exterior[w] {
                let zone = surfaces[SideId::new(w, 1 - side).index()].scale(line.slope);
                surfaces[SideId::new(w, side).index()] += zone;
            }
            let own = &mut cells[wall.first_cell..wall.first_cell + wall.len()];
            self.system.walls[w].back(SideId::pair(w).map(|surface| surfaces[surface.index()]), own);
        }
    }

    /// The transpose of [`Self::solve_rows`].
    fn solve_rows_transposed(&self, rows: &mut [f64]) {
        self.system.zone_fronts.back_transposed(rows);
        self.system.coupled.solve_transposed(rows);
        self.system.zone_fronts.forward_transposed(rows);
    }

    /// Replaces weights on all unknowns by weights on their equations: the transpose of [`Self::solve_values`].
    pub(crate) fn solve_transposed(&self, rows: &mut [f64], block: &mut Vec<f64>) {
        let (cells, rest) = rows.split_at_mut(self.model.plan.n_cells);
        let (surfaces, air) = rest.split_at_mut(self.model.plan.surfaces.len());
        block.clear();
        block.resize(self.model.plan.rows(), 0.0);
        for (w, wall) in self.model.plan.walls.iter().enumerate() {
            let own = &mut cells[wall.first_cell..wall.first_cell + wall.len()];
            let weights = self.system.walls[w].back_transposed(own);
            for e in 0..2 {
                surfaces[SideId::new(w, e).index()] += weights[e];
            }
            match self.system.exterior[w] {
                ExteriorSurfaces::None => {}
                ExteriorSurfaces::One { side, line } => {
                    let local = SideId::new(w, side);
                    surfaces[local.opposite().index()] += line.slope * surfaces[local.index()];
                    surfaces[local.index()] *= self.yields(local);
                }
                ExteriorSurfaces::Both(_) => {
                    let ([[a, b], [c, d]], inverse) = self.pair(w);
                    let [f, g] = [
                        surfaces[SideId::outside(w).index()] * inverse,
                        surfaces[SideId::inside(w).index()] * inverse,
                    ];
                    (surfaces[SideId::outside(w).index()], surfaces[SideId::inside(w).index()]) =
                        (f * d - g * c, g * a - f * b);
                }
            }
            for surface in SideId::pair(w) {
                if let SideRole::Zone { row, .. } = self.model.plan.surfaces[surface].role {
                    block[row] += surfaces[surface.index()];
                }
            }
        }
        for (zone, &air) in self.model.plan.zones.iter().zip(air.iter()) {
            block[zone.air_row] = air;
        }
        self.solve_rows_transposed(block);
        self.system.thick_walls.complete_values(block, true, |block| self.solve_rows_transposed(block));
        for (zone, air) in self.model.plan.zones.iter().zip(air) {
            *air = block[zone.air_row];
        }
        for (w, wall) in self.model.plan.walls.iter().enumerate() {
            for surface in SideId::pair(w) {
                if let SideRole::Zone { row, .. } = self.model.plan.surfaces[surface].role {
                    surfaces[surface.index()] = block[row];
                }
            }
            if let ExteriorSurfaces::One { side, .. } = self.system.exterior[w] {
                let (local, zone) = (SideId::new(w, side), SideId::new(w, 1 - side));
                let gain = self.model.coefficients.walls[w].area * self.system.responses[w].other(1 - side);
                surfaces[local.index()] += self.yields(local) * gain * surfaces[zone.index()];
            }
            let heat = [0, 1].map(|e| self.takes(SideId::new(w, e)) * surfaces[SideId::new(w, e).index()]);
            let own = &mut cells[wall.first_cell..wall.first_cell + wall.len()];
            self.system.walls[w].forward_transposed(heat, own);
        }
    }

    /// Heat that changes of this stage's solution leave stored for the next one: on its equations, in place.
    pub(crate) fn stored_for_next_stage(&self, rows: &mut [f64], ratio: f64) {
        let (cells, rest) = rows.split_at_mut(self.model.plan.n_cells);
        let (surfaces, air) = rest.split_at_mut(self.model.plan.surfaces.len());
        surfaces.fill(0.0);
        for (wall, chain) in self.model.plan.walls.iter().zip(&self.system.walls) {
            for (i, cell) in cells[wall.first_cell..wall.first_cell + wall.len()].iter_mut().enumerate() {
                *cell *= ratio * chain.rate[i] * chain.storage[i].capacity;
            }
        }
        for (air, zone) in air.iter_mut().zip(&self.model.coefficients.zones) {
            *air *= ratio * zone.capacity / self.system.factored_length;
        }
    }
}
