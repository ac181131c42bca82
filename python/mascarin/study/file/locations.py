"""File and line of each entry of a study, for error messages."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from mascarin.building.base.error_texts import KeyPath
from mascarin.building.reading import lines
from mascarin.errors import InputError
from mascarin.simulation.preparation.initial_state import StartError


class _Several(InputError):
    """Several errors in one message."""

    def __init__(self, where: Path | str, texts: list[str]) -> None:
        super().__init__("\n".join([f"{where}: {len(texts)} faults", *texts]))
        self.texts = texts


class Faults:
    """Collects independent errors, so that one message names them all."""

    def __init__(self) -> None:
        self._found: list[str] = []

    @contextmanager
    def kept(self) -> Iterator[None]:
        """Collect an InputError raised inside."""
        try:
            yield
        except _Several as error:
            self._found += error.texts
        except InputError as error:
            self._found.append(str(error))

    def raise_all(self, where: Path | str) -> None:
        """Raise one error that names all that were collected, if there are any.

        Raises
        ------
        InputError
            All collected errors, one after the other.
        """
        found = list(dict.fromkeys(self._found))
        if len(found) == 1:
            raise InputError(found[0])
        if found:
            raise _Several(where, found)


class Places:
    """Lines of the entries of a YAML file, and of those that it extends; without a file, dotted names alone.

    Parameters
    ----------
    path : Path, optional
        A file that has been read before.
    experiment : str
        Name of the experiment of which the entries are; empty for those of the study.
    of_experiment : mapping of place to int, optional
        Lines of the entries of the experiment, in place of those of the file.
    """

    def __init__(
        self,
        path: Path | None = None,
        experiment: str = "",
        of_experiment: Mapping[KeyPath, int] | None = None,
    ) -> None:
        self.file = "study" if path is None else str(path)
        self._experiment = f"experiments.{experiment}: " if experiment else ""
        self._lines, files = ({}, ()) if path is None else lines(path)
        if of_experiment is not None:
            self._lines = of_experiment
        self._texts = {str(file): file.read_text(encoding="utf-8") for file in files}

    def at(self, *place: str | int) -> str:
        """File, line and dotted name of an entry; the line of its parent if it is not written."""
        written = next((place[:n] for n in range(len(place), -1, -1) if place[:n] in self._lines and n), ())
        line = self._lines.get(written)
        where = f"{getattr(line, 'file', self.file)}:{line}" if line else self.file
        return f"{where}: {self._experiment}{'.'.join(map(str, place))}"

    def find(self, key: str, value: str) -> str | None:
        """File and line of the first line that gives a key this value; None if there is none."""
        wanted = re.compile(rf"\b{re.escape(key)}:\s*[\"']?{re.escape(value)}\b")
        for file, text in self._texts.items():
            for number, line in enumerate(text.splitlines(), start=1):
                if wanted.search(line):
                    return f"{file}:{number}"
        return None

    @contextmanager
    def blame(self, *place: str | int) -> Iterator[None]:
        """Put file, line and entry in front of the text of an InputError raised inside."""
        try:
            yield
        except InputError as error:
            raise self.blamed(error, *place) from None

    @contextmanager
    def noting(self, faults: Faults, *place: str | int) -> Iterator[None]:
        """The same, but collect the error and continue."""
        with faults.kept(), self.blame(*place):
            yield

    def blamed(self, error: InputError, *place: str | int) -> InputError:
        """The same error with file, line and entry in front, without repeating them."""
        text, place = str(error), error.place if isinstance(error, StartError) else place
        for said in (".".join(map(str, place)), *map(str, place[-1:])):
            text = text.removeprefix(f"{said}: ")
        return InputError(f"{self.at(*place)}: {text}")
