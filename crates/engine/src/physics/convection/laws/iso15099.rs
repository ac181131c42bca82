//! ISO 15099: natural convection at the indoor surface of a glazing.
//!
//! Source: ISO 15099:2003, 8.3.2.2. By the angle g from the horizontal, counted from where heat flows up, and the Rayleigh
//! number Ra of the height (of `length`), `h = Nu k/length`:
//!
//! - g below 15 deg: `Nu = 0.13 Ra^1/3`;
//! - 15 to 90 deg, both included: `0.56 (Ra sin g)^1/4`, above the critical `Rac = 2.5e5 (e^(0.72 g)/sin g)^1/5` (g in degrees)
//!   `0.13 (Ra^1/3 - Rac^1/3) + 0.56 (Rac sin g)^1/4`;
//! - 90 to 179 deg: `0.56 (Ra sin g)^1/4`; under a level plate `0.58 Ra^1/5`.
//!
//! Range: still room air. The properties are those of air at 20 degC and the site's density.

use crate::number::elementary::sin_of_degrees;
use crate::physics::constants::{AIR_SPECIFIC_HEAT, GRAVITY};
use crate::physics::convection::prelude::*;

/// Thermal conductivity [W/(m K)] and viscosity [Pa s] of air at 20 degC (ISO 15099:2003, annex B).
const INDOOR_AIR: [f64; 2] = [0.025_621, 1.820_5e-5];
/// 20 degC [K].
const INDOOR: f64 = 293.15;
/// A glazing is vertical above this inclination [deg].
const VERTICAL: f64 = 90.0 - 1e-6;

/// Where heat flows up and where it flows down.
#[derive(Debug, Clone)]
pub(crate) struct Iso15099<S>([Branch<S>; 2]);

/// `laminar |d|^1/4`, or `level |d|^1/5` where that is not zero; above a difference `turbulent |d|^1/3 + offset`.
#[derive(Debug, Clone, Copy)]
struct Branch<S> {
    laminar: S,
    level: S,
    turbulent: S,
    offset: S,
    /// Square of the difference where the flow turns turbulent [K2].
    limit: S,
}

impl<S> Branch<S> {
    #[inline(always)]
    fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> Branch<T> {
        let Self { laminar, level, turbulent, offset, limit } = self;
        Branch {
            laminar: change(laminar),
            level: change(level),
            turbulent: change(turbulent),
            offset: change(offset),
            limit: change(limit),
        }
    }
}

impl<S: Real> NamedLaw<S> for Iso15099<S> {
    const ROW: LawRow = LawRow::new(
        "ISO 15099",
        "Free convection on the room side of a glazing, by its height and tilt (ISO 15099:2003).",
        "still room air",
    )
    .source("ISO 15099:2003, 8.3.2.2: convection indoors")
    .numbers(&[LENGTH, FACTOR])
    .tilt(Tilt::Steady);

    fn new(number: &Numbers<'_, S>, surface: &Placement<S>) -> Self {
        let (length, factor) = (number.of("length"), number.of("factor"));
        let [conductivity, viscosity] = INDOOR_AIR;
        let degrees = surface.inclination;
        let sine = sin_of_degrees(degrees);
        let (level, flat) = (degrees.lt(S::constant(1.0)), degrees.lt(S::constant(15.0)));
        let heat = GRAVITY * AIR_SPECIFIC_HEAT / (INDOOR * viscosity * conductivity);
        // Ra over |d|, and h over the Nusselt number.
        let rayleigh = surface.density * surface.density * length * length * length.scale(heat);
        let per_nusselt = factor.scale(conductivity) / length;
        let quarter = |x: S| x.powf(S::constant(0.25));
        let third = |x: S| x.powf(S::constant(1.0 / 3.0));
        // The sine of a level plate is zero; its branch is not used there.
        let along = S::select(level, S::one(), sine);
        let laminar = per_nusselt.scale(0.56) * quarter(rayleigh * along);
        let turbulent = per_nusselt.scale(0.13) * third(rayleigh);
        let critical = degrees.scale(0.72 / 5.0).exp().scale(2.5e5) / along.powf(S::constant(0.2));
        let limit = critical / rayleigh;
        let offset = laminar * quarter(limit) - turbulent * third(limit);
        let up = Branch {
            laminar,
            level: S::zero(),
            turbulent,
            offset: S::select(flat, S::zero(), offset),
            limit: S::select(flat, -S::one(), limit * limit),
        };
        let plate = per_nusselt.scale(0.58) * rayleigh.powf(S::constant(0.2));
        // At the vertical itself the flow turns turbulent as well: 15 to 90 deg, 90 included.
        let vertical = S::constant(VERTICAL).lt(degrees);
        let limit = S::select(vertical, up.limit, S::constant(f64::MAX));
        let down = Branch { level: S::select(level, plate, S::zero()), limit, ..up };
        Self([up, down])
    }
}

