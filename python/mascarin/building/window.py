"""Windows in walls, and the shades in front of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.convection import Convection
from mascarin.building.glazing import PaneGlazing, both
from mascarin.building.names import GlazingName, SurfaceName
from mascarin.building.number import Number
from mascarin.building.part import Part, fault, insist
from mascarin.building.surface import Exposure, OutdoorLongwave

if TYPE_CHECKING:
    from collections.abc import Mapping

Vertices = tuple[tuple[q.Coordinate, q.Coordinate, q.Coordinate], ...]


class Frame(Part):
    """The part of a window that is no glass."""

    fraction: q.FrameFraction
    u_value: q.FrameU
    absorptance: q.Absorptance = Number(0.5, source="neither white nor black", assumed=True)
    emissivity: q.Emissivity = Number(0.9, source="ISO 10077-2:2017: painted or anodised", assumed=True)


class WindowOutside(Part):
    """The face of a window that sees the weather."""

    convection: Convection = Field(description="Film coefficient: a number, or a correlation")
    sky_view: q.SkyView | None = None
    height: q.Height | None = None
    longwave: OutdoorLongwave | None = Field(
        None, description="Exchange with sky, air and ground; none: exact"
    )

    @property
    def outdoors(self) -> Literal[True]:
        """Always."""
        return True

    @property
    def irradiance(self) -> None:
        """The sun is always the climate's."""
        return

    @property
    def sunlit(self) -> bool:
        """Always."""
        return True

    @property
    def exposed(self) -> Exposure:
        """To sun, wind and sky."""
        return Exposure()

    @property
    def ground(self) -> None:
        """Never."""
        return


class WindowInside(Part):
    """The face of a window that sees its zone."""

    convection: Convection = Field(description="Film coefficient: a number, or a correlation")

    @property
    def outdoors(self) -> None:
        """Never."""
        return

    @property
    def irradiance(self) -> None:
        """No sun is measured here."""
        return

    @property
    def sunlit(self) -> bool:
        """Never from outdoors."""
        return False

    @property
    def exposed(self) -> Exposure:
        """To nothing outdoors."""
        return Exposure(sun=False, wind=False, sky=False)

    @property
    def ground(self) -> None:
        """Never."""
        return


class Shade(Part):
    """An opaque thin polygon outdoors that keeps beam and diffuse sky off the faces behind it.

    It acts on every face outdoors that has vertices. It reflects nothing, and has no part in the heat.
    """

    vertices: Vertices = Field(description="Corners [x, y, z] in order, in the coordinates of the surfaces")


class Window(Part):
    """A glazing in a wall between outdoors and a zone; its area is taken off the wall's."""

    surface: SurfaceName = Field(description="Name of the wall it is in")
    glazing: GlazingName = Field(description="Name of a glazing")
    area: q.WindowArea | None = None
    vertices: Vertices | None = Field(
        None, description="Corners [x, y, z] in the plane of the wall, counter-clockwise seen from outside"
    )
    cavity_height: q.CavityHeight | None = None
    frame: Frame | None = Field(None, description="Frame; none: all of it is glass")
    outside: WindowOutside = Field(description="The outer face")
    inside: WindowInside = Field(description="The inner face")

    @model_validator(mode="after")
    def _sized(self) -> Window:
        if self.area is None and self.vertices is None:
            insist(fault(("area",), "nothing", self._meaning("area"), "Add 'area:' (or 'vertices:')."))
        return self


def emissivities(glazing: Any) -> tuple[float, float]:
    """Emissivity of the outermost and of the innermost face [-]."""
    if isinstance(glazing, PaneGlazing):
        return both(glazing.panes[0].emissivity)[0], both(glazing.panes[-1].emissivity)[1]
    return glazing.emissivity, glazing.emissivity


def windows_of(surface: str, windows: Mapping[str, Window]) -> Iterator[tuple[str, Window]]:
    """Windows in a wall."""
    return ((name, window) for name, window in windows.items() if window.surface == surface)


def opaque_area(surface: str, gross: float, windows: Mapping[str, Window]) -> float:
    """What the windows leave of a wall [m2]."""
    return gross - sum(float(window.area or 0.0) for _, window in windows_of(surface, windows))
