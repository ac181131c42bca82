//! Polygons of a plane: areas, clipping, subtraction, convex pieces, projection along a direction.
//!
//! A polygon is clipped by the lines through the edges of a convex one, one after the other (Sutherland & Hodgman 1974,
//! doi:10.1145/360767.360802).

use super::LEAST_LENGTH;
use super::plane::{Point, Vertex};

/// Twice the signed area of a triangle [m2], positive where it turns counter-clockwise.
pub(crate) fn double_area(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Signed area [m2], positive where the polygon turns counter-clockwise.
pub(crate) fn area(polygon: &[Point]) -> f64 {
    let mut sum = 0.0;
    for k in 1..polygon.len().saturating_sub(1) {
        sum += double_area(polygon[0], polygon[k], polygon[k + 1]);
    }
    0.5 * sum
}

/// The part of a convex polygon to the left of a line, into `kept`; to the right with `from` and `to` exchanged.
fn clip_left_of(polygon: &[Point], from: Point, to: Point, kept: &mut Vec<Point>) {
    kept.clear();
    let Some(&last) = polygon.last() else { return };
    let (mut here, mut a) = (last, double_area(from, to, last));
    for &next in polygon {
        let b = double_area(from, to, next);
        if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
            let share = a / (a - b);
            kept.push([here[0] + share * (next[0] - here[0]), here[1] + share * (next[1] - here[1])]);
        }
        if b >= 0.0 {
            kept.push(next);
        }
        (here, a) = (next, b);
    }
}

/// The box round a polygon: least and largest of each coordinate [m].
type Bounds = [[f64; 2]; 2];

fn bounds(polygon: &[Point]) -> Bounds {
    core::array::from_fn(|k| {
        polygon
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p[k]), high.max(p[k])])
    })
}

/// Whether two boxes have no area in common.
fn apart(a: &Bounds, b: &Bounds) -> bool {
    a.iter().zip(b).any(|([a0, a1], [b0, b1])| a1 <= b0 || b1 <= a0)
}

/// Convex pieces, from which others are subtracted.
#[derive(Debug, Clone, Default)]
pub(crate) struct Pieces {
    polygons: Vec<Vec<Point>>,
    /// Of each polygon: most of a subtracted polygon's time would go into finding them again.
    bounds: Vec<Bounds>,
}

impl Pieces {
    /// Pieces that do not overlap.
    pub(crate) fn new(polygons: Vec<Vec<Point>>) -> Self {
        Self { bounds: polygons.iter().map(|piece| bounds(piece)).collect(), polygons }
    }

    fn add(&mut self, polygon: Vec<Point>) {
        self.bounds.push(bounds(&polygon));
        self.polygons.push(polygon);
    }

    /// The pieces.
    pub(crate) fn into_polygons(self) -> Vec<Vec<Point>> {
        self.polygons
    }

    /// Whether nothing is left.
    pub(crate) fn is_empty(&self) -> bool {
        self.polygons.is_empty()
    }

    /// Removes the part inside a convex polygon that turns counter-clockwise.
    pub(crate) fn subtract(&mut self, hole: &[Point]) {
        let around = bounds(hole);
        if self.bounds.iter().all(|piece| apart(piece, &around)) {
            return;
        }
        let mut left = Self {
            polygons: Vec::with_capacity(self.polygons.len() + 3),
            bounds: Vec::with_capacity(self.bounds.len() + 3),
        };
        for (piece, box_of_piece) in self.polygons.drain(..).zip(self.bounds.drain(..)) {
            if apart(&box_of_piece, &around) {
                left.polygons.push(piece);
                left.bounds.push(box_of_piece);
            } else {
                left.add_without(piece, hole);
            }
        }
        *self = left;
    }

    /// Adds what a convex polygon leaves of a piece.
    fn add_without(&mut self, piece: Vec<Point>, hole: &[Point]) {
        let mut rest = piece;
        for (k, &from) in hole.iter().enumerate() {
            let to = hole[(k + 1) % hole.len()];
            let (mut outside, mut inside) = (Vec::new(), Vec::new());
            clip_left_of(&rest, to, from, &mut outside);
            if area(&outside) > LEAST_LENGTH * LEAST_LENGTH {
                self.add(outside);
            }
            clip_left_of(&rest, from, to, &mut inside);
            rest = inside;
            if area(&rest) <= LEAST_LENGTH * LEAST_LENGTH {
                break;
            }
        }
    }
}

/// Convex pieces without the part inside a convex polygon that turns counter-clockwise.
pub(crate) fn subtract(pieces: Vec<Vec<Point>>, hole: &[Point]) -> Vec<Vec<Point>> {
    let mut left = Pieces::new(pieces);
    left.subtract(hole);
    left.into_polygons()
}

/// Area common to two convex polygons [m2], the second turning counter-clockwise; `scratch` is overwritten.
pub(crate) fn common_area(a: &[Point], b: &[Point], scratch: &mut [Vec<Point>; 2]) -> f64 {
    let [rest, next] = scratch;
    rest.clear();
    rest.extend_from_slice(a);
    for (k, &from) in b.iter().enumerate() {
        let to = b[(k + 1) % b.len()];
        let (mut left, mut right) = (false, false);
        for &point in rest.iter() {
            let side = double_area(from, to, point);
            left |= side > 0.0;
            right |= side < 0.0;
        }
        if !left {
            return 0.0;
        }
        // Clipping is needed only where the line cuts the rest.
        if right {
            clip_left_of(rest, from, to, next);
            core::mem::swap(rest, next);
        }
    }
    area(rest)
}

