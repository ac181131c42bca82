//! Airs that a step of two stages carries beyond everything that acts on them: such a step is made in parts.
//!
//! The second stage of SDIRK2 goes on from the slope of the first one. Where the air of a zone is exchanged more than 2.41 times in a
//! step, and what it is exchanged with changes at once (a window that opens), it goes beyond that by up to 0.21 of the difference
//! (`run/physical_limits.rs`): 8 K below the outdoor air for a room at 20 degC whose window opens at -30 degC. In a part that is shorter
//! it does not. Steps in parts close their balances as whole ones do, and keep the second order, which stages of backward Euler would not.
//!
//! The bound is coarse on purpose: a step in parts costs up to a dozen times as much, and its result differs from that of the whole step by
//! about the bound, so that results are not continuous where a step just needs it.

use crate::building::coefficients::{BridgeEnd, Imposed};
use crate::input::forcing::channel;
use crate::number::real::{Mask, Real};
use crate::step::halving::Part;
use crate::step::state::State;
use crate::step::stepper::Stepper;
use crate::weather::conditions::Weather;

/// Farthest that the air of a zone may be beyond its causes at the end of a step [K].
const BEYOND: f64 = 0.5;

impl<S: Real> Stepper<'_, S> {
    /// Whether the part just solved has to be divided, because the air of a zone has left the span of its causes. Lanes where it has are marked
    /// as failed: they are run again alone.
    #[inline(always)]
    pub(super) fn overshoots(&mut self, state: &State<S>, weather: &Weather<'_>, part: Part) -> bool {
        if self.scheme.weights().len() == 1 {
            return false;
        }
        let mut turned = S::Mask::splat(false);
        for zone in 0..state.air.len() {
            let [cold, hot] = self.turned(state, zone);
            turned = turned | cold | hot;
        }
        turned.any() && self.leaves_causes(state, weather, part)
    }

    /// End of the first stage of the part just solved: the second one starts from `T_n + ratio (T_1 - T_n)` [degC].
    #[inline(always)]
    fn first_air(&self, state: &State<S>, zone: usize) -> S {
        let (start, held) = (state.air[zone], self.solver.start.air[zone]);
        start + (held - start).scale(1.0 / self.scheme.tableau().ratio)
    }

    /// Lanes where the air of a zone has gone on falling, and those where it has gone on rising, in the second stage, by more than the bound,
    /// though what acts on it there works against this. An air that is beyond its causes has done so.
    #[inline(always)]
    fn turned(&self, state: &State<S>, zone: usize) -> [S::Mask; 2] {
        let (held, end) = (self.solver.start.air[zone], self.solver.solution.air[zone]);
        let (first, beyond) = (self.first_air(state, zone), S::constant(BEYOND));
        [(end + beyond).lt(first) & held.lt(end), (first + beyond).lt(end) & end.lt(held)]
    }

    /// As [`Self::overshoots`], of airs that have turned.
    // One copy only, and rare.
    #[cold]
    #[inline(never)]
    fn leaves_causes(&mut self, state: &State<S>, weather: &Weather<'_>, part: Part) -> bool {
        let (mut left, beyond) = (S::Mask::splat(false), S::constant(BEYOND));
        for zone in 0..state.air.len() {
            let [cold, hot] = self.turned(state, zone);
            if !(cold | hot).any() {
                continue;
            }
            let [low, high] = self.causes(state, weather, part, zone);
            let end = self.solver.solution.air[zone];
            let conditions = &self.weather.conditions;
            let mut heat = conditions.zones[zone].convective + self.solver.start.load[zone];
            if let Some(&sun) = conditions.sun.to_air.get(zone) {
                heat += sun;
            }
            // Heat raises an air above its causes, and cooling lowers it below them.
            left = left | (cold & (end + beyond).lt(low) & !heat.lt(S::zero()));
            left = left | (hot & (high + beyond).lt(end) & !S::zero().lt(heat));
        }
        left = left & !self.solver.failed;
        if !left.any() {
            return false;
        }
        if const { S::LANES > 1 } {
            self.mark_failed(left);
            return false;
        }
        part.divisible() && !self.limit_reached()
    }

    /// Lowest and highest temperature of what acts on the air of a zone in the part just solved, beside heat [degC].
    fn causes(&self, state: &State<S>, weather: &Weather<'_>, part: Part, zone: usize) -> [S; 2] {
        let (conditions, numbers) = (&self.weather.conditions, &self.model.coefficients);
        let mut bounds = [state.air[zone]; 2];
        let mut act = |temperature: S| {
            bounds = [bounds[0].min(temperature), bounds[1].max(temperature)];
        };
        act(conditions.outdoor_air);
        for stage in 0..2 {
            let row = weather.row(part.step, stage);
            let outdoor = S::constant(row[channel::AIR_TEMPERATURE]);
            act(outdoor);
            for bridge in &numbers.bridges {
                if let BridgeEnd::Imposed(Imposed::Channel(channel)) = bridge.to {
                    act(S::constant(row[channel]));
                }
            }
            for unit in &numbers.mechanical_air.units {
                act(outdoor + unit.excess(row, outdoor));
            }
        }
        for &surface in &self.model.plan.zones[zone].surfaces {
            act(state.surfaces[surface]);
            act(self.solver.solution.surfaces[surface]);
        }
        for &bridge in conditions.bridges.iter().flatten() {
            act(bridge);
        }
        act(self.first_air(state, zone));
        for other in (0..state.air.len()).filter(|&other| other != zone) {
            act(state.air[other]);
            let first = self.first_air(state, other);
            act(first);
            // The end of one that may be beyond its own causes is none.
            let [cold, hot] = self.turned(state, other);
            act(S::select(cold | hot, first, self.solver.solution.air[other]));
        }
        bounds
    }
}
