//! Short-wave radiation on a plane.
//!
//! The sun's direction and the horizontal radiation come with the forcing; transposition is done
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

/// Orientation of a plane and what it sees of sky and ground.
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

/// Cosines of the zenith angles 85 and 89 deg: in the ratio of cosines the sun stays at least 5 deg (Perez) or 1 deg (Hay and
/// Davies) above the horizon.
const COS_85: f64 = 0.08715574274765814;
const COS_89: f64 = 0.0174524064372836;

impl Sunlight {
    /// Reads a forcing row and splits the diffuse radiation by the model.
    #[must_use]
    pub fn new(row: &[f64], model: DiffuseSky) -> Self {
        let direction = [row[channel::SUN_EAST], row[channel::SUN_NORTH], row[channel::SUN_UP]];
        let up = direction[2];
        let direct_normal = if up > 0.0 { row[channel::DIRECT_NORMAL] } else { 0.0 };
        let diffuse = row[channel::DIFFUSE_HORIZONTAL];
        let extra = row[channel::DIRECT_NORMAL_EXTRA];
        let (circumsolar_fraction, horizon_fraction) = match model {
            DiffuseSky::Isotropic => (0.0, 0.0),
            DiffuseSky::HayDavies => (if extra > 0.0 { (direct_normal / extra).min(1.0) } else { 0.0 }, 0.0),
            DiffuseSky::Perez => perez_fractions(up, direct_normal, diffuse, extra),
        };
        let lowest = if model == DiffuseSky::Perez { COS_85 } else { COS_89 };
        Self {
            direction,
            direct_normal,
            global_horizontal: row[channel::GLOBAL_HORIZONTAL],
            isotropic: diffuse * (1.0 - circumsolar_fraction),
            circumsolar: diffuse * circumsolar_fraction / up.max(lowest),
            horizon: diffuse * horizon_fraction,
        }
    }

    /// Takes away what comes from the direction of the sun, on the ground as well.
    pub(crate) fn hide_sun(&mut self) {
        let beam = self.direct_normal * self.direction[2].max(0.0);
        self.global_horizontal = (self.global_horizontal - beam).max(0.0);
        (self.direct_normal, self.circumsolar) = (0.0, 0.0);
    }

    /// Whether there is no short-wave radiation at all.
    #[must_use]
    pub fn dark(&self) -> bool {
        let parts =
            [self.direct_normal, self.global_horizontal, self.isotropic, self.circumsolar, self.horizon];
        parts.iter().all(|part| *part == 0.0)
    }

    /// Whether there is radiation from the sun's direction.
    #[must_use]
    pub fn directed(&self) -> bool {
        self.direct_normal > 0.0 || self.circumsolar > 0.0
    }

    /// Irradiance on a plane [W/m2] that sees a part of sun and sky.
    #[must_use]
    #[inline(always)]
    pub fn on<S: Real>(
        &self,
        plane: &Plane<S>,
        ground_reflectance: S,
        visible: &SkyVisibility,
    ) -> Irradiance<S> {
        let n = &plane.normal;
        let cosine =
            n[0].scale(self.direction[0]) + n[1].scale(self.direction[1]) + n[2].scale(self.direction[2]);
        let facing = cosine.max(S::zero());
        let bright = facing.scale(self.circumsolar * visible.sun);
        let sky = bright + plane.sky_view.scale(self.isotropic * visible.sky);
        let ground = (ground_reflectance * plane.ground_view).scale(self.global_horizontal * visible.ground);
        // The negative horizon term of Perez may exceed the rest of the sky.
        let diffuse = (sky + plane.sin_tilt.scale(self.horizon * visible.horizon)).max(S::zero());
        let circumsolar = bright.min(diffuse);
        let beam = facing.scale(self.direct_normal * visible.sun);
        Irradiance { cosine: facing, beam, circumsolar, horizon: diffuse - sky, diffuse, ground }
    }
}

/// Which part of sun, sky and ground a shaded surface sees; 1 each without obstacles [-].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkyVisibility {
    /// Fraction of the surface that the sun's disc reaches.
    pub sun: f64,
    /// Fraction of the isotropic sky.
    pub sky: f64,
    /// Fraction of the horizon.
    pub horizon: f64,
    /// Fraction of the ground.
    pub ground: f64,
}

