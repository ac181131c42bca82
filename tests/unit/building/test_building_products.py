"""Products of the library in a building file."""

from __future__ import annotations

import jsonschema
import pytest

from building_samples import ROOM
from mascarin.building import Building, check, json_schema
from mascarin.building.parts.materials.material import PhaseChangeMaterial
from mascarin.building.parts.materials.phase_change import FractionsLaw, TableLaw, TanhLaw
from mascarin.building.reading import parse, plain
from mascarin.errors import InputError
from mascarin.materials import Product, library, product


def text(material: str) -> str:
    return ROOM.replace("materials:\n", f"materials:\n  pcm: {{{material}}}\n").replace(
        "      - {material: concrete, thickness: 0.2}\n",
        "      - {material: concrete, thickness: 0.2}\n      - {material: pcm, thickness: 0.01}\n",
    )


def building(material: str) -> Building:
    return parse(text(material), "room.yaml")


def pcm(material: str) -> PhaseChangeMaterial:
    found = building(material).materials["pcm"]
    assert isinstance(found, PhaseChangeMaterial)
    return found


def values(material: PhaseChangeMaterial, *names: str) -> list[float]:
    return [float(getattr(material, name)) for name in names]


def test_a_product_is_a_material_with_its_numbers_and_sources() -> None:
    taken = building("product: rt25hc")
    material = taken.materials["pcm"]
    assert isinstance(material, PhaseChangeMaterial)
    assert material.product == "RT25HC"
    density = taken.parameter("materials.pcm.density.solid")
    assert (density.value, density.structural) == (880, False)
    assert density.source == product("RT25HC").source
    assert [source for source in taken.sources() if "RT25HC" in source] == [product("RT25HC").source]
    assert isinstance(material.law, TableLaw)
    curve = product("RT25HC").heating
    assert curve is not None
    assert tuple(map(float, material.law.temperatures)) == curve.temperatures
    assert taken.parameter("materials.pcm.law.temperature_shift").varies
    assert taken.to_engine().json


def test_a_curve_is_chosen_by_its_name() -> None:
    law = pcm("product: RT25HC, law: cooling").law
    assert isinstance(law, TableLaw)
    assert law.melting == (14.0, 28.0)
    with pytest.raises(InputError, match=r"law: heating, the curves known of RT28HC"):
        pcm("product: RT28HC, law: cooling")


def test_given_values_replace_those_of_the_product() -> None:
    material = pcm("product: Energain, density: 870, melting_temperature: {value: 22, range: [21, 23]}")
    assert values(material, "density", "melting_temperature", "latent_heat") == [870, 22, 71000]
    assert isinstance(material.law, TanhLaw)
    assert material.law.width == 1.0
    taken = building("product: Energain, density: 870")
    assert taken.parameter("materials.pcm.density").source in (None, "")
    assert "4.5 kg/m2" in str(building("product: Energain").parameter("materials.pcm.density").source)


def test_a_law_by_width_takes_latent_heat_and_melting_temperature_from_the_product() -> None:
    material = pcm("product: RT28HC, law: {kind: tanh, width: 0.5}")
    assert values(material, "latent_heat") == [220000]
    assert float(material.melting_temperature or 0) == product("RT28HC").melting_temperature == 27.63


def test_other_values_can_be_given_beside_a_product() -> None:
    other = building("product: RT25HC").replace(
        {"materials.pcm.density.solid": 900, "materials.pcm.law": "cooling"}
    )
    material = other.materials["pcm"]
    assert isinstance(material, PhaseChangeMaterial)
    assert material.law == pcm("product: RT25HC, law: cooling").law
    assert other.parameter("materials.pcm.density.solid").value == 900


