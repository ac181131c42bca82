"""Colors that readers can tell apart, on light and on dark paper."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import numpy.typing as npt
import pytest

from mascarin.figures import colors
from mascarin.pages.frame.template import palette

Array = npt.NDArray[np.float64]
#: Paper of the page, light and dark.
PAPERS = ("#fdfcfa", "#14171b")
#: Simulation of color blindness: Machado, Oliveira & Fernandes 2009, doi:10.1109/TVCG.2009.113, severity 1.
VISION = {
    "normal": np.eye(3),
    "protanopia": np.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
                            [-0.003882, -0.048116, 1.051998]]),
    "deuteranopia": np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
                              [-0.011820, 0.042940, 0.968881]]),
    "tritanopia": np.array([[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602],
                            [0.004733, 0.691367, 0.303900]]),
}  # fmt: skip
XYZ = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
                [0.0193339, 0.1191920, 0.9503041]])  # fmt: skip


def linear(color: str) -> Array:
    """Linear red, green and blue of a color."""
    coded = np.array([int(color[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
    return np.asarray(np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4))


def contrast(one: str, other: str) -> float:
    """Contrast of WCAG 2."""
    high, low = sorted((float(XYZ[1] @ linear(c)) for c in (one, other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def lab(rgb: Array) -> Array:
    ratio = XYZ @ rgb / XYZ.sum(axis=1)
    f = np.where(ratio > 216 / 24389, np.cbrt(ratio), (24389 / 27 * ratio + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def ciede2000(one: Array, other: Array) -> float:
    """Difference of two colors (Sharma, Wu & Dalal 2005, doi:10.1002/col.20070)."""
    mean_c = 0.5 * (np.hypot(one[1], one[2]) + np.hypot(other[1], other[2]))
    g = 0.5 * (1 - np.sqrt(mean_c**7 / (mean_c**7 + 25.0**7)))
    (l1, a1, b1), (l2, a2, b2) = one, other
    a1, a2 = (1 + g) * a1, (1 + g) * a2
    c1, c2 = np.hypot(a1, b1), np.hypot(a2, b2)
    h1, h2 = np.degrees(np.arctan2(b1, a1)) % 360, np.degrees(np.arctan2(b2, a2)) % 360
    step = (h2 - h1 + 180) % 360 - 180
    dl, dc, dh = l2 - l1, c2 - c1, 2 * np.sqrt(c1 * c2) * np.sin(np.radians(step / 2))
    lm, cm = 0.5 * (l1 + l2), 0.5 * (c1 + c2)
    hm = 0.5 * (h1 + h2) + (180 if abs(h1 - h2) > 180 else 0)
    t = (
        1 - 0.17 * np.cos(np.radians(hm - 30)) + 0.24 * np.cos(np.radians(2 * hm))
        + 0.32 * np.cos(np.radians(3 * hm + 6)) - 0.20 * np.cos(np.radians(4 * hm - 63))
    )  # fmt: skip
    sl = 1 + 0.015 * (lm - 50) ** 2 / np.sqrt(20 + (lm - 50) ** 2)
    sc, sh = 1 + 0.045 * cm, 1 + 0.015 * cm * t
    turn = 60 * np.exp(-(((hm - 275) / 25) ** 2))
    rt = -2 * np.sqrt(cm**7 / (cm**7 + 25.0**7)) * np.sin(np.radians(turn))
    return float(np.sqrt((dl / sl) ** 2 + (dc / sc) ** 2 + (dh / sh) ** 2 + rt * dc / sc * dh / sh))


def test_the_difference_of_colors_is_that_of_its_authors() -> None:
    # Pairs 1 and 25 of Sharma, Wu & Dalal 2005, table 1.
    pairs = [
        ((50.0, 2.6772, -79.7751), (50.0, 0.0, -82.7485), 2.0425),
        ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
    ]
    for one, other, expected in pairs:
        assert ciede2000(np.array(one), np.array(other)) == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize("paper", PAPERS)
def test_every_color_is_seen_on_light_and_on_dark_paper(paper: str) -> None:
    # WCAG 2.2, criterion 1.4.11: graphical objects have a contrast of at least 3.
    for color in (*colors.PALETTE, colors.MEASURED):
        assert contrast(color, paper) >= 3.0, color


@pytest.mark.parametrize("vision", VISION)
def test_any_two_colors_differ_for_every_reader(vision: str) -> None:
    seen = {c: lab(np.clip(VISION[vision] @ linear(c), 0.0, 1.0)) for c in (*colors.PALETTE, colors.MEASURED)}
    for one, other in combinations(seen, 2):
        assert ciede2000(seen[one], seen[other]) >= 9.0, (one, other)


def test_page_and_files_have_the_same_colors() -> None:
    style = palette()
    assert f"--fitted: {colors.models(['fitted'])['fitted']};" in style
    assert f"--nominal: {colors.models(['nominal'])['nominal']};" in style
    assert all(f"--c{k}: {color};" in style for k, color in enumerate(colors.PALETTE))


def test_models_keep_their_color_whatever_else_a_study_has() -> None:
    few, many = colors.models(["fitted"]), colors.models(["a", "nominal", "b", "fitted"])
    assert few["fitted"] == many["fitted"] == colors.FITTED
    assert many["nominal"] == colors.NOMINAL
    assert len(set(many.values())) == 4


def test_a_parameter_has_one_look_in_the_figures_of_all_outputs() -> None:
    shares = {"room": {f"p{k}": 0.1 / (k + 1) for k in range(12)}, "gap": {"p11": 0.9, "p0": 0.01}}
    looks = colors.parameters(shares, 8)
    assert next(iter(looks)) == "p11"
    assert {f"p{k}" for k in range(8)} <= looks.keys()
    # Nine parameters: the ninth has the first color with another pattern.
    assert len({(look.color, look.hatch) for look in looks.values()}) == len(looks) == 9
    assert colors.strongest({"a": float("nan"), "b": 0.1, "c": 0.2}, 2) == ["c", "b"]
