"""Powers and flows that are a number, or follow a measured column."""

from __future__ import annotations

from typing import ClassVar

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.number import Number, Remark, problem, quantity_of
from mascarin.building.base.part import Part
from mascarin.building.base.time_series import ColumnCourse, CourseKind


class Driven(Part):
    """A power or a flow: a number or a measured column, which a schedule may multiply."""

    #: Key of the number, and what a column holds.
    NUMBER: ClassVar[str] = ""
    KIND: ClassVar[CourseKind] = "power"

    column: str | None = Field(None, description="Measured column with the values; none: a number")
    factor: q.ColumnFactor | None = None

    @model_validator(mode="after")
    def _one_source(self) -> Driven:
        stated = [key for key in (self.NUMBER, "column") if getattr(self, key) is not None]
        if len(stated) != 1 and not (not stated and self._needs_none()):
            raise problem(
                " and ".join(stated) or f"no {self.NUMBER}",
                f"exactly one of {self.NUMBER} and column",
                "Keep one source of this quantity.",
            )
        if self.column is None:
            for key in ("factor", "unit"):
                if key in self.model_fields_set and getattr(self, key) is not None:
                    raise problem(f"'{key}' without a column", "none", f"Remove '{key}:'.")
            return self
        if self.factor is None:
            quantity = quantity_of(type(self).model_fields["factor"])
            self._fill(factor=Number(1.0, source=Remark("as measured"), derived=True, quantity=quantity))
        return self

    def _needs_none(self) -> bool:
        """Whether the part may have neither a number nor a column."""
        return False

    @property
    def course(self) -> ColumnCourse | None:
        """Course of the column; None where there is a number."""
        if self.column is None:
            return None
        unit = str(getattr(self, "unit", None) or self._usual_unit())
        return ColumnCourse(self.KIND, (self.column,), unit, getattr(self, "schedule", None))

    @classmethod
    def _usual_unit(cls) -> str:
        usual = {"power": "W", "heat_flux": "W/m2", "air_change": "1/h", "water_flow": "kg/s"}
        return (usual | {"temperature_gradient": "K/m"}).get(cls.KIND, "m3/s")

    @property
    def number(self) -> float:
        """The number; 0 where there is none."""
        return float(getattr(self, self.NUMBER, None) or 0.0)

    def in_words(self, unit: str) -> str:
        """The value, or where it comes from."""
        return f"{self.number:g} {unit}" if self.column is None else f"column {self.column}"
