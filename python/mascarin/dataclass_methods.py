"""Frozen dataclasses whose methods cost nothing until they are used.

`dataclasses.dataclass` writes the text of up to six methods for each class and has Python compile it, which
takes half a millisecond: for the classes of one run, a quarter of the time of the import. Here `__init__` is
compiled when the first object is made, and the other methods are the same functions for all classes.
"""

from __future__ import annotations

import dataclasses
import sys
from dataclasses import MISSING, Field, FrozenInstanceError
from functools import cache
from operator import attrgetter
from reprlib import recursive_repr
from types import MethodType
from typing import TYPE_CHECKING, Any, Final, NoReturn

if TYPE_CHECKING:
    from collections.abc import Callable
    from dataclasses import dataclass as dataclass
else:

    def dataclass(cls=None, *, frozen=False, eq=True, repr=True, kw_only=False, slots=False):
        """As `dataclasses.dataclass`, whose words it takes; type checkers read that one.

        Fields, comparison, hash and text are those of the standard library, and so are `fields`, `replace`
        and `asdict`. Classes that are not frozen are made by it altogether.

        Parameters
        ----------
        cls : type, optional
            The class, where the decorator stands without parentheses.
        frozen : bool
            Whether objects cannot be changed.
        eq : bool
            Whether objects with equal fields are equal.
        repr : bool
            Whether the text of an object shows its fields.
        kw_only : bool
            Whether fields are given by name only.
        slots : bool
            Whether objects have no ``__dict__``.

        Examples
        --------
        >>> @dataclass(frozen=True)
        ... class Layer:
        ...     "A layer."
        ...
        ...     thickness: float
        ...     name: str = "layer"
        >>> Layer(0.2)
        Layer(thickness=0.2, name='layer')
        >>> Layer(0.2) == Layer(0.2, "plaster")
        False
        """
        if not frozen:
            return dataclasses.dataclass(cls, eq=eq, repr=repr, kw_only=kw_only, slots=slots)

        def decorate(cls):
            given = {name for name, value in vars(cls).items() if value is not None}
            cls = dataclasses.dataclass(cls, init=False, repr=False, eq=False, kw_only=kw_only, slots=slots)
            methods = {"__init__": _Init(cls)}
            methods |= {"__repr__": _text} if repr else {}
            methods |= {"__eq__": _equal, "__hash__": _hash} if eq else {}
            methods |= {"__getstate__": _values, "__setstate__": _set_values} if slots else {}
            for name in methods.keys() - given:
                setattr(cls, name, methods[name])
            cls.__setattr__, cls.__delattr__ = _refuse_change, _refuse_removal
            return cls

        return decorate


class _Init:
    """The `__init__` of a class, which takes the place of this object when it is first used.

    Parameters
    ----------
    cls : type
        The dataclass.
    """

    def __init__(self, cls: type) -> None:
        self._cls = cls

    def __get__(self, instance: object, owner: type | None = None) -> Any:
        """The method, bound where there is an object."""
        method = _init_of(self._cls)
        type.__setattr__(self._cls, "__init__", method)
        return method if instance is None else MethodType(method, instance)


def _init_of(cls: type) -> Any:
    """Compile `__init__` of a dataclass, with the names of its fields as those of its parameters."""
    fields = dataclasses.fields(cls)
    names: dict[str, Any] = {"_set": object.__setattr__, "_factory": _FACTORY}
    parameters, by_name, body = ["self"], list[str](), list[str]()
    for field in fields:
        names[f"_default_{field.name}"] = field.default
        names[f"_make_{field.name}"] = field.default_factory
        value = _value_of(field, slots="__slots__" in vars(cls))
        if value is not None:
            body.append(f"_set(self, {field.name!r}, {value})")
        if field.init:
            (by_name if field.kw_only else parameters).append(field.name + _default_of(field))
    if hasattr(cls, "__post_init__"):
        body.append("self.__post_init__()")
    head = ", ".join([*parameters, *(["*", *by_name] if by_name else [])])
    inner = "\n  ".join(body or ["pass"])
    text = f"def make({', '.join(names)}):\n def __init__({head}):\n  {inner}\n return __init__"
    made: dict[str, Any] = {}
    exec(text, vars(sys.modules[cls.__module__]), made)  # noqa: S102  # as the standard library does
    method = made["make"](**names)
    method.__qualname__ = f"{cls.__qualname__}.__init__"
    method.__annotations__ = {field.name: field.type for field in fields if field.init} | {"return": None}
    return method


class _Factory:
    """In place of an argument: the field is made."""

    def __repr__(self) -> str:
        return "<factory>"


_FACTORY: Final = _Factory()


def _default_of(field: Field[Any]) -> str:
    """The default of a parameter as text."""
    if field.default is not MISSING:
        return f"=_default_{field.name}"
    return "" if field.default_factory is MISSING else "=_factory"


def _value_of(field: Field[Any], *, slots: bool) -> str | None:
    """What a field is set to, as text; None: it keeps the value that the class has, or has none."""
    made = f"_make_{field.name}()"
    if field.default_factory is MISSING:
        by_class = f"_default_{field.name}" if slots and field.default is not MISSING else None
        return field.name if field.init else by_class
    return f"{made} if {field.name} is _factory else {field.name}" if field.init else made


def _refuse_change(self: object, name: str, value: object) -> NoReturn:
    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def _refuse_removal(self: object, name: str) -> NoReturn:
    raise FrozenInstanceError(f"cannot delete field {name!r}")


@recursive_repr()
def _text(self: Any) -> str:
    shown = (f"{f.name}={getattr(self, f.name)!r}" for f in dataclasses.fields(self) if f.repr)
    return f"{type(self).__qualname__}({', '.join(shown)})"


@cache
def _reader(cls: type, *, hashed: bool) -> Callable[[Any], tuple[Any, ...]]:
    """Function that reads the fields of an object that are compared, or that its hash is made of."""
    fields = dataclasses.fields(cls)
    names = [f.name for f in fields if (f.hash if hashed and f.hash is not None else f.compare)]
    return attrgetter(*names) if len(names) > 1 else lambda item: tuple(getattr(item, name) for name in names)


def _equal(self: Any, other: object) -> Any:
    if other.__class__ is not self.__class__:
        return NotImplemented
    kind: Any = type(self)
    read = _reader(kind, hashed=False)
    return read(self) == read(other)


def _hash(self: Any) -> int:
    kind: Any = type(self)
    return hash(_reader(kind, hashed=True)(self))


def _values(self: Any) -> list[Any]:
    return [getattr(self, f.name) for f in dataclasses.fields(self)]


def _set_values(self: Any, values: list[Any]) -> None:
    for field, value in zip(dataclasses.fields(self), values, strict=True):
        object.__setattr__(self, field.name, value)
