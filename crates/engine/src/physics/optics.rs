//! Solar optics of panes and of units of panes.
//!
//! A unit is described by its transmittance and the absorptance of each pane over the cosine of the angle of incidence:
//! a monotone piecewise cubic through a few angles, set up once per run. In a step only the cubic is evaluated.
//!
//! An uncoated pane is a homogeneous plate: its refractive index and its internal transmittance follow in closed form
//! from transmittance and reflectance at normal incidence; Snell's and Fresnel's laws do the rest. Panes are combined
//! with values that are the mean of both polarisations already. Keeping the polarisations apart between the panes is
//! what a single plane wave would do; tables of real units (WINDOW, EN 410) are made with the mean, and lie 3 % (60 deg)
//! to 5 % (70 deg) lower in transmittance.
//!
//! Sources:
//! - Fresnel, absorption, multiple reflection in a plate: Duffie & Beckman (2013), ch. 5, doi:10.1002/9781118671603.
//! - Coated panes: polynomials of Finlayson, Arasteh, Huizenga, Rubin & Reilly (1993), WINDOW 4.0, LBL-33943.
//! - Angular behaviour of a unit known by U and g only: Karlsson & Roos (2000), Solar Energy 69(4),
//!   doi:10.1016/S0038-092X(00)00083-9; its transmittance at normal incidence: Arasteh, Kohler & Griffith (2009),
//!   LBNL-2804E.
//! - Monotone piecewise cubics: Fritsch & Butland (1984), doi:10.1137/0905021.

use crate::input::description::{Angular, PaneOptics};
use crate::input::values::Values;
use crate::number::real::Real;

/// Angles at which a calculated unit is tabulated [deg]; the curve bends near grazing incidence.
const ANGLES: [f64; 13] = [0.0, 20.0, 40.0, 50.0, 60.0, 65.0, 70.0, 75.0, 80.0, 85.0, 87.5, 89.0, 90.0];
/// Directions into which a quarter of the horizon is cut.
const HORIZON: usize = 32;
/// Above this transmittance a coated pane behaves like coated clear glass, below like tinted glass.
const CLEAR: f64 = 0.645;
/// Transmittance of coated panes, and its sum with their reflectance, as polynomials of the cosine; clear and tinted.
const COATED: [[[f64; 5]; 2]; 2] = [
    [[-0.0015, 3.355, -3.840, 1.460, 0.0288], [0.999, -0.563, 2.043, -2.532, 1.054]],
    [[-0.002, 2.813, -2.341, -0.05725, 0.599], [0.997, -1.868, 6.513, -7.862, 3.225]],
];

/// Optics of a unit.
#[derive(Debug, Clone)]
pub struct Optics<S> {
    /// For sun from one direction outside.
    pub beam: Curves<S>,
    /// For diffuse sun from outside.
    pub front: Diffuse<S>,
    /// For diffuse sun from inside.
    pub back: Diffuse<S>,
}

/// What becomes of diffuse radiation; the rest is reflected.
#[derive(Debug, Clone)]
pub struct Diffuse<S> {
    /// [-].
    pub transmittance: S,
    /// Of each pane, outside to inside [-].
    pub absorptance: Vec<S>,
}

impl<S: Real> Diffuse<S> {
    /// All that is not reflected [-].
    #[inline(always)]
    pub fn admitted(&self) -> S {
        self.absorptance.iter().fold(self.transmittance, |sum, part| sum + *part)
    }
}

/// Quantities over the cosine of the angle of incidence, piecewise cubic.
#[derive(Debug, Clone)]
pub struct Curves<S> {
    /// Rising from 0 to 1.
    knots: Vec<f64>,
    /// Number of quantities.
    count: usize,
    /// By piece and quantity: polynomial of the distance from the piece's first knot.
    pieces: Vec<[S; 4]>,
}

/// A pane at one angle.
#[derive(Debug, Clone, Copy)]
struct Plate<S> {
    transmittance: S,
    reflectance: [S; 2],
}

/// A unit at one angle: transmittance, then the absorptance of each pane.
type Unit<S> = Vec<S>;

