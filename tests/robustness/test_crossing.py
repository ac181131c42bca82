"""Every feature of a building at every entrance: it runs, or physics forbids it and the reason is said.

Features are in `crossing_features`, entrances in `crossing_entrances`. Rows and columns are compared with the
registries: sections of the description, kinds of outputs, commands. What a run warns of is compared with
what the other entrances say.
"""

from __future__ import annotations

import copy
import re
from pathlib import Path
from typing import Any, Final

import pytest

from crossing_entrances import (
    COMMANDS,
    ENTRANCES,
    WITHOUT_BUILDING,
    WITHOUT_RUN,
    Bench,
    enter,
    run,
)
from crossing_features import FEATURES, building, description
from mascarin.building.outputs.kinds import KINDS
from mascarin.building.parts.description import Description
from mascarin.cli import GROUPS

#: Pairs that physics forbids: by feature and entrance, words of the reason that is said.
FORBIDDEN: Final[dict[tuple[str, str], str]] = {
    (
        "boundaries and densities",
        "linear model",
    ): "infiltration of zone room, that a density, a schedule or a control changes is not linear",
    ("stratified air", "linear model"): "stratified air",
    ("products", "linear model"): "phase change",
    ("own curves", "linear model"): "phase change",
    ("hysteresis", "linear model"): "phase change",
    ("supercooling", "linear model"): "phase change",
    ("humidity", "linear model"): "heating or cooling",
    ("vents", "linear model"): "vent casement is not linear",
    ("fans in vents", "linear model"): "vent casement is not linear",
    (
        "controls",
        "linear model",
    ): "infiltration of zone room, that a density, a schedule or a control changes",
    ("heat sources", "linear model"): "heat source mat is not linear",
    ("openings", "linear model"): "opening slit is not linear",
    ("blinds", "linear model"): "window pane is not linear",
    ("loads", "linear model"): "heating or cooling",
    ("interior windows", "linear model"): "is not linear",
    ("mechanical air", "linear model"): "is not linear",
    ("laws as text", "linear model"): "conductivity by temperature",
    ("measured columns", "design"): "weather files, which have no measurements",
    ("column errors", "design"): "weather files, which have no measurements",
}


# --- rows and columns join by themselves --------------------------------------------------------------------


def test_every_section_and_output_kind_belongs_to_a_feature() -> None:
    sections: set[str] = set()
    kinds: set[str] = set()
    for feature in FEATURES:
        described = building(feature)
        sections |= described.model_fields_set
        kinds |= {output.kind for output in described.outputs()}
    missing = sorted(set(Description.model_fields) - sections)
    assert missing == [], (
        f"sections of a building that no feature has: {missing}. Add a feature with them to FEATURES in "
        "crossing_features.py"
    )
    missing = sorted(set(KINDS) - kinds)
    assert missing == [], (
        f"kinds of outputs that no feature gives: {missing}. Add a feature with them to FEATURES in "
        "crossing_features.py"
    )


def test_every_command_is_crossed() -> None:
    names = {command.name for commands in GROUPS.values() for command in commands}
    missing = sorted(names - set(COMMANDS) - set(WITHOUT_BUILDING))
    assert missing == [], (
        f"commands that are not crossed with the features: {missing}. Write a driver that calls the command "
        "with the files of a Bench, and enter it in COMMANDS of crossing_entrances.py; or enter the "
        "command in WITHOUT_BUILDING with the reason why it takes no building"
    )
    assert set(COMMANDS) | set(WITHOUT_BUILDING) == names
    assert not set(COMMANDS) & set(WITHOUT_BUILDING)


