"""A converted model, simulated beside a run of EnergyPlus: zones, loads and sun by month."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from mascarin.energyplus.comparison.causes import known_causes
from mascarin.energyplus.comparison.run_folder import TITLES, PeerRun, read_run, rms
from mascarin.energyplus.comparison.series import Array
from mascarin.energyplus.conversion import Conversion
from mascarin.errors import InputError
from mascarin.simulation import simulate
from mascarin.weather import Climate

#: Output of a zone for each quantity.
_OUTPUTS: Final = {
    "air": "air_temperature",
    "heating": "heating_load",
    "cooling": "cooling_load",
    "sun": "transmitted_solar",
}
QUANTITIES: Final = tuple(_OUTPUTS)
#: What is said of all zones together.
ALL: Final = "all zones"
#: Difference of the outdoor air above which the weather is another one [K].
_SAME_WEATHER: Final = 1.0
#: Heat below which no percentage is stated [kWh].
_LEAST: Final = 0.1
#: Difference of a volume of which another state of the model may be the cause [-].
_SAME_SIZE: Final = 0.02


@dataclass(frozen=True)
class ComparedSpan:
    """A month, or all of the period.

    Attributes
    ----------
    month : int
        1 to 12; 0 for all of the period.
    rms, bias : float
        Of the hourly differences, Mascarin less EnergyPlus: air temperature [K], heat [W].
    ours, theirs : float
        Mean air temperature [degC], or heat. [kWh]
    """

    month: int
    rms: float
    bias: float
    ours: float
    theirs: float

    @property
    def percent(self) -> float | None:
        """Heat of Mascarin over that of EnergyPlus, less one; None below 0.1 kWh. [%]"""
        return 100.0 * (self.ours / self.theirs - 1.0) if self.theirs > _LEAST else None


@dataclass(frozen=True)
class ComparedRow:
    """One quantity of one zone, or of all zones.

    Attributes
    ----------
    zone : str
        Its name in the file, or ``all zones``.
    quantity : str
        ``air``, ``heating``, ``cooling`` or ``sun``.
    period : ComparedSpan
        All of the period.
    months : tuple of ComparedSpan
        Its months.
    """

    zone: str
    quantity: str
    period: ComparedSpan
    months: tuple[ComparedSpan, ...]


@dataclass(frozen=True)
class Comparison:
    """A model in both programs.

    Attributes
    ----------
    conversion : Conversion
        The converted model.
    run : PeerRun
        Results of EnergyPlus.
    rows : tuple of ComparedRow
        Quantities in their order; all zones first, then the zones with the largest differences.
    causes : tuple of str
        What is known to make the programs differ in this model.
    notes : tuple of str
        What was not compared, and what may be another state of the model.
    """

    conversion: Conversion
    run: PeerRun
    rows: tuple[ComparedRow, ...]
    causes: tuple[str, ...]
    notes: tuple[str, ...]


def compare(conversion: Conversion, folder: str | Path, weather: str | Path) -> Comparison:
    """Simulate a converted model, and compare it with a run of EnergyPlus.

    Parameters
    ----------
    conversion : Conversion
        From `convert`, with the same ``weather``.
    folder : str or Path
        Where EnergyPlus has left ``eplusout.csv`` or ``eplusout.eso`` of the same model.
    weather : str or Path
        Weather file of that run (EPW).

    Returns
    -------
    Comparison
        Air temperatures, ideal loads and sun of the zones by month, with known causes.

    Raises
    ------
    InputError
        The folder has no results that can be compared: none, of a run that failed, or of another model,
        period, time step or weather.

    Examples
    --------
    >>> from mascarin.energyplus import convert
    >>> from mascarin.energyplus.comparison import compare
    >>> compare(convert("a.idf", weather="a.epw"), "run", "a.epw").rows  # doctest: +SKIP
    """
    run = read_run(Path(folder), conversion)
    climate = Climate.from_epw(weather)
    months, outdoors, ours = _simulated(conversion, climate, run.hours)
    if run.outdoors is not None and rms(outdoors - run.outdoors) > _SAME_WEATHER:
        raise InputError(
            f"{run.folder}: found outdoor air that differs from that of {weather} by "
            f"{rms(outdoors - run.outdoors):.1f} K; expected the same weather. Name the file of the run with "
            "--weather"
        )
    rows: list[ComparedRow] = []
    for quantity in QUANTITIES:
        pairs = {
            zone: (ours[quantity, zone], run.series[quantity, zone.upper()])
            for zone in conversion.names["zones"]
            if (quantity, zone) in ours and (quantity, zone.upper()) in run.series
        }
        rows += _rows_of(quantity, pairs, months)
    return Comparison(
        conversion,
        run,
        tuple(rows),
        tuple(known_causes(conversion, run)),
        tuple(_notes(conversion, run, ours)),
    )


def _simulated(
    conversion: Conversion, climate: Climate, hours: int
) -> tuple[npt.NDArray[np.int64], Array, dict[tuple[str, str], Array]]:
    """Month of each hour, hourly outdoor air [degC], and results: air [degC], heat [Wh]."""
    building, steps = conversion.building, conversion.steps_per_hour
    available = {output.name for output in building.outputs()}
    names = {
        (quantity, original): f"{zone}.{kind}"
        for original, zone in conversion.names["zones"].items()
        for quantity, kind in _OUTPUTS.items()
        if f"{zone}.{kind}" in available
    }
    results = simulate(
        building, climate, start=conversion.start, end=conversion.end, step=f"{60 // steps}min",
        outputs=list(names.values()),
    )  # fmt: skip
    # A record belongs to the step that ends there.
    records = results.records[-hours * steps :].reshape(hours, steps, -1).mean(axis=1)
    columns = {output.name: k for k, output in enumerate(results.outputs)}
    hourly = {key: records[:, columns[name]] for key, name in names.items()}
    start = np.datetime64(date.fromisoformat(conversion.start), "h")
    stamps = start + np.arange(hours)
    months = stamps.astype("datetime64[M]").astype(np.int64) % 12 + 1
    return months, _outdoors(climate, stamps), hourly


def _outdoors(climate: Climate, stamps: npt.NDArray[np.datetime64]) -> Array:
    """Air temperature of the hours of a typical year. [degC]"""
    values = np.asarray(climate.to_dataframe()["air_temperature"], dtype=float)
    first = stamps.astype("datetime64[Y]")[0]
    # Hours from the beginning of the year.
    rows = (stamps - first.astype("datetime64[h]")).astype(np.int64)
    return np.asarray(values[rows % len(values)])


def _rows_of(
    quantity: str, pairs: dict[str, tuple[Array, Array]], months: npt.NDArray[np.int64]
) -> list[ComparedRow]:
    rows = [_row(zone, quantity, [pair], months) for zone, pair in pairs.items()]
    rows.sort(key=lambda row: -row.period.rms)
    if len(pairs) > 1:
        rows.insert(0, _row(ALL, quantity, list(pairs.values()), months))
    return rows


def _row(
    zone: str, quantity: str, pairs: list[tuple[Array, Array]], months: npt.NDArray[np.int64]
) -> ComparedRow:
    ours, theirs = (np.array(side) for side in zip(*pairs, strict=True))
    spans = [
        _span(quantity, month, ours[:, chosen], theirs[:, chosen])
        for month in dict.fromkeys(months.tolist())
        for chosen in [months == month]
    ]
    return ComparedRow(zone, quantity, _span(quantity, 0, ours, theirs), tuple(spans))


def _span(quantity: str, month: int, ours: Array, theirs: Array) -> ComparedSpan:
    miss = ours - theirs
    size = np.mean if quantity == "air" else lambda values: np.sum(values) / 1000.0
    return ComparedSpan(month, rms(miss), float(miss.mean()), float(size(ours)), float(size(theirs)))


def _notes(conversion: Conversion, run: PeerRun, ours: dict[tuple[str, str], Array]) -> list[str]:
    notes = []
    for quantity in QUANTITIES:
        missing = [
            zone for which, zone in ours if which == quantity and (quantity, zone.upper()) not in run.series
        ]
        if missing:
            name, _, _ = TITLES[quantity][0].partition(" [")
            notes.append(
                f"{quantity} of {len(missing)} zones is not in the run: 'Output:Variable,*,{name},Hourly;'"
                " adds it"
            )
    for original, zone in conversion.names["zones"].items():
        volume, stated = float(conversion.building.zones[zone].volume or 0.0), run.sizes.get(original.upper())
        if stated is not None and abs(volume / stated - 1.0) > _SAME_SIZE:
            notes.append(
                f"zone '{original}' has {volume:.4g} m3 here, {stated:.4g} m3 in the run: is it this model?"
            )
    return notes
