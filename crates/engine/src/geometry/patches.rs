//! Where the beam through a window ends: the sunlit patches on the surfaces of a zone, by polygons.
//!
//! Each surface of the zone is projected along the direction of the sun onto the plane of the window. The area that the
//! projection has in common with the sunlit pieces of the window is the part of the beam that ends on the surface.

use super::GRAZING;
use super::plane::{Vertex, dot};
use super::polygon::{common_area, project};
use super::shading::Receiver;
use super::surface::PlaneSurface;

/// Corners that most polygons have at most after they are clipped.
const CORNERS: usize = 16;

/// A surface of a zone on which a beam may end.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Target {
    /// Normal into the zone.
    normal: Vertex,
    /// Convex pieces: coordinates along the plane of the window, and heights above it [m].
    pieces: Vec<Vec<Vertex>>,
}

impl Target {
    /// A surface on which no beam ends.
    pub(crate) const NONE: Self = Self { normal: [0.0; 3], pieces: Vec::new() };

    /// A surface of a zone behind a window; `towards` is 1 where its normal points into the zone, else -1.
    pub(crate) fn new(window: &PlaneSurface, surface: &PlaneSurface, towards: f64) -> Self {
        let local = |piece: &Vec<Vertex>| piece.iter().map(|&vertex| window.plane.local(vertex)).collect();
        Self {
            normal: surface.plane.normal().map(|x| towards * x),
            pieces: surface.pieces_in_space().iter().map(local).collect(),
        }
    }
}

/// A window, and the surfaces of the zone behind it.
#[derive(Debug, Clone)]
pub(crate) struct BeamTracer {
    window: Receiver,
    targets: Vec<Target>,
}

impl BeamTracer {
    /// The beam through a window onto targets in the coordinates of its plane.
    pub(crate) fn new(window: Receiver, targets: Vec<Target>) -> Self {
        Self { window, targets }
    }

    /// Whether the fractions of another window are always the same: it is the same seen from a corner of its own, as in a room of
    /// the same form, and no obstacle is in front of either.
    pub(crate) fn alike(&self, other: &Self) -> bool {
        let (mine, theirs) = (&self.window, &other.window);
        !mine.obstructed()
            && !theirs.obstructed()
            && mine.surface.plane.parallel(&theirs.surface.plane)
            && mine.surface.pieces == theirs.surface.pieces
            && self.targets == other.targets
    }

    /// Number of surfaces.
    pub(crate) fn len(&self) -> usize {
        self.targets.len()
    }