# --- pairs --------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module", params=list(FEATURES))
def bench(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Bench:
    """The files of a feature, which its entrances share."""
    folder = tmp_path_factory.mktemp("crossing") / str(request.param).replace(" ", "_")
    return Bench(folder, description(request.param))


@pytest.mark.parametrize("entrance", list(ENTRANCES))
def test_a_feature_runs_at_an_entrance_or_the_reason_is_said(
    bench: Bench, entrance: str, request: pytest.FixtureRequest
) -> None:
    feature = request.node.callspec.params["bench"]
    told = enter(entrance, bench)
    reason = FORBIDDEN.get((feature, entrance))
    if reason is None:
        assert told.code in (0, 1), f"{feature} at {entrance}: {told.text[-2000:]}"
        assert "Traceback" not in told.text
    else:
        assert told.code == 2, f"{feature} at {entrance} is not refused; take it out of FORBIDDEN"
        assert reason in told.text


# --- steps that are chosen ----------------------------------------------------------------------------------

#: Entrances that need steps of one length, with words of the reason.
OF_ONE_LENGTH: Final = {
    "fmu": "expected one length",
    "page": "expected one length",
    "view": "expected one length",
}


@pytest.fixture(scope="module")
def chosen(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    """The files of a room whose steps are chosen."""
    folder = tmp_path_factory.mktemp("chosen") / "room"
    return Bench(folder, description("loads"), step="auto 0.5K every 1h")


@pytest.mark.parametrize("entrance", list(ENTRANCES))
def test_chosen_steps_run_at_an_entrance_or_the_reason_is_said(chosen: Bench, entrance: str) -> None:
    told = enter(entrance, chosen)
    if entrance in OF_ONE_LENGTH:
        assert told.code == 2, told.text[-2000:]
        assert OF_ONE_LENGTH[entrance] in " ".join(told.text.split())
    elif entrance == "linear model":
        assert told.code == 2  # a zone that is heated; the model has no steps
    else:
        assert told.code in (0, 1), f"{entrance}: {told.text[-3000:]}"
        assert "Traceback" not in told.text


# --- warnings -----------------------------------------------------------------------------------------------

#: Warnings of a run by their words, whoever says them: a run says "the energy balance does not close", an
#: ensemble "the energy balance of 1 of 3 members does not close".
SAID: Final[dict[str, str]] = {
    "long step": r"time step of [\d.]+ min is too long",
    "unmelted layer": r"stayed (solid|liquid)",
    "open balance": r"energy balance (does|of .{0,40}do(es)?) not close",
    "open vapour balance": r"vapour balance (does|of .{0,40}do(es)?) not close",
    "no sorption data": r"no sorption data",
    "implausible surfaces": r"cannot enclose",
    "saturated air": r"(was|were) saturated",
}


#: Warnings of the run of `_light` by its scheme.
EXPECTED: Final = {
    "sdirk2": {"long step", "unmelted layer", "saturated air"},
    "apparent-capacity": {"open balance", "saturated air"},
}
#: Entrances that do not offer the scheme that closes no balance.
WITHOUT_OPEN_SCHEME: Final = ("design",)


def _light(scheme: str) -> dict[str, Any]:
    """A room whose run warns: of sheet, with vapour, and a layer that melts far away or in every hour."""
    tree = copy.deepcopy(description("humidity"))
    del tree["zones"]["room"]["heating"], tree["zones"]["room"]["cooling"]
    tree["materials"]["board"] |= {"density": 100, "conductivity": 1}
    tree["constructions"]["wall"]["layers"][0]["thickness"] = 0.002
    tree["zones"]["room"]["gains"] = {"stove": {"power": 4000, "schedule": "cooking"}}
    tree["schedules"] = {"cooking": {"kind": "fraction", "days": {"all": [
        {"at": "00:00", "value": 0}, {"at": "04:00", "value": 1}, {"at": "05:00", "value": 0},
        {"at": "09:00", "value": 1}, {"at": "10:00", "value": 0}, {"at": "14:00", "value": 1},
        {"at": "15:00", "value": 0}]}}}  # fmt: skip
    del tree["humidity"]["materials"]
    tree["humidity"]["zones"]["room"] = {"gains": {"bath": {"rate": 0.002}}}
    melts = 28 if scheme == "apparent-capacity" else 60
    tree["materials"]["pcm"] = {
        "kind": "pcm", "conductivity": 0.2, "density": 900, "specific_heat": 2000, "latent_heat": 150000,
        "melting_temperature": melts, "law": {"kind": "linear", "width": 0.5},
    }  # fmt: skip
    tree["constructions"]["wall"]["layers"].append({"material": "pcm", "thickness": 0.003})
    return tree


@pytest.fixture(scope="module", params=["sdirk2", "apparent-capacity"])
def warned(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Bench:
    """The files of a room whose run warns."""
    return Bench(tmp_path_factory.mktemp("warned") / "room", _light(request.param), scheme=request.param)


@pytest.fixture(scope="module")
def expected(warned: Bench) -> set[str]:
    """Kinds of warnings of its run."""
    return kinds_in(run(warned).text)


def kinds_in(text: str) -> set[str]:
    """Kinds of warnings that a text has."""
    return {kind for kind, words in SAID.items() if re.search(words, " ".join(text.split()))}


def test_every_warning_of_a_run_is_known(warned: Bench) -> None:
    lines = warned.simulation().run().warnings
    assert lines
    for line in lines:
        assert kinds_in(line), f"a warning whose words are not in SAID of test_crossing.py: {line}"
    assert kinds_in("\n".join(lines)) >= EXPECTED[warned.scheme]


@pytest.mark.parametrize("entrance", [name for name in ENTRANCES if name not in WITHOUT_RUN])
def test_warnings_of_a_run_are_given_at_every_entrance(
    warned: Bench, expected: set[str], entrance: str
) -> None:
    assert expected >= EXPECTED[warned.scheme]
    told = enter(entrance, warned)
    if warned.scheme == "apparent-capacity" and entrance in WITHOUT_OPEN_SCHEME:
        assert told.code == 2
        assert "scheme" in told.text
        return
    assert told.code in (0, 1), told.text[-2000:]
    assert expected - kinds_in(told.text) == set()


def test_entrances_without_a_run_say_why() -> None:
    assert set(WITHOUT_RUN) <= set(ENTRANCES)


def test_files_of_a_bench_are_those_of_a_user(tmp_path: Path) -> None:
    bench = Bench(tmp_path / "x", description("nothing"))
    assert bench.command("check", bench.file("building.yaml")).code == 0
    assert bench.file("logger.csv").is_file()
