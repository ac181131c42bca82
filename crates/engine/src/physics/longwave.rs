//! Long-wave radiation: exchange inside a zone, sky and ground outside.
//!
//! Sources:
//! - Exchange in an enclosure of grey diffuse surfaces: Hottel & Sarofim (1967), Radiative Transfer, ch. 3.
//! - View factors from areas: the symmetric form of Carroll's mean-radiant-temperature network
//!   (Carroll 1980, Energy and Buildings 3(2), 101-112).
//! - Sky: Clark & Allen (1978); Martin & Berdahl (1984), Solar Energy 33(3), doi:10.1016/0038-092X(84)90162-2;
//!   Brunt (1932), doi:10.1002/qj.49705824704; recalibrated by Li, Jiang & Coimbra (2017), Solar Energy 144,
//!   doi:10.1016/j.solener.2017.01.006; clouds: Clark & Allen (1978).
//! - Split of the sky by `sqrt(F_sky)` between sky and air: Walton (1983), NBSSIR 83-2655.

use crate::input::description::Sky;
use crate::input::forcing::channel;
use crate::input::values::Values;
use crate::number::dense::solve_many;
use crate::number::real::{Real, same};
use crate::physics::constants::{KELVIN, SIGMA};

/// Sinkhorn sweeps: each halves the imbalance or better; rooms reach round-off in about thirty.
const SCALING_SWEEPS: usize = 200;

/// Black emission at a temperature in degC, as value and slope at `at`, exact or linearised.
#[derive(Debug, Clone, Copy)]
pub enum Emission<S> {
    /// sigma T^4.
    Exact,
    /// Tangent at a reference temperature [degC].
    Linearised(S),
}

impl<S: Real> Emission<S> {
    /// Whether another law is this one.
    pub(crate) fn same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Exact, Self::Exact) => true,
            (Self::Linearised(mine), Self::Linearised(theirs)) => same(*mine, *theirs),
            _ => false,
        }
    }

    /// (sigma T^4, its slope) [W/m2, W/(m2 K)].
    #[inline(always)]
    pub fn at(&self, temperature: S) -> (S, S) {
        let kelvin = |t: S| t + S::constant(KELVIN);
        match self {
            Self::Exact => {
                let t = kelvin(temperature);
                let cube = t * t * t;
                ((cube * t).scale(SIGMA), cube.scale(4.0 * SIGMA))
            }
            Self::Linearised(reference) => {
                let t = kelvin(*reference);
                let cube = t * t * t;
                let slope = cube.scale(4.0 * SIGMA);
                ((cube * t).scale(SIGMA) + slope * (temperature - *reference), slope)
            }
        }
    }
}

/// Total exchange areas of a zone [m2], symmetric, diagonal unused:
/// `Q_ij = X_ij (E_i - E_j)` is the net heat from surface i to surface j.
///
/// `weights` holds `A_i F_ij` up to errors of closure; it is scaled symmetrically until every row sums to the
/// surface's area, so that reciprocity and closure hold exactly at the areas of this run.
pub fn exchange_areas<S: Real>(areas: &[S], emissivities: &[S], weights: &[S]) -> Vec<S> {
    let n = areas.len();
    let direct = balanced(areas, weights);
    // Radiosity: (I - (1 - e) F) J = e E; absorbed by i of j's emission: X = A e F (I - (1-e) F)^-1 e.
    let mut matrix = vec![S::zero(); n * n];
    let mut right = vec![S::zero(); n * n];
    for i in 0..n {
        for j in 0..n {
            let view = direct[i * n + j] / areas[i];
            let unit = if i == j { S::one() } else { S::zero() };
            matrix[i * n + j] = unit - (S::one() - emissivities[i]) * view;
        }
        right[i * n + i] = emissivities[i];
    }
    solve_many(&mut matrix, &mut right, n);
    let mut exchange = vec![S::zero(); n * n];
    for i in 0..n {
        for j in 0..n {
            let mut arriving = S::zero();
            for k in 0..n {
                arriving += direct[i * n + k] * right[k * n + j];
            }
            exchange[i * n + j] = emissivities[i] * arriving;
        }
    }
    symmetric(&exchange, n)
}

/// Weight with which a surface sees itself: none, unless it is larger than all others together. Then it must be bent
/// round them (a shell round a body), and closure can hold in no other way. Of a body and its shell it is exact.
pub fn self_weight<S: Real>(areas: &[S], surface: usize) -> S {
    let others = areas.iter().enumerate().filter(|(i, _)| *i != surface);
    let excess = others.fold(areas[surface], |rest, (_, area)| rest - *area);
    areas[surface] * excess.max(S::zero())
}

/// The mean of a matrix and its transpose: makes an exchange exactly two-sided.
fn symmetric<S: Real>(matrix: &[S], n: usize) -> Vec<S> {
    let mut mean = matrix.to_vec();
    for i in 0..n {
        for j in 0..n {
            mean[i * n + j] = (matrix[i * n + j] + matrix[j * n + i]).scale(0.5);
        }
    }
    mean
}

/// Symmetric diagonal scaling of the weights to row sums `areas` (Sinkhorn & Knopp's iteration, damped by a square
/// root to keep symmetry).
pub(crate) fn balanced<S: Real>(areas: &[S], weights: &[S]) -> Vec<S> {
    let n = areas.len();
    let mut scale = vec![S::one(); n];
    for _ in 0..SCALING_SWEEPS {
        let mut next = scale.clone();
        for i in 0..n {
            let mut row = S::zero();
            for j in 0..n {
                row += weights[i * n + j] * scale[j];
            }
            // A surface that sees nothing keeps its zero row.
            let row = row.max(S::constant(1e-300));
            next[i] = (scale[i] * areas[i] / row).sqrt();
        }
        scale = next;
    }
    let mut direct = weights.to_vec();
    for i in 0..n {
        for j in 0..n {
            direct[i * n + j] = scale[i] * weights[i * n + j] * scale[j];
        }
    }
    direct
}

