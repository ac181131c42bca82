//! Members of an ensemble in an array, one in each lane.

use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use crate::number::elementary::double::logistic;
use crate::number::elementary::{Bits, cos, sin};
use crate::number::macros::{add_assign, elementary_functions};
use crate::number::real::{Logistic, Mask, Real};

/// `N` members.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Lanes<const N: usize>(pub [f64; N]);

/// Truth of `N` members.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LaneMask<const N: usize>([bool; N]);

impl<const N: usize> Lanes<N> {
    /// The first numbers of a slice.
    #[inline(always)]
    pub fn of(numbers: &[f64]) -> Self {
        Self(core::array::from_fn(|lane| numbers[lane]))
    }
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(core::array::from_fn(|i| f(self.0[i])))
    }
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(core::array::from_fn(|i| f(self.0[i], other.0[i])))
    }
}

macro_rules! arithmetic {
    ($($operator:ident $method:ident $symbol:tt;)*) => {$(
        impl<const N: usize> $operator for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $symbol b)
            }
        }
    )*};
}
arithmetic! { Add add +; Sub sub -; Mul mul *; Div div /; }
impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}
add_assign!([const N: usize] Lanes<N>);

macro_rules! logic {
    ($($operator:ident $method:ident $symbol:tt;)*) => {$(
        impl<const N: usize> $operator for LaneMask<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(core::array::from_fn(|i| self.0[i] $symbol other.0[i]))
            }
        }
    )*};
}
logic! { BitAnd bitand &; BitOr bitor |; }
impl<const N: usize> Not for LaneMask<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(core::array::from_fn(|i| !self.0[i]))
    }
}
impl<const N: usize> Mask for LaneMask<N> {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Self([value; N])
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().any(|&lane| lane)
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> bool {
        self.0[lane]
    }
}

impl<const N: usize> Real for Lanes<N> {
    type Mask = LaneMask<N>;
    type Equations = ();
    const LANES: usize = N;
    const DERIVATIVES: bool = false;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self([value; N])
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.0[lane]
    }
    #[inline(always)]
    fn of_lanes(number: impl Fn(usize) -> f64) -> Self {
        Self(core::array::from_fn(number))
    }
    #[inline(always)]
    fn look_up<const K: usize>(self, find: impl Fn(f64) -> [f64; K]) -> [Self; K] {
        let found = self.0.map(find);
        core::array::from_fn(|k| Self(core::array::from_fn(|lane| found[lane][k])))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    // One copy only: inlining multiplies compile time.
    elementary_functions!(never double: exp, ln, inverse_cbrt);
    #[inline(always)]
    fn logistic(self) -> Logistic<Self> {
        logistic(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }
    #[inline(always)]
    fn sin(self) -> Self {
        self.map(sin)
    }
    #[inline(always)]
    fn cos(self) -> Self {
        self.map(cos)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> LaneMask<N> {
        LaneMask(core::array::from_fn(|i| self.0[i] < other.0[i]))
    }
    #[inline(always)]
    fn select(mask: LaneMask<N>, yes: Self, no: Self) -> Self {
        Self(core::array::from_fn(|i| if mask.0[i] { yes.0[i] } else { no.0[i] }))
    }
}

impl<const N: usize> Bits for Lanes<N> {
    #[inline(always)]
    fn power_of_two(shifted: Self) -> Self {
        shifted.map(f64::power_of_two)
    }
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        (self.map(|x| x.split().0), self.map(|x| x.split().1))
    }
    #[inline(always)]
    fn inverse_cbrt_guess(self) -> Self {
        self.map(f64::inverse_cbrt_guess)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_give_the_bits_of_the_scalar() {
        let x = Lanes([0.1, 1.7, 23.4, 350.0]);
        for lane in 0..4 {
            let s = x.0[lane];
            assert_eq!(Real::exp(x).0[lane].to_bits(), Real::exp(s).to_bits());
            assert_eq!(Real::ln(x).0[lane].to_bits(), Real::ln(s).to_bits());
            assert_eq!(Real::cbrt(x).0[lane].to_bits(), Real::cbrt(s).to_bits());
            let logistic = [Real::logistic(x).rise, Real::logistic(x).rest, Real::logistic(x).tail];
            let alone = [s.logistic().rise, s.logistic().rest, s.logistic().tail];
            assert_eq!(logistic.map(|part| part.0[lane].to_bits()), alone.map(f64::to_bits));
            assert_eq!(x.powf(Lanes([0.89; 4])).0[lane].to_bits(), Real::powf(s, 0.89).to_bits());
            assert_eq!((x / (x + x * x)).0[lane].to_bits(), (s / (s + s * s)).to_bits());
        }
    }
}
