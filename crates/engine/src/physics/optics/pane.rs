//! Angular laws of a single pane.
//!
//! An uncoated pane is a homogeneous plate: its refractive index and its internal transmittance follow in closed form from
//! transmittance and reflectance at normal incidence; Snell's and Fresnel's laws give the rest. A coated pane has its values at
//! normal incidence, times polynomials of the cosine.
//!
//! Sources:
//! - Fresnel, absorption, multiple reflection in a plate: Duffie & Beckman (2013), ch. 5, doi:10.1002/9781118671603.
//! - Coated panes: polynomials of Finlayson, Arasteh, Huizenga, Rubin & Reilly (1993), WINDOW 4.0, LBL-33943.

use crate::input::description::PaneOptics;
use crate::input::values::Values;
use crate::number::real::Real;

/// Above this transmittance a coated pane behaves like coated clear glass, below like tinted glass.
const CLEAR: f64 = 0.645;
/// Transmittance of coated panes, and its sum with their reflectance, as polynomials of the cosine; clear and tinted.
const COATED: [[[f64; 5]; 2]; 2] = [
    [[-0.0015, 3.355, -3.840, 1.460, 0.0288], [0.999, -0.563, 2.043, -2.532, 1.054]],
    [[-0.002, 2.813, -2.341, -0.05725, 0.599], [0.997, -1.868, 6.513, -7.862, 3.225]],
];

/// A pane at one angle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plate<S> {
    pub(super) transmittance: S,
    pub(super) reflectance: [S; 2],
}

/// Angular law of one pane.
pub(super) enum PaneLaw<S> {
    /// Refractive index and logarithm of the internal transmittance at normal incidence.
    Homogeneous { index: S, logarithm: S },
    /// Values at normal incidence, times the polynomials of coated glass.
    Coated { transmittance: S, reflectance: [S; 2] },
}

impl<S: Real> PaneLaw<S> {
    pub(super) fn new(values: &Values<'_, S>, pane: &PaneOptics) -> Self {
        let t = values.get(pane.transmittance);
        let reflectance = pane.reflectance.map(|id| values.get(id));
        if pane.coated {
            return Self::Coated { transmittance: t, reflectance };
        }
        // T = a (1-r)^2/(1 - r^2 a^2), R = r (1 + a T): solved for the reflectance r of one surface and for a.
        let r = reflectance[0];
        let beta = t * t - r * r + r.scale(2.0) + S::one();
        let two_minus = S::constant(2.0) - r;
        let root = (beta * beta - (two_minus * r).scale(4.0)).max(S::zero()).sqrt();
        let surface = ((beta - root) / two_minus).scale(0.5);
        let inside = ((r - surface) / (surface * t)).min(S::one()).max(S::constant(1e-6));
        let edge = surface.sqrt();
        Self::Homogeneous { index: (S::one() + edge) / (S::one() - edge), logarithm: inside.ln() }
    }

    pub(super) fn at(&self, cosine: f64) -> Plate<S> {
        match self {
            Self::Homogeneous { index, logarithm } => homogeneous(*index, *logarithm, cosine),
            Self::Coated { transmittance, reflectance } => coated(*transmittance, *reflectance, cosine),
        }
    }
}

fn homogeneous<S: Real>(index: S, logarithm: S, cosine: f64) -> Plate<S> {
    let sine = S::constant(1.0 - cosine * cosine) / (index * index);
    let refracted = (S::one() - sine).sqrt();
    let inside = (logarithm / refracted).exp();
    let across = S::constant(cosine);
    let amplitudes = [
        (across - index * refracted) / (across + index * refracted),
        (index * across - refracted) / (index * across + refracted),
    ];
    let (mut transmittance, mut reflectance) = (S::zero(), S::zero());
    for amplitude in amplitudes {
        let surface = amplitude * amplitude;
        let rest = S::one() - surface;
        let through = inside * rest * rest / (S::one() - surface * surface * inside * inside);
        transmittance += through.scale(0.5);
        reflectance += (surface + surface * inside * through).scale(0.5);
    }
    Plate { transmittance, reflectance: [reflectance; 2] }
}

fn coated<S: Real>(transmittance: S, reflectance: [S; 2], cosine: f64) -> Plate<S> {
    let clear = S::constant(CLEAR).lt(transmittance);
    let polynomial = |which: usize| {
        let at = |kind: usize| {
            let value = |x: f64| COATED[kind][which].iter().rev().fold(0.0, |sum, c| sum * x + c);
            // The fits differ from one at normal incidence, by 1 % at most.
            value(cosine) / value(1.0)
        };
        S::select(clear, S::constant(at(0)), S::constant(at(1)))
    };
    // The second polynomial less the first is reflected: nothing at normal incidence.
    let (passing, both) = (polynomial(0), polynomial(1));
    let reflected = both - passing;
    let transmittance = transmittance * passing.max(S::zero());
    // The two polynomials are separate fits: together they may exceed one by their error.
    let reflectance = reflectance.map(|normal| {
        (normal * (S::one() - reflected) + reflected).min(S::one() - transmittance).max(S::zero())
    });
    Plate { transmittance, reflectance }
}

#[cfg(test)]
mod tests {
    use super::super::diffuse::cosine;
    use super::*;
    use crate::input::description::ParamId;

    /// A plate of index 1.521 and extinction 0.0314/mm x 3.048 mm: what WINDOW lists for the pane.
    #[test]
    fn a_pane_over_the_angle() {
        let pane = PaneOptics { transmittance: ParamId(0), reflectance: [ParamId(1); 2], coated: false };
        let law = PaneLaw::new(&Values::new(&[0.834, 0.075]), &pane);
        if let PaneLaw::Homogeneous { index, logarithm } = law {
            assert!((index - 1.521).abs() < 2e-3 && (logarithm / -3.048 - 0.0314).abs() < 2e-4);
        }
        let expected = [0.834, 0.833, 0.831, 0.827, 0.818, 0.797, 0.749, 0.637, 0.389];
        for (k, t) in expected.into_iter().enumerate() {
            #[allow(clippy::cast_precision_loss, reason = "small")]
            let plate = law.at(cosine(10.0 * k as f64));
            assert!((plate.transmittance - t).abs() < 2.5e-3, "{k}: {} is not {t}", plate.transmittance);
        }
    }

    /// A coated pane at normal incidence is itself, at grazing incidence a mirror.
    #[test]
    fn a_coated_pane() {
        let pane =
            PaneOptics { transmittance: ParamId(0), reflectance: [ParamId(1), ParamId(2)], coated: true };
        for t in [0.4, 0.7] {
            let law = PaneLaw::new(&Values::new(&[t, 0.2, 0.25]), &pane);
            let normal = law.at(1.0);
            let found = [normal.transmittance, normal.reflectance[0], normal.reflectance[1]];
            assert!(found.iter().zip([t, 0.2, 0.25]).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
            assert!(law.at(0.01).reflectance[1] > 0.95);
        }
    }
}
