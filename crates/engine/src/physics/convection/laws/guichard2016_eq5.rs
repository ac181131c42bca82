//! Equation 5 of the paper on the LGI cell, as printed.
//!
//! Source: Guichard et al. (2016), Energies 9, 9, doi:10.3390/en9010009:
//! `{[1.51 d^1/4/H]^6 + [1.33 d^1/3]^6}^1/6`. It is a misprint of Alamdari & Hammond's correlation for a horizontal surface and
//! is kept under its own name, so that results of the paper can be compared. It makes no difference between heat that flows up
//! and heat that flows down.

use crate::physics::convection::prelude::*;

/// `factor (laminar |d|^3/2 + turbulent d^2)^1/6`.
#[derive(Debug, Clone)]
pub(crate) struct Guichard2016Eq5<S> {
    factor: S,
    laminar: S,
    turbulent: S,
}

impl<S: Real> NamedLaw<S> for Guichard2016Eq5<S> {
    const ROW: LawRow = LawRow::new(
        "Alamdari and Hammond as printed in Guichard et al. 2016, eq. 5",
        "Equation 5 of Guichard et al. 2016 as printed.",
        "comparisons with the paper",
    )
    .source("Guichard et al. 2016, doi:10.3390/en9010009, eq. 5 as printed")
    .numbers(&[LENGTH, FACTOR])
    .tilt(Tilt::Cases);

    fn new(number: &Numbers<'_, S>, _surface: &Placement<S>) -> Self {
        let (length, factor) = (number.of("length"), number.of("factor"));
        let laminar = S::constant(sixth_power(1.51)) / sixth_power(length);
        Self { factor, laminar, turbulent: S::constant(sixth_power(1.33)) }
    }
}

impl<S> Correlation<S> for Guichard2016Eq5<S> {
    type Of<T> = Guichard2016Eq5<T>;

    #[inline(always)]
    fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> Guichard2016Eq5<T> {
        let Self { factor, laminar, turbulent } = self;
        Guichard2016Eq5 { factor: change(factor), laminar: change(laminar), turbulent: change(turbulent) }
    }

    #[inline(always)]
    fn coefficient<V: Real>(
        &self,
        number: &impl Fn(&S) -> V,
        _upward: &S,
        at: &Difference<V>,
        _forced: &Forced<V>,
    ) -> Coefficient<V> {
        let natural = blend(number(&self.laminar), number(&self.turbulent), at);
        let factor = number(&self.factor);
        Coefficient { value: factor * natural.value, rise: factor * natural.rise }
    }
}

impl<S: Real> WindPart<S> for Guichard2016Eq5<S> {}

#[cfg(test)]
mod tests {
    use crate::input::description::Convection;
    use crate::physics::convection::testing::{assert_close, coefficient, id, surface};

    #[test]
    fn by_hand() {
        let law = Convection::law("guichard2016_eq5", &[("length", id(0)), ("factor", id(1))]);
        // 5 K, 0.28 m: the first term 1.51 5^.25 / 0.28 = 8.06419 is much larger than 1.33 5^(1/3) = 2.27427
        assert_close(coefficient(&surface(&law, &[0.28, 1.0], 1.0), 5.0, 0.0, false), 8.064_9);
    }
}
