//! One implicit time step: a function (state, weather) -> state, made of stages that Newton's iteration solves.
//!
//! The state changes only when the step is accepted. A step that does not converge, or carries the air of a zone beyond what acts on it,
//! is made in parts.

use crate::balance::energy_balance::{EnergyBalance, Power};
use crate::balance::flow_index::FlowIndex;
use crate::building::coefficients::Coefficients;
use crate::building::model::Model;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::linear::vent_network::VentNetwork;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::step::control::RunControl;
use crate::step::guess::Guess;
use crate::step::halving::{Part, Substeps};
use crate::step::ideal_loads::loads::IdealLoads;
use crate::step::newton::{Counters, Search, StageSolver};
use crate::step::residual::StageResiduals;
use crate::step::scheme::Scheme;
use crate::step::stage::Stage;
use crate::step::stage_histories::StageHistories;
use crate::step::stage_solutions::StageSolutions;
use crate::step::stage_weather::StageWeather;
use crate::step::state::{Initial, State};
use crate::step::vapour::balances::VapourBalances;
use crate::weather::conditions::{Instant, Weather};

/// Effective length of the stage that brings surfaces into balance [s]: too short for anything to be stored, by more than rounding.
pub(super) const INSTANT: ByPrecision = ByPrecision { double: 1e-3, single: 0.1 };

/// Computes the steps of a building one by one.
#[derive(Debug, Clone)]
pub struct Stepper<'a, S: Real> {
    pub(crate) model: Model<'a, S>,
    pub(crate) scheme: Scheme,
    pub(crate) weather: StageWeather<S>,
    pub(crate) flows: FlowIndex<S>,
    pub(crate) solver: StageSolver<'a, S>,
    pub(crate) guess: Guess<S>,
    pub(crate) ideal_loads: IdealLoads<S>,
    pub(crate) parts: Substeps<S>,
    pub(crate) known: StageSolutions<S>,
    /// Present only in a building with vapour balances.
    pub(crate) vapour: Option<Box<VapourBalances<'a, S>>>,
    /// Present only in a building with a pressure network.
    pub(super) vents: Option<Box<VentNetwork<'a, S>>>,
    /// Of phase-change cells, in the present stage.
    pub(super) histories: StageHistories<S>,
    /// Present only where residuals are evaluated.
    pub(super) residuals: Option<Box<StageResiduals<S>>>,
}

impl<'a, S: Real> Stepper<'a, S> {
    /// Prepares a plan with a parameter vector.
    #[must_use]
    pub fn new(plan: &'a Plan, parameters: &'a [S], scheme: Scheme) -> Self {
        let (model, tableau) = (Model::new(plan, Coefficients::new(plan, parameters)), scheme.tableau());
        let solver = StageSolver::new(&model, tableau);
        let weather = StageWeather::new(&model);
        Self {
            flows: FlowIndex::new(plan, &model.coefficients, &weather.index),
            weather,
            ideal_loads: IdealLoads::new(&model, &solver.solution, tableau),
            solver,
            guess: Guess::none(),
            vapour: VapourBalances::new(&model, tableau.weights.len()).map(Box::new),
            vents: plan.vents.as_ref().map(|network| Box::new(VentNetwork::new(network))),
            parts: Substeps::new(plan.zones.len()),
            known: StageSolutions::nothing(),
            residuals: None,
            histories: StageHistories::new(&model),
            model,
            scheme,
        }
    }

    /// The state that a run starts from, in the weather of a forcing row.
    pub fn begin(&self, initial: &Initial, row: &[f64]) -> State<S> {
        State::new(&self.model, initial, row)
    }

    /// Keeps the factors of walls of several stage lengths: for steps of unequal length.
    pub(crate) fn keep_factors(&mut self) {
        self.solver.system.factors.keep();
    }

    /// Lets the caller stop it, also within a step.
    pub(crate) fn set_control(&mut self, control: &'a RunControl) {
        self.solver.control = Some(control);
    }

    /// Counts of iterations, nested iterations and halvings since the start.
    pub fn counters(&self) -> Counters<S> {
        self.solver.counters
    }

    /// Evaluates the residuals of all stages from now on, see [`Counters::largest_residual`].
    pub(crate) fn evaluate_residuals(&mut self) {
        self.residuals = Some(Box::default());
        self.solver.counters.largest_residual = Some(S::zero());
    }

    /// Lanes whose iteration failed: their numbers have no meaning.
    pub fn failed(&self) -> S::Mask {
        self.solver.failed
    }

    /// Marks lanes as failed.
    pub(crate) fn mark_failed(&mut self, lanes: S::Mask) {
        self.solver.failed = self.solver.failed | lanes;
    }

