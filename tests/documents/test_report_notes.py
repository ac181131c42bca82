"""Sentences that a study writes into its results depend on its facts: causes, days, aims, profiles, transfer.

`test_report_facts` has the sentences of the report itself. Here each function that makes sentences is called
with facts, and again with each fact changed: the words change, or the fact stands in `SHOWN_ELSEWHERE` with
the place where it is.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator
from dataclasses import fields, replace
from types import SimpleNamespace
from typing import Any, Final

import numpy as np
import pandas as pd
import pytest

from mascarin._io.numbers import in_percent
from mascarin.calibration.profile import Profile
from mascarin.diagnosis.causes import CauseEstimate
from mascarin.diagnosis.error_sources import Correction, ErrorSources, explain_missed_aims
from mascarin.diagnosis.hypotheses import GROUPS, WORDS, Candidate, Cause, Diagnosis
from mascarin.study.diagnosis import words
from mascarin.study.results.document.whole import causes_table
from mascarin.study.steps.days import day_words, days_table
from mascarin.study.transfer.comparison import transfer_notes, transfer_table
from mascarin.study_document.comparison import MetricValues, TransferEntry, TransferScores
from mascarin.tables.quality.defects import Stretch
from mascarin.validation.criteria import Verdict
from mascarin.validation.days import DayChoice, DriverRange

TIMES: Final = pd.date_range("2024-05-01", periods=96, freq="1h", tz="UTC")


def setup(*stretches: Stretch, masked: bool = False) -> Any:
    """What the words of causes read of a study."""
    sensors = {name: SimpleNamespace(columns=(f"T_{name}",), label=None) for name in ("air", "wall")}
    return SimpleNamespace(
        plan=SimpleNamespace(sensors=sensors),
        quality=stretches,
        inputs=SimpleNamespace(leaves_out=lambda _: masked),
        observation=SimpleNamespace(times=TIMES),
        measurements=SimpleNamespace(data=pd.DataFrame(index=TIMES)),
    )


# --- causes -------------------------------------------------------------------------------------------------

#: Group, kind, subject, detail and unit of a candidate of each kind.
KINDS: Final[list[tuple[Any, Any, tuple[str, ...], str, str]]] = [
    ("data", "swapped", ("air", "wall"), "", ""),
    ("data", "swap_step", ("air", "wall"), "", ""),
    *(("data", what, ("air",), "", "K") for what in ("offset", "step", "drift")),
    *(("data", what, ("air",), "", "%") for what in ("gain", "scale")),
    *(("data", what, ("air",), "", "min") for what in ("clock", "clock_step")),
    ("data", "place", ("air",), "part of the mean radiant temperature", "-"),
    ("input", "gain", ("global_horizontal",), "", "%"),
    ("input", "offset", ("air_temperature",), "", "K"),
    ("input", "clock", ("global_horizontal",), "", "min"),
    ("parameter", "parameter", ("zones.room.volume",), "", "m3"),
    ("form", "form", ("surfaces.roof.outside.convection",), "doe2", ""),
    ("path", "path", ("room",), "a loss to outdoors", "W/K"),
]
#: Facts of a finding that its sentence does not have, with the place where they are.
SHOWN_ELSEWHERE: Final = {
    "log_bayes_factor": "in the results as data",
    "others": "said only where the cause is not told",
}


def finding(kind: tuple[Any, Any, tuple[str, ...], str, str], **facts: Any) -> CauseEstimate:
    group, what, subject, detail, unit = kind
    start = 50.0 if what.endswith("step") else math.nan
    candidate = Candidate(
        group,
        what,
        subject,
        np.zeros((1, 1)),
        unit=unit,
        detail=detail,
        start=start,
    )
    stated: dict[str, Any] = {
        "value": 0.6, "error": 0.1, "p": 0.003, "certainty": 0.93, "log_bayes_factor": 12.0, "told": True,
    }  # fmt: skip
    return CauseEstimate(candidate, **{**stated, **facts})


def said(estimate: CauseEstimate) -> str:
    return words.of_finding(setup(), estimate).text


def test_every_kind_of_cause_is_tried() -> None:
    of_table, noise = {"stuck", "forward_filled", "interpolated", "copied"}, {"noise"}
    assert {what for _, what, *_ in KINDS} | of_table | noise == set(WORDS)
    assert {group for group, *_ in KINDS} == set(GROUPS)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: "-".join(kind[:2]))
def test_each_fact_of_a_cause_changes_its_sentence(kind: tuple[Any, Any, tuple[str, ...], str, str]) -> None:
    base = said(finding(kind))
    other = finding(("data", "clock", ("wall",), "", "min")).candidate
    changes: dict[str, dict[str, Any]] = {
        "size": {"value": 0.9}, "error": {"error": 0.2}, "side": {"value": -0.6}, "p": {"p": 0.2},
        "certainty": {"certainty": 0.71}, "told": {"told": False}, "others": {"others": (other,)},
        "log_bayes_factor": {"log_bayes_factor": 3.0},
    }  # fmt: skip
    same = {name for name, facts in changes.items() if said(finding(kind, **facts)) == base}
    # A law and exchanged columns have no size.
    without_size = {"size", "error", "side"} if kind[1] in ("form", "swapped", "swap_step") else set()
    sideless = {"side"} if kind[1] == "place" else set()
    assert same == without_size | sideless | set(SHOWN_ELSEWHERE)
    untold = said(finding(kind, told=False, others=(other,)))
    assert untold.startswith("Cannot tell")
    assert "wall: sensor, clock" in untold
    # A sensor that is not told may be no other candidate; a model may lack what no candidate is.
    assert ("among the candidates" in untold) == (kind[0] != "data")
    elsewhere = replace(finding(kind).candidate, subject=("wall", "air")[: len(kind[2])])
    assert said(replace(finding(kind), candidate=elsewhere)) != base
    if kind[1].endswith("step"):
        assert "from about 2024-05-03 02:00 on" in base
        later = replace(finding(kind).candidate, start=75.0)
        assert "from about 2024-05-04 03:00 on" in said(replace(finding(kind), candidate=later))
    else:
        assert "from about" not in base


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: "-".join(kind[:2]))
def test_no_sentence_about_a_cause_states_what_the_facts_do_not(
    kind: tuple[Any, Any, tuple[str, ...], str, str],
) -> None:
    """High and low, early and late, up and down, missing and too much: one of the two, by the sign."""
    pairs = (("too high", "too low"), (" late", " early"), (" up ", " down "), ("missing", "too much"))
    more, less = said(finding(kind)), said(finding(kind, value=-0.6))
    for up, down in pairs:
        assert (up in more) == (down in less)
        assert not (up in more and down in more)
        assert not (up in less and down in less)


@pytest.mark.parametrize("kind", ["stuck", "forward_filled", "interpolated", "copied"])
def test_each_fact_of_a_stretch_changes_its_sentence(kind: Any) -> None:
    stretch = Stretch("T_air", kind, TIMES[3], TIMES[9], 7, "20.4")
    (base,) = words.of_table(setup(stretch))
    changes: dict[str, Any] = {
        "channel": "T_wall", "kind": "stuck" if kind == "copied" else "copied", "start": TIMES[4],
        "end": TIMES[12], "count": 11, "detail": "21.9",
    }  # fmt: skip
    for key, value in changes.items():
        (other,) = words.of_table(setup(replace(stretch, **{key: value})))
        assert other.text != base.text, key
    assert {field.name for field in fields(Stretch)} == {"channel", "kind", "start", "end", "count", "detail"}
    (masked,) = words.of_table(setup(stretch, masked=True))
    assert f"leave them out with quality: {{mask: [{kind}]}}" in base.text
    assert "they are left out of all comparisons" in masked.text
    assert "leave them out" not in masked.text


def test_each_fact_of_the_noise_changes_its_sentence() -> None:
    base = words.of_noise([("air", 0.3, 0.01, "degC")])
    for other in ([("wall", 0.3, 0.01, "degC")], [("air", 0.4, 0.01, "degC")], [("air", 0.3, 0.01, "W")]):
        assert words.of_noise(other).text != base.text
    two = words.of_noise([("air", 0.3, 0.01, "degC"), ("wall", 0.5, 0.02, "degC")])
    assert "air 0.3 K, wall 0.5 K" in two.text
    assert two.subject == ("air", "wall")


def test_what_a_diagnosis_says_as_a_whole_follows_from_its_causes() -> None:
    cause = Cause("data", "clock", ("air",), "late", 60.0, 1.0, "min", p=0.001, certainty=0.9)
    of_data = replace(cause, what="stuck", p=math.nan)
    nothing = words.summary(Diagnosis((), {}, p=0.3, candidates=40))
    assert nothing == words.summary(Diagnosis((of_data,), {}, p=0.3, candidates=40))
    assert "of 40 candidates" in nothing[0]
    assert "(p 0.3)" in nothing[0]
    assert words.summary(Diagnosis((), {}, p=0.4, candidates=40)) != nothing
    assert words.summary(Diagnosis((), {}, p=0.3, candidates=41)) != nothing
    assert words.summary(Diagnosis((cause,), {}, p=0.001, candidates=40)) == [words.NOT_BLIND]
    assert words.summary(Diagnosis((), {})) == []


def test_the_caption_of_the_causes_speaks_of_what_is_not_told_where_there_is_some() -> None:
    cause = Cause("data", "clock", ("air",), "late", 60.0, 1.0, "min", p=0.001, certainty=0.9)
    words_of_untold = "Where it is not told"
    assert words_of_untold not in causes_table(Diagnosis((cause,), {})).caption
    assert words_of_untold in causes_table(Diagnosis((replace(cause, told=False),), {})).caption
    rows = [causes_table(Diagnosis((replace(cause, told=told),), {})).rows[0] for told in (True, False)]
    assert [row[6] for row in rows] == ["yes", "no"]


# --- days ---------------------------------------------------------------------------------------------------


def choice(**facts: Any) -> DayChoice:
    stated: dict[str, Any] = {
        "days": ("2024-05-01", "2024-05-02", "2024-05-03", "2024-05-04"),
        "used": np.array([True, True, False, False]),
        "leverage": np.array([1.0, 1.0, 1.2, 9.0]),
        "information": np.array([0.1, 0.2, 0.3, 2.0]),
        "reduction": np.array([0.01, 0.02, 0.03, 0.4]),
        "outside": {"wind": np.array([0.0, 0.0, 0.0, 0.5])},
        "ranges": (DriverRange("wind", 0.0, 4.0, 0.5, 9.0, 0.25),),
        "proposed": (3,),
    }
    return DayChoice(**{**stated, **facts})


def test_each_fact_of_the_choice_of_days_changes_its_words() -> None:
    base = "\n".join(day_words(choice()))
    assert "1 of 2 days that were not used for the calibration is an extrapolation: its leverage" in base
    assert "2024-05-04" in base
    further: dict[str, Any] = {
        "name": "sun", "low": 1.0, "high": 5.0, "other_low": 0.1, "other_high": 8.0, "outside": 0.5,
    }  # fmt: skip
    changes: dict[str, dict[str, Any]] = {
        "nothing proposed": {"proposed": ()},
        "another day": {"proposed": (2,)},
        "no extrapolation": {"leverage": np.ones(4)},
        "two extrapolations": {"leverage": np.array([1.0, 1.0, 9.0, 9.0])},
        "more days": {"used": np.array([True, False, False, False])},
        "no range": {"ranges": ()},
        "dates": {"days": ("2025-05-01", "2025-05-02", "2025-05-03", "2025-05-04")},
        **{
            key: {"ranges": (replace(choice().ranges[0], **{key: value}),)}
            for key, value in further.items()
        },
    }  # fmt: skip
    told = {name: "\n".join(day_words(choice(**facts))) for name, facts in changes.items()}
    assert [name for name, text in told.items() if text == base] == []
    assert "extrapolation" not in told["no extrapolation"]
    assert (
        "2 of 2 days that were not used for the calibration are extrapolations: their"
        in told["two extrapolations"]
    )
    assert "Days with the largest" not in told["nothing proposed"]
    nothing = choice(leverage=np.ones(4), ranges=(), proposed=())
    assert day_words(nothing) == []
    assert days_table(nothing).rows == []
    assert [row[0] for row in days_table(choice()).rows] == ["2024-05-04"]


def test_no_share_of_the_days_is_rounded_to_nothing_or_to_all() -> None:
    for outside in (1e-6, 0.0004, 0.004, 0.9996, 1.0 - 1e-6):
        (text, *_) = day_words(
            choice(leverage=np.ones(4), ranges=(DriverRange("wind", 0, 4, 0, 9, outside),))
        )
        percent = float(re.findall(r": ([\d.e-]+) % of", text)[0])
        assert 0.0 < percent < 100.0
    for share in np.linspace(0.0, 1.0, 1001):
        percent = float(in_percent(float(share)).removesuffix(" %"))
        assert percent == pytest.approx(100.0 * share, abs=0.06)
        assert (percent == 0.0) == (share == 0.0)
        assert (percent == 100.0) == (share == 1.0)


# --- aims and profiles --------------------------------------------------------------------------------------


def missed(
    value: float = 0.3, limit: float = 0.1, floor: float = 0.05, count: int = 2, **noise: float
) -> str:
    sources = ErrorSources(
        ("air",), (value,), (), Correction(("a", "b")[:count], (0.1, 0.2)[:count], (floor,))
    )
    aim = Verdict("sd", "air", "blind", "sd", value, limit, "degC", passed=False)
    (text,) = explain_missed_aims([aim], sources, "blind", noise)
    return text


def test_each_fact_of_a_missed_aim_changes_its_sentence() -> None:
    base = missed()
    others = [missed(0.4), missed(limit=0.2), missed(floor=0.07), missed(count=1), missed(air=0.2)]
    assert len({base, *others}) == 6
    assert "the equations are sufficient" in base
    assert "no parameter values reach the aim" in missed(floor=0.2)
    assert "the white noise of the sensor, 0.20 K, is above the aim" in missed(air=0.2)
    assert "With the only parameter adjusted" in missed(count=1)


def test_a_missed_aim_is_never_written_as_met() -> None:
    """The error is above the aim, and so are its numbers; what remains is on its side of the aim, too."""
    rng = np.random.default_rng(1)
    for _ in range(200):
        limit = float(rng.choice([0.1, 0.25, 0.3, 1.0]))
        value = limit * (1.0 + float(rng.choice([1e-4, 1e-3, 0.02, 0.5])))
        floor = limit * float(rng.choice([0.5, 0.9995, 1.0005, 1.4]))
        text = missed(value, limit, floor)
        shown, aim, remaining = map(float, re.findall(r"([\d.]+) K", text))
        assert shown > aim
        assert (remaining > aim) == ("no parameter values reach the aim" in text)


def test_each_end_of_a_profile_has_its_words() -> None:
    texts = {}
    for low, high in itertools.product((False, True), repeat=2):
        profile = Profile(
            path="k", unit="W/(m K)", estimate=0.4, values=np.ones(3), rise=np.zeros(3),
            parameter_values=np.ones((3, 1)), limit=1.9, low=0.2, high=0.8, open_low=low, open_high=high,
        )  # fmt: skip
        texts[low, high] = profile.words
    assert texts[False, False] == ""
    assert texts[True, True] == "k: the data bound it on neither side"
    assert texts[True, False].endswith("bound it below; the interval ends with the range at 0.2 W/(m K)")
    assert texts[False, True].endswith("bound it above; the interval ends with the range at 0.8 W/(m K)")


# --- transfer -----------------------------------------------------------------------------------------------


def moved(**facts: Any) -> TransferEntry:
    scores = TransferScores(
        described=MetricValues(n=9, rmse=1.0, bias=0.4), calibrated=MetricValues(n=9, rmse=0.5, bias=0.1),
        held=0.93, unit="K",
    )  # fmt: skip
    stated = {"building": "north", "words": ["it extrapolates"], "sensors": {"air": {"blind": scores}}}
    return TransferEntry(**{**stated, **facts})


def numbers(entry: TransferEntry, name: str = "winter") -> list[Any]:
    study: Any = SimpleNamespace(
        experiments={},
        inputs=SimpleNamespace(transfer={name: SimpleNamespace(plan=setup().plan)}, experiment=""),
    )
    return transfer_table(study, {name: entry}).rows


def test_each_fact_of_a_transfer_changes_its_table_or_its_notes() -> None:
    base = numbers(moved())
    scores = moved().sensors["air"]["blind"]
    changes: dict[str, Any] = {
        "described": MetricValues(n=9, rmse=1.1, bias=0.4),
        "calibrated": MetricValues(n=9, rmse=0.6, bias=0.1),
        "held": 0.8, "unit": "W",
    }  # fmt: skip
    for key, value in changes.items():
        other = scores.model_copy(update={key: value})
        assert numbers(moved(sensors={"air": {"blind": other}})) != base, key
    assert set(changes) == set(TransferScores.model_fields)
    assert numbers(moved(building="south")) != base
    assert numbers(moved(sensors={"wall": {"blind": scores}})) != base
    assert numbers(moved(sensors={"air": {"identification": scores}})) != base
    (row,) = numbers(moved(sensors={"air": {"blind": scores.model_copy(update={"held": None})}}))
    assert row[-1] is None
    assert transfer_notes({"winter": moved()}) == ["winter: it extrapolates"]
    assert transfer_notes({"summer": moved(words=["warm", "dry"])}) == ["summer: warm", "summer: dry"]
    assert transfer_notes({"winter": moved(words=[])}) == []


def clauses(text: str) -> Iterator[str]:
    yield from (clause for clause in re.split(r"(?<=[.;:])\s+", text) if len(clause.split()) >= 3)


def test_no_clause_about_a_sensor_is_the_same_whatever_its_cause() -> None:
    texts = [
        said(finding(kind, value=v, told=t)) for kind in KINDS for v in (0.6, -0.3) for t in (True, False)
    ]
    constant = set.intersection(*(set(clauses(text)) for text in texts))
    assert constant == set()
