//! What acts on the building at one instant: forcing turned into numbers at each face.

use crate::coefficients::{Boundary, Coefficients, Face, Imposed, Outdoors};
use crate::convection::FilmAir;
use crate::forcing::channel;
use crate::parameters::Values;
use crate::plan::Plan;
use crate::radiation::sky_emission;
use crate::real::Real;
use crate::solar::Sunlight;

/// A face is leeward when the wind comes from behind its plane (Walton 1983 draws the line at 100 deg off the normal,
/// where the wind blows along the face and the windward coefficient has no ground any more).
const LEEWARD_COSINE: f64 = 0.0;
/// Faces within about 11 deg of horizontal are always windward (Walton 1983).
const FLAT: f64 = 0.98;

/// Numbers at a face.
#[derive(Debug, Clone, Copy)]
pub struct FaceDrive<S: Real> {
    /// Absorbed short-wave radiation [W/m2].
    pub solar: S,
    /// Long-wave radiation absorbed from sky, air and ground [W/m2].
    pub longwave: S,
    /// Temperature of the air, or the imposed temperature [degC].
    pub temperature: S,
    /// State of the air for the film.
    pub air: FilmAir<S>,
}

/// Numbers at all faces and outdoors.
#[derive(Debug, Clone)]
pub struct Drive<S: Real> {
    /// Per face.
    pub faces: Vec<FaceDrive<S>>,
    /// Outdoor air [degC].
    pub outdoor_air: S,
    /// Wind at the mast [m/s].
    pub wind: S,
}

impl<S: Real> Drive<S> {
    /// Evaluates a forcing row.
    #[must_use]
    pub fn new(plan: &Plan, coefficients: &Coefficients<S>, numbers: &[S], row: &[f64]) -> Self {
        let site = &plan.description.site;
        let sunlight = Sunlight::new(row, site.diffuse);
        let sky = sky_emission(&Values::new(numbers), &site.sky, coefficients.cloud, row);
        let outdoor_air = S::constant(row[channel::AIR_TEMPERATURE]);
        let wind = S::constant(row[channel::WIND_SPEED]);
        let faces = coefficients.faces.iter().map(|face| {
            let measured = face.irradiance.map(|channel| S::constant(row[channel]));
            match &face.boundary {
                Boundary::Outdoors(outdoors) => {
                    let irradiance = measured
                        .unwrap_or_else(|| sunlight.on(&outdoors.plane, coefficients.ground_reflectance));
                    FaceDrive {
                        solar: face.absorptance * irradiance,
                        longwave: face.emissivity * incoming_longwave(outdoors, sky, outdoor_air),
                        temperature: outdoor_air,
                        air: outdoor_film(face, outdoors, row),
                    }
                }
                Boundary::Imposed(imposed) => FaceDrive {
                    temperature: imposed_temperature(imposed, row),
                    ..FaceDrive::sheltered(face, measured)
                },
                Boundary::Zone | Boundary::Adiabatic => FaceDrive::sheltered(face, measured),
            }
        });
        Self { faces: faces.collect(), outdoor_air, wind }
    }
}

impl<S: Real> FaceDrive<S> {
    /// A face out of the weather.
    fn sheltered(face: &Face<S>, irradiance: Option<S>) -> Self {
        Self {
            solar: irradiance.map_or_else(S::zero, |irradiance| face.absorptance * irradiance),
            longwave: S::zero(),
            temperature: S::zero(),
            air: FilmAir::still(face.upward),
        }
    }
}

/// `F_sky (beta E_sky + (1 - beta) E_air) + F_ground E_air`, beta = `sqrt(F_sky)`; the ground is at air temperature.
fn incoming_longwave<S: Real>(outdoors: &Outdoors<S>, sky: S, air: S) -> S {
    let Some(emission) = &outdoors.emission else { return S::zero() };
    let from_air = emission.at(air).0;
    let view = outdoors.plane.sky_view;
    let to_sky = view * view.max(S::zero()).sqrt();
    to_sky * sky + (S::one() - to_sky) * from_air
}

fn outdoor_film<S: Real>(face: &Face<S>, outdoors: &Outdoors<S>, row: &[f64]) -> FilmAir<S> {
    let from = row[channel::WIND_DIRECTION].to_radians();
    let facing = outdoors.heading[0].scale(from.cos()) + outdoors.heading[1].scale(from.sin());
    let onto = S::constant(LEEWARD_COSINE).lt(facing);
    let flat = S::constant(FLAT).lt(face.upward.abs());
    FilmAir {
        upward: face.upward,
        wind: outdoors.wind_factor.scale(row[channel::WIND_SPEED]),
        windward: onto | flat,
    }
}

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
