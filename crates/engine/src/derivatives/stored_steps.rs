//! Steps of numbers with derivatives along the solutions of a plain run.
//!
//! Only the slopes of the equations of a stage are differentiated ([`super::equation_slopes`]). The slopes of the solution
//! follow from them by one solve with the plain matrix of the stage (implicit function theorem: Griewank & Walther (2008),
//! ch. 15, doi:10.1137/1.9780898717761). Nothing is iterated, and no elimination is computed with derivatives.

use crate::balance::terms::Balances;
use crate::building::plan::Plan;
use crate::linear::stage_matrix::StageMatrix;
use crate::linear::unknowns::Unknowns;
use crate::number::real::{Equations, Real};
use crate::number::tape::{Taped, add_steady_weights};
use crate::run::Action;
use crate::run::options::Options;
use crate::run::outputs::Output;
use crate::step::Scheme;
use crate::step::linearized_stepper::{StagePlace, TangentStepper};
use crate::step::stage_solutions::{KnownPart, StageSolutions};
use crate::step::state::State;
use crate::weather::conditions::{Instant, Weather};

use super::constant_terms::{ConstantTerms, KnownValues, Parts};
use super::equation_slopes::{Carries, EquationSlopes};

/// A follower whose numbers have derivatives, and the plain matrices at the known solutions.
#[derive(Debug, Clone)]
pub(super) struct DerivativeStepper<'a, S: Real> {
    pub(super) linearized_stepper: TangentStepper<'a, S>,
    /// What is known of each stage of a part; where the equations are solved once more after the step, of each stage of all its parts.
    stages: Vec<KnownStage<'a>>,
    /// Stages of a part.
    count: usize,
    equations: S::Equations,
    carries: Carries,
    steady: ConstantTerms<S>,
    /// Responses of all unknowns to each ideal load [K/W].
    responses: Vec<Vec<f64>>,
    scratch: Vec<f64>,
}

/// A stage at its known solution, in plain numbers.
#[derive(Debug, Clone)]
struct KnownStage<'a> {
    matrix: StageMatrix<'a>,
    values: KnownValues,
}

impl<'a, S: Real> DerivativeStepper<'a, S> {
    pub(super) fn new(plan: &'a Plan, numbers: &'a [S], scheme: Scheme) -> Self {
        let linearized_stepper = TangentStepper::new(plan, numbers, scheme);
        let plain: Vec<f64> = numbers.iter().map(|number| number.lane(0)).collect();
        let matrix = StageMatrix::new(plan, &plain, scheme.tableau().diagonal);
        let unknowns = plan.n_cells + plan.surfaces.len() + plan.zones.len();
        let values = KnownValues::new(&linearized_stepper.model);
        let count = scheme.weights().len();
        Self {
            equations: S::Equations::default(),
            carries: Carries::new(&linearized_stepper.model),
            steady: ConstantTerms::find(&linearized_stepper, &values),
            stages: vec![KnownStage { matrix, values }; count],
            count,
            responses: vec![vec![0.0; unknowns]; plan.ideal_loads.len()],
            scratch: Vec::new(),
            linearized_stepper,
        }
    }

    /// For a run: with the means that its outputs need, and with the factors of walls of several stage lengths where its steps differ.
    pub(super) fn of_run(plan: &'a Plan, numbers: &'a [S], options: &Options) -> Self {
        let mut stepper = Self::new(plan, numbers, options.scheme.converged());
        if options.lengths.is_some() {
            for stage in &mut stepper.stages {
                stage.matrix.keep_factors();
            }
        }
        if options.outputs.iter().any(Output::averages_absorbed_sun) {
            stepper.linearized_stepper.average_absorbed_sun();
        }
        stepper
    }

    /// Takes an action whose solution is known.
    pub(super) fn take(
        &mut self,
        action: Action,
        state: &mut State<S>,
        weather: &Weather<'_>,
        dt: f64,
        known: &StageSolutions<f64>,
    ) {
        // A step in many parts is rare: what was known of its stages is not kept.
        self.stages.truncate(self.count);
        let step = match action {
            Action::WarmUp(step) | Action::Step(step) => step,
            Action::FirstStep => 0,
            Action::BeginPeriod => return,
            Action::Balance => {
                return self.balance_surfaces(state, &weather.at(0, 0), known);
            }
        };
        self.linearized_stepper.begin_step(state, weather.row(step, 0), dt);
        for (k, part) in known.parts().enumerate() {
            let first = if const { S::Equations::SOLVED_LATER } { k * self.count } else { 0 };
            while self.stages.len() < first + self.count {
                let another = self.stages[0].clone();
                self.stages.push(another);
            }
            self.part(state, weather, dt, (&part, first));
            // Rounding and tolerances must not add up.
            if let Some(reached) = part.reached {
                state.change_by(reached, |number, value| *number = number.with_value(value));
            }
        }
    }

