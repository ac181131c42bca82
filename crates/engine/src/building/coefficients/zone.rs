//! Coefficients of a zone: air, gains and flows, long-wave exchange and the distribution of the sun in it.

use crate::building::ids::{BySide, SideId};
use crate::building::plan::Plan;
use crate::building::solar_distribution::{SolarDistribution, SolarSurface};
use crate::input::description::{Infiltration, Mixing, ParamId, Zone, ZoneLongwave};
use crate::input::forcing::Schedule;
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::air_flow::{self, Opening};
use crate::physics::constants::KELVIN;
use crate::physics::flow_density::{AirFlow, SiteAir};
use crate::physics::formula::function::Function;
use crate::physics::gains::{Gain, Thermostat};
use crate::physics::leakage::Leakage;
use crate::physics::longwave::{Emission, direct_exchange_areas, exchange_areas, self_weight};

use super::surface::SurfaceCoefficients;
use super::wall::WallCoefficients;

/// Temperature of a room [degC] about which the emission is linearised for the rise by an emitter.
const ROOM: f64 = 20.0;
/// Largest change of the mean radiant temperature by an emitter [K]: that by which the irradiance in a room at 20 degC vanishes, since
/// `sigma T^4 = 4 sigma T^3 (T/4)`. No cold emitter can take more from surfaces than they emit (419 W/m2 at 20 degC; Planck's law); no
/// room is heated by as much, which is some five times what a heated floor gives in reach of people (EN 1264-2: 100 W/m2 of floor).
const LARGEST_RISE: f64 = (ROOM + KELVIN) / 4.0;

/// A zone.
#[derive(Debug, Clone)]
pub struct ZoneCoefficients<S> {
    /// Heat capacity of the air and contents [J/K].
    pub capacity: S,
    /// Heat capacity of the zone's air volume [J/K], for air changes.
    pub air_capacity: S,
    /// Infiltration: constant, by temperature difference, by wind [1/h], [1/(h K)], [1/(h m/s)].
    pub infiltration: [S; 3],
    /// Infiltration that wind and temperatures drive, from a pressure test.
    pub leakage: Option<Leakage<S>>,
    /// Heat capacity of the zone's volume of the air that infiltrates [J/K]; none: at the density of the site.
    pub(crate) infiltrated_capacity: Option<AirFlow<S>>,
    /// Control that lets air infiltrate; none: not controlled.
    pub(crate) infiltration_control: Option<usize>,
    /// Control of each flow of ventilation.
    pub(crate) ventilation_controls: Vec<Option<usize>>,
    /// Infiltration as text [1/h].
    pub(crate) infiltration_law: Option<Function<S>>,
    /// Part of the transmitted sun that the air gets at once [-].
    pub solar_to_air: Option<S>,
    /// Exchange areas between its surfaces, by row [m2]; empty without long-wave exchange.
    pub exchange: Vec<S>,
    /// Sum of each surface's exchange areas with the others [m2].
    pub exchange_sums: Vec<S>,
    /// Law of emission.
    pub emission: Emission<S>,
    /// Gradient of the air temperature [K/m] and its schedule; none: one temperature.
    pub(crate) gradient: Option<(S, Schedule)>,
    /// From floor to ceiling, where the air is stratified [m].
    pub(crate) height: f64,
    /// Areas of its surfaces [m2].
    pub areas: Vec<S>,
    /// Heat from people, light and machines.
    pub gains: Vec<Gain<S>>,
    /// Fraction of the radiant gains that each surface absorbs [-].
    pub radiant_shares: Vec<S>,
    /// Ventilation with outdoor air.
    pub ventilation: Vec<AirFlow<S>>,
    /// Air that moves within the zone [1/h], and its schedule.
    pub(crate) mixing: Option<(S, Schedule)>,
    /// Openings to outdoors.
    pub openings: Vec<Opening<S>>,
    /// Parts of ideal heating and of ideal cooling that are radiated to the surfaces [-]; none: all goes to the air.
    pub radiated_loads: Option<[S; 2]>,
    /// What the radiated part of ideal loads adds to the mean radiant temperature [K/W]; none where all goes to the air.
    pub(crate) emitter: Option<S>,
    /// Share of the mean radiant temperature in what set points hold [-]; none: they hold the air.
    pub(crate) setpoint_radiant_share: Option<S>,
    /// Ideal heating.
    pub heating: Option<Thermostat<S>>,
    /// Ideal cooling.
    pub cooling: Option<Thermostat<S>>,
    /// Where the sun that windows transmit is absorbed; none without windows.
    pub solar_distribution: Option<SolarDistribution<S>>,
}

