//! Outdoor air that enters a zone, and air that two zones exchange.
//!
//! Every law gives the heat that the air carries as a function of the temperature difference that drives it, or the flow of heat
//! capacity where there is no such dependence. Flows are counted at the density of the site, or at another one that is asked for
//! (`physics/flow_density.rs`).
//!
//! Sources:
//! - Infiltration `n0 + n1 |d| + n2 V`: Coblentz & Achenbach (1963), ASHRAE Trans. 69, 358-365.
//! - Openings: ASHRAE Handbook of Fundamentals 2017, ch. 16, eqs. 37 and 38.

use crate::input::description;
use crate::input::forcing::{Schedule, scheduled};
use crate::input::values::Values;
use crate::number::line::Line;
use crate::number::real::{Mask, Real};
use crate::physics::constants::{GRAVITY, KELVIN};
use crate::physics::flow_density::{AirDensities, AirFlow, SiteAir};
use crate::physics::formula::function::Function;

/// Temperature differences between a zone and outdoors are rounded off within this [K] where they drive an air flow.
const ROUND_OFF: f64 = 0.01;
/// Least mean of both temperatures [K]: colder than any air, so that the flow is finite about an iterate that is far off.
const COLDEST: f64 = 150.0;

/// Ventilation of a zone by air changes or by volume flow; `air_capacity` of the zone's air [J/K].
pub(crate) fn ventilation<S: Real>(
    flow: &description::Ventilation,
    zone: usize,
    values: &Values<'_, S>,
    site: &SiteAir<S>,
    air_capacity: S,
) -> AirFlow<S> {
    let changes = values.get_or(flow.air_changes, 0.0).scale(1.0 / 3600.0) * air_capacity;
    let at_site = changes + values.get_or(flow.flow, 0.0) * site.heat;
    AirFlow::new(at_site, flow.schedule, (flow.density.as_ref(), [zone; 2]), values, site)
}

/// Air that two zones exchange.
#[derive(Debug, Clone)]
pub struct Path<S> {
    /// The zones.
    pub between: [usize; 2],
    flow: AirFlow<S>,
    /// Control that starts and stops it.
    pub(crate) control: Option<usize>,
}

impl<S: Real> Path<S> {
    /// Evaluates a path at a parameter vector.
    pub(crate) fn new(path: &description::AirPath, values: &Values<'_, S>, site: &SiteAir<S>) -> Self {
        let density = (path.density.as_ref(), path.between);
        let flow = AirFlow::new(values.get(path.flow) * site.heat, path.schedule, density, values, site);
        Self { between: path.between, flow, control: path.control }
    }

    /// Heat carried per degree between the zones [W/K].
    #[inline(always)]
    pub(crate) fn conductance(&self, row: &[f64], densities: &AirDensities<S>) -> S {
        self.flow.at(row, densities)
    }

    /// The same at the density of the site, where a third does not matter [W/K].
    #[inline(always)]
    pub(crate) fn about(&self, row: &[f64]) -> S {
        self.flow.about(row)
    }

    /// Heat carried per degree, where nothing changes it [W/K].
    pub(crate) fn whole(&self) -> Option<S> {
        if self.control.is_none() { self.flow.whole() } else { None }
    }
}

/// An opening to outdoors that wind and buoyancy drive air through.
///
/// `Q = A sqrt((C_w V)^2 + C_d^2 2 g h |T_o - T_i|/T)`: the two flows are added in quadrature, that is, by the pressures
/// that drive them. V is the wind at the mast, T the mean of both temperatures [K].
#[derive(Debug, Clone)]
pub struct Opening<S> {
    /// Heat capacity flow of the whole opening per air speed [W s/(K m)].
    conductance: S,
    /// `C_w^2` [-].
    wind: S,
    /// `C_d^2 2 g h` [m2/s2].
    stack: S,
    schedule: Schedule,
    /// Control that opens and closes it.
    pub(crate) control: Option<usize>,
}

impl<S: Real> Opening<S> {
    /// Evaluates an opening at a parameter vector; `heat` is that of a cubic metre of air [J/(m3 K)].
    #[must_use]
    pub fn new(opening: &description::Opening, values: &Values<'_, S>, heat: S) -> Self {
        let (discharge, wind) = (values.get(opening.discharge), values.get(opening.wind_coefficient));
        Self {
            conductance: heat * values.get(opening.area),
            wind: wind * wind,
            stack: discharge * discharge * values.get(opening.height).scale(2.0 * GRAVITY),
            schedule: Schedule::new(opening.schedule),
            control: opening.control,
        }
    }

