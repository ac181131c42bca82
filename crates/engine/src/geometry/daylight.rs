//! Which part of a surface the sun reaches, and where a beam through a window ends: polygons, exactly.
//!
//! Surfaces and shades are cut into convex pieces. A shade throws its shadow along the sun's direction onto the plane of a
//! surface; the shadow is cut off the surface's pieces, so that shadows that overlap count once. What is left is sunlit. The
//! beam through a window is followed the other way: each surface of the zone is projected along the sun's direction onto
//! the plane of the window and cut with its sunlit pieces.
//!
//! Shades act on the sky as well: the share of the isotropic sky that they leave is the mean of the sunlit share over
//! all directions of the sky, weighted by the cosine of incidence; that of the horizon the same just above the horizon.
//! The bright sky around the sun goes with the sun. What the ground reflects is not reduced.
//!
//! Rays that end on a window with a frame end on its glass.
//!
//! All of this depends on vertices and the sun alone. It is worked out in plain numbers, once per instant, for all
//! members of an ensemble.

use std::borrow::Cow;

use crate::building::ids::SurfaceId;
use crate::building::plan::ZonePlan;
use crate::input::description::{Description, Facing, ZoneSun};
use crate::number::real::Real;
use crate::physics::solar::{SkyVisibility, Sunlight};

/// Lengths below this are none [m].
const TOUCH: f64 = 1e-6;
/// Planes closer than this are one [m].
const PLANE: f64 = 1e-3;
/// Cosines of incidence below this are grazing: nothing falls on the surface.
const GRAZING: f64 = 1e-6;
/// Bands of elevation and sectors of azimuth that the sky is cut into.
const SKY: [usize; 2] = [36, 144];
/// What stands for just above the horizon [rad].
const JUST_ABOVE: f64 = 1e-3;

type Point = [f64; 2];
type Vertex = [f64; 3];

/// A plane with coordinates along it, and the height above it.
#[derive(Debug, Clone)]
struct Frame {
    origin: Vertex,
    axes: [Vertex; 3],
}

