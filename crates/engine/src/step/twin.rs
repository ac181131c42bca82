//! The plain twin of a stepper that carries derivatives: the matrix of a stage as a run has it, and solving with it.
//!
//! Unknowns and equations are those of all cells, all surfaces and all airs, in this order. Heat released in cells and at
//! surfaces outside the zones counts per square metre, at surfaces and airs of zones whole; the equation of a surface that is held
//! at a temperature is that temperature.

use crate::building::coefficients::Boundary;
use crate::building::ids::SurfaceId;
use crate::building::plan::SurfaceRole;
use crate::linear::surface_balance::{ExteriorSurfaces, SurfaceLaws};
use crate::number::line::Line;
use crate::number::real::{LinearSystem, Real};

use super::Stepper;

impl LinearSystem for Stepper<'_, f64> {
    #[inline(always)]
    fn solve<R: Real>(&self, rows: &mut [R], scratch: &mut Vec<R>) {
        self.solve_beside(rows, scratch);
    }
}

impl Stepper<'_, f64> {
    /// Takes over the values of a linearisation and factors its matrix.
    #[inline(always)]
    pub(super) fn adopt<S: Real>(&mut self, other: &Stepper<'_, S>, length: f64, new: bool) {
        for (mine, theirs) in self.laws.iter_mut().zip(&other.laws) {
            *mine = SurfaceLaws {
                convection: Line::of(&theirs.convection),
                emission: Line::of(&theirs.emission),
            };
        }
        let enter = |mine: &mut [Line<f64>], theirs: &[Line<S>]| {
            for (mine, theirs) in mine.iter_mut().zip(theirs) {
                *mine = Line::of(theirs);
            }
        };
        enter(&mut self.inflow, &other.inflow);
        enter(&mut self.airing, &other.airing);
        for (mine, theirs) in self.conditions.paths.iter_mut().zip(&other.conditions.paths) {
            *mine = theirs.lane(0);
        }
        if self.changing.curved || self.changing.by_wind || new {
            self.zone_fronts.adopt(&self.laws);
            self.enter_constant(true, false);
            self.zone_fronts.tell_locals(&mut self.locals, &mut self.inverses);
        }
        for i in 0..self.changing.walls.len() {
            let w = self.changing.walls[i];
            self.chains[w].adopt(&other.chains[w]);
            self.responses[w] = self.chains[w].factor(&self.coefficients.walls[w], length);
        }
        self.enter_changing(length);
        self.block.solve_rest();
    }

    /// What of the heat that a wall sends into a surface enters the equation of that surface [-], in zones [m2].
    #[inline(always)]
    pub(super) fn takes(&self, surface: SurfaceId) -> f64 {
        match self.plan.surfaces[surface].role {
            SurfaceRole::Zone { .. } => self.coefficients.walls[surface.wall()].area,
            SurfaceRole::Exterior if self.held_at(surface) => 0.0,
            SurfaceRole::Exterior => 1.0,
        }
    }

    /// Whether a local surface is held at a temperature.
    #[inline(always)]
    fn held_at(&self, surface: SurfaceId) -> bool {
        let numbers = &self.coefficients.surfaces[surface];
        numbers.convection.is_none() && matches!(numbers.boundary, Boundary::Imposed(_))
    }

    /// How much a local surface gives way, the other surface of its wall held.
    #[inline(always)]
    fn yields(&self, surface: SurfaceId) -> f64 {
        if self.held_at(surface) { 1.0 } else { self.inverses[surface.wall()] }
    }

    /// The matrix of a wall that touches no zone, and one over its determinant.
    #[inline(always)]
    fn pair(&self, w: usize) -> ([[f64; 2]; 2], f64) {
        let response = self.responses[w];
        let ([a, b], _) = self.local_balance(SurfaceId::outside(w)).equation(0, [0.0; 2], response);
        let ([d, c], _) = self.local_balance(SurfaceId::inside(w)).equation(1, [0.0; 2], response);
        ([[a, b], [c, d]], 1.0 / (a * d - b * c))
    }

    /// Replaces the right-hand sides of all equations (cells, surfaces, airs) by their solution.
    #[inline(always)]
    pub(crate) fn solve_beside<R: Real>(&self, rows: &mut [R], block: &mut Vec<R>) {
        let (cells, rest) = rows.split_at_mut(self.plan.n_cells);
        let (surfaces, air) = rest.split_at_mut(self.plan.surfaces.len());
        block.clear();
        block.resize(self.plan.rows(), R::zero());
        for (w, wall) in self.plan.walls.iter().enumerate() {
            let heat = self.chains[w].forward(&mut cells[wall.first_cell..wall.first_cell + wall.len()]);
            for e in 0..2 {
                surfaces[SurfaceId::new(w, e).index()] += heat[e].scale(self.takes(SurfaceId::new(w, e)));
                if let SurfaceRole::Zone { row, .. } = self.plan.surfaces[SurfaceId::new(w, e)].role {
                    block[row] += surfaces[SurfaceId::new(w, e).index()];
                }
            }
            match self.locals[w] {
                ExteriorSurfaces::None => {}
                ExteriorSurfaces::One { side, .. } => {
                    let (local, zone) = (SurfaceId::new(w, side), SurfaceId::new(w, 1 - side));
                    surfaces[local.index()] = surfaces[local.index()].scale(self.yields(local));
                    let gain = self.coefficients.walls[w].area * self.responses[w][1 - side][side];
                    block[self.plan.row(zone)] += surfaces[local.index()].scale(gain);
                }
                ExteriorSurfaces::Both(_) => {
                    let ([[a, b], [c, d]], inverse) = self.pair(w);
                    let [f, g] = [
                        surfaces[SurfaceId::outside(w).index()].scale(inverse),
                        surfaces[SurfaceId::inside(w).index()].scale(inverse),
                    ];
                    (surfaces[SurfaceId::outside(w).index()], surfaces[SurfaceId::inside(w).index()]) =
                        (f.scale(d) - g.scale(b), g.scale(a) - f.scale(c));
                }
            }
        }
        for (zone, &air) in self.plan.zones.iter().zip(air.iter()) {
            block[zone.air_row] = air;
        }
        self.zone_fronts.forward_beside(block);
        self.block.solve_beside(block);
        self.zone_fronts.back_beside(block);
        for (zone, air) in self.plan.zones.iter().zip(air) {
            *air = block[zone.air_row];
        }
        for (w, wall) in self.plan.walls.iter().enumerate() {
            for surface in SurfaceId::pair(w) {
                if let SurfaceRole::Zone { row, .. } = self.plan.surfaces[surface].role {
                    surfaces[surface.index()] = block[row];
                }
            }
            if let ExteriorSurfaces::One { side, line } = self.locals[w] {
                let zone = surfaces[SurfaceId::new(w, 1 - side).index()].scale(line.slope);
                surfaces[SurfaceId::new(w, side).index()] += zone;
            }
            let own = &mut cells[wall.first_cell..wall.first_cell + wall.len()];
            self.chains[w].back(SurfaceId::pair(w).map(|surface| surfaces[surface.index()]), own);
        }
    }

    /// Replaces weights on all unknowns by weights on their equations: the transpose of [`Self::solve_beside`].
    pub(super) fn solve_transposed(&self, rows: &mut [f64], block: &mut Vec<f64>) {
        let (cells, rest) = rows.split_at_mut(self.plan.n_cells);
        let (surfaces, air) = rest.split_at_mut(self.plan.surfaces.len());
        block.clear();
        block.resize(self.plan.rows(), 0.0);
        for (w, wall) in self.plan.walls.iter().enumerate() {
            let own = &mut cells[wall.first_cell..wall.first_cell + wall.len()];
            let weights = self.chains[w].back_transposed(own);
            for e in 0..2 {
                surfaces[SurfaceId::new(w, e).index()] += weights[e];
            }
            match self.locals[w] {
                ExteriorSurfaces::None => {}
                ExteriorSurfaces::One { side, line } => {
                    let local = SurfaceId::new(w, side);
                    surfaces[local.opposite().index()] += line.slope * surfaces[local.index()];
                    surfaces[local.index()] *= self.yields(local);
                }
                ExteriorSurfaces::Both(_) => {
                    let ([[a, b], [c, d]], inverse) = self.pair(w);
                    let [f, g] = [
                        surfaces[SurfaceId::outside(w).index()] * inverse,
                        surfaces[SurfaceId::inside(w).index()] * inverse,
                    ];
                    (surfaces[SurfaceId::outside(w).index()], surfaces[SurfaceId::inside(w).index()]) =
                        (f * d - g * c, g * a - f * b);
                }
            }
            for surface in SurfaceId::pair(w) {
                if let SurfaceRole::Zone { row, .. } = self.plan.surfaces[surface].role {
                    block[row] += surfaces[surface.index()];
                }
            }
        }
        for (zone, &air) in self.plan.zones.iter().zip(air.iter()) {
            block[zone.air_row] = air;
        }
        self.zone_fronts.back_transposed(block);
        self.block.solve_transposed(block);
        self.zone_fronts.forward_transposed(block);
        for (zone, air) in self.plan.zones.iter().zip(air) {
            *air = block[zone.air_row];
        }
        for (w, wall) in self.plan.walls.iter().enumerate() {
            for surface in SurfaceId::pair(w) {
                if let SurfaceRole::Zone { row, .. } = self.plan.surfaces[surface].role {
                    surfaces[surface.index()] = block[row];
                }
            }
            if let ExteriorSurfaces::One { side, .. } = self.locals[w] {
                let (local, zone) = (SurfaceId::new(w, side), SurfaceId::new(w, 1 - side));
                let gain = self.coefficients.walls[w].area * self.responses[w][1 - side][side];
                surfaces[local.index()] += self.yields(local) * gain * surfaces[zone.index()];
            }
            let heat =
                [0, 1].map(|e| self.takes(SurfaceId::new(w, e)) * surfaces[SurfaceId::new(w, e).index()]);
            let own = &mut cells[wall.first_cell..wall.first_cell + wall.len()];
            self.chains[w].forward_transposed(heat, own);
        }
    }

    /// What changes of the first stage's solution do to the equations of the second, in place.
    pub(super) fn hand_on(&self, rows: &mut [f64], ratio: f64) {
        let (cells, rest) = rows.split_at_mut(self.plan.n_cells);
        let (surfaces, air) = rest.split_at_mut(self.plan.surfaces.len());
        surfaces.fill(0.0);
        for (wall, chain) in self.plan.walls.iter().zip(&self.chains) {
            for (i, cell) in cells[wall.first_cell..wall.first_cell + wall.len()].iter_mut().enumerate() {
                *cell *= ratio * chain.rate[i] * chain.storage[i].capacity;
            }
        }
        for (air, zone) in air.iter_mut().zip(&self.coefficients.zones) {
            *air *= ratio * zone.capacity / self.factored;
        }
    }
}
