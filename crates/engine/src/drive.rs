//! What acts on the building at one instant: forcing turned into numbers at each face.

use crate::coefficients::{Boundary, Coefficients, Face, Imposed, Outdoors};
use crate::convection::{Film, Forced, Wind};
use crate::forcing::{Forcing, channel};
use crate::parameters::Values;
use crate::plan::Plan;
use crate::radiation::{Heaven, sky_emission};
use crate::real::Real;
use crate::solar::Sunlight;
use crate::zone::ZoneDrive;

/// A face is leeward when the wind comes from behind its plane (Walton 1983 draws the line at 100 deg off the normal,
/// where the wind blows along the face and the windward coefficient has no ground any more).
const LEEWARD_COSINE: f64 = 0.0;
/// Faces within about 11 deg of horizontal are always windward (Walton 1983).
const FLAT: f64 = 0.98;

/// The weather at one stage, worked out as far as it is the same for all members.
#[derive(Debug, Clone, Copy)]
pub struct Instant<'a> {
    /// All channels.
    pub row: &'a [f64],
    sunlight: Sunlight,
    heaven: Heaven,
    wind: Wind,
    /// North and east components of the direction the wind comes from.
    wind_from: [f64; 2],
}

impl<'a> Instant<'a> {
    /// Reads a forcing row.
    #[must_use]
    pub fn new(plan: &Plan, row: &'a [f64]) -> Self {
        let from = row[channel::WIND_DIRECTION].to_radians();
        Self {
            row,
            sunlight: Sunlight::new(row, plan.description.site.diffuse),
            heaven: Heaven::new(&plan.description.site.sky, row),
            wind: Wind::new(row[channel::WIND_SPEED]),
            wind_from: [from.cos(), from.sin()],
        }
    }
}

/// The weather of all stages of a run.
#[derive(Debug)]
pub struct Weather<'a> {
    instants: Vec<Instant<'a>>,
    stages: usize,
}

impl<'a> Weather<'a> {
    /// Reads a forcing.
    #[must_use]
    pub fn new(plan: &Plan, forcing: &Forcing<'a>) -> Self {
        let stages = forcing.stages();
        let instants = (0..forcing.steps() * stages)
            .map(|k| Instant::new(plan, forcing.at(k / stages, k % stages)))
            .collect();
        Self { instants, stages }
    }

    /// Number of steps.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.instants.len() / self.stages
    }

    /// The weather at a stage of a step.
    #[must_use]
    pub fn at(&self, step: usize, stage: usize) -> &Instant<'a> {
        &self.instants[step * self.stages + stage]
    }
}

/// Numbers at a face.
#[derive(Debug, Clone, Copy)]
pub struct FaceDrive<S: Real> {
    /// Absorbed short-wave radiation [W/m2].
    pub solar: S,
    /// Long-wave radiation absorbed from sky, air and ground [W/m2].
    pub longwave: S,
    /// Temperature of the air, or the imposed temperature [degC].
    pub temperature: S,
    /// What the wind makes of the film.
    pub forced: Forced<S>,
}

/// Numbers at all faces and outdoors.
#[derive(Debug, Clone)]
pub struct Drive<S: Real> {
    /// Per face.
    pub faces: Vec<FaceDrive<S>>,
    /// Per zone.
    pub zones: Vec<ZoneDrive<S>>,
    /// Heat carried between two zones, per path [W/K].
    pub paths: Vec<S>,
    /// Outdoor air [degC].
    pub outdoor_air: S,
    /// Wind at the mast [m/s].
    pub wind: S,
}

impl<S: Real> Drive<S> {
    /// A place for the numbers of a building, in still air.
    #[must_use]
    pub fn new(coefficients: &Coefficients<S>) -> Self {
        let zero = S::zero();
        let faces = coefficients.faces.iter().map(|face| {
            let forced = face.film.as_ref().map_or([zero; 2], Film::still);
            FaceDrive { solar: zero, longwave: zero, temperature: zero, forced }
        });
        Self {
            faces: faces.collect(),
            zones: coefficients.zones.iter().map(ZoneDrive::new).collect(),
            paths: vec![zero; coefficients.paths.len()],
            outdoor_air: zero,
            wind: zero,
        }
    }

