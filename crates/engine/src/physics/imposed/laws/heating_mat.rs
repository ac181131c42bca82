//! An electric heating mat behind the side, controlled by the outdoor air: `power (limit - T_o)/span`, from nothing to all of it.
//!
//! Range: insulated behind the mat; the control follows the outdoor air alone.

use crate::physics::imposed::prelude::*;

const POWER: LawParameter = LawParameter::new(
    "power",
    "W/m2",
    "Power of the mat where the outdoor air is the span below the limit",
    LawRange::Percent(5.0, "name plate"),
    100.0,
)
.at_most(10_000.0);

const SPAN: LawParameter = LawParameter::new(
    "span",
    "K",
    "How far below the limit the outdoor air is when the mat has all of its power",
    LawRange::Within(5.0, "set by hand"),
    25.0,
)
.positive();

/// `power (limit - T_o)/span`.
#[derive(Debug, Clone)]
pub(crate) struct HeatingMat<S> {
    power: S,
    limit: S,
    per_span: S,
}

impl<S: Real> ImposedLaw<S> for HeatingMat<S> {
    const ROW: LawRow = LawRow::new(
        "heating mat",
        "An electric heating mat behind the side, insulated behind, controlled by the outdoor air.",
        "no heat flows from the mat to what is behind it",
    )
    .gives_heat()
    .gives_coefficient()
    .numbers(&[POWER, HEATING_LIMIT, SPAN]);

    fn new(number: &Numbers<'_, S>) -> Self {
        let per_span = S::one() / number.of("span");
        Self { power: number.of("power"), limit: number.of("limit"), per_span }
    }

    /// That of the outdoor air: nothing acts through a coefficient of zero.
    #[inline(always)]
    fn temperature(&self, at: &ImposedWeather) -> S {
        S::constant(at.outdoor_air)
    }

    fn heat(&self, at: &ImposedWeather) -> S {
        let share = (self.limit - S::constant(at.outdoor_air)) * self.per_span;
        self.power * share.max(S::zero()).min(S::one())
    }
}

#[cfg(test)]
mod tests {
    use crate::physics::imposed::imposed_on;

    /// 100 W/m2 from 15 to -10 degC: 60 W/m2 at 0 degC, all at -20 degC, nothing at 20 degC.
    #[test]
    fn heating_mat_by_hand() {
        let numbers = [("power", 100.0), ("limit", 15.0), ("span", 25.0)];
        let heat = |outdoors: f64| imposed_on("heating_mat", &numbers, 1.0, outdoors).unwrap().1.unwrap();
        for (outdoors, expected) in [(0.0, 60.0), (-20.0, 100.0), (20.0, 0.0)] {
            assert!((heat(outdoors) - expected).abs() < 1e-12, "{}", heat(outdoors));
        }
    }
}
