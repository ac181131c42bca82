"""Air between rooms that a control starts and stops, by the temperatures of both."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mascarin.errors import InputError
from mascarin.simulation.preparation.objectives import Mean
from mascarin.simulation.results import Results
from mascarin.simulation.simulation import Simulation
from simulation_samples import hours
from test_flow_density import climate
from test_simulation_zones import box

BAND = {"open": 6.0, "close": 2.0}
LINKS: dict[str, dict[str, Any]] = {
    "flow": {"flow": 0.03},
    "door": {"door": {"width": 0.9, "height": 2.0}},
}


def rooms(link: dict[str, Any] | None, band: dict[str, float] | None, *, humid: bool = False) -> Any:
    """A room with a heater whose air goes to the next one, where it is warmer by the band."""
    zones: dict[str, Any] = {
        "sunspace": {"infiltration": 0.2, "gains": {"sun": {"column": "P"}}},
        "room": {"infiltration": 0.2},
    }
    more: dict[str, Any] = {}
    if link is not None:
        more["air_paths"] = {"link": {"between": ["sunspace", "room"], **link}}
    if link is not None and band is not None:
        more["air_paths"]["link"]["control"] = "warmer"
        more["controls"] = {"warmer": {"zone": "sunspace", "reference_zone": "room", "difference": band}}
    if humid:
        more["humidity"] = {"zones": {"sunspace": {"gains": {"plants": {"rate": 2e-5}}}}}
    return box(zones, **more)


def run(building: Any, power: Any = 400.0) -> Results:
    outputs = [output.name for output in building.outputs()]
    return Simulation(building, climate(2, P=power), step="15min", outputs=outputs).run()


@pytest.mark.parametrize("link", sorted(LINKS))
@pytest.mark.parametrize(
    ("band", "flows"), [({"open": -50, "close": -60}, True), ({"open": 90, "close": 80}, False)]
)
def test_always_and_never(link: str, band: dict[str, float], flows: bool) -> None:
    """A control that is always met is the plain path; one that is never met is no path, for vapour too."""
    controlled = run(rooms(LINKS[link], band, humid=True))
    plain = run(rooms(LINKS[link] if flows else None, None, humid=True))
    for name in ("sunspace.air_temperature", "room.air_temperature", "room.humidity_ratio"):
        np.testing.assert_allclose(np.asarray(controlled[name]), np.asarray(plain[name]), rtol=0, atol=1e-9)
    assert controlled.energy.closure < 1e-9


@pytest.mark.parametrize("link", sorted(LINKS))
def test_the_band_switches_with_hysteresis(link: str) -> None:
    """Each step follows the difference at its beginning: open above 6 K, closed below 2 K, else as before."""
    building = rooms(LINKS[link], BAND)
    power = 300.0 + 300.0 * np.sin(hours(2) / 6000.0)
    results = run(building, power)
    warm, cold = (np.asarray(results[f"{zone}.air_temperature"]) for zone in ("sunspace", "room"))
    opened = np.asarray(results["warmer.open"])
    difference = warm - cold
    state, states = 0.0, []
    for before in difference[:-1]:
        state = 1.0 if before > BAND["open"] else 0.0 if before < BAND["close"] else state
        states.append(state)
    switched = np.abs(np.diff(states)).sum()
    assert switched > 2, "the control opens and closes"
    assert opened[1:].tolist() == states
    assert results.energy.closure < 1e-9


def test_slopes_agree_with_differences() -> None:
    """Within states that do not change, slopes by the flow are those of differences."""
    building = rooms(LINKS["flow"], BAND)
    output = "room.air_temperature"
    simulation = Simulation(building, climate(2, P=500.0), step="15min", outputs=[output])
    path = "air_paths.link.flow"
    value = building.parameter(path).value
    step = 1e-5 * value
    ends = [simulation.run({path: value + sign * step})[output] for sign in (1, -1)]
    difference = float(ends[0].mean() - ends[1].mean()) / (2 * step)
    assert simulation.gradient(Mean(output)).slopes[path] == pytest.approx(difference, rel=1e-3)
    column = float(simulation.jacobian([path])[f"d {output}"].mean())
    assert column == pytest.approx(difference, rel=1e-3)


@pytest.mark.parametrize(
    ("control", "words"),
    [
        (
            {"zone": "sunspace", "reference_zone": "room", "indoor": {"open": 24, "close": 22}},
            "without difference",
        ),
        ({"zone": "room", "reference_zone": "room", "difference": BAND}, "the zone itself"),
        ({"zone": "room", "reference_zone": "attic", "difference": BAND}, "attic"),
    ],
)
def test_a_reference_that_means_nothing_is_refused(control: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        box({"sunspace": {}, "room": {}}, controls={"warmer": control})


def test_a_controlled_flow_one_way_is_refused() -> None:
    """It would leave its zones without balance; an unknown control is named."""
    link = {"between": ["sunspace", "room"], "flow": 0.03, "control": "warmer"}
    control = {"zone": "sunspace", "reference_zone": "room", "difference": BAND}
    with pytest.raises(InputError, match="one_way"):
        box(
            {"sunspace": {}, "room": {}},
            controls={"warmer": control},
            air_paths={"link": link | {"one_way": True}},
        )
    with pytest.raises(InputError, match="colder"):
        box({"sunspace": {}, "room": {}}, air_paths={"link": link | {"control": "colder"}})
