"""A calorimeter file of a known material gives that material."""

from __future__ import annotations

import csv
from collections import defaultdict
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from building_samples import ROOM
from dsc_samples import CENTRE, LATENT, LIQUID, RATE, SOLID, WIDTH, enthalpy, heat, temperatures, write
from mascarin.building.parts.materials.material import PhaseChangeMaterial
from mascarin.building.parts.materials.phase_change import TableLaw
from mascarin.building.reading import parse
from mascarin.errors import InputError
from mascarin.materials.dsc import DscMaterial, from_dsc
from mascarin.materials.dsc_yaml import to_yaml


def is_the_known_one(material: DscMaterial, direction: str = "heating") -> None:
    run = next(run for run in material.runs if run.direction == direction)
    assert run.latent_heat == pytest.approx(LATENT, rel=2e-3)
    assert run.specific_heat == pytest.approx((SOLID, LIQUID), rel=2e-3)
    assert run.half == pytest.approx(CENTRE, abs=0.02)
    best = run.fits[0]
    assert best.law.name == "tanh"
    assert best.melting_temperature == pytest.approx(CENTRE, abs=0.02)
    assert best.widths == pytest.approx((WIDTH,), rel=0.02)
    assert best.residual < 2e-3


def test_specific_heat(tmp_path: Path) -> None:
    t = temperatures()
    file = write(tmp_path / "a.csv", {"temperature [degC]": t, "cp [J/(g K)]": heat(t) / 1000})
    material = from_dsc(file)
    is_the_known_one(material)
    run = material.main
    assert (run.direction, run.rate) == ("heating", None)
    assert run.peak == pytest.approx(CENTRE, abs=0.05)
    # sech^2 is steepest at 0.6585 w from its centre, where its tangent meets zero 0.8660 w further out.
    assert run.onset == pytest.approx(CENTRE - (0.6585 + 0.8660) * WIDTH, abs=0.05)
    assert run.end == pytest.approx(CENTRE + (0.6585 + 0.8660) * WIDTH, abs=0.05)
    assert run.melting_range == pytest.approx((CENTRE - 3.1 * WIDTH, CENTRE + 3.1 * WIDTH), abs=0.1)


@pytest.mark.parametrize(
    ("name", "factor"),
    [
        ("cp [J/(kg K)]", 1.0),
        ("cp/(kJ kg^-1 K^-1)", 1e-3),
        ("Specific heat (J/g/K)", 1e-3),
        ("c [J/(g·K)]", 1e-3),
    ],
)
def test_units_of_specific_heat(name: str, factor: float, tmp_path: Path) -> None:
    t = temperatures()
    file = write(tmp_path / "a.csv", {"T [K]": t + 273.15, name: factor * heat(t)})
    is_the_known_one(from_dsc(file))


def test_heat_flow_with_time_as_an_instrument_writes_it(tmp_path: Path) -> None:
    """Lines above the names, ';', decimal commas, time in minutes, mW/mg."""
    t = temperatures()
    columns = {
        "##Temp./°C": t,
        "Time/min": (t - t[0]) / RATE,
        "DSC/(mW/mg)": heat(t) * RATE / 60 / 1000,
    }
    file = write(
        tmp_path / "a.csv",
        columns,
        separator=";",
        number=lambda x: f"{x:.8g}".replace(".", ","),
        head="#INSTRUMENT: a\n#SAMPLE: wax\n",
    )
    material = from_dsc(file)
    is_the_known_one(material)
    assert material.main.rate == pytest.approx(RATE)
    assert material.warnings == ()


def test_heat_flow_of_the_sample_with_the_opposite_sign(tmp_path: Path) -> None:
    t, mass = temperatures(), 12.5  # mg
    flow = -heat(t) * RATE / 60 * mass * 1e-6 * 1000  # mW, heat given off upwards
    file = write(tmp_path / "a.csv", {"temperature [degC]": t, "heat flow [mW]": flow})
    with pytest.raises(InputError, match="no heating rate"):
        from_dsc(file)
    with pytest.raises(InputError, match="expected its mass"):
        from_dsc(file, rate=RATE)
    material = from_dsc(file, rate=RATE, mass=mass)
    is_the_known_one(material)
    assert "sign changed" in material.warnings[0]


