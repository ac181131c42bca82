//! One implicit time step: Newton on enthalpy, walls eliminated onto their surfaces, a small dense room block.
//!
//! A step is a function (state, forcing) -> state; memory changes only when it is accepted.
//! Each stage solves `held + length * f(T) = H(T)` for all cells and airs at once.
//!
//! Sources: SDIRK2 of Alexander (1977), SIAM J. Numer. Anal. 14(6), doi:10.1137/0714068.

mod follow;
pub mod ideal_loads;
pub mod stage_solutions;
pub mod state;
mod twin;

use core::ops::Range;

use crate::balance::flow_index::FlowIndex;
use crate::balance::ledger::{Flow, Ledger, Power};
use crate::building::coefficients::{Boundary, Coefficients, Matter, SurfaceCoefficients};
use crate::building::glazing::Glass;
use crate::building::ids::{BySurface, SurfaceId};
use crate::building::plan::{Plan, SurfaceRole};
use crate::error::EngineError;
use crate::linear::coupled::CoupledSystem;
use crate::linear::step_maps::StepMaps;
use crate::linear::surface_balance::{ExteriorBalance, ExteriorSurfaces, SurfaceLaws, solve_pair};
use crate::linear::wall::{Chain, Iterate, Link, Start, StorageRule};
use crate::linear::zone_front::{Front, ZoneFronts, of_one_room};
use crate::number::line::Line;
use crate::number::real::{Mask, Real};
use crate::physics::air_flow;
use crate::physics::longwave::{Emission, black_temperature};
use crate::physics::pcm::{PcmMemory, reversed};
use crate::physics::window_gaps::GapTangent;
use crate::step::ideal_loads::{IdealLoads, Response};
use crate::step::stage_solutions::StageSolutions;
use crate::step::state::{Initial, State, Unknowns, blend, copy_runs, line, squared_distance};
use crate::weather::conditions::{Conditions, Instant, SolarMeans, SurfaceConditions, Weather};
use crate::weather::index::WeatherIndex;

use follow::Following;

/// Root of the sum of squared changes in the last Newton iteration [K]. Convergence is quadratic: the error left is
/// of the order of its square.
const TOLERANCE: f64 = 1e-6;
/// A solution is taken without another iteration to confirm it where the next change is foreseen to be below this [K].
const FORESEEN: f64 = 1e-8;
/// What is foreseen holds only for changes below this share of the melting range, and of 1 K.
const FORESIGHT: f64 = 0.05;
/// Iterations after which every third goes half-way only, lest it runs in a circle.
const PATIENCE: usize = 20;
/// Iterations before a step is given to the nested iteration, and rounds of that one before it is halved.
const MAX_ITERATIONS: usize = 60;
/// Sweeps over the stages of a step before it counts as unsolvable, and those of them that solve each stage only once.
const MAX_SWEEPS: usize = 40;
const SINGLE_SWEEPS: usize = 12;
/// Effective length of the stage that brings surfaces into balance [s]: too short for anything to be stored.
const INSTANT: f64 = 1e-3;
/// How often a step may be halved before it counts as unsolvable.
const MAX_HALVINGS: u32 = 6;

/// Time-stepping scheme.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// Two stages, second order, L-stable, one factorisation.
    Sdirk2,
    /// One stage, first order, keeps the maximum principle.
    BackwardEuler,
    /// The paper's: backward Euler with the apparent capacity at the old temperature. Loses latent heat.
    ApparentCapacity,
}

impl Scheme {
    /// Diagonal coefficient: a stage's effective length over the step.
    fn diagonal(self) -> f64 {
        match self {
            Self::Sdirk2 => 1.0 - core::f64::consts::FRAC_1_SQRT_2,
            Self::BackwardEuler | Self::ApparentCapacity => 1.0,
        }
    }

    /// Weights of the stages.
    #[must_use]
    pub fn weights(self) -> &'static [f64] {
        const DIAGONAL: f64 = 1.0 - core::f64::consts::FRAC_1_SQRT_2;
        match self {
            Self::Sdirk2 => &[1.0 - DIAGONAL, DIAGONAL],
            Self::BackwardEuler | Self::ApparentCapacity => &[1.0],
        }
    }

    fn storage_rule(self) -> StorageRule {
        match self {
            Self::ApparentCapacity => StorageRule::ApparentCapacity,
            Self::Sdirk2 | Self::BackwardEuler => StorageRule::Enthalpy,
        }
    }
}

/// Marches a building by one step at a time.
#[derive(Debug, Clone)]
pub struct Stepper<'a, S: Real> {
    pub(crate) plan: &'a Plan,
    /// Numbers of the run.
    pub coefficients: Coefficients<S>,
    numbers: &'a [S],
    scheme: Scheme,
    /// Linearised walls.
    pub chains: Vec<Chain<S>>,
    /// Those of constant properties.
    step_maps: StepMaps<S>,
    changing: Changing,
    responses: Vec<[[S; 2]; 2]>,
    /// Effective stage length of the factors in hand [s]; NaN: none.
    factored: f64,
    laws: BySurface<SurfaceLaws<S>>,
    /// Air entering each zone unasked: heat, of `T_outdoor - T_air` [W].
    inflow: Vec<Line<S>>,
    /// Outdoor air let into each zone, likewise.
    airing: Vec<Line<S>>,
    weather_index: WeatherIndex<S>,
    flow_index: FlowIndex<S>,
    conditions: Conditions<S>,
    /// What drives the other stage of a step whose stages are gone through again.
    other_conditions: Conditions<S>,
    /// Heat from the plant of each zone [W].
    load: Vec<S>,
    ideal_loads: IdealLoads<S>,
    /// The sun over the last step.
    pub sun: SolarMeans<S>,
    /// Convective conductance of the gaps of each wall that is a window, expected in each stage [W/(m2 K)].
    gap_convection: Vec<Vec<Vec<S>>>,
    /// Stage in hand.
    stage: usize,
    /// Heat of the walls into their surfaces at surfaces of 0 degC [W/m2].
    sources: Vec<[S; 2]>,
    /// Surfaces outside the zones, as functions of those inside.
    locals: Vec<ExteriorSurfaces<S>>,
    /// How much they give way to heat [m2 K/W].
    inverses: Vec<S>,
    block: CoupledSystem<'a, S>,
    zone_fronts: ZoneFronts<S>,
    iterate: Unknowns<S>,
    solved: Unknowns<S>,
    /// Start of the step before, from which the next is guessed.
    previous: Option<Unknowns<S>>,
    /// Square of the changes that can be foreseen [K2].
    foresight: S,
    held: Vec<S>,
    held_air: Vec<S>,
    /// Liquid fractions at the first stage of a step, for [`Counters::reversals`].
    midway: Vec<S>,
    /// Lanes whose iteration failed: what they hold means nothing any more.
    pub failed: S::Mask,
    /// What is left of the step, the next part last.
    parts: Vec<Part>,
    pub(crate) known: StageSolutions<S>,
    /// Only where slopes are carried along a known solution.
    following: Option<Box<Following<'a, S>>>,
    /// What was spent since the start.
    pub counters: Counters<S>,
}

/// What a run was spent on.
#[derive(Debug, Clone, Copy)]
pub struct Counters<S> {
    /// Newton iterations.
    pub iterations: usize,
    /// Stages that only the nested iteration solved.
    pub nested: usize,
    /// Steps that were halved.
    pub halvings: usize,
    /// Steps of phase-change cells with hysteresis in which melting and freezing followed each other: the memory, which
    /// changes at the end of a step, saw only the sum.
    pub reversals: S,
}

/// How a stage is solved.
#[derive(Debug, Clone, Copy)]
enum Search<S: Real> {
    /// One linear solve at the iterate.
    Once,
    /// To its end, in these lanes.
    Whole(S::Mask),
}

/// A part of a step.
#[derive(Debug, Clone, Copy)]
struct Part {
    step: usize,
    /// Start and length, in steps.
    from: f64,
    share: f64,
    halvings: u32,
}

impl Part {
    fn halves(self) -> [Self; 2] {
        let share = 0.5 * self.share;
        let first = Self { share, halvings: self.halvings + 1, ..self };
        [first, Self { from: self.from + share, ..first }]
    }
}

impl<'a, S: Real> Stepper<'a, S> {
    /// Prepares a plan with a parameter vector.
    #[must_use]
    pub fn new(plan: &'a Plan, numbers: &'a [S], scheme: Scheme) -> Self {
        let mut stepper = Self::with(plan, Coefficients::new(plan, numbers), numbers, scheme);
        if S::DERIVATIVES {
            stepper.following = Some(Box::new(Following::new(&stepper)));
        }
        stepper
    }

