//! What every law of what a side is in contact with offers: a temperature, heat or a coefficient; the weather that it is given, and numbers that several have.

use crate::number::real::Real;
use crate::physics::law_row::{LawParameter, LawRange, LawRow, Limits, Numbers};

/// Angle of a day in the year [rad/d].
pub(crate) const PER_DAY: f64 = core::f64::consts::TAU / 365.0;

/// A law of what a side, or a thermal bridge, is in contact with. Where a side has convection, or the law gives a coefficient, its temperature
/// is that of the air in front of the surface; otherwise it is that of the surface. Thermal bridges have the temperature alone.
pub(crate) trait ImposedLaw<S: Real>: Sized {
    /// What it says of itself.
    const ROW: LawRow;

    /// Reads its numbers.
    fn new(number: &Numbers<'_, S>) -> Self;

    /// The temperature at an instant [degC].
    fn temperature(&self, at: &ImposedWeather) -> S;

    /// Heat into the surface beside [W/m2]; asked for where the row says [`LawRow::gives_heat`].
    fn heat(&self, _at: &ImposedWeather) -> S {
        S::zero()
    }

    /// The coefficient of heat transfer between the temperature and the surface [W/(m2 K)]; asked for where the row says
    /// [`LawRow::gives_coefficient`].
    fn coefficient(&self, _at: &ImposedWeather) -> S {
        S::zero()
    }
}

/// What imposed temperatures depend on.
#[derive(Debug, Clone, Copy)]
pub struct ImposedWeather {
    /// Cosine and sine of the angle of the day in the year, [`PER_DAY`] times the day.
    pub season: [f64; 2],
    /// Temperature of the outdoor air [degC].
    pub outdoor_air: f64,
}

/// Limits of temperatures [degC].
pub(crate) const TEMPERATURES: Limits = Limits { above: None, at_least: Some(-100.0), at_most: Some(1000.0) };

/// Annual mean of the ground.
pub(crate) const MEAN: LawParameter = LawParameter::new(
    "mean",
    "degC",
    "Annual mean temperature of the ground",
    LawRange::Within(2.0, "depth and cover"),
    12.0,
)
.limits(TEMPERATURES);

/// The day on which the ground is coldest.
pub(crate) const COLDEST_DAY: LawParameter = LawParameter::new(
    "coldest_day",
    "d",
    "Day of the year on which the ground is coldest",
    LawRange::Within(20.0, "the lag grows with depth"),
    40.0,
)
.limits(Limits { above: None, at_least: Some(-366.0), at_most: Some(366.0) });

/// The outdoor air above which a mat is off.
pub(crate) const HEATING_LIMIT: LawParameter = LawParameter::new(
    "limit",
    "degC",
    "Outdoor air at which the mat is turned off",
    LawRange::Within(2.0, "set by hand"),
    15.0,
)
.limits(TEMPERATURES);

/// `amplitude cos(2 pi (day - coldest)/365)` as factors of cosine and sine of the season, for an angle of the coldest day [rad].
pub(crate) fn swing<S: Real>(amplitude: S, coldest: S) -> [S; 2] {
    [amplitude * coldest.cos(), amplitude * coldest.sin()]
}

/// The swing at an instant.
#[inline(always)]
pub(crate) fn swung<S: Real>(swing: &[S; 2], at: &ImposedWeather) -> S {
    let [cosine, sine] = at.season;
    swing[0].scale(cosine) + swing[1].scale(sine)
}