impl<S: Real> ZoneCoefficients<S> {
    /// Evaluates a zone at a parameter vector. Long because it fills every number of a zone.
    pub(crate) fn new(
        plan: &Plan,
        index: usize,
        values: &Values<'_, S>,
        walls: &[WallCoefficients<S>],
        surfaces: &BySide<SurfaceCoefficients<S>>,
        site: &SiteAir<S>,
    ) -> Self {
        let definition = &plan.description.zones[index];
        let zone_surfaces = &plan.zones[index].surfaces;
        let areas: Vec<S> = zone_surfaces.iter().map(|&surface| walls[surface.wall()].area).collect();
        let emissivities: Vec<S> =
            zone_surfaces.iter().map(|&surface| surfaces[surface].emissivity).collect();
        let emission = match definition.longwave {
            ZoneLongwave::Linearised { reference } => Emission::Linearised(values.get(reference)),
            ZoneLongwave::Radiosity | ZoneLongwave::None => Emission::Exact,
        };
        let exchanging = !matches!(definition.longwave, ZoneLongwave::None);
        let exchange = if exchanging && zone_surfaces.len() > 1 {
            exchange_areas(&areas, &emissivities, &view_weights(plan, index, &areas))
        } else {
            Vec::new()
        };
        let air_capacity = values.get(definition.volume) * site.heat;
        let Infiltration { law, density, schedule, control, .. } = &definition.infiltration;
        let (infiltration, driven_leakage) = leaks(&definition.infiltration, values);
        let openings = plan.description.openings.iter().filter(|opening| opening.zone == index);
        let ventilated = |flow| air_flow::ventilation(flow, index, values, site, air_capacity);
        // A schedule and a control multiply the air that infiltrates, whatever drives it.
        let changing = density.is_some() || schedule.is_some() || control.is_some();
        let infiltrated =
            || AirFlow::new(air_capacity, *schedule, (density.as_ref(), [index; 2]), values, site);
        let absorbing = exchanging.then_some(&emissivities);
        let rise = || radiant_rise(&areas, absorbing, &emission);
        let ([heating, cooling], radiated_loads) = plants(definition, values, rise);
        Self {
            emitter: radiated_loads.as_ref().map(|_| rise()),
            setpoint_radiant_share: definition.setpoint_radiant_share.map(|id| values.get(id)),
            radiated_loads,
            gains: definition.gains.iter().map(|gain| Gain::new(gain, values)).collect(),
            radiant_shares: radiant_shares(&areas, absorbing),
            ventilation: definition.ventilation.iter().map(ventilated).collect(),
            mixing: definition.mixing.as_ref().map(|mixing| mixed(mixing, values)),
            openings: openings.map(|opening| Opening::new(opening, values, site.heat)).collect(),
            heating,
            cooling,
            capacity: air_capacity * values.get(definition.capacity_factor),
            air_capacity,
            infiltration,
            gradient: definition
                .stratification
                .as_ref()
                .map(|air| (values.get(air.gradient), Schedule::new(air.schedule))),
            height: definition.stratification.as_ref().map_or(0.0, |air| air.height),
            leakage: driven_leakage,
            infiltrated_capacity: changing.then(infiltrated),
            infiltration_control: *control,
            ventilation_controls: definition.ventilation.iter().map(|flow| flow.control).collect(),
            infiltration_law: law.as_ref().map(|law| Function::of("infiltration", law, values)),
            solar_to_air: definition.solar_to_air.map(|id| values.get(id)),
            exchange_sums: sums_of_others(&exchange, zone_surfaces.len()),
            exchange,
            emission,
            solar_distribution: SolarDistribution::new(
                &definition.sun,
                &solar_surfaces(plan, zone_surfaces, walls, surfaces),
                values,
                || direct_exchange_areas(&areas, &view_weights(plan, index, &areas)),
            ),
            areas,
        }
    }

