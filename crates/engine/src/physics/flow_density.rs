//! Which air a volume flow is a volume of: at the density of the site, of the outdoor air, of the air of a zone, or at a given one.
//!
//! A flow of heat capacity is `V rho c`. At the density of the site it is known once; that of the outdoor air and of a zone changes with
//! temperature, pressure and humidity, and the flow is that of the site times the ratio of both densities.
//!
//! Density of the outdoor air: `P/(R T (1 + 1.6078 W))`, the mass of dry air in a cubic metre of moist air (ASHRAE Handbook of Fundamentals
//! 2017, ch. 1, eq. 26; EnergyPlus 25.2 Engineering Reference, infiltration); that of a zone: `P/(R T)`, with the temperature of its air
//! at the start of a step.

use crate::input::description;
use crate::input::forcing::{Schedule, channel, scheduled};
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::constants::{AIR_GAS_CONSTANT, KELVIN};
use crate::physics::psychrometrics::{MASS_RATIO, humidity_ratio, saturation_pressure};

/// Air colder than this has its density [K]: colder than any air, so that an iterate that is far off has a finite flow.
const COLDEST: f64 = 150.0;

/// Air at the density of the site.
#[derive(Debug, Clone, Copy)]
pub struct SiteAir<S> {
    /// Heat capacity of a cubic metre [J/(m3 K)].
    pub heat: S,
    /// [kg/m3].
    pub density: S,
    /// Pressure of the standard atmosphere at the altitude [Pa].
    pub pressure: S,
}

/// Densities of one moment over that of the site [-].
#[derive(Debug, Clone)]
pub(crate) struct AirDensities<S> {
    outdoors: S,
    zones: Vec<S>,
}

impl<S: Real> AirDensities<S> {
    /// That of the site everywhere.
    pub(crate) fn of_site(zones: usize) -> Self {
        Self { outdoors: S::one(), zones: vec![S::one(); zones] }
    }

    /// In the weather of a forcing row, with the airs of the zones [degC].
    // Few buildings ask for it.
    #[inline(never)]
    pub(crate) fn update(&mut self, site: &SiteAir<S>, row: &[f64], airs: &[S]) {
        let measured = row[channel::PRESSURE];
        let pressure = if measured.is_nan() { site.pressure } else { S::constant(measured) };
        let over_site = pressure / site.density.scale(AIR_GAS_CONSTANT);
        let (outdoor, dew_point) = (row[channel::AIR_TEMPERATURE], row[channel::DEW_POINT]);
        let ratio = if dew_point.is_nan() {
            S::zero()
        } else {
            humidity_ratio(S::constant(saturation_pressure(dew_point)), pressure)
        };
        let moist = S::one() + ratio.scale(1.0 / MASS_RATIO);
        self.outdoors = over_site / (moist.scale(outdoor + KELVIN));
        for (at, &air) in self.zones.iter_mut().zip(airs) {
            *at = over_site / (air + S::constant(KELVIN)).max(S::constant(COLDEST));
        }
    }
}

/// Where the density of a flow changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Varying {
    Never,
    Outdoors,
    Zone(usize),
    /// The mean of two zones that exchange air.
    Zones([usize; 2]),
}

/// A flow of heat capacity, constant or by schedule, of air of its density.
#[derive(Debug, Clone)]
pub struct AirFlow<S> {
    /// [W/K]; at the density of the site where the density changes.
    conductance: S,
    schedule: Schedule,
    varying: Varying,
}

impl<S: Real> AirFlow<S> {
    /// `at_site` [W/K]: the flow at the density of the site; `zones`: whose air `density: zone` means.
    pub(crate) fn new(
        at_site: S,
        schedule: Option<usize>,
        (density, zones): (Option<&description::FlowDensity>, [usize; 2]),
        values: &Values<'_, S>,
        site: &SiteAir<S>,
    ) -> Self {
        let (conductance, varying) = match density {
            None => (at_site, Varying::Never),
            Some(description::FlowDensity::Constant { value }) => {
                (at_site * values.get(*value) / site.density, Varying::Never)
            }
            Some(description::FlowDensity::Outdoors) => (at_site, Varying::Outdoors),
            Some(description::FlowDensity::Zone) if zones[0] == zones[1] => {
                (at_site, Varying::Zone(zones[0]))
            }
            Some(description::FlowDensity::Zone) => (at_site, Varying::Zones(zones)),
        };
        Self { conductance, schedule: Schedule::new(schedule), varying }
    }

