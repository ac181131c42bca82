//! Steps whose solution is known from a run of plain numbers: the parts of a stepper that derivatives use.
//!
//! Nothing is iterated. The laws are linearised at the solution; its slopes follow from those of the equations
//! (`derivatives`).

use crate::balance::terms::{Contents, Stage as StageContents};
use crate::building::ids::SurfaceId;
use crate::input::forcing::Forcing;
use crate::linear::stage_matrix::StageMatrix;
use crate::linear::unknowns::{Unknowns, copy_ranges};
use crate::number::line::Line;
use crate::number::real::{Mask, Real};
use crate::step::halving::Part;
use crate::step::newton::StageSolver;
use crate::step::scheme::Tableau;
use crate::step::stage::Stage;
use crate::step::stage_solutions::Solution;
use crate::step::state::State;
use crate::step::stepper::{INSTANT, Stepper};
use crate::weather::conditions::{Instant, Weather};

/// Position of a stage in its step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StagePlace {
    pub(crate) stage: usize,
    /// Effective length [s].
    pub(crate) length: f64,
    /// A stage starts from `T_n + ratio (T_1 - T_n)`: the start of the step and the solution of its first stage.
    pub(crate) ratio: f64,
}

impl StagePlace {
    /// The stage that brings surfaces into balance: too short for anything to be stored.
    pub(crate) fn instant() -> Self {
        Self { stage: 0, length: INSTANT, ratio: 0.0 }
    }
}

