//! Phase change: volumetric enthalpy, capacity, liquid fraction and conductivity at a temperature.
//!
//! A law gives the enthalpy itself and its exact derivative, so that the step can
//! conserve heat; the "apparent capacity" of the paper is that derivative.

use crate::description::PcmLaw;
use crate::parameters::Values;
use crate::real::Real;

/// State of a phase-change material at one temperature, per unit volume of layer.
#[derive(Debug, Clone, Copy)]
pub struct PcmPoint<S> {
    /// Enthalpy above the law's reference [J/m3].
    pub enthalpy: S,
    /// Slope of the enthalpy [J/(m3 K)]; the paper's apparent capacity.
    pub capacity: S,
    /// Liquid fraction [-].
    pub liquid_fraction: S,
    /// Conductivity [W/(m K)].
    pub conductivity: S,
    /// Slope of the conductivity [W/(m K2)].
    pub conductivity_slope: S,
    /// Integral of the conductivity over temperature [W/m], from a temperature of the law's own.
    pub potential: S,
}

impl<S: Real> PcmPoint<S> {
    /// A point not yet evaluated.
    pub fn zero() -> Self {
        let zero = S::zero();
        Self {
            enthalpy: zero,
            capacity: zero,
            liquid_fraction: zero,
            conductivity: zero,
            conductivity_slope: zero,
            potential: zero,
        }
    }
}

/// What a phase-change cell remembers between steps. Changes once per accepted step;
/// both stages of a step read the memory as it stood at the step's start.
#[derive(Debug, Clone, Copy)]
pub struct PcmMemory<S> {
    /// Liquid fraction at the end of the last accepted step [-].
    pub liquid_fraction: S,
}

/// A phase-change law with its numbers.
#[derive(Debug, Clone)]
pub struct PcmCoefficients<S> {
    conductivity: [S; 2],
    volumetric_heat: [S; 2],
    law: Law<S>,
}

#[derive(Debug, Clone)]
enum Law<S> {
    Tanh { centre: S, width: S, inverse_width: S, latent_heat: S },
    Table(Table<S>),
}

/// A monotone C1 curve of specific enthalpy, as segments of cubic Hermite polynomials.
#[derive(Debug, Clone)]
struct Table<S> {
    segments: Vec<Segment>,
    first_temperature: f64,
    last_temperature: f64,
    solidus: f64,
    liquidus: f64,
    shift: S,
    scale: S,
    density: S,
}

/// `h = dt (s0 u + (3 m - 2 s0 - s1) u^2 + (s0 + s1 - 2 m) u^3)` above its start, u in \[0, 1\].
#[derive(Debug, Clone, Copy)]
struct Segment {
    start: f64,
    length: f64,
    linear: f64,
    square: f64,
    cube: f64,
}

impl<S: Real> PcmCoefficients<S> {
    /// Reads the numbers of a law.
    pub fn new(
        values: &Values<'_, S>,
        conductivity: [crate::description::ParamId; 2],
        density: [crate::description::ParamId; 2],
        specific_heat: [crate::description::ParamId; 2],
        law: &PcmLaw,
    ) -> Self {
        let density = density.map(|id| values.get(id));
        let specific_heat = specific_heat.map(|id| values.get(id));
        let volumetric_heat = [density[0] * specific_heat[0], density[1] * specific_heat[1]];
        let tanh = |latent_heat, melting_temperature, width| Law::Tanh {
            centre: values.get(melting_temperature),
            width,
            inverse_width: S::one() / width,
            latent_heat: density[1] * values.get(latent_heat),
        };
        let law = match law {
            PcmLaw::TanhWidth { latent_heat, melting_temperature, width } => {
                tanh(*latent_heat, *melting_temperature, values.get(*width))
            }
            PcmLaw::TanhGamma { latent_heat, melting_temperature, gamma, delta_t } => {
                tanh(*latent_heat, *melting_temperature, values.get(*delta_t).scale(4.0) / values.get(*gamma))
            }
            PcmLaw::Tabulated {
                temperatures,
                enthalpies,
                melting_range,
                temperature_shift,
                enthalpy_scale,
            } => Law::Table(Table {
                segments: monotone_segments(temperatures, enthalpies),
                first_temperature: temperatures[0],
                last_temperature: temperatures[temperatures.len() - 1],
                solidus: melting_range[0],
                liquidus: melting_range[1],
                shift: values.get(*temperature_shift),
                scale: values.get(*enthalpy_scale),
                density: density[0],
            }),
        };
        Self { conductivity: conductivity.map(|id| values.get(id)), volumetric_heat, law }
    }

