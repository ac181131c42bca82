"""Windows in walls, and shades outdoors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.names import GlazingName, SurfaceName
from mascarin.building.base.number import Number, Remark
from mascarin.building.base.part import Part, Shorthand, fault, insist, refuse
from mascarin.building.parts.envelope.convection import CONVECTION, Convection
from mascarin.building.parts.envelope.surface import BEHIND_OBSTACLES, Exposure, OutdoorLongwave, Surface
from mascarin.building.parts.openings.blind import Blind
from mascarin.building.parts.openings.glazing import PaneGlazing, both

if TYPE_CHECKING:
    pass

Vertices = tuple[tuple[q.Coordinate, q.Coordinate, q.Coordinate], ...]


class Frame(Part):
    """Frame of a window.

    Examples
    --------
    >>> Frame(fraction=0.2, u_value=2)
    Frame(fraction=0.2, u_value=2 W/(m2 K), absorptance=0.5, emissivity=0.9)
    """

    fraction: q.FrameFraction
    u_value: q.FrameU
    absorptance: q.Absorptance = Number(0.5, source="neither white nor black", assumed=True)
    emissivity: q.Emissivity = Number(0.9, source="ISO 10077-2:2017: painted or anodized", assumed=True)


class WindowOutside(Part):
    """The outer side of a window.

    Examples
    --------
    >>> WindowOutside(convection="doe2", height=1.5)
    WindowOutside(convection=doe2, height=1.5 m)
    """

    convection: Convection = Field(description=CONVECTION)
    irradiance: str | None = Field(
        None,
        description="Measured column of the irradiance of this plane [W/m2], shared among beam, sky and "
        "ground as the climate has them, free of obstacles: what stands in front of the window takes its "
        "part of it; none: from the climate",
    )
    behind_obstacles: bool | None = Field(None, description=BEHIND_OBSTACLES)
    sky_view: q.SkyView | None = None
    ground_view: q.GroundView | None = None
    height: q.Height | None = None
    longwave: OutdoorLongwave | None = Field(
        None, description="Exchange with sky, air and ground; none: exact"
    )

    @model_validator(mode="after")
    def _sound(self) -> WindowOutside:
        if self.behind_obstacles is not None and self.irradiance is None:
            refuse(
                fault(
                    ("behind_obstacles",),
                    "'behind_obstacles' of a window without a measured irradiance",
                    "only what has an effect on this side",
                    "Remove 'behind_obstacles:', or add 'irradiance:'.",
                )
            )
        return self

    @property
    def outdoors(self) -> Literal[True]:
        """Always."""
        return True

    @property
    def sunlit(self) -> bool:
        """Whether its irradiance comes from the climate: beam and diffuse part do in any case."""
        return True

    @property
    def exposed(self) -> Exposure:
        """To all parts of the weather."""
        return Exposure()

    @property
    def ground(self) -> None:
        """Never."""
        return

    @property
    def imposed(self) -> None:
        """Never."""
        return


class WindowInside(Part):
    """The inner side of a window.

    Examples
    --------
    >>> WindowInside(convection="iso15099")
    WindowInside(convection=iso15099)
    """

    convection: Convection = Field(description=CONVECTION)

    @property
    def outdoors(self) -> None:
        """Never."""
        return

    @property
    def irradiance(self) -> None:
        """No measured column."""
        return

    @property
    def sunlit(self) -> bool:
        """Never."""
        return False

    @property
    def exposed(self) -> Exposure:
        """To no part of the weather."""
        return Exposure(sun=False, wind=False, sky=False)

    @property
    def ground(self) -> None:
        """Never."""
        return

    @property
    def imposed(self) -> None:
        """Never."""
        return


class Shade(Part):
    """A thin opaque polygon outdoors that shades beam and diffuse radiation of the sky.

    It acts on every outdoor surface with vertices. It reflects nothing and is not part of the heat balance.

    Examples
    --------
    >>> overhang = Shade(vertices=[[0, 0, 3], [4, 0, 3], [4, -1, 3], [0, -1, 3]])
    >>> len(overhang.vertices)
    4
    """

    vertices: Vertices = Field(description="Corners [x, y, z] in order, in the coordinates of the surfaces")


class Overhang(Part):
    """A thin horizontal plate over a window, which shades this window alone.

    Examples
    --------
    >>> Overhang(depth=0.6, gap=0.2)
    Overhang(depth=0.6 m, gap=0.2 m, extension=0 m)
    """

    depth: q.OverhangDepth
    gap: q.OverhangLength = Number(0.0, source=Remark("not given: at the upper edge of the window"))
    extension: q.OverhangLength = Number(0.0, source=Remark("not given: as wide as the window"))


class Window(Part):
    """A glazing in a wall between outdoors and a zone, or between two zones.

    Its area is subtracted from the area of the wall.

    Examples
    --------
    >>> window = Window(
    ...     surface="south",
    ...     glazing="double",
    ...     area=1.5,
    ...     outside=WindowOutside(convection="doe2"),
    ...     inside=WindowInside(convection="iso15099"),
    ... )
    >>> float(window.area)
    1.5
    """

    surface: SurfaceName = Field(description="Name of the surface it is in")
    glazing: GlazingName = Field(description="Name of a glazing")
    area: q.WindowArea | None = None
    vertices: Vertices | None = Field(
        None, description="Corners [x, y, z] in the plane of the wall, counter-clockwise seen from outside"
    )
    cavity_height: q.CavityHeight | None = None
    frame: Frame | None = Field(None, description="Frame; none: the whole area is glass")
    blind: Blind | None = Field(None, description="Blind or shutter before the glass; none: bare glass")
    reveal: q.RevealDepth | None = None
    overhang: Annotated[Overhang, Shorthand(number="depth")] | None = Field(
        None,
        description="Overhang: its depth [m], or a part with gap above the window and extension to "
        "both sides",
    )
    outside: WindowOutside = Field(description="The outer side")
    inside: WindowInside = Field(description="The inner side")

    @model_validator(mode="after")
    def _sized(self) -> Window:
        if self.area is None and self.vertices is None:
            insist(fault(("area",), "nothing", self._meaning("area"), "Add 'area:' (or 'vertices:')."))
        return self


def emissivities(glazing: Any) -> tuple[float, float]:
    """Emissivity of the outer side of the first pane and of the inner side of the last one [-]."""
    if isinstance(glazing, PaneGlazing):
        return both(glazing.panes[0].emissivity)[0], both(glazing.panes[-1].emissivity)[1]
    return glazing.emissivity, glazing.emissivity


def outer_side(window: Window, wall: Surface) -> WindowOutside | WindowInside:
    """The outer side of a window; in a wall between two zones, a side that faces a zone."""
    if wall.outside.zone is None:
        return window.outside
    return WindowInside.model_construct(convection=window.outside.convection)
