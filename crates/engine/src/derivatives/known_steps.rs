//! Steps of numbers with derivatives, where the solution of the step is known from a plain run.
//!
//! Only the slopes of the equations of a stage are differentiated ([`super::equation_slopes`]). The slopes of the solution
//! follow from them by one solve with the plain matrix of the stage (implicit function theorem: Griewank & Walther (2008),
//! ch. 15, doi:10.1137/1.9780898717761). Nothing is iterated, and no elimination is computed with derivatives.

use crate::balance::ledger::Ledger;
use crate::balance::terms::Balances;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::linear::stage_matrix::StageMatrix;
use crate::linear::unknowns::Unknowns;
use crate::number::real::{Equations, Real};
use crate::number::tape::{Taped, add_steady_weights};
use crate::run::Action;
use crate::step::known_solution::StagePlace;
use crate::step::stage_solutions::Solution;
use crate::step::state::State;
use crate::step::{Scheme, Stepper};
use crate::weather::conditions::{Instant, Weather};

use super::equation_slopes::{Carries, EquationSlopes};
use super::steady_terms::{KnownValues, Parts, SteadyTerms};

/// A stepper whose numbers have derivatives, and the plain matrices at the known solutions.
#[derive(Debug, Clone)]
pub(super) struct DerivativeStepper<'a, S: Real> {
    pub(super) stepper: Stepper<'a, S>,
    /// Matrices of the stages at their solutions, in plain numbers.
    matrices: Vec<StageMatrix<'a>>,
    equations: S::Equations,
    carries: Carries,
    steady: SteadyTerms<S>,
    /// What is known of each stage.
    known: Vec<KnownValues>,
    /// Responses of all unknowns to each ideal load [K/W].
    responses: Vec<Vec<f64>>,
    scratch: Vec<f64>,
}

impl<'a, S: Real> DerivativeStepper<'a, S> {
    pub(super) fn new(plan: &'a Plan, numbers: &'a [S], scheme: Scheme) -> Self {
        let stepper = Stepper::new(plan, numbers, scheme);
        let plain: Vec<f64> = numbers.iter().map(|number| number.lane(0)).collect();
        let matrix = StageMatrix::new(plan, &plain, scheme.tableau().diagonal);
        let unknowns = plan.n_cells + plan.surfaces.len() + plan.zones.len();
        let known = KnownValues::new(&stepper.model);
        let steady = SteadyTerms::find(&stepper, &known);
        Self {
            matrices: vec![matrix; scheme.weights().len()],
            equations: S::Equations::default(),
            carries: Carries::new(&stepper.model),
            steady,
            known: vec![known; scheme.weights().len()],
            responses: vec![vec![0.0; unknowns]; plan.ideal_loads.len()],
            scratch: Vec::new(),
            stepper,
        }
    }

    /// Takes an action whose solution is known; without one, by the iteration itself.
    pub(super) fn take(
        &mut self,
        action: Action,
        state: &mut State<S>,
        weather: &Weather<'_>,
        dt: f64,
        solution: Option<Solution<'_>>,
    ) -> Result<(), EngineError> {
        let Some(solution) = solution else {
            return action.take(&mut self.stepper, state, weather, dt, &mut Ledger::new());
        };
        match action {
            Action::BeginPeriod => {}
            Action::WarmUp(step) | Action::Step(step) => self.step(state, weather, step, dt, solution),
            // Made in parts, whose solutions are not kept.
            Action::FirstStep => {
                return action.take(&mut self.stepper, state, weather, dt, &mut Ledger::new());
            }
            Action::Balance => self.balance_surfaces(state, &weather.at(0, 0), solution),
        }
        Ok(())
    }

