"""Windows: errors of the description, and results of the engine."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from mascarin import simulate
from mascarin.building import Building
from mascarin.building.checks.overview import check
from mascarin.building.reading import parse
from mascarin.errors import InputError
from mascarin.weather import Climate

PANE = "{thickness: 0.003048, conductivity: 1.0, emissivity: 0.84, transmittance: 0.834, reflectance: 0.075}"
BOX = f"""\
name: box
site: {{latitude: 39.83, longitude: -104.65, altitude: 1650, timezone: UTC-7, sky: measured}}
materials: {{board: {{conductivity: 0.1, density: 500, specific_heat: 1000}}}}
constructions: {{wall: {{layers: [{{material: board, thickness: 0.1}}]}}}}
glazings:
  clear:
    kind: panes
    panes: [{PANE}, {PANE}]
    gaps: [{{conductance: 5.208}}]
zones: {{room: {{volume: 27, infiltration: 0.5}}}}
surfaces:
  south:
    construction: wall
    area: 9
    tilt: 90
    azimuth: 180
    outside: {{outdoors: true, convection: 12, emissivity: 0.9, absorptance: 0.6}}
    inside: {{zone: room, convection: 2, emissivity: 0.9, absorptance: 0.6}}
  rest:
    construction: wall
    area: 45
    tilt: 90
    azimuth: 0
    outside: {{outdoors: true, convection: 12, emissivity: 0.9, absorptance: 0.6}}
    inside: {{zone: room, convection: 2, emissivity: 0.9, absorptance: 0.4}}
windows:
  pane:
    surface: south
    glazing: clear
    area: 4
    outside: {{convection: 13}}
    inside: {{convection: 2.4}}