    /// Part of an ideal load that is radiated to the surfaces [-]; none where loads act on the air alone.
    #[inline(always)]
    pub(crate) fn radiated_part(&self, load: S) -> Option<S> {
        self.radiated_loads.map(|[heating, cooling]| S::select(load.lt(S::zero()), cooling, heating))
    }

    /// Mean radiant temperature: the mean of surface temperatures by area, and what the radiation of an ideal load [W] adds; `air`
    /// where the zone has no surfaces [degC]. Of changes of these temperatures [K] it gives the change.
    #[inline(always)]
    pub(crate) fn mean_radiant<V: Real>(
        &self,
        number: impl Fn(&S) -> V,
        (surfaces, air): (impl Iterator<Item = V>, V),
        radiated: V,
    ) -> V {
        if self.areas.is_empty() {
            return air;
        }
        let (mut sum, mut total) = (V::zero(), V::zero());
        for (temperature, area) in surfaces.zip(&self.areas) {
            let area = number(area);
            sum += area * temperature;
            total += area;
        }
        match &self.emitter {
            Some(rise) => sum / total + number(rise) * radiated,
            None => sum / total,
        }
    }

    /// What the set points hold: `(1 - s) T_a + s T_r` with the share `s` of the mean radiant temperature `T_r`, else the air [degC].
    /// Of changes of temperatures [K] it gives the change.
    #[inline(always)]
    pub(crate) fn held_temperature<V: Real>(
        &self,
        number: impl Fn(&S) -> V,
        (surfaces, air): (impl Iterator<Item = V>, V),
        radiated: V,
    ) -> V {
        let Some(share) = &self.setpoint_radiant_share else { return air };
        let share = number(share);
        let radiant = self.mean_radiant(number, (surfaces, air), radiated);
        (V::one() - share) * air + share * radiant
    }

    /// What an ideal load gives to the air and to the surfaces [W].
    #[inline(always)]
    pub(crate) fn load_parts(&self, load: S) -> [S; 2] {
        match self.radiated_part(load) {
            Some(part) => [load * (S::one() - part), load * part],
            None => [load, S::zero()],
        }
    }
}

/// Air that moves within a zone [1/h], and its schedule.
fn mixed<S: Real>(mixing: &Mixing, values: &Values<'_, S>) -> (S, Schedule) {
    (values.get(mixing.air_changes), Schedule::new(mixing.schedule))
}

/// Infiltration by its three parts, with what a pressure test adds to the first, and that of a test by stack and wind.
fn leaks<S: Real>(infiltration: &Infiltration, values: &Values<'_, S>) -> ([S; 3], Option<Leakage<S>>) {
    let Infiltration { constant, temperature, wind, leakage: test, .. } = infiltration;
    let mut rates = [constant, temperature, wind].map(|id| values.get(*id));
    let (constant, driven) = test.as_ref().map_or((None, None), |test| Leakage::of(test, values));
    if let Some(rate) = constant {
        rates[0] += rate;
    }
    (rates, driven)
}

/// Ideal heating and cooling of a zone, and the parts of them that are radiated; none where all goes to the air. What is radiated is
/// limited to [`LARGEST_RISE`] by the rise of the mean radiant temperature with it [K/W].
fn plants<S: Real>(
    zone: &Zone,
    values: &Values<'_, S>,
    rise: impl Fn() -> S,
) -> ([Option<Thermostat<S>>; 2], Option<[S; 2]>) {
    let plants = [&zone.heating, &zone.cooling].map(|plant| {
        let plant = Thermostat::new(plant.as_ref()?, values);
        let radiates = plant.radiative.is_some();
        Some(if radiates { plant.radiating_at_most(S::constant(LARGEST_RISE) / rise()) } else { plant })
    });
    let parts = plants.each_ref().map(|plant| plant.as_ref().and_then(|plant| plant.radiative));
    let radiated = parts.iter().any(Option::is_some);
    (plants, radiated.then(|| parts.map(|part| part.unwrap_or_else(S::zero))))
}