def test_enthalpy(tmp_path: Path) -> None:
    t = temperatures()
    file = write(tmp_path / "a.csv", {"temperature [degC]": t, "enthalpy [kJ/kg]": enthalpy(t) / 1000})
    is_the_known_one(from_dsc(file))


def test_a_subtracted_baseline(tmp_path: Path) -> None:
    t = temperatures()
    slope = 0.5 / (WIDTH * np.cosh((t - CENTRE) / WIDTH) ** 2) * LATENT
    file = write(tmp_path / "a.csv", {"temperature [degC]": t, "cp [J/(kg K)]": slope})
    with pytest.raises(InputError, match=r"expected specific_heat=\(solid, liquid\)"):
        from_dsc(file)
    run = from_dsc(file, specific_heat=(2000.0, 2000.0)).main
    assert run.latent_heat == pytest.approx(LATENT, rel=1e-3)
    assert run.half == pytest.approx(CENTRE, abs=0.01)


def test_heating_then_cooling_in_one_column(tmp_path: Path) -> None:
    t = temperatures()
    both = np.concatenate([t, t[::-1]])
    values = np.concatenate([heat(t), heat(t[::-1], CENTRE - 2.0)])
    material = from_dsc(write(tmp_path / "a.csv", {"temperature [degC]": both, "cp [J/(kg K)]": values}))
    assert [run.direction for run in material.runs] == ["heating", "cooling"]
    is_the_known_one(material)
    assert material.runs[1].half == pytest.approx(CENTRE - 2.0, abs=0.02)
    assert "freezes 2.0 K below where it melts" in material.warnings[0]


def test_heating_and_cooling_in_two_columns(tmp_path: Path) -> None:
    t = temperatures()
    columns = {
        "temperature [degC]": t,
        "cp cooling [J/(kg K)]": 0.9 * heat(t, CENTRE - 2.0),
        "cp heating [J/(kg K)]": heat(t),
    }
    material = from_dsc(write(tmp_path / "a.csv", columns))
    assert material.main.direction == "heating"
    is_the_known_one(material)
    assert "latent heat on heating and cooling differ by 10%" in material.warnings[0]


def test_noise_changes_little(tmp_path: Path) -> None:
    t = temperatures()
    noisy = heat(t) + np.random.default_rng(1).normal(0.0, 200.0, len(t))
    material = from_dsc(write(tmp_path / "a.csv", {"temperature [degC]": t, "cp [J/(kg K)]": noisy}))
    assert material.main.latent_heat == pytest.approx(LATENT, rel=0.02)
    assert material.main.half == pytest.approx(CENTRE, abs=0.05)
    temperatures_, enthalpies = (material.description()["law"][key] for key in ("temperatures", "enthalpies"))
    assert all(b > a for a, b in pairwise(temperatures_))
    assert all(b > a for a, b in pairwise(enthalpies))


def test_a_fast_heating_rate_gives_a_warning(tmp_path: Path) -> None:
    t = temperatures()
    file = write(tmp_path / "a.csv", {"temperature [degC]": t, "DSC [W/g]": heat(t) * 10 / 60 / 1000})
    assert "10 K/min is faster than in any wall" in from_dsc(file, rate=10.0).warnings[0]
    assert from_dsc(file, rate=10.0).main.latent_heat == pytest.approx(LATENT, rel=2e-3)


