//! Heat balances of surfaces as straight lines.

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

/// A surface outside the zones: held at a temperature, or gaining `offset - slope T`.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ExteriorBalance<S> {
    Fixed(S),
    Gain(Line<S>),
}

impl<S: Real> ExteriorBalance<S> {
    /// Gains of the surface's own temperature and the other one's, and the right-hand side.
    #[inline(always)]
    pub(crate) fn equation(self, e: usize, source: [S; 2], response: [[S; 2]; 2]) -> ([S; 2], S) {
        match self {
            Self::Fixed(value) => ([S::one(), S::zero()], value),
            Self::Gain(gain) => ([gain.slope - response[e][e], -response[e][1 - e]], source[e] + gain.offset),
        }
    }
}

/// The local surfaces of a wall after its elimination.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ExteriorSurfaces<S> {
    None,
    /// Its temperature as a function of the other surface's.
    One {
        side: usize,
        line: Line<S>,
    },
    Both([S; 2]),
}

/// Both surfaces of a wall that touches no zone.
#[inline(always)]
pub(crate) fn solve_pair<S: Real>(
    outer: ExteriorBalance<S>,
    inner: ExteriorBalance<S>,
    source: [S; 2],
    response: [[S; 2]; 2],
) -> [S; 2] {
    let ([a, b], f) = outer.equation(0, source, response);
    let ([d, c], g) = inner.equation(1, source, response);
    let determinant = a * d - b * c;
    [(f * d - b * g) / determinant, (a * g - c * f) / determinant]
}
