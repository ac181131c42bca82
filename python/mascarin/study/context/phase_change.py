"""Phase-change layers of a building: their outputs, and the enthalpy curve of their material."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.building.parts.materials.material import PhaseChangeMaterial
from mascarin.building.parts.materials.phase_change import TanhLaw
from mascarin.building.parts.materials.phases import PhaseDensities, Phases, PhaseSpecificHeats

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.building import Building
    from mascarin.simulation.results import Results

    Array = npt.NDArray[np.float64]

#: Points of an enthalpy curve.
_POINTS: Final = 161


@dataclass(frozen=True)
class MeltingLayer:
    """A phase-change layer of a surface.

    Attributes
    ----------
    surface, layer, material : str
        Their names.
    liquid_fraction, enthalpy : str
        Outputs: the mean liquid fraction, and the mean enthalpy. [-], [J/m3]
    surfaces : tuple of str
        Outputs: the temperatures of its two surfaces, outside and inside. [degC]
    """

    surface: str
    layer: str
    material: str
    liquid_fraction: str
    enthalpy: str
    surfaces: tuple[str, str]

    @property
    def outputs(self) -> tuple[str, ...]:
        """All recorded outputs."""
        return (self.liquid_fraction, self.enthalpy, *self.surfaces)

    def of(self, building: Building) -> PhaseChangeMaterial:
        """Its material."""
        material = building.materials[self.material]
        assert isinstance(material, PhaseChangeMaterial)  # noqa: S101 (melting_layers finds no other)
        return material


def melting_layers(building: Building) -> list[MeltingLayer]:
    """All phase-change layers, surface by surface.

    Parameters
    ----------
    building : Building
        The building.
    """
    found = []
    for surface, entry in building.surfaces.items():
        layers = building.constructions[entry.construction].layers
        for k, layer in enumerate(layers):
            if not isinstance(building.materials[layer.material], PhaseChangeMaterial):
                continue
            outer = f"{surface}.interface_{k}_temperature" if k else f"{surface}.outside_temperature"
            last = k + 1 == len(layers)
            inner = f"{surface}.inside_temperature" if last else f"{surface}.interface_{k + 1}_temperature"
            fraction, enthalpy = (
                f"{surface}.{layer.name}_{what}" for what in ("liquid_fraction", "enthalpy")
            )
            found.append(
                MeltingLayer(surface, str(layer.name), layer.material, fraction, enthalpy, (outer, inner))
            )
    return found


def _pair(value: Phases | float) -> tuple[float, float]:
    """A property of the solid and of the liquid."""
    if isinstance(value, PhaseDensities | PhaseSpecificHeats):
        return float(value.solid), float(value.liquid)
    assert isinstance(value, float)  # noqa: S101 (a number is the other form of both)
    return float(value), float(value)


def solid_density(material: PhaseChangeMaterial) -> float:
    """Density that enthalpies per volume are divided by. [kg/m3]"""
    return _pair(material.density)[0]


def latent_heat_of(building: Building, layer: MeltingLayer) -> float:
    """Latent heat of a whole layer; NaN where its material does not state it. [J]"""
    material, surface = layer.of(building), building.surfaces[layer.surface]
    layers = building.constructions[surface.construction].layers
    thickness = next(float(part.thickness or 0.0) for part in layers if str(part.name) == layer.layer)
    if material.latent_heat is None:
        return float("nan")
    # The latent heat of a volume is that of its liquid, as in `law_curve`.
    volume = thickness * float(surface.area or 0.0)
    return volume * _pair(material.density)[1] * float(material.latent_heat)


def day_of(index: pd.DatetimeIndex) -> npt.NDArray[np.int64] | None:
    """Number of the local day of each record, -1 on days that are not whole; None without a whole day."""
    number = np.asarray((index.tz_localize(None).normalize() - index[0].tz_localize(None).normalize()).days)
    count = np.bincount(number)
    whole_days = count >= count.max()
    if count.size < 2 or not whole_days.any():
        return None
    return np.where(whole_days[number], number, -1).astype(np.int64)


def daily_range(values: Array, days: npt.NDArray[np.int64]) -> Array:
    """Mean over all days of what values (..., rows) range over on a day.

    Examples
    --------
    >>> daily_range(np.array([[0.0, 1.0, 5.0, 2.0]]), np.array([0, 0, 1, 1])).tolist()
    [2.0]
    """
    ranges = [np.ptp(values[..., days == day], axis=-1) for day in np.unique(days[days >= 0])]
    return np.asarray(np.mean(ranges, axis=0))


def path(results: Results, building: Building, layer: MeltingLayer) -> tuple[Array, Array]:
    """Temperature and enthalpy of a layer at every recorded time.

    Parameters
    ----------
    results : Results
        A run that recorded the layer's outputs.
    building : Building
        The building, with the values of the run.
    layer : MeltingLayer
        Which layer.

    Returns
    -------
    temperature : ndarray, shape (rows,)
        Mean of its two surfaces. [degC]
    enthalpy : ndarray, shape (rows,)
        Mean over the layer, relative to the zero of its enthalpy curve. [kJ/kg]
    """
    names = [output.name for output in results.outputs]
    sides = [results.records[:, names.index(name)] for name in layer.surfaces]
    enthalpy = results.records[:, names.index(layer.enthalpy)] / (1000.0 * solid_density(layer.of(building)))
    return 0.5 * (sides[0] + sides[1]), enthalpy


def law_curve(material: PhaseChangeMaterial, low: float, high: float) -> tuple[Array, Array] | None:
    """Enthalpy over temperature of the tanh law, zero for the solid at the melting temperature.

    Parameters
    ----------
    material : PhaseChangeMaterial
        With the values of the run.
    low, high : float
        Ends of the curve. [degC]

    Returns
    -------
    tuple of ndarray or None
        Temperatures [degC] and enthalpies [kJ/kg], each of shape (161,); None for another law.
    """
    law = material.law
    if not isinstance(law, TanhLaw) or material.latent_heat is None or material.melting_temperature is None:
        return None
    heats, densities = _pair(material.specific_heat), _pair(material.density)
    solid, liquid = (rho * c for rho, c in zip(densities, heats, strict=True))
    temperature = np.linspace(low, high, _POINTS)
    above = temperature - float(material.melting_temperature)
    fraction = 0.5 * (1.0 + np.tanh(above / law.half_width))
    latent = densities[1] * float(material.latent_heat)
    enthalpy = solid * above + fraction * (latent + (liquid - solid) * above)
    return temperature, enthalpy / (1000.0 * solid_density(material))
