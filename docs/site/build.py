"""Build the documentation site without a network: ``python docs/site/build.py OUT``.

Pages are assembled and generated below ``OUT/source``, and Sphinx makes ``OUT/html`` from them. Every
warning is an error. Examples run in their pages where the engine for browsers is installed. With ``--links``
the addresses of other sites are asked instead.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE)]


def main() -> int:
    """Build."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path, help="folder of the site")
    parser.add_argument("--links", action="store_true", help="check the addresses of other sites")
    parser.add_argument("--dry", action="store_true", help="leave out running the examples and notebooks")
    parser.add_argument("--jobs", default="auto", help="processes")
    options = parser.parse_args()
    os.environ.setdefault("MPLBACKEND", "agg")
    from sphinx.cmd.build import build_main

    from sitepages import accessible, generated, live_pages

    out = options.out.resolve()
    builder = "linkcheck" if options.links else "html"
    live = [] if options.links else live_pages.write(out / "extra" / live_pages.FOLDER)
    if not live and not options.links:
        sys.stderr.write(f"{live_pages.WITHOUT}\n")
    generated.write(out / "source", live)
    words = ["-b", builder, "-W", "--keep-going", "-q", "-j", options.jobs, "-c", str(HERE)]
    if live:
        words += ["-D", f"html_extra_path={out / 'extra'}"]
    if options.dry or options.links:
        words += ["-D", "nb_execution_mode=off", "-D", "plot_gallery=0"]
    code = int(build_main([*words, "-d", str(out / "doctrees"), str(out / "source"), str(out / builder)]))
    if not options.links:
        accessible.name_toggles(out / builder)
        accessible.fill_corners(out / builder)
    return code


if __name__ == "__main__":
    sys.exit(main())
