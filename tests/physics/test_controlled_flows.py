"""Infiltration by a schedule, and infiltration and ventilation that a control lets flow."""

from __future__ import annotations

from typing import Any

import pytest

from mascarin.building.parts.site_air import density
from mascarin.errors import InputError
from mascarin.physics import AIR_SPECIFIC_HEAT
from test_flow_density import UA, run
from test_simulation_zones import box, last

#: The outdoor air is 30 K colder than the room at 20 degC.
OPEN, CLOSED = ({"outdoor_below": {"open": 0, "close": 1}}, {"outdoor_below": {"open": -20, "close": -19}})
WARM, COOL = ({"indoor_below": {"open": 26, "close": 28}}, {"indoor_below": {"open": 15, "close": 16}})


def load(zone: dict[str, Any], **more: Any) -> float:
    """Flow of 1 air change of the site over what it would be, in a room of 50 m3 held at 20 degC. [-]"""
    building = box({"room": {"held": 20, "volume": 50, "infiltration": 0} | zone}, **more)
    results = run(building)
    assert results.energy.closure < 1e-9
    whole = density(building.site) * 50 / 3600 * AIR_SPECIFIC_HEAT
    found = (last(results, "room.heating_load") / 30 - UA) / whole
    assert last(results, "room.air_changes") == pytest.approx(found, abs=1e-3)
    return float(found)


@pytest.mark.parametrize(
    ("zone", "share"),
    [
        ({"infiltration": {"constant": 1.0, "schedule": "half"}}, 0.5),
        ({"infiltration": {"constant": 1.0, "schedule": "half", "control": "steering"}}, 0.5),
        ({"infiltration": {"formula": "abs(dT)/30", "control": "steering"}}, 1.0),
        ({"ventilation": {"fan": {"air_changes": 1.0, "control": "steering"}}}, 1.0),
        (
            {
                "ventilation": {
                    "fan": {"air_changes": 1.0, "schedule": "half", "control": "steering"},
                    "other": {"air_changes": 0.25},
                }
            },
            0.75,
        ),
    ],
)
@pytest.mark.parametrize(("control", "flows"), [(OPEN, True), (CLOSED, False), (WARM, True), (COOL, False)])
def test_the_heat_of_a_flow_by_its_control(
    zone: dict[str, Any], share: float, control: dict[str, Any], flows: bool
) -> None:
    """The flow carries its heat, its scheduled part, or nothing where the control has closed."""
    more: dict[str, Any] = {
        "schedules": {"half": {"kind": "fraction", "value": 0.5}},
        "controls": {"steering": {"zone": "room"} | control},
    }
    if "control" not in str(zone):
        expected = share
    else:
        expected = share if flows else (0.25 if "other" in str(zone) else 0.0)
    assert load(zone, **more) == pytest.approx(expected, abs=2e-4)


def test_a_band_below_opens_below() -> None:
    control = {"steering": {"zone": "room", "indoor_below": {"open": 28, "close": 26}}}
    with pytest.raises(InputError, match=r"controls\.steering\.indoor_below"):
        box({"room": {"infiltration": 0}}, controls=control)
