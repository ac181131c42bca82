//! How a building responds to one watt of an ideal load in a step, from the factors of its stages.

use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::building::plan::SideRole;
use crate::linear::building_system::{BuildingSystem, is_held};
use crate::linear::surface_balance::ExteriorSurfaces;
use crate::linear::unknowns::Unknowns;
use crate::number::real::Real;

/// Response of a building to one watt of one load over the step.
#[derive(Debug, Clone)]
pub(crate) struct Response<S> {
    /// Of the temperatures at the end of each stage [K/W].
    pub(super) stages: Vec<Unknowns<S>>,
    /// Of what the set points of each zone hold at the end of the step [K/W]; empty where that is the air everywhere.
    pub(super) controlled: Vec<S>,
    /// Of the enthalpies that the second stage starts from [J/(m3 W)].
    held: Vec<S>,
    /// Forward sweeps of the nonlinear walls.
    known: Vec<S>,
    /// Right-hand side, then solution, of the coupled system.
    pub(super) right: Vec<S>,
    /// Of the heat from the walls into their surfaces in the second stage [1/m2].
    sources: Vec<[S; 2]>,
}

impl<S: Real> Response<S> {
    /// In a building whose set points hold operative temperatures, or airs alone.
    pub(super) fn new(unknowns: &Unknowns<S>, rows: usize, stages: usize, operative: bool) -> Self {
        let zeros = |n: usize| vec![S::zero(); n];
        Self {
            controlled: zeros(if operative { unknowns.air.len() } else { 0 }),
            stages: vec![unknowns.clone(); stages],
            held: zeros(unknowns.cells.len()),
            known: zeros(unknowns.cells.len()),
            right: zeros(rows),
            sources: vec![[S::zero(); 2]; unknowns.surfaces.len() / 2],
        }
    }

    /// One watt of a load, of the sign of the present one, into the air of a zone and onto its surfaces.
    #[inline(always)]
    fn set_unit(&mut self, model: &Model<'_, S>, (zone, load): (usize, S)) {
        self.right.fill(S::zero());
        let (plan, numbers) = (&model.plan.zones[zone], &model.coefficients.zones[zone]);
        self.right[plan.air_row] = S::one();
        let Some(radiated) = numbers.radiated_part(load) else { return };
        self.right[plan.air_row] = S::one() - radiated;
        for (&surface, &share) in plan.surfaces.iter().zip(&numbers.radiant_shares) {
            self.right[model.plan.row(surface)] = share * radiated;
        }
    }

    /// Response of the stage just solved, of a length [s], to the load of a zone, of which the present value [W] tells
    /// whether it heats or cools; `ratio` as in [`Tableau`](crate::step::scheme::Tableau).
    #[inline(always)]
    pub(super) fn find(
        &mut self,
        model: &Model<'_, S>,
        system: &BuildingSystem<'_, S>,
        of_zone: (usize, S),
        stage: usize,
        (length, ratio): (f64, f64),
    ) {
        self.set_unit(model, of_zone);
        if stage > 0 {
            self.carry_over(model, system, length, ratio);
        } else {
            self.known.fill(S::zero());
        }
        system.solve_again(&mut self.right);
        self.set_temperatures(model, system, stage, ratio);
        self.set_controlled(model, of_zone);
    }

    /// Response of the airs at the end of the step to a load in the last stage only.
    #[inline(always)]
    pub(super) fn find_last(
        &mut self,
        model: &Model<'_, S>,
        system: &BuildingSystem<'_, S>,
        of_zone: (usize, S),
    ) {
        self.set_unit(model, of_zone);
        system.solve_again(&mut self.right);
        let last = self.stages.len() - 1;
        for (air, plan) in self.stages[last].air.iter_mut().zip(&model.plan.zones) {
            *air = self.right[plan.air_row];
        }
        self.set_controlled(model, of_zone);
    }

    /// What the set points hold in the stage just solved, where that is not the air everywhere.
    #[inline(always)]
    fn set_controlled(&mut self, model: &Model<'_, S>, (own, load): (usize, S)) {
        let Self { controlled, right, .. } = self;
        for (zone, rise) in controlled.iter_mut().enumerate() {
            let (plan, numbers) = (&model.plan.zones[zone], &model.coefficients.zones[zone]);
            let surfaces = plan.surfaces.iter().map(|&surface| right[model.plan.row(surface)]);
            let radiated = numbers.radiated_part(load).filter(|_| zone == own).unwrap_or_else(S::zero);
            *rise = numbers.held_temperature(|&number| number, (surfaces, right[plan.air_row]), radiated);
        }
    }

