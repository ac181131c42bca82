"""Readers under mutation: what each reads, and how; an exception that is no refusal is a defect."""

from __future__ import annotations

import random
import shutil
import time
import traceback
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import dsc_samples
import fuzz_own_files
import fuzz_runs
from building_samples import EVERYTHING, ROOM
from design_support import BUILDING as DESIGNED
from design_support import STUDY as DESIGN
from fuzz_mutation import mutated, mutated_yaml
from fuzz_own_files import OwnReader
from genopt_support import SWARM, write_project
from idf_samples import IDF
from mascarin.building import check, load
from mascarin.design.variants.inputs import read_design
from mascarin.energyplus import convert
from mascarin.errors import MascarinError, SolverError
from mascarin.genopt import Options
from mascarin.genopt.run import check as check_project
from mascarin.materials.dsc import from_dsc
from mascarin.study import Study
from mascarin.weather import Climate, Measurements
from study_support import BUILDING, STUDY, drivers

#: Longest processor time of one input. [s]
LONGEST = 5.0


@dataclass
class Reader:
    """A reader, files that it reads without an error, and which of them are mutated."""

    name: str
    files: dict[str, bytes]
    mutated: tuple[str, ...]
    read: Callable[[Path], object]


@dataclass
class Counts:
    """What became of the inputs of a reader."""

    inputs: int = 0
    read: int = 0
    refused: int = 0
    unsolved: int = 0
    slow: list[int] = field(default_factory=list)
    defects: list[tuple[int, str]] = field(default_factory=list)

    def add(self, n: int, outcome: str, text: str, seconds: float) -> None:
        """Count an input."""
        self.inputs += 1
        self.read += outcome == "read"
        self.refused += outcome == "refused"
        self.unsolved += outcome == "unsolved"
        if outcome == "defect":
            self.defects.append((n, text))
        if seconds > LONGEST:
            self.slow.append(n)

    def row(self, name: str) -> str:
        """One line of a table."""
        found = (self.inputs, self.read, self.refused, self.unsolved, len(self.defects), len(self.slow))
        return f"| {name} | " + " | ".join(map(str, found)) + " |"


def attempt(reader: Reader | OwnReader, folder: Path, n: int, seed: int) -> tuple[str, str]:
    """Read one mutated file; it depends on the seed and n only.

    Returns
    -------
    str
        ``read``, ``refused``, ``unsolved`` (it was read; its run did not converge) or ``defect``.
    str
        The traceback of a defect.
    """
    draw = random.Random(f"{reader.name} {seed} {n}")
    if isinstance(reader, OwnReader):
        shutil.rmtree(folder)  # what it wrote before
    for name, content in reader.files.items():
        _put(folder / name, content)
    name = draw.choice(reader.mutated)
    content = reader.files[name]
    if isinstance(reader, OwnReader):
        changed = reader.changed(name, draw)
    elif name.endswith(".yaml"):
        changed = mutated_yaml(content.decode(), draw)
    else:
        changed = mutated(content, draw)
    _put(folder / name, changed)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            reader.read(folder)
    except SolverError:
        return "unsolved", ""
    except MascarinError:
        return "refused", ""
    except Exception:
        return "defect", traceback.format_exc()
    return "read", ""


def run(reader: Reader | OwnReader, folder: Path, count: int, seed: int) -> Counts:
    """Read mutated files; the n-th input depends on the seed and n only."""
    counts = Counts()
    for n in range(count):
        began = time.process_time()
        counts.add(n, *attempt(reader, folder, n, seed), time.process_time() - began)
    return counts


