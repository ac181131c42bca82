"""The page in a browser: nothing is cut off on any screen or on paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import report_example
from mascarin.pages.study import write

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = pytest.mark.browser

MANY = 27
#: Text area of A4 with the margins of the style sheet. [px]
A4 = 688
#: Elements that are not inside of a box that scrolls.
OUTSIDE = """limit => [...document.querySelectorAll('table, svg, img, p, pre, figure')]
  .filter(e => { const r = e.getBoundingClientRect(); return r.width > 0 && r.right > limit + 1; })
  .filter(e => !e.closest(limit < 500 ? '.scroll, pre' : 'none'))
  .map(e => e.tagName + e.textContent.slice(0, 60))"""


@pytest.fixture(scope="module")
def report_of_many(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A report with as many parameters as the study of the LGI cell has."""
    study, series = report_example.lgi()
    first: dict[str, Any] = next(iter(study["parameters"].values()))
    study["parameters"] |= {f"materials.m{k}.conductivity": first for k in range(MANY)}
    paths = list(study["parameters"])[:MANY]
    matrix = [[1.0 if i == k else -0.01 * (i + k) for k in range(MANY)] for i in range(MANY)]
    study["correlation"] = {"paths": paths, "matrix": matrix}
    return write(tmp_path_factory.mktemp("report") / "report.html", study, series)


@pytest.fixture
def page_of_many(page: Page, report_of_many: Path) -> Page:
    """That report in a browser."""
    page.goto(report_of_many.as_uri())
    page.evaluate("document.querySelectorAll('details.appendix').forEach(d => d.open = true)")
    page.wait_for_selector("#plot-values canvas")
    return page


@pytest.mark.parametrize("width", [1280, 1440, 1920])
def test_no_table_needs_scrolling_on_a_desktop(page_of_many: Page, width: int) -> None:
    page_of_many.set_viewport_size({"width": width, "height": 900})
    page_of_many.evaluate("document.querySelectorAll('details').forEach(d => d.open = true)")
    wider = page_of_many.evaluate(
        "[...document.querySelectorAll('.scroll')].filter(e => e.scrollWidth > e.clientWidth + 1)"
        ".map(e => e.getAttribute('aria-label'))"
    )
    assert wider == []


def test_on_a_telephone_wide_tables_scroll_in_their_own_box(page_of_many: Page) -> None:
    page_of_many.evaluate("document.querySelectorAll('details').forEach(d => d.open = true)")
    page_of_many.set_viewport_size({"width": 390, "height": 800})
    # At once, and not only after the charts were drawn again, which takes long on a busy computer.
    assert page_of_many.evaluate("document.documentElement.scrollWidth") <= 390
    assert page_of_many.evaluate(OUTSIDE, 390) == []


def test_print_drops_nothing(page_of_many: Page) -> None:
    page_of_many.set_viewport_size({"width": A4, "height": 1000})
    page_of_many.emulate_media(media="print")
    assert page_of_many.evaluate(OUTSIDE, A4) == []
    # Closed parts are printed, with every estimate in the columns of the correlation.
    for table in ("surfaces", "assumptions", "correlation-1", "correlation-3"):
        assert page_of_many.evaluate(
            f"document.querySelector('#table-{table}').getBoundingClientRect().height"
        )
    heads = page_of_many.eval_on_selector_all(
        ".matrix thead th.n",
        "all => all.filter(e => e.getBoundingClientRect().width > 0).map(e => +e.textContent)",
    )
    assert heads == list(range(1, MANY + 1))


def test_series_have_the_same_color_in_light_and_dark(page_of_many: Page) -> None:
    found = []
    for scheme in ("light", "dark"):
        page_of_many.emulate_media(color_scheme=scheme)
        found.append(
            page_of_many.evaluate(
                "['--fitted', '--nominal', '--observed', '--c0', '--c7']"
                ".map(n => getComputedStyle(document.documentElement).getPropertyValue(n))"
            )
        )
    assert found[0] == found[1]
    assert all(color.startswith("#") for color in found[0])
