"""Air for which the coefficients of cracks are stated."""

from __future__ import annotations

from pathlib import Path

import pytest

from idf_samples import IDF
from mascarin.energyplus import convert

CRACK = """
AirflowNetwork:SimulationControl,Network,MultizoneWithoutDistribution,SurfaceAverageCalculation;
AirflowNetwork:MultiZone:Zone,Room,NoVent;
AirflowNetwork:MultiZone:Surface:Crack,Crack,0.01,0.65,{named};
AirflowNetwork:MultiZone:Surface,East,Crack,,1;
"""
CONDITIONS = "AirflowNetwork:MultiZone:ReferenceCrackConditions,{name},{temperature},101325,0;\n"


def findings_of(tmp_path: Path, text: str) -> list[str]:
    """What is said of cracks and their conditions."""
    (tmp_path / "model.idf").write_text(IDF + text, encoding="utf-8")
    conversion = convert(tmp_path / "model.idf")
    assert len(conversion.building.vents) == 1
    return [f"{f.level}: {f.what}" for f in conversion.findings if "Crack" in f.kind]


@pytest.mark.parametrize("named", ["", "Cold"])
def test_the_only_conditions_are_those_of_all_cracks(tmp_path: Path, named: str) -> None:
    text = CRACK.format(named=named) + CONDITIONS.format(name="Cold", temperature=0)
    assert findings_of(tmp_path, text) == ["approximated: a crack measured with air of 0 degC and 101325 Pa"]


def test_usual_conditions_need_no_word(tmp_path: Path) -> None:
    text = CRACK.format(named="") + CONDITIONS.format(name="Usual", temperature=20)
    assert findings_of(tmp_path, text) == []


def test_of_several_conditions_only_named_ones_count(tmp_path: Path) -> None:
    both = "".join(CONDITIONS.format(name=f"Air {k}", temperature=k) for k in (0, 5))
    assert not [line for line in findings_of(tmp_path, CRACK.format(named="") + both) if "measured" in line]
