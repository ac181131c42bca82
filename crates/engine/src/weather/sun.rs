//! The sun on planes, through windows and in zones.
//!
//! Sunlight is incident on each plane; windows transmit a part of it and absorb another in their panes; what they transmit
//! into a zone is absorbed by its surfaces and its glass or is lost outdoors again
//! (see [`solar_distribution`](crate::building::solar_distribution)).

use crate::building::coefficients::{Boundary, Coefficients};
use crate::building::glazing::Glass;
use crate::building::ids::{BySide, SideId};
use crate::building::layout::{SideRole, ZonePlan};
use crate::building::plan::Plan;
use crate::building::solar_distribution::{FixedDistribution, SolarDistribution, TracedDistribution};
use crate::number::real::{Mask, Real};
use crate::weather::index::{IrradianceSource, WeatherIndex};
use crate::weather::instant::Instant;
use crate::weather::surface::SurfaceConditions;

/// The sun at a window.
#[derive(Debug, Clone)]
pub struct WindowConditions<S> {
    /// Transmitted into the zone of its inside; between zones less what it transmits the other way [W].
    pub transmitted: S,
    /// The part of it that comes from the sun's direction [W].
    pub beam: S,
    /// Absorbed in each pane, from both sides, and in a blind [W/m2].
    pub panes: Vec<S>,
    /// Part that a blind covers [-].
    pub covered: S,
    /// The part of it that acts in each cell [W/m2].
    pub cells: Vec<S>,
}

/// The sun in a zone [W].
#[derive(Debug, Clone, Copy)]
pub struct ZoneSolar<S> {
    /// Transmitted into it by its windows.
    pub transmitted: S,
    /// Transmitted outdoors again.
    pub lost: S,
    /// Absorbed by its glass from inside.
    pub in_glass: S,
}

/// The sun at an instant.
#[derive(Debug, Clone)]
pub struct SolarConditions<S> {
    /// Irradiance from each of [`WeatherIndex::irradiance_sources`] [W/m2].
    pub(crate) irradiances: Vec<S>,
    /// The part of each that comes from the sun's disc, zero where the irradiance is measured [W/m2]; empty where nobody reads it.
    pub(crate) beams: Vec<S>,
    /// Direction of the sun (east, north, up).
    pub(crate) direction: [f64; 3],
    /// Whether no sun is on any window.
    dark: bool,
    /// Per window, in the order of [`Plan::windows`](crate::building::plan::Plan::windows).
    pub windows: Vec<WindowConditions<S>>,
    /// Per zone.
    pub zones: Vec<ZoneSolar<S>>,
    /// Per zone: power of first incidence on each of its surfaces, where beams are traced [W].
    incidence: Vec<Vec<S>>,
    /// Per passage between zones: power that passes [W].
    passing: Vec<S>,
    /// Per zone, where there are such passages: diffuse sun that enters from other zones [W].
    entering: Vec<S>,
    /// Per zone, where there are such passages: what enters from other zones less what leaves to them [W].
    pub(crate) exchanged: Vec<S>,
    /// Per zone, where some give a part of the sun, or of what blinds absorb, to their air: that part [W].
    pub(crate) to_air: Vec<S>,
}

impl<S: Real> SolarConditions<S> {
    /// Zeros for a building.
    pub(crate) fn new(plan: &Plan, weather_index: &WeatherIndex<S>) -> Self {
        let zero = S::zero();
        let windows = plan.windows.iter().map(|&w| WindowConditions {
            transmitted: zero,
            beam: zero,
            covered: zero,
            panes: vec![zero; plan.walls[w].glass.as_ref().map_or(0, |glass| glass.sites.len())],
            cells: vec![zero; plan.walls[w].len()],
        });
        Self {
            irradiances: vec![zero; weather_index.irradiance_sources.len()],
            beams: Vec::new(),
            direction: [0.0; 3],
            dark: true,
            windows: windows.collect(),
            zones: vec![ZoneSolar { transmitted: zero, lost: zero, in_glass: zero }; plan.zones.len()],
            incidence: plan.zones.iter().map(|zone| vec![zero; zone.surfaces.len()]).collect(),
            passing: vec![zero; plan.passages.len()],
            entering: vec![zero; if plan.passages.is_empty() { 0 } else { plan.zones.len() }],
            exchanged: vec![zero; if plan.passages.is_empty() { 0 } else { plan.zones.len() }],
            to_air: vec![zero; if to_air(plan) { plan.zones.len() } else { 0 }],
        }
    }