    /// Numbers on the straight line through those of two moments, at a share of the way from the first to the second.
    ///
    /// What is no energy but a rate (films, wind) does not fall below zero beyond them.
    pub fn between(&mut self, first: &Self, second: &Self, share: f64) {
        let line = |a: S, b: S| a + (b - a).scale(share);
        let rate = |a: S, b: S| line(a, b).max(S::zero());
        for (at, (a, b)) in self.faces.iter_mut().zip(first.faces.iter().zip(&second.faces)) {
            at.solar = line(a.solar, b.solar);
            at.longwave = line(a.longwave, b.longwave);
            at.temperature = line(a.temperature, b.temperature);
            at.forced = [rate(a.forced[0], b.forced[0]), rate(a.forced[1], b.forced[1])];
        }
        for (at, (a, b)) in self.zones.iter_mut().zip(first.zones.iter().zip(&second.zones)) {
            at.between(a, b, share);
        }
        for (at, (&a, &b)) in self.paths.iter_mut().zip(first.paths.iter().zip(&second.paths)) {
            *at = rate(a, b);
        }
        self.outdoor_air = line(first.outdoor_air, second.outdoor_air);
        self.wind = rate(first.wind, second.wind);
    }

    /// Turns the weather into numbers at each face.
    #[inline(always)]
    pub fn update(&mut self, plan: &Plan, coefficients: &Coefficients<S>, numbers: &[S], now: &Instant<'_>) {
        let site = &plan.description.site;
        let sky = sky_emission(&Values::new(numbers), &site.sky, coefficients.cloud, &now.heaven);
        self.outdoor_air = S::constant(now.row[channel::AIR_TEMPERATURE]);
        self.wind = S::constant(now.wind.speed);
        for (at, face) in self.faces.iter_mut().zip(&coefficients.faces) {
            let measured = face.irradiance.map(
                #[inline(always)]
                |channel| S::constant(now.row[channel]),
            );
            if let Boundary::Outdoors(outdoors) = &face.boundary {
                let irradiance = match measured {
                    Some(irradiance) => irradiance,
                    None if !face.exposure.sun => S::zero(),
                    None => now.sunlight.on(&outdoors.plane, coefficients.ground_reflectance),
                };
                at.solar = face.absorptance * irradiance;
                at.longwave = face.emissivity * incoming_longwave(outdoors, sky, self.outdoor_air);
                at.temperature = self.outdoor_air;
                if face.exposure.wind {
                    at.forced = forced(face, outdoors, now);
                }
            } else if let Some(irradiance) = measured {
                at.solar = face.absorptance * irradiance;
            }
            if let Boundary::Imposed(imposed) = &face.boundary {
                at.temperature = imposed_temperature(imposed, now.row);
            }
        }
        for (at, zone) in self.zones.iter_mut().zip(&coefficients.zones) {
            at.update(zone, now.row);
        }
        for (at, path) in self.paths.iter_mut().zip(&coefficients.paths) {
            *at = path.conductance(now.row);
        }
    }
}

/// `F_sky (beta E_sky + (1 - beta) E_air) + F_ground E_air`, `beta = sqrt(F_sky)`; the ground is at air temperature.
#[inline(always)]
fn incoming_longwave<S: Real>(outdoors: &Outdoors<S>, sky: S, air: S) -> S {
    let Some(emission) = &outdoors.emission else { return S::zero() };
    let from_air = emission.at(air).0;
    from_air + outdoors.to_sky * (sky - from_air)
}

#[inline(always)]
fn forced<S: Real>(face: &Face<S>, outdoors: &Outdoors<S>, now: &Instant<'_>) -> Forced<S> {
    let Some(film) = &face.film else { return [S::zero(); 2] };
    let [north, east] = now.wind_from;
    let facing = outdoors.heading[0].scale(north) + outdoors.heading[1].scale(east);
    let onto = S::constant(LEEWARD_COSINE).lt(facing);
    let flat = S::constant(FLAT).lt(face.upward.abs());
    film.forced(&now.wind, onto | flat)
}

#[inline(always)]
fn imposed_temperature<S: Real>(imposed: &Imposed<S>, row: &[f64]) -> S {
    match imposed {
        Imposed::Channel(channel) => S::constant(row[*channel]),
        Imposed::Annual { mean, amplitude, coldest } => {
            let phase =
                (S::constant(row[channel::DAY_OF_YEAR]) - *coldest).scale(core::f64::consts::TAU / 365.0);
            *mean - *amplitude * phase.cos()
        }
    }
}