impl<S: Real> Optics<S> {
    /// A unit calculated from its panes.
    pub fn of_panes(values: &Values<'_, S>, panes: &[PaneOptics]) -> Self {
        let laws: Vec<_> = panes.iter().map(|pane| PaneLaw::new(values, pane)).collect();
        let at = |turned: bool| {
            let units = ANGLES.iter().map(|angle| {
                let cosine = cosine(*angle);
                let mut plates: Vec<_> = laws.iter().map(|law| law.at(cosine)).collect();
                if turned {
                    plates.reverse();
                    for plate in &mut plates {
                        plate.reflectance.reverse();
                    }
                }
                if cosine > 0.0 { combined(&plates) } else { vec![S::zero(); plates.len() + 1] }
            });
            Curves::new(&ANGLES, &units.collect::<Vec<_>>())
        };
        let beam = at(false);
        let mut back = at(true).diffuse();
        back.absorptance.reverse();
        Self { front: beam.diffuse(), beam, back }
    }

    /// A unit by its table. From inside it is taken to be the same as from outside.
    pub fn of_table(values: &Values<'_, S>, table: &Angular) -> Self {
        let (scale, absorbing) = (values.get(table.transmittance_scale), values.get(table.absorptance_scale));
        let units: Vec<Unit<S>> = (0..table.angles.len())
            .map(|k| {
                let absorbed = table.absorptance.iter().map(|pane| absorbing.scale(pane[k]));
                core::iter::once(scale.scale(table.transmittance[k])).chain(absorbed).collect()
            })
            .collect();
        let beam = Curves::new(&table.angles, &units);
        let mut front = beam.diffuse();
        if let Some(transmittance) = table.diffuse_transmittance {
            front.transmittance = scale.scale(transmittance);
        }
        if let Some(absorptance) = &table.diffuse_absorptance {
            front.absorptance = absorptance.iter().map(|pane| absorbing.scale(*pane)).collect();
        }
        let mut back = front.clone();
        back.absorptance.reverse();
        Self { beam, front, back }
    }

    /// A single absorbing sheet that stands for a unit; `panes` and `category` as in Karlsson & Roos.
    pub fn of_sheet(transmittance: S, absorptance: S, panes: S, category: S) -> Self {
        let units: Vec<Unit<S>> = ANGLES
            .iter()
            .map(|angle| {
                let share = karlsson_roos(*angle, panes, category);
                vec![transmittance * share, absorptance * share]
            })
            .collect();
        let beam = Curves::new(&ANGLES, &units);
        let front = beam.diffuse();
        Self { beam, back: front.clone(), front }
    }
}

/// Exact at 90 deg.
fn cosine(angle: f64) -> f64 {
    if angle >= 90.0 { 0.0 } else { Real::cos(angle.to_radians()) }
}

/// `1 - a x^alpha - b x^2 - c x^gamma`, x the angle over 90 deg.
fn karlsson_roos<S: Real>(angle: f64, panes: S, category: S) -> S {
    if angle <= 0.0 {
        return S::one();
    }
    if angle >= 90.0 {
        return S::zero();
    }
    let x = angle / 90.0;
    let (a, b) = (8.0, S::constant(0.25) / category);
    let c = S::constant(1.0 - a) - b;
    let alpha = S::constant(5.2) + category.scale(0.7);
    let gamma = S::constant(5.26) + panes.scale(0.06) + (S::constant(0.73) + panes.scale(0.04)) * category;
    let base = S::constant(x);
    S::one() - base.powf(alpha).scale(a) - b.scale(x * x) - c * base.powf(gamma)
}

/// Angular law of one pane.
enum PaneLaw<S> {
    /// Refractive index and logarithm of the internal transmittance at normal incidence.
    Homogeneous { index: S, logarithm: S },
    /// Values at normal incidence, times the polynomials of coated glass.
    Coated { transmittance: S, reflectance: [S; 2] },
}

impl<S: Real> PaneLaw<S> {
    fn new(values: &Values<'_, S>, pane: &PaneOptics) -> Self {
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

    fn at(&self, cosine: f64) -> Plate<S> {
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
            // The fits miss one at normal incidence, by 1 % at most.
            value(cosine) / value(1.0)
        };
        S::select(clear, S::constant(at(0)), S::constant(at(1)))
    };
    // What the second polynomial leaves beside the first is reflected: none at normal incidence.
    let (passing, both) = (polynomial(0), polynomial(1));
    let turning = both - passing;
    let transmittance = transmittance * passing.max(S::zero());
    // The two polynomials are separate fits: together they may exceed one by their error.
    let reflectance = reflectance
        .map(|normal| (normal * (S::one() - turning) + turning).min(S::one() - transmittance).max(S::zero()));
    Plate { transmittance, reflectance }
}

