"""The command that writes a page in which the model runs."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from mascarin._io import identity
from mascarin._io.locks import writing
from mascarin.commands.explore import two_weeks_after
from mascarin.commands.options.exit_code import exit_code
from mascarin.commands.options.inputs import (
    CheckSun,
    Columns,
    Compared,
    MeasuredTable,
    Outside,
    Settings,
    Shift,
    Stamps,
    Step,
    Weather,
    Zone,
    matching_outputs,
    read_building,
    seconds,
    set_values,
)
from mascarin.commands.options.places import lines_named
from mascarin.commands.options.tables import compared_columns, period_of, run_inputs
from mascarin.commands.view import require_html

if TYPE_CHECKING:
    from mascarin.simulation.preparation.initial import Initial


def page(
    building: Path,
    /,
    *,
    weather: Weather,
    out: Annotated[Path, Parameter(alias="-o")],
    measurements: MeasuredTable = None,
    columns: Columns = None,
    timezone: Zone = None,
    stamps: Stamps = "start",
    parameters: Annotated[
        list[str] | None, Parameter(name=("--parameter", "--parameters"), negative="")
    ] = None,
    outputs: Annotated[list[str] | None, Parameter(name="--output", negative="")] = None,
    band: Annotated[tuple[float, float], Parameter(negative="")] = (20.0, 26.0),
    start: str | None = None,
    end: str | None = None,
    step: Step = "15min",
    scheme: Literal["sdirk2", "linearly-implicit", "backward-euler", "apparent-capacity"] = "sdirk2",
    initial: float | None = None,
    settings: Settings = None,
    allow_outside: Outside = False,
    check_sun: CheckSun = True,
    shift: Shift = None,
    compared: Compared = None,
) -> int:
    """Write a page in which the model runs.

    One HTML file with the engine, the building and its weather: a slider for each chosen parameter, and
    curves, energy balance and comfort that follow it. It needs no installation and no network. Measured
    values are part of it only where --compare asks for them. Ends with exit code 1 where a balance of the
    run does not close or a temperature has no cause.

    Parameters
    ----------
    building : Path
        Description of a building.
    out : Path
        File for the page (.html).
    parameters : list of str
        Parameter with a slider, such as zones.room.volume or "surfaces.*.outside.absorptance"; can be given
        several times. Default: those that a study has calibrated, else the six whose ranges change the
        temperatures most.
    outputs : list of str
        Output with a curve, such as room.air_temperature or "roof.*"; can be given several times. Default:
        operative temperatures, and ideal loads where there are any.
    band : tuple of float
        Comfortable operative temperatures, lower and upper limit [degC]; they can be changed on the page.
    start : str
        Start of the period, local time. Default: the start of the weather file.
    end : str
        End of the period. Default: 14 days after its start. The page grows by about 14 kB a day.
    scheme : str
        Time-stepping scheme.
    initial : float
        Temperature of the whole building at the start [degC]. Default: the first day is repeated until it is
        periodic.
    """
    from mascarin.pages.explore.session import Band
    from mascarin.pages.live import Sent, live_page

    require_html("--out", out)
    described = read_building(building, settings)
    start_values = set_values(settings)
    with writing(out), lines_named(building), identity.outputs(out):
        climate, measured = run_inputs(
            described, weather, measurements, columns=columns or [], timezone=timezone, stamps=stamps,
            allow_outside=allow_outside, check_sun=check_sun, shift=shift,
        )  # fmt: skip
        source = (measurements or weather, described, timezone, stamps, shift)
        sensors, readings = compared_columns(compared, *source)
        start, end = period_of(climate, readings, start, end)
        begins: Initial = "repeat" if initial is None else initial
        options: dict[str, Any] = {
            "start": start, "end": end or two_weeks_after(climate, start), "step": seconds(step),
            "scheme": scheme, "initial": begins, "measurements": measured,
        }  # fmt: skip
        sent = Sent(
            base=building.name, settings=start_values, band=Band.checked(band), measurements=readings,
            inputs=[("Building", str(building)), ("Weather", str(weather))], compared=sensors,
        )  # fmt: skip
        results = live_page(
            described, climate, out, parameters=parameters or (),
            outputs=matching_outputs(described, outputs) or (), sent=sent, **options,
        )  # fmt: skip
    for line in results.warnings:
        print(f"warning: {line}", file=sys.stderr)
    print(f"wrote {out}: {out.stat().st_size / 1e6:.2f} MB", file=sys.stderr)
    return exit_code(sound=results.sound)
