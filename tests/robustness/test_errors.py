from __future__ import annotations

import pytest

from mascarin.errors import CriterionFailed, InputError, MascarinError, SolverError, did_you_mean


@pytest.mark.parametrize(("error", "code"), [(CriterionFailed, 1), (InputError, 2), (SolverError, 3)])
def test_each_error_has_its_exit_code(error: type[MascarinError], code: int) -> None:
    assert issubclass(error, MascarinError)
    assert error("text").exit_code == code
    assert str(error("text")) == "text"


def test_close_names_are_suggested() -> None:
    known = ["conductivity", "density", "specific_heat"]
    assert did_you_mean("conductivty", known) == "Did you mean 'conductivity'?"


def test_two_close_names_are_joined() -> None:
    assert did_you_mean("temprature_1", ["temperature_2", "temperature_1", "wind"]) == (
        "Did you mean 'temperature_1' or 'temperature_2'?"
    )


def test_a_short_list_is_shown_whole_and_sorted() -> None:
    assert did_you_mean("xyz", ["tanh", "table"]) == "Known: table, tanh."
    assert did_you_mean("xyz", ["tanh", "table"], known=False) == ""  # the message has them
    assert did_you_mean("tabel", ["tanh", "table"], known=False) == "Did you mean 'table'?"


def test_a_long_list_is_not_shown() -> None:
    assert did_you_mean("xyz", [f"name_{k:03d}" for k in range(40)]) == ""
    assert did_you_mean("xyz", []) == ""
