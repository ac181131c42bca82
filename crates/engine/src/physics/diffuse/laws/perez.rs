//! Perez et al.: brightness around the sun and at the horizon by the clearness of the sky.
//!
//! Source: Perez, Ineichen, Seals, Michalsky & Stewart (1990), Solar Energy 44(5), doi:10.1016/0038-092X(90)90055-H; relative air
//! mass by Kasten & Young (1989), Applied Optics 28(22), doi:10.1364/AO.28.004735.
//!
//! Range: all skies; coefficients of all sites of the source together.

use crate::physics::diffuse::prelude::*;

/// Perez brightness coefficients F11 F12 F13 F21 F22 F23 by clearness bin ("all sites composite 1990").
const COEFFICIENTS: [[f64; 6]; 8] = [
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
const BINS: [f64; 7] = [1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2];

/// Fractions by sky clearness and sky brightness.
pub(crate) struct Perez;

impl DiffuseModel for Perez {
    const ROW: LawRow = LawRow::new(
        "Perez et al.",
        "Brightness around the sun and at the horizon by the clearness of the sky.",
        "all skies",
    )
    .source("Perez et al. 1990, doi:10.1016/0038-092X(90)90055-H (diffuse radiation on a plane)")
    .further_sources(&[
        "Kopp & Lean 2011, doi:10.1029/2010GL045777 (solar constant)",
        "Kasten & Young 1989, doi:10.1364/AO.28.004735 (air mass)",
    ])
    .alternatives(&[Alternative::USUAL]);

    const LOWEST: f64 = COS_85;

    fn fractions(sun: &DiffuseSun) -> Fractions {
        let DiffuseSun { up, direct_normal: direct, diffuse, extraterrestrial: extra } = *sun;
        if diffuse <= 0.0 || extra <= 0.0 {
            return Fractions::default();
        }
        let zenith = acos(up.clamp(-1.0, 1.0)).min(core::f64::consts::FRAC_PI_2);
        let cube = 1.041 * zenith * zenith * zenith;
        let clearness = ((diffuse + direct) / diffuse + cube) / (1.0 + cube);
        let elevation = 90.0 - zenith.to_degrees();
        let air_mass = 1.0 / (Real::cos(zenith) + 0.50572 * Real::powf(elevation + 6.07995, -1.6364));
        // The diffuse radiation of the correlation is not above the extraterrestrial radiation on the horizontal, 1 over the air mass.
        let brightness = (diffuse * air_mass / extra).min(1.0);
        let f = &COEFFICIENTS[BINS.iter().filter(|&&edge| clearness >= edge).count()];
        let circumsolar = (f[0] + f[1] * brightness + f[2] * zenith).clamp(0.0, 1.0);
        let horizon = (f[3] + f[4] * brightness + f[5] * zenith).clamp(-1.0, 1.0);
        Fractions { circumsolar, horizon }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fractions(up: f64, direct_normal: f64, diffuse: f64) -> [f64; 2] {
        let sun = DiffuseSun { up, direct_normal, diffuse, extraterrestrial: 1361.0 };
        let Fractions { circumsolar, horizon } = Perez::fractions(&sun);
        [circumsolar, horizon]
    }

    /// The fractions of Perez et al. stay in their ranges; between the bins of the clearness they have the steps of the
    /// source, 0.14 at most with the sun at 60 deg and a diffuse part of a fifth.
    #[test]
    fn ranges_of_the_fractions() {
        for up in [-0.5, -1e-9, 0.0, 1e-12, 1e-3, 0.02, 0.0871, 0.0872, 0.3, 0.7, 0.999, 1.0_f64] {
            for direct in [0.0, 300.0, 1000.0, 1361.0, 5000.0] {
                for diffuse in [0.0, 1.0, 120.0, 700.0, 3000.0] {
                    let [bright, horizon] = fractions(up, direct, diffuse);
                    let possible = (0.0..=1.0).contains(&bright) && (-1.0..=1.0).contains(&horizon);
                    assert!(possible, "{bright} {horizon}");
                }
            }
        }
        let cube = 1.041 * Real::powf(core::f64::consts::FRAC_PI_3, 3.0);
        for edge in BINS {
            let clear = (edge * (1.0 + cube) - cube - 1.0) * 200.0;
            let [before, behind] =
                [1.0 - 1e-9, 1.0 + 1e-9].map(|x| fractions(0.5, clear * x, 200.0));
            assert!(
                (before[0] - behind[0]).abs() < 0.2 && (before[1] - behind[1]).abs() < 0.2,
                "{edge}: {before:?} {behind:?}"
            );
        }
    }
}
