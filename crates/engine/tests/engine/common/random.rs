//! Random valid buildings, each of them from a seed.

#![allow(dead_code, reason = "every test program uses its own part")]

use core::f64::consts::TAU;

use mascarin_engine::Scheme;
use mascarin_engine::description::{
    AirPath, Construction, Convection, Description, Exposure, Facing, FormulaNumber, FrameShare, Gain, Gap,
    Gas, Glazing, IdealLoad, Material, MeltingCurve, Opening, OutdoorLongwave, Pane, PaneOptics, ParamId,
    Parameter, PcmLaw, PublishedLaw, SetPoint, Side, Sky, TablePoints, Tail, Ventilation, ZoneLongwave,
    ZoneSun,
};
use mascarin_engine::forcing::channel;
use mascarin_engine::laws::{self, LawEntry, LawRange, Sides};
use mascarin_engine::number::Real;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::Options;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::state::Initial;

use crate::common::{Builder, LayerOf, facing, forcing, law, options, set, weather};

/// Laws of convection with draws of their own.
const DRAWN: [&str; 9] = [
    "constant",
    "alamdari_hammond",
    "tarp",
    "power",
    "linear_wind",
    "guichard2016_eq5",
    "mowitt",
    "iso15099",
    "doe2",
];

/// Random numbers: `SplitMix64` (Steele, Lea & Flood 2014, doi:10.1145/2660193.2660195).
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform from `low` to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// Uniform below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        usize::try_from(self.next() % count as u64).unwrap()
    }

    pub fn chance(&mut self, probability: f64) -> bool {
        self.between(0.0, 1.0) < probability
    }

    pub fn of<T: Clone>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())].clone()
    }

    /// Numbers from 0 to `count - 1` in a random order.
    pub fn permutation(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            order.swap(last, self.below(last + 1));
        }
        order
    }
}

/// What a building may contain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contents {
    /// Everything.
    All,
    /// Neither sun, gains, ideal loads nor radiation of the sky: all heat comes from imposed temperatures.
    ImposedTemperatures,
}

/// Channels of the building: a measured temperature, a schedule, a set point, a measured irradiance.
const MEASURED: usize = 0;
const SCHEDULE: usize = 1;
const SET_POINT: usize = 2;
const IRRADIANCE: usize = 3;

/// A building and how it is run.
pub struct Case {
    pub contents: Contents,
    pub description: Description,
    pub scheme: Scheme,
    /// Step [s].
    pub dt: f64,
    pub steps: usize,
    /// Temperature at the start [degC].
    pub start: f64,
}

impl Case {
    pub fn new(seed: u64, contents: Contents) -> Self {
        let mut random = Random::new(seed);
        let description = Maker { random: &mut random, b: Builder::new(), contents }.building();
        Self {
            contents,
            description,
            scheme: random.of(&[Scheme::Sdirk2, Scheme::BackwardEuler]),
            dt: random.of(&[900.0, 3600.0]),
            steps: 30,
            start: random.between(15.0, 28.0),
        }
    }

    pub fn plan(&self) -> Plan {
        Plan::new(self.description.clone()).unwrap()
    }

    /// What drives it; see [`forcing`].
    pub fn rows(&self, plan: &Plan) -> Vec<f64> {
        forcing(plan, self.scheme, self.steps, self.dt, |time, row| self.drive(time, row))
    }

    /// Weather, and the channels of the building.
    pub fn drive(&self, time: f64, row: &mut [f64]) {
        let hour = time / 3600.0;
        weather(time, row);
        row[channel::INFRARED] = 360.0 + 20.0 * Real::cos(TAU * hour / 24.0);
        row[channel::PRESSURE] = 101_000.0;
        if self.contents == Contents::ImposedTemperatures {
            for dark in [channel::DIRECT_NORMAL, channel::DIFFUSE_HORIZONTAL, channel::GLOBAL_HORIZONTAL] {
                row[dark] = 0.0;
            }
        }
        let occupied = (6.3..19.1).contains(&hour.rem_euclid(24.0));
        set(row, MEASURED, 19.0 + 3.0 * Real::sin(0.3 * hour));
        set(row, SCHEDULE, if occupied { 1.0 } else { 0.2 });
        set(row, SET_POINT, if occupied { 21.0 } else { 17.5 });
        set(row, IRRADIANCE, f64::max(300.0 * Real::cos(TAU * (hour - 12.3) / 24.0), 0.0));
    }

