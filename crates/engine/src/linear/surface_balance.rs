//! Heat balances of single surfaces, all laws as straight lines, and the elimination of exterior surfaces.
//!
//! An exterior surface is in no zone. A wall sends heat `source_e + sum_o response_eo T_o` into its surface e ([`Response`]); what acts on the
//! surface from outside is `offset - slope T`. The balance of an exterior surface therefore has two unknowns, the surfaces of its
//! wall, and is solved before all others: for its own temperature as a line of the other one's, or for both.

use crate::linear::wall::Response;
use crate::number::line::Line;
use crate::number::real::Real;

/// The linearised laws of a surface in one Newton iteration [W/m2].
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurfaceLaws<S> {
    /// Convection off the surface, of `T_surface - T_air`.
    pub(crate) convection: Line<S>,
    /// Black emission, of `T_surface`.
    pub(crate) emission: Line<S>,
}

/// What acts on an exterior surface from outside.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ExteriorBalance<S> {
    /// It is held at a temperature [degC].
    Fixed(S),
    /// Heat `offset - slope T` [W/m2].
    Gain(Line<S>),
}

impl<S: Real> ExteriorBalance<S> {
    /// The balance of surface e as an equation: coefficients of its own temperature and of the other surface's, and the
    /// right-hand side.
    #[inline(always)]
    pub(crate) fn equation(self, e: usize, source: [S; 2], response: &Response<S>) -> ([S; 2], S) {
        match self {
            Self::Fixed(value) => ([S::one(), S::zero()], value),
            Self::Gain(gain) => ([gain.slope - response.own(e), -response.other(e)], source[e] + gain.offset),
        }
    }
}

/// The exterior surfaces of a wall after their elimination.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ExteriorSurfaces<S> {
    /// Both surfaces are in zones.
    None,
    /// One is exterior: its temperature as a line of the other surface's [degC].
    One { side: usize, line: Line<S> },
    /// Both are: their temperatures [degC].
    Both([S; 2]),
}

/// Temperatures of both surfaces of a wall that touches no zone, by Cramer's rule [degC].
#[inline(always)]
pub(crate) fn solve_pair<S: Real>(
    outer: ExteriorBalance<S>,
    inner: ExteriorBalance<S>,
    source: [S; 2],
    response: &Response<S>,
) -> [S; 2] {
    let ([a, b], f) = outer.equation(0, source, response);
    let ([d, c], g) = inner.equation(1, source, response);
    let determinant = determinant(outer, inner, response);
    [(f * d - b * g) / determinant, (a * g - c * f) / determinant]
}

/// Determinant of the equations of both surfaces of a wall that touches no zone: a sum of positive numbers, which keeps its
/// digits where the wall conducts far better than heat is exchanged at its surfaces.
#[inline(always)]
pub(crate) fn determinant<S: Real>(
    outer: ExteriorBalance<S>,
    inner: ExteriorBalance<S>,
    response: &Response<S>,
) -> S {
    match (outer, inner) {
        (ExteriorBalance::Gain(outer), ExteriorBalance::Gain(inner)) => {
            // Heat that leaves a surface and does not reach the other one.
            let [outside, inside] = [outer.slope + response.stored[0], inner.slope + response.stored[1]];
            outside * (inside + response.across[1]) + response.across[0] * inside
        }
        (ExteriorBalance::Fixed(_), ExteriorBalance::Gain(inner)) => inner.slope - response.own(1),
        (ExteriorBalance::Gain(outer), ExteriorBalance::Fixed(_)) => outer.slope - response.own(0),
        (ExteriorBalance::Fixed(_), ExteriorBalance::Fixed(_)) => S::one(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wall of one conductance [W/(m2 K)] without storage.
    fn response(conductance: f64) -> Response<f64> {
        Response { across: [conductance; 2], stored: [0.0; 2] }
    }

    /// Air on both sides: resistances in series.
    #[test]
    fn a_wall_between_two_airs_is_a_series_of_resistances() {
        // h (T_air - T) on both sides: 25 W/(m2 K) to -10 degC, 8 W/(m2 K) to 20 degC; the wall has 2 W/(m2 K).
        let outer = ExteriorBalance::Gain(Line { offset: 25.0 * -10.0, slope: 25.0 });
        let inner = ExteriorBalance::Gain(Line { offset: 8.0 * 20.0, slope: 8.0 });
        let flux = 30.0 / (1.0 / 25.0 + 1.0 / 2.0 + 1.0 / 8.0);
        let [outside, inside] = solve_pair(outer, inner, [0.0; 2], &response(2.0));
        assert!((outside - (-10.0 + flux / 25.0)).abs() < 1e-12, "{outside}");
        assert!((inside - (20.0 - flux / 8.0)).abs() < 1e-12, "{inside}");
    }

    /// A surface at a given temperature stays there; heat of 12 W/m2 on the other one warms it by 12/2 K.
    #[test]
    fn a_held_surface_stays_at_its_temperature() {
        let (held, heated) =
            (ExteriorBalance::Fixed(15.0), ExteriorBalance::Gain(Line { offset: 12.0, slope: 0.0 }));
        assert_eq!(solve_pair(held, heated, [40.0, 0.0], &response(2.0)), [15.0, 21.0]);
        assert_eq!(solve_pair(heated, held, [0.0, 40.0], &response(2.0)), [21.0, 15.0]);
        // Heat from the wall's storage counts like heat from outside.
        let adiabatic = ExteriorBalance::Gain(Line { offset: 0.0, slope: 0.0 });
        assert_eq!(solve_pair(held, adiabatic, [0.0, 12.0], &response(2.0)), [15.0, 21.0]);
    }
}