    /// One step of length `dt` [s].
    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    fn step(
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
                self.stepper.control_vents(state, weather.row(step, 0), dt);
                self.stepper.begin_known_step(state);
                let plan = self.stepper.model.plan;
                let controlled =
                    !plan.ideal_loads.is_empty() && self.stepper.set_ideal_loads(weather, step, solution);
                // Responses do not contain the effect of a load on the convection extrapolated in gaps: with windows a second
                // round adds its slope.
                let rounds = match (controlled, plan.windows.is_empty()) {
                    (false, _) => 0,
                    (true, true) => 1,
                    (true, false) => 2,
                };
                for round in 0..=rounds {
                    for (place, known) in self.stepper.stage_places(dt).zip(solution.stages) {
                        if place.stage > 0 {
                            self.stepper.store_first_stage(state);
                        }
                        self.stepper.conditions_of_stage(state, weather, step, place.stage);
                        self.stage(state, place, known);
                        if round == rounds {
                            self.stepper.note_vapour(place.stage);
                        }
                    }
                    if round < rounds {
                        self.respond(dt);
                        self.stepper.correct_ideal_loads();
                    }
                }
                self.stepper.end_known_step(state);
                self.stepper.begin_vapour();
                self.stepper.advance_vapour(state, dt, &mut Ledger::new());
            },
        );
    }

    /// Brings the surfaces of a state into balance with the weather.
    fn balance_surfaces(&mut self, state: &mut State<S>, now: &Instant<'_>, solution: Solution<'_>) {
        S::vectorised_search(
            #[inline(always)]
            || {
                self.stepper.begin_known_step(state);
                self.stepper.conditions_now(now);
                self.stepper.control_vents(state, now.row, 0.0);
                self.stepper.drive_vents(state);
                self.stage(state, StagePlace::instant(), &solution.stages[0]);
                self.stepper.end_known_balance(state);
            },
        );
    }

    /// One stage: the slopes of its equations at the solution, and from them the slopes of the solution.
    #[inline(always)]
    fn stage(&mut self, state: &State<S>, place: StagePlace, solved: &Unknowns<f64>) {
        let Self { stepper, matrices, equations, carries, steady, known, .. } = self;
        let (matrix, values) = (&mut matrices[place.stage], &mut known[place.stage]);
        let new = matrix.factor_linear_walls(place.length);
        stepper.linearise_known_stage(state, place, solved);
        let Parts { solution, cooling, emission } = values.parts();
        stepper.write_known_solution(solved, solution);
        stepper.write_known_cells(&steady.walls, (state, place, solved), matrix, [solution, cooling]);
        stepper.write_emission(&steady.surfaces, solved, emission);
        let Balances { walls, laws, conditions, .. } = stepper.balances();
        matrix.factor((laws, walls, conditions), place.length, new);
        let contents = stepper.stage_of(state, place);
        let at = values.solution();
        let mut slopes = EquationSlopes::new(&stepper.model, carries, equations, at);
        stepper.balances().visit(&contents, &mut slopes);
        slopes.hold_heat(&contents, matrix);
        equations.add_steady(&steady.terms, values.all());
        stepper.store_solution(
            #[inline(always)]
            |solution| equations.solve(place.stage, matrix, at, solution),
        );
    }

    /// Responses of the airs at the end of the step to each ideal load, by the matrices of the stages.
    #[inline(always)]
    fn respond(&mut self, dt: f64) {
        let Self { stepper, matrices, responses, scratch, .. } = self;
        let plan = stepper.model.plan;
        let first_air = plan.n_cells + plan.surfaces.len();
        for (p, (&zone, rows)) in plan.ideal_loads.iter().zip(responses).enumerate() {
            rows.fill(0.0);
            for (place, matrix) in stepper.stage_places(dt).zip(&*matrices) {
                if let Some(first) = place.stage.checked_sub(1) {
                    // Heat capacities at the solution of the first stage, not of this one.
                    matrices[first].stored_for_next_stage(rows, place.ratio);
                }
                let numbers = &stepper.model.coefficients.zones[zone];
                let radiated =
                    numbers.radiated_part(stepper.ideal_load(zone)).map_or(0.0, |part| part.lane(0));
                rows[first_air + zone] += 1.0 - radiated;
                for (&surface, &share) in plan.zones[zone].surfaces.iter().zip(&numbers.radiant_shares) {
                    rows[plan.n_cells + surface.index()] += radiated * share.lane(0);
                }
                matrix.solve_values(rows, scratch);
            }
            stepper.set_response(p, &rows[first_air..]);
        }
    }
}

impl DerivativeStepper<'_, Taped> {
    /// Weights on the equations of a stage from weights on its solution, in place; those on the numbers of steady terms are added.
    pub(super) fn pull(&mut self, stage: usize, equations: &mut [f64], weights: &mut [f64]) {
        self.matrices[stage].solve_transposed(equations, &mut self.scratch);
        add_steady_weights(&self.steady.terms, self.known[stage].all(), equations, weights);
    }
}
