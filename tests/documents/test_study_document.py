"""Parts of ``study.json`` from results that are made here."""

from __future__ import annotations

import ast
import json
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pandas as pd
import pytest

import report_example
from mascarin.building import load
from mascarin.errors import InputError
from mascarin.examples import STUDIES
from mascarin.sensitivity import Factor
from mascarin.sensitivity.spectral import analyze, design
from mascarin.simulation import Simulation
from mascarin.study.context.context import StudyContext
from mascarin.study.context.phase_change import melting_layers
from mascarin.study.results.document.phase_change import phase_change
from mascarin.study.results.document.sensitivity import importance
from mascarin.study.steps.findings import ModelRun
from mascarin.study_document.document import StudyDocument
from mascarin.weather import Climate, Measurements

PACKAGE = Path(__file__).resolve().parents[2] / "python" / "mascarin"


def test_frequencies_are_those_of_the_groups() -> None:
    factors = [
        Factor("a", 0.0, 1.0, group="walls"),
        Factor("b", 0.0, 1.0, group="walls"),
        Factor("c", 0.0, 1.0),
        Factor("d", 0.0, 1.0),
    ]
    plan = design(factors, seed=3)
    x = plan.all_samples()
    # Each output depends on one group only, so that its strongest line is the frequency of that group.
    results = {"of_walls": x[:, 0] + x[:, 1], "of_c": x[:, 2], "of_d": x[:, 3]}
    found = {name: analyze(plan, y, names=[name]) for name, y in results.items()}
    days = (pd.Timestamp("2023-03-01", tz="UTC"), pd.Timestamp("2023-03-02", tz="UTC"))
    study = cast("StudyContext", SimpleNamespace(periods=SimpleNamespace(identification=days)))
    for output, group in (("of_walls", "walls"), ("of_c", "c"), ("of_d", "d")):
        content = importance(study, found[output])
        power = content.spectra[output].power
        strongest = content.spectra[output].frequencies[power.index(max(power))]
        assert list(content.frequencies) == ["walls", "c", "d"]
        assert content.frequencies[group] == strongest


def test_the_states_of_a_phase_change_layer_are_those_of_the_run() -> None:
    cell = load(STUDIES["lgi"].with_name("building.yaml"))
    table = STUDIES["lgi"].with_name("lgi_virtual.csv")
    columns = ("relative_humidity", "wind_speed", "wind_direction", "pressure", "global_horizontal")
    climate = Climate.from_table(
        table,
        timezone="UTC+4",
        columns={"air_temperature": "outdoor_air", "diffuse_horizontal": "diffuse_horizontal"}
        | {name: name for name in columns},
        latitude=-21.34,
        longitude=55.48,
        altitude=55.0,
    )
    (layer,) = melting_layers(cell)
    simulation = Simulation(
        cell,
        climate,
        start="2010-08-10",
        end="2010-08-14",
        step="1h",
        outputs=list(layer.outputs),
        initial=23.4,
        measurements=Measurements.from_table(table, timezone="UTC+4", columns=["slab_underside"]),
    )
    run = cast("ModelRun", SimpleNamespace(simulation=simulation, results=simulation.run()))
    compared_from = run.results.index[0] + pd.Timedelta(days=1)
    study = cast("StudyContext", SimpleNamespace(periods=SimpleNamespace(compared_from=compared_from)))
    (found,) = phase_change(study, run)
    assert found.label == "ceiling: energain"
    fraction = run.results[layer.liquid_fraction].to_numpy()
    rows = dict(found.rows)
    assert float(rows["liquid fraction at the start"]) == pytest.approx(fraction[0], abs=5e-4)
    assert float(rows["smallest liquid fraction"]) == pytest.approx(fraction.min(), abs=5e-4)
    assert float(rows["mean liquid fraction"]) == pytest.approx(fraction.mean(), abs=5e-4)
    # Three days remain after the first, which is not compared.
    assert {day.label.split(", ")[0] for day in found.days} == {
        "coldest", "warmest", "largest change of enthalpy",
    }  # fmt: skip
    assert all(len(day.enthalpy) == 24 for day in found.days)
    spread = {day.label.split(",")[0]: np.ptp(day.enthalpy) for day in found.days}
    assert spread["largest change of enthalpy"] == max(spread.values())
    assert float(rows["largest change of enthalpy within a day"].split()[0]) == pytest.approx(
        max(spread.values()), abs=0.6
    )
    mean = {day.label.split(",")[0]: np.mean(day.enthalpy) for day in found.days}
    assert mean["coldest"] < mean["warmest"]
    # The material has no hysteresis: every state of the layer is on its law, but for the mean over the layer.
    law = np.interp(found.temperature, found.law_temperature, found.law_enthalpy)
    assert np.abs(law - found.enthalpy).max() < 0.1 * np.ptp(found.law_enthalpy)


# --- one model of the results ---------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["lgi", "wall"])
def test_reading_and_writing_results_loses_nothing(name: str) -> None:
    content, _ = getattr(report_example, name)()
    # A later version may state more, anywhere.
    content |= {"new": {"of": [1, 2.5]}}
    content["sensor_info"] = {key: {**info, "serial": "x"} for key, info in content["sensor_info"].items()}
    text = json.dumps(content, sort_keys=True)
    assert json.dumps(StudyDocument.read(json.loads(text)).to_dict(), sort_keys=True) == text


def test_results_of_other_types_are_refused() -> None:
    with pytest.raises(InputError, match=r"study\.json: sensor_info\.air: found 3.*run the study again"):
        StudyDocument.read({"title": "x", "sensor_info": {"air": 3}}, "study.json")


def test_the_report_reads_no_plain_mappings() -> None:
    """Sections, figures and data of the report take the typed results; only the entrance reads mappings."""
    plain = []
    for path in sorted((PACKAGE / "pages" / "study").rglob("*.py")):
        if path.name in ("__init__.py", "series.py"):  # the entrance; the curves, which are no results
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                arguments = [*node.args.args, *node.args.kwonlyargs]
                types = [ast.unparse(a.annotation) for a in arguments if a.annotation is not None]
                plain += [f"{path.name}: {node.name}: {t}" for t in types if _is_plain(t, path.name)]
    assert plain == []


def _is_plain(annotation: str, file: str) -> bool:
    words = ("Mapping[str, Any]", "dict[str, Any]")
    return annotation in words and (file, annotation) != ("page.py", "dict[str, Any]")  # curves, packed


def test_every_key_of_a_study_is_declared() -> None:
    """What a study writes is in the model of results: `Any` is what it knows nothing of."""
    content, _ = report_example.lgi()
    assert (StudyDocument.read(content).model_extra or {}) == {}
