//! The front of one zone: all that its equations are made of.

use crate::building::coefficients::Coefficients;
use crate::building::ids::{BySurface, SurfaceId};
use crate::building::plan::Plan;
use crate::linear::surface_balance::SurfaceLaws;
use crate::number::real::Real;
use crate::physics::longwave::Emission;
use crate::weather::conditions::Conditions;

use super::eliminate::Factors;
use super::equations::Equations;
use super::exterior::Exterior;
use super::laws::Laws;
use super::layout::{Layout, air_places, places};

/// The front of a zone.
#[derive(Debug, Clone)]
pub(super) struct ZoneFront<S> {
    pub(super) layout: Layout,
    pub(super) laws: Laws<S>,
    /// Areas of the surfaces [m2], and the share of radiant gains that falls on each [-].
    pub(super) area: Vec<S>,
    pub(super) radiant_share: Vec<S>,
    /// Heat into each surface from sun, gains and its wall at surfaces of 0 degC [W].
    pub(super) heat: Vec<S>,
    pub(super) exterior: Exterior<S>,
    pub(super) equations: Equations<S>,
    pub(super) factors: Factors<S>,
    pub(super) influence: Influence<S>,
    /// Emissions of the unknowns while they are solved for, then temperatures of the exterior surfaces.
    pub(super) scratch: Vec<S>,
}

/// Influence coefficients of a constant matrix.
#[derive(Debug, Clone)]
pub(super) struct Influence<S> {
    /// By right-hand side of an eliminated surface (rows): temperatures of the eliminated surfaces, then what is added to the
    /// right-hand sides of the retained unknowns.
    pub(super) of_right: Vec<S>,
    /// By retained unknown (rows): temperatures of the eliminated surfaces.
    pub(super) of_retained: Vec<S>,
    /// Influence of the current right-hand side.
    pub(super) applied: Vec<S>,
}

impl<S: Real> Influence<S> {
    fn new(stride: usize) -> Self {
        let zeros = |count| vec![S::zero(); count];
        Self { of_right: zeros(stride * stride), of_retained: zeros(stride * stride), applied: zeros(stride) }
    }
}

impl<S: Real> ZoneFront<S> {
    pub(super) fn new(
        plan: &Plan,
        numbers: &Coefficients<S>,
        laws: &BySurface<SurfaceLaws<S>>,
        zone: usize,
    ) -> Self {
        let (of_plan, of_zone) = (&plan.zones[zone], &numbers.zones[zone]);
        let mut order: Vec<usize> = (0..of_plan.surfaces.len()).collect();
        order.sort_by_key(|&i| of_plan.surface_rows[i]);
        let eliminated = order.iter().filter(|&&i| of_plan.surface_rows[i] < plan.own_rows).count();
        let surfaces: Vec<SurfaceId> = order.iter().map(|&i| of_plan.surfaces[i]).collect();
        let retained = order[eliminated..].iter().map(|&i| of_plan.surface_rows[i]);
        let retained_rows: Vec<usize> = retained.chain([of_plan.air_row]).collect();
        let places = places(&plan.pattern, plan.own_rows, &retained_rows);
        let layout = Layout {
            surfaces: surfaces.len(),
            eliminated,
            stride: (surfaces.len() + 2).next_multiple_of(S::CHUNK),
            first_row: order.first().map_or(0, |&i| of_plan.surface_rows[i]),
            air_places: air_places(&places, retained_rows.len()),
            places,
            retained_rows,
            exterior: surfaces[..eliminated].iter().filter(|s| !plan.walls[s.wall()].thick).count(),
            walls: surfaces[..eliminated].to_vec(),
        };
        let exterior = Exterior::new(numbers, laws, &layout);
        let mut interior = Laws::new(&surfaces, layout.stride, laws);
        let exact = matches!(of_zone.emission, Emission::Exact) && !of_zone.exchange.is_empty();
        interior.sort(numbers, |_| true, |_| exact);
        // Along straight lines all surfaces emit alike: their offset cancels.
        interior.emission[0].fill(S::zero());
        if of_zone.exchange.is_empty() {
            interior.emission[1].fill(S::one());
        }
        interior.emission[1][surfaces.len()..].fill(S::one());
        let mut front = Self::blank(layout, interior, exterior);
        for (i, &k) in order.iter().enumerate() {
            (front.area[i], front.radiant_share[i]) = (of_zone.areas[k], of_zone.radiant_shares[k]);
        }
        if exact {
            // A nonlinear emission has no slope yet.
            front.equations.inverse_slope.fill(S::zero());
        }
        if !of_zone.exchange.is_empty() {
            let (n, stride) = (surfaces.len(), front.layout.stride);
            for (i, &a) in order.iter().enumerate() {
                for (j, &b) in order.iter().enumerate() {
                    let area = if a == b { of_zone.exchange_sums[a] } else { -of_zone.exchange[a * n + b] };
                    front.equations.exchange[i * stride + j] = area;
                }
            }
        }
        front
    }

    /// A front that has nothing but its laws.
    pub(super) fn blank(layout: Layout, laws: Laws<S>, exterior: Exterior<S>) -> Self {
        let stride = layout.stride;
        let zeros = || vec![S::zero(); stride];
        Self {
            area: zeros(),
            radiant_share: zeros(),
            heat: zeros(),
            equations: Equations::new(&layout, &laws),
            factors: Factors::new(stride),
            influence: Influence::new(stride),
            scratch: zeros(),
            layout,
            laws,
            exterior,
        }
    }

    /// Reads what drives a stage.
    #[inline(always)]
    pub(super) fn begin(&mut self, conditions: &Conditions<S>, radiant: S, sources: &[[S; 2]]) {
        self.laws.set_wind(conditions);
        let surfaces = self.laws.surfaces().zip(&self.area).zip(&self.radiant_share);
        for (heat, ((surface, &area), &share)) in self.heat.iter_mut().zip(surfaces) {
            *heat = area * conditions.surfaces[surface].solar + radiant * share;
        }
        self.exterior.begin(&self.layout, conditions, sources, &mut self.heat);
    }
}
