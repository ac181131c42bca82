"""A building in a climate over a period: compiled once, run as often as asked."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from mascarin import _engine
from mascarin.errors import InputError, SolverError, did_you_mean
from mascarin.simulation.results import EnergyLedger, Provenance, Results
from mascarin.weather.table import seconds_of
from mascarin.weather.timezones import moment

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.building import Building, EngineDescription, Output, Parameter
    from mascarin.building.initial_state import GivenStart, Profile
    from mascarin.simulation.initial import Initial, MeasuredStart
    from mascarin.weather import Climate, Measurements

    Array = npt.NDArray[np.float64]

Scheme = Literal["sdirk2", "backward-euler", "apparent-capacity"]
SCHEMES: Final[tuple[Scheme, ...]] = ("sdirk2", "backward-euler", "apparent-capacity")

#: Largest change of any temperature between two repetitions of the first period. [K]
SETTLED: Final = 0.01
#: Repetitions before the first period counts as unsettled.
MAX_CYCLES: Final = 1000
#: Readings that follow from two others.
#: What a run that can be gone back along may keep before it makes stretches anew. [B]
MEMORY: Final = 256 * 2**20
_DERIVED: Final = ("operative_temperature", "globe_temperature")


@dataclass(frozen=True)
class Failure:
    """A member of an ensemble that did not finish.

    Attributes
    ----------
    member : int
        Its row.
    reason : str
        What the engine said.
    """

    member: int
    reason: str


class Simulation:
    """A building compiled for a climate, a period and a step.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    step : str or float
        Time step, such as ``15min`` or seconds. [s]
    start, end : str, datetime or pandas.Timestamp, optional
        Period; local time of the climate unless an offset is given. Default: the whole climate.
    outputs : sequence of str, optional
        What to record. Default: air and face temperatures, interfaces and sensors.
    scheme : str
        ``sdirk2`` (default), ``backward-euler``, or ``apparent-capacity``: the paper's, which loses latent
        heat.
    initial : ``"repeat"``, float, mapping, GivenStart or MeasuredStart
        ``repeat``: the first period is repeated until nothing changes by more than 0.01 K. A number: that
        temperature everywhere at the start. A mapping, such as ``{"zones": {"room": 24.1}}``: temperatures
        of airs and surfaces, see `GivenStart`. A `MeasuredStart`: the first values of sensors. All but
        ``repeat`` are the same for all members of an ensemble, by the nominal resistances, and constant for
        derivatives. [degC]
    first_period : str or float
        Length of the period that is repeated. [s]
    measurements : Measurements, optional
        Where the measured columns are that the building names, unless the climate holds them.
    ranges : mapping of str to (float, float), optional
        Ranges that parameters will be varied in: the mesh is chosen for their worst end.

    Raises
    ------
    InputError
        Anything that cannot be used, before anything is run.
    """

    def __init__(
        self,
        building: Building,
        climate: Climate,
        *,
        step: str | float = "15min",
        start: object = None,
        end: object = None,
        outputs: Sequence[str] | None = None,
        scheme: Scheme = "sdirk2",
        initial: Initial = "repeat",
        first_period: str | float = "1d",
        measurements: Measurements | None = None,
        ranges: Mapping[str, tuple[float, float]] | None = None,
    ) -> None:
        if scheme not in SCHEMES:
            raise InputError(
                f"scheme: found '{scheme}', expected one of {', '.join(SCHEMES)}. "
                f"{did_you_mean(scheme, SCHEMES)}"
            )
        from mascarin.simulation.initial import read as start_asked_for

        self.building = building
        self.climate = climate
        self.scheme: Scheme = scheme
        self.step_seconds = seconds_of(step)
        self.start, self.end = _period(climate, start, end)
        self.outputs = _chosen(building, outputs)
        asked = start_asked_for(initial)
        self._first_period = seconds_of(first_period, "first_period")
        self._description: EngineDescription = building.to_engine(self.step_seconds, dict(ranges or {}))
        with _told_apart():
            self._plan = _engine.Plan(self._description.json)
        self._forcing = self._driven(measurements)
        _finite(self._forcing, self._description.channels, building)
        self.initial = self._started(asked)
        self._require_set_points_apart(self.values[None, :])

    def _started(self, asked: float | GivenStart | MeasuredStart | None) -> float | Profile | None:
        """Temperature or temperatures at the start; None to repeat the first period."""
        if asked is None or isinstance(asked, float):
            return asked
        from mascarin.building.initial_state import Ambient
        from mascarin.simulation.initial import resolved
        from mascarin.weather import CHANNELS

        # The weather of the first stage stands for that of the start.
        now = dict(zip((*CHANNELS, *self._description.channels), self._forcing[0, 0].tolist(), strict=True))
        ambient = Ambient(now["air_temperature"], now["day_of_year"], now)
        return resolved(asked, self.building, self._description.nodes, ambient, self.start)

    def _driven(self, measurements: Measurements | None) -> Array:
        """Climate, measured columns and schedules at every stage, shape (steps, stages, channels)."""
        from mascarin.weather import parse_timezone, scheduled

        building, names = self.building, self._description.schedules
        columns = self._description.channels[: len(self._description.channels) - len(names)]
        weather = self.climate.forcing(
            building.site,
            self.start,
            self.end,
            self.step_seconds,
            self.scheme,
            columns,
            measurements,
            limits=_boundary_limits(building),
        )
        if not names:
            return np.ascontiguousarray(weather, dtype=np.float64)
        profiles = scheduled(
            self.climate,
            {name: building.schedules[name] for name in names},
            parse_timezone(building.site.timezone),
            self.start,
            self.end,
            self.step_seconds,
            self.scheme,
            measurements,
        )
        return np.concatenate([weather, profiles], axis=-1)

    def _require_set_points_apart(self, vectors: Array) -> None:
        """Refuse heating above cooling, in any member and at any time.

        Raises
        ------
        InputError
            Naming the zone, the member, the time and both set points.
        """
        for name, zone in self.building.zones.items():
            if zone.heating is None or zone.cooling is None:
                continue
            heating, cooling = (self._set_point(name, which, vectors) for which in ("heating", "cooling"))
            bad = np.argwhere(heating > cooling + 1e-9)
            if not len(bad):
                continue
            member, step = (int(i) for i in bad[0])
            warm, cold = (
                float(np.broadcast_to(x, (len(vectors), len(self._forcing)))[member, step])
                for x in (heating, cooling)
            )
            raise InputError(
                f"zones.{name}: found heating to {warm:g} degC above cooling to {cold:g} degC at the end "
                f"of the step from {self.index[step]:%Y-%m-%d %H:%M}"
                f"{f' (member {member})' if len(vectors) > 1 else ''}; expected a heating set point at or "
                "below the cooling set point at all times: lower the one or raise the other"
            )

    def _set_point(self, zone: str, which: str, vectors: Array) -> Array:
        """Set points at the ends of the steps, shape (members, 1) or (1, steps). [degC]"""
        from mascarin.weather import CHANNELS

        plant = self.building.zones[zone].loads[which]
        if plant.setpoint.schedule is None:
            return vectors[:, [self._positions[f"zones.{zone}.{which}.setpoint.temperature"]]]
        place = len(CHANNELS) + self._description.channels.index(f"schedule {plant.setpoint.schedule}")
        return self._forcing[None, :, -1, place]

    @property
    def paths(self) -> list[str]:
        """Path of each parameter, in the order of a parameter vector."""
        return self._description.paths

    @property
    def values(self) -> Array:
        """Nominal value of each parameter, shape (P,). [unit of each]"""
        return self._description.values  # noqa: PD011 (ours, no pandas object)

    @property
    def notes(self) -> tuple[str, ...]:
        """Warnings about the mesh."""
        return self._description.notes

    @cached_property
    def index(self) -> pd.DatetimeIndex:
        """Times of the recorded states, shape (rows,): start, then the end of every step."""
        import pandas as pd

        count = len(self._forcing) + 1
        return pd.date_range(self.start, periods=count, freq=pd.Timedelta(seconds=self.step_seconds))

    @cached_property
    def identity(self) -> str:
        """Hash of everything a run depends on beside the parameter vector: building, forcing, options."""
        import hashlib

        digest = hashlib.sha256(self._description.json.encode())
        digest.update(self._forcing.tobytes())
        outputs = [output.name for output in self.outputs]
        digest.update(
            repr((self.scheme, self.step_seconds, self.initial, self._first_period, outputs)).encode()
        )
        return digest.hexdigest()

    def weather(self, channel: str) -> Array:
        """A climate channel at the recorded times, as the engine saw it, shape (rows,). [its unit]"""
        from mascarin.weather import CHANNELS

        values = self._forcing[:, :, CHANNELS.index(channel)]
        # The start has no stage of its own; the first one of the first step stands for it.
        return np.concatenate([values[:1, 0], values[:, -1]])

    def vector(self, values: Mapping[str, float]) -> Array:
        """The nominal parameter vector with some values replaced.

        Raises
        ------
        InputError
            Unknown path; the text names the nearest ones.
        """
        vector = self.values.copy()
        for path, value in values.items():
            vector[self.position(path)] = value
        return vector

    def position(self, path: str) -> int:
        """Where a path stands in a parameter vector.

        Raises
        ------
        InputError
            Unknown path, or a structural one, which needs another plan.
        """
        parameter = self.building.parameter(path)
        if parameter.path not in self._positions:
            raise InputError(
                f"{path}: is structural ({parameter.reason}); give it in the building, for example with "
                "replace()"
            )
        return self._positions[parameter.path]

    @cached_property
    def _positions(self) -> dict[str, int]:
        return {path: index for index, path in enumerate(self.paths)}

    def run(self, values: Array | None = None) -> Results:
        """Run once.

        Parameters
        ----------
        values : ndarray, shape (P,), optional
            Parameter vector; default the nominal one. [unit of each]

        Returns
        -------
        Results
            Labelled series and the energy ledger.

        Raises
        ------
        SolverError
            A step did not converge, or the first period did not settle.
        """
        from mascarin.building import unmelted

        probes, recipes = _probes([*self.outputs, *self._watched])
        vector: Array = np.array(self.values if values is None else values, dtype=np.float64)
        self._require_possible(vector[None, :])
        with _told_apart(self._in_time):
            raw = self._plan.simulate(vector, self._forcing, self._options(probes, 0, 1))
        records, seen = np.split(_derive(raw["records"], recipes), [len(self.outputs)], axis=1)
        return Results(
            outputs=self.outputs,
            index=self.index,
            records=np.ascontiguousarray(records),
            energy=EnergyLedger.read(raw),
            provenance=self._provenance(raw, vector),
            warnings=tuple(unmelted.warnings(self.building, seen)),
        )

    @cached_property
    def _watched(self) -> list[Output]:
        """What is recorded beside the outputs, to see whether what could melt did."""
        from mascarin.building import unmelted

        return unmelted.watched(self.building)

    def ensemble(
        self,
        samples: Array,
        *,
        record_from: int = 0,
        record_every: int = 1,
        report: Callable[[int], object] | None = None,
    ) -> tuple[Array, Array, list[Failure]]:
        """Run many parameter vectors, several at a time in lanes and threads.

        Parameters
        ----------
        samples : ndarray, shape (M, P)
            One parameter vector a row. [unit of each]
        record_from, record_every : int
            First recorded row and spacing of the recorded rows, in steps.
        report : callable, optional
            Called with the number of members done.

        Returns
        -------
        records : ndarray, shape (M, rows, outputs)
            NaN for a member that failed.
        closure : ndarray, shape (M,)
            Energy closure of each member. [-]
        failures : list of Failure
            Members that failed, and why.

        Raises
        ------
        InputError
            The samples do not have a column for each parameter.
        """
        probes, recipes = _probes(self.outputs)
        options = self._options(probes, record_from, record_every)
        members: Array = np.ascontiguousarray(samples, dtype=np.float64)
        self._require_possible(members)
        with _told_apart(self._in_time):
            raw, closure, failed = self._plan.ensemble(members, self._forcing, options, report)
        failures = [Failure(member, self._in_time(reason)) for member, reason in failed]
        return _derive(raw, recipes), closure, failures

    def jacobian(
        self,
        paths: Sequence[str],
        values: Array | None = None,
        *,
        record_from: int = 0,
        record_every: int = 1,
        report: Callable[[int], object] | None = None,
    ) -> tuple[Array, Array]:
        """Run once with the derivatives of every output by some parameters.

        The physics is run with numbers that carry their slopes: what comes back is the derivative of the
        discrete solution, the repeated first period included, not a difference quotient. At a switch (the end
        of a melting range, a wind that changes sides) it is the slope of the branch taken.

        Parameters
        ----------
        paths : sequence of str
            Parameters to derive by.
        values : ndarray, shape (P,), optional
            Parameter vector; default the nominal one. [unit of each]
        record_from, record_every : int
            First recorded row and spacing of the recorded rows, in steps.
        report : callable, optional
            Called with the number of parameters done.

        Returns
        -------
        records : ndarray, shape (rows, outputs)
            As of `run`.
        slopes : ndarray, shape (paths, rows, outputs)
            Derivative of each record by each parameter. [unit of the output / unit of the parameter]

        Raises
        ------
        InputError
            A path that is unknown or structural, or no path.
        SolverError
            A step did not converge, or the first period did not settle.
        """
        if not paths:
            raise InputError(
                "derivatives: no parameters; give at least one path, as `mascarin parameters` lists"
            )
        which = [self.position(path) for path in paths]
        probes, recipes = _probes(self.outputs)
        vector: Array = np.array(self.values if values is None else values, dtype=np.float64)
        self._require_possible(vector[None, :])
        options = self._options(probes, record_from, record_every)
        with _told_apart(self._in_time):
            raw, slopes = self._plan.jacobian(vector, which, self._forcing, options, report)
        return _derive(raw, recipes), _derive_slopes(raw, slopes, recipes)

    def trajectory(
        self,
        values: Array | None = None,
        *,
        record_from: int = 0,
        record_every: int = 1,
        memory: int = MEMORY,
    ) -> Trajectory:
        """Run once, keeping what is needed to go back along the run.

        Parameters
        ----------
        values : ndarray, shape (P,), optional
            Parameter vector; default the nominal one. [unit of each]
        record_from, record_every : int
            First recorded row and spacing of the recorded rows, in steps.
        memory : int
            About how much may be kept: beyond it stretches of the run are made once more on the way back. [B]

        Returns
        -------
        Trajectory
            Its records, and the derivatives of what is made of them by all parameters.

        Raises
        ------
        SolverError
            A step did not converge, or the first period did not settle.
        """
        probes, recipes = _probes(self.outputs)
        vector: Array = np.array(self.values if values is None else values, dtype=np.float64)
        self._require_possible(vector[None, :])
        options = self._options(probes, record_from, record_every)
        with _told_apart(self._in_time):
            run = _engine.Trajectory(self._plan, vector, self._forcing, options, memory)
        return Trajectory(run, run.run()["records"], recipes)

    def state_space(self) -> dict[str, Any]:
        """Matrices and names of a linear building; see `mascarin.simulation.linear_model`."""
        with _told_apart(self._in_time):
            return self._plan.state_space(self.values)

    def _require_possible(self, vectors: Array) -> None:
        """Refuse parameter vectors of the wrong length, or with a value that its parameter cannot have.

        Raises
        ------
        InputError
            Naming the parameter, the value and the limits.
        """
        if vectors.ndim != 2 or vectors.shape[1] != len(self.paths):
            raise InputError(
                f"samples: found an array of shape {vectors.shape}, expected (members, {len(self.paths)}): "
                "one value for each parameter"
            )
        lower, upper = self._limits
        # A value that is no number makes its own member fail and leaves the others.
        bad = np.argwhere((vectors < lower) | (vectors > upper))
        if bad.size:
            member, k = (int(i) for i in bad[0])
            parameter = self.building.parameter(self.paths[k])
            raise InputError(
                f"samples: {parameter.path} of member {member}: found {vectors[member, k]:g} "
                f"{parameter.unit}; expected a value from {parameter.lower:g} to {parameter.upper:g}"
            )
        self._require_set_points_apart(vectors)

    @cached_property
    def _limits(self) -> tuple[Array, Array]:
        """Hard limits of each parameter, shapes (P,). [unit of each]"""
        parameters = [self.building.parameter(path) for path in self.paths]
        return np.array([p.lower for p in parameters]), np.array([p.upper for p in parameters])

    def _in_time(self, reason: str) -> str:
        """An engine's message with the local time beside the number of the step."""

        def said(match: re.Match[str]) -> str:
            step = min(int(match[1]), len(self._forcing) - 1)
            return f"step {step} from {self.index[step]:%Y-%m-%d %H:%M:%S}"

        return re.sub(r"step (\d+)", said, reason, count=1)

    def _options(self, probes: str, record_from: int, record_every: int) -> dict[str, Any]:
        repeat = self.initial is None
        return {
            "dt": self.step_seconds,
            "scheme": self.scheme,
            "initial": self._temperatures,
            "warmup_steps": self._repeated_steps if repeat else 0,
            "warmup_tolerance": SETTLED,
            "warmup_max_cycles": MAX_CYCLES,
            "probes": probes,
            "record_from": record_from,
            "record_every": record_every,
        }

    @cached_property
    def _temperatures(self) -> float | dict[str, list[float]]:
        """Temperatures at the start, as the engine takes them."""
        if self.initial is None:
            # Where the repetition starts from matters only for its length.
            return float(self._forcing[:, -1, 0].mean())
        if isinstance(self.initial, float):
            return self.initial
        return {key: list(getattr(self.initial, key)) for key in ("cells", "faces", "air")}

    @property
    def _repeated_steps(self) -> int:
        """Steps of the first period, which is no longer than the run."""
        return min(max(round(self._first_period / self.step_seconds), 1), len(self._forcing))

    def _provenance(self, raw: Mapping[str, Any], vector: Array) -> Provenance:
        from mascarin.weather import summary

        changed = {
            path: float(value)
            for path, value, nominal in zip(self.paths, vector, self.values, strict=True)
            if value != nominal
        }
        return Provenance(
            building=self.building.name,
            building_hash=_hash(self._description.json),
            climate=summary(self.climate),
            step_seconds=self.step_seconds,
            scheme=self.scheme,
            start=self._start_note(raw),
            changed=changed,
            newton_iterations=int(raw["iterations"]),
            nested_stages=int(raw["nested"]),
            halved_steps=int(raw["halvings"]),
            reversals=int(raw["reversals"]),
        )

    def _start_note(self, raw: Mapping[str, Any]) -> str:
        if isinstance(self.initial, float):
            return f"{self.initial:g} degC everywhere"
        if self.initial is not None:
            return self.initial.words
        hours = self._repeated_steps * self.step_seconds / 3600.0
        return (
            f"first {hours:g} h repeated {raw['cycles']} times until nothing changed "
            f"by more than {SETTLED:g} K (last change {raw['settled']:.4f} K)"
        )


