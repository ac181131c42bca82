from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mascarin.genopt.files.numbers import double_text, normalised, parse_double, single, single_text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.9, "0.9"),
        (1.0, "1.0"),
        (0.001, "0.001"),
        (0.00099, "9.9E-4"),
        (9999999.0, "9999999.0"),
        (1e7, "1.0E7"),
        (-123456789.0, "-1.23456789E8"),
        (6.403033134149279e-05, "6.403033134149279E-5"),
        (-0.0, "-0.0"),
        (100.0, "100.0"),
        (math.inf, "Infinity"),
        (math.nan, "NaN"),
    ],
)
def test_text_of_doubles(value: float, text: str) -> None:
    assert double_text(value) == text


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_text_of_a_double_is_read_exactly(value: float) -> None:
    assert parse_double(double_text(value)) == value


@given(st.floats(allow_nan=False, allow_infinity=False, width=32))
def test_text_of_a_single_is_read_exactly(value: float) -> None:
    text = single_text(value)
    assert single_text(float(text)) == text
    assert float(text) == pytest.approx(value, rel=1e-7)


def test_rounding_removes_the_noise_of_mesh_arithmetic() -> None:
    assert 0.1 + 0.2 != 0.3
    assert single(0.1 + 0.2) == 0.3
    assert single(-1.0 / 3.0) == -0.33333334
    assert single_text(0.31622776601683794) == "0.31622776"


@pytest.mark.parametrize("text", ["1.2E+03", " 5 ", "-.5", "1.", "1d", "2f"])
def test_java_reads(text: str) -> None:
    assert parse_double(text) == float(text.strip().rstrip("df"))


@pytest.mark.parametrize("text", ["1.2D+03", "1_000", "nan", "inf", "", "1,2", "0x10"])
def test_java_does_not_read(text: str) -> None:
    assert parse_double(text) is None


@pytest.mark.parametrize(
    ("written", "kept"),
    [("0.10", "0.1"), ("10.0", "10"), ("1e-3", "0.001"), ("a.txt", "a.txt"), ("1f", "1f")],
)
def test_unquoted_numbers_are_written_again(written: str, kept: str) -> None:
    assert normalised(written) == kept
