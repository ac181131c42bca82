"""The command that simulates a building with a weather file."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from mascarin._io.locks import writing
from mascarin.commands.options.exit_code import exit_code
from mascarin.commands.options.inputs import (
    AsJson,
    CheckSun,
    Columns,
    Compared,
    MeasuredTable,
    Outside,
    RunStep,
    Settings,
    Shift,
    Stamps,
    Weather,
    Zone,
    matching_outputs,
    read_building,
    seconds,
    step_of,
)
from mascarin.commands.options.output import print_json, print_table
from mascarin.commands.options.places import lines_named
from mascarin.commands.options.tables import compared_columns, period_of, print_comparison, run_inputs
from mascarin.commands.view import require_html
from mascarin.errors import InputError
from mascarin.simulation.preparation.step_sequence import mesh_step
from mascarin.simulation.records.provenance import words_of

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.progress import Report
    from mascarin.simulation.results import Results
    from mascarin.simulation.run_summary import Finished
    from mascarin.simulation.simulation import Simulation
    from mascarin.validation.comparison import Metrics
    from mascarin.weather import Climate, Measurements

#: Shadows that take longer are announced [s].
LONG = 2.0


def run(
    building: Path,
    /,
    *,
    weather: Weather,
    measurements: MeasuredTable = None,
    columns: Columns = None,
    timezone: Zone = None,
    stamps: Stamps = "start",
    out: Annotated[Path | None, Parameter(alias="-o")] = None,
    report: Path | None = None,
    start: str | None = None,
    end: str | None = None,
    step: RunStep = "15min",
    interval: str | None = None,
    outputs: Annotated[list[str] | None, Parameter(name="--output", negative="")] = None,
    scheme: Literal["sdirk2", "linearly-implicit", "backward-euler", "apparent-capacity"] = "sdirk2",
    initial: float | None = None,
    settings: Settings = None,
    allow_outside: Outside = False,
    check_sun: CheckSun = True,
    shift: Shift = None,
    compared: Compared = None,
    steady: Annotated[bool, Parameter(negative="")] = False,
    as_json: AsJson = False,
) -> int:
    """Simulate a building with a weather file.

    Writes the time series to a file, or prints minimum, mean and maximum of each and the energy balance.
    Ends with exit code 1 where a balance does not close or a temperature has no cause.

    Parameters
    ----------
    building : Path
        Description of a building.
    out : Path
        File for the time series: NetCDF (.nc), CSV (.csv, in local time, with units and provenance in a file
        beside it) or Parquet (.parquet, in local time). NetCDF and CSV are written while the run goes on,
        unless --interval, --report or --json need all records. Without it a summary is printed.
    report : Path
        File for a page about the run (.html): inputs, curves, loads, energy balance, warnings.
    start : str
        Start of the period, such as 2012-09-20 or "2012-09-20 12:00", local time. Default: the start
        of the weather file.
    end : str
        End of the period. Default: the last whole step of the weather file.
    interval : str
        Time between the written values, such as 1h; independent of the time step. Default: the time step.
    outputs : list of str
        Output to record, such as room.air_temperature or "roof.*"; can be given several times. Default: the
        temperatures of air, surfaces, interfaces and sensors.
    scheme : str
        Time-stepping scheme.
    initial : float
        Temperature of the whole building at the start [degC]. Default: the first day is repeated until it is
        periodic, which takes long in heavy buildings.
    steady : bool
        Print the steady state in the weather at --start, which then does not change, and its heat flows [W].
    """
    # Long because each option of the command is a line.
    from mascarin.simulation.records.files import require_ending
    from mascarin.validation.first_comparison import first_comparison

    described = read_building(building, settings)
    if out is not None:
        require_ending(out, "--out")
    require_html("--report", report)
    with writing(out), writing(report), lines_named(building):
        climate, measured = run_inputs(
            described, weather, measurements, columns=columns or [], timezone=timezone, stamps=stamps,
            allow_outside=allow_outside, check_sun=check_sun, shift=shift,
        )  # fmt: skip
        source = (measurements or weather, described, timezone, stamps, shift)
        if steady:
            _require_alone(
                out=out, report=report, end=end, interval=interval, initial=initial, compare=compared,
                scheme=None if scheme == "sdirk2" else scheme,
            )  # fmt: skip
            return _steady(
                described, climate, measured, moment=start, step=step, outputs=outputs, as_json=as_json
            )
        sensors, readings = compared_columns(compared, *source)
        start, end = period_of(climate, readings, start, end)
        simulation = _compiled(
            described, climate, measurements=measured, step=step, start=start, end=end, outputs=outputs,
            scheme=scheme, initial=_start(initial), more=report is not None,
        )  # fmt: skip
        if out is not None and report is None and interval is None and not (as_json or sensors):
            return exit_code(sound=_stored(simulation, out).sound)
        results = _simulated(simulation)
        if report is not None:
            _write_report(report, simulation, results, {"Building": building, "Weather": weather})
            results = _only(results, matching_outputs(described, outputs))
        metrics = {} if readings is None else first_comparison(results, readings, sensors)
        if interval is not None:
            results = results.every(interval)
        if out is not None:
            _write(results, out)
    if as_json:
        print_json(_summary(results) | _plain(metrics))
    else:
        _print_all(results, metrics, sensors, summary=out is None)
    return exit_code(sound=results.sound)


def _require_alone(**options: object) -> None:
    """Refuse options of a course in time beside --steady.

    Raises
    ------
    InputError
        The first of them.
    """
    for name, value in options.items():
        if value is not None:
            raise InputError(
                f"--{name}: found it beside --steady, expected one of them: a steady state has no course in "
                "time. '--json' writes it for other programs"
            )


def _steady(
    building: Building,
    climate: Climate,
    measured: Measurements | None,
    *,
    moment: str | None,
    step: str,
    outputs: Sequence[str] | None,
    as_json: bool,
) -> int:
    """Print the steady state."""
    from mascarin.simulation.steady import steady

    state = steady(
        building, climate, moment=moment, step=seconds(step), measurements=measured,
        outputs=matching_outputs(building, outputs),
    )  # fmt: skip
    _print_warnings(building, seconds(step), state.warnings)
    if as_json:
        print_json(state.to_dict())
        return 0
    rows = [(name, state.units[name], round(value, 3)) for name, value in state.values.items()]
    print_table(("output", "unit", f"steady, {state.moment}"), rows)
    print()
    print_table(("heat flow", "unit", "into the building"), [
        (flow, "W", round(watts, 3)) for flow, watts in state.flows.items() if watts != 0.0
    ])  # fmt: skip
    print(f"sum of the flows {state.imbalance:.1e} of their magnitudes")
    return 0


def _plain(metrics: Mapping[str, Metrics]) -> dict[str, Any]:
    """Metrics of a comparison for JSON; nothing where there is none."""
    return {"comparison": {name: asdict(each) for name, each in metrics.items()}} if metrics else {}


def _print_all(
    results: Results, metrics: Mapping[str, Metrics], sensors: Mapping[str, str], *, summary: bool
) -> None:
    """The summary, where no file was written, and lines of a comparison."""
    if summary:
        _print(results)
    print_comparison(metrics, sensors)


def _start(temperature: float | None) -> float | Literal["repeat"]:
    """The start as a simulation takes it.

    Raises
    ------
    InputError
        The temperature is not possible; the text is about the option, not about the forms of Python.
    """
    from mascarin.simulation.preparation.initial_state import LIMITS

    if temperature is None:
        return "repeat"
    if not LIMITS[0] <= temperature <= LIMITS[1]:
        raise InputError(
            f"--initial: found {temperature:g}, expected one temperature between {LIMITS[0]:g} and "
            f"{LIMITS[1]:g} degC: such as --initial 20, or leave the option out"
        )
    return temperature


def _compiled(
    building: Building,
    climate: Climate,
    *,
    step: str,
    outputs: Sequence[str] | None,
    more: bool = False,
    **options: Any,
) -> Simulation:
    """Compile a run, with warnings about the building on standard error; `more`: record what a page shows."""
    from mascarin.simulation.preparation.prepare import chosen_outputs
    from mascarin.simulation.simulation import Simulation

    names = matching_outputs(building, outputs)
    if more:
        from mascarin.pages.run.page import needed

        chosen = [output.name for output in chosen_outputs(building, names)]
        names = list(dict.fromkeys([*chosen, *needed(building)]))
    simulation = Simulation(building, climate, step=step_of(step), outputs=names, **options)
    _print_warnings(
        building, mesh_step(simulation.step_seconds, simulation.sequence), simulation.building_warnings
    )
    _print_steps(simulation)
    _print_cost(building, simulation)
    return simulation


def _simulated(simulation: Simulation) -> Results:
    """Run once, with warnings about results, and progress of a long run, on standard error."""
    with _progress() as progress:
        results = simulation.run(progress=progress)
    _print_lines(_new(results.warnings, simulation))
    return results


def _stored(simulation: Simulation, out: Path) -> Finished:
    """Run once, and write the series while the run goes on; messages as `_simulated`."""
    with _progress() as progress:
        summary = simulation.run_into(out, progress=progress).finished
    _print_lines(_new(summary.warnings, simulation))
    print(f"wrote {out}", file=sys.stderr)
    return summary


def _new(warnings: Sequence[str], simulation: Simulation) -> list[str]:
    """Warnings without those about the building, which were printed before the run."""
    return [line for line in warnings if line not in simulation.building_warnings]


def _print_lines(warnings: Sequence[str]) -> None:
    for line in warnings:
        print(f"warning: {line}", file=sys.stderr)


def _write_report(file: Path, simulation: Simulation, results: Results, inputs: Mapping[str, Path]) -> None:
    from mascarin.building import check
    from mascarin.building.rooms import lived_in, rooms
    from mascarin.pages.run.page import Notes, write

    start = "warning: "
    lines = check(simulation.building, mesh_step(simulation.step_seconds, simulation.sequence))
    notes = Notes(
        outdoors=simulation.weather("air_temperature"),
        warnings=[line.removeprefix(start) for line in lines if line.startswith(start)],
        inputs=[(name, str(path)) for name, path in inputs.items()],
        rooms=lived_in(simulation.building),
        other_zones="cavities"
        if lived_in(simulation.building) == rooms(simulation.building)
        else "zones without windows, gains and loads",
    )
    write(file, results, notes)
    print(f"wrote {file}", file=sys.stderr)


def _only(results: Results, names: Sequence[str] | None) -> Results:
    """The results with these outputs alone, or with the usual ones."""
    from dataclasses import replace

    rows_kept = [
        k
        for k, output in enumerate(results.outputs)
        if (output.usual if names is None else output.name in names)
    ]
    outputs = [results.outputs[k] for k in rows_kept]
    return replace(results, outputs=outputs, records=results.records[:, rows_kept])


@contextlib.contextmanager
def _progress() -> Iterator[Report]:
    """Progress of the steps, with the time that remains; before them, that the first period is repeated."""
    from mascarin.progress import Progress

    with contextlib.ExitStack() as shown:
        before = shown.enter_context(Progress("run"))
        during: Progress | None = None

        def report(done: int, total: int) -> None:
            nonlocal during
            if done == 0:
                before.update(0, 0, "the first period is repeated until it is periodic")
                return
            if during is None:
                before.close()
                # Of its own, so that the time of the repetitions does not count for the steps.
                during = shown.enter_context(Progress("run"))
            during.update(done, total)

        yield report


def _print_warnings(building: Building, step: float, more: Sequence[str]) -> None:
    """Print warnings about the building, and how many values were assumed."""
    from mascarin.building import check

    lines = check(building, step)
    warnings = [line for line in lines if line.startswith("warning: ")]
    warnings += [f"warning: {line}" for line in more]
    for line in dict.fromkeys(warnings):
        print(line, file=sys.stderr)
    assumed = sum(number.assumed for number in building.parameters())
    if assumed:
        values = "one assumed value" if assumed == 1 else f"{assumed} assumed values"
        print(f"{values}: 'mascarin check' lists {'it' if assumed == 1 else 'them'}", file=sys.stderr)


def _print_steps(simulation: Simulation) -> None:
    """Say which steps were chosen, and what steps of one length would take."""
    if simulation.sequence is not None:
        print(f"steps: {words_of(simulation.sequence.to_dict())}", file=sys.stderr)


def _print_cost(building: Building, simulation: Simulation) -> None:
    """Say how long shadows take, where it is long."""
    from mascarin.building.parts.self_shading import expected_seconds, obstructions, pairs_with_shades

    steps, stages, _ = simulation.compiled.forcing_blocks.shape
    shades = pairs_with_shades(building)
    expected = expected_seconds(obstructions(building), steps * stages, shades=shades)
    if expected > LONG:
        advice = "describe fewer 'shades', such as one for many slats, or " if any(shades) else ""
        print(
            f"shading: about {expected:.0f} s for the shadows; {advice}turn off those of surfaces with "
            "'site: {self_shading: false}'",
            file=sys.stderr,
        )


def _write(results: Results, out: Path) -> None:
    results.write(out)
    print(f"wrote {out}", file=sys.stderr)


def _summary(results: Results) -> dict[str, Any]:
    records = results.records
    return {
        "outputs": {
            output.name: {
                "unit": output.unit,
                "min": float(records[:, k].min()),
                "mean": float(records[:, k].mean()),
                "max": float(records[:, k].max()),
            }
            for k, output in enumerate(results.outputs)
        },
        "energy": results.energy.to_dict(),
        **results.provenance.to_dict(),
        "warnings": list(results.warnings),
    }


def _print(results: Results) -> None:
    rows = [
        (name, row["unit"], round(row["min"], 3), round(row["mean"], 3), round(row["max"], 3))
        for name, row in _summary(results)["outputs"].items()
    ]
    print_table(("output", "unit", "min", "mean", "max"), rows)
    notes = results.provenance
    print(f"\nstart: {notes.start}")
    for output, at_start in zip(results.outputs, results.records[0], strict=True):
        if output.kind == "liquid_fraction":
            print(f"{output.name} at the start: {at_start:.3f}")
    print(results.energy)
    if notes.reversals:
        print(f"{notes.reversals} changes between melting and freezing within one time step (hysteresis)")
    if notes.halved_steps:
        print(
            f"{notes.halved_steps} time steps were halved: they did not converge, or carried the air of a "
            "zone beyond what acts on it"
        )
