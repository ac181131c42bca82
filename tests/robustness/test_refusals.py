"""Inputs that must end in a refusal with numbers and a place, never in a raw exception or an abort."""

from __future__ import annotations

import errno
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from building_samples import ROOM
from ensemble_support import panicking
from fuzz_readers import epw_text, tmy_text
from mascarin import _engine
from mascarin._io import memory
from mascarin.cli import main
from mascarin.errors import InputError
from study_support import BUILDING, STUDY, drivers

posix = pytest.mark.skipif(sys.platform == "win32", reason="POSIX systems")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A building and a weather file."""
    place = tmp_path_factory.mktemp("inputs")
    (place / "site.epw").write_text(epw_text(), encoding="utf-8")
    (place / "room.yaml").write_text(ROOM, encoding="utf-8")
    return place


def refused(words: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    """The message of a command that must end with exit code 2."""
    code = main(words)
    said = capsys.readouterr().err
    assert code == 2, said
    return said


YAML = {
    "a tag on a wrong text": ("volume: 30", "volume: !!int abc", "the tag 'int' on the text 'abc'"),
    "a truth value that is none": ("volume: 30", "volume: !!bool 7", "the tag 'bool' on the text '7'"),
    "a float that is none": ("volume: 30", "volume: !!float x", "the tag 'float' on the text 'x'"),
    "a tag of Python": ("volume: 30", "volume: !!python/name:os.system 1", "found: the tag"),
    "400 digits": ("volume: 30", "volume: " + "9" * 400, "a whole number of 400 digits"),
    "5000 digits": ("volume: 30", "volume: " + "9" * 5000, "a whole number of 5000 digits"),
    "30 digits": ("altitude: 100", "altitude: 1" + "0" * 30, "expected"),
    "half a pair": ("name: room", 'name: "\\ud800"', "half of a surrogate pair"),
    "half a pair in a key": ("  concrete:", '  "\\ud800":', "half of a surrogate pair"),
    "no letter": ("name: room", 'name: "\\U00ffffff"', "text that is no YAML"),
    "a list for a word": ("timezone: Europe/Paris", "timezone: [Europe, Paris]", "expected"),
    "a list for a terrain": (
        "timezone: Europe/Paris", "timezone: Europe/Paris, wind: {terrain: [city]}", "expected",
    ),
    "a mapping for a name": ("name: room", "name: {a: 1}", "expected"),
    "3000 brackets": ("volume: 30", "volume: " + "[" * 3000 + "]" * 3000, "inside each other"),
    "3000 braces": ("volume: 30", "volume: " + "{a: " * 3000 + "1" + "}" * 3000, "inside each other"),
    "60 brackets": ("volume: 30", "volume: " + "[" * 60 + "]" * 60, "inside each other more than 50 times"),
}  # fmt: skip


@pytest.mark.parametrize("case", YAML)
def test_a_description_is_refused_with_its_line(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before, after, said = YAML[case]
    assert ROOM.count(before) == 1
    file = tmp_path / "room.yaml"
    file.write_text(ROOM.replace(before, after), encoding="utf-8")
    text = refused(["check", str(file)], capsys)
    assert said in text
    assert "room.yaml:" in text


def test_a_conductivity_of_almost_nothing_ends_in_a_mesh_or_a_refusal(
    tmp_path: Path,
) -> None:
    file = tmp_path / "room.yaml"
    file.write_text(ROOM.replace("conductivity: 1.75", "conductivity: 1e-300"), encoding="utf-8")
    assert main(["check", str(file)]) in (0, 2)


RUNS = {
    "a year of seconds": (
        ["--step", "1s"],
        r"3.15e\+07 steps, which would take 31.5 GB of memory.*step of 1.58 s",
    ),
    "a step of nothing": (["--step", "1e-300"], r"from 1e-06 s to"),
    "a step of ages": (["--step", "1e300h"], r"to 1.2649e\+10 s"),
    "the year 0": (["--start", "0000-01-01"], r"0000-01-01"),
    "the year 1500": (["--start", "1500-01-01"], r"in the year 1500; expected one from 1800 to 2200"),
    "the year 9999": (["--end", "9999-12-31 23:59"], r"in the year 9999"),
}


@pytest.mark.parametrize("case", RUNS)
def test_a_run_is_refused_with_numbers(case: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options, said = RUNS[case]
    words = ["run", str(folder / "room.yaml"), "--weather", str(folder / "site.epw"), *options]
    assert re.search(said, refused(words, capsys))


def test_more_members_than_memory_holds_are_refused(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [
        "sweep",
        str(folder / "room.yaml"),
        "--weather",
        str(folder / "site.epw"),
        "-o",
        str(tmp_path / "s"),
    ]
    text = refused(
        [
            *words,
            "--draw",
            "99999999999",
            "--vary",
            "zones.room.volume",
            "--objective",
            "max:room.air_temperature",
        ],
        capsys,
    )
    # One number of eight bytes for each member, four times.
    assert "99999999999 members of 1 parameters would take 3.2 TB of memory" in text
    assert "draw fewer members" in text
    assert not (tmp_path / "s").exists()


def test_a_limit_of_the_process_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "available", lambda: 10 * 10**9)
    memory.require(8e9, "x", "y")
    with pytest.raises(InputError, match=r"x would take 8.1 GB of memory, but 10 GB are free, .* 80 %; y"):
        memory.require(8.1e9, "x", "y")


@pytest.mark.skipif(sys.platform != "linux", reason="limits of Linux")
def test_a_run_under_a_limit_of_memory_is_refused_and_does_not_abort(folder: Path) -> None:
    code = (
        "import resource, sys; from mascarin.cli import main\n"
        "resource.setrlimit(resource.RLIMIT_AS, (3 * 2**30, 3 * 2**30)); sys.exit(main(sys.argv[1:]))"
    )
    words = ["run", str(folder / "room.yaml"), "--weather", str(folder / "site.epw"), "--step", "2s"]
    ended = subprocess.run(
        [sys.executable, "-c", code, *words], capture_output=True, text=True, check=False,
        env={**os.environ, "RAYON_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
    )  # fmt: skip
    assert ended.returncode == 2, ended.stderr
    assert "would take 3.78 GB of memory" in ended.stderr


THICK = "      - {name: l%d, material: concrete, thickness: 0.02, nodes: 1000}\n"
LIMITED = """
import resource, sys
from mascarin.building import load
from mascarin.errors import InputError
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate
resource.setrlimit(resource.RLIMIT_AS, (3 * 2**30, 3 * 2**30))
building, climate = load(sys.argv[1]), Climate.from_epw(sys.argv[2])
try:
    Simulation(building, climate, step="1h", end="1995-01-01 01:00", initial=10.0).run()
