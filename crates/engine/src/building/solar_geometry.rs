//! The geometry of sun and shade of a building: which surfaces obstacles shade, and where the beams through windows end.
//!
//! A description is compiled to receivers and beam tracers once. At an instant their fractions are computed once for all
//! members of an ensemble, and read by wall and by window.
//!
//! A frame has the same outline as its glass: rays that reach the outline end on the glass.

use rayon::prelude::*;

use super::ids::{BySide, SideId};
use super::layout::ZonePlan;
use crate::geometry::patches::{BeamTracer, Target};
use crate::geometry::shading::Receiver;
use crate::geometry::surface::PlaneSurface;
use crate::input::description::{Description, Facing, Side, Surface, ZoneSun};
use crate::physics::solar::{SkyVisibility, Sunlight};

/// All geometry of sun and shade in a building.
#[derive(Debug, Clone, Default)]
pub struct SolarGeometry {
    /// Surfaces outdoors with obstacles in front of them.
    receivers: BySide<Option<Shaded>>,
    /// By window, in the order of the plan: the beam where it is traced.
    tracers: Vec<Option<Traced>>,
    /// Number of fractions at an instant.
    size: usize,
}

/// A beam that is traced.
#[derive(Debug, Clone)]
struct Traced {
    tracer: BeamTracer,
    /// Place of its first fraction.
    first: usize,
    /// The same of an earlier window that has the same fractions.
    same_as: Option<usize>,
}

impl Traced {
    /// Places of its fractions.
    fn places(&self) -> core::ops::Range<usize> {
        self.first..self.first + self.tracer.len()
    }
}

/// Finds, for each beam, the first one that is alike.
fn find_alike(tracers: &mut [Option<Traced>]) {
    let mut different: Vec<usize> = Vec::new();
    for k in 0..tracers.len() {
        let (before, rest) = tracers.split_at_mut(k);
        let Some(traced) = &mut rest[0] else { continue };
        let mut known = different.iter().filter_map(|&k| before[k].as_ref());
        traced.same_as = known.find(|other| other.tracer.alike(&traced.tracer)).map(|other| other.first);
        if traced.same_as.is_none() {
            different.push(k);
        }
    }
}

/// A surface outdoors with obstacles in front of it.
#[derive(Debug, Clone)]
struct Shaded {
    receiver: Receiver,
    /// Place of its sunlit fraction; none: no sun of the climate reaches it.
    place: Option<usize>,
    /// Whether the description gives the fraction of the sky that it sees past all obstacles.
    given_sky: bool,
    /// Whether it gives the fraction of the ground.
    given_ground: bool,
}

impl SolarGeometry {
    /// Prepares a description.
    #[must_use]
    pub fn new(description: &Description, windows: &[usize], zones: &[ZonePlan]) -> Self {
        let walls = &description.surfaces;
        let traced = |zone: usize| matches!(description.zones[zone].sun, ZoneSun::Geometry);
        let any_traced = (0..zones.len()).any(traced);
        let obstructed = |side: &&Side| !side.shaded_by.is_empty() || !side.own_shades.is_empty();
        let any_walls = walls.iter().any(|wall| sides(wall).iter().any(obstructed));
        if description.shades.is_empty() && !any_traced && !any_walls {
            let none = (0..2 * walls.len()).map(|_| None).collect();
            return Self { receivers: none, tracers: windows.iter().map(|_| None).collect(), size: 0 };
        }
        let drawn = Drawn::new(description);
        let mut size = 0;
        let mut place = |count: usize| {
            size += count;
            size - count
        };
        let surfaces: Vec<SideId> = (0..2 * walls.len()).map(SideId::from_index).collect();
        let outdoors = |surface: SideId| side(description, surface).facing == Facing::Outdoors;
        // What each sees of the sky takes milliseconds.
        let all: Vec<Option<Receiver>> = surfaces
            .par_iter()
            .map(|&surface| outdoors(surface).then(|| drawn.receiver(description, surface)).flatten())
            .collect();
        let receivers: BySide<_> = surfaces
            .iter()
            .zip(all)
            .map(|(&surface, receiver)| {
                let side = side(description, surface);
                let lit = side.exposure.sun && !side.behind_obstacles;
                receiver.filter(Receiver::obstructed).map(|receiver| Shaded {
                    receiver,
                    place: lit.then(|| place(1)),
                    given_sky: side.sky_view.is_some(),
                    given_ground: side.ground_view.is_some(),
                })
            })
            .collect();
        let mut tracers: Vec<Option<Traced>> = windows
            .iter()
            .map(|&w| {
                let zone = zones.iter().position(|zone| zone.surfaces.contains(&(SideId::inside(w))))?;
                let outdoors = walls[w].outside.facing == Facing::Outdoors;
                let window = drawn.net[w].as_ref().filter(|_| traced(zone) && outdoors)?;
                let targets: Vec<_> = zones[zone]
                    .surfaces
                    .iter()
                    .map(|&surface| target(description, window, &drawn.net, surface))
                    .collect();
                let first = place(targets.len());
                let outside = SideId::outside(w);
                let receiver = match &receivers[outside] {
                    Some(shaded) => shaded.receiver.clone(),
                    None => drawn.receiver(description, outside)?,
                };
                Some(Traced { tracer: BeamTracer::new(receiver, targets), first, same_as: None })
            })
            .collect();
        find_alike(&mut tracers);
        Self { receivers, tracers, size }
    }

