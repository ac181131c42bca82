//! Steps along solutions that are known: how numbers with derivatives go beside a plain run.
//!
//! At a known solution nothing is to be iterated and nothing to be eliminated with derivatives: the equations of a stage
//! are gathered term by term, the laws in them linearised at the solution as ever, and a plain twin of the stepper, which
//! takes over the values of that linearisation, solves for all slopes (see [`crate::number::real::Equations`]).

use crate::building::coefficients::Boundary;
use crate::building::ids::SurfaceId;
use crate::building::model::outdoor_emission;
use crate::building::plan::SurfaceRole;
use crate::linear::stage_matrix::StageMatrix;
use crate::linear::unknowns::Unknowns;
use crate::number::line::Line;
use crate::number::real::{Equations, Mask, Real};
use crate::physics::longwave::Emission;
use crate::step::following::Following;
use crate::step::halving::Part;
use crate::step::newton::StageSolver;
use crate::step::scheme::Tableau;
use crate::step::stage::Stage;
use crate::step::stage_solutions::Solution;
use crate::step::state::State;
use crate::step::stepper::{INSTANT, Stepper};
use crate::weather::conditions::{Instant, Weather};

/// Where in the stages of a step a stage stands.
#[derive(Debug, Clone, Copy)]
struct Place {
    stage: usize,
    /// Effective length [s].
    length: f64,
    /// Share of the way from the start of the step to the solution of the first stage that this one starts from.
    ratio: f64,
}

