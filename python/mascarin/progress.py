"""Progress of long work, with the time that remains: on standard error, or as a bar in a notebook."""

from __future__ import annotations

import contextlib
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from types import TracebackType
from typing import Final, Self, TextIO

from mascarin._io.terminal import printable
from mascarin.errors import InputError

Report = Callable[[int, int], object]
"""What is called during long work, with the number of units done and their total."""

ProgressOption = bool | Report | None
"""The option ``progress`` of every function: None shows progress in notebooks only, True everywhere, False
nowhere; a function is called with the number of units done and their total."""

SILENT_FOR: Final = 2.0
"""Work shorter than this shows nothing. [s]"""

_REDRAW_EVERY: Final = 0.1  # s, on a terminal
_LINE_EVERY: Final = 5.0  # s, in a log
_BAR: Final = 24  # characters


@contextlib.contextmanager
def reporting(progress: ProgressOption, label: str) -> Iterator[Report]:
    """Turn the option ``progress`` of a function into one callable.

    Parameters
    ----------
    progress : bool, callable or None
        As the user gave it; see `ProgressOption`.
    label : str
        What is being done, a few words.

    Yields
    ------
    callable
        To be called with the number of units done and their total.

    Examples
    --------
    >>> seen = []
    >>> with reporting(lambda done, total: seen.append((done, total)), "runs") as report:
    ...     report(1, 2)
    >>> seen
    [(1, 2)]
    """
    if progress is not None and not isinstance(progress, bool) and not callable(progress):
        raise InputError(
            f"progress: found {progress!r}, expected True, False, None, or a function of (done, total)"
        )
    if callable(progress):
        call = progress

        def forward(done: int, total: int) -> None:
            call(done, total)

        yield forward
    elif progress is not False and in_notebook():
        with _notebook_bar(label) as report:
            yield report
    elif progress:
        with Progress(label) as shown:
            yield shown
    else:
        yield lambda _done, _total: None


def in_notebook() -> bool:
    """Whether this process runs the cells of a notebook."""
    module = sys.modules.get("IPython")
    shell = None if module is None else module.get_ipython()
    return shell is not None and type(shell).__name__ == "ZMQInteractiveShell"


@contextlib.contextmanager
def _notebook_bar(label: str) -> Iterator[Report]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # without ipywidgets the bar is text, which needs no warning
        from tqdm.auto import tqdm

    with tqdm(desc=label, delay=SILENT_FOR, leave=False) as bar:

        def report(done: int, total: int) -> None:
            bar.total = total
            bar.update(done - bar.n)

        yield report


class Progress:
    """Progress of work, as a line of text.

    On a terminal one line is updated and removed at the end; elsewhere (a log, a
    pipe) a plain line appears every few seconds. Nothing is shown for work shorter than
    `SILENT_FOR`. An instance is also a callable ``progress(done, total)``.

    Parameters
    ----------
    label : str
        What is being done, a few words.
    stream : text stream, optional
        Where to write; standard error as it is when the work starts.
    clock : callable, optional
        Monotonic clock. [s]

    Examples
    --------
    >>> with Progress("members") as progress:
    ...     for k in range(100):
    ...         progress.update(k + 1, 100)
    """

    def __init__(
        self,
        label: str,
        *,
        stream: TextIO | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._label = label
        self._stream = sys.stderr if stream is None else stream
        self._clock = clock
        self._terminal = _is_terminal(self._stream)
        self._lock = threading.Lock()
        self._started = clock()
        self._shown_at: float | None = None
        self._width = 0
        self._first: tuple[float, float] | None = None  # (time, done) of the first call

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __call__(self, done: float, total: float) -> None:
        """The same as `update`."""
        self.update(done, total)

    def update(self, done: float, total: float, note: str = "") -> None:
        """Show how much is done; cheap enough to be called often, from any thread.

        Parameters
        ----------
        done, total : float
            Work done and work in all, in any common unit; a total of 0 means that it is not known. The
            first call may be above zero (work done by an earlier run): the remaining time counts only the
            work done since then.
        note : str, optional
            A few words shown behind the numbers, such as the best cost so far.
        """
        with self._lock:
            now = self._clock()
            if self._first is None:
                self._first = (self._started if done == 0 else now, done)
            if now - self._started < SILENT_FOR:
                return
            interval = _REDRAW_EVERY if self._terminal else _LINE_EVERY
            if self._shown_at is not None and now - self._shown_at < interval:
                return
            self._shown_at = now
            self._show(printable(self._text(now, done, total, note)))

    def close(self) -> None:
        """Remove the line from the terminal."""
        with self._lock:
            if self._terminal and self._width:
                self._write("\r" + " " * self._width + "\r")
                self._width = 0

    def _text(self, now: float, done: float, total: float, note: str) -> str:
        if total <= 0:
            return "  ".join([self._label, note] if note else [self._label, f"{done:g} done"])
        part = min(max(done / total, 0.0), 1.0)
        parts = [self._label]
        if self._terminal:
            filled = int(part * _BAR)
            parts.append("[" + "#" * filled + "-" * (_BAR - filled) + "]")
        parts.append(f"{100 * part:.0f} %")
        remaining = self._remaining(now, done, total)
        if remaining is not None:
            parts.append(f"{duration(remaining)} left")
        if note:
            parts.append(note)
        return "  ".join(parts)

    def _remaining(self, now: float, done: float, total: float) -> float | None:
        since, before = self._first or (now, done)
        if done <= before or now <= since:
            return None
        return (total - done) * (now - since) / (done - before)

    def _show(self, text: str) -> None:
        if not self._terminal:
            self._write(text + "\n")
            return
        self._write("\r" + text.ljust(self._width))
        self._width = len(text)

    def _write(self, text: str) -> None:
        # A terminal that was closed does not stop the work.
        with contextlib.suppress(OSError, ValueError):
            write = getattr(self._stream, "unfiltered", self._stream.write)  # with its carriage returns
            write(text)
            self._stream.flush()


def duration(seconds: float) -> str:
    """Duration as ``42 s``, ``3:05 min`` or ``2:10 h``.

    Parameters
    ----------
    seconds : float
        Duration. [s]
    """
    rounded = round(max(seconds, 0.0))
    if rounded < 60:
        return f"{rounded} s"
    if rounded < 3600:
        return f"{rounded // 60}:{rounded % 60:02d} min"
    return f"{rounded // 3600}:{rounded % 3600 // 60:02d} h"


def _is_terminal(stream: TextIO) -> bool:
    try:
        return stream.isatty()
    except (AttributeError, ValueError):
        return False
