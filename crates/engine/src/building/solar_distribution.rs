//! Where the sun that windows transmit into a zone is absorbed.
//!
//! Opaque surfaces absorb by their solar absorptance. Glass absorbs in its panes, transmits a part outdoors and reflects the
//! rest. All that is transmitted into the zone is absorbed or lost: the fractions sum to one.
//!
//! By area: the irradiance is the same on all surfaces, as in an integrating sphere. By given shares, those of beam and diffuse
//! radiation may differ. The beam on the floor: what the floor reflects is distributed by area. By geometry: the beam is
//! incident where its rays end (see [`geometry::patches`](crate::geometry::patches)), diffuse radiation by the view factors
//! from the window. What a surface reflects is diffuse and is incident by the view factors of the zone: the radiosity of its
//! surfaces (Hottel & Sarofim 1967, Radiative Transfer, ch. 3), solved once per run.

use crate::input::description::{ParamId, ZoneSun};
use crate::input::values::Values;
use crate::number::dense::solve_many;
use crate::number::real::Real;
use crate::physics::optics::Diffuse;

/// A surface of a zone, and what it does with the sun.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SolarSurface<'a, S> {
    /// [m2].
    pub(crate) area: S,
    /// Solar absorptance, where it is opaque [-].
    pub(crate) absorptance: S,
    /// Optics of glass for diffuse radiation from inside; none: opaque.
    pub(crate) glass: Option<&'a Diffuse<S>>,
    /// Whether what the glass transmits enters another zone; else it is lost outdoors.
    pub(crate) passes: bool,
}

impl<S: Real> SolarSurface<'_, S> {
    /// Fraction that is not reflected [-].
    fn admitted(&self) -> S {
        self.glass.map_or(self.absorptance, Diffuse::admitted)
    }

    /// What glass loses outdoors of the power on it [W].
    fn lost(&self, glass: &Diffuse<S>, on: S) -> S {
        if self.passes { S::zero() } else { on * glass.transmittance }
    }
}

/// Where the transmitted sun is absorbed, for the surfaces of a zone in their order.
#[derive(Debug, Clone)]
pub enum SolarDistribution<S> {
    /// By fractions that do not depend on the direction of the sun.
    Fixed(FixedDistribution<S>),
    /// By such fractions of the beam and of diffuse radiation.
    Split([FixedDistribution<S>; 2]),
    /// By the geometry of the zone.
    Traced(TracedDistribution<S>),
}

/// Fractions of each watt of transmitted sun.
#[derive(Debug, Clone)]
pub struct FixedDistribution<S> {
    /// Absorbed per square metre of an opaque surface; zero for glass [1/m2].
    pub absorbed: Vec<S>,
    /// Irradiance on the inside of glass; zero for opaque surfaces [1/m2].
    pub on_glass: Vec<S>,
    /// Absorbed in all glass [-].
    pub in_glass: S,
    /// Transmitted outdoors by all glass [-].
    pub lost: S,
}

/// View factors and reflections of a zone in which beams are traced.
#[derive(Debug, Clone)]
pub struct TracedDistribution<S> {
    /// View factor from surface i to surface j, by row [-].
    pub views: Vec<S>,
    /// Irradiance of surface i per watt of first incidence on surface j, all reflections included, by row [1/m2].
    pub irradiances: Vec<S>,
}

impl<S: Real> SolarDistribution<S> {
    /// Evaluates the law of a zone; none where it has no windows. `exchange` gives `A_i F_ij` [m2].
    pub(crate) fn new(
        law: &ZoneSun,
        surfaces: &[SolarSurface<'_, S>],
        values: &Values<'_, S>,
        exchange: impl FnOnce() -> Vec<S>,
    ) -> Option<Self> {
        if surfaces.iter().all(|surface| surface.glass.is_none()) {
            return None;
        }
        Some(match law {
            ZoneSun::Area => Self::Fixed(FixedDistribution::by_area(surfaces)),
            ZoneSun::Shares { surfaces: shares, lost, diffuse } => {
                let of = |share: &Option<ParamId>| values.get_or(*share, 0.0);
                let given = |shares: &[Option<ParamId>], lost| {
                    let shares: Vec<S> = shares.iter().map(of).collect();
                    FixedDistribution::by_shares(surfaces, &shares, of(lost))
                };
                let all = given(shares, lost);
                match diffuse {
                    Some(diffuse) => Self::Split([all, given(&diffuse.faces, &diffuse.lost)]),
                    None => Self::Fixed(all),
                }
            }
            ZoneSun::Floor { floor } => {
                let even = FixedDistribution::by_area(surfaces);
                Self::Split([FixedDistribution::on_floor(surfaces, floor, &even), even])
            }
            ZoneSun::Geometry => Self::Traced(TracedDistribution::new(surfaces, &exchange())),
        })
    }
}

impl<S: Real> FixedDistribution<S> {
    fn none(surfaces: usize) -> Self {
        let zeros = vec![S::zero(); surfaces];
        Self { absorbed: zeros.clone(), on_glass: zeros, in_glass: S::zero(), lost: S::zero() }
    }

