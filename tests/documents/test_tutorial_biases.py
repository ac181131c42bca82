"""The tutorial of a wall, typed as it is, with sensors that are wrong by what their data sheets allow."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mascarin import cli
from test_docs import ROOT, blocks

PAGE = ROOT / "docs" / "your-own-wall.md"
SENSORS = {"joint": 0.2, "core": 0.3}
"""Expanded uncertainty of each column. [K]"""


def typed(folder: Path, biases: dict[str, float], seed: int) -> tuple[dict[str, Any], dict[str, float]]:
    """Calibrate the wall of the page; its results, and the truth that the page names."""
    code = {}
    for block in blocks(PAGE):
        if "file" in block.marks:
            (folder / block.marks["file"]).write_text(block.text, encoding="utf-8")
        elif block.language == "python":
            code[block.text[:12]] = block.text
    table = next(text for text in code.values() if "logger.csv" in text)
    assert table.count("default_rng(7)") == table.count("core, joint = (np.array(seen) + noise).T\n") == 1
    planted = f"core, joint = core + {biases['core']!r}, joint + {biases['joint']!r}\n"
    line = "core, joint = (np.array(seen) + noise).T\n"
    table = table.replace("default_rng(7)", f"default_rng({seed})").replace(line, line + planted)
    exec(compile(table, str(PAGE), "exec"), {})  # noqa: S102 (the page is our own)
    names: dict[str, Any] = {}
    truth = next(text for text in code.values() if text.startswith("truth = "))
    exec(truth[: truth.index("}") + 1], names)  # noqa: S102
    cli.main(["calibrate", "study.yaml", "-o", "out"])
    return json.loads((folder / "out" / "calibration.json").read_text(encoding="utf-8")), names["truth"]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_truth_of_the_tutorial_is_in_every_interval_beside_planted_biases(
    seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    rng = np.random.default_rng(seed)
    signs = rng.choice([-1.0, 1.0], size=2)
    # Between half of the expanded uncertainty and nearly all of it: what a data sheet allows.
    biases = {
        name: float(sign * rng.uniform(0.5, 0.9) * limit)
        for sign, (name, limit) in zip(signs, SENSORS.items(), strict=True)
    }
    content, truth = typed(tmp_path, biases, seed)
    for path, value in truth.items():
        entry = content["parameters"][path]
        assert entry["low"] < value < entry["high"], (path, entry["low"], entry["high"])
        assert entry.get("stated", True), path
    for name, column in (("joint", "joint"), ("middle", "core")):
        found = content["sensor_errors"][f"{name} offset"]
        away = abs(found["estimate"] - biases[column])
        assert away < 1.96 * found["standard_uncertainty"], (name, biases[column], found)
    assert not [one for one in content["contradictions"] if one["factor"] > 1.0]
