"""Hypothesis strategies for tables with a time column."""

from __future__ import annotations

import numpy as np
import pandas as pd
from hypothesis import settings
from hypothesis import strategies as st

from mascarin.tables.reading.numbers import CODES

quick = settings(deadline=None, max_examples=40)
"""Few examples, each as long as it takes."""

ZONES = ("UTC", "Europe/Paris", "Indian/Reunion", "America/Denver", "Australia/Lord_Howe")
STEPS = ("1min", "10min", "15min", "30min", "1h", "3h", "24h")

# A code of loggers for no value, such as -999, is read as none.
numbers = (
    st.floats(-1e6, 1e6, allow_nan=False, width=32).map(float).filter(lambda number: number not in CODES)
)
names = st.text("abcdefghijklmnopqrstuvwxyz_0123456789", min_size=1, max_size=12).map(lambda s: f"c_{s}")


@st.composite
def indices(draw: st.DrawFn, least: int = 2, most: int = 60) -> pd.DatetimeIndex:
    """Regular stamps with a time zone, also across changes of the clock."""
    start = draw(
        st.datetimes(pd.Timestamp("2000-01-01").to_pydatetime(), pd.Timestamp("2030-01-01").to_pydatetime())
    )
    count, step = draw(st.integers(least, most)), draw(st.sampled_from(STEPS))
    stamps = pd.date_range(pd.Timestamp(start).floor("s"), periods=count, freq=step, tz="UTC")
    return stamps.tz_convert(draw(st.sampled_from(ZONES)))


@st.composite
def tables(draw: st.DrawFn, *, missing: bool = True) -> pd.DataFrame:
    """Numbers in named columns on regular stamps; some are missing, the first and the last row never."""
    index = draw(indices())
    columns = draw(st.lists(names, min_size=1, max_size=4, unique=True))
    values = draw(
        st.lists(
            st.lists(numbers, min_size=len(index), max_size=len(index)),
            min_size=len(columns),
            max_size=len(columns),
        )
    )
    frame = pd.DataFrame(dict(zip(columns, values, strict=True)), index=index)
    if missing:
        inner = st.lists(st.booleans(), min_size=len(index), max_size=len(index))
        gone = np.array(draw(inner))
        gone[[0, -1]] = False
        frame = frame.mask(pd.DataFrame(dict.fromkeys(columns, gone), index=index))
    return frame


positive = st.floats(0.0, 1e3, allow_nan=False).map(float)


@st.composite
def means(draw: st.DrawFn) -> tuple[float, list[float]]:
    """Length of an interval [s] and non-negative means of some intervals."""
    interval = draw(st.sampled_from([300.0, 600.0, 900.0, 1800.0, 3600.0]))
    return interval, draw(st.lists(positive, min_size=3, max_size=24))
