//! Numbers that several laws of convection have.

use crate::physics::law_row::{Default, LawParameter, LawRange};

/// Multiplies a correlation.
pub(crate) const FACTOR: LawParameter = LawParameter::new(
    "factor",
    "-",
    "Factor on the correlation",
    LawRange::Percent(30.0, "scatter of full-scale measurements about the correlations"),
    1.0,
)
.default(Default::Value(1.0, "the correlation as published"));

/// The length of a surface.
pub(crate) const LENGTH: LawParameter = LawParameter::new(
    "length",
    "m",
    "Characteristic length: height of a vertical surface, 4 area/perimeter of a horizontal one",
    LawRange::Percent(25.0, "surfaces are no free plates"),
    2.7,
)
.positive()
.default(Default::Length);

/// The perimeter of a surface.
pub(crate) const PERIMETER: LawParameter = LawParameter::new(
    "perimeter",
    "m",
    "Perimeter exposed to wind",
    LawRange::Percent(20.0, "whether neighboring surfaces count"),
    12.0,
)
.positive()
.default(Default::Perimeter)
.of_wind();

/// The roughness of a surface.
pub(crate) const ROUGHNESS: LawParameter = LawParameter::new(
    "roughness",
    "-",
    "Roughness factor of the forced part",
    LawRange::Span(1.0, 2.17, "very smooth to very rough"),
    1.67,
)
.positive()
.at_most(5.0)
.words(&[
    ("very_rough", 2.17),
    ("rough", 1.67),
    ("medium_rough", 1.52),
    ("medium_smooth", 1.13),
    ("smooth", 1.11),
    ("very_smooth", 1.0),
])
.default(Default::Assumed(1.52, "Walton 1983: medium rough, as plaster, concrete and brick"))
.of_wind();

/// A coefficient.
pub(crate) const fn coefficient(name: &'static str, example: f64) -> LawParameter {
    let range = LawRange::Percent(50.0, "published coefficients for the same surface differ by half");
    LawParameter::new(name, "W/(m2 K)", "Surface heat transfer coefficient", range, example).at_most(1e5)
}