    /// Fraction of the area that is open in a forcing row [-].
    #[inline(always)]
    pub(crate) fn open_fraction(&self, row: &[f64]) -> S {
        scheduled(S::one(), self.schedule, row)
    }

    /// Heat carried per degree [W/K] and its slope in `d = T_outdoor - T_air`.
    #[inline(always)]
    fn rate(&self, open: S, wind: S, outdoor: S, d: S) -> (S, S) {
        let magnitude = d.smooth_abs(ROUND_OFF);
        // T = T_outdoor - d/2.
        let (mean, least) = (outdoor - d.scale(0.5) + S::constant(KELVIN), S::constant(COLDEST));
        let inverse = S::one() / mean.max(least);
        let buoyancy = self.stack * magnitude * inverse;
        let by_mean = S::select(mean.lt(least), S::zero(), inverse.scale(0.5));
        let rise = self.stack * (d / magnitude + magnitude * by_mean) * inverse;
        // Without height and without wind the root would have an infinite slope.
        let speed = (self.wind * wind * wind + buoyancy).max(S::constant(1e-30)).sqrt();
        let gain = self.conductance * open;
        (gain * speed, gain * rise / speed.scale(2.0))
    }
}

/// Outdoor air through ventilation and openings.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Intake<'a, S> {
    /// Heat carried per degree by the flows that no temperature drives [W/K].
    pub(crate) ventilation: S,
    pub(crate) openings: &'a [Opening<S>],
    /// Open fraction of each opening [-].
    pub(crate) open: &'a [S],
}

impl<S: Real> Intake<'_, S> {
    /// Heat that it brings into a zone, as its tangent in `d = T_outdoor - T_air`; `wind` is the speed at the mast [m/s].
    #[inline(always)]
    pub(crate) fn heat(&self, wind: S, outdoor: S, air: S) -> Line<S> {
        let d = outdoor - air;
        let mut line = Line { offset: S::zero(), slope: self.ventilation };
        for (opening, &open) in self.openings.iter().zip(self.open) {
            let (rate, rise) = opening.rate(open, wind, outdoor, d);
            let tangent = Line::tangent(rate * d, rate + rise * d, d);
            line = Line { offset: line.offset + tangent.offset, slope: line.slope + tangent.slope };
        }
        line
    }
}

/// Heat that infiltration brings into a zone, `C (n0 + n1 |d| + n2 V)/3600 d`, as its tangent in
/// `d = T_outdoor - T_air`.
///
/// `rates`: n0 [1/h], n1 [1/(h K)], n2 [1/(h m/s)]; `air_capacity` C of the zone's air [J/K]; `wind` V at the mast [m/s].
#[inline(always)]
pub(crate) fn infiltration<S: Real>(rates: &[S; 3], air_capacity: S, wind: S, outdoor: S, air: S) -> Line<S> {
    let d = outdoor - air;
    let [_, temperature, _] = *rates;
    let per_second = air_capacity.scale(1.0 / 3600.0);
    // Without this part the rate is the same at all differences, to the bit: it is spared a root and a division.
    if const { !S::DERIVATIVES } && !S::zero().lt(temperature.abs()).any() {
        let rate = per_second * leakage(rates, wind, S::zero());
        return Line::tangent(rate * d, rate, d);
    }
    let magnitude = d.smooth_abs(ROUND_OFF);
    let rate = per_second * leakage(rates, wind, magnitude);
    let slope = rate + per_second * temperature * d * d / magnitude;
    Line::tangent(rate * d, slope, d)
}

/// Heat that infiltration as text brings into a zone, as its tangent in `d = T_outdoor - T_air`; a law has the opposite difference.
#[inline(always)]
pub(crate) fn heat_of_law<S: Real>(
    law: &Function<S>,
    air_capacity: S,
    wind: S,
    outdoor: S,
    air: S,
) -> Line<S> {
    let d = outdoor - air;
    let per_second = air_capacity.scale(1.0 / 3600.0);
    let [rate, slope] = law.at(-d, &[wind, outdoor]);
    Line::tangent(per_second * rate * d, per_second * (rate - slope * d), d)
}

/// Air changes of infiltration as text [1/h].
pub(crate) fn air_changes_of_law<S: Real>(law: &Function<S>, wind: S, outdoor: S, air: S) -> S {
    law.at(air - outdoor, &[wind, outdoor])[0]
}

