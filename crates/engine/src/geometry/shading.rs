//! The fractions of sun, sky and ground that obstacles leave of a surface, by polygons without sampling of the surface.
//!
//! An obstacle throws its shadow along the direction of the sun onto the plane of a surface. The shadow is subtracted from the
//! convex pieces of the surface, so that overlapping shadows count once. What is left is sunlit.
//!
//! Obstacles also cover sky and ground. The fraction left of the isotropic sky is the mean of the sunlit fraction over all
//! directions of the sky, weighted by the cosine of incidence; the fraction left of the brightening of the horizon is the same
//! mean just above the horizon. Circumsolar radiation is reduced with the beam. Walls cover the ground, too, by the same mean over
//! all directions below the horizon; thin shades leave all of its radiation.

use std::borrow::Cow;

use super::plane::{Point, Vertex, dot};
use super::polygon::{Pieces, area, project};
use super::surface::PlaneSurface;
use super::{GRAZING, LEAST_LENGTH, SAME_PLANE};
use crate::number::real::Real;
use crate::physics::solar::SkyVisibility;

/// Bands of elevation and sectors of azimuth of the sky, and of the ground.
const SKY: [usize; 2] = [36, 144];
/// Shifts by it fill an interval evenly (Weyl 1916, doi:10.1007/BF01475864).
const GOLDEN_SECTION: f64 = 0.618_033_988_749_894_9;
/// Elevation at which the horizon is evaluated [rad].
const HORIZON: f64 = 1e-3;
/// Cones that are wider than this cosine of half their angle are not used [-].
const WIDEST: f64 = 0.05;
/// Tolerance of the cosine of half the angle of a cone [-].
const ROUNDING: f64 = 1e-9;

/// A convex piece of an obstacle in front of a surface.
#[derive(Debug, Clone)]
struct Obstacle {
    /// Coordinates along the plane of the surface, and heights above it [m].
    corners: Vec<Vertex>,
    /// Directions in which it lies; none: all.
    cone: Option<Cone>,
    /// Whether it is a wall, not a thin shade.
    wall: bool,
}

/// The directions from all points of a surface to all points of an obstacle lie in it.
#[derive(Debug, Clone, Copy)]
struct Cone {
    axis: Vertex,
    /// Cosine of half of its angle.
    cosine: f64,
}

impl Cone {
    /// Round the directions from the corners of a surface to those of an obstacle; none where they touch or the cone is wide.
    /// Also the square of the least distance of two corners [m2].
    fn round(surface: &[Vec<Point>], obstacle: &[Vertex]) -> (Option<Self>, f64) {
        let mut directions = Vec::with_capacity(surface.len() * 4 * obstacle.len());
        let (mut nearest, mut touches) = (f64::INFINITY, false);
        for &[u, v] in surface.iter().flatten() {
            for &[x, y, height] in obstacle {
                let way = [x - u, y - v, height];
                let square = dot(way, way);
                nearest = nearest.min(square);
                touches |= square < LEAST_LENGTH * LEAST_LENGTH;
                directions.push(way.map(|x| x / square.sqrt()));
            }
        }
        if touches {
            return (None, nearest);
        }
        let sum = directions.iter().fold([0.0; 3], |sum, way| core::array::from_fn(|k| sum[k] + way[k]));
        let length = dot(sum, sum).sqrt();
        let axis = sum.map(|x| x / length);
        // A cone narrower than a half-space is convex: it holds the directions between all points, not only between corners.
        let cosine = directions.iter().map(|&way| dot(way, axis)).fold(1.0, f64::min) - ROUNDING;
        ((length > 0.0 && cosine > WIDEST).then_some(Self { axis, cosine }), nearest)
    }
}

impl Obstacle {
    /// Whether it may throw a shadow on the surface when the sun is in this direction.
    fn may_shade(&self, direction: Vertex) -> bool {
        self.cone.is_none_or(|cone| dot(cone.axis, direction) >= cone.cosine)
    }
}

/// A surface outdoors, and the obstacles in front of it.
#[derive(Debug, Clone)]
pub(crate) struct Receiver {
    /// The surface.
    pub(crate) surface: PlaneSurface,
    obstacles: Vec<Obstacle>,
    /// Fractions left of sky and ground [-]; that of the sun's disc is 1.
    pub(crate) sky: SkyVisibility,
    /// Fraction of the sky that is left by walls alone, without thin shades [-].
    pub(crate) open_sky: f64,
}

