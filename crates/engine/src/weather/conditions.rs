//! What acts on the building at one instant: forcing turned into numbers at each surface.

use std::borrow::Cow;

use crate::building::coefficients::{Boundary, Coefficients, Imposed, PER_DAY};
use crate::building::glazing::{Node, Site};
use crate::building::ids::{BySurface, SurfaceId};
use crate::building::plan::{Plan, SurfaceRole};
use crate::building::sun_distribution::Traced;
use crate::input::description::Facing;
use crate::input::forcing::{Forcing, channel};
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::convection::{Forced, SurfaceConvection, Wind, WindTerms};
use crate::physics::longwave::{SkyState, sky_emission};
use crate::physics::solar::{SkyVisibility, Sunlight};
use crate::weather::index::{Sun, WeatherIndex};
use crate::weather::zone_conditions::ZoneConditions;

/// A surface is leeward when the cosine between its normal and the direction that the wind comes from is below this. A wind along
/// the surface counts as windward: its cosine is zero but for round-off, so the limit lies 6e-8 deg behind the surface. (Walton
/// 1983 takes 100 deg off the normal as the limit; the windward coefficient has no basis beyond 90 deg.)
const LEEWARD_COSINE: f64 = -1e-9;
/// Surfaces within about 11 deg of horizontal are always windward (Walton 1983).
const FLAT: f64 = 0.98;

/// The weather at one stage, worked out as far as it is the same for all members.
#[derive(Debug, Clone)]
pub struct Instant<'a> {
    /// All channels.
    pub row: &'a [f64],
    sunlight: Sunlight,
    sky_state: SkyState,
    wind: Wind,
    /// North and east components of the direction the wind comes from, where films ask for it.
    wind_from: [f64; 2],
    /// Cosine and sine of the angle of the day in the year, where the ground asks for it.
    season: [f64; 2],
    /// Sun and shade, see [`SolarGeometry`](crate::building::solar_geometry::SolarGeometry).
    geometry: Box<[f64]>,
}

impl<'a> Instant<'a> {
    /// Reads a forcing row.
    #[must_use]
    pub fn new(plan: &Plan, row: &'a [f64], terms: WindTerms, ground: bool) -> Self {
        let turn =
            |angle: f64, needed: bool| if needed { [Real::cos(angle), Real::sin(angle)] } else { [0.0; 2] };
        let sunlight = Sunlight::new(row, plan.description.site.diffuse);
        Self {
            row,
            geometry: plan.solar_geometry.at(&sunlight),
            sunlight,
            sky_state: SkyState::new(&plan.description.site.sky, row),
            wind: Wind::new(row[channel::WIND_SPEED], terms),
            wind_from: turn(row[channel::WIND_DIRECTION].to_radians(), terms.direction),
            season: turn(row[channel::DAY_OF_YEAR] * PER_DAY, ground),
        }
    }
}

impl Instant<'_> {
    /// What shades leave a surface of sun and sky: they stand outside.
    fn open(&self, plan: &Plan, surface: SurfaceId) -> SkyVisibility {
        if surface.is_outside() {
            plan.solar_geometry.open(surface.wall(), &self.geometry)
        } else {
            SkyVisibility::FULL
        }
    }
}

/// The weather of all stages of a run.
#[derive(Debug)]
pub struct Weather<'a> {
    plan: &'a Plan,
    forcing: Forcing<'a>,
    terms: WindTerms,
    /// Whether the ground asks for the season.
    ground: bool,
    /// Empty where it is worked out when it is asked for.
    kept: Vec<Instant<'a>>,
}

impl<'a> Weather<'a> {
    /// Reads a forcing for many runs.
    #[must_use]
    pub fn new(plan: &'a Plan, forcing: &Forcing<'a>) -> Self {
        let mut weather = Self::passing(plan, forcing);
        let stages = forcing.stages();
        weather.kept =
            (0..forcing.steps() * stages).map(|k| weather.reckon(k / stages, k % stages)).collect();
        weather
    }

