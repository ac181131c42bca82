//! Convective heat flow between a surface and the air.
//!
//! Every correlation gives a surface heat transfer coefficient h as a function of the temperature difference; the heat flow is
//! `q = h d`, `d = T_surface - T_air`. Each file holds one correlation, with its source, equation, range, and a test against a
//! number worked out by hand:
//!
//! | file | correlation | used |
//! |---|---|---|
//! | [`constant`] | one number | anywhere |
//! | [`linear_wind`] | `a + b V` (`McAdams` 1954) | outdoors |
//! | [`alamdari_hammond`] | Alamdari & Hammond (1983) | indoors |
//! | [`paper_eq5`] | Guichard et al. (2016), eq. 5 as printed | indoors |
//! | [`tarp`] | TARP: Walton (1983) | indoors and outdoors |
//! | [`mowitt`] | `MoWiTT`: Yazdanian & Klems (1994) | outdoors, smooth surfaces |
//! | [`doe2`] | DOE-2: `MoWiTT` on rough surfaces | outdoors |
//! | [`iso15099`] | ISO 15099:2003, 8.3.2.2 | indoor surface of a glazing |
//! | [`power`] | `a + b |d|^n + c V^m` | anywhere |
//!
//! [`natural`] holds the terms that several of them are made of, [`wind`] the wind and its part of the coefficient. h is a
//! function of `d^2 + r^2` with a small r: it is smooth where the heat flow changes its direction, and roots and derivatives of
//! powers of `|d|` come without divisions. What depends on geometry is computed once per run, what depends on the wind once per
//! stage.
//!
//! # Adding a correlation
//!
//! 1. `input/description/convection.rs`: a variant of `Convection` with its parameters and their units;
//! 2. `input/parameter_walk.rs`: the names of these parameters (the compiler asks for them);
//! 3. here: a file with a struct of the numbers that remain after geometry, its `new`, `impl Correlation`, `impl WindPart`, and
//!    a test with a number worked out by hand; its name in `mod`, in `laws!`, in the table above; an arm of `Law::new` (the
//!    compiler asks for it);
//! 4. [`wind::WindTerms::of`]: the terms of the wind that it needs (the compiler asks for it);
//! 5. the description language: a class in `python/mascarin/model/convection.py` with the same names.
//!
//! Lanes, derivatives, ledger, and the linear systems need no change.

pub mod alamdari_hammond;
pub mod constant;
pub mod doe2;
pub mod iso15099;
pub mod linear_wind;
pub mod mowitt;
pub mod natural;
pub mod paper_eq5;
pub mod power;
pub mod tarp;
pub mod wind;

use crate::input::description::Convection;
use crate::input::values::Values;
use crate::number::real::Real;
use alamdari_hammond::AlamdariHammond;
use constant::Constant;
use doe2::Doe2;
use iso15099::Iso15099;
use linear_wind::LinearWind;
use mowitt::Mowitt;
use natural::{Coefficient, Difference};
use paper_eq5::PaperEq5;
use power::Power;
use tarp::Tarp;
pub use wind::{Forced, Wind, WindTerms};

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

