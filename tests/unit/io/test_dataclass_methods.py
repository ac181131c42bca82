"""Frozen dataclasses behave as those of the standard library."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
from dataclasses import FrozenInstanceError, field
from typing import Any, ClassVar

import pytest

from mascarin.dataclass_methods import dataclass

Pair = tuple[Any, Any]


def both(*, slots: bool = False, **options: bool) -> Pair:
    """The same class made by Mascarin and by the standard library."""
    made = []
    for decorator in (dataclass, dataclasses.dataclass):

        class Layer:
            """A layer."""

            thickness: float
            name: str = "layer"
            nodes: list[int] = field(default_factory=list, compare=False)
            note: str = field(default="", repr=False, hash=False)
            count: int = field(init=False, default=0, compare=False)
            most: ClassVar[int] = 3

        made.append(decorator(frozen=True, slots=slots, **options)(Layer))
    return made[0], made[1]


@pytest.mark.parametrize("slots", [False, True])
@pytest.mark.parametrize("options", [{}, {"eq": False}, {"repr": False}, {"kw_only": True}])
def test_objects_are_as_of_the_standard_library(slots: bool, options: dict[str, bool]) -> None:
    ours, usual = both(slots=slots, **options)
    assert str(inspect.signature(ours)) == str(inspect.signature(usual))
    assert [f.name for f in dataclasses.fields(ours)] == [f.name for f in dataclasses.fields(usual)]
    first, second = (kind(thickness=0.2, name="plaster") for kind in (ours, usual))
    assert dataclasses.asdict(first) == dataclasses.asdict(second)
    assert dataclasses.asdict(dataclasses.replace(first, thickness=0.3))["thickness"] == 0.3
    if options.get("repr", True):
        assert repr(first) == repr(second)
    if options.get("eq", True):
        assert first == ours(thickness=0.2, name="plaster", nodes=[1])
        assert first != ours(thickness=0.2, name="plaster", note="other")
        assert first != second
        assert hash(first) == hash(second) == hash(ours(thickness=0.2, name="plaster", note="other"))
    else:
        assert first != ours(thickness=0.2, name="plaster")
    assert first.nodes is not ours(thickness=0.2).nodes


@pytest.mark.parametrize("slots", [False, True])
def test_objects_cannot_be_changed(slots: bool) -> None:
    for kind in both(slots=slots):
        item = kind(0.2)
        with pytest.raises(FrozenInstanceError, match="cannot assign to field 'name'"):
            item.name = "other"
        with pytest.raises(FrozenInstanceError, match="cannot delete field 'name'"):
            del item.name
        assert copy.deepcopy(item) == item


@pytest.mark.parametrize("words", [{}, {"thicknes": 1.0}, {"thickness": 1.0, "count": 2}])
def test_wrong_arguments_are_refused_alike(words: dict[str, Any]) -> None:
    texts = []
    for kind in both():
        with pytest.raises(TypeError) as caught:
            kind(**words)
        texts.append(str(caught.value))
    assert texts[0] == texts[1]


@dataclass(frozen=True)
class Wall:
    """A wall."""

    area: float
    doubled: float = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "doubled", 2.0 * self.area)


@dataclass(frozen=True, slots=True)
class Node:
    """A node."""

    index: int
    above: Node | None = None


@dataclass(frozen=True)
class Roof(Wall):
    """A roof."""

    tilt: float = 0.0

    def __repr__(self) -> str:
        return "roof"


def test_classes_inherit_and_are_pickled() -> None:
    roof, node = Roof(2.0, tilt=30.0), Node(1, Node(0))
    assert (roof.doubled, repr(roof)) == (4.0, "roof")
    assert pickle.loads(pickle.dumps(roof)) == roof  # noqa: S301  # our own
    assert pickle.loads(pickle.dumps(node)) == node  # noqa: S301  # our own
    assert Wall(2.0) != roof
    assert not hasattr(node, "__dict__")


def test_the_first_use_may_be_that_of_a_class_below() -> None:
    @dataclass(frozen=True)
    class Base:
        """A base."""

        one: int

    class Below(Base):
        def __init__(self, one: int) -> None:
            super().__init__(one + 1)

    assert Below(1).one == 2
    assert Base(1).one == 1
