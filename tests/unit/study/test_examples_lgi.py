"""The LGI cell as an example: complete, with the stated geometry, and with all assumptions marked."""

from __future__ import annotations

import csv
import hashlib
import re
from pathlib import Path

import pytest

from mascarin.building import Building, load
from mascarin.building.geometry import Polygon, view_factors, volume
from mascarin.examples import STUDIES
from mascarin.study import Study
from mascarin.study.context.storage import Workspace
from mascarin.study.file.experiments import read_study
from mascarin.study.steps.model_runs import ModelRuns, judged

FOLDER = STUDIES["lgi"].parent
SHA256 = "f148c2fc65ce14ee8cadda7b3ce04cdce9d4fc38abcd97bdc1402ee9edd31f96"


@pytest.fixture(scope="module")
def cell() -> Building:
    return load(FOLDER / "building.yaml")


def faces(cell: Building, zone: str) -> list[Polygon]:
    """Faces of a zone, looking into it."""
    found = []
    for name, surface in cell.surfaces.items():
        assert surface.vertices is not None
        polygon = Polygon.of(name, surface.vertices)
        if surface.outside.zone == zone:
            found.append(polygon)
        if surface.inside.zone == zone:
            found.append(polygon.reversed())
    return found


def test_the_virtual_experiment_is_the_one_that_was_made() -> None:
    content = (FOLDER / "lgi_virtual.csv").read_bytes()
    assert hashlib.sha256(content).hexdigest() == SHA256
    rows = list(csv.DictReader(content.decode("ascii").splitlines()))
    assert len(rows) == 8832
    assert (rows[0]["time"], rows[-1]["time"]) == ("2010-08-01 00:00:00", "2010-10-31 23:45:00")
    card = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert SHA256 in card
    assert all(f"`{column}`" in card for column in rows[0] if column != "time")


def test_zones_close_and_have_the_stated_volumes(cell: Building) -> None:
    room, gap = faces(cell, "room"), faces(cell, "air_gap")
    assert volume(room) == pytest.approx(27.0, abs=1e-9)
    assert volume(gap) == pytest.approx(2.68, abs=0.005)
    assert float(cell.zones["room"].volume or 0.0) == pytest.approx(volume(room))
    assert float(cell.zones["air_gap"].volume or 0.0) == pytest.approx(volume(gap), abs=1e-3)
    for zone in (room, gap):
        assert view_factors(zone).sum(axis=1) == pytest.approx(1.0, abs=1e-12)


def test_areas_and_directions(cell: Building) -> None:
    areas = {name: float(surface.area or 0.0) for name, surface in cell.surfaces.items()}
    assert areas["ceiling"] == areas["roof"] == pytest.approx(9.58, abs=0.005)
    assert areas["floor"] == pytest.approx(9.0)
    for side in ("south", "north", "east", "west"):
        assert areas[f"upstand_{side}"] == pytest.approx(0.894, abs=1e-3)
    assert areas["door"] == pytest.approx(0.7 * 2.2)
    assert areas["jalousie"] == pytest.approx(0.8 * 0.8)
    assert areas["wall_south"] + areas["door"] == pytest.approx(3 * 3.546)
    assert areas["wall_north"] + areas["jalousie"] == pytest.approx(3 * 2.454)
    roof = cell.surfaces["roof"]
    assert (float(roof.tilt or 0.0), float(roof.azimuth or 0.0)) == pytest.approx((20.0, 0.0), abs=0.01)
    azimuths = [float(cell.surfaces[f"wall_{s}"].azimuth or 0.0) for s in ("north", "east", "south", "west")]
    assert azimuths == pytest.approx([0.0, 90.0, 180.0, 270.0])


def test_every_number_has_a_source_and_a_range(cell: Building) -> None:
    text = (FOLDER / "building.yaml").read_text(encoding="utf-8")
    for line in text.splitlines():
        for entry in re.findall(r"\{value: [^{}]*\}", line):
            assert "source: " in entry, line
            assert "range: " in entry or "tude" in line, line
            if not re.search(
                r"paper|virtual experiment|Walton|Yazdanian|Li et al|mid-height|open country", entry
            ):
                assert "assumed: true" in entry, line
    plain = [
        p.path
        for p in cell.parameters()
        if not p.source and not p.structural and not p.path.endswith((".area", ".tilt", ".azimuth"))
    ]
    assert plain == []