    /// What the set points of a zone hold at the end of the step [K/W].
    #[inline(always)]
    pub(super) fn gain(&self, zone: usize) -> S {
        match self.controlled.get(zone) {
            Some(&rise) => rise,
            None => self.stages[self.stages.len() - 1].air[zone],
        }
    }

    /// The effect of the response of the first stage on the second: heat stored in walls and airs.
    #[inline(always)]
    fn carry_over(&mut self, model: &Model<'_, S>, system: &BuildingSystem<'_, S>, length: f64, ratio: f64) {
        let Self { stages, held, known, right, sources, .. } = self;
        let first = &stages[0];
        for (zone, plan) in model.plan.zones.iter().enumerate() {
            let storage = model.coefficients.zones[zone].capacity.scale(ratio / length);
            right[plan.air_row] += storage * first.air[zone];
        }
        for (w, carried) in system.transition_matrices.carried() {
            let [outside, inside] = first.surfaces.pair(w);
            sources[w] = carried.map(|[a, b]| a * outside + b * inside);
        }
        for (w, wall) in model.plan.walls.iter().enumerate() {
            if wall.nonlinear {
                let cells = model.cells(w);
                let (held, known) = (&held[cells.clone()], &mut known[cells]);
                sources[w] = system.walls[w].source_changes(held, known);
            }
            let source = sources[w];
            let area = model.coefficients.walls[w].area;
            for e in 0..2 {
                let SideRole::Zone { row, .. } = model.plan.surfaces[SideId::new(w, e)].role else {
                    continue;
                };
                let mut heat = source[e];
                if let ExteriorSurfaces::One { side, .. } = system.exterior[w] {
                    let rise = exterior_rise(model, system, SideId::new(w, side), source[side]);
                    heat += system.responses[w].other(e) * rise;
                }
                right[row] += area * heat;
            }
        }
    }

    /// All surfaces, and the cells of nonlinear walls, from the solution of the coupled system.
    #[inline(always)]
    fn set_temperatures(
        &mut self,
        model: &Model<'_, S>,
        system: &BuildingSystem<'_, S>,
        stage: usize,
        ratio: f64,
    ) {
        let Self { stages, held, known, right, sources, .. } = self;
        let rise = &mut stages[stage];
        for (zone, plan) in model.plan.zones.iter().enumerate() {
            rise.air[zone] = right[plan.air_row];
        }
        for (w, wall) in model.plan.walls.iter().enumerate() {
            let mut surfaces = [S::zero(); 2];
            for (e, surface) in surfaces.iter_mut().enumerate() {
                if let SideRole::Zone { row, .. } = model.plan.surfaces[SideId::new(w, e)].role {
                    *surface = right[row];
                }
            }
            if let ExteriorSurfaces::One { side, line } = system.exterior[w] {
                let source = if stage > 0 { sources[w][side] } else { S::zero() };
                surfaces[side] = line.slope * surfaces[1 - side]
                    + exterior_rise(model, system, SideId::new(w, side), source);
            }
            rise.surfaces.set_pair(w, surfaces);
            if !wall.nonlinear {
                continue;
            }
            let cells = model.cells(w);
            let chain = &system.walls[w];
            chain.temperature_changes(&known[cells.clone()], surfaces, &mut rise.cells[cells.clone()]);
            if stage == 0 {
                for (i, k) in cells.enumerate() {
                    held[k] = chain.storage[i].capacity * rise.cells[k].scale(ratio);
                }
            }
        }
    }
}

/// Rise of an exterior surface by the heat from its wall, at a constant temperature of the other surface [K].
#[inline(always)]
fn exterior_rise<S: Real>(
    model: &Model<'_, S>,
    system: &BuildingSystem<'_, S>,
    surface: SideId,
    source: S,
) -> S {
    if is_held(model, surface) { S::zero() } else { source * system.inverses[surface.wall()] }
}