    /// Reads a forcing for one run: what is looked at once need not be kept.
    #[must_use]
    pub fn once(plan: &'a Plan, forcing: &Forcing<'a>) -> Self {
        // Where the sun is followed, what it meets is not to be found twice when days are repeated.
        if plan.solar_geometry.is_empty() { Self::passing(plan, forcing) } else { Self::new(plan, forcing) }
    }

    fn passing(plan: &'a Plan, forcing: &Forcing<'a>) -> Self {
        let sides = || plan.surfaces.ids().map(|surface| plan.side(surface));
        let terms = WindTerms::of(sides().filter_map(|side| side.convection.as_ref()));
        let ground = sides().any(|side| matches!(side.facing, Facing::Ground { .. }));
        Self { plan, forcing: *forcing, terms, ground, kept: Vec::new() }
    }

    fn reckon(&self, step: usize, stage: usize) -> Instant<'a> {
        Instant::new(self.plan, self.forcing.at(step, stage), self.terms, self.ground)
    }

    /// Number of steps.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.forcing.steps()
    }

    /// All channels at a stage of a step.
    #[must_use]
    pub fn row(&self, step: usize, stage: usize) -> &'a [f64] {
        self.forcing.at(step, stage)
    }

    /// The weather at a stage of a step.
    #[must_use]
    pub fn at(&self, step: usize, stage: usize) -> Cow<'_, Instant<'a>> {
        match self.kept.get(step * self.forcing.stages() + stage) {
            Some(kept) => Cow::Borrowed(kept),
            None => Cow::Owned(self.reckon(step, stage)),
        }
    }
}

/// Numbers at a surface.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceConditions<S: Real> {
    /// Absorbed short-wave radiation [W/m2].
    pub solar: S,
    /// Long-wave radiation absorbed from sky, air and ground [W/m2].
    pub longwave: S,
    /// Temperature of the air, or the imposed temperature [degC].
    pub temperature: S,
    /// What the wind makes of the film.
    pub forced: Forced<S>,
}

/// The sun at a window.
#[derive(Debug, Clone)]
pub struct WindowConditions<S> {
    /// Let into its zone [W].
    pub transmitted: S,
    /// The part of it that comes from the sun's direction [W].
    pub directed: S,
    /// Absorbed in each pane, from both sides [W/m2].
    pub panes: Vec<S>,
    /// What of it acts in each cell [W/m2].
    pub cells: Vec<S>,
}

/// The sun in a zone [W].
#[derive(Debug, Clone, Copy)]
pub struct ZoneLight<S> {
    /// Let in by its windows.
    pub transmitted: S,
    /// Leaves by them again.
    pub lost: S,
    /// Absorbed by their glass on the way.
    pub in_glass: S,
}

/// Numbers at all surfaces and outdoors.
#[derive(Debug, Clone)]
pub struct Conditions<S: Real> {
    /// Per surface.
    pub surfaces: BySurface<SurfaceConditions<S>>,
    /// Per zone.
    pub zones: Vec<ZoneConditions<S>>,
    /// Heat carried between two zones, per path [W/K].
    pub paths: Vec<S>,
    /// Outdoor air [degC].
    pub outdoor_air: S,
    /// Wind at the mast [m/s].
    pub wind: S,
    /// Emission of the sky on a horizontal plane [W/m2].
    pub sky: S,
    /// Per window, in the order of [`Plan::windows`](crate::building::plan::Plan::windows).
    pub windows: Vec<WindowConditions<S>>,
    /// The sun in each zone.
    pub light: Vec<ZoneLight<S>>,
    /// Irradiance by each of [`WeatherIndex::suns`] [W/m2].
    suns: Vec<S>,
    /// Emission of the outdoor air by each of [`WeatherIndex::emissions`] [W/m2].
    from_air: Vec<S>,
    /// Power that lands first on each surface of each zone [W].
    first: Vec<Vec<S>>,
}

