"""Checks of parameter vectors: limits, set points that do not cross, times of controls within the run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.building.parts.materials.material import PhaseChangeMaterial
from mascarin.errors import InputError
from mascarin.tables.times import local_time
from mascarin.weather.records.channels import CHANNELS

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building, Parameter
    from mascarin.simulation.records.times import Times
    from mascarin.tables.forcing_blocks import ForcingBlocks

    Array = npt.NDArray[np.float64]


#: Comparisons made at once: members times steps would not fit into memory.
_AT_ONCE: Final = 2**22


class ParameterLimits:
    """Limits of parameters, in the order of a parameter vector.

    Parameters
    ----------
    parameters : sequence of Parameter, length P
        The parameters.
    """

    def __init__(self, parameters: Sequence[Parameter]) -> None:
        self._parameters = list(parameters)
        self._lower = np.array([p.lower for p in parameters])
        self._upper = np.array([p.upper for p in parameters])

    def require(self, vectors: Array) -> None:
        """Refuse vectors of the wrong length, or with a value outside its limits.

        Parameters
        ----------
        vectors : ndarray, shape (M, P)
            Parameter vectors. [unit of each]

        Raises
        ------
        InputError
            Naming the parameter, the member, the value and the limits.
        """
        if vectors.ndim != 2 or vectors.shape[1] != len(self._parameters):
            raise InputError(
                f"samples: found an array of shape {vectors.shape}, expected (members, "
                f"{len(self._parameters)}): one value for each parameter"
            )
        # A value that is no number makes only its own member fail.
        bad = np.argwhere((vectors < self._lower) | (vectors > self._upper))
        if bad.size:
            member, k = (int(i) for i in bad[0])
            parameter = self._parameters[k]
            whose = f" (member {member})" if len(vectors) > 1 else ""
            raise InputError(
                f"{parameter.path}: found {vectors[member, k]:g} {parameter.unit}{whose}; "
                f"expected {parameter.allowed}"
            )


def require_scheme(building: Building, scheme: str) -> None:
    """Refuse a scheme of time stepping that cannot follow a law of melting with a state.

    Parameters
    ----------
    building : Building
        The building.
    scheme : str
        Name of the scheme.

    Raises
    ------
    InputError
        Naming the material.
    """
    for name, material in building.materials.items():
        law = material.one_curve if isinstance(material, PhaseChangeMaterial) else None
        if law is not None and scheme in law.excluded_schemes:
            raise InputError(
                f"scheme: found '{scheme}' with {law.model} in materials.{name}.hysteresis, expected "
                "'sdirk2', 'linearly-implicit' or 'backward-euler': heat that is set free at a rate is no "
                "function of temperature, so that no capacity contains it"
            )


def require_set_points_apart(
    building: Building,
    vectors: Array,
    forcing: ForcingBlocks,
    *,
    positions: Mapping[str, int],
    channels: Sequence[str],
    times: Times,
    begin_of: Callable[[int], float],
) -> None:
    """Refuse heating above cooling, and humidifying by a schedule or a column above drying.

    Parameters
    ----------
    building : Building
        The building.
    vectors : ndarray, shape (M, P)
        Parameter vectors. [unit of each]
    forcing : ForcingBlocks
        What acts on the building, schedules included. [unit of each]
    positions : mapping of str to int
        Position of each parameter in a vector.
    channels : sequence of str
        Channels of the forcing after those of the climate.
    times : Times
        Times of the records.
    begin_of : callable
        Start of a step, from the start of the run. [s]

    Raises
    ------
    InputError
        Naming the zone, the member, the time and both set points.
    """

    def set_point(path: str, course: str | None) -> Array:
        """Set points at the ends of the steps, shape (members, 1) or (1, steps). [degC] or [-]"""
        if course is None:
            return vectors[:, [positions[path]]]
        channel = len(CHANNELS) + list(channels).index(f"schedule {course}")
        return forcing.ends(channel)[None, :]

    for pair in set_point_pairs(building):
        (low, high) = (set_point(path, course) for path, course in pair.points)
        crossing = _first_above(low, high + 1e-9)
        if crossing is None:
            continue
        member, step = crossing
        shape = (len(vectors), len(forcing))
        when = local_time(times.first + begin_of(step), times.zone)
        first, second = (float(np.broadcast_to(x, shape)[member, step]) for x in (low, high))
        raise InputError(
            f"{pair.where}: found {pair.low} to {first:g}{pair.unit} above {pair.high} to "
            f"{second:g}{pair.unit} at the end of the step from {when:%Y-%m-%d %H:%M}"
            f"{f' (member {member})' if len(vectors) > 1 else ''}; expected a set point of {pair.low} at or "
            f"below that of {pair.high} at all times: lower the one or raise the other"
        )


@dataclass(frozen=True)
class SetPointPair:
    """Two set points that must not cross.

    Attributes
    ----------
    where : str
        The zone.
    low, high : str
        What they are set points of.
    unit : str
        Their unit, after a space.
    points : pair of (str, str or None)
        Of each the path of the number, and the name of the course that takes its place.
    """

    where: str
    low: str
    high: str
    unit: str
    points: tuple[tuple[str, str | None], tuple[str, str | None]]


def set_point_pairs(building: Building) -> Iterator[SetPointPair]:
    """The set points of a building that must not cross.

    Parameters
    ----------
    building : Building
        The building.
    """
    for name, zone in building.zones.items():
        if zone.heating is not None and zone.cooling is not None:
            prefix = f"zones.{name}"
            yield SetPointPair(
                prefix, "heating", "cooling", " degC",
                (
                    (f"{prefix}.heating.setpoint.temperature", zone.heating.setpoint.course),
                    (f"{prefix}.cooling.setpoint.temperature", zone.cooling.setpoint.course),
                ),
            )  # fmt: skip
    for name, vapour in building.humidity.zones.items() if building.humidity is not None else ():
        wet, dry = vapour.plants.get("humidifying"), vapour.plants.get("drying")
        if wet is None or dry is None or wet.setpoint[0] != dry.setpoint[0]:
            continue
        key, low, high = wet.setpoint[0], wet.setpoint[1].course, dry.setpoint[1].course
        # Ranges of two constant ones may overlap: drying decides there.
        if low is not None or high is not None:
            prefix = f"humidity.zones.{name}"
            yield SetPointPair(
                prefix, "humidifying", "drying", "" if key == "relative_humidity" else " kg/kg",
                ((f"{prefix}.humidifying.{key}.constant", low), (f"{prefix}.drying.{key}.constant", high)),
            )  # fmt: skip


def require_control_times(
    building: Building, vectors: Array, *, positions: Mapping[str, int], seconds: float
) -> None:
    """Refuse controls of openings whose minimum times are longer than the run.

    Parameters
    ----------
    building : Building
        The building.
    vectors : ndarray, shape (M, P)
        Parameter vectors. [unit of each]
    positions : mapping of str to int
        Position of each parameter in a vector.
    seconds : float
        Length of the run. [s]

    Raises
    ------
    InputError
        Naming the control, the member and both times.
    """
    for name in building.controls:
        for key in ("minimum_open_time", "minimum_closed_time"):
            path = f"controls.{name}.{key}"
            if path not in positions:
                continue
            minutes = vectors[:, positions[path]]
            too_long = np.flatnonzero(60.0 * minutes > seconds)
            if len(too_long):
                member = int(too_long[0])
                whose = f" (member {member})" if len(vectors) > 1 else ""
                raise InputError(
                    f"{path}: found {minutes[member]:g} min{whose}, longer than the run of "
                    f"{seconds / 60.0:g} min; expected a time within the run. Shorten it (in min), or "
                    "simulate a longer period"
                )


def _first_above(high: Array, low: Array) -> tuple[int, int] | None:
    """First place where `high` is above `low`; the two are broadcast, a part of the rows at a time."""
    rows, columns = np.broadcast_shapes(high.shape, low.shape)
    part = max(_AT_ONCE // columns, 1)
    for first in range(0, rows, part):
        above, below = (
            values if len(values) == 1 else values[first : first + part] for values in (high, low)
        )
        bad = np.argwhere(above > below)
        if len(bad):
            return first + int(bad[0][0]), int(bad[0][1])
    return None
