"""Measured irradiance that is brighter than the sun and the sky can be.

Of the extraterrestrial irradiance on the horizontal, a clear sky leaves 0.7 to 0.8. Clouds beside the sun add
to it for minutes, and below an elevation of a few degrees refraction, twilight and the mean over an interval
exceed it in good records: 10 rows of each record of the Twin Houses, 25 hours of the shipped year of Tampa.
1.5 times is the limit of physically possible values of the Baseline Surface Radiation Network (Long & Dutton
2002), and the zero offset of a pyranometer of class B is added to it.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.tables.arrays import Flags
from mascarin.tables.quality import Stretch, runs
from mascarin.tables.times import stamps_of
from mascarin.weather.checks.once import said_once
from mascarin.weather.derived import completion
from mascarin.weather.records.channels import SUN_POSITION
from mascarin.weather.records.record import WeatherRecord

if TYPE_CHECKING:
    import pandas as pd

MOST: Final = 1.5
"""Largest ratio to the extraterrestrial irradiance on the horizontal (Long & Dutton 2002, BSRN Global Network
recommended QC tests V2.0). [-]"""
OFFSET: Final = 21.0
"""Total zero offset of a pyranometer of class B (ISO 9060:2018, table 1). [W/m2]"""
_LIMIT: Final = (
    f"above {MOST:g} times the extraterrestrial irradiance on the horizontal, and {OFFSET:g} W/m2 more"
)
_NAMES: Final = ("global_horizontal", "diffuse_horizontal")


def too_bright(record: WeatherRecord, latitude: float, longitude: float) -> dict[str, Flags]:
    """Rows whose irradiance exceeds what is possible.

    Parameters
    ----------
    record : WeatherRecord
        As read.
    latitude, longitude : float
        Positive north and east. [deg]

    Returns
    -------
    dict of str to ndarray of bool, shape (rows,)
        For global and diffuse irradiance, as far as they are in the record.
    """
    names = [name for name in _NAMES if name in record.columns and np.any(record.columns[name] > OFFSET)]
    if not names:
        return {}
    highest = completion.extraterrestrial_horizontal(record, latitude, longitude, record.kinds[names[0]])
    with np.errstate(invalid="ignore"):
        return {name: record.columns[name] > MOST * highest + OFFSET for name in names}


def findings(record: WeatherRecord, latitude: float, longitude: float) -> tuple[str, ...]:
    """Say which irradiances exceed what is possible; nothing for a sound record.

    Parameters
    ----------
    record : WeatherRecord
        As read.
    latitude, longitude : float
        Positive north and east. [deg]

    Returns
    -------
    tuple of str
        A sentence for each column: number of rows, the first time, the worst value, what to check.
    """
    columns = [record.columns[name] for name in (*_NAMES, *SUN_POSITION) if name in record.columns]
    key = ("bright", tuple(record.kinds.get(name, "") for name in _NAMES), latitude, longitude)

    def sentences() -> list[str]:
        bright = too_bright(record, latitude, longitude)
        return [_sentence(record, name, rows) for name, rows in bright.items() if rows.any()]

    return said_once(record, columns, key, [sys.modules[__name__], completion], sentences)


def with_findings(
    completed: WeatherRecord, record: WeatherRecord, latitude: float, longitude: float
) -> WeatherRecord:
    """A completed record whose provenance has the findings of the record that it was made of.

    Parameters
    ----------
    completed : WeatherRecord
        With all irradiances.
    record : WeatherRecord
        As read.
    latitude, longitude : float
        Positive north and east. [deg]

    Returns
    -------
    WeatherRecord
        The completed record itself where nothing was found, or nothing that it does not say.
    """
    return with_notes(completed, findings(record, latitude, longitude))


def with_notes(record: WeatherRecord, notes: Sequence[str]) -> WeatherRecord:
    """A record whose provenance has further sentences.

    Parameters
    ----------
    record : WeatherRecord
        Any.
    notes : sequence of str
        Sentences.

    Returns
    -------
    WeatherRecord
        The record itself where it has all of them.
    """
    said = [note for note in notes if note not in record.provenance]
    return replace(record, provenance=(*record.provenance, *said)) if said else record


def bright_parts(record: WeatherRecord, index: pd.Index[pd.Timestamp]) -> list[Stretch]:
    """Parts of a record that are brighter than possible, where its place is known.

    Parameters
    ----------
    record : WeatherRecord
        As read.
    index : pandas.Index
        Time of each row.

    Returns
    -------
    list of Stretch
        In order of column, then start.
    """
    if record.site is None:
        return []
    bright = too_bright(record, float(record.site.latitude), float(record.site.longitude))
    return [
        Stretch(name, "out_of_range", index[first], index[after - 1], after - first, _LIMIT)
        for name, rows in bright.items()
        for first, after in runs(rows)
    ]


def _sentence(record: WeatherRecord, name: str, rows: Flags) -> str:
    grid, bright_rows = record.grid, np.flatnonzero(rows)
    values = record.columns[name]
    worst = int(bright_rows[np.argmax(values[bright_rows])])
    first, at_worst = (
        f"{stamp:%Y-%m-%d %H:%M}"
        for stamp in stamps_of(
            grid.start + grid.interval * np.array([bright_rows[0], worst], dtype=float), grid.zone
        )
    )
    return (
        f"{record.file}: {name} is {_LIMIT} in {len(bright_rows)} of {len(rows)} rows, first at {first}, "
        f"{values[worst]:.0f} W/m2 at {at_worst}; expected at most that. Check time zone, stamps, unit and "
        "sensor; what is calculated from it is bounded by the extraterrestrial irradiance."
    )
