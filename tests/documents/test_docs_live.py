"""Examples of the documentation that run in its pages."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from mascarin.errors import InputError
from mascarin.pages.live import engine
from sitepages import accessible, assemble, live_pages

if TYPE_CHECKING:
    from playwright.sync_api import Page


def marks() -> list[str]:
    """Examples that pages name, one for each place."""
    pages = sorted(assemble.DOCS.glob("*.md"))
    return [m["name"] for page in pages for m in live_pages.MARK.finditer(page.read_text(encoding="utf-8"))]


def test_each_example_is_alive_in_one_place() -> None:
    assert sorted(marks()) == sorted(live_pages.EXAMPLES)


def test_a_page_has_its_example_or_says_why_not() -> None:
    text = "Before.\n\n<!-- live: box -->\n\nAfter.\n"
    alive, still = live_pages.shown(text, ["box"]), live_pages.shown(text, [])
    assert 'data-src="live/box.html"' in alive
    assert "<!--" not in alive + still
    assert "<iframe" not in still
    assert "with the engine for browsers" in still


def test_without_the_engine_the_site_has_no_live_pages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def missing() -> bytes:
        raise InputError("found no engine for browsers")

    monkeypatch.setattr(engine, "read", missing)
    assert live_pages.write(tmp_path / "live") == []
    assert not (tmp_path / "live").exists()
    assert "rustup target add" in live_pages.WITHOUT


def test_arrows_of_the_contents_have_names(tmp_path: Path) -> None:
    page = tmp_path / "a.html"
    page.write_text('<details><summary><span class="toctree-toggle"></span></summary></details>', "utf-8")
    assert accessible.name_toggles(tmp_path) == 1
    assert '<summary aria-label="Pages of this section">' in page.read_text(encoding="utf-8")
    assert accessible.name_toggles(tmp_path) == 0


def test_corners_of_tables_of_notebooks_are_no_heads(tmp_path: Path) -> None:
    page = tmp_path / "a.html"
    page.write_text("<table><tr><th></th><th>a</th></tr></table>", "utf-8")
    assert accessible.fill_corners(tmp_path) == 1
    assert page.read_text(encoding="utf-8") == "<table><tr><td></td><th>a</th></tr></table>"
    assert accessible.fill_corners(tmp_path) == 0


@pytest.mark.browser
def test_examples_run_in_the_page_when_they_are_opened(page: Page, tmp_path: Path, wasm: Path) -> None:
    assert wasm.is_file()
    written = live_pages.write(tmp_path / live_pages.FOLDER)
    assert written == list(live_pages.EXAMPLES)
    for name in written:
        assert (tmp_path / "live" / f"{name}.html").stat().st_size < 1_500_000
    text = live_pages.shown("\n\n".join(f"<!-- live: {name} -->" for name in written), written)
    script = (Path(live_pages.__file__).parents[1] / "static" / "live.js").read_text(encoding="utf-8")
    file = tmp_path / "page.html"
    page_text = f'<!doctype html><html lang="en"><title>x</title>{text}<script>{script}</script>'
    file.write_text(page_text, encoding="utf-8")
    page.goto(file.as_uri())
    page.wait_for_timeout(300)
    assert len(page.frames) == len(written) + 1
    # Nothing is loaded before an example is opened.
    assert {frame.url for frame in page.frames[1:]} == {"about:blank"}
    for name in written:
        page.locator(f'details:has(iframe[data-src="live/{name}.html"]) > summary').click()
        inside = page.frame_locator(f'iframe[data-src="live/{name}.html"]')
        inside.locator("body[data-ready]").wait_for(timeout=60_000)
        assert inside.locator("#plots canvas").count() >= 1
        assert not inside.locator("#message").is_visible()
