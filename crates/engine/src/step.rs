//! One implicit time step: Newton on enthalpy, walls eliminated onto their faces, a small dense room block.
//!
//! A step is a function (state, forcing) -> state; memory changes only when it is accepted.
//! Each stage solves `held + length * f(T) = H(T)` for all cells and airs at once.
//!
//! Sources: SDIRK2 of Alexander (1977), SIAM J. Numer. Anal. 14(6), doi:10.1137/0714068.

use crate::coefficients::{Boundary, Coefficients, Face, Matter};
use crate::conduction::{Chain, Iterate, Start, StorageRule};
use crate::drive::{Drive, FaceDrive};
use crate::error::EngineError;
use crate::forcing::Forcing;
use crate::ledger::{Flow, Ledger, Power};
use crate::pcm::PcmMemory;
use crate::plan::{FaceId, FaceRole, Plan};
use crate::real::{Mask, Real};

/// Root of the sum of squared changes in the last Newton iteration [K]. Convergence is quadratic: the error left is
/// of the order of its square.
const TOLERANCE: f64 = 1e-6;
/// Iterations before a step counts as unsolvable.
const MAX_ITERATIONS: usize = 60;
/// Temperature differences between a zone and outdoors are rounded off within this [K] where they drive an air flow.
const ROUND_OFF: f64 = 0.01;

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

/// Everything that passes from step to step.
#[derive(Debug, Clone)]
pub struct State<S> {
    /// Cell temperatures of all walls [degC].
    pub cells: Vec<S>,
    /// Cell enthalpies [J/m3].
    pub enthalpy: Vec<S>,
    /// What the cells remember.
    pub memory: Vec<PcmMemory<S>>,
    /// Face temperatures [degC].
    pub faces: Vec<S>,
    /// Zone air temperatures [degC].
    pub air: Vec<S>,
}

impl<S: Real> State<S> {
    /// Takes over the lanes of `other` where the mask is true.
    pub fn take(&mut self, mask: S::Mask, other: &Self) {
        let blend = |mine: &mut [S], theirs: &[S]| {
            for (a, b) in mine.iter_mut().zip(theirs) {
                *a = S::select(mask, *b, *a);
            }
        };
        blend(&mut self.cells, &other.cells);
        blend(&mut self.enthalpy, &other.enthalpy);
        blend(&mut self.faces, &other.faces);
        blend(&mut self.air, &other.air);
        for (a, b) in self.memory.iter_mut().zip(&other.memory) {
            a.liquid_fraction = S::select(mask, b.liquid_fraction, a.liquid_fraction);
        }
    }

    /// Largest change of a cell or an air against another state [K].
    pub fn distance(&self, other: &Self) -> S {
        let pairs = self.cells.iter().zip(&other.cells).chain(self.air.iter().zip(&other.air));
        pairs.fold(S::zero(), |largest, (a, b)| largest.max((*a - *b).abs()))
    }
}

/// A straight line `offset + slope T`.
#[derive(Debug, Clone, Copy)]
struct Line<S> {
    offset: S,
    slope: S,
}

impl<S: Real> Line<S> {
    fn zero() -> Self {
        Self { offset: S::zero(), slope: S::zero() }
    }
    /// The tangent of a function with a value and a slope at a point.
    fn tangent(value: S, slope: S, at: S) -> Self {
        Self { offset: value - slope * at, slope }
    }
    fn at(&self, x: S) -> S {
        self.offset + self.slope * x
    }
}

/// The linearised laws of a face in one Newton iteration [W/m2].
#[derive(Debug, Clone, Copy)]
struct FaceLaws<S> {
    /// Convection off the face, of `T_face - T_air`.
    film: Line<S>,
    /// Black emission, of `T_face`.
    emission: Line<S>,
}

