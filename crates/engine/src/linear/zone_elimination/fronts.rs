//! The fronts of all zones: their part in the linear system of a stage.

use crate::building::coefficients::Coefficients;
use crate::building::ids::BySide;
use crate::building::plan::Plan;
use crate::linear::coupled::CoupledSystem;
use crate::linear::laws::StageInputs;
use crate::linear::surface_balance::{ExteriorSurfaces, SurfaceLaws};
use crate::linear::unknowns::Unknowns;
use crate::linear::wall::{Response, WallSystem};
use crate::number::real::{Chunk, ChunkTask, Real};
use crate::weather::conditions::Conditions;

use super::front::ZoneFront;
use super::layout::Elimination;
use super::shape::group_zones;

/// Fronts that go through all parts of a computation before the next ones do: they stay in the fast memory of the processor, which those of
/// a large building together do not.
const BLOCK: usize = 4;

/// The fronts of all zones.
#[derive(Debug, Clone)]
pub(crate) struct ZoneFronts<S> {
    all: Vec<ZoneFront<S>>,
    /// Whether some zones are computed side by side, and some windows together.
    side_by_side: bool,
    windows_together: bool,
}

/// The elimination of all fronts.
pub(super) struct Eliminate<'r, S: Real> {
    pub(super) zone_fronts: &'r mut [ZoneFront<S>],
    /// Iterate about which nonlinear laws are linearised; none: laws as they are.
    pub(super) iterate: Option<&'r Unknowns<S>>,
    pub(super) elimination: Elimination,
    pub(super) constant: bool,
}

impl<S: Real> ChunkTask<S> for Eliminate<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Chunk<S>>(self) {
        for front in self.zone_fronts.iter_mut() {
            if let Some(iterate) = self.iterate {
                front.exterior.hold_thick(&front.layout, &iterate.surfaces);
                if front.laws.convection_is_nonlinear() {
                    front.set_airs(&iterate.air);
                }
                // A loop: one copy of all correlations only, inlining multiplies compile time.
                for laws in [&mut front.laws, &mut front.exterior.laws] {
                    laws.linearise::<V>(&iterate.surfaces);
                }
            }
            front.assemble::<V>(self.elimination);
        }
        for front in self.zone_fronts {
            if front.side_by_side() {
                front.eliminate_side_by_side::<V>();
                continue;
            }
            if front.columns.is_some() {
                front.solve_columns();
                continue;
            }
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

/// Windows that are computed together, linearised and eliminated.
// A task of its own, as are the two below: buildings without them keep the code of the others as it is.
struct Condense<'r, S: Real> {
    zone_fronts: &'r mut [ZoneFront<S>],
    cells: &'r [S],
}

impl<S: Real> ChunkTask<S> for Condense<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Chunk<S>>(self) {
        for ZoneFront { windows, layout, exterior, heat, .. } in self.zone_fronts {
            windows.condense::<V>((layout, self.cells), exterior, heat);
        }
    }
}

/// Schur complements of zones side by side.
struct SchurComplements<'r, S: Real> {
    zone_fronts: &'r mut [ZoneFront<S>],
}

impl<S: Real> ChunkTask<S> for SchurComplements<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Chunk<S>>(self) {
        for front in self.zone_fronts.iter_mut().filter(|front| front.side_by_side()) {
            front.compute_schur_complements::<V>();
        }
    }
}

/// Cells of the windows that are computed together, from the surfaces.
struct WriteWindows<'r, S: Real> {
    zone_fronts: &'r [ZoneFront<S>],
    cells: &'r mut [S],
}

impl<S: Real> ChunkTask<S> for WriteWindows<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Chunk<S>>(self) {
        for front in self.zone_fronts {
            front.windows.write_cells::<V>([&front.equations.right, &front.scratch], self.cells);
        }
    }
}

/// Solution for all eliminated surfaces.
pub(super) struct Solve<'r, S: Real> {
    pub(super) zone_fronts: &'r mut [ZoneFront<S>],
    pub(super) constant: bool,
    pub(super) unknowns: &'r mut [S],
    pub(super) surfaces: &'r mut [S],
}

impl<S: Real> ChunkTask<S> for Solve<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Chunk<S>>(self) {
        for front in self.zone_fronts {
            front.solve::<V>(self.constant, self.unknowns, self.surfaces);
        }
    }
}

