"""The layers of a construction, drawn to scale."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.building.parts.materials.material import PhaseChangeMaterial, Resistance
from mascarin.building.parts.materials.phases import phase
from mascarin.figures import text
from mascarin.figures.svg.building_drawings import fill_of
from mascarin.figures.svg.chart import Svg
from mascarin.study_document.building import LayerEntry

if TYPE_CHECKING:
    from markupsafe import Markup

    from mascarin.building import Building
    from mascarin.building.parts.envelope.surface import Layer

#: Width of the thickest construction of a building, and height of the drawings [px].
_WIDTH, _HEIGHT = 300.0, 84.0
#: Lengths of a scale bar [m].
_SCALE_LENGTHS: Final = (1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
_RESISTANCE_THICKNESS: Final = 0.02  # drawn thickness of a resistance without one [m]


def constructions(building: Building) -> list[dict[str, Any]]:
    """Every construction with its layers, their drawing, and the surfaces that are built so.

    Parameters
    ----------
    building : Building
        The building.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> constructions(box())[0]["layers"][0]["number"]
    1
    """
    layers_by_name = {
        name: [_layer(building, layer) for layer in built.layers] for name, built in _built(building)
    }
    widest = max((sum(layer["drawn"] for layer in layers) for layers in layers_by_name.values()), default=1.0)
    return [
        {
            "name": name,
            "layers": [_row(number, layer) for number, layer in enumerate(layers, start=1)],
            "drawing": drawing(name, layers, _WIDTH / widest),
            "thickness": text.significant(1e3 * sum(layer["thickness"] or 0.0 for layer in layers)),
            "surfaces": [key for key, surface in building.surfaces.items() if surface.construction == name],
        }
        for name, layers in layers_by_name.items()
    ]


def _built(building: Building) -> list[tuple[str, Any]]:
    return list(building.constructions.items())


def _layer(building: Building, layer: Layer) -> dict[str, Any]:
    material = building.materials[layer.material]
    row: dict[str, Any] = {"name": layer.name, "material": layer.material, "kind": material.kind}
    row["thickness"] = None if layer.thickness is None else float(layer.thickness)
    row["drawn"] = row["thickness"] or _RESISTANCE_THICKNESS
    if isinstance(material, Resistance):
        return row | {"resistance": float(material.resistance), "melting": None}
    values = {
        key: tuple(phase(getattr(material, key), state) for state in ("solid", "liquid"))
        for key in ("conductivity", "density", "specific_heat")
    }
    melting = None
    if isinstance(material, PhaseChangeMaterial):
        melting = tuple(float(end) for end in material.melting)
    resistance = row["drawn"] / values["conductivity"][0]
    return row | values | {"resistance": resistance, "melting": melting}


def _row(number: int, layer: Mapping[str, Any]) -> dict[str, str | int]:
    """A layer in a table: solid/liquid where they differ."""
    thickness = layer["thickness"]
    melting = layer["melting"]
    return {
        "number": number,
        "name": str(layer["name"]),
        "material": str(layer["material"]),
        "thickness": text.NONE if thickness is None else text.significant(1e3 * thickness, 4),
        "resistance": text.significant(layer["resistance"]),
        "melting": ""
        if melting is None
        else f"{text.significant(melting[0])} to {text.significant(melting[1])}",
        **{key: _pair(layer.get(key)) for key in ("conductivity", "density", "specific_heat")},
    }


def _pair(values: tuple[float, float] | None) -> str:
    if values is None:
        return text.NONE
    shown = dict.fromkeys(text.significant(value, 4) for value in values)
    return " / ".join(shown)


def drawing(name: str, layers: Sequence[Mapping[str, Any]], scale: float) -> Markup:
    """Layers from outside (left) to inside, widths in proportion to their thickness.

    Parameters
    ----------
    name : str
        Name of the construction.
    layers : sequence of mappings
        ``drawn`` (thickness) [m], ``kind``, ``conductivity``, ``density``.
    scale : float
        Width of a metre. [px]
    """
    svg = Svg(_WIDTH + 110.0, _HEIGHT + 46.0)
    widths = np.maximum([scale * layer_row["drawn"] for layer_row in layers], 1.2)
    edges = 55.0 + np.concatenate([[0.0], np.cumsum(widths)])
    top, bottom = 14.0, 14.0 + _HEIGHT
    last = -99.0
    for number, (layer, x0, x1) in enumerate(zip(layers, edges, edges[1:], strict=False), start=1):
        density = layer.get("density")
        fill_of(
            svg,
            LayerEntry(
                kind=layer["kind"],
                conductivity=layer["conductivity"][0] if "conductivity" in layer else None,
                density=None if density is None else density[0],
            ),
            (float(x0), float(x1)),
            (top, bottom),
        )
        middle = max(0.5 * float(x0 + x1), last + 11.0)  # numbers of thin layers stand side by side
        last = middle
        svg.label(middle, bottom + 14.0, str(number), "tick", "middle")
    svg.label(50.0, top + 0.5 * _HEIGHT, "outside", "small", "end")
    svg.label(float(edges[-1]) + 6.0, top + 0.5 * _HEIGHT, "inside", "small")
    length = next(
        (bar_length for bar_length in _SCALE_LENGTHS if bar_length * scale <= 90.0), _SCALE_LENGTHS[-1]
    )
    y = bottom + 30.0
    svg.line(55.0, y, 55.0 + length * scale, y, "scale-bar")
    svg.line(55.0, y - 3.0, 55.0, y + 3.0, "scale-bar")
    svg.line(55.0 + length * scale, y - 3.0, 55.0 + length * scale, y + 3.0, "scale-bar")
    shown = f"{1e3 * length:g}\u00a0mm" if length < 1.0 else "1\u00a0m"
    svg.label(60.0 + length * scale, y + 4.0, shown, "tick")
    return svg.markup(f"Layers of {name} from outside to inside, to scale")