impl Receiver {
    /// Prepares a surface, and of thin shades and of walls the parts in front of its plane.
    pub(crate) fn new(surface: PlaneSurface, shades: &[PlaneSurface], walls: &[&PlaneSurface]) -> Self {
        let mut receiver = Self { obstacles: Vec::new(), surface, sky: SkyVisibility::FULL, open_sky: 1.0 };
        receiver.add_walls(walls);
        if receiver.obstructed() {
            receiver.open_sky = receiver.mean_over_sky();
            receiver.sky.sky = receiver.open_sky;
            receiver.sky.ground = receiver.mean(staggered().map(|(up, sector)| (-up, sector)));
        }
        if receiver.add_shades(shades) {
            receiver.sky.sky = receiver.mean_over_sky();
        }
        if receiver.obstructed() {
            receiver.sky.horizon = receiver.mean((0..SKY[1]).map(|sector| (HORIZON, sector)));
        }
        receiver
    }

    /// Adds the nearest walls first: what they shade needs no other.
    fn add_walls(&mut self, walls: &[&PlaneSurface]) {
        let pieces = walls.iter().flat_map(|wall| self.condensed_in_zone(wall));
        let mut sorted: Vec<(f64, Obstacle)> = pieces
            .map(|corners| {
                let (cone, nearest) = Cone::round(&self.surface.pieces, &corners);
                (nearest, Obstacle { corners, cone, wall: true })
            })
            .collect();
        sorted.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        self.obstacles = sorted.into_iter().map(|(_, obstacle)| obstacle).collect();
    }

    /// Adds thin shades, before the walls; whether there are any.
    fn add_shades(&mut self, shades: &[PlaneSurface]) -> bool {
        let pieces = shades.iter().flat_map(|shade| self.condensed_in_zone(shade));
        let mut all: Vec<Obstacle> =
            pieces.map(|corners| Obstacle { corners, cone: None, wall: false }).collect();
        let any = !all.is_empty();
        all.append(&mut self.obstacles);
        self.obstacles = all;
        any
    }

    /// The parts of an obstacle in front of the plane.
    fn condensed_in_zone(&self, obstacle: &PlaneSurface) -> Vec<Vec<Vertex>> {
        let pieces = obstacle.pieces_in_space();
        let front = pieces.iter().filter_map(|piece| {
            let local: Vec<Vertex> = piece.iter().map(|&vertex| self.surface.plane.local(vertex)).collect();
            part_in_front(&local)
        });
        front.collect()
    }

    /// Whether an obstacle stands in front of the surface.
    pub(crate) fn obstructed(&self) -> bool {
        !self.obstacles.is_empty()
    }

    /// Convex pieces of the surface that the sun reaches; all of them where it is behind the surface.
    pub(crate) fn sunlit_pieces(&self, sun: Vertex) -> Cow<'_, [Vec<Point>]> {
        let direction = self.surface.plane.direction(sun);
        if direction[2] < GRAZING {
            return Cow::Borrowed(&self.surface.pieces);
        }
        let mut left = None;
        let mut shadow = Vec::new();
        for obstacle in self.obstacles.iter().filter(|obstacle| obstacle.may_shade(direction)) {
            project(&obstacle.corners, direction, &mut shadow);
            if area(&shadow) > LEAST_LENGTH * LEAST_LENGTH {
                let left = left.get_or_insert_with(|| Pieces::new(self.surface.pieces.clone()));
                left.subtract(&shadow);
                if left.is_empty() {
                    break;
                }
            }
        }
        left.map_or(Cow::Borrowed(&self.surface.pieces), |left| Cow::Owned(left.into_polygons()))
    }

    /// Fraction of the surface that the sun reaches from a direction [-]; 1 where it is behind the surface.
    pub(crate) fn sunlit_fraction(&self, sun: Vertex) -> f64 {
        match self.sunlit_pieces(sun) {
            Cow::Borrowed(_) => 1.0,
            Cow::Owned(pieces) => {
                let sunlit: f64 = pieces.iter().map(|piece| area(piece)).sum();
                (sunlit / self.surface.area).min(1.0)
            }
        }
    }

    fn mean_over_sky(&self) -> f64 {
        // Thin shades alone: all sectors have the same elevations, as ever.
        let walls = self.obstacles.iter().any(|obstacle| obstacle.wall);
        if walls { self.mean(staggered()) } else { self.mean(level()) }
    }

    /// Mean of the sunlit fraction over directions of these elevations and sectors, weighted by the cosine of incidence.
    fn mean(&self, directions: impl Iterator<Item = (f64, usize)>) -> f64 {
        let (mut seen, mut all) = (0.0, 0.0);
        for (elevation, sector) in directions {
            let (up, level) = (Real::sin(elevation), Real::cos(elevation));
            let azimuth = (sector as f64 + 0.5) * core::f64::consts::TAU / SKY[1] as f64;
            let sun = [Real::sin(azimuth) * level, Real::cos(azimuth) * level, up];
            let weight = dot(sun, self.surface.plane.normal()) * level;
            if weight > GRAZING {
                seen += weight * self.sunlit_fraction(sun);
                all += weight;
            }
        }
        if all > 0.0 { seen / all } else { 1.0 }
    }
}

