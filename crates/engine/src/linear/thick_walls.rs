//! Thick walls between zones: what their surfaces add to each other, found by iteration.
//!
//! The matrix `M` of a stage leaves the couplings `C` between the two surfaces of thick walls out
//! ([`thick_walls`](crate::building::thick_walls)). A solution of `(M - C) x = b` is the limit of `M x_(k+1) = b + C x_k`. Each round
//! reduces the error by the largest share of the heat of a surface that reaches the other one within the stage; M-matrices
//! converge from any start (regular splitting; Varga 2000, Matrix Iterative Analysis, ch. 3,
//! doi:10.1007/978-3-642-05156-2). Where a stage is iterated anyway, the iterate stands for `x_k`, and what is left at the end is
//! removed by a few solutions with the factors at hand.

use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::linear::unknowns::Unknowns;
use crate::linear::wall::Response;
use crate::number::real::{ByPrecision, Mask, Real};

/// Heat that may be lacking at a surface in an iteration that is not the last [W/m2].
const ACCEPTED: ByPrecision = ByPrecision { double: 1e-6, single: 1e-4 };
/// Heat that may be lacking in the last one: rounding [W/m2].
const ROUNDING: ByPrecision = ByPrecision { double: 1e-13, single: 1e-5 };
/// What is left of an error after all rounds [-].
const LEFT: ByPrecision = ByPrecision { double: 1e-14, single: 1e-6 };
/// Most rounds: enough where less than 0.996 of the heat of a surface reaches the other one within a stage.
const MOST_ROUNDS: usize = 10_000;

/// A surface of a thick wall.
#[derive(Debug, Clone, Copy)]
struct ThickSurface<S> {
    surface: SideId,
    /// Rows of the surface and of the other one of its wall.
    rows: [usize; 2],
    area: S,
    /// Heat into the surface by the temperature of the other one [W/(m2 K)].
    from_other: S,
}

/// The couplings of thick walls.
#[derive(Debug, Clone)]
pub(crate) struct ThickWalls<S> {
    surfaces: Vec<ThickSurface<S>>,
    /// Rounds after which nothing is left of an error.
    rounds: S,
    /// A right-hand side of all unknowns [W].
    pub(crate) heat: Vec<S>,
}