    /// Heat carried per degree where nothing changes it [W/K].
    pub(crate) fn whole(&self) -> Option<S> {
        (self.schedule.is_constant() && self.varying == Varying::Never).then_some(self.conductance)
    }

    /// Heat carried per degree in a forcing row at the density of the site, where a third does not matter [W/K].
    #[inline(always)]
    pub(crate) fn about(&self, row: &[f64]) -> S {
        scheduled(self.conductance, self.schedule, row)
    }

    /// Heat carried per degree in a forcing row and at densities [W/K].
    #[inline(always)]
    pub(crate) fn at(&self, row: &[f64], densities: &AirDensities<S>) -> S {
        let flow = self.about(row);
        match self.varying {
            Varying::Never => flow,
            Varying::Outdoors => flow * densities.outdoors,
            Varying::Zone(zone) => flow * densities.zones[zone],
            Varying::Zones([a, b]) => flow * (densities.zones[a] + densities.zones[b]).scale(0.5),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::description::{FlowDensity, ParamId};
    use crate::input::forcing::CLIMATE_CHANNELS;

    /// 0.1 m3/s at 1.2 kg/m3 and 1000 J/(kg K) are 120 W/K. Air of -10 degC and 100 kPa without vapour has `1e5/(287.055 263.15)` =
    /// 1.32383 kg/m3; with 4 g/kg `1 + 1.6078 0.004` times less; zones of 20 and 30 degC 1.18835 and 1.14915 kg/m3; 0.9 kg/m3 as given.
    #[test]
    fn densities_by_hand() {
        let site = SiteAir { heat: 1200.0, density: 1.2, pressure: 90_000.0 };
        let values = [0.9];
        let values = Values::new(&values);
        let mut row = [0.0; CLIMATE_CHANNELS];
        (row[channel::AIR_TEMPERATURE], row[channel::PRESSURE]) = (-10.0, 1e5);
        row[channel::DEW_POINT] = f64::NAN;
        let mut densities = AirDensities::of_site(2);
        densities.update(&site, &row, &[20.0, 30.0]);
        let flow = |density: Option<FlowDensity>, zones: [usize; 2], densities: &AirDensities<f64>| {
            AirFlow::new(120.0, None, (density.as_ref(), zones), &values, &site).at(&row, densities)
        };
        let close = |found: f64, density: f64| {
            assert!((found / (100.0 * density) - 1.0).abs() < 2e-6, "{found} W/K is not of {density} kg/m3");
        };
        close(flow(None, [0, 0], &densities), 1.2);
        close(flow(Some(FlowDensity::Outdoors), [0, 0], &densities), 1.323_828);
        close(flow(Some(FlowDensity::Zone), [1, 1], &densities), 1.149_152);
        close(flow(Some(FlowDensity::Zone), [0, 1], &densities), 0.5 * (1.188_352 + 1.149_152));
        close(flow(Some(FlowDensity::Constant { value: ParamId(0) }), [0, 0], &densities), 0.9);
        // Vapour of 636.8 Pa at 0.475 degC: about 4 g/kg, and the pressure of the altitude where none is measured.
        let vapour = saturation_pressure(0.475);
        let ratio = MASS_RATIO * vapour / (9e4 - vapour);
        (row[channel::DEW_POINT], row[channel::PRESSURE]) = (0.475, f64::NAN);
        densities.update(&site, &row, &[20.0, 30.0]);
        let expected = 9e4 / (287.055 * 263.15 * (1.0 + 1.607_861 * ratio));
        assert!((1.2 * densities.outdoors / expected - 1.0).abs() < 1e-6 && ratio > 0.004);
    }
}
