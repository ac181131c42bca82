"""Check every page of the built site with axe: ``python docs/site/axe.py target/site/html [PAGE ...]``.

Prints each page with a fault, and a page that is wider than the screen; the exit code is 1 if there is one.
It needs Chromium (``MASCARIN_BROWSER``) and takes some seconds a page.
"""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path
from typing import Any, Final

#: Widths of a screen and of a telephone. [px]
WIDTHS: Final = (1280, 390)
SCHEMES: Final[tuple[Any, ...]] = ("light", "dark")
#: Time in which colors fade from one scheme to the other. [ms]
_FADES: Final = 500
#: Opens what is folded, but no live example, which would load its page.
_UNFOLD: Final = "document.querySelectorAll('details:not(.live-example)').forEach(d => d.open = true)"


def main() -> int:
    """Check."""
    from axe_playwright_python.sync_playwright import Axe
    from playwright.sync_api import sync_playwright

    site = Path(sys.argv[1])
    pages = sorted(page for page in site.rglob("*.html") if "_static" not in page.parts)
    pages = [page for page in pages if not sys.argv[2:] or page.stem in sys.argv[2:]]
    if not pages:
        sys.stderr.write(f"error: {site} has no pages: make docs\n")
        return 2
    program = os.environ.get("MASCARIN_BROWSER") or shutil.which("chromium")
    faults = 0
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        for page, width in ((page, width) for page in pages for width in WIDTHS):
            # Loaded anew for each width: the theme decides then what can be scrolled by the keyboard.
            opened = browser.new_page(viewport={"width": width, "height": 800}, offline=True)
            opened.goto(page.resolve().as_uri())
            opened.wait_for_load_state("load")
            opened.evaluate(_UNFOLD)
            for scheme in SCHEMES:
                opened.emulate_media(color_scheme=scheme)
                opened.wait_for_timeout(_FADES)
                said = [
                    f"{fault['id']} ({fault['impact']}): {fault['nodes'][0]['target']}"
                    for fault in Axe().run(opened).response["violations"]
                ]
                wide = opened.evaluate("document.documentElement.scrollWidth")
                said += [f"{wide} px wide"] if wide > width else []
                for words in said:
                    sys.stdout.write(f"{page.relative_to(site)}, {width} px, {scheme}: {words}\n")
                    sys.stdout.flush()
                faults += len(said)
            opened.close()
    sys.stdout.write(f"{len(pages)} pages, {faults} faults\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