impl<S: Real> ThickWalls<S> {
    pub(crate) fn new(model: &Model<'_, S>) -> Self {
        let (plan, walls) = (model.plan, &model.coefficients.walls);
        let of = |surface: SideId| ThickSurface {
            surface,
            rows: [surface, surface.opposite()].map(|surface| plan.row(surface)),
            area: walls[surface.wall()].area,
            from_other: S::zero(),
        };
        let surfaces: Vec<_> =
            model.parts.thick_walls.iter().flat_map(|&wall| SideId::pair(wall).map(of)).collect();
        let rows = if surfaces.is_empty() { 0 } else { plan.rows() };
        Self { surfaces, rounds: S::zero(), heat: vec![S::zero(); rows] }
    }

    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.surfaces.is_empty()
    }

    /// Sets the responses of the walls to their surfaces.
    pub(crate) fn set_responses(&mut self, responses: &[Response<S>]) {
        let mut share = S::zero();
        for thick in &mut self.surfaces {
            let (response, side) = (&responses[thick.surface.wall()], thick.surface.side());
            thick.from_other = response.other(side);
            share = share.max(thick.from_other / -response.own(side));
        }
        self.rounds = S::zero();
        let mut left = share;
        for _ in 0..MOST_ROUNDS {
            let more = S::constant(LEFT.of::<S>()).lt(left);
            if !more.any() {
                break;
            }
            self.rounds += S::select(more, S::one(), S::zero());
            left = left * share;
        }
    }

    /// Heat that the other surfaces have added since an iterate, as a right-hand side [W]; the largest [W/m2].
    #[inline(always)]
    pub(crate) fn heat_since(&mut self, iterate: &Unknowns<S>, solution: &Unknowns<S>) -> S {
        let Self { surfaces, heat, .. } = self;
        heat.fill(S::zero());
        let mut largest = S::zero();
        for thick in surfaces {
            let other = thick.surface.opposite();
            let added = thick.from_other * (solution.surfaces[other] - iterate.surfaces[other]);
            heat[thick.rows[0]] += thick.area * added;
            largest = largest.max(added.abs());
        }
        largest
    }

    /// Heat that a change of all unknowns, in place of a right-hand side, adds through the walls [W]; the largest [W/m2].
    #[inline(always)]
    pub(crate) fn heat_of_change(&mut self) -> S {
        let change: Vec<[S; 2]> =
            self.surfaces.iter().map(|thick| [self.heat[thick.rows[1]], thick.from_other]).collect();
        self.heat.fill(S::zero());
        let mut largest = S::zero();
        for (thick, [change, from_other]) in self.surfaces.iter().zip(change) {
            let added = from_other * change;
            self.heat[thick.rows[0]] += thick.area * added;
            largest = largest.max(added.abs());
        }
        largest
    }

    /// Where the solution may be the last: it had lacked little before anything was added.
    #[inline(always)]
    pub(crate) fn accepts(load_residual_before: S) -> S::Mask {
        load_residual_before.lt(S::constant(ACCEPTED.of::<S>()))
    }

    /// Where another round is needed: by the heat that is lacking, and what had been lacking at first. Derivatives take all rounds:
    /// of them nothing is known.
    #[inline(always)]
    pub(crate) fn load_residual(&self, lacking: S, load_residual_before: S, round: S) -> S::Mask {
        let enough = S::select(
            Self::accepts(load_residual_before),
            S::constant(ROUNDING.of::<S>()),
            S::constant(ACCEPTED.of::<S>()),
        );
        let left = round.lt(self.rounds + S::one());
        if S::DERIVATIVES { left } else { left & enough.lt(lacking) }
    }

    /// Keeps the heat in some lanes.
    #[inline(always)]
    pub(crate) fn keep_heat(&mut self, lanes: S::Mask) {
        for thick in &self.surfaces {
            let heat = &mut self.heat[thick.rows[0]];
            *heat = S::select(lanes, *heat, S::zero());
        }
    }

    /// Completes a solution that was found without the couplings; `solve` replaces a right-hand side by such a solution.
    #[inline(always)]
    pub(crate) fn complete(&self, solution: &mut [S], solve: impl Fn(&mut [S])) {
        if self.is_empty() {
            return;
        }
        let mut change = solution.to_vec();
        let mut heat = vec![S::zero(); solution.len()];
        let mut round = S::zero();
        while round.lt(self.rounds).any() {
            let lanes = round.lt(self.rounds);
            heat.fill(S::zero());
            for thick in &self.surfaces {
                let added = thick.area * thick.from_other * change[thick.rows[1]];
                heat[thick.rows[0]] += S::select(lanes, added, S::zero());
            }
            solve(&mut heat);
            for (whole, &part) in solution.iter_mut().zip(&heat) {
                *whole += part;
            }
            core::mem::swap(&mut change, &mut heat);
            round += S::one();
        }
    }
}

impl ThickWalls<f64> {
    /// [`Self::complete`] for values of another kind; with `transposed` the rows of the couplings are their columns.
    pub(crate) fn complete_values<R: Real>(
        &self,
        solution: &mut [R],
        transposed: bool,
        mut solve: impl FnMut(&mut [R]),
    ) {
        if self.is_empty() {
            return;
        }
        let mut change = solution.to_vec();
        let mut heat = vec![R::zero(); solution.len()];
        let mut round = 0.0;
        while round < self.rounds {
            heat.fill(R::zero());
            for thick in &self.surfaces {
                let [to, from] = if transposed { [thick.rows[1], thick.rows[0]] } else { thick.rows };
                heat[to] += change[from].scale(thick.area * thick.from_other);
            }
            solve(&mut heat);
            for (whole, &part) in solution.iter_mut().zip(&heat) {
                *whole += part;
            }
            core::mem::swap(&mut change, &mut heat);
            round += 1.0;
        }
    }
}
