//! What acts on the air of a zone beside its walls: gains, ventilation, openings, paths to other zones.

use crate::building::coefficients::ZoneCoefficients;
use crate::input::description;
use crate::input::forcing::CLIMATE_CHANNELS;
use crate::input::values::Values;
use crate::number::line::Line;
use crate::number::real::Real;

/// Acceleration of free fall [m/s2].
const GRAVITY: f64 = 9.806_65;
/// 0 degC [K].
const FREEZING: f64 = 273.15;
/// Temperature differences between a zone and outdoors are rounded off within this [K] where they drive an air flow.
const ROUND_OFF: f64 = 0.01;

/// A heat capacity flow, whole or by schedule.
#[derive(Debug, Clone)]
pub struct AirFlow<S> {
    /// [W/K].
    conductance: S,
    schedule: Option<usize>,
}

impl<S: Real> AirFlow<S> {
    /// Ventilation by air changes or by volume flow.
    ///
    /// `heat` is that of a cubic metre of air [J/(m3 K)], `air_capacity` that of the zone's [J/K].
    #[must_use]
    pub fn new(flow: &description::Ventilation, values: &Values<'_, S>, heat: S, air_capacity: S) -> Self {
        let changes = values.get_or(flow.air_changes, 0.0).scale(1.0 / 3600.0) * air_capacity;
        let conductance = changes + values.get_or(flow.flow, 0.0) * heat;
        Self { conductance, schedule: channel_of(flow.schedule) }
    }

    /// Heat carried per degree, without a schedule's part in it [W/K].
    pub(crate) fn whole(&self) -> Option<S> {
        self.schedule.is_none().then_some(self.conductance)
    }

    #[inline(always)]
    fn at(&self, row: &[f64]) -> S {
        scheduled(self.conductance, self.schedule, row)
    }
}

/// Air that two zones exchange.
#[derive(Debug, Clone)]
pub struct Path<S> {
    /// The zones.
    pub between: [usize; 2],
    flow: AirFlow<S>,
}

impl<S: Real> Path<S> {
    /// Evaluates a path at a parameter vector and the density of the air [kg/m3].
    #[must_use]
    pub fn new(path: &description::AirPath, values: &Values<'_, S>, density: S) -> Self {
        let heat = density.scale(crate::building::coefficients::AIR_SPECIFIC_HEAT);
        let flow = AirFlow { conductance: values.get(path.flow) * heat, schedule: channel_of(path.schedule) };
        Self { between: path.between, flow }
    }

    /// Heat carried per degree between the airs [W/K].
    #[inline(always)]
    pub fn conductance(&self, row: &[f64]) -> S {
        self.flow.at(row)
    }

    pub(crate) fn whole(&self) -> Option<S> {
        self.flow.whole()
    }
}

/// Heat from people, light and machines.
#[derive(Debug, Clone)]
pub struct Gain<S> {
    /// Part given to the air [W].
    convective: S,
    /// Part radiated to the surfaces [W].
    radiant: S,
    /// Part radiated [-].
    pub(crate) radiative: S,
    schedule: Option<usize>,
}

impl<S: Real> Gain<S> {
    /// Evaluates a gain at a parameter vector.
    #[must_use]
    pub fn new(gain: &description::Gain, values: &Values<'_, S>) -> Self {
        let (power, radiative) = (values.get(gain.power), values.get(gain.radiative));
        Self {
            convective: power * (S::one() - radiative),
            radiant: power * radiative,
            radiative,
            schedule: channel_of(gain.schedule),
        }
    }
}

/// Ideal heating or cooling.
#[derive(Debug, Clone)]
pub struct Thermostat<S> {
    set_point: SetPoint<S>,
    capacity: Option<S>,
    schedule: Option<usize>,
}

#[derive(Debug, Clone, Copy)]
enum SetPoint<S> {
    Constant(S),
    Scheduled(usize),
}

impl<S: Real> Thermostat<S> {
    /// A plant without capacity may give this much [W]: more than any building takes.
    const UNLIMITED: f64 = 1e12;

