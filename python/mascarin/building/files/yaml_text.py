"""Write plain mappings, lists, texts and numbers as YAML 1.2, short pieces on one line."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any, Final

_WIDTH: Final = 100  # characters


def text_of(plain: Mapping[str, Any]) -> str:
    """Write a description as YAML.

    Parameters
    ----------
    plain : mapping
        Mappings, lists, texts, numbers, truth values.

    Returns
    -------
    str
        The text, with a line end at the end.

    Examples
    --------
    >>> print(text_of({"name": "box", "zones": {"room": {"volume": 30}}}), end="")
    name: box
    zones:
      room: {volume: 30}
    """
    from ruamel.yaml import YAML

    writer = YAML(typ="rt", pure=True)
    writer.width = 10 * _WIDTH
    writer.indent(mapping=2, sequence=4, offset=2)
    buffer = io.StringIO()
    writer.dump(_styled(plain, depth=0), buffer)
    return buffer.getvalue()


def _styled(value: Any, depth: int) -> Any:
    """Choose for each mapping and list whether it is written on one line."""
    from ruamel.yaml.comments import CommentedMap, CommentedSeq
    from ruamel.yaml.scalarstring import DoubleQuotedScalarString, LiteralScalarString

    if isinstance(value, Mapping):
        styled: Any = CommentedMap((key, _styled(piece, depth + 1)) for key, piece in value.items())
    elif isinstance(value, list | tuple):
        styled = CommentedSeq(_styled(piece, depth + 1) for piece in value)
    elif isinstance(value, str) and value.count("\n") > 1 and value.endswith("\n"):
        return LiteralScalarString(value)  # a table, a line for each of its rows
    elif isinstance(value, str) and value[:1].isdigit():
        # Times and dates are texts here; older readers of YAML take them for numbers.
        return DoubleQuotedScalarString(value)
    else:
        return value
    # The sections of a building and the names in them have a line each.
    if not value or (depth > 1 and len(repr(value)) < _WIDTH) or _all_numbers(value):
        styled.fa.set_flow_style()
    return styled


def _all_numbers(value: Any) -> bool:
    return isinstance(value, list | tuple) and all(isinstance(piece, int | float) for piece in value)
