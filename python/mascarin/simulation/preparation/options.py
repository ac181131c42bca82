"""The options of a run: one set of names, types and defaults for every function that runs a building."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from datetime import datetime
from typing import TYPE_CHECKING, Any, Final, Literal, TypeVar

from mascarin._io.arguments import names_of
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from mascarin.simulation.preparation.initial import Initial
    from mascarin.weather import Measurements

F = TypeVar("F", bound=Callable[..., Any])

TimeLike = str | datetime
"""A point in time, such as ``2001-07-01 06:00``; a pandas.Timestamp is a datetime. Without an offset it is
local time of the climate."""

Scheme = Literal["sdirk2", "linearly-implicit", "backward-euler", "apparent-capacity"]
SCHEMES: Final[tuple[Scheme, ...]] = ("sdirk2", "linearly-implicit", "backward-euler", "apparent-capacity")

Precision = Literal["double", "single"]
PRECISIONS: Final[tuple[Precision, ...]] = ("double", "single")

TABLE: Final[Mapping[str, tuple[str, str]]] = {
    "parameters": (
        "mapping of str to float, optional",
        "Values by path that replace those of the building. [unit of each]",
    ),
    "outputs": (
        "sequence of str, optional",
        "What to record. Default: temperatures of air, surfaces, interfaces and sensors, and liquid "
        "fractions.",
    ),
    "start": (
        "str, datetime or pandas.Timestamp, optional",
        "Start of the period; local time of the climate unless an offset is given. Default: start of the "
        "climate.",
    ),
    "end": (
        "str, datetime or pandas.Timestamp, optional",
        "End of the period, as `start`. Default: the last whole step of the climate.",
    ),
    "step": (
        "str or float",
        "Time step, such as ``15min``, or a number of seconds. Text such as ``auto 0.05K every 1h``: steps "
        "that follow the weather, chosen before the run within a tolerance, with records every hour "
        "(docs/speed.md). [s]",
    ),
    "scheme": (
        "str",
        "``sdirk2`` (second order), ``linearly-implicit`` (the same stages by one linear solve each where "
        "that is enough: faster, within some thousandths of a kelvin), ``backward-euler`` (first order), or "
        "``apparent-capacity`` (for "
        "comparison with the literature only: it does not conserve latent heat).",
    ),
    "initial": (
        "'repeat', float, mapping, GivenStart or MeasuredStart",
        "``repeat``: the first period is repeated until no temperature changes by more than 0.01 K. "
        "A number: that temperature everywhere. A mapping, such as ``{'zones': {'room': 24.1}}``: "
        "temperatures of airs and surfaces. A `MeasuredStart`: the first values of sensors. All but "
        "``repeat`` are the same for all members of an ensemble and constant for derivatives. [degC]",
    ),
    "first_period": ("str or float", "Length of the period that ``repeat`` repeats. [s]"),
    "measurements": (
        "Measurements, optional",
        "Table of the measured columns that the building names. Default: those of the climate.",
    ),
    "progress": (
        "bool or callable, optional",
        "Show progress: in notebooks only (None), everywhere (True), nowhere (False); or a function that is "
        "called with the number of units done and their total.",
    ),
}
"""The options in their order: type and description, as in a numpydoc section ``Parameters``."""


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """The options of a run; `progress` is not among them, because it changes no result.

    Parameters
    ----------
    <run options>

    Raises
    ------
    InputError
        A scheme that does not exist; outputs or parameters that are not given by name.

    Examples
    --------
    >>> RunOptions(step="1h").scheme
    'sdirk2'
    """

    parameters: Mapping[str, float] | None = None
    outputs: Sequence[str] | None = None
    start: TimeLike | None = None
    end: TimeLike | None = None
    step: str | float = "15min"
    scheme: Scheme = "sdirk2"
    initial: Initial = "repeat"
    first_period: str | float = "1d"
    measurements: Measurements | None = None

    def __post_init__(self) -> None:
        if self.scheme not in SCHEMES:
            raise InputError(
                f"scheme: found '{self.scheme}', expected one of {', '.join(SCHEMES)}. "
                f"{did_you_mean(self.scheme, SCHEMES, known=False)}".rstrip()
            )
        if self.outputs is not None:
            listed = names_of("outputs", self.outputs, such_as="'room.air_temperature'")
            twice = next((name for name in listed if listed.count(name) > 1), None)
            if twice is not None:
                raise InputError(f"outputs: '{twice}' is listed twice, expected each output once")
        if self.parameters is not None and not isinstance(self.parameters, Mapping):
            raise InputError(
                f"parameters: found {type(self.parameters).__name__}, expected values by path, such as "
                "{'zones.room.volume': 30.0}"
            )

    def keywords(self) -> dict[str, Any]:
        """The options as keyword arguments."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


def require_precision(precision: str, scheme: str) -> None:
    """Check the precision of an ensemble.

    Parameters
    ----------
    precision : str
        What was given.
    scheme : str
        Time-stepping scheme.

    Raises
    ------
    InputError
        It does not exist, or does not go with the scheme.
    """
    if precision not in PRECISIONS:
        raise InputError(
            f"precision: found '{precision}', expected one of {', '.join(PRECISIONS)}. "
            f"{did_you_mean(precision, PRECISIONS, known=False)}".rstrip()
        )
    if precision == "single" and scheme == "apparent-capacity":
        raise InputError(
            "precision: found 'single' with the scheme 'apparent-capacity', expected another scheme: "
            "members in single precision are checked by their energy balance, which it does not close"
        )


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(
        text, 100, initial_indent="    ", subsequent_indent="    ", break_long_words=False,
        break_on_hyphens=False,
    )  # fmt: skip


def described(function: F) -> F:
    """Put the description of the options into a docstring, in place of the line ``<run options>``.

    Only options that the function has are described. The decorated function is the same object.
    """
    text = function.__doc__
    if text is None:  # python -OO
        return function
    has = inspect.signature(function).parameters
    lines = []
    for name, (kind, description) in TABLE.items():
        if name in has:
            lines += [f"{name} : {kind}", *_wrapped(description)]
    text = inspect.cleandoc(text)
    function.__doc__ = text.replace("<run options>", "\n".join(lines))
    return function


described(RunOptions)
