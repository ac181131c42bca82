"""The two listings, with the counters of GenOpt."""

from __future__ import annotations

import datetime as dt
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TextIO

from mascarin import __version__
from mascarin._io.identity import require_no_input
from mascarin.errors import SolverError
from mascarin.genopt.files.numbers import double_text
from mascarin.genopt.files.project import Project
from mascarin.optimization import Evaluation, Observer

MAIN_NAME = "OutputListingMain.txt"
ALL_NAME = "OutputListingAll.txt"

# The same number of lines as in GenOpt's files, for scripts that skip a fixed number of lines.
_HEADER = (
    f"Mascarin {__version__}, listing in the format of GenOpt 3.1.1",
    "",
    "Written by 'mascarin optimize'.",
    "Columns are separated by tabs; the last one has no title and contains the comment.",
    "Rows are added as the search proceeds.",
    "",
    "The first number counts simulations; for a repeated point it is the count of simulations so far.",
    "The next numbers count iterations, and trials within an iteration,",
    "the step number that penalty and barrier functions may use,",
    "the costs, the continuous and the discrete parameters.",
    "",
    "_" * 63,
    "",
)


@dataclass(frozen=True)
class Row:
    """One row of a listing.

    Parameters
    ----------
    evaluation : Evaluation
        The point and its cost.
    main, sub : int
        Iteration counters [-].
    comment : str
        Comment of the algorithm.
    """

    evaluation: Evaluation
    main: int
    sub: int
    comment: str


class Listings(Observer):
    """Writes both listings while a search proceeds.

    Parameters
    ----------
    project : Project
        The project; the files are written beside its command file.
    algorithm : str
        Name of the algorithm.
    max_equal : int, optional
        Number of equal costs that are allowed [-].
    comment : str, optional
        Replaces the comment of failed evaluations.
    """

    def __init__(self, project: Project) -> None:
        self._project = project
        self._main_counter = 1
        self._sub_counter = 1
        self.main_rows: list[Row] = []
        self.sub_rows: list[Row] = []
        self.notes: list[str] = []
        self.lowest: Row | None = None
        self.max_equal: int | None = None
        self._costs: Counter[float] = Counter()
        self._files: list[TextIO] = []

    def open(self, algorithm: str, started: dt.datetime) -> None:
        """Begin both files.

        Parameters
        ----------
        algorithm : str
            Name of the algorithm.
        started : datetime
            Start of the run.
        """
        folder = self._project.command_file.parent
        costs = [o.name for o in self._project.objectives]
        for name, title, columns in (
            (MAIN_NAME, "Main Iterations", ["Main Iteration"]),
            (ALL_NAME, "All Iterations", ["Main Iteration", "Sub Iteration"]),
        ):
            require_no_input(folder / name)
            file = (folder / name).open("w", encoding="utf-8", errors="surrogateescape")
            lines = [
                *_HEADER,
                f"Results of {algorithm} algorithm",
                f"Start time: {started.strftime('%a %b %d %H:%M:%S %Z %Y')}",
                "",
                title,
                "",
                "",
                "\t".join(["Simulation Number", *columns, "Step Number", *costs, *self._project.names]),
            ]
            file.write("\n".join(lines) + "\n")
            file.flush()
            self._files.append(file)

    def close(self) -> None:
        """Close both files."""
        for file in self._files:
            file.close()
        self._files = []

    # ------------------------------------------------------------------ what the search reports

    def sub(self, evaluation: Evaluation, comment: str) -> None:
        """Row of all iterations."""
        row = Row(evaluation, self._main_counter, self._sub_counter, comment)
        self.sub_rows.append(row)
        self._write(1, row)
        self._sub_counter += 1
        self._count(evaluation)

    def main(self, evaluation: Evaluation, comment: str) -> None:
        """Row of main iterations."""
        row = Row(evaluation, self._main_counter, self._sub_counter, comment)
        self.main_rows.append(row)
        self._write(0, row)
        self._main_counter += 1
        self._sub_counter = 1

    def minimum(self, comment: str) -> None:
        """Row of the lowest point in both files."""
        row = self.minimum_row(comment)
        if row is not None:
            self.lowest = row
            self._write(0, row)
            self._write(1, row)

    def restart(self) -> None:
        """Counters begin again."""
        self._main_counter = 1
        self._sub_counter = 1

    def note(self, text: str) -> None:
        """Remark for the log."""
        self.notes.append(text)

    def summary(self, lines: Sequence[str]) -> None:
        """Overview at the end of both files."""
        for file in self._files:
            file.write("\n".join(("", "", *lines)) + "\n")
            file.flush()

    def minimum_row(self, comment: str) -> Row | None:
        """The lowest point of the last step number, the latest main row of equals.

        Parameters
        ----------
        comment : str
            Its comment.

        Returns
        -------
        Row or None
            The row, None when nothing has been reported.
        """
        if not self.main_rows:
            return None
        step = self.main_rows[-1].evaluation.point.step
        best: Row | None = None
        for rows in (self.main_rows, self.sub_rows):
            for row in reversed(rows):
                e = row.evaluation
                if e.point.step == step and (best is None or e.cost < best.evaluation.cost):
                    best = row
        return replace(best, comment=comment) if best is not None else None

    # ------------------------------------------------------------------ rows

    def _write(self, which: int, row: Row) -> None:
        """Add a row to a file at once."""
        if self._files:
            file = self._files[which]
            file.write(self.text(row, sub=which == 1) + "\n")
            file.flush()

    def text(self, row: Row, *, sub: bool) -> str:
        """Text of a row.

        Parameters
        ----------
        row : Row
            The row.
        sub : bool
            Whether it has the column of the sub iteration.

        Returns
        -------
        str
            Cells separated by tabs.
        """
        e = row.evaluation
        cells = [str(e.number), str(row.main)]
        if sub:
            cells.append(str(row.sub))
        cells.append(str(e.point.step))
        cells += [double_text(v) for v in (e.cost, *e.outputs)]
        cells += [self._project.number_text(v) for v in e.point.x]
        cells += [p.values[k] for p, k in zip(self._project.discrete, e.point.choices, strict=True)]
        cells.append(row.comment)
        return "\t".join(cells)

    def _count(self, evaluation: Evaluation) -> None:
        """Stop when one cost occurs too often."""
        if self.max_equal is None:
            return
        self._costs[evaluation.cost] += 1
        if self._costs[evaluation.cost] > self.max_equal:
            msg = (
                f"the cost {evaluation.cost!r} was obtained more than MaxEqualResults = {self.max_equal} "
                "times; the cost does not depend on the parameters there: check the simulation or increase "
                "the number"
            )
            raise SolverError(msg)
