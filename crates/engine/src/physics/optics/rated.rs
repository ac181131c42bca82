//! The optics of a unit known by its rated U value and solar heat gain.
//!
//! Without a coating all panes are plates of one glass, whose absorption follows from the solar heat gain; Fresnel's and
//! Snell's laws give the other angles (`pane.rs`). A unit with a lower conductance than gas and uncoated glass allow has a
//! coating: clear panes with a coated one behind them, whose transmittance follows from that of the unit and whose reflectance
//! from the solar heat gain. The transmittance of a coated unit is given, or estimated from both rated values.
//!
//! What the panes absorb is assigned to the outermost and the innermost, so that the same part of it flows inwards.
//!
//! Sources:
//! - Clear glass: refractive index 1.521 and extinction 0.0314/mm, those of 3.048 mm of transmittance 0.834 and reflectance
//!   0.075 (WINDOW 7, clear glass).
//! - Surface resistances of a solar heat gain: EN 410:2011, 5.4.6 (0.04 and 0.13 m2 K/W).
//! - Coated units, transmittance by U and solar heat gain: Arasteh, Kohler & Griffith (2009), LBNL-2804E.
//! - Long-wave exchange of uncoated glass (emissivity 0.837) at 10 degC: EN 673:2011, 5.2.
//! - Other categories of glass, relative to category 4: Karlsson & Roos (2000), doi:10.1016/S0038-092X(00)00083-9.

use super::curves::Curves;
use super::diffuse::{Unit, cosine};
use super::pane::{PaneLaw, Plate};
use super::unit::{ANGLES, Optics, combined};
use crate::number::newton::falling_root;
use crate::number::real::{Mask, Real};
use crate::physics::window_gaps::RatedGaps;

/// Refractive index of clear glass [-].
const INDEX: f64 = 1.521;
/// Surface resistances outside and inside of a solar heat gain [m2 K/W].
const SURFACES: [f64; 2] = [0.04, 0.13];
/// Logarithm of the internal transmittance of a clear pane [-].
const CLEAR: f64 = -0.0957;
/// Least absorption of a pane, as the logarithm of its internal transmittance [-].
const LEAST: f64 = 1e-4;
/// Most panes.
const MOST: usize = 6;
/// Least conductance of the gas in a gap [W/(m2 K)]: 15 mm of argon with 15 K across it, by ISO 15099.
const GAS: f64 = 1.28;
/// Long-wave conductance between uncoated panes at 10 degC, `4 sigma T^3/(2/0.837 - 1)` [W/(m2 K)].
const RADIATION: f64 = 3.706;
/// Iterations for the glass that gives a solar heat gain: quadratic convergence.
const ITERATIONS: usize = 16;

/// What is known of a unit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rating<S> {
    /// Total solar heat gain at normal incidence [-].
    pub(crate) gain: S,
    /// Solar transmittance at normal incidence [-].
    pub(crate) transmittance: Option<S>,
    /// U value [W/(m2 K)].
    pub(crate) u_value: S,
    /// Resistance between its surfaces, and that of each of its outer panes [m2 K/W].
    pub(crate) resistances: [S; 2],
    /// Number of panes [-].
    pub(crate) panes: S,
    /// Category of glass [-].
    pub(crate) category: S,
}

/// Transmittance, and absorptances of the outermost and the innermost pane, at each of [`ANGLES`].
type Table<S> = Vec<[S; 3]>;

impl<S: Real> Rating<S> {
    /// The gaps between the outer panes: their number, and the conductances of gas and long-wave radiation in one of them as
    /// rated [W/(m2 K)].
    pub(crate) fn gaps(&self) -> RatedGaps<S> {
        let [whole, pane] = self.resistances;
        let number = (self.panes - S::one()).max(S::constant(1e-6));
        let between = number / (whole - pane.scale(2.0));
        let radiation = long_wave(between);
        RatedGaps { number, gas: between - radiation, radiation }
    }

