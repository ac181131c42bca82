"""Errors of the infrared radiation that a model of the sky computes, on days beside the identification.

Where the infrared radiation of the sky was not measured, a model computes it from humidity and clouds. Daily
means of the best published models differ from measured ones by 15 to 16 W/m2 (root mean square, 21 sites);
models whose coefficients were calibrated at the site, by 9.4 W/m2. A calibration absorbs the error that its
days have in common; other weather has another one. Consecutive days have similar weather, and so have their
errors.

References
----------
Flerchinger G.N., Xaio W., Marks D., Sauer T.J., Yu Q. (2009), Comparison of algorithms for incoming
atmospheric long-wave radiation, Water Resources Research 45, W03423. https://doi.org/10.1029/2008WR007394
Soneye-Arogundade O.O. (2021), Evaluation and calibration of downward longwave radiation models under
cloudless sky at Ile-Ife, Nigeria, Atmosfera 34, 417. https://doi.org/10.20937/ATM.52843
"""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.physics import KELVIN, STEFAN_BOLTZMANN
from mascarin.study.context.step_cache import kept_series

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.simulation.simulation import Simulation
    from mascarin.study.context.context import StudyContext

    Array = npt.NDArray[np.float64]

PUBLISHED: Final = 15.5
"""Standard error of the infrared radiation of a model with published coefficients, mean of a day. [W/m2]"""
CALIBRATED: Final = 9.4
"""The same where a number of the sky is calibrated. [W/m2]"""
#: Parameters that move the infrared radiation of all days alike.
_SKY: Final = ("site.sky.a", "site.sky.depression")
#: Part of it by which the sky is moved for the derivative.
_STEP: Final = 0.2


def sky_effect(
    study: StudyContext, simulation: Simulation, base: Array, calibrated: Collection[str]
) -> Array | None:
    """Effect of one standard error of the infrared radiation of the sky on all series.

    Parameters
    ----------
    study : StudyContext
        Has the folder where runs are kept.
    simulation : Simulation
        The model.
    base : ndarray
        Its parameter vector. [unit of each]
    calibrated : collection of str
        Paths of the parameters that were calibrated.

    Returns
    -------
    ndarray, shape (n, S), or None
        [unit of each sensor] None where the sky was measured, or has no number that moves it.
    """
    kind, air = simulation.building.site.sky.kind, float(np.nanmean(simulation.weather("air_temperature")))
    error = CALIBRATED if any(path.startswith(_SKY) for path in calibrated) else PUBLISHED
    black = STEFAN_BOLTZMANN * (air + KELVIN) ** 4
    # Where clouds hide a part of the sky, an error of the clear sky acts on the rest.
    if kind in ("martin_berdahl", "clark_allen", "brunt"):
        path, size = "site.sky.a", error / black
    elif kind == "offset":
        path = "site.sky.depression"
        sky = air + KELVIN - simulation.value_in(base, path)
        size = -error / (4.0 * STEFAN_BOLTZMANN * sky**3)
    else:
        return None
    value = simulation.value_in(base, path)
    moved = simulation.varied([path], np.array([[value + _STEP * size]]), base)[0]
    series = kept_series(study, simulation, np.array([base, moved]))
    return np.asarray(np.nan_to_num((series[1] - series[0]) / _STEP))