/// Heat flow from surface to air and its slope in `T_surface - T_air`.
#[derive(Debug, Clone, Copy)]
pub struct ConvectiveFlux<S> {
    /// [W/m2].
    pub flux: S,
    /// [W/(m2 K)].
    pub slope: S,
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

/// Defines `Law`, one variant for each correlation, and passes every question on to the correlation.
macro_rules! laws {
    ($($law:ident),*) => {
        /// A correlation with its numbers.
        #[derive(Debug, Clone)]
        enum Law<S> {
            $($law($law<S>),)*
        }

        impl<S> Law<S> {
            #[inline(always)]
            fn map<T>(&self, change: impl FnMut(&S) -> T) -> Law<T> {
                match self {
                    $(Self::$law(law) => Law::$law(law.map(change)),)*
                }
            }

            #[inline(always)]
            fn coefficient<V: Real>(
                &self,
                number: &impl Fn(&S) -> V,
                upward: &S,
                at: &Difference<V>,
                forced: &Forced<V>,
            ) -> Coefficient<V> {
                match self {
                    $(Self::$law(law) => law.coefficient(number, upward, at, forced),)*
                }
            }
        }

        impl<S: Real> Law<S> {
            fn depends_on_wind(&self) -> bool {
                match self {
                    $(Self::$law(_) => <$law<S> as WindPart<S>>::DEPENDS_ON_WIND,)*
                }
            }

            fn linear(&self) -> bool {
                match self {
                    $(Self::$law(_) => <$law<S> as WindPart<S>>::LINEAR,)*
                }
            }

            #[inline(always)]
            fn forced(&self, wind: &Wind, windward: S::Mask) -> Forced<S> {
                match self {
                    $(Self::$law(law) => law.forced(wind, windward),)*
                }
            }

            fn calm(&self) -> Forced<S> {
                match self {
                    $(Self::$law(law) => law.calm(),)*
                }
            }
        }
    };
}

laws!(Constant, LinearWind, AlamdariHammond, PaperEq5, Tarp, Mowitt, Doe2, Iso15099, Power);

impl<S: Real> Law<S> {
    fn new(values: &Values<'_, S>, law: &Convection, surface: &Placement<S>) -> Self {
        let get = |id| values.get(id);
        match law {
            Convection::Constant { coefficient } => Self::Constant(Constant::new(get(*coefficient))),
            Convection::LinearWind { constant, wind } => {
                Self::LinearWind(LinearWind::new(get(*constant), get(*wind), surface))
            }
            Convection::AlamdariHammond { length, factor } => {
                Self::AlamdariHammond(AlamdariHammond::new(get(*length), get(*factor), surface))
            }
            Convection::PaperEq5 { length, factor } => {
                Self::PaperEq5(PaperEq5::new(get(*length), get(*factor)))
            }
            Convection::Tarp { factor, roughness, perimeter } => {
                let rough =
                    roughness.zip(*perimeter).map(|(roughness, perimeter)| [get(roughness), get(perimeter)]);
                Self::Tarp(Tarp::new(get(*factor), rough, surface))
            }
            Convection::Mowitt { factor } => Self::Mowitt(Mowitt::new(get(*factor), surface)),
            Convection::Doe2 { factor, roughness } => {
                Self::Doe2(Doe2::new(get(*factor), get(*roughness), surface))
            }
            Convection::Iso15099 { length, factor } => {
                Self::Iso15099(Iso15099::new(get(*length), get(*factor), surface))
            }
            Convection::Power { upward, downward } => {
                Self::Power(Power::new(values, [upward, downward], surface))
            }
        }
    }
}

/// The correlation of a surface with its numbers.
#[derive(Debug, Clone)]
pub struct SurfaceConvection<S> {
    law: Law<S>,
    /// Upward component of the normal that points from the surface into the air [-].
    upward: S,
}

impl<S> SurfaceConvection<S> {
    /// The same correlation with other numbers.
    #[inline(always)]
    pub(crate) fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> SurfaceConvection<T> {
        let law = self.law.map(&mut change);
        SurfaceConvection { law, upward: change(&self.upward) }
    }

    /// Whether another surface has the same correlation.
    pub(crate) fn alike(&self, other: &Self) -> bool {
        core::mem::discriminant(&self.law) == core::mem::discriminant(&other.law)
    }

