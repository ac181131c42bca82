"""A sensor: columns of a measured table, the output that they are compared with, and their uncertainty."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any, Final, Literal, Self

from pydantic import AliasChoices, Field, model_validator

from mascarin.building.base.part import Part, fault, insist
from mascarin.measurements.time_fields import Duration, Hours, Spans, Stretch
from mascarin.measurements.uncertainty import COVERAGE_FACTOR, DEFAULT_EXPANDED, SensorUncertainty

#: First part of the name of an output that a sensor combines from others.
DERIVED: Final = "sensor_"
_ONE_OUTPUT: Final = (
    "one of output, sum and mean",
    "Name one output of the model, or the outputs whose sum or mean is measured.",
)


class SensorPeriods(Part):
    """Periods of one sensor, in place of those of the study; what is excluded is excluded in addition."""

    identification: Spans | None = Field(
        None, description="Start and end of its identification period, or a list of such pairs"
    )
    corroboration: Spans | None = Field(
        None, description="Start and end of its validation period, or a list of such pairs"
    )
    exclude: tuple[Stretch, ...] = Field(
        (), description="Days and pairs of times in which it is not compared"
    )
    exclude_hours: tuple[Hours, ...] = Field(
        (), description="Pairs of hours of the day in which it is not compared"
    )


class Sensor(Part):
    """A measured series and the model output that it is compared with.

    Examples
    --------
    >>> Sensor("T_room", expanded_uncertainty=0.3).columns
    ('T_room',)
    >>> Sensor(["T_1", "T_2"], standard_uncertainty=0.1).uncertainty("degC").absolute
    0.1
    """

    column: str | Annotated[tuple[str, ...], Field(min_length=1)] = Field(
        description="Column, or several columns, of which the mean is used; with `sum`, their sum"
    )
    output: str = Field(
        "", description="Output of the model; none with `sum` or `mean`. In `calibrate` by default the key"
    )
    sum: tuple[str, ...] | None = Field(
        None,
        min_length=2,
        description="Outputs of the model whose sum is compared with the sum of the columns",
    )
    mean: tuple[str, ...] | None = Field(
        None, min_length=2, description="Outputs of the model whose mean is compared with the columns"
    )
    expanded_uncertainty: float | None = Field(
        None,
        gt=0,
        validation_alias=AliasChoices("expanded_uncertainty", "uncertainty"),
        description="Half-width of the 95 % interval of a measured value (GUM, coverage factor 1.96); the "
        "older name uncertainty works as well; 0.5 for a sensor in degC when absent, required for other "
        "units [unit of the output]",
    )
    standard_uncertainty: float | None = Field(
        None,
        gt=0,
        description="Standard deviation of the error of a measured value (GUM), in place of "
        "expanded_uncertainty [unit of the output]",
    )
    relative: float = Field(
        0.0,
        ge=0,
        lt=1,
        validation_alias=AliasChoices("relative", "relative_expanded_uncertainty"),
        description="Further expanded uncertainty in proportion to the measured value, such as 0.05 [-]",
    )
    relative_standard_uncertainty: float = Field(
        0.0,
        ge=0,
        lt=1,
        description="The same as standard uncertainty, in place of relative [-]",
    )
    offset: float | None = Field(
        None,
        ge=0,
        description="Standard uncertainty of a constant added to all readings, such as that of the "
        "calibration of the sensor (accuracy); estimated together with the parameters; by default the "
        "stated standard uncertainty less the scatter of the readings; 0 for none [unit of the output]",
    )
    common: float = Field(
        0.0,
        ge=0,
        description="Standard uncertainty of a constant that all sensors with this key share, such as that "
        "of a logger [unit of the output]",
    )
    gain: float = Field(
        0.0,
        ge=0,
        lt=1,
        description="Standard uncertainty of a part of the distance from `reference` that is added to it [-]",
    )
    reference: float = Field(0.0, description="Reading at which a gain has no effect [unit of the output]")
    clock: Duration | None = Field(
        None, description="Standard uncertainty of the time by which the clock of the logger is fast"
    )
    depth: float | None = Field(
        None,
        gt=0,
        description="Standard uncertainty of the depth of a sensor in a wall (`sensors` of the building) [m]",
    )
    repeatability: float | None = Field(
        None,
        gt=0,
        description="Standard deviation of repeated readings under the same conditions, without what they "
        "share; by default estimated from the record [unit of the output]",
    )
    label: str | None = Field(None, description="Name in the report")
    use: bool = Field(True, description="Whether it is used in the identification")
    periods: SensorPeriods | None = Field(
        None, description="Its own periods, where they differ from those of the study"
    )

    # The column may be the first argument: mypy reads the other keys from here as well.
    def __init__(self, column: str | Sequence[str] | None = None, /, **fields: Any) -> None:
        super().__init__(**fields if column is None else {"column": column, **fields})

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @model_validator(mode="after")
    def _one_quantity(self) -> Self:
        stated = [key for key in ("output", "sum", "mean") if getattr(self, key)]
        combined = self.combined
        if combined is not None and stated[0] == "output" and self.output.startswith(DERIVED):
            return self  # what a study has made of it
        if len(stated) > 1:
            insist(fault((), " and ".join(stated), *_ONE_OUTPUT))
        if combined is not None and len(set(combined[1])) < len(combined[1]):
            twice = next(name for name in combined[1] if combined[1].count(name) > 1)
            insist(fault((combined[0],), f"'{twice}' twice", "each output once", f"Name '{twice}' once."))
        return self

    @model_validator(mode="after")
    def _one_form(self) -> Self:
        for standard, expanded in (
            ("standard_uncertainty", "expanded_uncertainty"),
            ("relative_standard_uncertainty", "relative"),
        ):
            if getattr(self, standard) and getattr(self, expanded):
                values = f"{getattr(self, standard):g} beside {expanded} {getattr(self, expanded):g}"
                insist(fault((standard,), values, "one of them", "Leave one out."))
        return self

    @property
    def combined(self) -> tuple[Literal["sum", "mean"], tuple[str, ...]] | None:
        """How outputs are combined, and which; None for a single output."""
        if self.sum is not None:
            return "sum", self.sum
        return None if self.mean is None else ("mean", self.mean)

    @property
    def adds(self) -> bool:
        """Whether its columns are added, not averaged."""
        return self.sum is not None

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns it is made of."""
        return (self.column,) if isinstance(self.column, str) else self.column

    def uncertainty(self, unit: str, where: str = "") -> SensorUncertainty:
        """Standard uncertainty of the measured values.

        Parameters
        ----------
        unit : str
            Unit of the output.
        where : str
            Name of the sensor in errors.

        Raises
        ------
        InputError
            None is stated although the unit is not degC.
        """
        return SensorUncertainty.stated(
            unit,
            standard=self._standard,
            expanded=self.expanded_uncertainty,
            relative_standard=self.relative_standard_uncertainty or None,
            relative_expanded=self.relative or None,
            where=where or f"sensor of column {', '.join(self.columns)}",
        )

    @property
    def expanded(self) -> float:
        """Expanded uncertainty (95 %) as stated, without the relative part. [unit of the output]"""
        if self.expanded_uncertainty is not None:
            return self.expanded_uncertainty
        if self._standard is not None:
            return COVERAGE_FACTOR * self._standard
        return DEFAULT_EXPANDED["degC"]

    @property
    def _standard(self) -> float | None:
        """Standard uncertainty of a reading: as stated, else from its parts. [unit of the output]"""
        if self.standard_uncertainty is not None or self.expanded_uncertainty is not None:
            return self.standard_uncertainty
        return math.hypot(self.offset or 0.0, self.common, self.repeatability or 0.0) or None

    @property
    def states_errors(self) -> bool:
        """Whether it says which errors the readings share."""
        shared = (self.offset, self.common, self.gain, self.clock, self.depth)
        return any(part is not None and part != 0.0 for part in shared)


def with_output(sensor: Sensor) -> Sensor:
    """Refuse a sensor that does not say what it is compared with, as those of a study do."""
    if not (sensor.output or sensor.combined):
        insist(fault((), "no output", *_ONE_OUTPUT))
    return sensor