    /// Linear interpolation or extrapolation: `fraction` 0 at the first, 1 at the second.
    pub(crate) fn interpolate(&mut self, first: &Self, second: &Self, fraction: S) {
        let line = |a: S, b: S| a + (b - a) * fraction;
        for (at, (&a, &b)) in
            self.irradiances.iter_mut().zip(first.irradiances.iter().zip(&second.irradiances))
        {
            *at = line(a, b);
        }
        for (at, (&a, &b)) in self.beams.iter_mut().zip(first.beams.iter().zip(&second.beams)) {
            *at = line(a, b);
        }
        self.direction = second.direction;
        for (at, (a, b)) in self.windows.iter_mut().zip(first.windows.iter().zip(&second.windows)) {
            at.transmitted = line(a.transmitted, b.transmitted);
            at.beam = line(a.beam, b.beam);
            at.covered = line(a.covered, b.covered).max(S::zero()).min(S::one());
            let sets = [(&mut at.panes, &a.panes, &b.panes), (&mut at.cells, &a.cells, &b.cells)];
            for (set, one, other) in sets {
                for (heat, (&a, &b)) in set.iter_mut().zip(one.iter().zip(other)) {
                    *heat = line(a, b);
                }
            }
        }
        for (at, (a, b)) in self.zones.iter_mut().zip(first.zones.iter().zip(&second.zones)) {
            at.transmitted = line(a.transmitted, b.transmitted);
            at.lost = line(a.lost, b.lost);
            at.in_glass = line(a.in_glass, b.in_glass);
        }
        for (at, (&a, &b)) in self.exchanged.iter_mut().zip(first.exchanged.iter().zip(&second.exchanged)) {
            *at = line(a, b);
        }
        for (at, (&a, &b)) in self.to_air.iter_mut().zip(first.to_air.iter().zip(&second.to_air)) {
            *at = line(a, b);
        }
    }

    /// The irradiance of all planes.
    #[inline(always)]
    pub(crate) fn irradiate(
        &mut self,
        plan: &Plan,
        coefficients: &Coefficients<S>,
        weather_index: &WeatherIndex<S>,
        now: &Instant<'_>,
    ) {
        let dark = now.sunlight.dark();
        self.direction = now.sunlight.direction;
        if !self.beams.is_empty() {
            self.light_beams(plan, coefficients, weather_index, now);
        }
        for (irradiance, source) in self.irradiances.iter_mut().zip(&weather_index.irradiance_sources) {
            *irradiance = match source {
                IrradianceSource::Measured(channel) => S::constant(now.on_sensor(*channel)),
                IrradianceSource::Obstructed(channel, surface) => {
                    let Boundary::Outdoors(outdoors) = &coefficients.surfaces[*surface].boundary else {
                        continue;
                    };
                    let given = (coefficients.ground_reflectance, *channel);
                    now.measured(plan, *surface, outdoors, given).total()
                }
                _ if dark => S::zero(),
                IrradianceSource::Uniform(plane, ground, surface) => {
                    S::constant(now.sunlight.on(plane, *ground, &now.visibility(plan, *surface)).total())
                }
                IrradianceSource::Varied(plane, surface) => now
                    .sunlight
                    .on(plane, coefficients.ground_reflectance, &now.visibility(plan, *surface))
                    .total(),
            };
        }
    }

