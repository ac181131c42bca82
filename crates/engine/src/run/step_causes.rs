//! Temperatures that a single step carries beyond everything that acts on the building in it: a step too long for light parts.
//!
//! A step starts from a state, and outdoor air, sky, imposed temperatures and supplied air act in it. Without sun, gains and plants nothing may
//! end the step colder than the coldest, or warmer than the warmest, of these (the maximum principle). A part that follows what acts on it
//! more than 2.41 times within a step of SDIRK2 goes beyond it, by up to 0.21 of the difference, and what it touches follows
//! ([`physical_limits`](super::physical_limits)). Temperatures at the end of the step are no causes of it: a room between light walls
//! goes with them.
//!
//! A surface outdoors has the sky as a cause in so far as it radiates to it: what acts on it is the temperature at which it would
//! exchange nothing with air and sky together.

use crate::building::coefficients::{Boundary, BridgeEnd, Imposed};
use crate::building::ids::SurfaceId;
use crate::building::model::outdoor_emission;
use crate::input::forcing::channel;
use crate::number::real::{Mask, Real};
use crate::step::film::film;
use crate::step::scheme::Scheme;
use crate::step::state::State;
use crate::step::stepper::Stepper;

/// How far a step may go beyond its causes [K]: the same as `step/overshoot.rs` allows for airs.
const BEYOND: f64 = 0.5;
/// Newton's iterations for the temperature at which a surface exchanges nothing: from 40 K off the second one ends within 0.02 K.
const ITERATIONS: usize = 2;

/// Follows the steps of a run.
#[derive(Debug, Clone)]
pub(super) struct StepCauses<S: Real> {
    /// Lowest and highest temperature of the state that the next step starts from [degC].
    range: [S; 2],
    /// Lanes that were heated, and those that were cooled, at the end of the last step.
    supplied: [S::Mask; 2],
    /// Where the straight line through the weather of both stages starts: fraction from the first to the last one.
    start: f64,
}

/// What a step was found to do.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepFinding<S> {
    /// How far a temperature is beyond what acts in the step, beside what is allowed; not above zero in a sound step [K].
    pub(super) excess: S,
    /// Lowest and highest of what acts [degC].
    pub(super) causes: [S; 2],
}

impl<S: Real> StepCauses<S> {
    /// Begins with the lowest and highest temperature that a run starts from [degC].
    pub(super) fn new(range: [S; 2], scheme: Scheme) -> Self {
        let start = match scheme.nodes() {
            [first, last] => -first / (last - first),
            _ => 0.0,
        };
        Self { range, supplied: [S::Mask::splat(true); 2], start }
    }

    /// Judges the state at the end of a step from its lowest and highest temperature [degC]; `supplied`: lanes that are heated, and those
    /// that are cooled. A state that no step has made (`is_step` is false) only begins the next one.
    #[inline(always)]
    pub(super) fn judge(
        &mut self,
        stepper: &Stepper<'_, S>,
        state: &State<S>,
        rows: [&[f64]; 2],
        (reached, supplied, is_step): ([S; 2], [S::Mask; 2], bool),
    ) -> StepFinding<S> {
        let ([low, high], beyond) = (self.range, S::constant(BEYOND));
        let [first, last] = rows.map(|row| row[channel::AIR_TEMPERATURE]);
        let causes = [low.min(S::constant(first.min(last))), high.max(S::constant(first.max(last)))];
        // Heat raises temperatures above their causes, and cooling lowers them; what has been supplied in the step before is on its way.
        let [heated, cooled] = [0, 1].map(|kind| supplied[kind] | self.supplied[kind]);
        let suspects =
            [(reached[0] + beyond).lt(causes[0]) & !cooled, (causes[1] + beyond).lt(reached[1]) & !heated];
        (self.range, self.supplied) = (reached, supplied);
        let mut finding = StepFinding { excess: S::zero(), causes };
        if is_step && (suspects[0] | suspects[1]).any() {
            finding = self.examine(stepper, state, rows, (reached, suspects, causes));
        }
        finding
    }

    /// As [`Self::judge`], with all causes.
    // One copy only, and rare.
    #[cold]
    #[inline(never)]
    fn examine(
        &self,
        stepper: &Stepper<'_, S>,
        state: &State<S>,
        rows: [&[f64]; 2],
        (reached, suspects, causes): ([S; 2], [S::Mask; 2], [S; 2]),
    ) -> StepFinding<S> {
        let [low, high] = self.causes(stepper, state, rows, causes);
        let (zero, beyond) = (S::zero(), S::constant(BEYOND));
        let cold = S::select(suspects[0], low - reached[0] - beyond, zero);
        let hot = S::select(suspects[1], reached[1] - high - beyond, zero);
        StepFinding { excess: cold.max(hot), causes: [low, high] }
    }

    /// Widens causes by all temperatures around the building in a step [degC].
    fn causes(
        &self,
        stepper: &Stepper<'_, S>,
        state: &State<S>,
        rows: [&[f64]; 2],
        [mut low, mut high]: [S; 2],
    ) -> [S; 2] {
        let (conditions, numbers) = (&stepper.weather.conditions, &stepper.model.coefficients);
        let mut act = |temperature: S| {
            low = low.min(temperature);
            high = high.max(temperature);
        };
        // Parts of a step have the weather of a straight line through both stages.
        let mut act_in = |channel: usize| {
            let [first, last] = rows.map(|row| row[channel]);
            for value in [first, last, first + (last - first) * self.start] {
                act(S::constant(value));
            }
        };
        act_in(channel::AIR_TEMPERATURE);
        for &surface in &stepper.weather.index.imposed {
            if let Boundary::Imposed(Imposed::Channel(channel)) = numbers.surfaces[surface].boundary {
                act_in(channel);
            }
        }
        for bridge in &numbers.bridges {
            if let BridgeEnd::Imposed(Imposed::Channel(channel)) = bridge.to {
                act_in(channel);
            }
        }
        for row in rows {
            let air = S::constant(row[channel::AIR_TEMPERATURE]);
            for unit in &numbers.mechanical_air.units {
                act(air + unit.excess(row, air));
            }
        }
        for &surface in &stepper.weather.index.imposed {
            act(conditions.surfaces[surface].temperature);
        }
        for &bridge in conditions.bridges.iter().flatten() {
            act(bridge);
        }
        for surface in stepper.model.plan.surfaces.ids() {
            if let Some(temperature) = without_exchange(stepper, state, surface) {
                act(temperature);
            }
        }
        [low, high]
    }
}

/// Temperature [degC] at which a surface outdoors would exchange nothing with air and sky together; none where it exchanges no
/// long-wave radiation of its own.
fn without_exchange<S: Real>(stepper: &Stepper<'_, S>, state: &State<S>, surface: SurfaceId) -> Option<S> {
    let (conditions, model) = (&stepper.weather.conditions, &stepper.model);
    let numbers = &model.coefficients.surfaces[surface];
    let law = outdoor_emission(numbers)?;
    let at = &conditions.surfaces[surface];
    let coefficient = film(model, conditions, surface, state.surfaces[surface], at.temperature);
    let mut temperature = state.surfaces[surface];
    for _ in 0..ITERATIONS {
        let (emitted, slope) = law.at(temperature);
        let exchange =
            at.longwave - numbers.emissivity * emitted + coefficient * (at.temperature - temperature);
        temperature += exchange / (numbers.emissivity * slope + coefficient).max(S::constant(1e-9));
    }
    Some(temperature)
}
