from __future__ import annotations

import io

import pytest

from mascarin.progress import Progress, duration


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_short_work_shows_nothing() -> None:
    clock, stream = Clock(), Terminal()
    with Progress("runs", stream=stream, clock=clock) as progress:
        for k in range(10):
            clock.now += 0.19
            progress.update(k + 1, 10)
    assert stream.getvalue() == ""


def test_a_log_gets_a_plain_line_every_five_seconds() -> None:
    clock, stream = Clock(), io.StringIO()
    with Progress("runs", stream=stream, clock=clock) as progress:
        progress.update(0, 20)
        for k in range(20):
            clock.now += 1.0
            progress(k + 1, 20)
    lines = stream.getvalue().splitlines()
    assert lines == [
        "runs  10 %  18 s left",
        "runs  35 %  13 s left",
        "runs  60 %  8 s left",
        "runs  85 %  3 s left",
    ]


def test_a_terminal_has_one_line_that_is_removed() -> None:
    clock, stream = Clock(), Terminal()
    with Progress("runs", stream=stream, clock=clock) as progress:
        clock.now += 3.0
        progress.update(1, 4, "best 0.25")
        clock.now += 0.05
        progress.update(2, 4)  # too soon after the last one
    text = stream.getvalue()
    assert "\n" not in text
    shown = "runs  [######------------------]  25 %  best 0.25"
    assert text == f"\r{shown}\r{' ' * len(shown)}\r"


def test_the_remaining_time_counts_only_new_work() -> None:
    clock, stream = Clock(), io.StringIO()
    progress = Progress("runs", stream=stream, clock=clock)
    progress.update(900, 1000)  # found done
    clock.now += 10.0
    progress.update(950, 1000)
    assert stream.getvalue() == "runs  95 %  10 s left\n"


def test_a_closed_terminal_does_not_stop_the_work() -> None:
    clock, stream = Clock(), io.StringIO()
    progress = Progress("runs", stream=stream, clock=clock)
    stream.close()
    clock.now += 10.0
    progress.update(1, 2)
    progress.close()


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(-1.0, "0 s"), (59.4, "59 s"), (59.6, "1:00 min"), (185.0, "3:05 min"), (7800.0, "2:10 h")],
)
def test_duration(seconds: float, text: str) -> None:
    assert duration(seconds) == text
