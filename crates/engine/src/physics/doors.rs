//! Doors and other large openings between two zones: a temperature difference drives air through them, both ways.
//!
//! The warmer air flows through the upper half and the colder air, as much of it, through the lower half:
//! `V = C_d W H/3 sqrt(g H |d|/T)` in each direction [m3/s].
//!
//! Source: Brown & Solvason (1962), Natural convection through rectangular openings in partitions - 1: Vertical partitions,
//! Int. J. Heat Mass Transfer 5(9), 859-868, doi:10.1016/0017-9310(62)90184-9. The mean temperature T of both airs is taken as
//! 20 degC: 10 K more or less change the flow by 2 %.

use crate::input::description;
use crate::input::forcing::{Schedule, scheduled};
use crate::input::values::Values;
use crate::number::line::Line;
use crate::number::real::Real;
use crate::physics::constants::{GRAVITY, KELVIN};

/// Temperature differences are rounded off within this [K].
const ROUND_OFF: f64 = 0.01;
/// Mean temperature of the airs [K].
const MEAN: f64 = 20.0 + KELVIN;

/// A door between two zones.
#[derive(Debug, Clone)]
pub struct Door<S> {
    /// The zones.
    pub between: [usize; 2],
    /// Heat carried at a temperature difference of 1 K with the door fully open [W].
    whole: S,
    open: S,
    schedule: Schedule,
    /// Control that opens and closes it.
    pub(crate) control: Option<usize>,
}

impl<S: Real> Door<S> {
    /// Evaluates a door at a parameter vector; `heat` is that of a cubic metre of air [J/(m3 K)].
    #[must_use]
    pub fn new(door: &description::Door, values: &Values<'_, S>, heat: S) -> Self {
        let (width, height) = (values.get(door.width), values.get(door.height));
        let speed = height.scale(GRAVITY / MEAN).sqrt();
        let flow = values.get(door.discharge) * width * height * speed.scale(1.0 / 3.0);
        Self {
            between: door.between,
            whole: heat * flow,
            open: values.get(door.open),
            schedule: Schedule::new(door.schedule),
            control: door.control,
        }
    }

    /// Heat carried at a temperature difference of 1 K in a forcing row [W].
    #[inline(always)]
    pub(crate) fn at(&self, row: &[f64]) -> S {
        scheduled(self.whole * self.open, self.schedule, row)
    }
}

/// Heat that the air through a door carries per degree at a temperature difference `d` [W/K].
#[inline(always)]
pub(crate) fn conductance<S: Real>(whole: S, d: S) -> S {
    whole * d.smooth_abs(ROUND_OFF).sqrt()
}

/// Heat that a door carries at a temperature difference `d`: `whole sqrt(|d|) d` [W].
#[inline(always)]
pub(crate) fn heat<S: Real>(whole: S, d: S) -> S {
    whole * d.smooth_abs(ROUND_OFF).sqrt() * d
}

/// The tangent of [`heat`].
#[inline(always)]
pub(crate) fn tangent<S: Real>(whole: S, d: S) -> Line<S> {
    let magnitude = d.smooth_abs(ROUND_OFF);
    let root = magnitude.sqrt();
    // The slope of the rounded magnitude is d over it.
    let slope = root + d * d / (magnitude * root).scale(2.0);
    Line::tangent(whole * root * d, whole * slope, d)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::description::ParamId;

    /// 0.9 m x 2 m, discharge 0.65, 2 K: `0.65 1.8/3 sqrt(9.80665 2 2/293.15) = 0.14266 m3/s`, 1200 J/(m3 K): 342.4 W; half open,
    /// half of it.
    #[test]
    fn a_door_by_hand() {
        let id = ParamId;
        let door = description::Door {
            name: "door".to_owned(),
            between: [0, 1],
            width: id(0),
            height: id(1),
            discharge: id(2),
            open: id(3),
            schedule: None,
            control: None,
        };
        let whole = |open: f64| Door::new(&door, &Values::new(&[0.9, 2.0, 0.65, open]), 1200.0).at(&[]);
        let expected = 1200.0 * 0.65 * 1.8 / 3.0 * (9.806_65_f64 * 2.0 * 2.0 / 293.15).sqrt() * 2.0;
        assert!((heat(whole(1.0), 2.0) / expected - 1.0).abs() < 1e-4, "{}", heat(whole(1.0), 2.0));
        assert!((heat(whole(0.5), -2.0) / expected + 0.5).abs() < 1e-4);
        for d in [-3.0, -0.004, 0.0, 0.02, 1.0] {
            let difference = (heat(300.0, d + 1e-6) - heat(300.0, d - 1e-6)) / 2e-6;
            let line = tangent(300.0, d);
            assert!((line.slope / difference - 1.0).abs() < 1e-6, "{} is not {difference}", line.slope);
            assert!((line.at(d) - heat(300.0, d)).abs() < 1e-9);
        }
    }
}
