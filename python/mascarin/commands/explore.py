"""The command that serves a page with sliders."""

from __future__ import annotations

import reprlib
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from mascarin._io import identity
from mascarin._io.locks import writing
from mascarin.commands.options.inputs import (
    CheckSun,
    Columns,
    Flag,
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
    set_values,
    step_of,
)
from mascarin.commands.options.places import lines_named
from mascarin.commands.options.tables import run_inputs
from mascarin.commands.view import open_page
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.pages.explore import Session
    from mascarin.weather import Climate

Sliders = Annotated[list[str] | None, Parameter(name=("--parameters", "--parameter"), negative="")]
#: Length of the period where no end is given [d].
_DAYS = 14


def explore(
    building: Path,
    /,
    *,
    weather: Weather,
    measurements: MeasuredTable = None,
    columns: Columns = None,
    timezone: Zone = None,
    stamps: Stamps = "start",
    parameters: Sliders = None,
    outputs: Annotated[list[str] | None, Parameter(name="--output", negative="")] = None,
    band: Annotated[tuple[float, float], Parameter(negative="")] = (20.0, 26.0),
    start: str | None = None,
    end: str | None = None,
    step: RunStep = "15min",
    out: Annotated[Path | None, Parameter(alias="-o")] = None,
    port: int = 0,
    no_open: Annotated[bool, Flag] = False,
    settings: Settings = None,
    allow_outside: Outside = False,
    check_sun: CheckSun = True,
    shift: Shift = None,
) -> None:
    """Move sliders and see the curves of a building.

    Opens a page of this computer alone: a slider for each chosen parameter, and curves, energy balance and
    comfort that follow it. A button writes the values as a building that extends this one. Ctrl-C ends it.

    Parameters
    ----------
    building : Path
        Description of a building.
    parameters : list of str
        Parameter with a slider, such as zones.room.volume or "surfaces.*.outside.absorptance"; can be given
        several times. Default: the six whose ranges change the temperatures most.
    outputs : list of str
        Output with a curve, such as room.air_temperature or "roof.*"; can be given several times. Default:
        operative temperatures, and ideal loads where there are any.
    band : tuple of float
        Comfortable operative temperatures, lower and upper limit [degC]; they can be changed on the page.
    start : str
        Start of the period, local time. Default: the start of the weather file.
    end : str
        End of the period. Default: 14 days after its start.
    out : Path
        File that the button writes (.yaml). Default: the name of the building with "-explored", in the
        current folder, with a number where there is such a file.
    port : int
        Port of the page. Default: any that is free.
    no_open : bool
        Print the address without opening it.
    """
    from mascarin.pages.explore import Session
    from mascarin.pages.explore.session import Band

    target = _target(out, building)
    described = read_building(building, settings)
    start_values = set_values(settings)
    with lines_named(building), identity.outputs(target):
        climate, measured = run_inputs(
            described, weather, measurements, columns=columns or [], timezone=timezone, stamps=stamps,
            allow_outside=allow_outside, check_sun=check_sun, shift=shift,
        )  # fmt: skip
        options: dict[str, Any] = {
            "start": start,
            "end": end,
            "step": step_of(step),
            "measurements": measured,
        }
        if end is None:
            options["end"] = two_weeks_after(climate, start)
        session = Session(
            described,
            climate,
            parameters=parameters or (),
            outputs=matching_outputs(described, outputs) or (),
            band=Band(*band),
            options=options,
        )

    _serve(session, building, start_values, target, port=port, open_it=not no_open)


def _serve(
    session: Session,
    building: Path,
    start_values: Mapping[str, float],
    target: Path,
    *,
    port: int,
    open_it: bool,
) -> None:
    """Serve the page until Ctrl-C."""
    from mascarin.pages.explore import Server
    from mascarin.pages.explore.page import render

    def save(content: Mapping[str, Any]) -> dict[str, str]:
        with writing(target):
            session.save(target, building, _values(content), start_values)
        return {"file": str(target)}

    server = Server(
        lambda token: render(session, token, target),
        {"/run": lambda content: session.run(_values(content), content.get("band")), "/save": save},
        port,
    )
    try:
        print(f"{server.address}\nCtrl-C ends it", file=sys.stderr, flush=True)
        if open_it:
            open_page(server.address, server.address)
        server.serve_forever(poll_interval=0.1)
    finally:
        server.server_close()


def _values(content: Mapping[str, Any]) -> Mapping[str, Any]:
    values = content.get("values", {})
    if not isinstance(values, Mapping):
        raise InputError(f"values: found {reprlib.repr(values)}; expected numbers by path")
    return values


def two_weeks_after(climate: Climate, start: str | None) -> Any:
    """Two weeks after the start, or the end of the weather.

    Parameters
    ----------
    climate : Climate
        The weather.
    start : str or None
        Start of the period, local time; None: that of the weather.
    """
    import pandas as pd

    from mascarin.simulation.preparation.prepare import period

    first, last = period(climate, start, None)
    return min(first + pd.Timedelta(days=_DAYS), last)


def _target(out: Path | None, building: Path) -> Path:
    """File of the button.

    Raises
    ------
    InputError
        Its name does not end with .yaml, its folder does not exist, or it is the building itself.
    """
    if out is None:
        names = (f"{building.stem}-explored{end}.yaml" for end in ("", *(f"-{k}" for k in range(2, 1000))))
        return next(Path(name) for name in names if not Path(name).exists())
    if out.suffix.lower() not in (".yaml", ".yml"):
        raise InputError(f"--out: found '{out}'; expected a file that ends with .yaml")
    if not out.parent.is_dir():
        raise InputError(f"--out: found no folder '{out.parent}'; expected a file in a folder that exists")
    if out.is_dir():
        raise InputError(f"--out: found the folder '{out}'; expected a file to write: choose another name")
    if out.resolve() == building.resolve():
        raise InputError(f"--out: found '{out}', the building itself; expected another file")
    return out
