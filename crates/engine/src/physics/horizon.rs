//! The horizon of a site: terrain and far obstacles, whose elevation is given by azimuth.
//!
//! Below it there is no sun, no bright sky around the sun and no diffuse sky; obstacles reflect nothing. Between two azimuths the
//! elevation is interpolated, over north as well.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::number::elementary::{acos, sin, sincos};
use crate::number::real::Real;
use crate::physics::solar::Plane;

/// Directions of the quadrature over the sky: around and up.
const AROUND: usize = 72;
const UP: usize = 24;

/// Elevation of the horizon [rad] at an azimuth [rad], for points (azimuth, elevation) [deg] with rising azimuths below 360.
fn elevation(points: &[[f64; 2]], azimuth: f64) -> f64 {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return 0.0 };
    let at = azimuth.to_degrees().rem_euclid(360.0);
    let after = points.iter().position(|point| point[0] > at);
    let [from, to] = match after {
        Some(0) => [[last[0] - 360.0, last[1]], first],
        Some(k) => [points[k - 1], points[k]],
        None => [last, [first[0] + 360.0, first[1]]],
    };
    let part = (at - from[0]) / (to[0] - from[0]);
    (from[1] + (to[1] - from[1]) * part).to_radians()
}

/// Whether the horizon hides the sun in a direction (east, north, up).
pub(crate) fn hides(points: &[[f64; 2]], [east, north, up]: [f64; 3]) -> bool {
    let level = (east * east + north * north).sqrt();
    if points.is_empty() || level == 0.0 {
        return false;
    }
    let from_north = acos((north / level).clamp(-1.0, 1.0));
    let azimuth = if east < 0.0 { TAU - from_north } else { from_north };
    up < sin(elevation(points, azimuth))
}

/// Fractions that the horizon leaves a plane of the isotropic sky and of its brightness at the horizon [-].
///
/// Each is the integral of the cosine of incidence over what is open, over that without a horizon, by the same quadrature.
pub(crate) fn open<S: Real>(points: &[[f64; 2]], plane: &Plane<S>) -> [S; 2] {
    let [mut seen, mut whole] = [[S::zero(); 2]; 2];
    for k in 0..AROUND {
        let azimuth = TAU * (k as f64 + 0.5) / AROUND as f64;
        let (east, north) = sincos(azimuth);
        let level = plane.normal[0].scale(east) + plane.normal[1].scale(north);
        let lowest = elevation(points, azimuth).clamp(0.0, FRAC_PI_2);
        let band = level.max(S::zero());
        whole[1] += band;
        if lowest <= 0.0 {
            seen[1] += band;
        }
        whole[0] += column(level, plane.normal[2], 0.0);
        seen[0] += column(level, plane.normal[2], lowest);
    }
    let part = |k: usize| {
        let none = whole[k].lt(S::constant(1e-9));
        S::select(none, S::one(), seen[k] / whole[k].max(S::constant(1e-9)))
    };
    [part(0), part(1)]
}

/// The cosine of incidence on a plane over a strip of sky above an elevation, by solid angle.
fn column<S: Real>(level: S, upward: S, lowest: f64) -> S {
    let step = (FRAC_PI_2 - lowest) / UP as f64;
    (0..UP).fold(S::zero(), |sum, k| {
        let (sine, cosine) = sincos(lowest + (k as f64 + 0.5) * step);
        sum + (level.scale(cosine) + upward.scale(sine)).max(S::zero()).scale(cosine * step / PI)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(tilt: f64, azimuth: f64) -> Plane<f64> {
        let (sine, cosine) = sincos(tilt.to_radians());
        let (east, north) = sincos(azimuth.to_radians());
        Plane {
            normal: [east * sine, north * sine, cosine],
            sin_tilt: sine,
            sky_view: 0.5 * (1.0 + cosine),
            ground_view: 0.5 * (1.0 - cosine),
        }
    }

    /// A level horizon at `h`: `cos^2 h` of the sky of a horizontal plane, `1 - (2/pi)(h + sin h cos h)` of a vertical one.
    #[test]
    fn a_level_horizon() {
        for degrees in [5.0_f64, 20.0, 50.0] {
            let (points, h) = ([[0.0, degrees]], degrees.to_radians());
            let (sine, cosine) = sincos(h);
            let [sky, band] = open(&points, &plane(0.0, 0.0));
            assert!((sky - cosine * cosine).abs() < 2e-3, "{sky}");
            assert!((band - 1.0).abs() < 1e-12, "a horizontal plane sees no horizon: {band}");
            let [sky, band] = open(&points, &plane(90.0, 200.0));
            assert!((sky - (1.0 - (h + sine * cosine) / FRAC_PI_2)).abs() < 2e-3, "{sky}");
            assert_eq!(band, 0.0);
        }
        for tilt in [0.0, 30.0, 90.0, 120.0] {
            assert_eq!(open(&[[0.0, 0.0], [90.0, 0.0]], &plane(tilt, 70.0)), [1.0; 2]);
        }
    }

    /// Interpolated between azimuths, over north as well; the sun at the same azimuth is hidden below it.
    #[test]
    fn elevations_by_azimuth() {
        let points = [[90.0, 10.0], [180.0, 30.0], [330.0, 0.0]];
        for (azimuth, expected) in [(90.0, 10.0), (135.0, 20.0), (255.0, 15.0), (330.0, 0.0), (30.0, 5.0)] {
            let found = elevation(&points, f64::to_radians(azimuth)).to_degrees();
            assert!((found - expected).abs() < 1e-9, "{azimuth}: {found}");
            for (above, hidden) in [(-0.1, true), (0.1, false)] {
                let (up, level) = sincos((expected + above).to_radians());
                let (east, north) = sincos(f64::to_radians(azimuth));
                assert_eq!(hides(&points, [east * level, north * level, up]), hidden, "{azimuth}");
            }
        }
        assert!(!hides(&[], [1.0, 0.0, -0.5]) && !hides(&points, [0.0, 0.0, 1.0]));
    }
}
