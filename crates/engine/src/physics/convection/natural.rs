//! Terms of natural convection that several correlations are made of.

use crate::number::real::{Mask, Real};

/// Temperature differences below this [K] are rounded off: `|d|^(1/3)` has an infinite slope at zero.
pub(crate) const ROUND_OFF: f64 = 0.01;
/// A surface is treated as horizontal when its normal lies within 45 deg of the vertical.
pub(crate) const HORIZONTAL: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// A temperature difference and what the correlations need of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Difference<V> {
    /// `d = T_surface - T_air` [K].
    pub(crate) d: V,
    /// `d^2` [K2].
    pub(crate) square: V,
    /// `d^2 + r^2` with a small r [K2].
    pub(crate) rounded: V,
}

impl<V: Real> Difference<V> {
    #[inline(always)]
    pub(crate) fn new(d: V) -> Self {
        let square = d * d;
        Self { d, square, rounded: square + V::constant(ROUND_OFF * ROUND_OFF) }
    }

    /// Where buoyancy moves the air away from the surface: warm and facing up, or cold and facing down. Heat flows up there.
    #[inline(always)]
    pub(crate) fn unstable(&self, upward: V) -> V::Mask {
        V::zero().lt(self.d * upward)
    }
}

/// A surface heat transfer coefficient h and `d dh/dd` [W/(m2 K)].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coefficient<V> {
    pub(crate) value: V,
    pub(crate) rise: V,
}

impl<V: Real> Coefficient<V> {
    /// A coefficient that does not depend on temperature.
    #[inline(always)]
    pub(crate) fn fixed(value: V) -> Self {
        Self { value, rise: V::zero() }
    }

    /// Another one where the mask is true.
    #[inline(always)]
    pub(crate) fn or(self, mask: V::Mask, other: Self) -> Self {
        Self { value: V::select(mask, other.value, self.value), rise: V::select(mask, other.rise, self.rise) }
    }
}

/// `gain |d|^1/3`.
#[inline(always)]
pub(crate) fn cube_root<V: Real>(gain: V, at: &Difference<V>) -> Coefficient<V> {
    let inverse = at.rounded.inverse_cbrt();
    // x^(1/6) = sqrt(x y^2) with y = x^(-1/3); 1/x = y^3.
    let value = gain * (at.rounded * inverse * inverse).sqrt();
    let share = at.square * (inverse * inverse * inverse);
    Coefficient { value, rise: (value * share).scale(1.0 / 3.0) }
}

/// `gain |d|^exponent`.
#[inline(always)]
pub(crate) fn any_power<V: Real>(gain: V, exponent: V, at: &Difference<V>) -> Coefficient<V> {
    let value = gain * (exponent.scale(0.5) * at.rounded.ln()).exp();
    Coefficient { value, rise: exponent * value * (at.square / at.rounded) }
}

/// `(laminar |d|^3/2 + turbulent d^2)^1/6`: the sixth root of the sum of the sixth powers of `l |d|^1/4` and `t |d|^1/3`,
/// with `laminar = l^6` and `turbulent = t^6` (Churchill & Usagi 1972, doi:10.1002/aic.690180606).
#[inline(always)]
pub(crate) fn blend<V: Real>(laminar: V, turbulent: V, at: &Difference<V>) -> Coefficient<V> {
    let magnitude = at.rounded.sqrt();
    let laminar = laminar * (magnitude * magnitude.sqrt());
    let turbulent = turbulent * at.rounded;
    let sum = laminar + turbulent;
    let inverse = sum.inverse_cbrt();
    let value = (sum * inverse * inverse).sqrt();
    let share = at.square / at.rounded;
    let slope = (laminar.scale(0.25) + turbulent.scale(1.0 / 3.0)) * (inverse * inverse * inverse);
    Coefficient { value, rise: value * share * slope }
}

/// Sixth power, by products: the compiler may round `powi` of a constant otherwise in lanes than in scalars.
pub(crate) fn sixth_power<V: Real>(x: V) -> V {
    let cube = x * x * x;
    cube * cube
}

/// `gain |d|^1/5` where the mask is true, else what is given.
#[inline(always)]
pub(crate) fn fifth_root_where<V: Real>(
    mask: V::Mask,
    gain: V,
    otherwise: Coefficient<V>,
    at: &Difference<V>,
) -> Coefficient<V> {
    if !mask.any() {
        return otherwise;
    }
    otherwise.or(mask, any_power(gain, V::constant(0.2), at))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each term at 8 K and its `d dh/dd`, an exponent times the term: `2 8^1/3 = 4`, `3 8^0.2 = 4.54715`,
    /// `(8^3/2 + 8^2)^1/6 = 2.10350`.
    #[test]
    fn terms_by_hand() {
        let at = Difference::new(8.0);
        let close = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < 1e-5, "{found} is not {expected}");
        };
        let root = cube_root(2.0, &at);
        close(root.value, 4.0);
        close(root.rise, 4.0 / 3.0);
        let fifth = any_power(3.0, 0.2, &at);
        close(fifth.value, 4.547_15);
        close(fifth.rise, 0.2 * 4.547_15);
        let both = blend(1.0, 1.0, &at);
        close(both.value, 2.103_50);
        // (3/2 8^3/2 + 2 8^2)/6 over the sum.
        close(both.rise, 2.103_50 * (1.5 * 22.627_417 + 128.0) / (6.0 * 86.627_417));
        // At zero the coefficient keeps a finite slope.
        assert!(cube_root(2.0, &Difference::new(0.0)).rise == 0.0);
    }
}
