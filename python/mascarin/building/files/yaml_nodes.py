"""The nodes of a YAML 1.2 text, each with its line.

ruamel.yaml decides what YAML 1.2 is: which texts are valid, and which words are numbers. Its scanner is
written in Python and takes longer than everything else that is done with a description. Nodes are therefore
made by libyaml, the C library behind PyYAML. What libyaml refuses, or could read in another way, ruamel.yaml
reads alone.
"""

from __future__ import annotations

import re
from string import ascii_letters
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ruamel.yaml import YAML
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
#: Words that both libraries know: decimal numbers, and those whose first letter makes them text.
_INTEGER = re.compile(r"-?[0-9]+")
_COUNT = re.compile(r"-?(?:0|[1-9][0-9]*)")
_DECIMAL = re.compile(r"-?[0-9]+\.[0-9]*")
_BEGIN_WORDS = frozenset(ascii_letters) - frozenset("tTfFnN")
_PREFIX = "tag:yaml.org,2002:"
_COLLECTIONS = {"SequenceNode": "seq", "MappingNode": "map"}
#: Nodes in nodes; the recursion of Python ends below this.
_MOST_LEVELS = 100


def compose(yaml: YAML, text: str) -> Any:
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
    >>> from ruamel.yaml import YAML
    >>> compose(YAML(typ="safe", pure=True), "volume: 30").value[0][1].tag
    'tag:yaml.org,2002:int'
    """
    root = _fast(yaml, text) if _surely_read(text) else None
    return yaml.compose(text) if root is None else root


def _surely_read(text: str) -> bool:
    """Whether both libraries read what is in a text in the same way."""
    otherwise = text.startswith("%") or any(map(text.__contains__, _OTHERWISE_READ))
    return not otherwise and _OTHER_ANCHORS.search(text) is None and _TAGS.search(text) is None


def _fast(yaml: YAML, text: str) -> Any:
    """The root by libyaml; None where ruamel.yaml has to decide."""
    try:
        from yaml.error import YAMLError

        return _composer()(yaml, text).get_single_node()
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
        def __init__(self, yaml: YAML, text: str) -> None:
            super().__init__(text)
            self._resolver, self._level = yaml.resolver, 0
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
            if not implicit[0] or value[:1] in _BEGIN_WORDS:
                return f"{_PREFIX}str"
            if _INTEGER.fullmatch(value):
                return f"{_PREFIX}int"
            if _DECIMAL.fullmatch(value):
                return f"{_PREFIX}float"
            if value not in self._known:
                self._known[value] = str(self._resolver.resolve(_scalar_node(), value, implicit))
            return self._known[value]

    return Composer


def _scalar_node() -> type[ScalarNode]:
    from ruamel.yaml.nodes import ScalarNode

    return ScalarNode


def number_of(yaml_constructor: Any, tag: str, text: str) -> Any:
    """The number or truth value that a plain word is.

    Parameters
    ----------
    yaml_constructor : ruamel.yaml.constructor.SafeConstructor
        Makes values in Python of YAML 1.2.
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
    >>> from ruamel.yaml import YAML
    >>> number_of(YAML(typ="safe", pure=True).constructor, "float", "71e3")
    71000.0
    """
    if tag == "int" and _COUNT.fullmatch(text):
        return int(text)
    if tag == "float" and _DECIMAL.fullmatch(text):
        return float(text)
    node = _scalar_node()(f"{_PREFIX}{tag}", text)
    return getattr(yaml_constructor, f"construct_yaml_{tag}")(node)
