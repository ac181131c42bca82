"""Parts inside of parts: validated, written and described as if pydantic had built all at once."""

from __future__ import annotations

import warnings

import pytest

import mascarin as mc
from mascarin.building import Site, Solid, Zone
from mascarin.errors import InputError
from mascarin.examples import FOLDER


def test_a_fault_in_a_part_inside_has_its_place() -> None:
    plain = mc.load(FOLDER / "box.yaml").to_dict()
    plain["surfaces"]["facade"]["inside"]["emissivity"] = 2.0
    plain["zones"]["room"]["volume"] = "much"
    with pytest.raises(InputError) as caught:
        mc.Building.from_dict(plain)
    assert "surfaces.facade.inside.emissivity" in str(caught.value)
    assert "zones.room.volume" in str(caught.value)


def test_a_part_inside_is_written_by_its_own_class() -> None:
    building = mc.load(FOLDER / "lgi" / "building.yaml")
    building.check()  # what is worked out stays with the parts, and is not written
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        written = building.model_dump(mode="json", exclude={"zones": {"room": {"volume"}}})
    assert "volume" not in written["zones"]["room"]
    assert written["surfaces"]["roof"]["outside"]["convection"]["kind"] == "mowitt"
    unset = building.model_dump(mode="json", exclude_unset=True)
    assert len(str(unset)) < len(str(written))


@pytest.mark.filterwarnings("ignore::pydantic.json_schema.PydanticJsonSchemaWarning")
def test_the_schema_has_every_part() -> None:
    schema = Zone.model_json_schema()
    assert {"IdealLoads", "LeakageStackWind", "ThermalBridge", "GivenSun"} <= schema["$defs"].keys()
    assert "volume" in schema["properties"]


def test_objects_are_parts_as_well() -> None:
    solid = Solid(conductivity=1.75, density=2400, specific_heat=880)
    plain = mc.load(FOLDER / "box.yaml").to_dict()
    building = mc.Building.from_dict(plain | {"materials": {"concrete": solid}})
    assert building.materials["concrete"] == solid
    with pytest.raises(InputError, match=r"site\.conductivity"):
        mc.Building.from_dict(plain | {"site": solid})
    assert isinstance(building.site, Site)
