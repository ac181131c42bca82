//! The weather at an instant, as far as it is the same for all members of an ensemble.

use std::borrow::Cow;
use std::sync::OnceLock;

use crate::building::coefficients::Outdoors;
use crate::building::ids::SideId;
use crate::building::plan::Plan;
use crate::input::description::Facing;
use crate::input::forcing::{Forcing, channel};
use crate::number::elementary::sincos;
use crate::number::real::Real;
use crate::physics::convection::{Wind, WindTerms, wind_terms};
use crate::physics::horizon;
use crate::physics::imposed::imposed_law::{ImposedWeather, PER_DAY};
use crate::physics::longwave::SkyWeather;
use crate::physics::psychrometrics::{saturation_pressure, saturation_pressures};
use crate::physics::solar::{Irradiance, SkyVisibility, Sunlight, not_negative};

/// The weather at one stage of a step.
#[derive(Debug, Clone)]
pub struct Instant<'a> {
    /// All forcing channels.
    pub row: &'a [f64],
    /// The sun and its radiation, independent of any plane.
    pub(crate) sunlight: Sunlight,
    /// What the emission of the sky depends on.
    pub(crate) sky: SkyWeather,
    /// Wind at the mast.
    pub(crate) wind: Wind,
    /// North and east components of the direction that the wind comes from; zeros where no law depends on it.
    pub(crate) wind_from: [f64; 2],
    /// Cosine and sine of the angle of the day in the year; zeros where no ground temperature depends on it.
    pub(crate) season: [f64; 2],
    /// Fractions of sun and beams, see [`SolarGeometry`](crate::building::solar_geometry::SolarGeometry).
    pub(crate) fractions: Box<[f64]>,
    /// Vapour pressure outdoors, in a building with vapour balances [Pa].
    pub(crate) vapour: f64,
}

impl<'a> Instant<'a> {
    /// Evaluates a forcing row, whose vapour pressure is known.
    fn new(plan: &Plan, row: &'a [f64], vapour: f64, terms: WindTerms, ground: bool) -> Self {
        let unit = |angle: f64, needed: bool| {
            let (sine, cosine) = if needed { sincos(angle) } else { (0.0, 0.0) };
            [cosine, sine]
        };
        let site = &plan.description.site;
        let mut sunlight = Sunlight::new(row, plan.diffuse);
        if horizon::hides(&site.horizon, sunlight.direction) {
            sunlight.hide_sun();
        }
        Self {
            row,
            fractions: plan.solar_geometry.at(&sunlight),
            sunlight,
            sky: SkyWeather::new(row),
            wind: Wind::new(row[channel::WIND_SPEED], terms),
            wind_from: unit(row[channel::WIND_DIRECTION].to_radians(), terms.direction),
            season: unit(row[channel::DAY_OF_YEAR] * PER_DAY, ground),
            vapour,
        }
    }

    /// What laws of imposed temperatures depend on.
    #[inline(always)]
    pub(crate) fn imposed_weather(&self) -> ImposedWeather {
        ImposedWeather { season: self.season, outdoor_air: self.row[channel::AIR_TEMPERATURE] }
    }

    /// Fractions that obstacles leave of sun, sky and ground on a surface.
    pub(crate) fn visibility(&self, plan: &Plan, surface: SideId) -> SkyVisibility {
        plan.solar_geometry.visibility(surface, &self.fractions)
    }

    /// A measured irradiance [W/m2]. A pyranometer by night, whose dome is colder than its sensor, shows some watts below zero: these are no radiation
    /// and count as none.
    #[inline(always)]
    pub(crate) fn on_sensor(&self, channel: usize) -> f64 {
        not_negative(self.row[channel])
    }

    /// A measured irradiance of a surface outdoors by its parts: beam, sky and ground in the proportions of the climate at this
    /// instant, or of an isotropic sky where the climate has no radiation. Of the irradiance of the free plane obstacles leave
    /// their part; one that was measured behind them is used as it is.
    // A rare part of a building: kept out of the code of the others.
    #[inline(never)]
    pub(crate) fn measured<S: Real>(
        &self,
        plan: &Plan,
        surface: SideId,
        outdoors: &Outdoors<S>,
        (ground, channel): (S, usize),
    ) -> Irradiance<S> {
        let (open, sum) = (self.visibility(plan, surface), self.on_sensor(channel));
        let Some(free) = &outdoors.free else {
            let light = if self.sunlight.dark() { Sunlight::OVERCAST } else { self.sunlight };
            return light.on(&outdoors.plane, ground, &open).measured(sum);
        };
        let whole = Sunlight::new(self.row, plan.diffuse);
        let (whole, left) =
            if whole.dark() { (Sunlight::OVERCAST, Sunlight::OVERCAST) } else { (whole, self.sunlight) };
        let before = whole.on(free, ground, &SkyVisibility::FULL);
        left.on(&outdoors.plane, ground, &open).left_of(before.total(), sum)
    }
}