def simulate(
    building: Building,
    climate: Climate,
    *,
    step: str | float = "15min",
    start: object = None,
    end: object = None,
    outputs: Sequence[str] | None = None,
    scheme: Scheme = "sdirk2",
    initial: Initial = "repeat",
    first_period: str | float = "1d",
    measurements: Measurements | None = None,
) -> Results:
    """Run a building in a climate.

    Parameters
    ----------
    building, climate, step, start, end, outputs, scheme, initial, first_period, measurements
        As in `Simulation`.

    Returns
    -------
    Results
        Labelled series and the energy ledger.

    Raises
    ------
    InputError
        Anything that cannot be used, before the run.
    SolverError
        A step did not converge, or the first period did not settle.
    """
    return Simulation(
        building,
        climate,
        step=step,
        start=start,
        end=end,
        outputs=outputs,
        scheme=scheme,
        initial=initial,
        first_period=first_period,
        measurements=measurements,
    ).run()


def unreached(
    building: Building,
    climate: Climate,
    *,
    step: str | float = "15min",
    start: object = None,
    end: object = None,
    measurements: Measurements | None = None,
) -> dict[str, str]:
    """Find the numbers of a building that nothing in a run depends on.

    Each number that is not structural is moved a little, one at a time; it is reached when any output or
    the energy ledger changes by any bit.

    Parameters
    ----------
    building, climate, step, measurements
        As in `Simulation`.
    start, end : str, datetime or pandas.Timestamp, optional
        Period; by default the first three days of the climate, or all of a shorter one.

    Returns
    -------
    dict of str to str
        Path of each number that changed nothing, and why: what the description says of it, or that it did
        not act in this period.

    Raises
    ------
    InputError
        Anything that cannot be used.
    SolverError
        The building cannot be simulated as it is.
    """
    import pandas as pd

    begin, last = _period(climate, start, end)
    if end is None:
        last = min(last, begin + pd.Timedelta(days=3))
    outputs = [output.name for output in building.outputs()]
    trial = Simulation(
        building,
        climate,
        step=step,
        start=begin,
        end=last,
        outputs=outputs,
        initial=20.0,
        measurements=measurements,
    )
    samples = np.tile(trial.values, (len(trial.paths) + 1, 1))
    for position, path in enumerate(trial.paths):
        samples[position + 1, position] = _moved(building.parameter(path))
    records, closure, failures = trial.ensemble(samples)
    failed = {failure.member for failure in failures}
    if 0 in failed:
        raise SolverError(failures[0].reason)
    found = {}
    for member, path in enumerate(trial.paths, start=1):
        same = np.array_equal(records[member], records[0]) and closure[member] == closure[0]
        if same and member not in failed:
            found[path] = building.parameter(path).reason or "did not act in this period"
    return found


