"""Shares of the sun, optics from inside, measured coefficients, moist air, outputs of surfaces, checks."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.building import Building, check, moist_air
from mascarin.building.reading import parse
from mascarin.errors import InputError
from mascarin.weather import Climate

SIGMA, KELVIN = 5.670374419e-8, 273.15
BOX = """\
name: box
site: {latitude: 39.83, longitude: -104.65, altitude: 1650, timezone: UTC-7,
       sky: {kind: offset, depression: 10}}
materials: {board: {conductivity: 0.1, density: 500, specific_heat: 1000}}
constructions: {wall: {layers: [{material: board, thickness: 0.1}]}}
glazings:
  glass:
    kind: panes
    panes: [{thickness: 0.004, emissivity: 0.84}]
    angular: {angles: [0, 60, 90], transmittance: [0.8, 0.7, 0], absorptance: [[0.1, 0.12, 0]],
              diffuse: {transmittance: 0.7, absorptance: [0.1]}}
zones: {room: {volume: 60, sun: area}}
surfaces:
  south:
    {construction: wall, area: 12, tilt: 90, azimuth: 180,
     outside: {outdoors: true, convection: 12, emissivity: 0.9, absorptance: 0.6},
     inside: {zone: room, convection: 2, emissivity: 0.9, absorptance: 0.5}}
  floor:
    {construction: wall, area: 20, tilt: 180, outside: {adiabatic: true},
     inside: {zone: room, convection: 2, emissivity: 0.9, absorptance: 0.7}}
  roof:
    {construction: wall, area: 20, tilt: 0,
     outside: {outdoors: true, convection: 12, emissivity: 0.8, absorptance: 0.4},
     inside: {zone: room, convection: 2, emissivity: 0.9, absorptance: 0.3}}
windows:
  pane: {surface: south, glazing: glass, area: 4, outside: {convection: 12}, inside: {convection: 3}}
