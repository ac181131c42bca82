//! The geometry of sun and shade of a building: which surfaces obstacles shade, and where the beams through windows end.
//!
//! A description is compiled to receivers and beam tracers once. At an instant their fractions are computed once for all
//! members of an ensemble, and read by wall and by window.
//!
//! A frame has the same outline as its glass: rays that reach the outline end on the glass.

use super::ids::SurfaceId;
use super::layout::ZonePlan;
use crate::geometry::patches::{BeamTracer, Target};
use crate::geometry::shading::Receiver;
use crate::geometry::surface::PlaneSurface;
use crate::input::description::{Description, Facing, ZoneSun};
use crate::physics::solar::{SkyVisibility, Sunlight};

/// All geometry of sun and shade in a building.
#[derive(Debug, Clone, Default)]
pub struct SolarGeometry {
    /// By wall: its outside surface where obstacles stand in front of it, and the place of its sunlit fraction.
    receivers: Vec<Option<(usize, Receiver)>>,
    /// By window, in the order of the plan: the beam where it is traced, and the place of its first fraction.
    tracers: Vec<Option<(usize, BeamTracer)>>,
    /// Number of fractions at an instant.
    size: usize,
}

impl SolarGeometry {
    /// Prepares a description.
    #[must_use]
    pub fn new(description: &Description, windows: &[usize], zones: &[ZonePlan]) -> Self {
        let walls = &description.surfaces;
        let traced = |zone: usize| matches!(description.zones[zone].sun, ZoneSun::Geometry);
        let any_traced = (0..zones.len()).any(traced);
        if description.shades.is_empty() && !any_traced {
            let none = vec![None; walls.len()];
            return Self { receivers: none, tracers: windows.iter().map(|_| None).collect(), size: 0 };
        }
        let surfaces = net_surfaces(description);
        let obstacles: Vec<PlaneSurface> =
            description.shades.iter().map(|shade| PlaneSurface::of(shade)).collect();
        let mut size = 0;
        let mut place = |count: usize| {
            size += count;
            size - count
        };
        let receivers: Vec<_> = walls
            .iter()
            .zip(&surfaces)
            .map(|(wall, surface)| {
                let outdoors = wall.outside.facing == Facing::Outdoors;
                let receiver = Receiver::new(surface.clone().filter(|_| outdoors)?, &obstacles);
                receiver.obstructed().then(|| (place(1), receiver))
            })
            .collect();
        let tracers = windows
            .iter()
            .map(|&w| {
                let zone = zones.iter().position(|zone| zone.surfaces.contains(&(SurfaceId::inside(w))))?;
                let window = surfaces[w].clone().filter(|_| traced(zone))?;
                let targets: Vec<_> = zones[zone]
                    .surfaces
                    .iter()
                    .map(|&surface| target(description, &window, &surfaces, surface))
                    .collect();
                let first = place(targets.len());
                Some((first, BeamTracer::new(Receiver::new(window, &obstacles), targets)))
            })
            .collect();
        Self { receivers, tracers, size }
    }

    /// Fractions at an instant, to be read by the functions below; none where no radiation comes from the sun's direction.
    #[must_use]
    pub fn at(&self, light: &Sunlight) -> Box<[f64]> {
        if self.size == 0 || !light.directed() || light.direction[2] <= 0.0 {
            return Box::default();
        }
        let mut fractions = vec![0.0; self.size];
        for (place, receiver) in self.receivers.iter().flatten() {
            fractions[*place] = receiver.sunlit_fraction(light.direction);
        }
        for (first, tracer) in self.tracers.iter().flatten() {
            tracer.trace(light.direction, &mut fractions[*first..first + tracer.len()]);
        }
        fractions.into_boxed_slice()
    }

    /// Whether nothing depends on the direction of the sun.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.size == 0
    }

    /// Whether an obstacle shades the outside of a wall.
    #[must_use]
    pub fn shaded(&self, wall: usize) -> bool {
        self.receivers[wall].is_some()
    }

    /// Fractions that obstacles leave of sun and sky on the outside of a wall.
    #[must_use]
    pub fn open(&self, wall: usize, fractions: &[f64]) -> SkyVisibility {
        match &self.receivers[wall] {
            Some((place, receiver)) => {
                SkyVisibility { sun: fractions.get(*place).copied().unwrap_or(1.0), ..receiver.sky }
            }
            None => SkyVisibility::FULL,
        }
    }

    /// Fractions of the beam through a window that end on each surface of its zone [-]; none where it is not traced.
    #[must_use]
    pub fn beam_fractions<'a>(&self, window: usize, fractions: &'a [f64]) -> Option<&'a [f64]> {
        let (first, tracer) = self.tracers[window].as_ref()?;
        fractions.get(*first..first + tracer.len())
    }
}

/// The walls with vertices as plane surfaces, without the openings that lie in them.
fn net_surfaces(description: &Description) -> Vec<Option<PlaneSurface>> {
    let walls = description.surfaces.iter();
    let whole: Vec<Option<PlaneSurface>> =
        walls.map(|wall| (wall.vertices.len() > 2).then(|| PlaneSurface::of(&wall.vertices))).collect();
    let all: Vec<PlaneSurface> = whole.iter().flatten().cloned().collect();
    whole.into_iter().map(|surface| surface.map(|surface| surface.without(&all))).collect()
}

/// A surface of a zone on which the beam through a window may end.
fn target(
    description: &Description,
    window: &PlaneSurface,
    surfaces: &[Option<PlaneSurface>],
    surface: SurfaceId,
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