    /// Evaluates a plant at a parameter vector.
    #[must_use]
    pub fn new(ideal_load: &description::Plant, values: &Values<'_, S>) -> Self {
        let set_point = match ideal_load.setpoint {
            description::SetPoint::Constant { temperature } => SetPoint::Constant(values.get(temperature)),
            description::SetPoint::Scheduled { channel } => SetPoint::Scheduled(CLIMATE_CHANNELS + channel),
        };
        let capacity = ideal_load.capacity.map(|id| values.get(id));
        Self { set_point, capacity, schedule: channel_of(ideal_load.schedule) }
    }

    /// Set point [degC] and the most heat [W] in a forcing row.
    #[inline(always)]
    pub fn at(&self, row: &[f64]) -> (S, S) {
        let set_point = match self.set_point {
            SetPoint::Constant(temperature) => temperature,
            SetPoint::Scheduled(channel) => S::constant(row[channel]),
        };
        let capacity = match self.capacity {
            Some(capacity) => capacity,
            None => S::constant(Self::UNLIMITED),
        };
        (set_point, scheduled(capacity, self.schedule, row))
    }
}

/// An opening to outdoors that wind and buoyancy drive air through.
///
/// `Q = A sqrt((C_w V)^2 + C_d^2 2 g h |T_o - T_i|/T)`: the two flows combined by the squares, which is by the pressures
/// that drive them; V the wind at the mast, T the mean of both temperatures (ASHRAE Handbook of Fundamentals 2017, ch. 16,
/// eqs. 37 and 38).
#[derive(Debug, Clone)]
pub struct Opening<S> {
    /// Heat capacity of the air that a square metre lets in per m/s [W s/(K m)].
    conductance: S,
    /// `C_w^2` [-].
    wind: S,
    /// `C_d^2 2 g h` [m2/s2].
    stack: S,
    schedule: Option<usize>,
}

impl<S: Real> Opening<S> {
    /// Evaluates an opening at a parameter vector; `heat` is that of a cubic metre of air [J/(m3 K)].
    #[must_use]
    pub fn new(opening: &description::Opening, values: &Values<'_, S>, heat: S) -> Self {
        let (discharge, wind) = (values.get(opening.discharge), values.get(opening.wind_coefficient));
        Self {
            conductance: heat * values.get(opening.area),
            wind: wind * wind,
            stack: discharge * discharge * values.get(opening.height).scale(2.0 * GRAVITY),
            schedule: channel_of(opening.schedule),
        }
    }

    /// Heat carried per degree [W/K] and its slope in `d = T_outdoor - T_air`.
    #[inline(always)]
    fn rate(&self, open: S, wind: S, outdoor: S, d: S) -> (S, S) {
        let magnitude = d.smooth_abs(ROUND_OFF);
        let inverse = S::one() / (outdoor - d.scale(0.5) + S::constant(FREEZING));
        let buoyancy = self.stack * magnitude * inverse;
        // |d|/T with T = T_outdoor - d/2.
        let rise = self.stack * (d / magnitude + magnitude * inverse.scale(0.5)) * inverse;
        // Closed by a height and a wind of nothing, the root must keep a slope.
        let speed = (self.wind * wind * wind + buoyancy).max(S::constant(1e-30)).sqrt();
        let gain = self.conductance * open;
        (gain * speed, gain * rise / speed.scale(2.0))
    }
}

/// What drives the air of a zone in one stage.
#[derive(Debug, Clone)]
pub struct ZoneConditions<S> {
    /// Gains given to the air [W].
    pub convective: S,
    /// Gains radiated to the surfaces [W].
    pub radiant: S,
    /// Heat carried by ventilation per degree [W/K].
    pub ventilation: S,
    /// Open part of each opening [-].
    open: Vec<S>,
}

impl<S: Real> ZoneConditions<S> {
    /// A place for the numbers of a zone.
    #[must_use]
    pub fn new(zone: &ZoneCoefficients<S>) -> Self {
        let zero = S::zero();
        Self { convective: zero, radiant: zero, ventilation: zero, open: vec![zero; zone.openings.len()] }
    }

