"""A building in a climate over a period: compiled once, run as often as needed."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mascarin._io.arguments import names_of
from mascarin._io.durations import auto_step, seconds_of
from mascarin.progress import reporting
from mascarin.simulation import run_warnings
from mascarin.simulation.checks import step_check
from mascarin.simulation.checks.energy import EnergyLedger
from mascarin.simulation.checks.judgement import Judgement
from mascarin.simulation.checks.vapour import VapourLedger
from mascarin.simulation.preparation import step_sequence
from mascarin.simulation.preparation.engine_run import MEMORY, CompiledRun
from mascarin.simulation.preparation.measured_planes import warnings_of_planes
from mascarin.simulation.preparation.options import RunOptions, described
from mascarin.simulation.preparation.parameter_vectors import VectorRuns
from mascarin.simulation.preparation.slopes import gradient_of, labelled_slopes
from mascarin.simulation.preparation.weather_inputs import warnings_of_sun
from mascarin.simulation.records import files
from mascarin.simulation.records.blocks import InMemory, Watch
from mascarin.simulation.records.provenance import Provenance
from mascarin.simulation.records.recorded_outputs import Readings
from mascarin.simulation.records.times import Times
from mascarin.simulation.results import Results
from mascarin.simulation.run_summary import Finished, StoredRun, start_note
from mascarin.tables.timezones import zone_name
from mascarin.weather import CHANNELS, summary, summary_of_measurements

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray as xr

    from mascarin.building import Building
    from mascarin.progress import ProgressOption, Report
    from mascarin.simulation.checks.warning_kinds import RunWarning
    from mascarin.simulation.preparation.initial import Initial
    from mascarin.simulation.preparation.objectives import Gradient, Objective
    from mascarin.simulation.preparation.options import Scheme, TimeLike
    from mascarin.weather import Climate, Measurements

    Array = npt.NDArray[np.float64]


class Simulation(VectorRuns):
    """A building compiled for a climate, a period and a step.

    Use it where the same building is run several times: `run`, `jacobian` and `gradient` take values of
    parameters by path. For a single run `simulate` is enough.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    <run options>
    ranges : mapping of str to (float, float), optional
        Ranges in which parameters will vary: the mesh is fine enough for all of them. [unit of each]

    Attributes
    ----------
    building : Building
        The building, with `parameters` replaced.
    climate : Climate
        Its weather.
    measured : dict or None
        What the measured table is: file, hash, period, columns.
    start, end : pandas.Timestamp
        The period, in local time of the climate.
    step_seconds : float
        Time step; record interval, where steps are chosen. [s]
    sequence : StepSequence or None
        Steps that were chosen.
    scheme : str
        Time-stepping scheme.
    outputs : list of Output
        What is recorded.
    compiled : CompiledRun
        What the engine gets.
    notes : tuple of str
        Warnings about the mesh.

    Raises
    ------
    InputError
        Something that cannot be used, before anything is run.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> simulation = mc.Simulation(box(), box_climate(), step="1h", outputs=["room.air_temperature"])
    >>> dark = simulation.run({"surfaces.facade.outside.absorptance": 0.9})
    >>> bool(dark["room.air_temperature"].max() > simulation.run()["room.air_temperature"].max())
    True
    """

    def __init__(
        self,
        building: Building,
        climate: Climate,
        *,
        parameters: Mapping[str, float] | None = None,
        outputs: Sequence[str] | None = None,
        start: TimeLike | None = None,
        end: TimeLike | None = None,
        step: str | float = "15min",
        scheme: Scheme = "sdirk2",
        initial: Initial = "repeat",
        first_period: str | float = "1d",
        measurements: Measurements | None = None,
        ranges: Mapping[str, tuple[float, float]] | None = None,
    ) -> None:
        from mascarin.simulation.preparation import (
            prepare,
        )  # pydantic, which an evaluation for GenOpt does without

        options = RunOptions(
            parameters=parameters, outputs=outputs, start=start, end=end, step=step, scheme=scheme,
            initial=initial, first_period=first_period, measurements=measurements,
        )  # fmt: skip
        self.building = prepare.in_climate(
            building, climate, measurements=measurements, parameters=options.parameters, varied=ranges or ()
        )
        self.climate, self._of_planes = climate, warnings_of_planes(self.building, climate, measurements)
        self.measured = None if measurements is None else summary_of_measurements(measurements)
        self.scheme: Scheme = scheme
        auto = auto_step(step)
        self.step_seconds = step_sequence.record_interval(auto, step, climate, scheme)
        first, last = prepare.span(climate, start, end, self.step_seconds)
        self.times = Times(first, last, self.step_seconds, climate.grid.zone)
        self.outputs = prepare.chosen_outputs(self.building, outputs)
        self._replaced = prepare.changed_parameters(building, self.building, options.parameters)
        stated_start = prepare.read_initial(initial)
        self._first_period = seconds_of(first_period, "first_period")
        mesh = step_sequence.mesh_step(self.step_seconds, auto)
        description = self.building.to_engine(mesh, dict(ranges or {}))
        self.notes = description.notes
        forcing, inputs, self.sequence = prepare.chosen_forcing_of(
            auto, self.building, climate, description, times=self.times, scheme=scheme,
            measurements=measurements, start=stated_start, first_period=self._first_period,
            outputs=self.outputs,
        )  # fmt: skip
        self.channels = tuple(description.channels)
        self.initial = prepare.start_of(stated_start, self.building, description, forcing, self.times.start)
        self.compiled = CompiledRun(
            description=description.json, forcing_blocks=forcing,
            paths=tuple(description.paths), values=description.values,
            settings=prepare.settings_of(
                self.initial, forcing, step_seconds=self.step_seconds, scheme=scheme,
                first_period=self._first_period, sequence=self.sequence,
            ),
            readings=Readings.of(self.outputs), inputs=inputs,
            start=first, timezone=zone_name(climate.grid.zone),
        )  # fmt: skip
        _ = self.compiled.plan  # the engine's own checks
        self._require_possible(self.values[None, :])

    def __repr__(self) -> str:
        return (
            f"<Simulation of '{self.building.name}', {self.start:%Y-%m-%d %H:%M} to "
            f"{self.end:%Y-%m-%d %H:%M}, step {self.step_seconds:g} s, {len(self.outputs)} outputs>"
        )

    # --- values by path -----------------------------------------------------------------------------------

    def run(
        self, parameters: Mapping[str, float] | None = None, *, progress: ProgressOption = None
    ) -> Results:
        """Run once.

        Parameters
        ----------
        parameters : mapping of str to float, optional
            Values by path that replace those of the building. [unit of each]
        progress : bool or callable, optional
            As in `Simulation`; units are steps. A function is called with 0 steps while a first period is
            repeated.

        Returns
        -------
        Results
            Series by name and the energy balance.

        Raises
        ------
        InputError
            An unknown or structural path, or a value that its parameter cannot have.
        SolverError
            A step or the repeated first period did not converge.

        Examples
        --------
        >>> import mascarin as mc
        >>> from mascarin.examples import box, box_climate
        >>> mc.Simulation(box(), box_climate(), step="1h").run({"zones.room.volume": 30.0}).provenance.changed
        {'zones.room.volume': 30.0}
        """
        with reporting(progress, "run") as report:
            steps = self.compiled.steps
            report(0, steps)
            results = self.run_vector(self.vector(parameters or {}), progress=report)
            report(steps, steps)
        return results

    def jacobian(
        self,
        vary: Sequence[str],
        parameters: Mapping[str, float] | None = None,
        *,
        progress: ProgressOption = None,
    ) -> xr.Dataset:
        """Series and their derivatives by some parameters; see `mascarin.jacobian`.

        Parameters
        ----------
        vary : sequence of str
            Paths of the parameters to derive by.
        parameters : mapping of str to float, optional
            Values by path that replace those of the building: where to derive. [unit of each]
        progress : bool or callable, optional
            As in `Simulation`; units are parameters.

        Returns
        -------
        xarray.Dataset
            Each output over (time), and ``d <output>`` over (parameter, time). The attribute ``warnings``
            has those of a run with these values.

        Raises
        ------
        InputError
            A path that is unknown or structural, or no path.
        SolverError
            A step or the repeated first period did not converge.
        """
        paths = [self.building.parameter(path).path for path in names_of("vary", vary)]
        with reporting(progress, "parameters") as report:
            report(0, len(paths))
            records, slopes = self.jacobian_vector(paths, self.vector(parameters or {}), progress=report)
            report(len(paths), len(paths))
        units = [self.building.parameter(path).unit for path in paths]
        named = dict(zip(paths, units, strict=True))
        said = self.warnings_at(self.vector(parameters or {}))
        return labelled_slopes(self.outputs, self.index, named, records, slopes).assign_attrs(
            warnings=list(map(str, said))
        )

    def gradient(
        self,
        objective: Objective,
        parameters: Mapping[str, float] | None = None,
        *,
        memory: int = MEMORY,
        progress: ProgressOption = None,
    ) -> Gradient:
        """A quantity and its derivatives by all parameters; see `mascarin.gradient`.

        Parameters
        ----------
        objective : callable
            From the series by output to a value and its derivatives by each.
        parameters : mapping of str to float, optional
            Values by path that replace those of the building: where to derive. [unit of each]
        memory : int
            About how much of the run may be kept: beyond it parts are calculated again. [B]
        progress : bool or callable, optional
            As in `Simulation`; units are the run and the way back.

        Returns
        -------
        Gradient
            The value and its derivatives.

        Raises
        ------
        InputError
            Unknown path, a value that the parameter cannot have, an objective that does not fit the outputs.
        SolverError
            A step or the repeated first period did not converge.
        """
        with reporting(progress, "gradient") as report:
            report(0, 2)
            vector = self.vector(parameters or {})
            trajectory = self.trajectory(vector, memory=memory)
            report(1, 2)
            free_parameters = [self.building.parameter(path) for path in self.paths]
            derivatives = gradient_of(
                objective, trajectory, [output.name for output in self.outputs], free_parameters
            )
            report(2, 2)
        return replace(derivatives, warnings=self.warnings_at(vector))

    def run_vector(self, vector: Array, *, progress: Report | None = None) -> Results:
        """Run once with a parameter vector; as `run`.

        Parameters
        ----------
        vector : ndarray, shape (P,)
            Parameter vector. [unit of each]
        progress : callable, optional
            Called with the number of steps done and their total.
        """
        memory = InMemory(self.times.rows, len(self.outputs))
        summary = self._run_through(vector, memory.take, progress, keeps_rows=True)
        return Results(
            outputs=self.outputs,
            times=self.times,
            records=memory.records,
            energy=summary.energy,
            provenance=summary.provenance,
            warnings=summary.warnings,
            vapour=summary.vapour,
            judgement=summary.judgement,
        )

    def run_into(
        self,
        path: str | Path,
        parameters: Mapping[str, float] | None = None,
        *,
        progress: ProgressOption = None,
    ) -> StoredRun:
        """Run once, and write the series to a file while the run goes on.

        Series are not held in memory, nor is the weather of all steps of a run that is longer than a year at
        15 min: each block of steps is worked out when the run comes to it, with the same bits. It is where
        steps are chosen (``step="auto"``), the building corrects its weather (``weather``), the table states
        the position of the sun, or a first period has over 8192 steps. The file appears when it is complete.

        Parameters
        ----------
        path : str or Path
            NetCDF (.nc) or CSV (.csv), as `Results.write` writes them. The records of a Parquet file
            (.parquet) are kept in memory until the run has finished.
        parameters : mapping of str to float, optional
            Values by path that replace those of the building. [unit of each]
        progress : bool or callable, optional
            As in `run`.

        Returns
        -------
        StoredRun
            The energy balance, provenance and warnings; `Results.open` reads the series.

        Raises
        ------
        InputError
            Another ending, pyarrow is not installed; an unknown or structural path, or a value that its
            parameter cannot have.
        SolverError
            A step or the repeated first period did not converge.
        OSError
            The file cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import mascarin as mc
        >>> from mascarin.examples import box, box_climate
        >>> file = Path(tempfile.mkdtemp()) / "run.nc"
        >>> simulation = mc.Simulation(box(), box_climate(), step="1h")
        >>> simulation.run_into(file).finished.energy.closes
        True
        >>> mc.Results.open(file) == simulation.run()
        True
        """
        target = Path(path)
        files.require_ending(target, str(target))
        with (
            reporting(progress, "run") as report,
            files.drafted(target, self.outputs, self.times, target.suffix.lower()) as draft,
        ):
            steps = self.compiled.steps
            report(0, steps)
            summary = self._run_through(self.vector(parameters or {}), draft.take, report)
            draft.finish(summary.attributes(self.outputs, self.times.timezone))
            report(steps, steps)
        return StoredRun(target, self.outputs, self.times, summary)

    def _run_through(
        self,
        vector: Array,
        take: Callable[[Array], object],
        progress: Report | None,
        *,
        keeps_rows: bool = False,
    ) -> Finished:
        """Run once, and hand the records over in blocks of rows."""
        vector = np.array(vector, dtype=np.float64)
        self._require_possible(vector[None, :])
        watch, count = Watch(self.building, self.outputs, self.scheme, self.sequence), len(self.outputs)

        def seen(rows: Array) -> None:
            watch.add(rows)
            take(rows[:, :count])

        raw = self.compiled.run_into(vector, seen, self.recorded, keeps_rows=keeps_rows, progress=progress)
        energy, judgement = EnergyLedger.read(raw), Judgement.read(raw, self.compiled.dated)
        vapour = None if self.building.humidity is None else VapourLedger.read(raw["vapour"])
        judged = run_warnings.of_engine(judgement, raw, self.compiled.dated, self.step_seconds, self.scheme)
        step, about, settings = self.step_seconds, self.building_warnings, self.compiled.settings
        repeated = self.compiled.begin_of(settings["warmup_steps"])
        return Finished(
            energy=energy,
            provenance=Provenance(
                building=self.building.name,
                building_hash=self.compiled.hash,
                climate=summary(self.climate),
                measurements=self.measured,
                step_seconds=self.step_seconds,
                steps=None if self.sequence is None else self.sequence.to_dict(),
                scheme=self.scheme,
                start=start_note(self.initial, settings, repeated, self.compiled.steps, raw),
                changed={**self._replaced, **self._changed(vector)},
                newton_iterations=int(raw["iterations"]),
                nested_stages=int(raw["nested"]),
                halved_steps=int(raw["halvings"]),
                reversals=int(raw["reversals"]),
            ),
            warnings=run_warnings.collected(
                energy, vapour, watch, step_seconds=step, building=about, judged=judged
            ),
            vapour=vapour,
            judgement=judgement,
        )

    @cached_property
    def recorded(self) -> Readings:
        """What a run records: the outputs asked for, and layers and airs that are watched."""
        from mascarin.simulation.checks import unmelted  # pydantic, as above

        airs = step_check.watched(self.building, self.outputs)
        return Readings.of([*self.outputs, *unmelted.watched(self.building), *airs])

    @cached_property
    def building_warnings(self) -> tuple[str, ...]:
        """Warnings that every run has: areas, volumes, materials and mesh of the building, irradiance."""
        from mascarin.building.checks import plausibility  # pydantic, as above

        sun = warnings_of_sun(self.climate, self.compiled.inputs, self.building.site)
        sun = (*sun, *self._of_planes)
        return (*sun, *self.climate.record.warnings, *plausibility.warnings(self.building, self.notes))

    def warnings_at(self, vector: Array) -> tuple[RunWarning, ...]:
        """Warnings of a run with a parameter vector, of which nothing else is kept.

        Parameters
        ----------
        vector : ndarray, shape (P,)
            Parameter vector. [unit of each]

        Raises
        ------
        SolverError
            A step or the repeated first period did not converge.
        """
        return self._run_through(vector, lambda _rows: None, None).warnings

    @cached_property
    def identity(self) -> str:
        """Hash of all that a run depends on beside the parameter vector: building, forcing, options."""
        digest = hashlib.sha256(self.compiled.description.encode())
        digest.update(self.compiled.forcing.tobytes())
        outputs = [output.name for output in self.outputs]
        digest.update(
            repr((self.scheme, self.step_seconds, self.initial, self._first_period, outputs)).encode()
        )
        return digest.hexdigest()

    def weather(self, channel: str) -> Array:
        """A climate channel at the recorded times, as the engine reads it, shape (rows,). [its unit]

        Parameters
        ----------
        channel : str
            Such as ``air_temperature``; see `mascarin.weather.CHANNELS`.
        """
        values = self.compiled.forcing[:, :, CHANNELS.index(channel)]
        # The start has no stage: the first one of the first step is used.
        return np.concatenate([values[:1, 0], values[self.compiled.record_ends, -1]])

    def _changed(self, vector: Array) -> dict[str, float]:
        """Parameters of a vector that differ from those of the building."""
        where = np.flatnonzero(vector != self.values)
        return {self.compiled.paths[k]: float(vector[k]) for k in where}


described(Simulation)
