"""Effects of what is not carried over, measured in EnergyPlus: the table, and where the list states it."""

from __future__ import annotations

import csv
import json
import sys
from copy import deepcopy
from pathlib import Path
from typing import Any

import idfkit
import pytest

from mascarin.energyplus import convert, report, terminal_lines
from mascarin.energyplus.model.effects import Effect, effect_of

ROOT = Path(__file__).resolve().parents[3]
TABLE = ROOT / "python" / "mascarin" / "energyplus" / "model" / "effects.csv"
with TABLE.open(encoding="utf-8", newline="") as held:
    ROWS = {row["name"]: row for row in csv.DictReader(held)}
sys.path.insert(0, str(ROOT / "bench"))
try:
    import energyplus_effects as bench  # type: ignore[import-not-found]
finally:
    sys.path.remove(str(ROOT / "bench"))


def model_of(name: str, room: str = "small", *, ideal: bool = False) -> Any:
    """The room of a case with its object."""
    case = bench.CASES[name]
    model = deepcopy(bench.base(room, "base_ideal" if ideal else "base"))
    for change in (case.both, case.added):
        if change is not None:
            change(model)
    return model


def test_the_table_has_all_kinds_of_the_script() -> None:
    assert list(ROWS) == list(bench.CASES), "run bench/energyplus_effects.py"
    kinds = idfkit.get_schema_manager().get_schema((25, 2, 0)).object_types
    for name, row in ROWS.items():
        assert (row["class"], row["found"]) == (bench.CASES[name].kind, bench.CASES[name].what)
        assert any(kind.casefold().startswith(row["class"].casefold()) for kind in kinds)
        assert min(float(row[key]) for key in row if key.endswith(("kelvin", "other", "percent"))) >= 0.0


@pytest.mark.parametrize("name", sorted(ROWS))
def test_the_list_states_the_measured_effect(name: str, tmp_path: Path) -> None:
    row, case = ROWS[name], bench.CASES[name]
    keys = ("kelvin", "kelvin_other", "loads_percent", "loads_percent_other")
    effect = Effect(*(float(row[key]) for key in keys))
    if case.example:
        assert effect_of(case.kind, case.example) == effect
        return
    only_with_loads = float(ROWS[name]["kelvin"]) == 0.0
    file = tmp_path / "model.epJSON"
    file.write_text(json.dumps(model_of(name, ideal=only_with_loads)), encoding="utf-8")
    conversion = convert(file)
    stated = {
        finding.measured
        for finding in conversion.findings
        if finding.level != "no effect" and finding.measured
    }
    assert effect in stated, [finding.text() for finding in conversion.findings]
    assert any(effect.text() in line for line in terminal_lines(conversion))
    sizes = [entry["loads_percent"] for entry in report(conversion)["findings"]]
    assert effect.percent in sizes


def test_the_largest_effect_comes_first(tmp_path: Path) -> None:
    model = model_of("tree")
    for name in ("shading_temperature", "moisture"):
        bench.CASES[name].added(model)
    file = tmp_path / "model.epJSON"
    file.write_text(json.dumps(model), encoding="utf-8")
    lines = [line for line in terminal_lines(convert(file)) if "in a small room" in line]
    kinds = [line.split("'")[0].split(":", 1)[1].strip() for line in lines]
    assert "WindowShadingControl" in lines[0], "1.8 K by shades"
    assert kinds.index(next(kind for kind in kinds if kind.startswith("Shading"))) < len(kinds) - 1


def test_what_was_not_measured_has_no_size() -> None:
    assert effect_of("EnergyManagementSystem:Program", "not carried over") is None