    /// Parts of what panes absorb that flow inwards, evenly spaced [-].
    fn inward(&self, panes: usize) -> Vec<S> {
        let [outer, inner] = SURFACES;
        let whole = self.resistances[0];
        let all = whole + S::constant(outer + inner);
        depths(panes).map(|depth| (whole.scale(depth) + S::constant(outer)) / all).collect()
    }

    /// How much of the unit's behaviour is that of a coated one: all of it where the long-wave conductance is less than half
    /// of that between uncoated panes [-].
    fn coated(&self, panes: usize) -> S {
        if panes == 1 {
            return S::zero();
        }
        let [whole, pane] = self.resistances;
        #[allow(clippy::cast_precision_loss, reason = "a few panes")]
        let each = S::constant((panes - 1) as f64) / (whole - pane.scale(2.0));
        let missing = S::one() - long_wave(each).scale(1.0 / RADIATION);
        missing.scale(2.0).min(S::one())
    }

    /// The unit with a whole number of panes.
    fn table(&self, panes: usize) -> Table<S> {
        let inward = self.inward(panes);
        let share = self.coated(panes);
        let (plain, glass) = self.plates(panes, &inward);
        let usual = glass[0][0];
        let estimate = usual + share * (transmittance_of_coated(self.u_value, self.gain) - usual);
        let normal = self.transmittance.unwrap_or(estimate).min(self.gain);
        let plain = self.scaled(&plain, normal, &inward);
        if panes == 1 {
            return plain;
        }
        let coated = self.scaled(&self.coated_unit(panes, normal, &inward), normal, &inward);
        let blend = |(a, b): (&[S; 3], &[S; 3])| core::array::from_fn(|k| a[k] + share * (b[k] - a[k]));
        plain.iter().zip(&coated).map(blend).collect()
    }

    /// Scales a unit so that it has a transmittance and the solar heat gain at normal incidence, and lumps what its panes
    /// absorb.
    fn scaled(&self, units: &[Unit<S>], normal: S, inward: &[S]) -> Table<S> {
        let first = &units[0];
        let (mut absorbed, mut enters) = (S::zero(), S::zero());
        for (part, inward) in first[1..].iter().zip(inward) {
            absorbed += *part;
            enters += *part * *inward;
        }
        let tiny = S::constant(1e-12);
        let through = normal / first[0].max(tiny);
        let most = (S::one() - normal) / absorbed.max(tiny);
        let kept = ((self.gain - normal) / enters.max(tiny)).max(S::zero()).min(most);
        let lump = |unit: &Unit<S>| {
            let mut row = [unit[0] * through, S::zero(), S::zero()];
            for (part, depth) in unit[1..].iter().zip(depths(unit.len() - 1)) {
                row[1] += (*part * kept).scale(1.0 - depth);
                row[2] += (*part * kept).scale(depth);
            }
            row
        };
        units.iter().map(lump).collect()
    }

    /// Plates of one glass that give the solar heat gain, at all angles; and the unit at normal incidence.
    fn plates(&self, panes: usize, inward: &[S]) -> (Vec<Unit<S>>, Vec<Unit<S>>) {
        let unit = |surface: S, absorption: S, cosine: f64| {
            let edge = surface.sqrt();
            let index = (S::one() + edge) / (S::one() - edge);
            let plate = PaneLaw::Homogeneous { index, logarithm: -absorption }.at(cosine);
            combined(&vec![plate; panes])
        };
        let edge = (INDEX - 1.0) / (INDEX + 1.0);
        let usual = S::constant(edge * edge);
        let gain = |unit: &Unit<S>| gain_of(unit, inward);
        let least = S::constant(LEAST);
        // Glass of less reflectance where even without absorption too little is transmitted: T = (1-r)/(1 + (2n-1) r).
        let clearest = gain(&unit(usual, least, 1.0));
        #[allow(clippy::cast_precision_loss, reason = "a few panes")]
        let reflections = (2 * panes - 1) as f64;
        let clear = (S::one() - self.gain) / (S::one() + self.gain.scale(reflections));
        let too_clear = clearest.lt(self.gain);
        let surface = S::select(too_clear, clear.max(S::constant(1e-6)), usual);
        let found = falling_root(least, ITERATIONS, [least, S::constant(20.0)], |absorption, fixed| {
            let surface = if fixed { surface.fixed() } else { surface };
            let parts: Vec<S> = inward.iter().map(|part| if fixed { part.fixed() } else { *part }).collect();
            let target = if fixed { self.gain.fixed() } else { self.gain };
            gain_of(&unit(surface, absorption, 1.0), &parts) - target
        });
        let absorption = S::select(too_clear, least, found.max(least));
        let all = |angle: &f64| at_angle(*angle, panes, |cosine| unit(surface, absorption, cosine));
        (ANGLES.iter().map(all).collect(), vec![unit(surface, absorption, 1.0)])
    }