except InputError as error:
    sys.exit(0 if "of memory" in str(error) else str(error))
"""


@pytest.mark.skipif(sys.platform != "linux", reason="limits of Linux")
def test_a_wall_of_ten_thousand_nodes_needs_linear_memory_or_is_refused(folder: Path, tmp_path: Path) -> None:
    text = ROOM.replace(
        "      - {material: concrete, thickness: 0.2}\n", "".join(THICK % k for k in range(10))
    )
    (tmp_path / "thick.yaml").write_text(text, encoding="utf-8")
    ended = subprocess.run(
        [sys.executable, "-c", LIMITED, str(tmp_path / "thick.yaml"), str(folder / "site.epw")],
        capture_output=True, text=True, check=False,
        env={**os.environ, "RAYON_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr


@posix
def test_pipes_and_devices_are_refused_as_inputs(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pipe = tmp_path / "pipe.epw"
    os.mkfifo(pipe)
    assert "found a named pipe" in refused(["check", str(pipe)], capsys)
    assert "found a device" in refused(["check", "/dev/zero"], capsys)
    assert "found a named pipe" in refused(["dsc", str(pipe)], capsys)
    words = ["run", str(folder / "room.yaml"), "--weather"]
    assert "found a named pipe" in refused([*words, str(pipe)], capsys)
    (tmp_path / "pipe.csv").symlink_to(pipe)
    words += [str(folder / "site.epw")]
    sweep = ["sweep", *words[1:], "-o", str(tmp_path / "out"), "--objective", "max:room.air_temperature"]
    assert "found a named pipe" in refused([*sweep, "--samples", str(tmp_path / "pipe.csv")], capsys)


TMY = {
    "a year of many digits": (
        "01/01/1995,01:00",
        "01/01/" + "9" * 30 + ",01:00",
        "site.csv:3: date and time are",
    ),
    "an hour of many digits": (
        "01/01/1995,01:00",
        "01/01/1995," + "9" * 30 + ":00",
        "site.csv:3: date and time",
    ),
    "no month": (
        "01/01/1995,02:00",
        "13/01/1995,02:00",
        "site.csv:4: found 13/1 hour 2, expected 1/1 hour 2",
    ),
    "a zone far away": (
        "CO,-7.0",
        "CO,1e300",
        "site.csv:1: time zone is '1e300', expected a number within 14",
    ),
    "no place": ("39.830", "nan", "site.csv:1: latitude is 'nan'"),
}


@pytest.mark.parametrize("case", TMY)
def test_a_damaged_tmy3_file_names_the_line(case: str, tmp_path: Path) -> None:
    from mascarin.weather import Climate

    before, after, said = TMY[case]
    file = tmp_path / "site.csv"
    file.write_text(tmy_text().replace(before, after, 1), encoding="utf-8")
    with pytest.raises(InputError) as error:
        Climate.from_tmy(file)
    assert said in str(error.value)


@pytest.mark.parametrize("year", ["0000", "1500", "-0", "9999"])
def test_stamps_of_impossible_years_name_the_line(year: str, tmp_path: Path) -> None:
    from mascarin.weather import Measurements

    file = tmp_path / "logger.csv"
    rows = [f"2024-09-04 00:{k:02d}:00;20.{k}" for k in range(10)]
    rows[4] = f"{year}-09-04 00:04:00;20.4"
    file.write_text("\n".join(["time;a", *rows]) + "\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"logger\.csv:6: "):
        Measurements.from_table(file, timezone="UTC")


def test_calorimeter_numbers_that_overflow_are_refused_with_their_row(tmp_path: Path) -> None:
    from mascarin.materials.dsc import from_dsc

    rows = [f"{10 + k},{2 + 80 * (12 < k < 16)},2" for k in range(30)]
    rows[3] = "13,2,-1e308"
    file = tmp_path / "a.csv"
    file.write_text("temperature [degC],cp heating [J/(g K)],cp cooling [J/(g K)]\n" + "\n".join(rows))
    with pytest.raises(InputError, match=r"row 5, column 'cp cooling \[J/\(g K\)\]': found '-1e308'"):
        from_dsc(file)


STUDIES = {
    "replicates": ("replicates: 3", "replicates: 99999999999", "expected at most 1000"),
    "samples": ("replicates: 3", "replicates: 3, samples: 99999999999", "expected at most 1e+08"),
    "order": ("replicates: 3", "replicates: 3, order: 99999999999", "expected at most 1e+08"),
}


@pytest.mark.parametrize("case", STUDIES)
def test_a_study_of_more_runs_than_anybody_has_time_for(case: str, tmp_path: Path) -> None:
    from mascarin.study import Study

    before, after, said = STUDIES[case]
    _study(tmp_path, STUDY.replace(before, after))
    with pytest.raises(InputError) as error:
        Study.from_yaml(tmp_path / "study.yaml")
    assert said in str(error.value)
    assert "study.yaml:" in str(error.value)


def _study(folder: Path, text: str) -> Path:
    folder.mkdir(exist_ok=True)
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (folder / "study.yaml").write_text(text, encoding="utf-8")
    table = drivers(9)
    table["joint"] = table["core"] = table["room"]
    table.to_csv(folder / "logger.csv", lineterminator="\n")
    return folder / "study.yaml"


@pytest.mark.parametrize("way", ["above", "absolute", "link", "extends"])
def test_a_study_reads_no_file_outside_its_folder(
    way: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("MASCARIN_DATA", raising=False)
    (tmp_path / "secret.yaml").write_text("password: swordfish\n", encoding="utf-8")
    inside = tmp_path / "study"
    named = {
        "extends": "building.yaml",
        "above": "../secret.yaml",
        "absolute": str(tmp_path / "secret.yaml"),
        "link": "building.yaml",
    }[way]
    study = _study(inside, STUDY.replace("building: building.yaml", f"building: {named}"))
    if way == "link":
        (inside / "building.yaml").unlink()
        (inside / "building.yaml").symlink_to(tmp_path / "secret.yaml")
    if way == "extends":
        (inside / "building.yaml").write_text("extends: ../secret.yaml\n", encoding="utf-8")
    text = refused(["validate", str(study)], capsys)
    assert "outside the folder of the study" in text
    assert "--allow-outside" in text
    assert "swordfish" not in text
    assert "password" not in text
    text = refused(["validate", str(study), "--allow-outside"], capsys)
    assert "outside the folder" not in text
    missing = STUDY.replace("building: building.yaml", "building: ../nothing.yaml")
    text = refused(["validate", str(_study(inside / "b", missing))], capsys)
    assert "outside the folder of the study" in text  # whether it exists is not said


@pytest.mark.parametrize(("name", "said"), [("a" * 5000, "a" * 60), ('"a\\0b"', "expected that of a file")])
def test_a_name_that_no_file_has_is_refused(name: str, said: str, tmp_path: Path) -> None:
    from mascarin.study import Study

    with pytest.raises(InputError, match=r"study.yaml:\d+: ") as error:
        Study.from_yaml(_study(tmp_path, STUDY.replace("building: building.yaml", f"building: {name}")))
    assert said in str(error.value)
    assert len(str(error.value)) < 1000


def test_a_shipped_climate_is_inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from mascarin.study import Study

    monkeypatch.delenv("MASCARIN_DATA", raising=False)
    text = re.sub(r"climate:.*?(?=^\w)", "climate: {epw: shipped:tampa}\n", STUDY, flags=re.S | re.M)
    assert text != STUDY
    study = _study(tmp_path / "study", text)
    with pytest.raises(InputError) as error:  # the table is of another year
        Study.from_yaml(study)
    assert "outside the folder" not in str(error.value)


def test_the_data_folder_may_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from mascarin.study import Study

    study = _study(tmp_path / "study", STUDY.replace("table: logger.csv", "table: ../data/logger.csv"))
    (tmp_path / "data").mkdir()
    (tmp_path / "study" / "logger.csv").rename(tmp_path / "data" / "logger.csv")
    monkeypatch.delenv("MASCARIN_DATA", raising=False)
    with pytest.raises(InputError, match="outside the folder"):
        Study.from_yaml(study)
    assert Study.from_yaml(study, allow_outside=True).building.name == "Test wall"
    monkeypatch.setenv("MASCARIN_DATA", str(tmp_path / "data"))
    assert Study.from_yaml(study).building.name == "Test wall"


@pytest.mark.parametrize("border", [False, True])
def test_a_panic_is_a_defect_wherever_it_happens(
    border: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import mascarin.commands.studies.schema as commands

    def broken(*words: object) -> None:
        _engine._panic("index 7 of 3", border)

    monkeypatch.setattr(commands, "json_text", broken)
    assert main(["schema"]) == 70
    assert "index 7 of 3" in capsys.readouterr().err


def test_a_panic_in_a_worker_is_a_defect(folder: Path) -> None:
    """It is not sent again three times and then called a failure of the solver."""
    from mascarin.building import load
    from mascarin.ensemble import sweep
    from mascarin.weather import Climate

    with pytest.raises(_engine.EngineDefect, match="a defect of the engine"):
        sweep(
            load(folder / "room.yaml"), Climate.from_epw(folder / "site.epw"),
            {"zones.room.volume": [30.0, 40.0]}, outputs=["room.air_temperature"],
            objectives={"x": panicking}, end="1995-01-02", workers=1,
        )  # fmt: skip


def test_a_full_disk_is_no_defect(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import mascarin.commands.studies.schema as commands

    def full(*words: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(commands, "json_text", full)
    assert "Make room on the disk" in refused(["schema"], capsys)


def test_no_memory_is_no_defect(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    import mascarin.commands.studies.schema as commands

    def huge(*words: object) -> None:
        raise MemoryError("Unable to allocate 7 GiB")

    monkeypatch.setattr(commands, "json_text", huge)
    said = refused(["schema"], capsys)
    assert "Unable to allocate 7 GiB" in said
    assert "longer step" in said


@pytest.mark.skipif(sys.platform != "linux", reason="/dev/full of Linux")
def test_standard_output_on_a_full_disk() -> None:
    with Path("/dev/full").open("w") as full:
        ended = subprocess.run(
            [sys.executable, "-m", "mascarin.cli", "schema"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert ended.returncode == 2
    assert "No space left on device" in ended.stderr
    assert "Traceback" not in ended.stderr