/// Transmittance and absorptances of panes one behind the other, light from the first one's side (net-radiation method).
fn combined<S: Real>(plates: &[Plate<S>]) -> Unit<S> {
    let n = plates.len();
    // Reflectance of all panes from k on, seen from the front.
    let mut behind = vec![S::zero(); n + 1];
    for (k, plate) in plates.iter().enumerate().rev() {
        let t = plate.transmittance;
        let between = S::one() - plate.reflectance[1] * behind[k + 1];
        behind[k] = plate.reflectance[0] + t * t * behind[k + 1] / between;
    }
    let mut unit = vec![S::zero(); n + 1];
    let mut arriving = S::one();
    for (k, plate) in plates.iter().enumerate() {
        let next = arriving * plate.transmittance / (S::one() - plate.reflectance[1] * behind[k + 1]);
        let [front, back] = plate.reflectance.map(|r| S::one() - plate.transmittance - r);
        unit[k + 1] = arriving * front + next * behind[k + 1] * back;
        arriving = next;
    }
    unit[0] = arriving;
    unit
}

impl<S: Real> Curves<S> {
    /// Through units at angles rising from 0 to 90 deg.
    fn new(angles: &[f64], units: &[Unit<S>]) -> Self {
        let knots: Vec<f64> = angles.iter().rev().map(|angle| cosine(*angle)).collect();
        let count = units[0].len();
        let mut pieces = vec![[S::zero(); 4]; (knots.len() - 1) * count];
        for quantity in 0..count {
            let heights: Vec<S> = units.iter().rev().map(|unit| unit[quantity]).collect();
            for (piece, polynomial) in monotone(&knots, &heights).into_iter().enumerate() {
                pieces[piece * count + quantity] = polynomial;
            }
        }
        Self { knots, count, pieces }
    }

    /// Transmittance at a cosine; fills in the absorptance of each pane.
    #[inline(always)]
    pub fn split(&self, cosine: S, panes: &mut [S]) -> S {
        let mut transmittance = [S::zero()];
        self.read(cosine, 0, &mut transmittance);
        self.read(cosine, 1, panes);
        transmittance[0]
    }

    /// Reads quantities from the given one on at a cosine; below zero as at zero.
    #[inline(always)]
    fn read(&self, cosine: S, offset: usize, read: &mut [S]) {
        // All members mostly look from one piece; where they do not, each lane selects its own.
        let (mut first, mut last) = (self.knots.len(), 0);
        for lane in 0..S::LANES {
            let piece = self.piece(cosine.lane(lane));
            first = first.min(piece);
            last = last.max(piece);
        }
        let piece = |number: usize, quantity: usize| self.pieces[number * self.count + offset + quantity];
        let mut from = S::constant(self.knots[first]);
        for number in first + 1..=last {
            let knot = S::constant(self.knots[number]);
            from = S::select(cosine.lt(knot), from, knot);
        }
        let x = cosine.max(S::zero()) - from;
        for (quantity, read) in read.iter_mut().enumerate() {
            let mut polynomial = piece(first, quantity);
            for number in first + 1..=last {
                let before = cosine.lt(S::constant(self.knots[number]));
                let here = piece(number, quantity);
                polynomial = core::array::from_fn(|k| S::select(before, polynomial[k], here[k]));
            }
            let [a, b, c, d] = polynomial;
            *read = a + x * (b + x * (c + x * d));
        }
    }

    /// Piece that holds a cosine.
    #[inline(always)]
    fn piece(&self, cosine: f64) -> usize {
        let inner = &self.knots[1..self.knots.len() - 1];
        inner.iter().filter(|knot| **knot <= cosine).count()
    }

