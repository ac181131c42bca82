"""The small models as files of older versions: other fields, other classes, the same building."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from mascarin.energyplus import convert

SMALL = Path(__file__).resolve().parents[2] / "idf_small"
VERSIONS = ("8.9", "9.0", "9.3")
#: Models without classes that these versions do not have; refused ones and the older one are left out.
LATER = {
    "extra_field", "macro_include", "old_version_9_4", "spaces", "interzone_one_sided", "incident_multiplier",
    "surrounding_surfaces", "hvac_template_vav", "internal_source", "spaces_by_area", "radiant_mat",
    "radiant_group",
}  # fmt: skip
#: Rules on lines of IDF: what an older version has in place of a field of 25.2.
ALL = [
    (r"^( *BuildingSurface:Detailed,(?:[^,]*,){4}),", r"\1"),  # no space
    (
        r"^( *(?:Wall:(?:Interzone|Exterior|Underground)|Ceiling:Interzone|InternalMass),(?:[^,]*,){3}),",
        r"\1",
    ),
]
OLDEST = [
    (r"^( *FenestrationSurface:Detailed,(?:[^,]*,){5}[^,]*,)", r"\1,"),  # a shading control before the frame
    (r"^( *Window,[^,]*,[^,]*,[^,]*,)", r"\1,"),
    (r"^( *RunPeriod,[^,]*,[^,]*,[^,]*,),([^,]*,[^,]*,),", r"\1\2"),  # no years
]
UNTIL_9_0 = [
    (
        r"ShadowCalculation,PolygonClipping,Periodic,(\d+);",
        r"ShadowCalculation,AverageOverDaysInFrequency,\1;",
    )
]


def older(text: str, version: str) -> str:
    """A file of 25.2 as one of an older version."""
    rules = [*ALL, *(OLDEST if version == "8.9" else []), *(UNTIL_9_0 if version in ("8.9", "9.0") else [])]
    for pattern, words in rules:
        text = re.sub(pattern, words, text, flags=re.MULTILINE)
    return text.replace("Version,25.2;", f"Version,{version};")


NAMES = sorted(path.stem for path in SMALL.glob("*.idf") if path.stem not in LATER)


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("name", NAMES)
def test_an_older_file_is_the_same_building(name: str, version: str, tmp_path: Path) -> None:
    text = (SMALL / f"{name}.idf").read_bytes().decode("latin-1")
    file = tmp_path / f"{name}.idf"
    file.write_bytes(older(text, version).encode("latin-1"))
    expected, found = convert(SMALL / f"{name}.idf"), convert(file)
    assert found.version == version
    assert found.description == expected.description
    assert (found.start[4:], found.end[4:]) == (expected.start[4:], expected.end[4:])


def test_the_year_of_an_old_run_period_gives_its_days(tmp_path: Path) -> None:
    text = older((SMALL / "base.idf").read_text(encoding="utf-8"), "8.9")
    period = "RunPeriod,year,1,1,12,31,Sunday,No,No,No,No,No;"
    assert period in text
    file = tmp_path / "model.idf"
    file.write_text(
        text.replace(period, "RunPeriod,year,1,1,12,31,,No,No,No,No,No,1,Yes,2013;"), encoding="utf-8"
    )
    assert convert(file).start == "2013-01-01"


def test_a_shading_control_of_an_old_window_is_a_blind(tmp_path: Path) -> None:
    text = older((SMALL / "base.idf").read_text(encoding="utf-8"), "8.9")
    window = "room S,,autocalculate,,,1,4"
    assert window in text
    text = text.replace(window, "room S,,autocalculate,shades,,1,4")
    text += (
        "WindowMaterial:Shade,cloth,0.1,0.6,0.1,0.6,0.9,0,0.003,0.1,0.05;\n"
        "WindowProperty:ShadingControl,shades,ExteriorShade,,AlwaysOn,,,No,No,cloth;\n"
    )
    file = tmp_path / "model.idf"
    file.write_text(text, encoding="utf-8")
    description = convert(file).description
    assert "blind" in description["windows"]["room_win"]
