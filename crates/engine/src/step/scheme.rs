//! Time-stepping schemes: their tableaux as data.
//!
//! A step of length `dt` goes through the stages of a diagonally implicit Runge-Kutta method. Stage i solves
//! `H_i - g dt f(T_i) = H_n + sum_(j<i) a_ij dt f(T_j)` with the same diagonal coefficient `g` in every stage, and the last
//! stage is the end of the step (stiffly accurate): its row of the tableau holds the weights. With two stages the sum over
//! the first one is `(1 - g)/g (H_1 - H_n)`: enthalpies reached take the place of fluxes.
//!
//! Source of SDIRK2: Alexander (1977), SIAM J. Numer. Anal. 14(6), doi:10.1137/0714068. Linearly implicit methods solve
//! one linear system a stage: Hairer & Wanner (1996), Solving Ordinary Differential Equations II, ch. IV.7,
//! doi:10.1007/978-3-642-05221-7.

use crate::linear::wall::StorageRule;
use crate::number::real::ByPrecision;

/// Time-stepping scheme.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// Two stages, second order, L-stable, one factorisation.
    Sdirk2,
    /// The stages of `Sdirk2`, each by one linear solve about its guess, more only where the tangents leave out much heat.
    LinearlyImplicit,
    /// One stage, first order, keeps the maximum principle.
    BackwardEuler,
    /// The paper's: backward Euler with the apparent capacity at the old temperature. Loses latent heat.
    ApparentCapacity,
}

/// The numbers of a scheme.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tableau {
    /// Diagonal coefficient: the effective length of a stage over that of the step.
    pub(crate) diagonal: f64,
    /// `(1 - g)/g` of the diagonal coefficient: the second stage starts from `H_n + ratio (H_1 - H_n)`.
    pub(crate) ratio: f64,
    /// Weights of the stages in the heat of a step.
    pub(crate) weights: &'static [f64],
    /// Times of the stages, in steps.
    pub(crate) nodes: &'static [f64],
    /// How the storage of phase-change cells is linearised.
    pub(crate) storage: StorageRule,
    /// What a stage may lack.
    pub(crate) tolerance: Tolerance,
}

/// What a solution may lack to be accepted.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tolerance {
    /// Heat that the tangents of the laws leave out, over the largest heat flow density [-].
    pub(crate) linearization_error: ByPrecision,
    /// How far the ideal loads that are missing would move the air [K]: the last stage supplies them.
    pub(crate) load: ByPrecision,
    /// Whether the first solution of a stage may be the last.
    pub(crate) first: bool,
}

/// Diagonal coefficient of SDIRK2.
const SDIRK2: f64 = 1.0 - core::f64::consts::FRAC_1_SQRT_2;

/// Tight enough for difference quotients of results.
const TIGHT: Tolerance = Tolerance {
    linearization_error: ByPrecision { double: 1e-9, single: 1e-5 },
    load: ByPrecision { double: 1e-5, single: 2e-3 },
    first: false,
};
/// Temperatures within some thousandths of a kelvin (docs/speed.md).
const LOOSE: Tolerance = Tolerance {
    linearization_error: ByPrecision { double: 1e-3, single: 1e-3 },
    load: ByPrecision { double: 1e-2, single: 1e-2 },
    first: true,
};

const TWO_STAGES: Tableau = Tableau {
    diagonal: SDIRK2,
    ratio: (1.0 - SDIRK2) / SDIRK2,
    weights: &[1.0 - SDIRK2, SDIRK2],
    nodes: &[SDIRK2, 1.0],
    storage: StorageRule::Enthalpy,
    tolerance: TIGHT,
};

const LINEARLY_IMPLICIT: Tableau = Tableau { tolerance: LOOSE, ..TWO_STAGES };

const ONE_STAGE: Tableau = Tableau {
    diagonal: 1.0,
    ratio: 0.0,
    weights: &[1.0],
    nodes: &[1.0],
    storage: StorageRule::Enthalpy,
    tolerance: TIGHT,
};

const APPARENT: Tableau = Tableau { storage: StorageRule::ApparentCapacity, ..ONE_STAGE };

impl Scheme {
    /// Its numbers.
    #[inline(always)]
    pub(crate) const fn tableau(self) -> &'static Tableau {
        match self {
            Self::Sdirk2 => &TWO_STAGES,
            Self::LinearlyImplicit => &LINEARLY_IMPLICIT,
            Self::BackwardEuler => &ONE_STAGE,
            Self::ApparentCapacity => &APPARENT,
        }
    }

    /// The scheme whose stages are solved to the end: derivatives are those of its solutions.
    pub(crate) const fn converged(self) -> Self {
        match self {
            Self::LinearlyImplicit => Self::Sdirk2,
            Self::Sdirk2 | Self::BackwardEuler | Self::ApparentCapacity => self,
        }
    }

    /// Weights of the stages in the heat of a step [-], one for each stage.
    #[must_use]
    #[inline(always)]
    pub fn weights(self) -> &'static [f64] {
        self.tableau().weights
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The conditions of first and of second order, and L-stability: `R(z) -> 0` as z goes to minus infinity, which holds where
    /// the last stage is the end of the step and the diagonal is not zero.
    #[test]
    fn order_conditions() {
        for scheme in
            [Scheme::Sdirk2, Scheme::LinearlyImplicit, Scheme::BackwardEuler, Scheme::ApparentCapacity]
        {
            let Tableau { diagonal, ratio, weights, nodes, .. } = *scheme.tableau();
            assert_eq!(weights.len(), nodes.len());
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15, "{scheme:?}: first order");
            assert!((weights[weights.len() - 1] - diagonal).abs() < 1e-15, "{scheme:?}: stiffly accurate");
            assert!((nodes[nodes.len() - 1] - 1.0).abs() < 1e-15 && (nodes[0] - diagonal).abs() < 1e-15);
            assert!((ratio * diagonal - (1.0 - diagonal)).abs() < 1e-15);
            let second: f64 = weights.iter().zip(nodes).map(|(weight, node)| weight * node).sum();
            let expected = if weights.len() == 2 { 0.5 } else { 1.0 };
            assert!((second - expected).abs() < 1e-15, "{scheme:?}: {second} is not {expected}");
        }
    }

    /// One step of `y' = z y` from 1, stage by stage as the stepper goes, against the stability function of SDIRK2,
    /// `R(z) = (1 + (1 - 2 g) z) / (1 - g z)^2`.
    #[test]
    fn the_second_stage_starts_from_the_first() {
        let Tableau { diagonal: g, ratio, .. } = *Scheme::Sdirk2.tableau();
        for z in [-0.1_f64, -1.0, -30.0, -1e4] {
            let first = 1.0 / (1.0 - g * z);
            let last = (1.0 + ratio * (first - 1.0)) / (1.0 - g * z);
            let expected = (1.0 + (1.0 - 2.0 * g) * z) / ((1.0 - g * z) * (1.0 - g * z));
            assert!((last - expected).abs() < 1e-14, "{last} is not {expected} at {z}");
        }
    }
}