fn dot(a: Vertex, b: Vertex) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: Vertex, b: Vertex) -> Vertex {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Vertex, b: Vertex) -> Vertex {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Vertex) -> Vertex {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

impl Frame {
    fn of(vertices: &[Vertex]) -> Self {
        let origin = vertices[0];
        let mut area = [0.0; 3];
        for pair in vertices.windows(2) {
            let part = cross(minus(pair[0], origin), minus(pair[1], origin));
            area = core::array::from_fn(|k| area[k] + part[k]);
        }
        let normal = unit(area);
        let edge = minus(vertices[1], origin);
        let off = dot(edge, normal);
        let along = unit(core::array::from_fn(|k| edge[k] - off * normal[k]));
        Self { origin, axes: [along, cross(normal, along), normal] }
    }

    fn normal(&self) -> Vertex {
        self.axes[2]
    }

    /// Coordinates along the plane, and the height above it.
    fn local(&self, vertex: Vertex) -> Vertex {
        let offset = minus(vertex, self.origin);
        self.axes.map(|axis| dot(offset, axis))
    }

    fn direction(&self, direction: Vertex) -> Vertex {
        self.axes.map(|axis| dot(direction, axis))
    }

    fn vertex(&self, [u, v]: Point) -> Vertex {
        core::array::from_fn(|k| self.origin[k] + u * self.axes[0][k] + v * self.axes[1][k])
    }
}

/// Twice the area of a triangle, positive where it turns to the left.
fn turn(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn area(polygon: &[Point]) -> f64 {
    let mut sum = 0.0;
    for k in 1..polygon.len().saturating_sub(1) {
        sum += turn(polygon[0], polygon[k], polygon[k + 1]);
    }
    0.5 * sum
}

/// The part of a convex polygon to the left of a line, into `kept`; to the right with `from` and `to` exchanged.
fn left_of(polygon: &[Point], from: Point, to: Point, kept: &mut Vec<Point>) {
    kept.clear();
    let Some(&last) = polygon.last() else { return };
    let (mut here, mut a) = (last, turn(from, to, last));
    for &next in polygon {
        let b = turn(from, to, next);
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

/// Whether the boxes round two polygons share no area.
fn apart(a: &[Point], b: &[Point]) -> bool {
    (0..2).any(|k| {
        let range = |polygon: &[Point]| {
            polygon
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p[k]), high.max(p[k])])
        };
        let ([a0, a1], [b0, b1]) = (range(a), range(b));
        a1 <= b0 || b1 <= a0
    })
}

/// Convex pieces less a convex polygon that turns to the left.
fn cut_off(pieces: Vec<Vec<Point>>, hole: &[Point]) -> Vec<Vec<Point>> {
    let mut left = Vec::with_capacity(pieces.len() + 2);
    for piece in pieces {
        if apart(&piece, hole) {
            left.push(piece);
            continue;
        }
        let mut rest = piece;
        for (k, &from) in hole.iter().enumerate() {
            let to = hole[(k + 1) % hole.len()];
            let (mut outside, mut inside) = (Vec::new(), Vec::new());
            left_of(&rest, to, from, &mut outside);
            if area(&outside) > TOUCH * TOUCH {
                left.push(outside);
            }
            left_of(&rest, from, to, &mut inside);
            rest = inside;
            if area(&rest) <= TOUCH * TOUCH {
                break;
            }
        }
    }
    left
}

/// Area that two convex polygons share, the second turning to the left; `scratch` is overwritten.
fn shared(a: &[Point], b: &[Point], scratch: &mut [Vec<Point>; 2]) -> f64 {
    let [rest, next] = scratch;
    rest.clear();
    rest.extend_from_slice(a);
    for (k, &from) in b.iter().enumerate() {
        let to = b[(k + 1) % b.len()];
        let (mut left, mut right) = (false, false);
        for &point in rest.iter() {
            let side = turn(from, to, point);
            left |= side > 0.0;
            right |= side < 0.0;
        }
        if !left {
            return 0.0;
        }
        // Most edges pass by.
        if right {
            left_of(rest, from, to, next);
            core::mem::swap(rest, next);
        }
    }
    area(rest)
}

/// A simple polygon that turns to the left, as convex pieces: itself, or triangles (ear clipping).
fn convex_pieces(polygon: Vec<Point>) -> Vec<Vec<Point>> {
    let corner = |points: &[Point], k: usize| {
        let n = points.len();
        [points[(k + n - 1) % n], points[k], points[(k + 1) % n]]
    };
    let convex = (0..polygon.len()).all(|k| {
        let [a, b, c] = corner(&polygon, k);
        turn(a, b, c) >= 0.0
    });
    if convex {
        return vec![polygon];
    }
    let mut rest = polygon;
    let mut pieces = Vec::new();
    while rest.len() > 3 {
        let ear = (0..rest.len()).find(|&k| {
            let [a, b, c] = corner(&rest, k);
            let inside = |p: &Point| turn(a, b, *p) >= 0.0 && turn(b, c, *p) >= 0.0 && turn(c, a, *p) >= 0.0;
            turn(a, b, c) > 0.0 && !rest.iter().any(|p| *p != a && *p != b && *p != c && inside(p))
        });
        // A simple polygon always has an ear; one whose corners lie in a line has nothing left to give.
        let Some(k) = ear else { break };
        pieces.push(corner(&rest, k).to_vec());
        rest.remove(k);
    }
    pieces.push(rest);
    pieces.retain(|piece| area(piece) > TOUCH * TOUCH);
    pieces
}

/// A plane surface in convex pieces.
#[derive(Debug, Clone)]
struct Shape {
    frame: Frame,
    pieces: Vec<Vec<Point>>,
    area: f64,
}

impl Shape {
    fn of(vertices: &[Vertex]) -> Self {
        let frame = Frame::of(vertices);
        let flat = vertices.iter().map(|&vertex| {
            let [u, v, _] = frame.local(vertex);
            [u, v]
        });
        let pieces = convex_pieces(flat.collect());
        let area = pieces.iter().map(|piece| area(piece)).sum();
        Self { frame, pieces, area }
    }

    /// Without what lies in it.
    fn without(mut self, others: &[Self]) -> Self {
        let whole = self.area;
        for other in others {
            let same = dot(self.frame.normal(), other.frame.normal()) > 1.0 - 1e-6
                && self.frame.local(other.frame.origin)[2].abs() < PLANE;
            if !same || other.area >= whole * (1.0 - 1e-9) {
                continue;
            }
            for hole in other.corners() {
                let flat: Vec<Point> = hole
                    .iter()
                    .map(|&vertex| {
                        let [u, v, _] = self.frame.local(vertex);
                        [u, v]
                    })
                    .collect();
                self.pieces = cut_off(self.pieces, &flat);
            }
        }
        self.area = self.pieces.iter().map(|piece| area(piece)).sum();
        self
    }

    /// Its pieces in space.
    fn corners(&self) -> Vec<Vec<Vertex>> {
        self.pieces.iter().map(|piece| piece.iter().map(|&p| self.frame.vertex(p)).collect()).collect()
    }
}

/// Points at coordinates and heights, projected along a direction onto the plane; turned to the left.
fn project(points: &[Vertex], [su, sv, sn]: Vertex, flat: &mut Vec<Point>) {
    flat.clear();
    flat.extend(points.iter().map(|&[u, v, h]| [u - h * su / sn, v - h * sv / sn]));
    if area(flat) < 0.0 {
        flat.reverse();
    }
}

/// A surface outdoors, and the shades in front of it.
#[derive(Debug, Clone)]
pub struct Receiver {
    shape: Shape,
    /// Convex pieces of shades, in the surface's coordinates.
    shades: Vec<Vec<Vertex>>,
    /// Shares that are left of the sky; `sun` is 1.
    pub sky: SkyVisibility,
}

impl Receiver {
    fn new(shape: Shape, shades: &[Shape]) -> Self {
        let pieces = shades.iter().flat_map(Shape::corners);
        let front = pieces.filter_map(|piece| {
            let local: Vec<Vertex> = piece.iter().map(|&vertex| shape.frame.local(vertex)).collect();
            in_front(&local)
        });
        let mut receiver = Self { shades: front.collect(), shape, sky: SkyVisibility::FULL };
        if !receiver.shades.is_empty() {
            receiver.sky = receiver.open_sky();
        }
        receiver
    }

    /// Pieces that the sun reaches.
    fn lit(&self, sun: Vertex) -> Cow<'_, [Vec<Point>]> {
        let direction = self.shape.frame.direction(sun);
        if self.shades.is_empty() || direction[2] < GRAZING {
            return Cow::Borrowed(&self.shape.pieces);
        }
        let (mut pieces, mut shadow) = (self.shape.pieces.clone(), Vec::new());
        for shade in &self.shades {
            project(shade, direction, &mut shadow);
            if area(&shadow) > TOUCH * TOUCH {
                pieces = cut_off(pieces, &shadow);
            }
        }
        Cow::Owned(pieces)
    }

    /// Share of the surface that the sun reaches from a direction; 1 where it is behind.
    #[must_use]
    pub fn sunlit(&self, sun: Vertex) -> f64 {
        if self.shades.is_empty() {
            return 1.0;
        }
        let lit: f64 = self.lit(sun).iter().map(|piece| area(piece)).sum();
        (lit / self.shape.area).min(1.0)
    }

    #[allow(clippy::cast_precision_loss, reason = "counts are small")]
    fn open_sky(&self) -> SkyVisibility {
        let [bands, sectors] = SKY;
        let band = core::f64::consts::FRAC_PI_2 / bands as f64;
        let centres = (0..bands).map(|k| (k as f64 + 0.5) * band);
        let mean = |elevations: &[f64]| {
            let (mut seen, mut all) = (0.0, 0.0);
            for &elevation in elevations {
                let (up, level) = (Real::sin(elevation), Real::cos(elevation));
                for k in 0..sectors {
                    let azimuth = (k as f64 + 0.5) * core::f64::consts::TAU / sectors as f64;
                    let sun = [Real::sin(azimuth) * level, Real::cos(azimuth) * level, up];
                    let weight = dot(sun, self.shape.frame.normal()) * level;
                    if weight > GRAZING {
                        seen += weight * self.sunlit(sun);
                        all += weight;
                    }
                }
            }
            if all > 0.0 { seen / all } else { 1.0 }
        };
        let centres: Vec<f64> = centres.collect();
        SkyVisibility { sun: 1.0, sky: mean(&centres), horizon: mean(&[JUST_ABOVE]) }
    }
}

