//! What programs without Python need of a run: the building, how it is run, the weather, and the variables. `python/mascarin/fmu` writes
//! it; a unit for co-simulation and a page whose model runs in the browser read it.

use mascarin_engine::Scheme;
use mascarin_engine::description::Description;
use mascarin_engine::forcing::{Forcing, channel};
use mascarin_engine::plan::Plan;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::{Options, Warmup};
use mascarin_engine::state::Initial;
use serde::Deserialize;

/// Number of the format that this library reads.
const FORMAT: u32 = 2;
/// First bytes of the file with the weather.
const MAGIC: &[u8; 8] = b"MASCARIN";
/// How far heating may be set above cooling, from rounding [K].
const APART: f64 = 1e-9;

/// A variable; its value reference in a unit is its position in the list, counted from 1. Time has 0.
#[derive(Debug, Clone, Deserialize)]
pub struct Variable {
    /// Its name.
    pub name: String,
    /// Its unit, for messages.
    pub unit: String,
    /// What it is.
    pub role: Role,
    /// Lowest value.
    pub low: Option<f64>,
    /// Highest value.
    pub high: Option<f64>,
    /// Value before any other is set; zero for an output.
    pub start: f64,
}

/// What a variable is.
#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// A channel of the forcing.
    Input(usize),
    /// A record of the engine.
    Output(usize),
    /// A number of the parameter vector.
    Parameter(usize),
}

/// A set point: a channel of the forcing, or a number of the parameter vector.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SetPoint {
    /// A channel.
    Channel(usize),
    /// A parameter.
    Parameter(usize),
}

/// A zone that is heated and cooled.
#[derive(Debug, Clone, Deserialize)]
pub struct Conditioned {
    /// Its name.
    pub zone: String,
    /// Set point of heating.
    pub heating: SetPoint,
    /// Set point of cooling.
    pub cooling: SetPoint,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Start {
    Everywhere(f64),
    Given { cells: Vec<f64>, faces: Vec<f64>, air: Vec<f64> },
}

#[derive(Deserialize)]
struct Settings {
    dt: f64,
    scheme: String,
    initial: Start,
    warmup_steps: usize,
    warmup_tolerance: f64,
    warmup_max_cycles: usize,
}

/// The file `run.json`.
#[derive(Deserialize)]
struct Header {
    format: u32,
    token: String,
    settings: Settings,
    outputs: Vec<Output>,
    variables: Vec<Variable>,
    conditioned: Vec<Conditioned>,
    global_follows: bool,
}

/// What is in a unit or a page.
#[derive(Debug)]
pub struct Contents {
    /// What the model description and the importing program call this unit.
    pub token: String,
    /// The building.
    pub plan: Plan,
    /// Step, scheme, start, outputs.
    pub options: Options,
    /// All variables but time.
    pub variables: Vec<Variable>,
    /// Zones whose set points must not cross.
    pub conditioned: Vec<Conditioned>,
    /// Whether the global radiation follows from the beam and diffuse radiation that are inputs.
    pub global_follows: bool,
    /// The parameter vector.
    pub parameters: Vec<f64>,
    forcing: Vec<f64>,
    stages: usize,
}

impl Contents {
    /// Reads the three files.
    ///
    /// # Errors
    /// A file is damaged or of another version: its name, and what is wrong with it.
    pub fn read(run: &str, building: &str, forcing: &[u8]) -> Result<Self, (&'static str, String)> {
        let damaged = |name, error: &dyn core::fmt::Display| (name, format!("is damaged: {error}"));
        let header: serde_json::Value =
            serde_json::from_str(run).map_err(|error| damaged("run.json", &error))?;
        if header.get("format").and_then(serde_json::Value::as_u64) != Some(u64::from(FORMAT)) {
            return Err(damaged("run.json", &format!("it does not have format {FORMAT}")));
        }
        let header: Header = serde_json::from_value(header).map_err(|error| damaged("run.json", &error))?;
        let description: Description =
            serde_json::from_str(building).map_err(|error| damaged("building.json", &error))?;
        let parameters = description.parameters.iter().map(|parameter| parameter.value).collect();
        let plan = Plan::new(description).map_err(|error| damaged("building.json", &error))?;
        let options =
            options(header.settings, header.outputs).map_err(|error| damaged("run.json", &error))?;
        let stages = options.scheme.weights().len();
        let forcing = unpack(forcing, stages, plan.n_channels())
            .ok_or_else(|| damaged("forcing.bin", &"its size does not fit the building"))?;
        let contents = Self {
            token: header.token,
            plan,
            options,
            variables: header.variables,
            conditioned: header.conditioned,
            global_follows: header.global_follows,
            parameters,
            forcing,
            stages,
        };
        contents.check().map_err(|error| damaged("run.json", &error))?;
        debug_assert_eq!(header.format, FORMAT);
        Ok(contents)
    }

    /// Positions that are not those of this building would otherwise be noticed in a step only.
    fn check(&self) -> Result<(), String> {
        let (channels, parameters, outputs) =
            (self.plan.n_channels(), self.parameters.len(), self.options.outputs.len());
        for variable in &self.variables {
            let fits = match &variable.role {
                Role::Input(channel) => *channel < channels,
                Role::Parameter(parameter) => *parameter < parameters,
                Role::Output(output) => *output < outputs,
            };
            if !fits {
                return Err(format!("the variable '{}' is not one of the building", variable.name));
            }
        }
        let known = |point: SetPoint| match point {
            SetPoint::Channel(channel) => channel < channels,
            SetPoint::Parameter(parameter) => parameter < parameters,
        };
        if self.conditioned.iter().any(|zone| !(known(zone.heating) && known(zone.cooling))) {
            return Err("a set point is not one of the building".to_owned());
        }
        self.options.outputs.iter().try_for_each(|output| output.check(&self.plan)).map_err(|e| e.to_string())
    }

