//! What acts on a single surface: absorbed radiation, the temperature beside it and the wind on it.

use crate::building::coefficients::{Boundary, Coefficients, Imposed};
use crate::building::ids::SurfaceId;
use crate::number::real::{ByPrecision, Real};
use crate::physics::convection::Forced;
use crate::weather::instant::Instant;

/// A surface is leeward when the cosine between its normal and the direction that the wind comes from is below this. A wind along
/// the surface counts as windward: its cosine is zero but for round-off, so the limit lies 6e-8 deg behind the surface. (Walton
/// 1983 takes 100 deg off the normal as the limit; the windward coefficient has no basis beyond 90 deg.)
const LEEWARD_COSINE: ByPrecision = ByPrecision { double: -1e-9, single: -1e-6 };
/// Surfaces within about 11 deg of horizontal are always windward (Walton 1983).
const FLAT: f64 = 0.98;

/// What acts on a surface.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceConditions<S: Real> {
    /// Absorbed short-wave radiation [W/m2].
    pub solar: S,
    /// Long-wave radiation absorbed from sky, air and ground [W/m2].
    pub longwave: S,
    /// Temperature of the air, or the imposed temperature [degC].
    pub temperature: S,
    /// The part of the surface heat transfer coefficient that depends on the wind.
    pub forced: Forced<S>,
}

#[inline(always)]
pub(crate) fn forced<S: Real>(
    coefficients: &Coefficients<S>,
    index: SurfaceId,
    now: &Instant<'_>,
) -> Forced<S> {
    let surface = &coefficients.surfaces[index];
    let (Some(convection), Boundary::Outdoors(outdoors)) = (&surface.convection, &surface.boundary) else {
        return [S::zero(); 2];
    };
    let [north, east] = now.wind_from;
    let facing = outdoors.heading[0].scale(north) + outdoors.heading[1].scale(east);
    let onto = S::constant(LEEWARD_COSINE.of::<S>()).lt(facing);
    let flat = S::constant(FLAT).lt(surface.upward.abs());
    convection.forced(&now.wind, onto | flat)
}

/// The imposed temperature of a surface at an instant [degC].
#[inline(always)]
pub(crate) fn imposed_temperature<S: Real>(imposed: &Imposed<S>, now: &Instant<'_>) -> S {
    match imposed {
        Imposed::Channel(channel) => S::constant(now.row[*channel]),
        Imposed::Annual { mean, swing } => {
            let [cosine, sine] = now.season;
            *mean - (swing[0].scale(cosine) + swing[1].scale(sine))
        }
    }
}