    /// Prepares a plan with coefficients; without numbers it can be driven by nothing.
    fn with(plan: &'a Plan, coefficients: Coefficients<S>, numbers: &'a [S], scheme: Scheme) -> Self {
        let chains: Vec<_> = coefficients.walls.iter().map(Chain::new).collect();
        let (changing, laws) = Changing::sort(plan, &coefficients);
        let zone_fronts = ZoneFronts::new(plan, &coefficients, &laws);
        let foresight = coefficients
            .walls
            .iter()
            .flat_map(|wall| &wall.pcm)
            .fold(S::one(), |narrowest, law| narrowest.min(law.width()));
        let foresight = foresight.scale(FORESIGHT);
        let zeros = |n: usize| vec![S::zero(); n];
        let unknowns = Unknowns {
            cells: zeros(plan.n_cells),
            surfaces: zeros(plan.surfaces.len()).into(),
            air: zeros(plan.zones.len()),
        };
        let weather_index = WeatherIndex::new(plan, &coefficients);
        let conditions = Conditions::new(plan, &coefficients, &weather_index);
        let flow_index = FlowIndex::new(plan, &coefficients);
        let means = SolarMeans::new(&conditions.sun);
        let gaps = coefficients.walls.iter().map(|wall| wall.glass.as_ref().map_or(0, Glass::filled_gaps));
        let gap_convection = vec![gaps.map(zeros).collect(); scheme.weights().len()];
        Self {
            plan,
            step_maps: StepMaps::new(plan, &coefficients, &chains, scheme.diagonal()),
            coefficients,
            numbers,
            scheme,
            changing,
            chains,
            responses: vec![[[S::zero(); 2]; 2]; plan.walls.len()],
            factored: f64::NAN,
            laws,
            inflow: vec![Line::zero(); plan.zones.len()],
            airing: vec![Line::zero(); plan.zones.len()],
            weather_index,
            flow_index,
            other_conditions: conditions.clone(),
            conditions,
            load: zeros(plan.zones.len()),
            ideal_loads: IdealLoads::new(&plan.ideal_loads, &unknowns, plan.rows(), scheme.weights().len()),
            sun: means,
            gap_convection,
            stage: 0,
            sources: vec![[S::zero(); 2]; plan.walls.len()],
            locals: vec![ExteriorSurfaces::None; plan.walls.len()],
            inverses: zeros(plan.walls.len()),
            block: CoupledSystem::new(&plan.reach, plan.own_rows, plan.constant_rows),
            zone_fronts,
            iterate: unknowns.clone(),
            solved: unknowns,
            previous: None,
            foresight: foresight * foresight,
            held: zeros(plan.n_cells),
            held_air: zeros(plan.zones.len()),
            midway: zeros(plan.n_cells),
            failed: S::Mask::splat(false),
            parts: Vec::new(),
            known: StageSolutions::nothing(),
            following: None,
            counters: Counters { iterations: 0, nested: 0, halvings: 0, reversals: S::zero() },
        }
    }

    /// The state that a run starts from.
    pub fn begin(&self, initial: &Initial) -> State<S> {
        let plan = self.plan;
        let (cells, surfaces, air) = match initial {
            Initial::Everywhere(temperature) => {
                let all = |count| vec![S::constant(*temperature); count];
                (all(plan.n_cells), all(plan.surfaces.len()), all(plan.zones.len()))
            }
            Initial::Given { cells, surfaces, air } => {
                let all = |given: &[f64]| given.iter().map(|&temperature| S::constant(temperature)).collect();
                (all(cells), all(surfaces), all(air))
            }
        };
        let mut state = State {
            memory: cells.iter().map(|&cell| PcmMemory::new(S::zero(), cell)).collect(),
            enthalpy: vec![S::zero(); plan.n_cells],
            load: vec![S::zero(); plan.zones.len()],
            cells,
            surfaces: surfaces.into(),
            air,
        };
        self.settle(&mut state);
        state
    }

    /// Enthalpies and memory that belong to the temperatures of a state, in the walls that change.
    fn settle(&self, state: &mut State<S>) {
        for &w in &self.changing.walls {
            let (wall, plan) = (&self.coefficients.walls[w], &self.plan.walls[w]);
            for (i, cell) in wall.cells.iter().enumerate() {
                let k = plan.first_cell + i;
                match &cell.matter {
                    Matter::Solid { capacity, .. } => {
                        state.enthalpy[k] = *capacity * state.cells[k];
                    }
                    Matter::Pcm(law) => {
                        let law = &wall.pcm[*law];
                        state.memory[k] = law.begin(state.cells[k]);
                        state.enthalpy[k] = law.at(state.cells[k], &state.memory[k]).enthalpy;
                    }
                }
            }
        }
    }

    /// Brings the surfaces of a state into balance with the weather: a stage so short that nothing is stored.
    ///
    /// # Errors
    /// [`EngineError::NotConverged`].
    pub fn balance_surfaces(&mut self, state: &mut State<S>, now: &Instant<'_>) -> Result<(), EngineError> {
        S::vectorised(
            #[inline(always)]
            || {
                self.conditions.update(self.plan, &self.coefficients, &self.weather_index, self.numbers, now);
                self.start(state, 0.0);
                self.solve_stage(state, INSTANT, (0, 0), Search::Whole(S::Mask::splat(true)))?;
                state.surfaces.copy_from_slice(&self.solved.surfaces);
                self.sun.restart();
                self.sun.add(&self.conditions.sun, 1.0);
                Ok(())
            },
        )
    }

    /// Cells whose temperatures are unknowns of their own, not consequences of others.
    pub(crate) fn changing_cells(&self) -> &[Range<usize>] {
        &self.changing.cells
    }

    /// A place for the unknowns of each stage.
    pub(crate) fn places(&self) -> Vec<Unknowns<S>> {
        vec![self.solved.clone(); self.scheme.weights().len()]
    }

    /// Forgets the step before: what comes next does not follow it.
    pub fn forget(&mut self) {
        self.previous = None;
    }

    /// One step of length `dt` [s].
    ///
    /// # Errors
    /// [`EngineError::NotConverged`].
    // Once, not at every place that takes steps: the compiler has enough to do.
    #[inline(never)]
    pub fn step(
        &mut self,
        state: &mut State<S>,
        weather: &Weather<'_>,
        step: usize,
        dt: f64,
        ledger: &mut Ledger<S>,
    ) -> Result<(), EngineError> {
        S::vectorised(
            #[inline(always)]
            || {
                self.parts.push(Part { step, from: 0.0, share: 1.0, halvings: 0 });
                self.known.halved = false;
                while let Some(part) = self.parts.pop() {
                    match self.attempt(state, weather, part, dt, ledger) {
                        Ok(()) if part.halvings == 0 => {}
                        // Parts differ in length: none is guessed from the one before it.
                        Ok(()) => self.forget(),
                        Err(error) => self.halve(part, error)?,
                    }
                }
                Ok(())
            },
        )
    }

    /// Puts two halves in the place of a part that could not be solved.
    #[cold]
    #[inline(never)]
    fn halve(&mut self, part: Part, error: EngineError) -> Result<(), EngineError> {
        let hopeless = S::LANES > 1 || part.halvings == MAX_HALVINGS;
        // What is not a number comes of what drives the step: parts of it would fare no better.
        let halved = matches!(error, EngineError::NotConverged { residual, .. } if !residual.is_nan());
        if hopeless || !halved {
            self.parts.clear();
            return Err(error);
        }
        self.counters.halvings += 1;
        self.known.halved = true;
        let [first, second] = part.halves();
        self.parts.extend([second, first]);
        self.forget();
        Ok(())
    }

    /// A part of a step; the state stays as it was when it fails.
    #[inline(always)]
    fn attempt(
        &mut self,
        state: &mut State<S>,
        weather: &Weather<'_>,
        part: Part,
        dt: f64,
        ledger: &mut Ledger<S>,
    ) -> Result<(), EngineError> {
        let length = part.share * dt;
        self.start(state, self.scheme.diagonal());
        let regulated = !self.plan.ideal_loads.is_empty();
        if regulated {
            self.set_out(state, weather.row(part.step, self.scheme.weights().len() - 1));
        }
        self.remember(state);
        let energy = if regulated {
            self.regulated_step(state, weather, part, length)?
        } else {
            self.free_step(state, weather, part, length)?
        };
        self.accept(state, &energy, ledger);
        Ok(())
    }

    /// The stages of a step without plants, one after the other.
    #[inline(always)]
    fn free_step(
        &mut self,
        state: &State<S>,
        weather: &Weather<'_>,
        part: Part,
        length: f64,
    ) -> Result<Power<S>, EngineError> {
        let (diagonal, weights) = (self.scheme.diagonal(), self.scheme.weights());
        let mut energy = Power::none();
        for (stage, &weight) in weights.iter().enumerate() {
            if stage > 0 {
                self.hold_over(state, diagonal);
            }
            self.conditions_at(weather, part, stage);
            let all = Search::Whole(S::Mask::splat(true));
            self.solve_stage(state, diagonal * length, (part.step, stage + 1), all)?;
            self.accumulate(weight * length, &mut energy);
        }
        Ok(energy)
    }