def _put(path: Path, content: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_bytes() != content:
        path.write_bytes(content)


def _building(folder: Path) -> None:
    building = load(folder / "building.yaml")
    check(building)
    fuzz_runs.day(building)


def _genopt(folder: Path) -> None:
    check_project(folder / "opt.ini", Options())


def _table(folder: Path) -> None:
    read = Measurements.from_table(
        folder / "logger.csv", timezone="Europe/Paris", columns=["air", "sun", "room"]
    )
    read.quality()


def epw_text() -> str:
    """A year of weather as an EPW file, made up."""
    head = [
        "LOCATION,Nowhere,-,XX,made up,000000,48.0,2.0,1.0,100.0",
        "DESIGN CONDITIONS,0", "TYPICAL/EXTREME PERIODS,0", "GROUND TEMPERATURES,0",
        "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0", "COMMENTS 1,made up", "COMMENTS 2,made up",
        "DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31",
    ]  # fmt: skip
    rows = []
    for stamp in _hours():
        warm = 10.0 + 8.0 * np.sin(2.0 * np.pi * (stamp.hour - 8) / 24.0)
        # Solar noon is at 12:52 there.
        sun = 600.0 * np.cos(np.pi * np.clip((stamp.hour + 0.5 - 12.87) / 8.0, -0.5, 0.5))
        fields = ["0"] * 35
        fields[:6] = [str(stamp.year), str(stamp.month), str(stamp.day), str(stamp.hour + 1), "60", "?"]
        fields[6:13] = [f"{warm:.1f}", "4.0", "70", "101325", "0", "0", "300"]
        fields[13:16] = [f"{0.3 * sun:.0f}", "0", f"{0.3 * sun:.0f}"]  # overcast
        fields[20:24] = ["200", "3.1", "5", "5"]
        rows.append(",".join(fields))
    return "\n".join([*head, *rows]) + "\n"


def tmy_text() -> str:
    """A year of weather as a TMY3 table, made up."""
    head = [
        '725650,"NOWHERE",CO,-7.0,39.830,-104.650,1650',
        "Date (MM/DD/YYYY),Time (HH:MM),GHI (W/m^2),DNI (W/m^2),DHI (W/m^2),OpqCld (tenths),Dry-bulb (C),"
        "Dew-point (C),RHum (%),Pressure (mbar),Wdir (degrees),Wspd (m/s)",
    ]
    rows = [
        f"{t.month:02d}/{t.day:02d}/{t.year},{t.hour + 1:02d}:00,{60 * _light(t.hour)},"
        f"{40 * _light(t.hour)},{20 * _light(t.hour)},3,{10 - abs(t.hour - 14)}.0,-4.0,"
        "55,837.0,120,2.5"
        for t in _hours()
    ]
    return "\n".join([*head, *rows]) + "\n"


def _light(hour: int) -> int:
    return max(0, 9 - abs(hour - 12))


def _hours() -> list:  # type: ignore[type-arg]
    import pandas as pd

    return list(pd.date_range("1995-01-01", periods=8760, freq="1h"))


def readers(folder: Path) -> list[Reader | OwnReader]:
    """Every reader with its files; `folder` is used to write the samples of GenOpt and DSC."""
    folder.mkdir(parents=True, exist_ok=True)
    t = dsc_samples.temperatures()
    dsc = dsc_samples.write(
        folder / "dsc.csv",
        {"temperature [degC]": t[::4], "cp heating [J/(g K)]": dsc_samples.heat(t[::4]) / 1000.0},
    ).read_bytes()
    project = write_project(folder / "project", algorithm="Main = PSOCC;" + SWARM).parent
    genopt = {
        name: (project / name).read_bytes() for name in ("opt.ini", "command.txt", "sim.cfg", "template.txt")
    }
    logger = drivers(9)
    logger["joint"] = logger["core"] = logger["room"]
    table = logger.round(3).to_csv(lineterminator="\n").encode()
    few = drivers(2).round(3).to_csv(lineterminator="\n").encode()
    study = {"study.yaml": STUDY.encode(), "building.yaml": BUILDING.encode(), "logger.csv": table}
    return [
        Reader("building", {"building.yaml": EVERYTHING.encode()}, ("building.yaml",), _building),
        Reader("room", {"building.yaml": ROOM.encode()}, ("building.yaml",), _building),
        Reader("study", study, ("study.yaml",), lambda at: Study.from_yaml(at / "study.yaml")),
        Reader(
            "EPW",
            {"site.epw": epw_text().encode()},
            ("site.epw",),
            lambda at: Climate.from_epw(at / "site.epw"),
        ),
        Reader(
            "TMY3",
            {"site.csv": tmy_text().encode()},
            ("site.csv",),
            lambda at: Climate.from_tmy(at / "site.csv"),
        ),
        Reader("table", {"logger.csv": few}, ("logger.csv",), _table),
        Reader("DSC", {"dsc.csv": dsc}, ("dsc.csv",), lambda at: from_dsc(at / "dsc.csv")),
        Reader("GenOpt", genopt, tuple(genopt), _genopt),
        Reader("IDF", {"model.idf": IDF.encode()}, ("model.idf",), lambda at: convert(at / "model.idf")),
        Reader(
            "design",
            {"design.yaml": DESIGN.encode(), "building.yaml": DESIGNED.encode()},
            ("design.yaml",),
            lambda at: read_design(at / "design.yaml"),
        ),
        *fuzz_own_files.readers(folder / "own"),
    ]