    /// The next step does not continue the last one: its guess starts anew.
    pub fn forget(&mut self) {
        self.guess.forget();
    }

    /// Brings the surfaces of a state into balance with the weather: a stage so short that nothing is stored. Airs that hold more vapour than
    /// they can in this weather lose it.
    ///
    /// # Errors
    /// [`EngineError::NotConverged`].
    pub fn balance_surfaces(&mut self, state: &mut State<S>, now: &Instant<'_>) -> Result<(), EngineError> {
        self.known.begin();
        S::vectorised(
            #[inline(always)]
            || {
                self.weather.set_instant(&self.model, now, &state.air);
                self.control_vents(state, now.row, 0.0);
                self.drive_vents(state);
                self.begin_step(state, 0.0, 0.0);
                self.solve_stage(state, INSTANT.of::<S>(), (0, 0), Search::Whole(S::Mask::splat(true)))?;
                state.surfaces.copy_from_slice(&self.solver.solution.surfaces);
                if let Some(humidity) = &self.weather.conditions.humidity {
                    state.condense(humidity.pressure);
                }
                self.known.accept(Part::whole(0), state);
                self.weather.average_instant(&self.model);
                self.begin_vapour();
                Ok(())
            },
        )
    }

    /// One step of length `dt` [s].
    ///
    /// # Errors
    /// [`EngineError::NotConverged`].
    pub fn step(
        &mut self,
        state: &mut State<S>,
        weather: &Weather<'_>,
        step: usize,
        dt: f64,
        energy_balance: &mut EnergyBalance<S>,
    ) -> Result<(), EngineError> {
        self.parts.begin(step);
        self.control_vents(state, weather.row(step, 0), dt);
        self.take_parts(state, weather, dt, energy_balance)
    }

    /// The first step of a run that starts from one temperature everywhere: in parts that grow, see [`Substeps::begin_first`].
    ///
    /// # Errors
    /// [`EngineError::NotConverged`].
    pub(crate) fn first_step(
        &mut self,
        state: &mut State<S>,
        weather: &Weather<'_>,
        dt: f64,
        energy_balance: &mut EnergyBalance<S>,
    ) -> Result<(), EngineError> {
        self.parts.begin_first();
        self.control_vents(state, weather.row(0, 0), dt);
        self.take_parts(state, weather, dt, energy_balance)
    }

    /// A part of a step of length `dt` [s] alone, in the weather of the step. Its loads are means over the part.
    ///
    /// # Errors
    /// [`EngineError::NotConverged`].
    pub(crate) fn part_of_step(
        &mut self,
        state: &mut State<S>,
        weather: &Weather<'_>,
        part: Part,
        dt: f64,
        energy_balance: &mut EnergyBalance<S>,
    ) -> Result<(), EngineError> {
        self.parts.begin_part(part);
        self.control_vents(state, weather.row(part.step, 0), part.share * dt);
        self.take_parts(state, weather, dt, energy_balance)?;
        for load in &mut state.load {
            *load = load.scale(1.0 / part.share);
        }
        Ok(())
    }

    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    fn take_parts(
        &mut self,
        state: &mut State<S>,
        weather: &Weather<'_>,
        dt: f64,
        energy_balance: &mut EnergyBalance<S>,
    ) -> Result<(), EngineError> {
        self.parts.count_from(self.solver.counters.iterations);
        self.known.begin();
        self.begin_vapour();
        S::vectorised(
            #[inline(always)]
            || {
                while let Some(part) = self.parts.next() {
                    match self.attempt(state, weather, part, dt, energy_balance) {
                        Ok(true) if part.halvings == 0 => {}
                        // Parts differ in length: no part is guessed from the one before it.
                        Ok(true) => {
                            self.parts.average(part, &mut state.load);
                            self.forget();
                        }
                        Ok(false) => self.divide(part),
                        Err(error) => self.halve(part, error)?,
                    }
                }
                Ok(())
            },
        )
    }

    /// Replaces a part that could not be solved by its two halves. With lanes this is an error: members that fail are run alone.
    // One copy only: inlining multiplies compile time.
    #[cold]
    #[inline(never)]
    fn halve(&mut self, part: Part, error: EngineError) -> Result<(), EngineError> {
        if S::LANES > 1 || self.limit_reached() {
            self.parts.clear();
            return Err(error);
        }
        self.parts.halve(part, error)?;
        self.solver.counters.halvings += 1;
        self.forget();
        Ok(())
    }

    /// Replaces a part that has carried an air beyond its causes by its two halves.
    #[cold]
    fn divide(&mut self, part: Part) {
        self.parts.divide(part);
        self.solver.counters.halvings += 1;
        self.forget();
    }

