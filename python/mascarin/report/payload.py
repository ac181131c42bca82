"""What a report is made from: the content of ``study.json`` and a compact set of series.

:class:`Study` writes down the keys of ``study.json`` that a report reads. Every key but ``title`` may be
missing: its part of the report is then left out. Dictionaries are shown in the order in which they are given.

:class:`Series` holds the curves. In a file each column is 16-bit integers with an offset and a scale, in
base64: the value is kept to 1/65000 of the column's span (about 1 mK for a roof) in two bytes.
"""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any, NotRequired, TypedDict

import numpy as np
import numpy.typing as npt

from mascarin.errors import InputError

Array = npt.NDArray[np.float64]

#: Most values over all columns that a report carries; series beyond are thinned.
MOST_VALUES = 600_000
_MISSING = -32768
_LEVELS = 65_000


class Metrics(TypedDict, total=False):
    """How far a model is from one sensor over one period; differences are model less sensor."""

    n: int
    bias: float
    """Mean difference, in the unit of the sensor."""
    sd: float
    """Standard deviation of the difference, in the unit of the sensor."""
    rmse: float
    mean_error: float
    """Mean absolute difference."""
    max_error: float
    """Difference of largest size, with its sign."""
    mean_error_percent: float
    """In percent of the measured range of the period."""
    max_error_percent: float


class SensorInfo(TypedDict, total=False):
    """What a sensor is."""

    label: str
    output: str
    """Name of the model output it is compared with."""
    unit: str
    uncertainty: float
    """Half-width of the sensor's band, in its unit."""


class Period(TypedDict, total=False):
    """A named part of the record."""

    label: str
    spans: list[list[str]]
    """Pairs of local times, start and end, ISO 8601 without offset."""
    note: str


class Model(TypedDict, total=False):
    """A variant whose results are compared: nominal, fitted, and whatever else the study ran."""

    label: str
    note: str


class ParameterEntry(TypedDict, total=False):
    """A parameter that was identified (or only declared, without ``fitted``)."""

    nominal: float
    fitted: float
    low: float
    high: float
    """Ends of the 95 % interval of the fitted value."""
    range: list[float]
    """Lowest and highest value that was allowed."""
    unit: str
    label: str
    at_bound: bool
    reason: str
    """Why the estimate lies on a bound, or is not identifiable."""
    source: str
    reference_nominal: float
    reference_fitted: float
    """What a publication gives for the same quantity before and after its own identification."""


class Criterion(TypedDict, total=False):
    """One test with its limit."""

    name: str
    sensor: str
    period: str
    model: str
    value: float
    limit: float
    unit: str
    passed: bool


class Assumption(TypedDict, total=False):
    """A number that nobody measured."""

    path: str
    value: float
    unit: str
    low: float
    high: float
    source: str
    assumed: bool


class QualityEntry(TypedDict, total=False):
    """A stretch of a measured channel that is not to be trusted."""

    channel: str
    kind: str
    start: str
    end: str
    count: int
    detail: str
    masked: bool


class LayerEntry(TypedDict, total=False):
    """A layer of a construction."""

    name: str
    material: str
    kind: str
    """``solid``, ``resistance`` or ``pcm``."""
    thickness: float
    """[m]"""
    conductivity: float | list[float]
    density: float | list[float]
    specific_heat: float | list[float]
    resistance: float
    """[m2 K/W]"""
    latent_heat: float
    """[J/kg]"""
    melting_temperature: float
    """[degC]"""
    nodes: int


class SurfaceEntry(TypedDict, total=False):
    """A surface of the building."""

    name: str
    construction: str
    area: float
    tilt: float
    azimuth: float
    outside: str
    """What the outside faces: ``outdoors``, a zone, ``ground``, the measured column, ``adiabatic``."""
    inside: str
    vertices: list[list[float]]
    film_outside: str
    film_inside: str


class BuildingEntry(TypedDict, total=False):
    """What was modelled."""

    name: str
    site: list[list[str]]
    """Rows of name and value, as text with units."""
    zones: list[dict[str, Any]]
    """Each with ``name`` and ``volume`` [m3]."""
    constructions: list[dict[str, Any]]
    """Each with ``name`` and ``layers`` (:class:`LayerEntry`, outside to inside)."""
    surfaces: list[SurfaceEntry]
    probes: list[dict[str, Any]]
    """Thermometers in walls: ``name``, ``surface``, ``depth`` [m from outside]."""
    choices: list[list[str]]
    """Rows of a modelling choice and what was chosen."""


