"""Reference of the Python interface: the public names of each package, described by their docstrings."""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Iterator
from typing import Final

import mascarin

PACKAGES: Final = (
    "building", "materials", "weather", "simulation", "ensemble", "sensitivity", "optimization",
    "measurements", "validation", "calibration", "study", "design", "comfort", "energyplus", "fmu",
    "pages.view", "pages.live", "physics",
)  # fmt: skip


def pages() -> dict[str, str]:
    """Pages by name: the overview, and one for each package."""
    found = {"api/index": _overview(), "api/mascarin": _page("mascarin", list(_own_names()))}
    for package in PACKAGES:
        module = importlib.import_module(f"mascarin.{package}")
        found[f"api/{package}"] = _page(module.__name__, list(module.__all__))
    return found


def _own_names() -> Iterator[str]:
    """Names of the package itself that are in no other package."""
    elsewhere = {name for one in PACKAGES for name in importlib.import_module(f"mascarin.{one}").__all__}
    for name in mascarin.__all__:
        if (
            name not in elsewhere
            and not inspect.ismodule(getattr(mascarin, name))
            and not name.startswith("_")
        ):
            yield name


def _overview() -> str:
    lines = [
        "# Python",
        "",
        "All public classes and functions. [Mascarin from Python](../python.md) shows how they work. "
        "Functions take `building` and `climate` by position; all options have names.",
        "",
        "| package | contents |",
        "|---|---|",
        "| [mascarin](mascarin.md) | names that are in no other package; all of `import mascarin as mc` |",
    ]
    for package in PACKAGES:
        doc = inspect.getdoc(importlib.import_module(f"mascarin.{package}")) or ""
        lines.append(
            f"| [mascarin.{package}]({package}.md) | {' '.join(doc.split(chr(10) * 2)[0].split())} |"
        )
    tree = "\n".join(("mascarin", *PACKAGES))
    return "\n".join(lines) + f"\n\n```{{toctree}}\n:hidden:\n\n{tree}\n```\n"


def _page(module: str, names: list[str]) -> str:
    """Classes, functions and constants of a module."""
    owner = importlib.import_module(module)
    kinds: dict[str, list[str]] = {"Functions": [], "Classes": [], "Constants": []}
    for name in sorted(names, key=str.lower):
        value = getattr(owner, name)
        kind = "Classes" if inspect.isclass(value) else "Functions" if callable(value) else "Constants"
        if kind != "Constants" or not hasattr(value, "__origin__"):
            kinds[kind].append(name)
    lines = [f"# {module}", ""]
    for title, found in kinds.items():
        if not found:
            continue
        lines += [f"## {title}", ""]
        for name in found:
            lines += _directive(module, name, title)
    return "\n".join(lines) + "\n"


def _at_home(module: str, name: str) -> bool:
    """Whether a package is where one of its names is defined, or the first of those that offer it.

    Sphinx wants each object once; links lead there.
    """
    offered = [
        package for package in PACKAGES if name in importlib.import_module(f"mascarin.{package}").__all__
    ]
    value = getattr(importlib.import_module(module), name)
    same = [p for p in offered if getattr(importlib.import_module(f"mascarin.{p}"), name) is value]
    if len(same) < 2:
        return True
    home = next((p for p in same if value.__module__.startswith(f"mascarin.{p}.")), same[0])
    return module == f"mascarin.{home}"


def _directive(module: str, name: str, title: str) -> list[str]:
    directive = {"Functions": "autofunction", "Classes": "autoclass", "Constants": "autodata"}[title]
    options = [":members:", ":exclude-members: model_config, model_post_init"] if title == "Classes" else []
    if not _at_home(module, name):
        options.append(":no-index:")
    if title == "Constants":
        options = [":no-value:"]
    body = "\n".join(
        ["```{eval-rst}", f".. {directive}:: {module}.{name}", *(f"   {one}" for one in options), "```"]
    )
    return [body, ""]