    /// Whether the step has taken more iterations than it may.
    #[inline(always)]
    pub(super) fn limit_reached(&self) -> bool {
        self.parts.limit_reached(self.solver.counters.iterations)
    }

    /// A part of a step; the state stays as it was when it fails, and where it has to be divided: false.
    #[inline(always)]
    fn attempt(
        &mut self,
        state: &mut State<S>,
        weather: &Weather<'_>,
        part: Part,
        dt: f64,
        energy_balance: &mut EnergyBalance<S>,
    ) -> Result<bool, EngineError> {
        let (length, tableau) = (part.share * dt, self.scheme.tableau());
        self.begin_step(state, tableau.nodes[0], length);
        let with_loads = !self.model.plan.ideal_loads.is_empty();
        if with_loads {
            self.guess_loads(state, weather.row(part.step, tableau.weights.len() - 1), length);
        }
        self.guess.remember(&self.model, state, length);
        let energy = if with_loads {
            self.step_with_loads(state, weather, part, length)?
        } else {
            self.step_without_loads(state, weather, part, length)?
        };
        if self.overshoots(state, weather, part) {
            return Ok(false);
        }
        self.accept(state, &energy, length, energy_balance);
        self.advance_vapour(state, length, energy_balance);
        self.known.accept(part, state);
        Ok(true)
    }

    /// The stages of a step without ideal loads, one after the other.
    #[inline(always)]
    fn step_without_loads(
        &mut self,
        state: &State<S>,
        weather: &Weather<'_>,
        part: Part,
        length: f64,
    ) -> Result<Power<S>, EngineError> {
        let tableau = self.scheme.tableau();
        let mut energy = Power::none();
        for (stage, &weight) in tableau.weights.iter().enumerate() {
            if stage > 0 {
                self.begin_second_stage(state);
            }
            self.weather.set_stage(&self.model, weather, tableau, (part, stage), &state.air);
            self.drive_vents(state);
            let all = Search::Whole(S::Mask::splat(true));
            self.solve_stage(state, tableau.diagonal * length, (part.step, stage + 1), all)?;
            self.note_vapour(stage);
            self.add_heat(weight * length, &mut energy);
        }
        Ok(energy)
    }

    /// Starts a step of a length [s] from a state; the stage at a node of the step is guessed from the step before.
    #[inline(always)]
    fn begin_step(&mut self, state: &State<S>, node: f64, length: f64) {
        self.histories.begin(&self.model, state, self.scheme.tableau(), length);
        let Self { model, solver, .. } = self;
        solver.start.begin(model, state);
        solver.start.load.copy_from_slice(&state.load);
        solver.start.holding.clear();
        solver.system.transition_matrices.begin();
        self.known.restart();
        self.guess.first(model, state, (node, length), &mut solver.iterate);
        solver.linearisation.extrapolate_gaps(0, &state.cells);
    }

    /// What the second stage starts from; its end is guessed on a straight line.
    #[inline(always)]
    pub(super) fn begin_second_stage(&mut self, state: &State<S>) {
        let tableau = self.scheme.tableau();
        let Self { model, solver, histories, .. } = self;
        let StageSolver { system, start, solution, .. } = solver;
        histories.begin_second(model, state, tableau, &solution.cells);
        system.transition_matrices.set_first_surfaces(&solution.surfaces);
        start.begin_second_stage(model, state, tableau.ratio, (&system.walls, solution));
        self.extrapolate_stage(state);
    }

    /// Guesses the end of a step on the straight line through its start and the first stage, and the convection in gaps
    /// there.
    #[inline(always)]
    pub(super) fn extrapolate_stage(&mut self, state: &State<S>) {
        let StageSolver { linearisation, iterate, solution, .. } = &mut self.solver;
        let known = [state.view(), solution.view()];
        iterate.extrapolate(&self.model, &known, 1.0 / self.scheme.tableau().diagonal, &state.memory);
        linearisation.extrapolate_gaps(1, &iterate.cells);
    }

    /// Solves a stage in the weather that is set.
    #[inline(always)]
    fn solve_stage(
        &mut self,
        state: &State<S>,
        length: f64,
        place: (usize, usize),
        search: Search<S>,
    ) -> Result<S::Mask, EngineError> {
        let (model, conditions) = (&self.model, &self.weather.conditions);
        let tableau = self.scheme.tableau();
        let histories = self.histories.within(state);
        let stage = Stage { model, conditions, state, histories, tableau, length, place };
        let sound = self.solver.solve(&stage, search)?;
        self.known.keep(&self.solver.solution);
        if self.residuals.is_some() && place.1 > 0 {
            self.record_residual(state, length, place.1 - 1);
        }
        Ok(sound)
    }
}