    /// Clear panes, and behind them a coated one that gives transmittance and solar heat gain, at all angles.
    fn coated_unit(&self, panes: usize, normal: S, inward: &[S]) -> Vec<Unit<S>> {
        let clear = |cosine: f64| -> Plate<S> {
            let (index, logarithm) = (S::constant(INDEX), S::constant(CLEAR));
            PaneLaw::Homogeneous { index, logarithm }.at(cosine)
        };
        let front = vec![clear(1.0); panes - 1];
        let through = combined(&front)[0];
        let behind = reflectance(&front);
        let law = |reflectance: S, normal: S| {
            let transmittance = normal * (S::one() - behind * reflectance) / through;
            let most = S::one() - reflectance;
            PaneLaw::Coated { transmittance: transmittance.min(most), reflectance: [reflectance; 2] }
        };
        let unit = |coated: &PaneLaw<S>, cosine: f64| {
            let mut plates = vec![clear(cosine); panes - 1];
            plates.push(coated.at(cosine));
            combined(&plates)
        };
        let least = S::constant(LEAST);
        let found =
            falling_root(S::constant(0.2), ITERATIONS, [least, S::constant(0.95)], |reflectance, fixed| {
                let keep = |number: S| if fixed { number.fixed() } else { number };
                let parts: Vec<S> = inward.iter().map(|part| keep(*part)).collect();
                gain_of(&unit(&law(reflectance, keep(normal)), 1.0), &parts) - keep(self.gain)
            });
        let coated = law(found, normal);
        ANGLES.iter().map(|angle| at_angle(*angle, panes, |cosine| unit(&coated, cosine))).collect()
    }
}

impl<S: Real> Optics<S> {
    /// A unit by its rating, with two absorbing panes: the outermost and the innermost.
    pub(crate) fn of_rating(rating: &Rating<S>) -> Self {
        let mut rows = vec![[S::zero(); 3]; ANGLES.len()];
        let above = |panes: usize| {
            #[allow(clippy::cast_precision_loss, reason = "a few panes")]
            let more = rating.panes - S::constant(panes as f64);
            let part = more.max(S::zero()).min(S::one());
            // Smooth where the number is whole.
            part * part * (S::constant(3.0) - part.scale(2.0))
        };
        for panes in 1..=MOST {
            // Between two whole numbers of panes both units count. Without any, or with more than most, the nearest.
            let from = if panes == 1 { S::one() } else { above(panes - 1) };
            let to = if panes == MOST { S::zero() } else { above(panes) };
            let weight = from - to;
            if !(S::zero().lt(weight) | S::zero().lt(S::one() - (rating.panes - near(panes)).abs())).any() {
                continue;
            }
            for (row, unit) in rows.iter_mut().zip(rating.table(panes)) {
                for (sum, part) in row.iter_mut().zip(unit) {
                    *sum += weight * part;
                }
            }
        }
        let units: Vec<Unit<S>> = ANGLES
            .iter()
            .zip(&rows)
            .map(|(angle, row)| {
                let factor = category(*angle, rating.panes, rating.category);
                vec![(row[0] * factor).min(S::one() - row[1] - row[2]), row[1], row[2]]
            })
            .collect();
        let beam = Curves::new(&ANGLES, &units);
        let front = beam.diffuse();
        let mut back = front.clone();
        back.absorptance.reverse();
        Self { beam, front, back }
    }
}

