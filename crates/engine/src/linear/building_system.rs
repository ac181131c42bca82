//! The linear system of a stage: all walls, surfaces and airs of the building, the laws in it as straight lines.
//!
//! Walls are eliminated onto their surfaces, exterior surfaces onto the other surface of their wall, the surfaces of a
//! zone onto what it shares with the rest of the building ([`ZoneFronts`]), and what is left is solved as one small dense
//! system ([`CoupledSystem`]). Walls of constant properties are factored once for each stage length.

use crate::building::coefficients::{Boundary, BridgeEnd};
use crate::building::ids::{BySide, SideId};
use crate::building::model::Model;
use crate::building::plan::{Plan, SideRole};
use crate::linear::coupled::CoupledSystem;
use crate::linear::laws::{LinearisedLaws, StageInputs};
use crate::linear::surface_balance::{ExteriorBalance, ExteriorSurfaces, SurfaceLaws, solve_pair};
use crate::linear::thick_walls::ThickWalls;
use crate::linear::transition_matrices::TransitionMatrices;
use crate::linear::unknowns::Unknowns;
use crate::linear::wall::{Response, WallSystem};
use crate::linear::wall_factors::{FactorStore, InUse};
use crate::linear::zone_elimination::{Elimination, ZoneFronts};
use crate::number::line::Line;
use crate::number::real::{Mask, Real};
use crate::weather::conditions::Conditions;

/// The linear system of a stage, with its factors.
#[derive(Debug, Clone)]
pub(crate) struct BuildingSystem<'a, S> {
    /// The linearised walls and their elimination.
    pub(crate) walls: Vec<WallSystem<S>>,
    /// Steps of the linear walls.
    pub(crate) transition_matrices: TransitionMatrices<S>,
    /// How the heat from each wall follows its surfaces.
    pub(crate) responses: Vec<Response<S>>,
    /// Heat of the walls into their surfaces at surfaces of 0 degC [W/m2].
    pub(crate) sources: Vec<[S; 2]>,
    /// Effective stage length that walls are factored for [s]; NaN: none.
    pub(crate) factored_length: f64,
    /// Of other stage lengths.
    pub(crate) factors: FactorStore<S>,
    /// Surfaces outside the zones, as functions of those inside.
    pub(crate) exterior: Vec<ExteriorSurfaces<S>>,
    /// Rise of the exterior surface of each wall with heat, its other surface held [m2 K/W].
    pub(crate) inverses: Vec<S>,
    pub(crate) coupled: CoupledSystem<'a, S>,
    pub(crate) zone_fronts: ZoneFronts<S>,
    /// Nonlinear walls that are linearised and eliminated one by one, and those of them that are windows in zone fronts.
    pub(crate) single_walls: Vec<usize>,
    pub(super) single_windows: Vec<usize>,
    pub(crate) thick_walls: ThickWalls<S>,
    /// Places in the coupled matrix of the two entries between the surfaces of each wall; nowhere where there are none.
    across: Vec<[usize; 2]>,
}

impl<'a, S: Real> BuildingSystem<'a, S> {
    /// The system of a building with its constant laws, for a scheme's diagonal coefficient. `together`: zones of one shape are
    /// computed side by side; derivatives need them one by one.
    pub(crate) fn new(model: &Model<'a, S>, laws: &LinearisedLaws<S>, diagonal: f64, together: bool) -> Self {
        let (plan, coefficients) = (model.plan, &model.coefficients);
        let walls: Vec<_> = coefficients.walls.iter().map(WallSystem::new).collect();
        let count = plan.walls.len();
        let together = [together, together && !model.loads_by_responses()];
        let zone_fronts = ZoneFronts::new(plan, coefficients, &laws.surfaces, together);
        let windows_together = zone_fronts.windows_together(count);
        let single = |walls: &[usize]| walls.iter().copied().filter(|&w| !windows_together[w]).collect();
        Self {
            single_walls: single(&model.parts.nonlinear_walls),
            single_windows: single(&model.parts.front_windows),
            transition_matrices: TransitionMatrices::new(plan, coefficients, &walls, diagonal),
            walls,
            responses: vec![Response::none(); count],
            sources: vec![[S::zero(); 2]; count],
            factored_length: f64::NAN,
            factors: FactorStore::new(),
            exterior: vec![ExteriorSurfaces::None; count],
            inverses: vec![S::zero(); count],
            coupled: CoupledSystem::new(&plan.pattern, plan.own_rows, plan.constant_rows),
            zone_fronts,
            thick_walls: ThickWalls::new(model),
            across: (0..count).map(|w| entries_across(plan, w)).collect(),
        }
    }