"""


def box(**changes: object) -> Building:
    building = parse(BOX, "box.yaml")
    return building.replace({path.replace("__", "."): value for path, value in changes.items()})


@pytest.fixture(scope="module")
def climate(data_dir: object) -> Climate:
    return Climate.from_epw(f"{data_dir}/bestest/725650TYCST.epw")


def test_the_area_of_a_wall_is_gross() -> None:
    with pytest.raises(InputError, match=r"9\.50 m2 of windows \(pane 9\.50\)[\s\S]*less than the 9\.00 m2"):
        box(windows__pane__area=9.5)


def test_windows_together_exceed_their_wall() -> None:
    second = BOX + (
        "  other: {surface: south, glazing: clear, area: 5.5,\n"
        "          outside: {convection: 13}, inside: {convection: 2}}\n"
    )
    with pytest.raises(InputError, match=r"9\.50 m2 of windows \(pane 4\.00, other 5\.50\)"):
        parse(second, "box.yaml")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("glazing: clear", "glazing: claer", r"'claer'[\s\S]*Did you mean 'clear'"),
        ("absorptance: 0.4}", "}", r"surfaces\.rest\.inside\.absorptance[\s\S]*the sun enters zone 'room'"),
        ("gaps: [{conductance: 5.208}]", "gaps: []", r"0 gaps between 2 panes"),
        ("reflectance: 0.075", "reflectance: 0.3", r"sum 1\.134[\s\S]*a sum of at most 1"),
        (
            "    area: 4\n",
            "    vertices: [[0, 0, 1], [1, 0, 1], [1, 0, 2], [0, 0, 2]]\n",
            r"vertices in 'south', which has none",
        ),
        (
            "infiltration: 0.5",
            "infiltration: 0.5, sun: {kind: shares, shares: {south: 0.5, rest: 0.4}}",
            r"fractions that sum to 0\.900",
        ),
        (
            "infiltration: 0.5",
            "infiltration: 0.5, sun: {kind: shares, shares: {suoth: 1}}",
            r"'suoth'[\s\S]*a surface of this zone",
        ),
    ],
)
def test_errors_of_windows(old: str, new: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        parse(BOX.replace(old, new), "box.yaml")


def test_steady_heat_through_a_window(climate: Climate) -> None:
    """Two panes, a given gap and two constant coefficients in series, no radiation: U = 2.10 W/(m2 K)."""
    still = box(
        zones__room__longwave="none",
        windows__pane__outside__longwave="none",
        windows__pane__outside__convection=17.8,
        windows__pane__inside__convection=4.5,
    )
    names = ["room.air_temperature", "pane.outside_temperature", "pane.inside_temperature"]
    frame = (
        simulate(still, climate, start="2001-01-01", end="2001-01-02", outputs=names)
        .to_dataframe()
        .iloc[1:20]
    )
    panes = 2 * 0.003048 + 1.0 / 5.208
    assert 1.0 / (1.0 / 17.8 + panes + 1.0 / 4.5) == pytest.approx(2.099, abs=1e-3)
    air, outer, inner = (frame[name].to_numpy() for name in names)
    # By night: what comes off the inside face goes through the panes.
    np.testing.assert_allclose(4.5 * (air - inner), (inner - outer) / panes, rtol=1e-9)


def test_transmitted_is_absorbed_or_lost(climate: Climate) -> None:
    names = ["room.transmitted_solar", "room.lost_solar", "pane.transmitted_solar", "pane.incident_solar"]
    run = simulate(box(), climate, start="2001-02-01", end="2001-02-03", outputs=names)
    assert run.energy.closure < 1e-12
    sums = run.to_dataframe().iloc[1:].sum() * 900.0
    assert sums["pane.transmitted_solar"] == pytest.approx(sums["room.transmitted_solar"], rel=1e-12)
    # Incident sun through a double pane, winter noon and the rest: between the diffuse and the normal value.
    assert 0.59 < sums["pane.transmitted_solar"] / (4.0 * sums["pane.incident_solar"]) < 0.70
    lost = sums["room.lost_solar"] / sums["room.transmitted_solar"]
    # Glass lets out 4 m2 x 0.60 of what all faces take: 5 x 0.6 + 45 x 0.4 + 4 x 0.79.
    assert lost == pytest.approx(4 * 0.597 / (3 + 18 + 4 * 0.793), rel=0.01)
    kept = run.energy.into["transmitted"]
    assert kept < sums["room.transmitted_solar"] - sums["room.lost_solar"]  # the panes take a part


def test_given_shares(climate: Climate) -> None:
    shares = {"kind": "shares", "shares": {"south": 0.1, "rest": 0.7}, "lost": 0.2}
    names = ["room.transmitted_solar", "room.lost_solar"]
    run = simulate(box(zones__room__sun=shares), climate, start="2001-02-01", end="2001-02-02", outputs=names)
    sums = run.to_dataframe().iloc[1:].sum() * 900.0
    assert sums["room.lost_solar"] == pytest.approx(0.2 * sums["room.transmitted_solar"], rel=1e-12)
    assert run.energy.into["transmitted"] == pytest.approx(0.8 * sums["room.transmitted_solar"], rel=1e-12)
    assert run.energy.closure < 1e-12


@pytest.mark.parametrize("gas", ["air", "argon", "krypton", "xenon"])
def test_filled_gaps_close_the_energy_balance(climate: Climate, gas: str) -> None:
    building = box(glazings__clear__gaps=[{"thickness": 0.012, "gas": gas}])
    run = simulate(building, climate, start="2001-07-01", end="2001-07-02")
    assert run.energy.closure < 1e-12


def test_a_frame_takes_its_fraction_of_the_area(climate: Climate) -> None:
    names = ["pane.transmitted_solar"]
    period = {"start": "2001-02-01", "end": "2001-02-02", "outputs": names}
    bare = simulate(box(), climate, **period).to_dataframe().sum()  # type: ignore[arg-type]
    framed = simulate(
        box(windows__pane__frame={"fraction": 0.25, "u_value": 2.0}),
        climate,
        **period,  # type: ignore[arg-type]
    )
    assert framed.to_dataframe().sum()[names[0]] == pytest.approx(0.75 * bare[names[0]], rel=1e-12)
    assert framed.energy.closure < 1e-12


#: A drawn room of 8 m by 6 m by 2.7 m, black inside, two windows in the south wall.
_FACES = {
    "south": [[0, 0, 0], [8, 0, 0], [8, 0, 2.7], [0, 0, 2.7]],
    "north": [[8, 6, 0], [0, 6, 0], [0, 6, 2.7], [8, 6, 2.7]],
    "east": [[8, 0, 0], [8, 6, 0], [8, 6, 2.7], [8, 0, 2.7]],
    "west": [[0, 6, 0], [0, 0, 0], [0, 0, 2.7], [0, 6, 2.7]],
    "floor": [[0, 0, 0], [0, 6, 0], [8, 6, 0], [8, 0, 0]],
    "roof": [[0, 0, 2.7], [8, 0, 2.7], [8, 6, 2.7], [0, 6, 2.7]],
}


_DOOR = [[0.2, 0, 0.0], [1.2, 0, 0], [1.2, 0, 2.0], [0.2, 0, 2.0]]


def _walls(faces: dict[str, Any], absorptance: float = 1.0) -> dict[str, Any]:
    return {
        name: {
            "construction": "wall",
            "vertices": vertices,
            "outside": {"outdoors": True, "convection": 12, "emissivity": 0.9, "absorptance": 0.6},
            "inside": {"zone": "room", "convection": 2, "emissivity": 0.9, "absorptance": absorptance},
        }
        for name, vertices in faces.items()
    }


def _pane(west: float) -> dict[str, Any]:
    corners = [[west, 0, 0.2], [west + 3, 0, 0.2], [west + 3, 0, 2.2], [west, 0, 2.2]]
    return {
        "surface": "south",
        "glazing": "clear",
        "vertices": corners,
        "outside": {"convection": 13},
        "inside": {"convection": 2.4},
    }


def drawn(absorptance: float = 1.0, sun: str = "geometry", **sections: Any) -> Building:
    pane = {"thickness": 0.003048, "emissivity": 0.84, "transmittance": 0.834, "reflectance": 0.075}
    plain = {
        "site": {"latitude": 39.83, "longitude": -104.65, "altitude": 1650, "timezone": "UTC-7"},
        "materials": {"board": {"conductivity": 0.1, "density": 500, "specific_heat": 1000}},
        "constructions": {"wall": {"layers": [{"material": "board", "thickness": 0.1}]}},
        "glazings": {"clear": {"kind": "panes", "panes": [pane, pane], "gaps": [{"conductance": 5.208}]}},
        "zones": {"room": {"sun": sun}},
        "windows": {"one": _pane(0.5), "two": _pane(4.5)},
        "surfaces": _walls(_FACES, absorptance),
    } | sections
    return parse(json.dumps(plain), "drawn.yaml")


def sums(building: Building, climate: Climate, *names: str) -> tuple[Any, list[float]]:
    run = simulate(building, climate, start="2001-02-01", end="2001-02-03", outputs=list(names))
    assert run.energy.closure < 1e-12
    frame = run.to_dataframe().iloc[1:].sum() * 900.0
    return run, [float(frame[name]) for name in names]


def test_a_black_room_absorbs_all_sun_and_a_white_one_none(climate: Climate) -> None:
    """Black surfaces absorb all radiation, as no window faces another one; white ones reflect all of it."""
    names = ("room.transmitted_solar", "room.lost_solar")
    run, (let_in, lost) = sums(drawn(1.0), climate, *names)
    assert let_in > 1e8
    assert lost == pytest.approx(0.0, abs=1e-9 * let_in)
    assert run.energy.into["transmitted"] == pytest.approx(let_in, rel=1e-12)
    run, (let_in, lost) = sums(drawn(0.0), climate, *names)
    assert abs(run.energy.into["transmitted"]) < 1e-9 * let_in
    # Glass takes for good what it does not reflect: 0.600 lost of 0.793, the rest in its panes.
    assert lost / let_in == pytest.approx(0.600 / 0.793, abs=0.01)


def test_a_gray_room_loses_sun_by_area_and_reflectance(climate: Climate) -> None:
    """With the solar fractions of Standard 140, 3.5 % is lost at an absorptance of 0.6."""
    _, (let_in, lost) = sums(drawn(0.6), climate, "room.transmitted_solar", "room.lost_solar")
    assert 0.02 < lost / let_in < 0.05


def test_a_screen_in_front_of_a_window_leaves_ground_radiation(climate: Climate) -> None:
    """No sky is visible; the ground with view factor 0.5 reflects 0.2 of the global radiation."""
    wide = [[-500, -0.01, -500], [500, -0.01, -500], [500, -0.01, 500], [-500, -0.01, 500]]
    _, (behind,) = sums(drawn(shades={"screen": {"vertices": wide}}), climate, "one.incident_solar")
    _, (roof,) = sums(drawn(), climate, "roof.incident_solar")
    assert behind == pytest.approx(0.2 * 0.5 * roof, rel=1e-3)


def test_an_overhang_does_not_shade_the_low_sun(climate: Climate) -> None:
    """At noon of 1 February the sun stands 33 deg high: the shadow covers tan 33 - 0.5 = 0.15 m of 2 m."""
    hood = {"hood": {"vertices": [[0, 0, 2.7], [8, 0, 2.7], [8, -1, 2.7], [0, -1, 2.7]]}}
    _, (free,) = sums(drawn(), climate, "one.transmitted_solar")
    _, (shaded,) = sums(drawn(shades=hood), climate, "one.transmitted_solar")
    assert 0.92 < shaded / free < 0.97


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"shades": {"s": {"vertices": [[0, 0, 0], [1, 0, 0]]}}}, r"shades\.s\.vertices[\s\S]*at least 3"),
        ({"shades": {"s": {"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]]}}}, r"not plane"),
        ({"windows": {"one": _pane(0.5), "two": _pane(2.0)}}, r"windows\.two[\s\S]*overlaps 'one'"),
        ({"windows": {"one": _pane(0.5), "two": _pane(0.5)}}, r"overlaps 'one'"),
        ({"surfaces": _walls(_FACES | {"door": _DOOR})}, r"windows\.one[\s\S]*overlaps 'door'"),
        ({"windows": {"one": _pane(5.5)}}, r"corners outside the outline of 'south'"),
    ],
)
def test_invalid_vertices_of_windows_are_errors(change: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        drawn(**change)


def test_shades_and_beam_tracing_need_vertices() -> None:
    shade = "shades: {s: {vertices: [[0, 0, 3], [1, 0, 3], [1, -1, 3]]}}\n"
    with pytest.raises(InputError, match=r"shades\.s[\s\S]*no sunlit surface has vertices"):
        parse(BOX + shade, "box.yaml")
    traced = BOX.replace("infiltration: 0.5", "infiltration: 0.5, sun: geometry")
    with pytest.raises(InputError, match=r"geometry, where 'south', 'rest', 'pane' have no vertices"):
        parse(traced, "box.yaml")
    half = drawn(shades={"s": {"vertices": [[0, 0, 3], [1, 0, 3], [1, -1, 3]]}}, sun="area")
    bare = {"windows.one.vertices": None, "windows.one.area": 6}
    assert any("shades: without effect on one" in line for line in check(half.replace(bare)))


@pytest.mark.parametrize("law", ["doe2", "tarp"])
def test_a_pane_is_very_smooth_where_nothing_is_stated(law: str) -> None:
    """A wall is medium rough; a stated roughness holds for both."""
    building = box(windows__pane__outside__convection=law, surfaces__south__outside__convection=law)
    stated = box(windows__pane__outside__convection={"kind": law, "roughness": "smooth"})
    path = "windows.pane.outside.convection.roughness"
    assert building.parameter(path).value == 1.0
    assert building.parameter(path).assumed
    assert building.parameter("surfaces.south.outside.convection.roughness").value == 1.52
    assert stated.parameter(path).value == 1.11