    /// Properties at a temperature [degC].
    #[inline(always)]
    pub fn at(&self, temperature: S, _memory: &PcmMemory<S>) -> PcmPoint<S> {
        let (enthalpy, capacity, fraction, fraction_slope) = match &self.law {
            Law::Tanh { centre, inverse_width, latent_heat, .. } => {
                self.tanh(temperature - *centre, *inverse_width, *latent_heat)
            }
            Law::Table(table) => table.at(temperature, self.volumetric_heat),
        };
        let molten = match &self.law {
            Law::Tanh { centre, width, .. } => {
                // The integral of the fraction, w/2 ln(1 + e^(2x)), from the fraction itself.
                let excess = temperature - *centre;
                let larger = fraction.max(S::one() - fraction);
                excess.max(S::zero()) - (*width * larger.ln()).scale(0.5)
            }
            Law::Table(table) => table.molten(temperature),
        };
        let spread = self.conductivity[1] - self.conductivity[0];
        PcmPoint {
            enthalpy,
            capacity,
            liquid_fraction: fraction,
            conductivity: self.conductivity[0] + fraction * spread,
            conductivity_slope: spread * fraction_slope,
            potential: self.conductivity[0] * temperature + spread * molten,
        }
    }

    /// The enthalpy whose derivative is the apparent capacity of the paper's eq. 2, relative to the melting temperature:
    /// `H = (rho c)_s (T-Tm) + f [rho_l L + D (T-Tm)]`, `D = (rho c)_l - (rho c)_s`,
    /// `f = 1/2 + 1/2 tanh((T-Tm)/w)`. One exponential serves all.
    #[inline(always)]
    fn tanh(&self, excess: S, inverse_width: S, latent_heat: S) -> (S, S, S, S) {
        let fraction = S::one() / (S::one() + (excess * inverse_width).scale(-2.0).exp());
        let slope = (fraction * (S::one() - fraction)).scale(2.0) * inverse_width;
        let step = self.volumetric_heat[1] - self.volumetric_heat[0];
        let jump = latent_heat + step * excess;
        let enthalpy = self.volumetric_heat[0] * excess + fraction * jump;
        let capacity = self.volumetric_heat[0] + step * fraction + slope * jump;
        (enthalpy, capacity, fraction, slope)
    }

    /// Keeps a Newton step from leaping over the steep part of the enthalpy curve: a step that crosses its
    /// inflection from beyond one half-width lands on the inflection, from where Newton converges monotonically.
    /// True where it was kept.
    #[inline(always)]
    pub fn limit(&self, from: S, to: S) -> (S, S::Mask) {
        let (centre, width) = match &self.law {
            Law::Tanh { centre, width, .. } => (*centre, *width),
            Law::Table(table) => table.middle(),
        };
        let before = from - centre;
        let after = to - centre;
        let crosses = (before * after).lt(S::zero());
        let leaps = crosses & width.lt((after - before).abs());
        (S::select(leaps, centre, to), leaps)
    }

    /// Half-width of the melting range [K].
    pub fn width(&self) -> S {
        match &self.law {
            Law::Tanh { width, .. } => *width,
            Law::Table(table) => table.middle().1,
        }
    }
}

impl<S: Real> Table<S> {
    /// (enthalpy, capacity, liquid fraction, its slope), summed over clamped segments so that lanes need no lookup.
    #[inline(always)]
    fn at(&self, temperature: S, volumetric_heat: [S; 2]) -> (S, S, S, S) {
        let read = temperature - self.shift;
        let (mut height, mut slope) = (S::zero(), S::zero());
        for segment in &self.segments {
            let (rise, gradient) = segment.at(read);
            height += rise;
            slope += gradient;
        }
        let factor = self.density * self.scale;
        let below = (read - S::constant(self.first_temperature)).min(S::zero());
        let above = (read - S::constant(self.last_temperature)).max(S::zero());
        let outside = S::select(
            below.lt(S::zero()),
            volumetric_heat[0],
            S::select(S::zero().lt(above), volumetric_heat[1], S::zero()),
        );
        let enthalpy = height * factor + below * volumetric_heat[0] + above * volumetric_heat[1];
        let solid = self.curve(self.solidus);
        let melt = self.curve(self.liquidus) - solid;
        let raw = (height - S::constant(solid)) / S::constant(melt);
        let fraction = raw.max(S::zero()).min(S::one());
        let melting = S::zero().lt(raw) & raw.lt(S::one());
        let fraction_slope = S::select(melting, slope / S::constant(melt), S::zero());
        (enthalpy, slope * factor + outside, fraction, fraction_slope)
    }

