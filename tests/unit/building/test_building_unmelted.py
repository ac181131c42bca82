"""Layers that neither melt nor freeze in a run."""

from __future__ import annotations

import numpy as np
import pytest

from mascarin.simulation.checks import unmelted
from mascarin.simulation.results import Results
from mascarin.verification.analytical import melting, setup
from mascarin.verification.analytical.phase import slab

WAX = (
    "density: 855, conductivity: 0.2, specific_heat: 2000, latent_heat: 71000, melting_temperature: 22.0, "
    "law: {kind: linear, width: 0.7}"
)


def led(face: float, wax: str = WAX, initial: float = 15.0) -> Results:
    return setup.run(
        slab(wax, 0.005, 4), 24 * setup.HOUR, {"surface": setup.steady(face)}, step=900.0, initial=initial,
        outputs=["slab.outside_temperature"],
    )  # fmt: skip


def test_a_layer_that_stays_solid_is_warned_of() -> None:
    (line,) = led(20.0, initial=20.0).warnings
    assert "surfaces.slab, layer wax: stayed solid" in line
    assert "20.00 to 20.00 degC on the mean" in line
    assert "melts from 21.30 to 22.70 degC:" in line


def test_a_layer_that_stays_liquid_is_warned_of() -> None:
    curves = WAX + ", hysteresis: {model: curve_switch, freezing_temperature: 19.5}"
    (line,) = led(23.0, curves, initial=23.0).warnings
    assert "stayed liquid" in line
    assert "freezes from 20.20 to 18.80 degC" in line


def test_a_layer_that_melts_is_not_warned_of() -> None:
    assert led(25.0).warnings == ()
    run = melting.ceiling(1.0, "curve_scale", 900.0, days=2).run()
    assert run.warnings == ()
    assert [output.name for output in run.outputs] == ["slab.wax_liquid_fraction"]
    assert run.records.shape == (193, 1)


@pytest.mark.parametrize(("swing", "said"), [(0.009, 1), (0.011, 0)])
def test_one_percent_of_melting_is_enough(swing: float, said: int) -> None:
    building = setup.building(slab(WAX, 0.005, 4))
    assert [output.name for output in unmelted.watched(building)] == [
        "slab.wax_temperature",
        "slab.wax_liquid_fraction",
    ]
    records = np.array([[20.0, 0.0], [21.3, swing]])
    whole, by_rows = unmelted.Extremes(building), unmelted.Extremes(building)
    whole.add(records)
    for row in records:
        by_rows.add(row[None, :])
    assert len(whole.warnings()) == said
    assert by_rows.warnings() == whole.warnings()
