//! Internal gains and the settings of ideal heating and cooling.

use crate::input::description;
use crate::input::forcing::{CLIMATE_CHANNELS, Schedule, scheduled};
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::occupants;

/// Heat from people, light and machines.
#[derive(Debug, Clone)]
pub struct Gain<S> {
    /// Part given to the air [W].
    convective: S,
    /// Part radiated to the surfaces [W].
    radiant: S,
    /// Part radiated [-].
    radiative: S,
    /// Heat of the activity of a person, of whose heat only the sensible part counts [W]; none: all of it does.
    activity: Option<S>,
    schedule: Schedule,
}

impl<S: Real> Gain<S> {
    /// Evaluates a gain at a parameter vector.
    #[must_use]
    pub fn new(gain: &description::Gain, values: &Values<'_, S>) -> Self {
        let (power, radiative) = (values.get(gain.power), values.get(gain.radiative));
        Self {
            convective: power * (S::one() - radiative),
            radiant: power * radiative,
            radiative,
            activity: gain.activity.map(|id| values.get(id)),
            schedule: Schedule::new(gain.schedule),
        }
    }

    /// Convective and radiant part [-].
    pub(crate) fn parts(&self) -> [S; 2] {
        [S::one() - self.radiative, self.radiative]
    }

    /// Whether it changes with the temperature of the air.
    pub(crate) fn of_people(&self) -> bool {
        self.activity.is_some()
    }

    /// Heat given to the air and heat radiated to the surfaces in a forcing row [W]; `air`: of the zone at the start of the step
    /// [degC].
    #[inline(always)]
    pub(crate) fn at(&self, row: &[f64], air: S) -> [S; 2] {
        let parts = [self.convective, self.radiant].map(|part| scheduled(part, self.schedule, row));
        match self.activity {
            Some(activity) => {
                let share = occupants::sensible_share(activity, air);
                parts.map(|part| part * share)
            }
            None => parts,
        }
    }
}

/// Set point and capacity of ideal heating or cooling.
#[derive(Debug, Clone)]
pub struct Thermostat<S> {
    set_point: SetPoint<S>,
    capacity: Option<S>,
    /// Part that is radiated [-]; none: all of it goes to the air.
    pub(crate) radiative: Option<S>,
    schedule: Schedule,
}

#[derive(Debug, Clone, Copy)]
enum SetPoint<S> {
    /// [degC].
    Constant(S),
    /// Position in a forcing row.
    Scheduled(usize),
}

impl<S: Real> Thermostat<S> {
    /// Capacity where none is given [W]: more than any building needs.
    const UNLIMITED: f64 = 1e12;

    /// Limits what is radiated to a power [W], whatever the capacity.
    #[must_use]
    pub(crate) fn radiating_at_most(mut self, power: S) -> Self {
        if let Some(part) = self.radiative {
            // A part of zero radiates nothing, and sets no limit.
            let most = S::select(S::zero().lt(part), power / part, S::constant(Self::UNLIMITED));
            self.capacity = Some(self.capacity.map_or(most, |capacity| capacity.min(most)));
        }
        self
    }

    /// Evaluates ideal heating or cooling at a parameter vector.
    #[must_use]
    pub fn new(ideal_load: &description::IdealLoad, values: &Values<'_, S>) -> Self {
        let set_point = match ideal_load.setpoint {
            description::SetPoint::Constant { temperature } => SetPoint::Constant(values.get(temperature)),
            description::SetPoint::Scheduled { channel } => SetPoint::Scheduled(CLIMATE_CHANNELS + channel),
        };
        let capacity = ideal_load.capacity.map(|id| values.get(id));
        let radiative = ideal_load.radiative.map(|id| values.get(id));
        Self { set_point, capacity, radiative, schedule: Schedule::new(ideal_load.schedule) }
    }

    /// Set point [degC] and capacity [W] in a forcing row.
    #[inline(always)]
    pub fn at(&self, row: &[f64]) -> (S, S) {
        let set_point = match self.set_point {
            SetPoint::Constant(temperature) => temperature,
            SetPoint::Scheduled(channel) => S::constant(row[channel]),
        };
        let capacity = match self.capacity {
            Some(capacity) => capacity,
            None => S::constant(Self::UNLIMITED),
        };
        (set_point, scheduled(capacity, self.schedule, row))
    }
}
