"""No command writes onto what it has read, by whatever name: checked for every command of the command line.

What a command reads is found from outside, by the audit events of Python, so that a file that is opened
past `mascarin._io` is seen as well.
"""

from __future__ import annotations

import gzip
import os
import shutil
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

import dsc_samples
import mascarin as mc
from building_samples import ROOM
from design_support import written as write_design
from fuzz_readers import epw_text
from genopt_support import write_project
from idf_samples import IDF
from mascarin._io import atomic, identity
from mascarin._io.regular import require_regular
from mascarin.cli import GROUPS, build_app, main
from mascarin.errors import InputError
from study_support import BUILDING, STUDY, logger_table

DAY = ("--step", "1h", "--end", "1995-01-02")


@dataclass(frozen=True)
class Case:
    """How a command is called.

    Attributes
    ----------
    words : tuple of str
        Arguments without outputs, with paths relative to the folder of the inputs.
    files : dict of str to str
        Ending of the file of each output option.
    folder : dict of str to tuple of str
        Files that the command writes into the folder of an output option.
    reads : tuple of str
        A quicker command that reads the same files; default: the command itself.
    late : tuple of str
        Inputs that are read after another refusal in this test.
    """

    words: tuple[str, ...] = ()
    files: dict[str, str] = field(default_factory=dict)
    folder: dict[str, tuple[str, ...]] = field(default_factory=dict)
    reads: tuple[str, ...] = ()
    late: tuple[str, ...] = ()


OF_STUDY = ("study.json", "tables/series.csv", "figures/fit.svg", "report.html", "validation.json")
VALIDATE = ("study/study.yaml",)

#: Every command; a later one fails `test_every_command_is_tried` until it is listed.
CASES: dict[str, Case] = {
    "init": Case(),
    "new": Case(
        (
            *("wall", "brick 20cm", "--inside", "room", "--outside", "air", "--sensor", "core=50mm"),
            *("--data", "study/logger.csv", "--timezone", "UTC"),
        ),
        folder={"--out": ("building.yaml", "study.yaml", "logger.csv")},
    ),
    "schema": Case(files={"--out": ".json"}),
    "check": Case(("house.yaml",)),
    "parameters": Case(("house.yaml",)),
    "outputs": Case(("house.yaml",)),
    "cite": Case(("house.yaml",)),
    "verify": Case(),
    "convert": Case(
        ("model.idf", "--weather", "site.epw", "--compare", "run"), {"--out": ".yaml", "--report": ".html"}
    ),
    "view": Case(("house.yaml", "--no-open"), {"--out": ".html"}),
    "materials": Case(("rt25",), {"--plot": ".svg"}),
    "dsc": Case(("dsc.csv",), {"--out": ".yaml", "--plot": ".svg"}),
    "weather": Case(("site.epw", "--morph", "morph.csv"), {"--epw": ".epw"}, {"--out": ("months.csv",)}),
    "run": Case(("house.yaml", "--weather", "site.epw", *DAY), {"--out": ".csv", "--report": ".html"}),
    "explore": Case(
        ("house.yaml", "--weather", "site.epw", "--no-open"),
        {"--out": ".yaml"},
        reads=("run", "house.yaml", "--weather", "site.epw", *DAY),
    ),
    "page": Case(
        ("house.yaml", "--weather", "site.epw", *DAY),
        {"--out": ".html"},
        reads=("run", "house.yaml", "--weather", "site.epw", *DAY),
    ),
    "fmu": Case(
        ("house.yaml", "--weather", "site.epw", *DAY),
        {"--out": ".fmu"},
        reads=("run", "house.yaml", "--weather", "site.epw", *DAY),
    ),
    "sweep": Case(
        (
            "house.yaml",
            "--weather",
            "site.epw",
            *DAY,
            "--samples",
            "samples.csv",
            "--objective",
            "max:room.air_temperature",
        ),
        folder={"--out": ("manifest.json", "members.parquet", "pieces/a.parquet")},
        reads=(
            "sweep",
            "house.yaml",
            "--weather",
            "site.epw",
            *DAY,
            "--samples",
            "samples.csv",
            "--objective",
            "max:room.air_temperature",
            "--out",
            "tried",
        ),
    ),
    "design": Case(
        ("design/design.yaml",),
        folder={"--out": ("designs.csv", "design.json", "report.html", "runs/x/manifest.json")},
        reads=("design", "design/design.yaml", "--check"),
    ),
    "study": Case(VALIDATE, folder={"--out": OF_STUDY}, reads=("validate", *VALIDATE)),
    "sensitivity": Case(VALIDATE, folder={"--out": OF_STUDY}, reads=("validate", *VALIDATE)),
    "calibrate": Case(VALIDATE, folder={"--out": OF_STUDY}, reads=("validate", *VALIDATE)),
    "validate": Case(VALIDATE, folder={"--out": OF_STUDY}, reads=("validate", *VALIDATE)),
    "bestest": Case(
        ("house.yaml", "--ranges", "ranges.csv", "--weather", "site.epw"),
        folder={"--out": ("bestest.html",)},
        late=("site.epw", "house.yaml", "base.yaml"),  # the weather is not that of the standard
    ),
    "suites": Case(("bland",), folder={"--out": ("suites.html", "suites.json")}),
    "optimize": Case(("--project", "genopt/opt.ini"), {"--table": ".csv"}),
    "genopt": Case(
        VALIDATE, folder={"--out": ("template.txt", "compiled.npz")}, reads=("validate", *VALIDATE)
    ),
    "cost": Case(("parameters.txt", "--study", "study/study.yaml"), {"--out": ".txt", "--log": ".log"}),
}

