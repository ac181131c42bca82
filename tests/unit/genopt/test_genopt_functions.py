from __future__ import annotations

import math

import pytest

from mascarin.errors import InputError
from mascarin.genopt.files.functions import evaluate, resolve, substitute


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("add(1, multiply(2, -0.4), 3)", 3.2),
        (" 5 ", 5.0),
        ("divide(1, 4)", 0.25),
        ("pow(2, 0.5)", math.sqrt(2)),
        ("rint(2.5)", 2.0),
        ("floor(-0.5)", -1.0),
        ("log10(1.0E3)", 3.0),
        ("max(abs(-3),2)", 3.0),
        ("subtract(1, add(1, 1, 1, 1, 1, 1))", -5.0),
    ],
)
def test_values(text: str, value: float) -> None:
    assert evaluate(text) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "value"), [("divide(1, 0)", math.inf), ("log(0)", -math.inf), ("pow(0, -1)", math.inf)]
)
def test_undefined_limits_are_infinite(text: str, value: float) -> None:
    assert evaluate(text) == value


def test_undefined_values_are_not_a_number() -> None:
    assert math.isnan(evaluate("sqrt(-1)"))
    assert math.isnan(evaluate("divide(0, 0)"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("add(1, 2", "closing bracket is missing"),
        ("add(1, 2) 3", "after the closing bracket"),
        ("adds(1, 2)", "'adds' is not known. Did you mean 'add'"),
        ("add(1)", "takes 2 to 6 arguments, found 1"),
        ("1+2", "without operators"),
        ("", "is missing"),
        ("-add(1, 2)", "'-add'"),
    ],
)
def test_errors_of_projects(text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        evaluate(text)
    assert message in str(caught.value)


def test_functions_are_inserted_in_each_other() -> None:
    functions = {"a": "add(%b%, 1)", "b": "multiply(%x%, 2)"}
    assert resolve(functions, str)["a"] == "add(multiply(%x%, 2), 1)"
    assert evaluate(substitute(resolve(functions, str)["a"], {"x": "4"})) == 9.0


def test_functions_in_a_circle_are_an_error() -> None:
    with pytest.raises(InputError, match="in a circle"):
        resolve({"a": "abs(%b%)", "b": "abs(%a%)"}, str)
