//! The weather of the stages of a step, as numbers at the surfaces and zones of the building.

use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::number::real::Real;
use crate::physics::longwave::black_temperature;
use crate::step::halving::Part;
use crate::step::scheme::Tableau;
use crate::weather::conditions::Conditions;
use crate::weather::index::WeatherIndex;
use crate::weather::instant::{Instant, Weather};
use crate::weather::solar_means::SolarMeans;

/// What acts on the building in the stage to be solved.
#[derive(Debug, Clone)]
pub(crate) struct StageWeather<S: Real> {
    pub(crate) index: WeatherIndex<S>,
    /// In the stage to be solved.
    pub(crate) conditions: Conditions<S>,
    /// In the other stage of a step whose stages are repeated.
    other: Conditions<S>,
    /// Solar radiation, means over the last step.
    pub(crate) sun: SolarMeans<S>,
    /// Sun absorbed by each surface, or by all panes of a window on both, mean over the last step [W/m2]; empty where nobody
    /// reads it.
    absorbed: Vec<S>,
}

impl<S: Real> StageWeather<S> {
    /// For a building with its coefficients.
    pub(crate) fn new(model: &Model<'_, S>) -> Self {
        let index = WeatherIndex::new(model.plan, &model.coefficients);
        let conditions = Conditions::new(model.plan, &model.coefficients, &index);
        Self {
            index,
            sun: SolarMeans::new(&conditions.sun),
            other: conditions.clone(),
            absorbed: Vec::new(),
            conditions,
        }
    }

    #[inline(always)]
    fn evaluate(
        &self,
        model: &Model<'_, S>,
        (now, airs): (&Instant<'_>, &[S]),
        conditions: &mut Conditions<S>,
    ) {
        conditions.weigh(&model.coefficients, now, airs);
        conditions.update(model.plan, &model.coefficients, &self.index, now);
    }

    /// The weather of one moment, no step; `airs` of the zones [degC].
    #[inline(always)]
    pub(crate) fn set_instant(&mut self, model: &Model<'_, S>, now: &Instant<'_>, airs: &[S]) {
        self.evaluate_now(model, now, airs);
        self.conditions.surround(&model.coefficients, &self.index, airs);
    }

    #[inline(always)]
    fn evaluate_now(&mut self, model: &Model<'_, S>, now: &Instant<'_>, airs: &[S]) {
        let Self { index, conditions, .. } = self;
        conditions.weigh(&model.coefficients, now, airs);
        conditions.update(model.plan, &model.coefficients, index, now);
    }

    /// The means over the last step are those of one moment.
    #[inline(always)]
    pub(crate) fn average_instant(&mut self, model: &Model<'_, S>) {
        self.restart_means();
        self.add_to_means(model, 1.0);
    }

    /// The weather at a stage of a step, or of a part of it that starts with some airs of the zones [degC].
    ///
    /// Within a step of two stages the weather is the straight line through both: SDIRK2 sums a straight line exactly,
    /// so that the parts of a step add up to the heat of the whole one. With one stage it is constant. The line of the sun is less steep where
    /// it would fall below zero.
    #[inline(always)]
    pub(crate) fn set_stage(
        &mut self,
        model: &Model<'_, S>,
        weather: &Weather<'_>,
        tableau: &Tableau,
        (part, stage): (Part, usize),
        airs: &[S],
    ) {
        let Tableau { weights, nodes, .. } = *tableau;
        self.evaluate_now(model, &weather.at(part.step, stage), airs);
        if stage == 0 {
            self.restart_means();
        }
        if part.halvings == 0 || weights.len() == 1 {
            self.add_to_means(model, weights[stage]);
        } else {
            let (mut first, mut second) = (self.conditions.clone(), self.conditions.clone());
            self.evaluate(model, (&weather.at(part.step, 0), airs), &mut first);
            self.evaluate(model, (&weather.at(part.step, 1), airs), &mut second);
            if stage == 0 {
                // The mean is that of the whole step.
                self.sun.add(&first.sun, weights[0]);
                self.sun.add(&second.sun, weights[1]);
                add_absorbed(&mut self.absorbed, model, &first, weights[0]);
                add_absorbed(&mut self.absorbed, model, &second, weights[1]);
            }
            let at = |place: f64| (place - nodes[0]) / (nodes[1] - nodes[0]);
            let fraction = at(part.from + part.share * nodes[stage]);
            let of_sun = Conditions::fraction_of_sun(&first, &second, fraction, [at(0.0), at(0.5)]);
            self.conditions.interpolate(&first, &second, (fraction, of_sun));
        }
        self.conditions.surround(&model.coefficients, &self.index, airs);
    }

    /// Averages the sun absorbed by surfaces, and its beam on planes, from now on.
    pub(crate) fn average_absorbed(&mut self, model: &Model<'_, S>) {
        self.absorbed = vec![S::zero(); model.plan.surfaces.len()];
        let beams = vec![S::zero(); self.sun.irradiances.len()];
        for set in [&mut self.conditions.sun.beams, &mut self.other.sun.beams, &mut self.sun.beams] {
            set.clone_from(&beams);
        }
    }

    /// Sun absorbed by a surface, or by all panes of a window, mean over the last step [W/m2].
    pub(crate) fn absorbed(&self, surface: SideId) -> S {
        self.absorbed.get(surface.index()).copied().unwrap_or_else(S::zero)
    }

    #[inline(always)]
    fn restart_means(&mut self) {
        self.sun.restart();
        self.absorbed.fill(S::zero());
    }

    #[inline(always)]
    fn add_to_means(&mut self, model: &Model<'_, S>, weight: f64) {
        self.sun.add(&self.conditions.sun, weight);
        if !self.absorbed.is_empty() {
            add_absorbed(&mut self.absorbed, model, &self.conditions, weight);
        }
    }

    /// Exchanges the weather with that of the other stage.
    #[inline(always)]
    pub(crate) fn swap_stages(&mut self) {
        core::mem::swap(&mut self.conditions, &mut self.other);
    }

    /// Short-wave radiation on a surface outdoors, mean over the last step [W/m2].
    pub(crate) fn incident(&self, surface: SideId) -> S {
        self.index.irradiance_source(surface).map_or_else(S::zero, |source| self.sun.irradiances[source])
    }

    /// The part of it from the sun's disc, where it is not measured [W/m2].
    pub(crate) fn incident_beam(&self, surface: SideId) -> S {
        let source = self.index.irradiance_source(surface);
        source.and_then(|source| self.sun.beams.get(source).copied()).unwrap_or_else(S::zero)
    }

    /// Temperature of the sky at the end of the last stage [degC].
    pub(crate) fn sky_temperature(&self) -> S {
        black_temperature(self.conditions.sky)
    }
}

/// Adds the sun absorbed by surfaces in a stage, by its weight.
#[inline(never)]
fn add_absorbed<S: Real>(means: &mut [S], model: &Model<'_, S>, conditions: &Conditions<S>, weight: f64) {
    for (mean, at) in means.iter_mut().zip(conditions.surfaces.iter()) {
        *mean += at.solar.scale(weight);
    }
    if means.is_empty() {
        return;
    }
    for (&w, window) in model.plan.windows.iter().zip(&conditions.sun.windows) {
        let all = window.panes.iter().fold(S::zero(), |sum, &pane| sum + pane);
        for surface in SideId::pair(w) {
            let shared = conditions.surfaces[surface].solar;
            means[surface.index()] += (all - shared).scale(weight);
        }
    }
}
