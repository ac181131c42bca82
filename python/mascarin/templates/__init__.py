"""Descriptions of rooms, walls and cells from a few words: a start that is edited afterwards."""

from mascarin.templates.new_buildings import building_of, new_room
from mascarin.templates.room import Room

__all__ = ["Room", "building_of", "new_room"]