    /// The stages of a step, gone through again until their temperatures and the loads of the plants are right; see
    /// [`crate::step::ideal_loads`].
    #[inline(always)]
    fn regulated_step(
        &mut self,
        state: &State<S>,
        weather: &Weather<'_>,
        part: Part,
        length: f64,
    ) -> Result<Power<S>, EngineError> {
        let mut active = S::Mask::splat(true);
        let mut polish = self.further_sweeps();
        let mut before = S::zero();
        for sweep in 0..MAX_SWEEPS {
            let whole = sweep >= SINGLE_SWEEPS;
            let (mut energy, change, limited) = self.sweep(state, weather, (part, length), sweep, active)?;
            before = S::select(limited, S::zero(), before);
            // The first sweep books nothing: it is never the last.
            let still = self.settled(change, before) & S::Mask::splat(sweep > 0);
            let still = still | S::Mask::splat(whole);
            before = change;
            let settled = self.ideal_loads.correct(&self.solved.air, &mut self.load, active, polish > 0);
            let moving = active & !(settled & still) & !self.failed;
            if moving.any() {
                active = moving;
            } else if polish > 0 {
                polish -= 1;
                active = S::Mask::splat(true);
            } else {
                self.close(&mut energy, length);
                return Ok(energy);
            }
        }
        let lane = (0..S::LANES).find(|&lane| active.lane(lane)).unwrap_or(0);
        let (zone, residual) = self.ideal_loads.worst(lane);
        let place = format!("zone {} (load of its plant)", self.plan.description.zones[zone].name);
        Err(EngineError::NotConverged {
            step: part.step,
            stage: self.scheme.weights().len(),
            place,
            residual,
            iterations: MAX_SWEEPS,
        })
    }

    /// Guesses the loads of a step that ends with a forcing row, and the first stage.
    #[inline(always)]
    fn set_out(&mut self, state: &State<S>, row: &[f64]) {
        self.ideal_loads.begin(&self.coefficients.zones, row, &mut self.load, self.previous.is_some());
        let (iterate, diagonal) = (&self.iterate, self.scheme.diagonal());
        self.ideal_loads.ask(&self.load, |zone| line(state.air[zone], iterate.air[zone], 1.0 / diagonal));
        if let Some(previous) = &self.previous {
            let way = [previous.view(), self.ideal_loads.first.view()];
            self.iterate.go_on(&self.changing.inner, &state.view(), &way);
        }
    }

    /// Corrects the guess of a stage, once it is known what drives it.
    #[inline(always)]
    fn guess_anew(&mut self, state: &State<S>, stage: usize) {
        if stage > 0 {
            // A straight line on from the first stage would carry the error of its load.
            let way = [self.ideal_loads.first.view(), state.view()];
            self.iterate.go_on(&self.changing.inner, &self.solved.view(), &way);
            return;
        }
        // Where the outdoor air turns, the surfaces outdoors turn with it.
        let [before, now] = self.ideal_loads.outdoor;
        let turn = self.conditions.outdoor_air - line(before, now, 1.0 + self.scheme.diagonal());
        for (guess, surface) in self.iterate.surfaces.iter_mut().zip(&self.coefficients.surfaces) {
            if matches!(surface.boundary, Boundary::Outdoors(_)) {
                *guess += turn;
            }
        }
    }

    /// Sweeps that are made once the numbers are found: for slopes, and where slopes will go along these numbers.
    #[inline(always)]
    fn further_sweeps(&self) -> usize {
        if !S::DERIVATIVES {
            // Numbers settle quadratically, but what a parameter does to them one sweep later: quotients would show it.
            return if self.known.keeps() { 2 } else { 0 };
        }
        // Responses leave out what a load does to the convection expected in gaps: its slope is then found in two rounds.
        if self.plan.windows.is_empty() { 1 } else { 2 }
    }

    /// All stages of a step at the loads in hand: one linear solve of each, or after many sweeps as many as it takes.
    /// Gives the heat of all but the last stage, the square of the change, and where it was limited. Lanes that are not
    /// active repeat the sweep before bit for bit.
    #[inline(always)]
    fn sweep(
        &mut self,
        state: &State<S>,
        weather: &Weather<'_>,
        (part, length): (Part, f64),
        sweep: usize,
        active: S::Mask,
    ) -> Result<(Power<S>, S, S::Mask), EngineError> {
        let (diagonal, weights) = (self.scheme.diagonal(), self.scheme.weights());
        let (mut energy, mut change, mut limited) = (Power::none(), S::zero(), S::Mask::splat(false));
        let (again, answer) = (sweep > 0, self.ideal_loads.answering(sweep, active));
        if again {
            copy_runs(&self.changing.cells, &mut self.held, &state.enthalpy);
            self.held_air.copy_from_slice(&state.air);
            self.known.restart();
        }
        for (stage, &weight) in weights.iter().enumerate() {
            if stage > 0 {
                self.hold_over(state, diagonal);
            }
            if weights.len() > 1 && (again || stage > 0) {
                core::mem::swap(&mut self.conditions, &mut self.other_conditions);
            }
            if again {
                self.ideal_loads.guess(stage, &self.changing.cells, &mut self.iterate, &mut self.solved);
                limited = limited | self.advance(active, 0, &state.memory);
            } else {
                self.conditions_at(weather, part, stage);
                if self.ideal_loads.follows {
                    self.guess_anew(state, stage);
                }
            }
            let search = if sweep < SINGLE_SWEEPS { Search::Once } else { Search::Whole(active) };
            let sound = self.solve_stage(state, diagonal * length, (part.step, stage + 1), search)?;
            change += S::select(sound, self.distance(&self.iterate), S::constant(f64::INFINITY));
            if answer {
                self.respond(stage, diagonal * length);
            }
            self.ideal_loads.keep(stage, &mut self.iterate, &self.solved);
            if again && stage + 1 < weights.len() {
                self.accumulate(weight * length, &mut energy);
            }
        }
        Ok((energy, change, limited))
    }

    /// Brings the airs onto their set points by the loads of the last stage, and books it.
    #[inline(always)]
    fn close(&mut self, energy: &mut Power<S>, length: f64) {
        let weights = self.scheme.weights();
        let weight = weights[weights.len() - 1];
        if self.ideal_loads.asking(!self.failed) {
            for (response, &zone) in self.ideal_loads.responses.iter_mut().zip(&self.plan.ideal_loads) {
                response.right.fill(S::zero());
                response.right[self.plan.zones[zone].air_row] = S::one();
                self.zone_fronts.forward(&mut response.right);
                self.block.solve_again(&mut response.right);
                self.zone_fronts.back(&mut response.right);
                let last = response.stages.len() - 1;
                for (air, plan) in response.stages[last].air.iter_mut().zip(&self.plan.zones) {
                    *air = response.right[plan.air_row];
                }
            }
            self.ideal_loads.complete(&self.solved.air, &self.load, &mut self.block.right);
            self.resolve_all();
            self.known.amend(&self.solved);
        }
        for (p, &zone) in self.plan.ideal_loads.iter().enumerate() {
            self.load[zone] += self.ideal_loads.correction[p];
        }
        self.accumulate(weight * length, energy);
        self.ideal_loads.outdoor = [self.ideal_loads.outdoor[1], self.conditions.outdoor_air];
        for (p, &zone) in self.plan.ideal_loads.iter().enumerate() {
            // The mean over the step.
            self.load[zone] = self.load[zone] - self.ideal_loads.correction[p].scale(1.0 - weight);
        }
    }

    /// Carries the solution of the room block to all airs and surfaces, and to the cells of walls that change, once more.
    #[inline(always)]
    fn resolve_all(&mut self) {
        for (zone, plan) in self.plan.zones.iter().enumerate() {
            self.solved.air[zone] = self.block.right[plan.air_row];
        }
        for (w, wall) in self.plan.walls.iter().enumerate() {
            let surfaces = self.resolve_surfaces(w, self.locals[w]);
            self.solved.surfaces.set_pair(w, surfaces);
            if wall.nonlinear {
                let cells = wall.first_cell..wall.first_cell + wall.len();
                self.chains[w].temperatures(surfaces, &mut self.solved.cells[cells]);
            }
        }
    }

    /// How the stage just solved answers to a watt of each plant.
    #[inline(always)]
    fn respond(&mut self, stage: usize, length: f64) {
        let mut responses = core::mem::take(&mut self.ideal_loads.responses);
        for (response, &zone) in responses.iter_mut().zip(&self.plan.ideal_loads) {
            response.right.fill(S::zero());
            response.right[self.plan.zones[zone].air_row] = S::one();
            if stage > 0 {
                self.carry_over(response, length);
            } else {
                response.known.fill(S::zero());
            }
            self.zone_fronts.forward(&mut response.right);
            self.block.solve_again(&mut response.right);
            self.zone_fronts.back(&mut response.right);
            self.spread(response, stage);
        }
        self.ideal_loads.responses = responses;
    }

    /// What the first stage's answer leaves to the second: heat held in walls and airs.
    #[inline(always)]
    fn carry_over(&self, response: &mut Response<S>, length: f64) {
        let diagonal = self.scheme.diagonal();
        let ratio = (1.0 - diagonal) / diagonal;
        let first = &response.stages[0];
        for (zone, plan) in self.plan.zones.iter().enumerate() {
            let storage = self.coefficients.zones[zone].capacity.scale(ratio / length);
            response.right[plan.air_row] += storage * first.air[zone];
        }
        for (w, carried) in self.step_maps.carried() {
            let [outside, inside] = first.surfaces.pair(w);
            response.sources[w] = carried.map(|[a, b]| a * outside + b * inside);
        }
        for (w, wall) in self.plan.walls.iter().enumerate() {
            if wall.nonlinear {
                let cells = wall.first_cell..wall.first_cell + wall.len();
                let (held, known) = (&response.held[cells.clone()], &mut response.known[cells]);
                response.sources[w] = self.chains[w].source_changes(held, known);
            }
            let source = response.sources[w];
            let area = self.coefficients.walls[w].area;
            for e in 0..2 {
                let SurfaceRole::Zone { row, .. } = self.plan.surfaces[SurfaceId::new(w, e)].role else {
                    continue;
                };
                let mut heat = source[e];
                if let ExteriorSurfaces::One { side, .. } = self.locals[w] {
                    heat += self.responses[w][e][side] * self.free_answer(w, side, source[side]);
                }
                response.right[row] += area * heat;
            }
        }
    }