impl<S: Real> Stepper<'_, S> {
    /// One step of length `dt` [s] along its solution.
    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    pub(crate) fn follow_step(
        &mut self,
        state: &mut State<S>,
        weather: &Weather<'_>,
        step: usize,
        dt: f64,
        solution: Solution<'_>,
    ) {
        S::vectorised(
            #[inline(always)]
            || {
                self.set_off(state);
                let asked =
                    !self.model.plan.ideal_loads.is_empty() && self.ask_ideal_loads(weather, step, solution);
                // Responses leave out what a load does to the convection expected in gaps: with windows its slope is
                // found in a round more.
                let rounds = if !asked {
                    0
                } else if self.model.plan.windows.is_empty() {
                    1
                } else {
                    2
                };
                for round in 0..=rounds {
                    self.follow_stages(state, weather, (step, dt), solution);
                    if round < rounds {
                        self.answer();
                        self.ideal_loads.correct(
                            &self.solver.solution.air,
                            &mut self.solver.start.load,
                            S::Mask::splat(true),
                            true,
                        );
                    }
                }
                self.arrive(state);
            },
        );
    }

    /// Brings the surfaces of a state into balance with the weather along the solution.
    pub(crate) fn follow_balance(&mut self, state: &mut State<S>, now: &Instant<'_>, solution: Solution<'_>) {
        S::vectorised(
            #[inline(always)]
            || {
                self.set_off(state);
                self.weather.set_instant(&self.model, now);
                let place = Place { stage: 0, length: INSTANT, ratio: 0.0 };
                self.follow_stage(state, place, &solution.stages[0]);
                state.surfaces.copy_from_slice(&self.solver.solution.surfaces);
                self.weather.average_instant();
            },
        );
    }

    /// Weights on the equations of a stage from weights on its solution, in place.
    pub(crate) fn pull_stage(&mut self, stage: usize, weights: &mut [f64]) {
        if let Some(following) = &mut self.following {
            following.matrices[stage].solve_transposed(weights, &mut following.block);
        }
    }

    #[inline(always)]
    fn set_off(&mut self, state: &State<S>) {
        self.forget();
        self.solver.start.load.copy_from_slice(&state.load);
        self.solver.linearisation.expect_gaps(&self.model, 0, &state.cells);
    }

    #[inline(always)]
    fn follow_stages(
        &mut self,
        state: &State<S>,
        weather: &Weather<'_>,
        (step, dt): (usize, f64),
        solution: Solution<'_>,
    ) {
        let Tableau { diagonal, ratio, .. } = *self.scheme.tableau();
        let part = Part::whole(step);
        for (stage, known) in solution.stages.iter().enumerate() {
            if stage > 0 {
                self.carry(state);
            }
            self.weather.set_stage(&self.model, weather, self.scheme.tableau(), part, stage);
            let ratio = if stage > 0 { ratio } else { 0.0 };
            self.follow_stage(state, Place { stage, length: diagonal * dt, ratio }, known);
        }
    }

    /// One stage: its equations at the solution, gathered and solved.
    #[inline(always)]
    fn follow_stage(&mut self, state: &State<S>, place: Place, known: &Unknowns<f64>) {
        let Some(mut following) = self.following.take() else { return };
        self.solver.iterate.set(known);
        let matrix = &mut following.matrices[place.stage];
        let new = matrix.factor_linear_walls(place.length);
        self.locate(state, place, known, matrix, &mut following.at);
        self.linearise_at(state, place);
        let (laws, walls) = (&self.solver.linearisation.laws, &self.solver.system.walls);
        matrix.factor((laws, walls, &self.weather.conditions.paths), place.length, new);
        following.equations.begin(following.at.len());
        self.gather_walls(state, place, &mut following);
        self.gather_zones(state, place, &mut following);
        let Following { equations, matrices, at, .. } = &mut *following;
        let Unknowns { cells, surfaces, air } = &mut self.solver.solution;
        equations.solve(place.stage, &matrices[place.stage], at, [cells, surfaces, air]);
        for &w in &self.model.parts.nonlinear_walls {
            let wall = &self.model.plan.walls[w];
            self.solver.system.walls[w]
                .arrive(&self.solver.solution.cells[wall.first_cell..wall.first_cell + wall.len()]);
        }
        self.following = Some(following);
    }

    /// The known solution: as it stands, but cells of constant walls follow from the rest.
    #[inline(always)]
    fn locate(
        &self,
        state: &State<S>,
        place: Place,
        known: &Unknowns<f64>,
        matrix: &StageMatrix<'_>,
        at: &mut [f64],
    ) {
        let (cells, rest) = at.split_at_mut(self.model.plan.n_cells);
        let (surfaces, air) = rest.split_at_mut(self.model.plan.surfaces.len());
        surfaces.copy_from_slice(&known.surfaces);
        air.copy_from_slice(&known.air);
        cells.copy_from_slice(&known.cells);
        for &w in &self.model.parts.linear_walls {
            let (wall, chain) = (&self.model.plan.walls[w], &matrix.system.walls[w]);
            let own = &mut cells[wall.first_cell..wall.first_cell + wall.len()];
            for (i, cell) in own.iter_mut().enumerate() {
                let k = wall.first_cell + i;
                let start = state.cells[k].lane(0);
                let held = start + (self.solver.solution.cells[k].lane(0) - start) * place.ratio;
                *cell = chain.rate[i] * chain.storage[i].capacity * held;
            }
            chain.forward(own);
            chain.back(known.surfaces.pair(w), own);
        }
    }

    /// Linearises everything at the iterate.
    #[inline(always)]
    fn linearise_at(&mut self, state: &State<S>, place: Place) {
        let (model, conditions) = (&self.model, &self.weather.conditions);
        let stage = Stage {
            model,
            conditions,
            state,
            storage: self.scheme.tableau().storage,
            length: place.length,
            place: (0, place.stage + 1),
        };
        let StageSolver { linearisation, system, iterate, .. } = &mut self.solver;
        for &w in &model.parts.nonlinear_walls {
            linearisation.linearise_wall(&stage, w, (iterate, None), &mut system.walls[w]);
        }
        linearisation.set_wind(model, conditions, true);
        linearisation.linearise_surfaces(model, conditions, iterate, true);
    }

    /// Cells of all walls: heat held and heat that flows between them and into the surfaces.
    #[inline(always)]
    fn gather_walls(&self, state: &State<S>, place: Place, following: &mut Following<'_, S>) {
        let Following { equations, capacity, at, matrices, carries, .. } = following;
        let matrix = &matrices[place.stage];
        let per_second = 1.0 / place.length;
        for (w, wall) in self.model.plan.walls.iter().enumerate() {
            let (chain, first, n) = (&self.solver.system.walls[w], wall.first_cell, wall.len());
            let surfaces = SurfaceId::pair(w).map(|surface| self.model.plan.n_cells + surface.index());
            let shares = SurfaceId::pair(w).map(|surface| matrix.takes(surface));
            if wall.nonlinear {
                self.gather_storage(state, place, w, (&mut *equations, at));
            } else {
                for k in first..first + n {
                    let (start, heat) = (state.cells[k], capacity[k].lane(0) * per_second);
                    let mut held = start.lane(0);
                    equations.add(k, start, heat * (1.0 - place.ratio));
                    if place.stage > 0 {
                        equations.add(k, self.solver.solution.cells[k], heat * place.ratio);
                        held += (self.solver.solution.cells[k].lane(0) - held) * place.ratio;
                    }
                    if carries.capacity[w] {
                        equations.add(k, capacity[k], (held - at[k]) * per_second);
                    }
                }
            }
            for (j, link) in chain.links.iter().enumerate() {
                let above = |i: usize| at[first + i] - chain.storage[i].place.lane(0);
                let (outer, left, gives) = if j == 0 {
                    (surfaces[0], at[surfaces[0]], shares[0])
                } else {
                    (first + j - 1, above(j - 1), 1.0)
                };
                let (inner, right, takes) = if j == n {
                    (surfaces[1], at[surfaces[1]], shares[1])
                } else {
                    (first + j, above(j), 1.0)
                };
                if wall.nonlinear {
                    for (row, share) in [(outer, -gives), (inner, takes)] {
                        equations.add(row, link.offset, share);
                        equations.add(row, link.left, share * left);
                        equations.add(row, link.right, -share * right);
                    }
                } else if carries.links[w] {
                    let conductance = link.left;
                    equations.add(outer, conductance, -gives * (left - right));
                    equations.add(inner, conductance, takes * (left - right));
                }
            }
            let ends = [(0, -1.0), (n, 1.0)].map(|(j, sign)| {
                let link = &chain.links[j];
                let left = if j == 0 {
                    at[surfaces[0]]
                } else {
                    at[first + j - 1] - chain.storage[j - 1].place.lane(0)
                };
                let right =
                    if j == n { at[surfaces[1]] } else { at[first + j] - chain.storage[j].place.lane(0) };
                sign * (link.offset.lane(0) + link.left.lane(0) * left - link.right.lane(0) * right)
            });
            for (e, heat) in ends.into_iter().enumerate() {
                match self.model.plan.surfaces[SurfaceId::new(w, e)].role {
                    // What enters by its area beside the heat from the wall is added with the zone.
                    SurfaceRole::Zone { .. } => {
                        equations.add(surfaces[e], self.model.coefficients.walls[w].area, heat);
                    }
                    SurfaceRole::Exterior => {
                        self.gather_local(
                            SurfaceId::new(w, e),
                            at[surfaces[e]],
                            (&mut *equations, surfaces[e]),
                        );
                    }
                }
            }
        }
    }

    /// What the cells of a wall that changes hold, and the sun in its panes.
    #[inline(always)]
    fn gather_storage(
        &self,
        state: &State<S>,
        place: Place,
        w: usize,
        (equations, at): (&mut S::Equations, &[f64]),
    ) {
        let (wall, chain, numbers) =
            (&self.model.plan.walls[w], &self.solver.system.walls[w], &self.model.coefficients.walls[w]);
        for (i, (storage, cell)) in chain.storage.iter().zip(&numbers.cells).enumerate() {
            let k = wall.first_cell + i;
            let rate = cell.thickness.lane(0) / place.length;
            let above = at[k] - storage.place.lane(0);
            let mut held = state.enthalpy[k].lane(0);
            equations.add(k, state.enthalpy[k], rate * (1.0 - place.ratio));
            if place.stage > 0 {
                equations.add(k, self.solver.start.enthalpy[k], rate * place.ratio);
                held += (self.solver.start.enthalpy[k].lane(0) - held) * place.ratio;
            }
            equations.add(k, storage.offset, -rate);
            equations.add(k, storage.capacity, -rate * above);
            let reached = storage.offset.lane(0) + storage.capacity.lane(0) * above;
            equations.add(k, cell.thickness, (held - reached) / place.length);
        }
        let gains = self
            .model
            .plan
            .windows
            .iter()
            .zip(&self.weather.conditions.sun.windows)
            .find(|(window, _)| **window == w);
        for (i, &gain) in gains.iter().flat_map(|(_, at)| &at.cells).enumerate() {
            equations.add(wall.first_cell + i, gain, 1.0);
        }
    }

    /// What a surface outside the zones takes from there.
    #[inline(always)]
    fn gather_local(&self, index: SurfaceId, at: f64, (equations, row): (&mut S::Equations, usize)) {
        let surface = &self.model.coefficients.surfaces[index];
        let (conditions, laws) =
            (&self.weather.conditions.surfaces[index], &self.solver.linearisation.laws.surfaces[index]);
        match surface.boundary {
            Boundary::Imposed(_) if surface.convection.is_none() => {
                equations.add(row, conditions.temperature, 1.0);
            }
            Boundary::Adiabatic => equations.add(row, conditions.solar, 1.0),
            _ => {
                equations.add(row, conditions.solar, 1.0);
                equations.add(row, conditions.longwave, 1.0);
                equations.add(row, laws.convection.offset, -1.0);
                equations.add(row, laws.convection.slope, conditions.temperature.lane(0) - at);
                equations.add(row, conditions.temperature, laws.convection.slope.lane(0));
                if outdoor_emission(surface).is_some() {
                    let (emissivity, emission) = (surface.emissivity, Line::of(&laws.emission));
                    equations.add(row, emissivity, -emission.at(at));
                    equations.add(row, laws.emission.offset, -emissivity.lane(0));
                    equations.add(row, laws.emission.slope, -emissivity.lane(0) * at);
                }
            }
        }
    }

    /// Surfaces and airs of the zones.
    #[inline(always)]
    fn gather_zones(&self, state: &State<S>, place: Place, following: &mut Following<'_, S>) {
        let Following { equations, at, carries, .. } = following;
        let first_air = self.model.plan.n_cells + self.model.plan.surfaces.len();
        for (z, (zone, numbers)) in
            self.model.plan.zones.iter().zip(&self.model.coefficients.zones).enumerate()
        {
            let (row, conditions) = (first_air + z, &self.weather.conditions.zones[z]);
            let air = at[row];
            for (i, &index) in zone.surfaces.iter().enumerate() {
                let (surface, convection) = (
                    self.model.plan.n_cells + index.index(),
                    &self.solver.linearisation.laws.surfaces[index].convection,
                );
                let (area, above, solar) = (
                    numbers.areas[i].lane(0),
                    at[self.model.plan.n_cells + index.index()] - air,
                    self.weather.conditions.surfaces[index].solar,
                );
                for (row, area) in [(surface, -area), (row, area)] {
                    equations.add(row, convection.offset, area);
                    equations.add(row, convection.slope, area * above);
                }
                let flux = Line::of(convection).at(above);
                equations.add(row, numbers.areas[i], flux);
                equations.add(surface, numbers.areas[i], solar.lane(0) - flux);
                equations.add(surface, solar, area);
                equations.add(surface, conditions.radiant, numbers.radiant_shares[i].lane(0));
                equations.add(surface, numbers.radiant_shares[i], conditions.radiant.lane(0));
            }
            self.gather_exchange(z, carries.exchange[z], (&mut *equations, at));
            let held = if place.stage > 0 {
                equations.add(
                    row,
                    self.solver.solution.air[z],
                    numbers.capacity.lane(0) / place.length * place.ratio,
                );
                state.air[z].lane(0)
                    + (self.solver.solution.air[z].lane(0) - state.air[z].lane(0)) * place.ratio
            } else {
                state.air[z].lane(0)
            };
            equations.add(row, state.air[z], numbers.capacity.lane(0) / place.length * (1.0 - place.ratio));
            equations.add(row, numbers.capacity, (held - air) / place.length);
            let below = self.weather.conditions.outdoor_air.lane(0) - air;
            for entering in [
                &self.solver.linearisation.laws.infiltration[z],
                &self.solver.linearisation.laws.ventilation[z],
            ] {
                equations.add(row, entering.offset, 1.0);
                equations.add(row, entering.slope, below);
            }
            equations.add(row, conditions.convective, 1.0);
            equations.add(row, self.solver.start.load[z], 1.0);
        }
        for (path, &conductance) in self.model.coefficients.paths.iter().zip(&self.weather.conditions.paths) {
            let [a, b] = path.between.map(|zone| first_air + zone);
            equations.add(a, conductance, at[b] - at[a]);
            equations.add(b, conductance, at[a] - at[b]);
        }
    }

    /// Long-wave exchange between the surfaces of a zone.
    #[inline(always)]
    fn gather_exchange(&self, z: usize, carries: bool, (equations, at): (&mut S::Equations, &[f64])) {
        let (surfaces, numbers) = (&self.model.plan.zones[z].surfaces, &self.model.coefficients.zones[z]);
        if numbers.exchange.is_empty() {
            return;
        }
        let n = surfaces.len();
        let linear = self.solver.linearisation.laws.surfaces[surfaces[0]].emission.slope.carries()
            && !matches!(numbers.emission, Emission::Exact);
        if !carries && !linear {
            return;
        }
        for (i, &index) in surfaces.iter().enumerate() {
            let row = self.model.plan.n_cells + index.index();
            let emission = |surface: SurfaceId| {
                Line::of(&self.solver.linearisation.laws.surfaces[surface].emission)
                    .at(at[self.model.plan.n_cells + surface.index()])
            };
            let own = emission(index);
            let mut by_slope = 0.0;
            for (&other, &exchange) in surfaces.iter().zip(&numbers.exchange[i * n..(i + 1) * n]) {
                if other != index {
                    // All that a surface sends out comes back to it from the others, as far as they are alike.
                    equations.add(row, exchange, emission(other) - own);
                    by_slope += exchange.lane(0) * (at[self.model.plan.n_cells + other.index()] - at[row]);
                }
            }
            // The slope of a straight law is a number of the building; an exact one depends on the solution alone.
            if linear {
                equations.add(row, self.solver.linearisation.laws.surfaces[index].emission.slope, by_slope);
            }
        }
    }

    /// What the first stage leaves to the second.
    #[inline(always)]
    fn carry(&mut self, state: &State<S>) {
        for &w in &self.model.parts.nonlinear_walls {
            let (wall, chain) = (&self.model.plan.walls[w], &self.solver.system.walls[w]);
            for (i, storage) in chain.storage.iter().enumerate() {
                self.solver.start.enthalpy[wall.first_cell + i] = storage.reached();
                self.solver.start.first_fraction[wall.first_cell + i] = chain.liquid_fraction(i);
            }
        }
        if !self.model.plan.windows.is_empty() {
            self.extrapolate_stage(state);
        }
    }

    /// Takes the last stage as the new state.
    #[inline(always)]
    fn arrive(&mut self, state: &mut State<S>) {
        self.accept_nonlinear(state);
        state.cells.copy_from_slice(&self.solver.solution.cells);
        state.surfaces.copy_from_slice(&self.solver.solution.surfaces);
        state.air.copy_from_slice(&self.solver.solution.air);
        state.load.copy_from_slice(&self.solver.start.load);
    }

    /// Sets the loads of plants to those of the solution. False where none is asked for any.
    #[inline(always)]
    fn ask_ideal_loads(&mut self, weather: &Weather<'_>, step: usize, solution: Solution<'_>) -> bool {
        let (last, all) = (self.scheme.weights().len() - 1, S::Mask::splat(true));
        self.ideal_loads.begin(
            &self.model.coefficients.zones,
            weather.row(step, last),
            &mut self.solver.start.load,
            false,
        );
        for (load, &known) in self.solver.start.load.iter_mut().zip(solution.load) {
            *load = S::constant(known);
        }
        let reached = &solution.stages[last].air;
        self.ideal_loads.ask(&self.solver.start.load, |zone| S::constant(reached[zone]));
        self.ideal_loads.answering(0, all)
    }

    /// How the airs at the end of the step answer to a watt of each plant, with the factors of the matrices.
    #[inline(always)]
    fn answer(&mut self) {
        let Some(mut following) = self.following.take() else { return };
        let ratio = self.scheme.tableau().ratio;
        let first_air = self.model.plan.n_cells + self.model.plan.surfaces.len();
        let Following { matrices, answers, block, .. } = &mut *following;
        for (p, (&zone, rows)) in self.model.plan.ideal_loads.iter().zip(answers).enumerate() {
            rows.fill(0.0);
            for (stage, matrix) in matrices.iter().enumerate() {
                if stage > 0 {
                    matrix.hand_on(rows, ratio);
                }
                rows[first_air + zone] += 1.0;
                matrix.solve_beside(rows, block);
            }
            if let Some(answer) = self.ideal_loads.responses[p].stages.last_mut() {
                for (air, &row) in answer.air.iter_mut().zip(&rows[first_air..]) {
                    *air = S::constant(row);
                }
            }
        }
        self.following = Some(following);
    }
}