/// What the surfaces of a zone do with the sun.
fn solar_surfaces<'a, S: Real>(
    plan: &Plan,
    zone_surfaces: &[SideId],
    walls: &'a [WallCoefficients<S>],
    surfaces: &BySide<SurfaceCoefficients<S>>,
) -> Vec<SolarSurface<'a, S>> {
    let of = |&surface: &SideId| {
        let wall = &walls[surface.wall()];
        SolarSurface {
            area: wall.area,
            absorptance: surfaces[surface].absorptance,
            glass: wall.glass.as_ref().map(|glass| glass.facing(surface)),
            passes: plan.lets_pass(surface),
        }
    };
    zone_surfaces.iter().map(of).collect()
}

/// Sum of each surface's exchange areas with the others; zeros where there are none.
fn sums_of_others<S: Real>(exchange: &[S], n: usize) -> Vec<S> {
    let others = |row: usize| (0..exchange.len() / n.max(1)).filter(move |&column| column != row);
    let sum = |row: usize| others(row).fold(S::zero(), |sum, column| sum + exchange[row * n + column]);
    (0..n).map(sum).collect()
}

/// Fractions by area times emissivity; by area alone where the surfaces exchange no long-wave radiation.
fn radiant_shares<S: Real>(areas: &[S], emissivities: Option<&Vec<S>>) -> Vec<S> {
    let weights: Vec<S> = match emissivities {
        Some(emissivities) => areas.iter().zip(emissivities).map(|(&a, &e)| a * e).collect(),
        None => areas.to_vec(),
    };
    let total = weights.iter().fold(S::zero(), |sum, &weight| sum + weight);
    weights.into_iter().map(|weight| weight / total).collect()
}

/// What a watt that an emitter radiates into a zone adds to the mean radiant temperature in it [K/W].
///
/// Surfaces absorb it by area times emissivity (see [`radiant_shares`]), so that everything in the zone is exposed to the same
/// irradiance `1/sum(e A)`. A black body in it is warmer by this over the slope `4 sigma T^3` of the emission, at the temperature
/// about which the zone is linearised, else at 20 degC (mean radiant temperature: ISO 7726:1998, annex B).
fn radiant_rise<S: Real>(areas: &[S], emissivities: Option<&Vec<S>>, emission: &Emission<S>) -> S {
    let absorbing = areas.iter().enumerate().fold(S::zero(), |sum, (i, &area)| {
        sum + emissivities.map_or(area, |emissivities| area * emissivities[i])
    });
    // A linearised emission has the slope of its reference everywhere.
    let (_, slope) = emission.at(S::constant(ROOM));
    S::one() / (slope * absorbing)
}

/// Given weights, or `A_i A_j` between surfaces that are not parts of one plane.
fn view_weights<S: Real>(plan: &Plan, index: usize, areas: &[S]) -> Vec<S> {
    let surfaces = &plan.zones[index].surfaces;
    let given = &plan.description.zones[index].view_weights;
    let n = surfaces.len();
    let normals: Vec<_> = surfaces.iter().map(|&surface| normal(plan, surface)).collect();
    let mut weights = Vec::with_capacity(n * n);
    for i in 0..n {
        for j in 0..n {
            let weight = if !given.is_empty() {
                // The given weights hold at the nominal areas: balancing adapts them when an area is varied.
                S::constant(given[i][j])
            } else if i == j {
                self_weight(areas, i)
            } else if !same_plane(normals[i], normals[j]) {
                areas[i] * areas[j]
            } else {
                S::zero()
            };
            weights.push(weight);
        }
    }
    weights
}

/// The normal of a surface into its zone, at its nominal tilt and azimuth.
fn normal(plan: &Plan, surface: SideId) -> [f64; 3] {
    let wall = &plan.description.surfaces[surface.wall()];
    let value = |id: ParamId| plan.description.parameters[id.0 as usize].value.to_radians();
    let (tilt, azimuth) = (value(wall.tilt), value(wall.azimuth));
    let sign = if surface.is_outside() { 1.0 } else { -1.0 };
    [
        Real::sin(azimuth) * Real::sin(tilt) * sign,
        Real::cos(azimuth) * Real::sin(tilt) * sign,
        Real::cos(tilt) * sign,
    ]
}

