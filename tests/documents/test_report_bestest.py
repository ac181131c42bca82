from __future__ import annotations

import re
from html import unescape
from html.parser import HTMLParser
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from bestest_support import years
from mascarin.pages.suites.bestest import render, write
from mascarin.verification.bestest.catalogue import CASES
from mascarin.verification.bestest.quantities import quantities

if TYPE_CHECKING:
    from playwright.sync_api import Page

FACTS = {"Command": "mascarin bestest --weather <file>"}


@pytest.fixture(scope="module")
def html() -> str:
    every = years()
    return render([row for case in CASES.values() for row in quantities(every, case)], every, FACTS)


def test_every_section_is_there(html: str) -> None:
    titles = re.findall(r'<section id="(\w+)"', html)
    assert titles == [
        "loads", "peaks", "floating", "sun", "differences", "days", "months", "bins", "table", "repeat",
    ]  # fmt: skip


def test_the_numbers_are_in_the_tables(html: str) -> None:
    assert "168" in html
    # Case 600 in January: 500 W on average, 744 hours.
    assert '<th scope="row">Jan</th><td class="n">372.0</td>' in html
    # 610 less 600 is nothing here, and 650 has no heating.
    row = re.search(r"610 − 600.*?</tr>", html, re.DOTALL)
    assert row is not None
    assert '<td class="n strong">0.00' in row[0]
    assert html.count("inside</span>") + html.count("outside</span>") >= 168
    assert "&lt;file&gt;" in html


def test_drawings_say_what_they_show(html: str) -> None:
    said = re.findall(r'<svg class="[^"]*" viewBox="[^"]*" role="img" aria-label="([^"]+)"', html)
    assert len(said) == html.count("<svg ") == 10 + 10 + 3 + 4 + 13 + 1
    assert any(text.startswith("Annual heating, low mass. 600: 4.380 of 3.993 to 4.504;") for text in said)


def test_a_value_outside_has_as_many_digits_as_its_range(html: str) -> None:
    lines = re.findall(r"<li>(\w+: [^<]* outside of the range [^<]*)</li>", html)
    assert lines
    for line in lines:
        numbers = re.findall(r"-?\d+\.?\d*", line.replace("−", "-"))[-3:]
        found, low, high = (float(number) for number in numbers)
        assert not low <= found <= high, line


def test_nothing_is_loaded_or_run(html: str) -> None:
    tags = []

    class Tags(HTMLParser):
        def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
            tags.append(tag)
            assert not any(name in ("src", "onclick") for name, _ in attrs)

    Tags().feed(html)
    assert "section" in tags
    assert "script" not in tags
    assert "default-src 'none'" in unescape(html)


def test_one_case_makes_a_page(tmp_path: Path) -> None:
    every = {name: one for name, one in years().items() if name == "600FF"}
    path = write(tmp_path / "page.html", quantities(every, CASES["600FF"]), every, FACTS)
    text = path.read_text(encoding="utf-8")
    assert '<section id="floating"' in text
    assert '<section id="loads"' not in text
    assert [file.name for file in tmp_path.iterdir()] == ["page.html"]


@pytest.mark.browser
@pytest.mark.parametrize("width", [360, 1280])
def test_no_width_scrolls_sideways(page: Page, html: str, tmp_path: Path, width: int) -> None:
    file = tmp_path / "page.html"
    file.write_text(html, encoding="utf-8")
    page.set_viewport_size({"width": width, "height": 800})
    page.goto(file.as_uri())
    assert page.evaluate("document.documentElement.scrollWidth") <= width


@pytest.mark.browser
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing(page: Page, html: str, tmp_path: Path, scheme: Any) -> None:
    from axe_playwright_python.sync_playwright import Axe

    file = tmp_path / "page.html"
    file.write_text(html, encoding="utf-8")
    page.emulate_media(color_scheme=scheme)
    page.goto(file.as_uri())
    found = Axe().run(page)
    assert found.violations_count == 0, found.generate_report()
