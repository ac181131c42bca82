//! Limits of recorded quantities, and where they are read.

use crate::building::ids::SurfaceId;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::run::outputs::Output;

/// What rounding may add to a quantity beyond its limits, in its unit.
const FRACTION: ByPrecision = ByPrecision { double: 1e-9, single: 1e-3 };

impl Output {
    /// What it is, in a word, for messages.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::LiquidFraction { .. } => "a liquid fraction",
            Self::VentOpen { .. } => "an open fraction",
            Self::SolarTransmittance { .. } => "a solar transmittance",
            Self::HumidityRatio { .. } => "a humidity ratio",
            Self::RelativeHumidity { .. } | Self::SurfaceHumidity { .. } => "a relative humidity",
            Self::AirChanges { .. } => "air changes",
            Self::Convection { .. } => "a heat transfer coefficient",
            Self::LatentCooling { .. } | Self::LatentHeating { .. } => "a latent load",
            _ => "an output",
        }
    }

    /// Name of the zone, surface, layer or opening that it is read at, for messages.
    #[must_use]
    pub fn place(&self, plan: &Plan) -> String {
        let description = &plan.description;
        match *self {
            Self::LiquidFraction { surface, layer } => {
                plan.cell_name(surface, plan.walls[surface].layer_cells[layer].0)
            }
            Self::SurfaceHumidity { surface, side } | Self::Convection { surface, side } => {
                plan.surface_name(SurfaceId::new(surface, side))
            }
            Self::SolarTransmittance { surface } => plan.surface_name(SurfaceId::outside(surface)),
            Self::VentOpen { vent } => format!("vent {}", description.vents[vent].name),
            Self::HumidityRatio { zone }
            | Self::RelativeHumidity { zone }
            | Self::AirChanges { zone }
            | Self::LatentCooling { zone }
            | Self::LatentHeating { zone } => format!("zone {}", description.zones[zone].name),
            _ => "the building".to_owned(),
        }
    }

    /// Least and largest value that it can have [its unit]; none where any number is possible.
    #[must_use]
    pub fn limits(&self) -> Option<[f64; 2]> {
        match self {
            Self::LiquidFraction { .. } | Self::VentOpen { .. } | Self::SolarTransmittance { .. } => {
                Some([0.0, 1.0])
            }
            Self::HumidityRatio { .. }
            | Self::RelativeHumidity { .. }
            | Self::SurfaceHumidity { .. }
            | Self::AirChanges { .. }
            | Self::Convection { .. }
            | Self::LatentCooling { .. }
            | Self::LatentHeating { .. } => Some([0.0, f64::INFINITY]),
            _ => None,
        }
    }
}

/// Lanes where one of the values of some outputs is beyond its limits.
#[inline(always)]
pub(crate) fn beyond_limits<S: Real>(outputs: &[Output], values: &[S]) -> S::Mask {
    let (mut beyond, slack) = (S::Mask::splat(false), FRACTION.of::<S>());
    for (output, &value) in outputs.iter().zip(values) {
        if let Some([least, most]) = output.limits() {
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
        if let Some([least, most]) = output.limits()
            && beyond_limits(core::slice::from_ref(output), &[*value])
        {
            let expected =
                if most.is_finite() { format!("{least} to {most}") } else { format!("none below {least}") };
            let what = format!("{} of {value:.9}, expected {expected}", output.name());
            return Err(EngineError::Impossible { step, place: output.place(plan), what });
        }
    }
    Ok(())
}
