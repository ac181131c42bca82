//! Sun that windows between zones let pass.
//!
//! Each such window is passed in two directions. What passes is diffuse: it is distributed in the zone that it enters, and a
//! part of it passes on or back. The powers `x` that pass satisfy `x = c + K x`: `c` is what passes of the sun that enters
//! through other windows, `K` what passes of a watt that has passed before. The inverse of `I - K` is computed once per run.

use super::wall::WallCoefficients;
use super::zone::ZoneCoefficients;
use crate::building::passages::Passage;
use crate::building::plan::Plan;
use crate::building::solar_distribution::SolarDistribution;
use crate::number::dense::solve_many;
use crate::number::real::Real;

/// What passes through windows between zones.
#[derive(Debug, Clone)]
pub struct Passing<S> {
    /// Power that passes per irradiance of the side that it comes from, for each passage [m2].
    pub areas: Vec<S>,
    /// Power that passes in the end per power that passes first, by row [-].
    pub multiples: Vec<S>,
}

impl<S: Real> Passing<S> {
    /// Evaluates the passages of a building.
    pub(crate) fn new(plan: &Plan, walls: &[WallCoefficients<S>], zones: &[ZoneCoefficients<S>]) -> Self {
        let passages = &plan.passages;
        let area = |passage: &Passage| {
            let wall = &walls[plan.windows[passage.window]];
            let surface = plan.zones[passage.from.0].surfaces[passage.from.1];
            wall.glass.as_ref().map_or_else(S::zero, |glass| wall.area * glass.facing(surface).transmittance)
        };
        let areas: Vec<S> = passages.iter().map(area).collect();
        let n = passages.len();
        let (mut matrix, mut multiples) = (vec![S::zero(); n * n], vec![S::zero(); n * n]);
        for (p, passage) in passages.iter().enumerate() {
            multiples[p * n + p] = S::one();
            for (q, before) in passages.iter().enumerate() {
                let own = if p == q { S::one() } else { S::zero() };
                let again = if passage.from.0 == before.to.0 {
                    let zone = &zones[before.to.0];
                    zone.solar_distribution.as_ref().map_or_else(S::zero, |distribution| {
                        areas[p] * irradiance(distribution, passage.from.1, before.to.1)
                    })
                } else {
                    S::zero()
                };
                matrix[p * n + q] = own - again;
            }
        }
        if n > 0 {
            solve_many(&mut matrix, &mut multiples, n);
        }
        Self { areas, multiples }
    }
}

/// Irradiance of a surface of a zone by a watt of diffuse sun that enters through another one [1/m2].
fn irradiance<S: Real>(distribution: &SolarDistribution<S>, surface: usize, entrance: usize) -> S {
    match distribution {
        SolarDistribution::Fixed(fixed) | SolarDistribution::Split([_, fixed]) => fixed.on_glass[surface],
        SolarDistribution::Traced(traced) => {
            let n = traced.size();
            traced.irradiance(surface, &traced.views[entrance * n..(entrance + 1) * n])
        }
    }
}