/// The part of a convex polygon above the plane that its heights are over; none where there is no such part.
fn in_front(points: &[Vertex]) -> Option<Vec<Vertex>> {
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
    (kept.iter().any(|point| point[2] > PLANE) && kept.len() > 2).then_some(kept)
}

/// The surfaces of a zone as a beam through one of its windows finds them.
#[derive(Debug, Clone)]
struct Tracer {
    window: Receiver,
    /// By surface of the zone: the normal into the zone, and convex pieces in the window's coordinates.
    surfaces: Vec<(Vertex, Vec<Vec<Vertex>>)>,
}

impl Tracer {
    /// Shares of the beam that end on each surface; they sum to one, or are all zero.
    fn trace(&self, sun: Vertex, shares: &mut [f64]) {
        let frame = &self.window.shape.frame;
        let direction = frame.direction(sun);
        shares.fill(0.0);
        if direction[2] < GRAZING {
            return;
        }
        let lit = self.window.lit(sun);
        let (mut seen, mut scratch) = (Vec::new(), [Vec::new(), Vec::new()]);
        for ((normal, pieces), share) in self.surfaces.iter().zip(shares.iter_mut()) {
            if dot(*normal, sun) <= 0.0 {
                continue;
            }
            for piece in pieces {
                project(piece, direction, &mut seen);
                *share += lit.iter().map(|part| shared(part, &seen, &mut scratch)).sum::<f64>();
            }
        }
        let sum: f64 = shares.iter().sum();
        if sum > 0.0 {
            for share in shares {
                *share /= sum;
            }
        }
    }
}

