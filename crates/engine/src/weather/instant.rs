//! The weather at an instant, as far as it is the same for all members of an ensemble.

use std::borrow::Cow;
use std::sync::OnceLock;

use crate::building::coefficients::surface::PER_DAY;
use crate::building::ids::SurfaceId;
use crate::building::plan::Plan;
use crate::input::description::Facing;
use crate::input::forcing::{Forcing, channel};
use crate::number::elementary::sincos;
use crate::number::real::Real;
use crate::physics::convection::{Wind, WindTerms};
use crate::physics::horizon;
use crate::physics::longwave::SkyState;
use crate::physics::psychrometrics::{saturation_pressure, saturation_pressures};
use crate::physics::solar::{SkyVisibility, Sunlight};

/// The weather at one stage of a step.
#[derive(Debug, Clone)]
pub struct Instant<'a> {
    /// All forcing channels.
    pub row: &'a [f64],
    /// The sun and its radiation, independent of any plane.
    pub(crate) sunlight: Sunlight,
    /// What the emission of the sky depends on.
    pub(crate) sky: SkyState,
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
        let mut sunlight = Sunlight::new(row, site.diffuse);
        if horizon::hides(&site.horizon, sunlight.direction) {
            sunlight.hide_sun();
        }
        Self {
            row,
            fractions: plan.solar_geometry.at(&sunlight),
            sunlight,
            sky: SkyState::new(&site.sky, row),
            wind: Wind::new(row[channel::WIND_SPEED], terms),
            wind_from: unit(row[channel::WIND_DIRECTION].to_radians(), terms.direction),
            season: unit(row[channel::DAY_OF_YEAR] * PER_DAY, ground),
            vapour,
        }
    }

    /// Fractions that obstacles leave of sun, sky and ground on a surface.
    pub(crate) fn visibility(&self, plan: &Plan, surface: SurfaceId) -> SkyVisibility {
        plan.solar_geometry.visibility(surface, &self.fractions)
    }
}

/// The weather at all stages of a run.
#[derive(Debug)]
pub struct Weather<'a> {
    plan: &'a Plan,
    forcing: Forcing<'a>,
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

    /// The weather of another forcing for the same plan, of which no stage is kept.
    #[must_use]
    pub(crate) fn of<'f>(&self, forcing: &Forcing<'f>) -> Weather<'f>
    where
        'a: 'f,
    {
        let Self { plan, terms, ground, .. } = *self;
        Weather { plan, forcing: *forcing, terms, ground, stages: Vec::new(), vapour: Vec::new() }
    }

    fn keeping(plan: &'a Plan, forcing: &Forcing<'a>, steps: usize) -> Self {
        let sides = || plan.surfaces.ids().map(|surface| plan.side(surface));
        let terms = WindTerms::of(sides().filter_map(|side| side.convection.as_ref()));
        let bridges = plan.description.thermal_bridges.iter().map(|bridge| &bridge.to);
        let ground = sides()
            .map(|side| &side.facing)
            .chain(bridges)
            .any(|facing| matches!(facing, Facing::Ground { .. }));
        let stages = (0..steps * forcing.stages()).map(|_| OnceLock::new()).collect();
        let vapour = if plan.humidity.is_some() { vapour_pressures(forcing) } else { Vec::new() };
        Self { plan, forcing: *forcing, terms, ground, stages, vapour }
    }

    /// Memory of a stage that is kept [B].
    #[must_use]
    pub fn bytes_of_stage(plan: &Plan) -> usize {
        size_of::<OnceLock<Instant<'a>>>() + plan.solar_geometry.bytes_of_instant()
    }

    fn evaluate(&self, step: usize, stage: usize) -> Instant<'a> {
        let row = self.forcing.at(step, stage);
        let vapour = match self.vapour.get(step * self.forcing.stages() + stage) {
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

    /// All forcing channels at a stage of a step.
    #[must_use]
    pub fn row(&self, step: usize, stage: usize) -> &'a [f64] {
        self.forcing.at(step, stage)
    }

    /// The weather at a stage of a step.
    #[must_use]
    pub fn at(&self, step: usize, stage: usize) -> Cow<'_, Instant<'a>> {
        match self.stages.get(step * self.forcing.stages() + stage) {
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
    use crate::building::test_buildings::glazed_zone;
    use crate::input::forcing::CLIMATE_CHANNELS;

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
