//! The energy ledger: heat that entered the building by flow, heat stored, and the energy-balance residual.

use crate::balance::vapour::VapourLedger;
use crate::number::real::{ByPrecision, Real};

/// Flows by which heat enters a building.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Short-wave radiation absorbed.
    Solar,
    /// Convection from outdoor air.
    Convection,
    /// Long-wave exchange with sky, outdoor air and ground.
    Longwave,
    /// Imposed temperatures, ground and measured, and heat fluxes that are given.
    Boundary,
    /// Outdoor air entering zones.
    Infiltration,
    /// Outdoor air through ventilation and openings, and the air of ventilation units.
    Ventilation,
    /// Heat exchanged between zones by air and thermal bridges: zero in sum, but part of the total heat exchanged.
    Interzone,
    /// People, light and machines.
    Gains,
    /// Ideal heating.
    Heating,
    /// Ideal cooling, as a negative number.
    Cooling,
    /// Sun through windows that is absorbed in zones, without the part absorbed in glass.
    Transmitted,
    /// Sun absorbed in glass, from both sides.
    Glass,
    /// Thermal bridges to outdoors, ground and measured temperatures.
    Bridges,
    /// Heat sources in walls; of water that cools it is negative.
    Sources,
}

impl Flow {
    /// All flows, in the order of the ledger's arrays.
    pub const ALL: [Self; 14] = [
        Self::Solar,
        Self::Convection,
        Self::Longwave,
        Self::Boundary,
        Self::Infiltration,
        Self::Ventilation,
        Self::Interzone,
        Self::Gains,
        Self::Heating,
        Self::Cooling,
        Self::Transmitted,
        Self::Glass,
        Self::Bridges,
        Self::Sources,
    ];

    /// Name in results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Solar => "solar",
            Self::Convection => "convection",
            Self::Longwave => "longwave",
            Self::Boundary => "boundary",
            Self::Infiltration => "infiltration",
            Self::Ventilation => "ventilation",
            Self::Interzone => "interzone",
            Self::Gains => "gains",
            Self::Heating => "heating",
            Self::Cooling => "cooling",
            Self::Transmitted => "transmitted",
            Self::Glass => "glass",
            Self::Bridges => "bridges",
            Self::Sources => "sources",
        }
    }
}

/// Heat of one flow through several surfaces, and its magnitudes [W].
pub(crate) struct Sum<S> {
    pub(crate) net: S,
    pub(crate) magnitude: S,
}

impl<S: Real> Sum<S> {
    #[inline(always)]
    pub(crate) fn none() -> Self {
        Self { net: S::zero(), magnitude: S::zero() }
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, power: S) {
        self.net += power;
        self.magnitude += power.abs();
    }
}

/// Heat of one stage [W], or of a step [J].
#[derive(Debug, Clone, Copy)]
pub struct Power<S> {
    /// Net heat into the building by flow.
    pub into: [S; Flow::ALL.len()],
    /// Sum of magnitudes over surfaces and flows.
    pub total_exchanged: S,
}

impl<S: Real> Power<S> {
    /// No heat.
    #[must_use]
    #[inline(always)]
    pub fn none() -> Self {
        Self { into: [S::zero(); Flow::ALL.len()], total_exchanged: S::zero() }
    }

    /// Adds a flow.
    #[inline(always)]
    pub fn add_flow(&mut self, flow: Flow, power: S) {
        self.into[flow as usize] += power;
        self.total_exchanged += power.abs();
    }

    /// Adds a flow through several surfaces.
    #[inline(always)]
    pub(crate) fn add_sum(&mut self, flow: Flow, sum: &Sum<S>) {
        self.into[flow as usize] += sum.net;
        self.total_exchanged += sum.magnitude;
    }

    /// Adds another one that acts for a time.
    #[inline(always)]
    pub fn add_for(&mut self, duration: f64, power: &Self) {
        for (sum, part) in self.into.iter_mut().zip(power.into) {
            *sum += part.scale(duration);
        }
        self.total_exchanged += power.total_exchanged.scale(duration);
    }
}

/// Heat of a run [J].
#[derive(Debug, Clone, Copy)]
pub struct EnergyBalance<S> {
    /// Net heat into the building by flow.
    pub into: [S; Flow::ALL.len()],
    /// Rise of the heat stored in walls and air.
    pub stored: S,
    /// Sum of magnitudes of all flows.
    pub total_exchanged: S,
    /// Sum over steps of |stored - into|.
    pub imbalance: S,
    /// Heat that counts as nothing [J], see [`Self::closure`].
    pub nothing: S,
    /// Vapour of the run [kg]; nothing in a building without vapour balances.
    pub vapour: VapourLedger<S>,
}

/// Part of the heat content of a building that counts as nothing in a step [-]. Stored heat is a difference of contents, which are
/// rounded to 1e-16; some thousand roundings add up in a step.
const NOTHING: ByPrecision = ByPrecision { double: 1e-12, single: 1e-6 };

impl<S: Real> EnergyBalance<S> {
    /// No heat yet.
    #[must_use]
    pub fn new() -> Self {
        let zero = S::zero();
        Self {
            into: [zero; Flow::ALL.len()],
            stored: zero,
            total_exchanged: zero,
            imbalance: zero,
            nothing: zero,
            vapour: VapourLedger::new(),
        }
    }

    /// Adds a step: heat into the building and its magnitude over the step [J], and the heat stored [J].
    #[inline(always)]
    pub fn add_step(&mut self, energy: &Power<S>, stored: S) {
        let mut total = S::zero();
        for (sum, part) in self.into.iter_mut().zip(energy.into) {
            *sum += part;
            total += part;
        }
        self.stored += stored;
        self.total_exchanged += energy.total_exchanged;
        self.imbalance += (stored - total).abs();
    }

    /// Sets the heat that a building contains [J] and the number of steps, see [`Self::closure`].
    pub(crate) fn set_content(&mut self, content: S, steps: usize) {
        self.nothing = content.scale(NOTHING.of::<S>() * steps as f64);
    }

    /// Relative energy-balance residual [-]: imbalance over total heat exchanged, summed over steps so that opposite errors do
    /// not cancel. Zero where a building at rest exchanges nothing, and the imbalance is rounding of the heat that it contains.
    #[must_use]
    pub fn closure(&self) -> S {
        let at_rest = self.total_exchanged.lt(self.nothing) & self.imbalance.lt(self.nothing);
        let scale = self.total_exchanged.max(self.nothing).max(S::constant(f64::MIN_POSITIVE));
        S::select(at_rest, S::zero(), self.imbalance / scale)
    }
}

impl<S: Real> EnergyBalance<S> {
    /// The larger of the relative residuals of the balances of heat and of vapour [-].
    #[must_use]
    pub fn worst_closure(&self) -> S {
        self.closure().max(self.vapour.closure())
    }
}

impl<S: Real> Default for EnergyBalance<S> {
    fn default() -> Self {
        Self::new()
    }
}
