"""Formulas and constants of physics are written in the engine, once; Python has them from one module."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "python" / "mascarin"
ENGINE = ROOT / "crates" / "engine" / "src"

#: Constants by their digits: 0 degC and the triple point, Stefan and Boltzmann, gravity, ratio of the molar
#: masses of vapour and air, gas constants, specific heats of air, vapour and water, latent heats, Magnus,
#: the standard atmosphere.
CONSTANTS = {
    "27315", "27316", "567", "567037", "5670374419", "980665", "981", "622", "621945", "62198", "287055",
    "28705", "28706", "461524", "4615", "8314462618", "8314", "1006", "1860", "4186", "4182", "2501", "2830",
    "6112", "61078", "24312", "1762", "101325", "225577", "525588",
}  # fmt: skip
#: Where they may stand.
OTHERS = {
    "verification",  # closed solutions do not use what they verify
    "physics.py",
}


def digits(number: float) -> str:
    """Digits of a number without sign, point and zeros at the ends."""
    mantissa = f"{abs(number):.12e}".split("e")[0]
    return mantissa.replace(".", "").strip("0")


def constants_in(path: Path, root: Path = ROOT) -> list[str]:
    """Physical constants that stand in a file, with their lines."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return [
        f"{path.relative_to(root)}:{node.lineno}: {node.value}"
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant)
        and isinstance(node.value, int | float)
        and not isinstance(node.value, bool)
        and digits(node.value) in CONSTANTS
    ]


MODULES = sorted(path for path in PACKAGE.rglob("*.py") if path.relative_to(PACKAGE).parts[0] not in OTHERS)


def test_python_has_no_constant_of_physics_of_its_own() -> None:
    found = [line for path in MODULES for line in constants_in(path)]
    assert found == [], (
        "constants of physics outside of the engine: take them from mascarin.physics\n" + "\n".join(found)
    )


def test_constants_are_recognised(tmp_path: Path) -> None:
    file = tmp_path / "a.py"
    file.write_text("x = 273.15\ny = 5.670374419e-8 * 2.0\nz = -9.81\nw = 27.0 + 3.15\n", encoding="utf-8")
    assert [digits(number) for number in (273.15, 5.670374419e-8, -9.81, 1006)] == [
        "27315",
        "5670374419",
        "981",
        "1006",
    ]
    assert [line.rsplit(":", 2)[1] for line in constants_in(file, tmp_path)] == ["1", "2", "3"]


def test_one_module_offers_the_physics_of_the_engine() -> None:
    names = (
        "saturation_pressure|condensing_pressure|humidity_ratio|vapour_pressure|dew_point|wet_bulb|"
        "globe_temperature|standard_pressure|standard_density|moist_air|liquid_fraction|melting_reach"
    )
    word = re.compile(rf"\b_engine\.(?:{names})\b")
    users = {
        path.relative_to(PACKAGE).as_posix()
        for path in PACKAGE.rglob("*.py")
        if word.search(path.read_text(encoding="utf-8"))
    }
    assert users == {"physics.py"}


@pytest.mark.parametrize("folder", ["balance", "building", "derivatives", "linear", "run", "step", "weather"])
def test_the_engine_has_its_constants_in_physics(folder: str) -> None:
    number = re.compile(r"(?<![\w.])(?:273\.15|5\.670_?374_?419e-8|9\.80_?665|287\.055|0\.621_?945)(?![\d])")
    for path in (ENGINE / folder).rglob("*.rs"):
        code = path.read_text(encoding="utf-8").split("#[cfg(test)]")[0]
        code = re.sub(r"//[^\n]*", "", re.sub(r'"(?:[^"\\]|\\.)*"', '""', code))
        assert not number.search(code), f"{path.relative_to(ROOT)}: a constant that physics/constants.rs has"
