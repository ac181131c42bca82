//! Mechanical ventilation, and air that flows from zone to zone.
//!
//! Heat is counted against the outdoor temperature `T_o`: air of `G` [W/K] that enters a zone brings `G (T - T_o)`, air that
//! leaves it takes `G (T_zone - T_o)` away. Outdoor air that makes up a balance brings nothing. Flows are volumes at the density
//! of the site, or at another one that is asked for; masses are balanced:
//!
//! `leaves to outdoors = max(exhaust, supply + from zones - to zones)`.
//!
//! What a zone lacks comes from outdoors by leaks, and what it has too much leaves by them: the air in a zone stays as much as it
//! is, whatever the flows.
//!
//! Heat recovery brings `e C_min (T_x - T_o)` from the extracted air to the supplied air, with the mean temperature `T_x` of the
//! extracted air and the smaller flow `C_min` (sensible effectiveness: ASHRAE Handbook, HVAC Systems and Equipment 2020, ch. 26,
//! eq. 2; Kays & London 1984, Compact heat exchangers, 3rd ed., ch. 2).

use crate::input::description;
use crate::input::forcing::CLIMATE_CHANNELS;
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::flow_density::{AirDensities, AirFlow, SiteAir};

/// Effectiveness is divided by the product of two flows [(W/K)^2], which may be zero.
const LEAST: f64 = 1e-12;

/// A flow of heat capacity of a zone.
#[derive(Debug, Clone)]
pub struct ZoneFlow<S> {
    pub(crate) zone: usize,
    flow: AirFlow<S>,
}

impl<S: Real> ZoneFlow<S> {
    fn new(flow: &description::UnitFlow, values: &Values<'_, S>, site: &SiteAir<S>) -> Self {
        let (at_site, density) = (values.get(flow.flow) * site.heat, flow.density.as_ref());
        let of_zone = (density, [flow.zone; 2]);
        Self { zone: flow.zone, flow: AirFlow::new(at_site, flow.schedule, of_zone, values, site) }
    }

    /// In a forcing row [W/K].
    #[inline(always)]
    pub(crate) fn at(&self, row: &[f64], densities: &AirDensities<S>) -> S {
        self.flow.at(row, densities)
    }
}

/// Temperature of supplied air.
#[derive(Debug, Clone)]
enum Supplied<S> {
    /// That of the outdoor air, with heat recovery of this effectiveness [-].
    Outdoor(Option<S>),
    /// [degC].
    Constant(S),
    /// Position in a forcing row.
    Channel(usize),
}

/// A ventilation unit.
#[derive(Debug, Clone)]
pub struct Unit<S> {
    pub(crate) supply: Vec<ZoneFlow<S>>,
    pub(crate) exhaust: Vec<ZoneFlow<S>>,
    supplied: Supplied<S>,
}

impl<S: Real> Unit<S> {
    /// Evaluates a unit at a parameter vector.
    pub(crate) fn new(
        unit: &description::VentilationUnit,
        values: &Values<'_, S>,
        site: &SiteAir<S>,
    ) -> Self {
        let flows = |flows: &[description::UnitFlow]| {
            flows.iter().map(|flow| ZoneFlow::new(flow, values, site)).collect()
        };
        let supplied = match &unit.temperature {
            Some(description::SetPoint::Constant { temperature }) => {
                Supplied::Constant(values.get(*temperature))
            }
            Some(description::SetPoint::Scheduled { channel }) => {
                Supplied::Channel(CLIMATE_CHANNELS + channel)
            }
            None => Supplied::Outdoor(unit.recovery.map(|id| values.get(id))),
        };
        Self { supply: flows(&unit.supply), exhaust: flows(&unit.exhaust), supplied }
    }

    /// Whether it recovers heat.
    pub(crate) fn recovers(&self) -> bool {
        matches!(self.supplied, Supplied::Outdoor(Some(_)))
    }

    /// Temperature of the supplied air above that of the outdoor air, heat recovery not counted [K].
    #[inline(always)]
    pub(crate) fn excess(&self, row: &[f64], outdoor: S) -> S {
        match self.supplied {
            Supplied::Outdoor(_) => S::zero(),
            Supplied::Constant(temperature) => temperature - outdoor,
            Supplied::Channel(channel) => S::constant(row[channel]) - outdoor,
        }
    }

    /// Heat that recovery brings from an extracted to a supplied flow, per degree and by the product of both flows [K/W]; zero
    /// without recovery.
    #[inline(always)]
    pub(crate) fn recovery(&self, row: &[f64], densities: &AirDensities<S>) -> S {
        let Supplied::Outdoor(Some(effectiveness)) = self.supplied else { return S::zero() };
        self.recovery_with(effectiveness, row, densities)
    }

    /// The same with an effectiveness [-]: by it `effectiveness C_min` is exchanged between all extracted and all supplied air.
    #[inline(always)]
    pub(crate) fn recovery_with(&self, effectiveness: S, row: &[f64], densities: &AirDensities<S>) -> S {
        let sum =
            |flows: &[ZoneFlow<S>]| flows.iter().fold(S::zero(), |sum, flow| sum + flow.at(row, densities));
        let (supply, exhaust) = (sum(&self.supply), sum(&self.exhaust));
        effectiveness * supply.min(exhaust) / (supply * exhaust).max(S::constant(LEAST))
    }
}

/// Air that flows from one zone to another.
#[derive(Debug, Clone)]
pub struct DirectedFlow<S> {
    pub(crate) ends: [usize; 2],
    flow: AirFlow<S>,
}

impl<S: Real> DirectedFlow<S> {
    /// Evaluates a flow at a parameter vector; the air of a zone that its density may be of is that of the zone which it leaves.
    pub(crate) fn new(flow: &description::DirectedFlow, values: &Values<'_, S>, site: &SiteAir<S>) -> Self {
        let (at_site, density) = (values.get(flow.flow) * site.heat, flow.density.as_ref());
        let of_zone = (density, [flow.from; 2]);
        Self { ends: [flow.from, flow.to], flow: AirFlow::new(at_site, flow.schedule, of_zone, values, site) }
    }

    /// In a forcing row [W/K].
    #[inline(always)]
    pub(crate) fn at(&self, row: &[f64], densities: &AirDensities<S>) -> S {
        self.flow.at(row, densities)
    }

    /// Where nothing changes it [W/K].
    pub(crate) fn whole(&self) -> Option<S> {
        self.flow.whole()
    }
}
