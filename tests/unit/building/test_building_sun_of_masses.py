"""Given shares of the sun for the sides of internal masses."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin.building import Building
from mascarin.building.reading import parse
from mascarin.errors import InputError
from mascarin.weather import Climate
from test_building_sun_and_films import BOX

SHELF = """\
  shelf:
    {construction: wall, area: 5, tilt: 90, azimuth: 0, internal_mass: true,
     outside: {zone: room, convection: 2, emissivity: 0.9, absorptance: 0.5},
     inside: {zone: room, convection: 2, emissivity: 0.9, absorptance: 0.5}}
windows:
"""


def furnished(**sun: Any) -> Building:
    """The box with a window and a shelf both sides of which face the room."""
    building = parse(BOX.replace("windows:\n", SHELF), "box.yaml")
    return building.replace({"zones.room.sun": {"kind": "shares"} | sun})


def test_each_side_gets_its_share() -> None:
    masses = {"shelf": {"outside": 0.3, "inside": 0.1}}
    names = [f"shelf.{side}_absorbed_solar" for side in ("outside", "inside")]
    names += ["floor.inside_absorbed_solar", "room.transmitted_solar"]
    run = mc.simulate(
        furnished(shares={"floor": 0.6}, masses=masses), Climate.shipped("golden"), start="2001-03-01",
        end="2001-03-03", step="1h", outputs=names,
    )  # fmt: skip
    outer, inner, floor, entered = (np.asarray(run[name])[1:].sum() for name in names)
    assert entered > 1000.0
    assert 5.0 * outer == pytest.approx(0.3 * entered, rel=1e-12)
    assert 5.0 * inner == pytest.approx(0.1 * entered, rel=1e-12)
    assert 20.0 * floor == pytest.approx(0.6 * entered, rel=1e-12)
    assert run.energy.relative_residual < 1e-10


def test_shares_of_masses_are_parameters() -> None:
    building = furnished(shares={"floor": 0.6}, masses={"shelf": {"outside": 0.3, "inside": 0.1}})
    assert building.parameter("zones.room.sun.masses.shelf.inside").value == pytest.approx(0.1)


def test_diffuse_shares_of_masses() -> None:
    part = {"shares": {"floor": 0.5}, "masses": {"shelf": {"outside": 0.5}}}
    furnished(shares={"floor": 1.0}, diffuse=part)
    with pytest.raises(InputError, match=r"zones\.room\.sun\.diffuse[\s\S]*sum to 0\.700"):
        furnished(shares={"floor": 1.0}, diffuse=part | {"masses": {"shelf": {"outside": 0.2}}})


def test_a_mass_among_shares_says_where_it_belongs() -> None:
    """Its one share was taken for each of its sides."""
    with pytest.raises(InputError, match=r"both sides in this zone[\s\S]*masses: \{shelf:"):
        furnished(shares={"floor": 0.8, "shelf": 0.2})
    with pytest.raises(InputError, match="under 'shares:'"):
        furnished(shares={"floor": 0.8}, masses={"roof": {"inside": 0.2}})


def test_a_misspelt_mass_is_named() -> None:
    with pytest.raises(InputError, match=r"found: 'shelv'[\s\S]*Did you mean 'shelf'"):
        furnished(shares={"floor": 0.8}, masses={"shelv": {"inside": 0.2}})
    with pytest.raises(InputError, match=r"found: 'cupboard'[\s\S]*Known: shelf"):
        furnished(shares={"floor": 0.8}, masses={"cupboard": {"inside": 0.2}})