impl<S: Real> Conditions<S> {
    /// A place for the numbers of a building, in still air.
    #[must_use]
    pub(crate) fn new(plan: &Plan, coefficients: &Coefficients<S>, weather_index: &WeatherIndex<S>) -> Self {
        let zero = S::zero();
        let surfaces = coefficients.surfaces.iter().map(|surface| {
            let forced = surface.convection.as_ref().map_or([zero; 2], SurfaceConvection::calm);
            SurfaceConditions { solar: zero, longwave: zero, temperature: zero, forced }
        });
        let windows = plan.windows.iter().map(|&w| WindowConditions {
            transmitted: zero,
            directed: zero,
            panes: vec![zero; plan.walls[w].glass.as_ref().map_or(0, |glass| glass.sites.len())],
            cells: vec![zero; plan.walls[w].len()],
        });
        Self {
            surfaces: surfaces.collect(),
            zones: coefficients.zones.iter().map(ZoneConditions::new).collect(),
            paths: vec![zero; coefficients.paths.len()],
            outdoor_air: zero,
            wind: zero,
            sky: zero,
            windows: windows.collect(),
            light: vec![ZoneLight { transmitted: zero, lost: zero, in_glass: zero }; plan.zones.len()],
            suns: vec![zero; weather_index.suns.len()],
            from_air: vec![zero; weather_index.emissions.len()],
            first: plan.zones.iter().map(|zone| vec![zero; zone.surfaces.len()]).collect(),
        }
    }

    /// Numbers on the straight line through those of two moments, at a share of the way from the first to the second.
    ///
    /// What is no energy but a rate (films, wind) does not fall below zero beyond them.
    pub fn between(&mut self, first: &Self, second: &Self, share: f64) {
        let line = |a: S, b: S| a + (b - a).scale(share);
        let rate = |a: S, b: S| line(a, b).max(S::zero());
        for (at, (a, b)) in self.surfaces.iter_mut().zip(first.surfaces.iter().zip(&second.surfaces)) {
            at.solar = line(a.solar, b.solar);
            at.longwave = line(a.longwave, b.longwave);
            at.temperature = line(a.temperature, b.temperature);
            at.forced = [rate(a.forced[0], b.forced[0]), rate(a.forced[1], b.forced[1])];
        }
        for (at, (&a, &b)) in self.suns.iter_mut().zip(first.suns.iter().zip(&second.suns)) {
            *at = line(a, b);
        }
        for (at, (a, b)) in self.zones.iter_mut().zip(first.zones.iter().zip(&second.zones)) {
            at.between(a, b, share);
        }
        for (at, (&a, &b)) in self.paths.iter_mut().zip(first.paths.iter().zip(&second.paths)) {
            *at = rate(a, b);
        }
        for (at, (a, b)) in self.windows.iter_mut().zip(first.windows.iter().zip(&second.windows)) {
            at.transmitted = line(a.transmitted, b.transmitted);
            at.directed = line(a.directed, b.directed);
            let sets = [(&mut at.panes, &a.panes, &b.panes), (&mut at.cells, &a.cells, &b.cells)];
            for (set, one, other) in sets {
                for (heat, (&a, &b)) in set.iter_mut().zip(one.iter().zip(other)) {
                    *heat = line(a, b);
                }
            }
        }
        for (at, (a, b)) in self.light.iter_mut().zip(first.light.iter().zip(&second.light)) {
            at.transmitted = line(a.transmitted, b.transmitted);
            at.lost = line(a.lost, b.lost);
            at.in_glass = line(a.in_glass, b.in_glass);
        }
        self.sky = line(first.sky, second.sky);
        self.outdoor_air = line(first.outdoor_air, second.outdoor_air);
        self.wind = rate(first.wind, second.wind);
    }

    /// Turns the weather into numbers at each surface.
    // Not inlined, for the compiler's sake: it is large and asked for in several places.
    #[inline(never)]
    pub(crate) fn update(
        &mut self,
        plan: &Plan,
        coefficients: &Coefficients<S>,
        weather_index: &WeatherIndex<S>,
        numbers: &[S],
        now: &Instant<'_>,
    ) {
        S::vectorised(
            #[inline(always)]
            || self.read(plan, coefficients, weather_index, numbers, now),
        );
    }

