"""What a conversion reads is what its handlers declare, and what they write reaches the building."""

from __future__ import annotations

from pathlib import Path

import pytest

from mascarin.building.parts.description import Description
from mascarin.energyplus import convert
from mascarin.energyplus.model.context import SECTIONS, Context
from mascarin.energyplus.model.handlers import HANDLERS, reads
from mascarin.energyplus.model.idf import IdfModel, read
from mascarin.energyplus.zones.conditioning import describe_conditioning
from mascarin.energyplus.zones.radiant import Envelope
from mascarin.energyplus.zones.zones import Zone
from test_convert import box, converted

TEXT = """\
Version,25.2;
Timestep,4;
Site:Location,Somewhere,40,-75,-5,100;
Material,Brick,Rough,0.2,0.8,1800,900;
Material,Unused,Rough,0.1,0.8,1800,900;
Construction,Wall,Brick;
Zone,Room,0,0,0,0,1,1,3,60;
InternalMass,Mass,Wall,Room,,10;
ZoneControl:Humidistat,Damp,Room,Half;
"""


def model_of(tmp_path: Path, text: str = TEXT) -> IdfModel:
    file = tmp_path / "model.idf"
    file.write_text(text, encoding="utf-8")
    return read(file)


def test_looking_at_a_class_is_not_reading_it(tmp_path: Path) -> None:
    model = model_of(tmp_path)
    assert len(model.of("Material")) == 2
    assert model.named("Damp", "ZoneControl:Humidistat") is not None
    assert {"Material", "ZoneControl:Humidistat"} <= {kind for kind, _ in model.unread()}


def test_a_handler_says_what_it_has_read(tmp_path: Path) -> None:
    context = Context(model_of(tmp_path))

    @reads("Material")
    def names(context: Context) -> list[str]:
        return [item.name for item in context.model.of("Material")]

    try:
        assert "Material" in {kind for kind, _ in context.model.unread()}
        assert names(context) == ["Brick", "Unused"]
        assert "Material" not in {kind for kind, _ in context.model.unread()}
        assert HANDLERS["material"][-1].endswith("names")
    finally:
        HANDLERS["material"].pop()


def test_every_class_that_is_looked_up_has_a_handler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without one, its objects would be called left out although they are read."""
    models: list[IdfModel] = []

    def remembered(path: Path) -> IdfModel:
        models.append(read(path))
        return models[-1]

    monkeypatch.setattr("mascarin.energyplus.conversion.read", remembered)
    converted(tmp_path, box())
    assert len(models[0].looked_up) > 40
    assert models[0].looked_up <= set(HANDLERS)
    assert models[0].read <= set(HANDLERS)


def test_what_no_handler_reads_is_left_out_by_name(tmp_path: Path) -> None:
    (tmp_path / "model.idf").write_text(TEXT, encoding="utf-8")
    findings = convert(tmp_path / "model.idf").findings
    assert [entry.name for entry in findings if entry.kind == "ZoneControl:Humidistat"] == ["Damp"]
    assert not [entry for entry in findings if entry.kind in ("Version", "RunPeriod", "Zone")]
    unused = [(entry.level, entry.name) for entry in findings if entry.kind == "Material"]
    assert unused == [("no effect", "Unused")], "what nothing names has no effect"


def test_every_section_of_a_description_can_be_written(tmp_path: Path) -> None:
    """No list of sections stands in between: humidity, vents, controls, units and sensors arrive as well."""
    context = Context(model_of(tmp_path))
    names = [name for name in Description.model_fields if name != "name"]
    for name in reversed(names):
        context.section(name)["part"] = {}
    assert list(context.ordered()) == names == list(SECTIONS)
    with pytest.raises(KeyError, match="expected one of site, weather, dimensions, materials"):
        context.section("sensor")


def test_a_section_that_a_handler_writes_reaches_the_building(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A step of the conversion that adds a vent and humidity: both are in the building that comes out."""

    def with_humidity(context: Context, zones: dict[str, Zone], envelope: Envelope) -> None:
        describe_conditioning(context, zones, envelope)
        context.section("humidity")["zones"] = {"Room": {"storage": 2.0}}
        context.section("sensors")["middle"] = {"surface": "Mass", "depth": 0.02}

    monkeypatch.setattr("mascarin.energyplus.conversion.describe_conditioning", with_humidity)
    (tmp_path / "model.idf").write_text(TEXT, encoding="utf-8")
    conversion_result = convert(tmp_path / "model.idf")
    assert conversion_result.building.humidity is not None
    assert list(conversion_result.building.sensors) == ["middle"]
    assert "humidity" in conversion_result.description