/// Marches a building by one step at a time.
#[derive(Debug)]
pub struct Stepper<'a, S: Real> {
    plan: &'a Plan,
    /// Numbers of the run.
    pub coefficients: Coefficients<S>,
    numbers: &'a [S],
    scheme: Scheme,
    /// Linearised walls.
    pub chains: Vec<Chain<S>>,
    responses: Vec<[[S; 2]; 2]>,
    /// Effective stage length of the factors in hand [s]; NaN: none.
    factored: f64,
    laws: Vec<FaceLaws<S>>,
    /// Air entering each zone: heat, of `T_outdoor - T_air` [W].
    inflow: Vec<Line<S>>,
    block: RoomBlock<S>,
    iterate: Unknowns<S>,
    solved: Unknowns<S>,
    held: Vec<S>,
    held_air: Vec<S>,
    /// Newton iterations since the start.
    pub iterations: usize,
}

/// Temperatures of one iterate.
#[derive(Debug, Clone)]
struct Unknowns<S> {
    cells: Vec<S>,
    faces: Vec<S>,
    air: Vec<S>,
}

impl<'a, S: Real> Stepper<'a, S> {
    /// Prepares a plan with a parameter vector.
    #[must_use]
    pub fn new(plan: &'a Plan, numbers: &'a [S], scheme: Scheme) -> Self {
        let coefficients = Coefficients::new(plan, numbers);
        let chains = coefficients.walls.iter().map(Chain::new).collect();
        let zeros = |n: usize| vec![S::zero(); n];
        let unknowns = Unknowns {
            cells: zeros(plan.n_cells),
            faces: zeros(plan.faces.len()),
            air: zeros(plan.zones.len()),
        };
        Self {
            plan,
            coefficients,
            numbers,
            scheme,
            chains,
            responses: vec![[[S::zero(); 2]; 2]; plan.walls.len()],
            factored: f64::NAN,
            laws: vec![FaceLaws { film: Line::zero(), emission: Line::zero() }; plan.faces.len()],
            inflow: vec![Line::zero(); plan.zones.len()],
            block: RoomBlock::new(plan.n_dense),
            iterate: unknowns.clone(),
            solved: unknowns,
            held: zeros(plan.n_cells),
            held_air: zeros(plan.zones.len()),
            iterations: 0,
        }
    }

    /// A state at one temperature throughout [degC].
    pub fn uniform(&self, temperature: S) -> State<S> {
        let nothing = PcmMemory { liquid_fraction: S::zero() };
        let mut state = State {
            cells: vec![temperature; self.plan.n_cells],
            enthalpy: vec![S::zero(); self.plan.n_cells],
            memory: vec![nothing; self.plan.n_cells],
            faces: vec![temperature; self.plan.faces.len()],
            air: vec![temperature; self.plan.zones.len()],
        };
        self.settle(&mut state);
        state
    }

    /// Enthalpies and memory that belong to the temperatures of a state.
    fn settle(&self, state: &mut State<S>) {
        for (wall, plan) in self.coefficients.walls.iter().zip(&self.plan.walls) {
            for (i, cell) in wall.cells.iter().enumerate() {
                let k = plan.first_cell + i;
                match &cell.matter {
                    Matter::Solid { capacity, .. } => {
                        state.enthalpy[k] = *capacity * state.cells[k];
                    }
                    Matter::Pcm(law) => {
                        let point = wall.pcm[*law].at(state.cells[k], &state.memory[k]);
                        state.enthalpy[k] = point.enthalpy;
                        state.memory[k].liquid_fraction = point.liquid_fraction;
                    }
                }
            }
        }
    }

    /// Brings the faces of a state into balance with a forcing row: a stage so short that nothing is stored.
    ///
    /// # Errors
    /// [`EngineError::NotConverged`].
    pub fn balance_faces(&mut self, state: &mut State<S>, row: &[f64]) -> Result<(), EngineError> {
        const INSTANT: f64 = 1e-3;
        let drive = Drive::new(self.plan, &self.coefficients, self.numbers, row);
        self.held.copy_from_slice(&state.enthalpy);
        self.held_air.copy_from_slice(&state.air);
        self.begin(state);
        self.solve_stage(&drive, state, INSTANT, (0, 0))?;
        state.faces.copy_from_slice(&self.solved.faces);
        Ok(())
    }

