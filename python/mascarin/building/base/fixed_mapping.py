"""The mappings of a part, such as the materials of a building: read like a dict, never changed."""

from __future__ import annotations

from typing import Any, NoReturn, TypeVar

from mascarin.errors import InputError

Key = TypeVar("Key")
Value = TypeVar("Value")


class FixedMapping(dict[Key, Value]):
    """A dict that cannot be changed, because what was checked and derived would no longer fit to it.

    `|`, `copy` and `dict` give a plain dict, which can be changed.

    Examples
    --------
    >>> areas = FixedMapping({"south": 12.0})
    >>> areas["south"], areas | {"north": 9.0}
    (12.0, {'south': 12.0, 'north': 9.0})
    >>> areas["north"] = 9.0
    Traceback (most recent call last):
        ...
    mascarin.errors.InputError: found a change of a mapping of the building, expected none: a building is \
immutable. Building.replace and with_values return a building with other values
    """

    __slots__ = ()

    def _refuse(self, *_: object, **__: object) -> NoReturn:
        raise InputError(
            "found a change of a mapping of the building, expected none: a building is immutable. "
            "Building.replace and with_values return a building with other values"
        )

    __setitem__ = __delitem__ = __ior__ = _refuse
    clear = pop = popitem = setdefault = update = _refuse

    def __reduce__(self) -> tuple[Any, ...]:
        """How it is pickled and copied: made at once, without assignments."""
        return type(self), (dict(self),)


def fixed(attributes: dict[str, Any]) -> dict[str, Any]:
    """The attributes of a part with a `FixedMapping` in place of each dict; they are changed in place.

    Examples
    --------
    >>> [type(value).__name__ for value in fixed({"areas": {}, "number": 1}).values()]
    ['FixedMapping', 'int']
    """
    for name, value in attributes.items():
        if type(value) is dict:
            attributes[name] = FixedMapping(value)
    return attributes
