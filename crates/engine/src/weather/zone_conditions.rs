//! What acts on the air of a zone in one stage beside its walls: internal gains, ventilation and openings.

use crate::building::coefficients::ZoneCoefficients;
use crate::input::forcing::scheduled;
use crate::number::line::Line;
use crate::number::real::Real;
use crate::physics::air_flow::{self, Intake};
use crate::physics::flow_density::AirDensities;

/// What acts on the air of a zone in one stage.
#[derive(Debug, Clone)]
pub struct ZoneConditions<S> {
    /// Gains given to the air [W].
    pub convective: S,
    /// Gains radiated to the surfaces [W].
    pub radiant: S,
    /// Heat carried per degree by the ventilation that is not controlled [W/K].
    pub ventilation: S,
    /// The same of each flow that a control opens and closes [W/K].
    controlled: Vec<S>,
    /// Heat capacity of the zone's volume of the air that infiltrates [J/K]; none: at the density of the site.
    infiltrated_capacity: Option<S>,
    /// Air that moves within the zone [1/h]; none: no fan moves any.
    mixing: Option<S>,
    /// Vertical gradient of the air temperature [K/m].
    pub(crate) gradient: S,
    /// Open fraction of each opening [-].
    open: Vec<S>,
}

impl<S: Real> ZoneConditions<S> {
    /// Zeros for a zone.
    #[must_use]
    pub fn new(zone: &ZoneCoefficients<S>) -> Self {
        let zero = S::zero();
        Self {
            convective: zero,
            radiant: zero,
            ventilation: zero,
            controlled: vec![zero; zone.ventilation_controls.iter().flatten().count()],
            infiltrated_capacity: zone.infiltrated_capacity.as_ref().map(|_| zero),
            mixing: zone.mixing.as_ref().map(|_| zero),
            gradient: zero,
            open: vec![zero; zone.openings.len()],
        }
    }

    /// Linear interpolation or extrapolation of two others: `fraction` 0 at the first, 1 at the second.
    ///
    /// Ventilation is not extrapolated below zero, and open fractions stay between 0 and 1.
    pub(crate) fn interpolate(&mut self, first: &Self, second: &Self, fraction: f64) {
        let line = |a: S, b: S| a + (b - a).scale(fraction);
        self.convective = line(first.convective, second.convective);
        self.radiant = line(first.radiant, second.radiant);
        self.ventilation = line(first.ventilation, second.ventilation).max(S::zero());
        for (at, (&a, &b)) in self.controlled.iter_mut().zip(first.controlled.iter().zip(&second.controlled))
        {
            *at = line(a, b).max(S::zero());
        }
        if let (Some(at), Some(a), Some(b)) =
            (&mut self.infiltrated_capacity, first.infiltrated_capacity, second.infiltrated_capacity)
        {
            *at = line(a, b).max(S::zero());
        }
        if let (Some(at), Some(a), Some(b)) = (&mut self.mixing, first.mixing, second.mixing) {
            *at = line(a, b).max(S::zero());
        }
        self.gradient = line(first.gradient, second.gradient);
        for (at, (&a, &b)) in self.open.iter_mut().zip(first.open.iter().zip(&second.open)) {
            *at = line(a, b).max(S::zero()).min(S::one());
        }
    }

    /// Evaluates gains, ventilation and openings in a forcing row; `air`: of the zone at the start of the step [degC].
    #[inline(always)]
    pub(crate) fn update(
        &mut self,
        zone: &ZoneCoefficients<S>,
        row: &[f64],
        densities: &AirDensities<S>,
        air: S,
    ) {
        (self.convective, self.radiant) = (S::zero(), S::zero());
        for gain in &zone.gains {
            let [convective, radiant] = gain.at(row, air);
            self.convective += convective;
            self.radiant += radiant;
        }
        self.ventilation = S::zero();
        let mut controlled = self.controlled.iter_mut();
        for (flow, control) in zone.ventilation.iter().zip(&zone.ventilation_controls) {
            match control.and_then(|_| controlled.next()) {
                Some(at) => *at = flow.at(row, densities),
                None => self.ventilation += flow.at(row, densities),
            }
        }
        if let Some(capacity) = &zone.infiltrated_capacity {
            self.infiltrated_capacity = Some(capacity.at(row, densities));
        }
        if let Some((air_changes, schedule)) = zone.mixing {
            self.mixing = Some(scheduled(air_changes, schedule, row));
        }
        if let Some((gradient, schedule)) = zone.gradient {
            self.gradient = scheduled(gradient, schedule, row);
        }
        for (open, opening) in self.open.iter_mut().zip(&zone.openings) {
            *open = opening.open_fraction(row);
        }
    }

    /// Closes the openings and stops the flows that controls have closed.
    pub(crate) fn control(&mut self, zone: &ZoneCoefficients<S>, opened: &[S]) {
        for (at, &control) in self.controlled.iter_mut().zip(zone.ventilation_controls.iter().flatten()) {
            *at = *at * opened[control];
        }
        if let (Some(at), Some(control)) = (&mut self.infiltrated_capacity, zone.infiltration_control) {
            *at = *at * opened[control];
        }
        for (open, opening) in self.open.iter_mut().zip(&zone.openings) {
            if let Some(control) = opening.control {
                *open = *open * opened[control];
            }
        }
    }

