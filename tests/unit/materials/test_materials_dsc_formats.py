"""Exports of calorimeters as instruments write them: signatures, segments, holds, mass and sign."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from dsc_samples import heat, temperatures, write
from mascarin import cli, from_dsc
from mascarin.errors import InputError
from mascarin.materials.dsc import DscMaterial

FILES = Path(__file__).parents[2] / "data" / "calorimeters"


def is_the_wax(material: DscMaterial, run: int = 0, centre: float = 24.0) -> None:
    """150 kJ/kg, 2.0 and 2.4 J/(g K), half molten at the centre, tangents 1.22 K beside it."""
    found = material.runs[run]
    assert found.latent_heat == pytest.approx(150000.0, abs=60.0)
    assert found.specific_heat == pytest.approx((2000.0, 2400.0), abs=1.0)
    assert (found.onset, found.peak, found.end) == pytest.approx(
        (centre - 1.22, centre, centre + 1.22), abs=0.02
    )
    assert found.rate == pytest.approx(0.5, abs=1e-9)


@pytest.mark.parametrize(
    "name", ["mettler.txt", "mettler_tab.txt", "ta_universal.txt", "trios.csv", "netzsch_heat.csv"]
)
def test_exports_are_read_as_they_are(name: str) -> None:
    is_the_wax(from_dsc(FILES / name))


def test_the_mass_of_the_file_is_used_and_another_one_is_refused() -> None:
    is_the_wax(from_dsc(FILES / "mettler.txt", mass=10.0))
    with pytest.raises(InputError, match=r"mass=12 mg, but the file states 10 mg.*Leave the mass out"):
        from_dsc(FILES / "mettler.txt", mass=12.0)


def test_the_stated_sign_is_no_guess() -> None:
    assert not any("sign changed" in text for text in from_dsc(FILES / "netzsch_heat.csv").warnings)
    assert any("sign changed" in text for text in from_dsc(FILES / "mettler.txt").warnings)


def test_a_sign_against_the_peak_is_said(tmp_path: Path) -> None:
    text = (FILES / "netzsch_heat.csv").read_bytes().replace(b"#EXO:1", b"#EXO:-1")
    (tmp_path / "a.csv").write_bytes(text)
    material = from_dsc(tmp_path / "a.csv")
    is_the_wax(material)
    assert any("points down, but the peak points the other way" in text for text in material.warnings)


def test_two_heatings_are_refused_and_one_can_be_named() -> None:
    with pytest.raises(InputError, match=r"2 runs of heating; expected one. Name the segment.*--segment 5"):
        from_dsc(FILES / "netzsch_all.csv")
    second = from_dsc(FILES / "netzsch_all.csv", segments=[5])
    assert [run.direction for run in second.runs] == ["heating"]
    is_the_wax(second)
    both = from_dsc(FILES / "netzsch_all.csv", segments=["2", "4"])
    assert [run.direction for run in both.runs] == ["heating", "cooling"]
    is_the_wax(both)
    is_the_wax(both, run=1, centre=21.5)
    with pytest.raises(InputError, match=r"segment: found '7'; expected one of 1, 2, 3, 4, 5"):
        from_dsc(FILES / "netzsch_all.csv", segments=[7])
    with pytest.raises(InputError, match="no column of segments; expected none"):
        from_dsc(FILES / "trios.csv", segments=[2])
    with pytest.raises(InputError, match="only segments at a constant temperature"):
        from_dsc(FILES / "netzsch_all.csv", segments=[1, 3])


def test_a_segment_on_the_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["dsc", str(FILES / "netzsch_all.csv"), "--segment", "5"]) == 0
    assert "latent heat    150.0 kJ/kg" in capsys.readouterr().out
    assert cli.main(["dsc", str(FILES / "netzsch_all.csv")]) == 2


def test_holds_before_and_after_are_left_out() -> None:
    material = from_dsc(FILES / "netzsch_s123_noseg.csv")
    is_the_wax(material)
    assert any("rows at a constant temperature were left out" in text for text in material.warnings)


def test_a_hold_between_heating_and_cooling(tmp_path: Path) -> None:
    t = temperatures()
    hold = t[-1] + 1e-4 * np.random.default_rng(1).normal(size=60)
    course = np.concatenate([t, hold, t[::-1]])
    flow = np.concatenate([heat(t), 0.0 * hold, heat(t[::-1], 21.5)]) * 0.25 / 60.0 / 1000.0
    time = np.arange(len(course)) * 0.05 / 0.25
    columns = {"temperature [degC]": course, "time [min]": time, "heat flow [W/g]": flow}
    material = from_dsc(write(tmp_path / "a.csv", columns))
    assert [run.direction for run in material.runs] == ["heating", "cooling"]
    for run, centre in zip(material.runs, (24.0, 21.5), strict=True):
        assert run.latent_heat == pytest.approx(150000.0, rel=2e-3)
        assert run.peak == pytest.approx(centre, abs=0.06)


def test_a_supercooled_run_is_named(tmp_path: Path) -> None:
    """The sample cools to 19 degC, jumps to 21.4 degC as it freezes, and cools on."""
    t = temperatures()[::-1]
    course = np.where((t < 21.5) & (t > 19.0), t, t)
    start = int(np.argmax(course < 19.0))
    course[start : start + 40] = np.linspace(19.0, 21.4, 40)
    course[start + 40 :] = np.linspace(21.4, 10.0, len(course) - start - 40)
    flow = -np.abs(heat(course, 21.4)) * 0.25 / 60.0 / 1000.0
    time = np.arange(len(course)) * 0.2
    labels = np.full(len(course), 2.0)
    columns = {"temperature [degC]": course, "time [min]": time, "heat flow [W/g]": flow, "segment": labels}
    material = from_dsc(write(tmp_path / "a.csv", columns))
    assert any("temperature rises by 2.4 K from 19.0" in text for text in material.warnings)


def test_a_cut_export_of_universal_analysis(tmp_path: Path) -> None:
    text = (FILES / "ta_universal.txt").read_bytes().decode("utf-16")
    (tmp_path / "cut.txt").write_text(text[: text.index("Sig1")] + text[text.index("StartOfData") :])
    with pytest.raises(InputError, match=r"found 0 signals in the head .*Export the file again"):
        from_dsc(tmp_path / "cut.txt")