impl SkyVisibility {
    /// No obstacles.
    pub const FULL: Self = Self { sun: 1.0, sky: 1.0, horizon: 1.0, ground: 1.0 };
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
    /// From the horizon, negative where it is darker than the rest of the sky: a part of `diffuse`.
    pub horizon: S,
    /// From the sky, the parts around the sun and at the horizon included.
    pub diffuse: S,
    /// From the ground.
    pub ground: S,
}

impl<S: Real> Irradiance<S> {
    /// Sum of all parts.
    #[inline(always)]
    pub fn total(&self) -> S {
        self.beam + self.diffuse + self.ground
    }

    /// The same parts of a measured sum [W/m2].
    #[inline(always)]
    pub fn measured(&self, sum: f64) -> Self {
        let factor = S::constant(sum.max(0.0)) / self.total().max(S::constant(1e-6));
        Self {
            cosine: self.cosine,
            beam: self.beam * factor,
            circumsolar: self.circumsolar * factor,
            horizon: self.horizon * factor,
            diffuse: self.diffuse * factor,
            ground: self.ground * factor,
        }
    }

    /// From the sun's direction: beam and circumsolar.
    #[inline(always)]
    pub fn directed(&self) -> S {
        self.beam + self.circumsolar
    }

    /// Isotropic: from the sky without sun and horizon, and from the ground.
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

/// Circumsolar and horizon fractions of the diffuse radiation by sky clearness and sky
/// brightness (Perez et al. 1990).
fn perez_fractions(up: f64, direct: f64, diffuse: f64, extra: f64) -> (f64, f64) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::forcing::CLIMATE_CHANNELS;

    /// A wall towards the east, the sun in the east 30 deg above the horizon: 400 W/m2 of beam (1000 W/m2 outside the
    /// atmosphere), 100 W/m2 of diffuse and 300 W/m2 of global horizontal radiation, ground reflectance 0.2.
    fn on_wall(model: DiffuseSky, visible: &SkyVisibility) -> Irradiance<f64> {
        let mut row = [0.0; CLIMATE_CHANNELS];
        (row[channel::SUN_EAST], row[channel::SUN_UP]) = (0.75_f64.sqrt(), 0.5);
        (row[channel::DIRECT_NORMAL], row[channel::DIRECT_NORMAL_EXTRA]) = (400.0, 1000.0);
        (row[channel::DIFFUSE_HORIZONTAL], row[channel::GLOBAL_HORIZONTAL]) = (100.0, 300.0);
        let wall = Plane { normal: [1.0, 0.0, 0.0], sin_tilt: 1.0, sky_view: 0.5, ground_view: 0.5 };
        Sunlight::new(&row, model).on(&wall, 0.2, visible)
    }

    fn assert_close(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} is not {expected}");
    }

    #[test]
    fn lowest_elevations() {
        for (cosine, zenith) in [(COS_85, 85.0_f64), (COS_89, 89.0)] {
            assert_eq!(cosine.to_bits(), Real::cos(zenith.to_radians()).to_bits(), "{zenith} deg");
        }
    }

    /// Beam 400 0.75^1/2 = 346.410, ground 0.2 0.5 300 = 30. Diffuse: isotropic 50; Hay & Davies with A = 0.4
    /// 0.6 50 + 0.4 100 0.75^1/2/0.5 = 99.2820; Perez with clearness 2.8219, brightness 0.19943, F1 = 0.453861, F2 = 0.182513: 124.1692.
    #[test]
    fn a_wall_by_hand() {
        let diffuse =
            [(DiffuseSky::Isotropic, 50.0), (DiffuseSky::HayDavies, 99.2820), (DiffuseSky::Perez, 124.1692)];
        for (model, diffuse) in diffuse {
            let found = on_wall(model, &SkyVisibility::FULL);
            assert_close(found.beam, 346.410);
            assert_close(found.ground, 30.0);
            assert_close(found.diffuse, diffuse);
            assert_close(found.total(), 376.410 + diffuse);
            assert_close(found.directed() + found.scattered() + found.horizon, found.total());
        }
    }

    /// A surface that sees a quarter of the sun's disc, half of the sky and a fifth of the ground.
    #[test]
    fn shades_take_their_parts() {
        let visible = SkyVisibility { sun: 0.25, sky: 0.5, horizon: 1.0, ground: 0.2 };
        let found = on_wall(DiffuseSky::HayDavies, &visible);
        assert_close(found.beam, 0.25 * 346.410);
        assert_close(found.diffuse, 0.5 * 30.0 + 0.25 * 69.2820);
        assert_close(found.ground, 6.0);
    }
}