def test_assumptions_are_on_their_page(repository: Path) -> None:
    """Value and range of every leaf that is marked as assumed; thicknesses may stand there in mm."""
    page = (repository / "docs" / "lgi-assumptions.md").read_text(encoding="utf-8").replace("–", " ")
    printed = {float(number) for number in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?", page)}
    text = (FOLDER / "building.yaml").read_text(encoding="utf-8")
    leaf = re.compile(
        r'(\w+): \{value: (\S+), range: \[(\S+), (\S+)\], source: "[^"]*", assumed: true\}',
    )
    found = leaf.findall(text)
    assert len(found) == text.count("assumed: true")
    for name, *numbers in found:
        values = [float(number) for number in numbers]
        assert any(
            all(any(abs(scale * value - known) < 1e-9 for known in printed) for value in values)
            for scale in (1, 1000)
        ), (name, values)


def test_the_sensors_are_there(cell: Building) -> None:
    for output in (
        "room.air_temperature",
        "ceiling.inside_temperature",
        "ceiling.energain_plasterboard_temperature",
        "ceiling.outside_temperature",
        "air_gap.air_temperature",
        "roof.inside_temperature",
    ):
        assert cell.output(output).unit == "degC"


def test_the_papers_constants_fit_the_description(cell: Building) -> None:
    """Both choices of table 4 as the study's variants write them."""
    variants = read_study(STUDIES["lgi"]).variants
    before = cell.replace(variants["paper, before"].changes)
    after = cell.replace(variants["paper, after"].changes)
    assert before.parameter("surfaces.roof.outside.convection.coefficient").value == 25.0
    assert after.parameter("surfaces.roof.outside.convection.constant").value == 11.4
    assert after.parameter("surfaces.roof.outside.convection.wind").value == 5.7
    assert after.parameter("materials.energain.law.gamma").value == 0.01


#: Largest standard deviation of the error per sensor, in the order of the study. [K]
CORROBORATION = (0.15, 0.25, 0.25, 0.25, 0.60, 0.85)
BLIND = (0.22, 0.30, 0.32, 0.33, 0.70, 1.00)


BIAS = 0.3  # K, what the sensors allow


def test_the_calibrated_cell_is_accurate_on_days_not_used(tmp_path: Path) -> None:
    """The identification as the study does it, on five days; its numbers frozen on all the others."""
    study = Study.from_yaml(STUDIES["lgi"])
    with Workspace(tmp_path, study.context.identity()) as workspace:
        run, fit = ModelRuns(study.context, workspace, False).candidate(None)
    assert run.results.energy.closure < 1e-10
    assert not fit.on_bound
    for periods, held, blind in zip(run.scores.values(), CORROBORATION, BLIND, strict=True):
        assert periods["corroboration"].sd < held
        assert periods["blind"].sd < blind
        for metrics in periods.values():
            assert abs(metrics.bias) < BIAS
            assert metrics.mean_error_percent < 5.0
    assert all(verdict.passed for verdict in judged(study.context, run)[run.label])


def test_the_study_leaves_the_form_of_the_model_open() -> None:
    study = Study.from_yaml(STUDIES["lgi"])
    assert study.context.inputs.candidates == [None]
    assert {part: list(forms) for part, forms in study.context.variants.forms.parts.items()} == {
        "outside convection": ["DOE-2", "TARP", "power of the wind"],
        "sky": ["Brunt", "Clark and Allen"],
        "convection in the gap": ["Alamdari and Hammond"],
        "diffuse radiation": ["Hay and Davies"],
    }
    free = study.context.variants.variant_of((("outside convection", "power of the wind"),))
    paths = set(study.context.variants.plan_of(free).parameters)
    shared = set(study.context.inputs.calibration_plan.parameters)
    assert shared - paths == {"surfaces.roof.outside.convection.factor"}
    assert paths - shared == {f"surfaces.roof.outside.convection.*.{number}" for number in "abcm"}


def test_all_outdoor_surfaces_have_one_law_in_an_alternative() -> None:
    study = Study.from_yaml(STUDIES["lgi"])
    for name, kind in (("DOE-2", "doe2"), ("TARP", "tarp")):
        building = study.context.variants.building_of(
            study.context.variants.variant_of((("outside convection", name),))
        )
        for surface, entry in building.surfaces.items():
            if entry.outside.outdoors and not (kind == "doe2" and surface in ("door", "jalousie")):
                assert entry.outside.convection is not None
                assert entry.outside.convection.kind == kind, surface


def test_tables_5_and_6_of_the_paper_stand_beside_ours_as_a_scale() -> None:
    file = read_study(STUDIES["lgi"])
    assert file.reference is not None
    published = file.reference.sensors
    assert list(published) == list(file.sensors)
    assert [p["identification"].sd for p in published.values()] == [0.2, 0.4, 0.4, 0.5, 1.0, 1.3]
    assert [p["corroboration"].sd for p in published.values()] == [0.2, 0.5, 0.5, 0.5, 1.3, 1.6]
    assert "virtual experiment" in file.reference.note
    assert file.observed == "virtual experiment"