/// Air changes of infiltration [1/h].
#[inline(always)]
fn leakage<S: Real>(rates: &[S; 3], wind: S, magnitude: S) -> S {
    let [constant, temperature, by_wind] = *rates;
    constant + temperature * magnitude + by_wind * wind
}

/// Outdoor air of infiltration and intake together [1/h]; arguments as in [`infiltration`].
pub(crate) fn air_changes<S: Real>(
    rates: &[S; 3],
    air_capacity: S,
    intake: &Intake<'_, S>,
    wind: S,
    outdoor: S,
    air: S,
) -> S {
    let d = outdoor - air;
    let openings = intake.openings.iter().zip(intake.open);
    let conductances = openings.map(|(opening, &open)| opening.rate(open, wind, outdoor, d).0);
    let conductance = conductances.fold(intake.ventilation, |sum, conductance| sum + conductance);
    leakage(rates, wind, d.smooth_abs(ROUND_OFF)) + conductance.scale(3600.0) / air_capacity
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::description::ParamId;

    /// 0.5 m2, 1 m to the neutral level, Cd 0.6, Cw 0.3, 4 m/s, 10 degC outside, 20 degC inside:
    /// `(0.3 4)^2 + 0.6^2 2 g 10/288.15 = 1.68504`, so 0.5 1.29809 m3/s.
    #[test]
    fn an_opening_by_hand() {
        let id = ParamId;
        let opening = description::Opening {
            name: "window".to_owned(),
            zone: 0,
            area: id(0),
            height: id(1),
            discharge: id(2),
            wind_coefficient: id(3),
            schedule: None,
            control: None,
        };
        let openings = [Opening::new(&opening, &Values::new(&[0.5, 1.0, 0.6, 0.3]), 1.0)];
        let intake = |open: &[f64], air: f64| {
            let line = Intake { ventilation: 0.0, openings: &openings, open }.heat(4.0, 10.0, air);
            (line.at(10.0 - air), line.slope)
        };
        let (heat, _) = intake(&[1.0], 20.0);
        assert!((heat / -6.490_45 - 1.0).abs() < 1e-5, "{heat}");
        // Half open it lets half as much in; the slope is that of the heat flow in `T_outdoor - T_air`.
        let (heat, slope) = intake(&[0.5], 20.0);
        assert!((heat / -3.245_23 - 1.0).abs() < 1e-5, "{heat}");
        let difference = (intake(&[0.5], 20.0 - 1e-4).0 - intake(&[0.5], 20.0 + 1e-4).0) / 2e-4;
        assert!((slope / difference - 1.0).abs() < 1e-7, "{slope} is not {difference}");
    }

    /// The heat through an opening rises with the temperature difference over all real numbers, as its slope says: airs from far below
    /// 0 K to 1e5 degC.
    #[test]
    fn the_heat_of_an_opening_rises_everywhere() {
        let opening = Opening {
            conductance: 1200.0,
            wind: 0.09,
            stack: 7.06,
            schedule: Schedule::new(None),
            control: None,
        };
        let openings = [opening];
        let heat = |air: f64| {
            let line = Intake { ventilation: 0.0, openings: &openings, open: &[1.0] }.heat(4.0, -10.0, air);
            (line.at(-10.0 - air), line.slope)
        };
        for k in -1000..1000 {
            let air = 100.0 * f64::from(k) + 17.0;
            let ((colder, _), (here, slope), (warmer, _)) = (heat(air - 1e-3), heat(air), heat(air + 1e-3));
            assert!(here.is_finite() && colder > here && here > warmer, "{air}");
            assert!(((colder - warmer) / 2e-3 / slope - 1.0).abs() < 1e-4, "{air}: {slope}");
        }
    }

    /// 3600 J/K of air, 0.5 + 0.02 10 + 0.1 3 = 1 air change per hour and -10 K: -10 W; slope 1 + 0.02 10 W/K.
    #[test]
    fn infiltration_by_hand() {
        let rates = [0.5, 0.02, 0.1];
        let line = infiltration(&rates, 3600.0, 3.0, 10.0, 20.0);
        assert!((line.at(-10.0) + 10.0).abs() < 1e-5, "{}", line.at(-10.0));
        assert!((line.slope - 1.2).abs() < 1e-5, "{}", line.slope);
        // With 2 W/K of ventilation: two air changes more.
        let intake = Intake { ventilation: 2.0, openings: &[], open: &[] };
        let changes = air_changes(&rates, 3600.0, &intake, 3.0, 10.0, 20.0);
        assert!((changes - 3.0).abs() < 1e-5, "{changes}");
    }
}
