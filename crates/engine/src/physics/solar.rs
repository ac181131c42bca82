//! Short-wave radiation on a plane.
//!
//! The sun's direction and the horizontal radiation come with the forcing; transposition lives
//! here so that tilt, azimuth and albedo are parameters like others.
//!
//! Sources:
//! - Hay & Davies (1980), Calculation of the solar radiation incident on an inclined surface.
//! - Perez, Ineichen, Seals, Michalsky & Stewart (1990), Solar Energy 44(5), doi:10.1016/0038-092X(90)90055-H.
//! - Kasten & Young (1989), Applied Optics 28(22), doi:10.1364/AO.28.004735 (relative air mass).

use crate::input::description::DiffuseSky;
use crate::input::forcing::channel;
use crate::number::elementary::acos;
use crate::number::real::{Real, same};

/// The sun and its radiation at one instant, independent of any plane.
#[derive(Debug, Clone, Copy)]
pub struct Sunlight {
    /// Unit vector to the sun (east, north, up).
    pub direction: [f64; 3],
    /// Beam on a plane normal to it [W/m2]; zero below the horizon.
    pub direct_normal: f64,
    /// [W/m2].
    pub global_horizontal: f64,
    isotropic: f64,
    /// Multiplies `max(0, cos incidence)`: circumsolar diffuse [W/m2].
    circumsolar: f64,
    /// Multiplies sin(tilt): brightening of the horizon [W/m2].
    horizon: f64,
}

/// A plane as the sun sees it.
#[derive(Debug, Clone, Copy)]
pub struct Plane<S> {
    /// Outward normal (east, north, up).
    pub normal: [S; 3],
    /// Sine of the tilt.
    pub sin_tilt: S,
    /// Fraction of the sky seen.
    pub sky_view: S,
    /// Fraction of the ground seen, (1 - cos tilt)/2.
    pub ground_view: S,
}

impl<S: Real> Plane<S> {
    /// The same plane in numbers made of these.
    pub(crate) fn map<T>(&self, change: impl Fn(S) -> T) -> Plane<T> {
        let Self { normal, sin_tilt, sky_view, ground_view } = *self;
        Plane {
            normal: normal.map(&change),
            sin_tilt: change(sin_tilt),
            sky_view: change(sky_view),
            ground_view: change(ground_view),
        }
    }

    /// Whether another plane has the same numbers.
    pub(crate) fn same(&self, other: &Self) -> bool {
        let numbers = |plane: &Self| {
            let [east, north, up] = plane.normal;
            [east, north, up, plane.sin_tilt, plane.sky_view, plane.ground_view]
        };
        numbers(self).into_iter().zip(numbers(other)).all(|(a, b)| same(a, b))
    }
}

impl Sunlight {
    /// Reads a forcing row and splits the diffuse radiation by the model.
    #[must_use]
    pub fn new(row: &[f64], model: DiffuseSky) -> Self {
        let direction = [row[channel::SUN_EAST], row[channel::SUN_NORTH], row[channel::SUN_UP]];
        let up = direction[2];
        let direct_normal = if up > 0.0 { row[channel::DIRECT_NORMAL] } else { 0.0 };
        let diffuse = row[channel::DIFFUSE_HORIZONTAL];
        let extra = row[channel::DIRECT_NORMAL_EXTRA];
        let (circumsolar_share, horizon_share) = match model {
            DiffuseSky::Isotropic => (0.0, 0.0),
            DiffuseSky::HayDavies => (if extra > 0.0 { (direct_normal / extra).min(1.0) } else { 0.0 }, 0.0),
            DiffuseSky::Perez => perez_shares(up, direct_normal, diffuse, extra),
        };
        // Both models keep the sun at least 5 deg (Perez) or 1 deg above the horizon in the ratio of cosines.
        let lowest = Real::cos(if model == DiffuseSky::Perez { 85.0_f64 } else { 89.0 }.to_radians());
        Self {
            direction,
            direct_normal,
            global_horizontal: row[channel::GLOBAL_HORIZONTAL],
            isotropic: diffuse * (1.0 - circumsolar_share),
            circumsolar: diffuse * circumsolar_share / up.max(lowest),
            horizon: diffuse * horizon_share,
        }
    }

    /// Whether no light comes from anywhere.
    #[must_use]
    pub fn dark(&self) -> bool {
        let parts =
            [self.direct_normal, self.global_horizontal, self.isotropic, self.circumsolar, self.horizon];
        parts.iter().all(|part| *part == 0.0)
    }

    /// Whether light comes from the sun's direction.
    #[must_use]
    pub fn directed(&self) -> bool {
        self.direct_normal > 0.0 || self.circumsolar > 0.0
    }

