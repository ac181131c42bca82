//! Heat balances of faces as straight lines.

use crate::real::Real;

/// A straight line `offset + slope T`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line<S> {
    pub(crate) offset: S,
    pub(crate) slope: S,
}

impl<S: Real> Line<S> {
    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self { offset: S::zero(), slope: S::zero() }
    }
    /// The tangent of a function with a value and a slope at a point. What derivatives do to the slope does not matter:
    /// it counts only away from that point, where no solution lies.
    #[inline(always)]
    pub(crate) fn tangent(value: S, slope: S, at: S) -> Self {
        let slope = slope.fixed();
        Self { offset: value - slope * at, slope }
    }
    #[inline(always)]
    pub(crate) fn at(&self, x: S) -> S {
        self.offset + self.slope * x
    }
}

impl Line<f64> {
    /// The values of another line.
    #[inline(always)]
    pub(crate) fn of<S: Real>(other: &Line<S>) -> Self {
        Self { offset: other.offset.lane(0), slope: other.slope.lane(0) }
    }
}

/// The linearised laws of a face in one Newton iteration [W/m2].
#[derive(Debug, Clone, Copy)]
pub(crate) struct FaceLaws<S> {
    /// Convection off the face, of `T_face - T_air`.
    pub(crate) film: Line<S>,
    /// Black emission, of `T_face`.
    pub(crate) emission: Line<S>,
}

/// A face outside the zones: held at a temperature, or gaining `offset - slope T`.
#[derive(Debug, Clone, Copy)]
pub(crate) enum LocalBalance<S> {
    Fixed(S),
    Gain(Line<S>),
}

impl<S: Real> LocalBalance<S> {
    /// Gains of the face's own temperature and the other one's, and the right-hand side.
    #[inline(always)]
    pub(crate) fn equation(self, e: usize, source: [S; 2], response: [[S; 2]; 2]) -> ([S; 2], S) {
        match self {
            Self::Fixed(value) => ([S::one(), S::zero()], value),
            Self::Gain(gain) => ([gain.slope - response[e][e], -response[e][1 - e]], source[e] + gain.offset),
        }
    }
}

/// The local faces of a wall after its elimination.
#[derive(Debug, Clone, Copy)]
pub(crate) enum LocalFaces<S> {
    None,
    /// Its temperature as a function of the other face's.
    One {
        side: usize,
        line: Line<S>,
    },
    Both([S; 2]),
}

/// Both faces of a wall that touches no zone.
#[inline(always)]
pub(crate) fn solve_pair<S: Real>(
    outer: LocalBalance<S>,
    inner: LocalBalance<S>,
    source: [S; 2],
    response: [[S; 2]; 2],
) -> [S; 2] {
    let ([a, b], f) = outer.equation(0, source, response);
    let ([d, c], g) = inner.equation(1, source, response);
    let determinant = a * d - b * c;
    [(f * d - b * g) / determinant, (a * g - c * f) / determinant]
}
