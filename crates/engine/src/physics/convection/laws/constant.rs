//! A constant surface heat transfer coefficient, also one that includes long-wave radiation.

use crate::physics::convection::prelude::*;

/// One number.
#[derive(Debug, Clone)]
pub(crate) struct Constant<S> {
    /// [W/(m2 K)].
    pub(crate) coefficient: S,
}

impl<S: Real> NamedLaw<S> for Constant<S> {
    const ROW: LawRow =
        LawRow::new("constant", "A constant surface heat transfer coefficient.", "where it was found")
            .numbers(&[coefficient("coefficient", 8.0)]);

    fn new(number: &Numbers<'_, S>, _surface: &Placement<S>) -> Self {
        Self { coefficient: number.of("coefficient") }
    }
}

impl<S> Correlation<S> for Constant<S> {
    type Of<T> = Constant<T>;

    #[inline(always)]
    fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> Constant<T> {
        Constant { coefficient: change(&self.coefficient) }
    }

    #[inline(always)]
    fn coefficient<V: Real>(
        &self,
        number: &impl Fn(&S) -> V,
        _upward: &S,
        _at: &Difference<V>,
        _forced: &Forced<V>,
    ) -> Coefficient<V> {
        Coefficient::fixed(number(&self.coefficient))
    }
}

impl<S: Real> WindPart<S> for Constant<S> {
    const LINEAR: bool = true;

    fn fixed(&self) -> Option<S> {
        Some(self.coefficient)
    }
}

#[cfg(test)]
mod tests {
    use crate::input::description::Convection;
    use crate::physics::convection::testing::{assert_close, coefficient, id, surface};

    #[test]
    fn one_number() {
        let law = surface(&Convection::law("constant", &[("coefficient", id(0))]), &[7.7], 1.0);
        assert_close(coefficient(&law, 5.0, 3.0, true), 7.7);
        assert_eq!(law.constant(), Some(7.7));
        assert!(law.straight() && !law.windy());
    }
}
