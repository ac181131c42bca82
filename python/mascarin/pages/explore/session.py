"""What the page of `mascarin explore` asks for: runs of one compiled building with other values."""

from __future__ import annotations

import os
import reprlib
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Self

import numpy as np

from mascarin import __version__
from mascarin._io import atomic, units
from mascarin.building import load
from mascarin.building.files.yaml_text import text_of
from mascarin.building.rooms import lived_in, rooms
from mascarin.errors import InputError
from mascarin.pages.explore import choice
from mascarin.pages.run.page import flow_words
from mascarin.simulation.simulation import Simulation

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.building.parameters.parameter import Parameter
    from mascarin.simulation.results import Results
    from mascarin.weather import Climate

#: No number of a building is as large.
_MAX_VALUE: Final = 1e300
#: Points of a curve; of longer runs every k-th step is shown.
_MAX_POINTS: Final = 3000


class Band(NamedTuple):
    """Operative temperatures that count as comfortable. [degC]"""

    low: float = 20.0
    high: float = 26.0

    @classmethod
    def checked(cls, band: object) -> Self:
        """Make one of two numbers that may come from anywhere.

        Parameters
        ----------
        band : object
            Two temperatures. [degC]

        Raises
        ------
        InputError
            It is something else, or the lower one does not come first.
        """
        ends = list(band) if isinstance(band, list | tuple) else []
        if len(ends) != 2 or not all(map(_is_number, ends)) or not ends[0] < ends[1]:
            raise InputError(
                f"band: found {reprlib.repr(ends or band)}; expected two temperatures, the lower one first, "
                "such as 20 26"
            )
        return cls(float(ends[0]), float(ends[1]))