    /// Factors the linear walls for a stage length [s], and prepares the nonlinear ones. True where that was not done
    /// before.
    #[inline(always)]
    pub(crate) fn factor_linear_walls(&mut self, model: &Model<'_, S>, length: f64) -> bool {
        let new = self.factored_length.to_bits() != length.to_bits();
        if new {
            let current = InUse {
                walls: &mut self.walls,
                transition_matrices: &mut self.transition_matrices,
                responses: &mut self.responses,
                length: &mut self.factored_length,
            };
            if !self.factors.exchange(length, current) {
                for &w in &model.parts.linear_walls {
                    self.responses[w] = self.walls[w].factor(&model.coefficients.walls[w], length);
                }
                for &w in &model.parts.nonlinear_walls {
                    self.walls[w].set_stage_length(&model.coefficients.walls[w], length);
                }
                self.transition_matrices.factor(&self.walls);
            }
            self.zone_fronts.set_responses(&self.responses);
            self.thick_walls.set_responses(&self.responses);
            self.factored_length = length;
        }
        new
    }

    /// Everything that stays during a stage: heat from the linear walls into their surfaces; and those surfaces
    /// eliminated, where their balances are linear. Cells are those at the start of the step.
    #[inline(always)]
    pub(crate) fn begin_stage(
        &mut self,
        inputs: &StageInputs<'_, S>,
        iterate: &Unknowns<S>,
        stage: usize,
        cells: &[S],
    ) {
        let parts = &inputs.model.parts;
        let matrix = self.factor_linear_walls(inputs.model, inputs.length) | parts.wind_changes_balances;
        if stage == 0 {
            self.transition_matrices.first_sources(&self.walls, cells, &mut self.sources);
        } else {
            self.transition_matrices.second_sources(&mut self.sources);
        }
        self.transition_matrices.release(stage, &inputs.conditions.heat_sources, &mut self.sources);
        self.zone_fronts.begin_stage(inputs, &self.sources);
        if !parts.nonlinear_balances {
            self.assemble_linear(inputs, matrix, Some(iterate));
        }
    }

    /// Eliminates the cells of a nonlinear wall, linearised and with the enthalpies that they start from [J/m3].
    #[inline(always)]
    pub(crate) fn condense(
        &mut self,
        model: &Model<'_, S>,
        conditions: &Conditions<S>,
        w: usize,
        enthalpy: &[S],
    ) {
        let condensed = match model.plan.walls[w].window {
            // Solar radiation absorbed in the panes.
            Some(window) => self.walls[w].condense_heated(enthalpy, &conditions.sun.windows[window].cells),
            None if self.walls[w].has_sources() => self.walls[w].condense_with_sources(enthalpy),
            None => self.walls[w].condense(enthalpy),
        };
        (self.sources[w], self.responses[w]) = (condensed.source, condensed.response);
    }

    /// Solves the linearised building: airs, nonlinear walls and their surfaces; the surfaces of linear walls, too, where the
    /// next iteration depends on them.
    #[inline(always)]
    pub(crate) fn solve(
        &mut self,
        inputs: &StageInputs<'_, S>,
        iterate: &Unknowns<S>,
        solution: &mut Unknowns<S>,
    ) {
        let model = inputs.model;
        let again = model.parts.nonlinear_balances || !self.thick_walls.is_empty();
        if again {
            self.assemble_linear(inputs, !model.parts.balances_stay(), Some(iterate));
        }
        self.assemble_nonlinear(inputs);
        self.coupled.solve_rest();
        self.resolve_airs(model, solution);
        for &w in &model.parts.coupled_walls {
            self.resolve_wall(model, w, solution);
        }
        if again {
            self.resolve_linear_walls(model, solution);
        }
    }