    fn begin(&mut self, state: &State<S>) {
        self.iterate.cells.copy_from_slice(&state.cells);
        self.iterate.faces.copy_from_slice(&state.faces);
        self.iterate.air.copy_from_slice(&state.air);
    }

    /// One step of length `dt` [s].
    ///
    /// # Errors
    /// [`EngineError::NotConverged`].
    pub fn step(
        &mut self,
        state: &mut State<S>,
        forcing: &Forcing<'_>,
        step: usize,
        dt: f64,
        ledger: &mut Ledger<S>,
    ) -> Result<(), EngineError> {
        let diagonal = self.scheme.diagonal();
        self.begin(state);
        self.held.copy_from_slice(&state.enthalpy);
        self.held_air.copy_from_slice(&state.air);
        let mut energy = Power::none();
        for (stage, &weight) in self.scheme.weights().iter().enumerate() {
            let drive = Drive::new(self.plan, &self.coefficients, self.numbers, forcing.at(step, stage));
            self.solve_stage(&drive, state, diagonal * dt, (step, stage + 1))?;
            self.accumulate(&drive, weight * dt, &mut energy);
            if stage + 1 < self.scheme.weights().len() {
                self.hold_over(state, (1.0 - diagonal) / diagonal);
            }
        }
        self.accept(state, &energy, ledger);
        Ok(())
    }

    /// What the next stage starts from: `H_n + ratio (H_stage - H_n)`.
    fn hold_over(&mut self, state: &State<S>, ratio: f64) {
        for (wall, chain) in self.plan.walls.iter().zip(&self.chains) {
            for i in 0..wall.len() {
                let k = wall.first_cell + i;
                let reached = chain.storage[i].at(self.solved.cells[k]);
                self.held[k] = state.enthalpy[k] + (reached - state.enthalpy[k]).scale(ratio);
            }
        }
        for (zone, held) in self.held_air.iter_mut().enumerate() {
            *held = state.air[zone] + (self.solved.air[zone] - state.air[zone]).scale(ratio);
        }
        self.iterate.clone_from(&self.solved);
    }

    /// Takes the last stage as the new state and books the step.
    fn accept(&mut self, state: &mut State<S>, energy: &Power<S>, ledger: &mut Ledger<S>) {
        let mut stored = S::zero();
        for ((wall, chain), numbers) in self.plan.walls.iter().zip(&self.chains).zip(&self.coefficients.walls)
        {
            for (i, cell) in numbers.cells.iter().enumerate() {
                let k = wall.first_cell + i;
                let temperature = self.solved.cells[k];
                let mut enthalpy = chain.storage[i].at(temperature);
                if let Matter::Pcm(law) = cell.matter {
                    let point = numbers.pcm[law].at(temperature, &state.memory[k]);
                    if self.scheme == Scheme::ApparentCapacity {
                        // What the material holds in truth, not what the scheme believes to have stored.
                        enthalpy = point.enthalpy;
                    }
                    state.memory[k].liquid_fraction = point.liquid_fraction;
                }
                stored += numbers.area * cell.thickness * (enthalpy - state.enthalpy[k]);
                state.enthalpy[k] = enthalpy;
            }
        }
        for (zone, numbers) in self.coefficients.zones.iter().enumerate() {
            stored += numbers.capacity * (self.solved.air[zone] - state.air[zone]);
        }
        state.cells.copy_from_slice(&self.solved.cells);
        state.faces.copy_from_slice(&self.solved.faces);
        state.air.copy_from_slice(&self.solved.air);
        ledger.book(energy, stored);
    }

