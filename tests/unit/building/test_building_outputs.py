"""Names of results: unique, and known to the engine."""

from __future__ import annotations

import pytest

from building_samples import everything, room
from mascarin.errors import InputError


def test_the_results_of_a_room() -> None:
    assert [(output.name, output.unit) for output in room().outputs()] == [
        ("room.air_temperature", "degC"),
        ("room.mean_radiant_temperature", "degC"),
        ("room.operative_temperature", "degC"),
        ("room.globe_temperature", "degC"),
        ("room.air_changes", "1/h"),
        ("room.total_air_changes", "1/h"),
        ("south.outside_temperature", "degC"),
        ("south.inside_temperature", "degC"),
        ("south.outside_flux", "W/m2"),
        ("south.inside_flux", "W/m2"),
        ("south.concrete_flux", "W/m2"),
        ("south.incident_solar", "W/m2"),
        ("south.incident_beam", "W/m2"),
        ("south.incident_diffuse", "W/m2"),
        ("south.sky_view_factor", "-"),
        ("south.ground_view_factor", "-"),
        ("south.outside_absorbed_solar", "W/m2"),
        ("south.outside_longwave", "W/m2"),
        ("south.outside_convection", "W/(m2 K)"),
        ("south.inside_longwave", "W/m2"),
        ("south.inside_convection", "W/(m2 K)"),
        ("rest.outside_temperature", "degC"),
        ("rest.inside_temperature", "degC"),
        ("rest.outside_flux", "W/m2"),
        ("rest.inside_flux", "W/m2"),
        ("rest.concrete_flux", "W/m2"),
        ("rest.inside_longwave", "W/m2"),
        ("rest.inside_convection", "W/(m2 K)"),
        ("sky_temperature", "degC"),
        ("sun_altitude", "deg"),
        ("sun_azimuth", "deg"),
        ("core.temperature", "degC"),
    ]


def test_names_and_aliases_are_unique() -> None:
    names = [name for output in everything()[0].outputs() for name in (output.name, *output.aliases)]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize(
    ("name", "kind", "place"),
    [
        ("attic.air_temperature", "air_temperature", {"zone": 1}),
        ("roof.inside_temperature", "face_temperature", {"surface": 0, "side": 1}),
        ("ceiling.outside_flux", "face_flux", {"surface": 1, "side": 0}),
        ("ceiling.interface_2_temperature", "interface_temperature", {"surface": 1, "interface": 2}),
        ("ceiling.salt_curve_temperature", "interface_temperature", {"surface": 1, "interface": 2}),
        ("roof.gap_flux", "layer_flux", {"surface": 0, "layer": 1}),
        ("ceiling.salt_liquid_fraction", "liquid_fraction", {"surface": 1, "layer": 1}),
        ("ceiling.curve_enthalpy", "layer_enthalpy", {"surface": 1, "layer": 2}),
        ("core.temperature", "sensor", {"sensor": 0}),
    ],
)
def test_names_have_kind_and_position(name: str, kind: str, place: dict[str, int]) -> None:
    output = everything()[0].output(name)
    assert (output.kind, output.place) == (kind, place)


def test_only_phase_change_layers_have_a_liquid_fraction() -> None:
    melting = {output.name for output in everything()[0].outputs() if output.kind == "liquid_fraction"}
    assert melting == {f"ceiling.{layer}_liquid_fraction" for layer in ("wax", "salt", "curve")}


def test_an_unknown_output_names_the_nearest() -> None:
    with pytest.raises(InputError, match=r"Did you mean 'room\.air_temperature'"):
        room().output("room.air_temperatur")
