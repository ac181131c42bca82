//! The solution of the linear system of a stage: temperatures from that of the coupled system, and other right-hand sides.

use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::linear::building_system::BuildingSystem;
use crate::linear::surface_balance::ExteriorSurfaces;
use crate::linear::unknowns::Unknowns;
use crate::number::real::Real;

impl<S: Real> BuildingSystem<'_, S> {
    /// Airs from the solution of the coupled system.
    #[inline(always)]
    pub(super) fn resolve_airs(&self, model: &Model<'_, S>, solution: &mut Unknowns<S>) {
        for (zone, plan) in model.plan.zones.iter().enumerate() {
            solution.air[zone] = self.coupled.right[plan.air_row];
        }
    }

    /// Surfaces of the linear walls.
    #[inline(always)]
    pub(super) fn resolve_linear_walls(&mut self, model: &Model<'_, S>, solution: &mut Unknowns<S>) {
        self.coupled.solve_first();
        let stays = model.parts.balances_stay();
        self.zone_fronts.solve(stays, &mut self.coupled.right, solution);
        self.resolve_single_windows(model, solution);
        for &w in &model.parts.shared_walls {
            let surfaces = self.resolve_surfaces(model, w);
            solution.surfaces.set_pair(w, surfaces);
        }
    }

    /// Cells of the windows whose surfaces zone fronts have solved for.
    #[inline(always)]
    pub(super) fn resolve_single_windows(&mut self, model: &Model<'_, S>, solution: &mut Unknowns<S>) {
        for &w in &self.single_windows {
            let surfaces = solution.surfaces.pair(w);
            self.walls[w].temperatures(surfaces, &mut solution.cells[model.cells(w)]);
        }
    }

    /// Surfaces of a nonlinear wall and its cells.
    #[inline(always)]
    pub(super) fn resolve_wall(&mut self, model: &Model<'_, S>, w: usize, solution: &mut Unknowns<S>) {
        let surfaces = self.resolve_surfaces(model, w);
        solution.surfaces.set_pair(w, surfaces);
        self.walls[w].temperatures(surfaces, &mut solution.cells[model.cells(w)]);
    }

    /// All airs and surfaces, and the cells of nonlinear walls, from the solution of the coupled system.
    #[inline(always)]
    pub(crate) fn resolve_all(&mut self, model: &Model<'_, S>, solution: &mut Unknowns<S>) {
        self.resolve_airs(model, solution);
        for &w in &model.parts.coupled_walls {
            self.resolve_wall(model, w, solution);
        }
        self.zone_fronts.write(&self.coupled.right, solution);
        self.resolve_single_windows(model, solution);
        self.zone_fronts.write_windows(&solution.cells, &mut self.walls);
        for &w in &model.parts.shared_walls {
            let surfaces = self.resolve_surfaces(model, w);
            solution.surfaces.set_pair(w, surfaces);
        }
    }

    /// Both surfaces of a wall.
    #[inline(always)]
    pub(super) fn resolve_surfaces(&self, model: &Model<'_, S>, w: usize) -> [S; 2] {
        let of_zone = |surface: SideId| self.coupled.right[model.plan.row(surface)];
        match self.exterior[w] {
            ExteriorSurfaces::Both(surfaces) => surfaces,
            ExteriorSurfaces::None => SideId::pair(w).map(of_zone),
            ExteriorSurfaces::One { side: 0, line } => {
                let inner = of_zone(SideId::inside(w));
                [line.at(inner), inner]
            }
            ExteriorSurfaces::One { line, .. } => {
                let outer = of_zone(SideId::outside(w));
                [outer, line.at(outer)]
            }
        }
    }

    /// Solves the coupled system and the zone fronts for another right-hand side, with the factors already computed.
    #[inline(always)]
    pub(crate) fn solve_again(&self, right: &mut [S]) {
        self.solve_without_thick_walls(right);
        if !self.thick_walls.is_empty() {
            self.thick_walls.complete(right, |right| self.solve_without_thick_walls(right));
        }
    }

    /// [`Self::solve_again`] for heat into airs alone: the fronts have nothing to eliminate.
    #[inline(always)]
    pub(crate) fn solve_for_airs(&self, right: &mut [S]) {
        if !self.thick_walls.is_empty() {
            return self.solve_again(right);
        }
        self.coupled.solve_again(right);
        self.zone_fronts.back(right);
    }

    /// The same where the surfaces that fronts eliminate are not asked for.
    #[inline(always)]
    pub(crate) fn solve_airs_alone(&self, right: &mut [S]) {
        if !self.thick_walls.is_empty() {
            return self.solve_again(right);
        }
        self.coupled.solve_again(right);
    }

    /// [`Self::solve_again`] without what the surfaces of thick walls add to each other: nearly the solution.
    #[inline(always)]
    pub(crate) fn solve_without_thick_walls(&self, right: &mut [S]) {
        self.zone_fronts.forward(right);
        self.coupled.solve_again(right);
        self.zone_fronts.back(right);
    }
}