def test_a_file_that_begins_inside_the_melting(tmp_path: Path) -> None:
    t = temperatures()
    for first, message in ((CENTRE - 1.2, "begins and ends outside the melting"), (CENTRE - 3.0, "")):
        part = t[t > first]
        file = write(tmp_path / "a.csv", {"temperature [degC]": part, "cp [J/(kg K)]": heat(part)})
        if message:
            with pytest.raises(InputError, match=message):
                from_dsc(file)
    material = from_dsc(file)
    assert any("begins where the specific heat still changes" in text for text in material.warnings)


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (("temperature [degC]", "cp [J/(kg K)]", 1e-3, 0.0), r"With J/\(g K\) or kJ/\(kg K\) it could be"),
        (("temperature [degC]", "cp [J/(g K)]", 1.0, 0.0), r"With J/\(kg K\) it could be"),
        (("temperature [degC]", "cp [W/m]", 1.0, 0.0), "found the unit 'w/m'"),
        (("temperature [degC]", "cp [J/(kg K)]", 1.0, 273.15), "They look like kelvins"),
        (("temperature [K]", "cp [J/(kg K)]", 1.0, 0.0), "They look like degC"),
        (("temperature [degC]", "colour", 1.0, 0.0), "expected a signal"),
        (("depth [m]", "cp [J/(kg K)]", 1.0, 0.0), "found 0 columns of temperature"),
        (("temperature [degC]", "DSC", 1.0, 0.0), "found no unit"),
    ],
)
def test_wrong_units(columns: tuple[str, str, float, float], message: str, tmp_path: Path) -> None:
    first, second, factor, shift = columns
    t = temperatures()
    file = write(tmp_path / "a.csv", {first: t + shift, second: factor * heat(t)})
    with pytest.raises(InputError, match=message) as caught:
        from_dsc(file)
    assert str(caught.value).startswith(f"{file}:1: ")


def test_a_unit_can_be_given(tmp_path: Path) -> None:
    t = temperatures()
    file = write(tmp_path / "a.csv", {"temperature [degC]": t, "DSC": heat(t) / 1000})
    is_the_known_one(from_dsc(file, unit="J/(g K)"))
    with pytest.raises(InputError, match="found 'furlong'"):
        from_dsc(file, unit="furlong")
    bare = write(tmp_path / "b.csv", {"temperature": t, "cp": heat(t) / 1000})
    material = from_dsc(bare)
    is_the_known_one(material)
    assert "has no unit: j/gk assumed" in material.warnings[0]


def test_wrong_order(tmp_path: Path) -> None:
    t = temperatures()
    shuffled = np.random.default_rng(1).permutation(len(t))
    file = write(tmp_path / "a.csv", {"temperature [degC]": t[shuffled], "cp [J/(kg K)]": heat(t)[shuffled]})
    with pytest.raises(InputError, match=r"row \d+: found .* expected temperatures in the order of the run"):
        from_dsc(file)
    falling = write(tmp_path / "b.csv", {"temperature [degC]": t, "h [J/g]": -enthalpy(t) / 1000})
    with pytest.raises(InputError, match="falls with temperature"):
        from_dsc(falling)


def test_other_errors(tmp_path: Path) -> None:
    t = temperatures()
    flat = write(tmp_path / "a.csv", {"temperature [degC]": t, "cp [J/(kg K)]": 2000.0 + 0 * t})
    with pytest.raises(InputError, match="no peak above the sensible heat"):
        from_dsc(flat)
    with pytest.raises(InputError, match="rate: found -1"):
        from_dsc(flat, rate=-1.0)
    good = write(tmp_path / "b.csv", {"temperature [degC]": t, "cp [J/(kg K)]": heat(t)})
    with pytest.raises(InputError, match="a range inside the file's 10 to 38 degC"):
        from_dsc(good, melting_range=(5.0, 30.0))
    is_the_known_one(from_dsc(good, melting_range=(19.0, 29.0)))
    (tmp_path / "c.csv").write_text("temperature [degC],cp [J/(kg K)]\n20,2000\n21,x\n" + "22,2000\n" * 10)
    with pytest.raises(InputError, match=r"row 3, column .* found 'x'"):
        from_dsc(tmp_path / "c.csv")
    (tmp_path / "d.csv").write_text("1,2\n3,4\n")
    with pytest.raises(InputError, match="no line of column names"):
        from_dsc(tmp_path / "d.csv")
    with pytest.raises(InputError, match="cannot be read"):
        from_dsc(tmp_path / "e.csv")
    with pytest.raises(InputError, match="Did you mean 'gaussian'"):
        from_dsc(good).description("gausian")


