from __future__ import annotations

import csv
from collections import defaultdict
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from mascarin.building import PhaseChangeMaterial
from mascarin.errors import InputError
from mascarin.materials import Product, product, products, search
from mascarin.materials.library import (
    COLLECTION,
    KINDS,
    PROPERTIES,
    capacities,
    curves,
    enthalpy_curves,
    suggestion,
)
from mascarin.materials.plots import plot

#: What the collection calls a product, where it is more than maker and name.
PREFIXES = ("Rubitherm_", "Croda_", "PLUSS_", "")


def collected(folder: Path) -> dict[str, dict[str, str]]:
    with (folder / "pcm" / "pcm_products.csv").open(encoding="utf-8") as file:
        return {row["id"]: row for row in csv.DictReader(file)}


def name_there(one: Product, known: dict[str, dict[str, str]]) -> str:
    return next(p + one.name.replace("-", "_") for p in PREFIXES if p + one.name.replace("-", "_") in known)


def from_collection() -> list[Product]:
    return [one for one in products().values() if COLLECTION in one.source]


def test_there_are_enough_products_with_sources() -> None:
    assert len(products()) >= 25
    for one in products().values():
        assert one.source
        assert one.kind is None or one.kind in KINDS
        assert one.heating is not None or "law" in one.raw
    names = ["Energain", "RT21", "RT28HC", "SP21EK", "SP26E", "Crodatherm-21", "SmartBoard-26"]
    assert set(names) <= set(products())


@pytest.mark.parametrize("one", from_collection(), ids=lambda one: one.name)
def test_the_numbers_are_those_of_the_collection(one: Product, data_dir: Path) -> None:
    rows = collected(data_dir)
    row = rows[name_there(one, rows)]
    assert one.number("latent_heat") == pytest.approx(1000 * float(row["latent_kJ_kg"]), abs=0.6)
    assert one.melting_range == (float(row["T_melt_start_C"]), float(row["T_melt_end_C"]))
    for key, short in zip(PROPERTIES, ("k", "rho", "cp"), strict=True):
        assert one.pair(key) == (float(row[f"{short}_solid"]), float(row[f"{short}_liquid"]))
    if one.note is None and "data sheet" in one.source.lower():
        assert row["data_from"].split()[-1].strip(".") in one.source  # the day the sheet was read


def test_the_curves_are_those_of_the_collection(data_dir: Path) -> None:
    """Liquid fractions to the digits kept; between the points within 2 % of the transition."""
    there: dict[tuple[str, str], dict[float, float]] = defaultdict(dict)
    with (data_dir / "pcm" / "pcm_curves_8_60C.csv").open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            there[row["id"], row["direction"]][float(row["T_C"])] = float(row["liquid_fraction"])
    rows = collected(data_dir)
    for one in from_collection():
        for direction, curve in curves(one):
            published = there[name_there(one, rows), direction]
            for t, fraction in zip(curve.temperatures, curve.liquid_fraction, strict=True):
                assert fraction == pytest.approx(published[t], abs=6e-5), (one.name, direction, t)
            outside = [xi for t, xi in published.items() if not curve.first <= t <= curve.temperatures[-1]]
            assert all(min(xi, 1 - xi) < 1e-4 for xi in outside)


def test_heating_and_cooling_meet_in_the_liquid() -> None:
    """Enthalpy is a function of temperature and liquid fraction: no heat is made by going round."""
    for one in products().values():
        ends = {round(enthalpies[-1], 0) for _, _, enthalpies in enthalpy_curves(one)}
        assert len(ends) == 1, one.name
        assert all(
            after > before
            for _, _, enthalpies in enthalpy_curves(one)
            for before, after in pairwise(enthalpies)
        )


def test_enthalpy_includes_latent_and_sensible_heat() -> None:
    """RT25HC, equal specific heats: 2000 J/(kg K) times the span and the latent heat."""
    one = product("RT25HC")
    _, temperatures, enthalpies = next(enthalpy_curves(one))
    assert enthalpies[-1] == pytest.approx(198904 + 2000 * (temperatures[-1] - temperatures[0]))
    middles = capacities(temperatures, enthalpies)
    peak = max(middles, key=lambda point: point[1])
    assert peak[0] == pytest.approx(24.75, abs=0.5)
    assert sum(c * (b - a) for (_, c), (a, b) in zip(middles, pairwise(temperatures), strict=True)) == (
        pytest.approx(enthalpies[-1], rel=1e-9)
    )


