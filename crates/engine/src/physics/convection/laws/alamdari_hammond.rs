//! Alamdari & Hammond: natural convection at indoor surfaces.
//!
//! Source: Alamdari & Hammond (1983), Build. Serv. Eng. Res. Technol. 4(3), 106-112, doi:10.1177/014362448300400304.
//!
//! - Vertical surface of height H: `{[1.5 (d/H)^1/4]^6 + [1.23 d^1/3]^6}^1/6`.
//! - Horizontal, heat flows up: the same with 1.4 and 1.63 and the length `D = 4 A/P` instead of H.
//! - Horizontal, heat flows down: `0.6 (d/D^2)^1/5`.
//!
//! Range: laminar to turbulent flow at the surfaces of rooms with still air. A surface counts as horizontal when its normal lies
//! within 45 deg of the vertical.

use crate::physics::convection::prelude::*;

/// `factor (laminar |d|^3/2 + turbulent d^2)^1/6`, but `factor stable |d|^1/5` where warm air lies on a horizontal surface.
#[derive(Debug, Clone)]
pub(crate) struct AlamdariHammond<S> {
    factor: S,
    laminar: S,
    turbulent: S,
    stable: S,
}

impl<S: Real> NamedLaw<S> for AlamdariHammond<S> {
    const ROW: LawRow = LawRow::new(
        "Alamdari and Hammond",
        "Buoyant convection by orientation and direction of heat flow (Alamdari & Hammond 1983).",
        "surfaces of rooms with still air",
    )
    .source("Alamdari & Hammond 1983, doi:10.1177/014362448300400304")
    .numbers(&[LENGTH, FACTOR])
    .tilt(Tilt::Cases)
    .alternatives(&[Alternative::INDOORS]);

    fn new(number: &Numbers<'_, S>, surface: &Placement<S>) -> Self {
        let (length, factor) = (number.of("length"), number.of("factor"));
        let horizontal = S::constant(HORIZONTAL).lt(surface.upward.abs());
        let choose = |plate: f64, wall: f64| {
            S::select(horizontal, S::constant(sixth_power(plate)), S::constant(sixth_power(wall)))
        };
        let stable = (length * length).powf(S::constant(-0.2)).scale(0.6);
        let laminar = choose(1.4, 1.5) / (length * length.sqrt());
        Self { factor, laminar, turbulent: choose(1.63, 1.23), stable }
    }
}

impl<S> Correlation<S> for AlamdariHammond<S> {
    type Of<T> = AlamdariHammond<T>;

    #[inline(always)]
    fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> AlamdariHammond<T> {
        let Self { factor, laminar, turbulent, stable } = self;
        AlamdariHammond {
            factor: change(factor),
            laminar: change(laminar),
            turbulent: change(turbulent),
            stable: change(stable),
        }
    }

    #[inline(always)]
    fn coefficient<V: Real>(
        &self,
        number: &impl Fn(&S) -> V,
        upward: &S,
        at: &Difference<V>,
        _forced: &Forced<V>,
    ) -> Coefficient<V> {
        let natural = blend(number(&self.laminar), number(&self.turbulent), at);
        let horizontal = V::constant(HORIZONTAL).lt(number(upward).abs());
        let stable = horizontal & !at.unstable(number(upward));
        let natural = fifth_root_where(stable, number(&self.stable), natural, at);
        let factor = number(&self.factor);
        Coefficient { value: factor * natural.value, rise: factor * natural.rise }
    }
}

impl<S: Real> WindPart<S> for AlamdariHammond<S> {}

#[cfg(test)]
mod tests {
    use crate::input::description::Convection;
    use crate::physics::convection::testing::{assert_close, coefficient, id, surface};

    #[test]
    fn by_hand() {
        let law = Convection::law("alamdari_hammond", &[("length", id(0)), ("factor", id(1))]);
        // 5 K, 3 m: laminar 1.5 (5/3)^.25 = 1.70434, turbulent 1.23 5^(1/3) = 2.10327
        assert_close(coefficient(&surface(&law, &[3.0, 1.0], 0.0), 5.0, 0.0, false), 2.192_50);
        // Stable over a 3 m plate at 5 K: 0.6 (5/9)^0.2 = 0.53345
        assert_close(coefficient(&surface(&law, &[3.0, 1.0], 1.0), -5.0, 0.0, false), 0.533_45);
        // Unstable: 1.4 (5/3)^.25 = 1.59071, 1.63 5^(1/3) = 2.78726
        assert_close(coefficient(&surface(&law, &[3.0, 1.0], 1.0), 5.0, 0.0, false), 2.803_09);
        // The factor multiplies all of them.
        assert_close(coefficient(&surface(&law, &[3.0, 1.2], 1.0), -5.0, 0.0, false), 1.2 * 0.533_45);
    }
}