"""


def box(**changes: Any) -> Building:
    return parse(BOX, "box.yaml").replace({path.replace("__", "."): new for path, new in changes.items()})


@pytest.fixture(scope="module")
def climate(data_dir: object) -> Climate:
    return Climate.from_epw(f"{data_dir}/bestest/725650TYCST.epw")


def run(building: Building, climate: Climate, names: list[str], **more: Any) -> mc.Results:
    return mc.simulate(building, climate, start="2001-03-01", end="2001-03-04", outputs=names, **more)


def sun(building: Building, climate: Climate) -> dict[str, float]:
    """Sun absorbed by the inner sides, transmitted into the room and lost from it [J]."""
    areas = {"south": 8.0, "floor": 20.0, "roof": 20.0}
    names = [f"{name}.inside_absorbed_solar" for name in areas]
    totals = ["room.transmitted_solar", "room.lost_solar"]
    found = run(building, climate, [*names, *totals])

    def integral(name: str) -> float:
        return float(np.asarray(found[name])[1:].sum()) * 900.0

    parts = {key: area * integral(name) for (key, area), name in zip(areas.items(), names, strict=True)}
    return parts | {name.split(".")[1]: integral(name) for name in totals}


def given(beam: str, diffuse: str) -> dict[str, object]:
    return {"kind": "shares", "shares": {beam: 1.0}, "diffuse": {"shares": {diffuse: 1.0}}}


def test_beam_and_diffuse_sun_have_shares_of_their_own(climate: Climate) -> None:
    one = sun(box(zones__room__sun=given("floor", "roof")), climate)
    other = sun(box(zones__room__sun=given("roof", "floor")), climate)
    assert one["floor"] + one["roof"] == pytest.approx(one["transmitted_solar"], rel=1e-12)
    assert one["floor"] == pytest.approx(other["roof"], rel=1e-12)
    assert one["roof"] == pytest.approx(other["floor"], rel=1e-12)
    assert min(one["floor"], one["roof"]) > 0.1 * one["transmitted_solar"]
    same = box(zones__room__sun=given("floor", "floor"))
    whole = box(zones__room__sun={"kind": "shares", "shares": {"floor": 1.0}})
    assert sun(same, climate) == pytest.approx(sun(whole, climate), rel=1e-12)


def test_shares_of_the_diffuse_part_sum_to_one() -> None:
    part = {"kind": "shares", "shares": {"floor": 1.0}, "diffuse": {"shares": {"roof": 0.5}}}
    with pytest.raises(InputError, match=r"zones\.room\.sun\.diffuse[\s\S]*sum to 0\.500"):
        box(zones__room__sun=part)


def test_the_beam_on_the_floor(climate: Climate) -> None:
    """The floor absorbs 0.7 of the beam; 0.3 of it and the diffuse part give an even irradiance.

    The irradiance of all surfaces is their power over the sum of area times what is not reflected: 8 x 0.5 +
    20 x 0.7 + 20 x 0.3 of the surfaces and 4 x 0.8 of the glass.
    """
    parts = sun(box(zones__room__sun=given("floor", "roof")), climate)
    beam, diffuse = parts["floor"], parts["roof"]
    even = (diffuse + 0.3 * beam) / (8 * 0.5 + 20 * 0.7 + 20 * 0.3 + 4 * 0.8)
    found = sun(box(zones__room__sun="floor"), climate)
    assert found["floor"] == pytest.approx(0.7 * (beam + 20.0 * even), rel=1e-9)
    assert found["roof"] == pytest.approx(0.3 * 20.0 * even, rel=1e-9)
    assert found["lost_solar"] == pytest.approx(0.7 * 4.0 * even, rel=1e-9)


def test_a_zone_without_floor() -> None:
    with pytest.raises(InputError, match="floor, in a zone without a floor"):
        box(zones__room__sun="floor", surfaces__floor__tilt=90.0, surfaces__floor__azimuth=0.0)


def test_optics_from_inside(climate: Climate) -> None:
    """Of even irradiance the glass loses its area times its transmittance from inside."""
    back = {"transmittance": 0.65, "reflectance": 0.1, "absorptance": [0.25]}
    for building, through, admitted in [
        (box(), 0.7, 0.8),
        (box(glazings__glass__angular__back=back), 0.65, 0.9),
    ]:
        found = sun(building, climate)
        whole = 8 * 0.5 + 20 * 0.7 + 20 * 0.3 + 4 * admitted
        assert found["lost_solar"] / found["transmitted_solar"] == pytest.approx(
            4 * through / whole, rel=1e-9
        )


def test_back_values_sum_to_one() -> None:
    back = {"transmittance": 0.7, "reflectance": 0.3, "absorptance": [0.2]}
    with pytest.raises(InputError, match=r"sum of 1\.200 \(diffuse, from inside\)"):
        box(glazings__glass__angular__back=back)


def test_radiation_and_coefficients_of_surfaces(climate: Climate) -> None:
    """The roof sees the sky alone; inside, what one surface gains another loses."""
    names = ["south", "floor", "roof", "pane"]
    wanted = [f"{name}.inside_longwave" for name in names]
    wanted += [f"roof.outside_{word}" for word in ("longwave", "convection", "absorbed_solar", "temperature")]
    wanted += ["roof.incident_solar", "sky_temperature", "pane.inside_convection", "pane.outside_longwave"]
    found = {name: np.asarray(series) for name, series in run(box(), climate, wanted).items()}
    inside = [found[f"{name}.inside_longwave"] for name in names]
    gained = sum(area * q for area, q in zip((8.0, 20.0, 20.0, 4.0), inside, strict=True))
    assert np.abs(gained).max() < 1e-9
    assert max(np.abs(q).max() for q in inside) > 10.0
    black = [SIGMA * (found[f"{name}temperature"] + KELVIN) ** 4 for name in ("sky_", "roof.outside_")]
    np.testing.assert_allclose(found["roof.outside_longwave"], 0.8 * (black[0] - black[1]), atol=1e-9)
    np.testing.assert_allclose(found["roof.outside_convection"], 12.0, rtol=1e-12)
    np.testing.assert_allclose(found["pane.inside_convection"], 3.0, rtol=1e-12)
    np.testing.assert_allclose(
        found["roof.outside_absorbed_solar"], 0.4 * found["roof.incident_solar"], rtol=1e-9
    )


def test_the_transmittance_of_a_window_lies_within_its_table(climate: Climate) -> None:
    names = ["pane.solar_transmittance", "pane.transmitted_solar", "pane.incident_solar"]
    through, heat, incident = (np.asarray(series) for series in run(box(), climate, names).values())
    day = incident > 1.0
    np.testing.assert_allclose(through[day], heat[day] / (4.0 * incident[day]), rtol=1e-12)
    assert (through[incident == 0.0] == 0.0).all()
    assert 0.3 < through[day].min() < through.max() < 0.8


def measured(values: Any) -> mc.Measurements:
    index = pd.date_range("2001-02-28", "2001-03-06", freq="1h", tz="Etc/GMT+7")
    return mc.Measurements.from_table(pd.DataFrame({"h": values}, index=index), columns=["h"])


FILMS = {
    "surfaces.south.inside.convection": 2.0,
    "surfaces.roof.outside.convection": 12.0,
    "windows.pane.inside.convection": 3.0,
    "surfaces.floor.inside.convection": 2.0,
}


@pytest.mark.parametrize("scheme", ["sdirk2", "backward-euler"])
def test_a_measured_coefficient_that_stays_is_a_constant_one(climate: Climate, scheme: str) -> None:
    names = ["room.air_temperature", "south.inside_temperature", "pane.inside_convection"]
    for path, value in FILMS.items():
        film = {"kind": "measured", "column": "h", "factor": 0.5}
        building = parse(BOX, "box.yaml").replace({path: film})
        found = run(building, climate, names, scheme=scheme, measurements=measured(2.0 * value))
        expected = run(box(), climate, names, scheme=scheme)
        for name in names:
            np.testing.assert_allclose(np.asarray(found[name]), np.asarray(expected[name]), atol=1e-6)
        assert found.energy.closure < 1e-10


def test_a_measured_coefficient_follows_its_column(climate: Climate) -> None:
    hours = np.arange(145.0)
    building = parse(BOX, "box.yaml").replace(
        {"surfaces.floor.inside.convection": {"kind": "measured", "column": "h"}}
    )
    names = ["floor.inside_convection"]
    found = run(building, climate, names, measurements=measured(2.0 + 0.01 * hours), step="1h")
    series = np.asarray(found[names[0]])[1:]
    # Straight between the hours; the record is the last stage of its step.
    np.testing.assert_allclose(np.diff(series), 0.01, atol=1e-9)


def test_a_negative_coefficient_is_refused(climate: Climate) -> None:
    building = parse(BOX, "box.yaml").replace(
        {"surfaces.floor.inside.convection": {"kind": "measured", "column": "h"}}
    )
    with pytest.raises(InputError, match="h"):
        run(building, climate, ["room.air_temperature"], measurements=measured(-1.0))


def test_moist_air() -> None:
    """ASHRAE Fundamentals 2017, ch. 1, table 2: at 30 degC saturated air has 27.3 g/kg and 1.1466 kg/m3."""
    density, heat = moist_air(30.0, 1.0, 101325.0)
    ratio = 0.02733
    assert density == pytest.approx((1 + ratio) / 0.8962, rel=2e-3)
    assert heat == pytest.approx((1006 + ratio * 1860) / (1 + ratio), rel=1e-3)
    with pytest.raises(InputError, match="relative humidity from 0 to 1"):
        moist_air(20.0, 50.0, 101325.0)


def test_the_specific_heat_of_the_air_acts(climate: Climate) -> None:
    """It multiplies density in all flows and in the air of the zone: both together stay the same."""
    names = ["room.air_temperature"]
    leaky = {"zones.room.infiltration": 2.0}
    light = box().replace({**leaky, "site.air_density": 1.0, "site.air_specific_heat": 1100.0})
    heavy = box().replace({**leaky, "site.air_density": 1.1, "site.air_specific_heat": 1000.0})
    dry = box().replace({**leaky, "site.air_density": 1.0})
    found = [np.asarray(run(one, climate, names)[names[0]]) for one in (light, heavy, dry)]
    np.testing.assert_allclose(found[0], found[1], atol=1e-7)
    assert np.abs(found[0] - found[2]).max() > 0.05
    assert "infiltration 36.67 W/K" in check(light)[1]


def test_u_values_by_the_coefficients_described() -> None:
    """A film of 1000 W/(m2 K) with a black coefficient of 5.7 W/(m2 K): not that of ISO 6946."""
    thin = box(surfaces__south__inside__convection=1000.0)
    line = next(line for line in check(thin) if line.startswith("surface south"))
    films = 1 / (12 + 0.9 * 5.1) + 1 / (1000 + 0.9 * 5.7)
    assert f"; U {1 / (1.0 + films):.3f} as described" in line
    assert "U 0.855 W/(m2 K), ISO 6946 surface resistances" in line
    ua = 8.0 / (1.0 + films)
    ua += 4.0 / (1 / (12 + 0.84 * 5.1) + 0.004 + 1 / (3 + 0.84 * 5.7))
    ua += 20.0 / (1 / (12 + 0.8 * 5.1) + 1.0 + 1 / (2 + 0.9 * 5.7))
    assert f"({ua:.2f} W/K with the coefficients described)" in check(thin)[1]


def test_heights_and_wind_are_shown() -> None:
    """At 2 m in suburbs: (270/10)^0.14 (2/370)^0.22 = 0.503 of the wind at 10 m over open country."""
    high = box(surfaces__south__outside__height=2.0, site__wind__terrain="suburb")
    lines = check(high)
    assert "surface south: 2.00 m high, 0.50 of the wind at the mast" in lines
    assert "surface roof: no height, wind as at the mast" in lines


def test_ratings_are_shown() -> None:
    line = next(line for line in check(box()) if line.startswith("window pane: glass of"))
    assert "solar transmittance 0.800, 0.700 of diffuse radiation" in line
    # One pane of 4 mm: a quarter of a tenth of what it absorbs enters.
    assert f"U {1 / 0.174:.2f} W/(m2 K) and solar heat gain {0.8 + 0.1 * 0.042 / 0.174:.3f}" in line
