"""Numbers of tables and figures, and the references to them."""

from __future__ import annotations

from collections import Counter
from typing import Final

from markupsafe import Markup

KINDS: Final = ("Table", "Figure")


class CrossReferences:
    """Counts tables and figures in the order of the page.

    A text may refer to what comes after it: the page is made twice, and the second time all are known.

    Examples
    --------
    >>> references = CrossReferences()
    >>> references.label("Table", "metrics"), references.label("Table", "periods")
    ('Table 1', 'Table 2')
    >>> str(references.refer("Table", "periods"))
    '<a href="#table-periods">Table 2</a>'
    """

    def __init__(self) -> None:
        self._label_of: dict[tuple[str, str], str] = {}
        self._counts: Counter[str] = Counter()

    def restart(self) -> None:
        """Count from one again; references keep what was counted."""
        self._counts.clear()

    def label(self, kind: str, key: str) -> str:
        """Count a table or figure.

        Parameters
        ----------
        kind : str
            One of `KINDS`.
        key : str
            Its name on the page, which no other of its kind has.

        Returns
        -------
        str
            Such as ``Table 3``.
        """
        self._counts[kind] += 1
        self._label_of[kind, key] = f"{kind} {self._counts[kind]}"
        return self._label_of[kind, key]

    def refer(self, kind: str, key: str) -> Markup:
        """A link to a table or figure.

        Parameters
        ----------
        kind, key : str
            As for `label`.

        Returns
        -------
        Markup
            Its number; before it is counted only its kind.
        """
        words = self._label_of.get((kind, key), kind)
        return Markup('<a href="#{}-{}">{}</a>').format(kind.lower(), key, words)
