//! The loads that bring the airs to their set points, from the responses of the building: an active-set method.

use crate::number::dense::solve_many;
use crate::number::real::{Mask, Real};
use crate::step::ideal_loads::limits::Limits;
use crate::step::ideal_loads::loads::IdealLoads;

/// What an ideal load does: it holds the air on a set point, or gives a fixed load.
#[derive(Debug, Clone, Copy)]
struct Mode<S: Real> {
    held: S::Mask,
    set_point: S,
    fixed: S,
}

impl<S: Real> Limits<S> {
    /// The mode of a load with the air at a temperature and its response to the load [K/W].
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

impl<S: Real> IdealLoads<S> {
    /// Compares the airs at the end of a sweep with the set points. True in the lanes whose loads are right; in the other
    /// active lanes whose responses are known (with `all`, in every active one) the loads are corrected.
    #[inline(always)]
    pub(super) fn correct(
        &mut self,
        air: &[S],
        loads: &mut [S],
        (number, active, all): (usize, S::Mask, bool),
    ) -> S::Mask {
        if let Some(held) = &mut self.held {
            let limits = (&self.limits[..], &self.zones[..]);
            self.correction.fill(S::zero());
            return held.correct(limits, (air, loads), (number, active, all));
        }
        let controlled = core::mem::take(&mut self.controlled);
        let held = if controlled.is_empty() { air } else { &controlled };
        let corrected = self.correct_by_responses(held, loads, (active, all));
        self.controlled = controlled;
        corrected
    }

    /// As [`Self::correct`], by the responses, of what the set points hold.
    #[inline(always)]
    fn correct_by_responses(
        &mut self,
        air: &[S],
        loads: &mut [S],
        (active, all): (S::Mask, bool),
    ) -> S::Mask {
        let quiet = self.within_set_points(|zone| air[zone]);
        let known = self.responses_known;
        self.needed = self.needed | !quiet;
        if !(known & active).any() {
            self.correction.fill(S::zero());
            return quiet;
        }
        self.solve(air, loads);
        let mut small = S::Mask::splat(true);
        for (p, &zone) in self.zones.iter().enumerate() {
            let change = self.correction[p] - loads[zone];
            small = small & (change * self.gain(p, p)).abs().lt(S::constant(self.close));
            self.correction[p] = change;
        }
        let found = (known & small) | (!known & quiet);
        let moving = known & active & (!found | S::Mask::splat(all));
        for (p, &zone) in self.zones.iter().enumerate() {
            self.correction[p] = S::select(moving, self.correction[p], S::zero());
            loads[zone] += self.correction[p];
        }
        found
    }

    /// Corrects the solution of the coupled system of the last stage by the missing loads.
    #[inline(always)]
    pub(super) fn complete_by_responses(&mut self, air: &[S], loads: &[S], solution: &mut [S]) {
        let needed = self.needed;
        self.solve(air, loads);
        for (p, &zone) in self.zones.iter().enumerate() {
            self.correction[p] = S::select(needed, self.correction[p] - loads[zone], S::zero());
            for (value, &rise) in solution.iter_mut().zip(&self.responses[p].right) {
                *value = S::select(needed, *value + rise * self.correction[p], *value);
            }
        }
    }

    /// The loads that follow from the responses, into `correction`.
    #[inline(always)]
    fn solve(&mut self, air: &[S], loads: &[S]) {
        let Self { zones, limits, responses, correction, matrix, right, .. } = self;
        find_loads(
            (zones, limits),
            #[inline(always)]
            |p, q| responses[q].gain(zones[p]),
            (air, loads),
            (correction, matrix, right),
        );
    }
}

/// The loads of some zones that bring airs, or what else the set points hold, to their set points, by the response `gain(p, q)` of the air
/// of load `p` to load `q` [K/W].
#[inline(always)]
pub(super) fn find_loads<S: Real>(
    (zones, limits): (&[usize], &[Limits<S>]),
    gain: impl Fn(usize, usize) -> S,
    (air, loads): (&[S], &[S]),
    (found, matrix, right): (&mut [S], &mut [S], &mut [S]),
) {
    let n = zones.len();
    for (load, &zone) in found.iter_mut().zip(zones) {
        *load = loads[zone];
    }
    // The mode of a single load is found at once; several loads may change each other's modes.
    for _ in 0..(if n == 1 { 1 } else { 2 * n + 2 }) {
        for (p, &zone) in zones.iter().enumerate() {
            let mut now = air[zone];
            let mut without = air[zone];
            for (q, &other) in zones.iter().enumerate() {
                now += gain(p, q) * (found[q] - loads[other]);
                without = without - gain(p, q) * loads[other];
            }
            let mode = limits[p].mode(found[p], now, gain(p, p));
            right[p] = S::select(mode.held, mode.set_point - without, mode.fixed);
            for q in 0..n {
                let unit = if p == q { S::one() } else { S::zero() };
                matrix[p * n + q] = S::select(mode.held, gain(p, q), unit);
            }
        }
        // Responses are the inverse of an M-matrix, whose principal minors are positive: no pivoting.
        solve_many(matrix, right, 1);
        let mut loads = right.iter().zip(&*found);
        let moved = loads.any(|(&new, &old)| (new.lt(old) | old.lt(new)).any());
        found.copy_from_slice(right);
        // The same loads have the same modes, and these the same solution.
        if !moved {
            break;
        }
    }
}
