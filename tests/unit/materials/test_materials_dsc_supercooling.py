"""A sample that supercools in a calorimeter: latent heat over time, and the law of how it freezes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

import mascarin as mc
from mascarin import cli
from mascarin.errors import InputError
from mascarin.materials import from_dsc

LATENT, SOLID, LIQUID, CENTRE, WIDTH = 180_000.0, 1400.0, 2100.0, 29.0, 0.6
RATE = 0.5  # K/min
#: Between oven and sample, by its mass. [W/(kg K)]
LINK = 40.0


def melted(temperature: float) -> float:
    """Liquid fraction of the melting curve."""
    return float(0.5 + 0.5 * np.tanh((temperature - CENTRE) / WIDTH))


def enthalpy(temperature: float, fraction: float) -> float:
    over = temperature - CENTRE
    return SOLID * over + fraction * (LATENT + (LIQUID - SOLID) * over)


def temperature_of(heat: float, fraction: float) -> float:
    return CENTRE + (heat - fraction * LATENT) / (SOLID + fraction * (LIQUID - SOLID))


def heated(first: float, last: float, step: float = 1.0) -> tuple[np.ndarray, ...]:
    """Seconds, sample temperature and heat flow [mW/mg] of a run in equilibrium with its curve."""
    sample = np.linspace(first, last, round(abs(last - first) / (RATE / 60.0) / step) + 1)
    heat = np.array([enthalpy(t, melted(t)) for t in sample])
    seconds = step * np.arange(len(sample))
    return seconds, sample, np.gradient(heat, seconds) / 1000.0


def supercooled(first: float, last: float, degree: float, tau: float) -> tuple[np.ndarray, ...]:
    """The same of a sample behind a resistance that freezes late, by small explicit steps."""
    step, fraction, nucleated = 0.2, 1.0, False
    heat = enthalpy(first, 1.0)
    rows = []
    for k in range(round((first - last) / (RATE / 60.0) / step * 1.3)):
        sample = temperature_of(heat, fraction)
        flow = LINK * (first - RATE / 60.0 * step * k - sample)
        rows.append((step * k, sample, flow / 1000.0))
        heat += step * flow
        nucleated = nucleated or sample < CENTRE - degree
        if nucleated:
            fraction -= step / tau * max(fraction - melted(sample), 0.0)
    seconds, sample_temperature, flow_by_mass = np.array(rows).T
    return seconds, sample_temperature, flow_by_mass


def table(seconds: np.ndarray, temperature: np.ndarray, flow: np.ndarray) -> str:
    """A file as an instrument writes it."""
    rows = [f"{t:.3f},{s:.2f},{f:.6f}" for t, s, f in zip(temperature, seconds, flow, strict=True)]
    return "\n".join(["temperature [degC],time [s],heat flow [mW/mg]", *rows]) + "\n"


def written(path: Path, degree: float, tau: float, *, noise: float = 0.0, sign: float = 1.0) -> Path:
    """Both runs, one after the other, a row each second."""
    warm, cold = heated(15.0, 42.0), supercooled(42.0, 12.0, degree, tau)
    cold = tuple(column[::5] for column in cold)
    seconds = np.concatenate([warm[0], warm[0][-1] + 1.0 + cold[0]])
    noisy = noise * np.random.default_rng(1).normal(size=len(seconds))
    flow = sign * (np.concatenate([warm[2], cold[2]]) + noisy)
    path.write_text(table(seconds, np.concatenate([warm[1], cold[1]]), flow), encoding="utf-8")
    return path


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("degree", "tau"), [(6.0, 120.0), (9.0, 200.0)])
def test_the_law_of_a_virtual_calorimeter_comes_back(
    degree: float, tau: float, sign: float, tmp_path: Path
) -> None:
    material = from_dsc(written(tmp_path / "salt.csv", degree, tau, noise=0.002, sign=sign))
    heating, cooling = material.runs
    assert heating.latent_heat == pytest.approx(LATENT, rel=0.01)
    # Over time; over temperature the rise would be counted with the wrong sign.
    # It is that at the temperature at which it freezes.
    assert cooling.latent_heat == pytest.approx(LATENT - (LIQUID - SOLID) * degree, rel=0.01)
    law = material.description(conductivity=0.5, density=1500.0, supercooling=True)["hysteresis"]
    assert law["model"] == "supercooling"
    assert law["degree"] == pytest.approx(degree, abs=0.15)
    assert law["time_constant"] == pytest.approx(tau, rel=0.08)


def test_such_a_material_is_written_and_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written(tmp_path / "salt.csv", 6.0, 120.0)
    monkeypatch.chdir(tmp_path)
    options = ["--conductivity", "0.5", "--density", "1500", "-o", "salt.yaml"]
    assert cli.main(["dsc", "salt.csv", "--supercooling", *options]) == 0
    text = (tmp_path / "salt.yaml").read_text(encoding="utf-8")
    assert "model: supercooling" in text
    room = mc.new_room("3x3x2.5").to_dict()
    room["materials"]["salt"] = yaml.safe_load(text)["materials"]["salt"]
    checked = mc.Building.from_dict(room)
    assert "Supercooling" in str(checked.materials["salt"])


def test_what_cannot_be_seen_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "heating.csv"
    file.write_text(table(*heated(15.0, 42.0)), encoding="utf-8")
    with pytest.raises(InputError, match="found heating; expected a heating run, and a cooling run"):
        from_dsc(file).description(supercooling=True)
    assert "hysteresis" not in from_dsc(file).description()


def test_a_first_row_that_is_far_away_is_refused(tmp_path: Path) -> None:
    seconds, temperature, flow = heated(15.0, 42.0)
    temperature[0] = 60.0
    file = tmp_path / "glitch.csv"
    file.write_text(table(seconds, temperature, flow), encoding="utf-8")
    with pytest.raises(InputError, match="expected"):
        from_dsc(file)
