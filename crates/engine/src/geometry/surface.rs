//! A plane surface in space as convex pieces, and openings cut out of it.

use super::SAME_PLANE;
use super::plane::{PlaneAxes, Point, Vertex, dot};
use super::polygon::{area, convex_pieces, subtract};

/// A plane surface in convex pieces.
#[derive(Debug, Clone)]
pub(crate) struct PlaneSurface {
    /// Its plane.
    pub(crate) plane: PlaneAxes,
    /// Convex pieces in the coordinates of the plane [m], without overlap.
    pub(crate) pieces: Vec<Vec<Point>>,
    /// [m2].
    pub(crate) area: f64,
}

impl PlaneSurface {
    /// The surface inside a simple polygon.
    pub(crate) fn of(vertices: &[Vertex]) -> Self {
        let plane = PlaneAxes::of(vertices);
        let pieces = convex_pieces(along(&plane, vertices));
        let area = pieces.iter().map(|piece| area(piece)).sum();
        Self { plane, pieces, area }
    }

    /// The surface without its openings: the smaller surfaces in its plane with the same normal.
    pub(crate) fn without(mut self, others: &[Self]) -> Self {
        let whole = self.area;
        for other in others {
            let same = dot(self.plane.normal(), other.plane.normal()) > 1.0 - 1e-6
                && self.plane.local(other.plane.origin)[2].abs() < SAME_PLANE;
            if !same || other.area >= whole * (1.0 - 1e-9) {
                continue;
            }
            for opening in other.pieces_in_space() {
                self.pieces = subtract(self.pieces, &along(&self.plane, &opening));
            }
        }
        self.area = self.pieces.iter().map(|piece| area(piece)).sum();
        self
    }

    /// The same surface seen from its other side.
    pub(crate) fn reversed(&self) -> Self {
        let plane = self.plane.reversed();
        let mirrored = |piece: &Vec<Point>| piece.iter().rev().map(|&[u, v]| [u, -v]).collect();
        Self { plane, pieces: self.pieces.iter().map(mirrored).collect(), area: self.area }
    }

    /// Vertices of its convex pieces in space [m].
    pub(crate) fn pieces_in_space(&self) -> Vec<Vec<Vertex>> {
        self.pieces.iter().map(|piece| piece.iter().map(|&p| self.plane.vertex(p)).collect()).collect()
    }
}

/// Coordinates along a plane.
fn along(plane: &PlaneAxes, vertices: &[Vertex]) -> Vec<Point> {
    let point = |&vertex: &Vertex| {
        let [u, v, _] = plane.local(vertex);
        [u, v]
    };
    vertices.iter().map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The 6 m2 of a window are cut out of a wall of 8 m x 2.7 m; the wall itself and a surface of opposite normal are not.
    #[test]
    fn a_window_is_cut_out_of_its_wall() {
        let wall = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 0.0, 2.7], [0.0, 0.0, 2.7]];
        let window = [[0.5, 0.0, 0.2], [3.5, 0.0, 0.2], [3.5, 0.0, 2.2], [0.5, 0.0, 2.2]];
        let mut behind = window.map(|[x, y, z]| [x + 4.0, y, z]);
        behind.reverse();
        let all = [wall, window, behind].map(|vertices| PlaneSurface::of(&vertices));
        let rest = PlaneSurface::of(&wall).without(&all);
        assert!((rest.area - (21.6 - 6.0)).abs() < 1e-9);
        let vertices: Vec<Vertex> = rest.pieces_in_space().concat();
        assert!(vertices.iter().all(|vertex| vertex[1].abs() < 1e-12));
    }
}