/// Elevations [rad] and sectors of the sky: in each sector the middles of the bands.
fn level() -> impl Iterator<Item = (f64, usize)> {
    let band = core::f64::consts::FRAC_PI_2 / SKY[0] as f64;
    (0..SKY[0]).flat_map(move |k| (0..SKY[1]).map(move |sector| ((k as f64 + 0.5) * band, sector)))
}

/// The same, shifted within the bands from sector to sector by the golden section, so that the edge of a long wall is not
/// met or missed by a whole band.
fn staggered() -> impl Iterator<Item = (f64, usize)> {
    let band = core::f64::consts::FRAC_PI_2 / SKY[0] as f64;
    (0..SKY[0]).flat_map(move |k| {
        (0..SKY[1]).map(move |sector| {
            let shift = (sector as f64 + 0.5) * GOLDEN_SECTION;
            ((k as f64 + shift - shift.floor()) * band, sector)
        })
    })
}

/// The part of a convex polygon above the plane that its heights are measured from; none where there is no such part.
fn part_in_front(points: &[Vertex]) -> Option<Vec<Vertex>> {
    let mut kept = Vec::with_capacity(points.len() + 1);
    for (k, &here) in points.iter().enumerate() {
        let next = points[(k + 1) % points.len()];
        if here[2] >= 0.0 {
            kept.push(here);
        }
        if (here[2] > 0.0 && next[2] < 0.0) || (here[2] < 0.0 && next[2] > 0.0) {
            let share = here[2] / (here[2] - next[2]);
            kept.push(core::array::from_fn(|i| here[i] + share * (next[i] - here[i])));
        }
    }
    (kept.iter().any(|point| point[2] > SAME_PLANE) && kept.len() > 2).then_some(kept)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::double_area;

    const WALL: [Vertex; 4] = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 0.0, 2.7], [0.0, 0.0, 2.7]];
    const WINDOW: [Vertex; 4] = [[0.5, 0.0, 0.2], [3.5, 0.0, 0.2], [3.5, 0.0, 2.2], [0.5, 0.0, 2.2]];
    const OVERHANG: [Vertex; 4] = [[0.0, 0.0, 2.7], [8.0, 0.0, 2.7], [8.0, -1.0, 2.7], [0.0, -1.0, 2.7]];

    fn sun(azimuth: f64, elevation: f64) -> Vertex {
        let (a, e) = (azimuth.to_radians(), elevation.to_radians());
        [Real::sin(a) * Real::cos(e), Real::cos(a) * Real::cos(e), Real::sin(e)]
    }

    fn shaded(surface: &[Vertex], obstacles: &[&[Vertex]]) -> Receiver {
        let obstacles: Vec<PlaneSurface> = obstacles.iter().map(|shade| PlaneSurface::of(shade)).collect();
        Receiver::new(PlaneSurface::of(surface), &obstacles, &[])
    }

    /// Due south at 45 deg an overhang of 1 m shades the 1 m below it: 0.5 m of the window's 2 m, and 1 m of the wall's
    /// 2.7 m.
    #[test]
    fn an_overhang_at_45_degrees() {
        assert!((shaded(&WINDOW, &[&OVERHANG]).sunlit_fraction(sun(180.0, 45.0)) - 1.5 / 2.0).abs() < 1e-12);
        assert!((shaded(&WALL, &[&OVERHANG]).sunlit_fraction(sun(180.0, 45.0)) - 1.7 / 2.7).abs() < 1e-12);
    }

    /// Due south at 60 deg the shadow of 1 m reaches tan 60 = 1.732 m down: 1.232 m of the window's 2 m.
    #[test]
    fn an_overhang_at_noon() {
        let receiver = shaded(&WINDOW, &[&OVERHANG]);
        let expected = (2.0 - (3.0_f64.sqrt() - 0.5)) / 2.0;
        assert!((receiver.sunlit_fraction(sun(180.0, 60.0)) - expected).abs() < 1e-12);
        assert!((receiver.sunlit_fraction(sun(180.0, 20.0)) - 1.0).abs() < 1e-12);
        assert!(receiver.sunlit_fraction(sun(180.0, 80.0)).abs() < 1e-12);
        // From the south-east the foot of the shadow moves west, but the overhang is long enough.
        let depth = 3.0_f64.sqrt() / 0.5_f64.sqrt() - 0.5;
        assert!((receiver.sunlit_fraction(sun(135.0, 60.0)) - (2.0 - depth.min(2.0)) / 2.0).abs() < 1e-12);
    }

    /// A fin of 1 m at the window's east edge: sun from 45 deg east of south throws its shadow 1 m to the west.
    #[test]
    fn a_fin() {
        let fin: [Vertex; 4] = [[3.5, 0.0, 0.0], [3.5, -1.0, 0.0], [3.5, -1.0, 2.7], [3.5, 0.0, 2.7]];
        let receiver = shaded(&WINDOW, &[&fin]);
        assert!((receiver.sunlit_fraction(sun(135.0, 0.001)) - 2.0 / 3.0).abs() < 1e-4);
        assert!((receiver.sunlit_fraction(sun(225.0, 0.001)) - 1.0).abs() < 1e-12);
    }

    /// Overlapping shadows count once: two overhangs in the same place are one.
    #[test]
    fn shadows_overlap() {
        let one = shaded(&WINDOW, &[&OVERHANG]);
        let two = shaded(&WINDOW, &[&OVERHANG, &OVERHANG]);
        for k in 1..80 {
            let at = sun(100.0 + 2.0 * f64::from(k), f64::from(k));
            assert!((one.sunlit_fraction(at) - two.sunlit_fraction(at)).abs() < 1e-9);
        }
        assert!((one.sky.sky - two.sky.sky).abs() < 1e-9);
    }

    /// Rays from points of an L-shaped surface towards the sun, against polygons, with three obstacles (one not convex).
    #[test]
    fn against_rays() {
        let surface: Vec<Vertex> = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.5], [2.0, 1.5], [2.0, 3.0], [0.0, 3.0]]
            .map(|[x, z]| [x, 0.0, z])
            .to_vec();
        let obstacles: [Vec<Vertex>; 3] = [
            vec![[0.0, 0.0, 3.2], [4.0, 0.0, 3.2], [4.0, -1.2, 3.2], [0.0, -1.2, 3.2]],
            vec![[3.0, -0.1, 0.0], [3.0, -1.5, 0.0], [3.0, -1.5, 3.0], [3.0, -0.1, 3.0]],
            vec![
                [0.0, -2.0, 0.0],
                [1.5, -2.0, 0.0],
                [1.5, -2.0, 0.5],
                [0.5, -2.0, 0.5],
                [0.5, -2.0, 2.0],
                [0.0, -2.0, 2.0],
            ],
        ];
        let receiver = shaded(&surface, &[&obstacles[0], &obstacles[1], &obstacles[2]]);
        let obstacles = obstacles.map(|vertices| PlaneSurface::of(&vertices));
        for (azimuth, elevation) in
            [(180.0, 30.0), (150.0, 50.0), (215.0, 20.0), (120.0, 10.0), (190.0, 65.0)]
        {
            let at = sun(azimuth, elevation);
            let (mut sunlit, mut all) = (0, 0);
            let n = 200;
            for i in 0..n {
                for j in 0..n {
                    let x = 4.0 * (f64::from(i) + 0.5) / f64::from(n);
                    let z = 3.0 * (f64::from(j) + 0.5) / f64::from(n);
                    if x > 2.0 && z > 1.5 {
                        continue;
                    }
                    all += 1;
                    sunlit += i32::from(!obstacles.iter().any(|shade| blocks(shade, [x, 0.0, z], at)));
                }
            }
            let rays = f64::from(sunlit) / f64::from(all);
            let exact = receiver.sunlit_fraction(at);
            assert!((rays - exact).abs() < 6e-3, "{azimuth}, {elevation}: {rays} and {exact}");
        }
    }

    /// Whether a ray from a point meets an obstacle.
    fn blocks(obstacle: &PlaneSurface, from: Vertex, towards: Vertex) -> bool {
        let [u, v, h] = obstacle.plane.local(from);
        let d = obstacle.plane.direction(towards);
        let t = -h / d[2];
        let p = [u + t * d[0], v + t * d[1]];
        let inside = |piece: &Vec<Point>| {
            (0..piece.len()).all(|k| double_area(piece[k], piece[(k + 1) % piece.len()], p) >= 0.0)
        };
        t > 0.0 && obstacle.pieces.iter().any(inside)
    }

    /// A very long overhang at the top of a strip: the strip sees the sky between horizon and edge. With unit depth and a
    /// strip of height H right below, the view factor of the strip to the overhang is (1 + H - sqrt(1 + H^2))/(2 H)
    /// (crossed strings); without it the strip sees half of the sky.
    #[test]
    fn sky_under_a_long_overhang() {
        let long = 2000.0;
        let strip = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 2.0], [-1.0, 0.0, 2.0]];
        let overhang = [[-long, 0.0, 2.0], [long, 0.0, 2.0], [long, -1.0, 2.0], [-long, -1.0, 2.0]];
        let receiver = shaded(&strip, &[&overhang]);
        let view = (1.0 + 2.0 - 5.0_f64.sqrt()) / 4.0;
        assert!((receiver.sky.sky - (0.5 - view) / 0.5).abs() < 1e-3, "{}", receiver.sky.sky);
        assert!((receiver.sky.horizon - 1.0).abs() < 2e-3);
    }

    /// Only the part of an obstacle in front of the plane counts: a wall below an overhang does not shade its upper side, and a
    /// fin through the plane is cut at it.
    #[test]
    fn obstacles_behind_the_plane() {
        let mut upper = OVERHANG;
        upper.reverse();
        let below: [Vertex; 4] = WALL.map(|[x, y, z]| [x, y - 0.5, z - 0.1]);
        assert!(!shaded(&upper, &[&below]).obstructed());
        assert!(!shaded(&WALL, &[&WALL]).obstructed());
        let through = [[4.0, 1.0, 0.0], [4.0, -1.0, 0.0], [4.0, -1.0, 2.7], [4.0, 1.0, 2.7]];
        let receiver = shaded(&WALL, &[&through]);
        assert_eq!(receiver.obstacles.len(), 1);
        assert!(receiver.obstacles[0].corners.iter().all(|point| point[2] >= 0.0));
    }

    fn behind_walls(surface: &[Vertex], walls: &[&[Vertex]]) -> Receiver {
        let walls: Vec<PlaneSurface> = walls.iter().map(|wall| PlaneSurface::of(wall)).collect();
        Receiver::new(PlaneSurface::of(surface), &[], &walls.iter().collect::<Vec<_>>())
    }

    /// Walls shade as thin shades in their place do, whether they touch the surface or stand far from it.
    #[test]
    fn walls_and_shades_in_one_place() {
        let fin: [Vertex; 4] = [[3.5, 0.0, 0.0], [3.5, -1.0, 0.0], [3.5, -1.0, 2.7], [3.5, 0.0, 2.7]];
        let house: [Vertex; 4] =
            [[9.0, -30.0, 0.0], [-2.0, -20.0, 0.0], [-2.0, -20.0, 9.0], [9.0, -30.0, 9.0]];
        let gate: [Vertex; 4] = [[2.0, -4.0, 1.0], [1.0, -4.0, 1.0], [1.0, -4.0, 3.0], [2.0, -4.0, 3.0]];
        for obstacles in [&[&fin[..]][..], &[&house], &[&gate], &[&house, &fin, &gate, &OVERHANG]] {
            let (one, other) = (shaded(&WINDOW, obstacles), behind_walls(&WINDOW, obstacles));
            assert_eq!(other.open_sky.to_bits(), other.sky.sky.to_bits());
            assert_eq!(one.open_sky, 1.0);
            let mut dark = 0;
            for azimuth in 0..36 {
                for elevation in -8..9 {
                    let at = sun(10.0 * f64::from(azimuth) + 3.0, 10.0 * f64::from(elevation) + 4.0);
                    let fractions = [&one, &other].map(|receiver| receiver.sunlit_fraction(at));
                    assert!((fractions[0] - fractions[1]).abs() < 1e-9, "{fractions:?}");
                    dark += i32::from(fractions[1] < 1.0);
                }
            }
            assert!(dark > 2, "{dark}");
            assert!(
                (one.sky.sky - other.sky.sky).abs() < 2e-3
                    && (one.sky.ground, other.open_sky) == (1.0, other.sky.sky)
            );
        }
    }

    /// A point of a wall, `y` above the foot of a very long parallel wall of height H at the distance D: above the top of that
    /// wall at the elevation a it sees 1 - sin a of its half of the sky, and before its foot, b below the horizon, 1 - sin b of
    /// the ground.
    #[test]
    fn sky_and_ground_before_a_long_wall() {
        let long = 4000.0;
        for (y, distance, height) in [(3.0, 7.0, 10.0), (0.5, 4.0, 3.0), (6.0, 20.0, 6.5)] {
            let patch: [Vertex; 4] =
                [[0.0, 0.0, y], [0.01, 0.0, y], [0.01, 0.0, y + 0.01], [0.0, 0.0, y + 0.01]];
            let wall =
                [[long, 0.0], [-long, 0.0], [-long, height], [long, height]].map(|[x, z]| [x, -distance, z]);
            let receiver = behind_walls(&patch, &[&wall]);
            let sine = |rise: f64| rise / (rise * rise + distance * distance).sqrt();
            let [sky, ground] = [1.0 - sine(height - y), 1.0 - sine(y)];
            assert!((receiver.sky.sky - sky).abs() < 2e-3, "{} and {sky}", receiver.sky.sky);
            assert!((receiver.sky.ground - ground).abs() < 2e-3, "{} and {ground}", receiver.sky.ground);
            assert!(receiver.sky.horizon < 1e-2);
        }
    }

    /// The floor of a square yard as deep as wide sees of the sky what a square sees of an equal one opposite to it, 0.199825
    /// (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-11).
    #[test]
    fn the_floor_of_a_yard() {
        let floor: [Vertex; 4] = [[0.0, 0.0, 0.0], [6.0, 0.0, 0.0], [6.0, 6.0, 0.0], [0.0, 6.0, 0.0]];
        let walls: [[Vertex; 4]; 4] = core::array::from_fn(|k| {
            let (a, b) = (floor[k], floor[(k + 1) % 4]);
            [a, b, [b[0], b[1], 6.0], [a[0], a[1], 6.0]]
        });
        let receiver = behind_walls(&floor, &walls.each_ref().map(<[Vertex; 4]>::as_slice));
        assert!((receiver.sky.sky - 0.199_825).abs() < 1e-3, "{}", receiver.sky.sky);
        assert_eq!(receiver.sky.ground, 1.0);
        // Due south at 45 deg the shadow of the south wall covers all of it, at atan 2 half of it.
        assert_eq!(receiver.sunlit_fraction(sun(180.0, 44.9)), 0.0);
        let half = receiver.sunlit_fraction(sun(180.0, 63.434_948_822_922_01));
        assert!((half - 0.5).abs() < 1e-9, "{half}");
    }

    /// Seen from its other side a wall has the same area in the mirrored place.
    #[test]
    fn the_other_side_of_a_wall() {
        let other = PlaneSurface::of(&WALL).reversed();
        assert!((other.plane.normal()[1] - 1.0).abs() < 1e-15);
        for vertex in other.pieces_in_space().concat() {
            assert!(WALL.iter().any(|corner| (0..3).all(|k| (corner[k] - vertex[k]).abs() < 1e-12)));
        }
        assert!(other.pieces.iter().all(|piece| area(piece) > 0.0));
    }
}
