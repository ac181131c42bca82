"""Numbers of tables and figures, the facts at the top, and the table in the form of a publication."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import report_example
from mascarin.figures import colors
from mascarin.figures.comparison import Compared
from mascarin.pages.study import render
from mascarin.pages.study.data.series import Column, Series
from mascarin.pages.study.figures.comparison_data import compared_sensors
from mascarin.pages.study.page import context, coverage_facts
from mascarin.pages.study.sections import data
from mascarin.study_document.analysis import QualityEntry
from mascarin.study_document.document import StudyDocument
from test_report import Outline


@pytest.fixture(scope="module")
def page() -> str:
    return render(*report_example.lgi())


def test_every_table_and_figure_has_a_numbered_caption(page: str) -> None:
    outline = Outline(page)
    tables, figures = (len(outline.all(tag)) for tag in ("table", "figure"))
    for kind, element, count in (("Table", "caption", tables), ("Figure", "figcaption", figures)):
        found = re.findall(rf"<{element}[^>]*>(?:<span[^>]*>)?<strong>{kind} (\d+)\.", page)
        assert [int(number) for number in found] == list(range(1, count + 1))
        assert count > 5


def test_every_reference_leads_to_what_it_names(page: str) -> None:
    captions = dict(re.findall(r'id="((?:table|figure)-[^"]+)">(?:<span[^>]*>)?<strong>(\w+ \d+)\.', page))
    links = re.findall(r'<a href="#((?:table|figure)-[^"]+)">([^<]+)</a>', page)
    assert len(links) > 10
    for target, words in links:
        assert captions[target] == words


BANDS = {
    "a": {"confidence": 0.95, "held": {"blind": 0.9}},
    "b": {"confidence": 0.95, "held": {"blind": 0.5}},
}


def bands_study() -> dict[str, Any]:
    return {
        "title": "Two sensors",
        "sensor_info": {"a": {"label": "Air"}, "b": {"label": "Heater", "unit": "W"}},
        "models": {"fitted": {"label": "fitted"}},
        "periods": {"blind": {"label": "Blind days", "spans": [["2024-01-01", "2024-01-02"]]}},
        "sensors": {
            "a": {"blind": {"fitted": {"n": 300, "sd": 0.125}}},
            "b": {"blind": {"fitted": {"n": 100, "sd": 40.0}}},
        },
        "band": BANDS,
    }


def test_the_coverage_of_all_values_and_of_the_lowest_sensor_is_at_the_top() -> None:
    (fact,) = coverage_facts(StudyDocument.read(bands_study()))
    # 300 values with 90 % and 100 with 50 %.
    assert fact["value"] == "80\u00a0%"
    assert "asked: 95\u00a0%" in fact["note"]
    assert "lowest: Heater, 50\u00a0%" in fact["note"]


def test_units_are_not_mixed_in_a_headline() -> None:
    facts = context(StudyDocument.read(bands_study()), Series("2024-01-01T00:00", 900.0))["facts"]
    errors = [fact["value"] for fact in facts if fact["name"].startswith("Error of")]
    assert errors == ["0.12\u00a0K", "40.00\u00a0W"]


def test_the_error_is_in_its_band_exactly_where_the_measured_value_is() -> None:
    rng = np.random.default_rng(3)
    measured, simulated, center = rng.normal(size=(3, 500))
    half = np.abs(rng.normal(size=500)) + 0.1
    one = Compared("x", measured, {"fitted": simulated}, "fitted", half=half, center=center)
    assert one.band is not None
    assert one.error_band is not None
    inside = (one.band[0] <= measured) & (measured <= one.band[1])
    error = one.error("fitted")
    np.testing.assert_array_equal(inside, (one.error_band[0] <= error) & (error <= one.error_band[1]))
    assert 50 < inside.sum() < 450


def test_the_band_of_a_report_is_that_of_its_series() -> None:
    study = StudyDocument.read(bands_study())
    values = {"observed": [20.0, 21.0], "fitted": [20.5, 20.5], "expected": [20.2, 20.4], "band": [0.3, 0.5]}
    columns = {f"{key}/a": Column(np.array(v), "Air", "degC") for key, v in values.items()}
    _, found = compared_sensors(study, Series("2024-01-01T00:00", 900.0, columns), slice(0, 2), 10)
    assert list(found) == ["a"]
    assert found["a"].band is not None
    np.testing.assert_allclose(found["a"].band, [[19.9, 19.9], [20.5, 20.9]])


def table_4() -> dict[str, Any]:
    study, _ = report_example.wall()
    study["reference"] = {
        "label": "A paper",
        "tables": {"parameters": "table 4"},
        "parameters": [
            {"symbol": "h_ce,CI", "parameter": "surfaces.roof.outside.convection.factor", "before": 25,
             "after": "5.7 V + 11.4", "unit": "W/(m2 K)"},
            {"symbol": "gamma", "parameter": "materials.energain.law.width", "before": 0.04, "after": 0.01,
             "delta_t": 0.01},
        ],
    }  # fmt: skip
    factor = {"nominal": 1.0, "fitted": 0.92, "low": 0.74, "high": 1.04}
    study["parameters"] = {
        "surfaces.roof.outside.convection.factor": factor,
        "materials.energain.law.width": {
            "nominal": 1.0, "fitted": 2.0, "low": 1.6, "high": 2.5, "unit": "K",
        },
    }  # fmt: skip
    law = "surfaces.roof.outside.convection"
    models = {"nominal": {law: 5.951}, "fitted": {law: 6.77}}
    study["coefficients"] = {"period": "identification", "unit": "W/(m2 K)", "models": models}
    return study


def test_the_table_of_the_paper_has_its_form_with_mean_coefficients_beside_factors() -> None:
    _, series = report_example.wall()
    words = re.sub(r"\s+", " ", " ".join(Outline(render(table_4(), series)).text))
    assert "in the form of A paper (after table 4 of A paper)" in words
    words = words[words.index("in the form of A paper") :]
    roof = words[words.index("roof · outside · convection factor") :]
    assert re.match(
        r"roof · outside · convection factor 25 5\.7 V \+ 11\.4 1 0\.92 0\.74 to 1\.04 5\.95 6\.77 ", roof
    )
    # gamma = 4 delta_t / w: 0.04 / 2 K, between 0.04 / 2.5 K and 0.04 / 1.6 K.
    gamma = words[words.index("w as γ = 4 δT / w") :]
    assert "0.04 0.01 0.04 0.0200 0.0160 to 0.0250" in gamma[:120]


def test_sensors_have_the_same_color_on_the_page_and_in_files(page: str) -> None:
    study, _ = report_example.lgi()
    for number in range(len(study["sensor_info"])):
        assert f"stroke: {colors.look(number).color}" in page


def test_a_report_of_other_data_claims_nothing_of_an_example() -> None:
    study, series = report_example.wall()
    words = " ".join(Outline(render(study | {"title": "Mine", "sources": []}, series)).text)
    for name in ("LGI", "Reunion", "Guichard", "the paper"):
        assert name not in words


def test_suspicious_values_of_one_column_and_kind_share_a_row() -> None:
    def entry(day: int, count: int, kind: str = "stuck", *, masked: bool = False) -> QualityEntry:
        start, end = (f"2024-01-{day:02}T{hour:02}:00" for hour in (6, 8))
        detail = f"{day} degC"
        return QualityEntry(
            channel="T", kind=kind, start=start, end=end, count=count, detail=detail, masked=masked
        )

    entries = [entry(1, 8), entry(3, 1020), entry(5, 9), entry(6, 4, "spike"), entry(7, 3, masked=True)]
    study = StudyDocument(quality=entries)
    content = data.content(study, Series("2024-01-01", 60.0))
    assert content is not None
    rows = [(r["kind"], r["start"], r["end"], r["count"], r["detail"], r["use"]) for r in content["quality"]]
    longest = "3 times; the longest from 3 Jan 2024 06:00, 1\u202f020 values: 3 degC"
    assert rows == [
        ("stuck", "1 Jan 2024 06:00", "5 Jan 2024 08:00", "1\u202f037", longest, "included"),
        ("spike", "6 Jan 2024 06:00", "6 Jan 2024 08:00", "4", "6 degC", "included"),
        ("stuck", "7 Jan 2024 06:00", "7 Jan 2024 08:00", "3", "7 degC", "excluded"),
    ]