    /// Rise of a local surface with the heat that its wall sends into it, the other surface held [K].
    #[inline(always)]
    fn free_answer(&self, w: usize, side: usize, source: S) -> S {
        match self.local_balance(SurfaceId::new(w, side)) {
            ExteriorBalance::Fixed(_) => S::zero(),
            ExteriorBalance::Gain(_) => source * self.inverses[w],
        }
    }

    /// Carries the answer of the room block to all surfaces, and to the cells of walls that change.
    #[inline(always)]
    fn spread(&self, response: &mut Response<S>, stage: usize) {
        let diagonal = self.scheme.diagonal();
        let ratio = (1.0 - diagonal) / diagonal;
        let Response { stages, held, known, right, sources } = response;
        let answer = &mut stages[stage];
        for (zone, plan) in self.plan.zones.iter().enumerate() {
            answer.air[zone] = right[plan.air_row];
        }
        for (w, wall) in self.plan.walls.iter().enumerate() {
            let mut surfaces = [S::zero(); 2];
            for (e, surface) in surfaces.iter_mut().enumerate() {
                if let SurfaceRole::Zone { row, .. } = self.plan.surfaces[SurfaceId::new(w, e)].role {
                    *surface = right[row];
                }
            }
            if let ExteriorSurfaces::One { side, line } = self.locals[w] {
                let source = if stage > 0 { sources[w][side] } else { S::zero() };
                surfaces[side] = line.slope * surfaces[1 - side] + self.free_answer(w, side, source);
            }
            answer.surfaces.set_pair(w, surfaces);
            if !wall.nonlinear {
                continue;
            }
            let cells = wall.first_cell..wall.first_cell + wall.len();
            let chain = &self.chains[w];
            chain.temperature_changes(&known[cells.clone()], surfaces, &mut answer.cells[cells.clone()]);
            if stage == 0 {
                for (i, k) in cells.enumerate() {
                    held[k] = chain.storage[i].capacity * answer.cells[k].scale(ratio);
                }
            }
        }
    }

    /// The weather at a stage of a step, or of a part of it.
    ///
    /// Within a step of two stages the weather is the straight line through both: SDIRK2 sums a straight line exactly,
    /// so that the parts of a step add up to the heat of the whole one. With one stage it is constant.
    #[inline(always)]
    fn conditions_at(&mut self, weather: &Weather<'_>, part: Part, stage: usize) {
        let read = |conditions: &mut Conditions<S>, stage: usize| {
            let now = weather.at(part.step, stage);
            conditions.update(self.plan, &self.coefficients, &self.weather_index, self.numbers, &now);
        };
        read(&mut self.conditions, stage);
        let weights = self.scheme.weights();
        if stage == 0 {
            self.sun.restart();
        }
        if part.halvings == 0 || weights.len() == 1 {
            self.sun.add(&self.conditions.sun, weights[stage]);
        } else {
            let (mut first, mut second) = (self.conditions.clone(), self.conditions.clone());
            read(&mut first, 0);
            read(&mut second, 1);
            if stage == 0 {
                // The mean is that of the whole step.
                self.sun.add(&first.sun, weights[0]);
                self.sun.add(&second.sun, weights[1]);
            }
            let diagonal = self.scheme.diagonal();
            let place = part.from + part.share * if stage == 0 { diagonal } else { 1.0 };
            self.conditions.interpolate(&first, &second, (place - diagonal) / (1.0 - diagonal));
        }
    }

    /// Sets out from a state; guesses that it goes on as in the step before for a share of a step.
    #[inline(always)]
    fn start(&mut self, state: &State<S>, share: f64) {
        copy_runs(&self.changing.cells, &mut self.held, &state.enthalpy);
        self.held_air.copy_from_slice(&state.air);
        self.load.copy_from_slice(&state.load);
        self.step_maps.begin();
        self.known.restart();
        match &self.previous {
            Some(previous) if share > 0.0 => {
                self.iterate.extrapolate(
                    self.plan,
                    &self.coefficients,
                    (&self.changing.watched, &self.changing.walls),
                    &[previous.view(), state.view()],
                    1.0 + share,
                    &state.memory,
                );
            }
            _ => {
                copy_runs(&self.changing.cells, &mut self.iterate.cells, &state.cells);
                self.iterate.surfaces.copy_from_slice(&state.surfaces);
                self.iterate.air.copy_from_slice(&state.air);
            }
        }
        self.expect_gaps(0, state);
    }

    /// Keeps the start of this step for the guess of the next.
    #[inline(always)]
    fn remember(&mut self, state: &State<S>) {
        let previous = self.previous.get_or_insert_with(|| self.solved.clone());
        copy_runs(&self.changing.cells, &mut previous.cells, &state.cells);
        previous.surfaces.copy_from_slice(&state.surfaces);
        previous.air.copy_from_slice(&state.air);
    }

    /// What the second stage starts from: `H_n + (1 - g)/g (H_stage - H_n)`; its end is guessed on a straight line.
    #[inline(always)]
    fn hold_over(&mut self, state: &State<S>, diagonal: f64) {
        let ratio = (1.0 - diagonal) / diagonal;
        self.step_maps.hold_over(&self.solved.surfaces);
        for &w in &self.changing.walls {
            let (wall, chain) = (&self.plan.walls[w], &self.chains[w]);
            for i in 0..wall.len() {
                let k = wall.first_cell + i;
                self.held[k] = line(state.enthalpy[k], chain.storage[i].reached(), ratio);
                self.midway[k] = chain.liquid_fraction(i);
            }
        }
        for (zone, held) in self.held_air.iter_mut().enumerate() {
            *held = state.air[zone] + (self.solved.air[zone] - state.air[zone]).scale(ratio);
        }
        self.extrapolate_on(state);
        self.expect_gaps(1, state);
    }

    /// Guesses the end of a step on the straight line through its start and the first stage.
    #[inline(always)]
    fn extrapolate_on(&mut self, state: &State<S>) {
        self.iterate.extrapolate(
            self.plan,
            &self.coefficients,
            (&self.changing.watched, &self.changing.walls),
            &[state.view(), self.solved.view()],
            1.0 / self.scheme.diagonal(),
            &state.memory,
        );
    }

    /// Takes the last stage as the new state and books the step.
    #[inline(always)]
    fn accept(&mut self, state: &mut State<S>, energy: &Power<S>, ledger: &mut Ledger<S>) {
        let mut stored = self.step_maps.finish(&self.solved.surfaces, &mut state.cells);
        stored += self.accept_changing(state);
        for (zone, numbers) in self.coefficients.zones.iter().enumerate() {
            stored += numbers.capacity * (self.solved.air[zone] - state.air[zone]);
        }
        state.surfaces.copy_from_slice(&self.solved.surfaces);
        state.air.copy_from_slice(&self.solved.air);
        state.load.copy_from_slice(&self.load);
        ledger.book(energy, stored);
    }

    /// Cells of the walls that change at the end of the last stage, and what they remember; the heat stored [J].
    #[inline(always)]
    fn accept_changing(&mut self, state: &mut State<S>) -> S {
        let mut stored = S::zero();
        for &w in &self.changing.walls {
            let (wall, chain, numbers) = (&self.plan.walls[w], &self.chains[w], &self.coefficients.walls[w]);
            for (i, cell) in numbers.cells.iter().enumerate() {
                let k = wall.first_cell + i;
                let temperature = self.solved.cells[k];
                let mut enthalpy = chain.storage[i].reached();
                if let Matter::Pcm(law) = cell.matter {
                    let law = &numbers.pcm[law];
                    let mut fraction = chain.reached_fraction(i);
                    // Where the way taken matters: the point itself.
                    if law.remembers() || self.scheme == Scheme::ApparentCapacity {
                        let point = law.at(temperature, &state.memory[k]);
                        fraction = point.liquid_fraction;
                        if self.scheme == Scheme::ApparentCapacity {
                            // What the material holds in truth, not what the scheme believes to have stored.
                            enthalpy = point.enthalpy;
                        }
                    }
                    if law.remembers() && self.scheme == Scheme::Sdirk2 {
                        let start = state.memory[k].liquid_fraction;
                        let turned = reversed(start, self.midway[k], fraction);
                        self.counters.reversals += S::select(turned, S::one(), S::zero());
                    }
                    state.memory[k] = law.next(&state.memory[k], temperature, fraction);
                }
                stored += numbers.area * cell.thickness * (enthalpy - state.enthalpy[k]);
                state.enthalpy[k] = enthalpy;
                state.cells[k] = temperature;
            }
        }
        stored
    }