    /// [`SurfaceConvection::flux`] of numbers that are still to be turned into those to compute with.
    #[inline(always)]
    pub(crate) fn flux_of<V: Real>(
        &self,
        number: impl Fn(&S) -> V,
        d: V,
        forced: &Forced<V>,
    ) -> ConvectiveFlux<V> {
        // q = h d, so q' = h + d h'.
        let Coefficient { value, rise } =
            self.law.coefficient(&number, &self.upward, &Difference::new(d), forced);
        ConvectiveFlux { flux: value * d, slope: value + rise }
    }
}

impl<S: Copy> SurfaceConvection<S> {
    /// Surfaces of one correlation, their numbers side by side.
    pub(crate) fn together(convections: &[&Self]) -> SurfaceConvection<Box<[S]>> {
        let numbers = convections.iter().map(|convection| {
            let mut numbers = Vec::new();
            convection.map(|&number| numbers.push(number));
            numbers
        });
        let numbers: Vec<_> = numbers.collect();
        let mut place = 0..;
        convections[0].map(|_| {
            let place = place.next().unwrap_or(0);
            numbers.iter().map(|convection| convection[place]).collect()
        })
    }
}

impl<S: Real> SurfaceConvection<S> {
    /// Reads the numbers of a correlation for a surface.
    pub fn new(values: &Values<'_, S>, law: &Convection, surface: &Placement<S>) -> Self {
        Self { law: Law::new(values, law, surface), upward: surface.upward }
    }

    /// The coefficient, where it depends neither on temperature nor on wind.
    pub fn constant(&self) -> Option<S> {
        if let Law::Constant(law) = &self.law { Some(law.coefficient) } else { None }
    }

    /// Whether the heat flow is linear in the temperature difference.
    pub fn straight(&self) -> bool {
        self.law.linear()
    }

    /// Whether a part of the coefficient depends on the wind.
    pub fn windy(&self) -> bool {
        self.law.depends_on_wind()
    }

    /// The part of the coefficient without temperature; `windward`: where the wind blows onto the surface.
    #[inline(always)]
    pub fn forced(&self, wind: &Wind, windward: S::Mask) -> Forced<S> {
        self.law.forced(wind, windward)
    }

    /// The part of the coefficient without temperature in calm air.
    pub fn calm(&self) -> Forced<S> {
        self.law.calm()
    }

    /// Heat flow at `d = T_surface - T_air` [K].
    #[inline(always)]
    pub fn flux(&self, d: S, forced: &Forced<S>) -> ConvectiveFlux<S> {
        self.flux_of(
            #[inline(always)]
            |number| *number,
            d,
            forced,
        )
    }
}

/// Evaluates correlations for the tests of all files here.
#[cfg(test)]
mod testing {
    use super::{Placement, SurfaceConvection, Wind, WindTerms};
    use crate::input::description::{Convection, ParamId};
    use crate::input::values::Values;

    pub(super) fn id(index: u32) -> ParamId {
        ParamId(index)
    }

    /// A surface of 1 m2 in air of 1.2 kg/m3 with the mast's wind.
    pub(super) fn surface(law: &Convection, numbers: &[f64], upward: f64) -> SurfaceConvection<f64> {
        let inclination = crate::number::elementary::acos(upward.abs()).to_degrees();
        let surface = Placement { area: 1.0, upward, wind_factor: 1.0, inclination, density: 1.2 };
        SurfaceConvection::new(&Values::new(numbers), law, &surface)
    }

    /// The coefficient [W/(m2 K)] at a difference [K] and a wind [m/s]; its slope is checked against a difference.
    #[track_caller]
    pub(super) fn coefficient(surface: &SurfaceConvection<f64>, d: f64, wind: f64, windward: bool) -> f64 {
        let forced = surface.forced(&Wind::new(wind, WindTerms::all()), windward);
        let flux = surface.flux(d, &forced);
        let step = 1e-5;
        let slope =
            (surface.flux(d + step, &forced).flux - surface.flux(d - step, &forced).flux) / (2.0 * step);
        assert!((flux.slope - slope).abs() < 1e-6 * slope.abs(), "slope {} is not {slope}", flux.slope);
        flux.flux / d
    }

    #[track_caller]
    pub(super) fn assert_close(value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() < 2e-4, "{value} is not {expected}");
    }
}
