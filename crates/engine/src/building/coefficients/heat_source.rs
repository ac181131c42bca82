//! Heat sources in walls: their numbers.

use crate::building::plan::Plan;
use crate::input::description::{self, HeatExchange, HeatingMeans, SetPoint, Soil};
use crate::input::forcing::{CLIMATE_CHANNELS, Schedule};
use crate::input::values::Values;
use crate::number::real::Real;

use super::wall::WallCoefficients;

/// A heat source.
#[derive(Debug, Clone)]
pub struct HeatSource<S> {
    /// Index of the wall, and of the cell of the building that is its plane.
    pub(crate) wall: usize,
    pub(crate) cell: usize,
    /// Power [W/m2] or flow [kg/(s m2)], and what multiplies it.
    pub(crate) driven: (S, Schedule),
    pub(crate) water: Option<Water<S>>,
    pub(crate) thermostat: Option<Throttle<S>>,
    pub(crate) control: Option<usize>,
}

/// Water in pipes.
#[derive(Debug, Clone)]
pub(crate) struct Water<S> {
    pub(crate) supply: Temperature<S>,
    /// [J/(kg K)].
    pub(crate) specific_heat: S,
    pub(crate) exchange: Exchange<S>,
}

/// How well water exchanges its heat.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Exchange<S> {
    /// [W/(m2 K)].
    Conductance(S),
    /// [-].
    Effectiveness(S),
}

/// A thermostat with a throttling range.
#[derive(Debug, Clone)]
pub(crate) struct Throttle<S> {
    pub(crate) zone: usize,
    pub(crate) set_point: Temperature<S>,
    pub(crate) range: S,
    pub(crate) cooling: bool,
}

/// A temperature that is a number or a channel.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Temperature<S> {
    /// [degC].
    Constant(S),
    /// Position in a forcing row.
    Channel(usize),
}

impl<S: Real> Temperature<S> {
    fn new(point: &SetPoint, values: &Values<'_, S>) -> Self {
        match point {
            SetPoint::Constant { temperature } => Self::Constant(values.get(*temperature)),
            SetPoint::Scheduled { channel } => Self::Channel(CLIMATE_CHANNELS + channel),
        }
    }

    /// In a forcing row [degC].
    pub(crate) fn at(&self, row: &[f64]) -> S {
        match *self {
            Self::Constant(temperature) => temperature,
            Self::Channel(channel) => S::constant(row[channel]),
        }
    }
}

impl<S: Real> HeatSource<S> {
    /// The heat by the outdoor air into the two innermost cells of the soil behind a wall.
    pub(crate) fn of_soil(plan: &Plan, (surface, soil): (usize, &Soil)) -> [Self; 2] {
        let innermost = plan.walls[surface].first_cell + soil.capacities.len() - 1;
        [0, 1].map(|next| Self {
            wall: surface,
            cell: innermost - next,
            driven: (S::one(), Schedule::new(Some(soil.heat[next]))),
            water: None,
            thermostat: None,
            control: None,
        })
    }

    pub(crate) fn new(
        plan: &Plan,
        (index, source): (usize, &description::HeatSource),
        values: &Values<'_, S>,
        walls: &[WallCoefficients<S>],
    ) -> Self {
        let (wall, area) = (&plan.walls[source.surface], walls[source.surface].area);
        let planes = wall.planes.iter().filter(|(of, _)| *of == index);
        let cell = planes.map(|(_, cell)| wall.first_cell + cell).sum();
        let (driven, water) = match &source.means {
            HeatingMeans::Electric { power, schedule } => {
                ((values.get(*power), Schedule::new(*schedule)), None)
            }
            HeatingMeans::Water { flow, schedule, supply, specific_heat, exchange } => {
                let water = Water {
                    supply: Temperature::new(supply, values),
                    specific_heat: values.get(*specific_heat),
                    exchange: match exchange {
                        HeatExchange::Conductance { conductance } => {
                            Exchange::Conductance(values.get(*conductance))
                        }
                        HeatExchange::Effectiveness { effectiveness } => {
                            Exchange::Effectiveness(values.get(*effectiveness))
                        }
                    },
                };
                ((values.get(*flow) / area, Schedule::new(*schedule)), Some(water))
            }
        };
        let thermostat = source.thermostat.as_ref().map(|thermostat| Throttle {
            zone: thermostat.zone,
            set_point: Temperature::new(&thermostat.setpoint, values),
            range: values.get(thermostat.range),
            cooling: thermostat.cooling,
        });
        Self { wall: source.surface, cell, driven, water, thermostat, control: source.control }
    }
}