    #[inline(always)]
    fn read(
        &mut self,
        plan: &Plan,
        coefficients: &Coefficients<S>,
        weather_index: &WeatherIndex<S>,
        numbers: &[S],
        now: &Instant<'_>,
    ) {
        let site = &plan.description.site;
        let air = S::constant(now.row[channel::AIR_TEMPERATURE]);
        let sky = sky_emission(&Values::new(numbers), &site.sky, coefficients.cloud, &now.sky_state);
        (self.sky, self.outdoor_air) = (sky, air);
        self.wind = S::constant(now.wind.speed);
        self.shine(plan, coefficients, weather_index, now);
        for (emission, law) in self.from_air.iter_mut().zip(&weather_index.emissions) {
            *emission = law.at(air).0;
        }
        for outside in &weather_index.outdoors {
            let at = &mut self.surfaces[outside.surface];
            at.temperature = air;
            if let Some(sun) = outside.sun {
                at.solar = outside.absorptance * self.suns[sun];
            }
            if let Some(emission) = outside.emission {
                at.longwave = outside.of_air * self.from_air[emission] + outside.of_sky * sky;
            }
        }
        for &index in &weather_index.windy {
            self.surfaces[index].forced = forced(coefficients, index, now);
        }
        for &(index, sun, absorptance) in &weather_index.lit {
            self.surfaces[index].solar = absorptance * self.suns[sun];
        }
        for &index in &weather_index.imposed {
            if let Boundary::Imposed(imposed) = &coefficients.surfaces[index].boundary {
                self.surfaces[index].temperature = imposed_temperature(imposed, now);
            }
        }
        for (at, zone) in self.zones.iter_mut().zip(&coefficients.zones) {
            at.update(zone, now.row);
        }
        for (at, path) in self.paths.iter_mut().zip(&coefficients.paths) {
            *at = path.conductance(now.row);
        }
        if !self.windows.is_empty() {
            self.let_in(plan, coefficients, now);
            self.land(plan, coefficients, now);
            self.settle_panes(plan);
        }
    }

    /// The sun on all planes.
    #[inline(always)]
    fn shine(
        &mut self,
        plan: &Plan,
        coefficients: &Coefficients<S>,
        weather_index: &WeatherIndex<S>,
        now: &Instant<'_>,
    ) {
        let dark = now.sunlight.dark();
        for (irradiance, sun) in self.suns.iter_mut().zip(&weather_index.suns) {
            *irradiance = match sun {
                Sun::Measured(channel) => S::constant(now.row[*channel]),
                _ if dark => S::zero(),
                Sun::Even(plane, ground, surface) => {
                    S::constant(now.sunlight.on(plane, *ground, &now.open(plan, *surface)).total())
                }
                Sun::Varied(plane, surface) => {
                    now.sunlight.on(plane, coefficients.ground_reflectance, &now.open(plan, *surface)).total()
                }
            };
        }
    }

