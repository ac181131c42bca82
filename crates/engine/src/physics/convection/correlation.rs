//! What every correlation offers: its coefficient at a temperature difference, and the part of the wind.

use super::natural::{Coefficient, Difference};
use super::wind::{Forced, Wind};
use crate::number::real::Real;

/// Where a surface lies: what turns the wind at the mast and gravity into those at the surface.
#[derive(Debug, Clone, Copy)]
pub struct Placement<S> {
    /// Plane area [m2].
    pub area: S,
    /// Upward component of the normal that points from the surface into the air [-].
    pub upward: S,
    /// Wind at the surface over wind at the mast [-].
    pub wind_factor: S,
    /// Angle between the surface and the horizontal, at most 90 [deg].
    pub inclination: S,
    /// Density of the air [kg/m3].
    pub density: S,
}

/// A correlation, reduced to the numbers that depend neither on temperature nor on the wind.
///
/// `S` is the type of these numbers: a number to compute with, or a list of the numbers of several surfaces that
/// follow the same correlation.
pub(crate) trait Correlation<S> {
    /// The same correlation with numbers of another type.
    type Of<T>;

    /// Changes all numbers, always in the same order.
    fn map<T>(&self, change: impl FnMut(&S) -> T) -> Self::Of<T>;

    /// The coefficient at a temperature difference; `upward` is the upward component of the normal into the air, and
    /// `number` turns the numbers of the correlation into those to compute with.
    fn coefficient<V: Real>(
        &self,
        number: &impl Fn(&S) -> V,
        upward: &S,
        at: &Difference<V>,
        forced: &Forced<V>,
    ) -> Coefficient<V>;
}

/// What the wind contributes to a coefficient.
pub(crate) trait WindPart<S: Real> {
    /// Whether the wind contributes anything.
    const DEPENDS_ON_WIND: bool = false;

    /// Whether the temperature contributes nothing.
    const LINEAR: bool = false;

    /// Whether the wind contributes anything to this law.
    fn depends_on_wind(&self) -> bool {
        Self::DEPENDS_ON_WIND
    }

    /// Whether the temperature contributes nothing to this law.
    fn linear(&self) -> bool {
        Self::LINEAR
    }

    /// The part without temperature at a wind; `windward`: where it blows onto the surface.
    #[inline(always)]
    fn forced(&self, _wind: &Wind, _windward: S::Mask) -> Forced<S> {
        [S::zero(); 2]
    }

    /// The part without temperature in calm air.
    fn calm(&self) -> Forced<S> {
        [S::zero(); 2]
    }
}
