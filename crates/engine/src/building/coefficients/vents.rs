//! Openings of the pressure network and the controls of openings.

use super::air;
use super::surface::wind_factor;
use crate::building::plan::Plan;
use crate::input::description::{Band, Vent, VentControl, WindOnVent};
use crate::input::forcing::{CLIMATE_CHANNELS, Schedule, scheduled};
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::constants::GRAVITY;
use crate::physics::vents::{self, HALF_PLACE};

/// Temperature that the density of the site belongs to [K]: that of the standard atmosphere at sea level.
pub(crate) const OF_DENSITY: f64 = 288.15;

/// Round-off of a time that steps add up to [s].
const SLACK: f64 = 1e-3;

/// All of them; empty in a building without.
#[derive(Debug, Clone)]
pub struct Vents<S> {
    /// Openings of the pressure network.
    pub(crate) all: Vec<VentNumbers<S>>,
    /// Controls.
    pub(crate) controls: Vec<Control<S>>,
    /// Heat capacity of a cubic metre of air [J/(m3 K)].
    pub(crate) heat: S,
    /// Weight of a cubic metre of air of the site [N/m3].
    pub(crate) weight: S,
}

/// An opening of the pressure network.
#[derive(Debug, Clone)]
pub(crate) struct VentNumbers<S> {
    pub(crate) zone: usize,
    pub(crate) to: Option<usize>,
    /// Heights above the ground of the parts that air passes in one direction [m].
    pub(crate) heights: Vec<S>,
    /// Volume flow of one part at 1 Pa with air of the site [m3/s].
    pub(crate) strength: S,
    pub(crate) exponent: S,
    wind: Option<Wind<S>>,
    schedule: Schedule,
    pub(crate) control: Option<usize>,
}

/// The wind on an opening.
#[derive(Debug, Clone)]
struct Wind<S> {
    coefficients: vents::Coefficients<S>,
    azimuth: S,
    /// Dynamic pressure of air of the site where the wind at the mast is 1 m/s [Pa].
    dynamic: S,
}

impl<S: Real> Wind<S> {
    fn new(plan: &Plan, wind: &WindOnVent, values: &Values<'_, S>, density: S) -> Self {
        let factor = wind_factor(plan, wind.height, values) * values.get(wind.shelter);
        Self {
            coefficients: vents::Coefficients::new(&wind.pressure, |id| values.get(id)),
            azimuth: values.get_or(wind.azimuth, 0.0),
            dynamic: density.scale(0.5) * factor * factor,
        }
    }
}

impl<S: Real> VentNumbers<S> {
    fn new(plan: &Plan, vent: &Vent, values: &Values<'_, S>, density: S) -> Self {
        let middle = values.get(vent.elevation);
        let heights = match vent.height {
            None => vec![middle],
            Some(height) => {
                let place = values.get(height).scale(HALF_PLACE);
                vec![middle - place, middle + place]
            }
        };
        let area = values.get(vent.area).scale(1.0 / heights.len() as f64);
        let exponent = values.get(vent.exponent);
        Self {
            zone: vent.zone,
            to: vent.to,
            strength: vents::strength(area, values.get(vent.discharge), exponent, density),
            heights,
            exponent,
            wind: vent.wind.as_ref().map(|wind| Wind::new(plan, wind, values, density)),
            schedule: Schedule::new(vent.schedule),
            control: vent.control,
        }
    }

    /// Fraction of the area that its schedule opens in a forcing row [-].
    #[inline(always)]
    pub(crate) fn open(&self, row: &[f64]) -> S {
        scheduled(S::one(), self.schedule, row)
    }

    /// Pressure of a wind at the mast [m/s] from a direction [deg], above that of still air [Pa].
    #[inline(always)]
    pub(crate) fn pressure(&self, speed: f64, direction: f64) -> S {
        self.wind.as_ref().map_or_else(S::zero, |wind| {
            wind.dynamic.scale(speed * speed) * wind.coefficients.at(direction, wind.azimuth)
        })
    }
}

/// Limits of a condition: beyond the first it lets open what is closed, beyond the second it closes what is open.
type Limits<S> = [S; 2];

/// What opens and closes openings.
#[derive(Debug, Clone)]
pub(crate) struct Control<S> {
    zone: usize,
    /// Zone that the difference is taken to; none: the outdoor air.
    reference: Option<usize>,
    indoor: Option<Limits<S>>,
    outdoor: Option<Limits<S>>,
    difference: Option<Limits<S>>,
    indoor_below: Option<Limits<S>>,
    outdoor_below: Option<Limits<S>>,
    wind: Option<Limits<S>>,
    rain: Option<(usize, Limits<S>)>,
    /// Times for which it stays open and closed [s].
    minimum_open: S,
    minimum_closed: S,
}