@pytest.mark.parametrize(
    ("material", "message"),
    [
        ("product: RT25", "a product of the library\n  Did you mean 'RT25HC'"),
        ("product: 25", "expected: the name of a product"),
        ("product: RT25HC, kind: solid", "RT25HC is a phase-change material"),
        ("product: RT25HC, densty: 1", "Did you mean 'density'?"),
        ("product: RT25HC, latent_heat: 1.0e5", "the rise of the table"),
    ],
)
def test_errors_of_products_have_line_and_path(material: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        building(material)
    assert message in str(caught.value)
    assert str(caught.value).startswith("room.yaml:4: materials.pcm")


def test_unknown_properties_must_be_given(monkeypatch: pytest.MonkeyPatch) -> None:
    bare = Product(
        "Bare", "y", None, None, "a leaflet", None, None, None, {"latent_heat": 1e5, "density": 900}
    )
    monkeypatch.setattr(library, "products", lambda: {"Bare": bare})
    with pytest.raises(
        InputError, match="no conductivity and no specific_heat; the source of Bare does not give it"
    ):
        pcm("product: Bare")
    given = "product: Bare, conductivity: 0.2, specific_heat: 2000"
    with pytest.raises(InputError, match="no law; Bare has no curves"):
        pcm(given)
    with pytest.raises(InputError, match="melting_temperature: needed"):
        pcm(f"{given}, law: {{kind: tanh, width: 1}}")
    material = pcm(f"{given}, melting_temperature: 25, law: {{kind: tanh, width: 1}}")
    assert values(material, "latent_heat", "density") == [1e5, 900]


def test_the_schema_allows_the_short_form() -> None:
    validator = jsonschema.Draft202012Validator(json_schema())
    validator.validate(plain(text("product: RT25HC"), "room.yaml"))


def test_hysteresis_takes_both_curves_of_a_product() -> None:
    taken = building("product: RT25HC, hysteresis: {model: curve_switch}")
    material, one = taken.materials["pcm"], product("RT25HC")
    assert isinstance(material, PhaseChangeMaterial)
    assert one.heating is not None
    assert one.cooling is not None
    assert isinstance(material.law, FractionsLaw)
    assert material.law.temperatures == one.heating.temperatures
    assert material.cooling is not None
    law, centre = material.cooling
    assert isinstance(law, FractionsLaw)
    for t, x in zip(one.cooling.temperatures, one.cooling.liquid_fraction, strict=True):
        assert law.fraction(t - centre) == pytest.approx(x, abs=1e-12)
    assert taken.parameter("materials.pcm.hysteresis.law.temperature_shift").varies
    assert '"kind":"history"' in taken.to_engine().json.replace(" ", "")
    assert material.written() == {"product": "RT25HC", "hysteresis": {"model": "curve_switch"}}
    assert PhaseChangeMaterial(**material.written()) == material
    other = taken.replace({"materials.pcm.product": "RT24HC"}).materials["pcm"]
    assert other == pcm("product: RT24HC, hysteresis: {model: curve_switch}")


def test_hysteresis_works_with_every_product_whose_curves_do_not_cross() -> None:
    crossed = []
    for name, one in library.products().items():
        if one.heating is None or one.cooling is None:
            continue
        more = {key: {"conductivity": 0.2, "density": 900}[key] for key in one.missing}
        try:
            material = PhaseChangeMaterial.from_product(name, hysteresis={"model": "curve_track"}, **more)
        except InputError as error:
            assert "never more liquid on heating than on cooling" in str(error)  # noqa: PT017
            crossed.append(name)
            continue
        # The enthalpy of all liquid over all solid is that of the table of the product.
        solid, liquid = (float(x) for x in one.pair("specific_heat") or (0.0, 0.0))
        low, high = material.melting
        by_law = (
            solid * (material.reference - low)
            + liquid * (high - material.reference)
            + float(material.latent_heat or 0.0)
        )
        assert by_law == pytest.approx(one.enthalpies([low, high], [0.0, 1.0])[1], abs=1.0)
    assert crossed == ["RT21HC", "PX25", "Crodatherm-19", "Crodatherm-21", "SmartBoard-21"]


@pytest.mark.parametrize(
    ("material", "message"),
    [
        ("product: RT28HC, hysteresis: {model: curve_switch}", "the source of RT28HC does not give it"),
        ("product: RT25HC, law: cooling, hysteresis: {model: curve_switch}", "cooling beside hysteresis"),
        ("product: RT25HC, hysteresis: {model: curve_switch, law: heating}", "hysteresis.law: cooling"),
        ("product: Energain, hysteresis: {model: curve_switch}", "freezing_temperature: needed"),
        ("product: RT25HC, hysteresis: {model: odd}", "curve_track"),
        ("product: RT25HC, hysteresis: 3", "hysteresis"),
    ],
)
def test_hysteresis_that_a_product_cannot_have_is_refused_with_the_reason(
    material: str, message: str
) -> None:
    with pytest.raises(InputError) as caught:
        building(material)
    assert message in str(caught.value)
    assert str(caught.value).startswith("room.yaml:4: materials.pcm")


def test_hysteresis_beside_a_product_takes_other_curves_too() -> None:
    shifted = pcm(
        "product: RT25HC, law: {temperature_shift: 1}, "
        "hysteresis: {model: curve_scale, law: {curve: cooling, temperature_shift: -1}}"
    )
    assert isinstance(shifted.law, FractionsLaw)
    assert float(shifted.law.temperature_shift) == 1.0
    assert shifted.cooling is not None
    assert shifted.cooling[1] == -1.0
    assert PhaseChangeMaterial(**shifted.written()) == shifted
    lower = pcm("product: Energain, hysteresis: {model: curve_switch, freezing_temperature: 20}")
    assert lower.cooling is not None
    assert lower.cooling[1] == 20.0


def test_a_curve_that_is_not_used_is_said() -> None:
    def said(material: str) -> list[str]:
        return [line for line in check(building(material)) if "is not used" in line]

    assert "RT25HC freezes by its cooling curve" in said("product: RT25HC")[0]
    assert "RT25HC melts by its heating curve" in said("product: RT25HC, law: cooling")[0]
    assert said("product: RT25HC, hysteresis: {model: curve_switch}") == []
    assert said("product: RT28HC") == said("product: RT25HC, law: {kind: tanh, width: 1}") == []


def test_the_heat_of_a_product_has_the_tolerance_of_its_maker() -> None:
    """Within 7.5 % by the maker and 10 % between calorimeters: both in quadrature, 12.5 %."""
    scale = building("product: RT25HC").parameter("materials.pcm.law.enthalpy_scale")
    assert (scale.low, scale.high) == pytest.approx((0.875, 1.125))
    assert "data sheets of Rubitherm" in (scale.source or "")
    latent = building("product: RT25HC, law: {kind: tanh, width: 1}").parameter("materials.pcm.latent_heat")
    assert (latent.low / latent.value, latent.high / latent.value) == pytest.approx((0.875, 1.125))
    stated = building("product: RT25HC, law: {enthalpy_scale: {value: 1, range: [0.99, 1.01]}}")
    assert stated.parameter("materials.pcm.law.enthalpy_scale").high == 1.01
    other = building("product: Energain").parameter("materials.pcm.latent_heat")
    assert (other.low / other.value, other.high / other.value) == pytest.approx((0.9, 1.1))