    /// The same irradiance on all surfaces.
    fn by_area(surfaces: &[SolarSurface<'_, S>]) -> Self {
        let mut distribution = Self::none(surfaces.len());
        let all = surfaces.iter().fold(S::zero(), |sum, surface| sum + surface.area * surface.admitted());
        let irradiance = S::one() / all;
        for (i, surface) in surfaces.iter().enumerate() {
            if let Some(glass) = surface.glass {
                let on = surface.area * irradiance;
                distribution.on_glass[i] = irradiance;
                distribution.lost += surface.lost(glass, on);
                distribution.in_glass += on * (glass.admitted() - glass.transmittance);
            } else {
                distribution.absorbed[i] = irradiance * surface.absorptance;
            }
        }
        distribution
    }

    /// The same irradiance on the floor; what it reflects as `even`.
    fn on_floor(surfaces: &[SolarSurface<'_, S>], floor: &[bool], even: &Self) -> Self {
        let lit = || surfaces.iter().enumerate().filter(|(i, _)| floor[*i]);
        let irradiance = S::one() / lit().fold(S::zero(), |sum, (_, surface)| sum + surface.area);
        let mut reflected = S::zero();
        for (_, surface) in lit() {
            reflected += surface.area * irradiance * (S::one() - surface.admitted());
        }
        let scaled = |numbers: &[S]| numbers.iter().map(|&number| number * reflected).collect();
        let mut distribution = Self {
            absorbed: scaled(&even.absorbed),
            on_glass: scaled(&even.on_glass),
            in_glass: even.in_glass * reflected,
            lost: even.lost * reflected,
        };
        for (i, surface) in lit() {
            distribution.add(i, surface, irradiance);
        }
        distribution
    }

    /// Adds what a surface does with an irradiance [1/m2].
    fn add(&mut self, i: usize, surface: &SolarSurface<'_, S>, irradiance: S) {
        if let Some(glass) = surface.glass {
            let on = surface.area * irradiance;
            self.on_glass[i] += irradiance;
            self.lost += surface.lost(glass, on);
            self.in_glass += on * (glass.admitted() - glass.transmittance);
        } else {
            self.absorbed[i] += irradiance * surface.absorptance;
        }
    }

    /// Given shares, scaled to a sum of one with what is lost.
    fn by_shares(surfaces: &[SolarSurface<'_, S>], shares: &[S], lost: S) -> Self {
        let mut distribution = Self::none(surfaces.len());
        let sum = shares.iter().fold(lost, |sum, &share| sum + share);
        for ((absorbed, surface), &share) in distribution.absorbed.iter_mut().zip(surfaces).zip(shares) {
            *absorbed = share / (sum * surface.area);
        }
        distribution.lost = lost / sum;
        distribution
    }
}

impl<S: Real> TracedDistribution<S> {
    /// Solves `G_i - sum_j F_ji r_j G_j = P_i` for the power G on each surface, P the power of first incidence.
    fn new(surfaces: &[SolarSurface<'_, S>], exchange: &[S]) -> Self {
        let n = surfaces.len();
        let reflected: Vec<S> = surfaces.iter().map(|surface| S::one() - surface.admitted()).collect();
        let mut views = exchange.to_vec();
        for (row, surface) in views.chunks_exact_mut(n).zip(surfaces) {
            let inverse = S::one() / surface.area;
            for view in row {
                *view = *view * inverse;
            }
        }
        let unit = |i: usize, j: usize| if i == j { S::one() } else { S::zero() };
        let mut matrix: Vec<S> =
            (0..n * n).map(|k| unit(k / n, k % n) - views[(k % n) * n + k / n] * reflected[k % n]).collect();
        let mut irradiances: Vec<S> = (0..n * n).map(|k| unit(k / n, k % n)).collect();
        solve_many(&mut matrix, &mut irradiances, n);
        for (row, surface) in irradiances.chunks_exact_mut(n).zip(surfaces) {
            let inverse = S::one() / surface.area;
            for power in row {
                *power = *power * inverse;
            }
        }
        Self { views, irradiances }
    }

    /// Number of surfaces.
    pub(crate) fn size(&self) -> usize {
        self.views.len().isqrt()
    }

    /// Irradiance of a surface [W/m2] from the power of first incidence on each [W].
    #[inline(always)]
    pub fn irradiance(&self, surface: usize, incidence: &[S]) -> S {
        let row = &self.irradiances[surface * incidence.len()..(surface + 1) * incidence.len()];
        let mut sum = S::zero();
        for (&irradiance, &power) in row.iter().zip(incidence) {
            sum += irradiance * power;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opaque(area: f64, absorptance: f64) -> SolarSurface<'static, f64> {
        SolarSurface { area, absorptance, glass: None, passes: false }
    }

    /// By area the irradiance is 1/sum(A a); what is absorbed, taken up by the glass and lost sums to one.
    #[test]
    fn by_area_every_watt_is_accounted_for() {
        let glass = Diffuse { transmittance: 0.6, absorptance: vec![0.1, 0.05] };
        let window = SolarSurface { area: 2.0, absorptance: 0.0, glass: Some(&glass), passes: false };
        let surfaces = [opaque(10.0, 0.6), opaque(20.0, 0.3), window];
        let distribution = FixedDistribution::by_area(&surfaces);
        let irradiance = 1.0 / (10.0 * 0.6 + 20.0 * 0.3 + 2.0 * 0.75);
        assert!((distribution.on_glass[2] - irradiance).abs() < 1e-15);
        assert!((distribution.absorbed[1] - 0.3 * irradiance).abs() < 1e-15);
        assert!((distribution.lost - 2.0 * 0.6 * irradiance).abs() < 1e-15);
        let absorbed = 10.0 * distribution.absorbed[0] + 20.0 * distribution.absorbed[1];
        assert!((absorbed + distribution.lost + distribution.in_glass - 1.0).abs() < 1e-14);
    }

    /// A watt of beam on a floor of absorptance 0.6: 0.4 W are reflected and distributed by area.
    #[test]
    fn on_the_floor_every_watt_is_accounted_for() {
        let glass = Diffuse { transmittance: 0.6, absorptance: vec![0.1, 0.05] };
        let window = SolarSurface { area: 2.0, absorptance: 0.0, glass: Some(&glass), passes: false };
        let surfaces = [opaque(10.0, 0.6), opaque(20.0, 0.3), window];
        let even = FixedDistribution::by_area(&surfaces);
        let beam = FixedDistribution::on_floor(&surfaces, &[true, false, false], &even);
        let irradiance = 1.0 / (10.0 * 0.6 + 20.0 * 0.3 + 2.0 * 0.75);
        assert!((beam.absorbed[0] - 0.6 * (0.1 + 0.4 * irradiance)).abs() < 1e-15);
        assert!((beam.absorbed[1] - 0.3 * 0.4 * irradiance).abs() < 1e-15);
        let absorbed = 10.0 * beam.absorbed[0] + 20.0 * beam.absorbed[1];
        assert!((absorbed + beam.lost + beam.in_glass - 1.0).abs() < 1e-14);
    }

    /// Shares of 1, 3 and 1 lost are 0.2, 0.6 and 0.2.
    #[test]
    fn shares_are_scaled() {
        let surfaces = [opaque(10.0, 0.6), opaque(20.0, 0.3)];
        let distribution = FixedDistribution::by_shares(&surfaces, &[1.0, 3.0], 1.0);
        assert!((distribution.absorbed[0] - 0.02).abs() < 1e-15);
        assert!((distribution.absorbed[1] - 0.03).abs() < 1e-15 && (distribution.lost - 0.2).abs() < 1e-15);
    }

    /// Between two parallel plates a watt that is incident on the first is reflected back and forth:
    /// `G_1 = 1/(1 - r_1 r_2)`, `G_2 = r_1 G_1`.
    #[test]
    fn reflections_between_two_plates() {
        let (surfaces, reflected) = ([opaque(4.0, 0.3), opaque(4.0, 0.8)], [0.7, 0.2]);
        let traced = TracedDistribution::new(&surfaces, &[0.0, 4.0, 4.0, 0.0]);
        let first = 1.0 / (1.0 - reflected[0] * reflected[1]);
        assert!((traced.irradiance(0, &[1.0, 0.0]) - first / 4.0).abs() < 1e-15);
        assert!((traced.irradiance(1, &[1.0, 0.0]) - reflected[0] * first / 4.0).abs() < 1e-15);
        let absorbed =
            4.0 * (0.3 * traced.irradiance(0, &[1.0, 0.0]) + 0.8 * traced.irradiance(1, &[1.0, 0.0]));
        assert!((absorbed - 1.0).abs() < 1e-14);
    }
}