def _moved(parameter: Parameter) -> float:
    """A value a tenth of the way from the nominal one to an end of its range. [its unit]"""
    value, low, high = parameter.value, parameter.low, parameter.high
    if high > value:
        return value + 0.1 * (high - value)
    if low < value:
        return value - 0.1 * (value - low)
    nudge = 1e-3 * max(abs(value), 1.0)
    return value + nudge if value + nudge <= parameter.upper else value - nudge


@contextmanager
def _told_apart(in_time: Callable[[str], str] = str) -> Iterator[None]:
    """Engine errors as Mascarin's: what was given, or what could not be solved, and when."""
    try:
        yield
    except _engine.EngineInputError as error:
        raise InputError(str(error)) from None
    except _engine.EngineSolverError as error:
        raise SolverError(in_time(str(error))) from None


def _period(climate: Climate, start: object, end: object) -> tuple[pd.Timestamp, pd.Timestamp]:
    from mascarin.weather.table import stamps_of

    grid = climate.grid
    first, last = stamps_of(np.array([grid.start, grid.end]), grid.zone)
    begin = first if start is None else moment(start, grid.zone, "start")
    finish = last if end is None else moment(end, grid.zone, "end")
    if finish <= begin:
        raise InputError(f"period: found start {begin} and end {finish}, expected the end after the start")
    return begin, finish


