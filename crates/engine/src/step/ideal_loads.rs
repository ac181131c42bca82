//! Ideal heating and cooling: the load that keeps the air of each zone between its set points.
//!
//! A load is the mean over a step and acts in all of its stages alike. (A load of its own for each stage would let the
//! air overshoot.) It is the one that brings the air onto the set point at the end of the step, as far as the capacity
//! goes, and nothing where the air stays between the set points without it.
//!
//! Step by step: each stage is solved once, about a guess and with guessed loads; the response of the air at the end to
//! each load follows from the factors in hand; new loads follow from both, and with them the temperatures about which
//! the stages are solved next; and so on until all stay. This is one Newton iteration on the temperatures of all stages
//! and the loads together. In each of these sweeps a load is heating, cooling, off or at its capacity by what the air
//! would do without it: Newton's way with the complementarity of load and set point (an active set method:
//! Hintermueller, Ito & Kunisch 2002, SIAM J. Optim. 13(3), doi:10.1137/S1052623401383558).
//!
//! The loads of the last sweep miss the set points by hundred-thousandths of a kelvin at most. What is missing the last
//! stage makes up for, so that the air ends on its set point to round-off; the load told is the mean of both.

use core::ops::Range;

use crate::building::coefficients::ZoneCoefficients;
use crate::number::real::{Mask, Real};
use crate::step::state::Unknowns;

/// A load is found when correcting it would move the air by less than this [K]: so little the last stage makes up for.
const CLOSE: f64 = 1e-5;
/// Airs off their set points by less than this are on them [K].
const TOLERANCE: f64 = 1e-8;
/// Set point that is never reached, where there is no heating or no cooling [degC].
const NEVER: f64 = 1e6;

/// What one plant may do over a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits<S> {
    /// Set points of heating and cooling [degC].
    set_points: [S; 2],
    /// Most heating and cooling [W].
    most: [S; 2],
}

impl<S: Real> Limits<S> {
    /// Reads the set points at the end of a step.
    #[inline(always)]
    fn at(zone: &ZoneCoefficients<S>, row: &[f64]) -> Self {
        let nothing = [(S::constant(-NEVER), S::zero()), (S::constant(NEVER), S::zero())];
        let (heating, most_heating) =
            if let Some(ideal_load) = &zone.heating { ideal_load.at(row) } else { nothing[0] };
        let (cooling, most_cooling) =
            if let Some(ideal_load) = &zone.cooling { ideal_load.at(row) } else { nothing[1] };
        Self { set_points: [heating, cooling], most: [most_heating, most_cooling] }
    }

    /// Where a load would be by itself: the load, and whether it holds the air on a set point, and which.
    #[inline(always)]
    fn mode(&self, load: S, air: S, gain: S) -> Mode<S> {
        let [heat, cool] = self.set_points;
        let heating = load + (heat - air) / gain;
        let cooling = load + (cool - air) / gain;
        let heats = S::zero().lt(heating) & S::zero().lt(self.most[0]);
        let cools = cooling.lt(S::zero()) & S::zero().lt(self.most[1]);
        let full = (heats & self.most[0].lt(heating)) | (!heats & cools & cooling.lt(-self.most[1]));
        let fixed = S::select(heats, self.most[0], S::select(cools, -self.most[1], S::zero()));
        Mode { held: (heats | cools) & !full, set_point: S::select(heats, heat, cool), fixed }
    }
}

/// What a plant does: it holds the air on a set point, or gives a fixed load.
#[derive(Debug, Clone, Copy)]
struct Mode<S: Real> {
    held: S::Mask,
    set_point: S,
    fixed: S,
}

/// How a building answers to one watt of one plant over the step.
#[derive(Debug, Clone)]
pub(crate) struct Response<S> {
    /// At the end of each stage [K/W].
    pub(crate) stages: Vec<Unknowns<S>>,
    /// In the enthalpies that the second stage starts from [J/(m3 W)].
    pub(crate) held: Vec<S>,
    /// Forward sweeps of the walls that change.
    pub(crate) known: Vec<S>,
    /// Right-hand side, then solution, of the room block.
    pub(crate) right: Vec<S>,
    /// Of the walls in the second stage [1/m2].
    pub(crate) sources: Vec<[S; 2]>,
}

/// The plants of a building and the search for their loads in one step.
#[derive(Debug, Clone)]
pub(crate) struct IdealLoads<S: Real> {
    /// Zone of each plant.
    zones: Vec<usize>,
    limits: Vec<Limits<S>>,
    /// Answers to each plant.
    pub(crate) responses: Vec<Response<S>>,
    /// Iterate about which each stage was last linearised, and its solution.
    pub(crate) iterates: Vec<Unknowns<S>>,
    pub(crate) solved: Vec<Unknowns<S>>,
    /// The first stage of the step before, and whether this step follows it.
    pub(crate) first: Unknowns<S>,
    pub(crate) follows: bool,
    /// Outdoor air at the ends of the last two steps [degC].
    pub(crate) outdoor: [S; 2],
    /// Loads that the step before set out from [W].
    earlier: Vec<S>,
    /// Lanes that give a load, or have to.
    asking: S::Mask,
    /// Those of them whose responses are known.
    answered: S::Mask,
    /// Change of each load [W].
    pub(crate) correction: Vec<S>,
    matrix: Vec<S>,
    right: Vec<S>,
}