    /// Options of the run; [`Case::outputs`] are recorded.
    pub fn options(&self) -> Options {
        Options {
            initial: Initial::Everywhere(self.start),
            ..options(self.scheme, self.dt, outputs(&self.description))
        }
    }

    /// Lowest and highest of all imposed temperatures [degC].
    pub fn imposed_range(&self, plan: &Plan, rows: &[f64]) -> [f64; 2] {
        let mut range = [self.start; 2];
        let mut add = |temperature: f64| {
            range = [range[0].min(temperature), range[1].max(temperature)];
        };
        for row in rows.chunks(plan.n_channels()) {
            add(row[channel::AIR_TEMPERATURE]);
            add(row[mascarin_engine::forcing::CLIMATE_CHANNELS + MEASURED]);
        }
        let value = |id: ParamId| self.description.parameters[id.0 as usize].value;
        for surface in &self.description.surfaces {
            for side in [&surface.outside, &surface.inside] {
                if let Facing::Imposed { law } = &side.facing {
                    let number = |name| law.number(name).map_or(0.0, value);
                    add(number("mean") - number("amplitude"));
                    add(number("mean") + number("amplitude"));
                }
            }
        }
        range
    }
}

/// Readings of all zones, then of all surfaces.
pub fn outputs(description: &Description) -> Vec<Output> {
    let zones = (0..description.zones.len()).flat_map(of_zone);
    zones.chain((0..description.surfaces.len()).flat_map(of_surface)).collect()
}

/// Readings of a zone: two temperatures, two loads.
pub fn of_zone(zone: usize) -> [Output; 4] {
    [
        Output::AirTemperature { zone },
        Output::MeanRadiantTemperature { zone },
        Output::HeatingLoad { zone },
        Output::CoolingLoad { zone },
    ]
}

/// Readings of a surface: two temperatures.
pub fn of_surface(surface: usize) -> [Output; 2] {
    [Output::FaceTemperature { surface, side: 0 }, Output::FaceTemperature { surface, side: 1 }]
}

/// The same building with other numbers of zones and surfaces: `zones[k]` is the old number of the new zone k.
pub fn reordered(description: &Description, zones: &[usize], surfaces: &[usize]) -> Description {
    let new_zone = |old: usize| zones.iter().position(|&zone| zone == old).unwrap();
    let mut d = description.clone();
    d.surfaces = surfaces.iter().map(|&old| description.surfaces[old].clone()).collect();
    for surface in &mut d.surfaces {
        for side in [&mut surface.outside, &mut surface.inside] {
            if let Facing::Zone { zone } = &mut side.facing {
                *zone = new_zone(*zone);
            }
        }
    }
    d.zones = zones.iter().map(|&old| description.zones[old].clone()).collect();
    for (zone, &old) in d.zones.iter_mut().zip(zones) {
        // Shares of the sun stand in the order of the surfaces.
        if let ZoneSun::Shares { surfaces: shares, .. } = &mut zone.sun {
            let before = sides_of(description, old);
            let mut after = before.clone();
            after.sort_by_key(|&(surface, side)| {
                (surfaces.iter().position(|&old| old == surface).unwrap(), side)
            });
            let place = |side| before.iter().position(|&other| other == side).unwrap();
            *shares = after.iter().map(|&side| shares[place(side)]).collect();
        }
    }
    for path in &mut d.air_paths {
        path.between = path.between.map(new_zone);
    }
    for opening in &mut d.openings {
        opening.zone = new_zone(opening.zone);
    }
    d
}

/// Surfaces and sides of a zone.
fn sides_of(description: &Description, zone: usize) -> Vec<(usize, usize)> {
    let sides = description.surfaces.iter().enumerate();
    let sides = sides.flat_map(|(k, surface)| [((k, 0), &surface.outside), ((k, 1), &surface.inside)]);
    sides.filter(|(_, side)| side.facing == Facing::Zone { zone }).map(|(place, _)| place).collect()
}

/// Writes a random description.
struct Maker<'a> {
    random: &'a mut Random,
    b: Builder,
    contents: Contents,
}

