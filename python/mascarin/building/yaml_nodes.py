"""The nodes of a YAML 1.2 text, each with its line.

ruamel.yaml decides what YAML 1.2 is: which texts are valid, and which words are numbers. Its scanner is
written in Python and takes longer than everything else that is done with a description. A text is therefore
first divided into events by libyaml, the C library behind PyYAML. What libyaml refuses, or could read in
another way, ruamel.yaml reads alone.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ruamel.yaml import YAML
    from ruamel.yaml.nodes import Node

#: Line ends of YAML 1.1 that are letters in YAML 1.2, the byte order mark, the first letter of directives,
#: tabs, and marks with a comment after them.
_OTHERWISE_READ = ("\x85", "\u2028", "\u2029", "\ufeff", "\n%", "\t", "\r", "|#", ">#")
#: Names of anchors with letters that end them in YAML 1.1.
_OTHER_ANCHORS = re.compile(r"[&*][\w-]*[^\w\s,\]}-]", re.ASCII)
#: Nodes in nodes; the recursion of Python ends below this.
_MOST_LEVELS = 100


def compose(yaml: YAML, text: str) -> Node | None:
    """Read the nodes of a text.

    Parameters
    ----------
    yaml : ruamel.yaml.YAML
        A reader in Python of YAML 1.2.
    text : str
        The text of one document.

    Returns
    -------
    Node or None
        The root; None of an empty text. Nodes have tags by the rules of YAML 1.2, and marks with their lines.

    Raises
    ------
    ruamel.yaml.error.YAMLError
        The text is no YAML 1.2.
    RecursionError
        Values are inside each other too often.

    Examples
    --------
    >>> from ruamel.yaml import YAML
    >>> compose(YAML(typ="safe", pure=True), "volume: 30").value[0][1].tag
    'tag:yaml.org,2002:int'
    """
    root = _fast(yaml, text) if _surely_read(text) else None
    return yaml.compose(text) if root is None else root


def _surely_read(text: str) -> bool:
    """Whether both libraries read what is in a text in the same way."""
    otherwise = text.startswith("%") or any(map(text.__contains__, _OTHERWISE_READ))
    return not otherwise and _OTHER_ANCHORS.search(text) is None


def _fast(yaml: YAML, text: str) -> Node | None:
    """The root by libyaml; None where ruamel.yaml has to decide."""
    try:
        from yaml.cyaml import CParser
        from yaml.error import YAMLError
    except (ImportError, AttributeError):  # PyYAML without its C library, or an import that was interrupted
        return None
    try:
        return _Composer(yaml, CParser(text)).document()
    except (YAMLError, _Undecided, ValueError):
        return None


class _Undecided(Exception):
    """ruamel.yaml has to decide how a text is read."""


class _Composer:
    """Nodes of ruamel.yaml from the events of a parser."""

    def __init__(self, yaml: YAML, parser: Any) -> None:
        from ruamel.yaml import nodes
        from yaml import events

        # Imports in functions take longer than what is done with one event.
        self._kinds, self._events = nodes, events
        self._next, self._resolver = parser.get_event, yaml.resolver
        self._tags: dict[tuple[str, tuple[bool, bool]], Any] = {}
        self._anchors: dict[str, Node] = {}

    def document(self) -> Node:
        """The root of the only document."""
        start = [self._next() for _ in range(2)]
        if not isinstance(start[1], self._events.DocumentStartEvent):
            raise _Undecided
        root = self._node(self._next(), 0)
        end = [self._next() for _ in range(2)]
        if not isinstance(end[1], self._events.StreamEndEvent):
            raise _Undecided
        return root

    def _node(self, event: Any, level: int) -> Node:
        if isinstance(event, self._events.AliasEvent):
            return self._anchored(event.anchor)
        # Tags are written with other letters in YAML 1.1.
        if event.tag is not None or event.anchor in self._anchors or level > _MOST_LEVELS:
            raise _Undecided
        marks = (event.start_mark, event.end_mark)
        if isinstance(event, self._events.ScalarEvent):
            scalar = self._kinds.ScalarNode(self._tag(event), event.value, *marks, style=event.style or None)
            return self._noted(event, scalar)
        if isinstance(event, self._events.SequenceStartEvent):
            items = self._kinds.SequenceNode("tag:yaml.org,2002:seq", [], *marks)
            self._noted(event, items).value.extend(self._until(self._events.SequenceEndEvent, level))
            return items
        pairs = self._kinds.MappingNode("tag:yaml.org,2002:map", [], *marks)
        pieces = self._until(self._events.MappingEndEvent, level)
        self._noted(event, pairs).value.extend(zip(pieces, pieces, strict=True))
        return pairs

    def _anchored(self, anchor: str) -> Node:
        if anchor not in self._anchors:
            raise _Undecided
        return self._anchors[anchor]

    def _noted(self, event: Any, node: Node) -> Node:
        """A node, from now on known by its anchor: an alias can be inside it."""
        if event.anchor is not None:
            self._anchors[event.anchor] = node
        return node

    def _until(self, end: type, level: int) -> Iterator[Node]:
        """The nodes before an event of a kind."""
        while not isinstance(event := self._next(), end):
            yield self._node(event, level + 1)

    def _tag(self, event: Any) -> Any:
        key = (event.value, event.implicit)
        if key not in self._tags:
            self._tags[key] = self._resolver.resolve(self._kinds.ScalarNode, *key)
        return self._tags[key]
