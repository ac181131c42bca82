//! Constant infiltration, `factor n50`.
//!
//! Source: EN ISO 13789:2017, annex C, with a factor by shielding and exposed sides.

use crate::physics::leakage::prelude::*;

const SOURCE: &str = "EN ISO 13789:2017 (air changes of infiltration from n50)";

const FACTOR: LawParameter = LawParameter::new(
    "factor",
    "-",
    "Air changes of infiltration over those at 50 Pa",
    LawRange::Span(0.01, 0.10, "one facade exposed with heavy shielding, to several without shielding"),
    0.07,
)
.at_most(1.0)
.default(Default::Assumed(0.07, SOURCE));

/// `factor n50`.
#[derive(Debug, Clone)]
pub(crate) struct Factor<S> {
    product: S,
}

impl<S: Real> LeakageLaw<S> for Factor<S> {
    const ROW: LawRow = LawRow::new("a factor of n50", "Constant infiltration: ``factor n50``.", "means over months")
        .details(
            "The factor depends on shielding: with several exposed facades 0.10 without, 0.07 with moderate and 0.04 with heavy \
             shielding, with one 0.03, 0.02 and 0.01.",
        )
        .source(SOURCE)
        .numbers(&[N50, FACTOR]);

    fn new(number: &Numbers<'_, S>) -> Self {
        Self { product: number.of("n50") * number.of("factor") }
    }

    fn constant(&self) -> Option<S> {
        Some(self.product)
    }

    #[inline(always)]
    fn rate(&self, _wind: S, _difference: S) -> (S, S) {
        (self.product, S::zero())
    }
}

#[cfg(test)]
mod tests {
    use crate::physics::leakage::testing::leakage;

    #[test]
    fn a_factor_by_hand() {
        assert_eq!(leakage("factor", &[("n50", 2.0), ("factor", 0.07)]).0, Some(0.14));
    }
}