class Share(TypedDict, total=False):
    """Part of an output's variance owed to one parameter."""

    share: float
    low: float
    high: float
    effect: float
    """Signed change of the output from the low to the high end of the range, in the output's unit."""


class Spectrum(TypedDict, total=False):
    """Spectrum of an output over the design's runs."""

    frequencies: list[float]
    power: list[float]
    """Part of the variance at each frequency [-]."""
    threshold: float
    """Below it an ordinate is indistinguishable from chance."""
    peaks: list[dict[str, Any]]
    """Each with ``frequency``, ``power``, ``path``, ``harmonic``."""


class DayShares(TypedDict, total=False):
    """Shares over the hours of the day."""

    hours: list[float]
    paths: list[str]
    share: list[list[float]]
    """One row per path, one column per hour."""


class Residuals(TypedDict, total=False):
    """Statistics of the residual of one sensor."""

    acf_lags: list[float]
    """[h]"""
    acf: list[float]
    acf_band: float
    period: str
    periodogram_frequency: list[float]
    """[1/day]"""
    periodogram_cumulative: list[float]
    """0 to 1."""
    periodogram_band: float
    hour_mean: list[float]
    """24 means, in the unit of the sensor."""
    hour_sd: list[float]
    correlation: dict[str, float]
    """Correlation with sun, wind, outdoor air, ... by channel label."""
    correlation_band: float
    correlation_lag: dict[str, float]
    """How long the residual comes after the channel. [h]"""
    cross_lags: list[float]
    """[h]"""
    cross_correlation: dict[str, list[float | None]]
    """Correlation with each channel at each lag."""
    daily_cycle: dict[str, float] | None
    """``measured_amplitude``, ``measured_peak`` [h], the same ``simulated_``, ``delay_minutes``."""
    hour_share: float
    """Part of the variance that the hour of the day explains."""
    effective_n: float


class Shortfall(TypedDict, total=False):
    """What would take the rest of the error away, parameter by parameter; ``sd`` is by sensor."""

    sd: dict[str, float]
    """As it is."""
    period: str
    steps: list[dict[str, Any]]
    """Each with ``path`` (what is changed besides those before), ``changes`` by path [ranges], and ``sd``."""
    every: dict[str, Any]
    """``parameters``, their number, and ``sd`` with all of them changed."""


class LedgerTerm(TypedDict, total=False):
    """One entry of the energy ledger."""

    label: str
    value: float
    """[MJ], positive into the building."""


class Ledger(TypedDict, total=False):
    """Where the heat went."""

    closure: float
    """Largest imbalance over the heat turned over [-]."""
    terms: list[LedgerTerm]
    model: str


class PhaseChange(TypedDict, total=False):
    """What a phase-change layer did."""

    label: str
    temperature: list[float]
    """Path followed: mean of the layer's two faces [degC]."""
    enthalpy: list[float]
    """Path followed: enthalpy [kJ/kg]."""
    days: list[dict[str, Any]]
    """Single days of it: ``label``, ``temperature``, ``enthalpy``."""
    law_temperature: list[float]
    law_enthalpy: list[float]
    column: str
    """Series column with the liquid fraction over time."""
    rows: list[list[str]]
    """Facts as rows of name and value."""


class Table(TypedDict, total=False):
    """Any further table."""

    title: str
    caption: str
    columns: list[str]
    rows: list[list[Any]]
    section: str
    """Identifier of the section it belongs to; ``comparison`` by default."""


