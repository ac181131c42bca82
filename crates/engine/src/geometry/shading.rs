//! The fractions of sun and sky that obstacles leave of a surface, by polygons without sampling of the surface.
//!
//! An obstacle throws its shadow along the direction of the sun onto the plane of a surface. The shadow is subtracted from the
//! convex pieces of the surface, so that overlapping shadows count once. What is left is sunlit.
//!
//! Obstacles also cover the sky. The fraction left of the isotropic sky is the mean of the sunlit fraction over all directions
//! of the sky, weighted by the cosine of incidence; the fraction left of the brightening of the horizon is the same mean just
//! above the horizon. Circumsolar radiation is reduced with the beam. Radiation reflected by the ground is not reduced.

use std::borrow::Cow;

use super::plane::{Point, Vertex, dot};
use super::polygon::{area, project, subtract};
use super::surface::PlaneSurface;
use super::{GRAZING, LEAST_LENGTH, SAME_PLANE};
use crate::number::real::Real;
use crate::physics::solar::SkyVisibility;

/// Bands of elevation and sectors of azimuth of the sky.
const SKY: [usize; 2] = [36, 144];
/// Elevation at which the horizon is evaluated [rad].
const HORIZON: f64 = 1e-3;

/// A surface outdoors, and the obstacles in front of it.
#[derive(Debug, Clone)]
pub(crate) struct Receiver {
    /// The surface.
    pub(crate) surface: PlaneSurface,
    /// Convex pieces of the obstacles: coordinates along the plane of the surface, and heights above it [m].
    obstacles: Vec<Vec<Vertex>>,
    /// Fractions left of the sky [-]; that of the sun's disc is 1.
    pub(crate) sky: SkyVisibility,
}

impl Receiver {
    /// Prepares a surface, and of the obstacles the parts in front of its plane.
    pub(crate) fn new(surface: PlaneSurface, obstacles: &[PlaneSurface]) -> Self {
        let pieces = obstacles.iter().flat_map(PlaneSurface::pieces_in_space);
        let front = pieces.filter_map(|piece| {
            let local: Vec<Vertex> = piece.iter().map(|&vertex| surface.plane.local(vertex)).collect();
            part_in_front(&local)
        });
        let mut receiver = Self { obstacles: front.collect(), surface, sky: SkyVisibility::FULL };
        if receiver.obstructed() {
            receiver.sky = receiver.sky_visibility();
        }
        receiver
    }

    /// Whether an obstacle stands in front of the surface.
    pub(crate) fn obstructed(&self) -> bool {
        !self.obstacles.is_empty()
    }

    /// Convex pieces of the surface that the sun reaches; all of them where it is behind the surface.
    pub(crate) fn sunlit_pieces(&self, sun: Vertex) -> Cow<'_, [Vec<Point>]> {
        let direction = self.surface.plane.direction(sun);
        if self.obstacles.is_empty() || direction[2] < GRAZING {
            return Cow::Borrowed(&self.surface.pieces);
        }
        let (mut pieces, mut shadow) = (self.surface.pieces.clone(), Vec::new());
        for obstacle in &self.obstacles {
            project(obstacle, direction, &mut shadow);
            if area(&shadow) > LEAST_LENGTH * LEAST_LENGTH {
                pieces = subtract(pieces, &shadow);
            }
        }
        Cow::Owned(pieces)
    }

    /// Fraction of the surface that the sun reaches from a direction [-]; 1 where it is behind the surface.
    pub(crate) fn sunlit_fraction(&self, sun: Vertex) -> f64 {
        if self.obstacles.is_empty() {
            return 1.0;
        }
        let sunlit: f64 = self.sunlit_pieces(sun).iter().map(|piece| area(piece)).sum();
        (sunlit / self.surface.area).min(1.0)
    }

    fn sky_visibility(&self) -> SkyVisibility {
        let [bands, sectors] = SKY;
        let band = core::f64::consts::FRAC_PI_2 / bands as f64;
        let centres: Vec<f64> = (0..bands).map(|k| (k as f64 + 0.5) * band).collect();
        let mean = |elevations: &[f64]| {
            let (mut seen, mut all) = (0.0, 0.0);
            for &elevation in elevations {
                let (up, level) = (Real::sin(elevation), Real::cos(elevation));
                for k in 0..sectors {
                    let azimuth = (k as f64 + 0.5) * core::f64::consts::TAU / sectors as f64;
                    let sun = [Real::sin(azimuth) * level, Real::cos(azimuth) * level, up];
                    let weight = dot(sun, self.surface.plane.normal()) * level;
                    if weight > GRAZING {
                        seen += weight * self.sunlit_fraction(sun);
                        all += weight;
                    }
                }
            }
            if all > 0.0 { seen / all } else { 1.0 }
        };
        SkyVisibility { sun: 1.0, sky: mean(&centres), horizon: mean(&[HORIZON]) }
    }
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
        Receiver::new(PlaneSurface::of(surface), &obstacles)
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
        assert!(receiver.obstacles[0].iter().all(|point| point[2] >= 0.0));
    }
}
