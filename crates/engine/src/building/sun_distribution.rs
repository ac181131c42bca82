//! Where the sun that enters a zone lands.
//!
//! What a window lets in falls on the zone's surfaces. Opaque surfaces absorb by their solar absorptance. Glass absorbs in its
//! panes, lets part out again and reflects the rest. All that is transmitted is absorbed or lost: the shares sum to one.
//!
//! By area: the sun is spread until every square metre of the zone gets the same, as in an integrating sphere.
//! By geometry: what comes from the sun's direction lands where its rays end (see `daylight.rs`), all else by the view
//! factors from the window. What a surface reflects goes out diffusely and lands by the view factors of the zone: the
//! radiosity of its surfaces, solved once per run.

use crate::building::coefficients::{SurfaceCoefficients, WallCoefficients};
use crate::building::ids::{BySurface, SurfaceId};
use crate::input::description::ZoneSun;
use crate::input::values::Values;
use crate::number::dense::solve_many;
use crate::number::real::Real;
use crate::physics::optics::Diffuse;

/// The surfaces of a zone and their numbers.
#[derive(Debug, Clone, Copy)]
pub struct Inside<'a, S> {
    /// Surfaces of the zone.
    pub zone_surfaces: &'a [SurfaceId],
    /// Their areas [m2].
    pub areas: &'a [S],
    /// All walls.
    pub walls: &'a [WallCoefficients<S>],
    /// All surfaces.
    pub surfaces: &'a BySurface<SurfaceCoefficients<S>>,
}

/// View factors and reflections of a zone in which the sun is followed.
#[derive(Debug, Clone)]
pub struct Traced<S> {
    /// Share of what leaves surface i diffusely that arrives at surface j without reflection, by row [-].
    pub views: Vec<S>,
    /// Irradiance of surface i per watt that lands first on surface j, by row [1/m2].
    pub spread: Vec<S>,
}

/// Where each watt of transmitted sun goes, for the surfaces of a zone in their order.
#[derive(Debug, Clone)]
pub struct Landing<S> {
    /// Absorbed per square metre of an opaque surface; zero for glass [1/m2].
    pub absorbed: Vec<S>,
    /// Irradiance on the inside of glass; zero for opaque surfaces [1/m2].
    pub on_glass: Vec<S>,
    /// Absorbed in all glass [-].
    pub in_glass: S,
    /// Leaves through all glass [-].
    pub lost: S,
    /// Where the sun is followed the four above are idle, and this acts.
    pub traced: Option<Traced<S>>,
}

impl<S: Real> Landing<S> {
    /// Evaluates the law of a zone; none where it has no windows. `exchange` gives `A_i F_ij` [m2].
    pub fn new(
        law: &ZoneSun,
        inside: &Inside<'_, S>,
        values: &Values<'_, S>,
        exchange: impl FnOnce() -> Vec<S>,
    ) -> Option<Self> {
        let Inside { zone_surfaces, areas, walls, surfaces } = *inside;
        let glass = |surface: SurfaceId| walls[surface.wall()].glass.as_ref().map(|glass| &glass.optics.back);
        if zone_surfaces.iter().all(|&surface| glass(surface).is_none()) {
            return None;
        }
        let taken =
            |surface: SurfaceId| glass(surface).map_or(surfaces[surface].absorptance, Diffuse::admitted);
        let n = zone_surfaces.len();
        let mut landing = Self {
            absorbed: vec![S::zero(); n],
            on_glass: vec![S::zero(); n],
            in_glass: S::zero(),
            lost: S::zero(),
            traced: None,
        };
        match law {
            ZoneSun::Area => {
                let all = zone_surfaces
                    .iter()
                    .zip(areas)
                    .fold(S::zero(), |sum, (&surface, &area)| sum + area * taken(surface));
                let everywhere = S::one() / all;
                for (i, &surface) in zone_surfaces.iter().enumerate() {
                    if let Some(back) = glass(surface) {
                        let on = areas[i] * everywhere;
                        landing.on_glass[i] = everywhere;
                        landing.lost += on * back.transmittance;
                        landing.in_glass += on * (back.admitted() - back.transmittance);
                    } else {
                        landing.absorbed[i] = everywhere * surfaces[surface].absorptance;
                    }
                }
            }
            ZoneSun::Shares { surfaces: shares, lost } => {
                let of = |share: &Option<_>| values.get_or(*share, 0.0);
                let sum = shares.iter().fold(of(lost), |sum, share| sum + of(share));
                for (i, share) in shares.iter().enumerate() {
                    landing.absorbed[i] = of(share) / (sum * areas[i]);
                }
                landing.lost = of(lost) / sum;
            }
            ZoneSun::Geometry => {
                let reflected: Vec<S> =
                    zone_surfaces.iter().map(|&surface| S::one() - taken(surface)).collect();
                landing.traced = Some(Traced::new(areas, &reflected, &exchange()));
            }
        }
        Some(landing)
    }
}

impl<S: Real> Traced<S> {
    /// Solves `G_i - sum_j F_ji r_j G_j = P_i` for the power G on each surface, P the power that lands first.
    fn new(areas: &[S], reflected: &[S], exchange: &[S]) -> Self {
        let n = areas.len();
        let mut views = exchange.to_vec();
        for (row, &area) in views.chunks_exact_mut(n).zip(areas) {
            let inverse = S::one() / area;
            for view in row {
                *view = *view * inverse;
            }
        }
        let unit = |i: usize, j: usize| if i == j { S::one() } else { S::zero() };
        let mut matrix: Vec<S> =
            (0..n * n).map(|k| unit(k / n, k % n) - views[(k % n) * n + k / n] * reflected[k % n]).collect();
        let mut spread: Vec<S> = (0..n * n).map(|k| unit(k / n, k % n)).collect();
        solve_many(&mut matrix, &mut spread, n);
        for (row, &area) in spread.chunks_exact_mut(n).zip(areas) {
            let inverse = S::one() / area;
            for power in row {
                *power = *power * inverse;
            }
        }
        Self { views, spread }
    }

    /// Irradiance of a surface [W/m2] from the power that lands first on each [W].
    #[inline(always)]
    pub fn irradiance(&self, surface: usize, first: &[S]) -> S {
        let row = &self.spread[surface * first.len()..(surface + 1) * first.len()];
        let mut sum = S::zero();
        for (&spread, &power) in row.iter().zip(first) {
            sum += spread * power;
        }
        sum
    }
}