    /// What windows transmit, and what their panes absorb of the sun from outside.
    #[inline(always)]
    pub(crate) fn transmit(&mut self, plan: &Plan, coefficients: &Coefficients<S>, now: &Instant<'_>) {
        for zone in &mut self.zones {
            zone.transmitted = S::zero();
        }
        self.dark = now.sunlight.dark();
        for (at, &w) in self.windows.iter_mut().zip(&plan.windows) {
            let wall = &coefficients.walls[w];
            at.transmitted = S::zero();
            at.beam = S::zero();
            at.panes.fill(S::zero());
            let (Some(glass), Boundary::Outdoors(outdoors)) =
                (&wall.glass, &coefficients.surfaces[SideId::outside(w)].boundary)
            else {
                continue;
            };
            let (outside, ground) = (SideId::outside(w), coefficients.ground_reflectance);
            let light = match coefficients.surfaces[outside].irradiance {
                // Without sun in the climate it is the offset of a sensor by night, and by day diffuse.
                Some(channel) if now.row[channel] > 0.0 && !(now.sunlight.dark() && now.sunlight.night()) => {
                    self.dark = false;
                    now.measured(plan, outside, outdoors, (ground, channel))
                }
                None if !now.sunlight.dark() => {
                    now.sunlight.on(&outdoors.plane, ground, &now.visibility(plan, outside))
                }
                _ => {
                    at.covered = covered(glass, now, S::zero());
                    continue;
                }
            };
            let (front, level) = (&glass.optics.front, &glass.horizon);
            let (directed, mut scattered, mut horizon) = (light.directed(), light.scattered(), light.horizon);
            if horizon.lt(S::zero()).any() {
                (scattered, horizon) = front.with_dark_horizon(level, scattered, horizon);
            }
            let (panes, of_blind) = match &plan.walls[w].glass {
                Some(layout) => layout.split(&mut at.panes),
                None => (&mut at.panes[..], None),
            };
            let through = glass.optics.beam.split(light.cosine, panes);
            let diffuse = front.absorptance.iter().zip(&level.absorptance);
            for (pane, (&everywhere, &level)) in panes.iter_mut().zip(diffuse) {
                *pane = *pane * directed + everywhere * scattered + level * horizon;
            }
            let spread = front.transmittance * scattered + level.transmittance * horizon;
            if let (Some((_, blind)), Some(own)) = (&glass.blind, of_blind) {
                let beam = through * directed;
                let mut sun = [beam, beam + spread];
                at.covered = blind.covers(now.row, light.total());
                blind.cover(at.covered, light.total(), [front, &glass.optics.back], &mut sun, (panes, own));
                (at.beam, at.transmitted) = (wall.area * sun[0], wall.area * sun[1]);
            } else {
                at.beam = wall.area * through * directed;
                at.transmitted = at.beam + wall.area * spread;
            }
            if let SideRole::Zone { zone, .. } = plan.surfaces[SideId::inside(w)].role {
                self.zones[zone].transmitted += at.transmitted;
            }
        }
    }

    /// What the airs of zones get at once of what windows transmit.
    // A rare part of a building: kept out of the code of the others.
    #[inline(never)]
    pub(crate) fn give_to_air(&mut self, coefficients: &Coefficients<S>) {
        for ((heat, zone), numbers) in self.to_air.iter_mut().zip(&self.zones).zip(&coefficients.zones) {
            *heat = numbers.solar_to_air.map_or_else(S::zero, |part| part * zone.transmitted);
        }
    }

    /// First incidence of what windows transmit, in zones where beams are traced.
    #[inline(always)]
    pub(crate) fn trace(&mut self, plan: &Plan, coefficients: &Coefficients<S>, now: &Instant<'_>) {
        if self.dark {
            return;
        }
        for (z, numbers) in coefficients.zones.iter().enumerate() {
            if let Some(SolarDistribution::Traced(traced)) = &numbers.solar_distribution {
                self.trace_beams(plan, z, traced, now);
            }
        }
    }

    /// What windows between zones let pass, back and forth.
    // A rare part of a building: kept out of the code of the others.
    #[inline(never)]
    pub(crate) fn pass(&mut self, plan: &Plan, coefficients: &Coefficients<S>) {
        for powers in [&mut self.passing, &mut self.entering, &mut self.exchanged] {
            powers.fill(S::zero());
        }
        if self.dark {
            return;
        }
        let on = |(z, i): (usize, usize)| {
            let distribution = coefficients.zones[z].solar_distribution.as_ref();
            distribution.map_or_else(S::zero, |law| self.on_glass(law, z, &plan.zones[z], i))
        };
        let passing = &coefficients.passing;
        let first: Vec<S> = plan
            .passages
            .iter()
            .zip(&passing.areas)
            .map(|(passage, &area)| area * on(passage.from))
            .collect();
        for ((power, row), passage) in
            self.passing.iter_mut().zip(passing.multiples.chunks_exact(first.len())).zip(&plan.passages)
        {
            *power = row.iter().zip(&first).fold(S::zero(), |sum, (&multiple, &one)| sum + multiple * one);
            let (from, (to, entrance)) = (passage.from.0, passage.to);
            self.entering[to] += *power;
            self.exchanged[to] += *power;
            self.exchanged[from] += -*power;
            self.windows[passage.window].transmitted += if passage.inwards { *power } else { -*power };
            if let Some(SolarDistribution::Traced(traced)) = &coefficients.zones[to].solar_distribution {
                let n = traced.size();
                for (on, &view) in self.incidence[to].iter_mut().zip(&traced.views[entrance * n..]) {
                    *on += *power * view;
                }
            }
        }
    }