impl<S: Real> Control<S> {
    fn new(control: &VentControl, values: &Values<'_, S>) -> Self {
        let band = |band: &Band| [values.get(band.open), values.get(band.close)];
        let of = |given: &Option<Band>| given.as_ref().map(band);
        let seconds = |id| values.get_or(id, 0.0).scale(60.0);
        Self {
            zone: control.zone,
            reference: control.reference_zone,
            indoor: of(&control.indoor),
            outdoor: of(&control.outdoor),
            difference: of(&control.difference),
            indoor_below: of(&control.indoor_below),
            outdoor_below: of(&control.outdoor_below),
            wind: of(&control.wind),
            rain: control.rain.as_ref().map(|rain| (CLIMATE_CHANNELS + rain.channel, band(&rain.band))),
            minimum_open: seconds(control.minimum_open_time),
            minimum_closed: seconds(control.minimum_closed_time),
        }
    }

    /// 1 where it opens or stays open, else 0, after it was in a state for a time [s], with the airs of the zones and the outdoor air
    /// [degC] and the wind at the mast [m/s] of a forcing row. Wind and rain close it at once.
    pub(crate) fn decide(
        &self,
        before: S,
        unchanged: S,
        air: &[S],
        outdoor: f64,
        wind: f64,
        row: &[f64],
    ) -> S {
        let was_open = S::constant(0.5).lt(before);
        let mut warm = S::one();
        let limit = |[opens, closes]: Limits<S>| S::select(was_open, closes, opens);
        let (indoor, outdoor) = (air[self.zone], S::constant(outdoor));
        let reference = self.reference.map_or(outdoor, |zone| air[zone]);
        let above = [(self.indoor, indoor), (self.outdoor, outdoor), (self.difference, indoor - reference)];
        for (limits, value) in above {
            if let Some(limits) = limits {
                warm = S::select(limit(limits).lt(value), warm, S::zero());
            }
        }
        for (limits, value) in [(self.indoor_below, indoor), (self.outdoor_below, outdoor)] {
            if let Some(limits) = limits {
                warm = S::select(value.lt(limit(limits)), warm, S::zero());
            }
        }
        let stays =
            unchanged.lt(S::select(was_open, self.minimum_open, self.minimum_closed) - S::constant(SLACK));
        let mut open = S::select(stays, before, warm);
        let rain = self.rain.map(|(channel, limits)| (limits, row[channel]));
        for (limits, value) in self.wind.map(|limits| (limits, wind)).into_iter().chain(rain) {
            // At the limit itself it is open: no rain is 0.
            open = S::select(limit(limits).lt(S::constant(value)), S::zero(), open);
        }
        open
    }
}

impl<S: Real> Vents<S> {
    pub(crate) fn new(plan: &Plan, values: &Values<'_, S>) -> Self {
        let density = air::density(plan, values);
        let description = &plan.description;
        Self {
            all: description.vents.iter().map(|vent| VentNumbers::new(plan, vent, values, density)).collect(),
            controls: description.controls.iter().map(|control| Control::new(control, values)).collect(),
            heat: air::heat_capacity(plan, values, density),
            weight: density.scale(GRAVITY),
        }
    }

    /// Whether there are none.
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.all.is_empty() && self.controls.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Opens above 24 degC and 2 K warmer than outdoors, closes below 22 degC, 1 K, or above 8 m/s; opens again below 6 m/s, without rain.
    #[test]
    fn hysteresis() {
        let control = Control {
            zone: 0,
            reference: None,
            indoor: Some([24.0, 22.0]),
            outdoor: None,
            difference: Some([2.0, 1.0]),
            indoor_below: None,
            outdoor_below: None,
            wind: Some([6.0, 8.0]),
            rain: Some((0, [0.0, 0.2])),
            minimum_open: 0.0,
            minimum_closed: 0.0,
        };
        let decide = |before: f64, air: f64, outdoor: f64, wind: f64, rain: f64| {
            control.decide(before, 0.0, &[air], outdoor, wind, &[rain])
        };
        assert_eq!((decide(0.0, 23.0, 18.0, 3.0, 0.0), decide(1.0, 23.0, 18.0, 3.0, 0.0)), (0.0, 1.0));
        assert_eq!((decide(0.0, 24.5, 23.0, 3.0, 0.0), decide(1.0, 24.5, 23.0, 3.0, 0.0)), (0.0, 1.0));
        assert_eq!((decide(0.0, 25.0, 18.0, 7.0, 0.0), decide(1.0, 25.0, 18.0, 7.0, 0.0)), (0.0, 1.0));
        assert_eq!((decide(0.0, 25.0, 18.0, 3.0, 0.1), decide(1.0, 25.0, 18.0, 3.0, 0.1)), (0.0, 1.0));
        assert_eq!((decide(0.0, 24.5, 18.0, 6.0, 0.0), decide(1.0, 24.5, 18.0, 8.1, 0.0)), (1.0, 0.0));
        assert_eq!((decide(1.0, 21.9, 18.0, 3.0, 0.0), decide(1.0, 24.0, 18.0, 3.0, 0.3)), (0.0, 0.0));
    }
}
