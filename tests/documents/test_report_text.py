from __future__ import annotations

from datetime import datetime

import pytest

from mascarin._io import units
from mascarin.figures import text


@pytest.mark.parametrize(
    ("value", "digits", "expected"),
    [
        (0.0, 3, "0"),
        (0.7304, 3, "0.73"),
        (71000.0, 3, "71\u202f000"),
        (22.6489, 4, "22.65"),
        (99.96, 3, "100"),
        (-0.04567, 2, "−0.046"),
        (3.14e-13, 2, "3.1×10⁻¹³"),
        (None, 3, "–"),
        (float("nan"), 3, "–"),
    ],
)
def test_significant(value: float | None, digits: int, expected: str) -> None:
    assert text.significant(value, digits) == expected


@pytest.mark.parametrize(
    ("value", "sign", "expected"), [(-0.004, True, "0.00"), (0.126, True, "+0.13"), (-2.5, False, "−2.50")]
)
def test_fixed(value: float, sign: bool, expected: str) -> None:
    assert text.fixed(value, sign=sign) == expected


def test_spans() -> None:
    assert text.span_of(datetime(2010, 9, 20), datetime(2010, 9, 25)) == "20–24 Sep 2010"
    assert text.span_of(datetime(2010, 9, 20), datetime(2010, 9, 21)) == "20 Sep 2010"
    assert text.span_of(datetime(2010, 9, 25), datetime(2010, 10, 2)) == "25 Sep 2010 to 1 Oct 2010"
    assert (
        text.span_of(datetime(2010, 9, 4, 10), datetime(2010, 9, 5, 10))
        == "4 Sep 2010 10:00 to 5 Sep 2010 10:00"
    )


def test_units() -> None:
    assert text.with_unit(25.0, "degC") == "25\u00a0°C"
    assert text.with_unit(20.0, "deg") == "20°"
    assert units.difference("degC") == "K"
    assert units.difference("W/m2") == "W/m²"
    # One notation everywhere: the page has that of the documentation, with signs for powers.
    assert units.shown("W/(m2 K)") == "W/(m² K)"
    assert units.shown("m2 K/W") == "m² K/W"
    assert units.shown("kJ/(kg K)") == "kJ/(kg K)"
    assert units.shown("-") == ""
    assert units.bracketed("error", units.difference("degC")) == "error [K]"


def test_paths_become_words() -> None:
    assert (
        text.plain_path("constructions.ceiling.layers.energain.thickness") == "ceiling · energain · thickness"
    )
    assert text.plain_path("surfaces.roof.inside.convection.factor") == "roof · inside · convection factor"
    assert text.plain_path("surfaces.wall_north.outside.absorptance") == "wall north · outside · absorptance"


def test_plain_signs_are_typeset() -> None:
    assert text.typeset("|max error| <= 2 degC") == "|max error| ≤ 2\u00a0°C"
    assert text.typeset("a wall of 7 m2, 25 W/(m2 K), 30 kg/m3 and m2x") == (
        "a wall of 7\u00a0m², 25 W/(m² K), 30 kg/m³ and m2x"
    )
    assert text.typeset("-1.51 deg") == "−1.51°"
    assert text.typeset("2010-09-20 from -0.2 to 3") == "2010-09-20 from −0.2 to 3"


def test_digits_are_those_that_the_uncertainty_supports() -> None:
    assert text.with_interval(24.0, 23.96, 24.043) == ("24.000", "23.960 to 24.043")
    assert text.with_interval(24.0, 22.9, 25.1) == ("24.0", "22.9 to 25.1")
    assert text.with_uncertainty(0.0107034, 0.111393) == "0.01"
    assert text.with_uncertainty(None, 0.1) == "–"
    # A value that misses its limit never looks equal to it.
    assert text.beside_limit(0.25004, 0.25) == ("0.25004", "0.25")


def test_numbers_of_one_column_have_the_same_decimals() -> None:
    assert text.alike([99.1667, 100.0, None, 85.9]) == ["99", "100", "–", "86"]
    assert text.alike([0.274, 0.9525, 0.3]) == ["0.274", "0.953", "0.300"]
    assert text.alike([25, "5.7 V + 11.4"]) == ["25", "5.7 V + 11.4"]
    assert text.alike([3.5, 1.75]) == ["3.50", "1.75"]
    assert text.alike([2.5e-8, 0.0]) == ["2.50×10⁻⁸", "0"]