class Study(TypedDict, total=False):
    """The keys of ``study.json`` that a report reads."""

    title: str
    intro: list[str]
    """Paragraphs for somebody who never saw the tool."""
    observed: dict[str, str]
    """``label`` (what the data are called, e.g. "virtual experiment") and ``note``."""
    mascarin_version: str
    created: str
    seed: int
    timezone: str
    command: list[str]
    """Lines to type to get the same result."""
    inputs: list[dict[str, str]]
    """Each with ``name``, ``sha256`` and perhaps ``note``."""
    versions: dict[str, str]
    run_time: float
    """[s]"""
    sources: list[dict[str, str]]
    """Each with ``text`` and perhaps ``doi``."""
    sensor_info: dict[str, SensorInfo]
    periods: dict[str, Period]
    models: dict[str, Model]
    sensors: dict[str, dict[str, dict[str, Metrics]]]
    """sensor -> period -> model -> metrics; other keys beside the models are left alone."""
    reference: dict[str, Any]
    """A publication to read the numbers by: ``label``, ``note``, ``sensors`` (as above, without models), its
    ``tables`` by what they hold, and its ``influential`` parameters with ``symbol`` and ``frequency``."""
    building: BuildingEntry
    assumptions: list[Assumption]
    quality: list[QualityEntry]
    parameters: dict[str, ParameterEntry]
    variant_parameters: dict[str, dict[str, ParameterEntry]]
    """The same of other models that were identified."""
    correlation: dict[str, Any]
    """``paths`` and ``matrix`` of the correlation between the estimates."""
    identification: list[list[str]]
    """Rows of name and value about how the fit was found."""
    criteria: list[Criterion]
    aims: list[Criterion]
    """Limits that one would have liked to reach; missing one fails nothing."""
    shortfall: Shortfall
    sensitivity: dict[str, dict[str, Share]]
    sensitivity_design: list[list[str]]
    frequencies: dict[str, int]
    """At which frequency each parameter swings in the spectra."""
    spectra: dict[str, Spectrum]
    day_shares: dict[str, DayShares]
    residuals: dict[str, Residuals]
    start: str
    """How the state at the start of the run was found."""
    ledger: Ledger
    phase_change: list[PhaseChange]
    tables: list[Table]
    notes: list[dict[str, str]]
    """Each with ``title`` and ``text``: what the numbers say, which physics differs."""


class _Column(TypedDict):
    label: str
    unit: str
    offset: float
    scale: float
    data: str
    group: NotRequired[str]


@dataclass(frozen=True)
class Column:
    """A curve.

    Parameters
    ----------
    values : array, shape (n,)
        Values at the instants; NaN where there is none or it is masked. [unit]
    label : str
        What it is, for legends.
    unit : str
        Unit, for axes (``degC`` is shown as °C).
    """

    values: Array
    label: str
    unit: str


@dataclass(frozen=True)
class Series:
    """Curves on one regular time axis.

    Columns named ``<model>/<sensor>`` belong to a sensor, ``observed/<sensor>`` being what was measured;
    ``weather/<name>`` and ``state/<name>`` are shown beside them.

    Parameters
    ----------
    start : str
        First instant, ISO 8601 local time without offset.
    step : float
        Distance of two instants. [s]
    columns : mapping of str to Column
        Curves of one length.
    """

    start: str
    step: float
    columns: Mapping[str, Column] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check that all columns have one length and that the axis can be read."""
        lengths = {key: len(column.values) for key, column in self.columns.items()}
        if len(set(lengths.values())) > 1:
            raise InputError(f"series of different lengths: {lengths}; expected one time axis for all")
        if not (math.isfinite(self.step) and self.step > 0.0):
            raise InputError(f"series: step {self.step} s; expected a positive number of seconds")
        moment(self.start)

    def __len__(self) -> int:
        """Give the number of instants."""
        return next((len(column.values) for column in self.columns.values()), 0)

    def time(self, index: float) -> datetime:
        """Local time of an instant."""
        return moment(self.start) + timedelta(seconds=self.step * index)

    def slice_of(self, start: str, end: str) -> slice:
        """Instants of a span given by two local times, the end not included."""
        first = (moment(start) - moment(self.start)).total_seconds() / self.step
        last = (moment(end) - moment(self.start)).total_seconds() / self.step
        return slice(max(0, math.ceil(first - 1e-6)), max(0, math.ceil(last - 1e-6)))

    def thinned(self, most: int = MOST_VALUES) -> Series:
        """Keep every k-th instant, k as small as the number of values allows.

        Parameters
        ----------
        most : int
            Most values over all columns. [-]

        Returns
        -------
        Series
            The same object if it is small enough.
        """
        every = max(1, math.ceil(len(self) * len(self.columns) / most))
        if every == 1:
            return self
        kept = {k: Column(c.values[::every], c.label, c.unit) for k, c in self.columns.items()}
        return Series(self.start, self.step * every, kept)

    def to_dict(self) -> dict[str, Any]:
        """Give the compact form, ready for JSON."""
        columns = {key: _packed(column) for key, column in self.columns.items()}
        return {"start": self.start, "step": self.step, "count": len(self), "columns": columns}

    @classmethod
    def from_dict(cls, raw: Mapping[str, Any]) -> Series:
        """Read the compact form.

        Raises
        ------
        InputError
            A key is missing or cannot be read.
        """
        try:
            columns = {key: _unpacked(column) for key, column in raw["columns"].items()}
            return cls(str(raw["start"]), float(raw["step"]), columns)
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise InputError(
                f"series: {type(error).__name__}: {error}; expected the keys start, step and columns as "
                "written by the study; run the study again"
            ) from error

    def write(self, path: Path) -> None:
        """Write the compact form as JSON."""
        path.write_text(json.dumps(self.to_dict(), separators=(",", ":")), encoding="utf-8")

    @classmethod
    def read(cls, path: Path) -> Series:
        """Read what :meth:`write` wrote.

        Raises
        ------
        InputError
            The file is missing or is not such a file.
        """
        return cls.from_dict(read_json(path))


def read_json(path: Path) -> dict[str, Any]:
    """Read a JSON object from a file.

    Raises
    ------
    InputError
        The file is missing, no JSON or no object.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}; expected a file written by 'mascarin study'") from error
    except ValueError as error:
        raise InputError(f"{path}: not JSON ({error}); run the study again") from error
    if not isinstance(content, dict):
        raise InputError(f"{path}: holds a {type(content).__name__}; expected an object written by the study")
    return content