    /// Newton's iteration for one stage. Leaves the solution in `solved` and the linearisation that produced
    /// it in the chains and laws, so that every flux can be booked at the value the last solve used.
    ///
    /// A lane that has converged keeps its iterate: later solves repeat its last one bit for bit.
    fn solve_stage(
        &mut self,
        drive: &Drive<S>,
        state: &State<S>,
        length: f64,
        place: (usize, usize),
    ) -> Result<(), EngineError> {
        self.prepare_linear_walls(length);
        let mut sources = self.linear_sources();
        let mut active = S::Mask::splat(true);
        let mut polish = S::DERIVATIVES;
        for _ in 0..MAX_ITERATIONS {
            self.iterations += 1;
            self.linearise_walls(state, length, &mut sources);
            self.linearise_faces(drive);
            self.solve_linear(drive, &sources, length);
            let change = self.change();
            active = active & !change.lt(S::constant(TOLERANCE * TOLERANCE));
            if active.any() {
                self.advance(active);
            } else {
                if !polish {
                    self.finish_linear_walls();
                    return Ok(());
                }
                polish = false;
                self.advance(S::Mask::splat(true));
            }
        }
        Err(self.not_converged(active, place))
    }

    /// Factors the walls of constant properties, once per stage length.
    fn prepare_linear_walls(&mut self, length: f64) {
        if self.factored.to_bits() == length.to_bits() {
            return;
        }
        for (w, wall) in self.plan.walls.iter().enumerate() {
            if !wall.nonlinear {
                self.responses[w] = self.chains[w].factor(&self.coefficients.walls[w], length);
            }
        }
        self.factored = length;
    }

    fn linear_sources(&mut self) -> Vec<[S; 2]> {
        let held = &self.held;
        let walls = self.plan.walls.iter().zip(self.chains.iter_mut());
        walls
            .map(|(wall, chain)| {
                if wall.nonlinear {
                    [S::zero(); 2]
                } else {
                    chain.sources(&held[wall.first_cell..wall.first_cell + wall.len()])
                }
            })
            .collect()
    }

    fn linearise_walls(&mut self, state: &State<S>, length: f64, sources: &mut [[S; 2]]) {
        for (w, wall) in self.plan.walls.iter().enumerate().filter(|(_, wall)| wall.nonlinear) {
            let cells = wall.first_cell..wall.first_cell + wall.len();
            let numbers = &self.coefficients.walls[w];
            let at = Iterate {
                cells: &self.iterate.cells[cells.clone()],
                faces: [self.iterate.faces[2 * w], self.iterate.faces[2 * w + 1]],
            };
            let start = Start {
                cells: &state.cells[cells.clone()],
                enthalpy: &state.enthalpy[cells.clone()],
                memory: &state.memory[cells.clone()],
            };
            self.chains[w].linearise(numbers, &at, &start, self.scheme.storage_rule());
            self.responses[w] = self.chains[w].factor(numbers, length);
            sources[w] = self.chains[w].sources(&self.held[cells]);
        }
    }

    fn linearise_faces(&mut self, drive: &Drive<S>) {
        for (index, face) in self.coefficients.faces.iter().enumerate() {
            let temperature = self.iterate.faces[index];
            let (air, emission) = match self.plan.faces[index].role {
                FaceRole::Zone { zone, .. } => {
                    (self.iterate.air[zone], Some(self.coefficients.zones[zone].emission))
                }
                FaceRole::Local => (drive.faces[index].temperature, outdoor_emission(face)),
            };
            self.laws[index] = FaceLaws {
                film: face.film.as_ref().map_or_else(Line::zero, |film| {
                    let flux = film.flux(temperature - air, &drive.faces[index].air);
                    Line::tangent(
                        flux.flux * face.area_factor,
                        flux.slope * face.area_factor,
                        temperature - air,
                    )
                }),
                emission: emission.map_or_else(Line::zero, |law| {
                    let (value, slope) = law.at(temperature);
                    Line::tangent(value, slope, temperature)
                }),
            };
        }
        for (zone, numbers) in self.coefficients.zones.iter().enumerate() {
            self.inflow[zone] = infiltration(numbers, drive, self.iterate.air[zone]);
        }
    }

