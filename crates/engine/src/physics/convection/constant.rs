//! A constant surface heat transfer coefficient, also one that includes long-wave radiation.

use super::correlation::{Correlation, WindPart};
use super::natural::{Coefficient, Difference};
use super::wind::Forced;
use crate::number::real::Real;

/// One number.
#[derive(Debug, Clone)]
pub(super) struct Constant<S> {
    /// [W/(m2 K)].
    pub(super) coefficient: S,
}

impl<S> Constant<S> {
    pub(super) fn new(coefficient: S) -> Self {
        Self { coefficient }
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
}

#[cfg(test)]
mod tests {
    use crate::input::description::Convection;
    use crate::physics::convection::testing::{assert_close, coefficient, id, surface};

    #[test]
    fn one_number() {
        let law = surface(&Convection::Constant { coefficient: id(0) }, &[7.7], 1.0);
        assert_close(coefficient(&law, 5.0, 3.0, true), 7.7);
        assert_eq!(law.constant(), Some(7.7));
        assert!(law.straight() && !law.windy());
    }
}
