from __future__ import annotations

import base64
import re
import struct
import zlib
from collections.abc import Callable
from functools import cache
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import report_example
from mascarin.errors import InputError
from mascarin.pages.study import render, write
from mascarin.pages.study.data.series import Series

if TYPE_CHECKING:
    from playwright.sync_api import Page

VOID = {"meta", "link", "img", "br", "input"}
SECTIONS = ["summary",
    "criteria", "model", "data", "sensitivity", "parameters", "comparison", "curves", "carpets",
            "phase-change", "residuals", "error-sources", "energy", "notes", "reproduce"]  # fmt: skip


class Outline(HTMLParser):
    """Elements, their attributes and whether they nest."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.found: list[tuple[str, dict[str, str]]] = []
        self.faults: list[str] = []
        self.text: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, {name: value or "" for name, value in attrs}))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, {name: value or "" for name, value in attrs}))

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> at {self.getpos()}")

    def handle_data(self, data: str) -> None:
        if not self.open or self.open[-1] not in ("script", "style"):
            self.text.append(data)

    def all(self, tag: str) -> list[dict[str, str]]:
        return [attributes for name, attributes in self.found if name == tag]


@pytest.fixture(scope="module")
def lgi_page() -> str:
    return render(*report_example.lgi())


@pytest.fixture(scope="module")
def outline(lgi_page: str) -> Outline:
    return Outline(lgi_page)


def test_every_section_is_there_in_its_order(outline: Outline) -> None:
    assert [s["id"] for s in outline.all("section")] == SECTIONS
    links = [a["href"] for a in outline.all("a") if a["href"].startswith("#")]
    contents = [link for link in links if not link.startswith(("#table-", "#figure-"))]
    assert contents[1:] == [f"#{name}" for name in SECTIONS]
    assert outline.faults == []
    assert outline.open == []


def test_the_file_is_small(lgi_page: str) -> None:
    assert len(lgi_page.encode()) < 3_000_000


def test_nothing_outside_is_named_to_be_loaded(lgi_page: str, outline: Outline) -> None:
    for tag, attributes in outline.found:
        for name in ("src", "srcset", "data", "poster", "action", "xlink:href"):
            assert attributes.get(name, "data:").startswith("data:"), (tag, attributes)
    assert [link["href"] for link in outline.all("link")] == ["data:,"]
    assert "@import" not in lgi_page
    # Addresses that begin with # are parts of the same figure.
    assert not re.search(r"url\((?!#)", re.sub(r"<script.*?</script>", "", lgi_page, flags=re.DOTALL))
    for tag, attributes in outline.found:
        assert tag == "a" or attributes.get("href", "#").startswith(("#", "data:")), (tag, attributes)
    policy = next(m["content"] for m in outline.all("meta") if m.get("http-equiv"))
    assert policy.startswith("default-src 'none'; script-src 'sha256-")
    assert "unsafe-inline" not in policy.split("style-src")[0]


def test_the_texts_of_the_study_are_shown(outline: Outline) -> None:
    text = re.sub(r"\s+", " ", "".join(outline.text))
    for words in (
        "virtual experiment",
        "18 of 18",
        "energain_plasterboard_temperature",
        "20–24 Sep 2010",
        "beyond 0.5 m² K/W the mask no longer acts",
        "mascarin study lgi",
        "Energy-balance residual 3.1×10⁻¹³",
        "80 mm in all (paper, table 1)",
        "3.00\u00a0K3.10\u00a0K14:3014:45+15".replace("\u00a0", " "),
        "coldest",
        "the paper's seven: parameters compared with those of",
        "Copyright (c) 2022 Leon Sorokin",
    ):
        assert words in text, words


def test_tables_hold_the_numbers(outline: Outline) -> None:
    study, _ = report_example.lgi()
    text = re.sub(r"\s+", " ", " ".join(outline.text))
    steel = study["sensors"]["steel_sheet"]["corroboration"]["fitted"]
    table = text[text.index("Corroboration: fitted Sensor") :]
    row = table[table.index("Steel sheet") :].split()
    assert row[2].replace("−", "-") == f"{steel['bias']:+.2f}"
    assert row[4] == f"{steel['sd']:.2f}"
    assert row[5] == "1.6"


def test_published_parameters_stand_beside_ours(lgi_page: str, outline: Outline) -> None:
    study, _ = report_example.lgi()
    path = "surfaces.roof.outside.absorptance"
    output = max(study["sensitivity"], key=lambda name: study["sensitivity"][name][path]["share"])
    share = study["sensitivity"][output][path]["share"]
    text = re.sub(r"\s+", " ", " ".join(outline.text))
    row = text[text.index("Rank of") :]
    row = row[row.index("218") : row.index("Spectra")]
    assert "α<sub>CI</sub>" in lgi_page
    assert f"roof · outside · absorptance 24 {100 * share:.1f} %" in row
    label = study["reference"]["label"]
    assert f"(after table 3 of {label})" in text
    assert f"(after table 5 of {label})" in text


def test_sources_of_remaining_error_are_listed(outline: Outline) -> None:
    study, _ = report_example.lgi()
    text = re.sub(r"\s+", " ", " ".join(outline.text))
    table = text[text.index("Each week is evaluated with changes estimated from other weeks") :]
    table = table[: table.index("Energy balance")]
    labels = (
        "fitted model",
        "with changed roof · steel · thickness",
        "and site · cloud · c3",
        "all 173",
        "aim",
    )
    rows = [table.index(label) for label in labels]
    assert rows == sorted(rows)
    # The last step's changes are those that belong together.
    assert "with changed roof · steel · thickness +33" in table
    assert "and site · cloud · c3 −12" in table
    steel = study["shortfall"]["all_parameters"]["sd"]["steel_sheet"]
    assert f"{steel:.3f}" in table[rows[3] : rows[4]]
    met = sum(aim["passed"] for aim in study["aims"])
    assert f"{met} of 6 are met" in text


def test_the_page_can_be_read_without_seeing_it(outline: Outline) -> None:
    assert outline.all("html") == [{"lang": "en"}]
    assert len(outline.all("main")) == len(outline.all("h1")) == 1
    assert all("alt" in image for image in outline.all("img"))
    assert all(svg.get("role") == "img" and svg.get("aria-label") for svg in outline.all("svg"))
    assert all(th.get("scope") for th in outline.all("th"))
    levels = [int(tag[1]) for tag, _ in outline.found if re.fullmatch(r"h[1-6]", tag)]
    assert all(b <= a + 1 for a, b in pairwise(levels))
    identifiers = [a["id"] for _, a in outline.found if "id" in a]
    assert len(identifiers) == len(set(identifiers))


EVIL = "</script><script>alert(1)</script>\"'&<b>"
NAMES = {"spans", "start", "end", "created", "outside", "inside", "name", "surface", "construction", "sensor",
         "period", "model", "kind", "column", "output", "path", "paths", "unit"}  # fmt: skip


def poisoned(value: Any, key: str = "") -> Any:
    """The same content with markup in every text that is neither a name nor a time."""
    if isinstance(value, dict):
        return {k: poisoned(v, k) for k, v in value.items()}
    if isinstance(value, list):
        return [poisoned(v, key) for v in value]
    return value + EVIL if isinstance(value, str) and key not in NAMES else value


def test_markup_in_texts_stays_text() -> None:
    study, series = report_example.lgi()
    page = render(poisoned(study), series)
    assert "<script>alert" not in page
    assert page.count("<script") == 4  # data, uPlot, curves.js, report.js
    outline = Outline(page)
    assert outline.faults == []
    assert not outline.all("b")
    assert "alert(1)" in "".join(outline.text)


def test_names_are_escaped_in_drawings() -> None:
    study, series = report_example.wall()
    study["building"]["constructions"][0]["layers"][0]["material"] = EVIL
    study["building"]["surfaces"][0]["name"] = EVIL
    page = render(study, series)
    assert "<script>alert" not in page
    assert Outline(page).faults == []


def test_a_doi_becomes_a_link_and_nothing_else_does() -> None:
    study, series = report_example.wall()
    study["sources"] = [
        {"text": "good", "doi": "10.3390/en9010009"},
        {"text": "bad", "doi": "javascript:alert(1)"},
        {"text": "Li et al. 2017, doi:10.1016/j.solener.2017.01.006"},
    ]
    links = [a["href"] for a in Outline(render(study, series)).all("a") if not a["href"].startswith("#")]
    assert links == [
        "https://doi.org/10.3390/en9010009",
        "https://doi.org/10.1016/j.solener.2017.01.006",
    ]


def test_a_single_wall_makes_a_page() -> None:
    outline = Outline(render(*report_example.wall()))
    assert [s["id"] for s in outline.all("section")] == ["model", "data", "curves", "carpets"]
    assert "20.444 all the time" in "".join(outline.text)
    assert outline.faults == []


def test_a_title_alone_makes_a_page() -> None:
    outline = Outline(render({"title": "Nothing yet"}, Series("2024-01-01T00:00", 900.0)))
    assert outline.all("section") == []
    assert outline.faults == []


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"title": ""}, "no 'title'"),
        ({"sensors": {"attic": {}}}, "'attic', which 'sensor_info' does not declare"),
        ({"sensors": {"interface": {"blind": {}}}}, "'blind', which 'periods' does not declare"),
        ({"sensors": {"interface": {"corroboration": {"best": {}}}}}, "'best', which 'models'"),
        ({"periods": {"x": {"spans": [["2024-01-01"]]}}}, "expected pairs"),
        ({"periods": {"x": {"spans": [["soon", "2024-01-01"]]}}}, "time 'soon'"),
        ({"phase_change": [{"column": "state/none"}]}, "'state/none', which is not there"),
    ],
)
def test_what_does_not_fit_together_is_refused(change: dict[str, Any], message: str) -> None:
    study, series = report_example.wall()
    with pytest.raises(InputError, match=re.escape(message)):
        render(study | change, series)


def test_writing_leaves_one_file(tmp_path: Path) -> None:
    write(tmp_path / "report.html", *report_example.wall())
    assert [p.name for p in tmp_path.iterdir()] == ["report.html"]


def test_carpet_pictures_hold_the_errors(lgi_page: str) -> None:
    """Decode one carpet and find the color of an error where it belongs."""
    study, series = report_example.lgi()
    address = re.findall(r'src="data:image/png;base64,([^"]+)" alt="Error of fitted for Room air', lgi_page)
    raw = base64.b64decode(address[0])
    width, height = struct.unpack(">II", raw[16:24])
    assert (width, height) == (92, 96)
    start = raw.index(b"IDAT")
    size = struct.unpack(">I", raw[start - 4 : start])[0]
    rows = zlib.decompress(raw[start + 4 : start + 4 + size])
    levels = np.frombuffer(rows, dtype=np.uint8).reshape(height, width + 1)[::-1, 1:].astype(float)
    error = series.columns["fitted/room_air"].values - series.columns["observed/room_air"].values
    expected = np.clip((error.reshape(92, 96).T / 0.5 + 1) / 2, 0, 1) * 200 + 1
    assert np.abs(levels - expected).max() <= 0.51
    assert study["sensor_info"]


# --- in a browser --------------------------------------------------------------------------------


Pages = Callable[[str], Path]


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Pages:
    """Gives the file of a report by its name; each is made once."""

    @cache
    def file(name: str) -> Path:
        folder = tmp_path_factory.mktemp(name)
        return write(folder / "report.html", *getattr(report_example, name)())

    return file


def opened(page: Page, file: Path) -> tuple[list[str], list[str]]:
    """Open a report; give the addresses that it asked for and what it complained about."""
    asked: list[str] = []
    complaints: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.on("console", lambda message: complaints.append(f"{message.type}: {message.text}"))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto(file.as_uri())
    page.evaluate("document.querySelectorAll('details.appendix').forEach(d => d.open = true)")
    page.wait_for_selector("#plot-values canvas")
    return asked, complaints


@pytest.mark.browser
@pytest.mark.parametrize("name", ["lgi", "wall"])
def test_nothing_leaves_the_page_and_nothing_fails(page: Page, pages: Pages, name: str) -> None:
    asked, complaints = opened(page, pages(name))
    for scheme in ("dark", "light"):
        page.emulate_media(color_scheme=scheme)
    options = page.eval_on_selector_all("#pick-sensor option", "all => all.map(o => o.value)")
    for sensor in options:
        page.select_option("#pick-sensor", sensor)
    page.select_option("#pick-period", "")
    for model in page.query_selector_all("input[name=model]"):
        model.click()
    if page.query_selector("#pick-beside"):
        page.select_option("#pick-beside", index=1)
        assert page.query_selector("#plot-beside canvas")
    carpet = page.query_selector(".carpet-picture img")
    assert carpet is not None
    carpet.scroll_into_view_if_needed()
    carpet.hover()
    assert " K" in (page.text_content("#carpet-readout") or "")
    page.emulate_media(media="print")
    assert complaints == []
    assert [a for a in asked if not a.startswith(("file:", "data:"))] == []


@pytest.mark.browser
@pytest.mark.parametrize("width", [320, 768, 1400])
def test_no_width_scrolls_sideways(page: Page, pages: Pages, width: int) -> None:
    page.set_viewport_size({"width": width, "height": 800})
    opened(page, pages("lgi"))
    page.evaluate("document.querySelectorAll('details').forEach(d => d.open = true)")
    assert page.evaluate("document.documentElement.scrollWidth") <= width


@pytest.mark.browser
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing(page: Page, pages: Pages, scheme: Any) -> None:
    from axe_playwright_python.sync_playwright import Axe

    page.emulate_media(color_scheme=scheme)
    opened(page, pages("lgi"))
    page.evaluate("document.querySelectorAll('details').forEach(d => d.open = true)")
    found = Axe().run(page)
    assert found.response["passes"]
    assert [violation["id"] for violation in found.response["violations"]] == []


@pytest.mark.browser
def test_curves_in_the_browser_are_those_of_the_study(page: Page, pages: Pages) -> None:
    """The browser's decoding of the packed series gives the values back."""
    _, series = report_example.lgi()
    opened(page, pages("lgi"))
    page.select_option("#pick-period", "")
    page.hover("#plot-values .u-over", position={"x": 200, "y": 100})
    shown = page.eval_on_selector_all(
        "#plot-values .u-legend .u-series:not(.hidden) .u-value", "all => all.map(v => v.textContent)"
    )
    day, month, clock = re.match(r"(\d+) (\w+) (\d\d:\d\d)", shown[0]).groups()  # type: ignore[union-attr]
    at = f"2010-{ {'Aug': '08', 'Sep': '09', 'Oct': '10'}[month] }-{int(day):02d}T{clock}"
    index = series.slice_of(at, at).start
    seen = series.columns["observed/room_air"].values[index]
    assert shown[-1] == f"{seen:.2f} °C"
