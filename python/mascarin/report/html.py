"""Renders the templates of a report into one file with its styles and scripts."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Mapping
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from mascarin.figures import colors
from mascarin.report.numbering import Numbering
from mascarin.report.page import context, explorer
from mascarin.report.series import Series
from mascarin.report.text import significant, typeset


def page(study: Mapping[str, Any], series: Series) -> str:
    """Make the HTML of a report.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.report.schema.Study`.
    series : Series
        Curves.
    """
    library, own = _asset("vendor/uPlot.iife.min.js"), _asset("report.js")
    environment = Environment(
        loader=PackageLoader("mascarin", "report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["typeset"] = typeset
    environment.filters["significant"] = significant
    environment.filters["symbol"] = _symbol
    numbering = Numbering()
    environment.globals["numbering"] = numbering
    style = "\n".join((_asset("vendor/uPlot.min.css"), palette(), _asset("report.css")))
    template = environment.get_template("page.html")
    values = dict(
        context(study, series),
        style=Markup(style),  # noqa: S704  (our own files)
        library=Markup(library),  # noqa: S704
        licence=_asset("vendor/uPlot.LICENSE"),
        script=Markup(own),  # noqa: S704
        data=_json(explorer(study, series)),
        policy=_policy(library, own),
    )
    template.render(values)  # counts the tables and figures to which texts refer
    numbering.restart()
    return template.render(values)


def palette() -> str:
    """The colors of all figures as custom properties of a style sheet."""
    named = {
        "observed": colors.MEASURED,
        "fitted": colors.FITTED,
        "nominal": colors.NOMINAL,
        "rest": colors.REST,
    }
    named |= {f"c{number}": color for number, color in enumerate(colors.PALETTE)}
    return ":root {" + " ".join(f"--{name}: {color};" for name, color in named.items()) + "}"


def _policy(*scripts: str) -> str:
    """Content security policy: only the scripts of this file run, and nothing is loaded."""
    digests = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
        for script in scripts
    )
    return (
        f"default-src 'none'; script-src {digests}; style-src 'unsafe-inline'; img-src data:; "
        "base-uri 'none'; form-action 'none'"
    )


def _json(content: Mapping[str, Any]) -> Markup:
    """JSON without characters that would end its HTML element."""
    raw = json.dumps(content, separators=(",", ":"), allow_nan=False)
    safe = raw.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
    return Markup(safe)  # noqa: S704  (escaped above)


def _asset(name: str) -> str:
    return files("mascarin.report").joinpath(name).read_text(encoding="utf-8")


def _symbol(words: str) -> Markup:
    """A symbol such as ``h_ci`` or ``alpha_CI``: Greek letters by their sign, an index below the line."""
    base, _, index = words.partition("_")
    letter = {"alpha": "α", "gamma": "γ", "epsilon": "ε", "lambda": "λ", "rho": "ρ"}.get(base, base)
    return Markup("{}<sub>{}</sub>").format(letter, index) if index else Markup("{}").format(letter)
