"""The command that writes a building as a unit for co-simulation."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from mascarin._io.locks import writing
from mascarin.commands.options.exit_code import exit_code
from mascarin.commands.options.inputs import (
    CheckSun,
    Outside,
    Settings,
    Shift,
    Step,
    matching_outputs,
    read_building,
    seconds,
)
from mascarin.commands.options.places import lines_named
from mascarin.commands.options.tables import run_inputs
from mascarin.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mascarin.simulation.simulation import Simulation


def fmu(
    building: Path,
    /,
    *,
    weather: Path,
    out: Annotated[Path, Parameter(alias="-o")],
    inputs: Annotated[list[str] | None, Parameter(name="--input", negative="")] = None,
    outputs: Annotated[list[str] | None, Parameter(name="--output", negative="")] = None,
    parameters: Annotated[list[str] | None, Parameter(name="--parameter", negative="")] = None,
    measurements: Path | None = None,
    columns: Annotated[list[str] | None, Parameter(name="--column", negative="")] = None,
    timezone: str | None = None,
    stamps: Literal["start", "end"] = "start",
    start: str | None = None,
    end: str | None = None,
    step: Step = "15min",
    scheme: Literal["sdirk2", "linearly-implicit", "backward-euler", "apparent-capacity"] = "sdirk2",
    settings: Settings = None,
    allow_outside: Outside = False,
    check_sun: CheckSun = True,
    shift: Shift = None,
    fmi: Literal["3.0", "2.0"] = "3.0",
) -> int:
    """Write a building as a unit for co-simulation (FMU).

    The unit contains the engine and the weather, and needs no Python. Programs such as Modelica tools and
    FMPy run it step by step and exchange values with it. Without inputs its outputs are those of
    'mascarin run', to the bit. Its first 30 days are run once for the warnings of a run. Ends with
    exit code 1 where that run is not sound.

    Parameters
    ----------
    building : Path
        Description of a building.
    weather : Path
        Weather: an EPW file, TMY3 as CSV, a measured table (CSV with --column, or Parquet), or a YAML file
        with the keys climate and measurements of a study, such as the study itself.
    out : Path
        File for the unit, such as cell.fmu.
    inputs : list of str
        What the importing program sets, such as schedules.heating, columns.heater or "weather.*"; can be
        given several times. Default: nothing; all comes from weather, schedules and tables.
    outputs : list of str
        Output of the unit, such as room.air_temperature or "roof.*"; can be given several times. Default: the
        temperatures of air, surfaces, interfaces and sensors.
    parameters : list of str
        Parameter that can be set before a run, such as zones.room.volume or "materials.*"; can be given
        several times. Default: all parameters that do not change the mesh.
    measurements : Path
        Table with the measured columns that the building names. Default: the table of --weather.
    columns : list of str
        Column of a measured table for --weather, as CHANNEL=COLUMN or CHANNEL=COLUMN [UNIT], such as
        "air_temperature=T_out" or "wind_speed=wind [km/h]"; CHANNEL=none for what was not measured. Can be
        given several times.
    timezone : str
        Time zone of measured tables. Default: that of the site.
    stamps : str
        Which end of its interval a stamp of a measured table marks.
    start : str
        Start of the period, such as 2012-09-20 or "2012-09-20 12:00", local time: time 0 of the unit.
        Default: the start of the weather file.
    end : str
        End of the period. Default: the end of the weather file.
    scheme : str
        Time-stepping scheme.
    fmi : str
        Version of the Functional Mock-up Interface.
    """
    from mascarin.fmu import export
    from mascarin.simulation.nominal import of_short_run
    from mascarin.simulation.simulation import Simulation

    described = read_building(building, settings)
    if out.suffix.lower() != ".fmu":
        raise InputError(f"--out: found '{out}'; expected a file ending in .fmu")
    with writing(out), lines_named(building):
        climate, measured = run_inputs(
            described,
            weather,
            measurements,
            columns=columns or [],
            timezone=timezone,
            stamps=stamps,
            allow_outside=allow_outside,
            check_sun=check_sun,
            shift=shift,
        )
        simulation = Simulation(
            described, climate, measurements=measured, step=seconds(step), start=start, end=end,
            scheme=scheme, outputs=matching_outputs(described, outputs),
        )  # fmt: skip
        lines = of_short_run(simulation)
        for line in lines:
            print(f"warning: {line}", file=sys.stderr)
        export(simulation, out, inputs=inputs or (), parameters=parameters, version=fmi)
    if inputs:
        print(_start_values(simulation, inputs), file=sys.stderr)
    size = out.stat().st_size / 2**20
    print(f"wrote {out}: {size:.1f} MB, internal step {simulation.step_seconds:g} s", file=sys.stderr)
    return exit_code(warnings=lines)


def _start_values(simulation: Simulation, inputs: Sequence[str]) -> str:
    """The values that inputs of a unit have before they are set."""
    from mascarin.fmu.inputs import chosen_inputs
    from mascarin.fmu.variables import variables_of

    values = ", ".join(
        f"{variable.name} {variable.start:.4g}{'' if variable.unit == '-' else ' ' + variable.unit}"
        for variable in variables_of(simulation, chosen_inputs(simulation, inputs), [])
        if variable.causality == "input" and variable.start is not None
    )
    return f"inputs hold until they are set, also where nothing is connected: {values}"