    /// Means over the horizon, `1/2 int f(sin tilt cos a) cos a da`, a the azimuth off the normal from -90 to 90 deg.
    pub fn horizon(&self, sine: S) -> Diffuse<S> {
        let mut means = vec![S::zero(); self.count];
        let mut read = means.clone();
        let step = core::f64::consts::FRAC_PI_2 / HORIZON as f64;
        let mut weights = 0.0;
        for k in 0..HORIZON {
            let weight = Real::cos((k as f64 + 0.5) * step);
            self.read(sine.scale(weight), 0, &mut read);
            for (mean, read) in means.iter_mut().zip(&read) {
                *mean += read.scale(weight);
            }
            weights += weight;
        }
        for mean in &mut means {
            *mean = mean.scale(1.0 / weights);
        }
        Diffuse { transmittance: means[0], absorptance: means.split_off(1) }
    }

    /// Means over the hemisphere, `2 int f(c) c dc`.
    fn diffuse(&self) -> Diffuse<S> {
        let mut means = vec![S::zero(); self.count];
        for (number, pair) in self.knots.windows(2).enumerate() {
            let (from, h) = (pair[0], pair[1] - pair[0]);
            let square = h * h;
            let powers = [h, square, square * h, square * square, square * square * h];
            // int_0^h t^k (from + t) dt
            let moment = |k: usize| {
                let (m, n) = ((k + 1) as f64, (k + 2) as f64);
                from * powers[k] / m + powers[k + 1] / n
            };
            let moments = [moment(0), moment(1), moment(2), moment(3)];
            for (quantity, mean) in means.iter_mut().enumerate() {
                let polynomial = self.pieces[number * self.count + quantity];
                for (coefficient, moment) in polynomial.into_iter().zip(moments) {
                    *mean += coefficient.scale(2.0 * moment);
                }
            }
        }
        Diffuse { transmittance: means[0], absorptance: means.split_off(1) }
    }
}

/// Polynomials between knots, without overshoot where the heights are monotone.
fn monotone<S: Real>(knots: &[f64], heights: &[S]) -> Vec<[S; 4]> {
    let n = knots.len() - 1;
    let widths: Vec<f64> = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let rises: Vec<S> = (0..n).map(|k| (heights[k + 1] - heights[k]).scale(1.0 / widths[k])).collect();
    let mut slopes = vec![rises[0]; n + 1];
    for k in 1..n {
        slopes[k] = inner_slope(widths[k - 1], widths[k], rises[k - 1], rises[k]);
    }
    if n > 1 {
        slopes[0] = end_slope(widths[0], widths[1], rises[0], rises[1]);
        slopes[n] = end_slope(widths[n - 1], widths[n - 2], rises[n - 1], rises[n - 2]);
    }
    (0..n)
        .map(|k| {
            let h = widths[k];
            let (start, end, rise) = (slopes[k], slopes[k + 1], rises[k]);
            [
                heights[k],
                start,
                (rise.scale(3.0) - start.scale(2.0) - end).scale(1.0 / h),
                (start + end - rise.scale(2.0)).scale(1.0 / (h * h)),
            ]
        })
        .collect()
}

/// Weighted harmonic mean of the rises on both sides, zero at a turn.
fn inner_slope<S: Real>(before: f64, after: f64, left: S, right: S) -> S {
    let (u, v) = (before + 2.0 * after, 2.0 * before + after);
    let product = left * right;
    let turns = !S::zero().lt(product);
    let sum = S::select(turns, S::one(), right.scale(u) + left.scale(v));
    S::select(turns, S::zero(), product.scale(u + v) / sum)
}

