//! Whether laws that are written as text are used where they say that they hold.
//!
//! The end of each step is compared with the `valid` of each law: of convection, of conductivity, of infiltration and of the sky. A law goes
//! on outside of it; the caller warns. A run of one member says which law, when and at which values, each member of an ensemble in how many
//! steps.

use crate::building::cell::Matter;
use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::building::plan::SideRole;
use crate::number::real::Real;
use crate::physics::convection::SurfaceConvection;
use crate::physics::formula::function::Function;
use crate::physics::longwave::SkyEmission;
use crate::step::state::State;
use crate::step::stepper::Stepper;

/// A law that was used where it does not hold.
#[derive(Debug, Clone, PartialEq)]
pub struct OutOfRange {
    /// Name of what has the law.
    pub place: String,
    /// What it is a law of.
    pub law: &'static str,
    /// Steps at whose end it did not hold.
    pub steps: usize,
    /// The first of them.
    pub first: usize,
    /// What its `valid` depends on, at the ends of these steps.
    pub values: Vec<Extent>,
}

/// The values of a name of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Extent {
    /// The name in the formula.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The least value.
    pub least: f64,
    /// The largest value.
    pub most: f64,
}

/// Name, unit and value of what a `valid` depends on.
type Values = Vec<(&'static str, &'static str, f64)>;

/// A law that says where it holds.
#[derive(Debug, Clone, Copy)]
enum Limited {
    Convection(SideId),
    Conductivity { wall: usize, layer: usize },
    Infiltration(usize),
    Sky,
}

/// The laws of a run that say where they hold.
#[derive(Debug, Clone)]
pub(crate) struct Validity {
    laws: Vec<Limited>,
    /// In the order of the laws, of a run of one member.
    found: Vec<Option<OutOfRange>>,
    /// Steps at whose end a law did not hold, by law and lane.
    counts: Vec<usize>,
}

impl Validity {
    /// Nothing is watched in runs with derivatives.
    pub(crate) fn new<S: Real>(model: &Model<'_, S>) -> Self {
        let laws = if S::DERIVATIVES { Vec::new() } else { limited(model) };
        Self { found: vec![None; laws.len()], counts: vec![0; laws.len() * S::LANES], laws }
    }

    /// Looks at the state after a step.
    #[inline(always)]
    pub(crate) fn judge<S: Real>(&mut self, stepper: &Stepper<'_, S>, state: &State<S>, step: usize) {
        if !self.laws.is_empty() {
            self.look(stepper, state, step);
        }
    }

    // One copy only: it is seldom used.
    #[inline(never)]
    fn look<S: Real>(&mut self, stepper: &Stepper<'_, S>, state: &State<S>, step: usize) {
        let counts = self.counts.chunks_mut(S::LANES);
        for ((&law, found), counts) in self.laws.iter().zip(&mut self.found).zip(counts) {
            let mut beyond = Vec::new();
            for (lane, count) in counts.iter_mut().enumerate() {
                beyond = law.beyond(stepper, state, lane);
                *count += usize::from(!beyond.is_empty());
            }
            if beyond.is_empty() || S::LANES > 1 {
                continue;
            }
            let found = found.get_or_insert_with(|| law.unused(&stepper.model, step));
            found.steps += 1;
            for (name, unit, value) in beyond.into_iter().flatten() {
                if let Some(known) = found.values.iter_mut().find(|known| known.name == name) {
                    (known.least, known.most) = (known.least.min(value), known.most.max(value));
                } else {
                    found.values.push(Extent { name, unit, least: value, most: value });
                }
            }
        }
    }

    /// Steps of each lane at whose end a law did not hold, of the law that holds least often.
    pub(crate) fn steps<S: Real>(&self) -> S {
        let of_lane = |lane: usize| self.counts.chunks(S::LANES).map(move |counts| counts[lane]).max();
        S::of_lanes(|lane| of_lane(lane).unwrap_or(0) as f64)
    }

    /// The laws that were used where they do not hold.
    pub(crate) fn found(&self) -> impl Iterator<Item = &OutOfRange> {
        self.found.iter().flatten()
    }
}

