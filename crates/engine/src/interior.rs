//! Where the sun that enters a zone lands.
//!
//! What a window lets in falls on the zone's faces. Opaque faces absorb by their solar absorptance. Glass absorbs in its
//! panes, lets part out again and reflects the rest. All that is transmitted is absorbed or lost: the shares sum to one.
//!
//! By area: the sun is spread until every square metre of the zone gets the same, as in an integrating sphere.
//! By geometry: what comes from the sun's direction lands where its rays end (see `daylight.rs`), all else by the view
//! factors from the window. What a face reflects goes out diffusely and lands by the view factors of the zone: the
//! radiosity of its faces, solved once per run.

use crate::coefficients::{Face, Wall};
use crate::description::ZoneSun;
use crate::optics::Diffuse;
use crate::parameters::Values;
use crate::plan::FaceId;
use crate::radiation::solve_many;
use crate::real::Real;

/// The faces of a zone and their numbers.
#[derive(Debug, Clone, Copy)]
pub struct Inside<'a, S> {
    /// Faces of the zone.
    pub zone_faces: &'a [FaceId],
    /// Their areas [m2].
    pub areas: &'a [S],
    /// All walls.
    pub walls: &'a [Wall<S>],
    /// All faces.
    pub faces: &'a [Face<S>],
}

/// View factors and reflections of a zone in which the sun is followed.
#[derive(Debug, Clone)]
pub struct Traced<S> {
    /// Share of what leaves face i diffusely that arrives at face j without reflection, by row [-].
    pub views: Vec<S>,
    /// Irradiance of face i per watt that lands first on face j, by row [1/m2].
    pub spread: Vec<S>,
}

/// Where each watt of transmitted sun goes, for the faces of a zone in their order.
#[derive(Debug, Clone)]
pub struct Landing<S> {
    /// Absorbed per square metre of an opaque face; zero for glass [1/m2].
    pub absorbed: Vec<S>,
    /// Irradiance on the inside of glass; zero for opaque faces [1/m2].
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
        let Inside { zone_faces, areas, walls, faces } = *inside;
        let glass = |face: FaceId| walls[face / 2].glass.as_ref().map(|glass| &glass.optics.back);
        if zone_faces.iter().all(|&face| glass(face).is_none()) {
            return None;
        }
        let taken = |face: FaceId| glass(face).map_or(faces[face].absorptance, Diffuse::admitted);
        let n = zone_faces.len();
        let mut landing = Self {
            absorbed: vec![S::zero(); n],
            on_glass: vec![S::zero(); n],
            in_glass: S::zero(),
            lost: S::zero(),
            traced: None,
        };
        match law {
            ZoneSun::Area => {
                let all = zone_faces
                    .iter()
                    .zip(areas)
                    .fold(S::zero(), |sum, (&face, &area)| sum + area * taken(face));
                let everywhere = S::one() / all;
                for (i, &face) in zone_faces.iter().enumerate() {
                    if let Some(back) = glass(face) {
                        let on = areas[i] * everywhere;
                        landing.on_glass[i] = everywhere;
                        landing.lost += on * back.transmittance;
                        landing.in_glass += on * (back.admitted() - back.transmittance);
                    } else {
                        landing.absorbed[i] = everywhere * faces[face].absorptance;
                    }
                }
            }
            ZoneSun::Shares { faces: shares, lost } => {
                let of = |share: &Option<_>| values.get_or(*share, 0.0);
                let sum = shares.iter().fold(of(lost), |sum, share| sum + of(share));
                for (i, share) in shares.iter().enumerate() {
                    landing.absorbed[i] = of(share) / (sum * areas[i]);
                }
                landing.lost = of(lost) / sum;
            }
            ZoneSun::Geometry => {
                let reflected: Vec<S> = zone_faces.iter().map(|&face| S::one() - taken(face)).collect();
                landing.traced = Some(Traced::new(areas, &reflected, &exchange()));
            }
        }
        Some(landing)
    }
}

impl<S: Real> Traced<S> {
    /// Solves `G_i - sum_j F_ji r_j G_j = P_i` for the power G on each face, P the power that lands first.
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

    /// Irradiance of a face [W/m2] from the power that lands first on each [W].
    #[inline(always)]
    pub fn irradiance(&self, face: usize, first: &[S]) -> S {
        let row = &self.spread[face * first.len()..(face + 1) * first.len()];
        let mut sum = S::zero();
        for (&spread, &power) in row.iter().zip(first) {
            sum += spread * power;
        }
        sum
    }
}