    /// Fractions at an instant, to be read by the functions below; none where no radiation comes from the sun's direction.
    #[must_use]
    pub fn at(&self, light: &Sunlight) -> Box<[f64]> {
        if self.size == 0 || !light.directed() || light.direction[2] <= 0.0 {
            return Box::default();
        }
        let mut fractions = vec![0.0; self.size];
        for shaded in self.receivers.iter().flatten() {
            if let Some(place) = shaded.place {
                fractions[place] = shaded.receiver.sunlit_fraction(light.direction);
            }
        }
        for traced in self.tracers.iter().flatten() {
            if let Some(same) = traced.same_as {
                fractions.copy_within(same..same + traced.tracer.len(), traced.first);
            } else {
                traced.tracer.trace(light.direction, &mut fractions[traced.places()]);
            }
        }
        fractions.into_boxed_slice()
    }

    /// Memory of the fractions at an instant [B].
    #[must_use]
    pub fn bytes_of_instant(&self) -> usize {
        size_of::<f64>() * self.size
    }

    /// Whether nothing depends on the direction of the sun.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.size == 0
    }

    /// Whether an obstacle stands in front of a surface.
    #[must_use]
    pub fn shaded(&self, surface: SideId) -> bool {
        self.receivers[surface].is_some()
    }

    /// Fractions that obstacles leave of sun, sky and ground on a surface.
    #[must_use]
    pub fn visibility(&self, surface: SideId, fractions: &[f64]) -> SkyVisibility {
        let Some(Shaded { receiver, place, given_sky, given_ground }) = &self.receivers[surface] else {
            return SkyVisibility::FULL;
        };
        SkyVisibility {
            sun: place.and_then(|place| fractions.get(place)).copied().unwrap_or(1.0),
            sky: if *given_sky { 1.0 } else { receiver.sky.sky },
            ground: if *given_ground { 1.0 } else { receiver.sky.ground },
            ..receiver.sky
        }
    }

    /// Fraction of the sky that walls leave of a surface, for its long-wave radiation [-].
    #[must_use]
    pub fn open_sky(&self, surface: SideId) -> f64 {
        match &self.receivers[surface] {
            Some(shaded) if !shaded.given_sky => shaded.receiver.open_sky,
            _ => 1.0,
        }
    }

    /// Fractions of the beam through a window that end on each surface of its zone [-]; none where it is not traced.
    #[must_use]
    pub fn beam_fractions<'a>(&self, window: usize, fractions: &'a [f64]) -> Option<&'a [f64]> {
        fractions.get(self.tracers[window].as_ref()?.places())
    }
}

/// The two sides of a wall.
fn sides(wall: &Surface) -> [&Side; 2] {
    [&wall.outside, &wall.inside]
}

/// The description of a surface.
fn side(description: &Description, surface: SideId) -> &Side {
    sides(&description.surfaces[surface.wall()])[surface.side()]
}

/// What has vertices.
struct Drawn {
    /// Walls and windows with the openings that lie in them.
    whole: Vec<Option<PlaneSurface>>,
    /// Without them.
    net: Vec<Option<PlaneSurface>>,
    shades: Vec<PlaneSurface>,
}

impl Drawn {
    fn new(description: &Description) -> Self {
        let walls = description.surfaces.iter();
        let whole: Vec<Option<PlaneSurface>> =
            walls.map(|wall| (wall.vertices.len() > 2).then(|| PlaneSurface::of(&wall.vertices))).collect();
        let all: Vec<PlaneSurface> = whole.iter().flatten().cloned().collect();
        let net = whole.iter().map(|surface| surface.clone().map(|surface| surface.without(&all))).collect();
        Self { whole, net, shades: description.shades.iter().map(|shade| PlaneSurface::of(shade)).collect() }
    }

