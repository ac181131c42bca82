//! The fast elimination is held to the terms of the balances: the residual of each solved stage.

use crate::balance::ledger::Ledger;
use crate::balance::terms::{Balances, Contents, Stage};
use crate::building::plan::Plan;
use crate::common::random::{Case, Contents as CaseContents};
use crate::common::values;
use crate::input::forcing::Forcing;
use crate::number::lanes::Lanes;
use crate::number::real::{Mask, Real};
use crate::step::state::State;
use crate::weather::conditions::Weather;

use super::Scheme;
use super::stepper::{INSTANT, Stepper};

/// Residuals of the stages solved so far.
#[derive(Debug, Clone)]
pub(super) struct Residuals<S> {
    pub(super) active: bool,
    /// Cells, enthalpies and airs at the end of the first stage.
    first: [Vec<S>; 3],
    /// Cells at the end of the last stage.
    cells: Vec<S>,
    /// The largest residual over the largest heat flow density [-].
    pub(super) worst: f64,
    pub(super) stages: usize,
}

impl<S> Default for Residuals<S> {
    fn default() -> Self {
        Self { active: false, first: Default::default(), cells: Vec::new(), worst: 0.0, stages: 0 }
    }
}

impl<S: Real> Stepper<'_, S> {
    /// Temperatures of all cells at the end of the stage just solved. Those of constant walls follow from their start and
    /// the surfaces.
    fn solved_cells(&self, start: &[S]) -> Vec<S> {
        let mut cells = self.solver.solution.cells.clone();
        for &w in &self.model.parts.linear_walls {
            let (wall, chain) = (&self.model.plan.walls[w], &self.solver.system.walls[w]);
            let range = wall.first_cell..wall.first_cell + wall.len();
            let held: Vec<S> =
                start[range.clone()].iter().zip(&chain.storage).map(|(&t, cell)| cell.capacity * t).collect();
            let mut known = vec![S::zero(); wall.len()];
            chain.source_changes(&held, &mut known);
            chain.temperature_changes(&known, self.solver.solution.surfaces.pair(w), &mut cells[range]);
        }
        cells
    }

    /// Records the residual of the stage just solved, with the laws as linearised for it.
    pub(super) fn record_residual(&mut self, state: &State<S>, length: f64, index: usize) {
        if !self.residuals.active || length == INSTANT {
            return;
        }
        let ratio = if index > 0 { self.scheme.tableau().ratio } else { 0.0 };
        let mut laws = self.solver.linearisation.laws.clone();
        self.solver.system.zone_fronts.laws_in_zones(&mut laws.surfaces);
        let start = Contents { cells: &state.cells, enthalpy: &state.enthalpy, air: &state.air };
        let [cells, enthalpy, air] = &self.residuals.first;
        let first = if index > 0 { Contents { cells, enthalpy, air } } else { start };
        let stage = Stage { length, ratio, start, first };
        let from: Vec<S> =
            start.cells.iter().zip(first.cells).map(|(&a, &b)| a + (b - a).scale(ratio)).collect();
        let cells = self.solved_cells(&from);
        let balances = Balances { laws: &laws, ..self.balances() };
        let residual =
            balances.residual(&stage, &cells, &self.solver.solution.surfaces, &self.solver.solution.air);
        let (worst, scale) = (residual.largest(), residual.largest_flow);
        let failed = self.failed();
        for lane in (0..S::LANES).filter(|&lane| !failed.lane(lane)) {
            let relative = worst.lane(lane) / scale.lane(lane);
            // A residual that is no number is the largest, and stays.
            if relative.is_nan() || relative > self.residuals.worst {
                self.residuals.worst = relative;
            }
        }
        self.residuals.stages += 1;
        if index == 0 {
            let mut enthalpy = state.enthalpy.clone();
            for &w in &self.model.parts.nonlinear_walls {
                for (i, storage) in self.solver.system.walls[w].storage.iter().enumerate() {
                    enthalpy[self.model.plan.walls[w].first_cell + i] = storage.at_solution();
                }
            }
            self.residuals.first = [cells.clone(), enthalpy, self.solver.solution.air.clone()];
        }
        self.residuals.cells = cells;
    }
}

/// Largest residual of all stages of a run over its largest heat flow density, and the largest difference of the cells that
/// a step ends with from those of its last stage [K].
fn worst<S: Real>(case: &Case, plan: &Plan, numbers: &[S]) -> (f64, f64) {
    let rows = case.rows(plan);
    let forcing = Forcing::new(&rows, case.scheme.weights().len(), plan.n_channels()).unwrap();
    let weather = Weather::new(plan, &forcing);
    let mut stepper = Stepper::new(plan, numbers, case.scheme);
    stepper.residuals.active = true;
    let mut state = stepper.begin(&case.options().initial);
    stepper.balance_surfaces(&mut state, &weather.at(0, 0)).unwrap();
    let (mut ledger, mut apart) = (Ledger::new(), 0.0);
    for step in 0..case.steps {
        stepper.step(&mut state, &weather, step, case.dt, &mut ledger).unwrap();
        for (a, b) in state.cells.iter().zip(&stepper.residuals.cells) {
            let failed = stepper.failed();
            for lane in (0..S::LANES).filter(|&lane| !failed.lane(lane)) {
                apart = f64::max(apart, (a.lane(lane) - b.lane(lane)).abs());
            }
        }
    }
    assert!(stepper.residuals.stages >= case.steps * case.scheme.weights().len());
    (stepper.residuals.worst, apart)
}

/// Parts of a building and of a scheme that random plans have to contain.
fn contents(case: &Case, plan: &Plan) -> [bool; 5] {
    [
        !plan.windows.is_empty(),
        plan.walls.iter().any(|wall| wall.nonlinear && wall.glass.is_none()),
        !plan.ideal_loads.is_empty(),
        !plan.description.air_paths.is_empty(),
        case.scheme == Scheme::Sdirk2,
    ]
}

/// The residual of each stage, from the terms of the balances, is below 1e-9 of the largest heat flow density.
#[test]
fn fast_elimination_solves_the_balances() {
    let mut seen = [false; 5];
    for seed in 0..24 {
        let mut case = Case::new(seed, CaseContents::All);
        case.steps = 8;
        let plan = case.plan();
        for (seen, contains) in seen.iter_mut().zip(contents(&case, &plan)) {
            *seen |= contains;
        }
        let numbers = values(&plan);
        let (residual, apart) = worst::<f64>(&case, &plan, &numbers);
        assert!(residual < 1e-9, "seed {seed}: residual {residual:e}");
        assert!(apart < 1e-9, "seed {seed}: cells differ by {apart:e} K");
        let lanes: Vec<Lanes<4>> = numbers
            .iter()
            .map(|&number| Lanes(core::array::from_fn(|lane| number * (1.0 + 1e-3 * lane as f64))))
            .collect();
        let (residual, apart) = worst(&case, &plan, &lanes);
        assert!(residual < 1e-9, "seed {seed} in lanes: residual {residual:e}");
        assert!(apart < 1e-9, "seed {seed} in lanes: cells differ by {apart:e} K");
    }
    assert_eq!(seen, [true; 5], "the plans leave out a part of a building");
}
