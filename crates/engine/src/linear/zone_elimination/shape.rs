//! The shape of a zone, and which zones share a front: those of one shape, [side by side](super::side_by_side).

use crate::building::coefficients::Coefficients;
use crate::building::plan::Plan;
use crate::number::real::Real;
use crate::physics::longwave::Emission;

/// Least number of zones side by side. Measured with rows of rooms with windows, one member: with 6 of one shape a run takes 0.88 of
/// the time, with ideal loads 0.93.
const LEAST: usize = 6;

/// Eliminated surfaces from which a front is solved by iteration, and how many there must be for each retained unknown. Measured
/// with rooms of concrete and of foam: with 96 surfaces iteration takes 0.4 of the time, with 400 of which each tenth is retained as
/// long as an elimination.
const LARGE: usize = 96;
const LARGE_FOR_EACH_RETAINED: usize = 12;

/// What zones must have in common to be computed side by side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shape {
    /// Surfaces, those that are eliminated, and those of them with an exterior surface behind.
    pub(super) surfaces: usize,
    pub(super) eliminated: usize,
    pub(super) exterior: usize,
    /// Windows among these, the last of them.
    pub(super) windows: usize,
    /// Whether surfaces exchange long-wave radiation, and with the fourth power of their temperature.
    pub(super) exchange: bool,
    pub(super) exact: bool,
}

impl Shape {
    /// Whether a front has so many surfaces that it is solved by [iteration](super::large).
    pub(super) fn is_large(&self) -> bool {
        let retained = self.surfaces + 1 - self.eliminated;
        self.eliminated >= LARGE && self.eliminated >= LARGE_FOR_EACH_RETAINED * retained
    }
}

/// A zone and its shape.
#[derive(Debug, Clone)]
pub(super) struct ZoneShape {
    pub(super) key: Shape,
    /// Its surfaces in the order of their rows.
    pub(super) order: Vec<usize>,
}

impl ZoneShape {
    pub(super) fn new<S: Real>(plan: &Plan, numbers: &Coefficients<S>, zone: usize) -> Self {
        let (of_plan, of_zone) = (&plan.zones[zone], &numbers.zones[zone]);
        let mut order: Vec<usize> = (0..of_plan.surfaces.len()).collect();
        order.sort_by_key(|&i| of_plan.surface_rows[i]);
        let eliminated = order.iter().filter(|&&i| of_plan.surface_rows[i] < plan.own_rows).count();
        let wall = |i: usize| &plan.walls[of_plan.surfaces[i].wall()];
        let exchange = !of_zone.exchange.is_empty();
        let key = Shape {
            surfaces: order.len(),
            eliminated,
            exterior: order[..eliminated].iter().filter(|&&i| !wall(i).thick).count(),
            windows: order[..eliminated].iter().filter(|&&i| wall(i).nonlinear).count(),
            exchange,
            exact: matches!(of_zone.emission, Emission::Exact) && exchange,
        };
        Self { key, order }
    }
}

/// The zones of each front, and how many of them differ: alone, or `together` side by side where they have the same shape.
pub(super) fn group_zones<S: Real>(
    plan: &Plan,
    numbers: &Coefficients<S>,
    together: bool,
) -> Vec<(Vec<usize>, usize)> {
    let mut shapes: Vec<(Shape, Vec<usize>)> = Vec::new();
    for zone in 0..plan.zones.len() {
        let key = ZoneShape::new(plan, numbers, zone).key;
        match shapes.iter_mut().find(|(known, _)| *known == key) {
            Some((_, zones)) => zones.push(zone),
            None => shapes.push((key, vec![zone])),
        }
    }
    let mut fronts = Vec::new();
    for (shape, group) in
        shapes.iter().flat_map(|(key, zones)| zones.chunks(S::CHUNK).map(move |group| (key, group)))
    {
        if together && S::CHUNK > 1 && group.len() >= LEAST && !shape.is_large() {
            let mut zones = group.to_vec();
            zones.resize(S::CHUNK, group[0]);
            fronts.push((zones, group.len()));
        } else {
            fronts.extend(group.iter().map(|&zone| (vec![zone], 1)));
        }
    }
    fronts
}