    /// One part of a step of length `dt` [s]; `first` is the place of its first stage.
    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    fn part(
        &mut self,
        state: &mut State<S>,
        weather: &Weather<'_>,
        dt: f64,
        (known, first): (&KnownPart<'_>, usize),
    ) {
        let length = dt * known.part.share;
        S::vectorised(
            #[inline(always)]
            || {
                self.linearized_stepper.begin_part(state);
                let plan = self.linearized_stepper.model.plan;
                let controlled =
                    !plan.ideal_loads.is_empty() && self.linearized_stepper.set_ideal_loads(weather, known);
                // Responses do not contain the effect of a load on the convection extrapolated in gaps: with windows a second
                // round adds its slope.
                let rounds = match (controlled, plan.windows.is_empty()) {
                    (false, _) => 0,
                    (true, true) => 1,
                    (true, false) => 2,
                };
                for round in 0..=rounds {
                    for (place, solved) in self.linearized_stepper.stage_places(length).zip(known.stages) {
                        if place.stage > 0 {
                            self.linearized_stepper.store_first_stage(state);
                        } else {
                            self.linearized_stepper.begin_first_stage(state, length);
                        }
                        self.linearized_stepper.conditions_of_stage(state, weather, known.part, place.stage);
                        self.stage(state, place, (solved, first + place.stage));
                        if round == rounds {
                            self.linearized_stepper.note_vapour(place.stage);
                        }
                    }
                    if round < rounds {
                        self.respond(length, first);
                        self.linearized_stepper.correct_ideal_loads();
                    }
                }
                self.linearized_stepper.end_part(state, known.part, length);
            },
        );
    }

    /// Brings the surfaces of a state into balance with the weather.
    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    fn balance_surfaces(&mut self, state: &mut State<S>, now: &Instant<'_>, known: &StageSolutions<f64>) {
        self.linearized_stepper.begin_balance(state, now);
        for solved in known.parts().flat_map(|part| part.stages) {
            self.stage(state, StagePlace::instant(), (solved, 0));
        }
        self.linearized_stepper.end_balance(state);
    }

    /// One stage: the slopes of its equations at the solution, and from them the slopes of the solution.
    // One copy only, the largest part of a step: inlining multiplies the size of the library.
    #[inline(never)]
    fn stage(&mut self, state: &State<S>, place: StagePlace, (solved, number): (&Unknowns<f64>, usize)) {
        S::vectorised(
            #[inline(always)]
            || self.solve_stage(state, place, (solved, number)),
        );
    }

    #[inline(always)]
    fn solve_stage(
        &mut self,
        state: &State<S>,
        place: StagePlace,
        (solved, number): (&Unknowns<f64>, usize),
    ) {
        let Self { linearized_stepper, stages, equations, carries, steady, .. } = self;
        let KnownStage { matrix, values } = &mut stages[number];
        let new = matrix.factor_linear_walls(place.length);
        linearized_stepper.linearise_known_stage(state, place, solved);
        let Parts { solution, cooling, emission } = values.parts();
        linearized_stepper.write_known_solution(solved, solution);
        linearized_stepper.write_known_cells(
            &steady.walls,
            (state, place, solved),
            matrix,
            [solution, cooling],
        );
        linearized_stepper.write_emission(&steady.surfaces, solved, emission);
        let Balances { walls, laws, conditions, .. } = linearized_stepper.balances();
        matrix.factor((laws, walls, conditions), place.length, new);
        let contents = linearized_stepper.stage_of(state, place);
        let at = values.solution();
        let mut slopes = EquationSlopes::new(&linearized_stepper.model, carries, equations, at);
        linearized_stepper.balances().visit(&contents, &mut slopes);
        slopes.hold_heat(&contents, matrix);
        equations.add_steady(&steady.terms, values.all());
        linearized_stepper.store_solution(
            #[inline(always)]
            |solution| equations.solve(number, matrix, at, solution),
        );
    }

    /// Responses of the airs at the end of the step to each ideal load, by the matrices of the stages.
    #[inline(always)]
    fn respond(&mut self, length: f64, first: usize) {
        let Self { linearized_stepper, stages, count, responses, scratch, .. } = self;
        let stages = &stages[first..first + *count];
        let plan = linearized_stepper.model.plan;
        let first_air = plan.n_cells + plan.surfaces.len();
        let radiated_part = |stepper: &TangentStepper<'a, S>, zone: usize| {
            let numbers = &stepper.model.coefficients.zones[zone];
            numbers.radiated_part(stepper.ideal_load(zone)).map_or(0.0, |part| part.lane(0))
        };
        for (p, (&zone, rows)) in plan.ideal_loads.iter().zip(responses).enumerate() {
            rows.fill(0.0);
            let radiated = radiated_part(linearized_stepper, zone);
            for (place, KnownStage { matrix, .. }) in linearized_stepper.stage_places(length).zip(stages) {
                if let Some(before) = place.stage.checked_sub(1) {
                    // Heat capacities at the solution of the first stage, not of this one.
                    stages[before].matrix.stored_for_next_stage(rows, place.ratio);
                }
                let numbers = &linearized_stepper.model.coefficients.zones[zone];
                rows[first_air + zone] += 1.0 - radiated;
                for (&surface, &share) in plan.zones[zone].surfaces.iter().zip(&numbers.radiant_shares) {
                    rows[plan.n_cells + surface.index()] += radiated * share.lane(0);
                }
                matrix.solve_values(rows, scratch);
            }
            let (surfaces, airs) = rows[plan.n_cells..].split_at(first_air - plan.n_cells);
            linearized_stepper.set_response(p, ([surfaces, airs], radiated));
        }
    }
}

impl DerivativeStepper<'_, Taped> {
    /// Weights on the equations of a stage from weights on its solution, in place; those on the numbers of steady terms are added.
    pub(super) fn pull(&mut self, stage: usize, equations: &mut [f64], weights: &mut [f64]) {
        let KnownStage { matrix, values } = &self.stages[stage];
        matrix.solve_transposed(equations, &mut self.scratch);
        add_steady_weights(&self.steady.terms, values.all(), equations, weights);
    }
}
