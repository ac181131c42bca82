"""Steps that follow the weather: their choice before a run, and what the run says of them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.durations import AutoStep, length_words, seconds_of
from mascarin.engine_errors import translated
from mascarin.errors import InputError
from mascarin.tables.times import local_time

if TYPE_CHECKING:
    from datetime import tzinfo

    import numpy.typing as npt

    from mascarin import _engine
    from mascarin.building import Building, Output
    from mascarin.tables.arrays import Halvings
    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]

#: A record interval is halved until its parts are no longer than this. [s]
_SHORTEST: Final = 15.0
#: Weather in which steps are chosen: the record interval is halved while its parts are longer. Between the
#: stages of such a step it is a straight line. [s]
_WEATHER: Final = 900.0
#: Record interval that is taken where none is stated and the weather has a shorter one. [s]
_RECORDS: Final = 900.0
#: Longest record interval. [s]
_LONGEST: Final = 6 * 3600.0
#: Length of step for which layers are divided into cells, at most. [s]
_MESH: Final = 900.0
#: Schemes of second order, for which the error of a step is estimated.
_SCHEMES: Final = ("sdirk2", "linearly-implicit")
#: Largest estimated error of a step, as a part of the tolerance. Measured: docs/speed.md. [-]
SHARE: Final = 0.2


@dataclass(frozen=True, eq=False)
class StepSequence:
    """Lengths of the steps of a run, chosen before it.

    Parameters
    ----------
    halvings : ndarray of uint8, shape (steps,)
        How often the record interval is halved for each step.
    interval : float
        Record interval. [s]
    tolerance : float
        Tolerance that was asked for. [K]
    error : float
        Largest estimated error of a step. [K]

    Examples
    --------
    >>> steps = StepSequence(np.array([0, 1, 1], dtype=np.uint8), 3600.0, 0.05, 0.02)
    >>> steps.edges.tolist()
    [0.0, 3600.0, 5400.0, 7200.0]
    >>> steps.to_dict()["sequence"]
    '1x0 2x1'
    """

    halvings: Halvings
    interval: float
    tolerance: float
    error: float

    @cached_property
    def lengths(self) -> Array:
        """Lengths of the steps, shape (steps,). [s]"""
        return np.asarray(self.interval * np.exp2(-self.halvings.astype(np.float64)))

    @cached_property
    def edges(self) -> Array:
        """Ends of the steps, from the start, shape (steps + 1,). [s]"""
        return np.concatenate([[0.0], np.cumsum(self.lengths)])

    def count_in(self, intervals: int) -> int:
        """Steps of the first record intervals.

        Parameters
        ----------
        intervals : int
            Their number.
        """
        return int(np.searchsorted(self.edges, intervals * self.interval))

    @property
    def fixed_count(self) -> int:
        """Steps of one length over the same period, as long as the shortest after the first interval."""
        return round(float(self.edges[-1] / self.shortest))

    @property
    def shortest(self) -> float:
        """Shortest step after the first record interval. [s]"""
        return float(_after_start(self.halvings, self.lengths).min())

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; the sequence as counts and numbers of halvings."""
        runs = ((len(list(group)), int(value)) for value, group in groupby(self.halvings))
        return {
            "tolerance_K": self.tolerance,
            "record_interval_s": self.interval,
            "steps": len(self.halvings),
            "shortest_s": self.shortest,
            "longest_s": float(self.lengths.max()),
            "estimated_error_K": self.error,
            "steps_of_the_shortest_length": self.fixed_count,
            "sequence": " ".join(f"{count}x{value}" for count, value in runs),
        }


def record_interval(auto: AutoStep | None, step: str | float, climate: Climate, scheme: str) -> float:
    """Step of a run, or its record interval where steps are chosen. [s]

    Parameters
    ----------
    auto : AutoStep or None
        What was asked for; None for a step of one length.
    step : str or float
        That length.
    climate : Climate
        The weather.
    scheme : str
        Time-stepping scheme.

    Raises
    ------
    InputError
        A record interval shorter than that of the weather or longer than 6 h, or a scheme of first order.
    """
    if auto is None:
        return seconds_of(step)
    weather, file = climate.grid.interval, climate.file
    if scheme not in _SCHEMES:
        raise InputError(
            f"step: found '{auto}' with the scheme '{scheme}', expected one of {', '.join(_SCHEMES)}: the "
            "error of a step is estimated for schemes of second order. State one length, such as 15min"
        )
    interval = auto.interval
    if interval is None:
        interval = weather * max(1, int(np.ceil(_RECORDS / weather - 1e-9)))
    if interval < weather - 1e-6:
        raise InputError(
            f"step: found records every {length_words(interval)} with weather every {length_words(weather)} "
            f"({file}), expected records at least as far apart: a step is no longer than their interval, and "
            f"between the values of the weather there is nothing to follow. Write 'auto {auto.tolerance:g}K "
            f"every {weather / 60.0:g}min', or state one length, such as 15min"
        )
    if interval > _LONGEST:
        raise InputError(
            f"step: found records every {length_words(interval)}, expected at most {_LONGEST / 3600.0:g} h: "
            f"a step may be as long as their interval. Write 'auto {auto.tolerance:g}K every 1h'"
        )
    return interval


