//! What surrounds the surfaces of zones: laws of convection that depend on the air of a zone and on the air that moves in it.

use crate::building::coefficients::Coefficients;
use crate::number::real::{Mask, Real};
use crate::physics::convection::{Surroundings, Wind, WindTerms};
use crate::weather::conditions::Conditions;
use crate::weather::index::WeatherIndex;

impl<S: Real> Conditions<S> {
    /// Laws of convection in zones that depend on their air, by the airs at the start of a step [degC].
    ///
    /// Within a step they do not change with it: the coefficient is that of a slowly changing air, and the balances stay those of a
    /// coefficient that depends on a temperature difference.
    #[inline(always)]
    pub(crate) fn surround(
        &mut self,
        coefficients: &Coefficients<S>,
        weather_index: &WeatherIndex<S>,
        airs: &[S],
    ) {
        if !weather_index.surrounded_in_zones.is_empty() {
            self.surround_in_zones(coefficients, weather_index, airs);
        }
    }

    /// Air that fans bring into a zone or move within it [1/h].
    fn moved_air(&self, coefficients: &Coefficients<S>, zone: usize) -> S {
        let mixing = self.zones[zone].mixing();
        let Some(fans) = self.mechanical_air.zones.get(zone) else { return mixing };
        mixing + (fans.fresh + fans.from_zones).scale(3600.0) / coefficients.zones[zone].air_capacity
    }

    /// All air that flows into a zone or moves within it, at a temperature of its air [1/h].
    pub(crate) fn total_air_changes(&self, coefficients: &Coefficients<S>, zone: usize, air: S) -> S {
        let numbers = &coefficients.zones[zone];
        let rate = self.zones[zone].air_changes(numbers, self.wind, self.outdoor_air, air);
        rate + self.moved_air(coefficients, zone)
    }

    // One copy only: few buildings have such laws.
    #[inline(never)]
    fn surround_in_zones(
        &mut self,
        coefficients: &Coefficients<S>,
        weather_index: &WeatherIndex<S>,
        airs: &[S],
    ) {
        let calm = Wind::new(0.0, WindTerms::default());
        for &(surface, zone, needs_air_change) in &weather_index.surrounded_in_zones {
            let mut around = Surroundings { air: airs[zone], ..Surroundings::calm() };
            if needs_air_change {
                let numbers = &coefficients.zones[zone];
                around.air_change =
                    self.zones[zone].air_changes(numbers, self.wind, self.outdoor_air, airs[zone]);
                around.total_air_change = around.air_change + self.moved_air(coefficients, zone);
            }
            if let Some(law) = &coefficients.surfaces[surface].convection {
                self.surfaces[surface].forced = law.driven(&calm, S::Mask::splat(true), &around);
            }
        }
    }
}