impl<S: Real> IdealLoads<S> {
    pub(crate) fn new(zones: &[usize], unknowns: &Unknowns<S>, rows: usize, stages: usize) -> Self {
        let zeros = |n: usize| vec![S::zero(); n];
        let count = zones.len();
        let response = Response {
            stages: vec![unknowns.clone(); stages],
            held: zeros(unknowns.cells.len()),
            known: zeros(unknowns.cells.len()),
            right: zeros(rows),
            sources: vec![[S::zero(); 2]; unknowns.surfaces.len() / 2],
        };
        let nothing = Limits { set_points: [S::zero(); 2], most: [S::zero(); 2] };
        let kept = if count == 0 { 0 } else { stages };
        Self {
            zones: zones.to_vec(),
            limits: vec![nothing; count],
            responses: vec![response; count],
            iterates: vec![unknowns.clone(); kept],
            solved: vec![unknowns.clone(); kept],
            first: unknowns.clone(),
            follows: false,
            outdoor: [S::zero(); 2],
            earlier: zeros(unknowns.air.len()),
            asking: S::Mask::splat(false),
            answered: S::Mask::splat(false),
            correction: zeros(count),
            matrix: zeros(count * count),
            right: zeros(count),
        }
    }

    /// Sets out on a step that ends with a forcing row. Loads go on as in the step before, where it `follows` one.
    #[inline(always)]
    pub(crate) fn begin(
        &mut self,
        zones: &[ZoneCoefficients<S>],
        row: &[f64],
        loads: &mut [S],
        follows: bool,
    ) {
        self.follows = follows;
        core::mem::swap(&mut self.first, &mut self.solved[0]);
        for (limits, &zone) in self.limits.iter_mut().zip(&self.zones) {
            *limits = Limits::at(&zones[zone], row);
            let (before, now) = (self.earlier[zone], loads[zone]);
            self.earlier[zone] = now;
            let next = if follows { now + now - before } else { now };
            // What heats does not come to cool.
            let next = S::select(S::zero().lt(next * now), next, S::zero());
            loads[zone] = next.min(limits.most[0]).max(-limits.most[1]);
        }
    }

    /// Asks the plants that set out with a load, or whose air is expected off its set points.
    #[inline(always)]
    pub(crate) fn ask(&mut self, loads: &[S], air: impl Fn(usize) -> S) {
        self.answered = S::Mask::splat(false);
        self.asking = !self.within_set_points(air);
        for &zone in &self.zones {
            self.asking = self.asking | S::zero().lt(loads[zone].abs());
        }
    }

    /// Whether some lane needs the responses.
    #[inline(always)]
    pub(crate) fn asking(&self, active: S::Mask) -> bool {
        (self.asking & active).any()
    }

    /// Whether the responses are to be found in a sweep: the second goes by those of the first, which are close enough.
    #[inline(always)]
    pub(crate) fn answering(&mut self, sweep: usize, active: S::Mask) -> bool {
        let answering = sweep != 1 && self.asking(active);
        if answering {
            self.answered = self.asking;
        }
        answering
    }

    /// Keeps what a stage was linearised about, in exchange for what is to be overwritten, and its solution.
    #[inline(always)]
    pub(crate) fn keep(&mut self, stage: usize, iterate: &mut Unknowns<S>, solved: &Unknowns<S>) {
        core::mem::swap(&mut self.iterates[stage], iterate);
        self.solved[stage].copy_from(solved);
    }

    /// Looks at the air at the end of a sweep. True in the lanes whose loads are right; in the other active ones
    /// that know the responses, and in `all` of them on demand, the loads are corrected.
    #[inline(always)]
    pub(crate) fn correct(&mut self, air: &[S], loads: &mut [S], active: S::Mask, all: bool) -> S::Mask {
        let quiet = self.within_set_points(|zone| air[zone]);
        let known = self.answered;
        self.asking = self.asking | !quiet;
        if !(known & active).any() {
            self.correction.fill(S::zero());
            return quiet;
        }
        self.solve(air, loads);
        let mut small = S::Mask::splat(true);
        for (p, &zone) in self.zones.iter().enumerate() {
            let change = self.correction[p] - loads[zone];
            small = small & (change * self.gain(p, p)).abs().lt(S::constant(CLOSE));
            self.correction[p] = change;
        }
        let settled = (known & small) | (!known & quiet);
        let moving = known & active & (!settled | S::Mask::splat(all));
        for (p, &zone) in self.zones.iter().enumerate() {
            self.correction[p] = S::select(moving, self.correction[p], S::zero());
            loads[zone] += self.correction[p];
        }
        settled
    }