    /// Solves one stage: by one linear solve where one is asked for, else by iteration. False in the lanes that are at no
    /// number.
    // Not inlined, for the compiler's sake: it is by far the largest part of a step.
    #[inline(never)]
    fn solve_stage(
        &mut self,
        state: &State<S>,
        length: f64,
        place: (usize, usize),
        search: Search<S>,
    ) -> Result<S::Mask, EngineError> {
        S::vectorised(
            #[inline(always)]
            || {
                self.stage = place.1.saturating_sub(1);
                self.begin_stage(state, length);
                let mut sound = S::Mask::splat(true);
                match search {
                    Search::Once => sound = self.solve_once(state, length),
                    Search::Whole(active) => self.iterate_stage(state, length, place, active)?,
                }
                self.known.keep(&self.solved);
                Ok(sound)
            },
        )
    }

    /// One linear solve at the iterate.
    #[inline(always)]
    fn solve_once(&mut self, state: &State<S>, length: f64) -> S::Mask {
        self.counters.iterations += 1;
        self.linearise_walls(state, None);
        self.linearise_surfaces(false);
        self.solve_linear(length);
        self.finish_stage()
    }

    /// Newton's iteration for one stage. Leaves the solution in `solved` and the linearisation that produced
    /// it in the chains and laws, so that every flux can be booked at the value the last solve used.
    ///
    /// A lane that has converged, or was not active from the start, keeps its iterate: later solves repeat its last one
    /// bit for bit.
    #[inline(always)]
    fn iterate_stage(
        &mut self,
        state: &State<S>,
        length: f64,
        place: (usize, usize),
        mut active: S::Mask,
    ) -> Result<(), EngineError> {
        active = active & !self.failed;
        let mut polish = S::DERIVATIVES;
        // Square of the change before this one; zero where it says nothing of the next.
        let mut before = S::zero();
        for iteration in 0..MAX_ITERATIONS {
            self.counters.iterations += 1;
            self.linearise_walls(state, None);
            self.linearise_surfaces(false);
            self.solve_linear(length);
            let change = self.distance(&self.iterate);
            active = active & !self.settled(change, before);
            if active.any() && iteration + 1 == MAX_ITERATIONS {
                // The last change stays to be seen: it is what an error tells.
                break;
            }
            if active.any() {
                let limited = self.advance(active, iteration, &state.memory);
                before = S::select(limited, S::zero(), change);
            } else if polish {
                polish = false;
                self.advance(S::Mask::splat(true), 0, &state.memory);
            } else {
                let lost = !(self.finish_stage() | self.failed);
                return if lost.any() { self.lose(lost, place) } else { Ok(()) };
            }
        }
        self.finish_stage();
        if S::LANES > 1 {
            return self.lose(active, place);
        }
        let error = self.not_converged(active, place);
        if self.solve_nested(state, length) { Ok(()) } else { Err(error) }
    }

    /// Gives up lanes: each is run again alone, with all that is done for one there; the others go on.
    #[cold]
    #[inline(never)]
    fn lose(&mut self, lanes: S::Mask, place: (usize, usize)) -> Result<(), EngineError> {
        if S::LANES > 1 {
            self.failed = self.failed | lanes;
            if (!self.failed).any() {
                return Ok(());
            }
        }
        Err(self.not_converged(lanes, place))
    }

    /// The nested iteration of Casulli & Zanolli (2010), doi:10.1137/100786320: the enthalpy is the difference of two
    /// convex functions; the outer iteration goes along the tangent of the second, the inner one is Newton's on the
    /// first. Each converges from one side as long as the rest is linear.
    #[cold]
    #[inline(never)]
    fn solve_nested(&mut self, state: &State<S>, length: f64) -> bool {
        // Colder than any melting: there the second function is zero.
        const SOLID: f64 = -273.15;
        let state = State { memory: self.complete_memory(state), ..state.clone() };
        let enough = S::constant(TOLERANCE * TOLERANCE);
        let mut outer =
            Unknowns { cells: state.cells.clone(), surfaces: state.surfaces.clone(), air: state.air.clone() };
        self.iterate.copy_from(&outer);
        outer.cells.fill(S::constant(SOLID));
        for _ in 0..MAX_ITERATIONS {
            for _ in 0..MAX_ITERATIONS {
                self.counters.iterations += 1;
                self.linearise_walls(&state, Some(&outer.cells));
                self.linearise_surfaces(false);
                self.solve_linear(length);
                let settled = self.distance(&self.iterate).lt(enough);
                self.iterate.copy_from(&self.solved);
                if settled.any() {
                    break;
                }
            }
            if self.distance(&outer).lt(enough).any() {
                self.counters.nested += 1;
                return self.finish_stage().any();
            }
            outer.copy_from(&self.solved);
        }
        false
    }

    fn complete_memory(&self, state: &State<S>) -> Vec<PcmMemory<S>> {
        let mut memory = state.memory.clone();
        for (wall, numbers) in self.plan.walls.iter().zip(&self.coefficients.walls) {
            for (i, cell) in numbers.cells.iter().enumerate() {
                if let Matter::Pcm(law) = cell.matter {
                    let k = wall.first_cell + i;
                    memory[k] = numbers.pcm[law].complete(&memory[k]);
                }
            }
        }
        memory
    }

    /// Where the changes (squared) are small, or the next is foreseen to be: Newton's iteration squares them.
    #[inline(always)]
    fn settled(&self, change: S, before: S) -> S::Mask {
        let small = change.lt(S::constant(TOLERANCE * TOLERANCE));
        // e2 = e1 (e1/e0)^2, in squares.
        let foreseen = (change * change * change).lt((before * before).scale(FORESEEN * FORESEEN));
        small | (foreseen & change.lt(self.foresight))
    }

    /// Everything that stays during a stage: what constant walls send into their surfaces, what the wind makes of films; and
    /// the surfaces of constant walls, eliminated, where they answer to temperatures in straight lines.
    #[inline(always)]
    fn begin_stage(&mut self, state: &State<S>, length: f64) {
        let new = self.factor_constant(length) | self.changing.by_wind;
        if self.stage == 0 {
            self.step_maps.first_sources(&state.cells, &mut self.sources);
        } else {
            self.step_maps.second_sources(&mut self.sources);
        }
        self.zone_fronts.begin(&self.conditions, &self.sources);
        self.blow(false);
        if !self.changing.curved {
            self.enter_constant(new, true);
        }
    }

    /// What the wind makes of films that depend on nothing else; those in rooms see to it, unless asked.
    #[inline(always)]
    fn blow(&mut self, all: bool) {
        for &surface in &self.changing.bends(all).windy {
            let numbers = &self.coefficients.surfaces[surface];
            self.laws[surface].convection.slope =
                self.conditions.surfaces[surface].forced[0] * numbers.area_factor;
        }
    }

    /// Factors the walls of constant properties for a stage length [s], and tells it to the others. True where that was
    /// not done before.
    #[inline(always)]
    fn factor_constant(&mut self, length: f64) -> bool {
        let new = self.factored.to_bits() != length.to_bits();
        if new {
            for &w in &self.changing.constant {
                self.responses[w] = self.chains[w].factor(&self.coefficients.walls[w], length);
            }
            for &w in &self.changing.walls {
                self.chains[w].pace(&self.coefficients.walls[w], length);
            }
            self.step_maps.factor(&self.chains);
            self.zone_fronts.respond(&self.responses);
            self.factored = length;
        }
        new
    }

    /// Takes the convection in gaps at the temperatures that are expected in a stage: those of the step's start in the
    /// first, so that a step follows from the state and the weather alone.
    #[inline(always)]
    fn expect_gaps(&mut self, stage: usize, state: &State<S>) {
        let expected = if stage == 0 { &state.cells } else { &self.iterate.cells };
        for &w in &self.plan.windows {
            if let Some(glass) = &self.coefficients.walls[w].glass {
                let wall = &self.plan.walls[w];
                let cells = &expected[wall.first_cell..wall.first_cell + wall.len()];
                glass.expect(cells, &mut self.gap_convection[stage][w]);
            }
        }
    }

    #[inline(always)]
    fn linearise_walls(&mut self, state: &State<S>, outer: Option<&[S]>) {
        for i in 0..self.changing.walls.len() {
            let w = self.changing.walls[i];
            self.linearise_wall(w, state, outer);
            let wall = &self.plan.walls[w];
            let (chain, held) =
                (&mut self.chains[w], &self.held[wall.first_cell..wall.first_cell + wall.len()]);
            let mut windows = self.plan.windows.iter().zip(&self.conditions.sun.windows);
            let condensed = match windows.find(|(window, _)| **window == w) {
                // The sun in the panes.
                Some((_, sun)) => chain.condense_heated(held, &sun.cells),
                None => chain.condense(held),
            };
            (self.sources[w], self.responses[w]) = (condensed.source, condensed.response);
        }
    }

