"""Criteria: limits on metrics, and whether a comparison meets them.

A criterion is written as a plain mapping, for example::

    {metric: max_error_percent, limit: 10}
    {metric: max_error, limit: 1, sensors: room, name: "room air within 1 degC"}
    {metric: rmse, limit: 0.15, sensors: [interface], periods: blind}
    {metric: cv_rmse, limit: 30, sensors: heating}

The size of the metric is compared, so that a bias of -3 does not meet a limit of 2. ``cv_rmse`` and ``nmbe``
are those of ASHRAE Guideline 14, over the mean of the measurements; a sensor in degC is refused for them. The
Guideline accepts a model by hourly data with NMBE within 10 % and CV(RMSE) up to 30 %, by monthly data with
5 % and 15 %.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, WithJsonSchema

from mascarin._io.limits import at_most
from mascarin.errors import InputError, did_you_mean
from mascarin.validation.comparison import METRICS, OVER_MEAN, PERCENT, TABLE, Metrics

if TYPE_CHECKING:
    MetricName = str
else:
    MetricName = Literal[METRICS]


def _listed(value: object) -> object:
    """A single name is read as a list of one."""
    return [value] if isinstance(value, str) else value


#: Names, or one of them.
Names = Annotated[
    Annotated[tuple[str, ...], Field(min_length=1)] | None,
    BeforeValidator(_listed),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "string"},
                {"type": "array", "items": {"type": "string"}, "minItems": 1},
                {"type": "null"},
            ]
        }
    ),
]


class Criterion(BaseModel):
    """One limit on one metric, for some or all sensors and periods.

    Parameters
    ----------
    metric : str
        What is limited, such as ``rmse``.
    limit : float
        Largest size of the metric, itself allowed. [unit of the metric]
    sensors, periods : sequence of str, optional
        Sensors and periods it applies to. Default: all.
    units : sequence of str, optional
        Units of the sensors it applies to. Default: all.
    name : str, optional
        A name for the report.

    Examples
    --------
    >>> Criterion(metric="rmse", limit=0.5, sensors=("room",)).describe("degC")
    '|rmse| <= 0.5 K'
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    metric: MetricName = Field(
        description="What is limited; cv_rmse and nmbe (ASHRAE Guideline 14) are over the mean of the "
        "measurements, all other percentages over the measured range."
    )
    limit: float = Field(
        gt=0.0,
        allow_inf_nan=False,
        description="Largest size of the metric, itself allowed. [unit of the metric]",
    )
    sensors: Names = Field(default=None, description="Sensors it applies to; every sensor when absent.")
    periods: Names = Field(default=None, description="Periods it applies to; every period when absent.")
    units: Names = Field(
        default=None,
        description="Units of the sensors it applies to, such as degC or W; every unit when absent.",
    )
    name: str | None = Field(default=None, description="A name for the report.")

    def describe(self, unit: str) -> str:
        """Describe the criterion in words.

        Parameters
        ----------
        unit : str
            Unit of the sensor; percentages keep their own.

        Returns
        -------
        str
            Its name, or such as ``|max error| <= 2 K``.
        """
        if self.name is not None:
            return self.name
        metric = TABLE[self.metric]
        suffix = " of the measured range" if metric.over == "range" else ""
        # Errors of temperatures are differences.
        of_metric = metric_unit(self.metric, unit).replace("degC", "K")
        return f"{metric.words} <= {self.limit:g} {of_metric}{suffix}"


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether one sensor meets one criterion over one period.

    Attributes
    ----------
    name : str
        The criterion in words.
    sensor, period, metric : str
        What was compared.
    value : float
        The metric, with its sign; NaN when there was nothing to compare. [unit]
    limit : float
        Largest size allowed. [unit]
    unit : str
        Unit of value and limit.
    passed : bool
        Whether the size of the value is at most the limit; False when there was nothing to compare.

    Examples
    --------
    >>> Verdict("|bias| <= 1 K", "room", "july", "bias", 0.5, 1.0, "degC", passed=True).to_dict()["value"]
    0.5
    """

    name: str
    sensor: str
    period: str
    metric: str
    value: float
    limit: float
    unit: str
    passed: bool

    def to_dict(self) -> dict[str, str | float | bool | None]:
        """Return the verdict for a JSON file; a value that could not be computed is None."""
        return {
            "name": self.name,
            "sensor": self.sensor,
            "period": self.period,
            "metric": self.metric,
            "value": self.value if math.isfinite(self.value) else None,
            "limit": self.limit,
            "unit": self.unit,
            "passed": self.passed,
        }


def parse_criteria(items: Iterable[Mapping[str, Any]], *, where: str = "criteria") -> tuple[Criterion, ...]:
    """Read criteria from plain mappings.

    Parameters
    ----------
    items : iterable of mapping
        One mapping per criterion, see `Criterion`.
    where : str
        Place named in errors, such as ``study.yaml:31: criteria``.

    Returns
    -------
    tuple of Criterion

    Raises
    ------
    InputError
        For an unknown key or metric, a missing or non-positive limit.

    Examples
    --------
    >>> parse_criteria([{"metric": "max_error", "limit": 1.0, "sensors": "room"}])[0].sensors
    ('room',)
    """
    criteria = []
    for k, item in enumerate(items):
        try:
            criteria.append(Criterion.model_validate(dict(item)))
        except ValidationError as error:
            raise InputError(_explain(error, f"{where}[{k}]")) from error
    return tuple(criteria)


def judge(
    criteria: Sequence[Criterion], metrics: Mapping[str, Mapping[str, Metrics]], *, where: str = "criteria"
) -> list[Verdict]:
    """Apply criteria to the metrics of a comparison.

    Parameters
    ----------
    criteria : sequence of Criterion
        The limits.
    metrics : mapping of sensor to mapping of period to Metrics
        What `metrics` found.
    where : str
        Place named in errors.

    Returns
    -------
    list of Verdict
        By criterion, then sensor, then period.

    Raises
    ------
    InputError
        A criterion names a sensor or period that was not compared, or limits a metric over the mean of a
        sensor in degC.

    Examples
    --------
    >>> from mascarin.validation.comparison import metrics
    >>> found = {"room": {"july": metrics([20.0, 22.0, 24.0], [20.5, 22.5, 24.5])}}
    >>> judge([Criterion(metric="bias", limit=1.0)], found)[0].passed
    True
    """
    verdicts: list[Verdict] = []
    # A sensor may lack a period that another has; a name that none has is a mistake.
    all_periods = {period: None for periods in metrics.values() for period in periods}
    for k, criterion in enumerate(criteria):
        sensors = _selected(criterion.sensors, metrics, f"{where}[{k}]: sensor")
        sensors = _of_units(criterion, sensors, metrics, f"{where}[{k}]")
        _require_true_zero(criterion, sensors, metrics, f"{where}[{k}]")
        periods = _selected(criterion.periods, all_periods, f"{where}[{k}]: period")
        verdicts += [
            _verdict(criterion, sensor, period, metrics[sensor][period])
            for sensor in sensors
            for period in periods
            if period in metrics[sensor]
        ]
    return verdicts


def metric_unit(metric: str, unit: str) -> str:
    """Return the unit of a metric of a sensor that measures in `unit`."""
    return "%" if metric in PERCENT else unit


def _require_true_zero(
    criterion: Criterion, sensors: Sequence[str], metrics: Mapping[str, Mapping[str, Metrics]], where: str
) -> None:
    """Refuse a metric over the mean of the measurements for temperatures in degC."""
    if criterion.metric not in OVER_MEAN:
        return
    for sensor in sensors:
        if any(period_metrics.unit == "degC" for period_metrics in metrics[sensor].values()):
            other = TABLE[criterion.metric].instead
            raise InputError(
                f"{where}: found {criterion.metric} for sensor '{sensor}' in degC, expected a sensor whose "
                "zero has a physical meaning, such as energy or power: the mean of a temperature depends on "
                f"the zero of its scale. Name the sensors it applies to, or use {other}"
            )


def _verdict(criterion: Criterion, sensor: str, period: str, metrics: Metrics) -> Verdict:
    value = float(getattr(metrics, criterion.metric))
    return Verdict(
        name=criterion.describe(metrics.unit),
        sensor=sensor,
        period=period,
        metric=criterion.metric,
        value=value,
        limit=criterion.limit,
        unit=metric_unit(criterion.metric, metrics.unit),
        passed=at_most(abs(value), criterion.limit),
    )


def _selected(selection: tuple[str, ...] | None, names: Mapping[str, object], where: str) -> list[str]:
    """Return the names a criterion applies to; each is known."""
    if selection is None:
        return list(names)
    for name in selection:
        if name not in names:
            msg = f"{where} '{name}' was not compared. {did_you_mean(name, names)}"
            raise InputError(msg)
    return list(selection)


def _of_units(
    criterion: Criterion, sensors: list[str], metrics: Mapping[str, Mapping[str, Metrics]], where: str
) -> list[str]:
    """Sensors of the units that a criterion applies to."""
    if criterion.units is None:
        return sensors
    unit_of = {s: next((period_metrics.unit for period_metrics in metrics[s].values()), "") for s in sensors}
    for unit in criterion.units:
        if unit not in unit_of.values():
            raise InputError(
                f"{where}: unit '{unit}' is that of no sensor it applies to. "
                f"{did_you_mean(unit, unit_of.values())}".rstrip()
            )
    return [sensor for sensor in sensors if unit_of[sensor] in criterion.units]


def _explain(error: ValidationError, where: str) -> str:
    """Describe what is wrong with a mapping, one line per error."""
    lines = []
    for fault in error.errors():
        path = ".".join(str(part) for part in fault["loc"])
        value = fault["input"]
        if fault["type"] == "extra_forbidden":
            hint = did_you_mean(path, Criterion.model_fields)
            lines.append(f"{where}.{path}: unknown key. {hint}".rstrip())
        elif fault["type"] == "missing":
            lines.append(f"{where}.{path}: missing; a criterion needs 'metric' and 'limit'")
        elif fault["type"] == "literal_error":
            hint = did_you_mean(str(value), METRICS)
            lines.append(f"{where}.{path}: '{value}' is not a metric. {hint}".rstrip())
        else:
            lines.append(f"{where}.{path}: {fault['msg']}, found {value!r}")
    return "\n".join(lines)