    /// Fractions of the beam that end on each surface [-]; they sum to one, or are all zero.
    pub(crate) fn trace(&self, sun: Vertex, fractions: &mut [f64]) {
        let direction = self.window.surface.plane.direction(sun);
        fractions.fill(0.0);
        if direction[2] < GRAZING {
            return;
        }
        let sunlit = self.window.sunlit_pieces(sun);
        // Room for a polygon of some corners: none of them grows in small steps.
        let room = || Vec::with_capacity(CORNERS);
        let (mut projected, mut scratch) = (room(), [room(), room()]);
        for (Target { normal, pieces }, fraction) in self.targets.iter().zip(fractions.iter_mut()) {
            if dot(*normal, sun) <= 0.0 {
                continue;
            }
            for piece in pieces {
                project(piece, direction, &mut projected);
                *fraction +=
                    sunlit.iter().map(|part| common_area(part, &projected, &mut scratch)).sum::<f64>();
            }
        }
        let sum: f64 = fractions.iter().sum();
        if sum > 0.0 {
            for fraction in fractions {
                *fraction /= sum;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In the south wall of a zone of 8 m by 6 m by 2.7 m, from 0.2 m to 2.2 m above the floor.
    const WINDOW: [Vertex; 4] = [[0.5, 0.0, 0.2], [3.5, 0.0, 0.2], [3.5, 0.0, 2.2], [0.5, 0.0, 2.2]];
    const FLOOR: [Vertex; 4] = [[0.0, 0.0, 0.0], [0.0, 6.0, 0.0], [8.0, 6.0, 0.0], [8.0, 0.0, 0.0]];
    const NORTH: [Vertex; 4] = [[8.0, 6.0, 0.0], [0.0, 6.0, 0.0], [0.0, 6.0, 2.7], [8.0, 6.0, 2.7]];

    /// Unit vector along a direction.
    fn towards(direction: Vertex) -> Vertex {
        let length = dot(direction, direction).sqrt();
        direction.map(|x| x / length)
    }

    /// Their normals point outdoors: out of the zone.
    fn tracer(surfaces: &[&[Vertex]], obstacles: &[&[Vertex]]) -> BeamTracer {
        let window = PlaneSurface::of(&WINDOW);
        let targets = surfaces.iter().map(|vertices| Target::new(&window, &PlaneSurface::of(vertices), -1.0));
        let targets = targets.collect();
        let obstacles: Vec<_> = obstacles.iter().map(|vertices| PlaneSurface::of(vertices)).collect();
        BeamTracer::new(Receiver::new(window, &obstacles, &[]), targets)
    }

    /// Due south at 45 deg the whole beam ends on the floor, from 0.2 m to 2.2 m behind the window; at a slope of 0.2 the rays
    /// from above 1.2 m end on the north wall: half of the window.
    #[test]
    fn a_beam_on_floor_and_wall() {
        let tracer = tracer(&[&FLOOR, &NORTH], &[]);
        let mut fractions = [0.0; 2];
        tracer.trace(towards([0.0, -1.0, 1.0]), &mut fractions);
        assert!((fractions[0] - 1.0).abs() < 1e-12 && fractions[1] == 0.0);
        tracer.trace(towards([0.0, -1.0, 0.2]), &mut fractions);
        assert!((fractions[0] - 0.5).abs() < 1e-9 && (fractions[1] - 0.5).abs() < 1e-9, "{fractions:?}");
        tracer.trace(towards([0.0, 1.0, 1.0]), &mut fractions);
        assert_eq!(fractions, [0.0; 2]);
    }

    /// At 45 deg due south the patch on the floor lies from 0.2 m to 2.2 m behind the window, 3 m wide. A floor cut at 1 m in
    /// depth gets (1 - 0.2)/2 of it in front; cut at x = 2 m, half of it. From the south-east it moves to the west.
    #[test]
    fn the_patch_by_hand() {
        let front = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [8.0, 1.0, 0.0], [8.0, 0.0, 0.0]];
        let back = [[0.0, 1.0, 0.0], [0.0, 6.0, 0.0], [8.0, 6.0, 0.0], [8.0, 1.0, 0.0]];
        let mut fractions = [0.0; 2];
        tracer(&[&front, &back], &[]).trace(towards([0.0, -1.0, 1.0]), &mut fractions);
        assert!((fractions[0] - 0.4).abs() < 1e-12 && (fractions[1] - 0.6).abs() < 1e-12, "{fractions:?}");
        let west = [[-9.0, 0.0, 0.0], [-9.0, 6.0, 0.0], [2.0, 6.0, 0.0], [2.0, 0.0, 0.0]];
        let east = [[2.0, 0.0, 0.0], [2.0, 6.0, 0.0], [8.0, 6.0, 0.0], [8.0, 0.0, 0.0]];
        let tracer = tracer(&[&west, &east], &[]);
        tracer.trace(towards([0.0, -1.0, 1.0]), &mut fractions);
        assert!((fractions[0] - 0.5).abs() < 1e-12 && (fractions[1] - 0.5).abs() < 1e-12, "{fractions:?}");
        // Azimuth 135 deg and a slope of 1 into the depth: the ray from height z ends z to the west. East of x = 2 m ends what
        // comes from x > 2 + z: the integral of (1.5 - z) from 0.2 m to 1.5 m, 0.845 m2 of the window's 6 m2.
        tracer.trace(towards([1.0, -1.0, 1.0]), &mut fractions);
        assert!((fractions[1] - 0.845 / 6.0).abs() < 1e-12, "{fractions:?}");
    }

    /// A room at another place, in coordinates that are exact: the same fractions. A lower window, a wall that is missing and an
    /// overhang are seen.
    #[test]
    fn windows_of_rooms_of_one_form_are_alike() {
        let moved = |vertices: &[Vertex; 4], x: f64| vertices.map(|[a, y, z]| [a + x, y, z]);
        let room = |x: f64, lower: f64| {
            let window = PlaneSurface::of(&WINDOW.map(|[a, y, z]| [a + x, y, z - lower]));
            let surfaces = [moved(&FLOOR, x), moved(&NORTH, x)].map(|vertices| PlaneSurface::of(&vertices));
            let targets = surfaces.iter().map(|surface| Target::new(&window, surface, -1.0)).collect();
            BeamTracer::new(Receiver::new(window, &[], &[]), targets)
        };
        let (first, second) = (room(0.0, 0.0), room(64.0, 0.0));
        assert!(first.alike(&second) && !first.alike(&room(0.0, 0.125)));
        let [mut one, mut other] = [[0.0; 2]; 2];
        first.trace(towards([0.3, -1.0, 0.4]), &mut one);
        second.trace(towards([0.3, -1.0, 0.4]), &mut other);
        assert_eq!(one, other);
        let without_wall =
            BeamTracer::new(first.window.clone(), vec![first.targets[0].clone(), Target::NONE]);
        assert!(!first.alike(&without_wall));
        let overhang =
            PlaneSurface::of(&[[-9.0, 0.0, 2.7], [9.0, 0.0, 2.7], [9.0, -1.0, 2.7], [-9.0, -1.0, 2.7]]);
        let shaded = Receiver::new(first.window.surface.clone(), &[overhang], &[]);
        assert!(!first.alike(&BeamTracer::new(shaded, first.targets.clone())));
    }

    /// An overhang that shades the upper quarter of the window at 45 deg takes the far end of the patch: none is left beyond
    /// 1.7 m, and a floor cut at 1 m gets 0.8 of 1.5 m in front.
    #[test]
    fn the_patch_of_a_shaded_window() {
        let overhang = [[-9.0, 0.0, 2.7], [9.0, 0.0, 2.7], [9.0, -1.0, 2.7], [-9.0, -1.0, 2.7]];
        let strip = |from: f64, to: f64| [[0.0, from, 0.0], [0.0, to, 0.0], [8.0, to, 0.0], [8.0, from, 0.0]];
        let mut fractions = [0.0; 3];
        let floors = [strip(0.0, 1.0), strip(1.0, 1.7), strip(1.7, 6.0)];
        tracer(&[&floors[0], &floors[1], &floors[2]], &[&overhang])
            .trace(towards([0.0, -1.0, 1.0]), &mut fractions);
        assert!((fractions[0] - 0.8 / 1.5).abs() < 1e-12 && fractions[2].abs() < 1e-12, "{fractions:?}");
    }
}
