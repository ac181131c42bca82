"""Numbers have range and source; quantities have unit, limits and default range."""

from __future__ import annotations

import copy
import math
from pathlib import Path

import pytest
from pydantic_core import PydanticCustomError

from crossing_features import building as feature
from mascarin.building import quantities
from mascarin.building.base.number import Fixed, Limits, Number, OnlyGiven, Percent, Quantity, Span, Within
from mascarin.building.building import Building
from mascarin.errors import InputError
from mascarin.examples import box

LENGTH = Quantity("m", "A length", Percent(10, "a ruler"), Limits(above=0, at_most=5))


def test_a_number_next_to_its_limit_counts_as_on_it() -> None:
    limits = Limits(above=0, at_most=20)
    assert limits.hold(1e-9)
    assert not limits.hold(5e-324)
    assert not limits.hold(0.0)
    assert not limits.hold(20.1)


def test_a_number_is_a_float() -> None:
    number = LENGTH.read({"value": 2, "range": [1, 4], "source": "a book", "assumed": True})
    assert number * 2 == 4.0
    assert (number.range, number.source, number.assumed, number.quantity) == (
        (1.0, 4.0),
        "a book",
        True,
        LENGTH,
    )
    twin = copy.deepcopy(number)
    assert (twin, twin.range, twin.source) == (2.0, (1.0, 4.0), "a book")


def test_without_a_range_the_default_is_used() -> None:
    assert LENGTH.read(2.0).plausible == pytest.approx((1.8, 2.2))
    assert LENGTH.read({"value": 2.0, "range": [1.0, 2.0]}).plausible == (1.0, 2.0)
    assert Number(3.0).plausible == (3.0, 3.0)


@pytest.mark.parametrize(
    ("spread", "value", "expected"),
    [
        (Percent(20, ""), -2.0, (-2.4, -1.6)),
        (Within(0.5, ""), 1.0, (0.5, 1.5)),
        (Span(0.0, 1.0, ""), 0.2, (0.0, 1.0)),
        (Span(0.0, 1.0, ""), 1.5, (0.0, 1.5)),
        (Fixed(""), 1.0, (1.0, 1.0)),
    ],
)
def test_default_ranges(
    spread: Percent | Within | Span | Fixed, value: float, expected: tuple[float, float]
) -> None:
    assert Quantity("-", "", spread).default_range(value) == pytest.approx(expected)


def test_a_default_range_keeps_inside_the_limits() -> None:
    share = Quantity("-", "", Within(0.1, ""), Limits(above=0, at_most=1))
    assert share.default_range(0.95) == pytest.approx((0.85, 1.0))
    low, high = share.default_range(0.05)
    assert 0.0 < low < 0.05 < high == pytest.approx(0.15)


@pytest.mark.parametrize(
    "raw", [0, -1, 6, math.nan, math.inf, "1", "1 m", True, None, [1], {}, {"value": None}]
)
def test_invalid_numbers_are_errors(raw: object) -> None:
    with pytest.raises(PydanticCustomError, match=r"found .*; expected"):
        LENGTH.read(raw)


def test_a_word_may_replace_a_number() -> None:
    worded = Quantity("-", "", Span(1, 2, ""), words={"rough": 1.67})
    assert worded.read("rough") == 1.67
    assert worded.read({"value": "rough", "range": [1, 2]}).source == "'rough'"
    with pytest.raises(PydanticCustomError, match="Did you mean 'rough'"):
        worded.read("rouhg")


def test_a_whole_number() -> None:
    count = Quantity("-", "", Fixed(""), integer=True)
    assert count.read(3) == 3.0
    with pytest.raises(PydanticCustomError, match="a whole number"):
        count.read(3.5)


def test_every_quantity_has_unit_meaning_and_range() -> None:
    """Unit, meaning and a reason for the range; the default range of a plain value has a width."""
    found = 0
    for name in dir(quantities):
        for note in getattr(getattr(quantities, name), "__metadata__", ()):
            found += 1
            assert note.unit, name
            assert note.description[:1].isupper(), name
            assert note.spread.reason, name
            value = max(note.limits.lower, 0.0) + min(0.5, 0.5 * note.limits.upper)
            low, high = note.default_range(value)
            assert note.limits.hold(low), name
            assert note.limits.hold(high), name
            assert low < high or isinstance(note.spread, Fixed | OnlyGiven), name
    assert found > 50


@pytest.mark.parametrize("value", ["3 m", [1], float("nan"), {"value": "x"}])
def test_a_message_about_a_number_of_a_formula_has_its_unit(value: object) -> None:
    described = feature("derived outputs")
    with pytest.raises(InputError, match=r"expected: a number \[m2\] \(Number 'A' of the formula\)"):
        described.replace({"derived_outputs.gain.A": value})


def test_a_number_of_a_formula_without_a_unit_may_be_given_one() -> None:
    described = feature("derived outputs")
    changed = described.replace({"derived_outputs.gain.A": {"value": 13, "range": [12, 14]}})
    parameter = changed.parameter("derived_outputs.gain.A")
    assert (parameter.value, parameter.unit, parameter.low, parameter.high) == (13.0, "m2", 12.0, 14.0)
    with pytest.raises(InputError) as refused:
        described.replace({"derived_outputs.half": {"formula": "gain/n", "n": "2 m"}})
    assert "expected: a number (Number 'n' of the formula)" in str(refused.value)
    assert 'Write {value: 2, unit: "m"}.' in str(refused.value)
    assert "[-]" not in str(refused.value)
    remedied = described.replace(
        {"derived_outputs.half": {"formula": "gain/n", "n": {"value": 2, "unit": "m"}}}
    )
    assert remedied.parameter("derived_outputs.half.n").unit == "m"
    with pytest.raises(InputError, match="value, range, source, assumed, unit, limits"):
        described.replace({"derived_outputs.half": {"formula": "gain/n", "n": {"value": 2, "units": "m"}}})


def test_a_building_whose_value_has_left_its_range_can_be_read_again(tmp_path: Path) -> None:
    """As a calibrated building, whose tied factor moves values beyond the ranges of the description."""
    described = box().replace(
        {"zones.room.infiltration.constant": Number(0.5, range=(0.3, 0.7), source="a test")}
    )
    for value, expected in ((0.1, (0.1, 0.7)), (0.9, (0.3, 0.9)), (0.4, (0.3, 0.7))):
        moved = described.with_values({"zones.room.infiltration.constant": value})
        moved.to_yaml(tmp_path / f"{value}.yaml")
        again = Building.from_yaml(tmp_path / f"{value}.yaml").parameter("zones.room.infiltration.constant")
        assert (again.value, (again.low, again.high)) == (value, expected)