    /// What windows transmit and their panes absorb on the way in.
    #[inline(always)]
    fn let_in(&mut self, plan: &Plan, coefficients: &Coefficients<S>, now: &Instant<'_>) {
        for zone in &mut self.light {
            zone.transmitted = S::zero();
        }
        for (at, &w) in self.windows.iter_mut().zip(&plan.windows) {
            let wall = &coefficients.walls[w];
            at.transmitted = S::zero();
            at.directed = S::zero();
            at.panes.fill(S::zero());
            let (Some(glass), Boundary::Outdoors(outdoors)) =
                (&wall.glass, &coefficients.surfaces[SurfaceId::outside(w)].boundary)
            else {
                continue;
            };
            if now.sunlight.dark() {
                continue;
            }
            let open = now.open(plan, SurfaceId::outside(w));
            let light = now.sunlight.on(&outdoors.plane, coefficients.ground_reflectance, &open);
            let (directed, scattered) = (light.directed(), light.scattered());
            let (front, level) = (&glass.optics.front, &glass.horizon);
            let through = glass.optics.beam.split(light.cosine, &mut at.panes);
            let diffuse = front.absorptance.iter().zip(&level.absorptance);
            for (pane, (&everywhere, &level)) in at.panes.iter_mut().zip(diffuse) {
                *pane = *pane * directed + everywhere * scattered + level * light.horizon;
            }
            at.directed = wall.area * through * directed;
            let spread = front.transmittance * scattered + level.transmittance * light.horizon;
            at.transmitted = at.directed + wall.area * spread;
            if let SurfaceRole::Zone { zone, .. } = plan.surfaces[SurfaceId::inside(w)].role {
                self.light[zone].transmitted += at.transmitted;
            }
        }
    }

    /// Brings what has been let in onto the surfaces of the zones.
    #[inline(always)]
    fn land(&mut self, plan: &Plan, coefficients: &Coefficients<S>, now: &Instant<'_>) {
        for (z, (zone, numbers)) in plan.zones.iter().zip(&coefficients.zones).enumerate() {
            let Some(landing) = &numbers.landing else { continue };
            if now.sunlight.dark() {
                (self.light[z].lost, self.light[z].in_glass) = (S::zero(), S::zero());
                for &surface in &zone.surfaces {
                    self.surfaces[surface].solar = S::zero();
                }
                continue;
            }
            let entered = self.light[z].transmitted;
            if let Some(traced) = &landing.traced {
                self.follow(plan, z, traced, now);
                let (mut lost, mut in_glass) = (S::zero(), S::zero());
                for (i, &surface) in zone.surfaces.iter().enumerate() {
                    let on = traced.irradiance(i, &self.first[z]);
                    self.surfaces[surface].solar = coefficients.surfaces[surface].absorptance * on;
                    if let Some(glass) = &coefficients.walls[surface.wall()].glass {
                        let (power, back) = (numbers.areas[i] * on, &glass.optics.back);
                        lost += power * back.transmittance;
                        in_glass += power * (back.admitted() - back.transmittance);
                    }
                }
                (self.light[z].lost, self.light[z].in_glass) = (lost, in_glass);
            } else {
                self.light[z].lost = landing.lost * entered;
                self.light[z].in_glass = landing.in_glass * entered;
                for (i, &surface) in zone.surfaces.iter().enumerate() {
                    self.surfaces[surface].solar = landing.absorbed[i] * entered;
                }
            }
            for &(window, i) in &zone.windows {
                let Some(glass) = &coefficients.walls[plan.windows[window]].glass else { continue };
                let on = match &landing.traced {
                    Some(traced) => traced.irradiance(i, &self.first[z]),
                    None => landing.on_glass[i] * entered,
                };
                let panes = &mut self.windows[window].panes;
                for (pane, &absorptance) in panes.iter_mut().zip(&glass.optics.back.absorptance) {
                    *pane += absorptance * on;
                }
            }
        }
    }

    /// Where the sun that enters a zone lands first.
    #[inline(always)]
    fn follow(&mut self, plan: &Plan, z: usize, traced: &Traced<S>, now: &Instant<'_>) {
        let first = &mut self.first[z];
        let n = first.len();
        first.fill(S::zero());
        for &(window, i) in &plan.zones[z].windows {
            let at = &self.windows[window];
            let patches = plan.solar_geometry.beam_fractions(window, &now.geometry);
            // A window in full shade has no beam to follow.
            let patches = patches.filter(|shares| shares.iter().sum::<f64>() > 0.0);
            let beam = if patches.is_some() { at.directed } else { S::zero() };
            let rest = at.transmitted - beam;
            for (j, power) in first.iter_mut().enumerate() {
                *power += rest * traced.views[i * n + j];
                if let Some(shares) = patches {
                    *power += beam.scale(shares[j]);
                }
            }
        }
    }

