//! The plain twin of a stepper that carries derivatives: the matrix of a stage as a run has it, and solving with it.
//!
//! Unknowns and equations are those of all cells, all faces and all airs, in this order. Heat released in cells and at
//! faces outside the zones counts per square metre, at faces and airs of zones whole; the equation of a face that is held
//! at a temperature is that temperature.

use crate::balance::{FaceLaws, Line, LocalFaces};
use crate::coefficients::Boundary;
use crate::plan::{FaceId, FaceRole};
use crate::real::Real;

use super::Stepper;

impl Stepper<'_, f64> {
    /// Takes over the values of a linearisation and factors its matrix.
    #[inline(always)]
    pub(super) fn adopt<S: Real>(&mut self, other: &Stepper<'_, S>, length: f64, new: bool) {
        for (mine, theirs) in self.laws.iter_mut().zip(&other.laws) {
            *mine = FaceLaws { film: Line::of(&theirs.film), emission: Line::of(&theirs.emission) };
        }
        let enter = |mine: &mut [Line<f64>], theirs: &[Line<S>]| {
            for (mine, theirs) in mine.iter_mut().zip(theirs) {
                *mine = Line::of(theirs);
            }
        };
        enter(&mut self.inflow, &other.inflow);
        enter(&mut self.airing, &other.airing);
        for (mine, theirs) in self.drive.paths.iter_mut().zip(&other.drive.paths) {
            *mine = theirs.lane(0);
        }
        if self.changing.curved || self.changing.by_wind || new {
            self.rooms.adopt(&self.laws);
            self.enter_constant(true, false);
            self.rooms.tell_locals(&mut self.locals, &mut self.inverses);
        }
        for i in 0..self.changing.walls.len() {
            let w = self.changing.walls[i];
            self.chains[w].adopt(&other.chains[w]);
            self.responses[w] = self.chains[w].factor(&self.coefficients.walls[w], length);
        }
        self.enter_changing(length);
        self.block.solve_rest();
    }

    /// What of the heat that a wall sends into a face enters the equation of that face [-], in zones [m2].
    #[inline(always)]
    pub(super) fn takes(&self, face: FaceId) -> f64 {
        match self.plan.faces[face].role {
            FaceRole::Zone { .. } => self.coefficients.walls[face / 2].area,
            FaceRole::Local if self.held_at(face) => 0.0,
            FaceRole::Local => 1.0,
        }
    }

    /// Whether a local face is held at a temperature.
    #[inline(always)]
    fn held_at(&self, face: FaceId) -> bool {
        let numbers = &self.coefficients.faces[face];
        numbers.film.is_none() && matches!(numbers.boundary, Boundary::Imposed(_))
    }

    /// How much a local face gives way, the other face of its wall held.
    #[inline(always)]
    fn yields(&self, face: FaceId) -> f64 {
        if self.held_at(face) { 1.0 } else { self.inverses[face / 2] }
    }

    /// The matrix of a wall that touches no zone, and one over its determinant.
    #[inline(always)]
    fn pair(&self, w: usize) -> ([[f64; 2]; 2], f64) {
        let response = self.responses[w];
        let ([a, b], _) = self.local_balance(2 * w).equation(0, [0.0; 2], response);
        let ([d, c], _) = self.local_balance(2 * w + 1).equation(1, [0.0; 2], response);
        ([[a, b], [c, d]], 1.0 / (a * d - b * c))
    }

    /// Replaces the right-hand sides of all equations (cells, faces, airs) by their solution.
    #[inline(always)]
    pub(crate) fn solve_beside<R: Real>(&self, rows: &mut [R], block: &mut Vec<R>) {
        let (cells, rest) = rows.split_at_mut(self.plan.n_cells);
        let (faces, air) = rest.split_at_mut(self.plan.faces.len());
        block.clear();
        block.resize(self.plan.rows(), R::zero());
        for (w, wall) in self.plan.walls.iter().enumerate() {
            let heat = self.chains[w].forward(&mut cells[wall.first_cell..wall.first_cell + wall.len()]);
            for e in 0..2 {
                faces[2 * w + e] += heat[e].scale(self.takes(2 * w + e));
                if let FaceRole::Zone { row, .. } = self.plan.faces[2 * w + e].role {
                    block[row] += faces[2 * w + e];
                }
            }
            match self.locals[w] {
                LocalFaces::None => {}
                LocalFaces::One { side, .. } => {
                    let (local, zone) = (2 * w + side, 2 * w + 1 - side);
                    faces[local] = faces[local].scale(self.yields(local));
                    let gain = self.coefficients.walls[w].area * self.responses[w][1 - side][side];
                    block[self.plan.row(zone)] += faces[local].scale(gain);
                }
                LocalFaces::Both(_) => {
                    let ([[a, b], [c, d]], inverse) = self.pair(w);
                    let [f, g] = [faces[2 * w].scale(inverse), faces[2 * w + 1].scale(inverse)];
                    (faces[2 * w], faces[2 * w + 1]) = (f.scale(d) - g.scale(b), g.scale(a) - f.scale(c));
                }
            }
        }
        for (zone, &air) in self.plan.zones.iter().zip(air.iter()) {
            block[zone.air_row] = air;
        }
        self.rooms.forward_beside(block);
        self.block.solve_beside(block);
        self.rooms.back_beside(block);
        for (zone, air) in self.plan.zones.iter().zip(air) {
            *air = block[zone.air_row];
        }
        for (w, wall) in self.plan.walls.iter().enumerate() {
            for face in [2 * w, 2 * w + 1] {
                if let FaceRole::Zone { row, .. } = self.plan.faces[face].role {
                    faces[face] = block[row];
                }
            }
            if let LocalFaces::One { side, line } = self.locals[w] {
                let zone = faces[2 * w + 1 - side].scale(line.slope);
                faces[2 * w + side] += zone;
            }
            let own = &mut cells[wall.first_cell..wall.first_cell + wall.len()];
            self.chains[w].back([faces[2 * w], faces[2 * w + 1]], own);
        }
    }

    /// Replaces weights on all unknowns by weights on their equations: the transpose of [`Self::solve_beside`].
    pub(super) fn solve_transposed(&self, rows: &mut [f64], block: &mut Vec<f64>) {
        let (cells, rest) = rows.split_at_mut(self.plan.n_cells);
        let (faces, air) = rest.split_at_mut(self.plan.faces.len());
        block.clear();
        block.resize(self.plan.rows(), 0.0);
        for (w, wall) in self.plan.walls.iter().enumerate() {
            let own = &mut cells[wall.first_cell..wall.first_cell + wall.len()];
            let weights = self.chains[w].back_transposed(own);
            for e in 0..2 {
                faces[2 * w + e] += weights[e];
            }
            match self.locals[w] {
                LocalFaces::None => {}
                LocalFaces::One { side, line } => {
                    let local = 2 * w + side;
                    faces[2 * w + 1 - side] += line.slope * faces[local];
                    faces[local] *= self.yields(local);
                }
                LocalFaces::Both(_) => {
                    let ([[a, b], [c, d]], inverse) = self.pair(w);
                    let [f, g] = [faces[2 * w] * inverse, faces[2 * w + 1] * inverse];
                    (faces[2 * w], faces[2 * w + 1]) = (f * d - g * c, g * a - f * b);
                }
            }
            for face in [2 * w, 2 * w + 1] {
                if let FaceRole::Zone { row, .. } = self.plan.faces[face].role {
                    block[row] += faces[face];
                }
            }
        }
        for (zone, &air) in self.plan.zones.iter().zip(air.iter()) {
            block[zone.air_row] = air;
        }
        self.rooms.back_transposed(block);
        self.block.solve_transposed(block);
        self.rooms.forward_transposed(block);
        for (zone, air) in self.plan.zones.iter().zip(air) {
            *air = block[zone.air_row];
        }
        for (w, wall) in self.plan.walls.iter().enumerate() {
            for face in [2 * w, 2 * w + 1] {
                if let FaceRole::Zone { row, .. } = self.plan.faces[face].role {
                    faces[face] = block[row];
                }
            }
            if let LocalFaces::One { side, .. } = self.locals[w] {
                let (local, zone) = (2 * w + side, 2 * w + 1 - side);
                let gain = self.coefficients.walls[w].area * self.responses[w][1 - side][side];
                faces[local] += self.yields(local) * gain * faces[zone];
            }
            let heat = [0, 1].map(|e| self.takes(2 * w + e) * faces[2 * w + e]);
            let own = &mut cells[wall.first_cell..wall.first_cell + wall.len()];
            self.chains[w].forward_transposed(heat, own);
        }
    }

    /// What changes of the first stage's solution do to the equations of the second, in place.
    pub(super) fn hand_on(&self, rows: &mut [f64], ratio: f64) {
        let (cells, rest) = rows.split_at_mut(self.plan.n_cells);
        let (faces, air) = rest.split_at_mut(self.plan.faces.len());
        faces.fill(0.0);
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