    /// Irradiance of the glass at a place among the surfaces of a zone [W/m2].
    #[inline(always)]
    fn on_glass(&self, distribution: &SolarDistribution<S>, z: usize, zone: &ZonePlan, i: usize) -> S {
        match distribution {
            SolarDistribution::Fixed(fixed) => fixed.on_glass[i] * self.reaching(z),
            SolarDistribution::Split([beam, diffuse]) => {
                let [direct, scattered] = self.parts(z, zone);
                beam.on_glass[i] * direct + diffuse.on_glass[i] * scattered
            }
            SolarDistribution::Traced(traced) => traced.irradiance(i, &self.incidence[z]),
        }
    }

    /// Sun that enters a zone from outdoors and from other zones [W].
    #[inline(always)]
    fn reaching(&self, z: usize) -> S {
        let outdoors = match self.to_air.get(z) {
            Some(&to_air) => self.zones[z].transmitted - to_air,
            None => self.zones[z].transmitted,
        };
        self.entering.get(z).map_or(outdoors, |&entering| outdoors + entering)
    }

    /// Distributes what windows transmit over the surfaces of the zones and the insides of the panes.
    #[inline(always)]
    pub(crate) fn distribute(
        &mut self,
        plan: &Plan,
        coefficients: &Coefficients<S>,
        surfaces: &mut BySide<SurfaceConditions<S>>,
    ) {
        for (z, (zone, numbers)) in plan.zones.iter().zip(&coefficients.zones).enumerate() {
            let Some(distribution) = &numbers.solar_distribution else { continue };
            if self.dark {
                (self.zones[z].lost, self.zones[z].in_glass) = (S::zero(), S::zero());
                for &surface in &zone.surfaces {
                    surfaces[surface].solar = S::zero();
                }
                continue;
            }
            match distribution {
                SolarDistribution::Fixed(fixed) => self.distribute_fixed(z, zone, fixed, surfaces),
                SolarDistribution::Split(split) => self.distribute_split(z, zone, split, surfaces),
                SolarDistribution::Traced(traced) => {
                    self.distribute_traced(plan, z, traced, coefficients, surfaces);
                }
            }
            for &(window, i) in &zone.windows {
                let Some(glass) = &coefficients.walls[plan.windows[window]].glass else { continue };
                let on = self.on_glass(distribution, z, zone, i);
                let panes = &mut self.windows[window].panes;
                let (panes, _) = match &plan.walls[plan.windows[window]].glass {
                    Some(layout) => layout.split(panes),
                    None => (&mut panes[..], None),
                };
                for (pane, &absorptance) in panes.iter_mut().zip(&glass.facing(zone.surfaces[i]).absorptance)
                {
                    *pane += absorptance * on;
                }
            }
        }
    }

    /// Distributes the sun in a zone by fractions.
    #[inline(always)]
    fn distribute_fixed(
        &mut self,
        z: usize,
        zone: &ZonePlan,
        fixed: &FixedDistribution<S>,
        surfaces: &mut BySide<SurfaceConditions<S>>,
    ) {
        let transmitted = self.reaching(z);
        self.zones[z].lost = fixed.lost * transmitted;
        self.zones[z].in_glass = fixed.in_glass * transmitted;
        for (i, &surface) in zone.surfaces.iter().enumerate() {
            surfaces[surface].solar = fixed.absorbed[i] * transmitted;
        }
    }

