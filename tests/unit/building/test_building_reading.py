"""Errors of a description are reported with line and path, and say what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from building_samples import EVERYTHING, ROOM
from mascarin.building import load
from mascarin.building.files.yaml_document import plain
from mascarin.building.reading import parse
from mascarin.errors import InputError

# (what to replace, by what); the faulty line is the one that then holds the mark.
MARK = "# here"
FAULTS = {
    "unknown key": (
        "    area: 16\n",
        "    area: 16\n    colour: red # here\n",
        "surfaces.south.colour",
        ["the key 'colour'", "a key that exists"],
    ),
    "misspelt key": (
        "  room: {volume: 30, infiltration: 0.5}",
        "  room: {volum: 30, infiltration: 0.5} # here",
        "zones.room.volum",
        ["Did you mean 'volume'?"],
    ),
    "negative thickness": (
        "thickness: 0.2}",
        "thickness: -0.2} # here",
        "constructions.wall.layers.concrete.thickness",
        ["found: -0.2", "above 0", "[m]"],
    ),
    "no thickness": (
        "{material: concrete, thickness: 0.2}",
        "{material: concrete} # here",
        "constructions.wall.layers.concrete.thickness",
        ["found: nothing", "Add 'thickness:'"],
    ),
    "no layers": (
        "    layers:\n      - {material: concrete, thickness: 0.2}",
        "    layers: [] # here",
        "constructions.wall.layers",
        ["no layers", "at least one layer"],
    ),
    "two layers of one name": (
        "    layers:\n      - {material: concrete, thickness: 0.2}",
        "    layers: [{material: concrete, thickness: 0.2}, {material: concrete, thickness: 0.1}] # here",
        "constructions.wall.layers",
        ["two layers called 'concrete'", "Add 'name:'"],
    ),
    "layer named as a side": (
        "{material: concrete, thickness: 0.2}",
        "{name: outside, material: concrete, thickness: 0.2} # here",
        "constructions.wall.layers.outside",
        ["the name 'outside'"],
    ),
    "unknown material": (
        "{material: concrete, thickness: 0.2}",
        "{material: concrte, thickness: 0.2} # here",
        "constructions.wall.layers.concrte.material",
        ["'concrte'", "under 'materials:'", "Did you mean 'concrete'?"],
    ),
    "thickness of a resistance": (
        "concrete: {conductivity: 1.75, density: 2240, specific_heat: 900, source: a table}",
        "concrete: {kind: resistance, resistance: 0.1}",
        "constructions.wall.layers.concrete.thickness",
        ["none: the material is a resistance", "Remove 'thickness:'"],
    ),
    "unknown kind of material": (
        "concrete: {conductivity: 1.75,",
        "concrete: {kind: pmc, conductivity: 1.75, # here\n   ",
        "materials.concrete",
        ["kind: pmc", "solid, variable, resistance, pcm", "Did you mean 'pcm'?"],
    ),
    "unknown zone": (
        "inside: {zone: room, convection: 3, emissivity: 0.9}\n  rest",
        "inside: {zone: rom, convection: 3, emissivity: 0.9} # here\n  rest",
        "surfaces.south.inside.zone",
        ["'rom'", "under 'zones:'", "Did you mean 'room'?"],
    ),
    "unknown construction": (
        "    construction: wall\n    area: 16",
        "    construction: walls # here\n    area: 16",
        "surfaces.south.construction",
        ["Did you mean 'wall'?"],
    ),
    "no surfaces": (
        ROOM[ROOM.index("zones:") :],
        "surfaces: {} # here\n",
        "surfaces",
        ["at least one surface"],
    ),
    "two sides on one zone": (
        "outside: {adiabatic: true}\n    inside: {zone: room, convection: 3, emissivity: 0.9}",
        "outside: {zone: room, convection: 3, emissivity: 0.9}\n"
        "    inside: {zone: room, convection: 3, emissivity: 0.9} # here",
        "surfaces.rest.inside.zone",
        ["both sides facing zone 'room'", "internal_mass: true"],
    ),
    "internal mass that is none": (
        "    area: 50",
        "    internal_mass: true # here\n    area: 50",
        "surfaces.rest.internal_mass",
        ["the sides face different things"],
    ),
    "two facings": (
        "outside: {adiabatic: true}",
        "outside: {adiabatic: true, zone: room, convection: 3, emissivity: 0.9} # here",
        "surfaces.rest.outside",
        [
            "zone and adiabatic",
            "exactly one of outdoors, zone, ground, soil, imposed, measured, scheduled, heat_flux, adiabatic",
        ],
    ),
    "no facing": (
        "outside: {adiabatic: true}",
        "outside: {} # here",
        "surfaces.rest.outside",
        ["a side that faces nothing"],
    ),
    "no column": (
        "outside: {adiabatic: true}",
        "outside: {measured: []} # here",
        "surfaces.rest.outside.measured",
        ["found: no column", "the name of a measured column"],
    ),
    "outdoors: false": (
        "outside: {adiabatic: true}",
        "outside: {adiabatic: false} # here",
        "surfaces.rest.outside.adiabatic",
        ["found: False", "true"],
    ),
    "no emissivity outdoors": (
        "convection: 15, emissivity: 0.9, absorptance: 0.6}",
        "convection: 15, absorptance: 0.6} # here",
        "surfaces.south.outside.emissivity",
        ["found: nothing", "Long-wave emissivity", "facing outdoors"],
    ),
    "no absorptance outdoors": (
        "emissivity: 0.9, absorptance: 0.6}",
        "emissivity: 0.9} # here",
        "surfaces.south.outside.absorptance",
        ["Solar absorptance"],
    ),
    "no convection outdoors": (
        "convection: 15, emissivity: 0.9, absorptance: 0.6}",
        "emissivity: 0.9, absorptance: 0.6} # here",
        "surfaces.south.outside.convection",
        ["Surface heat transfer coefficient"],
    ),
    "no emissivity in an exchanging zone": (
        "inside: {zone: room, convection: 3, emissivity: 0.9}\n  rest",
        "inside: {zone: room, convection: 3} # here\n  rest",
        "surfaces.south.inside.emissivity",
        ["zone 'room' exchanges radiation", "longwave: none"],
    ),
    "no absorptance for a measured irradiance": (
        "outside: {adiabatic: true}",
        "outside: {measured: T, convection: 9, irradiance: G} # here",
        "surfaces.rest.outside.absorptance",
        ["needed on a side facing measured"],
    ),
    "what could not act": (
        "outside: {adiabatic: true}",
        "outside: {adiabatic: true, sky_view: 0.5} # here",
        "surfaces.rest.outside.sky_view",
        ["'sky_view' on a side facing adiabatic", "Remove 'sky_view:'"],
    ),
    "roughness indoors": (
        "true}\n    inside: {zone: room, convection: 3,",
        "true}\n    inside: {zone: room, convection: {kind: tarp, roughness: rough}, # here\n",
        "surfaces.rest.inside.convection.roughness",
        ["only the forced part by wind uses it"],
    ),
    "an outdoor film indoors": (
        "true}\n    inside: {zone: room, convection: 3,",
        "true}\n    inside: {zone: room, convection: doe2, # here\n",
        "surfaces.rest.inside.convection",
        ["'doe2' on a side facing zone", "Write 'tarp'"],
    ),
    "wind correlation on an imposed temperature": (
        "outside: {adiabatic: true}",
        "outside: {measured: T, convection: mowitt} # here",
        "surfaces.rest.outside.convection",
        ["'mowitt' on a side facing measured"],
    ),
    "one column with two meanings": (
        "outside: {adiabatic: true}",
        "outside: {measured: T, convection: 9, irradiance: T, absorptance: 0.5} # here",
        "surfaces.rest.outside.irradiance",
        ["a measured temperature elsewhere"],
    ),
    "unknown convection": (
        "inside: {zone: room, convection: 3, emissivity: 0.9}\n  rest",
        "inside: {zone: room, convection: trap, emissivity: 0.9} # here\n  rest",
        "surfaces.south.inside.convection",
        ["kind: trap", "Did you mean 'tarp'?"],
    ),
    "no azimuth": (
        "    azimuth: 180\n    outside: {outdoors",
        "    outside: {outdoors",
        "surfaces.south.azimuth",
        ["Azimuth of the outside normal"],
    ),
    "sensor too deep": (
        "depth: 0.1}",
        "depth: 0.3} # here",
        "sensors.core.depth",
        ["0.3 m", "at most 0.2 m, the thickness of 'south'"],
    ),
    "sensor in no surface": (
        "{surface: south, depth: 0.1}",
        "{surface: sud, depth: 0.1} # here",
        "sensors.core.surface",
        ["under 'surfaces:'"],
    ),
    "one name twice": (
        "  core: {surface: south,",
        "  room: {surface: south, # here\n ",
        "sensors.room",
        ["'room' also under 'zones:'"],
    ),
    "a name with a dot": (
        "  core: {surface: south,",
        "  co.re: {surface: south, # here\n ",
        "sensors.co.re",
        ["a name of letters, digits"],
    ),
    "duplicate key": (
        "    area: 16\n",
        "    area: 16\n    area: 17 # here\n",
        "surfaces.south.area",
        ["the key 'area' again (first on line 14)"],
    ),
    "a unit": (
        "thickness: 0.2}",
        'thickness: "12 mm"} # here',
        "constructions.wall.layers.concrete.thickness",
        ["'12 mm'", "the unit is always m"],
    ),
    "text for a number": (
        "volume: 30,",
        "volume: big, # here\n    ",
        "zones.room.volume",
        ["'big'", "a number above 0 [m3]"],
    ),
    "a truth value for a number": (
        "volume: 30,",
        "volume: true, # here\n    ",
        "zones.room.volume",
        ["found: True"],
    ),
    "a list for a number": (
        "volume: 30,",
        "volume: [30, 40], # here\n    ",
        "zones.room.volume",
        ["[30, 40]"],
    ),
    "a number for a mapping": (
        "site: {latitude: 48, longitude: 2, altitude: 100, timezone: Europe/Paris}",
        "site: 48 # here",
        "site",
        ["found: 48", "a mapping"],
    ),
    "a mapping for a list": (
        "    layers:\n      - {material: concrete, thickness: 0.2}",
        "    layers: {material: concrete, thickness: 0.2} # here",
        "constructions.wall.layers",
        ["a list"],
    ),
    "not a number": (
        "volume: 30,",
        "volume: .nan, # here\n    ",
        "zones.room.volume",
        ["nan", "finite"],
    ),
    "infinite": (
        "volume: 30,",
        "volume: .inf, # here\n    ",
        "zones.room.volume",
        ["inf", "finite"],
    ),
    "range around another value": (
        "volume: 30,",
        "volume: {value: 30, range: [10, 20]}, # here\n    ",
        "zones.room.volume",
        ["range: [10, 20]", "around 30"],
    ),
    "range the wrong way": (
        "volume: 30,",
        "volume: {value: 30, range: [40, 20]}, # here\n    ",
        "zones.room.volume",
        ["low < high"],
    ),
    "range beyond the limits": (
        "volume: 30,",
        "volume: {value: 30, range: [-1, 40]}, # here\n    ",
        "zones.room.volume",
        ["found: -1"],
    ),
    "unknown note": (
        "volume: 30,",
        "volume: {value: 30, rang: [20, 40]}, # here\n    ",
        "zones.room.volume",
        ["key 'rang'", "Did you mean 'range'?"],
    ),
    "no time zone": (
        ", timezone: Europe/Paris}",
        "} # here",
        "site.timezone",
        ["found: nothing", "Europe/Paris, or UTC+4"],
    ),
    "time zone misspelt": (
        "timezone: Europe/Paris}",
        "timezone: Europe/Pari} # here",
        "site.timezone",
        ["Did you mean 'Europe/Paris'"],
    ),
    "time zone that is a place": (
        "timezone: Europe/Paris}",
        "timezone: ../Paris} # here",
        "site.timezone",
        ["an IANA time zone"],
    ),
    "unknown diffuse model": (
        "timezone: Europe/Paris}",
        "timezone: Europe/Paris, diffuse: peres} # here",
        "site.diffuse",
        ["one of perez, hay_davies, isotropic", "Did you mean 'perez'?"],
    ),
    "unknown sky": (
        "timezone: Europe/Paris}",
        "timezone: Europe/Paris, sky: blue} # here",
        "site.sky",
        ["kind: blue", "martin_berdahl"],
    ),
    "a word that is no roughness": (
        "convection: 15, emissivity",
        "convection: {kind: tarp, roughness: ruogh}, # here\n      emissivity",
        "surfaces.south.outside.convection.roughness",
        ["very_rough", "Did you mean 'rough'"],
    ),
    "a tag": (
        "volume: 30,",
        "volume: !!python/object/apply:os.getcwd [], # here\n    ",
        "zones.room.volume",
        ["the tag", "plain values"],
    ),
    "an alias of itself": (
        "  room: {volume: 30, infiltration: 0.5}",
        "  room: &r {volume: 30, # here\n    infiltration: *r}",
        "zones.room.infiltration",
        ["an alias without end"],
    ),
    "crossed vertices": (
        "    area: 50\n    tilt: 90\n    azimuth: 0\n",
        "    vertices: [[0, 0, 0], [2, 0, 0], [0, 0, 2], [1, 0, 3]] # here\n",
        "surfaces.rest.vertices",
        ["crosses"],
    ),
    "a vertex in the plane": (
        "    area: 50\n    tilt: 90\n    azimuth: 0\n",
        "    vertices: [[0, 0], [1, 0, 0], [0, 0, 1]] # here\n",
        "surfaces.rest.vertices.0",
        ["another number of items"],
    ),
    "a key without a value": (
        "    azimuth: 180\n",
        "    azimuth: # here\n",
        "surfaces.south.azimuth",
        ["found: nothing", "Write one or remove the key"],
    ),
    "a decimal comma": (
        "    azimuth: 180\n",
        "    azimuth: 180,5 # here\n",
        "surfaces.south.azimuth",
        ["found: '180,5'", "Write decimals with a point: 180.5."],
    ),
    "a decimal comma in braces": (
        "{volume: 30, infiltration: 0.5}",
        "{volume: 30, infiltration: 0,5} # here",
        "zones.room.5",
        ["found: nothing", "Write decimals with a point, as in 0.4."],
    ),
    "no volume": (
        "{volume: 30, infiltration: 0.5}",
        "{infiltration: 0.5} # here",
        "zones.room.volume",
        ["found: nothing", "or vertices to every surface"],
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_an_error_is_reported_with_line_and_path(name: str) -> None:
    old, new, path, words = FAULTS[name]
    assert ROOM.count(old) == 1
    text = ROOM.replace(old, new)
    with pytest.raises(InputError) as caught:
        parse(text, "room.yaml")
    report = str(caught.value)
    blocks = [block for block in report.split("room.yaml:") if block.split("\n")[0].endswith(f": {path}")]
    assert len(blocks) == 1, report
    line = blocks[0].split(":")[0]
    if MARK in text:
        assert int(line) == 1 + text[: text.index(MARK)].count("\n"), report
    for word in words:
        assert word in blocks[0], report
    assert "  expected: " in blocks[0]


WAX = "    law: {kind: tanh, gamma: 0.04, delta_t: 0.01}"
LAWS = {
    "width of zero": (WAX, "    law: {kind: tanh, width: 0}", "materials.wax.law.width", "above 0"),
    "two forms": (WAX, "    law: {kind: tanh, width: 1, gamma: 1}", "materials.wax.law", "give one form"),
    "half a form": (WAX, "    law: {kind: tanh, gamma: 1}", "materials.wax.law", "both gamma and delta_t"),
    "no latent heat": ("    latent_heat: 71000\n", "", "materials.wax.latent_heat", "needed by the tanh law"),
    # D (T - Tm) outweighs rho_l L on the cold side of a wide melting range.
    "falling enthalpy": (
        "    latent_heat: 71000\n",
        "    latent_heat: 1500\n",
        "materials.wax.law",
        "an enthalpy that rises",
    ),
    "enthalpies that fall": (
        "enthalpies: [0, 2.0e+4, 9.0e+4, 1.2e+5]",
        "enthalpies: [0, 2.0e+4, 1.9e+4, 1.2e+5]",
        "materials.curve.law.enthalpies.2",
        "19000 after 20000",
    ),
    "a plateau": (
        "enthalpies: [0, 2.0e+4, 9.0e+4, 1.2e+5]",
        "enthalpies: [0, 2.0e+4, 2.0e+4, 1.2e+5]",
        "materials.curve.law.enthalpies.2",
        "strictly rising",
    ),
    "temperatures that fall": (
        "temperatures: [15, 20, 22, 23]",
        "temperatures: [15, 20, 14, 23]",
        "materials.curve.law.temperatures.2",
        "14 after 20",
    ),
    "a table of one point": (
        "temperatures: [15, 20, 22, 23]",
        "temperatures: [15]",
        "materials.curve.law.temperatures",
        "at least two points",
    ),
    "a table with a gap": (
        "temperatures: [15, 20, 22, 23]",
        "temperatures: [15, 20, 22]",
        "materials.curve.law",
        "3 temperatures and 4 enthalpies",
    ),
    "melting backwards": ("[20, 22]", "[22, 20]", "materials.curve.law.melting_range", "Swap the two"),
    "latent heat beside a table": (
        "    conductivity: 0.2\n",
        "    conductivity: 0.2\n    latent_heat: 40000\n",
        "materials.curve.latent_heat",
        "the rise of the table between 20 and 22 degC",
    ),
    "three phases": (
        "[0.22, 0.18]",
        "[0.22, 0.2, 0.18]",
        "materials.wax.conductivity",
        "3 values",
    ),
    "view factors that leak": (
        "roof: {ceiling: 1.0}\n",
        "roof: {ceiling: 0.8}\n",
        "zones.attic.view_factors.roof",
        "sum to 1",
    ),
    "view factors of a stranger": (
        "roof: {ceiling: 1.0}\n",
        "roof: {floor: 1.0}\n",
        "zones.attic.view_factors.roof.floor",
        "a surface of this zone",
    ),
    "view factors with a hole": (
        "      ceiling: {roof: 0.8, light: 0.1, hatch: 0.1}\n",
        "",
        "zones.attic.view_factors",
        "no row 'ceiling'",
    ),
}


@pytest.mark.parametrize("name", LAWS)
def test_impossible_phase_change_is_an_error(name: str) -> None:
    old, new, path, words = LAWS[name]
    text = EVERYTHING.replace(old, new)
    if name == "falling enthalpy":
        text = text.replace("{solid: 3134, liquid: 2833}", "{solid: 300, liquid: 20000}")
        text = text.replace("gamma: 0.04", "gamma: 0.005")
    with pytest.raises(InputError) as caught:
        parse(text, "x.yaml")
    report = str(caught.value)
    assert f": {path}\n" in report
    assert words in report


def test_all_errors_are_reported_at_once_and_in_order() -> None:
    text = ROOM.replace("thickness: 0.2}", "thickness: -0.2}").replace("volume: 30", "volume: x")
    text = text.replace("zone: room,", "zone: rom,").replace("latitude: 48", "latitude: 480")
    with pytest.raises(InputError) as caught:
        parse(text, "room.yaml")
    report = str(caught.value)
    assert report.startswith("room.yaml: 5 faults\n")
    lines = [int(line.split(":")[1]) for line in report.splitlines()[1:] if line.startswith("room.yaml:")]
    assert lines == sorted(lines) == [2, 8, 10, 18, 25]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("site: {latitude: 1", "no YAML"),
        ("a: b: c", "no YAML"),
        ("\tname: x", "no YAML"),
        ("", "no keys"),
        ("- 1\n- 2\n", "no keys"),
        ("just text", "no keys"),
        ("a: 1\n---\nb: 2\n", "no YAML"),
        ("a: \x00", "no YAML"),
    ],
)
def test_a_text_without_sections_is_an_error(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        parse(text, "x.yaml")
    assert str(caught.value).startswith("x.yaml:")


def test_the_expansion_of_aliases_is_limited() -> None:
    rows = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    rows += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 9)]
    with pytest.raises(InputError, match="more than 100000 values"):
        parse("\n".join(rows), "x.yaml")


def test_a_long_text_has_as_many_values_as_it_says() -> None:
    """A building of 600 rooms has more than a hundred thousand values; only aliases make more of a text."""
    assert len(plain("values: [" + ", ".join(["1"] * 120_000) + "]", "x.yaml")["values"]) == 120_000


def test_a_missing_file_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        load(tmp_path / "no.yaml")


def test_a_binary_file_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="not UTF-8"):
        load(path)


def test_numbers_are_those_of_yaml_1_2(tmp_path: Path) -> None:
    """What YAML 1.1 reads as text, a truth value or sexagesimal is a number or text here."""
    text = ROOM.replace("900, source", "9e2, source").replace("a table", "NO")
    path = tmp_path / "room.yaml"
    path.write_text(text, encoding="utf-8")
    concrete = load(path).parameter("materials.concrete.specific_heat")
    assert concrete.value == 900.0
    assert concrete.source == "NO"


def test_an_alias_is_read_as_its_content() -> None:
    inside = "{zone: room, convection: 3, emissivity: 0.9}"
    first, _, rest = ROOM.partition(inside)
    text = f"{first}&inside {inside}{rest.replace(inside, '*inside')}"
    assert parse(text, "a").to_engine().json == parse(ROOM, "a").to_engine().json
