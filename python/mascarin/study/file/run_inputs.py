"""Weather and measurements of a single run, from a study or from a file with the same two keys."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import Field, model_validator

from mascarin._io.regular import requiring
from mascarin.building.base.part import Part
from mascarin.building.engine_input import measured_columns
from mascarin.building.files.yaml_document import validated
from mascarin.study.file.data_sources import FILE_KEYS, ClimateSource, TableSource, with_shared_table
from mascarin.study.file.inputs import Beside, filled, find, open_climate
from mascarin.study.file.locations import Places
from mascarin.weather import Measurements

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.weather import Climate


class RunInputs(Part):
    """Weather, and a table of measurements: what a run takes from a study, or from a file with these keys."""

    climate: ClimateSource = Field(description="Weather data")
    measurements: TableSource | None = Field(
        None, description="Table with the measured columns of the building"
    )

    @model_validator(mode="before")
    @classmethod
    def _one_table(cls, data: Any) -> Any:
        """Keep the keys of a run, and share what weather and measurements have in common."""
        if not isinstance(data, dict):
            return data
        weather = (
            (data.get("climate") or {}).get("measured") if isinstance(data.get("climate"), dict) else None
        )
        kept = {key: data[key] for key in ("climate", "measurements") if key in data}
        return with_shared_table(kept) if "measurements" in kept or weather else kept


def open_run_inputs(
    path: Path, building: Building, *, allow_outside: bool = False
) -> tuple[Climate, Measurements | None]:
    """Read the weather of a run, and the measured columns that its building names.

    Parameters
    ----------
    path : Path
        Study, or a file with ``climate`` and ``measurements`` as in a study.
    building : Building
        Names the columns of its measured boundaries.
    allow_outside : bool
        Whether the file may name files outside its folder.

    Returns
    -------
    climate : Climate
        The weather.
    measurements : Measurements or None
        The columns; None where the building has no measured boundary.

    Raises
    ------
    InputError
        A file, column or time zone is missing, or a value cannot be used.
    """
    beside = Beside(path.parent, allow_outside)
    with requiring(beside.require_inside):
        return _opened(path, building, beside)


def _opened(path: Path, building: Building, beside: Beside) -> tuple[Climate, Measurements | None]:
    inputs = validated(
        path, RunInputs, "weather and measurements", only=("climate", "measurements"), file_keys=FILE_KEYS
    )
    places = Places(path)
    climate = open_climate(inputs.climate, beside, building, places)
    columns, table = measured_columns(building), inputs.measurements
    if not columns or table is None:
        return climate, None
    with places.blame("measurements", "table"):
        file = find(table.table, beside)
    with places.blame("measurements"):
        read = Measurements.from_table(file, columns=columns, **{**table.options, "mean": ()})
        means = [name for name in table.mean if name in columns]
        if means:
            read = Measurements.from_table(file, columns=columns, **{**table.options, "mean": means})
    return climate, read if table.fill_gaps is None else filled(read, building, table.fill_gaps)
