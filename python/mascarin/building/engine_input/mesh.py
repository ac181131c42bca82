"""Number of finite volumes of each layer.

The mesh is chosen once for all runs of a study: a mesh that changed with a parameter would make objectives
discontinuous. Numbers that vary are therefore taken at the end of their range that needs most volumes.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mascarin.building.base.leaves import leaves
from mascarin.building.base.number import Interval
from mascarin.building.parameters.parameter import resolve
from mascarin.building.parts.materials.closed_law import ClosedLaw
from mascarin.building.parts.materials.formula_curve import FormulaCurve
from mascarin.building.parts.materials.material import PhaseChangeMaterial, Resistance
from mascarin.building.parts.materials.phase_change import Law, TanhLaw, TriangleLaw
from mascarin.building.parts.materials.phases import Phases, phase

if TYPE_CHECKING:
    from mascarin.building.parts.description import Description
    from mascarin.building.parts.envelope.surface import Layer

#: Least number of volumes of a phase-change layer; with fewer the melting front moves in jumps.
LEAST_IN_PCM = 4
#: Usual heat flux in a melting layer of a building [W/m2].
MELTING_FLUX = 20.0
#: Largest number of volumes because of the melting range.
MOST_FOR_MELTING = 12
#: Largest number of volumes of a layer, unless its ``nodes`` are given.
MOST_IN_LAYER = 60


@dataclass(frozen=True)
class Mesh:
    """Number of finite volumes by construction and layer, with warnings."""

    nodes: Mapping[tuple[str, str], int]
    warnings: tuple[str, ...]


def choose(building: Description, step_seconds: float, ranges: Mapping[str, Interval] | None = None) -> Mesh:
    """Choose the mesh of a building.

    Parameters
    ----------
    building : Building
        The building.
    step_seconds : float
        Time step. [s]
    ranges : mapping of str to (low, high), optional
        Ranges of the parameters that will vary. [unit of each]

    Returns
    -------
    Mesh
        Nodes of every layer, 0 for a resistance, and warnings where there are too few.
    """
    worst = _Worst(building, _by_path(building, ranges or {}))
    nodes, warnings = {}, []
    for name, construction in building.constructions.items():
        for layer in construction.layers:
            path = f"constructions.{name}.layers.{layer.name}"
            nodes[name, layer.name], warning = _of_layer(layer, path, worst, step_seconds)
            warnings += [warning] if warning else []
    return Mesh(nodes, tuple(warnings))


def _by_path(building: Description, ranges: Mapping[str, Interval]) -> dict[str, Interval]:
    numbers = {path: number for path, number, _ in leaves(building)} if ranges else {}
    return {resolve(building, path, numbers): ends for path, ends in ranges.items()}


@dataclass(frozen=True)
class _Worst:
    """Values of numbers at the ends of their ranges."""

    building: Description
    ranges: Mapping[str, Interval]

    def ends(self, path: str, value: float) -> Interval:
        return self.ranges.get(path, (float(value), float(value)))

    def property(self, material: str, name: str) -> Interval:
        """Lowest and highest value of a property, over both phases where there are two."""
        path, held = f"materials.{material}.{name}", getattr(self.building.materials[material], name)
        if not isinstance(held, Phases):
            return self.ends(path, held)
        solid, liquid = (self.ends(f"{path}.{state}", phase(held, state)) for state in ("solid", "liquid"))
        return (min(solid[0], liquid[0]), max(solid[1], liquid[1]))


def _of_layer(layer: Layer, path: str, worst: _Worst, step_seconds: float) -> tuple[int, str]:
    material = worst.building.materials[layer.material]
    if isinstance(material, Resistance) or layer.thickness is None:
        return 0, ""
    thickness = worst.ends(f"{path}.thickness", layer.thickness)[1]
    count = diffusion_count(
        thickness,
        worst.property(layer.material, "conductivity")[0],
        worst.property(layer.material, "density")[1] * worst.property(layer.material, "specific_heat")[1],
        step_seconds,
    )
    if isinstance(material, PhaseChangeMaterial):
        count = max(count, LEAST_IN_PCM, _melting_count(layer.material, material, thickness, worst))
    if layer.nodes is not None:
        stated = int(layer.nodes)
        short = f"{path}.nodes: {stated} given, {count} would resolve a step of {step_seconds:g} s"
        return stated, short if stated < count else ""
    if count > MOST_IN_LAYER:
        short = f"{path}: {count} nodes would resolve a step of {step_seconds:g} s, {MOST_IN_LAYER} taken"
        return MOST_IN_LAYER, f"{short}; split the layer or set its nodes"
    return count, ""


def diffusion_count(thickness: float, conductivity: float, capacity: float, step_seconds: float) -> int:
    """Volumes of a layer, none thicker than the damping depth of the fastest oscillation of a step.

    Steps of ``dt`` resolve no period below ``P = 2 dt``; the amplitude of an oscillation of that period
    decays to 1/e over ``sqrt(alpha P/pi)``.

    Parameters
    ----------
    thickness : float
        Thickness of the layer. [m]
    conductivity : float
        Thermal conductivity. [W/(m K)]
    capacity : float
        Volumetric heat capacity without latent heat. [J/(m3 K)]
    step_seconds : float
        Time step. [s]

    Returns
    -------
    int
        At least 1.
    """
    depth = math.sqrt(2.0 * step_seconds * conductivity / (math.pi * capacity))
    if depth <= thickness * 1e-9:  # also 0, of a conductivity so small that the product vanishes
        return MOST_IN_LAYER + 1
    return max(1, math.ceil(thickness / depth * (1.0 - 1e-12)))


def _melting_count(name: str, material: PhaseChangeMaterial, thickness: float, worst: _Worst) -> int:
    """Volumes for which the temperature difference between neighbors is within the half-width of melting."""
    difference = MELTING_FLUX * thickness / worst.property(name, "conductivity")[0]
    return min(MOST_FOR_MELTING, math.ceil(difference / _least_width(name, material, worst)))


def _least_width(name: str, material: PhaseChangeMaterial, worst: _Worst) -> float:
    """Half-width of the narrowest curve at the narrow end of the ranges [K]."""
    widths = [_width(material.law, f"materials.{name}.law", worst)]
    if material.two_curves is not None and material.two_curves.law is not None:
        widths.append(_width(material.two_curves.law, f"materials.{name}.hysteresis.law", worst))
    return min(widths)


def _width(law: Law, path: str, worst: _Worst) -> float:
    if isinstance(law, TanhLaw) and law.gamma is not None and law.delta_t is not None:
        return 4.0 * worst.ends(f"{path}.delta_t", law.delta_t)[0] / worst.ends(f"{path}.gamma", law.gamma)[1]
    if isinstance(law, TriangleLaw):
        below, above = worst.ends(f"{path}.below", law.below), worst.ends(f"{path}.above", law.above)
        return 0.5 * (below[0] + above[0])
    if isinstance(law, ClosedLaw) and not isinstance(law, FormulaCurve):
        return worst.ends(f"{path}.width", law.half_width)[0]
    return law.half_width