def _chosen(building: Building, names: Sequence[str] | None) -> list[Output]:
    if names is not None:
        return [building.output(name) for name in names]
    usual = ("air_temperature", "face_temperature", "interface_temperature", "sensor", "liquid_fraction")
    return [output for output in building.outputs() if output.kind in usual]


def _boundary_limits(building: Building) -> dict[str, tuple[float, float]]:
    """What measured columns that drive a building can be at all, by what each is used for."""
    from mascarin.weather import IRRADIANCES, TEMPERATURES

    sides = [side for surface in building.surfaces.values() for side in surface.sides]
    temperatures = {side.measured: TEMPERATURES for side in sides if side.measured is not None}
    irradiances = {side.irradiance: IRRADIANCES for side in sides if side.irradiance is not None}
    return temperatures | irradiances


def _finite(forcing: Array, channels: Sequence[str], building: Building) -> None:
    """Channels that the engine reads must hold numbers; two may be absent."""
    from mascarin.weather import CHANNELS

    names = (*CHANNELS, *channels)
    absent = {"pressure"} | (set() if building.site.sky.kind == "measured" else {"infrared"})
    if building.site.sky.kind in ("offset", "measured"):
        absent.add("dew_point")
    bad = [bool(np.isnan(forcing[..., k]).any()) for k in range(len(names))]
    missing = [name for name, empty in zip(names, bad, strict=True) if empty and name not in absent]
    if missing:
        raise InputError(
            f"climate: no values for {', '.join(missing)}, which this building needs (sky model "
            f"'{building.site.sky.kind}'). Give the column, or choose another sky model, for example "
            "site.sky: {kind: offset}"
        )


