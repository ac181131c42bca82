//! Starts that are far from any balance: a cold room whose light surfaces get nearly all of an unlimited heating by radiation.

use crate::common::random::of_surface;
use crate::common::{ALL_SCHEMES, Builder, forcing, options, try_run, values, weather};
use mascarin_engine::Scheme;
use mascarin_engine::description::{Convection, Description, IdealLoad, SetPoint, ZoneLongwave};
use mascarin_engine::forcing::channel;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::Options;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::state::Initial;

/// A room of light surfaces, some of them massless, with heating that is radiated.
fn room(radiative: f64, area: f64, film: Option<f64>) -> Description {
    let mut b = Builder::new();
    let wool = b.solid("wool", 0.04, 30.0, 1000.0);
    let concrete = b.solid("concrete", 1.75, 2240.0, 900.0);
    let pane = b.resistance("pane", 0.15);
    let heavy = b.construction("heavy", &[(wool, 0.1, 3), (concrete, 0.1, 4)]);
    let light = b.construction("light", &[(pane, 0.0, 0)]);
    let zone = b.zone("room", 50.0, 0.5, ZoneLongwave::Radiosity);
    let factor = b.number("factor", 1.0);
    for (name, construction, place) in [
        ("south", heavy, [12.0, 90.0, 180.0]),
        ("north", heavy, [12.0, 90.0, 0.0]),
        ("roof", heavy, [20.0, 0.0, 0.0]),
        ("window", light, [area, 90.0, 180.0]),
    ] {
        let law = match film {
            Some(coefficient) if construction == light => b.convection(coefficient),
            _ => Convection::law("tarp", &[("factor", factor)]),
        };
        let outside = b.convection(15.0);
        let (outside, inside) = (b.outdoors(outside, 0.9, 0.6), b.inside(zone, law, 0.9));
        b.surface(name, construction, place, outside, inside);
    }
    let [temperature, radiated] = [("setpoint", 20.0), ("radiative", radiative)].map(|(n, v)| b.number(n, v));
    let mut d = b.describe();
    let setpoint = SetPoint::Constant { temperature };
    d.zones[0].heating =
        Some(IdealLoad { setpoint, capacity: None, radiative: Some(radiated), schedule: None });
    d
}

fn cold(time: f64, row: &mut [f64]) {
    weather(time, row);
    row[channel::AIR_TEMPERATURE] -= 30.0;
    row[channel::DEW_POINT] -= 35.0;
}

/// All of them are solved, with balances that close, and nothing is colder than the sky can make it.
#[test]
fn radiant_heating_of_a_cold_room_freezes_nothing() {
    let mut strongest = 0.0_f64;
    for (radiative, area, film) in
        [(0.95, 0.5, None), (0.95, 2.0, None), (0.95, 6.0, None), (0.95, 6.0, Some(3.0)), (0.6, 20.0, None)]
    {
        let plan = Plan::new(room(radiative, area, film)).unwrap();
        // What its surfaces emit at 20 degC: sigma T^4 = 418.766 W/m2 of black ones.
        let emitted = 418.766 * 0.9 * (12.0 + 12.0 + 20.0 + area);
        for (scheme, dt, start) in ALL_SCHEMES.into_iter().flat_map(|scheme: Scheme| {
            [(60.0, -10.0), (300.0, 0.0), (900.0, -40.0), (10_800.0, -10.0)]
                .map(|(dt, start)| (scheme, dt, start))
        }) {
            let rows = forcing(&plan, scheme, 48, dt, cold);
            let outputs = (0..4)
                .flat_map(of_surface)
                .chain([Output::AirTemperature { zone: 0 }, Output::HeatingLoad { zone: 0 }])
                .collect::<Vec<_>>();
            let columns = outputs.len();
            let options = Options {
                initial: Initial::Everywhere(start),
                residuals: true,
                ..options(scheme, dt, outputs)
            };
            let name = format!("{area} m2, {radiative}, {film:?}, {scheme:?}, {dt} s from {start} degC");
            let run = try_run(&plan, &values(&plan), &rows, &options);
            let run = run.unwrap_or_else(|error| panic!("{name}: {error}"));
            let coldest = run.records.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(coldest > -80.0, "{name}: {coldest} degC");
            let radiated =
                run.records.iter().skip(columns - 1).step_by(columns).map(|load| radiative * load / emitted);
            strongest = radiated.fold(strongest, f64::max);
            assert!(strongest < 1.0 + 1e-9, "{name}: {strongest} of what the surfaces emit");
            assert!(run.energy_balance.closure() < 1e-10, "{name}: {}", run.energy_balance.closure());
            // The tangents of linearly implicit stages leave out up to a thousandth of the heat.
            let missing = run.counters.largest_residual.unwrap();
            assert!(scheme == Scheme::LinearlyImplicit || missing < 1e-2, "{name}: {missing} W are missing");
        }
    }
    assert!(strongest > 0.99, "the limit of the radiation is reached: {strongest}");
}
