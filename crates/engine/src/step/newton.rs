//! Newton's iteration for one stage: `H(T) - length f(T) = H_start` for all cells, surfaces and airs at once.
//!
//! Every law is linearised about the iterate ([`Linearisation`]), the linear system solved ([`BuildingSystem`]) and the
//! iterate moved to its solution, limited where a melting range would be crossed ([`super::limiter`]), until what the
//! tangents leave out is small ([`super::remainder`]). The solution is that of the last linear solve, so that every flux can be evaluated at the values it used.

use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::error::EngineError;
use crate::linear::building_system::BuildingSystem;
use crate::linear::laws::StageInputs;
use crate::linear::thick_walls::ThickWalls;
use crate::linear::unknowns::Unknowns;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::step::control::RunControl;
use crate::step::linearisation::Linearisation;
use crate::step::linearization_error::NonlinearLaws;
use crate::step::scheme::Tableau;
use crate::step::stage::{Stage, StageStart};

/// Largest change of a temperature in the last iteration, where many have not brought the residual down [K].
pub(super) const TOLERANCE: ByPrecision = ByPrecision { double: 1e-6, single: 1e-4 };
/// Iterations after which every third moves half of the step only, so that the iteration leaves a cycle.
pub(super) const DAMPING_START: usize = 20;
/// Iterations before a step is given to the nested iteration, and rounds of that one before it is halved.
pub(super) const MAX_ITERATIONS: usize = 60;

/// What a run was spent on.
#[derive(Debug, Clone, Copy)]
pub struct Counters<S> {
    /// Newton iterations.
    pub iterations: usize,
    /// Stages that only the nested iteration solved.
    pub nested: usize,
    /// Steps, and parts of steps, that were halved: they did not converge, or carried the air of a zone beyond what acts on it.
    pub halvings: usize,
    /// Steps of phase-change cells with hysteresis in which melting and freezing followed each other: the memory, which
    /// changes at the end of a step, saw only the sum.
    pub reversals: S,
    /// Largest change of a temperature in the last iteration of a stage that was accepted [K].
    pub largest_change: S,
    /// Largest residual of a heat balance at the end of a stage that was accepted, all laws evaluated there [W]; none where
    /// it is not asked for.
    pub largest_residual: Option<S>,
}

/// How a stage is solved.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Search<S: Real> {
    /// One linear solve at the iterate; only a solution that may be the last is `complete`.
    Once { complete: bool },
    /// Until it has converged, in these lanes.
    Whole(S::Mask),
}

/// Solves one stage after the other.
#[derive(Debug, Clone)]
pub(crate) struct StageSolver<'a, S: Real> {
    pub(crate) linearisation: Linearisation<S>,
    pub(crate) system: BuildingSystem<'a, S>,
    pub(crate) start: StageStart<S>,
    pub(crate) iterate: Unknowns<S>,
    /// Solution of the last linear solve.
    pub(crate) solution: Unknowns<S>,
    pub(super) nonlinear: NonlinearLaws<S>,
    /// Lanes whose iteration failed: their numbers mean nothing any more.
    pub(crate) failed: S::Mask,
    pub(crate) counters: Counters<S>,
    /// What the last linear solve lacked of the heat through thick walls [W/m2].
    pub(super) load_residual_before: S,
    /// Where the caller can stop it.
    pub(crate) control: Option<&'a RunControl>,
}

impl<'a, S: Real> StageSolver<'a, S> {
    pub(crate) fn new(model: &Model<'a, S>, tableau: &Tableau) -> Self {
        let plan = model.plan;
        let linearisation = Linearisation::new(model, tableau.weights.len());
        let unknowns = Unknowns::zero(plan.n_cells, plan.surfaces.len(), plan.zones.len());
        Self {
            system: BuildingSystem::new(
                model,
                &linearisation.laws,
                tableau.diagonal,
                !model.parts.balances_stay(),
            ),
            linearisation,
            start: StageStart::new(model),
            iterate: unknowns.clone(),
            solution: unknowns,
            nonlinear: NonlinearLaws::new(model),
            failed: S::Mask::splat(false),
            counters: Counters {
                iterations: 0,
                nested: 0,
                halvings: 0,
                reversals: S::zero(),
                largest_change: S::zero(),
                largest_residual: None,
            },
            load_residual_before: S::zero(),
            control: None,
        }
    }