impl<S> Correlation<S> for Iso15099<S> {
    type Of<T> = Iso15099<T>;

    #[inline(always)]
    fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> Iso15099<T> {
        let [up, down] = &self.0;
        Iso15099([up.map(&mut change), down.map(&mut change)])
    }

    #[inline(always)]
    fn coefficient<V: Real>(
        &self,
        number: &impl Fn(&S) -> V,
        upward: &S,
        at: &Difference<V>,
        _forced: &Forced<V>,
    ) -> Coefficient<V> {
        let unstable = at.unstable(number(upward));
        let [up, down] = [self.0[0].map(number), self.0[1].map(number)];
        branch(
            #[inline(always)]
            |of| V::select(unstable, of(&up), of(&down)),
            at,
        )
    }
}

/// The law whose numbers are chosen.
#[inline(always)]
fn branch<V: Real>(choose: impl Fn(fn(&Branch<V>) -> V) -> V, at: &Difference<V>) -> Coefficient<V> {
    // |d|^1/4 by roots: most glass is vertical and needs nothing else.
    let value = choose(|b| b.laminar) * at.rounded.sqrt().sqrt().sqrt();
    let mut natural = Coefficient { value, rise: value.scale(0.25) * (at.square / at.rounded) };
    let gain = choose(|b| b.level);
    let level = V::zero().lt(gain);
    if level.any() {
        natural = natural.or(level, any_power(gain, V::constant(0.2), at));
    }
    let turbulent = choose(|b| b.limit).lt(at.square);
    if turbulent.any() {
        let mut fast = cube_root(choose(|b| b.turbulent), at);
        fast.value += choose(|b| b.offset);
        natural = natural.or(turbulent, fast);
    }
    natural
}

impl<S: Real> WindPart<S> for Iso15099<S> {}

#[cfg(test)]
mod tests {
    use crate::input::description::Convection;
    use crate::number::real::Real;
    use crate::physics::convection::testing::{assert_close, coefficient, id, surface};

    /// In air of 1.2 kg/m3: Ra/(H^3 d) = 1.2^2 9.80665 1006 / (293.15 1.8205e-5 0.025621) = 1.03897e8 a K.
    #[test]
    fn by_hand() {
        let law = Convection::law("iso15099", &[("length", id(0)), ("factor", id(1))]);
        // Vertical, 2 m, 10 K: Nu = 0.56 (8.3117e9)^1/4.
        let vertical = surface(&law, &[2.0, 1.0], 0.0);
        assert_close(coefficient(&vertical, -10.0, 3.0, true), 2.166_10);
        assert_close(coefficient(&vertical, 10.0, 0.0, false), 2.166_10);
        // 1 m at 30 deg from the horizontal, cold above the zone: Rac = 2.5e5 (e^21.6/0.5)^1/5 is exceeded above 0.208 K.
        let sloped = surface(&law, &[1.0, 1.0], -Real::cos(30f64.to_radians()));
        assert_close(coefficient(&sloped, -10.0, 0.0, false), 3.268_40);
        assert_close(coefficient(&sloped, 10.0, 0.0, false), 2.166_10);
        // Level: 0.13 Ra^1/3 where heat flows up, 0.58 Ra^1/5 where it flows down.
        let level = surface(&law, &[1.0, 1.0], -1.0);
        assert_close(coefficient(&level, -10.0, 0.0, false), 3.373_45);
        assert_close(coefficient(&level, 10.0, 0.0, false), 0.944_811);
    }
}