/// Slope of the parabola through three points, kept from overshooting.
fn end_slope<S: Real>(near: f64, far: f64, rise: S, next: S) -> S {
    let slope = (rise.scale(2.0 * near + far) - next.scale(near)).scale(1.0 / (near + far));
    let against = (slope * rise).lt(S::zero());
    let steep = (rise * next).lt(S::zero()) & rise.scale(3.0).abs().lt(slope.abs());
    S::select(against, S::zero(), S::select(steep, rise.scale(3.0), slope))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::description::ParamId;

    fn clear_double() -> Optics<f64> {
        let pane = PaneOptics { transmittance: ParamId(0), reflectance: [ParamId(1); 2], coated: false };
        Optics::of_panes(&Values::new(&[0.834, 0.075]), &[pane.clone(), pane])
    }

    fn read(optics: &Optics<f64>, angle: f64) -> [f64; 3] {
        let mut read = [0.0; 3];
        optics.beam.read(Real::cos(angle.to_radians()), 0, &mut read);
        read
    }

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

    /// Two panes, polarisations averaged pane by pane; energy is kept at every angle.
    #[test]
    fn a_double_unit() {
        let optics = clear_double();
        // By hand: t^2/(1 - r^2).
        assert!((read(&optics, 0.0)[0] - 0.834 * 0.834 / (1.0 - 0.075 * 0.075)).abs() < 1e-9);
        for (angle, transmittance, reflectance) in [(60.0, 0.572, 0.225), (70.0, 0.432, 0.361)] {
            let [t, outer, inner] = read(&optics, angle);
            assert!((t - transmittance).abs() < 1e-3, "{angle}: {t}");
            assert!((1.0 - t - outer - inner - reflectance).abs() < 1e-3, "{angle}");
        }
        assert!((optics.front.transmittance - 0.601).abs() < 8e-3, "{}", optics.front.transmittance);
        assert!((optics.front.transmittance - optics.back.transmittance).abs() < 1e-12);
        // The unit is symmetric.
        assert!((optics.front.absorptance[0] - optics.back.absorptance[1]).abs() < 1e-12);
    }

    /// The horizon seen by a vertical pane: of the cosine itself pi/4; of the clear double unit more than of the dome.
    #[test]
    fn horizontal_means() {
        let angles: Vec<f64> = (0..=90).map(f64::from).collect();
        let units: Vec<_> = angles.iter().map(|a| vec![1.0, cosine(*a)]).collect();
        let curves = Curves::new(&angles, &units);
        for sine in [1.0, 0.5] {
            let means = curves.horizon(sine);
            assert!((means.transmittance - 1.0).abs() < 1e-12);
            let expected = sine * core::f64::consts::FRAC_PI_4;
            assert!((means.absorptance[0] - expected).abs() < 1e-4, "{}", means.absorptance[0]);
        }
        let optics = clear_double();
        let horizon = optics.beam.horizon(1.0).transmittance;
        assert!(horizon > optics.front.transmittance + 0.03 && horizon < 0.699, "{horizon}");
    }

    /// Hemispherical means of a constant and of the cosine itself: 1 and 2/3.
    #[test]
    fn hemispherical_means() {
        let angles = [0.0, 60.0, 90.0];
        let units: Vec<_> = angles.iter().map(|a| vec![1.0, cosine(*a)]).collect();
        let means = Curves::new(&angles, &units).diffuse();
        assert!((means.transmittance - 1.0).abs() < 1e-12);
        assert!((means.absorptance[0] - 2.0 / 3.0).abs() < 1e-12);
    }

    /// The curve goes through its table.
    #[test]
    fn through_the_table() {
        let angles = [0.0, 30.0, 60.0, 80.0, 90.0];
        let heights = [0.703, 0.692, 0.577, 0.208, 0.0];
        let units: Vec<_> = heights.iter().map(|t| vec![*t]).collect();
        let curves = Curves::new(&angles, &units);
        for (angle, height) in angles.into_iter().zip(heights) {
            let mut read = [0.0];
            curves.read(cosine(angle), 0, &mut read);
            assert!((read[0] - height).abs() < 1e-12, "{angle}");
        }
    }

    /// Twenty panes of clear glass, or one: never more than what arrives, whatever the angle.
    #[test]
    fn energy_is_kept() {
        for count in [1, 2, 3, 20] {
            let pane = PaneOptics {
                transmittance: ParamId(0),
                reflectance: [ParamId(1), ParamId(2)],
                coated: count == 3,
            };
            let optics = Optics::of_panes(&Values::new(&[0.6_f64, 0.2, 0.3]), &vec![pane; count]);
            let mut read = vec![0.0; count + 1];
            for k in 0..=100 {
                optics.beam.read(f64::from(k) / 100.0, 0, &mut read);
                let sum: f64 = read.iter().sum();
                assert!((-1e-12..=1.0 + 1e-12).contains(&sum), "{count}: {sum}");
                assert!(read.iter().all(|part| *part > -1e-12));
            }
        }
    }
}