/// The weather at all stages of a run.
#[derive(Debug)]
pub struct Weather<'a> {
    plan: &'a Plan,
    forcing: Forcing<'a>,
    /// Step of the run that the forcing begins with.
    first: usize,
    /// Terms of the wind that the laws of convection depend on.
    terms: WindTerms,
    /// Whether a ground temperature depends on the day of the year.
    ground: bool,
    /// The stages of the first steps, each kept once it has been evaluated; empty where none is kept.
    stages: Vec<OnceLock<Instant<'a>>>,
    /// Vapour pressure outdoors at all stages, computed together; empty where it is computed when a stage is read, or by nobody [Pa].
    vapour: Vec<f64>,
}

impl<'a> Weather<'a> {
    /// The weather for many runs: each stage is evaluated when it is first read, and kept.
    #[must_use]
    pub fn new(plan: &'a Plan, forcing: &Forcing<'a>) -> Self {
        Self::keeping(plan, forcing, forcing.steps())
    }

    /// The weather for a single run that reads the stages of some first steps again and again. Memory does not grow with its length.
    #[must_use]
    pub fn for_single_run(plan: &'a Plan, forcing: &Forcing<'a>, repeated: usize) -> Self {
        // Shadows and beams are expensive: stages that warm-up reads again are evaluated once. All else is cheap.
        let kept = if plan.solar_geometry.is_empty() { 0 } else { repeated.min(forcing.steps()) };
        Self::keeping(plan, forcing, kept)
    }

    /// The weather of a part of a run that begins with a step; no stage is kept.
    #[must_use]
    pub(crate) fn from_step(plan: &'a Plan, forcing: &Forcing<'a>, first: usize) -> Self {
        Self { first, ..Self::keeping(plan, forcing, 0) }
    }

    /// The weather of another forcing for the same plan, of which no stage is kept.
    #[must_use]
    pub(crate) fn of<'f>(&self, forcing: &Forcing<'f>) -> Weather<'f>
    where
        'a: 'f,
    {
        let Self { plan, terms, ground, .. } = *self;
        Weather { plan, forcing: *forcing, first: 0, terms, ground, stages: Vec::new(), vapour: Vec::new() }
    }

    fn keeping(plan: &'a Plan, forcing: &Forcing<'a>, steps: usize) -> Self {
        let sides = || plan.surfaces.ids().map(|surface| plan.side(surface));
        let terms = wind_terms(sides().filter_map(|side| side.convection.as_ref()));
        let bridges = plan.description.thermal_bridges.iter().map(|bridge| &bridge.to);
        let ground = sides()
            .map(|side| &side.facing)
            .chain(bridges)
            .any(|facing| matches!(facing, Facing::Imposed { .. }));
        let stages = (0..steps * forcing.stages()).map(|_| OnceLock::new()).collect();
        let vapour = if plan.humidity.is_some() { vapour_pressures(forcing) } else { Vec::new() };
        Self { plan, forcing: *forcing, first: 0, terms, ground, stages, vapour }
    }

    /// Memory of a stage that is kept [B].
    #[must_use]
    pub fn bytes_of_stage(plan: &Plan) -> usize {
        size_of::<OnceLock<Instant<'a>>>() + plan.solar_geometry.bytes_of_instant()
    }

    fn evaluate(&self, step: usize, stage: usize) -> Instant<'a> {
        let row = self.row(step, stage);
        let vapour = match self.vapour.get((step - self.first) * self.forcing.stages() + stage) {
            Some(&known) => known,
            None if self.plan.humidity.is_some() => saturation_pressure(row[channel::DEW_POINT]),
            None => 0.0,
        };
        Instant::new(self.plan, row, vapour, self.terms, self.ground)
    }

    /// Number of steps.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.forcing.steps()
    }

    /// All forcing channels at a stage of a step of the run.
    #[must_use]
    pub fn row(&self, step: usize, stage: usize) -> &'a [f64] {
        self.forcing.at(step - self.first, stage)
    }

    /// The weather at a stage of a step of the run.
    #[must_use]
    pub fn at(&self, step: usize, stage: usize) -> Cow<'_, Instant<'a>> {
        match self.stages.get((step - self.first) * self.forcing.stages() + stage) {
            Some(kept) => Cow::Borrowed(kept.get_or_init(|| self.evaluate(step, stage))),
            None => Cow::Owned(self.evaluate(step, stage)),
        }
    }
}