    /// Linearises a wall that changes about the iterate.
    #[inline(always)]
    fn linearise_wall(&mut self, w: usize, state: &State<S>, outer: Option<&[S]>) {
        let wall = &self.plan.walls[w];
        let cells = wall.first_cell..wall.first_cell + wall.len();
        let numbers = &self.coefficients.walls[w];
        let at = Iterate {
            cells: &self.iterate.cells[cells.clone()],
            surfaces: self.iterate.surfaces.pair(w),
            outer: outer.map(
                #[inline(always)]
                |outer| &outer[cells.clone()],
            ),
        };
        let start = Start {
            cells: &state.cells[cells.clone()],
            enthalpy: &state.enthalpy[cells.clone()],
            memory: &state.memory[cells],
        };
        let chain = &mut self.chains[w];
        if let Some(glass) = &numbers.glass {
            let links = &mut chain.links;
            glass.linearise(
                at.cells,
                &self.gap_convection[self.stage][w],
                #[inline(always)]
                |link, GapTangent { left, right, offset }| links[link] = Link { left, right, offset },
            );
        } else {
            chain.linearise(numbers, &at, &start, self.scheme.storage_rule());
        }
    }

    /// Linearises what depends on the temperatures of surfaces and airs; surfaces in rooms only on demand.
    #[inline(always)]
    fn linearise_surfaces(&mut self, all: bool) {
        let bends = self.changing.bends(all);
        for &index in &bends.bent {
            let (surface, at) = (&self.coefficients.surfaces[index], &self.conditions.surfaces[index]);
            let air = match self.plan.surfaces[index].role {
                SurfaceRole::Zone { zone, .. } => self.iterate.air[zone],
                SurfaceRole::Exterior => at.temperature,
            };
            if let Some(convection) = &surface.convection {
                let difference = self.iterate.surfaces[index] - air;
                let flux = convection.flux(difference, &at.forced);
                let (flux, slope) = (flux.flux * surface.area_factor, flux.slope * surface.area_factor);
                self.laws[index].convection = Line::tangent(flux, slope, difference);
            }
        }
        for &index in &bends.radiant {
            let temperature = self.iterate.surfaces[index];
            let (value, slope) = Emission::Exact.at(temperature);
            self.laws[index].emission = Line::tangent(value, slope, temperature);
        }
        for (zone, numbers) in self.coefficients.zones.iter().enumerate() {
            let (wind, outdoor, air) =
                (self.conditions.wind, self.conditions.outdoor_air, self.iterate.air[zone]);
            self.inflow[zone] =
                air_flow::infiltration(&numbers.infiltration, numbers.air_capacity, wind, outdoor, air);
            self.airing[zone] = self.conditions.zones[zone].outdoor_heat(numbers, wind, outdoor, air);
        }
    }

    /// Solves the linearised building into `solved`: airs, walls that change and their surfaces; the other surfaces, too, where
    /// the next iteration depends on them.
    #[inline(always)]
    fn solve_linear(&mut self, length: f64) {
        if self.changing.curved {
            self.enter_constant(true, true);
        }
        self.enter_changing(length);
        self.block.solve_rest();
        for (zone, plan) in self.plan.zones.iter().enumerate() {
            self.solved.air[zone] = self.block.right[plan.air_row];
        }
        for &w in &self.changing.walls {
            let wall = &self.plan.walls[w];
            let surfaces = self.resolve_surfaces(w, self.locals[w]);
            self.solved.surfaces.set_pair(w, surfaces);
            let cells = wall.first_cell..wall.first_cell + wall.len();
            self.chains[w].temperatures(surfaces, &mut self.solved.cells[cells]);
        }
        if self.changing.curved {
            self.resolve_constant();
        }
    }

    /// Enters what changes from iteration to iteration: the other walls and all that acts on airs.
    #[inline(always)]
    fn enter_changing(&mut self, length: f64) {
        self.block.begin();
        for i in 0..self.changing.walls.len() {
            let w = self.changing.walls[i];
            self.locals[w] = self.eliminate_wall(w, true);
        }
        for zone in 0..self.plan.zones.len() {
            self.enter_air(zone, length);
        }
        for (path, &conductance) in self.coefficients.paths.iter().zip(&self.conditions.paths) {
            let [a, b] = path.between.map(|zone| self.plan.zones[zone].air_row);
            self.block.couple(a, b, conductance);
        }
    }

    /// Enters the walls of constant properties, and films and radiation in zones, and eliminates the surfaces of the former;
    /// without `matrix` only the right-hand sides; `bend`: along the tangents at the iterate, else as laws stand.
    #[inline(always)]
    fn enter_constant(&mut self, matrix: bool, bend: bool) {
        self.block.clear_right();
        if matrix {
            self.block.clear_matrix();
        }
        for i in 0..self.changing.shared.len() {
            let w = self.changing.shared[i];
            self.locals[w] = self.eliminate_wall(w, matrix);
        }
        let front = if matrix { Front::Whole } else { Front::Right };
        let iterate = bend.then_some(&self.iterate);
        self.zone_fronts.eliminate(iterate, front, self.changing.stays(), &mut self.block);
        if matrix {
            self.block.keep_matrix();
        }
        self.block.keep_right();
    }

    /// Surfaces of the walls of constant properties.
    #[inline(always)]
    fn resolve_constant(&mut self) {
        self.block.solve_first();
        self.zone_fronts.resolve(self.changing.stays(), &mut self.block.right, &mut self.solved.surfaces);
        for &w in &self.changing.shared {
            let surfaces = self.resolve_surfaces(w, self.locals[w]);
            self.solved.surfaces.set_pair(w, surfaces);
        }
    }

    /// Enters a wall into the room block, its local surfaces eliminated.
    #[inline(always)]
    fn eliminate_wall(&mut self, w: usize, matrix: bool) -> ExteriorSurfaces<S> {
        let (source, response) = (self.sources[w], self.responses[w]);
        let area = self.coefficients.walls[w].area;
        let roles =
            [self.plan.surfaces[SurfaceId::outside(w)].role, self.plan.surfaces[SurfaceId::inside(w)].role];
        match roles {
            [SurfaceRole::Exterior, SurfaceRole::Exterior] => {
                let (outer, inner) =
                    (self.local_balance(SurfaceId::outside(w)), self.local_balance(SurfaceId::inside(w)));
                ExteriorSurfaces::Both(solve_pair(outer, inner, source, response))
            }
            [SurfaceRole::Zone { row: outer, .. }, SurfaceRole::Zone { row: inner, .. }] => {
                for (e, (mine, other)) in [(outer, inner), (inner, outer)].into_iter().enumerate() {
                    if matrix {
                        self.block.add(mine, mine, -(area * response[e][e]));
                        self.block.add(mine, other, -(area * response[e][1 - e]));
                    }
                    self.block.right[mine] += area * source[e];
                }
                ExteriorSurfaces::None
            }
            [SurfaceRole::Zone { row, .. }, SurfaceRole::Exterior] => self.eliminate_one(w, 0, row, matrix),
            [SurfaceRole::Exterior, SurfaceRole::Zone { row, .. }] => self.eliminate_one(w, 1, row, matrix),
        }
    }

    /// A wall whose surface `e` is in a zone and whose other surface is local.
    #[inline(always)]
    fn eliminate_one(&mut self, w: usize, e: usize, row: usize, matrix: bool) -> ExteriorSurfaces<S> {
        let source = self.sources[w];
        let (response, area, o) = (self.responses[w], self.coefficients.walls[w].area, 1 - e);
        let balance = self.local_balance(SurfaceId::new(w, o));
        let slope = match (balance, self.locals[w]) {
            (ExteriorBalance::Fixed(_), _) => S::zero(),
            (ExteriorBalance::Gain(_), ExteriorSurfaces::One { line, .. }) if !matrix => line.slope,
            (ExteriorBalance::Gain(gain), _) => {
                self.inverses[w] = S::one() / (gain.slope - response[o][o]);
                response[o][e] * self.inverses[w]
            }
        };
        let offset = match balance {
            ExteriorBalance::Fixed(value) => value,
            ExteriorBalance::Gain(gain) => (source[o] + gain.offset) * self.inverses[w],
        };
        if matrix {
            self.block.add(row, row, -(area * (response[e][e] + response[e][o] * slope)));
        }
        self.block.right[row] += area * (source[e] + response[e][o] * offset);
        ExteriorSurfaces::One { side: o, line: Line { offset, slope } }
    }

    /// Heat from outside into a local surface, `offset - slope T`, or the temperature it is held at.
    #[inline(always)]
    fn local_balance(&self, index: SurfaceId) -> ExteriorBalance<S> {
        let surface = &self.coefficients.surfaces[index];
        let (at, laws) = (&self.conditions.surfaces[index], &self.laws[index]);
        match surface.boundary {
            Boundary::Imposed(_) if surface.convection.is_none() => ExteriorBalance::Fixed(at.temperature),
            Boundary::Adiabatic => ExteriorBalance::Gain(Line { offset: at.solar, slope: S::zero() }),
            _ => ExteriorBalance::Gain(Line {
                offset: at.solar + at.longwave + laws.convection.slope * at.temperature
                    - laws.convection.offset
                    - surface.emissivity * laws.emission.offset,
                slope: laws.convection.slope + surface.emissivity * laws.emission.slope,
            }),
        }
    }