    /// Adds what the surfaces of thick walls have changed since the iterate. Returns what had been lacking [W/m2].
    #[inline(always)]
    pub(crate) fn couple_thick_walls(
        &mut self,
        model: &Model<'_, S>,
        iterate: &Unknowns<S>,
        solution: &mut Unknowns<S>,
    ) -> S {
        if self.thick_walls.is_empty() {
            return S::zero();
        }
        let load_residual_before = self.thick_walls.heat_since(iterate, solution);
        let (mut lacking, mut round) = (load_residual_before, S::zero());
        loop {
            let lanes = self.thick_walls.load_residual(lacking, load_residual_before, round);
            if !lanes.any() {
                break;
            }
            self.thick_walls.keep_heat(lanes);
            let mut heat = core::mem::take(&mut self.thick_walls.heat);
            self.solve_without_thick_walls(&mut heat);
            for (unknown, &change) in self.coupled.right.iter_mut().zip(&heat) {
                *unknown += change;
            }
            self.thick_walls.heat = heat;
            lacking = self.thick_walls.heat_of_change();
            round += S::one();
        }
        if S::zero().lt(round).any() {
            self.resolve_all(model, solution);
        }
        load_residual_before
    }

    /// Solves for the unknowns that [`Self::solve`] does not compute, and copies exterior surfaces of the zone fronts to others;
    /// with `laws`, for the energy balance, theirs and the windows, too. False in the lanes where a wall that touches no zone is not a number.
    #[inline(always)]
    pub(crate) fn finish(
        &mut self,
        model: &Model<'_, S>,
        laws: Option<&mut BySide<SurfaceLaws<S>>>,
        solution: &mut Unknowns<S>,
    ) -> S::Mask {
        if !model.parts.nonlinear_balances && self.thick_walls.is_empty() {
            self.resolve_linear_walls(model, solution);
        }
        if let Some(laws) = laws {
            if !model.parts.balances_stay() {
                self.zone_fronts.write_exterior_laws(laws);
            }
            self.zone_fronts.write_windows(&solution.cells, &mut self.walls);
        }
        if S::DERIVATIVES || model.loads_by_responses() {
            self.zone_fronts.write_exterior_surfaces(&mut self.exterior, &mut self.inverses);
        }
        let mut sum = S::zero();
        for &w in &model.parts.detached_walls {
            sum += solution.surfaces[SideId::outside(w)] + solution.surfaces[SideId::inside(w)];
        }
        sum.abs().lt(S::constant(f64::MAX))
    }

    /// Assembles the linear walls, and convection and radiation in zones, and eliminates the surfaces of the former; without
    /// `matrix` only the right-hand sides. Nonlinear laws along their tangents at the iterate; without one as they are.
    #[inline(always)]
    pub(crate) fn assemble_linear(
        &mut self,
        inputs: &StageInputs<'_, S>,
        matrix: bool,
        iterate: Option<&Unknowns<S>>,
    ) {
        let parts = &inputs.model.parts;
        self.coupled.clear_right();
        if matrix {
            self.coupled.clear_matrix();
        }
        for &w in &parts.shared_walls {
            self.exterior[w] = self.eliminate_wall(inputs, w, matrix);
        }
        if !self.single_windows.is_empty() {
            self.zone_fronts.set_windows(&self.sources, &self.responses);
        }
        let elimination = if matrix { Elimination::Full } else { Elimination::RightHandSide };
        self.zone_fronts.eliminate(iterate, elimination, parts.balances_stay(), &mut self.coupled);
        if matrix {
            self.coupled.keep_matrix();
        }
        self.coupled.keep_right();
    }

    /// Assembles what changes from iteration to iteration: the nonlinear walls that no front eliminates, and all that acts on airs.
    #[inline(always)]
    pub(crate) fn assemble_nonlinear(&mut self, inputs: &StageInputs<'_, S>) {
        let model = inputs.model;
        self.coupled.begin();
        for &w in &model.parts.coupled_walls {
            self.exterior[w] = self.eliminate_wall(inputs, w, true);
        }
        for zone in 0..model.plan.zones.len() {
            self.assemble_air(inputs, zone);
        }
        for (path, &conductance) in model.coefficients.paths.iter().zip(&inputs.conditions.paths) {
            let [a, b] = path.between.map(|zone| model.plan.zones[zone].air_row);
            self.coupled.couple(a, b, conductance);
        }
        self.assemble_exchanges(inputs);
    }

