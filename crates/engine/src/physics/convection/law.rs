//! The correlation of a surface: any of those of this folder.

use std::sync::Arc;

use super::correlation::{Correlation, NamedLaw, Placement, WindPart};
use super::formula::Formula;
use super::formula_text::FormulaText;
use super::laws::{self, with_laws};
use super::measured::Measured;
use super::natural::{Coefficient, Difference};
use super::wind::{Driven, Forced, Surroundings, Wind, WindTerms};
use crate::input::description::{Convection, PublishedLaw};
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::law_row::{LawEntry, LawRow, Numbers};

/// Heat flow from surface to air and its slope in `T_surface - T_air`.
#[derive(Debug, Clone, Copy)]
pub struct ConvectiveFlux<S> {
    /// [W/m2].
    pub flux: S,
    /// [W/(m2 K)].
    pub slope: S,
}

/// Defines `Law`, one variant for each file of `laws`, and passes every question on to the correlation.
macro_rules! laws {
    ($(($module:ident, $law:ident, $kind:literal))*) => {
        /// A correlation with its numbers.
        #[derive(Debug, Clone)]
        enum Law<S> {
            $($law(laws::$module::$law<S>),)*
            Measured(Measured<S>),
            Formula(Formula<S>),
        }

        impl<S> Law<S> {
            #[inline(always)]
            fn map<T>(&self, change: impl FnMut(&S) -> T) -> Law<T> {
                match self {
                    $(Self::$law(law) => Law::$law(law.map(change)),)*
                    Self::Measured(law) => Law::Measured(law.map(change)),
                    Self::Formula(law) => Law::Formula(law.map(change)),
                }
            }

            #[inline(always)]
            fn coefficient<V: Real>(
                &self,
                number: &impl Fn(&S) -> V,
                upward: &S,
                at: &Difference<V>,
                driven: &Driven<V>,
            ) -> Coefficient<V> {
                let forced = &[driven[0], driven[1]];
                match self {
                    $(Self::$law(law) => law.coefficient(number, upward, at, forced),)*
                    Self::Measured(law) => law.coefficient(number, upward, at, forced),
                    Self::Formula(law) => law.coefficient(number, at, driven),
                }
            }
        }

        impl<S: Real> Law<S> {
            /// The law of a kind.
            fn named(law: &PublishedLaw, number: &Numbers<'_, S>, surface: &Placement<S>) -> Option<Self> {
                match law.kind.as_str() {
                    $($kind => Some(Self::$law(<laws::$module::$law<S> as NamedLaw<S>>::new(number, surface))),)*
                    _ => None,
                }
            }

            fn depends_on_wind(&self) -> bool {
                match self {
                    $(Self::$law(law) => law.depends_on_wind(),)*
                    Self::Measured(law) => law.depends_on_wind(),
                    Self::Formula(law) => law.depends_on_wind(),
                }
            }

            fn linear(&self) -> bool {
                match self {
                    $(Self::$law(law) => law.linear(),)*
                    Self::Measured(law) => law.linear(),
                    Self::Formula(law) => law.linear(),
                }
            }

            fn fixed(&self) -> Option<S> {
                match self {
                    $(Self::$law(law) => law.fixed(),)*
                    Self::Measured(_) | Self::Formula(_) => None,
                }
            }

            #[inline(always)]
            fn forced(&self, wind: &Wind, windward: S::Mask) -> Driven<S> {
                match self {
                    $(Self::$law(law) => widened(law.forced(wind, windward)),)*
                    Self::Measured(law) => widened(law.forced(wind, windward)),
                    Self::Formula(law) => law.driven(wind, windward, &Surroundings::calm()),
                }
            }

            fn calm(&self) -> Driven<S> {
                match self {
                    $(Self::$law(law) => widened(law.calm()),)*
                    Self::Measured(law) => widened(law.calm()),
                    Self::Formula(law) => law.calm(),
                }
            }
        }

        /// All laws that a description has by name, in the order of their kinds.
        pub fn table() -> Vec<LawEntry> {
            vec![$(entry::<laws::$module::$law<f64>>($kind)),*]
        }

        /// The terms of the wind that a law needs.
        fn terms(law: &PublishedLaw) -> WindTerms {
            let terms = match law.kind.as_str() {
                $($kind => <laws::$module::$law<f64> as WindPart<f64>>::WIND,)*
                _ => None,
            };
            terms.unwrap_or_default()
        }

        /// What a law says of itself; none for a kind that is no law.
        pub(crate) fn row(law: &PublishedLaw) -> Option<LawRow> {
            match law.kind.as_str() {
                $($kind => Some(<laws::$module::$law<f64> as NamedLaw<f64>>::ROW),)*
                _ => None,
            }
        }
    };
}