    /// Solves the linearised building into `solved` (cells of nonlinear walls included).
    fn solve_linear(&mut self, drive: &Drive<S>, sources: &[[S; 2]], length: f64) {
        let mut locals = Vec::with_capacity(self.plan.walls.len());
        self.block.clear();
        for (w, &source) in sources.iter().enumerate() {
            let local = self.eliminate_wall(drive, w, source);
            locals.push(local);
        }
        for zone in 0..self.plan.zones.len() {
            self.assemble_zone(drive, zone, length);
        }
        self.block.solve();
        for (zone, plan) in self.plan.zones.iter().enumerate() {
            self.solved.air[zone] = self.block.right[plan.air_row];
        }
        for (w, local) in locals.into_iter().enumerate() {
            let faces = self.resolve_faces(w, local);
            self.solved.faces[2 * w] = faces[0];
            self.solved.faces[2 * w + 1] = faces[1];
            let wall = &self.plan.walls[w];
            if wall.nonlinear {
                let cells = wall.first_cell..wall.first_cell + wall.len();
                self.chains[w].temperatures(faces, &mut self.solved.cells[cells]);
            }
        }
    }

    /// Enters a wall into the room block, its local faces eliminated.
    fn eliminate_wall(&mut self, drive: &Drive<S>, w: usize, source: [S; 2]) -> LocalFaces<S> {
        let response = self.responses[w];
        let area = self.coefficients.walls[w].area;
        let roles = [self.plan.faces[2 * w].role, self.plan.faces[2 * w + 1].role];
        match roles {
            [FaceRole::Local, FaceRole::Local] => {
                let [outer, inner] = [0, 1].map(|e| self.local_balance(drive, 2 * w + e));
                LocalFaces::Both(solve_pair(outer, inner, source, response))
            }
            [FaceRole::Zone { row: outer, .. }, FaceRole::Zone { row: inner, .. }] => {
                for (e, (mine, other)) in [(outer, inner), (inner, outer)].into_iter().enumerate() {
                    self.block.add(mine, mine, -(area * response[e][e]));
                    self.block.add(mine, other, -(area * response[e][1 - e]));
                    self.block.right[mine] += area * source[e];
                }
                LocalFaces::None
            }
            [FaceRole::Zone { row, .. }, FaceRole::Local] => self.eliminate_one(drive, w, 0, row, source),
            [FaceRole::Local, FaceRole::Zone { row, .. }] => self.eliminate_one(drive, w, 1, row, source),
        }
    }

    /// A wall whose face `e` is in a zone and whose other face is local.
    fn eliminate_one(
        &mut self,
        drive: &Drive<S>,
        w: usize,
        e: usize,
        row: usize,
        source: [S; 2],
    ) -> LocalFaces<S> {
        let (response, area, o) = (self.responses[w], self.coefficients.walls[w].area, 1 - e);
        let line = match self.local_balance(drive, 2 * w + o) {
            LocalBalance::Fixed(value) => Line { offset: value, slope: S::zero() },
            LocalBalance::Gain(gain) => {
                let inverse = S::one() / (gain.slope - response[o][o]);
                Line { offset: (source[o] + gain.offset) * inverse, slope: response[o][e] * inverse }
            }
        };
        self.block.add(row, row, -(area * (response[e][e] + response[e][o] * line.slope)));
        self.block.right[row] += area * (source[e] + response[e][o] * line.offset);
        LocalFaces::One { side: o, line }
    }

    /// Heat from outside into a local face, `offset - slope T`, or the temperature it is held at.
    fn local_balance(&self, drive: &Drive<S>, index: FaceId) -> LocalBalance<S> {
        let face = &self.coefficients.faces[index];
        let (at, laws) = (&drive.faces[index], &self.laws[index]);
        match face.boundary {
            Boundary::Imposed(_) if face.film.is_none() => LocalBalance::Fixed(at.temperature),
            Boundary::Adiabatic => LocalBalance::Gain(Line { offset: at.solar, slope: S::zero() }),
            _ => LocalBalance::Gain(Line {
                offset: at.solar + at.longwave + laws.film.slope * at.temperature
                    - laws.film.offset
                    - face.emissivity * laws.emission.offset,
                slope: laws.film.slope + face.emissivity * laws.emission.slope,
            }),
        }
    }