impl<S: Real> Stepper<'_, S> {
    /// Linearises all laws at 0 degC everywhere, in calm air, with schedules of zero.
    pub(crate) fn linearise_at_rest(&mut self) {
        let row = vec![0.0; self.model.plan.n_channels()];
        if let Ok(forcing) = Forcing::new(&row, 1, row.len()) {
            let weather = Weather::for_single_run(self.model.plan, &forcing, 0);
            self.conditions_now(&weather.at(0, 0));
        }
        let (solver, conditions) = (&mut self.solver, &self.weather.conditions);
        solver.linearisation.linearise_surfaces(&self.model, conditions, &solver.iterate, true);
    }

    /// The stages of a step of a length [s].
    pub(crate) fn stage_places(&self, dt: f64) -> impl Iterator<Item = StagePlace> + use<S> {
        let Tableau { diagonal, ratio, weights, .. } = *self.scheme.tableau();
        (0..weights.len()).map(move |stage| StagePlace {
            stage,
            length: diagonal * dt,
            ratio: if stage > 0 { ratio } else { 0.0 },
        })
    }

    /// Begins a step at a state.
    #[inline(always)]
    pub(crate) fn begin_known_step(&mut self, state: &State<S>) {
        self.forget();
        self.solver.start.load.copy_from_slice(&state.load);
        self.solver.linearisation.extrapolate_gaps(0, &state.cells);
    }

    /// The weather of a stage.
    #[inline(always)]
    pub(crate) fn conditions_of_stage(
        &mut self,
        state: &State<S>,
        weather: &Weather<'_>,
        step: usize,
        stage: usize,
    ) {
        let (tableau, part) = (self.scheme.tableau(), Part::whole(step));
        self.weather.set_stage(&self.model, weather, tableau, part, stage);
        self.drive_vents(state);
    }

    /// The weather of an instant.
    #[inline(always)]
    pub(crate) fn conditions_now(&mut self, now: &Instant<'_>) {
        self.weather.set_instant(&self.model, now);
    }

    /// Heat stored when a stage begins; after [`Self::store_first_stage`] in the second one.
    #[inline(always)]
    pub(crate) fn stage_of<'s>(&'s self, state: &'s State<S>, place: StagePlace) -> StageContents<'s, S> {
        let StageSolver { start, solution, .. } = &self.solver;
        StageContents {
            length: place.length,
            ratio: place.ratio,
            start: Contents { cells: &state.cells, enthalpy: &state.enthalpy, air: &state.air },
            first: Contents { cells: &solution.cells, enthalpy: &start.enthalpy, air: &solution.air },
        }
    }

    /// Linearises everything at the solution of a stage.
    #[inline(always)]
    pub(crate) fn linearise_known_stage(
        &mut self,
        state: &State<S>,
        place: StagePlace,
        known: &Unknowns<f64>,
    ) {
        let (model, conditions) = (&self.model, &self.weather.conditions);
        let tableau = self.scheme.tableau();
        let stage =
            Stage { model, conditions, state, tableau, length: place.length, place: (0, place.stage + 1) };
        let StageSolver { linearisation, system, iterate, .. } = &mut self.solver;
        iterate.set(known);
        for &w in &model.parts.nonlinear_walls {
            linearisation.linearise_wall(&stage, w, (iterate, None), &mut system.walls[w]);
        }
        linearisation.set_wind(model, conditions, true);
        linearisation.linearise_surfaces(model, conditions, iterate, true);
    }

    /// The solution of a stage as one list: cells, surfaces, airs [degC]; of cells those of nonlinear walls.
    #[inline(always)]
    pub(crate) fn write_known_solution(&self, known: &Unknowns<f64>, solution: &mut [f64]) {
        let (cells, rest) = solution.split_at_mut(self.model.plan.n_cells);
        let (surfaces, air) = rest.split_at_mut(self.model.plan.surfaces.len());
        surfaces.copy_from_slice(&known.surfaces);
        air.copy_from_slice(&known.air);
        copy_ranges(&self.model.parts.nonlinear_cells, cells, &known.cells);
    }

    /// The temperatures of the cells of some walls of constant properties, which follow from those of their surfaces [degC], and how
    /// fast they have cooled in the stage [K/s]. `matrix` has the factors of the walls.
    #[inline(always)]
    pub(crate) fn write_known_cells(
        &self,
        walls: &[usize],
        (state, place, known): (&State<S>, StagePlace, &Unknowns<f64>),
        matrix: &StageMatrix<'_>,
        [cells, cooling]: [&mut [f64]; 2],
    ) {
        let rate = 1.0 / place.length;
        for &w in walls {
            let (range, chain) = (self.model.cells(w), &matrix.system.walls[w]);
            let (own, cooling) = (&mut cells[range.clone()], &mut cooling[range.clone()]);
            let contents = state.cells[range.clone()].iter().zip(&self.solver.solution.cells[range]);
            let laws = chain.rate.iter().zip(&chain.storage);
            for (((cell, held), (start, first)), (rate, storage)) in
                own.iter_mut().zip(cooling.iter_mut()).zip(contents).zip(laws)
            {
                *held = start.lane(0) + (first.lane(0) - start.lane(0)) * place.ratio;
                *cell = rate * storage.capacity * *held;
            }
            chain.forward(own);
            chain.back(known.surfaces.pair(w), own);
            for (held, &reached) in cooling.iter_mut().zip(&*own) {
                *held = (*held - reached) * rate;
            }
        }
    }

    /// Black emission of some surfaces at a solution [W/m2].
    #[inline(always)]
    pub(crate) fn write_emission(&self, surfaces: &[SurfaceId], known: &Unknowns<f64>, emission: &mut [f64]) {
        let laws = &self.solver.linearisation.laws.surfaces;
        for &surface in surfaces {
            emission[surface.index()] = Line::of(&laws[surface].emission).at(known.surfaces[surface]);
        }
    }

    /// Stores the solution of a stage: `solve` writes it with its derivatives.
    #[inline(always)]
    pub(crate) fn store_solution(&mut self, solve: impl FnOnce([&mut [S]; 3])) {
        let StageSolver { system, solution: Unknowns { cells, surfaces, air }, .. } = &mut self.solver;
        solve([cells, surfaces, air]);
        for &w in &self.model.parts.nonlinear_walls {
            system.walls[w].set_solution(&cells[self.model.cells(w)]);
        }
    }

    /// Enthalpies and liquid fractions at the end of the first stage, for the second.
    #[inline(always)]
    pub(crate) fn store_first_stage(&mut self, state: &State<S>) {
        let StageSolver { start, system, .. } = &mut self.solver;
        for &w in &self.model.parts.nonlinear_walls {
            let (wall, chain) = (&self.model.plan.walls[w], &system.walls[w]);
            for (i, storage) in chain.storage.iter().enumerate() {
                start.enthalpy[wall.first_cell + i] = storage.at_solution();
                start.first_fraction[wall.first_cell + i] = chain.liquid_fraction(i);
            }
        }
        if !self.model.plan.windows.is_empty() {
            self.extrapolate_stage(state);
        }
    }

    /// The last stage becomes the new state.
    #[inline(always)]
    pub(crate) fn end_known_step(&mut self, state: &mut State<S>) {
        self.accept_nonlinear(state);
        let StageSolver { start, solution, .. } = &self.solver;
        state.cells.copy_from_slice(&solution.cells);
        state.surfaces.copy_from_slice(&solution.surfaces);
        state.air.copy_from_slice(&solution.air);
        state.load.copy_from_slice(&start.load);
    }

    /// The surfaces balanced at an instant become those of a state.
    #[inline(always)]
    pub(crate) fn end_known_balance(&mut self, state: &mut State<S>) {
        state.surfaces.copy_from_slice(&self.solver.solution.surfaces);
        self.weather.average_instant(&self.model);
    }

    /// Sets the ideal loads to those of the solution. False where none of them responds to the air.
    #[inline(always)]
    pub(crate) fn set_ideal_loads(
        &mut self,
        weather: &Weather<'_>,
        step: usize,
        solution: Solution<'_>,
    ) -> bool {
        let (last, all) = (self.scheme.weights().len() - 1, S::Mask::splat(true));
        let load = &mut self.solver.start.load;
        self.ideal_loads.begin(&self.model.coefficients.zones, weather.row(step, last), load, false);
        for (load, &known) in load.iter_mut().zip(solution.load) {
            *load = S::constant(known);
        }
        let reached = &solution.stages[last].air;
        self.ideal_loads.mark_needed(load, |zone| S::constant(reached[zone]));
        self.ideal_loads.finds_responses(0, all)
    }

    /// The ideal load of a zone [W].
    #[inline(always)]
    pub(crate) fn ideal_load(&self, zone: usize) -> S {
        self.solver.start.load[zone]
    }

    /// Sets the response of the airs at the end of the step to an ideal load [K/W].
    #[inline(always)]
    pub(crate) fn set_response(&mut self, ideal_load: usize, airs: &[f64]) {
        if let Some(response) = self.ideal_loads.responses[ideal_load].stages.last_mut() {
            for (air, &known) in response.air.iter_mut().zip(airs) {
                *air = S::constant(known);
            }
        }
    }

    /// Corrects the ideal loads, and with them their slopes.
    #[inline(always)]
    pub(crate) fn correct_ideal_loads(&mut self) {
        let StageSolver { start, solution, .. } = &mut self.solver;
        self.ideal_loads.correct(&solution.air, &mut start.load, (0, S::Mask::splat(true), true));
    }
}
