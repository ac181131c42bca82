//! The coefficients of a front, before its elimination.

use crate::number::real::Real;

use super::laws::Laws;
use super::layout::Layout;

/// The coefficients of a front. Unknowns are emissions, see [`zone_elimination`](super).
#[derive(Debug, Clone)]
pub(super) struct Equations<S> {
    /// Exchange areas: what a surface loses by its own emission and gains by that of others [m2]; symmetric.
    pub(super) exchange: Vec<S>,
    /// One for eliminated surfaces, else zero; and this over the slope of the emission [m2 K/W]: the temperature of a retained
    /// surface is an unknown of the coupled system, which its convection is assembled into.
    pub(super) eliminated: Vec<S>,
    pub(super) inverse_slope: Vec<S>,
    /// Convective conductance to the air [W/K], the same per emission [m2], and heat into the air that depends on no
    /// temperature [W].
    pub(super) to_air: Vec<S>,
    pub(super) to_air_by_emission: Vec<S>,
    pub(super) air_heat: Vec<S>,
    /// What the diagonal has beside the exchange [m2], for the air [W/K]; right-hand side [W].
    pub(super) diagonal: Vec<S>,
    pub(super) right: Vec<S>,
}

impl<S: Real> Equations<S> {
    /// Equations without exchange.
    pub(super) fn new(layout: &Layout, laws: &Laws<S>) -> Self {
        let zeros = || vec![S::zero(); layout.stride];
        let mut eliminated = zeros();
        eliminated[..layout.eliminated].fill(S::one());
        let slopes = eliminated.iter().zip(&laws.emission[1]);
        Self {
            exchange: vec![S::zero(); layout.matrix()],
            inverse_slope: slopes.map(|(&flag, &slope)| flag / slope).collect(),
            eliminated,
            to_air: zeros(),
            to_air_by_emission: zeros(),
            air_heat: zeros(),
            diagonal: zeros(),
            right: zeros(),
        }
    }
}