    /// Convection, exchange between faces, infiltration and storage of a zone.
    fn assemble_zone(&mut self, drive: &Drive<S>, zone: usize, length: f64) {
        let plan = self.plan;
        let numbers = &self.coefficients.zones[zone];
        let (air, faces) = (plan.zones[zone].air_row, &plan.zones[zone].faces);
        let n = faces.len();
        for (i, &index) in faces.iter().enumerate() {
            let row = plan.row(index);
            let film = self.laws[index].film;
            let (conductance, offset) = (numbers.areas[i] * film.slope, numbers.areas[i] * film.offset);
            self.block.couple(row, air, conductance);
            self.block.right[row] += numbers.areas[i] * drive.faces[index].solar - offset;
            self.block.right[air] += offset;
            if numbers.exchange.is_empty() {
                continue;
            }
            for (j, &other) in faces.iter().enumerate().filter(|(j, _)| *j != i) {
                let exchange = numbers.exchange[i * n + j];
                let (mine, theirs) = (self.laws[index].emission, self.laws[other].emission);
                self.block.add(row, row, exchange * mine.slope);
                self.block.add(row, plan.row(other), -(exchange * theirs.slope));
                self.block.right[row] += exchange * (theirs.offset - mine.offset);
            }
        }
        let inflow = self.inflow[zone];
        let storage = numbers.capacity.scale(1.0 / length);
        self.block.add(air, air, storage + inflow.slope);
        self.block.right[air] +=
            storage * self.held_air[zone] + inflow.offset + inflow.slope * drive.outdoor_air;
    }

    fn resolve_faces(&self, w: usize, local: LocalFaces<S>) -> [S; 2] {
        let dense = |e: usize| self.block.right[self.plan.row(2 * w + e)];
        match local {
            LocalFaces::Both(faces) => faces,
            LocalFaces::None => [dense(0), dense(1)],
            LocalFaces::One { side: 0, line } => [line.at(dense(1)), dense(1)],
            LocalFaces::One { line, .. } => [dense(0), line.at(dense(0))],
        }
    }

    /// Sum of the squared changes of the iterate, by lane [K2]. Not a number when any part of it is not one.
    fn change(&self) -> S {
        let mut sum = S::zero();
        let mut compare = |new: &[S], old: &[S]| {
            for (a, b) in new.iter().zip(old) {
                let change = *a - *b;
                sum += change * change;
            }
        };
        compare(&self.solved.faces, &self.iterate.faces);
        compare(&self.solved.air, &self.iterate.air);
        for wall in self.plan.walls.iter().filter(|wall| wall.nonlinear) {
            let cells = wall.first_cell..wall.first_cell + wall.len();
            compare(&self.solved.cells[cells.clone()], &self.iterate.cells[cells]);
        }
        sum
    }

    /// Moves the iterate of the active lanes to the solution, limited where a melting range would be leapt over.
    fn advance(&mut self, active: S::Mask) {
        let take = |new: &[S], old: &mut [S]| {
            for (a, b) in new.iter().zip(old) {
                *b = S::select(active, *a, *b);
            }
        };
        take(&self.solved.faces, &mut self.iterate.faces);
        take(&self.solved.air, &mut self.iterate.air);
        for (w, wall) in self.plan.walls.iter().enumerate().filter(|(_, wall)| wall.nonlinear) {
            let numbers = &self.coefficients.walls[w];
            for (i, cell) in numbers.cells.iter().enumerate() {
                let k = wall.first_cell + i;
                let (old, new) = (self.iterate.cells[k], self.solved.cells[k]);
                let target = match cell.matter {
                    Matter::Pcm(law) => numbers.pcm[law].limit(old, new),
                    Matter::Solid { .. } => new,
                };
                self.iterate.cells[k] = S::select(active, target, old);
            }
        }
    }

