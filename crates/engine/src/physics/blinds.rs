//! Blinds and shutters: a layer on the outer or the inner side of a window, which covers a part of it.
//!
//! What a blind transmits and reflects is diffuse. Behind an outer blind with transmittance `t` and reflectance `r`, a glass with
//! the diffuse transmittance `T` and reflectance `R` lets pass `t T/(1 - r R)` of all radiation on it; the blind absorbs
//! `(1 - t - r)(1 + t R/(1 - r R))`. An inner blind behind a glass that transmits `T` lets pass `T t/(1 - r R)`, with the
//! reflectance `R` of the glass from inside, and absorbs `T (1 - t - r)/(1 - r R)`. (Net radiation between two layers; EN
//! 13363-2:2005.) The part that is not covered is the bare glass.
//!
//! A blind has no heat capacity. It is the outermost or innermost node of the window, and a resistance connects it to the glass:
//! that of the blind and of the air behind it (the additional resistance of EN ISO 10077-1), in proportion to the part that is
//! covered.
//!
//! The air behind an inner blind is that of the room: it rises there and carries a part of what the blind absorbs away from the
//! glass (`to_air`). This part goes to the air of the room at once, the rest to the node of the blind.

use crate::input::description;
use crate::input::forcing::{Schedule, scheduled};
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::optics::Diffuse;

/// Resistance between the node of an open blind and the glass [m2 K/W]: without meaning, and small.
pub(crate) const OPEN: f64 = 1e-3;

/// A blind of a window.
#[derive(Debug, Clone)]
pub struct Blind<S> {
    /// Whether it is on the side of the room.
    pub(crate) inside: bool,
    transmittance: S,
    reflectance: S,
    /// Of the closed blind, the air behind it included [m2 K/W].
    resistance: S,
    /// Part of the window that it covers when it is closed [-].
    cover: S,
    schedule: Schedule,
    /// Irradiance of the window above which it is closed [W/m2]; none: it follows its schedule alone.
    radiation: Option<S>,
    /// Part of what an inner blind absorbs that the air behind it carries into the room [-].
    pub(crate) to_air: Option<S>,
}

impl<S: Real> Blind<S> {
    pub(crate) fn new(values: &Values<'_, S>, blind: &description::Blind) -> Self {
        Self {
            inside: blind.inside,
            transmittance: values.get(blind.transmittance),
            reflectance: values.get(blind.reflectance),
            resistance: values.get(blind.resistance),
            cover: values.get(blind.cover),
            schedule: Schedule::new(blind.schedule),
            radiation: blind.radiation.map(|id| values.get(id)),
            to_air: blind.to_air.map(|id| values.get(id)),
        }
    }

    /// Part of the window that is covered in a forcing row, with an irradiance of its plane [W/m2].
    #[inline(always)]
    pub(crate) fn covers(&self, row: &[f64], irradiance: S) -> S {
        let covered = scheduled(self.cover, self.schedule, row);
        match self.radiation {
            Some(limit) => S::select(limit.lt(irradiance), covered, S::zero()),
            None => covered,
        }
    }

    /// Conductance to the glass where a part is covered [W/(m2 K)].
    #[inline(always)]
    pub(crate) fn conductance(&self, covered: S) -> S {
        S::one() / (S::constant(OPEN) + covered * self.resistance)
    }

    /// One over the part of the radiation between blind and glass that is left after it went back and forth once [-].
    #[inline(always)]
    fn multiple(&self, reflectance: S) -> S {
        S::one() / (S::one() - self.reflectance * reflectance)
    }

