"""Published laws of convection that are written as text: coefficients by hand, and their numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin.building import FormulaLaw
from mascarin.building.checks.overview import check
from mascarin.building.parameters.unused_parameters import without_effect
from mascarin.building.parts.envelope.published_laws import published_laws
from mascarin.errors import InputError
from mascarin.examples import box, clear_days
from mascarin.simulation.preparation.objectives import Mean

FACADE = "surfaces.facade.inside.convection"
MIXING = "zones.room.mixing_air_change.air_changes"

MIXED = "beausoleil_morrison"
CAVITY = "ventilated_cavity"
#: Law, numbers, tilt [deg], difference [K], coefficient by hand [W/(m2 K)].
BY_HAND = [
    # 20.7 air changes an hour: 20.7^0.604 = 6.2351, 20.7^0.98 = 19.4828, 20.7^0.503 = 4.5913.
    ("fisher_ceiling_diffuser", {"mixing": 20.7}, 90, 5.0, 1.208 + 1.012 * 6.2351),
    ("fisher_ceiling_diffuser", {"mixing": 20.7}, 0, 5.0, 3.873 + 0.082 * 19.4828),
    ("fisher_ceiling_diffuser", {"mixing": 20.7}, 180, -2.0, 2.234 + 4.099 * 4.5913),
    # 10 K, 9 m2 of 12 m: hydraulic diameter 3 m.
    ("awbi_hatton", {"perimeter": 12.0}, 90, 10.0, 1.823 * 10**0.293 / 3**0.121),
    ("awbi_hatton", {"perimeter": 12.0}, 0, 10.0, 2.175 * 10**0.308 / 3**0.076),
    ("awbi_hatton", {"factor": 2.0, "perimeter": 12.0}, 180, 10.0, 2.0 * 0.704 * 10**0.133 / 3**0.601),
    # 2 air changes an hour: 2^0.8 = 1.741101; floor 0.360968, ceiling 0.676693, wall 0.131809. 1 K over 2 m:
    # 0.5^(1/4) = 0.840896, 0.5^(1/5) = 0.870551; cubes of the natural parts 2.736790 (walls) and 4.627900.
    # Forced parts as in the tests of EnergyPlus: a floor of -4.3290 = cbrt(0.1425 - (12 0.360968)^3).
    (MIXED, {"mixing": 2.0, "length": 2.0}, 90, 1.0, (2.736790 + 0.131809**3) ** (1 / 3)),
    (MIXED, {"mixing": 2.0, "length": 2.0}, 0, -1.0, ((0.6 * 0.870551) ** 3 + 0.360968**3) ** (1 / 3)),
    (MIXED, {"mixing": 2.0, "length": 2.0}, 0, 1.0, (4.627900 + 0.360968**3) ** (1 / 3)),
    (MIXED, {"mixing": 2.0, "length": 2.0}, 180, 1.0, ((0.6 * 0.870551) ** 3 + 0.676693**3) ** (1 / 3)),
    (MIXED, {"mixing": 2.0, "length": 2.0}, 180, -1.0, (4.627900 + 0.676693**3) ** (1 / 3)),
    # 50 air changes: 50^0.8 = 22.8653; wall 4.145398. Opposed: the cubic difference.
    (MIXED, {"mixing": 50.0, "length": 2.0, "opposing": 1}, 90, 1.0, (4.145398**3 - 2.736790) ** (1 / 3)),
    # Closed air layers of EN ISO 6946, twice: sides that differ by 2 K; by 16 K, 2 0.73 16^(1/3); heat that
    # flows down through 100 mm, 2 0.12 0.1^-0.44; conduction through 10 mm.
    (CAVITY, {}, 90, 1.0, 2.5),
    (CAVITY, {}, 90, 8.0, 3.679009),
    (CAVITY, {}, 0, 1.0, 3.9),
    (CAVITY, {}, 180, 1.0, 0.661015),
    (CAVITY, {}, 0, -1.0, 0.661015),
    (CAVITY, {"depth": 0.01}, 180, 1.0, 5.0),
]


@pytest.mark.parametrize(("key", "numbers", "tilt", "difference", "expected"), BY_HAND)
def test_coefficients_by_hand(
    key: str, numbers: dict[str, float], tilt: float, difference: float, expected: float
) -> None:
    law = box().replace({FACADE: {"kind": key, **numbers}}).surfaces["facade"].inside.convection
    assert isinstance(law, FormulaLaw)
    found = law.coefficient([difference], tilt=tilt, area=9.0, air_change=0.0)
    assert found[0] == pytest.approx(expected, rel=2e-5)
    assert law.source == published_laws()[key].source


#: Air layers of EN ISO 6946:2017, table 8 (both sides with an emissivity of 0.9, 10 degC): depth [m], tilt of
#: the warm side [deg], resistance [m2 K/W].
TABLE_8 = [
    (0.01, 90, 0.15), (0.025, 90, 0.18), (0.3, 90, 0.18),
    (0.01, 0, 0.15), (0.025, 0, 0.16), (0.3, 0, 0.16),
    (0.01, 180, 0.15), (0.025, 180, 0.19), (0.1, 180, 0.22), (0.3, 180, 0.23),
]  # fmt: skip


@pytest.mark.parametrize(("depth", "tilt", "resistance"), TABLE_8)
def test_closed_cavity_has_the_resistance_of_its_standard(
    depth: float, tilt: float, resistance: float
) -> None:
    law = box().replace({FACADE: {"kind": CAVITY, "depth": depth}}).surfaces["facade"].inside.convection
    assert isinstance(law, FormulaLaw)
    side = law.coefficient([2.0], tilt=tilt, area=9.0, air_change=0.0)[0]
    radiation = 4 * 5.67e-8 * 283.15**3 / (1 / 0.9 + 1 / 0.9 - 1)
    assert 1 / (0.5 * side + radiation) == pytest.approx(resistance, abs=0.006)


def test_air_that_flows_through_a_cavity_adds_four_for_each_metre_per_second() -> None:
    law = box().replace({FACADE: {"kind": CAVITY, "path": 9.0}}).surfaces["facade"].inside.convection
    assert isinstance(law, FormulaLaw)
    still, moved = (law.coefficient([1.0], tilt=90, area=9.0, total_air_change=n)[0] for n in (0.0, 200.0))
    assert moved - still == pytest.approx(4 * 9.0 * 200 / 3600, rel=1e-12)


def test_every_law_has_a_case() -> None:
    assert {key for key, *_ in BY_HAND} == published_laws().keys()


def test_a_word_is_enough_and_its_numbers_are_parameters() -> None:
    building = box().replace({FACADE: "fisher_ceiling_diffuser"})
    path = f"{FACADE}.mixing"
    climate = clear_days(
        float(building.site.latitude),
        float(building.site.longitude),
        timezone="UTC-7",
        start="2024-02-01",
        days=2,
        mean=5,
        altitude=1829,
    )
    output = "facade.inside_convection"
    runs = [
        mc.simulate(building, climate, outputs=[output], parameters={path: mixing}, initial=20.0)
        for mixing in (5.0, 20.0)
    ]
    calm, blown = (float(run[output].values[-1]) for run in runs)
    change = float(building.zones["room"].infiltration.constant)
    # The air of the zone changes by infiltration, too.
    for found, mixing in ((calm, 5.0), (blown, 20.0)):
        assert found == pytest.approx(1.208 + 1.012 * (change + mixing) ** 0.604, rel=1e-9)
    assert np.all(np.isfinite(runs[0][output].values))


def test_the_air_of_the_zone_drives_the_laws() -> None:
    """Mixing by a number and by a schedule: the coefficient is that by hand."""
    fan = {FACADE: "fisher_ceiling_diffuser"}
    building = box()
    climate = clear_days(
        float(building.site.latitude), float(building.site.longitude), timezone="UTC-7", start="2024-02-01",
        days=2, mean=5, altitude=1829,
    )  # fmt: skip
    outputs = ["facade.inside_convection", "room.total_air_changes", "room.air_changes"]
    stated: dict[str, Any] = {"number": 12.0, "half": {"air_changes": 24.0, "schedule": "half"}}
    for source in stated.values():
        extra = {"schedules.half": {"kind": "fraction", "value": 0.5}} if isinstance(source, dict) else {}
        moved = box().replace(extra | fan | {"zones.room.mixing_air_change": source})
        run = mc.simulate(moved, climate, outputs=outputs, initial=20.0)
        total = 12.0 + run["room.air_changes"].values
        assert run["room.total_air_changes"].values == pytest.approx(total, rel=1e-12)
        # The law follows the air at the start of a step; infiltration is constant here.
        h = run["facade.inside_convection"].values[1:]
        assert h == pytest.approx(1.208 + 1.012 * total[1:] ** 0.604, rel=1e-9)


def test_fans_and_vents_drive_the_laws() -> None:
    unit = {"supply": {"room": 0.02}, "exhaust": {"room": 0.02}}
    building = box().replace({"ventilation_units": {"fan": unit}, FACADE: "fisher_ceiling_diffuser"})
    climate = clear_days(
        float(building.site.latitude), float(building.site.longitude), timezone="UTC-7", start="2024-02-01",
        days=2, mean=5, altitude=1829,
    )  # fmt: skip
    outputs = ["facade.inside_convection", "room.total_air_changes", "room.air_changes"]
    run = mc.simulate(building, climate, outputs=outputs, initial=20.0)
    total = run["room.total_air_changes"].values[1:]
    assert total == pytest.approx(run["room.air_changes"].values[1:], rel=1e-12)
    supplied = 0.02 * 3600 / float(building.zones["room"].volume or 0.0)
    assert total == pytest.approx(supplied + float(building.zones["room"].infiltration.constant), rel=1e-9)
    h = run["facade.inside_convection"].values[1:]
    assert h == pytest.approx(1.208 + 1.012 * total**0.604, rel=1e-9)


def test_slopes_by_mixing_agree_with_differences() -> None:
    path = MIXING
    building = box().replace({"zones.room.mixing_air_change": 15.0, FACADE: MIXED})
    climate = clear_days(
        float(building.site.latitude), float(building.site.longitude), timezone="UTC-7", start="2024-02-01",
        days=2, mean=5, altitude=1829,
    )  # fmt: skip
    simulation = mc.Simulation(building, climate, outputs=["room.air_temperature"])
    slopes = simulation.gradient(Mean("room.air_temperature")).slopes
    high, low = (
        float(simulation.run({path: 15.0 + sign * 1e-3})["room.air_temperature"].mean()) for sign in (1, -1)
    )
    assert slopes[path] == pytest.approx((high - low) / 2e-3, rel=1e-3)
    assert abs(slopes[path]) > 1e-6


def test_a_law_by_flow_needs_a_flow() -> None:
    still = {"zones.room.infiltration": 0.0, FACADE: "fisher_ceiling_diffuser"}
    with pytest.raises(InputError, match=r"zone 'room' where nothing moves any(?s:.)*mixing_air_change: 10"):
        box().replace(still)
    moved = box().replace(still | {"zones.room.mixing_air_change": 10})
    text = "\n".join(check(moved))
    assert "zone room: forced convection by 10 1/h of mixing at surfaces.facade.inside" in text
    assert box().replace(still | {FACADE: {"kind": "fisher_ceiling_diffuser", "mixing": 5}}) is not None
    unused = box().replace({"zones.room.mixing_air_change": 10})
    assert "no law of convection depends on" in without_effect(unused)[MIXING]


def test_what_a_law_does_not_have_is_refused() -> None:
    with pytest.raises(InputError, match=r"mixng: 20\.7\n.*one of factor, mixing"):
        box().replace({FACADE: {"kind": "fisher_ceiling_diffuser", "mixng": 20.7}})
    with pytest.raises(InputError, match="mixing"):
        box().replace({FACADE: {"kind": "fisher_ceiling_diffuser", "mixing": -1.0}})
    with pytest.raises(
        InputError, match=r"kind: .*awbi_haton.*\n.*tarp, measured, text, fisher.*awbi_hatton"
    ):
        box().replace({FACADE: "awbi_haton"})
