//! The vapour ledger: vapour that entered the zones by flow, vapour stored in air and surfaces, and what is missing.

use crate::number::real::{ByPrecision, Real};

/// Flows by which vapour enters a building.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VapourFlow {
    /// With outdoor air, whatever drives it.
    OutdoorAir,
    /// Exchanged between zones with air: zero in sum, but part of what is exchanged.
    Interzone,
    /// From people, plants, kitchens and bathrooms.
    Gains,
    /// Ideal humidifying.
    Humidifying,
    /// Ideal drying, as a negative number.
    Drying,
    /// Vapour that saturated air cannot hold, as a negative number.
    Condensation,
}

impl VapourFlow {
    /// All flows, in the order of the ledger's arrays.
    pub const ALL: [Self; 6] =
        [Self::OutdoorAir, Self::Interzone, Self::Gains, Self::Humidifying, Self::Drying, Self::Condensation];

    /// Name in results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::OutdoorAir => "outdoor_air",
            Self::Interzone => "interzone",
            Self::Gains => "gains",
            Self::Humidifying => "humidifying",
            Self::Drying => "drying",
            Self::Condensation => "condensation",
        }
    }
}

/// Vapour of a run, or of a step [kg].
#[derive(Debug, Clone, Copy)]
pub struct VapourLedger<S> {
    /// Net vapour into the zones by flow.
    pub into: [S; VapourFlow::ALL.len()],
    /// Rise of the vapour stored in air and surfaces.
    pub stored: S,
    /// Sum of magnitudes of all flows.
    pub total_exchanged: S,
    /// Sum over steps of |stored - into|.
    pub imbalance: S,
    /// Vapour that counts as nothing: a small part of what is stored, summed up over the steps.
    nothing: S,
    /// Steps, or parts of steps, that were too coarse: an air was kept between its causes by a large correction.
    pub corrected: S,
    /// Fastest exchange of vapour of an air in these [1/s].
    pub fastest: S,
}

/// Part of the vapour stored in a building that counts as nothing in a step [-]; see [`Ledger`](super::ledger::Ledger).
const NOTHING: ByPrecision = ByPrecision { double: 1e-12, single: 1e-6 };
/// Rounding of what is stored, over what counts as nothing [-]: some roundings of 1e-16 in a step, of 6e-8 in single precision.
const ROUNDING: ByPrecision = ByPrecision { double: 1e-3, single: 0.5 };

impl<S: Real> VapourLedger<S> {
    /// No vapour yet.
    #[must_use]
    #[inline(always)]
    pub fn new() -> Self {
        let zero = S::zero();
        Self {
            into: [zero; VapourFlow::ALL.len()],
            stored: zero,
            total_exchanged: zero,
            imbalance: zero,
            nothing: zero,
            corrected: zero,
            fastest: zero,
        }
    }

    /// Adds a flow.
    #[inline(always)]
    pub(crate) fn add_flow(&mut self, flow: VapourFlow, vapour: S) {
        self.into[flow as usize] += vapour;
        self.total_exchanged += vapour.abs();
    }

    /// Adds a step, at the end of which so much is contained [kg].
    #[inline(always)]
    pub(crate) fn add_step(&mut self, step: &Self, content: S) {
        let mut total = S::zero();
        for (sum, part) in self.into.iter_mut().zip(step.into) {
            *sum += part;
            total += part;
        }
        self.stored += step.stored;
        self.total_exchanged += step.total_exchanged;
        self.imbalance += (step.stored - total).abs();
        self.nothing += content.abs().scale(NOTHING.of::<S>());
        self.corrected += step.corrected;
        self.fastest = self.fastest.max(step.fastest);
    }

    /// Relative residual of the vapour balance [-]: imbalance over all vapour exchanged. Zero where nothing is exchanged, and where the
    /// imbalance is rounding of what is stored: airs that exchange next to nothing beside what surfaces hold.
    #[must_use]
    pub fn closure(&self) -> S {
        let at_rest = (self.total_exchanged.lt(self.nothing) & self.imbalance.lt(self.nothing))
            | self.imbalance.lt(self.nothing.scale(ROUNDING.of::<S>()));
        let scale = self.total_exchanged.max(self.nothing).max(S::constant(f64::MIN_POSITIVE));
        S::select(at_rest, S::zero(), self.imbalance / scale)
    }
}

impl<S: Real> Default for VapourLedger<S> {
    fn default() -> Self {
        Self::new()
    }
}