    /// A surface, and what stands in front of it; none without vertices and without an outline of its own.
    fn receiver(&self, description: &Description, surface: SideId) -> Option<Receiver> {
        let side = side(description, surface);
        let own = side.own_shades.iter().map(|shade| PlaneSurface::of(shade));
        let Some(net) = self.net[surface.wall()].as_ref() else {
            let outline = (side.outline.len() > 2).then(|| PlaneSurface::of(&side.outline))?;
            return Some(Receiver::new(outline, &own.collect::<Vec<_>>(), &[]));
        };
        let walls: Vec<&PlaneSurface> =
            side.shaded_by.iter().filter_map(|&wall| self.whole[wall].as_ref()).collect();
        let net = if surface.is_outside() { net.clone() } else { net.reversed() };
        if side.own_shades.is_empty() {
            return Some(Receiver::new(net, &self.shades, &walls));
        }
        let shades: Vec<PlaneSurface> = self.shades.iter().cloned().chain(own).collect();
        Some(Receiver::new(net, &shades, &walls))
    }
}

/// A surface of a zone on which the beam through a window may end.
fn target(
    description: &Description,
    window: &PlaneSurface,
    surfaces: &[Option<PlaneSurface>],
    surface: SideId,
) -> Target {
    let wall = &description.surfaces[surface.wall()];
    let is_frame = wall.frame.as_ref().is_some_and(|frame| frame.is_frame);
    match &surfaces[surface.wall()] {
        Some(plane) if !is_frame => {
            // Vertices turn counter-clockwise seen from outside: normals of walls point to their outside.
            let towards = if surface.is_outside() { 1.0 } else { -1.0 };
            Target::new(window, plane, towards)
        }
        _ => Target::NONE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::plan::Plan;
    use crate::building::test_buildings::{WINDOW, glazed_zone};
    use crate::input::forcing::{CLIMATE_CHANNELS, channel};
    use crate::physics::diffuse::DiffuseSky;

    fn sunlight(direction: [f64; 3]) -> Sunlight {
        let mut row = [0.0; CLIMATE_CHANNELS];
        row[channel::DIRECT_NORMAL] = 800.0;
        for (k, at) in [channel::SUN_EAST, channel::SUN_NORTH, channel::SUN_UP].into_iter().enumerate() {
            row[at] = direction[k];
        }
        Sunlight::new(&row, DiffuseSky::named("isotropic").unwrap())
    }

    /// Nothing to compute without obstacles and traced beams.
    #[test]
    fn empty_without_shades_and_beams() {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        assert!(plan.solar_geometry.is_empty());
        let half = 0.5_f64.sqrt();
        assert!(plan.solar_geometry.at(&sunlight([0.0, -half, half])).is_empty());
        assert_eq!(plan.solar_geometry.visibility(SideId::outside(0), &[]), SkyVisibility::FULL);
        assert_eq!(plan.solar_geometry.beam_fractions(0, &[]), None);
    }

    /// Due south at 45 deg the overhang of 1 m shades the upper metre of the wall, 0.5 m of which are window: of the wall
    /// without its window (21.6 - 6) m2 are left 8 x 1.7 - 3 x 1.5. The beam ends on the floor.
    #[test]
    fn a_shaded_wall_and_its_window() {
        let plan = Plan::new(glazed_zone("geometry", true)).unwrap();
        let geometry = &plan.solar_geometry;
        let half = 0.5_f64.sqrt();
        let fractions = geometry.at(&sunlight([0.0, -half, half]));
        assert!(geometry.shaded(SideId::outside(0)) && geometry.shaded(SideId::outside(WINDOW)));
        let wall = geometry.visibility(SideId::outside(0), &fractions);
        assert!((wall.sun - (8.0 * 1.7 - 3.0 * 1.5) / 15.6).abs() < 1e-12, "{wall:?}");
        assert!(wall.sky < 1.0 && wall.sky > 0.5);
        assert!((geometry.visibility(SideId::outside(WINDOW), &fractions).sun - 0.75).abs() < 1e-12);
        let beam = geometry.beam_fractions(0, &fractions).unwrap();
        assert!((beam[4] - 1.0).abs() < 1e-12 && beam.iter().sum::<f64>() < 1.0 + 1e-12, "{beam:?}");
        // At night no fractions are stored: all of the sun's disc, and no beam.
        let night = geometry.at(&sunlight([0.0, -half, -half]));
        assert!(night.is_empty() && geometry.visibility(SideId::outside(0), &night).sun == 1.0);
        assert_eq!(geometry.beam_fractions(0, &night), None);
    }
}