def test_the_table_is_a_material_of_a_building(tmp_path: Path) -> None:
    """Read back, the table holds latent and sensible heat of the range it spans."""
    t = temperatures()
    file = write(tmp_path / "wax.csv", {"temperature [degC]": t, "cp [J/(kg K)]": heat(t)})
    material = from_dsc(file)
    lines = to_yaml("wax", material.description(conductivity=(0.22, 0.18), density=855.0)).splitlines()
    text = ROOM.replace("materials:", "\n".join(lines))
    read = parse(text, "x.yaml").materials["wax"]
    assert isinstance(read, PhaseChangeMaterial)
    assert isinstance(read.law, TableLaw)
    assert read.source == "DSC, heating"
    first, last = float(read.law.temperatures[0]), float(read.law.temperatures[-1])
    known = enthalpy(np.array([first, last]))
    taken = float(read.law.enthalpies[-1]) - float(read.law.enthalpies[0])
    assert taken == pytest.approx(float(known[1] - known[0]), rel=2e-3)
    bare = to_yaml("wax", material.description())
    assert "# density:   a calorimeter does not measure it" in bare
    with pytest.raises(InputError, match=r"materials\.wax\.density\n  found: nothing"):
        parse(ROOM.replace("materials:", bare.rstrip()), "x.yaml")


def test_curves_of_real_products(data_dir: Path, tmp_path: Path) -> None:
    """Apparent specific heats as published give the published latent heat back, however they were made."""
    curves: dict[str, list[tuple[str, str, str]]] = defaultdict(list)
    with (data_dir / "pcm" / "pcm_curves_8_60C.csv").open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            curves[row["id"]].append((row["T_C"], row["cp_app_J_kgK"], row["direction"]))
    with (data_dir / "pcm" / "pcm_products.csv").open(encoding="utf-8") as file:
        published = {row["id"]: 1000 * float(row["latent_kJ_kg"]) for row in csv.DictReader(file)}
    for name in ("Rubitherm_RT25HC", "ClimSel_C28", "SmartBoard_26", "Rubitherm_RT35HC_DSC_10_Kmin"):
        path = tmp_path / f"{name}.csv"
        rows = [",".join(row) for row in curves[name]]
        path.write_text("temperature [degC],cp [J/(kg K)],direction\n" + "\n".join(rows), encoding="utf-8")
        material = from_dsc(path)
        assert [run.direction for run in material.runs] == list(dict.fromkeys(row[2] for row in curves[name]))
        for run in material.runs:
            assert run.latent_heat == pytest.approx(published[name], rel=0.005)
            assert run.fits[0].law.name in ("gumbel, tail low", "triangle")  # as polymers and paraffins do


def test_report_and_plot(tmp_path: Path) -> None:
    t = temperatures()
    file = write(tmp_path / "a.csv", {"temperature [degC]": t, "cp [J/(kg K)]": heat(t)})
    material = from_dsc(file)
    assert "latent heat    150.0 kJ/kg" in material.report()
    figure = material.plot()
    above, below = figure.axes
    # From 0 at the first temperature to sensible and latent heat at the last, in kJ/kg.
    measured, *_ = above.lines
    assert measured.get_label() == "heating"
    assert np.asarray(measured.get_ydata())[-1] == pytest.approx(np.trapezoid(heat(t), t) / 1000.0, rel=0.01)
    assert material.plot(ax=[above, below]) is figure
    array: Any = np.array([above, below])  # as `plt.subplots` gives them
    assert material.plot(ax=array) is figure
    with pytest.raises(InputError, match="expected one, or one for each unit"):
        material.plot(ax=[above, below, below])
    assert material.to_dict()["runs"]["heating"]["fits"]["tanh"]["law"]["kind"] == "tanh"
