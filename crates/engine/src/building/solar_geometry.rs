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
    pub fn visibility(&self, wall: usize, fractions: &[f64]) -> SkyVisibility {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::plan::Plan;
    use crate::building::test_buildings::{WINDOW, glazed_zone};
    use crate::input::description::DiffuseSky;
    use crate::input::forcing::{CLIMATE_CHANNELS, channel};

    fn sunlight(direction: [f64; 3]) -> Sunlight {
        let mut row = [0.0; CLIMATE_CHANNELS];
        row[channel::DIRECT_NORMAL] = 800.0;
        for (k, at) in [channel::SUN_EAST, channel::SUN_NORTH, channel::SUN_UP].into_iter().enumerate() {
            row[at] = direction[k];
        }
        Sunlight::new(&row, DiffuseSky::Isotropic)
    }

    /// Nothing to compute without obstacles and traced beams.
    #[test]
    fn empty_without_shades_and_beams() {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        assert!(plan.solar_geometry.is_empty());
        let half = 0.5_f64.sqrt();
        assert!(plan.solar_geometry.at(&sunlight([0.0, -half, half])).is_empty());
        assert_eq!(plan.solar_geometry.visibility(0, &[]), SkyVisibility::FULL);
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
        assert!(geometry.shaded(0) && geometry.shaded(WINDOW));
        let wall = geometry.visibility(0, &fractions);
        assert!((wall.sun - (8.0 * 1.7 - 3.0 * 1.5) / 15.6).abs() < 1e-12, "{wall:?}");
        assert!(wall.sky < 1.0 && wall.sky > 0.5);
        assert!((geometry.visibility(WINDOW, &fractions).sun - 0.75).abs() < 1e-12);
        let beam = geometry.beam_fractions(0, &fractions).unwrap();
        assert!((beam[4] - 1.0).abs() < 1e-12 && beam.iter().sum::<f64>() < 1.0 + 1e-12, "{beam:?}");
        // At night no fractions are stored: all of the sun's disc, and no beam.
        let night = geometry.at(&sunlight([0.0, -half, -half]));
        assert!(night.is_empty() && geometry.visibility(0, &night).sun == 1.0);
        assert_eq!(geometry.beam_fractions(0, &night), None);
    }
}