/// All geometry of sun and shade in a building.
#[derive(Debug, Clone, Default)]
pub struct Daylight {
    /// By wall: its outside surface, where shades stand in front of it.
    receivers: Vec<Option<(usize, Receiver)>>,
    /// By window, in the order of the plan's: first number of its shares, and what they come from.
    tracers: Vec<Option<(usize, Tracer)>>,
    /// Numbers per instant.
    size: usize,
}

impl Daylight {
    /// Prepares a description.
    #[must_use]
    pub fn new(description: &Description, windows: &[usize], zones: &[ZonePlan]) -> Self {
        let surfaces = &description.surfaces;
        let traced = |zone: usize| matches!(description.zones[zone].sun, ZoneSun::Geometry);
        let any_traced = (0..zones.len()).any(traced);
        if description.shades.is_empty() && !any_traced {
            let none = vec![None; surfaces.len()];
            return Self { receivers: none, tracers: windows.iter().map(|_| None).collect(), size: 0 };
        }
        let drawn: Vec<Option<Shape>> = surfaces
            .iter()
            .map(|wall| (wall.vertices.len() > 2).then(|| Shape::of(&wall.vertices)))
            .collect();
        let all: Vec<Shape> = drawn.iter().flatten().cloned().collect();
        let net: Vec<Option<Shape>> =
            drawn.into_iter().map(|shape| shape.map(|shape| shape.without(&all))).collect();
        let shades: Vec<Shape> = description.shades.iter().map(|shade| Shape::of(shade)).collect();
        let mut size = 0;
        let mut place = |count: usize| {
            size += count;
            size - count
        };
        let receivers: Vec<_> = surfaces
            .iter()
            .zip(&net)
            .map(|(wall, shape)| {
                let outdoors = wall.outside.facing == Facing::Outdoors;
                let receiver = Receiver::new(shape.clone().filter(|_| outdoors)?, &shades);
                (!receiver.shades.is_empty()).then(|| (place(1), receiver))
            })
            .collect();
        let tracers = windows
            .iter()
            .map(|&w| {
                let zone = zones.iter().position(|zone| zone.surfaces.contains(&(SurfaceId::inside(w))))?;
                let shape = net[w].clone().filter(|_| traced(zone))?;
                let surfaces = zones[zone].surfaces.iter().map(|&surface| {
                    // A frame shares the outline of its glass, on which the rays end.
                    let frame = surfaces[surface.wall()].frame.as_ref().is_some_and(|frame| frame.is_frame);
                    if frame { ([0.0; 3], Vec::new()) } else { seen(&shape, &net, surface) }
                });
                let surfaces: Vec<_> = surfaces.collect();
                let first = place(surfaces.len());
                Some((first, Tracer { window: Receiver::new(shape, &shades), surfaces }))
            })
            .collect();
        Self { receivers, tracers, size }
    }

