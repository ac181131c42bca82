//! Infiltration by stack and wind: `Q = A sqrt(C_s |d| + C_w U^2)`.
//!
//! The leakage area at 4 Pa, `A = n50 V/3600 (4/50)^n sqrt(rho/(2 4))` [m2], where Q is in L/s and A in cm2: ten times the flow in m3/s
//! by square metres. Density 1.2 kg/m3; U is the wind at the mast.
//!
//! Source: basic model of ASHRAE Handbook of Fundamentals 2017, ch. 16, eq. 48, after Sherman & Grimsrud (1980),
//! Infiltration-pressurization correlation: simplified physical modeling, ASHRAE Trans. 86(2), 778-807.
//!
//! Range: detached houses of one to three storeys.

use crate::physics::leakage::prelude::*;

const SOURCE: &str = "Sherman & Grimsrud 1980, ASHRAE Trans. 86(2), 778-807, as in ASHRAE Handbook of Fundamentals 2017, \
                      ch. 16, eq. 48 (infiltration by stack and wind)";

/// Temperature differences are rounded off within this [K].
const ROUND_OFF: f64 = 0.01;
/// Pressure of the leakage area and of the test [Pa], and density of air [kg/m3].
const LOW: f64 = 4.0;
const HIGH: f64 = 50.0;
const DENSITY: f64 = 1.2;
/// Cubic metres per second by square metres, from litres per second by square centimetres.
const UNITS: f64 = 10.0;

const EXPONENT: LawParameter = LawParameter::new(
    "exponent",
    "-",
    "Exponent of the pressure difference in the flow through leaks",
    LawRange::Span(0.6, 0.7, "pressure tests of houses"),
    0.65,
)
.limits(Limits { above: None, at_least: Some(0.5), at_most: Some(1.0) })
.default(Default::Assumed(0.65, SOURCE));

const BY_TABLE: &str = "by storeys and shelter";

const STACK: LawParameter = LawParameter::new(
    "stack",
    "(L/s)2/(cm4 K)",
    "Stack coefficient of the leakage area",
    LawRange::Percent(30.0, "height of the house, and where its leaks are"),
    0.000_145,
)
.at_most(0.01)
.default(Default::Tabulated(
    &[
        0.000_145, 0.000_145, 0.000_145, 0.000_145, 0.000_145, // one storey
        0.000_290, 0.000_290, 0.000_290, 0.000_290, 0.000_290, // two
        0.000_435, 0.000_435, 0.000_435, 0.000_435, 0.000_435, // three
    ],
    BY_TABLE,
));

const WIND: LawParameter = LawParameter::new(
    "wind",
    "(L/s)2/(cm4 (m/s)2)",
    "Wind coefficient of the leakage area",
    LawRange::Percent(50.0, "the next shelter class to either side"),
    0.000_174,
)
.at_most(0.01)
.default(Default::Tabulated(
    &[
        0.000_319, 0.000_246, 0.000_174, 0.000_104, 0.000_032, // one storey
        0.000_420, 0.000_325, 0.000_231, 0.000_137, 0.000_042, // two
        0.000_494, 0.000_382, 0.000_271, 0.000_161, 0.000_049, // three
    ],
    BY_TABLE,
));

const STOREYS: Choice = Choice {
    name: "storeys",
    meaning: "Number of storeys of the house: 1, 2 or 3",
    among: &[1, 2, 3],
    default: 1,
};
const SHELTER: Choice = Choice {
    name: "shelter",
    meaning: "Shelter class: 1 none, 2 isolated rural house, 3 across a street, 4 dense, 5 close",
    among: &[1, 2, 3, 4, 5],
    default: 3,
};

/// `scale sqrt(stack |d| + wind U^2)` [1/h].
#[derive(Debug, Clone)]
pub(crate) struct StackWind<S> {
    /// [1/h per m/s].
    scale: S,
    stack: S,
    wind: S,
}

impl<S: Real> LeakageLaw<S> for StackWind<S> {
    const ROW: LawRow = LawRow::new(
        "stack and wind",
        "Infiltration by stack and wind through the leakage area of the test.",
        "detached houses of one to three storeys",
    )
    .details(
        "``Q = A sqrt(C_s |dT| + C_w U^2)``, with the leakage area A at 4 Pa and the wind U at the mast.",
    )
    .source(SOURCE)
    .numbers(&[N50, EXPONENT, STACK, WIND])
    .choices(&[STOREYS, SHELTER]);

    fn new(number: &Numbers<'_, S>) -> Self {
        let low = S::constant(LOW / HIGH).powf(number.of("exponent"));
        let scale = (number.of("n50") * low).scale(UNITS * Real::sqrt(DENSITY / (2.0 * LOW)));
        Self { scale, stack: number.of("stack"), wind: number.of("wind") }
    }

    #[inline(always)]
    fn rate(&self, wind: S, difference: S) -> (S, S) {
        let magnitude = difference.smooth_abs(ROUND_OFF);
        // Without stack and wind the root would have an infinite slope.
        let root = (self.stack * magnitude + self.wind * wind * wind).max(S::constant(1e-30)).sqrt();
        (self.scale * root, self.scale * self.stack * (difference / magnitude) / root.scale(2.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::leakage::testing::leakage;

    /// n50 2.2, exponent 0.65, one storey, class 3, 20 K and 4 m/s: `2.2 0.08^0.65 10 sqrt(0.15) sqrt(0.0029 + 0.002784) = 0.12438 1/h`.
    #[test]
    fn stack_and_wind_by_hand() {
        let numbers = [("n50", 2.2), ("exponent", 0.65), ("stack", 0.000_145), ("wind", 0.000_174)];
        let (constant, law) = leakage("stack_wind", &numbers);
        let law = law.unwrap();
        let expected = 2.2 * Real::powf(0.08, 0.65) * 10.0 * 0.15_f64.sqrt() * 0.005_684_f64.sqrt();
        assert_eq!(constant, None);
        assert!(
            (law.air_changes(4.0, -20.0) / expected - 1.0).abs() < 1e-6,
            "{}",
            law.air_changes(4.0, -20.0)
        );
        assert!((expected - 0.1244).abs() < 1e-4, "{expected}");
        let heat = |air: f64| law.heat(3600.0, 4.0, 0.0, air);
        let difference = (heat(20.0 - 1e-4).at(-20.0 + 1e-4) - heat(20.0 + 1e-4).at(-20.0 - 1e-4)) / 2e-4;
        assert!((heat(20.0).slope / difference - 1.0).abs() < 1e-6);
    }
}
