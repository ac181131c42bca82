"""Products that come with Mascarin: the file `products.yaml`, found by name or filtered by properties.

A building file names a product (``product: RT25HC``); the description then checks each of its numbers as if
the user had given it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

from mascarin.errors import InputError, did_you_mean
from mascarin.physics import MeltingCurve

FILE: Final = Path(__file__).with_name("products.yaml")
STEP: Final = 0.5
"""Distance of the points of a curve [K]."""

PROPERTIES: Final = ("conductivity", "density", "specific_heat")
KINDS: Final = ("organic", "salt hydrate", "powder", "board", "sheet")
DIRECTIONS: Final = ("heating", "cooling")
COLLECTION: Final = "as collected in slPCMlib (Barz, Bres & Emhofer 2022, doi:10.3384/ecp19363)"


@dataclass(frozen=True)
class Curve:
    """Liquid fraction over temperature, in steps of `STEP`, from 0 to 1.

    Attributes
    ----------
    first : float
        First temperature. [degC]
    liquid_fraction : tuple of float
        Liquid fraction at each temperature. [-]

    Examples
    --------
    >>> Curve(first=20.0, liquid_fraction=(0.0, 0.5, 1.0)).temperature_at(0.25)
    20.25
    """

    first: float
    liquid_fraction: tuple[float, ...]

    @property
    def temperatures(self) -> tuple[float, ...]:
        """Temperatures of the points [degC]."""
        return tuple(self.first + STEP * k for k in range(len(self.liquid_fraction)))

    def temperature_at(self, fraction: float) -> float:
        """Temperature at which a fraction is liquid, linear between the points [degC]."""
        points = list(zip(self.temperatures, self.liquid_fraction, strict=True))
        for (t0, f0), (t1, f1) in pairwise(points):
            if f0 <= fraction <= f1 and f1 > f0:
                return t0 + (fraction - f0) / (f1 - f0) * (t1 - t0)
        raise ValueError(f"liquid fraction {fraction:g} is outside the curve")


#: Largest difference of the heat of a delivered product from its data sheet, by maker, and its source. [-]
_STATED: Final[Mapping[str, tuple[float, str]]] = {
    "Rubitherm GmbH": (0.075, "heat storage capacity within 7.5 % (data sheets of Rubitherm)"),
}
#: The same between calorimeters, at other rates and with other limits of integration: a judgement. [-]
_CALORIMETERS: Final = 0.1


@dataclass(frozen=True, repr=False)
class Product:
    """A phase-change product.

    Attributes
    ----------
    name, maker : str
        Name of the product and of the manufacturer.
    kind, form : str or None
        One of `KINDS`, and the form of delivery.
    source, note : str or None
        Source of the numbers, and a remark.
    heating, cooling : Curve or None
        Liquid fraction on heating and on cooling.
    raw : mapping
        The numbers as in the file, with ranges and sources, for use in a description.

    Examples
    --------
    >>> one = product("RT25HC")
    >>> one.melting_temperature, one.pair("density")
    (24.3, (880.0, 770.0))
    >>> one
    Product('RT25HC', organic, melts at 24.3 degC, 198.9 kJ/kg)
    """

    name: str
    maker: str
    kind: str | None
    form: str | None
    source: str
    note: str | None
    heating: Curve | None
    cooling: Curve | None
    raw: Mapping[str, Any]

    def __repr__(self) -> str:
        words = [self.kind or ""]
        if self.melting_temperature is not None:
            words.append(f"melts at {self.melting_temperature:g} degC")
        latent = self.number("latent_heat")
        if latent is not None:
            words.append(f"{latent / 1000.0:.4g} kJ/kg")
        return f"Product({self.name!r}, {', '.join(word for word in words if word)})"

    def pair(self, key: str) -> tuple[float, float] | None:
        """A property of solid and liquid, or None where it is not known. [unit of the property]"""
        raw = self.raw.get(key)
        if raw is None:
            return None
        if isinstance(raw, list):
            return (_bare(raw[0]), _bare(raw[1]))
        return (_bare(raw), _bare(raw))

    def number(self, key: str) -> float | None:
        """A single number, such as the latent heat, or None where it is not known."""
        raw = self.raw.get(key)
        return None if raw is None else _bare(raw)

    @property
    def heat_tolerance(self) -> tuple[float, str] | None:
        """Relative half-width of the range of the heat of melting and its reason, where the maker states one.

        What the maker states of delivered products and what calorimeters differ by are independent.
        """
        if self.maker not in _STATED:
            return None
        stated, reason = _STATED[self.maker]
        return math.hypot(stated, _CALORIMETERS), f"{reason}, and 10 % between calorimeters (judgement)"

    @property
    def melting_range(self) -> tuple[float, float] | None:
        """First and last temperature at which something melts or freezes [degC]."""
        return self.pair("melting_range")

    @property
    def melting_temperature(self) -> float | None:
        """Stated melting temperature, else that at which half is liquid on heating [degC]."""
        stated = self.number("melting_temperature")
        if stated is not None or self.heating is None:
            return stated
        return round(self.heating.temperature_at(0.5), 2)

    @property
    def freezing_temperature(self) -> float | None:
        """Temperature at which half is liquid on cooling [degC]; None where there is no cooling curve."""
        return None if self.cooling is None else round(self.cooling.temperature_at(0.5), 2)

    @property
    def missing(self) -> tuple[str, ...]:
        """Properties that a wall needs and the source does not give."""
        return tuple(key for key in (*PROPERTIES, "latent_heat") if key not in self.raw)

    def enthalpies(self, temperatures: Sequence[float], fractions: Sequence[float]) -> tuple[float, ...]:
        """Specific enthalpy along a curve, above its first point.

        ``h(T, xi) = c_s (T - Tm) + xi [L + (c_l - c_s)(T - Tm)]``: a function of temperature and liquid
        fraction alone, so that heating and cooling curve agree in the liquid and in the solid.

        Parameters
        ----------
        temperatures, fractions : sequences of float
            Points of the curve: temperature [degC] and liquid fraction [-].

        Returns
        -------
        tuple of float
            Enthalpies [J/kg].

        Raises
        ------
        ValueError
            The specific heat, the latent heat or the melting temperature is not known.
        """
        heats, latent, centre = (
            self.pair("specific_heat"),
            self.number("latent_heat"),
            self.melting_temperature,
        )
        if heats is None or latent is None or centre is None:
            raise ValueError(f"{self.name}: a property that the enthalpy needs is not known")
        solid, liquid = heats
        values = [
            solid * (t - centre) + xi * (latent + (liquid - solid) * (t - centre))
            for t, xi in zip(temperatures, fractions, strict=True)
        ]
        return tuple(round(value - values[0], 1) for value in values)


def _bare(raw: Any) -> float:
    return float(raw["value"] if isinstance(raw, Mapping) else raw)


def _curve(raw: Mapping[str, Any] | None) -> Curve | None:
    if raw is None:
        return None
    return Curve(float(raw["first"]), tuple(float(x) for x in raw["liquid_fraction"]))


def _product(name: str, raw: Mapping[str, Any]) -> Product:
    source = str(raw["source"])
    return Product(
        name=name,
        maker=str(raw["maker"]),
        kind=raw.get("kind"),
        form=raw.get("form"),
        source=source if "doi:" in source else f"{source}, {COLLECTION}",
        note=raw.get("note"),
        heating=_curve(raw.get("heating")),
        cooling=_curve(raw.get("cooling")),
        raw=raw,
    )


@cache
def products() -> Mapping[str, Product]:
    """Every product by its name, in the order of the file.

    Returns
    -------
    mapping of str to Product
        The library.

    Examples
    --------
    >>> "RT25HC" in products()
    True
    """
    from ruamel.yaml import YAML

    text = FILE.read_text(encoding="utf-8")
    return {name: _product(name, raw) for name, raw in YAML(typ="safe").load(text).items()}


def plain(name: str) -> str:
    """A name in lower case, without spaces and hyphens."""
    return re.sub(r"[\s_.-]", "", name).casefold()


def product(name: str) -> Product:
    """One product by its name; case, spaces and hyphens are ignored.

    Parameters
    ----------
    name : str
        The name.

    Returns
    -------
    Product
        The product.

    Raises
    ------
    InputError
        There is no such product; the text names the nearest ones.

    Examples
    --------
    >>> product("rt 25 hc").name
    'RT25HC'
    """
    for item in products().values():
        if plain(item.name) == plain(name):
            return item
    raise InputError(
        f"found the product '{name}'; expected one of the library ('mascarin materials' lists it). "
        f"{suggestion(name)}".rstrip()
    )


def suggestion(name: str) -> str:
    """Sentence with the nearest names, for a name that is no product."""
    by_plain = {plain(known_name): known_name for known_name in products()}
    close = did_you_mean(plain(name), by_plain)
    if not close.startswith("Did you mean"):
        return ""
    return re.sub(r"'([^']+)'", lambda match: f"'{by_plain[match[1]]}'", close)


def search(
    query: str = "", *, melting: tuple[float, float] | None = None, kind: str | None = None
) -> list[Product]:
    """Find products.

    Parameters
    ----------
    query : str
        Part of a name, of a maker or of the form; empty: any.
    melting : tuple of float, optional
        Lowest and highest melting temperature [degC].
    kind : str, optional
        One of `KINDS`.

    Returns
    -------
    list of Product
        By melting temperature, lowest first.

    Raises
    ------
    InputError
        There is no such kind, or the temperatures are in the wrong order.

    Examples
    --------
    >>> [one.name for one in search(melting=(22, 24), kind="salt hydrate")]
    ['savE-HS22', 'ClimSel-C21', 'SP24E']
    """
    if kind is not None and kind not in KINDS:
        raise InputError(f"kind: found '{kind}'; expected a kind of product. {did_you_mean(kind, KINDS)}")
    if melting is not None and not melting[0] <= melting[1]:
        raise InputError(f"melting: found {melting[0]:g}..{melting[1]:g}; expected the lower end first")
    items = [item for item in products().values() if _fits(item, query, melting, kind)]
    return sorted(items, key=lambda item: (item.melting_temperature or 0.0, item.name))


def _fits(item: Product, query: str, melting: tuple[float, float] | None, kind: str | None) -> bool:
    words = (plain(word) for word in (item.name, item.maker, item.form or ""))
    if query and not any(plain(query) in word for word in words):
        return False
    if kind is not None and item.kind != kind:
        return False
    if melting is None:
        return True
    centre = item.melting_temperature
    return centre is not None and melting[0] <= centre <= melting[1]


def curves(item: Product) -> Iterator[tuple[str, Curve]]:
    """The curves that are known, each with its direction."""
    for direction in DIRECTIONS:
        curve = getattr(item, direction)
        if curve is not None:
            yield direction, curve


def enthalpy_curves(item: Product) -> Iterator[tuple[str, tuple[float, ...], tuple[float, ...]]]:
    """Enthalpy over temperature, where it is known.

    Yields
    ------
    tuple
        Name of the curve (heating, cooling, or the law of a product without curves), temperatures [degC],
        enthalpies [J/kg].
    """
    if {"specific_heat", "latent_heat"} & set(item.missing) or item.melting_temperature is None:
        return
    by_direction = dict(curves(item))
    low = min((curve.temperatures[0] for curve in by_direction.values()), default=0.0) - 2.0
    high = max((curve.temperatures[-1] for curve in by_direction.values()), default=0.0) + 2.0
    for direction, curve in by_direction.items():  # from the solid to the liquid, where the curves meet
        points = (low, *curve.temperatures, high)
        yield direction, points, item.enthalpies(points, (0.0, *curve.liquid_fraction, 1.0))
    if item.heating is None and item.cooling is None and "law" in item.raw:
        width, centre = _bare(item.raw["law"]["width"]), item.melting_temperature
        points = tuple(centre + 0.1 * k * width for k in range(-40, 41))
        law = MeltingCurve("tanh_width", {"melting_temperature": centre, "width": width})
        fractions = law(points).tolist()
        yield f"tanh law, half-width {width:g} K", points, item.enthalpies(points, fractions)


def capacities(temperatures: Sequence[float], enthalpies: Sequence[float]) -> list[tuple[float, float]]:
    """Apparent specific heat between the points: mid temperature [degC], capacity [J/(kg K)]."""
    points = list(zip(temperatures, enthalpies, strict=True))
    return [(0.5 * (t0 + t1), (h1 - h0) / (t1 - t0)) for (t0, h0), (t1, h1) in pairwise(points)]