class Session:
    """A compiled building, its sliders and its curves.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    parameters : sequence of str
        Paths of the sliders, with ``*``; none: those whose ranges change the temperatures most.
    outputs : sequence of str
        Curves; none: operative temperatures and loads.
    band : Band
        Comfortable operative temperatures, at first.
    options : mapping
        ``start``, ``end``, ``step``, ``measurements`` of `Simulation`.

    Raises
    ------
    InputError
        Something that cannot be used.

    Examples
    --------
    >>> from mascarin.examples import box, box_climate
    >>> session = Session(box(), box_climate(), options={"step": "1h"})
    >>> sorted(session.run({}))
    ['comfort', 'energy', 'series', 'warnings']
    """

    def __init__(
        self,
        building: Building,
        climate: Climate,
        *,
        parameters: Sequence[str] = (),
        outputs: Sequence[str] = (),
        band: Band | None = None,
        options: Mapping[str, Any] | None = None,
    ) -> None:
        self.band = Band.checked(band or Band())
        chosen = [building.output(name).name for name in outputs] or choice.curves(building)
        operative = [output.name for output in building.outputs() if output.kind == "operative_temperature"]
        self._curves = tuple(chosen)
        run_options = dict(options or {}) | {"outputs": list(dict.fromkeys([*chosen, *operative]))}
        if parameters:
            sliders = choice.named(building, parameters)
        else:
            temperatures = operative or [name for name in chosen if building.output(name).unit == "degC"]
            sliders = choice.strongest(
                building, Simulation(building, climate, **{**run_options, "outputs": temperatures or chosen})
            )
        self.sliders: tuple[Parameter, ...] = tuple(sliders)
        ranges = {slider.path: (slider.low, slider.high) for slider in sliders if slider.low < slider.high}
        self.simulation = Simulation(building, climate, ranges=ranges, **run_options)
        self._lock = threading.Lock()  # runs of one page come one after the other

    def run(self, values: Mapping[str, Any], band: Sequence[float] | None = None) -> dict[str, Any]:
        """Run once.

        Parameters
        ----------
        values : mapping of str to float
            Values of sliders by path; the others are those of the building. [unit of each]
        band : (float, float), optional
            Comfortable operative temperatures. [degC]

        Returns
        -------
        dict
            ``series``: values of each curve; ``energy``: heat by flow [kWh]; ``comfort``: hours and
            degree-hours of each zone; ``warnings``.

        Raises
        ------
        InputError
            A path without a slider, or a value that its parameter cannot have.
        SolverError
            The run did not converge.
        """
        limits = self.band if band is None else Band.checked(band)
        numbers = self._numbers(values)
        with self._lock:
            results = self.simulation.run(numbers)
        stride = self._stride
        records = {output.name: results.records[::stride, k] for k, output in enumerate(results.outputs)}
        return {
            "series": {name: np.round(records[name], 4).tolist() for name in self._curves},
            "energy": [
                *([flow_words(flow), round(heat / 3.6e6, 4)] for flow, heat in results.energy.into.items()),
                ["Stored in walls and air", round(results.energy.stored / 3.6e6, 4)],
            ],
            "comfort": self._comfort(results, limits),
            "warnings": list(results.warnings),
        }

    def page(self) -> dict[str, Any]:
        """What the page needs once: sliders, times, curves, and the run of the building as it is."""
        times, building = self.simulation.index[:: self._stride], self.simulation.building
        return {
            "sliders": [choice.slider(parameter) for parameter in self.sliders],
            # Local times, as if they were UTC.
            "times": [round(time.timestamp()) for time in times.tz_localize(None)],
            "curves": [
                {"name": name, **words} for name, words in choice.labels(building, self._curves).items()
            ],
            # Rooms that do not count in the sum of the comfort until someone ticks them: an attic.
            "uncounted": [zone for zone in rooms(building) if zone not in lived_in(building)],
            "band": list(self.band),
            "reference": self.run({}),
            "outdoors": np.round(self.simulation.weather("air_temperature")[:: self._stride], 3).tolist(),
        }

    def save(self, target: Path, base: Path, values: Mapping[str, Any], settings: Mapping[str, float]) -> str:
        """Write a description that extends the building by the values.

        Parameters
        ----------
        target : Path
            File to write.
        base : Path
            File of the building.
        values : mapping of str to float
            Values of sliders by path. [unit of each]
        settings : mapping of str to float
            Values that the building had been given before. [unit of each]

        Returns
        -------
        str
            The text of the file.

        Raises
        ------
        InputError
            A value cannot be used, or the file would be the building itself.
        """
        if target.resolve() == base.resolve():
            raise InputError(f"--out: found {target}, the building itself; expected another file")
        nominal = {slider.path: slider.value for slider in self.sliders}
        changed = {path: x for path, x in self._numbers(values).items() if x != nominal[path]}
        self.simulation.vector(changed)
        with self._lock:
            written = text_of({"extends": _path(base, target.parent), "set": {**settings, **changed}})
            head = f"# {base.name} with other values, by 'mascarin explore' {__version__}.\n"
            before = target.read_text(encoding="utf-8") if target.exists() else None
            atomic.write(target, head + written)
            try:
                load(target)
            except InputError:
                target.unlink() if before is None else atomic.write(target, before)
                raise
        return head + written

    def _numbers(self, values: Mapping[str, Any]) -> dict[str, float]:
        sliders = {slider.path: slider for slider in self.sliders}
        for path, value in values.items():
            if path not in sliders:
                raise InputError(f"{path}: found no slider of this parameter; expected one of the page")
            if not _is_number(value):
                raise InputError(f"{path}: found {reprlib.repr(value)}; expected a number")
            slider = sliders[path]
            if not slider.lower <= value <= slider.upper:
                limits = f"{slider.lower:g} to {slider.upper:g} {units.shown(slider.unit)}".rstrip()
                raise InputError(f"{path}: found {value:g}; expected {limits}")
        return {path: float(value) for path, value in values.items()}

    @property
    def _stride(self) -> int:
        return max(1, -(-len(self.simulation.index) // _MAX_POINTS))

    def _comfort(self, results: Results, band: Band) -> list[dict[str, Any]]:
        # A cavity such as a roof gap has no comfort.
        zones = [
            name for name in rooms(self.simulation.building) if f"{name}.operative_temperature" in results
        ]
        rows = []
        for zone in zones:
            discomfort = results.comfort(zone, index="operative", band=list(band)).discomfort
            rows.append(
                {
                    "zone": zone,
                    "hot": round(float(discomfort.hot_hours), 2),
                    "cold": round(float(discomfort.cold_hours), 2),
                    "hot_degree_hours": round(float(discomfort.hot_degree_hours), 2),
                    "cold_degree_hours": round(float(discomfort.cold_degree_hours), 2),
                }
            )
        return rows


def _is_number(value: object) -> bool:
    """Whether a value of JSON is a number that a float can hold; integers of JSON have no end."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _MAX_VALUE


def _path(base: Path, folder: Path) -> str:
    """Path of the building, counted from the folder of the new file."""
    try:
        return Path(os.path.relpath(base.resolve(), folder.resolve())).as_posix()
    except ValueError:  # another drive
        return base.resolve().as_posix()
