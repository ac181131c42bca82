"""A page in which the model runs: sliders, curves, energy and comfort in one file, without a network."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import lru_cache
from glob import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from markupsafe import Markup

from mascarin import __version__
from mascarin._io import atomic, units
from mascarin._io.arguments import names_of
from mascarin.building.outputs.kinds import KINDS
from mascarin.building.rooms import lived_in, rooms
from mascarin.errors import InputError, did_you_mean
from mascarin.figures import text
from mascarin.fmu.contents import run_json
from mascarin.fmu.variables import variables_of
from mascarin.pages.explore import choice
from mascarin.pages.explore.session import Band
from mascarin.pages.frame.template import CURVES, asset, environment, frame
from mascarin.pages.live import engine, sliders
from mascarin.pages.live.packing import ALPHABET, planes, text_of
from mascarin.pages.run.page import Notes, flow_words, how_it_was_run
from mascarin.simulation.checks import step_check, unmelted
from mascarin.simulation.checks.energy import CLOSED, FLOWS
from mascarin.simulation.checks.warning_kinds import WarningKind
from mascarin.simulation.preparation.step_sequence import require_equal_steps
from mascarin.simulation.simulation import Simulation
from mascarin.weather import CHANNELS

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.building.parameters.parameter import Parameter
    from mascarin.simulation.results import Results
    from mascarin.weather import Climate, Measurements

#: The text of the engine, which takes as long as a run of a month.
_engine_text: Final = lru_cache(maxsize=1)(text_of)
#: Points of a curve; of longer runs every k-th step is drawn.
_MAX_POINTS: Final = 3000


class Sent(NamedTuple):
    """What a page has beside the run.

    Attributes
    ----------
    base : str
        The file of the building, which the YAML file of the page extends.
    settings : mapping of str to float
        Values that the building was given after it was read. [unit of each]
    inputs : sequence of (str, str)
        Files and options, by name.
    band : Band
        Comfortable operative temperatures, at first. [degC]
    measurements : Measurements or None
        Measured table. Only the columns of `compared` become part of the page.
    compared : mapping of str to str
        Output and the measured column that is drawn beside it.
    """

    base: str = "building.yaml"
    settings: Mapping[str, float] = {}
    inputs: Sequence[tuple[str, str]] = ()
    band: Band = Band()
    measurements: Measurements | None = None
    compared: Mapping[str, str] = {}


def live_page(
    building: Building,
    climate: Climate,
    path: str | Path,
    *,
    parameters: Sequence[str] = (),
    outputs: Sequence[str] = (),
    sent: Sent | None = None,
    **options: Any,
) -> Results:
    """Write a page in which the model runs: one HTML file with the engine, the building and its weather.

    It needs no installation and no network. Its runs have the bits of `simulate` in Python.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    path : str or Path
        The file; one that exists is replaced.
    parameters : sequence of str
        Paths of the sliders, with ``*``. Default: what a study has calibrated in this building, else the six
        parameters whose ranges change the temperatures most.
    outputs : sequence of str
        Curves. Default: operative temperatures, and ideal loads where there are any.
    sent : Sent, optional
        Measured data, limits of comfort, names of files.
    **options
        ``start``, ``end``, ``step``, ``scheme``, ``initial``, ``first_period`` and ``measurements`` of
        `simulate`.

    Returns
    -------
    Results
        The run with the values of the building, with its warnings; the page has them, too.

    Raises
    ------
    InputError
        Something that cannot be used, or an installation without the engine for browsers.
    SolverError
        The run with the values of the building did not converge.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> run = mc.live_page(box(), box_climate(), Path(mkdtemp()) / "box.html", step="1h")  # doctest: +SKIP
    >>> run.energy.closes  # doctest: +SKIP
    True
    """
    module = engine.module()
    about = sent or Sent()
    chosen = [building.output(name).name for name in names_of("outputs", outputs)] or choice.curves(building)
    patterns = names_of("parameters", parameters)
    simulation, parameters_shown = _compiled(building, climate, patterns, chosen, options)
    results = simulation.run()
    html = _Page(simulation, results, parameters_shown, chosen, about).html(module)
    atomic.write(Path(path), html)
    return results


def _compiled(
    building: Building,
    climate: Climate,
    patterns: Sequence[str],
    curves: Sequence[str],
    options: Mapping[str, Any],
) -> tuple[Simulation, list[Parameter]]:
    """The run, with a mesh that is fine enough for all positions of the sliders, and what has one."""
    operative = [f"{zone}.operative_temperature" for zone in rooms(building)]
    recorded = list(dict.fromkeys([*curves, *operative]))
    first = Simulation(building, climate, **options, outputs=recorded)
    parameters = sliders.chosen(building, first, patterns)
    require_equal_steps(first.sequence, "a page in which the model runs: its engine has no others")
    ranges = {each.path: (each.low, each.high) for each in parameters if each.low < each.high}
    return Simulation(building, climate, **options, outputs=recorded, ranges=ranges), parameters


class _Page:
    """What the page has, from a run."""

    def __init__(
        self,
        simulation: Simulation,
        results: Results,
        parameters: Sequence[Parameter],
        curves: Sequence[str],
        sent: Sent,
    ) -> None:
        self._simulation, self._results, self._curves, self._sent = simulation, results, curves, sent
        self._parameters = parameters
        self._sliders = [sliders.plain(simulation, parameter) for parameter in parameters]

    def html(self, module: bytes) -> str:
        """The page.

        Parameters
        ----------
        module : bytes
            The engine for browsers.
        """
        simulation = self._simulation
        files = self._files()
        styles = ["frame/vendor/uPlot.min.css", "explore/explore.css", "live/live.css"]
        return (
            environment()
            .get_template("pages/live/live.html")
            .render(
                frame(
                    styles=[f"pages/{style}" for style in styles],
                    libraries=[CURVES],
                    scripts=["pages/frame/curves.js", "pages/live/checks.js", "pages/live/live.js"],
                    data=self._data(files),
                    computes=True,
                ),
                title=simulation.building.name,
                version=__version__,
                sections=[],
                period=text.span_of(simulation.start, simulation.end),
                sliders=self._sliders,
                measured=bool(self._sent.compared),
                rooms=self._rooms(),
                same=self._has_the_mesh_of_a_run(),
                inputs=self._inputs(),
                worker=Markup(asset("pages/live/worker.js")),  # noqa: S704  (our own file)
                engine=_engine_text(module),
                contents=text_of(b"".join(files)),
            )
        )

    def _inputs(self) -> list[tuple[str, str]]:
        """How the run was made, without what was read of each column of a table."""
        rows = how_it_was_run(self._results, Notes(inputs=self._sent.inputs))
        return [(name, words) for name, words in rows if not name.endswith(", provenance")]

    def _files(self) -> list[bytes]:
        """What the engine reads, then measured values."""
        simulation = self._simulation
        channels = simulation.compiled.forcing.shape[-1]
        names = [escape(simulation.paths[k]) for entry in self._sliders for k, _ in entry["positions"]]
        variables = [each for each in variables_of(simulation, (), names) if each.causality == "parameter"]
        return [
            run_json(
                simulation,
                variables,
                f"{{{simulation.identity[:32]}}}",
                readings=simulation.recorded,
                sources=False,
            ),
            simulation.compiled.description.encode(),
            planes(np.moveaxis(simulation.compiled.forcing.reshape(-1, channels), -1, 0)),
            json.dumps(self._measured(), allow_nan=False).encode(),
        ]

    def _data(self, files: Sequence[bytes]) -> dict[str, Any]:
        """What the script of the page reads."""
        simulation = self._simulation
        compiled, times = simulation.compiled, simulation.index.tz_localize(None)
        seconds = times.to_numpy().astype("datetime64[s]").astype(np.int64)
        words = choice.labels(simulation.building, self._curves)
        jumps = np.flatnonzero(np.diff(seconds) != simulation.step_seconds) + 1
        return {
            "alphabet": ALPHABET,
            "sizes": [len(content) for content in files],
            "sliders": self._sliders,
            "rows": len(seconds),
            "step": simulation.step_seconds,
            "period": f"{simulation.start:%Y-%m-%d %H:%M} to {simulation.end:%Y-%m-%d %H:%M}, steps of "
            f"{simulation.step_seconds:g} s",
            # Local times, as if they were UTC; the clock jumps at these rows.
            "clock": [[int(row), int(seconds[row])] for row in (0, *jumps.tolist())],
            "stride": max(1, -(-len(seconds) // _MAX_POINTS)),
            "channels": {
                "stages": compiled.forcing.shape[1],
                "count": compiled.forcing.shape[2],
                "outdoors": CHANNELS.index("air_temperature"),
            },
            "outputs": [
                {
                    "name": name,
                    "label": words[name]["label"] if name in words else name,
                    "quantity": KINDS[output.kind].label,
                    "unit": units.shown(output.unit),
                    "plain": output.unit,
                    "column": column,
                }
                for name, output, column in self._recorded()
            ],
            "curves": list(self._curves),
            "records": len(json.loads(simulation.recorded.outputs)),
            "rooms": self._rooms(),
            # Rooms that do not count in the sum of the comfort until someone ticks them: an attic.
            "uncounted": [zone for zone in self._rooms() if zone not in lived_in(simulation.building)],
            "band": list(self._sent.band),
            "flows": [[flow, flow_words(flow)] for flow in FLOWS],
            "checks": self._checks(),
            "warnings": {
                "building": [line for line in self._results.warnings if line.kind == WarningKind.BUILDING],
                "sent": [line for line in self._results.warnings if line.kind != WarningKind.BUILDING],
            },
            "base": self._sent.base,
            "settings": dict(self._sent.settings),
            "title": simulation.building.name,
            "version": __version__,
        }

    def _recorded(self) -> list[tuple[str, Any, int]]:
        outputs = self._simulation.outputs
        columns = self._simulation.recorded.columns[: len(outputs)]
        return [(output.name, output, column) for output, column in zip(outputs, columns, strict=True)]

    def _rooms(self) -> list[str]:
        """Zones whose comfort is shown: a cavity such as a roof gap has none."""
        recorded = {name for name, _, _ in self._recorded()}
        zones = rooms(self._simulation.building)
        return [zone for zone in zones if f"{zone}.operative_temperature" in recorded]

    def _checks(self) -> dict[str, Any]:
        """What the page looks for in its own runs, as `simulation.run_warnings` does."""
        simulation = self._simulation
        building, columns, count = simulation.building, simulation.recorded.columns, len(simulation.outputs)
        layers = [f"surfaces.{name}, layer {layer}" for name, layer, _ in unmelted.layers(building)]
        watched = unmelted.watched(building)
        outputs = [*simulation.outputs, *watched, *step_check.watched(building, simulation.outputs)]
        order, share = step_check.SHARES[simulation.scheme]
        return {
            "closed": CLOSED,
            "layers": [
                {"name": name, "temperature": columns[count + 2 * k], "fraction": columns[count + 2 * k + 1]}
                for k, name in enumerate(layers)
            ],
            "nothing": unmelted.NOTHING,
            "airs": {zone: columns[k] for zone, k in step_check.free_airs(building, outputs).items()},
            "order": order,
            "share": share,
            "large": step_check.LARGE,
            "first": step_check.START,
            "humid": building.humidity is not None,
        }

    def _measured(self) -> dict[str, list[float | None]]:
        """Measured values beside outputs, at the times of the records."""
        sent, names = self._sent, [name for name, _, _ in self._recorded()]
        values: dict[str, list[float | None]] = {}
        for name, column in sent.compared.items():
            if name not in names or sent.measurements is None:
                raise InputError(
                    f"--compare: found the output '{name}', expected one with a curve and a measured table. "
                    f"{did_you_mean(name, names)}".rstrip()
                )
            series = sent.measurements.at(column, self._simulation.index)
            if not np.isfinite(series).any():
                raise InputError(
                    f"{sent.measurements.file}: column {column!r} has no value in the period of the page, "
                    f"expected some; the table covers {sent.measurements.grid.span()}: choose --start and "
                    "--end inside"
                )
            values[name] = [round(value, 5) if np.isfinite(value) else None for value in series.tolist()]
        return values

    def _has_the_mesh_of_a_run(self) -> bool:
        """Whether the ranges of the sliders leave the mesh as it is without them."""
        simulation = self._simulation
        plain = simulation.building.to_engine(simulation.step_seconds)
        return plain.json == simulation.compiled.description
