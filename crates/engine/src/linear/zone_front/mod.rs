//! The surfaces that belong to one zone alone, eliminated together: one dense front for each zone.
//!
//! Most walls have constant properties, one surface in a zone and the other in none. The exterior surface is eliminated first
//! ([`exterior`]): it is a straight line of the interior one. The interior surfaces of these walls are the *eliminated*
//! unknowns of the zone's front. Its *retained* unknowns are the zone's other surfaces (of nonlinear walls, or of walls
//! between zones) and its air. With the right-hand side as one more column the front is assembled ([`assemble`]) and
//! eliminated ([`eliminate`]); the Schur complement of the retained unknowns goes to the [`CoupledSystem`] ([`solve`]).
//!
//! The unknowns of a front are the emissions of its surfaces along the tangent of their law, `E = offset + slope T` [W/m2],
//! and the temperature of its air. Surfaces are then coupled by exchange areas, which never change and are symmetric: only
//! the diagonal is assembled, and half of the elimination is saved. A zone without long-wave exchange has `E = T`.
//!
//! All numbers stand by their place in the front, so that neighbours are computed together ([`Abreast`]).

use crate::building::coefficients::Coefficients;
use crate::building::ids::{BySurface, SurfaceId};
use crate::building::plan::Plan;
use crate::linear::coupled::CoupledSystem;
use crate::linear::surface_balance::{ExteriorSurfaces, SurfaceLaws};
use crate::linear::unknowns::Unknowns;
use crate::number::real::{Abreast, Real, Task};
use crate::physics::longwave::Emission;
use crate::weather::conditions::Conditions;

use assemble::Equations;
use eliminate::Factors;
use exterior::Exterior;
use laws::Laws;
use solve::Influence;

/// The numbers from a place on that fill a register.
macro_rules! part {
    ($line:expr, $start:expr) => {
        V::load(&$line[$start..$start + S::SIDE])
    };
}

mod assemble;
mod eliminate;
mod exterior;
mod laws;
mod solve;

/// The unknowns of a front and where they stand.
#[derive(Debug, Clone)]
struct Layout {
    /// Number of surfaces, the eliminated ones first. The air stands behind them, then the right-hand side.
    surfaces: usize,
    /// Number of eliminated surfaces.
    eliminated: usize,
    /// Numbers in a row: all unknowns and the right-hand side, and as many more as fill the last register.
    stride: usize,
    /// Row of the first eliminated surface among the unknowns of the building, and rows of the retained unknowns.
    first_row: usize,
    retained_rows: Vec<usize>,
    /// The eliminated surfaces.
    walls: Vec<SurfaceId>,
}

impl Layout {
    /// Row of an unknown of the front among the unknowns of the building.
    #[inline(always)]
    fn row(&self, i: usize) -> usize {
        if i < self.eliminated { self.first_row + i } else { self.retained_rows[i - self.eliminated] }
    }
}

/// The front of a zone.
#[derive(Debug, Clone)]
struct ZoneFront<S> {
    layout: Layout,
    laws: Laws<S>,
    /// Areas of the surfaces [m2], and the share of radiant gains that falls on each [-].
    area: Vec<S>,
    radiant_share: Vec<S>,
    /// Heat into each surface from sun, gains and its wall at surfaces of 0 degC [W].
    heat: Vec<S>,
    exterior: Exterior<S>,
    equations: Equations<S>,
    factors: Factors<S>,
    influence: Influence<S>,
    /// Emissions of the unknowns while they are solved for, then temperatures of the exterior surfaces.
    scratch: Vec<S>,
}

/// The fronts of all zones.
#[derive(Debug, Clone)]
pub(crate) struct ZoneFronts<S> {
    zone_fronts: Vec<ZoneFront<S>>,
}

/// What is to be eliminated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Elimination {
    /// The matrix with its right-hand side.
    Full,
    /// The right-hand side alone: the matrix is that of the last elimination.
    RightHandSide,
}