/// The laws of a building that say where they hold.
fn limited<S: Real>(model: &Model<'_, S>) -> Vec<Limited> {
    let (plan, coefficients) = (model.plan, &model.coefficients);
    let convects = |surface: &SideId| model.convection(*surface).is_some_and(SurfaceConvection::limited);
    let layers = plan.walls.iter().enumerate();
    let layers =
        layers.flat_map(|(wall, layout)| (0..layout.layer_cells.len()).map(move |layer| (wall, layer)));
    let layers = layers.filter(|&(wall, layer)| conductivity(model, wall, layer).is_some());
    let zones = coefficients.zones.iter().enumerate();
    let zones = zones.filter(|(_, zone)| zone.infiltration_law.as_ref().is_some_and(Function::limited));
    (plan.surfaces.ids().filter(convects).map(Limited::Convection))
        .chain(layers.map(|(wall, layer)| Limited::Conductivity { wall, layer }))
        .chain(zones.map(|(zone, _)| Limited::Infiltration(zone)))
        .chain(coefficients.sky.limited().map(|_| Limited::Sky))
        .collect()
}

/// The conductivity of a layer that says where it holds.
fn conductivity<'m, S: Real>(model: &'m Model<'_, S>, wall: usize, layer: usize) -> Option<&'m Function<S>> {
    let (start, end) = model.plan.walls[wall].layer_cells[layer];
    let coefficients = &model.coefficients.walls[wall];
    match coefficients.cells.get(start..end)?.first()?.matter {
        Matter::Pcm(place) => coefficients.pcm[place].limited_conductivity(),
        Matter::Solid { .. } => None,
    }
}

impl Limited {
    /// What it depends on, at each place where it does not hold.
    fn beyond<S: Real>(self, stepper: &Stepper<'_, S>, state: &State<S>, lane: usize) -> Vec<Values> {
        let (model, conditions) = (&stepper.model, &stepper.weather.conditions);
        let wind = conditions.wind.lane(lane);
        match self {
            Self::Convection(surface) => {
                let air = match model.plan.surfaces[surface].role {
                    SideRole::Zone { zone, .. } => state.air[zone],
                    SideRole::Exterior => conditions.surfaces[surface].temperature,
                };
                let difference = state.surfaces[surface] - air;
                let law = model.convection(surface);
                let holds =
                    law.is_none_or(|law| law.valid(difference, conditions.wind, air).lane(lane) > 0.5);
                if holds {
                    return Vec::new();
                }
                vec![vec![("dT", "K", difference.lane(lane)), ("V", "m/s", wind)]]
            }
            Self::Conductivity { wall, layer } => {
                let Some(law) = conductivity(model, wall, layer) else { return Vec::new() };
                let (start, end) = model.plan.walls[wall].layer_cells[layer];
                let cells = &state.cells[model.cells(wall)][start..end];
                cells.iter().filter_map(|temperature| law.beyond(&[temperature.lane(lane)], lane)).collect()
            }
            Self::Infiltration(zone) => {
                let law = model.coefficients.zones[zone].infiltration_law.as_ref();
                let outdoor = conditions.outdoor_air.lane(lane);
                let point = [state.air[zone].lane(lane) - outdoor, wind, outdoor];
                law.and_then(|law| law.beyond(&point, lane)).into_iter().collect()
            }
            Self::Sky => {
                let law = model.coefficients.sky.limited();
                let point = SkyEmission::<S>::names(&conditions.sky_weather);
                law.and_then(|law| law.beyond(&point, lane)).into_iter().collect()
            }
        }
    }

    /// A record of it without a step.
    fn unused<S: Real>(self, model: &Model<'_, S>, first: usize) -> OutOfRange {
        let plan = model.plan;
        let (place, law) = match self {
            Self::Convection(surface) => (plan.surface_name(surface), "convection"),
            Self::Conductivity { wall, layer } => {
                (plan.cell_name(wall, plan.walls[wall].layer_cells[layer].0), "conductivity")
            }
            Self::Infiltration(zone) => {
                (format!("zone {}", plan.description.zones[zone].name), "infiltration")
            }
            Self::Sky => ("site".to_owned(), "the sky"),
        };
        OutOfRange { place, law, steps: 0, first, values: Vec::new() }
    }
}
