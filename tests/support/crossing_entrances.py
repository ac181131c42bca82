"""Entrances for the crossing tests: how each command and function runs the building of a feature.

A command of `mascarin.cli.GROUPS` that is neither in `COMMANDS` nor in `WITHOUT_BUILDING` fails
`test_crossing.test_every_command_is_crossed`: write a driver here, or say why it takes no building.
"""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np
import pytest

from crossing_features import END, START, VARIED, ZONE, measured
from mascarin import _engine, cli
from mascarin.building import Building
from mascarin.building.files.yaml_text import text_of
from mascarin.errors import MascarinError
from mascarin.genopt.program import Program
from mascarin.simulation.linear_model import state_space
from mascarin.simulation.preparation.options import Scheme
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate, Measurements

OUTPUT: Final = "room.air_temperature"
#: Channels of the weather table, which has the names of the channels.
CHANNELS: Final = (
    "air_temperature", "dew_point", "cloud_cover", "wind_speed", "wind_direction", "direct_normal",
    "diffuse_horizontal",
)  # fmt: skip


@dataclass(frozen=True)
class Told:
    """What an entrance did.

    Attributes
    ----------
    code : int
        Exit code of the command, or of the exception.
    text : str
        All that it wrote for people: on both streams and in its pages, and the warnings it returns.
    """

    code: int
    text: str


@dataclass(frozen=True)
class Bench:
    """A folder with a building, weather, a study and designs, all of one feature.

    Attributes
    ----------
    folder : Path
        The folder.
    tree : dict
        The building, as a file holds it.
    step, scheme : str
        Step and scheme of the runs.
    initial : float
        Temperature at the start, where an entrance takes one. [degC]
    """

    folder: Path
    tree: Mapping[str, Any]
    step: str = "1h"
    scheme: Scheme = "sdirk2"
    initial: float = 26.0
    made: set[str] = field(default_factory=set)

    @cached_property
    def building(self) -> Building:
        """The building."""
        return Building.from_dict(self.tree)

    @cached_property
    def climate(self) -> Climate:
        """Its weather."""
        names = dict(zip(CHANNELS, CHANNELS, strict=True))
        return Climate.from_table(self.file("logger.csv"), timezone=ZONE, columns=names)

    @cached_property
    def measurements(self) -> Measurements:
        """Measured columns."""
        return Measurements.from_table(self.file("logger.csv"), timezone=ZONE)

    def simulation(self, *outputs: str) -> Simulation:
        """The run in Python."""
        return Simulation(
            self.building, self.climate, measurements=self.measurements, start=START, end=END, step=self.step,
            scheme=self.scheme, initial=self.initial, outputs=outputs or None,
        )  # fmt: skip

    def file(self, name: str) -> Path:
        """A file of the folder, written when it is first asked for."""
        path = self.folder / name
        if name not in self.made:
            self.made.add(name)
            self.folder.mkdir(exist_ok=True)
            if name == "logger.csv":
                measured().to_csv(path)
            else:
                path.write_text(text_of(_CONTENT[name](self)), encoding="utf-8")
        return path

    def command(self, *words: str | Path) -> Told:
        """Run a command in this process."""
        said = io.StringIO()
        with (
            contextlib.redirect_stdout(said),
            contextlib.redirect_stderr(said),
            warnings.catch_warnings(),
        ):
            warnings.simplefilter("default")  # a warning is text here, as for a user
            code = cli.main([str(word) for word in words])
        return Told(code, said.getvalue())


# --- files --------------------------------------------------------------------------------------------------


def _sources(bench: Bench) -> dict[str, Any]:
    names = {name: name for name in CHANNELS}
    table = {"table": str(bench.file("logger.csv").name), "timezone": ZONE}
    weather = table | {"columns": names}
    return {"climate": {"measured": weather}, "measurements": table}


def _study(bench: Bench) -> dict[str, Any]:
    bench.file("building.yaml")
    return {
        "name": "crossing",
        "building": "building.yaml",
        **_sources(bench),
        "sensors": {"air": {"column": "air", "output": OUTPUT, "uncertainty": 0.5}},
        "step": bench.step,
        "scheme": bench.scheme,
        "initial": bench.initial,
        "periods": {
            "identification": ["2001-07-02 00:00", "2001-07-02 18:00"],
            "corroboration": ["2001-07-02 18:00", "2001-07-03 06:00"],
        },
        "sensitivity": {"replicates": 3, "samples": 33, "only": [*VARIED]},
        "identification": {"starts": 1, "lead": "6h", "parameters": {VARIED[1]: None}},
    }


def _short_study(bench: Bench) -> dict[str, Any]:
    """The study without its sensitivity analysis, which is an entrance of its own."""
    return {key: value for key, value in _study(bench).items() if key != "sensitivity"}


