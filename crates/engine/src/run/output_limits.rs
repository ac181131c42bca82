//! Limits of recorded quantities, and where they are read.

use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::run::outputs::Output;

/// What rounding may add to a quantity beyond its limits, in its unit.
const FRACTION: ByPrecision = ByPrecision { double: 1e-9, single: 1e-3 };

/// Lanes where one of the values of some outputs is beyond its limits.
#[inline(always)]
pub(crate) fn beyond_limits<S: Real>(outputs: &[Output], values: &[S]) -> S::Mask {
    let (mut beyond, slack) = (S::Mask::splat(false), FRACTION.of::<S>());
    for (output, &value) in outputs.iter().zip(values) {
        let [least, most] = output.row().limits;
        if least > f64::NEG_INFINITY {
            beyond = beyond | value.lt(S::constant(least - slack)) | S::constant(most + slack).lt(value);
        }
    }
    beyond
}

/// As [`beyond_limits`] in a run of one member, with an error that names the first of them.
///
/// # Errors
/// [`EngineError::Impossible`].
pub(crate) fn require_limits(
    plan: &Plan,
    outputs: &[Output],
    values: &[f64],
    step: usize,
) -> Result<(), EngineError> {
    for (output, value) in outputs.iter().zip(values) {
        if beyond_limits(core::slice::from_ref(output), &[*value]) {
            let row = output.row();
            let [least, most] = row.limits;
            let expected =
                if most.is_finite() { format!("{least} to {most}") } else { format!("none below {least}") };
            let unit = if row.unit == "-" { String::new() } else { format!(" {}", row.unit) };
            let what = format!("a {} of {value:.9}{unit}, expected {expected}", row.label.to_lowercase());
            return Err(EngineError::Impossible { step, place: output.part(plan), what });
        }
    }
    Ok(())
}
