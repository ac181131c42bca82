//! The front of one zone, or of several side by side: all that its equations are made of.

use crate::building::coefficients::Coefficients;
use crate::building::ids::{BySide, SideId};
use crate::building::plan::Plan;
use crate::linear::surface_balance::SurfaceLaws;
use crate::number::real::Real;
use crate::weather::conditions::Conditions;

use super::eliminate::Factors;
use super::equations::Equations;
use super::exterior::Exterior;
use super::laws::Laws;
use super::layout::Layout;
use super::shape::{Shape, ZoneShape};
use super::windows::Windows;

/// The front of a zone, or of several zones of one shape.
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
    pub(super) windows: Windows<S>,
    pub(super) equations: Equations<S>,
    pub(super) factors: Factors<S>,
    pub(super) influence: Influence<S>,
    /// What a large front has in place of factors.
    pub(super) columns: Option<Columns<S>>,
    /// Schur complements of zones side by side: as many entries as [`Layout::register_places`], then right-hand sides.
    pub(super) schur: Vec<S>,
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

/// The columns of a large front, see [`large`](super::large).
#[derive(Debug, Clone)]
pub(super) struct Columns<S> {
    /// That of the right-hand side [W/m2], of the air [W/(m2 K)] and of each retained surface [-], one after the other.
    pub(super) numbers: Vec<S>,
    pub(super) line: usize,
}

impl<S> Columns<S> {
    #[inline(always)]
    pub(super) fn column(&self, k: usize) -> &[S] {
        &self.numbers[k * self.line..(k + 1) * self.line]
    }
}

/// The laws of the surfaces of a front in its zones.
fn interior_laws<S: Real>(
    numbers: &Coefficients<S>,
    laws: &BySide<SurfaceLaws<S>>,
    surfaces: &[SideId],
    (stride, shape): (usize, &Shape),
) -> Laws<S> {
    let mut interior = Laws::new(surfaces, stride, laws);
    interior.sort(numbers, |_| true, |_| shape.exact);
    // Along straight lines all surfaces emit alike: their offset cancels.
    interior.emission[0].fill(S::zero());
    if !shape.exchange {
        interior.emission[1].fill(S::one());
    }
    interior.emission[1][surfaces.len()..].fill(S::one());
    interior
}

impl<S: Real> Influence<S> {
    /// None is known yet: most buildings never need it.
    fn unknown() -> Self {
        Self { of_right: Vec::new(), of_retained: Vec::new(), applied: Vec::new() }
    }

    /// As many zeros as there are coefficients, where there are none yet.
    pub(super) fn begin(&mut self, stride: usize) {
        self.of_right.resize(stride * stride, S::zero());
        self.of_retained.resize(stride * stride, S::zero());
        self.applied.resize(stride, S::zero());
    }
}

impl<S: Real> ZoneFront<S> {
    /// The front of some zones of one shape, of which the first `members` differ.
    pub(super) fn new(
        plan: &Plan,
        numbers: &Coefficients<S>,
        laws: &BySide<SurfaceLaws<S>>,
        (zones, members): (&[usize], usize),
        [iterated, windows_together]: [bool; 2],
    ) -> Self {
        let shapes: Vec<_> = zones.iter().map(|&zone| ZoneShape::new(plan, numbers, zone)).collect();
        let (shape, step) = (&shapes[0], shapes.len());
        // Surfaces of the same number are neighbours.
        let places = || (0..shape.order.len() * step).map(|place| (place, place % step, place / step));
        let of_plan = |lane: usize| &plan.zones[zones[lane]];
        let surfaces: Vec<SideId> =
            places().map(|(_, lane, i)| of_plan(lane).surfaces[shapes[lane].order[i]]).collect();
        let layout = Layout::new(plan, &shapes, (zones, members), &surfaces, S::CHUNK);
        let exterior = Exterior::new(numbers, laws, &layout);
        let interior = interior_laws(numbers, laws, &surfaces, (layout.stride, &shape.key));
        let (exact, exchange) = (shape.key.exact, shape.key.exchange);
        let windows = Windows::new(plan, numbers, &layout, windows_together);
        let mut front = Self { windows, ..Self::blank(layout, interior, exterior) };
        let of_zone = |lane: usize| &numbers.zones[zones[lane]];
        for (place, lane, i) in places() {
            let k = shapes[lane].order[i];
            (front.area[place], front.radiant_share[place]) =
                (of_zone(lane).areas[k], of_zone(lane).radiant_shares[k]);
        }
        if iterated && shape.key.is_large() {
            front.make_large();
        }
        if exact {
            // A nonlinear emission has no slope yet.
            front.equations.inverse_slope.fill(S::zero());
        }
        if exchange {
            let (n, stride) = (shape.order.len(), front.layout.stride);
            for (place, lane, i) in places() {
                for j in 0..n {
                    let [a, b] = [i, j].map(|place| shapes[lane].order[place]);
                    let zone = of_zone(lane);
                    let area = if a == b { zone.exchange_sums[a] } else { -zone.exchange[a * n + b] };
                    front.equations.exchange[i * stride + j * step + place % step] = area;
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
            factors: Factors::new(&layout),
            influence: Influence::unknown(),
            columns: None,
            scratch: zeros(),
            schur: vec![S::zero(); layout.register_places.len() + layout.retained_rows.len()],
            windows: Windows::none(),
            layout,
            laws,
            exterior,
        }
    }

    /// Reads what drives a stage; `radiant`: heat that is released at the surfaces of each zone [W].
    #[inline(always)]
    pub(super) fn begin(
        &mut self,
        conditions: &Conditions<S>,
        radiant: impl Fn(usize) -> S,
        sources: &[[S; 2]],
    ) {
        self.laws.set_wind(conditions);
        if self.side_by_side() {
            for (lane, &zone) in self.layout.zones.iter().enumerate() {
                let radiant = radiant(zone);
                for place in (lane..self.laws.count).step_by(S::CHUNK) {
                    let solar = conditions.surfaces[self.laws.surface(place)].solar;
                    self.heat[place] = self.area[place] * solar + radiant * self.radiant_share[place];
                }
            }
        } else {
            let radiant = radiant(self.layout.zones[0]);
            let surfaces = self.laws.surfaces().zip(&self.area).zip(&self.radiant_share);
            for (heat, ((surface, &area), &share)) in self.heat.iter_mut().zip(surfaces) {
                *heat = area * conditions.surfaces[surface].solar + radiant * share;
            }
        }
        self.exterior.begin(&self.layout, conditions, sources, &mut self.heat);
    }

    /// Whether it holds several zones. Only of plain numbers, of which some fill a register.
    #[inline(always)]
    pub(super) fn side_by_side(&self) -> bool {
        S::CHUNK > 1 && self.layout.step() > 1
    }

    /// Sets the temperatures of the airs in front of the surfaces.
    #[inline(always)]
    pub(super) fn set_airs(&mut self, airs: &[S]) {
        if !self.side_by_side() {
            return self.laws.air.fill(airs[self.layout.zones[0]]);
        }
        for airs_of_places in self.laws.air.chunks_exact_mut(S::CHUNK) {
            for (air, &zone) in airs_of_places.iter_mut().zip(&self.layout.zones) {
                *air = airs[zone];
            }
        }
    }
}
