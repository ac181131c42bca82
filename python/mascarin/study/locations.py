"""Where in its file each entry of a study stands, so that a late complaint can still point at it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mascarin.building.initial_state import StartError
from mascarin.errors import InputError


class _Several(InputError):
    """Errors told together."""

    def __init__(self, where: Path, texts: list[str]) -> None:
        super().__init__("\n".join([f"{where}: {len(texts)} faults", *texts]))
        self.texts = texts


class Faults:
    """Errors that do not hang on each other, told together."""

    def __init__(self) -> None:
        self._found: list[str] = []

    @contextmanager
    def kept(self) -> Iterator[None]:
        """Keep an InputError raised inside."""
        try:
            yield
        except _Several as error:
            self._found += error.texts
        except InputError as error:
            self._found.append(str(error))

    def tell(self, where: Path) -> None:
        """Raise what was kept, if anything.

        Raises
        ------
        InputError
            All that was kept, one after the other.
        """
        found = list(dict.fromkeys(self._found))
        if len(found) == 1:
            raise InputError(found[0])
        if found:
            raise _Several(where, found)


class Places:
    """Lines of the entries of a YAML file.

    Parameters
    ----------
    path : Path
        A file that has been read before.
    """

    def __init__(self, path: Path) -> None:
        from mascarin.building.reading import lines

        self.path = path
        self._lines = lines(path.read_text(encoding="utf-8"), str(path))

    def at(self, *place: str | int) -> str:
        """File, line and dotted place of an entry; the line of what holds it when it is not written."""
        written = next((place[:n] for n in range(len(place), -1, -1) if place[:n] in self._lines and n), ())
        line = self._lines.get(written)
        where = f"{self.path}:{line}" if line else str(self.path)
        return f"{where}: {'.'.join(map(str, place))}"

    def find(self, key: str, value: str) -> str | None:
        """File and line of the first line that gives a key this value, None when there is none."""
        import re

        wanted = re.compile(rf"\b{re.escape(key)}:\s*[\"']?{re.escape(value)}\b")
        for number, line in enumerate(self.path.read_text(encoding="utf-8").splitlines(), start=1):
            if wanted.search(line):
                return f"{self.path}:{number}"
        return None

    @contextmanager
    def blame(self, *place: str | int) -> Iterator[None]:
        """Put file, line and place in front of what an InputError says inside."""
        try:
            yield
        except InputError as error:
            raise self.blamed(error, *place) from None

    @contextmanager
    def noting(self, faults: Faults, *place: str | int) -> Iterator[None]:
        """The same, but keep the error among others and go on."""
        with faults.kept(), self.blame(*place):
            yield

    def blamed(self, error: InputError, *place: str | int) -> InputError:
        """The same error with file, line and place in front, its own where it has one; none is said twice."""
        text, place = str(error), error.place if isinstance(error, StartError) else place
        for said in (".".join(map(str, place)), *map(str, place[-1:])):
            text = text.removeprefix(f"{said}: ")
        return InputError(f"{self.at(*place)}: {text}")