    /// Solves one stage: by one linear solve where one is asked for, else by iteration. False in the lanes that are not
    /// numbers.
    // One copy only: inlining multiplies compile time, and it is by far the largest part of a step.
    #[inline(never)]
    pub(crate) fn solve(&mut self, stage: &Stage<'_, S>, search: Search<S>) -> Result<S::Mask, EngineError> {
        S::vectorised(
            #[inline(always)]
            || {
                self.begin(stage);
                let mut sound = S::Mask::splat(true);
                match search {
                    Search::Once { complete } => sound = self.solve_once(stage, complete),
                    Search::Whole(active) => self.converge(stage, active)?,
                }
                Ok(sound)
            },
        )
    }

    /// Everything that stays during a stage.
    #[inline(always)]
    fn begin(&mut self, stage: &Stage<'_, S>) {
        self.linearisation.set_wind(stage.model, stage.conditions, false);
        self.nonlinear.begin(stage);
        let Self { linearisation, system, start, iterate, .. } = self;
        let convection = |w: usize| linearisation.gap_convection(stage.index(), w);
        system.zone_fronts.begin_windows(stage.conditions, convection);
        system.begin_stage(&inputs(stage, linearisation, start), iterate, stage.index(), &stage.state.cells);
    }

    /// One linear solve at the iterate.
    #[inline(always)]
    fn solve_once(&mut self, stage: &Stage<'_, S>, complete: bool) -> S::Mask {
        self.solve_linearised(stage, None);
        self.finish(stage, complete)
    }

    /// Linearises everything about the iterate and solves; `outer` as in [`Linearisation::linearise_wall`].
    #[inline(always)]
    pub(super) fn solve_linearised(&mut self, stage: &Stage<'_, S>, outer: Option<&[S]>) {
        self.counters.iterations += 1;
        let (model, conditions) = (stage.model, stage.conditions);
        let Self { linearisation, system, start, iterate, solution, .. } = self;
        for k in 0..system.single_walls.len() {
            let w = system.single_walls[k];
            linearisation.linearise_wall(stage, w, (iterate, outer), &mut system.walls[w]);
            system.condense(model, conditions, w, &start.enthalpy[model.cells(w)]);
        }
        linearisation.linearise_surfaces(model, conditions, iterate, false);
        system.solve(&inputs(stage, linearisation, start), iterate, solution);
        self.load_residual_before = system.couple_thick_walls(model, iterate, solution);
    }

    /// Newton's iteration. A lane that has converged, or was not active from the start, keeps its iterate: later solves
    /// repeat its last one bit for bit.
    #[inline(always)]
    fn converge(&mut self, stage: &Stage<'_, S>, mut active: S::Mask) -> Result<(), EngineError> {
        active = active & !self.failed;
        // Numbers with derivatives make one more iteration at the solution: it gives their slopes.
        let mut further = S::DERIVATIVES;
        for iteration in 0..MAX_ITERATIONS {
            self.check_stop()?;
            self.solve_linearised(stage, None);
            let first = iteration == 0 && active.any();
            let change = if first { self.first_change(stage.model) } else { self.change(stage.model) };
            active = active & !self.accepts(stage, change, iteration);
            if active.any() && iteration + 1 == MAX_ITERATIONS {
                // The last change is kept: the error names it.
                break;
            }
            if active.any() {
                self.advance(stage, active, iteration);
            } else if further {
                further = false;
                self.advance(stage, S::Mask::splat(true), 0);
            } else {
                self.accept_change(change);
                let lost = !(self.finish(stage, true) | self.failed);
                return if lost.any() { self.fail(stage, lost) } else { Ok(()) };
            }
        }
        self.finish(stage, true);
        // Known when it is compiled: lanes have no nested iteration.
        if const { S::LANES > 1 } {
            return self.fail(stage, active);
        }
        let error = self.not_converged(stage, active);
        if self.solve_nested(stage) { Ok(()) } else { Err(error) }
    }

    /// An error where the caller has stopped the run: a step may take long.
    #[inline(always)]
    pub(super) fn check_stop(&self) -> Result<(), EngineError> {
        self.control.map_or(Ok(()), RunControl::check)
    }