    /// Refuses values with which heating would be set above cooling.
    ///
    /// # Errors
    /// The zone, both set points, and the time of the first such step.
    pub fn require_set_points_apart(&self, parameters: &[f64]) -> Result<(), String> {
        if self.conditioned.is_empty() {
            return Ok(());
        }
        (0..self.steps()).try_for_each(|step| self.require_apart_in(self.rows(step, 1), parameters, step))
    }

    /// The same for the weather of one step.
    ///
    /// # Errors
    /// As [`Self::require_set_points_apart`].
    pub fn require_apart_in(&self, rows: &[f64], parameters: &[f64], step: usize) -> Result<(), String> {
        let last = rows.len() - self.plan.n_channels();
        let value = |point: SetPoint| match point {
            SetPoint::Channel(channel) => rows[last + channel],
            SetPoint::Parameter(parameter) => parameters[parameter],
        };
        for zone in &self.conditioned {
            let (heating, cooling) = (value(zone.heating), value(zone.cooling));
            if heating > cooling + APART {
                return Err(format!(
                    "zones.{}: found heating to {heating} degC above cooling to {cooling} degC at {} s; lower the one \
                     or raise the other",
                    zone.zone,
                    step as f64 * self.options.dt
                ));
            }
        }
        Ok(())
    }

    /// Steps that there is weather for.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.forcing.len() / self.row()
    }

    /// Numbers of a step: stages x channels.
    fn row(&self) -> usize {
        self.stages * self.plan.n_channels()
    }

    /// Stages of a step.
    #[must_use]
    pub fn stages(&self) -> usize {
        self.stages
    }

    /// The weather of some steps, which must be there.
    #[must_use]
    pub fn rows(&self, first: usize, steps: usize) -> &[f64] {
        &self.forcing[first * self.row()..(first + steps) * self.row()]
    }

    /// As the engine reads it.
    ///
    /// # Errors
    /// The numbers are not some steps.
    pub fn forcing<'f>(&self, rows: &'f [f64]) -> Result<Forcing<'f>, String> {
        Forcing::new(rows, self.stages, self.plan.n_channels()).map_err(|error| error.to_string())
    }

    /// Writes inputs into the weather of a step, the same in all stages.
    pub fn put(&self, inputs: &[(usize, f64)], rows: &mut [f64]) {
        for row in rows.chunks_mut(self.plan.n_channels()) {
            for &(channel, value) in inputs {
                row[channel] = value;
            }
            if self.global_follows {
                let beam = row[channel::DIRECT_NORMAL] * row[channel::SUN_UP].max(0.0);
                row[channel::GLOBAL_HORIZONTAL] = beam + row[channel::DIFFUSE_HORIZONTAL];
            }
        }
    }
}

fn options(settings: Settings, outputs: Vec<Output>) -> Result<Options, String> {
    let scheme = match settings.scheme.as_str() {
        "sdirk2" => Scheme::Sdirk2,
        "linearly-implicit" => Scheme::LinearlyImplicit,
        "backward-euler" => Scheme::BackwardEuler,
        "apparent-capacity" => Scheme::ApparentCapacity,
        other => return Err(format!("unknown scheme '{other}'")),
    };
    let initial = match settings.initial {
        Start::Everywhere(temperature) => Initial::Everywhere(temperature),
        Start::Given { cells, faces, air } => Initial::Given { cells, surfaces: faces, air },
    };
    if !(settings.dt > 0.0 && settings.dt.is_finite()) {
        return Err(format!("a step of {} s", settings.dt));
    }
    Ok(Options {
        dt: settings.dt,
        lengths: None,
        scheme,
        initial,
        warmup: (settings.warmup_steps > 0).then_some(Warmup {
            steps: settings.warmup_steps,
            tolerance: settings.warmup_tolerance,
            max_cycles: settings.warmup_max_cycles,
        }),
        outputs,
        record_from: 0,
        record_every: 1,
        residuals: false,
    })
}

/// The weather as steps x stages x channels, from a file that has channels x steps x stages; none where it has another size.
///
/// Numbers of one channel resemble each other, so that they are packed tighter when they stand side by side.
fn unpack(bytes: &[u8], stages: usize, channels: usize) -> Option<Vec<f64>> {
    let numbers = bytes.strip_prefix(MAGIC)?;
    let (numbers, rest) = numbers.as_chunks::<8>();
    let instants = numbers.len() / channels;
    if !rest.is_empty()
        || instants == 0
        || instants * channels != numbers.len()
        || !instants.is_multiple_of(stages)
    {
        return None;
    }
    let mut forcing = vec![0.0; numbers.len()];
    for (channel, course) in numbers.chunks(instants).enumerate() {
        for (instant, bytes) in course.iter().enumerate() {
            forcing[instant * channels + channel] = f64::from_le_bytes(*bytes);
        }
    }
    Some(forcing)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two steps of two stages of three channels: channel 1 of the last stage is the number 23.
    #[test]
    fn the_weather_is_turned() {
        let mut bytes = MAGIC.to_vec();
        for channel in 0..3 {
            for instant in 0..4 {
                bytes.extend(f64::to_le_bytes(f64::from(10 * (channel + 1) + instant)));
            }
        }
        let forcing = unpack(&bytes, 2, 3).unwrap();
        assert_eq!(forcing[..4], [10.0, 20.0, 30.0, 11.0]);
        assert_eq!(forcing[3 * 3 + 1], 23.0);
        assert!(unpack(&bytes, 3, 3).is_none() && unpack(&bytes[..bytes.len() - 1], 2, 3).is_none());
        assert!(unpack(b"other", 2, 3).is_none());
    }
}
