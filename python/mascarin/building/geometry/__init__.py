"""Geometry of a zone: plane polygons, the volume that they enclose, view factors between them."""

from __future__ import annotations

from mascarin.building.geometry.enclosure import (
    OpenEdge,
    check_convex,
    net_areas,
    open_edges,
    parents,
    volume,
)
from mascarin.building.geometry.exchange import (
    CLOSURE_LIMIT,
    closed_exchange_areas,
    exchange_areas,
    log_integral,
    view_factors,
)
from mascarin.building.geometry.flat import TOLERANCE
from mascarin.building.geometry.index import BoxIndex
from mascarin.building.geometry.obstacles import InFront, in_front
from mascarin.building.geometry.polygon import Polygon
from mascarin.building.geometry.viewpoint import plane_factor, solid_angle

__all__ = [
    "CLOSURE_LIMIT",
    "TOLERANCE",
    "BoxIndex",
    "InFront",
    "OpenEdge",
    "Polygon",
    "check_convex",
    "closed_exchange_areas",
    "exchange_areas",
    "in_front",
    "log_integral",
    "net_areas",
    "open_edges",
    "parents",
    "plane_factor",
    "solid_angle",
    "view_factors",
    "volume",
]