    /// Numbers of an instant, to be read by the functions below; none where nothing comes from the sun.
    #[must_use]
    pub fn at(&self, light: &Sunlight) -> Box<[f64]> {
        if self.size == 0 || !light.directed() || light.direction[2] <= 0.0 {
            return Box::default();
        }
        let mut numbers = vec![0.0; self.size];
        for (slot, receiver) in self.receivers.iter().flatten() {
            numbers[*slot] = receiver.sunlit(light.direction);
        }
        for (first, tracer) in self.tracers.iter().flatten() {
            tracer.trace(light.direction, &mut numbers[*first..first + tracer.surfaces.len()]);
        }
        numbers.into_boxed_slice()
    }

    /// Whether nothing depends on where the sun stands.
    #[must_use]
    pub fn idle(&self) -> bool {
        self.size == 0
    }

    /// Whether anything shades a wall.
    #[must_use]
    pub fn shaded(&self, wall: usize) -> bool {
        self.receivers[wall].is_some()
    }

    /// What shades leave a wall of the sky.
    #[must_use]
    pub fn open(&self, wall: usize, numbers: &[f64]) -> SkyVisibility {
        match &self.receivers[wall] {
            Some((slot, receiver)) => {
                SkyVisibility { sun: numbers.get(*slot).copied().unwrap_or(1.0), ..receiver.sky }
            }
            None => SkyVisibility::FULL,
        }
    }

    /// Where the beam through a window ends, by surface of its zone; none where it is not followed.
    #[must_use]
    pub fn patches<'a>(&self, window: usize, numbers: &'a [f64]) -> Option<&'a [f64]> {
        let (first, tracer) = self.tracers[window].as_ref()?;
        numbers.get(*first..first + tracer.surfaces.len())
    }
}

