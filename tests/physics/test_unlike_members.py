"""Members of an ensemble that differ much: each has the bits of its run alone, whatever its neighbors do."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mascarin.building import Building
from mascarin.ensemble import Store, sweep, sweep_into
from mascarin.ensemble import workers as sweep_workers
from mascarin.simulation.run import simulate
from mascarin.weather import Climate

OUTSIDE = {"outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.6}
OUTPUTS = [
    "r0.air_temperature",
    "r1.air_temperature",
    "r2.heating_load",
    "r0.cooling_load",
    "r0.relative_humidity",
    "vent.inflow",
    "s1.board_liquid_fraction",
]
OPTIONS: dict[str, Any] = {"outputs": OUTPUTS, "start": "2001-04-10", "end": "2001-04-11"}
#: Of 19 members: each differs from the others in all of them.
SAMPLES: dict[str, list[float]] = {
    path: [float(low + (high - low) * ((factor * k) % 19) / 18) for k in range(19)]
    for path, (low, high, factor) in {
        "zones.r0.infiltration.constant": (0.1, 3.0, 1),
        "zones.r0.gains.people.power": (0.0, 3000.0, 5),
        "zones.r1.volume": (20.0, 300.0, 7),
        "zones.r2.heating.capacity": (100.0, 5000.0, 11),
        "surfaces.s0.outside.absorptance": (0.1, 0.9, 13),
        "materials.board.hysteresis.freezing_temperature": (18.0, 21.0, 3),
        "vents.vent.area": (0.01, 0.5, 17),
    }.items()
}


def _inside(room: int) -> dict[str, Any]:
    return {"zone": f"r{room}", "convection": "tarp", "emissivity": 0.9, "absorptance": 0.5}


def rooms(features: bool) -> Building:
    """Three heated and cooled rooms; with ``features`` a melting board, humidity, a vent and a blind."""
    d: dict[str, Any] = {
        "name": "rooms",
        "site": {"latitude": 39.74, "longitude": -105.18, "altitude": 1829, "timezone": "UTC-7"},
        "materials": {
            "plaster": {"conductivity": 0.16, "density": 950, "specific_heat": 840},
            "wool": {"conductivity": 0.04, "density": 30, "specific_heat": 1000},
        },
        "constructions": {
            "shell": {
                "layers": [{"material": "wool", "thickness": 0.1}, {"material": "plaster", "thickness": 0.02}]
            },
            "partition": {"layers": [{"material": "plaster", "thickness": 0.02}]},
        },
        "zones": {},
        "surfaces": {},
    }
    for room in range(3):
        d["zones"][f"r{room}"] = {
            "volume": 60,
            "infiltration": 0.5,
            "gains": {"people": {"power": 300, "radiative": 0.5}},
            "heating": {"setpoint": 20, "capacity": 1500},
            "cooling": {"setpoint": 25, "capacity": 800},
        }
        wall = {"area": 20, "outside": OUTSIDE, "inside": _inside(room)}
        d["surfaces"][f"s{room}"] = {"construction": "shell", "tilt": 90, "azimuth": 90 * room, **wall}
        d["surfaces"][f"roof{room}"] = {"construction": "shell", "tilt": 0, **wall}
        if room:
            sides = {"outside": _inside(room - 1), "inside": _inside(room)}
            d["surfaces"][f"between{room}"] = {
                "construction": "partition", "area": 15, "tilt": 90, "azimuth": 0, **sides,
            }  # fmt: skip
    if features:
        _equip(d)
    return Building.from_dict(d)


def _equip(d: dict[str, Any]) -> None:
    d["materials"]["board"] = {
        "kind": "pcm", "density": 855, "conductivity": [0.22, 0.18], "specific_heat": [3134, 2833],
        "latent_heat": 71000, "melting_temperature": 22.0, "law": {"kind": "tanh", "width": 0.8},
        "hysteresis": {"model": "curve_switch", "freezing_temperature": 20.0},
    }  # fmt: skip
    d["constructions"]["melting"] = {
        "layers": [{"material": "wool", "thickness": 0.1}, {"material": "board", "thickness": 0.005}]
    }
    d["surfaces"]["s1"]["construction"] = "melting"
    d["humidity"] = {
        "materials": {"plaster": "gypsum"},
        "zones": {"r0": {"gains": {"people": {"power": 60}}, "drying": {"relative_humidity": 0.5}}},
    }
    d["controls"] = {"night": {"zone": "r0", "indoor": {"open": 23, "close": 21}}}
    d["vents"] = {
        "vent": {
            "zone": "r0", "surface": "s0", "area": 0.2, "height": 1.0, "elevation": 1.5,
            "pressure": "low_rise", "control": "night",
        },
        "door": {"between": ["r0", "r1"], "area": 1.5, "height": 2.0, "elevation": 1.0},
    }  # fmt: skip
    pane = {"thickness": 0.004, "emissivity": 0.84, "transmittance": 0.8, "reflectance": 0.08}
    gap = {"thickness": 0.016, "gas": "argon"}
    d["glazings"] = {"double": {"kind": "panes", "panes": [pane, pane], "gaps": [gap]}}
    blind = {
        "position": "outside",
        "transmittance": 0,
        "reflectance": 0.6,
        "resistance": 0.17,
        "radiation": 150,
    }
    d["windows"] = {
        "south": {
            "surface": "s2", "glazing": "double", "area": 4, "blind": blind,
            "outside": {"convection": 15}, "inside": {"convection": 3},
        }
    }  # fmt: skip


@pytest.fixture(scope="module")
def climate() -> Climate:
    return Climate.shipped("golden")


@pytest.mark.parametrize(
    ("features", "scheme", "step"),
    [(False, "sdirk2", "15min"), (False, "linearly-implicit", "3h"), (True, "sdirk2", "30min")],
)
def test_a_member_has_the_bits_of_its_run_alone(
    climate: Climate, features: bool, scheme: str, step: str
) -> None:
    building = rooms(features)
    names = OUTPUTS if features else OUTPUTS[:4]
    options = OPTIONS | {"outputs": names, "scheme": scheme, "step": step}
    samples = SAMPLES if features else dict(list(SAMPLES.items())[:5])
    members = sweep(building, climate, samples, **options)
    order = np.random.default_rng(3).permutation(19)
    shuffled = sweep(
        building, climate, {path: [values[k] for k in order] for path, values in samples.items()}, **options
    )
    some = sweep(building, climate, {path: values[4:15] for path, values in samples.items()}, **options)
    for name in names:
        np.testing.assert_array_equal(
            shuffled[name].to_numpy(), members[name].to_numpy()[order], err_msg=name
        )
        np.testing.assert_array_equal(some[name].to_numpy(), members[name].to_numpy()[4:15], err_msg=name)
    for k in range(0, 19, 3):
        alone = simulate(
            building, climate, parameters={path: values[k] for path, values in samples.items()}, **options
        )
        for name in names:
            np.testing.assert_array_equal(
                members[name].to_numpy()[k], alone[name].values, err_msg=f"{name}, member {k}"
            )


def test_a_sweep_that_was_interrupted_ends_with_the_same_bytes(
    climate: Climate, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    building, samples = rooms(False), dict(list(SAMPLES.items())[:5])
    options = OPTIONS | {"outputs": OUTPUTS[:4], "step": "30min"}
    sweep_into(tmp_path / "whole", building, climate, samples, **options)
    monkeypatch.setattr(sweep_workers, "FIRST", 8)

    def impatient(done: int, _: int) -> None:
        if done > 8:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sweep_into(tmp_path / "cut", building, climate, samples, progress=impatient, **options)
    assert 0 < Store(tmp_path / "cut").done < 19
    sweep_into(tmp_path / "cut", building, climate, samples, **options)
    first, second = ((tmp_path / name / "members.parquet").read_bytes() for name in ("whole", "cut"))
    assert first == second


def test_single_precision_does_not_depend_on_neighbors(climate: Climate) -> None:
    building, samples = rooms(False), dict(list(SAMPLES.items())[:5])
    options = OPTIONS | {"outputs": OUTPUTS[:4], "step": "30min", "precision": "single"}
    members = sweep(building, climate, samples, **options)
    order = np.random.default_rng(5).permutation(19)
    shuffled = sweep(
        building, climate, {path: [values[k] for k in order] for path, values in samples.items()}, **options
    )
    for name in OUTPUTS[:4]:
        np.testing.assert_array_equal(
            shuffled[name].to_numpy(), members[name].to_numpy()[order], err_msg=name
        )


def _bits(features: bool) -> str:
    """Hash of the results of all members."""
    names = OUTPUTS if features else OUTPUTS[:4]
    samples = SAMPLES if features else dict(list(SAMPLES.items())[:5])
    options = OPTIONS | {"outputs": names, "step": "1h"}
    members = sweep(rooms(features), Climate.shipped("golden"), samples, **options)
    return hashlib.sha256(b"".join(members[name].to_numpy().tobytes() for name in names)).hexdigest()


@pytest.mark.parametrize("features", [False, True])
def test_all_registers_give_the_same_bits(features: bool) -> None:
    # A machine without AVX-512 or AVX2 takes what it has.
    code = f"import test_unlike_members as test; print(test._bits({features}))"
    # The folders of its own imports, too: those of pytest.
    folder = os.pathsep.join([str(Path(__file__).parent), *sys.path])
    said = set()
    for lanes in ("array", "avx2", "avx512"):
        path = os.pathsep.join([folder, *filter(None, [os.environ.get("PYTHONPATH")])])
        environment = os.environ | {"MASCARIN_LANES": lanes, "PYTHONPATH": path}
        done = subprocess.run(
            [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        said.add(done.stdout.strip())
    assert len(said) == 1