impl Maker<'_> {
    fn number(&mut self, path: &str, low: f64, high: f64) -> ParamId {
        let value = self.random.between(low, high);
        self.b.number(path, value)
    }

    fn building(mut self) -> Description {
        for name in ["measured", "schedule", "set_point", "irradiance"] {
            self.b.channel(name);
        }
        let walls = self.constructions();
        let zones = 1 + self.random.below(6);
        for zone in 0..zones {
            self.zone(zone);
        }
        let count = (zones + 2).max(3 + self.random.below(23));
        for surface in 0..count {
            // Every zone has a wall of its own.
            let zone = if surface < zones { surface } else { self.random.below(zones) };
            let construction = self.random.of(&walls);
            self.wall(surface, construction, zone, zones, surface >= zones);
        }
        let windows = self.windows(zones);
        let mut d = core::mem::replace(&mut self.b, Builder::new()).describe();
        self.complete(&mut d, &windows);
        d
    }

    /// Materials and constructions of walls.
    fn constructions(&mut self) -> Vec<usize> {
        let mut solids = Vec::new();
        for (name, conductivity, density, heat) in [
            ("heavy", [0.8, 2.0], [1500.0, 2400.0], [800.0, 1000.0]),
            ("light", [0.025, 0.05], [20.0, 150.0], [1000.0, 1500.0]),
            ("board", [0.12, 0.3], [500.0, 1000.0], [900.0, 1800.0]),
        ] {
            let [k, rho, c] = [conductivity, density, heat].map(|[low, high]| self.random.between(low, high));
            solids.push(self.b.solid(name, k, rho, c));
        }
        let resistance = self.random.between(0.05, 1.0);
        let resistance = self.b.resistance("massless", resistance);
        let melting: Vec<usize> = (0..=self.random.below(3)).map(|k| self.melting(k)).collect();
        let count = 3 + self.random.below(4);
        (0..count)
            .map(|construction| {
                let layers: Vec<LayerOf> = (0..=self.random.below(4))
                    .map(|_| {
                        let (kind, nodes) = (self.random.between(0.0, 1.0), 1 + self.random.below(6));
                        if kind < 0.12 {
                            (resistance, 0.0, 0)
                        } else if kind < 0.35 {
                            let material = self.random.of(&melting);
                            (material, self.random.between(0.003, 0.03), nodes)
                        } else {
                            let material = self.random.of(&solids);
                            (material, self.random.between(0.005, 0.15), nodes)
                        }
                    })
                    .collect();
                self.b.construction(&format!("wall_{construction}"), &layers)
            })
            .collect()
    }

    fn melting(&mut self, index: usize) -> usize {
        let law = self.law();
        let mut pair = |low, high| {
            let one = self.random.between(low, high);
            [one, if self.random.chance(0.3) { one } else { self.random.between(low, high) }]
        };
        let numbers = [pair(0.15, 0.6), pair(1400.0, 3200.0)];
        let density = self.random.between(700.0, 1000.0);
        self.b.pcm(&format!("melting_{index}"), numbers, density, law)
    }

    fn law(&mut self) -> PcmLaw {
        let latent_heat = self.number("law.latent_heat", 3e4, 2e5);
        let (middle, width) = (self.random.between(18.0, 28.0), self.random.between(0.2, 3.0));
        let kind = self.random.below(8);
        if self.random.chance(0.15) {
            return self.table(middle, width);
        }
        let curve = self.curve(kind, middle, width);
        if self.random.chance(0.6) {
            return PcmLaw::Melting { latent_heat, curve };
        }
        let apart = self.random.between(0.2, 3.0);
        let model = self.random.of(&["curve_track", "curve_switch", "curve_scale", "supercooling"]);
        let (curves, numbers) = if model == "supercooling" {
            (vec![curve], self.supercooling(apart))
        } else {
            (vec![curve, self.curve(kind, middle - apart, width)], Vec::new())
        };
        PcmLaw::History { latent_heat, model: model.to_owned(), curves, numbers }
    }

    /// Numbers of a law of supercooling by a degree [K].
    fn supercooling(&mut self, degree: f64) -> Vec<FormulaNumber> {
        let (name, value) = if self.random.chance(0.5) {
            ("time_constant", self.random.between(30.0, 3600.0))
        } else {
            ("rate", self.random.between(1e-5, 1e-2))
        };
        [("degree", degree), (name, value)]
            .map(|(name, value)| FormulaNumber {
                name: name.to_owned(),
                value: self.b.number(&format!("hysteresis.{name}"), value),
            })
            .into()
    }

    fn curve(&mut self, kind: usize, middle: f64, width: f64) -> MeltingCurve {
        let melting_temperature = self.b.number("law.melting_temperature", middle);
        let (half, delta_t) = (self.b.number("law.width", width), self.b.number("law.delta_t", 0.01));
        match kind {
            0 => MeltingCurve::TanhWidth { melting_temperature, width: half },
            1 => {
                let gamma = self.b.number("law.gamma", 0.04 / width);
                MeltingCurve::TanhGamma { melting_temperature, gamma, delta_t }
            }
            2 => MeltingCurve::SmoothStep { melting_temperature, width: half, continuity: 1 },
            3 => MeltingCurve::SmoothStep { melting_temperature, width: half, continuity: 2 },
            4 => MeltingCurve::Gaussian { melting_temperature, width: half },
            5 => MeltingCurve::Gumbel { melting_temperature, width: half, tail: Tail::Low },
            6 => MeltingCurve::Linear { melting_temperature, width: half },
            _ => {
                let above = self.b.number("law.above", 0.5 * width);
                MeltingCurve::Triangle { melting_temperature, below: half, above }
            }
        }
    }

    fn table(&mut self, middle: f64, width: f64) -> PcmLaw {
        let temperatures: Vec<f64> =
            [-4.0, -1.0, -0.5, 0.0, 0.6, 1.0, 4.0].iter().map(|x| middle + x * width).collect();
        let points = if self.random.chance(0.5) {
            let mut enthalpy = 0.0;
            let load_sensitivities: Vec<f64> = temperatures
                .windows(2)
                .map(|pair| (pair[1] - pair[0]) * self.random.between(2e3, 4e4))
                .collect();
            let rising = load_sensitivities.into_iter().map(|rise| {
                enthalpy += rise;
                enthalpy
            });
            TablePoints::Enthalpies(core::iter::once(0.0).chain(rising).collect())
        } else {
            TablePoints::Capacities(temperatures.iter().map(|_| self.random.between(2e3, 4e4)).collect())
        };
        PcmLaw::Tabulated {
            melting_range: [temperatures[1], temperatures[5]],
            temperatures,
            points,
            temperature_shift: self.number("law.temperature_shift", -0.5, 0.5),
            enthalpy_scale: self.number("law.enthalpy_scale", 0.7, 1.3),
        }
    }

    fn zone(&mut self, index: usize) {
        let longwave = match self.random.below(3) {
            0 => ZoneLongwave::None,
            1 => ZoneLongwave::Radiosity,
            _ => ZoneLongwave::Linearised { reference: self.b.number("zone.reference", 20.0) },
        };
        let (volume, changes) = (self.random.between(5.0, 150.0), self.random.between(0.0, 1.5));
        self.b.zone(&format!("zone_{index}"), volume, changes, longwave);
    }

    /// A law of convection of a surface in a zone or outdoors. The laws of this list keep their draws, so that random buildings stay as they
    /// are; those that the table has beside them are drawn, too.
    fn convection(&mut self, outdoors: bool) -> Convection {
        let mut others = laws::convection();
        others
            .retain(|entry| !DRAWN.contains(&entry.kind) && (outdoors || entry.row.sides != Sides::Outdoors));
        if !others.is_empty() && self.random.chance(0.3) {
            let entry = self.random.of(&others);
            return self.of_table(&entry, outdoors);
        }
        let factor = self.number("convection.factor", 0.7, 1.4);
        let length = self.number("convection.length", 0.5, 4.0);
        let roughness = self.number("convection.roughness", 1.0, 2.1);
        let perimeter = self.number("convection.perimeter", 4.0, 20.0);
        let law = Convection::law;
        match self.random.below(if outdoors { 7 } else { 6 }) {
            0 => law("constant", &[("coefficient", self.number("convection.coefficient", 1.0, 20.0))]),
            1 => law("alamdari_hammond", &[("length", length), ("factor", factor)]),
            2 if outdoors => {
                law("tarp", &[("factor", factor), ("roughness", roughness), ("perimeter", perimeter)])
            }
            2 => law("tarp", &[("factor", factor)]),
            3 => {
                let wind = if outdoors { 3.0 } else { 0.0 };
                let mut law = |b: f64| [self.random.between(0.1, 2.0), b, 0.3, wind, 0.8];
                let (upward, downward) = (law(1.3), law(0.6));
                self.b.power(upward, downward)
            }
            4 if outdoors => {
                let constant = self.number("convection.constant", 3.0, 7.0);
                law(
                    "linear_wind",
                    &[("constant", constant), ("wind", self.number("convection.wind", 1.0, 5.0))],
                )
            }
            4 => law("guichard2016_eq5", &[("length", length), ("factor", factor)]),
            5 if outdoors => law("mowitt", &[("factor", factor)]),
            5 => law("iso15099", &[("length", length), ("factor", factor)]),
            _ => law("doe2", &[("factor", factor), ("roughness", roughness)]),
        }
    }

    /// A law of the table with numbers within their ranges.
    fn of_table(&mut self, LawEntry { kind, row, .. }: &LawEntry, outdoors: bool) -> Convection {
        let directions: &[&str] = if row.by_direction { &["upward.", "downward."] } else { &[""] };
        let mut numbers = Vec::new();
        for direction in directions {
            for number in row.numbers.iter().filter(|number| outdoors || !number.outdoors) {
                let (low, high) = match number.range {
                    LawRange::Percent(part, _) => {
                        (number.example * (1.0 - part / 100.0), number.example * (1.0 + part / 100.0))
                    }
                    LawRange::Within(half, _) => (number.example - half, number.example + half),
                    LawRange::Span(low, high, _) => (low, high),
                };
                let id = self.number(&format!("convection.{}", number.name), low, high);
                numbers.push((format!("{direction}{}", number.name), id));
            }
        }
        law(kind, &numbers)
    }

    fn inside(&mut self, zone: usize) -> Side {
        let (law, emissivity) = (self.convection(false), self.random.between(0.05, 0.95));
        let absorptance = Some(self.number("inside.absorptance", 0.2, 0.9));
        Side { absorptance, ..self.b.inside(zone, law, emissivity) }
    }

    fn outdoors(&mut self) -> Side {
        let (law, emissivity) = (self.convection(true), self.random.between(0.1, 0.95));
        let absorptance = self.random.between(0.2, 0.9);
        let mut side = self.b.outdoors(law, emissivity, absorptance);
        let passive = self.contents == Contents::ImposedTemperatures;
        side.exposure = Exposure {
            sun: !passive && self.random.chance(0.85),
            wind: self.random.chance(0.85),
            sky: !passive && self.random.chance(0.85),
        };
        side.longwave = match self.random.below(4) {
            0 => OutdoorLongwave::None,
            1 => OutdoorLongwave::Linearised { reference: self.b.number("outside.reference", 18.0) },
            _ => OutdoorLongwave::Exact,
        };
        if self.random.chance(0.2) {
            side.area_factor = Some(self.number("outside.area_factor", 1.0, 1.3));
        }
        if self.random.chance(0.2) {
            side.sky_view = Some(self.number("outside.sky_view", 0.2, 0.9));
        }
        if self.random.chance(0.3) {
            side.height = Some(self.number("outside.height", 1.0, 12.0));
        }
        if !passive && self.random.chance(0.1) {
            side.irradiance = Some(IRRADIANCE);
        }
        side
    }

    /// The side of a wall that is not the one in its own zone.
    fn other_side(&mut self, zone: usize, zones: usize, free: bool) -> Side {
        let convection = self.random.chance(0.5).then(|| self.random.between(2.0, 15.0));
        let convection = convection.map(|coefficient| self.b.convection(coefficient));
        match self.random.between(0.0, 1.0) {
            _ if !free => self.outdoors(),
            kind if kind < 0.4 => self.outdoors(),
            kind if kind < 0.65 && zones > 1 => {
                let other = (zone + 1 + self.random.below(zones - 1)) % zones;
                self.inside(other)
            }
            // Both surfaces in one zone.
            kind if kind < 0.7 => self.inside(zone),
            kind if kind < 0.8 => {
                let numbers = [
                    ("mean", self.number("ground.mean", 12.0, 18.0)),
                    ("amplitude", self.number("ground.amplitude", 0.0, 5.0)),
                    ("coldest_day", self.number("ground.coldest_day", 20.0, 60.0)),
                ];
                facing(Facing::imposed("ground", &numbers), convection)
            }
            kind if kind < 0.9 => facing(Facing::Measured { channel: MEASURED }, convection),
            _ => facing(Facing::Adiabatic, None),
        }
    }

    fn wall(&mut self, index: usize, construction: usize, zone: usize, zones: usize, free: bool) {
        let mut sides = [self.other_side(zone, zones, free), self.inside(zone)];
        if free && self.random.chance(0.15) {
            sides.reverse();
        }
        let area = self.random.between(2.0, 30.0);
        let tilts = [90.0, 90.0, 90.0, 0.0, 180.0, 25.0];
        let azimuth = if self.random.chance(0.5) {
            self.random.of(&[0.0, 90.0, 180.0, 270.0])
        } else {
            self.random.between(0.0, 360.0)
        };
        let place = [area, self.random.of(&tilts), azimuth];
        let [outside, inside] = sides;
        self.b.surface(&format!("surface_{index}"), construction, place, outside, inside);
    }

    /// Surfaces of windows: zone, and whether it is a frame. Their constructions follow in [`Self::complete`].
    fn windows(&mut self, zones: usize) -> Vec<Window> {
        let mut windows = Vec::new();
        for _ in 0..self.random.below(4) {
            let zone = self.random.below(zones);
            let (area, azimuth) = (self.random.between(0.4, 1.9), self.random.of(&[0.0, 90.0, 180.0, 270.0]));
            let fraction = self.random.chance(0.4).then(|| self.number("window.frame", 0.1, 0.3));
            let frames: &[bool] = if fraction.is_some() { &[false, true] } else { &[false] };
            let opening = self.random.chance(0.7);
            for &is_frame in frames {
                let (mut outside, mut inside) = (self.outdoors(), self.inside(zone));
                if !is_frame {
                    // Panes have optics of their own.
                    (outside.absorptance, inside.absorptance, outside.irradiance) = (None, None, None);
                }
                let place = [area, 90.0, azimuth];
                // The construction is corrected later.
                let surface = self.b.surface("window", 0, place, outside, inside);
                let frame = fraction.map(|fraction| FrameShare { fraction, is_frame });
                windows.push(Window { surface, zone, frame, opening: opening && !is_frame });
            }
        }
        windows
    }

    fn complete(&mut self, d: &mut Description, windows: &[Window]) {
        self.complete_site(d);
        let mut glass_area = None;
        for window in windows {
            let is_frame = window.frame.as_ref().is_some_and(|frame| frame.is_frame);
            d.surfaces[window.surface].construction = d.constructions.len();
            let construction = if is_frame { self.frame(d) } else { self.glass(d) };
            d.constructions.push(construction);
            let surface = &mut d.surfaces[window.surface];
            surface.frame.clone_from(&window.frame);
            if is_frame {
                // Both parts have the area of the whole window.
                surface.area = glass_area.expect("the glass comes before its frame");
                continue;
            }
            glass_area = Some(surface.area);
            let area = surface.area;
            if self.random.chance(0.8) {
                let height = number(d, "cavity_height", 1.4);
                d.surfaces[window.surface].cavity_height = Some(height);
            }
            let zone = Facing::Zone { zone: window.zone };
            // Walls are of 2 m2 at least, and each has room for one window.
            let host = d.surfaces.iter_mut().find(|surface| {
                surface.inside.facing == zone
                    && surface.outside.facing == Facing::Outdoors
                    && surface.openings.is_empty()
                    && surface.name != "window"
            });
            if let (Some(host), true) = (host, window.opening) {
                host.openings.push(area);
            }
        }
        for zone in 0..d.zones.len() {
            self.complete_zone(d, zone);
        }
        if d.zones.len() > 1 {
            for _ in 0..self.random.below(3) {
                let order = self.random.permutation(d.zones.len());
                let flow = number(d, "path.flow", self.random.between(0.0, 0.05));
                let schedule = self.random.chance(0.5).then_some(SCHEDULE);
                d.air_paths.push(AirPath {
                    name: "path".to_owned(),
                    between: [order[0], order[1]],
                    flow,
                    schedule,
                    density: None,
                    control: None,
                });
            }
        }
        for _ in 0..self.random.below(2) {
            let opening = Opening {
                name: "opening".to_owned(),
                zone: self.random.below(d.zones.len()),
                area: number(d, "opening.area", self.random.between(0.002, 0.1)),
                height: number(d, "opening.height", self.random.between(0.1, 1.5)),
                discharge: number(d, "opening.discharge", 0.6),
                wind_coefficient: number(d, "opening.wind_coefficient", 0.25),
                schedule: self.random.chance(0.5).then_some(SCHEDULE),
                control: None,
            };
            d.openings.push(opening);
        }
    }

    fn complete_site(&mut self, d: &mut Description) {
        if self.random.chance(0.5) {
            d.site.air_density = Some(number(d, "site.air_density", self.random.between(1.1, 1.25)));
        }
        // These models keep their draws, so that random buildings stay as they are; those that the tables have beside them are drawn, too.
        let kinds = ["perez", "hay_davies", "isotropic"];
        self.random.of(&kinds).clone_into(&mut d.site.diffuse);
        let others = laws::diffuse().into_iter().filter(|entry| !kinds.contains(&entry.kind));
        let others: Vec<_> = others.collect();
        if !others.is_empty() && self.random.chance(0.3) {
            self.random.of(&others).kind.clone_into(&mut d.site.diffuse);
        }
        let drawn = ["measured", "clark_allen", "brunt", "offset", "martin_berdahl"];
        let others: Vec<_> = laws::sky().into_iter().filter(|entry| !drawn.contains(&entry.kind)).collect();
        if !others.is_empty() && self.random.chance(0.3) {
            let LawEntry { kind, row, .. } = self.random.of(&others);
            let numbers = row.numbers.iter();
            let numbers: Vec<_> =
                numbers.map(|n| (n.name, number(d, &format!("site.sky.{}", n.name), n.example))).collect();
            d.site.sky = Sky::Law(PublishedLaw::new(kind, &numbers));
            return;
        }
        let mut put = |leaf: &'static str, value: f64| (leaf, number(d, &format!("site.sky.{leaf}"), value));
        let (kind, numbers) = match self.random.below(5) {
            0 => (drawn[0], vec![put("scale", 1.0)]),
            1 => (drawn[1], vec![put("a", 0.787), put("b", 0.764)]),
            2 => (drawn[2], vec![put("a", 0.618), put("b", 0.056)]),
            3 => (drawn[3], vec![put("depression", 9.0)]),
            _ => return,
        };
        d.site.sky = Sky::Law(PublishedLaw::new(kind, &numbers));
    }

    fn frame(&mut self, d: &mut Description) -> Construction {
        let u_value = number(d, "frame.u_value", self.random.between(1.0, 3.0));
        d.materials.push(Material::Rated { u_value });
        let material = d.materials.len() - 1;
        let layer = mascarin_engine::description::Layer {
            name: "frame".to_owned(),
            material,
            thickness: None,
            nodes: 0,
        };
        Construction { name: "frame".to_owned(), layers: vec![layer], glazing: None, blind: None }
    }

    fn glass(&mut self, d: &mut Description) -> Construction {
        let glazing = if self.random.chance(0.25) {
            Glazing::Simple {
                u_value: number(d, "glass.u_value", self.random.between(1.0, 3.0)),
                solar_heat_gain: number(d, "glass.solar_heat_gain", self.random.between(0.3, 0.75)),
                transmittance: None,
                panes: number(d, "glass.panes", 2.0),
                category: number(d, "glass.category", 4.0),
                surface_resistances: [
                    number(d, "glass.resistance", 0.04),
                    number(d, "glass.resistance", 0.13),
                ],
            }
        } else {
            let count = 1 + self.random.below(3);
            let panes = (0..count).map(|_| self.pane(d)).collect();
            let gaps = (1..count).map(|_| self.gap(d)).collect();
            Glazing::Panes { panes, gaps, angular: None }
        };
        Construction { name: "glass".to_owned(), layers: Vec::new(), glazing: Some(glazing), blind: None }
    }

    fn pane(&mut self, d: &mut Description) -> Pane {
        let coated = self.random.chance(0.4);
        let mut put = |leaf: &str, value: f64| number(d, &format!("panes.{leaf}"), value);
        Pane {
            thickness: put("thickness", self.random.between(0.003, 0.01)),
            conductivity: put("conductivity", 1.0),
            storage: self.random.chance(0.5).then(|| [put("density", 2500.0), put("specific_heat", 750.0)]),
            emissivity: [
                put("emissivity.outside", if coated { 0.1 } else { 0.84 }),
                put("emissivity.inside", 0.84),
            ],
            optics: Some(PaneOptics {
                transmittance: put("transmittance", self.random.between(0.4, 0.85)),
                reflectance: [put("reflectance.outside", 0.09), put("reflectance.inside", 0.08)],
                coated,
            }),
        }
    }

    fn gap(&mut self, d: &mut Description) -> Gap {
        if self.random.chance(0.3) {
            return Gap::Given { conductance: number(d, "gap.conductance", self.random.between(2.0, 6.0)) };
        }
        Gap::Filled {
            thickness: number(d, "gap.thickness", self.random.between(0.006, 0.02)),
            pressure: number(d, "gap.pressure", 101_325.0),
            gas: self.random.of(&[Gas::Air, Gas::Argon, Gas::Krypton, Gas::Xenon]),
        }
    }

    /// What acts on the air of a zone, and where its sun arrives.
    fn complete_zone(&mut self, d: &mut Description, zone: usize) {
        if self.random.chance(0.3) {
            let mut surfaces = Vec::new();
            for (surface, _) in sides_of(d, zone) {
                let glass = d.constructions[d.surfaces[surface].construction].glazing.is_some();
                let absorbs = !glass && self.random.chance(0.8);
                surfaces.push(absorbs.then(|| number(d, "sun.share", self.random.between(0.05, 1.0))));
            }
            d.zones[zone].sun = ZoneSun::Shares {
                surfaces,
                lost: Some(number(d, "sun.lost", self.random.between(0.01, 0.2))),
                diffuse: None,
            };
        }
        let put = |d: &mut Description, id: ParamId, value: f64| d.parameters[id.0 as usize].value = value;
        let given = d.zones[zone].clone();
        put(d, given.capacity_factor, self.random.between(1.0, 8.0));
        if self.random.chance(0.5) {
            put(d, given.infiltration.temperature, self.random.between(0.0, 0.03));
            put(d, given.infiltration.wind, self.random.between(0.0, 0.15));
        }
        for _ in 0..self.random.below(2) {
            let schedule = self.random.chance(0.7).then_some(SCHEDULE);
            let by_volume = self.random.chance(0.5);
            let amount =
                number(d, "ventilation", self.random.between(0.0, if by_volume { 4.0 } else { 0.1 }));
            d.zones[zone].ventilation.push(Ventilation {
                name: "ventilation".to_owned(),
                air_changes: by_volume.then_some(amount),
                flow: (!by_volume).then_some(amount),
                schedule,
                control: None,
                density: None,
            });
        }
        if self.contents == Contents::ImposedTemperatures {
            return;
        }
        for _ in 0..self.random.below(3) {
            let gain = Gain {
                name: "gain".to_owned(),
                power: number(d, "gain.power", self.random.between(10.0, 300.0)),
                radiative: number(d, "gain.radiative", self.random.between(0.0, 1.0)),
                activity: None,
                schedule: self.random.chance(0.6).then_some(SCHEDULE),
            };
            d.zones[zone].gains.push(gain);
        }
        let heating = self.random.between(18.0, 23.0);
        if self.random.chance(0.35) {
            d.zones[zone].heating = Some(self.ideal_load(d, heating, "heating"));
        }
        if self.random.chance(0.3) {
            let cooling = heating + self.random.between(0.5, 4.0);
            d.zones[zone].cooling = Some(self.ideal_load(d, cooling, "cooling"));
        }
    }

    fn ideal_load(&mut self, d: &mut Description, temperature: f64, name: &str) -> IdealLoad {
        // The scheduled set point is below every one of cooling.
        let scheduled = name == "heating" && temperature < 19.5;
        let setpoint = if scheduled {
            SetPoint::Scheduled { channel: SET_POINT }
        } else {
            SetPoint::Constant { temperature: number(d, &format!("{name}.setpoint"), temperature.max(21.0)) }
        };
        let capacity = if self.random.chance(0.6) {
            Some(number(d, &format!("{name}.capacity"), self.random.between(50.0, 3000.0)))
        } else {
            None
        };
        IdealLoad {
            setpoint,
            capacity,
            radiative: None,
            schedule: self.random.chance(0.3).then_some(SCHEDULE),
        }
    }
}

/// A window's surface, before the description is complete.
struct Window {
    surface: usize,
    zone: usize,
    frame: Option<FrameShare>,
    /// Whether its area is taken from a wall.
    opening: bool,
}

fn number(d: &mut Description, path: &str, value: f64) -> ParamId {
    d.parameters.push(Parameter { path: path.to_owned(), value });
    ParamId(u32::try_from(d.parameters.len() - 1).unwrap())
}
