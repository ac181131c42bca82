//! What acts on the air of a zone in one stage beside its walls: internal gains, ventilation and openings.

use crate::building::coefficients::ZoneCoefficients;
use crate::number::line::Line;
use crate::number::real::Real;
use crate::physics::air_flow::{self, Intake};

/// What acts on the air of a zone in one stage.
#[derive(Debug, Clone)]
pub struct ZoneConditions<S> {
    /// Gains given to the air [W].
    pub convective: S,
    /// Gains radiated to the surfaces [W].
    pub radiant: S,
    /// Heat carried by ventilation per degree [W/K].
    pub ventilation: S,
    /// Open fraction of each opening [-].
    open: Vec<S>,
}

impl<S: Real> ZoneConditions<S> {
    /// Zeros for a zone.
    #[must_use]
    pub fn new(zone: &ZoneCoefficients<S>) -> Self {
        let zero = S::zero();
        Self { convective: zero, radiant: zero, ventilation: zero, open: vec![zero; zone.openings.len()] }
    }

    /// Linear interpolation or extrapolation of two others; see `Conditions::between`](super::conditions::Conditions::between).
    pub(crate) fn interpolate(&mut self, first: &Self, second: &Self, share: f64) {
        let line = |a: S, b: S| a + (b - a).scale(share);
        self.convective = line(first.convective, second.convective);
        self.radiant = line(first.radiant, second.radiant);
        self.ventilation = line(first.ventilation, second.ventilation).max(S::zero());
        for (at, (&a, &b)) in self.open.iter_mut().zip(first.open.iter().zip(&second.open)) {
            *at = line(a, b).max(S::zero()).min(S::one());
        }
    }

    /// Evaluates gains, ventilation and openings in a forcing row.
    #[inline(always)]
    pub(crate) fn update(&mut self, zone: &ZoneCoefficients<S>, row: &[f64]) {
        (self.convective, self.radiant) = (S::zero(), S::zero());
        for gain in &zone.gains {
            let [convective, radiant] = gain.at(row);
            self.convective += convective;
            self.radiant += radiant;
        }
        self.ventilation = S::zero();
        for flow in &zone.ventilation {
            self.ventilation += flow.at(row);
        }
        for (open, opening) in self.open.iter_mut().zip(&zone.openings) {
            *open = opening.open_fraction(row);
        }
    }

    #[inline(always)]
    fn intake<'a>(&'a self, zone: &'a ZoneCoefficients<S>) -> Intake<'a, S> {
        Intake { ventilation: self.ventilation, openings: &zone.openings, open: &self.open }
    }

    /// Heat that ventilation and openings bring into the zone, as its tangent in `T_outdoor - T_air`.
    #[inline(always)]
    pub(crate) fn outdoor_heat(&self, zone: &ZoneCoefficients<S>, wind: S, outdoor: S, air: S) -> Line<S> {
        self.intake(zone).heat(wind, outdoor, air)
    }

    /// Outdoor air that enters the zone, infiltration included [1/h].
    pub(crate) fn air_changes(&self, zone: &ZoneCoefficients<S>, wind: S, outdoor: S, air: S) -> S {
        air_flow::air_changes(&zone.infiltration, zone.air_capacity, &self.intake(zone), wind, outdoor, air)
    }
}