#[allow(clippy::cast_precision_loss, reason = "a few panes")]
fn near<S: Real>(panes: usize) -> S {
    S::constant(panes as f64)
}

/// Relative depths of panes at even distances; a single one lies in the middle.
fn depths(panes: usize) -> impl Iterator<Item = f64> {
    #[allow(clippy::cast_precision_loss, reason = "a few panes")]
    (0..panes).map(move |k| if panes == 1 { 0.5 } else { k as f64 / (panes - 1) as f64 })
}

/// Long-wave part of the conductance of a gap at 10 degC: what gas at rest leaves, as far as glass can radiate it.
fn long_wave<S: Real>(gap: S) -> S {
    (gap - S::constant(GAS)).max(S::zero()).min(S::constant(RADIATION))
}

fn gain_of<S: Real>(unit: &Unit<S>, inward: &[S]) -> S {
    unit[1..].iter().zip(inward).fold(unit[0], |sum, (part, inward)| sum + *part * *inward)
}

/// A unit at an angle; at 90 deg all is reflected.
fn at_angle<S: Real>(angle: f64, panes: usize, unit: impl Fn(f64) -> Unit<S>) -> Unit<S> {
    let cosine = cosine(angle);
    if cosine > 0.0 { unit(cosine) } else { vec![S::zero(); panes + 1] }
}

/// Reflectance of plates from behind.
fn reflectance<S: Real>(plates: &[Plate<S>]) -> S {
    plates.iter().fold(S::zero(), |behind, plate| {
        let t = plate.transmittance;
        plate.reflectance[1] + t * t * behind / (S::one() - plate.reflectance[0] * behind)
    })
}

/// Solar transmittance by U value [W/(m2 K)] and solar heat gain (LBNL-2804E).
fn transmittance_of_coated<S: Real>(u_value: S, gain: S) -> S {
    let cubic = |c: [f64; 3]| gain * (S::constant(c[1]) + gain.scale(c[0])) + S::constant(c[2]);
    let single = S::select(
        gain.lt(S::constant(0.7206)),
        cubic([0.939_998, 0.203_32, 0.0]),
        cubic([0.0, 1.304_15, -0.305_15]),
    );
    let many = S::select(
        gain.lt(S::constant(0.15)),
        gain.scale(0.410_40),
        cubic([0.085_775, 0.963_954, -0.084_958]),
    );
    // Between the two families of glass the correlation is interpolated by U.
    let share = ((u_value - S::constant(3.4)).scale(1.0 / 1.1)).max(S::zero()).min(S::one());
    (many + share * (single - many)).max(S::zero()).min(gain)
}

/// Transmittance of a category of glass over that of category 4 at an angle [deg].
fn category<S: Real>(angle: f64, panes: S, category: S) -> S {
    if angle <= 0.0 || angle >= 90.0 {
        return S::one();
    }
    let usual = karlsson_roos(angle, panes, S::constant(4.0)).max(S::constant(1e-9));
    karlsson_roos(angle, panes, category).max(S::zero()) / usual
}

/// `1 - a x^alpha - b x^2 - c x^gamma`, x the angle over 90 deg.
fn karlsson_roos<S: Real>(angle: f64, panes: S, category: S) -> S {
    let x = angle / 90.0;
    let (a, b) = (8.0, S::constant(0.25) / category);
    let c = S::constant(1.0 - a) - b;
    let alpha = S::constant(5.2) + category.scale(0.7);
    let gamma = S::constant(5.26) + panes.scale(0.06) + (S::constant(0.73) + panes.scale(0.04)) * category;
    let base = S::constant(x);
    S::one() - base.powf(alpha).scale(a) - b.scale(x * x) - c * base.powf(gamma)
}