def mesh_step(interval: float, auto: AutoStep | StepSequence | None) -> float:
    """Length of step for which layers are divided into cells. [s]

    Parameters
    ----------
    interval : float
        Step, or record interval. [s]
    auto : AutoStep, StepSequence or None
        Whether steps are chosen.
    """
    return interval if auto is None else min(interval, _MESH)


def weather_levels(interval: float) -> int:
    """How often a record interval is halved for the weather in which steps are chosen.

    Parameters
    ----------
    interval : float
        Record interval. [s]
    """
    return max(0, int(np.ceil(np.log2(interval / _WEATHER))))


def chosen_sequence(
    auto: AutoStep,
    interval: float,
    run: tuple[_engine.Plan, Array],
    forcings: Sequence[Array],
    settings: Mapping[str, Any],
    start: tuple[float, tzinfo],
    *,
    controlled: bool,
) -> StepSequence:
    """Choose the steps of a run.

    Parameters
    ----------
    auto : AutoStep
        Tolerance.
    interval : float
        Record interval. [s]
    run : tuple
        Plan of the engine and parameter vector.
    forcings : sequence of ndarray, shape (steps, stages, channels)
        Weather in steps of the record interval, of half of it, and so on.
    settings : mapping
        Those of a run with steps of the record interval.
    start : tuple of (float, tzinfo)
        Start in seconds since 1970-01-01 UTC [s], and zone, for messages.
    controlled : bool
        Whether the building has controls, which switch at the beginning of a step.

    Raises
    ------
    InputError
        The shortest steps do not meet the tolerance.
    SolverError
        A step or the repeated first period did not converge.
    """
    plan, vector = run
    most = max(len(forcings) - 1, int(np.ceil(np.log2(interval / _SHORTEST))))
    allowed = SHARE * auto.tolerance

    def dated(message: str) -> str:
        """Without the number of a step, which counts parts of different lengths."""
        return re.sub(r"step \d+", "a step while lengths were chosen", message, count=1)

    options = {**settings, "outputs": "[]", "record_from": 0, "record_every": 1}
    with translated(dated):
        halvings, errors = plan.choose_steps(vector, list(forcings), options, allowed, most)
    # Where a control switches within a step, no length is short enough: that is no error of the scheme.
    resolved = np.where((halvings == most) & controlled, 0.0, errors)
    judged = _after_start(halvings, resolved)
    sequence = StepSequence(halvings, interval, auto.tolerance, float(judged.max()))
    if sequence.error > allowed:
        worst = len(errors) - len(judged) + int(np.argmax(judged))
        when = local_time(start[0] + sequence.edges[worst], start[1])
        raise InputError(
            f"step: found a tolerance of {auto.tolerance:g} K, which steps of "
            f"{length_words(sequence.shortest)} do not meet from {when:%Y-%m-%d %H:%M:%S} "
            f"(estimated error of the step {sequence.error:.2g} K, expected {allowed:.2g} K at most). "
            f"Write 'auto {_rounded_up(sequence.error / SHARE):g}K', or state one length, such as 1min"
        )
    return sequence


def _after_start(halvings: Halvings, values: Array) -> Array:
    """Values of steps without those of the first record interval, where there are more.

    A start fits the weather only roughly: surfaces without mass jump, and no step is short enough for them.
    """
    ends = np.cumsum(np.exp2(-halvings.astype(np.float64)))
    return values[np.searchsorted(ends, 1.0) + 1 :] if ends[-1] > 1.0 else values


def require_equal_steps(sequence: StepSequence | None, what: str) -> None:
    """Refuse a run whose steps were chosen, where steps of one length are needed.

    Parameters
    ----------
    sequence : StepSequence or None
        Its steps.
    what : str
        For what, and why.

    Raises
    ------
    InputError
        The steps were chosen.
    """
    if sequence is not None:
        raise InputError(
            f"step: found 'auto' for {what}; expected steps of one length. State one, such as --step 15min"
        )


def _rounded_up(value: float) -> float:
    digit = 10.0 ** np.floor(np.log10(value))
    return float(f"{np.ceil(value / digit) * digit:.3g}")


def require_outputs(building: Building, outputs: Sequence[Output]) -> None:
    """Refuse outputs whose records steps of unequal length would make wrong.

    Parameters
    ----------
    building : Building
        The building.
    outputs : sequence of Output
        What is recorded.

    Raises
    ------
    InputError
        A derived output that depends on a mean over the interval.
    """
    means = {output.name: output.mean for output in building.outputs() if output.derived is None}
    derived = building.derived_outputs

    def uses_mean(name: str) -> bool:
        return any(
            means.get(word, False) or (word in derived and uses_mean(word)) for word in derived[name].used
        )

    for output in outputs:
        if output.derived is not None and uses_mean(output.name):
            raise InputError(
                f"step: found 'auto' with the derived output '{output.name}', which depends on a mean "
                "over the interval; expected outputs of instants alone, since its formula would see the last "
                "step of the interval only. Leave the output out, or state one length, such as 15min"
            )
