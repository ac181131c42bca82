"""A run as plain arrays: all that the engine needs, without the description, the weather or pandas."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin import _engine
from mascarin._io import memory
from mascarin.engine_errors import plan_of, translated
from mascarin.errors import SolverError
from mascarin.simulation.preparation.options import require_precision
from mascarin.simulation.preparation.run_results import EnsembleRun, Failure, Trajectory
from mascarin.simulation.records.blocks import InMemory, rows_of
from mascarin.simulation.records.recorded_outputs import Readings
from mascarin.tables.forcing_blocks import STEPS, ForcingBlocks
from mascarin.tables.timezones import parse_timezone

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.progress import Report
    from mascarin.simulation.preparation.options import Precision
    from mascarin.simulation.preparation.weather_inputs import WeatherInputs

    Array = npt.NDArray[np.float64]

#: Memory that a run with derivatives in reverse may keep before it calculates parts again. [B]
MEMORY: Final = 256 * 2**20

#: Change between two repetitions of the first period where two runs are compared for a derivative. [K]
_REPEATED_WITHIN: Final = 1e-7


@dataclass(frozen=True, eq=False)
class CompiledRun:
    """A building in a climate, compiled for the engine: text and arrays that can be pickled or saved.

    Methods take parameter vectors; `Simulation` takes values by path.

    Parameters
    ----------
    description : str
        The building as the engine reads it, JSON.
    forcing_blocks : ForcingBlocks
        Weather, measured boundaries and schedules of all steps. [unit of each channel]
    paths : tuple of str, length P
        Path of each parameter.
    values : ndarray, shape (P,)
        Parameter vector of the building. [unit of each]
    settings : dict
        Step [s], scheme, start and repeated period, as the engine reads them.
    readings : Readings
        What is recorded, and how the outputs follow from it.
    start : float
        Start, in seconds since 1970-01-01 UTC. [s]
    timezone : str
        Time zone of the climate, for messages.
    inputs : WeatherInputs or None
        Parameters that act by the forcing: gain, offset and clock of the weather.

    Examples
    --------
    >>> import pickle
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> simulation = mc.Simulation(box(), box_climate(), step="1h", outputs=["room.air_temperature"])
    >>> compiled = pickle.loads(pickle.dumps(simulation.compiled))
    >>> records, _ = compiled.run(compiled.values)
    >>> bool((records == simulation.run().records).all())
    True
    """

    description: str
    forcing_blocks: ForcingBlocks
    paths: tuple[str, ...]
    values: Array
    settings: Mapping[str, Any]
    readings: Readings
    start: float
    timezone: str
    inputs: WeatherInputs | None = None

    @cached_property
    def plan(self) -> _engine.Plan:
        """The engine's form of the description; made when it is first used, also after unpickling."""
        return plan_of(self.description)

    def __getstate__(self) -> dict[str, Any]:
        return {key: value for key, value in self.__dict__.items() if key not in ("plan", "edges")}

    @property
    def forcing(self) -> Array:
        """The forcing of all steps, shape (steps, stages, channels); it stays in memory."""
        return self.forcing_blocks.all_steps

    @cached_property
    def edges(self) -> Array:
        """Ends of the steps, from the start, shape (steps + 1,). [s]"""
        halvings = np.array(self.settings.get("halvings", np.zeros(self.steps)), dtype=np.float64)
        return np.concatenate([[0.0], np.cumsum(self.settings["dt"] * np.exp2(-halvings))])

    @property
    def steps(self) -> int:
        """Number of steps."""
        return len(self.forcing_blocks)

    def begin_of(self, step: int) -> float:
        """Start of a step, by its number from 0, since the start of the run. [s]"""
        return float(self.edges[step] if "halvings" in self.settings else self.settings["dt"] * step)

    @property
    def record_ends(self) -> npt.NDArray[np.int64]:
        """The last step of each record interval."""
        ends = self.settings["dt"] * np.arange(1, self.intervals + 1)
        # In the middle between steps, so that rounding does not matter.
        return np.asarray(np.searchsorted(self.edges[1:] + 1e-9 * self.settings["dt"], ends), dtype=np.int64)

    @property
    def intervals(self) -> int:
        """Record intervals: steps, where these are of one length."""
        return round(self.begin_of(self.steps) / float(self.settings["dt"]))

    @cached_property
    def hash(self) -> str:
        """SHA-256 of the description."""
        return hashlib.sha256(self.description.encode()).hexdigest()

    def forcing_at(self, vector: Array) -> Array:
        """The forcing for a parameter vector, whose gains, offsets and clocks of the weather may differ."""
        return self.forcing if self.inputs is None else self.inputs.forcing(vector, self.forcing)

    def options(
        self, readings: Readings | None = None, record_from: int = 0, record_every: int = 1
    ) -> dict[str, Any]:
        """Options of a run as the engine reads them.

        Parameters
        ----------
        readings : Readings, optional
            Outputs other than those of the compiled run.
        record_from, record_every : int
            First recorded row and spacing of the recorded rows, in steps, or record intervals.
        """
        return {
            **self.settings,
            "outputs": (readings or self.readings).outputs,
            "record_from": record_from,
            "record_every": record_every,
        }

    def run(
        self, vector: Array, readings: Readings | None = None, *, progress: Report | None = None
    ) -> tuple[Array, dict[str, Any]]:
        """Run once.

        Parameters
        ----------
        vector : ndarray, shape (P,)
            Parameter vector. [unit of each]
        readings : Readings, optional
            Outputs other than those of the compiled run.
        progress : callable, optional
            Called with the number of steps done and their total; with 0 while a first period is repeated.

        Returns
        -------
        records : ndarray, shape (rows, outputs)
            Outputs. [unit of each]
        raw : dict
            Energy ledger [J] and counters of the solver.

        Raises
        ------
        SolverError
            A step or the repeated first period did not converge.
        """
        recorded = readings or self.readings
        memory = InMemory(self._rows(0, 1), len(recorded.columns))
        raw = self.run_into(vector, memory.take, recorded, keeps_rows=True, progress=progress)
        return memory.records, raw

    def run_into(
        self,
        vector: Array,
        take: Callable[[Array], object],
        readings: Readings | None = None,
        *,
        keeps_rows: bool = False,
        progress: Report | None = None,
    ) -> dict[str, Any]:
        """Run once, and hand the outputs over in blocks of rows while the run goes on.

        Parameters
        ----------
        vector : ndarray, shape (P,)
            Parameter vector. [unit of each]
        take : callable
            Called with the next rows, shape (n, outputs); what it raises ends the run.
        readings : Readings, optional
            Outputs other than those of the compiled run.
        keeps_rows : bool
            Whether the rows stay in memory: blocks are smaller then.
        progress : callable, optional
            Called with the number of steps done and their total; with 0 while a first period is repeated.

        Returns
        -------
        dict
            Energy ledger [J] and counters of the solver.

        Raises
        ------
        SolverError
            A step or the repeated first period did not converge.
        """
        recorded, blocks = readings or self.readings, self._blocks(vector, keeps_steps=keeps_rows)
        with translated(self.dated):
            if progress is not None:
                progress(0, self.steps)  # the time left counts from here
            rows_at_once = rows_of(len(recorded.columns), keeps_rows=keeps_rows)
            raw: dict[str, Any] = self.plan.simulate_into(
                vector, next(blocks), self.options(recorded), rows_at_once,
                lambda rows: take(recorded.values(rows)), _of_total(progress, self.steps), self.steps,
                lambda: next(blocks, None),
            )  # fmt: skip
        return raw

    def _blocks(self, vector: Array, *, keeps_steps: bool) -> Iterator[Array]:
        """The forcing for a parameter vector in blocks of steps, the first with the repeated first period."""
        if self.inputs is not None or self.settings["warmup_steps"] > STEPS:
            return iter([self.forcing_at(vector)])
        return self.forcing_blocks.blocks(keeps_steps=keeps_steps)

    def ensemble(
        self,
        vectors: Array,
        *,
        record_from: int = 0,
        record_every: int = 1,
        precision: Precision = "double",
        progress: Report | None = None,
    ) -> EnsembleRun:
        """Run many parameter vectors, several at a time in lanes and threads.

        Parameters
        ----------
        vectors : ndarray, shape (M, P)
            One parameter vector a row. [unit of each]
        record_from, record_every : int
            First recorded row and spacing of the recorded rows, in steps, or record intervals.
        precision : str
            ``double`` or ``single``; in single precision, members whose energy balance does not close within
            1e-4 are run again in double precision.
        progress : callable, optional
            Called with the number of members done and their total.

        Returns
        -------
        EnsembleRun
            Records, energy-balance residuals, failures, and how far temperatures are outside of their causes.

        Raises
        ------
        InputError
            A precision that does not exist, or does not go with the scheme.
        """
        require_precision(precision, str(self.settings["scheme"]))
        options = self.options(None, record_from, record_every)
        rows = self._rows(record_from, record_every)
        # Weather, sun and shadows of each stage are kept for all members.
        stages = float(np.prod(self.forcing_blocks.shape[:2])) * self.plan.stage_bytes
        self._require_room(len(vectors), rows, f"{len(vectors)} members", "run fewer at a time", stages)
        if self.inputs is not None and (vectors[:, self.inputs.positions] != self.inputs.base).any():
            return self._by_weather(self.inputs, vectors, record_from, record_every, precision, progress)
        with translated(self.dated):
            raw, (residuals, outside, beyond), failed = self.plan.ensemble(
                vectors, self.forcing, options, _of_total(progress, len(vectors)), precision == "single"
            )
        failures = [Failure(member, self.dated(reason)) for member, reason in failed]
        return EnsembleRun(self.readings.values(raw), residuals, failures, outside, beyond)

    def _by_weather(
        self,
        inputs: WeatherInputs,
        vectors: Array,
        record_from: int,
        record_every: int,
        precision: Precision,
        progress: Report | None,
    ) -> EnsembleRun:
        """The same for members with different weather: those with the same weather at a time."""
        count, done = len(vectors), 0
        records = np.empty((count, self._rows(record_from, record_every), len(self.readings.columns)))
        judged = np.empty((3, count))
        failures: list[Failure] = []
        for rows, vector in inputs.groups(vectors):
            alone = replace(self, forcing_blocks=ForcingBlocks.of(self.forcing_at(vector)), inputs=None)
            part = alone.ensemble(
                np.ascontiguousarray(vectors[rows]),
                record_from=record_from, record_every=record_every, precision=precision,
            )  # fmt: skip
            records[rows] = part.records
            judged[:, rows] = part.residuals, part.outside, part.beyond
            failures += [replace(failure, member=int(rows[failure.member])) for failure in part.failures]
            done += len(rows)
            if progress is not None:
                progress(done, count)
        residuals, outside, beyond = judged
        return EnsembleRun(records, residuals, sorted(failures, key=lambda f: f.member), outside, beyond)

    def jacobian(
        self,
        directions: Sequence[Sequence[tuple[int, float]]],
        vector: Array,
        *,
        record_from: int = 0,
        record_every: int = 1,
        progress: Report | None = None,
    ) -> tuple[Array, Array]:
        """Run once with the derivatives of every output by some parameters, in forward mode.

        Parameters
        ----------
        directions : sequence of sequence of (int, float)
            For each derivative the positions of the parameters in the vector that change together, and how
            much each changes.
        vector : ndarray, shape (P,)
            Parameter vector. [unit of each]
        record_from, record_every : int
            First recorded row and spacing of the recorded rows, in steps, or record intervals.
        progress : callable, optional
            Called with the number of parameters done and their total.

        Returns
        -------
        records : ndarray, shape (rows, outputs)
            Outputs. [unit of each]
        slopes : ndarray, shape (directions, rows, outputs)
            Derivatives. [unit of the output / unit of the parameter]

        Raises
        ------
        SolverError
            A step or the repeated first period did not converge.
        """
        options = self.options(None, record_from, record_every)
        report = _of_total(progress, len(directions))
        rows, lanes = self._rows(record_from, record_every), len(directions) + 1
        self._require_room(lanes, rows, f"derivatives by {len(directions)} parameters", "take fewer")
        ways, inputs = [list(direction) for direction in directions], self.inputs
        by_weather = [] if inputs is None else [k for k, way in enumerate(ways) if inputs.moves(way)]
        by_engine = [k for k in range(len(ways)) if k not in by_weather]
        if inputs is not None and not by_engine:
            first = self.ensemble(vector[None], record_from=record_from, record_every=record_every)
            records, slopes = first.records[0], np.empty((0, *first.records.shape[1:]))
        else:
            exact = [ways[k] for k in by_engine]
            with translated(self.dated):
                raw, derived = self.plan.jacobian(vector, exact, self.forcing_at(vector), options, report)
            records, slopes = self.readings.values(raw), self.readings.values(derived)
        if inputs is None or not by_weather:
            return records, slopes
        both = np.empty((len(ways), *records.shape))
        both[by_engine] = slopes
        for k in by_weather:
            both[k] = self._difference(inputs, ways[k], vector, record_from, record_every)
        return records, both

    def _difference(
        self,
        inputs: WeatherInputs,
        direction: list[tuple[int, float]],
        vector: Array,
        record_from: int,
        record_every: int,
    ) -> Array:
        """Derivative by a direction in which the weather changes, from two runs, shape (rows, outputs)."""
        half = inputs.difference(direction)
        pair = np.tile(vector, (2, 1))
        for position, weight in direction:
            pair[:, position] += np.array([1.0, -1.0]) * half * weight
        # Repetitions of the first period that end a little early would be most of such a small difference.
        exact = replace(self, settings={**self.settings, "warmup_tolerance": _REPEATED_WITHIN})
        ends = exact.ensemble(pair, record_from=record_from, record_every=record_every)
        if ends.failures:
            raise SolverError(ends.failures[0].reason)
        return np.asarray((ends.records[0] - ends.records[1]) / (2.0 * half))

    def trajectory(
        self, vector: Array, *, record_from: int = 0, record_every: int = 1, memory: int = MEMORY
    ) -> Trajectory:
        """Run once and keep what the derivatives in reverse mode need.

        Parameters
        ----------
        vector : ndarray, shape (P,)
            Parameter vector. [unit of each]
        record_from, record_every : int
            First recorded row and spacing of the recorded rows, in steps, or record intervals.
        memory : int
            About how much may be kept: beyond it parts of the run are calculated again. [B]

        Returns
        -------
        Trajectory
            Its records, and the derivatives of quantities made of them by all parameters.

        Raises
        ------
        SolverError
            A step or the repeated first period did not converge.
        """
        options = self.options(None, record_from, record_every)
        with translated(self.dated):
            run = _engine.Trajectory(self.plan, vector, self.forcing_at(vector), options, memory)
        further: dict[int, Callable[[], Array]] = {}
        if self.inputs is not None:
            inputs = self.inputs
            further = {
                position: partial(
                    self._difference, inputs, [(position, 1.0)], vector, record_from, record_every
                )
                for position in inputs.positions.tolist()
            }
        return Trajectory(run, run.run()["records"], self.readings, further)

    def _rows(self, record_from: int, record_every: int) -> int:
        return max(self.intervals - record_from, 0) // max(record_every, 1) + 1

    def _require_room(self, times: int, rows: int, what: str, advice: str, more: float = 0.0) -> None:
        """Refuse results that memory does not hold, with `more` bytes; the engine would end the process."""
        columns = len(self.readings.columns)
        # As the engine records them, and as outputs.
        memory.require(
            2.0 * 8.0 * times * rows * columns + more,
            f"{what}, {rows} records and {columns} outputs",
            f"{advice}, record fewer outputs, or take a longer step or a shorter period",
        )

    def dated(self, message: str) -> str:
        """Add the local time to a message of the engine that names a step."""

        def stamped(match: re.Match[str]) -> str:
            step = min(int(match[1]), self.steps - 1)
            begin = datetime.fromtimestamp(0, UTC) + timedelta(seconds=self.start + self.begin_of(step))
            local = begin.astimezone(parse_timezone(self.timezone))
            return f"step {step} from {local:%Y-%m-%d %H:%M:%S}"

        return re.sub(r"step (\d+)", stamped, message, count=1)

    def header(self) -> dict[str, Any]:
        """All but the arrays, as plain values for JSON."""
        return {
            "description": self.description,
            "paths": list(self.paths),
            "settings": dict(self.settings),
            "outputs": self.readings.outputs,
            "columns": list(self.readings.columns),
            "start": self.start,
            "timezone": self.timezone,
        }

    @classmethod
    def read(cls, header: Mapping[str, Any], forcing: Array, values: Array) -> CompiledRun:
        """Make a compiled run again from its `header` and arrays.

        Parameters
        ----------
        header : mapping
            What `header` returned.
        forcing : ndarray, shape (steps, stages, channels)
            Weather, measured boundaries and schedules. [unit of each channel]
        values : ndarray, shape (P,)
            Parameter vector of the building. [unit of each]
        """
        return cls(
            description=header["description"],
            forcing_blocks=ForcingBlocks.of(forcing),
            paths=tuple(header["paths"]),
            values=values,
            settings=header["settings"],
            readings=Readings(header["outputs"], tuple(header["columns"])),
            start=header["start"],
            timezone=header["timezone"],
        )


def _of_total(progress: Report | None, total: int) -> Callable[[int], object] | None:
    """The engine's form of a progress callback: with the number done alone."""
    if progress is None:
        return None
    return lambda done: progress(done, total)
