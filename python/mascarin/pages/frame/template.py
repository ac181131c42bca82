"""The frame of all pages: one template to extend, one style, one content security policy.

A page is one file: styles, scripts, pictures and data are parts of it. Its policy names its scripts by their
hash and forbids the browser to load anything, or to run what a name in a description might contain.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any, Final, NamedTuple

from jinja2 import BytecodeCache, Environment, PackageLoader, StrictUndefined
from jinja2.bccache import Bucket
from markupsafe import Markup

from mascarin._io.terminal import printable
from mascarin.figures import colors
from mascarin.figures.text import significant, typeset
from mascarin.pages.frame.cross_references import CrossReferences


class Library(NamedTuple):
    """A program of others that is part of pages.

    Parameters
    ----------
    script, licence : str
        Its files, below the package.
    purpose : str
        What it does on the page, as a sentence.
    """

    script: str
    licence: str
    purpose: str


CURVES: Final = Library(
    "pages/frame/vendor/uPlot.iife.min.js", "pages/frame/vendor/uPlot.LICENSE", "Curves are drawn by uPlot."
)


class _Compiled(BytecodeCache):
    """Compiled templates of this process: each page has an environment of its own."""

    def __init__(self) -> None:
        self._codes: dict[tuple[str, str], bytes] = {}

    def load_bytecode(self, bucket: Bucket) -> None:
        bytecode = self._codes.get((bucket.key, bucket.checksum))
        if bytecode is not None:
            bucket.bytecode_from_string(bytecode)

    def dump_bytecode(self, bucket: Bucket) -> None:
        self._codes[bucket.key, bucket.checksum] = bucket.bytecode_to_string()


_COMPILED: Final = _Compiled()


def environment(references: CrossReferences | None = None) -> Environment:
    """Templates of all packages, by their path below ``mascarin``; they extend ``pages/frame/base.html``.

    Parameters
    ----------
    references : CrossReferences, optional
        Numbers of tables and figures; new ones if not given.

    Examples
    --------
    >>> environment().get_template("pages/frame/base.html").name
    'pages/frame/base.html'
    """
    templates = Environment(
        loader=PackageLoader("mascarin", ""),
        autoescape=True,
        finalize=lambda value: printable(value) if type(value) is str else value,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        bytecode_cache=_COMPILED,
    )
    templates.filters |= {"typeset": typeset, "significant": significant, "symbol": _symbol}
    templates.globals["references"] = references or CrossReferences()
    return templates


def frame(
    *,
    styles: Sequence[str] = (),
    libraries: Sequence[Library] = (),
    scripts: Sequence[str] = (),
    data: Mapping[str, Any] | None = None,
    served: bool = False,
    computes: bool = False,
) -> dict[str, Any]:
    """Values of the frame of a page.

    Parameters
    ----------
    styles : sequence of str
        Style sheets beside ``pages/frame/report.css``, below the package.
    libraries : sequence of Library
        Programs of others, which run before the scripts.
    scripts : sequence of str
        Scripts, below the package.
    data : mapping, optional
        Data of the scripts, in the element ``page-data``.
    served : bool
        Whether the page may ask the server that it comes from.
    computes : bool
        Whether the page has a module of WebAssembly, and a worker that runs it.

    Returns
    -------
    dict
        ``style``, ``policy``, ``scripts``, ``data`` and ``software`` of ``pages/frame/base.html``.

    Examples
    --------
    >>> frame()["policy"].startswith("default-src 'none'; style-src")
    True
    """
    texts = [asset(library.script) for library in libraries] + [asset(script) for script in scripts]
    style = "\n".join((palette(), asset("pages/frame/report.css"), *map(asset, styles)))
    return {
        "style": Markup(style),  # noqa: S704  (our own files)
        "policy": _policy(texts, served=served, computes=computes),
        "scripts": [Markup(script) for script in texts],  # noqa: S704
        "data": None if data is None else _json(data),
        "software": [
            {"purpose": library.purpose, "licence": asset(library.licence)} for library in libraries
        ],
    }


@cache
def asset(path: str) -> str:
    """Text of a file of the package, by its path below ``mascarin``."""
    return files("mascarin").joinpath(path).read_text(encoding="utf-8")


def palette() -> str:
    """The colors of all figures as custom properties of a style sheet."""
    named = {
        "observed": colors.MEASURED,
        "fitted": colors.FITTED,
        "nominal": colors.NOMINAL,
        "rest": colors.REMAINDER,
    }
    named |= {f"c{number}": color for number, color in enumerate(colors.PALETTE)}
    return ":root {" + " ".join(f"--{name}: {color};" for name, color in named.items()) + "}"


def _policy(scripts: Sequence[str], *, served: bool, computes: bool) -> str:
    """Content security policy: only the scripts of this file run, and nothing is loaded from elsewhere.

    A worker is started from a text of the page, and has this policy, too.
    """
    digests = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
        for script in scripts
    )
    module = " 'wasm-unsafe-eval'" if computes else ""
    rules = [
        "default-src 'none'",
        *([f"script-src {digests}{module}"] if digests else []),
        *(["worker-src blob:"] if computes else []),
        "style-src 'unsafe-inline'",
        "img-src data:",
        *(["connect-src 'self'"] if served else []),
        "base-uri 'none'",
        "form-action 'none'",
    ]
    return "; ".join(rules)


def _json(content: Mapping[str, Any]) -> Markup:
    """JSON without characters that would end its HTML element."""
    raw = json.dumps(content, separators=(",", ":"), allow_nan=False)
    safe = raw.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
    return Markup(safe)  # noqa: S704  (escaped above)


def _symbol(words: str) -> Markup:
    """A symbol such as ``h_ci`` or ``alpha_CI``: Greek letters by their sign, an index below the line."""
    base, _, index = words.partition("_")
    letter = {"alpha": "α", "gamma": "γ", "epsilon": "ε", "lambda": "λ", "rho": "ρ"}.get(base, base)
    return Markup("{}<sub>{}</sub>").format(letter, index) if index else Markup("{}").format(letter)
