//! What takes vapour away from the air of a zone: ideal drying and humidifying, and saturation.
//!
//! What is taken away never falls with the humidity ratio: minus the capacity of humidifying below its set point, nothing between
//! the set points, the capacity of drying above its set point, and whatever is too much at saturation.

use crate::building::coefficients::humidity::{Dryer, VapourZone};
use crate::number::real::{Mask, Real};
use crate::physics::psychrometrics::humidity_ratio;
use crate::weather::humidity::Plant;

use super::flows::ZoneFlows;

/// What a zone does in a solution: its humidity ratio is held at a value [kg/kg], or a value is taken away [kg/s].
#[derive(Debug, Clone, Copy)]
pub(super) struct Mode<S: Real> {
    pub(super) held: S::Mask,
    pub(super) value: S,
}

impl<S: Real> Mode<S> {
    /// Nothing is taken away.
    pub(super) fn idle() -> Self {
        Self { held: S::Mask::splat(false), value: S::zero() }
    }

    #[inline(always)]
    pub(super) fn differs(&self, other: &Self) -> S::Mask {
        let kind = (self.held & !other.held) | (!self.held & other.held);
        kind | self.value.lt(other.value) | other.value.lt(self.value)
    }
}

/// Set points [kg/kg] and capacities [kg/s].
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits<S> {
    humidify: S,
    most_added: S,
    dry: S,
    most_dried: S,
    saturated: S,
}

impl<S: Real> Limits<S> {
    /// Zeros.
    pub(super) fn none() -> Self {
        let zero = S::zero();
        Self { humidify: zero, most_added: zero, dry: zero, most_dried: zero, saturated: zero }
    }

    /// In a stage, with the pressure of the air and the saturation pressure of the zone [Pa], and its ideal load [W].
    #[inline(always)]
    pub(super) fn new(
        zone: &VapourZone<S>,
        flows: &ZoneFlows<S>,
        (pressure, at_air): (S, S),
        load: S,
    ) -> Self {
        let saturated = humidity_ratio(at_air, pressure);
        if !zone.has_plants() {
            return Self { saturated, dry: saturated, ..Self::none() };
        }
        let target = |plant: &Plant<S>| {
            if plant.relative { humidity_ratio(plant.target * at_air, pressure) } else { plant.target }
        };
        let (dry, most_dried) = match &zone.drying {
            None => (saturated, S::zero()),
            Some(Dryer::Controlled(_)) => (target(&flows.drying).min(saturated), flows.drying.capacity),
            Some(Dryer::Coil { per_heat, saturated: at_coil }) => {
                let at_coil = humidity_ratio(*at_coil, pressure);
                (at_coil.min(saturated), *per_heat * (-load).max(S::zero()))
            }
        };
        let (humidify, most_added) = match &zone.humidifying {
            None => (S::zero(), S::zero()),
            Some(_) => (target(&flows.humidifying).min(dry), flows.humidifying.capacity),
        };
        Self { humidify, most_added, dry, most_dried, saturated }
    }

    /// The same in a stage at a node before the end of the step, whose limits are given, with the humidity ratio at the start of the step.
    ///
    /// Air that is beyond a set point, which has stepped or whose plant was off, comes to it on a straight line over the step, and so does air
    /// that saturation falls below. A stage that held it at once would take away its vapour over a part of the step, and the next one goes on
    /// from the slope of the first: the step would end far on the other side of the set point.
    #[inline(always)]
    pub(super) fn on_the_way(&self, end: &Self, start: S, node: f64) -> Self {
        let line = |target: S| start + (target - start).scale(node);
        let falls = self.saturated.lt(start);
        let saturated = S::select(falls, self.saturated.max(line(end.saturated)), self.saturated);
        let dry = S::select(self.dry.lt(start), self.dry.max(line(end.dry)).min(saturated), self.dry);
        let wet = self.humidify.min(line(end.humidify));
        let humidify = S::select(start.lt(self.humidify), wet, self.humidify);
        Self { humidify, dry, saturated, ..*self }
    }

    /// The mode of a zone, with or without plants, from a humidity ratio and what was taken away: the point of the law on the line
    /// `removed + slope ratio = constant` through both.
    #[inline(always)]
    pub(super) fn mode(&self, plants: bool, ratio: S, removed: S, slope: S) -> Mode<S> {
        let sum = removed + slope * ratio;
        if !plants {
            let below = sum.lt(slope * self.saturated);
            return Mode { held: !below, value: S::select(below, S::zero(), self.saturated) };
        }
        let [humidify, dry, saturated] = [self.humidify, self.dry, self.saturated].map(|at| slope * at);
        let held = |value: S| (S::Mask::splat(true), value);
        let fixed = |value: S| (S::Mask::splat(false), value);
        let mut mode = (S::Mask::splat(true), self.saturated);
        let parts = [
            (saturated + self.most_dried, fixed(self.most_dried)),
            (dry + self.most_dried, held(self.dry)),
            (dry, fixed(S::zero())),
            (humidify, held(self.humidify)),
            (humidify - self.most_added, fixed(-self.most_added)),
        ];
        for (below, (is_held, value)) in parts {
            let here = sum.lt(below);
            mode = ((here & is_held) | (!here & mode.0), S::select(here, value, mode.1));
        }
        Mode { held: mode.0, value: mode.1 }
    }

    /// What is taken away by drying and by condensation, and what is added [kg/s].
    #[inline(always)]
    pub(super) fn shares(&self, removed: S) -> [S; 3] {
        let away = removed.max(S::zero());
        let dried = away.min(self.most_dried);
        [dried, away - dried, (-removed).max(S::zero())]
    }
}