/// What models of the sky need to know of the weather.
#[derive(Debug, Clone, Copy)]
pub struct Heaven {
    /// Black emission at the air's temperature [W/m2].
    black: f64,
    /// Air temperature [K].
    air: f64,
    /// What the model multiplies: infrared, or its function of the dew point.
    humidity: f64,
    /// Cloud cover [tenths].
    cloud: f64,
}

impl Heaven {
    /// Reads a forcing row for a model.
    #[must_use]
    pub fn new(sky: &Sky, row: &[f64]) -> Self {
        let air = row[channel::AIR_TEMPERATURE] + KELVIN;
        let dew = row[channel::DEW_POINT];
        let humidity = match sky {
            Sky::Measured { .. } => row[channel::INFRARED],
            Sky::Offset { .. } => 0.0,
            Sky::ClarkAllen { .. } => Real::ln((dew + KELVIN) / 273.0),
            Sky::MartinBerdahl { .. } => dew / 100.0,
            Sky::Brunt { .. } => Real::sqrt(vapour_pressure(dew)),
        };
        Self { black: SIGMA * air.pow4(), air, humidity, cloud: row[channel::CLOUD_COVER] }
    }
}

/// Downward emission of the sky on a horizontal plane [W/m2].
#[inline(always)]
pub fn sky_emission<S: Real>(values: &Values<'_, S>, sky: &Sky, cloud: [S; 3], heaven: &Heaven) -> S {
    let h = heaven.humidity;
    let emissivity = match sky {
        Sky::Measured { scale } => return values.get(*scale).scale(h),
        Sky::Offset { depression } => {
            return (S::constant(heaven.air) - values.get(*depression)).pow4().scale(SIGMA);
        }
        Sky::ClarkAllen { a, b } | Sky::Brunt { a, b } => values.get(*a) + values.get(*b).scale(h),
        Sky::MartinBerdahl { a, b, c } => {
            values.get(*a) + values.get(*b).scale(h) + values.get(*c).scale(h * h)
        }
    };
    let n = heaven.cloud;
    let clouds = S::one() + (cloud[0] + (cloud[1] + cloud[2].scale(n)).scale(n)).scale(n);
    (emissivity * clouds).min(S::one()).scale(heaven.black)
}

/// Temperature [degC] of a black body of an emission [W/m2].
pub fn black_temperature<S: Real>(emission: S) -> S {
    // An emission of nothing is absolute zero.
    emission.scale(1.0 / SIGMA).max(S::constant(1e-300)).sqrt().sqrt() - S::constant(KELVIN)
}

/// Vapour pressure [hPa] at a dew point [degC]: Magnus form, Alduchov & Eskridge (1996),
/// J. Appl. Meteorol. 35, doi:10.1175/1520-0450(1996)035<0601:IMFAOS>2.0.CO;2.
fn vapour_pressure(dew: f64) -> f64 {
    6.1094 * Real::exp(17.625 * dew / (243.04 + dew))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two infinite plates: X = A / (1/e1 + 1/e2 - 1).
    #[test]
    fn parallel_plates() {
        let exchange = exchange_areas(&[2.0, 2.0], &[0.9, 0.25], &[0.0, 1.0, 1.0, 0.0]);
        assert!((exchange[1] - 2.0 / (1.0 / 0.9 + 1.0 / 0.25 - 1.0)).abs() < 1e-12);
    }

    /// A body in a shell: 1/X = (1-e1)/(e1 A1) + 1/A1 + (1-e2)/(e2 A2) (Hottel & Sarofim 1967, ch. 3).
    #[test]
    fn body_in_a_shell() {
        for shell in [10.5, 20.0, 400.0] {
            let areas = [10.0, shell];
            let weights =
                [self_weight(&areas, 0), areas[0] * areas[1], areas[0] * areas[1], self_weight(&areas, 1)];
            let exchange = exchange_areas(&areas, &[0.8, 0.3], &weights);
            let expected = 1.0 / (0.2 / 8.0 + 0.1 + 0.7 / (0.3 * shell));
            assert!(
                (exchange[1] / expected - 1.0).abs() < 1e-9,
                "{shell}: {} is not {expected}",
                exchange[1]
            );
        }
    }

    /// In a cube with black walls the exchange area is A F; rows sum to the areas for any emissivities of the rest.
    #[test]
    fn black_enclosure_and_closure() {
        let areas = [9.0, 9.0, 12.0, 12.0, 9.5, 10.0];
        let n = areas.len();
        let weights: Vec<f64> =
            (0..n * n).map(|k| if k / n == k % n { 0.0 } else { areas[k / n] * areas[k % n] }).collect();
        let direct = balanced(&areas, &weights);
        for i in 0..n {
            let row: f64 = (0..n).map(|j| direct[i * n + j]).sum();
            assert!((row / areas[i] - 1.0).abs() < 1e-13);
        }
        let exchange = exchange_areas(&areas, &[1.0; 6], &weights);
        for (x, d) in exchange.iter().zip(&direct) {
            assert!((x - d).abs() < 1e-12);
        }
        // One grey surface among black ones takes exactly e A of black radiation.
        let exchange = exchange_areas(&areas, &[0.3, 1.0, 1.0, 1.0, 1.0, 1.0], &weights);
        let row: f64 = (0..n).map(|j| exchange[j]).sum();
        assert!((row / (0.3 * 9.0) - 1.0).abs() < 1e-12);
    }
}
