//! What acts on a single surface: absorbed radiation, the temperature beside it and the wind on it.

use crate::building::coefficients::{Boundary, Coefficients, Imposed, Outdoors};
use crate::building::ids::{BySide, SideId};
use crate::building::plan::Plan;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::physics::convection::wind::angle_of_cosine;
use crate::physics::convection::{Driven, Surroundings};
use crate::weather::instant::Instant;
use crate::weather::zone_conditions::ZoneConditions;

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
    /// Long-wave radiation absorbed from sky, air and ground, or the heat flux that is given [W/m2].
    pub longwave: S,
    /// Temperature of the air, or the imposed temperature [degC].
    pub temperature: S,
    /// Air in front of it less the mean of its zone [K].
    pub air_shift: S,
    /// The parts of the surface heat transfer coefficient that depend on the wind and on what is around the surface.
    pub forced: Driven<S>,
}

impl<S: Real> SurfaceConditions<S> {
    /// Takes over heat [W/m2] and a coefficient [W/(m2 K)] that a law gives beside its temperature.
    pub(crate) fn impose(&mut self, [heat, coefficient]: [Option<S>; 2]) {
        self.longwave = heat.unwrap_or(self.longwave);
        self.forced = coefficient.map_or(self.forced, |coefficient| [coefficient; 4]);
    }
}

/// Sets the air in front of the surfaces of stratified zones.
// Few buildings have any.
#[inline(never)]
pub(super) fn stratify<S: Real>(
    surfaces: &mut BySide<SurfaceConditions<S>>,
    zones: &[ZoneConditions<S>],
    plan: &Plan,
    coefficients: &Coefficients<S>,
) {
    for (zone, at) in plan.zones.iter().zip(zones) {
        for &surface in &zone.surfaces {
            if let Some(level) = coefficients.surfaces[surface].level {
                surfaces[surface].air_shift = at.gradient.scale(level);
            }
        }
    }
}

/// The cosine of the angle between the azimuth of a surface outdoors and the wind, and where the wind blows onto it.
#[inline(always)]
fn facing<S: Real>(outdoors: &Outdoors<S>, upward: S, now: &Instant<'_>) -> (S, S::Mask) {
    let [north, east] = now.wind_from;
    let facing = outdoors.heading[0].scale(north) + outdoors.heading[1].scale(east);
    let onto = S::constant(LEEWARD_COSINE.of::<S>()).lt(facing);
    let flat = S::constant(FLAT).lt(upward.abs());
    (facing, onto | flat)
}

#[inline(always)]
pub(crate) fn forced<S: Real>(coefficients: &Coefficients<S>, index: SideId, now: &Instant<'_>) -> Driven<S> {
    let surface = &coefficients.surfaces[index];
    let (Some(convection), Boundary::Outdoors(outdoors)) = (&surface.convection, &surface.boundary) else {
        return [S::zero(); 4];
    };
    let (_, windward) = facing(outdoors, surface.upward, now);
    convection.forced(&now.wind, windward)
}

/// What drives a law as text at a surface in no zone: `air` is the temperature beside it [degC], `sun` the irradiance of its plane [W/m2].
// One copy only: few buildings have such laws.
#[inline(never)]
pub(crate) fn driven_outside<S: Real>(
    coefficients: &Coefficients<S>,
    index: SideId,
    now: &Instant<'_>,
    (air, sun): (S, S),
) -> Driven<S> {
    let surface = &coefficients.surfaces[index];
    let Some(convection) = &surface.convection else { return [S::zero(); 4] };
    let mut around = Surroundings { air, sun, ..Surroundings::calm() };
    let mut windward = S::Mask::splat(true);
    if let Boundary::Outdoors(outdoors) = &surface.boundary {
        let (cosine, onto) = facing(outdoors, surface.upward, now);
        windward = onto;
        around.angle = angle_of_cosine(cosine * outdoors.plane.sin_tilt);
    }
    convection.driven(&now.wind, windward, &around)
}

/// The imposed temperature of a surface at an instant [degC].
#[inline(always)]
pub(crate) fn imposed_temperature<S: Real>(imposed: &Imposed<S>, now: &Instant<'_>) -> S {
    match imposed {
        Imposed::Channel(channel) => S::constant(now.row[*channel]),
        Imposed::Law(law) => law.at(&now.imposed_weather()),
    }
}