def check(study: Mapping[str, Any], series: Series) -> None:
    """Check what a report cannot do without.

    Raises
    ------
    InputError
        No title, or metrics of a sensor, period or model that is not declared.
    """
    if not study.get("title"):
        raise InputError("study: no 'title'; expected the name of the study")
    for sensor, periods in study.get("sensors", {}).items():
        _declared("sensor_info", [sensor], study)
        _declared("periods", periods, study)
        for entries in periods.values():
            _declared("models", (key for key, entry in entries.items() if isinstance(entry, dict)), study)
    for key, period in study.get("periods", {}).items():
        for span in period.get("spans", []):
            if len(span) != 2:
                raise InputError(f"study: periods.{key}.spans holds {span}; expected pairs of start and end")
            moment(span[0])
            moment(span[1])
    for entry in study.get("phase_change", []):
        column = entry.get("column")
        if column is not None and column not in series.columns:
            raise InputError(f"study: phase_change names the series column '{column}', which is not there")


def tidy(study: Mapping[str, Any]) -> dict[str, Any]:
    """Leave out periods that hold the same instants as one before them.

    Parameters
    ----------
    study : mapping
        As in :class:`Study`.

    Returns
    -------
    dict
        The same without the repetitions, in periods, metrics, criteria and aims.
    """
    kept: dict[str, Any] = {}
    for key, period in study.get("periods", {}).items():
        if not any(period.get("spans") == other.get("spans") for other in kept.values()):
            kept[key] = period
    sensors = {
        sensor: {key: entries for key, entries in periods.items() if key in kept}
        for sensor, periods in study.get("sensors", {}).items()
    }
    limits = {
        what: [c for c in study.get(what, []) if not c.get("period") or c["period"] in kept]
        for what in ("criteria", "aims")
    }
    changed = {"periods": kept, "sensors": sensors, **limits}
    return {**study, **{key: value for key, value in changed.items() if key in study}}


def _declared(where: str, names: Iterable[str], study: Mapping[str, Any]) -> None:
    known: Sequence[str] = list(study.get(where, {}))
    for name in names:
        if name not in known:
            raise InputError(f"study: metrics of '{name}', which '{where}' does not declare (it has {known})")


def moment(text: str) -> datetime:
    """Read a local time without offset.

    Raises
    ------
    InputError
        It is not ISO 8601 or carries an offset.
    """
    try:
        time = datetime.fromisoformat(text)
    except (TypeError, ValueError) as error:
        raise InputError(f"time '{text}': expected ISO 8601, e.g. 2012-09-20T00:00") from error
    if time.tzinfo is not None:
        raise InputError(f"time '{text}' carries an offset; expected local time of the study's zone")
    return time


def _packed(column: Column) -> _Column:
    values = np.asarray(column.values, dtype=np.float64)
    finite = values[np.isfinite(values)]
    low = float(finite.min()) if finite.size else 0.0
    high = float(finite.max()) if finite.size else 0.0
    scale = (high - low) / _LEVELS or 1.0
    levels = np.where(np.isfinite(values), np.round((values - low) / scale) - _LEVELS // 2, _MISSING)
    data = base64.b64encode(levels.astype("<i2").tobytes()).decode("ascii")
    return {"label": column.label, "unit": column.unit, "offset": low, "scale": scale, "data": data}


def _unpacked(raw: Mapping[str, Any]) -> Column:
    levels = np.frombuffer(base64.b64decode(raw["data"]), dtype="<i2").astype(np.float64)
    values = (levels + _LEVELS // 2) * float(raw["scale"]) + float(raw["offset"])
    values[levels == _MISSING] = math.nan
    return Column(values, str(raw["label"]), str(raw["unit"]))
