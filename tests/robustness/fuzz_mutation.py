"""Mutations of files: bytes, lines, words, and the values of YAML descriptions."""

from __future__ import annotations

import copy
import json
import random
import re
from collections.abc import Callable
from typing import Any

from ruamel.yaml import YAML

NUMBERS = (
    "0", "-0", "-1", "1e-300", "1e308", "-1e308", "1e400", "nan", ".nan", "inf", "-.inf", "9" * 400,
    "1e99999", "0x1F", "1_000", "0o17", "2147483648", "9223372036854775808", "-9900", "1e-5", "1e12",
    "5e-324", "",
)  # fmt: skip
WORDS = (
    "~", "null", "true", "!!int abc", "!!float abc", "!!bool 7", "!!binary x", "!!timestamp 0000",
    "!!int 1:2", "*a", "&a 1", "<<", '"\\ud800"', '"\\U00ffffff"', "'", '"', "{", "}", "[", "]", "[[[[",
    "- ", ": ", "#", "0000-01-01", "1500-01-01 00:00", "9999-12-31 24:00", "-0-09-04 00:30:00",
    "2024-02-30", "24:00", "\x00", "\ud7ff", "\ufeff", "\u2028", "%x%", "%", "\\", "../..", "/dev/zero",
    "a" * 300, ";", ",", "\t", "\r", "%YAML 1.1", "[" * 3000, "{a: " * 3000, "- " * 3000, "(" * 3000,
    "-" * 3000, "add(", "%x1%", "!!python/name:os.system", "!x y",
)  # fmt: skip
VALUES: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 1e-300, 1e308, -1e308, 10**400, 10**18, 0.0, -0.0, "", "x", "room", "1e5",
    " ", "nan", [], {}, [[]], [{}], {"x": 1}, [1, 2], ["a", "b"], [0, 0, 0], "0000-01-01", "1500-01-01",
    "a.b", "..", {"value": 1, "range": [2, 1]}, {"value": []}, {"kind": "table"}, [1e308, -1e308],
    "\u0000", "\u2028", 2**63, 1e19,
)  # fmt: skip

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")


def mutated(content: bytes, draw: random.Random) -> bytes:
    """One to four mutations of a text file."""
    for _ in range(draw.choice((1, 1, 1, 2, 4))):
        content = draw.choice(_WAYS)(content, draw)
    return content


def mutated_yaml(text: str, draw: random.Random) -> bytes:
    """Values of a description replaced, removed, moved or repeated; or its text mutated."""
    if draw.random() < 0.4:
        return mutated(text.encode(), draw)
    tree = YAML(typ="safe", pure=True).load(text)
    # Numbers of another size often make a description that can be run; other values are mostly refused.
    way = draw.choice((mutate, _scale))
    for _ in range(draw.choice((1, 1, 2, 3))):
        way(tree, draw)
    written = json.dumps(tree)  # JSON is YAML
    return mutated(written.encode(), draw) if draw.random() < 0.1 else written.encode()


def _places(tree: Any) -> list[tuple[Any, Any]]:
    """Every container of a tree with each of its keys."""
    found = []
    keys = list(tree) if isinstance(tree, dict) else range(len(tree)) if isinstance(tree, list) else ()
    for key in keys:
        found.append((tree, key))
        found += _places(tree[key])
    return found


def mutate(tree: Any, draw: random.Random) -> None:
    """One value of a tree replaced, removed, moved or repeated."""
    places = _places(tree)
    if not places:
        return
    holder, key = draw.choice(places)
    match draw.randrange(6):
        case 0:
            del holder[key]
        case 1:
            other, place = draw.choice(places)
            holder[key] = json.loads(json.dumps(other[place])) if _has(other, place) else None
        case 2 if isinstance(holder, dict):
            holder[draw.choice((*map(str, holder), "x", "kind", "nodes", "a.b", ""))] = copy.deepcopy(
                draw.choice(VALUES)
            )
        case 3 if isinstance(holder, list):
            holder.append(holder[key])
        case 4 if isinstance(holder[key], int | float):
            # A whole number may be larger than any other kind of number.
            factor = draw.choice((-1, 0, 1e-12, 1e12, 10, 0.1))
            holder[key] = holder[key] * (factor if abs(holder[key]) < 1e290 else -1)
        case _:
            holder[key] = copy.deepcopy(draw.choice(VALUES))


def _scale(tree: Any, draw: random.Random) -> None:
    numbers = [
        (holder, key)
        for holder, key in _places(tree)
        if isinstance(holder[key], int | float) and not isinstance(holder[key], bool)
    ]
    if numbers:
        holder, key = draw.choice(numbers)
        factor = 10.0 ** draw.choice((draw.uniform(-0.3, 0.3), draw.uniform(-3.0, 3.0)))
        holder[key] = round(holder[key] * factor) if isinstance(holder[key], int) else holder[key] * factor


def _has(holder: Any, key: Any) -> bool:
    return key in holder if isinstance(holder, dict) else key < len(holder)


def _flip(content: bytes, draw: random.Random) -> bytes:
    if not content:
        return b"\xff"
    changed = bytearray(content)
    for _ in range(draw.choice((1, 1, 3))):
        changed[draw.randrange(len(changed))] = draw.choice(
            (0, 9, 10, 13, 32, 34, 37, 44, 59, 128, 255, draw.randrange(256))
        )
    return bytes(changed)


def _cut(content: bytes, draw: random.Random) -> bytes:
    first, last = sorted(draw.randrange(len(content) + 1) for _ in range(2))
    return content[:first] if draw.random() < 0.3 else content[:first] + content[last:]


def _repeat(content: bytes, draw: random.Random) -> bytes:
    first = draw.randrange(len(content) + 1)
    last = min(first + draw.randrange(200), len(content))
    return content[:last] + content[first:last] + content[last:]


def _number(content: bytes, draw: random.Random) -> bytes:
    text = content.decode("utf-8", errors="replace")
    # Beginnings of files hold heads; every number there should be reached in a few attempts.
    found = list(_NUMBER.finditer(text, 0, draw.choice((400, 4000, len(text)))))
    if not found:
        return content
    one = draw.choice(found)
    return (text[: one.start()] + draw.choice(NUMBERS) + text[one.end() :]).encode()


def _word(content: bytes, draw: random.Random) -> bytes:
    text = content.decode("utf-8", errors="replace")
    found = list(re.finditer(r"[\w.\-:+]+", text[: draw.choice((400, 4000, 40000))]))
    if not found:
        return content
    one = draw.choice(found)
    return (text[: one.start()] + draw.choice(WORDS) + text[one.end() :]).encode("utf-8", "surrogatepass")


def _lines(content: bytes, draw: random.Random) -> bytes:
    lines = content.split(b"\n")
    first, second = draw.randrange(len(lines)), draw.randrange(len(lines))
    match draw.randrange(3):
        case 0:
            lines[first], lines[second] = lines[second], lines[first]
        case 1:
            del lines[first]
        case _:
            lines.insert(first, lines[second])
    return b"\n".join(lines)


_WAYS: tuple[Callable[[bytes, random.Random], bytes], ...] = (
    _flip, _cut, _repeat, _number, _number, _word, _word, _lines,
)  # fmt: skip
