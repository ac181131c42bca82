"""Commands for phase-change materials: the library of products, and DSC measurements."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from mascarin._io.atomic import drafted
from mascarin._io.locks import writing
from mascarin.commands.options.inputs import AsJson
from mascarin.commands.options.output import print_json, print_table
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.materials import Product
    from mascarin.materials.dsc import DscMaterial


def materials(
    query: str = "",
    /,
    *,
    melting: Annotated[str | None, Parameter(help="Melting temperature, as LOW..HIGH in degC.")] = None,
    kind: str | None = None,
    plot: Path | None = None,
    as_json: AsJson = False,
) -> None:
    """Search the library of phase-change products.

    A building file names a product: "ceiling_pcm: {product: RT25HC}". The name of one product prints all its
    data.

    Parameters
    ----------
    query : str
        Name of a product, or a part of its name, its maker or its form. Default: all products.
    kind : str
        Only products of this kind: organic, salt hydrate, powder, board, sheet.
    plot : Path
        File for a figure of enthalpy and apparent specific heat: SVG, PNG or PDF.
    """
    from mascarin.materials import search
    from mascarin.materials.library import suggestion

    _require_format(plot)
    chosen = search(query, melting=_interval(melting), kind=kind)
    exact = [product for product in chosen if _same(product.name, query)]
    chosen = exact or chosen
    if not chosen:
        hint = suggestion(query) if query else ""
        raise InputError(
            f"found no such product; expected a part of a name, or a wider search. {hint}".rstrip()
        )
    if as_json:
        print_json([described(product) for product in chosen])
    elif exact:
        _show(exact[0])
    else:
        _list(chosen)
    if plot is not None:
        from mascarin.materials.plots import plot as draw

        with writing(plot):
            figure = draw(chosen)
            with drafted(plot) as part:
                figure.savefig(part)
        print(f"wrote {plot}", file=sys.stderr)


def _require_format(plot: Path | None) -> None:
    if plot is not None:
        from mascarin.figures.files import require_format

        require_format(plot, "--plot")


def _same(name: str, query: str) -> bool:
    from mascarin.materials.library import plain

    return plain(name) == plain(query)


def _interval(text: str | None) -> tuple[float, float] | None:
    if text is None:
        return None
    low, dots, high = text.partition("..")
    try:
        if dots:
            return (float(low or "-inf"), float(high or "inf"))
    except ValueError:
        pass
    raise InputError(f"--melting: found '{text}'; expected LOW..HIGH in degC, such as 22..28, 22.. or ..28")


def _list(chosen: list[Product]) -> None:
    header = (
        "product",
        "kind",
        "melts",
        "freezes",
        "latent kJ/kg",
        "c J/(kg K)",
        "k W/(m K)",
        "rho kg/m3",
        "maker",
    )
    rows = [
        (
            product.name,
            product.kind or "",
            _number(product.melting_temperature, 1),
            _number(product.freezing_temperature, 1),
            _number(_kilo(product.number("latent_heat")), 0),
            *(_pair(product.pair(key)) for key in ("specific_heat", "conductivity", "density")),
            product.maker,
        )
        for product in chosen
    ]
    print_table(header, rows)


def _show(product: Product) -> None:
    ranged = product.melting_range
    lines = [
        ("maker", product.maker),
        ("kind", ", ".join(text for text in (product.kind, product.form) if text)),
        ("melting range", f"{ranged[0]:g} to {ranged[1]:g} degC" if ranged else ""),
        (
            "melts",
            _with(
                product.melting_temperature,
                "degC (half is liquid)" if product.heating else "degC (as stated)",
            ),
        ),
        ("freezes", _with(product.freezing_temperature, "degC (half is liquid)")),
        ("latent heat", _with(_kilo(product.number("latent_heat")), "kJ/kg")),
        ("specific heat", _with(_pair(product.pair("specific_heat")), "J/(kg K) solid/liquid")),
        ("conductivity", _with(_pair(product.pair("conductivity")), "W/(m K) solid/liquid")),
        ("density", _with(_pair(product.pair("density")), "kg/m3 solid/liquid")),
        ("thickness", _with(product.number("thickness"), "m")),
        ("curves", ", ".join(name for name in ("heating", "cooling") if getattr(product, name)) or "none"),
        ("law", json.dumps(_bare(product.raw["law"])) if "law" in product.raw else ""),
        ("source", product.source),
        ("note", product.note or ""),
    ]
    print(product.name)
    for label, text in lines:
        if text:
            print(f"  {label:14} {text}")
    print(f"\nIn a building file:\n  materials:\n    my_pcm: {{product: {product.name}}}")


def _number(value: float | None, digits: int) -> str:
    return "" if value is None else f"{value:.{digits}f}"


def _with(value: float | str | None, unit: str) -> str:
    if value is None or value == "":
        return ""
    return f"{value if isinstance(value, str) else f'{value:g}'} {unit}"


def _kilo(value: float | None) -> float | None:
    return None if value is None else value / 1000.0


def _pair(pair: tuple[float, float] | None) -> str:
    if pair is None:
        return ""
    return f"{pair[0]:g}" if pair[0] == pair[1] else f"{pair[0]:g}/{pair[1]:g}"


def _bare(raw: Any) -> Any:
    if isinstance(raw, dict):
        return raw["value"] if "value" in raw else {key: _bare(value) for key, value in raw.items()}
    return raw


def described(product: Product) -> dict[str, Any]:
    """Data of a product in SI units; None where the source gives no value."""
    from mascarin.materials.library import curves

    return {
        "name": product.name,
        "maker": product.maker,
        "kind": product.kind,
        "form": product.form,
        "melting_temperature": product.melting_temperature,
        "freezing_temperature": product.freezing_temperature,
        "melting_range": product.melting_range,
        "latent_heat": product.number("latent_heat"),
        **{key: product.pair(key) for key in ("specific_heat", "conductivity", "density")},
        "thickness": product.number("thickness"),
        "law": _bare(product.raw.get("law")),
        "curves": {
            direction: {"temperatures": curve.temperatures, "liquid_fraction": curve.liquid_fraction}
            for direction, curve in curves(product)
        },
        "source": product.source,
        "note": product.note,
    }


def dsc(
    files: tuple[Path, ...],
    /,
    *,
    out: Annotated[Path | None, Parameter(name=("--out", "-o"))] = None,
    name: str | None = None,
    law: str = "table",
    unit: str | None = None,
    rate: float | None = None,
    mass: float | None = None,
    specific_heat: str | None = None,
    segments: Annotated[list[str] | None, Parameter(name="--segment", negative="")] = None,
    melting: Annotated[str | None, Parameter(help="Range of melting, as LOW..HIGH in degC.")] = None,
    conductivity: str | None = None,
    density: str | None = None,
    supercooling: Annotated[bool, Parameter(negative="")] = False,
    plot: Path | None = None,
    as_json: AsJson = False,
) -> None:
    """Make a phase-change material from a DSC measurement.

    The file is an export of a calorimeter (NETZSCH Proteus, Mettler STARe, TA Universal Analysis, TRIOS), or
    CSV: a column of temperature, and heat flow, apparent specific heat or enthalpy, with units in the names,
    such as "temperature [degC]" and "cp heating [J/(g K)]". Prints latent heat, onset, peak and end, and how
    closely each law fits.

    Parameters
    ----------
    files : tuple of Path
        Files of the measurement (differential scanning calorimeter). Of several files of one material the
        slowest runs are averaged, and their spread is stated.
    out : Path
        File for the material, in the form of a building file.
    name : str
        Name of the material. Default: the name of the file.
    law : str
        Form of the melting curve: "table" as measured, or a law of the report, such as "gumbel, tail low".
    unit : str
        Unit of the signal, if the file does not state it: mW/mg, mW, J/(g K), J/(kg K), J/g, kJ/kg.
    rate : float
        Heating rate, for a heat flow without a time column. [K/min]
    mass : float
        Mass of the sample, for a heat flow of the whole sample. [mg]
    segments : list of str
        Segment of the file to use, such as that of the second heating; can be given several times. Default:
        all that heat or cool.
    specific_heat : str
        SOLID,LIQUID, if the baseline was subtracted from the signal. [J/(kg K)]
    conductivity : str
        VALUE or SOLID,LIQUID; DSC does not measure it. [W/(m K)]
    density : str
        VALUE or SOLID,LIQUID; DSC does not measure it. [kg/m3]
    supercooling : bool
        Let the material freeze as the cooling run shows: below its melting temperature, with a speed of its
        own. Needs heating, and cooling over time, in one file.
    plot : Path
        File for a figure of enthalpy and apparent specific heat: SVG, PNG or PDF.
    """
    from mascarin.materials.dsc_several import from_dsc_files

    _require_format(plot)
    span = _interval(melting)
    material = from_dsc_files(
        files,
        unit=unit,
        rate=rate,
        mass=mass,
        specific_heat=_values(specific_heat, "--specific-heat", 2),
        melting_range=span,
        segments=segments or (),
    )
    described = material.description(
        law,
        conductivity=_values(conductivity, "--conductivity"),
        density=_values(density, "--density"),
        supercooling=supercooling,
    )
    with writing(out, plot):
        if out is not None:
            _write(material, name or material.name, described, out)
        if plot is not None:
            figure = material.plot()
            with drafted(plot) as part:
                figure.savefig(part)
            print(f"wrote {plot}", file=sys.stderr)
    if as_json:
        print_json({"material": described, **material.to_dict()})
    else:
        print(material.report())


def _write(material: DscMaterial, name: str, described: dict[str, Any], out: Path) -> None:
    from mascarin.materials.dsc_yaml import to_yaml

    usable = re.sub(r"\W", "_", name)
    usable = usable if usable[:1].isalpha() else f"pcm_{usable}"
    with drafted(out) as part:
        text = to_yaml(usable, described, [f"from {material.name}", *material.report().splitlines()])
        part.write_text(text, encoding="utf-8")
    print(f"wrote {out}", file=sys.stderr)


def _values(text: str | None, option: str, count: int = 0) -> Any:
    """Read one value, or one for the solid and one for the liquid."""
    if text is None:
        return None
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if len(values) not in ((count,) if count else (1, 2)) or not all(value > 0.0 for value in values):
        expected = "SOLID,LIQUID" if count else "VALUE or SOLID,LIQUID"
        raise InputError(f"{option}: found '{text}'; expected {expected}, positive numbers")
    return values[0] if len(values) == 1 else (values[0], values[1])