    #[inline(always)]
    fn intake<'a>(&'a self, zone: &'a ZoneCoefficients<S>) -> Intake<'a, S> {
        let ventilation = self.controlled.iter().fold(self.ventilation, |sum, &flow| sum + flow);
        Intake { ventilation, openings: &zone.openings, open: &self.open }
    }

    /// Heat that ventilation and openings bring into the zone, as its tangent in `T_outdoor - T_air`.
    #[inline(always)]
    pub(crate) fn outdoor_heat(&self, zone: &ZoneCoefficients<S>, wind: S, outdoor: S, air: S) -> Line<S> {
        self.intake(zone).heat(wind, outdoor, air)
    }

    /// Air that moves within the zone [1/h].
    pub(crate) fn mixing(&self) -> S {
        self.mixing.unwrap_or_else(S::zero)
    }

    /// Heat capacity of the zone's volume of the air that infiltrates [J/K].
    #[inline(always)]
    pub(crate) fn infiltrated_capacity(&self, zone: &ZoneCoefficients<S>) -> S {
        self.infiltrated_capacity.unwrap_or(zone.air_capacity)
    }

    /// Flow of outdoor air into the zone, infiltration included, as volumes at the density of the site [1/h].
    pub(crate) fn air_changes(&self, zone: &ZoneCoefficients<S>, wind: S, outdoor: S, air: S) -> S {
        let intake = self.intake(zone);
        if let Some(capacity) = self.infiltrated_capacity {
            let none = Intake { ventilation: S::zero(), openings: &[], open: &[] };
            let leaks = Self::with_leaks(zone, &none, wind, outdoor, air) * capacity / zone.air_capacity;
            let rates = [S::zero(); 3];
            return leaks + air_flow::air_changes(&rates, zone.air_capacity, &intake, wind, outdoor, air);
        }
        Self::with_leaks(zone, &intake, wind, outdoor, air)
    }

    /// Infiltration at the density of the site, and an intake [1/h].
    #[inline(always)]
    fn with_leaks(zone: &ZoneCoefficients<S>, intake: &Intake<'_, S>, wind: S, outdoor: S, air: S) -> S {
        let rate = air_flow::air_changes(&zone.infiltration, zone.air_capacity, intake, wind, outdoor, air);
        let rate = zone.leakage.as_ref().map_or(rate, |law| rate + law.air_changes(wind, outdoor - air));
        let law = zone.infiltration_law.as_ref();
        law.map_or(rate, |law| rate + air_flow::air_changes_of_law(law, wind, outdoor, air))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::coefficients::Coefficients;
    use crate::building::plan::Plan;
    use crate::building::test_buildings::{glazed_zone, values};
    use crate::input::description::{Gain, ParamId, Parameter, Ventilation};
    use crate::input::forcing::CLIMATE_CHANNELS;

    /// Gains of 100 W, of which 40 % are radiated, and two air changes per hour by a schedule, at which the air of the zone
    /// carries `2/3600 C` per degree.
    fn zone() -> ZoneCoefficients<f64> {
        let mut description = glazed_zone("area", false);
        let mut number = |value: f64| {
            description.parameters.push(Parameter { path: "number".to_owned(), value });
            ParamId(u32::try_from(description.parameters.len() - 1).unwrap())
        };
        let (power, radiative, air_changes) = (number(100.0), number(0.4), number(2.0));
        let name = "number".to_owned();
        let zone = &mut description.zones[0];
        zone.gains = vec![Gain { name: name.clone(), power, radiative, activity: None, schedule: None }];
        zone.ventilation = vec![Ventilation {
            name: name.clone(),
            air_changes: Some(air_changes),
            flow: None,
            schedule: Some(0),
            density: None,
            control: None,
        }];
        description.channels = vec![name];
        let plan = Plan::new(description).unwrap();
        Coefficients::new(&plan, &values(&plan.description)).zones.remove(0)
    }

    #[test]
    fn gains_and_ventilation_of_a_row() {
        let zone = zone();
        let mut at = ZoneConditions::new(&zone);
        let mut row = [0.0; CLIMATE_CHANNELS + 1];
        row[CLIMATE_CHANNELS] = 0.5;
        at.update(&zone, &row, &AirDensities::of_site(1), 20.0);
        assert_eq!((at.convective, at.radiant), (60.0, 40.0));
        assert!((at.ventilation / (zone.air_capacity / 3600.0) - 1.0).abs() < 1e-14);
        // 0.5 1/h of infiltration and 1 1/h of ventilation.
        assert!((at.air_changes(&zone, 0.0, 0.0, 20.0) - 1.5).abs() < 1e-12);
        // Ventilation at 20 K brings -20 K times its conductance.
        let heat = at.outdoor_heat(&zone, 0.0, 0.0, 20.0).at(-20.0);
        assert!((heat + 20.0 * at.ventilation).abs() < 1e-9);
    }

    /// Gains are extrapolated along the line; ventilation not below zero.
    #[test]
    fn extrapolation() {
        let zone = zone();
        let [mut first, mut second] = [ZoneConditions::new(&zone), ZoneConditions::new(&zone)];
        (first.convective, first.ventilation) = (10.0, 4.0);
        (second.convective, second.ventilation) = (20.0, 1.0);
        let mut at = first.clone();
        at.interpolate(&first, &second, 2.0);
        assert_eq!((at.convective, at.ventilation), (30.0, 0.0));
    }
}