/// True when the normals of two surfaces of a zone agree: parts of one plane.
fn same_plane(a: [f64; 3], b: [f64; 3]) -> bool {
    let dot: f64 = a.iter().zip(b).map(|(x, y)| x * y).sum();
    dot > 1.0 - 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::coefficients::Coefficients;
    use crate::building::test_buildings::{WINDOW, glazed_zone, values};

    fn zone(sun: &str) -> ZoneCoefficients<f64> {
        let plan = Plan::new(glazed_zone(sun, false)).unwrap();
        Coefficients::new(&plan, &values(&plan.description)).zones.remove(0)
    }

    /// 129.6 m3 of air of 1.225 kg/m3 and 1006 J/(kg K).
    #[test]
    fn capacity_of_the_air() {
        let zone = zone("area");
        assert!((zone.air_capacity / (129.6 * 1.225 * 1006.0) - 1.0).abs() < 1e-4);
        assert_eq!(zone.capacity, zone.air_capacity);
    }

    /// With one emissivity e, radiant gains are absorbed by area; each surface's exchange areas add up to no more than e A.
    #[test]
    fn radiation_between_surfaces() {
        let zone = zone("area");
        let total: f64 = zone.areas.iter().sum();
        assert!((total - (2.0 * 21.6 + 2.0 * 16.2 + 2.0 * 48.0)).abs() < 1e-12);
        for (i, &area) in zone.areas.iter().enumerate() {
            assert!((zone.radiant_shares[i] - area / total).abs() < 1e-15);
            let row = zone.exchange_sums[i] + zone.exchange[i * zone.areas.len() + i];
            assert!((row / (0.9 * area) - 1.0).abs() < 1e-9, "{row}");
        }
    }

    /// South wall and window are parts of one plane and see each other by no weight; other surfaces by the product of areas.
    #[test]
    fn surfaces_of_one_plane() {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        let areas = zone("area").areas;
        let weights = view_weights(&plan, 0, &areas);
        let n = areas.len();
        assert_eq!((weights[WINDOW], weights[WINDOW * n], weights[0]), (0.0, 0.0, 0.0));
        assert_eq!(weights[n + WINDOW], areas[1] * areas[WINDOW]);
    }

    /// Given weights replace the products of areas: after balancing, rows sum to the areas.
    #[test]
    fn given_view_weights() {
        let mut description = glazed_zone("area", false);
        let n = description.surfaces.len();
        let given: Vec<Vec<f64>> =
            (0..n).map(|i| (0..n).map(|j| if i == j { 0.0 } else { (1 + i + j) as f64 }).collect()).collect();
        description.zones[0].view_weights.clone_from(&given);
        let plan = Plan::new(description).unwrap();
        let areas = zone("area").areas;
        assert_eq!(view_weights(&plan, 0, &areas), given.concat());
    }

    /// A distribution exists where there is a window; the irradiance of a zone in which beams are traced is
    /// `sum(A a G) + transmitted = 1` per watt of first incidence.
    #[test]
    fn every_traced_watt_is_absorbed_or_lost() {
        let Some(SolarDistribution::Traced(traced)) = zone("geometry").solar_distribution else {
            panic!("beams are traced")
        };
        let plan = Plan::new(glazed_zone("geometry", false)).unwrap();
        let numbers = Coefficients::new(&plan, &values(&plan.description));
        for first in 0..=WINDOW {
            let incidence: Vec<f64> = (0..=WINDOW).map(|i| f64::from(u8::from(i == first))).collect();
            let admitted = numbers.zones[0].areas.iter().enumerate().map(|(i, area)| {
                let fraction =
                    numbers.walls[i].glass.as_ref().map_or(0.55, |glass| glass.optics.back.admitted());
                area * fraction * traced.irradiance(i, &incidence)
            });
            let sum: f64 = admitted.sum();
            assert!((sum - 1.0).abs() < 1e-9, "{first}: {sum}");
        }
    }
}