#: Reference numbers of a suite: a slab, its film, its start, the step of the air, and two hours.
SLAB = """\
Input Data

0.1
1.0
1000
1000
10
20
10
0
0
7200
3600
IOSTEP Output Data
Temperature (K)
20.1, 0
20.4, 0
"""

_opened: list[str] | None = None


def _audit(event: str, values: tuple[Any, ...]) -> None:
    if event == "open" and _opened is not None and isinstance(values[0], str | os.PathLike):
        mode, flags = values[1], values[2]
        if not (mode and set(mode) & set("wax+")) and not (flags or 0) & (os.O_WRONLY | os.O_RDWR):
            _opened.append(str(values[0]))


sys.addaudithook(_audit)


@pytest.fixture(scope="module")
def original(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Inputs of all commands."""
    folder = tmp_path_factory.mktemp("inputs")
    (folder / "base.yaml").write_text(ROOM, encoding="utf-8")
    (folder / "house.yaml").write_text("extends: base.yaml\n", encoding="utf-8")
    (folder / "site.epw").write_text(epw_text(), encoding="utf-8")
    (folder / "model.idf").write_text(IDF, encoding="utf-8")
    rows = "\n".join(f"{month},1.0" for month in range(1, 13))
    (folder / "morph.csv").write_text(f"month,temperature\n{rows}\n", encoding="utf-8")
    (folder / "samples.csv").write_text("zones.room.volume\n30\n40\n", encoding="utf-8")
    (folder / "ranges.csv").write_text(
        "case,quantity,unit,min,max\nhouse,annual_heating,MWh,0,1\n", encoding="utf-8"
    )
    (folder / "parameters.txt").write_text("materials.brick.conductivity = 0.6\n", encoding="utf-8")
    t = dsc_samples.temperatures()[::4]
    heat = dsc_samples.heat(t) / 1000.0
    dsc_samples.write(folder / "dsc.csv", {"temperature [degC]": t, "cp heating [J/(g K)]": heat})
    for name in ("design", "study"):
        (folder / name).mkdir()
    write_design(folder / "design")
    (folder / "study" / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (folder / "study" / "study.yaml").write_text(STUDY, encoding="utf-8")
    logger_table(folder / "study" / "building.yaml").to_csv(folder / "study" / "logger.csv")
    write_project(folder / "genopt")
    (folder / "run").mkdir()
    (folder / "run" / "eplusout.csv").write_text("Date/Time,ROOM:Zone Mean Air Temperature [C](Hourly)\n")
    (folder / "suites" / "bland").mkdir(parents=True)
    with gzip.open(folder / "suites" / "bland" / "Test_1-1_Analytical.csv.gz", "wt") as file:
        file.write(SLAB)
    return folder


@pytest.fixture
def place(original: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the inputs, which is the working folder."""
    shutil.copytree(original, tmp_path / "inputs")
    monkeypatch.chdir(tmp_path / "inputs")
    monkeypatch.setenv("MASCARIN_DATA", str(tmp_path / "inputs"))
    return tmp_path / "inputs"


def options(name: str) -> Iterator[tuple[str, ...]]:
    """Names of the options of a command that are paths."""
    for argument in build_app(name)[name].assemble_argument_collection():
        if "Path" in str(argument.hint) and argument.names[0].startswith("-"):
            yield argument.names


def inputs_of(words: tuple[str, ...], place: Path) -> list[str]:
    """Files of the folder that a command opens, relative to it."""
    global _opened
    before = {file for file in place.rglob("*") if file.is_file()}
    _opened = []
    try:
        code = main(list(words))
    finally:
        paths, _opened = _opened, None
    assert code in (0, 1, 2)
    named = {(place / path).resolve() for path in paths}
    return sorted(str(file.relative_to(place)) for file in before if file.resolve() in named)


def files(place: Path) -> list[Path]:
    """Files of the folder, without the results of an earlier run that a new one removes or rewrites."""
    own = {"result.txt", "log.txt", "GenOpt.log", "OutputListingMain.txt", "OutputListingAll.txt"}
    return sorted(path for path in place.rglob("*") if path.name not in own)


def test_every_command_is_tried() -> None:
    names = [command.name for group in GROUPS.values() for command in group]
    assert sorted(CASES) == sorted(names)
    for name in names:
        written = {names[0] for names in options(name) if set(names) & identity.OPTIONS}
        assert written == {*CASES[name].files, *CASES[name].folder}, name
        # An option with a path is an output, or one of these inputs.
        read = {names[0] for names in options(name)} - written
        assert read <= {
            "--weather",
            "--measurements",
            "--samples",
            "--morph",
            "--ranges",
            "--project",
            "--data",
            "--compare",
        }, name


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.files])
def test_a_file_that_is_read_is_not_written(
    name: str, place: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    case = CASES[name]
    read = inputs_of(case.reads or (name, *case.words), place)
    assert read or not any("." in word for word in case.words)
    for option, ending in case.files.items():
        further = {"cost": ("--out", "result.txt")}.get(name, ()) if option == "--log" else ()
        needed = ("building",) if name == "schema" else ()
        for k, source in enumerate(read):
            content = (place / source).read_bytes()
            for how in ("hard", "soft"):
                link = place / f"{how}{k}{ending}"
                link.hardlink_to(place / source) if how == "hard" else link.symlink_to(place / source)
                before = files(place)
                capsys.readouterr()
                # `optimize` ends with 1 after every error, as GenOpt does.
                assert main([name, *needed, *case.words, option, str(link), *further]) in (1, 2)
                said = capsys.readouterr().err
                assert "input" in said or "no result of this command" in said, (option, source, said)
                assert option in said, said
                assert (place / source).read_bytes() == content
                assert link.samefile(place / source)
                assert files(place) == before  # refused before any work
                link.unlink()


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.folder])
def test_a_folder_with_an_input_where_results_go_is_refused(
    name: str, place: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    case = CASES[name]
    read = inputs_of(case.reads or (name, *case.words), place)
    assert read
    for option, files in case.folder.items():
        for k, source in enumerate(read):
            content = (place / source).read_bytes()
            for j, file in enumerate(files):
                out = place / f"out{k}-{j}"
                (out / file).parent.mkdir(parents=True)
                # The input is there, and its own name leads to it.
                (out / file).write_bytes(content)
                (place / source).unlink()
                (place / source).symlink_to(out / file)
                capsys.readouterr()
                assert main([name, *case.words, option, str(out)]) == 2, (source, file)
                said = capsys.readouterr().err
                if source not in case.late and "not empty" not in said:
                    assert "input" in said, (source, file, said)
                assert (out / file).read_bytes() == content, (source, file)
                (place / source).unlink()
                (place / source).write_bytes(content)


def test_a_name_in_other_case_and_spelling_is_the_same_file(
    place: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (place / "sub").mkdir()
    content = (place / "dsc.csv").read_bytes()
    for spelled in ("dsc.csv", "./dsc.csv", "sub/../dsc.csv", str(place / "dsc.csv")):
        assert main(["dsc", "dsc.csv", f"--out={spelled}"]) == 2
        assert f"--out: found {Path(spelled)}, which is an input (dsc.csv)" in capsys.readouterr().err
    assert (place / "dsc.csv").read_bytes() == content


def test_in_python_an_input_is_kept_until_it_is_removed(place: Path) -> None:
    climate = mc.Climate.from_epw(place / "site.epw")
    results = mc.simulate(mc.load(place / "house.yaml"), climate, step="1h", end="1995-01-02")
    (place / "site.csv").hardlink_to(place / "site.epw")
    with pytest.raises(InputError, match=r"found an input.*remove the file first"):
        results.write(place / "site.csv")
    (place / "base.csv").hardlink_to(place / "base.yaml")
    with pytest.raises(InputError, match="found an input"):
        results.write(place / "base.csv")
    (place / "site.csv").unlink()
    results.write(place / "site.csv")
    # An own file is no input, also when it was read again; results go back over results.
    mc.Results.open(place / "site.csv")
    results.write(place / "site.csv")


def test_in_python_a_description_goes_back_over_its_file(place: Path) -> None:
    house = mc.load(place / "base.yaml").replace({"zones.room.volume": 44})
    house.to_yaml(place / "base.yaml")
    assert mc.load(place / "base.yaml").parameter("zones.room.volume").value == 44


def test_a_file_in_the_place_of_a_removed_input_may_be_written(tmp_path: Path) -> None:
    first, second = tmp_path / "a", tmp_path / "b"
    first.write_text("x")
    require_regular(first)
    first.rename(second)  # the same inode under another name, as of a file that was removed and made anew
    atomic.write(second, "y")
    assert second.read_text() == "y"
