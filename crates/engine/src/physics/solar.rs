//! Short-wave radiation on a plane.
//!
//! The sun's direction and the horizontal radiation come with the forcing; transposition is done
//! here so that tilt, azimuth and albedo are parameters like others.
//!
//! Models of the diffuse radiation: `physics/diffuse`.

use crate::input::forcing::channel;
use crate::number::real::{Mask, Real, same};
use crate::physics::diffuse::DiffuseSky;
use crate::physics::diffuse::model::{DiffuseSun, Fractions};

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
    /// Extraterrestrial normal irradiance, which sun and sky together do not exceed on any plane [W/m2]; infinite where it is unknown.
    most: f64,
    /// Whether they could on some plane.
    bounded: bool,
}

/// What short-wave radiation on a plane cannot exceed [W/m2]: all that arrives from outside of the atmosphere, extraterrestrial
/// normal irradiance, falls at right angles on it, and what the ground reflects of as much. In numbers of the plane: the fraction
/// of the ground that it sees and the reflectance of the ground [-].
#[must_use]
pub(crate) fn greatest_irradiance<S: Real>(
    extraterrestrial: f64,
    ground_reflectance: S,
    ground_view: S,
) -> S {
    (S::one() + ground_reflectance * ground_view).scale(extraterrestrial)
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

/// A measured irradiance, without the zero offset of its pyranometer by night [W/m2]. What is not a number stays so.
#[inline(always)]
pub(crate) fn not_negative(irradiance: f64) -> f64 {
    if irradiance < 0.0 { 0.0 } else { irradiance }
}

impl Sunlight {
    /// Reads a forcing row and splits the diffuse radiation by the model.
    #[must_use]
    pub fn new(row: &[f64], model: DiffuseSky) -> Self {
        let direction = [row[channel::SUN_EAST], row[channel::SUN_NORTH], row[channel::SUN_UP]];
        let up = direction[2];
        let extra = row[channel::DIRECT_NORMAL_EXTRA];
        // Nothing exceeds what arrives from outside of the atmosphere, where that is known, and nothing is below zero: a pyranometer by night,
        // whose dome is colder than its sensor, shows some watts less.
        let most = if extra > 0.0 { extra } else { f64::INFINITY };
        let [direct, diffuse, global] =
            [channel::DIRECT_NORMAL, channel::DIFFUSE_HORIZONTAL, channel::GLOBAL_HORIZONTAL]
                .map(|channel| not_negative(row[channel]).min(most));
        let direct_normal = if up > 0.0 { direct } else { 0.0 };
        let sun = DiffuseSun { up, direct_normal, diffuse, extraterrestrial: extra };
        let Fractions { circumsolar: circumsolar_fraction, horizon: horizon_fraction } =
            (model.fractions)(&sun);
        let lowest = up.max(model.lowest);
        let bright = diffuse * circumsolar_fraction / lowest;
        // Sun and bright sky around it together are at most as bright as the sun outside of the atmosphere; the rest of the diffuse
        // radiation comes from all of the sky.
        let circumsolar = bright.min((most - direct_normal).max(0.0));
        let isotropic = if bright > circumsolar {
            diffuse - circumsolar * lowest
        } else {
            diffuse * (1.0 - circumsolar_fraction)
        };
        let horizon = diffuse * horizon_fraction;
        let sum = direct_normal + circumsolar + isotropic + horizon.max(0.0);
        Self {
            direction,
            direct_normal,
            global_horizontal: global,
            isotropic,
            circumsolar,
            horizon,
            most,
            bounded: sum > most,
        }
    }

    /// An isotropic sky and no sun.
    pub(crate) const OVERCAST: Self = Self {
        direction: [0.0, 0.0, 1.0],
        direct_normal: 0.0,
        global_horizontal: 1.0,
        isotropic: 1.0,
        circumsolar: 0.0,
        horizon: 0.0,
        most: f64::INFINITY,
        bounded: false,
    };

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

    /// Whether the sun is below the horizon.
    #[must_use]
    pub(crate) fn night(&self) -> bool {
        self.direction[2] <= 0.0
    }

    /// Whether there is radiation from the sun's direction.
    #[must_use]
    pub fn directed(&self) -> bool {
        self.direct_normal > 0.0 || self.circumsolar > 0.0
    }

    /// What the irradiance on a plane cannot exceed at this instant [W/m2]; infinite where the extraterrestrial one is unknown.
    pub(crate) fn greatest<S: Real>(&self, plane: &Plane<S>, ground_reflectance: S) -> S {
        greatest_irradiance(self.most, ground_reflectance, plane.ground_view)
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
        let light = Irradiance { cosine: facing, beam, circumsolar, horizon: diffuse - sky, diffuse, ground };
        let light = if self.bounded { light.limited(self.most) } else { light };
        let most = self.greatest(plane, ground_reflectance).scale(1.0 + 1e-5);
        debug_assert!(!most.lt(light.total()).any(), "an irradiance above extraterrestrial plus reflected");
        light
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
        self.times(S::constant(sum.max(0.0)) / self.total().max(S::constant(1e-6)))
    }

    /// What obstacles leave of a measured sum of the free plane, whose parts sum to `free` in the climate [W/m2].
    #[inline(always)]
    pub(crate) fn left_of(&self, free: S, sum: f64) -> Self {
        // A given view of the sky may exceed that of the free plane: never more than was measured.
        let whole = free.max(self.total()).max(S::constant(1e-6));
        self.times(S::constant(sum.max(0.0)) / whole)
    }

    /// The same parts where sun and sky are not above a limit [W/m2].
    // A rare case: kept out of the code of the others.
    #[inline(never)]
    fn limited(&self, limit: f64) -> Self {
        let most = S::constant(limit);
        Self { ground: self.ground, ..self.times(most / (self.beam + self.diffuse).max(most)) }
    }

    /// All parts times a factor.
    #[inline(always)]
    fn times(&self, factor: S) -> Self {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::forcing::CLIMATE_CHANNELS;
    use crate::physics::diffuse::model::{COS_85, COS_89};

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
        let diffuse = [("isotropic", 50.0), ("hay_davies", 99.2820), ("perez", 124.1692)];
        for (model, diffuse) in diffuse {
            let found = on_wall(DiffuseSky::named(model).unwrap(), &SkyVisibility::FULL);
            assert_close(found.beam, 346.410);
            assert_close(found.ground, 30.0);
            assert_close(found.diffuse, diffuse);
            assert_close(found.total(), 376.410 + diffuse);
            assert_close(found.directed() + found.scattered() + found.horizon, found.total());
        }
    }

    /// Rows that no sky can have: time stamps that are wrong by an hour, sensors that fail, the sun at and below the horizon, at the
    /// equator and over the poles, on high mountains.
    fn impossible_rows() -> Vec<[f64; CLIMATE_CHANNELS]> {
        let mut rows = Vec::new();
        for up in [-0.5, -1e-9, 0.0, 1e-12, 1e-3, 0.02, 0.0871, 0.0872, 0.3, 0.7, 0.999, 1.0_f64] {
            for direct in [0.0, 300.0, 1000.0, 1361.0, 5000.0] {
                for diffuse in [0.0, 1.0, 120.0, 700.0, 3000.0] {
                    let mut row = [0.0; CLIMATE_CHANNELS];
                    row[channel::SUN_UP] = up;
                    row[channel::SUN_EAST] = (1.0 - up * up).max(0.0).sqrt();
                    (row[channel::DIRECT_NORMAL], row[channel::DIFFUSE_HORIZONTAL]) = (direct, diffuse);
                    row[channel::GLOBAL_HORIZONTAL] = direct * up.max(0.0) + diffuse;
                    row[channel::DIRECT_NORMAL_EXTRA] = if diffuse > 100.0 { 1316.0 } else { 1408.0 };
                    rows.push(row);
                }
            }
        }
        rows
    }

    fn plane(tilt: f64, azimuth: f64) -> Plane<f64> {
        let ((sine, cosine), (east, north)) =
            (crate::number::elementary::sincos(tilt), crate::number::elementary::sincos(azimuth));
        let (sky_view, ground_view) = (0.5 * (1.0 + cosine), 0.5 * (1.0 - cosine));
        Plane { normal: [sine * east, sine * north, cosine], sin_tilt: sine, sky_view, ground_view }
    }

    /// On no plane, by no model, whatever the weather, more than arrives from outside of the atmosphere and is reflected by the
    /// ground; and no part is negative.
    #[test]
    fn nothing_above_extraterrestrial_plus_reflected() {
        let part = SkyVisibility { sun: 0.6, sky: 0.3, horizon: 0.0, ground: 0.5 };
        for (row, model) in
            impossible_rows().iter().flat_map(|row| DiffuseSky::ALL.iter().map(move |&model| (row, model)))
        {
            let sun = Sunlight::new(row, model);
            for (k, visible) in [&SkyVisibility::FULL, &part].into_iter().enumerate() {
                for step in 0..=12 {
                    let tilt = f64::from(step) * core::f64::consts::PI / 12.0;
                    let plane = plane(tilt, 1.2 * f64::from(step) + k as f64);
                    let light = sun.on(&plane, 0.8, visible);
                    let most = greatest_irradiance(row[channel::DIRECT_NORMAL_EXTRA], 0.8, plane.ground_view);
                    assert!(light.total() <= most * (1.0 + 1e-12), "{model:?} {row:?}: {}", light.total());
                    let parts =
                        [light.beam, light.circumsolar, light.diffuse, light.ground, light.directed()];
                    assert!(parts.iter().all(|part| *part >= 0.0), "{model:?} {row:?}: {light:?}");
                    assert!(light.scattered() >= -1e-9, "{model:?} {row:?}: {light:?}");
                }
            }
        }
    }

    /// 50 W/m2 of diffuse radiation with the sun 0.5 deg high: the bright sky around it stays below what is left of the
    /// extraterrestrial radiation, and a horizontal plane still receives all that was measured.
    #[test]
    fn a_low_sun() {
        let mut row = [0.0; CLIMATE_CHANNELS];
        (row[channel::SUN_EAST], row[channel::SUN_UP]) = (1.0, 0.1);
        (row[channel::DIRECT_NORMAL], row[channel::DIFFUSE_HORIZONTAL]) = (1300.0, 60.0);
        row[channel::DIRECT_NORMAL_EXTRA] = 1361.0;
        for &model in DiffuseSky::ALL {
            let sun = Sunlight::new(&row, model);
            let level = sun.on(&plane(0.0, 0.0), 0.2, &SkyVisibility::FULL);
            assert_close(level.diffuse, 60.0);
            let wall = sun.on(
                &plane(core::f64::consts::FRAC_PI_2, core::f64::consts::FRAC_PI_2),
                0.0,
                &SkyVisibility::FULL,
            );
            assert!(wall.directed() <= 1361.0 + 1e-9 && wall.total() <= 1361.0 + 1e-9, "{wall:?}");
        }
    }

    /// At the lowest elevations of the ratio of cosines and near the zenith no model jumps.
    #[test]
    fn borders_of_the_elevation() {
        for &model in DiffuseSky::ALL {
            for up in [COS_85, COS_89, 0.5, 0.9999] {
                let [before, behind] = [-1e-10, 1e-10].map(|more| {
                    let mut row = [0.0; CLIMATE_CHANNELS];
                    row[channel::SUN_UP] = up + more;
                    row[channel::SUN_EAST] = (1.0 - (up + more) * (up + more)).sqrt();
                    (row[channel::DIRECT_NORMAL], row[channel::DIFFUSE_HORIZONTAL]) = (500.0, 100.0);
                    row[channel::DIRECT_NORMAL_EXTRA] = 1361.0;
                    Sunlight::new(&row, model).on(&plane(1.0, 1.0), 0.2, &SkyVisibility::FULL).total()
                });
                assert!((before - behind).abs() < 1e-4, "{model:?} at {up}: {before} and {behind}");
            }
        }
    }

    /// A surface that sees a quarter of the sun's disc, half of the sky and a fifth of the ground.
    #[test]
    fn shades_take_their_parts() {
        let visible = SkyVisibility { sun: 0.25, sky: 0.5, horizon: 1.0, ground: 0.2 };
        let found = on_wall(DiffuseSky::named("hay_davies").unwrap(), &visible);
        assert_close(found.beam, 0.25 * 346.410);
        assert_close(found.diffuse, 0.5 * 30.0 + 0.25 * 69.2820);
        assert_close(found.ground, 6.0);
    }
}