/// A surface of a zone from a window.
fn seen(window: &Shape, net: &[Option<Shape>], surface: SurfaceId) -> (Vertex, Vec<Vec<Vertex>>) {
    let Some(shape) = &net[surface.wall()] else { return ([0.0; 3], Vec::new()) };
    let sign = if surface.is_outside() { 1.0 } else { -1.0 };
    let local = |piece: &Vec<Vertex>| piece.iter().map(|&vertex| window.frame.local(vertex)).collect();
    (shape.frame.normal().map(|x| sign * x), shape.corners().iter().map(local).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALL: [Vertex; 4] = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 0.0, 2.7], [0.0, 0.0, 2.7]];
    const WINDOW: [Vertex; 4] = [[0.5, 0.0, 0.2], [3.5, 0.0, 0.2], [3.5, 0.0, 2.2], [0.5, 0.0, 2.2]];
    const OVERHANG: [Vertex; 4] = [[0.0, 0.0, 2.7], [8.0, 0.0, 2.7], [8.0, -1.0, 2.7], [0.0, -1.0, 2.7]];

    fn sun(azimuth: f64, elevation: f64) -> Vertex {
        let (a, e) = (azimuth.to_radians(), elevation.to_radians());
        [Real::sin(a) * Real::cos(e), Real::cos(a) * Real::cos(e), Real::sin(e)]
    }

    fn shaded(surface: &[Vertex], shades: &[&[Vertex]]) -> Receiver {
        let shades: Vec<Shape> = shades.iter().map(|shade| Shape::of(shade)).collect();
        Receiver::new(Shape::of(surface), &shades)
    }

    /// Due south at 60 deg the shadow of 1 m reaches tan 60 = 1.732 m down: 1.232 m of the window's 2 m.
    #[test]
    fn an_overhang_at_noon() {
        let receiver = shaded(&WINDOW, &[&OVERHANG]);
        assert!((receiver.sunlit(sun(180.0, 60.0)) - (2.0 - (3.0_f64.sqrt() - 0.5)) / 2.0).abs() < 1e-12);
        assert!((receiver.sunlit(sun(180.0, 20.0)) - 1.0).abs() < 1e-12);
        assert!(receiver.sunlit(sun(180.0, 80.0)).abs() < 1e-12);
        // From the south-east the foot of the shadow moves west, but the overhang is long enough.
        let depth = 3.0_f64.sqrt() / 0.5_f64.sqrt() - 0.5;
        assert!((receiver.sunlit(sun(135.0, 60.0)) - (2.0 - depth.min(2.0)) / 2.0).abs() < 1e-12);
    }

    /// A fin of 1 m at the window's east edge: sun from 45 deg east of south throws it 1 m to the west.
    #[test]
    fn a_fin() {
        let fin: [Vertex; 4] = [[3.5, 0.0, 0.0], [3.5, -1.0, 0.0], [3.5, -1.0, 2.7], [3.5, 0.0, 2.7]];
        let receiver = shaded(&WINDOW, &[&fin]);
        assert!((receiver.sunlit(sun(135.0, 0.001)) - 2.0 / 3.0).abs() < 1e-4);
        assert!((receiver.sunlit(sun(225.0, 0.001)) - 1.0).abs() < 1e-12);
    }

    /// Overlapping shades count once: two overhangs on each other are one; overhang and fin by the union.
    #[test]
    fn shadows_overlap() {
        let one = shaded(&WINDOW, &[&OVERHANG]);
        let two = shaded(&WINDOW, &[&OVERHANG, &OVERHANG]);
        for k in 1..80 {
            let at = sun(100.0 + 2.0 * f64::from(k), f64::from(k));
            assert!((one.sunlit(at) - two.sunlit(at)).abs() < 1e-9);
        }
        assert!((one.sky.sky - two.sky.sky).abs() < 1e-9);
    }

    /// Rays from points of an L-shaped surface towards the sun, against polygons, with three shades (one not convex).
    #[test]
    fn against_rays() {
        let surface: Vec<Vertex> = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.5], [2.0, 1.5], [2.0, 3.0], [0.0, 3.0]]
            .map(|[x, z]| [x, 0.0, z])
            .to_vec();
        let shades: [Vec<Vertex>; 3] = [
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
        let receiver = shaded(&surface, &[&shades[0], &shades[1], &shades[2]]);
        let shapes: Vec<Shape> = shades.iter().map(|shade| Shape::of(shade)).collect();
        for (azimuth, elevation) in
            [(180.0, 30.0), (150.0, 50.0), (215.0, 20.0), (120.0, 10.0), (190.0, 65.0)]
        {
            let at = sun(azimuth, elevation);
            let (mut lit, mut all) = (0, 0);
            let n = 200;
            for i in 0..n {
                for j in 0..n {
                    let x = 4.0 * (f64::from(i) + 0.5) / f64::from(n);
                    let z = 3.0 * (f64::from(j) + 0.5) / f64::from(n);
                    if x > 2.0 && z > 1.5 {
                        continue;
                    }
                    all += 1;
                    lit += i32::from(!shapes.iter().any(|shape| blocks(shape, [x, 0.0, z], at)));
                }
            }
            let rays = f64::from(lit) / f64::from(all);
            let exact = receiver.sunlit(at);
            assert!((rays - exact).abs() < 6e-3, "{azimuth}, {elevation}: {rays} and {exact}");
        }
    }

    /// Whether a ray from a point meets a shape.
    fn blocks(shape: &Shape, from: Vertex, towards: Vertex) -> bool {
        let [u, v, h] = shape.frame.local(from);
        let d = shape.frame.direction(towards);
        let t = -h / d[2];
        let p = [u + t * d[0], v + t * d[1]];
        t > 0.0
            && shape
                .pieces
                .iter()
                .any(|piece| (0..piece.len()).all(|k| turn(piece[k], piece[(k + 1) % piece.len()], p) >= 0.0))
    }

    /// An endless overhang at the top of a strip: the strip sees the sky between horizon and edge. With unit depth and a
    /// strip of height H right below, the view factor of the strip to the overhang is (1 + H - sqrt(1 + H^2))/(2 H)
    /// (crossed strings), half the sky is seen without.
    #[test]
    fn sky_under_a_long_overhang() {
        let long = 2000.0;
        let strip = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 2.0], [-1.0, 0.0, 2.0]];
        let hood = [[-long, 0.0, 2.0], [long, 0.0, 2.0], [long, -1.0, 2.0], [-long, -1.0, 2.0]];
        let receiver = shaded(&strip, &[&hood]);
        let view = (1.0 + 2.0 - 5.0_f64.sqrt()) / 4.0;
        assert!((receiver.sky.sky - (0.5 - view) / 0.5).abs() < 1e-3, "{}", receiver.sky.sky);
        assert!((receiver.sky.horizon - 1.0).abs() < 2e-3);
    }

    /// A window in a wall is cut out of it, and a shade behind the plane throws no shadow on it.
    #[test]
    fn holes_and_backs() {
        let wall = Shape::of(&WALL).without(&[Shape::of(&WALL), Shape::of(&WINDOW)]);
        assert!((wall.area - (21.6 - 6.0)).abs() < 1e-9);
        assert!(shaded(&OVERHANG, &[&WALL]).shades.is_empty() || shaded(&WALL, &[&WALL]).shades.is_empty());
    }

    /// A beam through the south window of a box: at 45 deg due south it ends on the floor, from 0.2 m to 2.2 m in.
    #[test]
    fn a_beam_on_the_floor() {
        let floor = [[0.0, 0.0, 0.0], [0.0, 6.0, 0.0], [8.0, 6.0, 0.0], [8.0, 0.0, 0.0]];
        let north = [[8.0, 6.0, 0.0], [0.0, 6.0, 0.0], [0.0, 6.0, 2.7], [8.0, 6.0, 2.7]];
        let window = Shape::of(&WINDOW);
        let net = [Some(Shape::of(&floor)), Some(Shape::of(&north))];
        let surfaces =
            vec![seen(&window, &net, SurfaceId::inside(0)), seen(&window, &net, SurfaceId::inside(1))];
        let tracer = Tracer { window: Receiver::new(window, &[]), surfaces };
        let mut shares = [0.0; 2];
        tracer.trace(sun(180.0, 45.0), &mut shares);
        assert!((shares[0] - 1.0).abs() < 1e-12 && shares[1] == 0.0);
        // At tan e = 0.2, sin e = 0.2/sqrt(1.04), the ray from z ends on the north wall where z > 1.2: half of the window.
        tracer.trace(
            sun(180.0, 90.0 - crate::number::elementary::acos(0.2 / 1.04_f64.sqrt()).to_degrees()),
            &mut shares,
        );
        assert!((shares[0] - 0.5).abs() < 1e-9 && (shares[1] - 0.5).abs() < 1e-9, "{shares:?}");
    }
}