    /// Storage of the air of a zone, what enters it, and the heat released into it.
    #[inline(always)]
    fn enter_air(&mut self, zone: usize, length: f64) {
        let (air, numbers) = (self.plan.zones[zone].air_row, &self.coefficients.zones[zone]);
        let (inflow, airing) = (self.inflow[zone], self.airing[zone]);
        let entering = Line { offset: inflow.offset + airing.offset, slope: inflow.slope + airing.slope };
        let storage = numbers.capacity.scale(1.0 / length);
        self.block.add(air, air, storage + entering.slope);
        self.block.right[air] +=
            storage * self.held_air[zone] + entering.offset + entering.slope * self.conditions.outdoor_air;
        self.block.right[air] += self.conditions.zones[zone].convective + self.load[zone];
    }

    /// Solution at a surface in a zone.
    #[inline(always)]
    fn zone_surface(&self, index: SurfaceId) -> S {
        self.block.right[self.plan.row(index)]
    }

    #[inline(always)]
    fn resolve_surfaces(&self, w: usize, local: ExteriorSurfaces<S>) -> [S; 2] {
        match local {
            ExteriorSurfaces::Both(surfaces) => surfaces,
            ExteriorSurfaces::None => {
                [self.zone_surface(SurfaceId::outside(w)), self.zone_surface(SurfaceId::inside(w))]
            }
            ExteriorSurfaces::One { side: 0, line } => {
                let inner = self.zone_surface(SurfaceId::inside(w));
                [line.at(inner), inner]
            }
            ExteriorSurfaces::One { line, .. } => {
                let outer = self.zone_surface(SurfaceId::outside(w));
                [outer, line.at(outer)]
            }
        }
    }

    /// Sum of the squared distances of the solution from an iterate where something is linearised, by lane [K2]. Not a
    /// number when any part of it is not one.
    #[inline(always)]
    fn distance(&self, iterate: &Unknowns<S>) -> S {
        let mut sum = squared_distance(&self.solved.air, &iterate.air);
        for &surface in &self.changing.watched {
            let change = self.solved.surfaces[surface] - iterate.surfaces[surface];
            sum += change * change;
        }
        for cells in &self.changing.cells {
            sum += squared_distance(&self.solved.cells[cells.clone()], &iterate.cells[cells.clone()]);
        }
        sum
    }

    /// Moves the iterate of the active lanes to the solution, limited where a melting range would be leapt over.
    /// True where it was limited.
    #[inline(always)]
    fn advance(&mut self, active: S::Mask, iteration: usize, memory: &[PcmMemory<S>]) -> S::Mask {
        if iteration >= PATIENCE && iteration.is_multiple_of(3) {
            self.hold_back();
        }
        // The apparent capacity is a constant of the step: no curve to leap over.
        let curved = self.scheme.storage_rule() == StorageRule::Enthalpy;
        let mut limited = S::Mask::splat(false);
        for &surface in &self.changing.watched {
            let old = self.iterate.surfaces[surface];
            self.iterate.surfaces[surface] = S::select(active, self.solved.surfaces[surface], old);
        }
        blend(active, &mut self.iterate.air, &self.solved.air);
        for (&w, cells) in self.changing.walls.iter().zip(&self.changing.cells) {
            let numbers = &self.coefficients.walls[w];
            let ways = self.iterate.cells[cells.clone()].iter_mut().zip(&self.solved.cells[cells.clone()]);
            let laws = numbers.cells.iter().zip(&memory[cells.clone()]);
            for ((old, &new), (cell, memory)) in ways.zip(laws) {
                let target = match cell.matter {
                    Matter::Pcm(law) if curved => {
                        let (target, leaps) = numbers.pcm[law].limit(*old, new, memory);
                        limited = limited | leaps;
                        target
                    }
                    Matter::Pcm(_) | Matter::Solid { .. } => new,
                };
                *old = S::select(active, target, *old);
            }
        }
        limited
    }

    /// Halves the step that Newton's iteration takes: it then leaves a cycle.
    #[cold]
    fn hold_back(&mut self) {
        let halve = |new: &mut [S], old: &[S]| {
            for (a, &b) in new.iter_mut().zip(old) {
                *a = line(b, *a, 0.5);
            }
        };
        halve(&mut self.solved.surfaces, &self.iterate.surfaces);
        halve(&mut self.solved.air, &self.iterate.air);
        halve(&mut self.solved.cells, &self.iterate.cells);
    }

    /// Solves for all that Newton did not need. False in the lanes where a wall that touches no zone is at no number; of
    /// all other walls Newton has noticed.
    #[inline(always)]
    fn finish_stage(&mut self) -> S::Mask {
        if !self.changing.curved {
            self.resolve_constant();
        }
        if !self.changing.stays() {
            self.zone_fronts.tell_laws(&mut self.laws);
        }
        if !self.plan.ideal_loads.is_empty() {
            self.zone_fronts.tell_locals(&mut self.locals, &mut self.inverses);
        }
        let mut sum = S::zero();
        for &w in &self.changing.loose {
            sum += self.solved.surfaces[SurfaceId::outside(w)] + self.solved.surfaces[SurfaceId::inside(w)];
        }
        sum.abs().lt(S::constant(f64::MAX))
    }

    /// Adds the stage's heat to the step's, at the values of the last linear solve.
    #[inline(always)]
    fn accumulate(&self, duration: f64, energy: &mut Power<S>) {
        let mut power = Power::none();
        self.flow_index.surfaces(&self.conditions, &self.laws, &self.solved.surfaces, &mut power);
        for &(surface, area) in &self.flow_index.imposed {
            power
                .book(Flow::Boundary, area * self.boundary_heat(surface, &self.conditions.surfaces[surface]));
        }
        if !self.plan.windows.is_empty() {
            self.accumulate_windows(&mut power);
        }
        self.accumulate_zones(&mut power);
        energy.add_for(duration, &power);
    }

    /// Adds the sun in windows and what they let in.
    #[inline(always)]
    fn accumulate_windows(&self, power: &mut Power<S>) {
        for (&w, window) in self.plan.windows.iter().zip(&self.conditions.sun.windows) {
            let absorbed = window.panes.iter().fold(S::zero(), |sum, heat| sum + *heat);
            power.book(Flow::Glass, self.coefficients.walls[w].area * absorbed);
        }
        for zone in &self.conditions.sun.zones {
            // What the surfaces absorb, seen from what came in: the two agree or the books do not close.
            power.book(Flow::Transmitted, zone.transmitted - zone.lost - zone.in_glass);
        }
    }

    /// Adds what acts on the airs of the zones beside walls, and what radiates there.
    #[inline(always)]
    fn accumulate_zones(&self, power: &mut Power<S>) {
        let outdoor = self.conditions.outdoor_air;
        for (inflow, &air) in self.inflow.iter().zip(&self.solved.air) {
            power.book(Flow::Infiltration, inflow.at(outdoor - air));
        }
        for &zone in &self.flow_index.aired {
            power.book(Flow::Ventilation, self.airing[zone].at(outdoor - self.solved.air[zone]));
        }
        for &zone in &self.flow_index.gaining {
            let at = &self.conditions.zones[zone];
            power.book(Flow::Gains, at.convective + at.radiant);
        }
        for (path, &conductance) in self.coefficients.paths.iter().zip(&self.conditions.paths) {
            let [a, b] = path.between.map(|zone| self.solved.air[zone]);
            let heat = conductance * (b - a);
            power.book(Flow::Interzone, heat);
            power.book(Flow::Interzone, -heat);
        }
        for &zone in &self.plan.ideal_loads {
            let load = self.load[zone];
            power.book(Flow::Heating, load.max(S::zero()));
            power.book(Flow::Cooling, load.min(S::zero()));
        }
    }

    /// Outdoor air entering a zone at an air temperature, as the last stage was driven [1/h].
    pub(crate) fn air_changes(&self, zone: usize, air: S) -> S {
        let (conditions, numbers) = (&self.conditions, &self.coefficients.zones[zone]);
        conditions.zones[zone].air_changes(numbers, conditions.wind, conditions.outdoor_air, air)
    }

    /// Heat from an imposed temperature into its wall [W/m2].
    #[inline(always)]
    fn boundary_heat(&self, index: SurfaceId, at: &SurfaceConditions<S>) -> S {
        if self.coefficients.surfaces[index].convection.is_some() {
            return -self.laws[index].convection.at(self.solved.surfaces[index] - at.temperature);
        }
        let flux = self.surface_flux(index);
        if index.is_outside() { flux } else { -flux }
    }

    /// Short-wave radiation on a surface outdoors, mean over the last step [W/m2].
    pub(crate) fn incident(&self, surface: SurfaceId) -> S {
        self.weather_index
            .irradiance_source(surface)
            .map_or_else(S::zero, |source| self.sun.irradiances[source])
    }

    /// Temperature of the sky at the end of the last stage [degC].
    #[must_use]
    pub fn sky_temperature(&self) -> S {
        black_temperature(self.conditions.sky)
    }

