//! A step with ideal loads: its stages, repeated until their temperatures and the loads are right.

use crate::balance::energy_balance::Power;
use crate::error::EngineError;
use crate::linear::unknowns::line;
use crate::number::real::{Mask, Real};
use crate::step::halving::Part;
use crate::step::newton::{DAMPING_START, Search};
use crate::step::stage::Stage;
use crate::step::state::State;
use crate::step::stepper::Stepper;
use crate::weather::conditions::Weather;

/// Largest number of sweeps over the stages of a step, beside one for each load that may begin or end; and how many of the first
/// ones solve each stage only once.
const MAX_SWEEPS: usize = 40;
const SINGLE_SWEEPS: usize = 12;

/// One sweep over the stages of a step.
#[derive(Debug, Clone, Copy)]
struct Sweep<S: Real> {
    part: Part,
    /// Of the part [s].
    length: f64,
    /// Sweeps before it.
    number: usize,
    /// Lanes that change; the others repeat the previous sweep with the same bits.
    active: S::Mask,
}

/// The result of a sweep.
struct LoadIteration<S: Real> {
    /// Heat of all but the last stage.
    energy: Power<S>,
    /// Largest change of a temperature in any stage [K].
    change: S,
    /// Where all stages are accepted; nowhere after a sweep that cannot be the last, which adds up no heat.
    accepted: S::Mask,
}