    /// Integral of the liquid fraction over temperature [K], from the solidus.
    #[inline(always)]
    fn molten(&self, temperature: S) -> S {
        let read = temperature - self.shift;
        let solid = self.curve(self.solidus);
        let melt = self.curve(self.liquidus) - solid;
        let mut below = 0.0;
        let mut sum = (read - S::constant(self.liquidus)).max(S::zero());
        for segment in &self.segments {
            sum += segment.integral(read, below - solid, [self.solidus, self.liquidus]).scale(1.0 / melt);
            below += segment.linear + segment.square + segment.cube;
        }
        sum
    }

    /// Specific enthalpy above the first point [J/kg] at an unshifted temperature.
    #[inline(always)]
    fn curve(&self, temperature: f64) -> f64 {
        self.segments.iter().map(|segment| segment.at(temperature).0).sum()
    }

    /// Middle and half-width of the melting range.
    #[inline(always)]
    fn middle(&self) -> (S, S) {
        let centre = S::constant(0.5 * (self.solidus + self.liquidus)) + self.shift;
        (centre, S::constant(0.5 * (self.liquidus - self.solidus)))
    }
}

impl Segment {
    /// Rise of the segment up to a temperature and its slope there (zero outside).
    #[inline(always)]
    fn at<S: Real>(&self, temperature: S) -> (S, S) {
        let raw = (temperature - S::constant(self.start)).scale(1.0 / self.length);
        let u = raw.max(S::zero()).min(S::one());
        let inside = !raw.lt(S::zero()) & raw.lt(S::one());
        let rise = u * (S::constant(self.linear) + u * (S::constant(self.square) + u.scale(self.cube)));
        let slope =
            S::constant(self.linear) + u * (S::constant(2.0 * self.square) + u.scale(3.0 * self.cube));
        (rise, S::select(inside, slope.scale(1.0 / self.length), S::zero()))
    }

    /// Integral of `offset + rise` up to a temperature, over the part of the segment within a range.
    #[inline(always)]
    fn integral<S: Real>(&self, temperature: S, offset: f64, range: [f64; 2]) -> S {
        let [low, high] = range.map(|end| ((end - self.start) / self.length).clamp(0.0, 1.0));
        let raw = (temperature - S::constant(self.start)).scale(1.0 / self.length);
        let u = raw.max(S::constant(low)).min(S::constant(high));
        self.antiderivative(u, offset) - self.antiderivative(S::constant(low), offset)
    }

    #[inline(always)]
    fn antiderivative<S: Real>(&self, u: S, offset: f64) -> S {
        let cubic = S::constant(self.square / 3.0) + u.scale(self.cube / 4.0);
        (u * (S::constant(offset) + u * (S::constant(self.linear / 2.0) + u * cubic))).scale(self.length)
    }
}