def _probes(outputs: Sequence[Output]) -> tuple[str, list[tuple[str, tuple[int, ...]]]]:
    """What the engine records, and how each output follows from it: kind and columns."""
    probes: list[dict[str, Any]] = []

    def column(kind: str, place: Mapping[str, int]) -> int:
        probe = {"kind": kind, **place}
        if probe not in probes:
            probes.append(probe)
        return probes.index(probe)

    recipes: list[tuple[str, tuple[int, ...]]] = []
    for output in outputs:
        kinds = ("air_temperature", "mean_radiant_temperature") if output.kind in _DERIVED else (output.kind,)
        recipes.append((output.kind, tuple(column(kind, output.place) for kind in kinds)))
    return json.dumps(probes), recipes


def _derive(records: Array, recipes: Sequence[tuple[str, tuple[int, ...]]]) -> Array:
    """Outputs from records, along the last axis."""
    if all(kind not in _DERIVED for kind, _ in recipes) and [c for _, (c, *_) in recipes] == list(
        range(records.shape[-1])
    ):
        return records
    columns = [_reading(kind, [records[..., c] for c in places]) for kind, places in recipes]
    return np.stack(columns, axis=-1)


class Trajectory:
    """A run that can be gone back along; see `Simulation.trajectory`.

    Attributes
    ----------
    records : ndarray, shape (rows, outputs)
        Outputs of the run.
    """

    def __init__(
        self, run: _engine.Trajectory, raw: Array, recipes: Sequence[tuple[str, tuple[int, ...]]]
    ) -> None:
        self._run = run
        self._raw = raw
        self._recipes = recipes
        self.records = _derive(raw, recipes)

    def pull(self, weights: Array) -> Array:
        """Carry weights on the records back to the parameters.

        Parameters
        ----------
        weights : ndarray, shape (rows, outputs)
            Derivative of a quantity by each record.

        Returns
        -------
        ndarray, shape (P,)
            Derivative of the quantity by each parameter, in the order of `Simulation.paths`.
        """
        raw = np.zeros_like(self._raw)
        for k, (kind, places) in enumerate(self._recipes):
            parts = [self._raw[:, c] for c in places]
            for i, c in enumerate(places):
                raw[:, c] += weights[:, k] * _by_part(kind, parts, i)
        return self._run.pull(np.ascontiguousarray(raw))