def _design(bench: Bench) -> dict[str, Any]:
    bench.file("building.yaml")
    return {
        "name": "crossing",
        "building": "building.yaml",
        "climates": {"tampa": {"epw": "shipped:tampa", "start": "07-02", "end": "07-03"}},
        "step": bench.step,
        "scheme": bench.scheme,
        "variables": {"volume": {"path": VARIED[0], "values": [28, 32]}},
        "objectives": {"hot": {"kind": "degree_hours", "zones": ["room"], "above": 27}},
        "uncertainty": {"parameters": [VARIED[1]], "samples": 4, "designs": 2},
    }


_CONTENT: Final[dict[str, Callable[[Bench], Mapping[str, Any]]]] = {
    "building.yaml": lambda bench: bench.tree,
    "inputs.yaml": _sources,
    "study.yaml": _study,
    "short_study.yaml": _short_study,
    "design.yaml": _design,
}


# --- drivers ------------------------------------------------------------------------------------------------


def _period(bench: Bench) -> tuple[str, ...]:
    return ("--start", START, "--end", END, "--step", bench.step, "--scheme", bench.scheme)


def run(bench: Bench, *more: str | Path) -> Told:
    """``mascarin run``."""
    words: tuple[str | Path, ...] = ("--weather", bench.file("inputs.yaml"), *_period(bench))
    words = (*words, "--initial", str(bench.initial))
    return bench.command("run", bench.file("building.yaml"), *words, *more)


def _run_into(bench: Bench) -> Told:
    return run(bench, "-o", bench.folder / "run.nc")


def _report(bench: Bench) -> Told:
    page = bench.folder / "run.html"
    told = run(bench, "--report", page)
    return Told(told.code, _with(told.text, page))


def _sweep(bench: Bench) -> Told:
    words: tuple[str | Path, ...] = (
        "--weather", bench.file("inputs.yaml"), "-o", bench.folder / "sweep", "--draw", "3",
    )  # fmt: skip
    vary = [word for path in VARIED for word in ("--vary", path)]
    return bench.command(
        "sweep", bench.file("building.yaml"), *words, *vary, "--objective", f"max:{OUTPUT}", *_period(bench)
    )


def _fmu(bench: Bench) -> Told:
    words: tuple[str | Path, ...] = (
        "--weather", bench.file("inputs.yaml"), "-o", bench.folder / "unit.fmu", *_period(bench),
    )  # fmt: skip
    with pytest.MonkeyPatch.context() as patch:
        # The library is that of the system for every building, and to pack it takes longer than all else.
        _, *system = _engine.fmu_library()
        patch.setattr(_engine, "fmu_library", lambda: (b"library", *system))
        return bench.command("fmu", bench.file("building.yaml"), *words)


def _view(bench: Bench) -> Told:
    page = bench.folder / "view.html"
    told = bench.command("view", bench.file("building.yaml"), "-o", page, "--step", bench.step)
    return Told(told.code, _with(told.text, page))


def _page(bench: Bench) -> Told:
    page = bench.folder / "page.html"
    words: tuple[str | Path, ...] = ("--weather", bench.file("inputs.yaml"), "-o", page, *_period(bench))
    sliders = [word for path in VARIED for word in ("--parameter", path)]
    initial = ("--initial", str(bench.initial))
    told = bench.command("page", bench.file("building.yaml"), *words, *sliders, *initial)
    return Told(told.code, told.text)


def _explore(bench: Bench) -> Told:
    """The page of ``mascarin explore`` and a run with other values, without its server."""
    from mascarin.pages.explore import Session
    from mascarin.pages.explore.page import render

    options = {"start": START, "end": END, "step": bench.step, "measurements": bench.measurements}
    options |= {"scheme": bench.scheme}
    session = Session(bench.building, bench.climate, parameters=VARIED, options=options)
    page = render(session, "token", bench.folder / "explored.yaml")
    reply = session.run({VARIED[0]: 31.0})
    return Told(0, page + "\n".join(reply["warnings"]))


def _of_study(name: str) -> Callable[[Bench], Told]:
    def driver(bench: Bench) -> Told:
        out = bench.folder / name
        words = ("--no-figures",) if name == "study" else ()
        file = "short_study.yaml" if name == "study" else "study.yaml"
        told = bench.command(name, bench.file(file), "-o", out, *words)
        pages = [*out.glob("*.html"), *out.glob("*.json")]
        return Told(told.code, _with(told.text, *pages))

    return driver


def _genopt(bench: Bench) -> Told:
    words = ("-o", bench.folder / "genopt", "--force", "--algorithm", "parametric")
    return bench.command("genopt", bench.file("study.yaml"), *words)


