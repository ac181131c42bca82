"""Ranges of the numbers that materials of a name have, by tabulated design values.

References
----------
ISO 10456:2007, Building materials and products: hygrothermal properties, tabulated design values and
procedures for determining declared and design thermal values, table 3.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

TOLERANCE: Final = 0.25
"""Part by which a number may be outside of the tabulated values of its kind. [-]"""

SOURCE: Final = "ISO 10456:2007, table 3"


@dataclass(frozen=True, slots=True)
class MaterialKind:
    """Tabulated values of a kind of material: the lowest and the highest of each quantity.

    Attributes
    ----------
    name : str
        The kind.
    conductivity : tuple of float
        [W/(m K)]
    density : tuple of float
        [kg/m3]
    specific_heat : tuple of float
        [J/(kg K)]
    """

    name: str
    conductivity: tuple[float, float]
    density: tuple[float, float]
    specific_heat: tuple[float, float]


#: Words of a name, and what is tabulated for them; the first that matches counts.
_KINDS: Final = (
    (r"reinforced.?concrete", MaterialKind("reinforced concrete", (2.3, 2.5), (2300, 2400), (1000, 1000))),
    (r"concrete.?tile", MaterialKind("concrete tiles", (1.5, 1.5), (2100, 2100), (1000, 1000))),
    (r"concrete|beton", MaterialKind("concrete", (1.15, 2.5), (1800, 2400), (1000, 1000))),
    (r"plaster.?board|gypsum.?board", MaterialKind("plasterboard", (0.21, 0.25), (700, 900), (1000, 1000))),
    (r"gypsum", MaterialKind("gypsum", (0.18, 0.56), (600, 1500), (1000, 1000))),
    (r"plaster|render", MaterialKind("plasters and renders", (0.18, 1.0), (600, 1800), (1000, 1000))),
    (r"plywood", MaterialKind("plywood", (0.09, 0.24), (300, 1000), (1600, 1600))),
    (r"osb", MaterialKind("oriented strand board", (0.13, 0.13), (650, 650), (1700, 1700))),
    (r"timber|softwood|hardwood|spruce|oak", MaterialKind("timber", (0.12, 0.18), (450, 700), (1600, 1600))),
    (r"granite", MaterialKind("granite", (2.8, 2.8), (2500, 2700), (1000, 1000))),
    (r"limestone", MaterialKind("limestone", (0.85, 2.3), (1600, 2600), (1000, 1000))),
    (r"marble", MaterialKind("marble", (3.5, 3.5), (2800, 2800), (1000, 1000))),
    (r"stainless", MaterialKind("stainless steel", (17, 30), (7900, 7900), (460, 500))),
    (r"steel", MaterialKind("steel", (50, 50), (7800, 7800), (450, 450))),
    (r"alumini?um", MaterialKind("aluminium alloys", (160, 160), (2800, 2800), (880, 880))),
    (r"copper", MaterialKind("copper", (380, 380), (8900, 8900), (380, 380))),
    (r"\bglass\b(?! (wool|fib))", MaterialKind("glass", (1.0, 1.4), (2000, 2500), (750, 750))),
)  # fmt: skip
#: Materials of such names have other numbers than the kind of their last word.
_SPECIAL: Final = re.compile(r"light|aerated|cellular|foam|insulat|hollow|board.?with|wool|pcm|straw|hemp")


def kind_of(material: str) -> MaterialKind | None:
    """Find what is tabulated for a material of some name; None for names that do not say what it is.

    Parameters
    ----------
    material : str
        Name of the material.

    Examples
    --------
    >>> kind_of("heavy_concrete").conductivity
    (1.15, 2.5)
    >>> kind_of("aerated_concrete"), kind_of("layer_2")
    (None, None)
    """
    words = material.lower().replace("_", " ").replace("-", " ")
    if _SPECIAL.search(words):
        return None
    return next((kind for pattern, kind in _KINDS if re.search(pattern, words)), None)


def unusual(path: str, value: float) -> str | None:
    """Say that a number is not one that the named material has; None if it may be, or nothing is tabulated.

    Parameters
    ----------
    path : str
        Such as ``materials.concrete.conductivity``.
    value : float
        [unit of the number]

    Examples
    --------
    >>> unusual("materials.concrete.conductivity", 0.26)
    'concrete has 1.15 to 2.5 (ISO 10456:2007, table 3)'
    >>> unusual("materials.concrete.conductivity", 1.6) is None
    True
    """
    steps = path.split(".")
    if len(steps) != 3 or steps[0] != "materials":
        return None
    kind = kind_of(steps[1])
    if kind is None or steps[2] not in ("conductivity", "density", "specific_heat"):
        return None
    low, high = getattr(kind, steps[2])
    if low * (1.0 - TOLERANCE) <= value <= high * (1.0 + TOLERANCE):
        return None
    return (
        f"{kind.name} has {low:g} to {high:g} ({SOURCE})"
        if low < high
        else f"{kind.name} has {low:g} ({SOURCE})"
    )
