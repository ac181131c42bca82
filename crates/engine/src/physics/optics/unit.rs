//! The optics of a unit of panes, at all angles.

use super::curves::Curves;
use super::diffuse::{Diffuse, Unit, cosine};
use super::pane::{PaneLaw, Plate};
use crate::input::description::{Angular, PaneOptics};
use crate::input::values::Values;
use crate::number::real::Real;

/// Angles at which a calculated unit is tabulated [deg], close together near grazing incidence, where the transmittance falls
/// steeply.
pub(super) const ANGLES: [f64; 13] =
    [0.0, 20.0, 40.0, 50.0, 60.0, 65.0, 70.0, 75.0, 80.0, 85.0, 87.5, 89.0, 90.0];

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

impl<S: Real> Optics<S> {
    /// A unit calculated from its panes.
    pub fn of_panes(values: &Values<'_, S>, panes: &[PaneOptics]) -> Self {
        let laws: Vec<_> = panes.iter().map(|pane| PaneLaw::new(values, pane)).collect();
        let at = |reversed: bool| {
            let units = ANGLES.iter().map(|angle| {
                let cosine = cosine(*angle);
                let mut plates: Vec<_> = laws.iter().map(|law| law.at(cosine)).collect();
                if reversed {
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

    /// A unit by its table. From inside it is the same as from outside where nothing else is given.
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
        if let Some(transmittance) = table.back_transmittance {
            back.transmittance = scale.scale(transmittance);
        }
        if let Some(absorptance) = &table.back_absorptance {
            back.absorptance = absorptance.iter().map(|pane| absorbing.scale(*pane)).collect();
        }
        Self { beam, front, back }
    }
}

/// Transmittance and absorptances of panes in a row, for light that arrives on the first one (net-radiation method).
pub(super) fn combined<S: Real>(plates: &[Plate<S>]) -> Unit<S> {
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

    /// A vertical pane transmits more of the light of the horizon than of that of the whole sky.
    #[test]
    fn the_horizon_through_a_double_unit() {
        let optics = clear_double();
        let horizon = optics.beam.horizon(1.0).transmittance;
        assert!(horizon > optics.front.transmittance + 0.03 && horizon < 0.699, "{horizon}");
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
