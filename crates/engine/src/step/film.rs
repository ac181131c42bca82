//! Convective heat transfer coefficients at temperatures.

use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::number::real::Real;
use crate::weather::conditions::Conditions;

/// Smaller temperature differences count as this [K].
const LEAST: f64 = 1e-3;

/// Convective heat transfer coefficient of a surface at its temperature and that of the air [degC]: [W/(m2 K)]. Zero where no heat
/// passes by convection.
#[inline(always)]
pub(crate) fn film<S: Real>(
    model: &Model<'_, S>,
    conditions: &Conditions<S>,
    surface: SideId,
    temperature: S,
    air: S,
) -> S {
    let Some(law) = model.convection(surface) else { return S::zero() };
    let shift = conditions.surfaces[surface].air_shift;
    let (difference, least) = (temperature - air - shift, S::constant(LEAST));
    let difference = S::select(difference.abs().lt(least), least, difference);
    law.flux(difference, &conditions.surfaces[surface].forced).flux / difference
        * model.coefficients.surfaces[surface].area_factor
}
