//! What every correlation offers: its coefficient at a temperature difference, and the part of the wind.

use super::natural::{Coefficient, Difference};
use super::wind::{Forced, Wind, WindTerms};
use crate::number::real::Real;
use crate::physics::law_row::{LawRow, Numbers};

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
    /// Height above ground, where it has one; else zero [m].
    pub height: S,
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
    /// The terms of the wind that contribute; none where the wind contributes nothing.
    const WIND: Option<WindTerms> = None;

    /// Whether the temperature contributes nothing.
    const LINEAR: bool = false;

    /// Whether the wind contributes anything to this law.
    fn depends_on_wind(&self) -> bool {
        Self::WIND.is_some()
    }

    /// Whether the temperature contributes nothing to this law.
    fn linear(&self) -> bool {
        Self::LINEAR
    }

    /// The coefficient, where it depends neither on temperature nor on wind.
    fn fixed(&self) -> Option<S> {
        None
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

/// A published law that a description has by its name.
pub(crate) trait NamedLaw<S: Real>: Correlation<S> + WindPart<S> + Sized {
    /// What it says of itself.
    const ROW: LawRow;

    /// Reads its numbers for a surface.
    fn new(number: &Numbers<'_, S>, surface: &Placement<S>) -> Self;
}
