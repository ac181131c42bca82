"""The nodes of a YAML 1.2 text, each with its line.

ruamel.yaml decides what YAML 1.2 is: which texts are valid, and which words are numbers. Its scanner is
written in Python and takes longer than everything else that is done with a description. Nodes are therefore
made by libyaml, the C library behind PyYAML. What libyaml refuses, or could read in another way, ruamel.yaml
reads alone. It is imported when a text has such words: most descriptions have none.
"""

from __future__ import annotations

import re
from functools import cached_property
from string import ascii_letters
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ruamel.yaml import YAML
    from ruamel.yaml.error import MarkedYAMLError, YAMLError
    from ruamel.yaml.nodes import ScalarNode

#: Line ends of YAML 1.1 that are letters in YAML 1.2, the byte order mark, the first letter of directives,
#: tabs, and marks with a comment after them.
_OTHERWISE_READ = ("\x85", "\u2028", "\u2029", "\ufeff", "\n%", "\t", "\r", "|#", ">#")
#: What may stand before a node: a letter before a star makes it a part of a word, as in `wall_*.outside`.
_BEFORE = r"(?:^|[\s,\[\]{}:?\"'-])"
#: Names of anchors with letters that end them in YAML 1.1.
_OTHER_ANCHORS = re.compile(_BEFORE + r"[&*][\w-]*[^\w\s,\]}-]", re.ASCII)
#: Tags, which are written with other letters in YAML 1.1.
_TAGS = re.compile(_BEFORE + "!")
#: Words that are known: decimal numbers, and those that begin with a letter.
_INTEGER = re.compile(r"-?[0-9]+")
_COUNT = re.compile(r"-?(?:0|[1-9][0-9]*)")
_DECIMAL = re.compile(r"-?[0-9]+\.[0-9]*")
_POWER_OF_TEN = re.compile(r"-?[0-9]+(?:\.[0-9]*)?[eE][-+]?[0-9]+")
_LETTERS = frozenset(ascii_letters)
_TRUTHS = {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}
_NAMED = dict.fromkeys(_TRUTHS, "bool") | dict.fromkeys(("null", "Null", "NULL", "~", ""), "null")
#: Words that begin with a digit and are no number and no time, by a letter in them; and dates.
_BEGUN_WITH_DIGIT = re.compile("[1-9].*[a-df-su-yA-DF-SU-Y]")
_DATE = re.compile("[0-9]{4}-[0-9]{2}-[0-9]{2}")
_PREFIX = "tag:yaml.org,2002:"
_COLLECTIONS = {"SequenceNode": "seq", "MappingNode": "map"}
#: Nodes in nodes; the recursion of Python ends below this.
_MOST_LEVELS = 100


class Reader:
    """What ruamel.yaml decides, imported when it is needed."""

    @cached_property
    def yaml(self) -> YAML:
        """A reader in Python of YAML 1.2."""
        from ruamel.yaml import YAML

        return YAML(typ="safe", pure=True)

    @property
    def faults(self) -> tuple[type[MarkedYAMLError], type[YAMLError]]:
        """Errors with a place in the text, and all errors, of a text that is no YAML."""
        from ruamel.yaml.error import MarkedYAMLError, YAMLError

        return MarkedYAMLError, YAMLError


def compose(reader: Reader, text: str) -> Any:
    """Read the nodes of a text.

    Parameters
    ----------
    reader : Reader
        Reads what libyaml does not.
    text : str
        The text of one document.

    Returns
    -------
    Node or None
        The root, of PyYAML or ruamel.yaml; None of an empty text. Nodes have tags by the rules of YAML 1.2,
        and marks with their lines.

    Raises
    ------
    ruamel.yaml.error.YAMLError
        The text is no YAML 1.2.
    RecursionError
        Values are inside each other too often.

    Examples
    --------
    >>> compose(Reader(), "volume: 30").value[0][1].tag
    'tag:yaml.org,2002:int'
    """
    root = _fast(reader, text) if _surely_read(text) else None
    return reader.yaml.compose(text) if root is None else root


def _surely_read(text: str) -> bool:
    """Whether both libraries read what is in a text in the same way."""
    otherwise = text.startswith("%") or any(map(text.__contains__, _OTHERWISE_READ))
    return not otherwise and _OTHER_ANCHORS.search(text) is None and _TAGS.search(text) is None


def _fast(reader: Reader, text: str) -> Any:
    """The root by libyaml; None where ruamel.yaml has to decide."""
    try:
        from yaml.error import YAMLError

        return _composer()(reader, text).get_single_node()
    except (ImportError, AttributeError):  # PyYAML without its C library, or an import that was interrupted
        return None
    except (YAMLError, _Undecided, ValueError):
        return None


class _Undecided(Exception):
    """ruamel.yaml has to decide how a text is read."""


def _composer() -> Any:
    """Class that makes nodes by libyaml, with the tags that ruamel.yaml gives to plain words."""
    from yaml.cyaml import CParser

    class Composer(CParser):  # type: ignore[misc]  # without types
        def __init__(self, reader: Reader, text: str) -> None:
            super().__init__(text)
            self._reader, self._level = reader, 0
            self._known: dict[str, str] = {}

        def descend_resolver(self, _parent: object, _index: object) -> None:
            self._level += 1
            if self._level > _MOST_LEVELS:
                raise _Undecided

        def ascend_resolver(self) -> None:
            self._level -= 1

        def resolve(self, kind: type, value: str | None, implicit: Any) -> str:
            if value is None:
                return f"{_PREFIX}{_COLLECTIONS[kind.__name__]}"
            if not implicit[0]:
                return f"{_PREFIX}str"
            if value in _NAMED:
                return f"{_PREFIX}{_NAMED[value]}"
            if value[:1] in _LETTERS or _BEGUN_WITH_DIGIT.match(value):
                return f"{_PREFIX}str"
            if _INTEGER.fullmatch(value):
                return f"{_PREFIX}int"
            if _DECIMAL.fullmatch(value) or _POWER_OF_TEN.fullmatch(value):
                return f"{_PREFIX}float"
            if _DATE.fullmatch(value):
                return f"{_PREFIX}timestamp"
            if value not in self._known:
                resolver = self._reader.yaml.resolver
                self._known[value] = str(resolver.resolve(_scalar_node(), value, implicit))
            return self._known[value]

    return Composer


def _scalar_node() -> type[ScalarNode]:
    from ruamel.yaml.nodes import ScalarNode

    return ScalarNode


def number_of(reader: Reader, tag: str, text: str) -> Any:
    """The number or truth value that a plain word is.

    Parameters
    ----------
    reader : Reader
        Reads what is not plain.
    tag : str
        ``bool``, ``int`` or ``float``.
    text : str
        The word.

    Raises
    ------
    ValueError, KeyError, IndexError, OverflowError
        The word is none.

    Examples
    --------
    >>> number_of(Reader(), "float", "71e3")
    71000.0
    """
    if tag == "int" and _COUNT.fullmatch(text):
        return int(text)
    if tag == "float" and (_DECIMAL.fullmatch(text) or _POWER_OF_TEN.fullmatch(text)):
        return float(text)
    if tag == "bool" and text in _TRUTHS:
        return _TRUTHS[text]
    node = _scalar_node()(f"{_PREFIX}{tag}", text)
    return getattr(reader.yaml.constructor, f"construct_yaml_{tag}")(node)