    /// Hands the heat of the panes to the cells and surfaces where it acts.
    #[inline(always)]
    fn settle_panes(&mut self, plan: &Plan) {
        for (at, &w) in self.windows.iter_mut().zip(&plan.windows) {
            let Some(glass) = &plan.walls[w].glass else { continue };
            let mut surfaces = [S::zero(); 2];
            at.cells.fill(S::zero());
            for (site, &heat) in glass.sites.iter().zip(&at.panes) {
                match site {
                    Site::Middle(cell) => at.cells[*cell] += heat,
                    Site::Surfaces(nodes) => {
                        for node in nodes {
                            match node {
                                Node::Outside => surfaces[0] += heat.scale(0.5),
                                Node::Cell(cell) => at.cells[*cell] += heat.scale(0.5),
                                Node::Inside => surfaces[1] += heat.scale(0.5),
                            }
                        }
                    }
                }
            }
            self.surfaces[SurfaceId::outside(w)].solar = surfaces[0];
            self.surfaces[SurfaceId::inside(w)].solar += surfaces[1];
        }
    }
}

/// The sun over a step: means of its stages.
#[derive(Debug, Clone)]
pub struct SunMeans<S> {
    /// By each of [`WeatherIndex::suns`] [W/m2].
    pub(crate) suns: Vec<S>,
    /// Let in by each window [W].
    pub windows: Vec<S>,
    /// Let into each zone [W].
    pub zones: Vec<S>,
    /// Lost by each zone [W].
    pub lost: Vec<S>,
}

impl<S: Real> SunMeans<S> {
    /// A place for the means of a building.
    #[must_use]
    pub fn new(conditions: &Conditions<S>) -> Self {
        let zeros = |count: usize| vec![S::zero(); count];
        Self {
            suns: zeros(conditions.suns.len()),
            windows: zeros(conditions.windows.len()),
            zones: zeros(conditions.light.len()),
            lost: zeros(conditions.light.len()),
        }
    }

    /// Forgets the step before.
    #[inline(always)]
    pub fn restart(&mut self) {
        for means in [&mut self.suns, &mut self.windows, &mut self.zones, &mut self.lost] {
            means.fill(S::zero());
        }
    }

    /// Adds a stage by its weight.
    #[inline(always)]
    pub fn add(&mut self, conditions: &Conditions<S>, weight: f64) {
        for (mean, sun) in self.suns.iter_mut().zip(&conditions.suns) {
            *mean += sun.scale(weight);
        }
        for (mean, window) in self.windows.iter_mut().zip(&conditions.windows) {
            *mean += window.transmitted.scale(weight);
        }
        for ((mean, lost), zone) in self.zones.iter_mut().zip(&mut self.lost).zip(&conditions.light) {
            *mean += zone.transmitted.scale(weight);
            *lost += zone.lost.scale(weight);
        }
    }
}

#[inline(always)]
fn forced<S: Real>(coefficients: &Coefficients<S>, index: SurfaceId, now: &Instant<'_>) -> Forced<S> {
    let surface = &coefficients.surfaces[index];
    let (Some(convection), Boundary::Outdoors(outdoors)) = (&surface.convection, &surface.boundary) else {
        return [S::zero(); 2];
    };
    let [north, east] = now.wind_from;
    let facing = outdoors.heading[0].scale(north) + outdoors.heading[1].scale(east);
    let onto = S::constant(LEEWARD_COSINE).lt(facing);
    let flat = S::constant(FLAT).lt(surface.upward.abs());
    convection.forced(&now.wind, onto | flat)
}

#[inline(always)]
fn imposed_temperature<S: Real>(imposed: &Imposed<S>, now: &Instant<'_>) -> S {
    match imposed {
        Imposed::Channel(channel) => S::constant(now.row[*channel]),
        Imposed::Annual { mean, swing } => {
            let [cosine, sine] = now.season;
            *mean - (swing[0].scale(cosine) + swing[1].scale(sine))
        }
    }
}