    /// Irradiance on a plane [W/m2] of which shades leave some of the sky.
    #[must_use]
    #[inline(always)]
    pub fn on<S: Real>(&self, plane: &Plane<S>, ground_reflectance: S, open: &Open) -> Irradiance<S> {
        let n = &plane.normal;
        let cosine =
            n[0].scale(self.direction[0]) + n[1].scale(self.direction[1]) + n[2].scale(self.direction[2]);
        let facing = cosine.max(S::zero());
        let bright = facing.scale(self.circumsolar * open.sun);
        let sky = bright + plane.sky_view.scale(self.isotropic * open.sky);
        let ground = (ground_reflectance * plane.ground_view).scale(self.global_horizontal);
        // What Perez takes off the horizon may be more than the rest of the sky gives.
        let diffuse = (sky + plane.sin_tilt.scale(self.horizon * open.horizon)).max(S::zero());
        let circumsolar = bright.min(diffuse);
        let beam = facing.scale(self.direct_normal * open.sun);
        Irradiance { cosine: facing, beam, circumsolar, horizon: diffuse - sky, diffuse, ground }
    }
}

/// Shares of the sky that shades leave, 1 each in the open [-].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Open {
    /// Share of a surface that the sun's disc reaches.
    pub sun: f64,
    /// Of the isotropic sky.
    pub sky: f64,
    /// Of the horizon.
    pub horizon: f64,
}

impl Open {
    /// No shades.
    pub const ALL: Self = Self { sun: 1.0, sky: 1.0, horizon: 1.0 };
}

/// Short-wave radiation on a plane by where it comes from [W/m2].
#[derive(Debug, Clone, Copy)]
pub struct Irradiance<S> {
    /// Cosine of the angle of incidence of the sun's disc, 0 behind the plane [-].
    pub cosine: S,
    /// From the sun's disc.
    pub beam: S,
    /// From the bright sky around it: a part of `diffuse`.
    pub circumsolar: S,
    /// From the horizon, less than nothing where it is darker than the rest of the sky: a part of `diffuse`.
    pub horizon: S,
    /// From the sky, the parts around the sun and at the horizon included.
    pub diffuse: S,
    /// From the ground.
    pub ground: S,
}

impl<S: Real> Irradiance<S> {
    /// All of it.
    #[inline(always)]
    pub fn total(&self) -> S {
        self.beam + self.diffuse + self.ground
    }

    /// What comes from the sun's direction.
    #[inline(always)]
    pub fn directed(&self) -> S {
        self.beam + self.circumsolar
    }

    /// What comes from everywhere alike.
    #[inline(always)]
    pub fn scattered(&self) -> S {
        self.diffuse - self.circumsolar - self.horizon + self.ground
    }
}

/// Perez brightness coefficients F11 F12 F13 F21 F22 F23 by clearness bin ("all sites composite 1990").
const PEREZ: [[f64; 6]; 8] = [
    [-0.008, 0.588, -0.062, -0.060, 0.072, -0.022],
    [0.130, 0.683, -0.151, -0.019, 0.066, -0.029],
    [0.330, 0.487, -0.221, 0.055, -0.064, -0.026],
    [0.568, 0.187, -0.295, 0.109, -0.152, -0.014],
    [0.873, -0.392, -0.362, 0.226, -0.462, 0.001],
    [1.132, -1.237, -0.412, 0.288, -0.823, 0.056],
    [1.060, -1.600, -0.359, 0.264, -1.127, 0.131],
    [0.678, -0.327, -0.250, 0.156, -1.377, 0.251],
];
/// Upper edges of the clearness bins.
const PEREZ_BINS: [f64; 7] = [1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2];

/// Circumsolar and horizon shares of the diffuse radiation.
fn perez_shares(up: f64, direct: f64, diffuse: f64, extra: f64) -> (f64, f64) {
    if diffuse <= 0.0 || extra <= 0.0 {
        return (0.0, 0.0);
    }
    let zenith = acos(up.clamp(-1.0, 1.0)).min(core::f64::consts::FRAC_PI_2);
    let cube = 1.041 * zenith * zenith * zenith;
    let clearness = ((diffuse + direct) / diffuse + cube) / (1.0 + cube);
    let elevation = 90.0 - zenith.to_degrees();
    let air_mass = 1.0 / (Real::cos(zenith) + 0.50572 * Real::powf(elevation + 6.07995, -1.6364));
    let brightness = diffuse * air_mass / extra;
    let f = &PEREZ[PEREZ_BINS.iter().filter(|&&edge| clearness >= edge).count()];
    let circumsolar = (f[0] + f[1] * brightness + f[2] * zenith).max(0.0);
    (circumsolar, f[3] + f[4] * brightness + f[5] * zenith)
}
