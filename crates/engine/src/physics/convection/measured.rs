//! A surface heat transfer coefficient that is measured, a forcing channel, or that a law of what a side is in contact with gives.
//!
//! The value is read with the weather of each stage (see [`WeatherIndex`](crate::weather::index::WeatherIndex)) and takes the
//! place of the part that depends on the wind.

use super::correlation::{Correlation, WindPart};
use super::natural::{Coefficient, Difference};
use super::wind::Forced;
use crate::input::forcing::CLIMATE_CHANNELS;
use crate::number::real::Real;

/// `factor h`, h measured or imposed.
#[derive(Debug, Clone)]
pub(super) struct Measured<S> {
    /// Of the forcing; none: imposed.
    pub(super) channel: Option<usize>,
    /// [-].
    pub(super) factor: S,
}

impl<S> Measured<S> {
    pub(super) fn new(channel: usize, factor: S) -> Self {
        Self { channel: Some(CLIMATE_CHANNELS + channel), factor }
    }

    /// That of a law of what a side is in contact with; `one`: the number.
    pub(super) fn imposed(one: S) -> Self {
        Self { channel: None, factor: one }
    }
}

impl<S> Correlation<S> for Measured<S> {
    type Of<T> = Measured<T>;

    #[inline(always)]
    fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> Measured<T> {
        Measured { channel: self.channel, factor: change(&self.factor) }
    }

    #[inline(always)]
    fn coefficient<V: Real>(
        &self,
        _number: &impl Fn(&S) -> V,
        _upward: &S,
        _at: &Difference<V>,
        forced: &Forced<V>,
    ) -> Coefficient<V> {
        Coefficient::fixed(forced[0])
    }
}

impl<S: Real> WindPart<S> for Measured<S> {
    const LINEAR: bool = true;
}

#[cfg(test)]
mod tests {
    use crate::input::description::Convection;
    use crate::input::forcing::CLIMATE_CHANNELS;
    use crate::physics::convection::testing::{id, surface};

    /// 1.5 times a measured 4 W/(m2 K) at 2 K: 12 W/m2.
    #[test]
    fn by_hand() {
        let law = surface(&Convection::Measured { channel: 1, factor: id(0) }, &[1.5], 0.0);
        assert!(law.constant().is_none() && law.straight() && !law.windy());
        let (channel, factor) = law.measured().unwrap();
        assert_eq!(channel, CLIMATE_CHANNELS + 1);
        assert_eq!(law.flux(2.0, &[factor * 4.0; 4]).flux, 12.0);
    }
}
