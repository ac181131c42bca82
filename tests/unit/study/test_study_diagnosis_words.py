"""What a study says of causes agrees with their numbers."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.diagnosis.causes import CauseEstimate
from mascarin.diagnosis.hypotheses import Candidate, Diagnosis
from mascarin.study.diagnosis import words as diagnosis_words

TIMES = pd.date_range("2023-03-02 06:00", periods=96, freq="1h", tz="UTC")
SETUP: Any = SimpleNamespace(
    observation=SimpleNamespace(times=TIMES),
    measurements=SimpleNamespace(data=pd.DataFrame(index=TIMES)),
    plan=SimpleNamespace(sensors={n: SimpleNamespace(columns=(f"T_{n}",)) for n in ("room", "wall")}),
)
NOTHING = np.zeros((1, 1))
STEP = Candidate("data", "step", ("room",), NOTHING, unit="K", start=30.0)
LAW = Candidate("form", "form", ("site.sky",), NOTHING, mean=1.0, detail="brunt")


def test_a_cause_that_is_told_has_its_size_time_p_and_certainty() -> None:
    cause = diagnosis_words.of_finding(SETUP, CauseEstimate(STEP, -0.52, 0.11, 0.001, 0.934, 12.0, told=True))
    assert "room: it reads 0.52 ± 0.11 K too low from about 2023-03-03 06:00 on" in cause.text
    assert "in 0.1 % of cases (p 0.001)" in cause.text
    assert "has a probability of 93.4 %" in cause.text
    assert (cause.value, cause.error, cause.certainty, cause.told) == (-0.52, 0.11, 0.934, True)


def test_what_is_not_told_is_said_to_be_not_told_with_what_else_it_may_be() -> None:
    found = CauseEstimate(LAW, 1.0, 0.1, 0.004, 0.55, 9.0, told=False, others=(STEP,))
    cause = diagnosis_words.of_finding(SETUP, found)
    assert cause.text.startswith("Cannot tell: ")
    assert "with 55 %, is: site.sky: the law 'brunt'" in cause.text
    assert cause.same == ("room: sensor, step of the offset from about 2023-03-03 06:00 on",)
    assert cause.same[0] in cause.text


@pytest.mark.parametrize(
    ("what", "subject", "value", "said"),
    [
        ("offset", ("room",), 0.6, "room: it reads 0.60 ± 0.10 K too high at all times"),
        ("clock", ("room",), -60.0, "room: its series is 60.00 ± 0.10 min early"),
        ("gain", ("wall",), 6.0, "wall: it reads 6.00 ± 0.10 % too high"),
        ("drift", ("wall",), -1.0, "wall: it drifts by 1.00 ± 0.10 K down over the record"),
        ("swapped", ("room", "wall"), 1.0, "the columns T_room and T_wall are exchanged"),
    ],
)
def test_every_fault_has_its_sentence(what: Any, subject: tuple[str, ...], value: float, said: str) -> None:
    unit = {"clock": "min", "gain": "%"}.get(what, "K")
    one = Candidate("data", what, subject, NOTHING, unit=unit)
    assert (
        said
        in diagnosis_words.of_finding(SETUP, CauseEstimate(one, value, 0.1, 0.01, 0.9, 9.0, told=True)).text
    )


def test_a_probability_is_never_rounded_to_certainty() -> None:
    cause = diagnosis_words.of_finding(SETUP, CauseEstimate(STEP, 0.5, 0.1, 0.001, 0.9996, 12.0, told=True))
    assert not re.search(r"\b100 %", cause.text)
    assert "99.96 %" in cause.text


def test_a_diagnosis_says_that_the_days_are_no_longer_blind_or_that_nothing_is_named() -> None:
    cause = diagnosis_words.of_finding(SETUP, CauseEstimate(STEP, 0.5, 0.1, 0.001, 0.9, 12.0, told=True))
    assert "no longer blind" in diagnosis_words.summary(Diagnosis((cause,), {}, 0.001, 100, 999))[0]
    (nothing,) = diagnosis_words.summary(Diagnosis((), {}, 0.31, 1234, 999))
    assert "of 1234 candidates" in nothing
    assert "(p 0.31)" in nothing
    # Findings of the table alone are no test.
    table = replace(cause, p=float("nan"))
    assert "No cause is named" in diagnosis_words.summary(Diagnosis((table,), {}, 0.31, 1234, 999))[0]