/// A simple polygon that turns counter-clockwise, as convex pieces: itself, or triangles (ear clipping; Meisters 1975,
/// doi:10.2307/2319703).
pub(crate) fn convex_pieces(polygon: Vec<Point>) -> Vec<Vec<Point>> {
    let corner = |points: &[Point], k: usize| {
        let n = points.len();
        [points[(k + n - 1) % n], points[k], points[(k + 1) % n]]
    };
    let convex = (0..polygon.len()).all(|k| {
        let [a, b, c] = corner(&polygon, k);
        double_area(a, b, c) >= 0.0
    });
    if convex {
        return vec![polygon];
    }
    let mut rest = polygon;
    let mut pieces = Vec::new();
    while rest.len() > 3 {
        let ear = (0..rest.len()).find(|&k| {
            let [a, b, c] = corner(&rest, k);
            let inside = |p: &Point| {
                double_area(a, b, *p) >= 0.0 && double_area(b, c, *p) >= 0.0 && double_area(c, a, *p) >= 0.0
            };
            double_area(a, b, c) > 0.0 && !rest.iter().any(|p| *p != a && *p != b && *p != c && inside(p))
        });
        // A simple polygon always has an ear, unless all its corners lie on a line: then no area is left.
        let Some(k) = ear else { break };
        pieces.push(corner(&rest, k).to_vec());
        rest.remove(k);
    }
    pieces.push(rest);
    pieces.retain(|piece| area(piece) > LEAST_LENGTH * LEAST_LENGTH);
    pieces
}

/// Points with coordinates along a plane and heights above it, projected along a direction onto the plane, into `flat`;
/// turned counter-clockwise.
pub(crate) fn project(points: &[Vertex], [su, sv, sn]: Vertex, flat: &mut Vec<Point>) {
    flat.clear();
    flat.extend(points.iter().map(|&[u, v, h]| [u - h * su / sn, v - h * sv / sn]));
    if area(flat) < 0.0 {
        flat.reverse();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Point; 4] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];

    /// A square of side 2 cut along its diagonal keeps half of its area, on either side.
    #[test]
    fn a_clipped_square() {
        let mut kept = Vec::new();
        clip_left_of(&SQUARE, [0.0, 0.0], [2.0, 2.0], &mut kept);
        assert_eq!(area(&kept), 2.0);
        // From the middle of the lower edge to the middle of the right one: a triangle of 1/2 is to the right.
        clip_left_of(&SQUARE, [1.0, 0.0], [2.0, 1.0], &mut kept);
        assert!((area(&kept) - 3.5).abs() < 1e-15 && kept.len() == 5);
        clip_left_of(&SQUARE, [2.0, 1.0], [1.0, 0.0], &mut kept);
        assert!((area(&kept) - 0.5).abs() < 1e-15);
        clip_left_of(&SQUARE, [3.0, 0.0], [3.0, -1.0], &mut kept);
        assert!(kept.is_empty());
    }

    /// Two squares of side 2 shifted by (1, 1/2) have 1 x 3/2 in common; a diamond in the square all of its own area.
    #[test]
    fn area_common_to_two() {
        let mut scratch = [Vec::new(), Vec::new()];
        let shifted = SQUARE.map(|[x, y]| [x + 1.0, y + 0.5]);
        assert!((common_area(&SQUARE, &shifted, &mut scratch) - 1.5).abs() < 1e-15);
        let diamond = [[1.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]];
        assert!((common_area(&SQUARE, &diamond, &mut scratch) - 2.0).abs() < 1e-15);
        let away = SQUARE.map(|[x, y]| [x + 2.0, y]);
        assert_eq!(common_area(&SQUARE, &away, &mut scratch), 0.0);
    }

    /// A hole in the middle leaves the frame round it; subtracted twice it counts once.
    #[test]
    fn subtraction_of_a_hole() {
        let hole = [[0.5, 0.5], [1.5, 0.5], [1.5, 1.25], [0.5, 1.25]];
        let total = |pieces: &[Vec<Point>]| pieces.iter().map(|piece| area(piece)).sum::<f64>();
        let once = subtract(vec![SQUARE.to_vec()], &hole);
        assert!((total(&once) - (4.0 - 0.75)).abs() < 1e-14);
        assert!((total(&subtract(once, &hole)) - (4.0 - 0.75)).abs() < 1e-14);
        assert!(subtract(vec![hole.to_vec()], &SQUARE).is_empty());
    }

    /// An L of 3 x 3 less 2 x 2 has 5 m2, in convex pieces that do not overlap.
    #[test]
    fn pieces_of_an_l() {
        let l = vec![[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        assert_eq!(area(&l), 5.0);
        let pieces = convex_pieces(l);
        assert!((pieces.iter().map(|piece| area(piece)).sum::<f64>() - 5.0).abs() < 1e-14);
        let mut scratch = [Vec::new(), Vec::new()];
        for (k, a) in pieces.iter().enumerate() {
            assert!(a.len() == 3 && pieces[..k].iter().all(|b| common_area(a, b, &mut scratch) < 1e-14));
        }
        assert_eq!(convex_pieces(SQUARE.to_vec()), [SQUARE.to_vec()]);
    }

    /// Along a direction with a slope of 1:2 a height of 2 m moves a point by 1 m, against the direction.
    #[test]
    fn projection_along_a_direction() {
        let mut flat = Vec::new();
        let points = [[0.0, 0.0, 2.0], [0.0, 1.0, 2.0], [1.0, 1.0, 2.0]];
        project(&points, [1.0, 0.0, 2.0], &mut flat);
        assert_eq!(flat, [[0.0, 1.0], [-1.0, 1.0], [-1.0, 0.0]]);
    }
}