    /// Doors, air that fans carry from zone to zone, and thermal bridges.
    #[inline(always)]
    fn assemble_exchanges(&mut self, inputs: &StageInputs<'_, S>) {
        let (model, conditions) = (inputs.model, inputs.conditions);
        let row = |zone: usize| model.plan.zones[zone].air_row;
        for (door, line) in model.coefficients.doors.iter().zip(&inputs.laws.doors) {
            let [a, b] = door.between.map(row);
            self.coupled.couple(a, b, line.slope);
            self.coupled.right[a] += -line.offset;
            self.coupled.right[b] += line.offset;
        }
        let carries = &model.coefficients.mechanical_air.carries;
        for (ends, &conductance) in carries.iter().zip(&conditions.mechanical_air.carried) {
            let [from, to] = ends.map(row);
            self.coupled.add_diagonal(from, conductance);
            self.coupled.add(to, from, -conductance);
            let at_outdoors = conductance * conditions.outdoor_air;
            self.coupled.right[from] += at_outdoors;
            self.coupled.right[to] += -at_outdoors;
        }
        for (bridge, &temperature) in model.coefficients.bridges.iter().zip(&conditions.bridges) {
            let air = row(bridge.zone);
            if let BridgeEnd::Zone(other) = bridge.to {
                self.coupled.couple(air, row(other), bridge.conductance);
            } else if let Some(temperature) = temperature {
                self.coupled.add_diagonal(air, bridge.conductance);
                self.coupled.right[air] += bridge.conductance * temperature;
            }
        }
    }

    /// Storage of the air of a zone, outdoor air that enters it, and the heat released into it.
    #[inline(always)]
    fn assemble_air(&mut self, inputs: &StageInputs<'_, S>, zone: usize) {
        let (air, numbers) = (inputs.model.plan.zones[zone].air_row, &inputs.model.coefficients.zones[zone]);
        let (infiltration, ventilation) = (inputs.laws.infiltration[zone], inputs.laws.ventilation[zone]);
        let entering = Line {
            offset: infiltration.offset + ventilation.offset,
            slope: infiltration.slope + ventilation.slope,
        };
        let storage = numbers.capacity.scale(1.0 / inputs.length);
        self.coupled.add_diagonal(air, storage + entering.slope);
        let mut right = self.coupled.right[air];
        right +=
            storage * inputs.air[zone] + entering.offset + entering.slope * inputs.conditions.outdoor_air;
        let [load, _] = numbers.load_parts(inputs.load[zone]);
        right += inputs.conditions.zones[zone].convective + load;
        if let Some(&sun) = inputs.conditions.sun.to_air.get(zone) {
            right += sun;
        }
        if let Some(holding) = inputs.holding.get(zone) {
            self.coupled.add_diagonal(air, holding.slope);
            right += holding.offset;
        }
        self.coupled.right[air] = right;
    }

    /// Adds a wall to the coupled system, its exterior surfaces eliminated.
    #[inline(always)]
    fn eliminate_wall(&mut self, inputs: &StageInputs<'_, S>, w: usize, matrix: bool) -> ExteriorSurfaces<S> {
        let model = inputs.model;
        let (source, response) = (self.sources[w], self.responses[w]);
        let area = model.coefficients.walls[w].area;
        let roles = SideId::pair(w).map(|surface| model.plan.surfaces[surface].role);
        match roles {
            [SideRole::Exterior, SideRole::Exterior] => {
                let [outer, inner] = SideId::pair(w)
                    .map(|surface| exterior_balance(model, inputs.conditions, inputs.laws, surface));
                ExteriorSurfaces::Both(solve_pair(outer, inner, source, &response))
            }
            [SideRole::Zone { row: outer, .. }, SideRole::Zone { row: inner, .. }] => {
                for (e, mine) in [outer, inner].into_iter().enumerate() {
                    if matrix {
                        self.coupled.add_diagonal(mine, -(area * response.own(e)));
                        self.coupled.add_at(self.across[w][e], -(area * response.other(e)));
                    }
                    self.coupled.right[mine] += area * source[e];
                }
                ExteriorSurfaces::None
            }
            [SideRole::Zone { row, .. }, SideRole::Exterior] => {
                self.eliminate_one(inputs, SideId::outside(w), row, matrix)
            }
            [SideRole::Exterior, SideRole::Zone { row, .. }] => {
                self.eliminate_one(inputs, SideId::inside(w), row, matrix)
            }
        }
    }

