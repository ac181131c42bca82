"""A sensor of a study file."""

from __future__ import annotations

from pydantic import AliasChoices, Field

from mascarin.building.part import Part
from mascarin.validation.sensors import COVERAGE_FACTOR, DEFAULT_EXPANDED, SensorUncertainty


class Sensor(Part):
    """A measured series and the model output that it is compared with."""

    column: str | tuple[str, ...] = Field(description="Column, or several columns, of which the mean is used")
    output: str = Field(description="Output of the model")
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
        description="Further expanded uncertainty in proportion to the measured value, such as 0.05 [-]",
    )
    label: str | None = Field(None, description="Name in the report")
    use: bool = Field(True, description="Whether it is used in the identification")

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns it is made of."""
        return (self.column,) if isinstance(self.column, str) else self.column

    def stated_uncertainty(self, unit: str, name: str) -> SensorUncertainty:
        """Standard uncertainty of the measured values.

        Raises
        ------
        InputError
            Standard and expanded uncertainty together, or none although the unit is not degC.
        """
        return SensorUncertainty.stated(
            unit,
            standard=self.standard_uncertainty,
            expanded=self.expanded_uncertainty,
            relative_expanded=self.relative or None,
            where=f"sensors.{name}",
        )

    @property
    def uncertainty(self) -> float:
        """Expanded uncertainty (95 %), without the relative part. [unit of the output]"""
        if self.expanded_uncertainty is not None:
            return self.expanded_uncertainty
        if self.standard_uncertainty is not None:
            return COVERAGE_FACTOR * self.standard_uncertainty
        return DEFAULT_EXPANDED["degC"]