impl<S: Real> Stepper<'_, S> {
    /// Guesses the loads of a step of a length [s] that ends with a forcing row, and the first stage.
    #[inline(always)]
    pub(in crate::step) fn guess_loads(&mut self, state: &State<S>, row: &[f64], length: f64) {
        let Self { model, solver, ideal_loads, guess, .. } = self;
        let (load, iterate) = (&mut solver.start.load, &mut solver.iterate);
        let previous = guess.previous();
        ideal_loads.begin(&model.coefficients.zones, row, load, previous.is_some());
        let tableau = self.scheme.tableau();
        let expected = |zone: usize| line(state.air[zone], iterate.air[zone], 1.0 / tableau.diagonal);
        if ideal_loads.controlled.is_empty() {
            ideal_loads.mark_needed(load, expected);
        } else {
            let controlled = |zone: usize| {
                let [now, next] =
                    [(&state.surfaces, state.air[zone]), (&iterate.surfaces, iterate.air[zone])]
                        .map(|at| model.held_temperature(zone, at, load[zone]));
                line(now, next, 1.0 / tableau.diagonal)
            };
            ideal_loads.mark_needed(load, controlled);
        }
        ideal_loads.begin_holding(model, row, (tableau.diagonal * length, tableau.ratio), load, expected);
        if let Some(previous) = previous {
            let known = [previous, ideal_loads.first.view()];
            iterate.shift(&model.parts.zone_surfaces, &state.view(), &known);
        }
    }

    /// The stages of a step, repeated until their temperatures and the loads are right.
    #[inline(always)]
    pub(in crate::step) fn step_with_loads(
        &mut self,
        state: &State<S>,
        weather: &Weather<'_>,
        part: Part,
        length: f64,
    ) -> Result<Power<S>, EngineError> {
        let mut active = S::Mask::splat(true);
        let mut further = self.further_sweeps();
        for number in 0..self.most_sweeps() {
            self.solver.check_stop()?;
            // Sweeps are bounded anyway; lanes together may take more iterations than one alone.
            if S::LANES == 1 && self.limit_reached() {
                break;
            }
            let whole = number >= SINGLE_SWEEPS;
            let LoadIteration { mut energy, change, accepted } =
                self.sweep(state, weather, Sweep { part, length, number, active })?;
            let still = accepted | S::Mask::splat(whole);
            let (solution, load) = (&self.solver.solution, &mut self.solver.start.load);
            let air = &solution.air;
            self.ideal_loads.read_controlled(&self.model, &solution.view(), load);
            let found = self.ideal_loads.correct(air, load, (number, active, further > 0));
            let moving = active & !(found & still) & !self.solver.failed;
            if moving.any() && !(number + 1 == self.most_sweeps() && self.fail_some(moving)) {
                active = moving;
            } else if further > 0 {
                further -= 1;
                active = S::Mask::splat(true);
            } else {
                self.solver.accept_change(change);
                self.close(state, &mut energy, length);
                self.note_vapour_of_loads();
                return Ok(energy);
            }
        }
        Err(self.loads_not_found(active, part.step))
    }

    /// Marks lanes whose loads are not found as failed: they are run again alone. False where no other is left.
    #[cold]
    #[inline(never)]
    fn fail_some(&mut self, lanes: S::Mask) -> bool {
        let others = !(lanes | self.solver.failed);
        if S::LANES == 1 || !others.any() {
            return false;
        }
        self.mark_failed(lanes);
        true
    }

    /// Sweeps before a step counts as unsolved.
    fn most_sweeps(&self) -> usize {
        MAX_SWEEPS + self.ideal_loads.zones.len()
    }

    /// Names the load that changes most in the first lane that did not converge.
    #[cold]
    fn loads_not_found(&self, active: S::Mask, step: usize) -> EngineError {
        let lane = (0..S::LANES).find(|&lane| active.lane(lane)).unwrap_or(0);
        let (zone, residual) = self.ideal_loads.worst(lane);
        let place = format!("zone {} (ideal load)", self.model.plan.description.zones[zone].name);
        let (stage, iterations) = (self.scheme.weights().len(), self.most_sweeps());
        EngineError::NotConverged { step, stage, place, residual, iterations }
    }

    /// Corrects the guess of a stage, once the weather in it is known.
    #[inline(always)]
    fn correct_guess(&mut self, state: &State<S>, stage: usize) {
        let Self { model, solver, ideal_loads, weather, .. } = self;
        let iterate = &mut solver.iterate;
        if stage > 0 {
            // Extrapolation from the first stage would contain the error of its load.
            let known = [ideal_loads.first.view(), state.view()];
            iterate.shift(&model.parts.zone_surfaces, &solver.solution.view(), &known);
            return;
        }
        // A change of the outdoor air against its extrapolation is added to the surfaces outdoors.
        let [before, now] = ideal_loads.outdoor;
        let expected = line(before, now, 1.0 + self.scheme.tableau().diagonal);
        let turn = weather.conditions.outdoor_air - expected;
        for outdoors in &weather.index.outdoors {
            iterate.surfaces[outdoors.surface] += turn;
        }
    }

    /// Sweeps after convergence: for slopes, and where slopes will be computed at this solution.
    #[inline(always)]
    fn further_sweeps(&self) -> usize {
        if !S::DERIVATIVES {
            // The effect of a parameter converges one sweep after the numbers; difference quotients would show the error.
            return if self.known.keeps() { 2 } else { 0 };
        }
        // Responses do not contain the effect of a load on the convection extrapolated in gaps: slopes then take two sweeps.
        if self.model.plan.windows.is_empty() { 1 } else { 2 }
    }

    /// All stages of a step at the present loads: one linear solve of each; after many sweeps, iterations to convergence.
    // Long because each part depends on whether the sweep is the first and the stage the first.
    #[inline(always)]
    fn sweep(
        &mut self,
        state: &State<S>,
        weather: &Weather<'_>,
        Sweep { part, length, number, active }: Sweep<S>,
    ) -> Result<LoadIteration<S>, EngineError> {
        let tableau = self.scheme.tableau();
        let (weights, length_of_stage) = (tableau.weights, tableau.diagonal * length);
        let (again, responds) = (number > 0, self.ideal_loads.finds_responses(number, active));
        let may_end = again || tableau.tolerance.first;
        let (mut energy, mut change, mut accepted) = (Power::none(), S::zero(), S::Mask::splat(may_end));
        if again {
            self.solver.start.begin(&self.model, state);
            self.histories.begin(&self.model, state, tableau, length);
            self.known.restart();
            self.ideal_loads.begin_again(active);
        }
        for (index, &weight) in weights.iter().enumerate() {
            if index > 0 {
                self.begin_second_stage(state);
            }
            if weights.len() > 1 && (again || index > 0) {
                self.weather.swap_stages();
            }
            if again {
                let (cells, solver) = (&self.model.parts.nonlinear_cells, &mut self.solver);
                self.ideal_loads.guess(index, cells, &mut solver.iterate, &mut solver.solution);
            } else {
                self.weather.set_stage(&self.model, weather, tableau, (part, index), &state.air);
                self.drive_vents(state);
                if self.ideal_loads.continues {
                    self.correct_guess(state, index);
                }
            }
            let Self { model, weather, solver, ideal_loads, known, histories, .. } = self;
            let stage = Stage {
                model,
                conditions: &weather.conditions,
                state,
                histories: histories.within(state),
                tableau,
                length: length_of_stage,
                place: (part.step, index + 1),
            };
            if again {
                solver.advance(&stage, active, number.min(DAMPING_START - 1));
            }
            ideal_loads.hold(index + 1 == weights.len(), &mut solver.start.holding);
            let once = Search::Once { complete: may_end || self.residuals.is_some() };
            let search = if number < SINGLE_SWEEPS { once } else { Search::Whole(active) };
            let mut sound = solver.solve(&stage, search)?;
            if again
                && index == 0
                && ideal_loads.supply(model, &solver.system, number - 1, &mut solver.start.load)
            {
                sound = solver.solve(&stage, search)?;
            }
            known.keep(&solver.solution);
            let moved = S::select(sound, solver.change(model), S::constant(f64::INFINITY));
            change = change.max(moved);
            if accepted.any() {
                accepted = accepted & solver.small_linearization_error(&stage, moved);
            }
            if responds {
                let loads = (index, &solver.start.load[..]);
                ideal_loads.respond(model, &solver.system, loads, (length_of_stage, tableau.ratio));
            }
            if number == 1 {
                ideal_loads.learn(index, &solver.solution);
            }
            let cells = &model.parts.nonlinear_cells;
            ideal_loads.keep(index, cells, &mut solver.iterate, &solver.solution);
            if self.residuals.is_some() {
                self.record_residual_of_sweep(state, length_of_stage, index);
            }
            if may_end && index + 1 < weights.len() {
                self.add_heat(weight * length, &mut energy);
            }
        }
        Ok(LoadIteration { energy, change, accepted })
    }

    /// Records the residual of a stage. The heat that holds the airs in the last one counts as part of their loads.
    #[cold]
    fn record_residual_of_sweep(&mut self, state: &State<S>, length: f64, index: usize) {
        let loads = self.solver.start.load.clone();
        if index + 1 == self.scheme.weights().len() {
            for (zone, heat) in self.ideal_loads.holding_heat(&self.solver.solution.air) {
                self.solver.start.load[zone] += heat;
            }
        }
        self.record_residual(state, length, index);
        self.solver.start.load = loads;
    }

    /// Brings the airs to their set points by the loads of the last stage, and adds its heat.
    #[inline(always)]
    fn close(&mut self, state: &State<S>, energy: &mut Power<S>, length: f64) {
        let weights = self.scheme.weights();
        let weight = weights[weights.len() - 1];
        let Self { model, solver, ideal_loads, known, .. } = self;
        if ideal_loads.any_needed(!solver.failed) {
            ideal_loads.read_controlled(model, &solver.solution.view(), &solver.start.load);
            ideal_loads.complete(model, &mut solver.system, &solver.solution.air, &solver.start.load);
            solver.system.resolve_all(model, &mut solver.solution);
            known.amend(&solver.solution);
        }
        ideal_loads.add_held(&solver.solution.air);
        for (&correction, &zone) in ideal_loads.correction.iter().zip(&model.plan.ideal_loads) {
            solver.start.load[zone] += correction;
        }
        if self.residuals.is_some() {
            self.record_residual(state, self.scheme.tableau().diagonal * length, weights.len() - 1);
        }
        self.add_heat(weight * length, energy);
        let Self { model, solver, ideal_loads, weather, .. } = self;
        ideal_loads.outdoor = [ideal_loads.outdoor[1], weather.conditions.outdoor_air];
        for (&correction, &zone) in ideal_loads.correction.iter().zip(&model.plan.ideal_loads) {
            // The mean over the step.
            let load = &mut solver.start.load[zone];
            *load = *load - correction.scale(1.0 - weight);
        }
    }
}