/// Vapour pressures at the dew points of a forcing [Pa]; some more at the end. The exponential and the logarithm of one dew point
/// alone take as long as those of eight.
fn vapour_pressures(forcing: &Forcing<'_>) -> Vec<f64> {
    let stages = 0..forcing.steps() * forcing.stages();
    let mut dew: Vec<f64> =
        stages.map(|k| forcing.at(k / forcing.stages(), k % forcing.stages())[channel::DEW_POINT]).collect();
    dew.resize(dew.len().next_multiple_of(f64::CHUNK), 0.0);
    let mut pressures = vec![0.0; dew.len()];
    saturation_pressures(&dew, &mut pressures);
    pressures
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::coefficients::Coefficients;
    use crate::building::test_buildings::{glazed_zone, values};
    use crate::input::forcing::CLIMATE_CHANNELS;
    use crate::weather::conditions::Conditions;
    use crate::weather::index::WeatherIndex;

    /// The irradiance of the south wall of a zone, of which 100 W/m2 were measured, under the overhang or without it.
    fn left_of_100(overhang: bool, behind: bool, sun: [f64; 3], climate: [f64; 2]) -> (f64, SkyVisibility) {
        irradiated(overhang, behind, sun, climate, 100.0)
    }

    /// The same of another measured irradiance [W/m2].
    fn irradiated(
        overhang: bool,
        behind: bool,
        sun: [f64; 3],
        [direct, diffuse]: [f64; 2],
        measured: f64,
    ) -> (f64, SkyVisibility) {
        let mut description = glazed_zone("area", overhang);
        description.channels = vec!["G".into()];
        description.site.diffuse = "isotropic".to_owned();
        let side = &mut description.surfaces[0].outside;
        (side.irradiance, side.behind_obstacles) = (Some(0), behind);
        let plan = Plan::new(description).unwrap();
        let mut row = [0.0; CLIMATE_CHANNELS + 1];
        for (at, part) in [channel::SUN_EAST, channel::SUN_NORTH, channel::SUN_UP].into_iter().zip(sun) {
            row[at] = part;
        }
        (row[channel::DIRECT_NORMAL], row[channel::DIFFUSE_HORIZONTAL]) = (direct, diffuse);
        row[channel::GLOBAL_HORIZONTAL] = direct * sun[2].max(0.0) + diffuse;
        (row[channel::DIRECT_NORMAL_EXTRA], row[CLIMATE_CHANNELS]) = (1361.0, measured);
        let numbers = values(&plan.description);
        let coefficients = Coefficients::new(&plan, &numbers);
        let index = WeatherIndex::new(&plan, &coefficients);
        let forcing = Forcing::new(&row, 1, row.len()).unwrap();
        let weather = Weather::new(&plan, &forcing);
        let now = weather.at(0, 0);
        let mut conditions = Conditions::new(&plan, &coefficients, &index);
        conditions.update(&plan, &coefficients, &index, &now);
        let wall = SideId::outside(0);
        // The wall absorbs 0.6 of it.
        (conditions.surfaces[wall].solar / 0.6, now.visibility(&plan, wall))
    }

    /// Below zero a pyranometer measures itself: no irradiance of a surface is negative, whether the climate or a column has it.
    #[test]
    fn zero_offsets_are_no_radiation() {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        let mut row = [0.0; CLIMATE_CHANNELS];
        row[channel::SUN_UP] = 0.2;
        row[channel::SUN_NORTH] = -0.96_f64.sqrt();
        for at in [channel::DIRECT_NORMAL, channel::DIFFUSE_HORIZONTAL, channel::GLOBAL_HORIZONTAL] {
            row[at] = -3.0;
        }
        let numbers = values(&plan.description);
        let coefficients = Coefficients::new(&plan, &numbers);
        let index = WeatherIndex::new(&plan, &coefficients);
        let forcing = Forcing::new(&row, 1, row.len()).unwrap();
        let weather = Weather::new(&plan, &forcing);
        let mut conditions = Conditions::new(&plan, &coefficients, &index);
        conditions.update(&plan, &coefficients, &index, &weather.at(0, 0));
        assert!(weather.at(0, 0).sunlight.dark());
        assert!(conditions.surfaces.iter().all(|surface| surface.solar == 0.0));
        assert!(conditions.sun.windows.iter().all(|window| window.transmitted == 0.0));
        let day = [0.0, -0.75_f64.sqrt(), 0.5];
        for behind in [true, false] {
            assert_eq!(irradiated(true, behind, day, [600.0, 120.0], -4.0).0, 0.0);
        }
    }

    /// Beam 600 0.75^1/2 = 519.615, sky 0.5 120 = 60, ground 0.2 0.5 420 = 42 W/m2 on the free wall: of 100 W/m2 each obstacle
    /// takes its part. Behind the wall, or below the horizon, there is no beam; without radiation in the climate it is that of an
    /// isotropic sky, 0.5 to 0.1.
    #[test]
    fn obstacles_act_on_a_measured_irradiance() {
        let (cosine, sine) = (0.75_f64.sqrt(), 0.5);
        let south = [0.0, -cosine, sine];
        let (found, open) = left_of_100(true, false, south, [600.0, 120.0]);
        let free = 600.0 * cosine + 60.0 + 42.0;
        let left = 600.0 * cosine * open.sun + 60.0 * open.sky + 42.0 * open.ground;
        assert!(open.sun < 0.9 && open.sky < 0.9 && open.ground == 1.0, "{open:?}");
        assert!((found - 100.0 * left / free).abs() < 1e-9, "{found}");
        // The sun behind the wall, with 120 W/m2 beside it; diffuse radiation alone; and none.
        let behind_sun = ([0.0, cosine, sine], [600.0, 120.0], [60.0, 42.0]);
        let cases = [
            behind_sun,
            (south, [0.0, 120.0], [60.0, 12.0]),
            ([0.0, -cosine, -sine], [0.0, 0.0], [0.5, 0.1]),
        ];
        for (sun, climate, [sky, ground]) in cases {
            let (found, open) = left_of_100(true, false, sun, climate);
            let expected = 100.0 * (sky * open.sky + ground * open.ground) / (sky + ground);
            assert!((found - expected).abs() < 1e-9, "{sun:?}: {found} is not {expected}");
        }
    }

    /// One that was measured behind the obstacles, or without any, is used as it is.
    #[test]
    fn nothing_acts_behind_the_obstacles() {
        let south = [0.0, -0.75_f64.sqrt(), 0.5];
        for (overhang, behind) in [(true, true), (false, true), (false, false)] {
            assert_eq!(left_of_100(overhang, behind, south, [600.0, 120.0]).0, 100.0);
        }
    }

    /// Two steps of two stages, the air one degree warmer at each.
    #[test]
    fn stages_kept_or_evaluated_again() {
        let rows: Vec<f64> = (0..4 * CLIMATE_CHANNELS)
            .map(|k| {
                if k % CLIMATE_CHANNELS == channel::AIR_TEMPERATURE {
                    (k / CLIMATE_CHANNELS) as f64
                } else {
                    0.0
                }
            })
            .collect();
        let forcing = Forcing::new(&rows, 2, CLIMATE_CHANNELS).unwrap();
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        let (all, single) = (Weather::new(&plan, &forcing), Weather::for_single_run(&plan, &forcing, 2));
        assert_eq!((all.steps(), all.stages.len(), single.stages.len()), (2, 4, 0));
        for weather in [&all, &single] {
            assert_eq!(weather.at(1, 0).row[channel::AIR_TEMPERATURE], 2.0);
            assert_eq!(weather.row(0, 1)[channel::AIR_TEMPERATURE], 1.0);
        }
        // Beams are traced once for steps that are read again, and these alone are kept.
        let traced = Plan::new(glazed_zone("geometry", false)).unwrap();
        for (repeated, kept) in [(0, 0), (1, 2), (9, 4)] {
            let weather = Weather::for_single_run(&traced, &forcing, repeated);
            assert_eq!(weather.stages.len(), kept);
            assert_eq!(weather.at(1, 0).row[channel::AIR_TEMPERATURE], 2.0);
        }
    }
}