/// All surfaces from those that the fronts eliminated.
pub(super) struct Write<'r, S: Real> {
    pub(super) zone_fronts: &'r mut [ZoneFront<S>],
    pub(super) unknowns: &'r [S],
    pub(super) surfaces: &'r mut [S],
}

impl<S: Real> ChunkTask<S> for Write<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Chunk<S>>(self) {
        for front in self.zone_fronts {
            front.write::<V>(self.unknowns, self.surfaces);
        }
    }
}

// Large functions, not inlined: one copy only, inlining multiplies compile time.
impl<S: Real> ZoneFronts<S> {
    /// The fronts of all zones; zones of one shape and their windows `together` side by side, or each alone and all of them
    /// eliminated. Numbers with derivatives are always eliminated.
    pub(crate) fn new(
        plan: &Plan,
        numbers: &Coefficients<S>,
        laws: &BySide<SurfaceLaws<S>>,
        [together, windows_together]: [bool; 2],
    ) -> Self {
        let iterated = together && !S::DERIVATIVES;
        let groups = group_zones(plan, numbers, together);
        let front = |(zones, members): &(Vec<usize>, usize)| {
            ZoneFront::new(plan, numbers, laws, (zones, *members), [iterated, windows_together])
        };
        let zone_fronts: Vec<_> = groups.iter().map(front).collect();
        Self {
            side_by_side: zone_fronts.iter().any(ZoneFront::side_by_side),
            windows_together: zone_fronts.iter().any(|front| front.windows.walls().next().is_some()),
            all: zone_fronts,
        }
    }

    /// Sets how the heat from the walls follows their surfaces.
    pub(crate) fn set_responses(&mut self, responses: &[Response<S>]) {
        for front in &mut self.all {
            front.exterior.set_responses(&front.layout, responses);
        }
    }

    /// Reads what drives a stage: conditions, ideal loads, and heat from the walls at surfaces of 0 degC [W/m2].
    #[inline(never)]
    pub(crate) fn begin_stage(&mut self, inputs: &StageInputs<'_, S>, sources: &[[S; 2]]) {
        let (conditions, zones) = (inputs.conditions, &inputs.model.coefficients.zones);
        S::vectorised(
            #[inline(always)]
            || {
                let radiant = |z: usize| {
                    let radiant = conditions.zones[z].radiant;
                    if zones[z].radiated_loads.is_some() {
                        return radiant + zones[z].load_parts(inputs.load[z])[1];
                    }
                    radiant
                };
                for front in &mut self.all {
                    front.begin(conditions, radiant, sources);
                }
            },
        );
    }

    /// Whether each wall is a window that is computed together with others here.
    pub(crate) fn windows_together(&self, walls: usize) -> Vec<bool> {
        let mut together = vec![false; walls];
        let windows = self.all.iter().flat_map(|front| front.windows.walls());
        windows.for_each(|wall| together[wall] = true);
        together
    }

    /// Reads what stays in a stage at these windows; `convection`: expected conductance of the gas in a wall [W/(m2 K)].
    #[inline(always)]
    pub(crate) fn begin_windows(&mut self, conditions: &Conditions<S>, convection: impl Fn(usize) -> S) {
        self.all.iter_mut().for_each(|front| front.windows.begin(conditions, &convection));
    }

    /// Writes these windows as they were linearised and solved to the walls.
    #[inline(always)]
    pub(crate) fn write_windows(&self, cells: &[S], walls: &mut [WallSystem<S>]) {
        self.all.iter().for_each(|front| front.windows.write_walls(cells, walls));
    }