with_laws!(laws);

fn entry<L: NamedLaw<f64>>(kind: &'static str) -> LawEntry {
    let wind_direction = L::WIND.is_some_and(|terms| terms.direction);
    LawEntry { kind, wind: L::WIND.is_some(), wind_direction, linear: L::LINEAR, row: L::ROW }
}

#[inline(always)]
fn widened<S: Real>([first, second]: Forced<S>) -> Driven<S> {
    [first, second, S::zero(), S::zero()]
}

/// The terms of the wind that several laws need together.
pub fn wind_terms<'a>(convections: impl Iterator<Item = &'a Convection>) -> WindTerms {
    convections.fold(WindTerms::default(), |sum, convection| {
        sum.and(match convection {
            Convection::Law(law) => terms(law),
            Convection::Formula { formula, .. }
                if ["windward", "wind_angle"].iter().any(|name| formula.contains(name)) =>
            {
                WindTerms::DIRECTION
            }
            Convection::Formula { .. } | Convection::Measured { .. } => WindTerms::default(),
        })
    })
}

impl<S: Real> Law<S> {
    fn new(
        values: &Values<'_, S>,
        convection: &Convection,
        text: Option<&Arc<FormulaText>>,
        surface: &Placement<S>,
    ) -> Self {
        match convection {
            Convection::Law(law) => {
                let named = Self::named(law, &Numbers::new(values, law), surface);
                named.expect("a plan knows its laws")
            }
            Convection::Measured { channel, factor } => {
                Self::Measured(Measured::new(*channel, values.get(*factor)))
            }
            Convection::Formula { numbers, .. } => {
                let given: Vec<S> = numbers.iter().map(|number| values.get(number.value)).collect();
                let text = text.expect("a plan reads the formulas of its sides");
                Self::Formula(Formula::new(text, &given, surface))
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
        match (&self.law, &other.law) {
            (Law::Formula(law), Law::Formula(other)) => law.alike(other),
            (law, other) => core::mem::discriminant(law) == core::mem::discriminant(other),
        }
    }

    /// [`SurfaceConvection::flux`] of numbers that are still to be turned into those to compute with.
    #[inline(always)]
    pub(crate) fn flux_of<V: Real>(
        &self,
        number: impl Fn(&S) -> V,
        d: V,
        forced: &Driven<V>,
    ) -> ConvectiveFlux<V> {
        // q = h d, so q' = h + d h'.
        let Coefficient { value, rise } =
            self.law.coefficient(&number, &self.upward, &Difference::new(d), forced);
        ConvectiveFlux { flux: value * d, slope: value + rise }
    }
}

impl<S: Copy> SurfaceConvection<S> {
    /// Surfaces of one correlation: their numbers are neighbours in arrays.
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
    /// Reads the numbers of a correlation for a surface; `text`: the formula, where it is written as one.
    pub(crate) fn new(
        values: &Values<'_, S>,
        law: &Convection,
        text: Option<&Arc<FormulaText>>,
        surface: &Placement<S>,
    ) -> Self {
        Self { law: Law::new(values, law, text, surface), upward: surface.upward }
    }

    /// The coefficient that a law of what a side is in contact with gives.
    pub(crate) fn imposed(surface: &Placement<S>) -> Self {
        Self { law: Law::Measured(Measured::imposed(S::one())), upward: surface.upward }
    }

    /// How much more the flow of heat bends than that of the published correlations; one at least.
    pub(crate) fn bend(&self) -> S {
        if let Law::Formula(law) = &self.law { law.bend() } else { S::one() }
    }

    /// Whether it says where it is valid.
    pub(crate) fn limited(&self) -> bool {
        matches!(&self.law, Law::Formula(law) if law.limited())
    }

    /// One where it is valid at a difference [K], a wind at the mast [m/s] and a temperature of the air [degC], else zero.
    pub(crate) fn valid(&self, d: S, speed: S, air: S) -> S {
        if let Law::Formula(law) = &self.law { law.valid(d, speed, air) } else { S::one() }
    }

    /// Whether it is written as text: all four parts of [`Driven`] may act, and be negative.
    pub(crate) fn is_text(&self) -> bool {
        matches!(&self.law, Law::Formula(_))
    }

    /// Whether it depends on its [`Surroundings`].
    pub(crate) fn surrounded(&self) -> bool {
        matches!(&self.law, Law::Formula(law) if law.surrounded())
    }

    /// Whether it depends on the air that flows into a zone.
    pub(crate) fn needs_air_change(&self) -> bool {
        matches!(&self.law, Law::Formula(law) if law.needs_air_change())
    }

    /// What drives it in its surroundings; `windward`: where the wind blows onto the surface.
    pub(crate) fn driven(&self, wind: &Wind, windward: S::Mask, at: &Surroundings<S>) -> Driven<S> {
        if let Law::Formula(law) = &self.law {
            law.driven(wind, windward, at)
        } else {
            self.law.forced(wind, windward)
        }
    }

    /// The coefficient, where it depends neither on temperature nor on wind.
    pub fn constant(&self) -> Option<S> {
        self.law.fixed()
    }

    /// Forcing channel and factor of a measured coefficient.
    pub(crate) fn measured(&self) -> Option<(usize, S)> {
        if let Law::Measured(law) = &self.law { Some((law.channel?, law.factor)) } else { None }
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
    pub fn forced(&self, wind: &Wind, windward: S::Mask) -> Driven<S> {
        self.law.forced(wind, windward)
    }

    /// The part of the coefficient without temperature in calm air.
    pub fn calm(&self) -> Driven<S> {
        self.law.calm()
    }

    /// Heat flow at `d = T_surface - T_air` [K], in numbers with derivatives. Where none of its numbers has any, it is that of plain
    /// numbers: most surfaces do not depend on the few parameters that slopes are computed by.
    #[inline(always)]
    pub(crate) fn tangent_flux(&self, d: S, forced: &Driven<S>) -> ConvectiveFlux<S> {
        if const { S::DERIVATIVES } && !self.carries(d, forced) {
            let ConvectiveFlux { flux, slope } = self.plain_flux(d.lane(0), forced.map(|part| part.lane(0)));
            return ConvectiveFlux { flux: S::constant(flux), slope: S::constant(slope) };
        }
        self.flux(d, forced)
    }

    /// Whether one of the numbers of the heat flow has derivatives.
    #[inline(always)]
    fn carries(&self, d: S, forced: &Driven<S>) -> bool {
        let mut carries = d.carries() || forced.iter().any(|part| part.carries());
        self.map(|number| carries |= number.carries());
        carries
    }

    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    fn plain_flux(&self, d: f64, forced: Driven<f64>) -> ConvectiveFlux<f64> {
        self.flux_of(|number| number.lane(0), d, &forced)
    }

    /// Heat flow at `d = T_surface - T_air` [K].
    #[inline(always)]
    pub fn flux(&self, d: S, forced: &Driven<S>) -> ConvectiveFlux<S> {
        self.flux_of(
            #[inline(always)]
            |number| *number,
            d,
            forced,
        )
    }
}