/// Monotone cubic interpolation (Fritsch & Butland 1984, SIAM J. Sci. Stat. Comput. 5(2), doi:10.1137/0905021):
/// harmonic-mean slopes inside, secants at the ends.
fn monotone_segments(x: &[f64], y: &[f64]) -> Vec<Segment> {
    let secants: Vec<f64> =
        x.windows(2).zip(y.windows(2)).map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0])).collect();
    let slope = |i: usize| {
        if i == 0 {
            return secants[0];
        }
        if i == secants.len() {
            return secants[i - 1];
        }
        let (left, right) = (x[i] - x[i - 1], x[i + 1] - x[i]);
        let (w1, w2) = (2.0 * right + left, right + 2.0 * left);
        (w1 + w2) / (w1 / secants[i - 1] + w2 / secants[i])
    };
    (0..secants.len())
        .map(|i| {
            let length = x[i + 1] - x[i];
            let (s0, s1, m) = (slope(i), slope(i + 1), secants[i]);
            Segment {
                start: x[i],
                length,
                linear: length * s0,
                square: length * (3.0 * m - 2.0 * s0 - s1),
                cube: length * (s0 + s1 - 2.0 * m),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::ParamId;
    use crate::real::Dual;

    type D = Dual<f64, 1>;

    fn ids<const N: usize>(first: u32) -> [ParamId; N] {
        core::array::from_fn(|i| ParamId(first + u32::try_from(i).unwrap()))
    }

    fn check_slopes(law: &PcmLaw, numbers: &[f64]) {
        let numbers: Vec<D> = numbers.iter().map(|&v| D::constant(v)).collect();
        let pcm = PcmCoefficients::new(&Values::new(&numbers), ids(0), ids(2), ids(4), law);
        let memory = PcmMemory { liquid_fraction: D::zero() };
        let mut last = f64::NEG_INFINITY;
        for i in 0..400 {
            let t = 10.0 + 0.083 * f64::from(i);
            let point = pcm.at(D::variable(t, 0), &memory);
            assert!((point.enthalpy.slope[0] / point.capacity.value - 1.0).abs() < 1e-9, "capacity at {t}");
            let slope = point.conductivity.slope[0] - point.conductivity_slope.value;
            assert!(slope.abs() < 1e-12, "conductivity at {t}");
            let slope = point.potential.slope[0] - point.conductivity.value;
            assert!(slope.abs() < 1e-12, "potential at {t}");
            assert!(point.enthalpy.value > last);
            last = point.enthalpy.value;
        }
    }

    /// Energain, reference/paper Table 2.
    const ENERGAIN: [f64; 6] = [0.22, 0.18, 855.0, 855.0, 3134.0, 2833.0];

    #[test]
    fn capacity_is_the_derivative_of_enthalpy() {
        let [latent_heat, melting_temperature, gamma, delta_t] = ids(6);
        let law = PcmLaw::TanhGamma { latent_heat, melting_temperature, gamma, delta_t };
        check_slopes(&law, &[&ENERGAIN[..], &[71e3, 23.4, 0.04, 0.01]].concat());
        let [temperature_shift, enthalpy_scale] = ids(6);
        let law = PcmLaw::Tabulated {
            temperatures: vec![15.0, 20.0, 22.0, 23.0, 25.0, 30.0],
            enthalpies: vec![0.0, 16e3, 40e3, 70e3, 90e3, 104e3],
            melting_range: [18.0, 25.0],
            temperature_shift,
            enthalpy_scale,
        };
        check_slopes(&law, &[&ENERGAIN[..], &[0.4, 1.1]].concat());
    }

    #[test]
    fn melting_takes_up_the_latent_heat() {
        let [latent_heat, melting_temperature, width] = ids(6);
        let law = PcmLaw::TanhWidth { latent_heat, melting_temperature, width };
        let numbers = [&ENERGAIN[..], &[71e3, 23.4, 1.0]].concat();
        let pcm = PcmCoefficients::new(&Values::new(&numbers), ids(0), ids(2), ids(4), &law);
        let memory = PcmMemory { liquid_fraction: 0.0 };
        let rise = pcm.at(33.4, &memory).enthalpy - pcm.at(13.4, &memory).enthalpy;
        let expected = 855.0 * (71e3 + 10.0 * 3134.0 + 10.0 * 2833.0);
        assert!((rise / expected - 1.0).abs() < 1e-7);
    }

    #[test]
    fn table_passes_through_its_points() {
        let [temperature_shift, enthalpy_scale] = ids(6);
        let (temperatures, enthalpies) = (vec![10.0, 20.0, 24.0, 40.0], vec![0.0, 20e3, 90e3, 130e3]);
        let law = PcmLaw::Tabulated {
            temperatures: temperatures.clone(),
            enthalpies: enthalpies.clone(),
            melting_range: [20.0, 24.0],
            temperature_shift,
            enthalpy_scale,
        };
        let numbers = [&ENERGAIN[..], &[0.0, 1.0]].concat();
        let pcm = PcmCoefficients::new(&Values::new(&numbers), ids(0), ids(2), ids(4), &law);
        let memory = PcmMemory { liquid_fraction: 0.0 };
        for (t, h) in temperatures.iter().zip(&enthalpies) {
            assert!((pcm.at(*t, &memory).enthalpy - 855.0 * h).abs() < 1e-6 * 855.0 * 130e3);
        }
    }
}