    /// Takes over the other windows as they are linearised in an iteration: their heat into surfaces of 0 degC [W/m2], and how it follows
    /// the surfaces.
    #[inline(never)]
    pub(crate) fn set_windows(&mut self, sources: &[[S; 2]], responses: &[Response<S>]) {
        S::vectorised(
            #[inline(always)]
            || {
                for front in &mut self.all {
                    let places = (&front.layout, front.windows.singles());
                    front.exterior.set_windows(places, (sources, responses), &mut front.heat);
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
        let condense = iterate.filter(|_| self.windows_together);
        for zone_fronts in self.all.chunks_mut(BLOCK) {
            if let Some(iterate) = condense {
                S::in_chunks(Condense { zone_fronts, cells: &iterate.cells });
            }
            S::vectorised(
                #[inline(always)]
                || {
                    S::in_chunks(Eliminate { zone_fronts, iterate, elimination, constant });
                    if self.side_by_side {
                        S::in_chunks(SchurComplements { zone_fronts });
                    }
                    for front in zone_fronts.iter() {
                        front.add_schur_complement(elimination, constant, coupled);
                    }
                },
            );
        }
    }

    /// Solves for the eliminated surfaces, once the other unknowns are known; surfaces and cells are those of the building.
    #[inline(never)]
    pub(crate) fn solve(&mut self, constant: bool, unknowns: &mut [S], solution: &mut Unknowns<S>) {
        let Unknowns { surfaces, cells, .. } = solution;
        for zone_fronts in self.all.chunks_mut(BLOCK) {
            S::vectorised(
                #[inline(always)]
                || S::in_chunks(Solve { zone_fronts, constant, unknowns, surfaces }),
            );
            if self.windows_together {
                S::in_chunks(WriteWindows { zone_fronts, cells });
            }
        }
    }

    /// Surfaces and cells of the building from a solution of all unknowns that was found with the factors.
    #[inline(never)]
    pub(crate) fn write(&mut self, unknowns: &[S], solution: &mut Unknowns<S>) {
        let Unknowns { surfaces, cells, .. } = solution;
        for zone_fronts in self.all.chunks_mut(BLOCK) {
            S::vectorised(
                #[inline(always)]
                || S::in_chunks(Write { zone_fronts, unknowns, surfaces }),
            );
            if self.windows_together {
                S::in_chunks(WriteWindows { zone_fronts, cells });
            }
        }
    }

    /// Eliminates the surfaces of the fronts from another right-hand side.
    #[inline(never)]
    pub(crate) fn forward(&self, right: &mut [S]) {
        S::vectorised(
            #[inline(always)]
            || self.all.iter().for_each(|front| front.forward_in_building(right)),
        );
    }

    /// Solves for the eliminated surfaces of another right-hand side.
    #[inline(never)]
    pub(crate) fn back(&self, right: &mut [S]) {
        S::vectorised(
            #[inline(always)]
            || self.all.iter().for_each(|front| front.back_in_building(right)),
        );
    }

    /// Copies laws that were linearised elsewhere.
    pub(crate) fn copy_laws(&mut self, laws: &BySide<SurfaceLaws<S>>) {
        for front in &mut self.all {
            front.laws.copy_from(laws);
            front.exterior.laws.copy_from(laws);
        }
    }

    /// Writes the laws of the exterior surfaces, which the energy balance needs.
    #[inline(never)]
    pub(crate) fn write_exterior_laws(&self, laws: &mut BySide<SurfaceLaws<S>>) {
        self.all.iter().for_each(|front| front.exterior.laws.copy_to(laws));
    }

    /// Writes the laws of the surfaces in the zones.
    #[cfg(test)]
    pub(crate) fn laws_in_zones(&self, laws: &mut BySide<SurfaceLaws<S>>) {
        self.all.iter().for_each(|front| front.laws.copy_to(laws));
    }

    /// Writes the exterior surfaces as lines of the interior ones [degC], and how much they rise with heat [m2 K/W].
    #[inline(never)]
    pub(crate) fn write_exterior_surfaces(&self, surfaces: &mut [ExteriorSurfaces<S>], inverses: &mut [S]) {
        for front in &self.all {
            for (i, interior) in front.layout.walls.iter().enumerate().take(front.layout.exterior) {
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
        // A loop: a closure is not always inlined, and is then compiled without wide instructions.
        for front in &self.all {
            front.forward_values(right);
        }
    }

    /// Solves for the eliminated surfaces of right-hand sides of any kind.
    #[inline(always)]
    pub(crate) fn back_values<R: Real>(&self, right: &mut [R]) {
        // A loop: a closure is not always inlined, and is then compiled without wide instructions.
        for front in &self.all {
            front.back_values(right);
        }
    }

    /// The transpose of [`Self::back_values`].
    pub(crate) fn back_transposed(&self, weights: &mut [f64]) {
        self.all.iter().for_each(|front| front.back_transposed(weights));
    }

    /// The transpose of [`Self::forward_values`].
    pub(crate) fn forward_transposed(&self, weights: &mut [f64]) {
        self.all.iter().for_each(|front| front.forward_transposed(weights));
    }
}