    /// Distributes beam and diffuse sun in a zone by fractions of their own.
    // A rare law: kept out of the code of the others.
    #[inline(never)]
    fn distribute_split(
        &mut self,
        z: usize,
        zone: &ZonePlan,
        [beam, diffuse]: &[FixedDistribution<S>; 2],
        surfaces: &mut BySide<SurfaceConditions<S>>,
    ) {
        let [direct, scattered] = self.parts(z, zone);
        self.zones[z].lost = beam.lost * direct + diffuse.lost * scattered;
        self.zones[z].in_glass = beam.in_glass * direct + diffuse.in_glass * scattered;
        for (i, &surface) in zone.surfaces.iter().enumerate() {
            surfaces[surface].solar = beam.absorbed[i] * direct + diffuse.absorbed[i] * scattered;
        }
    }

    /// Beam and diffuse sun that enter a zone [W].
    fn parts(&self, z: usize, zone: &ZonePlan) -> [S; 2] {
        let beams = zone.windows.iter().map(|&(window, _)| self.windows[window].beam);
        let mut direct = beams.fold(S::zero(), |sum, beam| sum + beam);
        if let Some(&to_air) = self.to_air.get(z) {
            // The air gets as much of the beam as of the rest.
            direct = direct * (S::one() - part(to_air, self.zones[z].transmitted));
        }
        [direct, self.reaching(z) - direct]
    }

    /// The power of first incidence on each surface of a zone.
    #[inline(always)]
    fn trace_beams(&mut self, plan: &Plan, z: usize, traced: &TracedDistribution<S>, now: &Instant<'_>) {
        let incidence = &mut self.incidence[z];
        let n = incidence.len();
        incidence.fill(S::zero());
        for &(window, i) in &plan.zones[z].windows {
            let at = &self.windows[window];
            let fractions = plan.solar_geometry.beam_fractions(window, &now.fractions);
            // All fractions of a window in full shade are zero: what it transmits is diffuse.
            let fractions = fractions.filter(|fractions| fractions.iter().sum::<f64>() > 0.0);
            let beam = if fractions.is_some() { at.beam } else { S::zero() };
            let rest = at.transmitted - beam;
            for (j, power) in incidence.iter_mut().enumerate() {
                *power += rest * traced.views[i * n + j];
                if let Some(fractions) = fractions {
                    *power += beam.scale(fractions[j]);
                }
            }
        }
        if let Some(&to_air) = self.to_air.get(z) {
            let kept = S::one() - part(to_air, self.zones[z].transmitted);
            for power in incidence {
                *power = *power * kept;
            }
        }
    }

    /// Distributes the sun in a zone by reflections after the first incidence.
    #[inline(always)]
    fn distribute_traced(
        &mut self,
        plan: &Plan,
        z: usize,
        traced: &TracedDistribution<S>,
        coefficients: &Coefficients<S>,
        surfaces: &mut BySide<SurfaceConditions<S>>,
    ) {
        let (mut lost, mut in_glass) = (S::zero(), S::zero());
        for (i, &surface) in plan.zones[z].surfaces.iter().enumerate() {
            let on = traced.irradiance(i, &self.incidence[z]);
            surfaces[surface].solar = coefficients.surfaces[surface].absorptance * on;
            if let Some(glass) = &coefficients.walls[surface.wall()].glass {
                let (power, back) = (coefficients.zones[z].areas[i] * on, glass.facing(surface));
                if !plan.lets_pass(surface) {
                    lost += power * back.transmittance;
                }
                in_glass += power * (back.admitted() - back.transmittance);
            }
        }
        (self.zones[z].lost, self.zones[z].in_glass) = (lost, in_glass);
    }
}

/// Whether the air of a zone gets a part of the sun, or of what a blind absorbs.
fn to_air(plan: &Plan) -> bool {
    let mut blinds =
        plan.description.constructions.iter().filter_map(|construction| construction.blind.as_ref());
    plan.description.zones.iter().any(|zone| zone.solar_to_air.is_some())
        || blinds.any(|blind| blind.to_air.is_some())
}

/// Part of a window that its blind covers; none without a blind.
fn covered<S: Real>(glass: &Glass<S>, now: &Instant<'_>, irradiance: S) -> S {
    glass.blind.as_ref().map_or_else(S::zero, |(_, blind)| blind.covers(now.row, irradiance))
}

/// A part over the whole, which may be zero.
fn part<S: Real>(some: S, all: S) -> S {
    some / all.max(S::constant(f64::MIN_POSITIVE))
}
