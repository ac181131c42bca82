//! Air through openings that pressure drives, and the controls of openings.
//!
//! A control decides at the beginning of a step, from the temperatures there, the weather in the first stage and the time since it last
//! opened or closed; its decision holds for the step. So do those of the thermostats of heat sources in walls. The pressures and flows of a stage belong to the weather in the stage and to the temperatures of the airs at the beginning of
//! the step, or of the part of it: a step stays as linear as it is without them, and its flows are of first order in its length. (Hensen
//! 1999, A comparison of coupled and de-coupled solutions for temperature and air flow in a building, ASHRAE Trans. 105(2), 962-969, calls
//! this ping-pong.) A flow that a temperature difference alone drives grows with the root of it: a flow that is too large for the heat in
//! the room is followed by one that is too small by less than half of that.

use crate::building::coefficients::vents::OF_DENSITY;
use crate::building::model::Model;
use crate::input::forcing::channel;
use crate::linear::vent_network::{LEAK, Link, VentNetwork};
use crate::number::real::Real;
use crate::physics::constants::KELVIN;
use crate::step::stage_weather::StageWeather;
use crate::step::state::State;
use crate::step::stepper::Stepper;
use crate::weather::conditions::Conditions;

impl<S: Real> Stepper<'_, S> {
    /// Lets the controls decide in a forcing row, for a length [s].
    #[inline(always)]
    pub(crate) fn control_vents(&self, state: &mut State<S>, row: &[f64], length: f64) {
        control_vents(&self.model, state, row, length);
    }

    /// Closes what controls have closed, and finds the flows in the weather that is set.
    #[inline(always)]
    pub(crate) fn drive_vents(&mut self, state: &State<S>) {
        drive_vents(&self.model, &mut self.weather, self.vents.as_deref_mut(), state);
    }
}

/// Lets the controls decide in a forcing row, for a length [s].
#[inline(always)]
pub(super) fn control_vents<S: Real>(model: &Model<'_, S>, state: &mut State<S>, row: &[f64], length: f64) {
    let State { opened, unchanged, air, .. } = state;
    let (outdoor, wind) = (row[channel::AIR_TEMPERATURE], row[channel::WIND_SPEED]);
    let states = opened.iter_mut().zip(unchanged);
    for ((opened, unchanged), control) in states.zip(&model.coefficients.vents.controls) {
        let before = *opened;
        *opened = control.decide(before, *unchanged, air, outdoor, wind, row);
        let changed = before.lt(*opened) | opened.lt(before);
        *unchanged = S::select(changed, S::zero(), *unchanged) + S::constant(length);
    }
}

/// Closes what controls have closed, lets heat sources release what thermostats ask for, and finds the flows in the weather of the conditions.
#[inline(always)]
pub(super) fn drive_vents<S: Real>(
    model: &Model<'_, S>,
    weather: &mut StageWeather<S>,
    network: Option<&mut VentNetwork<'_, S>>,
    state: &State<S>,
) {
    let sources = weather.conditions.heat_sources.iter_mut().zip(&model.coefficients.heat_sources);
    for (at, source) in sources {
        at.drive(source, &state.air, &state.opened);
    }
    if !model.coefficients.vents.is_empty() {
        find_vent_flows(model, weather, network, state);
    }
}

// Most buildings have none: one copy of it is enough.
#[inline(never)]
fn find_vent_flows<S: Real>(
    model: &Model<'_, S>,
    weather: &mut StageWeather<S>,
    network: Option<&mut VentNetwork<'_, S>>,
    state: &State<S>,
) {
    let numbers = &model.coefficients;
    let StageWeather { conditions, index, .. } = weather;
    for (at, zone) in conditions.zones.iter_mut().zip(&numbers.zones) {
        at.control(zone, &state.opened);
    }
    let flows = conditions.paths.iter_mut().zip(numbers.paths.iter().map(|path| path.control));
    let doors = conditions.doors.iter_mut().zip(numbers.doors.iter().map(|door| door.control));
    for (flow, control) in flows.chain(doors) {
        if let Some(control) = control {
            *flow = *flow * state.opened[control];
        }
    }
    conditions.vents.control(&numbers.vents, &state.opened);
    if let Some(network) = network {
        S::vectorised(
            #[inline(always)]
            || {
                drive(network, model, conditions, &state.air);
                network.solve();
                spread(network, model, conditions);
            },
        );
    }
    // Laws of convection that depend on the air that flows in see what has been opened.
    conditions.surround(numbers, index, &state.air);
}

/// Wind and stack on all parts of openings, and the density of the air on both of their sides.
#[inline(always)]
fn drive<S: Real>(
    network: &mut VentNetwork<'_, S>,
    model: &Model<'_, S>,
    conditions: &Conditions<S>,
    air: &[S],
) {
    let numbers = &model.coefficients.vents;
    // Densities over that of the site [-].
    let density = |air: S| S::constant(OF_DENSITY) / (air + S::constant(KELVIN));
    let outdoor = density(conditions.outdoor_air);
    let of_zone = |zone: usize| density(air[zone]);
    for (drawn, zone) in network.drawn.iter_mut().zip(&conditions.mechanical_air.zones) {
        *drawn = zone.drawn / numbers.heat;
    }
    network.links.clear();
    for (k, vent) in numbers.all.iter().enumerate() {
        let ends = [of_zone(vent.zone), vent.to.map_or(outdoor, of_zone)];
        let fall = numbers.weight * (ends[1] - ends[0]);
        let opened = vent.strength * conditions.vents.open[k];
        let strengths = ends.map(|density| opened * density.sqrt());
        for &height in &vent.heights {
            network.links.push(Link {
                from: vent.zone,
                to: vent.to,
                strengths,
                exponent: vent.exponent,
                drive: fall * height - outdoor * conditions.vents.pressure[k],
            });
        }
    }
}

/// Flows of all openings, and the heat that they carry.
#[inline(always)]
fn spread<S: Real>(network: &VentNetwork<'_, S>, model: &Model<'_, S>, conditions: &mut Conditions<S>) {
    let air = &model.coefficients.mechanical_air;
    let numbers = &model.coefficients.vents;
    let (zones, carried) = (&mut conditions.mechanical_air.zones, &mut conditions.mechanical_air.carried);
    let (mut link, mut pair) = (0, air.first_of_vents);
    for (vent, flows) in numbers.all.iter().zip(&mut conditions.vents.flows) {
        *flows = [S::zero(); 2];
        for _ in &vent.heights {
            let flow = network.flow(link);
            flows[0] += flow.max(S::zero());
            flows[1] += (-flow).max(S::zero());
            link += 1;
        }
        let heat = flows.map(|flow| flow * numbers.heat);
        if let Some(to) = vent.to {
            zones[to].from_zones += heat[0];
            zones[vent.zone].from_zones += heat[1];
            carried[pair..pair + 2].copy_from_slice(&heat);
            pair += 2;
        } else {
            zones[vent.zone].exchange(heat);
        }
    }
    for (zone, &pressure) in zones.iter_mut().zip(&network.pressures) {
        let leak = pressure.scale(LEAK) * numbers.heat;
        zone.exchange([leak.max(S::zero()), (-leak).max(S::zero())]);
    }
}