    /// A wall with one surface in a zone, in a row, whose other surface is exterior.
    #[inline(always)]
    fn eliminate_one(
        &mut self,
        inputs: &StageInputs<'_, S>,
        surface: SideId,
        row: usize,
        matrix: bool,
    ) -> ExteriorSurfaces<S> {
        let (w, e, o) = (surface.wall(), surface.side(), surface.opposite().side());
        let (source, response, area) =
            (self.sources[w], self.responses[w], inputs.model.coefficients.walls[w].area);
        let balance = exterior_balance(inputs.model, inputs.conditions, inputs.laws, surface.opposite());
        let slope = match (balance, self.exterior[w]) {
            (ExteriorBalance::Fixed(_), _) => S::zero(),
            (ExteriorBalance::Gain(_), ExteriorSurfaces::One { line, .. }) if !matrix => line.slope,
            (ExteriorBalance::Gain(gain), _) => {
                self.inverses[w] = S::one() / (gain.slope - response.own(o));
                response.other(o) * self.inverses[w]
            }
        };
        let offset = match balance {
            ExteriorBalance::Fixed(value) => value,
            ExteriorBalance::Gain(gain) => (source[o] + gain.offset) * self.inverses[w],
        };
        if matrix {
            // Heat that leaves the surface in the zone and does not come back, as in `zone_elimination::exterior`.
            let lost = match balance {
                ExteriorBalance::Fixed(_) => -response.own(e),
                ExteriorBalance::Gain(gain) => response.stored[e] + slope * (gain.slope + response.stored[o]),
            };
            self.coupled.add_diagonal(row, area * lost);
        }
        self.coupled.right[row] += area * (source[e] + response.other(e) * offset);
        ExteriorSurfaces::One { side: o, line: Line { offset, slope } }
    }
}

/// Places in the coupled matrix of the entries between the two surfaces of a wall, in the rows of the outside and of the inside
/// surface; nowhere where these are not both unknowns of it.
fn entries_across(plan: &Plan, w: usize) -> [usize; 2] {
    let rows = SideId::pair(w).map(|surface| match plan.surfaces[surface].role {
        SideRole::Zone { row, .. } => row.checked_sub(plan.own_rows),
        SideRole::Exterior => None,
    });
    let place = |[row, column]: [Option<usize>; 2]| plan.pattern.place(row?, column?);
    [rows, [rows[1], rows[0]]].map(|entry| place(entry).unwrap_or(plan.pattern.nowhere()))
}

/// Whether an exterior surface has an imposed temperature.
#[inline(always)]
pub(crate) fn is_held<S: Real>(model: &Model<'_, S>, index: SideId) -> bool {
    let surface = &model.coefficients.surfaces[index];
    surface.convection.is_none() && matches!(surface.boundary, Boundary::Imposed(_))
}

/// Heat from outside into an exterior surface, `offset - slope T` [W/m2], or the temperature that it is held at.
#[inline(always)]
pub(crate) fn exterior_balance<S: Real>(
    model: &Model<'_, S>,
    conditions: &Conditions<S>,
    laws: &LinearisedLaws<S>,
    index: SideId,
) -> ExteriorBalance<S> {
    let surface = &model.coefficients.surfaces[index];
    let (at, laws) = (&conditions.surfaces[index], &laws.surfaces[index]);
    match surface.boundary {
        Boundary::Imposed(_) if surface.convection.is_none() => ExteriorBalance::Fixed(at.temperature),
        Boundary::Adiabatic => {
            ExteriorBalance::Gain(Line { offset: at.solar + at.longwave, slope: S::zero() })
        }
        _ => ExteriorBalance::Gain(Line {
            offset: at.solar + at.longwave + laws.convection.slope * at.temperature
                - laws.convection.offset
                - surface.emissivity * laws.emission.offset,
            slope: laws.convection.slope + surface.emissivity * laws.emission.slope,
        }),
    }
}
