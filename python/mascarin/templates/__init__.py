"""Descriptions of rooms, walls and cells from a few words: a start that is edited afterwards."""

from mascarin.templates.room import Room, new_room

__all__ = ["Room", "new_room"]
