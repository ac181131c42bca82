"""Temperatures that are a number, a schedule or a measured column."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.names import ScheduleName
from mascarin.building.base.number import problem
from mascarin.building.base.part import Part
from mascarin.building.base.time_series import temperature_course


class SetPoint(Part):
    """A temperature that air is brought to: a number, a schedule or a measured column.

    Examples
    --------
    >>> SetPoint(temperature=20)
    SetPoint(temperature=20 degC)
    """

    advice: ClassVar[Mapping[str, str]] = {
        "measured": "Write 'setpoint: {column: NAME}', or 'setpoint: {schedule: NAME}' with a schedule of "
        "kind temperature."
    }

    temperature: q.SetPoint | None = None
    schedule: ScheduleName | None = Field(None, description="Schedule of temperature")
    column: str | None = Field(None, description="Measured column of temperature [degC]")

    @model_validator(mode="after")
    def _one_source(self) -> SetPoint:
        stated = [key for key in ("temperature", "schedule", "column") if getattr(self, key) is not None]
        if len(stated) != 1:
            raise problem(
                " and ".join(stated) or "neither",
                "a temperature [degC], {schedule: name} or {column: name}",
                "Write for instance 'setpoint: 20'.",
            )
        return self

    @property
    def course(self) -> str | None:
        """Name of the schedule or of the course of the column; None for a number."""
        return self.schedule if self.column is None else temperature_course(self.column).name

    @property
    def words(self) -> str:
        """The value, or where it comes from."""
        if self.temperature is not None:
            return f"{self.temperature:g} degC"
        return f"schedule {self.schedule}" if self.schedule is not None else f"column {self.column}"