def test_the_salt_hydrate_may_supercool() -> None:
    salt = PhaseChangeMaterial.from_product(
        "CaCl2-6H2O", hysteresis={"model": "supercooling", "degree": 12, "time_constant": 900}
    )
    assert salt.latent_heat is not None
    assert float(salt.latent_heat) == 190800
    assert salt.one_curve is not None
    assert salt.one_curve.coldest_liquid(salt.reference) == 17.0
    again = PhaseChangeMaterial(**salt.written())
    assert again == salt
    assert PhaseChangeMaterial.from_product("CaCl2-6H2O").hysteresis is None


def test_energain_is_that_of_the_paper() -> None:
    one = product("energain")
    assert (one.melting_temperature, one.number("latent_heat")) == (23.4, 71000)
    assert one.pair("specific_heat") == (3134, 2833)
    assert one.pair("conductivity") == (0.22, 0.18)
    assert one.pair("density") == (855, 855)
    assert (one.heating, one.freezing_temperature) == (None, None)
    ((what, _, enthalpies),) = enthalpy_curves(one)
    assert what == "tanh law, half-width 1 K"
    # tanh(4) leaves 0.03 % of the latent heat outside four half-widths on each side.
    assert enthalpies[-1] == pytest.approx(71000 + 4 * (3134 + 2833), rel=1e-3)


def test_names_are_found_in_any_spelling() -> None:
    assert product("rt 25 hc") is product("RT25HC") is product("RT25-HC")
    with pytest.raises(InputError, match="Did you mean 'RT25HC'"):
        product("RT25HD")
    assert suggestion("Energane") == "Did you mean 'Energain'?"
    assert suggestion("xyzzy") == ""


def test_search() -> None:
    found = search(melting=(22.0, 24.0), kind="salt hydrate")
    assert [one.name for one in found] == ["savE-HS22", "ClimSel-C21", "SP24E"]
    assert {one.name for one in search("knauf")} == {"SmartBoard-21", "SmartBoard-26"}
    assert search("RT", melting=(27.0, 28.0))[0].name == "RT28HC"
    with pytest.raises(InputError, match="Known: board"):
        search(kind="salts")
    with pytest.raises(InputError, match="lower end first"):
        search(melting=(28.0, 22.0))


def test_unknown_values_stay_empty() -> None:
    bare = Product("x", "y", None, None, "z", None, None, None, {"latent_heat": 1e5})
    assert bare.missing == PROPERTIES
    assert bare.pair("density") is None
    assert (bare.melting_temperature, bare.melting_range) == (None, None)
    assert list(enthalpy_curves(bare)) == []
    with pytest.raises(ValueError, match="a property that the enthalpy needs is not known"):
        bare.enthalpies([0.0, 1.0], [0.0, 1.0])


def test_the_text_of_a_product_is_one_short_line() -> None:
    assert repr(product("Energain")) == "Product('Energain', sheet, melts at 23.4 degC, 71 kJ/kg)"
    assert max(len(repr(one)) for one in products().values()) <= 100


def test_plot() -> None:
    figure = plot([product("RT25HC"), product("Energain")])
    labels = [str(line.get_label()) for line in figure.axes[0].lines]
    assert labels == ["RT25HC, heating", "RT25HC, cooling", "Energain, tanh law, half-width 1 K"]
    with pytest.raises(InputError, match="1 to 8 products"):
        plot(list(products().values()), ax=figure.axes)


def test_plot_of_every_product_has_a_panel_for_each() -> None:
    figure = plot(list(products().values()))
    shown = {axes.get_title(): axes for axes in figure.axes if axes.get_visible()}
    assert set(shown) == set(products())
    heated = shown["RT25HC"].lines[0].get_ydata()
    assert float(np.ptp(heated)) > 198.9  # the latent heat and some sensible heat [kJ/kg]
