"""Glass by wavelength: the schema numbers the first four wavelengths, and groups the others."""

from __future__ import annotations

from pathlib import Path

import idfkit
import pytest

from mascarin.energyplus import convert

BASE = Path(__file__).resolve().parents[2] / "idf_small" / "base.idf"
#: Visible light passes, the rest of the sun does not.
GLASS = """
WindowMaterial:Glazing,by wavelength,Spectral,table,0.006,,,,,,,0,0.84,0.84,0.9;
MaterialProperty:GlazingSpectralData,table,
  0.3,0.8,0.1,0.1, 0.5,0.8,0.1,0.1, 0.6,0.8,0.1,0.1, 0.7,0.8,0.1,0.1,
  0.71,0.2,0.1,0.1, 1.0,0.2,0.1,0.1, 2.0,0.2,0.1,0.1, 2.5,0.2,0.1,0.1;
"""


@pytest.fixture
def text() -> str:
    """The plain room with this glass."""
    plain = BASE.read_text(encoding="utf-8")
    assert "Construction,glazing,glass;" in plain
    return plain.replace("Construction,glazing,glass;", "Construction,glazing,by wavelength;") + GLASS


@pytest.mark.parametrize("suffix", ["idf", "epJSON"])
def test_all_wavelengths_count(tmp_path: Path, text: str, suffix: str) -> None:
    """By Planck's law at 5800 K, 0.49 of the sun from 0.3 to 2.5 um is below 0.7 um (blackbody functions)."""
    file = tmp_path / "model.idf"
    file.write_text(text, encoding="utf-8")
    if suffix == "epJSON":
        held = idfkit.write_epjson(idfkit.load_idf(str(file)))
        file = tmp_path / "model.epJSON"
        file.write_text(held, encoding="utf-8")
    [pane] = convert(file).description["glazings"]["glazing"]["panes"]
    visible = (pane["transmittance"] - 0.2) / (0.8 - 0.2)
    # F(0.7 um) = 0.492, F(0.3 um) = 0.033, F(2.5 um) = 0.966 at 5800 K; few wavelengths: within 0.06.
    assert visible == pytest.approx((0.492 - 0.033) / (0.966 - 0.033), abs=0.06)
    assert pane["reflectance"] == pytest.approx(0.1)


def test_the_order_of_wavelengths_is_their_own(tmp_path: Path, text: str) -> None:
    """Rows of a table may stand in any order."""
    file = tmp_path / "model.idf"
    file.write_text(text, encoding="utf-8")
    sorted_glass = convert(file).description["glazings"]
    moved = text.replace("0.71,0.2,0.1,0.1, 1.0,0.2,0.1,0.1,", "1.0,0.2,0.1,0.1, 0.71,0.2,0.1,0.1,")
    assert moved != text
    file.write_text(moved, encoding="utf-8")
    assert convert(file).description["glazings"] == sorted_glass