    /// Conduction through a surface at the end of the last stage [W/m2], positive towards the inside.
    #[inline(always)]
    fn surface_flux(&self, index: SurfaceId) -> S {
        let (w, e) = (index.wall(), index.side());
        let surfaces = self.solved.surfaces.pair(w);
        if self.plan.walls[w].nonlinear {
            return self.chains[w].link_flux(e * self.plan.walls[w].len(), surfaces);
        }
        let [by_outside, by_inside] = self.responses[w][e];
        let into = self.sources[w][e] + by_outside * surfaces[0] + by_inside * surfaces[1];
        if e == 0 { -into } else { into }
    }

    /// Enthalpy of a cell of a wall [J/m3].
    #[must_use]
    pub fn enthalpy(&self, state: &State<S>, w: usize, cell: usize) -> S {
        let wall = &self.plan.walls[w];
        if wall.nonlinear {
            return state.enthalpy[cell];
        }
        self.chains[w].storage[cell - wall.first_cell].capacity * state.cells[cell]
    }

    /// Conduction along a link of a wall at the end of the step that led to a state [W/m2], positive towards the inside.
    #[must_use]
    #[inline(always)]
    pub fn link_flux(&self, state: &State<S>, w: usize, link: usize) -> S {
        let wall = &self.plan.walls[w];
        let surfaces = self.solved.surfaces.pair(w);
        if wall.nonlinear {
            return self.chains[w].link_flux(link, surfaces);
        }
        let cells = &state.cells[wall.first_cell..wall.first_cell + wall.len()];
        let left = if link == 0 { surfaces[0] } else { cells[link - 1] };
        let right = if link == cells.len() { surfaces[1] } else { cells[link] };
        self.chains[w].links[link].flux(left, right)
    }

    /// Names the part that moves most in the first lane that failed.
    fn not_converged(&self, active: S::Mask, (step, stage): (usize, usize)) -> EngineError {
        let lane = (0..S::LANES).find(|&lane| active.lane(lane)).unwrap_or(0);
        let mut worst = (0.0, String::from("the building"));
        let mut look = |new: S, old: S, name: &dyn Fn() -> String| {
            let change = (new.lane(lane) - old.lane(lane)).abs();
            // What is not a number comes first; of those, the first.
            if change > worst.0 || (change.is_nan() && !worst.0.is_nan()) {
                worst = (change, name());
            }
        };
        for &surface in &self.changing.watched {
            look(self.solved.surfaces[surface], self.iterate.surfaces[surface], &|| {
                self.plan.surface_name(surface)
            });
        }
        for (zone, (new, old)) in self.solved.air.iter().zip(&self.iterate.air).enumerate() {
            look(*new, *old, &|| format!("zone {} (air)", self.plan.description.zones[zone].name));
        }
        for (w, wall) in self.plan.walls.iter().enumerate().filter(|(_, wall)| wall.nonlinear) {
            for i in 0..wall.len() {
                let k = wall.first_cell + i;
                look(self.solved.cells[k], self.iterate.cells[k], &|| {
                    let surface = &self.plan.description.surfaces[w];
                    let layers = &self.plan.description.constructions[surface.construction].layers;
                    match layers.get(wall.cell_layers[i]) {
                        Some(layer) => format!("surface {} (layer {})", surface.name, layer.name),
                        None => format!("window {} (pane {})", surface.name, wall.cell_layers[i] + 1),
                    }
                });
            }
        }
        EngineError::NotConverged {
            step,
            stage,
            place: worst.1,
            residual: worst.0,
            iterations: MAX_ITERATIONS,
        }
    }
}

/// What changes when, and what stays: found from the plan, never from a number.
#[derive(Debug, Clone)]
struct Changing {
    /// Walls of constant properties, those of them that are in no single room, and the others with their cells.
    constant: Vec<usize>,
    shared: Vec<usize>,
    walls: Vec<usize>,
    cells: Vec<Range<usize>>,
    /// Walls of constant properties that touch no zone, and the surfaces in zones of all of them.
    loose: Vec<usize>,
    inner: Vec<SurfaceId>,
    /// Surfaces whose laws change: all of them, and those in no room.
    bending: NonlinearSurfaces,
    apart: NonlinearSurfaces,
    /// Surfaces at which something is linearised: where films or radiation bend, and the surfaces of walls that change.
    watched: Vec<SurfaceId>,
    /// Whether the balance of a surface of a constant wall is more than a straight line of its temperature.
    curved: bool,
    /// Whether the wind changes its slope.
    by_wind: bool,
}

/// Surfaces whose films depend on the wind alone, surfaces whose films depend on temperature, and surfaces that radiate with the
/// fourth power of it.
#[derive(Debug, Clone, Default)]
struct NonlinearSurfaces {
    windy: Vec<SurfaceId>,
    bent: Vec<SurfaceId>,
    radiant: Vec<SurfaceId>,
}

impl Changing {
    /// Sorts walls and surfaces; also the laws that never change.
    fn sort<S: Real>(plan: &Plan, numbers: &Coefficients<S>) -> (Self, BySurface<SurfaceLaws<S>>) {
        let (walls, constant): (Vec<_>, Vec<_>) =
            (0..plan.walls.len()).partition(|&wall| plan.walls[wall].nonlinear);
        let local = |surface: SurfaceId| plan.surfaces[surface].role == SurfaceRole::Exterior;
        let loose = constant
            .iter()
            .copied()
            .filter(|&wall| local(SurfaceId::outside(wall)) && local(SurfaceId::inside(wall)))
            .collect();
        let shared = constant.iter().copied().filter(|&wall| !of_one_room(plan, wall)).collect();
        let surfaces = constant.iter().flat_map(|&wall| SurfaceId::pair(wall));
        let inner = surfaces.filter(|&surface| !local(surface)).collect();
        let cells = walls.iter().map(|&wall| &plan.walls[wall]);
        let cells = cells.map(|wall| wall.first_cell..wall.first_cell + wall.len()).collect();
        let mut all = Self {
            constant,
            shared,
            walls,
            cells,
            loose,
            inner,
            bending: NonlinearSurfaces::default(),
            apart: NonlinearSurfaces::default(),
            watched: Vec::new(),
            curved: false,
            by_wind: false,
        };
        let laws = plan.surfaces.ids().map(|surface| all.enter(plan, numbers, surface)).collect();
        let bending = &all.bending;
        let linearised = |surface: &SurfaceId| {
            plan.walls[surface.wall()].nonlinear
                || bending.bent.contains(surface)
                || bending.radiant.contains(surface)
        };
        all.watched = plan.surfaces.ids().filter(linearised).collect();
        let apart = |surfaces: &[SurfaceId]| {
            surfaces
                .iter()
                .copied()
                .filter(|&surface| local(surface) && !of_one_room(plan, surface.wall()))
                .collect()
        };
        all.apart = NonlinearSurfaces {
            windy: apart(&bending.windy),
            bent: apart(&bending.bent),
            radiant: apart(&bending.radiant),
        };
        (all, laws)
    }

    /// Surfaces whose laws change: all of them, or those in no room.
    #[inline(always)]
    fn bends(&self, all: bool) -> &NonlinearSurfaces {
        if all { &self.bending } else { &self.apart }
    }

    /// Whether no slope of the surfaces of constant walls ever changes.
    #[inline(always)]
    fn stays(&self) -> bool {
        !self.curved && !self.by_wind
    }

    fn enter<S: Real>(&mut self, plan: &Plan, numbers: &Coefficients<S>, index: SurfaceId) -> SurfaceLaws<S> {
        let (surface, role) = (&numbers.surfaces[index], plan.surfaces[index].role);
        let mut laws = SurfaceLaws { convection: Line::zero(), emission: Line::zero() };
        // What happens at the free surface of a wall that changes is entered with the wall.
        let entered = matches!(role, SurfaceRole::Zone { .. }) || !plan.walls[index.wall()].nonlinear;
        let adiabatic = matches!(surface.boundary, Boundary::Adiabatic);
        if let Some(convection) = surface.convection.as_ref().filter(|_| !adiabatic) {
            if let Some(coefficient) = convection.constant() {
                laws.convection.slope = coefficient * surface.area_factor;
            } else if convection.straight() {
                self.bending.windy.push(index);
                self.by_wind |= entered;
            } else {
                self.bending.bent.push(index);
                self.curved |= entered;
            }
        }
        let emission = match role {
            SurfaceRole::Zone { zone, .. } if numbers.zones[zone].exchange.is_empty() => None,
            SurfaceRole::Zone { zone, .. } => Some(numbers.zones[zone].emission),
            SurfaceRole::Exterior => outdoor_emission(surface),
        };
        match emission {
            Some(Emission::Exact) => {
                self.bending.radiant.push(index);
                self.curved |= entered;
            }
            Some(Emission::Linearised(_)) => {
                let (offset, slope) = emission.map_or((S::zero(), S::zero()), |law| law.at(S::zero()));
                laws.emission = Line { offset, slope };
            }
            None => {}
        }
        laws
    }
}

/// The emission law of a surface that looks outdoors.
#[inline(always)]
fn outdoor_emission<S: Real>(surface: &SurfaceCoefficients<S>) -> Option<Emission<S>> {
    match &surface.boundary {
        Boundary::Outdoors(outdoors) => outdoors.emission,
        Boundary::Imposed(_) | Boundary::Adiabatic | Boundary::Zone => None,
    }
}