    /// The iterate of a stage, and its solution with what the loads have changed since; of cells only those asked for.
    #[inline(always)]
    pub(crate) fn guess(
        &mut self,
        stage: usize,
        cells: &[Range<usize>],
        iterate: &mut Unknowns<S>,
        solved: &mut Unknowns<S>,
    ) {
        core::mem::swap(iterate, &mut self.iterates[stage]);
        let kept = &self.solved[stage];
        solved.surfaces.copy_from_slice(&kept.surfaces);
        solved.air.copy_from_slice(&kept.air);
        for cells in cells {
            solved.cells[cells.clone()].copy_from_slice(&kept.cells[cells.clone()]);
        }
        for (response, &change) in self.responses.iter().zip(&self.correction) {
            let answer = &response.stages[stage];
            let shift = |values: &mut [S], rises: &[S]| {
                for (value, &rise) in values.iter_mut().zip(rises) {
                    *value += rise * change;
                }
            };
            shift(&mut solved.surfaces, &answer.surfaces);
            shift(&mut solved.air, &answer.air);
            for cells in cells {
                shift(&mut solved.cells[cells.clone()], &answer.cells[cells.clone()]);
            }
        }
    }

    /// Corrects the solution of the room block of the last stage by what its loads have to make up for.
    #[inline(always)]
    pub(crate) fn complete(&mut self, air: &[S], loads: &[S], solution: &mut [S]) {
        let asking = self.asking;
        self.solve(air, loads);
        for (p, &zone) in self.zones.iter().enumerate() {
            self.correction[p] = S::select(asking, self.correction[p] - loads[zone], S::zero());
            for (value, &rise) in solution.iter_mut().zip(&self.responses[p].right) {
                *value = S::select(asking, *value + rise * self.correction[p], *value);
            }
        }
    }

    /// True where every air lies between its set points.
    #[inline(always)]
    fn within_set_points(&self, air: impl Fn(usize) -> S) -> S::Mask {
        let slack = S::constant(TOLERANCE);
        let mut within = S::Mask::splat(true);
        for (limits, &zone) in self.limits.iter().zip(&self.zones) {
            let [heat, cool] = limits.set_points;
            let cold = air(zone).lt(heat - slack) & S::zero().lt(limits.most[0]);
            let hot = (cool + slack).lt(air(zone)) & S::zero().lt(limits.most[1]);
            within = within & !(cold | hot);
        }
        within
    }

    /// Answer of the air of plant `p` at the end of the step to plant `q` [K/W].
    #[inline(always)]
    fn gain(&self, p: usize, q: usize) -> S {
        let stages = &self.responses[q].stages;
        stages[stages.len() - 1].air[self.zones[p]]
    }

    /// The loads that the responses ask for, into `correction`.
    #[inline(always)]
    fn solve(&mut self, air: &[S], loads: &[S]) {
        let n = self.zones.len();
        for (load, &zone) in self.correction.iter_mut().zip(&self.zones) {
            *load = loads[zone];
        }
        // Alone, a plant knows its mode at once; several may change each other's.
        for _ in 0..(if n == 1 { 1 } else { 2 * n + 2 }) {
            for (p, &zone) in self.zones.iter().enumerate() {
                let mut now = air[zone];
                let mut idle = air[zone];
                for (q, &other) in self.zones.iter().enumerate() {
                    now += self.gain(p, q) * (self.correction[q] - loads[other]);
                    idle = idle - self.gain(p, q) * loads[other];
                }
                let mode = self.limits[p].mode(self.correction[p], now, self.gain(p, p));
                self.right[p] = S::select(mode.held, mode.set_point - idle, mode.fixed);
                for q in 0..n {
                    let unit = if p == q { S::one() } else { S::zero() };
                    self.matrix[p * n + q] = S::select(mode.held, self.gain(p, q), unit);
                }
            }
            eliminate(&mut self.matrix, &mut self.right);
            self.correction.copy_from_slice(&self.right);
        }
    }

    /// Zone whose load moves most in a lane, and by how much its air would move [K].
    pub(crate) fn worst(&self, lane: usize) -> (usize, f64) {
        let moved = |p: usize| (self.correction[p] * self.gain(p, p)).lane(lane).abs();
        let worst = (0..self.zones.len()).max_by(|&a, &b| moved(a).total_cmp(&moved(b))).unwrap_or(0);
        (self.zones[worst], moved(worst))
    }
}

/// Gaussian elimination without pivoting: responses are inverses of M-matrices, whose principal minors are positive.
#[inline(always)]
fn eliminate<S: Real>(matrix: &mut [S], right: &mut [S]) {
    let n = right.len();
    for k in 0..n {
        let inverse = S::one() / matrix[k * n + k];
        for i in k + 1..n {
            let factor = matrix[i * n + k] * inverse;
            for j in k..n {
                matrix[i * n + j] = matrix[i * n + j] - factor * matrix[k * n + j];
            }
            right[i] = right[i] - factor * right[k];
        }
    }
    for k in (0..n).rev() {
        for j in k + 1..n {
            right[k] = right[k] - matrix[k * n + j] * right[j];
        }
        right[k] = right[k] / matrix[k * n + k];
    }
}