    /// Cell temperatures of the walls whose cells Newton did not need.
    fn finish_linear_walls(&mut self) {
        for (w, wall) in self.plan.walls.iter().enumerate().filter(|(_, wall)| !wall.nonlinear) {
            let faces = [self.solved.faces[2 * w], self.solved.faces[2 * w + 1]];
            let cells = wall.first_cell..wall.first_cell + wall.len();
            self.chains[w].temperatures(faces, &mut self.solved.cells[cells]);
        }
    }

    /// Adds the stage's heat to the step's, at the values of the last linear solve.
    fn accumulate(&self, drive: &Drive<S>, duration: f64, energy: &mut Power<S>) {
        let mut book = |flow: Flow, power: S| energy.book(flow, power.scale(duration));
        for (index, face) in self.coefficients.faces.iter().enumerate() {
            let area = self.coefficients.walls[index / 2].area;
            let (at, laws) = (&drive.faces[index], &self.laws[index]);
            let temperature = self.solved.faces[index];
            if face.irradiance.is_some() || matches!(face.boundary, Boundary::Outdoors(_)) {
                book(Flow::Solar, area * at.solar);
            }
            match &face.boundary {
                Boundary::Outdoors(outdoors) => {
                    book(Flow::Convection, -(area * laws.film.at(temperature - at.temperature)));
                    if outdoors.emission.is_some() {
                        let net = at.longwave - face.emissivity * laws.emission.at(temperature);
                        book(Flow::Longwave, area * net);
                    }
                }
                Boundary::Imposed(_) => book(Flow::Boundary, area * self.boundary_heat(index, at)),
                Boundary::Zone | Boundary::Adiabatic => {}
            }
        }
        for (zone, inflow) in self.inflow.iter().enumerate() {
            book(Flow::Infiltration, inflow.at(drive.outdoor_air - self.solved.air[zone]));
        }
    }

    /// Heat from an imposed temperature into its wall [W/m2].
    fn boundary_heat(&self, index: FaceId, at: &FaceDrive<S>) -> S {
        if self.coefficients.faces[index].film.is_some() {
            return -self.laws[index].film.at(self.solved.faces[index] - at.temperature);
        }
        let flux = self.face_flux(index);
        if index % 2 == 0 { flux } else { -flux }
    }

    /// Conduction through a face at the end of the last stage [W/m2], positive towards the inside.
    #[must_use]
    pub fn face_flux(&self, index: FaceId) -> S {
        let link = if index % 2 == 0 { 0 } else { self.plan.walls[index / 2].len() };
        self.link_flux(index / 2, link)
    }