    /// Solves for all that Newton's iteration did not need; what the energy balance reads only where the solution is to be `complete`. False in the lanes where a wall that touches no zone is not a
    /// number; of all other walls the iteration has noticed.
    #[inline(always)]
    pub(super) fn finish(&mut self, stage: &Stage<'_, S>, complete: bool) -> S::Mask {
        let laws = complete.then_some(&mut self.linearisation.laws.surfaces);
        self.system.finish(stage.model, laws, &mut self.solution)
    }

    /// Marks lanes as failed: each is run again alone; the others go on. An error where none is left.
    #[cold]
    #[inline(never)]
    fn fail(&mut self, stage: &Stage<'_, S>, lanes: S::Mask) -> Result<(), EngineError> {
        if S::LANES > 1 {
            self.failed = self.failed | lanes;
            if (!self.failed).any() {
                return Ok(());
            }
        }
        Err(self.not_converged(stage, lanes))
    }

    /// Where the solution is accepted: what the tangents leave out is small, or after many iterations the change.
    #[inline(always)]
    fn accepts(&self, stage: &Stage<'_, S>, change: S, iteration: usize) -> S::Mask {
        let small = self.small_linearization_error(stage, change);
        if iteration < DAMPING_START {
            return small;
        }
        small | (change.lt(S::constant(TOLERANCE.of::<S>())) & ThickWalls::accepts(self.load_residual_before))
    }

    /// Where what the tangents leave out at the solution is accepted, see [`NonlinearLaws::accepts`].
    #[inline(always)]
    pub(super) fn small_linearization_error(&self, stage: &Stage<'_, S>, change: S) -> S::Mask {
        let coupled = ThickWalls::accepts(self.load_residual_before);
        coupled & self.nonlinear.accepts(stage, change, &self.system, [&self.iterate, &self.solution])
    }

    /// Notes the last change of an accepted stage.
    #[inline(always)]
    pub(super) fn accept_change(&mut self, change: S) {
        self.counters.largest_change = self.counters.largest_change.max(change);
    }

    /// Largest change from the iterate to the solution, see [`Self::distance`].
    #[inline(always)]
    pub(super) fn change(&self, model: &Model<'_, S>) -> S {
        self.distance(model, &self.iterate)
    }

    /// The same after the first solve; infinite where the airs alone have moved by more than is accepted, in all lanes. In most stages they
    /// have, and nothing else has to be looked at.
    #[inline(always)]
    fn first_change(&self, model: &Model<'_, S>) -> S {
        let mut of_airs = Distance::none();
        of_airs.add(&self.solution.air, &self.iterate.air);
        let accepted = self.nonlinear.accepts_change(of_airs.largest());
        if accepted.any() { self.change(model) } else { S::constant(f64::INFINITY) }
    }

    /// Largest distance of the solution from an iterate where something is linearised, by lane [K]. Infinite when any part of
    /// it is not a number.
    #[inline(always)]
    pub(super) fn distance(&self, model: &Model<'_, S>, iterate: &Unknowns<S>) -> S {
        let mut distance = Distance::none();
        distance.add(&self.solution.air, &iterate.air);
        for surfaces in &model.parts.linearised {
            distance.add(self.solution.surfaces.places(surfaces), iterate.surfaces.places(surfaces));
        }
        for cells in &model.parts.nonlinear_cells {
            distance.add(&self.solution.cells[cells.clone()], &iterate.cells[cells.clone()]);
        }
        distance.largest()
    }

    /// Names the part that changes most in the first lane that failed.
    fn not_converged(&self, stage: &Stage<'_, S>, active: S::Mask) -> EngineError {
        let (model, plan) = (stage.model, stage.model.plan);
        let lane = (0..S::LANES).find(|&lane| active.lane(lane)).unwrap_or(0);
        let mut worst = (0.0, String::from("the building"));
        let mut look = |new: S, old: S, name: &dyn Fn() -> String| {
            let change = (new.lane(lane) - old.lane(lane)).abs();
            // What is not a number comes first; of those, the first.
            if change > worst.0 || (change.is_nan() && !worst.0.is_nan()) {
                worst = (change, name());
            }
        };
        for surface in model.parts.linearised.iter().cloned().flatten().map(SideId::from_index) {
            look(self.solution.surfaces[surface], self.iterate.surfaces[surface], &|| {
                plan.surface_name(surface)
            });
        }
        for (zone, (new, old)) in self.solution.air.iter().zip(&self.iterate.air).enumerate() {
            look(*new, *old, &|| format!("zone {} (air)", plan.description.zones[zone].name));
        }
        for (w, wall) in plan.walls.iter().enumerate().filter(|(_, wall)| wall.nonlinear) {
            for i in 0..wall.len() {
                let k = wall.first_cell + i;
                look(self.solution.cells[k], self.iterate.cells[k], &|| plan.cell_name(w, i));
            }
        }
        let (step, stage) = stage.place;
        EngineError::NotConverged {
            step,
            stage,
            place: worst.1,
            residual: worst.0,
            iterations: MAX_ITERATIONS,
        }
    }
}