def _derive_slopes(records: Array, slopes: Array, recipes: Sequence[tuple[str, tuple[int, ...]]]) -> Array:
    """Slopes of outputs from slopes of records, along the last axis, by the chain rule."""
    columns = []
    for kind, places in recipes:
        parts = [records[..., c] for c in places]
        terms = (_by_part(kind, parts, k) * slopes[..., c] for k, c in enumerate(places))
        columns.append(sum(terms, np.zeros(slopes.shape[:-1])))
    return np.stack(columns, axis=-1)


def _by_part(kind: str, parts: Sequence[Array], k: int) -> Array | float:
    """Derivative of an output by one of the readings that it is made of. [-]"""
    if kind not in _DERIVED:
        return 1.0
    # Small, for a globe's film bends sharply where globe and air are equally warm.
    nudge = 1e-6
    up, down = ([p + sign * nudge * (j == k) for j, p in enumerate(parts)] for sign in (1.0, -1.0))
    return (_reading(kind, up) - _reading(kind, down)) / (2.0 * nudge)


def _reading(kind: str, parts: Sequence[Array]) -> Array:
    if kind == "operative_temperature":
        return 0.5 * (parts[0] + parts[1])
    if kind == "globe_temperature":
        return globe_temperature(parts[0], parts[1])
    return parts[0]


def globe_temperature(air: Array, radiant: Array, diameter: float = 0.15, emissivity: float = 0.95) -> Array:
    """Temperature of a black globe in still air.

    Balances radiation with natural convection, ``1.4 (|dT|/D)^0.25`` (ISO 7726:1998, annex B).

    Parameters
    ----------
    air, radiant : ndarray
        Air and mean radiant temperature. [degC]
    diameter : float
        Diameter of the globe. [m]
    emissivity : float
        Long-wave emissivity of the globe. [-]

    Returns
    -------
    ndarray
        Globe temperature. [degC]
    """
    sigma, kelvin = 5.670374419e-8, 273.15
    globe = 0.5 * (air + radiant)
    for _ in range(20):
        convection = 1.4 * (np.maximum(np.abs(globe - air), 1e-3) / diameter) ** 0.25
        mean = 0.5 * (globe + radiant) + kelvin
        radiation = 4.0 * emissivity * sigma * mean**3
        globe = 0.5 * globe + 0.5 * (convection * air + radiation * radiant) / (convection + radiation)
    return np.asarray(globe)


def _hash(text: str) -> str:
    import hashlib

    return hashlib.sha256(text.encode()).hexdigest()