    /// Numbers on the straight line through two others; see [`Conditions::between`](crate::weather::conditions::Conditions::between).
    pub(crate) fn between(&mut self, first: &Self, second: &Self, share: f64) {
        let line = |a: S, b: S| a + (b - a).scale(share);
        self.convective = line(first.convective, second.convective);
        self.radiant = line(first.radiant, second.radiant);
        self.ventilation = line(first.ventilation, second.ventilation).max(S::zero());
        for (at, (&a, &b)) in self.open.iter_mut().zip(first.open.iter().zip(&second.open)) {
            *at = line(a, b).max(S::zero()).min(S::one());
        }
    }

    /// Reads the schedules.
    #[inline(always)]
    pub(crate) fn update(&mut self, zone: &ZoneCoefficients<S>, row: &[f64]) {
        (self.convective, self.radiant) = (S::zero(), S::zero());
        for gain in &zone.gains {
            self.convective += scheduled(gain.convective, gain.schedule, row);
            self.radiant += scheduled(gain.radiant, gain.schedule, row);
        }
        self.ventilation = S::zero();
        for flow in &zone.ventilation {
            self.ventilation += flow.at(row);
        }
        for (open, opening) in self.open.iter_mut().zip(&zone.openings) {
            *open = scheduled(S::one(), opening.schedule, row);
        }
    }
}

/// Heat of outdoor air that is let in, by ventilation and openings, as its tangent in `T_outdoor - T_air`.
#[inline(always)]
pub(crate) fn ventilation<S: Real>(
    zone: &ZoneCoefficients<S>,
    at: &ZoneConditions<S>,
    wind: S,
    outdoor: S,
    air: S,
) -> Line<S> {
    let d = outdoor - air;
    let mut line = Line { offset: S::zero(), slope: at.ventilation };
    for (opening, &open) in zone.openings.iter().zip(&at.open) {
        let (rate, rise) = opening.rate(open, wind, outdoor, d);
        let tangent = Line::tangent(rate * d, rate + rise * d, d);
        line = Line { offset: line.offset + tangent.offset, slope: line.slope + tangent.slope };
    }
    line
}

/// Heat of outdoor air that enters unasked, `C (n0 + n1 |d| + n2 V)/3600 d`, as its tangent in `d = T_outdoor - T_air`.
#[inline(always)]
pub(crate) fn infiltration<S: Real>(zone: &ZoneCoefficients<S>, wind: S, outdoor: S, air: S) -> Line<S> {
    let d = outdoor - air;
    let [_, temperature, _] = zone.infiltration;
    let magnitude = d.smooth_abs(ROUND_OFF);
    let per_second = zone.air_capacity.scale(1.0 / 3600.0);
    let rate = per_second * leakage(zone, wind, magnitude);
    let slope = rate + per_second * temperature * d * d / magnitude;
    Line::tangent(rate * d, slope, d)
}

#[inline(always)]
fn leakage<S: Real>(zone: &ZoneCoefficients<S>, wind: S, magnitude: S) -> S {
    let [constant, temperature, by_wind] = zone.infiltration;
    constant + temperature * magnitude + by_wind * wind
}

/// Outdoor air entering a zone in all ways [1/h].
pub(crate) fn air_changes<S: Real>(
    zone: &ZoneCoefficients<S>,
    at: &ZoneConditions<S>,
    wind: S,
    outdoor: S,
    air: S,
) -> S {
    let d = outdoor - air;
    let openings = zone.openings.iter().zip(&at.open);
    let rates = openings.map(|(opening, &open)| opening.rate(open, wind, outdoor, d).0);
    let let_in = rates.fold(at.ventilation, |sum, rate| sum + rate);
    leakage(zone, wind, d.smooth_abs(ROUND_OFF)) + let_in.scale(3600.0) / zone.air_capacity
}

fn channel_of(schedule: Option<usize>) -> Option<usize> {
    schedule.map(|channel| CLIMATE_CHANNELS + channel)
}

/// A number, or the fraction of it that a schedule's channel says.
#[inline(always)]
fn scheduled<S: Real>(whole: S, schedule: Option<usize>, row: &[f64]) -> S {
    match schedule {
        Some(channel) => whole.scale(row[channel]),
        None => whole,
    }
}