/// What the linear system of a stage is made of.
#[inline(always)]
fn inputs<'s, S: Real>(
    stage: &Stage<'s, S>,
    linearisation: &'s Linearisation<S>,
    start: &'s StageStart<S>,
) -> StageInputs<'s, S> {
    StageInputs {
        model: stage.model,
        conditions: stage.conditions,
        laws: &linearisation.laws,
        air: &start.air,
        load: &start.load,
        holding: &start.holding,
        length: stage.length,
    }
}

/// Numbers that are compared side by side.
const ABREAST: usize = 4;

/// Largest of some differences, of several side by side: none of them waits for the one before.
struct Distance<S> {
    largest: [S; ABREAST],
    /// Not finite when any difference is not a number: a maximum would leave it out.
    sum: [S; ABREAST],
}

impl<S: Real> Distance<S> {
    #[inline(always)]
    fn none() -> Self {
        Self { largest: [S::zero(); ABREAST], sum: [S::zero(); ABREAST] }
    }

    #[inline(always)]
    fn add_one(&mut self, i: usize, new: S, old: S) {
        let difference = new - old;
        self.largest[i] = self.largest[i].max(difference.abs());
        self.sum[i] += difference;
    }

    #[inline(always)]
    fn add(&mut self, mut new: &[S], mut old: &[S]) {
        // Lanes fill the registers alone.
        if const { S::CHUNK > 1 } {
            let ((whole, rest), (of_old, rest_of_old)) =
                (new.as_chunks::<ABREAST>(), old.as_chunks::<ABREAST>());
            for (new, old) in whole.iter().zip(of_old) {
                for i in 0..ABREAST {
                    self.add_one(i, new[i], old[i]);
                }
            }
            (new, old) = (rest, rest_of_old);
        }
        for (&new, &old) in new.iter().zip(old) {
            self.add_one(0, new, old);
        }
    }

    #[inline(always)]
    fn largest(&self) -> S {
        let [mut largest, mut sum] = [self.largest[0], self.sum[0]];
        if const { S::CHUNK > 1 } {
            for i in 1..ABREAST {
                largest = largest.max(self.largest[i]);
                sum += self.sum[i];
            }
        }
        let finite = sum.abs().lt(S::constant(f64::MAX));
        S::select(finite, largest, S::constant(f64::INFINITY))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::lanes::Lanes;

    /// The maximum norm, lane by lane: a part that is not a number shows wherever it stands.
    #[test]
    fn the_distance_is_the_largest_difference() {
        let mut distance = Distance::none();
        distance.add(&[1.0, -3.0, 2.0], &[1.5, 1.0, 2.0]);
        assert_eq!(distance.largest(), 4.0);
        // Of nine plain numbers eight are compared side by side.
        for place in 0..9 {
            let mut new = [1.0; 9];
            new[place] = -7.0;
            let mut distance = Distance::none();
            distance.add(&new, &[0.0; 9]);
            assert_eq!(distance.largest(), 7.0);
            new[place] = f64::NAN;
            distance.add(&new, &[0.0; 9]);
            assert_eq!(distance.largest(), f64::INFINITY);
        }
        for place in 0..3 {
            let mut new = [Lanes([1.0, 2.0]); 3];
            new[place].0[1] = f64::NAN;
            let mut distance = Distance::none();
            distance.add(&new, &[Lanes([0.25, 0.0]); 3]);
            assert_eq!(distance.largest().0, [0.75, f64::INFINITY]);
        }
    }
}
