"""From the move of a slider to the drawn curve: the page of `mascarin explore` in a browser.

    python bench/explore_latency.py [--browser PROGRAM]

The LGI cell over 14 days in steps of 15 min, with its usual sliders and curves. The browser measures from the
event of the slider to the end of the frame in which the curves are drawn. Needs playwright and Chromium.
"""

from __future__ import annotations

import argparse
import os
import shutil
import statistics
import threading
from pathlib import Path

from playwright.sync_api import sync_playwright

import mascarin as mc
from mascarin import examples
from mascarin.commands.options.tables import run_inputs
from mascarin.pages.explore import Server, Session
from mascarin.pages.explore.page import render

MOVES = 60
MOVE = "(e, v) => { e.value = v; e.dispatchEvent(new Event('input')); }"


def session() -> Session:
    """The LGI cell with its virtual measurements as weather."""
    folder = examples.FOLDER / "lgi"
    cell = mc.load(folder / "building.yaml")
    climate, measured = run_inputs(
        cell, folder / "study.yaml", None, columns=[], timezone=None, stamps="start"
    )
    options = {"start": "2010-08-01", "end": "2010-08-15", "step": "15min", "measurements": measured}
    return Session(cell, climate, options=options)


def latencies(server: Server, program: str) -> list[float]:
    """Time of each move [ms]."""
    flags = ["--no-sandbox", "--disable-gpu"]
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=flags)
        page = browser.new_page(viewport={"width": 1280, "height": 1000})
        page.goto(server.address)
        page.wait_for_selector("body[data-ready]")
        slider = page.locator(".slider input[type=range]").first
        found = []
        for k in range(MOVES):
            slider.evaluate(MOVE, 50 + 15 * k)
            page.wait_for_selector(f"body[data-runs='{k + 1}']")
            found.append(float(page.evaluate("document.body.dataset.latency")))
        browser.close()
    return found


def main() -> None:
    """Measure and print."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--browser", default=os.environ.get("MASCARIN_BROWSER") or shutil.which("chromium"))
    program = options.parse_args().browser
    shown = session()
    server = Server(
        lambda token: render(shown, token, Path("x.yaml")),
        {"/run": lambda content: shown.run(content["values"], content["band"])},
    )
    threading.Thread(target=server.serve_forever, daemon=True).start()
    found = sorted(latencies(server, program))
    server.shutdown()
    server.server_close()
    print(
        f"{len(found)} moves: median {statistics.median(found):.0f} ms, 95 % below "
        f"{found[int(0.95 * len(found))]:.0f} ms, longest {found[-1]:.0f} ms"
    )


if __name__ == "__main__":
    main()
