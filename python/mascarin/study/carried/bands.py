"""Bands of a comparison with a posterior that another study has found: another season, another building.

The sample of the parameters is run; it has the numbers that were not estimated as well, with what the
identification tells of them. Numbers with a range that it does not name, as those of other parts, are drawn
beside it, and the stated uncertainty of each sensor is added.

The errors of the model are those of the sensor of the same output in the identification, else the largest of
its unit. They are known for the weather and the temperatures of the identification alone. Elsewhere nothing
tells their size but the limit that the study states: with the distance d from the range of the
identification, in lengths of that range, their variance approaches the square of the limit by
1 - exp(-d^2 / 2), as that of a Gaussian process with this length does away from its data.

References
----------
Rasmussen C.E., Williams C.K.I. (2006), Gaussian Processes for Machine Learning, section 2.2. MIT Press.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io.numbers import in_percent
from mascarin._io.units import difference
from mascarin.errors import InputError
from mascarin.sensitivity.building_analysis import factors_of
from mascarin.study_document.comparison import BandEntry

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import numpy.typing as npt
    import pandas as pd

    from mascarin.building import Building
    from mascarin.building.parts.posterior import Posterior, SensorPosterior
    from mascarin.measurements.observation import Observation
    from mascarin.simulation.simulation import Simulation

    Array = npt.NDArray[np.float64]
    Flags = npt.NDArray[np.bool_]

#: Runs of a band.
DRAWS: Final = 64
_SEED: Final = 43
#: Standard uncertainty of a number that is not estimated, as a part of its range.
_RANGES: Final = 0.25
#: Relative difference of a value from its estimate, from which the building states another one.
_OTHER: Final = 1e-4
#: Days outside that are named.
_NAMED: Final = 3


@dataclass(frozen=True, eq=False)
class Bands:
    """Where measured values are expected.

    Attributes
    ----------
    confidence : float
        Of the bands. [-]
    center, half_width : ndarray, shape (n, S)
        Middle and half-width of the band of each sensor; NaN where nothing is known of its error. [unit]
    parameters : ndarray, shape (n, S)
        Standard deviation from the parameters alone. [unit]
    distance : ndarray, shape (n, S)
        Distance from the range of the identification, in lengths of that range; 0 inside. [-]
    words : tuple of str
        Where it extrapolates, and what the posterior does not know, in sentences.
    """

    confidence: float
    center: Array
    half_width: Array
    parameters: Array
    distance: Array
    words: tuple[str, ...]

    def entries(self, observation: Observation, used: Mapping[str, Flags]) -> dict[str, BandEntry]:
        """The bands in numbers, by sensor.

        Parameters
        ----------
        observation : Observation
            The measured series.
        used : mapping of str to ndarray of bool, shape (n, S)
            Values of each period.
        """
        misses = self.center - observation.measured
        inside = np.abs(misses) <= self.half_width
        entries = {}
        for s, name in enumerate(observation.names):
            finite = np.isfinite(misses[:, s]) & np.isfinite(self.half_width[:, s])
            shares = {}
            for period, use in used.items():
                compared = finite & use[:, s]
                shares[period] = float(inside[compared, s].mean()) if compared.any() else None
            entries[name] = BandEntry(
                confidence=self.confidence,
                half_width=_mean(self.half_width[:, s]),
                parameters=_mean(self.parameters[:, s]),
                extrapolated=float(np.mean(self.distance[:, s] > 0.0)),
                held=shares,
            )
        return entries

    def beside(self, series: pd.DataFrame, names: Sequence[str], units: Sequence[str]) -> pd.DataFrame:
        """A table of series with the middle and the half-width of the band of each sensor."""
        table = series.copy()
        for s, (name, unit) in enumerate(zip(names, units, strict=False)):
            table[f"{name}.expected [{unit}]"] = np.round(self.center[:, s], 6)
            table[f"{name}.prediction_band [{difference(unit)}]"] = np.round(self.half_width[:, s], 6)
        return table


def _mean(values: Array) -> float | None:
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if finite.size else None


def carried_bands(
    simulation: Simulation,
    observation: Observation,
    posterior: Posterior,
    outputs: Sequence[str],
    stated: Sequence[float],
    weather: Mapping[str, Array],
) -> Bands:
    """Bands of a building that has a posterior.

    Parameters
    ----------
    simulation : Simulation
        The model, its first outputs those of the sensors.
    observation : Observation
        Instants and sensors.
    posterior : Posterior
        That of the building.
    outputs : sequence of str
        Output of each sensor.
    stated : sequence of float
        Standard uncertainty of a reading of each sensor. [unit]
    weather : mapping of str to ndarray
        Weather at the instants, by channel. [unit of each]
    """
    from scipy import stats

    columns, words = usable(simulation.building, posterior)
    series = _simulated(simulation, observation, posterior, columns)
    center, spread = np.nanmean(series, axis=0), np.nanstd(series, axis=0, ddof=1)
    tail = 0.5 + 0.5 * posterior.confidence
    shared_factor = float(stats.t.ppf(tail, max(posterior.days - 1, 2)))
    own_factor = float(stats.norm.ppf(tail))
    days = day_numbers(observation.times)
    outside, said = _weather_outside(posterior, weather, days, observation.times)
    words = [*words, *said]
    half, distance = np.full(center.shape, np.nan), np.zeros(center.shape)
    for s, output in enumerate(outputs):
        unit = simulation.outputs[s].unit
        name, sensor = _like(posterior, output, unit)
        if sensor is None:
            words.append(f"{observation.names[s]}: the posterior has no sensor in {unit}: it has no band")
            continue
        if name is None:
            words.append(
                f"{observation.names[s]}: {output} was not measured in the identification; its error of the "
                f"model is taken as the largest of all sensors in {unit}"
            )
        beyond = np.zeros(len(center)) if name is None else _beyond(center[:, s], sensor.range)
        if name is not None and beyond.any():
            share = in_percent(float(np.mean(beyond > 0.0)))
            words.append(
                f"{observation.names[s]}: {share} of the simulated values are outside of "
                f"{sensor.range[0]:.4g} to {sensor.range[1]:.4g} {unit}, the range of the identification"
            )
        distance[:, s] = np.maximum(outside, beyond)
        model = sensor.repeating**2 + sensor.daily**2
        toward = 1.0 - np.exp(-0.5 * distance[:, s] ** 2)
        model = model + np.maximum(sensor.limit**2 - model, 0.0) * toward
        # The sample of the parameters has the spread of Student's distribution already.
        normal = spread[:, s] ** 2 + stated[s] ** 2 + sensor.independent**2
        half[:, s] = np.sqrt(own_factor**2 * normal + shared_factor**2 * model)
    return Bands(posterior.confidence, center, half, spread, distance, tuple(words))


def usable(building: Building, posterior: Posterior) -> tuple[list[int], list[str]]:
    """Columns of the sample that the building has with their estimates, and words about all others.

    Parameters
    ----------
    building : Building
        May have other parts and other values than that which was calibrated.
    posterior : Posterior
        What the calibration found.
    """
    columns, missing, changed = [], [], []
    estimates = {path: estimate for path, (estimate, _, _) in posterior.intervals.items()}
    for k, (path, estimate) in enumerate((estimates | posterior.numbers).items()):
        try:
            parameter = building.parameter(path)
        except InputError:
            missing.append(path)
            continue
        if abs(parameter.value - estimate) > _OTHER * max(abs(estimate), abs(parameter.value)):
            changed.append(path)
        else:
            columns.append(k)
    missing = [path for path in missing if path in estimates]
    changed = [path for path in changed if path in estimates]
    words = []
    if missing:
        words.append(f"parameters of the posterior that the building does not have: {', '.join(missing)}")
    if changed:
        words.append(
            f"parameters with other values than their estimates, which count as known: {', '.join(changed)}"
        )
    return columns, words


def day_numbers(times: pd.DatetimeIndex) -> npt.NDArray[np.int64]:
    """Number of the local day of each instant, from 0, shape (n,)."""
    local = times.tz_localize(None).normalize()
    return np.asarray((local - local[0]).days, dtype=np.int64)


def daily_means(values: Array, days: npt.NDArray[np.int64]) -> Array:
    """Mean of each day, shape (D,); NaN for a day without a value. [unit]

    Examples
    --------
    >>> daily_means(np.array([1.0, 3.0, 5.0]), np.array([0, 0, 1])).tolist()
    [2.0, 5.0]
    """
    finite = np.isfinite(values)
    total = np.bincount(days[finite], np.asarray(values)[finite], minlength=int(days.max()) + 1)
    count = np.bincount(days[finite], minlength=total.size)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def _simulated(
    simulation: Simulation, observation: Observation, posterior: Posterior, columns: Sequence[int]
) -> Array:
    """Series of the sensors for draws of all uncertain numbers, shape (M, n, S)."""
    rng = np.random.default_rng(_SEED)
    rows = rng.permutation(len(posterior.draws))
    chosen = np.resize(rows, DRAWS)
    vectors = np.tile(simulation.vector({}), (DRAWS, 1))
    paths = [posterior.paths[k] for k in columns]
    numbers = posterior.draws[chosen][:, list(columns)]
    named = set(paths)
    changed = set(posterior.intervals) - named  # stated again, so that they count as known
    for factor in factors_of(simulation.building):
        if factor.path in named | changed or factor.path.startswith("sensors."):
            continue
        middle = simulation.building.parameter(factor.path).value
        moved = middle + _RANGES * (factor.high - factor.low) * rng.standard_normal(DRAWS)
        paths.append(factor.path)
        numbers = np.column_stack([numbers, np.clip(moved, factor.low, factor.high)])
    if paths:
        vectors = simulation.varied(paths, numbers)
    records, _, _ = simulation.ensemble(vectors)
    return observation.simulated(simulation.index, records[..., : len(observation.names)])


def _like(posterior: Posterior, output: str, unit: str) -> tuple[str | None, SensorPosterior | None]:
    """The sensor of an output and its name; else one with the largest errors of its unit, and None."""
    for name, sensor in posterior.sensors.items():
        if sensor.output == output:
            return name, sensor
    alike = [sensor for sensor in posterior.sensors.values() if sensor.unit == unit]
    if not alike:
        return None, None
    largest = {
        key: max(getattr(sensor, key) for sensor in alike)
        for key in ("repeating", "daily", "independent", "limit")
    }
    return None, alike[0].model_copy(update=largest)


def _beyond(values: Array, ends: tuple[float, float]) -> Array:
    """Distance of values from a range, in lengths of the range. [-]"""
    low, high = ends
    length = max(high - low, 1e-9)
    return np.nan_to_num(np.maximum(np.maximum(low - values, values - high), 0.0)) / length


def _weather_outside(
    posterior: Posterior, weather: Mapping[str, Array], days: npt.NDArray[np.int64], times: pd.DatetimeIndex
) -> tuple[Array, list[str]]:
    """Distance of the daily means of the weather from the identification at each instant, and words."""
    distance = np.zeros(len(days))
    words = []
    dates = times.tz_localize(None).normalize().unique()
    for channel, ends in posterior.weather.items():
        if channel not in weather:
            continue
        means = daily_means(weather[channel], days)
        away = _beyond(means, ends)
        distance = np.maximum(distance, away[days])
        far = np.flatnonzero(away > 0.0)
        if far.size:
            farthest = far[np.argsort(-away[far], kind="stable")][:_NAMED]
            named = ", ".join(f"{dates[d]:%Y-%m-%d}" for d in sorted(farthest.tolist()) if d < len(dates))
            words.append(
                f"{channel.replace('_', ' ')}: the daily means of {far.size} of {means.size} days are "
                f"outside of {ends[0]:.4g} to {ends[1]:.4g}, the range of the identification of "
                f"'{posterior.study}' (farthest: {named}): the model extrapolates there, and the bands are "
                "wider"
            )
    return distance, words