def _cost(bench: Bench) -> Told:
    values = bench.folder / "parameters.txt"
    bench.folder.mkdir(exist_ok=True)
    values.write_text(f"{VARIED[1]} = 0.55\n", encoding="utf-8")
    log = bench.folder / "log.txt"
    words = ("--study", bench.file("study.yaml"), "-o", bench.folder / "result.txt", "--log", log)
    told = bench.command("cost", values, *words)
    return Told(told.code, _with(told.text, log))


def _optimize(bench: Bench) -> Told:
    """The project that ``mascarin genopt`` writes, whose program runs in this process."""
    project = _genopt(bench)
    if project.code:
        return project
    said: list[str] = []

    def start(program: Program, folder: Path) -> None:
        words = program.command(folder)
        with contextlib.chdir(folder):
            told = bench.command(*words[words.index("cost") :])
        said.append(told.text)
        if told.code:
            raise program._failed(folder, told.text)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Program, "_start", start)
        # One run at a time: the folder is that of the process.
        told = bench.command("optimize", sorted((bench.folder / "genopt").glob("*.ini"))[0], "--workers", "1")
    return Told(told.code, "\n".join([project.text, told.text, *said]))


def _design_command(bench: Bench) -> Told:
    out = bench.folder / "designs"
    told = bench.command("design", bench.file("design.yaml"), "-o", out)
    return Told(told.code, _with(told.text, *out.glob("*.html")))


def _of_building(name: str) -> Callable[[Bench], Told]:
    return lambda bench: bench.command(name, bench.file("building.yaml"))


def _linear_model(bench: Bench) -> Told:
    state_space(bench.building)
    return Told(0, "")


def _jacobian(bench: Bench) -> Told:
    return _in_python(lambda: bench.simulation(OUTPUT).jacobian(VARIED))


def _in_python(call: Callable[[], Any]) -> Told:
    """What a function says: by its result, or as a warning of Python."""
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        result = call()
    said = [str(warning.message) for warning in heard]
    said += [str(value) for key, value in getattr(result, "attrs", {}).items() if "warning" in str(key)]
    return Told(0, "\n".join([*said, *getattr(result, "warnings", ())]))


def _gradient(bench: Bench) -> Told:
    def mean(series: Mapping[str, Any]) -> tuple[float, dict[str, Any]]:
        values = series[OUTPUT]
        return float(values.mean()), {OUTPUT: np.full(len(values), 1.0 / len(values))}

    return _in_python(lambda: bench.simulation(OUTPUT).gradient(mean))


def _with(text: str, *files: Path) -> str:
    return "\n".join([text, *(file.read_text(encoding="utf-8") for file in files if file.exists())])


Driver = Callable[[Bench], Told]

#: Commands that take a building, or what names one.
COMMANDS: Final[dict[str, Driver]] = {
    "run": run,
    "sweep": _sweep,
    "fmu": _fmu,
    "view": _view,
    "explore": _explore,
    "page": _page,
    "design": _design_command,
    "study": _of_study("study"),
    "sensitivity": _of_study("sensitivity"),
    "calibrate": _of_study("calibrate"),
    "validate": _of_study("validate"),
    "genopt": _genopt,
    "cost": _cost,
    "optimize": _optimize,
    "check": _of_building("check"),
    "parameters": _of_building("parameters"),
    "outputs": _of_building("outputs"),
    "cite": _of_building("cite"),
}
#: Commands that take no building of the user, with the reason.
WITHOUT_BUILDING: Final[dict[str, str]] = {
    "init": "copies an example",
    "new": "describes a building from words: test_templates",
    "schema": "prints the keys of all buildings",
    "convert": "reads a model of EnergyPlus: test_crossing_convert",
    "materials": "lists the catalogue",
    "dsc": "reads a measurement of a material",
    "weather": "reads weather alone",
    "verify": "runs its own walls",
    "bestest": "runs its own cases",
    "suites": "runs its own cases",
}
#: Entrances that make no run in the weather, so that there are no warnings of one, with the reason.
WITHOUT_RUN: Final[dict[str, str]] = {
    "fmu": "the importing program makes the run",
    "view": "shows the building",
    "cost": "one evaluation of a search, in a process of its own: genopt, which writes the project, says it",
    "check": "reads the building",
    "parameters": "reads the building",
    "outputs": "reads the building",
    "cite": "reads the building",
    "linear model": "matrices of the building",
}
#: Entrances that are no commands of their own.
OTHERS: Final[dict[str, Driver]] = {
    "run to a file": _run_into,
    "report": _report,
    "linear model": _linear_model,
    "jacobian": _jacobian,
    "gradient": _gradient,
}
ENTRANCES: Final[dict[str, Driver]] = COMMANDS | OTHERS


def enter(entrance: str, bench: Bench) -> Told:
    """What an entrance does with a building; an error that is meant for the user has its exit code."""
    try:
        return ENTRANCES[entrance](bench)
    except MascarinError as error:
        return Told(error.exit_code, f"error: {error}")
