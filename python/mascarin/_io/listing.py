"""Lists of described objects, which are shown by their first entries and as a table."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, TypeVar

from mascarin._io import display

if TYPE_CHECKING:
    import pandas as pd

Item = TypeVar("Item")


class Listing(list[Item]):
    """A list of data classes with a short text, an HTML table in notebooks, and `to_dataframe`.

    Parameters
    ----------
    items : iterable
        Instances of one data class.
    title : str
        First line of the text.
    shown : tuple of str
        Fields of an entry that the text shows; the first is the index of the table.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass
    ... class Pump:
    ...     name: str
    ...     power: float
    >>> pumps = Listing([Pump("a", 40.0), Pump("b", 60.0)], "2 pumps", ("name", "power"))
    >>> pumps
    2 pumps
      a  40
      b  60
    >>> float(pumps.to_dataframe().loc["b", "power"])
    60.0
    """

    def __init__(self, items: Iterable[Item], title: str, shown: tuple[str, ...]) -> None:
        super().__init__(items)
        self._title = title
        self._shown = shown

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table with one row for each entry and one column for each of its fields."""
        import pandas as pd

        rows = [asdict(item) for item in self]  # type: ignore[call-overload]
        return pd.DataFrame(rows).set_index(self._shown[0]) if rows else pd.DataFrame()

    def __repr__(self) -> str:
        return display.text(self._title, [self._row(item) for item in self])

    def _repr_html_(self) -> str:
        return display.page(self._title, [], tables={"Table": self.to_dataframe()})

    def _row(self, item: Item) -> tuple[str, str]:
        name, *cells = (getattr(item, field) for field in self._shown)
        return str(name), " ".join(_text(value) for value in cells)


def _text(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