impl<S: Real> ZoneFront<S> {
    fn new(plan: &Plan, numbers: &Coefficients<S>, laws: &BySurface<SurfaceLaws<S>>, zone: usize) -> Self {
        let (of_plan, of_zone) = (&plan.zones[zone], &numbers.zones[zone]);
        let mut order: Vec<usize> = (0..of_plan.surfaces.len()).collect();
        order.sort_by_key(|&i| of_plan.surface_rows[i]);
        let eliminated = order.iter().filter(|&&i| of_plan.surface_rows[i] < plan.own_rows).count();
        let surfaces: Vec<SurfaceId> = order.iter().map(|&i| of_plan.surfaces[i]).collect();
        let retained = order[eliminated..].iter().map(|&i| of_plan.surface_rows[i]);
        let layout = Layout {
            surfaces: surfaces.len(),
            eliminated,
            stride: (surfaces.len() + 2).next_multiple_of(S::SIDE),
            first_row: order.first().map_or(0, |&i| of_plan.surface_rows[i]),
            retained_rows: retained.chain([of_plan.air_row]).collect(),
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
    fn blank(layout: Layout, laws: Laws<S>, exterior: Exterior<S>) -> Self {
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
    fn begin(&mut self, conditions: &Conditions<S>, radiant: S, sources: &[[S; 2]]) {
        self.laws.set_wind(conditions);
        let surfaces = self.laws.surfaces().zip(&self.area).zip(&self.radiant_share);
        for (heat, ((surface, &area), &share)) in self.heat.iter_mut().zip(surfaces) {
            *heat = area * conditions.surfaces[surface].solar + radiant * share;
        }
        self.exterior.begin(&self.layout, conditions, sources, &mut self.heat);
    }
}

/// The elimination of all fronts.
struct Eliminate<'r, S: Real> {
    zone_fronts: &'r mut [ZoneFront<S>],
    /// Iterate about which nonlinear laws are linearised; none: laws as they are.
    iterate: Option<&'r Unknowns<S>>,
    elimination: Elimination,
    constant: bool,
}

impl<S: Real> Task<S> for Eliminate<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Abreast<S>>(self) {
        for (zone, front) in self.zone_fronts.iter_mut().enumerate() {
            if let Some(iterate) = self.iterate {
                if front.laws.convection_is_nonlinear() {
                    front.laws.air.fill(iterate.air[zone]);
                }
                // A loop: one copy of all correlations only, inlining multiplies compile time.
                for laws in [&mut front.laws, &mut front.exterior.laws] {
                    laws.linearise::<V>(&iterate.surfaces);
                }
            }
            front.assemble::<V>(self.elimination);
        }
        for front in self.zone_fronts {
            if self.elimination == Elimination::Full {
                front.factors.eliminate::<V>(&front.equations, &front.layout);
                if self.constant {
                    front.compute_influence();
                }
            }
            if self.constant {
                front.apply_influence::<V>();
            }
        }
    }
}

/// Solution for all eliminated surfaces.
struct Solve<'r, S: Real> {
    zone_fronts: &'r mut [ZoneFront<S>],
    constant: bool,
    unknowns: &'r mut [S],
    surfaces: &'r mut [S],
}

impl<S: Real> Task<S> for Solve<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Abreast<S>>(self) {
        for front in self.zone_fronts {
            front.solve::<V>(self.constant, self.unknowns, self.surfaces);
        }
    }
}

// Large functions, not inlined: one copy only, inlining multiplies compile time.
impl<S: Real> ZoneFronts<S> {
    pub(crate) fn new(plan: &Plan, numbers: &Coefficients<S>, laws: &BySurface<SurfaceLaws<S>>) -> Self {
        let zones = 0..plan.zones.len();
        Self { zone_fronts: zones.map(|zone| ZoneFront::new(plan, numbers, laws, zone)).collect() }
    }

    /// Sets the responses of the walls: heat into surface e by the temperature of surface o [W/(m2 K)].
    pub(crate) fn set_responses(&mut self, responses: &[[[S; 2]; 2]]) {
        for front in &mut self.zone_fronts {
            front.exterior.set_responses(&front.layout, responses);
        }
    }

    /// Reads what drives a stage: conditions, and heat from the walls at surfaces of 0 degC [W/m2].
    #[inline(never)]
    pub(crate) fn begin_stage(&mut self, conditions: &Conditions<S>, sources: &[[S; 2]]) {
        S::vectorised(
            #[inline(always)]
            || {
                for (front, zone) in self.zone_fronts.iter_mut().zip(&conditions.zones) {
                    front.begin(conditions, zone.radiant, sources);
                }
            },
        );
    }

