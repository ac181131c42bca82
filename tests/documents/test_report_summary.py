"""The first pages of a report: every sentence follows from facts, and they fit on three sheets of paper."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import report_example
from mascarin.pages.frame.template import asset
from mascarin.pages.study import write
from mascarin.pages.study.data.main_results import worst_sensor
from mascarin.pages.study.page import _errors, coverage_facts
from mascarin.pages.study.sections import curves, summary
from mascarin.study_document.analysis import ContradictionEntry
from mascarin.study_document.document import StudyDocument

if TYPE_CHECKING:
    from playwright.sync_api import Page


NOTE = ContradictionEntry(text="x")


def criterion(value: float, *, sensor: str = "room_air", period: str = "blind") -> dict[str, Any]:
    return {
        "name": "|max error| <= 1 K", "sensor": sensor, "period": period, "metric": "max_error",
        "value": value, "limit": 1.0, "unit": "K", "passed": abs(value) <= 1.0, "model": "fitted",
    }  # fmt: skip


def study(**entries: Any) -> StudyDocument:
    content = {
        "title": "A study",
        "models": {"fitted": {"label": "fitted"}},
        "periods": {"blind": {"label": "Blind days"}},
        "sensor_info": {"room_air": {"label": "Room air", "unit": "degC"}},
        **entries,
    }
    return StudyDocument.read(content)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ((0.5, 0.9), "meets all 2 criteria"),
        ((0.5, 1.2), "meets 1 of 2 criteria"),
        ((1.5, 1.2), "meets none of 2"),
    ],
)
def test_the_verdict_counts_the_criteria(values: tuple[float, float], said: str) -> None:
    [first, *_] = summary.verdict(study(criteria=[criterion(value) for value in values]))
    assert said in first
    assert first.startswith("The model")
    fitted = {"a.b": {"fitted": 1.0, "nominal": 2.0}}
    [first, *_] = summary.verdict(study(criteria=[criterion(v) for v in values], parameters=fitted))
    assert first.startswith("The calibrated model")


def test_the_verdict_says_what_bands_hold_and_what_contradicts() -> None:
    fitted = {"a.b": {"fitted": 1.0, "nominal": 2.0}}
    band = {"room_air": {"confidence": 0.95, "held": {"blind": 0.61}}}
    # The second sensor has three times as many values: they count, in the head of the page as well.
    band["steel"] = {"confidence": 0.95, "held": {"blind": 0.81}}
    sensors = {key: {"blind": {"fitted": {"n": n}}} for key, n in (("room_air", 100), ("steel", 300))}
    complete = study(parameters=fitted, band=band, sensors=sensors)
    good = summary.verdict(complete)[-1]
    [fact] = coverage_facts(complete)
    assert good.startswith(fact["value"])
    assert good.startswith("76\u00a0% of the values of blind days lie in its prediction bands of 95\u00a0%")
    assert "no contradiction" in good
    assert fact["note"].endswith("lowest: Room air, 61\u00a0%")
    alike = {key: {**entry, "held": {"blind": 1.0}} for key, entry in band.items()}
    [fact] = coverage_facts(study(parameters=fitted, band=alike, sensors=sensors))
    assert fact["note"].endswith("all sensors")
    bad = summary.verdict(complete.model_copy(update={"contradictions": [NOTE, NOTE]}))[-1]
    assert "contradicts its data or what is known in 2 points" in bad
    assert "no contradiction" not in bad
    assert summary.verdict(study()) == []


def test_steps_follow_from_bounds_misses_and_causes() -> None:
    assert summary.next_steps(study(criteria=[criterion(0.5)])) == []
    steps = summary.next_steps(
        study(
            criteria=[criterion(1.2), criterion(3.0, period="late")],
            parameters={"zones.room.infiltration": {"fitted": 0.0, "at_bound": True}},
            diagnosis={
                "causes": [
                    {"group": "data", "text": "50 repeated values; they are left out of all comparisons."},
                    {
                        "group": "data",
                        "what": "clock",
                        "text": "clock of the steel is 28 min late: check it.",
                    },
                    {"group": "sensor", "text": "'room_air' reads 0.4 K too high."},
                ]
            },
            shortfall={"steps": [{"path": "site.sky.a"}]},
        )
    )
    assert [step.split()[0] for step in steps] == ["clock", "Room", "room", "Look", "Determine"]
    assert "left out" not in " ".join(steps)
    assert "3.00 K, limit 1.00 K" in steps[3]
    assert "at the end of the stated range" in steps[2]


def test_each_criterion_has_its_cell() -> None:
    matrix = summary.criteria_matrix(
        study(criteria=[criterion(0.5), criterion(1.5, sensor="steel"), criterion(0.2, period="late")])
    )
    assert matrix is not None
    assert (matrix["met"], matrix["total"], matrix["sensors"]) == (2, 3, ["Room air", "steel"])
    cells = [[cell and cell["passed"] for cell in row["cells"]] for row in matrix["rows"]]
    assert cells == [[True, False], [True, None]]
    other = copy.deepcopy(criterion(0.5)) | {"model": "nominal"}
    assert summary.criteria_matrix(study(criteria=[other, criterion(0.5)]))["total"] == 1  # type: ignore[index]


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(tmp_path_factory.mktemp("summary") / "report.html", *report_example.lgi())


@pytest.mark.browser
def test_three_sheets_of_paper_and_a_short_page_on_a_telephone(page: Page, report: Path) -> None:
    page.goto(report.as_uri())
    page.set_viewport_size({"width": 390, "height": 800})
    assert page.evaluate("document.documentElement.scrollHeight") <= 12_000
    page.evaluate(
        "document.querySelectorAll('section:has(> .appendix)').forEach(e => e.style.display = 'none')"
    )
    assert page.pdf(format="A4").count(b"/Type /Page\n") <= 3


@pytest.mark.browser
def test_long_names_do_not_cover_the_bars_of_the_sensitivity(page: Page) -> None:
    paths = [
        "surfaces.facade.outside.convection.coefficient",
        "surfaces." + "long_" * 12 + "wall.outside.emissivity",
    ]
    labels = {"sensor_info": {"s": {"label": "insulation/concrete interface", "unit": "degC"}}}
    drawing = summary._sensitivity(study(sensitivity={"s": {p: {"share": 0.6} for p in paths}}, **labels))
    page.set_content(f"<style>{asset('pages/frame/report.css')}</style><figure>{drawing}</figure>")
    boxes = """tag => [...document.querySelectorAll(tag)].map(e => e.getBoundingClientRect())
      .map(b => [b.left, b.right])"""
    bars, texts = page.evaluate(boxes, "rect"), page.evaluate(boxes, "text")
    names, words = texts[::2], texts[1::2]
    assert len(bars) == len(names) == 2
    for (left, right), (_, end), (start, edge) in zip(bars, names, words, strict=True):
        assert end <= left < right <= start
        assert edge <= page.evaluate("document.querySelector('svg').getBoundingClientRect().right")


@pytest.mark.browser
def test_nothing_of_the_first_pages_is_out_of_its_place(page: Page, tmp_path: Path) -> None:
    raw, series = report_example.lgi()
    raw["contradictions"] = [{"text": "a number is at its bound"}]
    page.goto(write(tmp_path / "report.html", raw, series).as_uri())
    page.set_viewport_size({"width": 390, "height": 800})
    # The mark of a folded part stands before its heading, also where that has two lines.
    first = "e => [e.getBoundingClientRect().top, e.querySelector('h2').getClientRects()[0].top]"
    for top, words in page.locator(".appendix > summary").evaluate_all(f"all => all.map({first})"):
        assert words - top < 20.0
    # What stands after a warning keeps its distance, and the intervals of parameters need no scrolling.
    gaps = """all => all.filter(e => e.nextElementSibling).map(e =>
      e.nextElementSibling.getBoundingClientRect().top - e.getBoundingClientRect().bottom)"""
    assert min(page.locator(".banner").evaluate_all(gaps)) >= 8.0
    table = page.locator(".scroll:has(.key-parameters)")
    assert table.evaluate("e => e.scrollWidth <= e.clientWidth + 1")
    page.emulate_media(media="print")
    page.set_viewport_size({"width": 690, "height": 1000})
    rules = "all => all.map(e => getComputedStyle(e).breakAfter)"
    assert set(page.locator(".appendix > summary").evaluate_all(rules)) == {"avoid"}
    page.evaluate("document.querySelectorAll('details').forEach(e => e.open = true)")
    hashes = page.locator("td.hash, .hash code, .hash").evaluate_all("all => all.map(e => e.clientHeight)")
    assert hashes
    assert max(hashes) < 60


@pytest.mark.browser
def test_a_link_unfolds_what_it_leads_to(page: Page, report: Path) -> None:
    page.goto(report.as_uri())
    assert page.locator("details.appendix[open]").count() == 0
    assert not page.locator("#explorer").is_visible()
    page.click(".contents a[href='#curves']")
    page.wait_for_selector("#plot-values canvas")
    assert page.evaluate("document.querySelector('#plot-values canvas').clientWidth") > 200
    # A reference to a table inside of another appendix.
    page.evaluate("location.hash = '#table-parameters'")
    page.wait_for_selector("#table-parameters")
    assert page.locator("details.appendix[open]").count() == 2


def test_the_verdict_has_the_mean_of_the_error_beside_its_scatter() -> None:
    """A sensor that is 0.6 K too low in the mean scatters by little: both are said, and of which days."""
    errors = {"bias": -0.6, "sd": 0.04, "rmse": 0.6, "n": 9}
    other = {"bias": 0.1, "sd": 0.08, "rmse": 0.13, "n": 9}
    periods = {"blind": {"label": "Blind days", "note": "not used for the calibration"}}

    def said(**changes: Any) -> str:
        sensors = {
            "room_air": {"blind": {"fitted": {**errors, **changes}}}, "steel": {"blind": {"fitted": other}}
        }  # fmt: skip
        complete = study(criteria=[criterion(0.5)], sensors=sensors, periods=periods)
        [fact] = [fact for fact in _errors(complete) if "Error" in fact["name"]]
        assert "mean −0.60 to 0.10" in fact["note"] or changes
        return summary.verdict(complete)[0]

    base = said()
    assert "a mean of −0.60 to 0.10" in base
    assert "a standard deviation of 0.04 to 0.08" in base
    assert base.endswith("depending on the sensor (blind days: not used for the calibration).")
    assert len({base, said(bias=-0.5), said(sd=0.03)}) == 3


def test_every_parameter_at_an_end_is_named() -> None:
    def named(count: int) -> str:
        entries = {f"zones.z{k}.infiltration": {"fitted": 0.0, "at_bound": True} for k in range(count)}
        [step] = summary.next_steps(study(parameters=entries))
        return step

    assert named(1).endswith("is at the end of the stated range: measure it, state a wider range with its "
                             "source, or look for a cause outside of the parameters.")  # fmt: skip
    assert "z0 · infiltration and z1 · infiltration are at the ends of their stated ranges" in named(2)
    assert "z3 · infiltration and 2 more are at the ends" in named(6)


def test_the_figure_of_the_summary_shows_the_worst_sensor_and_says_so() -> None:
    """By its criteria; where the period has none, by the rmse among sensors of the first unit."""
    names = ["room_air", "steel", "heater"]
    info = {"room_air": {"unit": "degC"}, "steel": {"unit": "degC"}, "heater": {"unit": "W"}}
    errors = {"room_air": 0.2, "steel": 0.5, "heater": 40.0}
    sensors = {name: {"blind": {"fitted": {"rmse": errors[name]}}} for name in names}
    plain = study(sensors=sensors, sensor_info=info)
    assert worst_sensor(plain, "blind", names) == ("steel", "of 3 sensors that with the largest rmse")
    limited = [criterion(0.9), criterion(0.5, sensor="steel"), criterion(0.7, sensor="heater")]
    judged = study(sensors=sensors, sensor_info=info, criteria=limited)
    assert worst_sensor(judged, "blind", names) == ("room_air", "of 3 sensors the nearest to a limit")
    missed = study(sensors=sensors, criteria=[*limited, criterion(-1.4, sensor="heater")])
    assert worst_sensor(missed, "blind", names) == ("heater", "of 3 sensors the farthest beyond a limit")
    assert worst_sensor(missed, "blind", ["steel"]) == ("steel", "")


def test_the_caption_of_the_figure_names_that_sensor() -> None:
    raw, series = report_example.lgi()
    document = StudyDocument.read(raw)
    shown = curves.last_period(document, series)
    assert shown is not None
    measured = [name for name in document.sensor_info if f"observed/{name}" in series.columns]
    worst, reason = worst_sensor(document, "blind", measured)
    assert shown.title.startswith(document.sensor_info[worst].label or worst)
    assert shown.title.endswith(f"({reason})")
