"""Keys of ``study.json`` that a report reads.

Every key but ``title`` may be missing: its part of the report is then left out. Dictionaries are shown in the
order in which they are given.
"""

from __future__ import annotations

from typing import Any, TypedDict


class Metrics(TypedDict, total=False):
    """Errors of a model for one sensor and period: simulated minus measured."""

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
    """A model whose results are compared: nominal, fitted, or a variant."""

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
    """Why the estimate is on a bound, or is not identifiable."""
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
    """An assumed value."""

    path: str
    value: float
    unit: str
    low: float
    high: float
    source: str
    assumed: bool


class QualityEntry(TypedDict, total=False):
    """Suspicious values of a measured column."""

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
    """What is on the outside: ``outdoors``, a zone, ``ground``, the measured column, ``adiabatic``."""
    inside: str
    vertices: list[list[float]]
    film_outside: str
    film_inside: str


class BuildingEntry(TypedDict, total=False):
    """The building."""

    name: str
    site: list[list[str]]
    """Rows of name and value, as text with units."""
    zones: list[dict[str, Any]]
    """Each with ``name`` and ``volume`` [m3]."""
    constructions: list[dict[str, Any]]
    """Each with ``name`` and ``layers`` (:class:`LayerEntry`, outside to inside)."""
    surfaces: list[SurfaceEntry]
    windows: list[dict[str, str]]
    """Each with ``name`` and the ``surface`` that it is in."""
    doors: list[list[str]]
    """Pairs of zones that a door joins."""
    probes: list[dict[str, Any]]
    """Thermometers in walls: ``name``, ``surface``, ``depth`` [m from outside]."""
    choices: list[list[str]]
    """Rows of name and value of modeling choices."""


class Share(TypedDict, total=False):
    """First-order index of a parameter for an output: the part of the variance that it causes."""

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
    """Values below it are not significant."""
    peaks: list[dict[str, Any]]
    """Each with ``frequency``, ``power``, ``path``, ``harmonic``."""


class DayShares(TypedDict, total=False):
    """First-order indices over the hours of the day."""

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
    """Sources of remaining error, parameter by parameter; ``sd`` is by sensor."""

    sd: dict[str, float]
    """Of the fitted model."""
    period: str
    steps: list[dict[str, Any]]
    """Each with ``path`` (what is changed besides those before), ``changes`` by path [ranges], and ``sd``."""
    all_parameters: dict[str, Any]
    """``parameters``, their number, and ``sd`` with all of them changed."""


class LedgerTerm(TypedDict, total=False):
    """One term of the energy balance."""

    label: str
    value: float
    """[MJ], positive into the building."""


class Ledger(TypedDict, total=False):
    """Energy balance of a run."""

    closure: float
    """Relative energy-balance residual [-]."""
    terms: list[LedgerTerm]
    model: str


class PhaseChange(TypedDict, total=False):
    """States of a phase-change layer."""

    label: str
    temperature: list[float]
    """Mean temperature of the two surfaces of the layer at each time [degC]."""
    enthalpy: list[float]
    """Mean enthalpy of the layer at each time [kJ/kg]."""
    days: list[dict[str, Any]]
    """Single days of it: ``label``, ``temperature``, ``enthalpy``."""
    law_temperature: list[float]
    law_enthalpy: list[float]
    column: str
    """Series column with the liquid fraction over time."""
    hysteresis: bool
    """Whether the material freezes along another curve than it melts, or has a state of its own."""
    own_path: str
    """What a law with a state does beside its curve; absent with two curves or none."""
    rows: list[list[str]]
    """Facts as rows of name and value."""


class Table(TypedDict, total=False):
    """Any further table."""

    title: str
    caption: str
    columns: list[str]
    rows: list[list[Any]]
    uncertainty: dict[str, str]
    """Columns whose digits another column decides: name of the column -> that of its standard uncertainty."""
    significant: list[str]
    """Columns whose numbers span decades, shown with two significant digits each."""
    section: str
    """Identifier of the section it belongs to; ``comparison`` by default."""


class Study(TypedDict, total=False):
    """The keys of ``study.json`` that a report reads."""

    title: str
    intro: list[str]
    """Introduction, in paragraphs."""
    observed: dict[str, str]
    """``label`` (what the data are called, e.g. "virtual experiment") and ``note``."""
    mascarin_version: str
    created: str
    seed: int
    timezone: str
    command: list[str]
    """Commands that give the same results."""
    inputs: list[dict[str, str]]
    """Each with ``name``, ``sha256`` and perhaps ``note``."""
    versions: dict[str, str]
    run_time: float
    """[s]"""
    contradictions: list[dict[str, Any]]
    """By what the calibrated model contradicts its data or what is known, each with ``text``; shown first."""
    warnings: list[str]
    """Warnings of the runs, with the models that have them."""
    sound: bool
    """Whether every energy balance closes and every temperature has a cause."""
    sources: list[dict[str, str]]
    """Each with ``text`` and perhaps ``doi``."""
    sensor_info: dict[str, SensorInfo]
    periods: dict[str, Period]
    models: dict[str, Model]
    sensors: dict[str, dict[str, dict[str, Metrics]]]
    """sensor -> period -> model -> metrics; other keys beside the models are left alone."""
    reference: dict[str, Any]
    """A publication for comparison: ``label``, ``note``, ``sensors`` (as above, without models), its
    ``tables`` by what they hold, its ``influential`` parameters with ``symbol`` and ``frequency``, and its
    identified ``parameters`` with ``symbol``, ``before``, ``after`` and perhaps ``unit`` and ``delta_t``."""
    reference_values: dict[str, dict[str, Any]]
    """``value`` and ``unit`` of its parameters in the building as described."""
    coefficients: dict[str, Any]
    """Effective mean convective coefficients: ``period``, ``unit``, and ``models``: model -> law -> value."""
    band: dict[str, dict[str, Any]]
    """Prediction interval of each sensor: ``confidence`` [-] and ``held``, the coverage by period [-]."""
    building: BuildingEntry
    assumptions: list[Assumption]
    quality: list[QualityEntry]
    parameters: dict[str, ParameterEntry]
    variant_parameters: dict[str, dict[str, ParameterEntry]]
    """The same of other models that were identified."""
    correlation: dict[str, Any]
    """``paths`` and ``matrix`` of the correlation between the estimates."""
    identification: list[list[str]]
    """Rows of name and value about the calibration."""
    criteria: list[Criterion]
    aims: list[Criterion]
    """Desired limits, which are not required."""
    shortfall: Shortfall
    diagnosis: dict[str, Any]
    """``causes`` in their order, ``noise`` by sensor, ``remaining`` [-], and a ``table`` of the causes."""
    days: dict[str, Any]
    """Leverage and expected information of each day, and a ``table`` of the most important ones."""
    sensitivity: dict[str, dict[str, Share]]
    sensitivity_design: list[list[str]]
    frequencies: dict[str, int]
    """Frequency of each parameter in the spectra."""
    spectra: dict[str, Spectrum]
    day_shares: dict[str, DayShares]
    residuals: dict[str, Residuals]
    transfer: dict[str, dict[str, Any]]
    """Other houses, seasons and phases: ``building``, ``words``, and ``sensors``: sensor -> period ->
    ``described`` and ``calibrated`` metrics, ``held`` [-] and ``unit``."""
    start: str
    """Initial state of the run."""
    ledger: Ledger
    phase_change: list[PhaseChange]
    tables: list[Table]
    notes: list[dict[str, str]]
    """Each with ``title`` and ``text``: remarks of the analysis."""