    /// Eliminates the surfaces of all fronts and adds the Schur complement to the coupled system. Nonlinear laws are taken along
    /// their tangents at an iterate; without one as they are. `constant`: the matrix changes only with the stage length.
    #[inline(never)]
    pub(crate) fn eliminate(
        &mut self,
        iterate: Option<&Unknowns<S>>,
        elimination: Elimination,
        constant: bool,
        coupled: &mut CoupledSystem<'_, S>,
    ) {
        S::vectorised(
            #[inline(always)]
            || {
                S::abreast(Eliminate { zone_fronts: &mut self.zone_fronts, iterate, elimination, constant });
                for zone_front in &self.zone_fronts {
                    zone_front.add_schur_complement(elimination, constant, coupled);
                }
            },
        );
    }

    /// Solves for the eliminated surfaces, once the other unknowns are known; surfaces are those of the building.
    #[inline(never)]
    pub(crate) fn solve(&mut self, constant: bool, unknowns: &mut [S], surfaces: &mut [S]) {
        S::vectorised(
            #[inline(always)]
            || S::abreast(Solve { zone_fronts: &mut self.zone_fronts, constant, unknowns, surfaces }),
        );
    }

    /// Eliminates the surfaces of the fronts from another right-hand side.
    #[inline(never)]
    pub(crate) fn forward(&self, right: &mut [S]) {
        S::vectorised(
            #[inline(always)]
            || self.zone_fronts.iter().for_each(|front| front.forward_in_building(right)),
        );
    }

    /// Solves for the eliminated surfaces of another right-hand side.
    #[inline(never)]
    pub(crate) fn back(&self, right: &mut [S]) {
        S::vectorised(
            #[inline(always)]
            || self.zone_fronts.iter().for_each(|front| front.back_in_building(right)),
        );
    }

    /// Copies laws that were linearised elsewhere.
    pub(crate) fn copy_laws(&mut self, laws: &BySurface<SurfaceLaws<S>>) {
        for front in &mut self.zone_fronts {
            front.laws.copy_from(laws);
            front.exterior.laws.copy_from(laws);
        }
    }

    /// Writes the laws of the exterior surfaces, which the energy balance needs.
    #[inline(never)]
    pub(crate) fn write_exterior_laws(&self, laws: &mut BySurface<SurfaceLaws<S>>) {
        self.zone_fronts.iter().for_each(|front| front.exterior.laws.copy_to(laws));
    }

    /// Writes the laws of the surfaces in the zones.
    #[cfg(test)]
    pub(crate) fn laws_in_zones(&self, laws: &mut BySurface<SurfaceLaws<S>>) {
        self.zone_fronts.iter().for_each(|front| front.laws.copy_to(laws));
    }

    /// Writes the exterior surfaces as lines of the interior ones [degC], and how much they rise with heat [m2 K/W].
    #[inline(never)]
    pub(crate) fn write_exterior_surfaces(&self, surfaces: &mut [ExteriorSurfaces<S>], inverses: &mut [S]) {
        for front in &self.zone_fronts {
            for (i, interior) in front.layout.walls.iter().enumerate() {
                let (line, inverse) = front.exterior.line_at(i);
                surfaces[interior.wall()] = ExteriorSurfaces::One { side: interior.opposite().side(), line };
                inverses[interior.wall()] = inverse;
            }
        }
    }
}

/// A plain matrix: right-hand sides may carry derivatives, and there is a transpose.
impl ZoneFronts<f64> {
    /// Eliminates the surfaces of the fronts from right-hand sides of any kind.
    #[inline(always)]
    pub(crate) fn forward_values<R: Real>(&self, right: &mut [R]) {
        self.zone_fronts.iter().for_each(|front| front.forward_values(right));
    }

    /// Solves for the eliminated surfaces of right-hand sides of any kind.
    #[inline(always)]
    pub(crate) fn back_values<R: Real>(&self, right: &mut [R]) {
        self.zone_fronts.iter().for_each(|front| front.back_values(right));
    }

    /// The transpose of [`Self::back_values`].
    pub(crate) fn back_transposed(&self, weights: &mut [f64]) {
        self.zone_fronts.iter().for_each(|front| front.back_transposed(weights));
    }

    /// The transpose of [`Self::forward_values`].
    pub(crate) fn forward_transposed(&self, weights: &mut [f64]) {
        self.zone_fronts.iter().for_each(|front| front.forward_transposed(weights));
    }
}

#[cfg(test)]
mod tests;