    /// What the blind does to the sun on a window, where it covers a part. `sun` is transmitted from the sun's direction and in
    /// all, and `absorbed` in the panes and in the blind [W/m2]; `irradiance` that of the plane [W/m2]; the glass for diffuse
    /// radiation from outside and from inside.
    #[inline(always)]
    pub(crate) fn cover(
        &self,
        covered: S,
        irradiance: S,
        [front, back]: [&Diffuse<S>; 2],
        sun: &mut [S; 2],
        (panes, own): (&mut [S], &mut S),
    ) {
        let bare = S::one() - covered;
        let absorptance = S::one() - self.transmittance - self.reflectance;
        let (through, others, behind) = if self.inside {
            let multiple = self.multiple(S::one() - back.admitted());
            let arriving = covered * sun[1] * multiple;
            *own = arriving * absorptance;
            // The panes still absorb what comes from outside, and of what the blind reflects.
            (arriving * self.transmittance, S::one(), (arriving * self.reflectance, back))
        } else {
            let reflectance = S::one() - front.admitted();
            let multiple = self.multiple(reflectance);
            let arriving = covered * irradiance * self.transmittance * multiple;
            *own = covered * irradiance * absorptance + arriving * reflectance * absorptance;
            (arriving * front.transmittance, bare, (arriving, front))
        };
        let (heat, glass) = behind;
        for (pane, &part) in panes.iter_mut().zip(&glass.absorptance) {
            *pane = *pane * others + heat * part;
        }
        *sun = [sun[0] * bare, sun[1] * bare + through];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blind(inside: bool) -> Blind<f64> {
        Blind {
            inside,
            transmittance: 0.2,
            reflectance: 0.5,
            resistance: 0.2,
            cover: 1.0,
            schedule: Schedule::new(None),
            radiation: Some(150.0),
            to_air: None,
        }
    }

    fn glass() -> Diffuse<f64> {
        Diffuse { transmittance: 0.6, absorptance: vec![0.15, 0.05] }
    }

    /// Outside, by hand: `0.2 x 0.6/(1 - 0.5 x 0.2) = 0.13333` passes, `0.3 (1 + 0.2 x 0.2/0.9) = 0.31333` stays in the blind.
    #[test]
    fn an_outer_blind() {
        let (mut sun, mut panes, mut own) = ([50.0, 60.0], [15.0, 5.0], 0.0);
        blind(false).cover(1.0, 100.0, [&glass(), &glass()], &mut sun, (&mut panes, &mut own));
        assert!((sun[1] - 13.333_333).abs() < 1e-6 && sun[0] == 0.0, "{sun:?}");
        assert!((own - 31.333_333).abs() < 1e-6, "{own}");
        assert!((panes[0] - 100.0 * 0.2 / 0.9 * 0.15).abs() < 1e-12);
        // What is left is reflected: 0.5 + 0.2 x 0.2 x 0.2/0.9.
        let reflected = 100.0 - sun[1] - own - panes[0] - panes[1];
        assert!((reflected - 100.0 * (0.5 + 0.008 / 0.9)).abs() < 1e-9, "{reflected}");
    }

    /// Inside, by hand: of 60 that the glass transmits `60 x 0.2/0.9` pass and `60 x 0.3/0.9` stay in the blind; half of it where
    /// half is covered.
    #[test]
    fn an_inner_blind() {
        for covered in [1.0, 0.5] {
            let (mut sun, mut panes, mut own) = ([50.0, 60.0], [15.0, 5.0], 0.0);
            blind(true).cover(covered, 100.0, [&glass(), &glass()], &mut sun, (&mut panes, &mut own));
            let passes = covered * 60.0 * 0.2 / 0.9 + (1.0 - covered) * 60.0;
            assert!((sun[1] - passes).abs() < 1e-12 && (own - covered * 20.0).abs() < 1e-12);
            assert!((panes[1] - 5.0 - covered * 60.0 * 0.5 / 0.9 * 0.05).abs() < 1e-12);
            // Nothing is lost: transmitted, absorbed, and reflected outdoors through the glass.
            let back = covered * 60.0 * 0.5 / 0.9 * 0.6;
            let sum = sun[1] + own + panes[0] + panes[1] + back;
            assert!((sum - (60.0 + 20.0)).abs() < 1e-9, "{sum}");
        }
    }

    /// Closed above the limit only; resistances in proportion to what is covered.
    #[test]
    fn control_and_resistance() {
        let blind = blind(false);
        assert_eq!((blind.covers(&[], 151.0), blind.covers(&[], 150.0)), (1.0, 0.0));
        assert!((1.0 / blind.conductance(0.5) - 0.101).abs() < 1e-12);
        assert!((1.0 / blind.conductance(0.0) - OPEN).abs() < 1e-15);
    }
}
