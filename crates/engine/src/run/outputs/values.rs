//! Values of outputs that take more than one line: means of layers, fluxes and temperatures inside of walls.

use super::row::At;
use crate::building::coefficients::{Matter, WallCoefficients};
use crate::building::ids::SideId;
use crate::building::plan::Plan;
use crate::number::real::Real;
use crate::step::state::State;

/// Sun that a window transmits, mean over the step [W].
pub(super) fn transmitted<S: Real>(at: &At<'_, S>, surface: usize) -> S {
    let window = at.plan.windows.iter().position(|&w| w == surface);
    window.map_or_else(S::zero, |window| at.step.weather.sun.windows[window])
}

/// Transmitted over incident solar radiation of a window, zero in the dark [-].
pub(super) fn solar_transmittance<S: Real>(at: &At<'_, S>, surface: usize) -> S {
    let area = at.step.model.coefficients.walls[surface].area;
    let incident = area * at.step.incident(SideId::outside(surface));
    let dark = incident.lt(S::constant(1e-9));
    let fraction = transmitted(at, surface) / S::select(dark, S::one(), incident);
    S::select(dark, S::zero(), fraction)
}

/// Mean temperature of the surfaces of a zone, weighted by area, with what the radiation of an ideal load adds; that of the air where it
/// has no surfaces [degC].
pub(super) fn mean_radiant<S: Real>(at: &At<'_, S>, zone: usize) -> S {
    let numbers = &at.step.model.coefficients.zones[zone];
    let surfaces = at.plan.zones[zone].surfaces.iter().map(|&surface| at.state.surfaces[surface]);
    let radiated = numbers.load_parts(at.state.load[zone])[1];
    numbers.mean_radiant(|&number| number, (surfaces, at.state.air[zone]), radiated)
}

#[allow(clippy::cast_precision_loss, reason = "cell counts are small")]
pub(super) fn layer_mean<S: Real>(
    plan: &Plan,
    surface: usize,
    layer: usize,
    value: impl Fn(usize) -> S,
) -> S {
    let wall = &plan.walls[surface];
    let (start, end) = wall.layer_cells[layer];
    let sum = (start..end).fold(S::zero(), |sum, i| sum + value(wall.first_cell + i));
    sum.scale(1.0 / (end - start) as f64)
}

/// Flux at the middle of a layer: along the middle link, or the mean of the two about the middle cell.
pub(super) fn layer_flux<S: Real>(at: &At<'_, S>, surface: usize, layer: usize) -> S {
    let (start, end) = at.plan.walls[surface].layer_cells[layer];
    let (first, last) = (usize::midpoint(start, end), (start + end).div_ceil(2));
    let flux = |link| at.step.link_flux(at.state, surface, link);
    (flux(first) + flux(last)).scale(0.5)
}

/// Half of a cell's resistance at its present state [m2 K/W].
fn half_resistance<S: Real>(wall: &WallCoefficients<S>, state: &State<S>, first_cell: usize, i: usize) -> S {
    let half = wall.cells[i].thickness.scale(0.5);
    match wall.cells[i].matter {
        Matter::Solid { conductivity, .. } => half / conductivity,
        Matter::Pcm(law) => {
            let k = first_cell + i;
            half / wall.pcm[law].at(state.cells[k], &state.memory[k]).conductivity
        }
    }
}

/// Temperature on the inner side of the layers before `interface`, from the flux that crosses it.
pub(super) fn interface_temperature<S: Real>(at: &At<'_, S>, surface: usize, interface: usize) -> S {
    let At { plan, step, state } = *at;
    let (wall, numbers) = (&plan.walls[surface], &step.model.coefficients.walls[surface]);
    // The link that holds the interface follows the cells of all layers before it.
    let link = if interface == 0 { wall.soil } else { wall.layer_cells[interface - 1].1 };
    let flux = step.link_flux(state, surface, link);
    let (mut temperature, mut resistance) = if link == 0 {
        (state.surfaces[SideId::outside(surface)], S::zero())
    } else {
        let half = half_resistance(numbers, state, wall.first_cell, link - 1);
        (state.cells[wall.first_cell + link - 1], half)
    };
    for &layer in wall.link_layers[link].iter().filter(|&&layer| layer < interface) {
        resistance += numbers.layer_resistance[layer];
    }
    temperature = temperature - flux * resistance;
    temperature
}

/// Temperature at the depth of a sensor [degC].
pub(super) fn sensor_temperature<S: Real>(at: &At<'_, S>, sensor: usize) -> S {
    let surface = at.plan.description.sensors[sensor].surface;
    profile_at(&profile(at, surface), at.step.model.coefficients.sensor_depths[sensor])
}

/// Temperatures and depths of the surfaces, cell centres and interfaces of a wall, outside to inside.
fn profile<S: Real>(place: &At<'_, S>, surface: usize) -> Vec<(S, S)> {
    let At { plan, step, state } = *place;
    let (wall, numbers) = (&plan.walls[surface], &step.model.coefficients.walls[surface]);
    let at = |surface: SideId| state.surfaces[surface];
    let mut depth = S::zero();
    // Where soil is behind it, the construction begins at the soil.
    let outer =
        if wall.soil > 0 { interface_temperature(place, surface, 0) } else { at(SideId::outside(surface)) };
    let mut points = vec![(depth, outer)];
    for (layer, &(start, end)) in wall.layer_cells.iter().enumerate() {
        if layer > 0 {
            points.push((depth, interface_temperature(place, surface, layer)));
        }
        for i in start..end {
            let half = numbers.cells[i].thickness.scale(0.5);
            points.push((depth + half, state.cells[wall.first_cell + i]));
            depth += numbers.cells[i].thickness;
        }
    }
    points.push((depth, at(SideId::inside(surface))));
    points
}

/// Piecewise linear interpolation in a profile, without a branch on the depth (it may differ between lanes).
fn profile_at<S: Real>(points: &[(S, S)], depth: S) -> S {
    let mut temperature = points[0].1;
    for pair in points.windows(2) {
        let ((x0, t0), (x1, t1)) = (pair[0], pair[1]);
        let length = x1 - x0;
        let thin = length.lt(S::constant(1e-12));
        let inside = ((depth - x0) / length.max(S::constant(1e-12))).max(S::zero()).min(S::one());
        let beyond = S::select(x0.lt(depth), S::one(), S::zero());
        temperature += S::select(thin, beyond, inside) * (t1 - t0);
    }
    temperature
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Between two points on a straight line, constant beyond the ends, and a jump over a layer without thickness.
    #[test]
    fn a_profile_is_read_between_its_points() {
        let points = [(0.0, 10.0), (0.1, 20.0), (0.1, 26.0), (0.3, 22.0)];
        for (depth, expected) in
            [(-1.0, 10.0), (0.0, 10.0), (0.05, 15.0), (0.2, 24.0), (0.3, 22.0), (9.0, 22.0)]
        {
            let found: f64 = profile_at(&points, depth);
            assert!((found - expected).abs() < 1e-12, "{found} at {depth}, expected {expected}");
        }
    }
}