    /// Conduction along a link of a wall at the end of the last stage [W/m2], positive towards the inside.
    #[must_use]
    pub fn link_flux(&self, w: usize, link: usize) -> S {
        let wall = &self.plan.walls[w];
        let faces = [self.solved.faces[2 * w], self.solved.faces[2 * w + 1]];
        let cells = &self.solved.cells[wall.first_cell..wall.first_cell + wall.len()];
        self.chains[w].link_flux(link, faces, cells)
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
        for (index, (new, old)) in self.solved.faces.iter().zip(&self.iterate.faces).enumerate() {
            look(*new, *old, &|| self.plan.face_name(index));
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
                    format!("surface {} (layer {})", surface.name, layers[wall.cell_layers[i]].name)
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

/// The emission law of a face that looks outdoors.
fn outdoor_emission<S: Real>(face: &Face<S>) -> Option<crate::radiation::Emission<S>> {
    match &face.boundary {
        Boundary::Outdoors(outdoors) => outdoors.emission,
        Boundary::Imposed(_) | Boundary::Adiabatic | Boundary::Zone => None,
    }
}

/// Heat of entering air, `C (n0 + n1 |d| + n2 V)/3600 d`, `d = T_outdoor - T_air`, as its tangent.
fn infiltration<S: Real>(zone: &crate::coefficients::Zone<S>, drive: &Drive<S>, air: S) -> Line<S> {
    let d = drive.outdoor_air - air;
    let [constant, temperature, wind] = zone.infiltration;
    let magnitude = d.smooth_abs(ROUND_OFF);
    let per_second = zone.air_capacity.scale(1.0 / 3600.0);
    let rate = per_second * (constant + temperature * magnitude + wind * drive.wind);
    let slope = rate + per_second * temperature * d * d / magnitude;
    Line::tangent(rate * d, slope, d)
}

/// A face outside the zones: held at a temperature, or gaining `offset - slope T`.
#[derive(Debug, Clone, Copy)]
enum LocalBalance<S> {
    Fixed(S),
    Gain(Line<S>),
}

/// The local faces of a wall after its elimination.
#[derive(Debug, Clone, Copy)]
enum LocalFaces<S> {
    None,
    /// Its temperature as a function of the other face's.
    One {
        side: usize,
        line: Line<S>,
    },
    Both([S; 2]),
}

/// Both faces of a wall that touches no zone.
fn solve_pair<S: Real>(
    outer: LocalBalance<S>,
    inner: LocalBalance<S>,
    source: [S; 2],
    response: [[S; 2]; 2],
) -> [S; 2] {
    let equation = |balance: LocalBalance<S>, e: usize| match balance {
        LocalBalance::Fixed(value) => ([S::one(), S::zero()], value),
        LocalBalance::Gain(gain) => {
            ([gain.slope - response[e][e], -response[e][1 - e]], source[e] + gain.offset)
        }
    };
    let ([a, b], f) = equation(outer, 0);
    let ([d, c], g) = equation(inner, 1);
    let determinant = a * d - b * c;
    [(f * d - b * g) / determinant, (a * g - c * f) / determinant]
}

/// The dense system of zone faces and airs. Its matrix is an M-matrix: no pivoting.
#[derive(Debug)]
struct RoomBlock<S> {
    size: usize,
    matrix: Vec<S>,
    right: Vec<S>,
}

impl<S: Real> RoomBlock<S> {
    fn new(size: usize) -> Self {
        Self { size, matrix: vec![S::zero(); size * size], right: vec![S::zero(); size] }
    }

    fn clear(&mut self) {
        self.matrix.fill(S::zero());
        self.right.fill(S::zero());
    }

    fn add(&mut self, row: usize, column: usize, value: S) {
        self.matrix[row * self.size + column] += value;
    }

    /// A conductance between two unknowns.
    fn couple(&mut self, a: usize, b: usize, conductance: S) {
        self.add(a, a, conductance);
        self.add(b, b, conductance);
        self.add(a, b, -conductance);
        self.add(b, a, -conductance);
    }

    /// Gaussian elimination; the solution replaces the right-hand side.
    fn solve(&mut self) {
        let n = self.size;
        for k in 0..n {
            let (upper, lower) = self.matrix.split_at_mut((k + 1) * n);
            let pivot = &upper[k * n..];
            let inverse = S::one() / pivot[k];
            let known = self.right[k];
            for (i, row) in lower.chunks_exact_mut(n).enumerate() {
                let factor = row[k] * inverse;
                for (a, p) in row[k + 1..].iter_mut().zip(&pivot[k + 1..]) {
                    *a = *a - factor * *p;
                }
                self.right[k + 1 + i] = self.right[k + 1 + i] - factor * known;
            }
        }
        for k in (0..n).rev() {
            let row = &self.matrix[k * n..(k + 1) * n];
            let mut sum = self.right[k];
            for (a, x) in row[k + 1..].iter().zip(&self.right[k + 1..]) {
                sum = sum - *a * *x;
            }
            self.right[k] = sum / row[k];
        }
    }
}
