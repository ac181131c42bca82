"""Files that Mascarin writes for itself: sealed, bounded, and confined to their folder.

A sealed file begins with its kind, the version of Mascarin and a hash of its content. What is damaged, cut,
of another kind or of another version has no content: a cache is computed again, a result of the user is
refused with a remedy. Contents are JSON and arrays of numbers; nothing is unpickled, and no name in a file
is imported. Lengths are compared with the length of the file before memory is taken for them.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import stat
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import TYPE_CHECKING, Any, Final

from mascarin import __version__
from mascarin._io import atomic, memory
from mascarin.errors import InputError

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Array = npt.NDArray[Any]

_MAGIC: Final = b"mascarin own file 1\n"
_HASH: Final = 32
_WORD: Final = 8
#: Length of the lines with kind and version. [B]
_LONGEST: Final = 200
#: Kinds of numbers in an array: truth values, whole and floating-point numbers, text, times and spans.
_NUMBERS: Final = frozenset("?bBhHiIlLqQefdUmM")
#: Longest text of an array of texts. [characters]
_LONGEST_TEXT: Final = 100_000
#: Largest whole number of an own file: larger ones are no floats.
_MAX_INTEGER: Final = 10**300
#: Nesting of JSON. Results of a study have about 10 levels.
DEEPEST: Final = 64


class DamagedError(ValueError):
    """An own file that cannot be used: damaged, cut, of another kind or of another version."""


def sealed(kind: str, content: bytes) -> bytes:
    """A content with its header.

    Parameters
    ----------
    kind : str
        What it is, one line.
    content : bytes
        The content.
    """
    head = f"{kind}\n{__version__}\n".encode()
    return _MAGIC + head + _digest(head, content) + content


def opened(kind: str, sealed: bytes) -> bytes:
    """The content of a sealed file.

    Parameters
    ----------
    kind : str
        What is expected.
    sealed : bytes
        The file.

    Raises
    ------
    DamagedError
        It is no such file, of another version, or damaged.

    Examples
    --------
    >>> opened("test", sealed("test", b"abc"))
    b'abc'
    >>> opened("test", sealed("test", b"abc")[:-1])
    Traceback (most recent call last):
    mascarin._io.sealed.own_files.DamagedError: its content is not that which was written
    """
    if not sealed.startswith(_MAGIC):
        raise DamagedError("it has no header of Mascarin")
    first = len(_MAGIC)
    lines = sealed[first : first + _LONGEST].split(b"\n", 2)
    if len(lines) < 3:
        raise DamagedError("its header is cut")
    head = b"\n".join(lines[:2]) + b"\n"
    start = first + len(head)
    content = sealed[start + _HASH :]
    if _digest(head, content) != sealed[start : start + _HASH]:
        raise DamagedError("its content is not that which was written")
    expected = f"{kind}\n{__version__}\n".encode()
    if head != expected:
        raise DamagedError(f"it is of another version or kind ({b', '.join(lines[:2]).decode()})")
    return content


def _digest(head: bytes, content: bytes) -> bytes:
    digest = hashlib.sha256(head)
    digest.update(content)
    return digest.digest()


def read(path: Path, kind: str) -> bytes:
    """The content of a sealed file.

    Raises
    ------
    DamagedError
        There is no such file, or its content cannot be used.
    OSError
        It cannot be read.
    """
    return opened(kind, whole(path))


def write(path: Path, kind: str, content: bytes) -> Path:
    """Write a sealed file; see `atomic.write`."""
    return atomic.write(path, sealed(kind, content))


def whole(path: Path) -> bytes:
    """All bytes of an own file, which is a regular file in its folder and no link out of it.

    Raises
    ------
    DamagedError
        It is a link, a pipe, a device or a folder, or larger than the free memory.
    OSError
        It cannot be read.
    """
    facts = os.lstat(path)
    if not stat.S_ISREG(facts.st_mode):
        raise DamagedError("it is no regular file")
    try:
        memory.require(facts.st_size, f"{path}: the file", "use a part of the file")
    except InputError as error:
        raise DamagedError(str(error)) from None
    return path.read_bytes()


def remove(path: Path) -> None:
    """Remove an own file, or a link in its place; a folder of that name is left."""
    if path.is_symlink() or not path.is_dir():
        path.unlink(missing_ok=True)


def json_of(text: str | bytes, *, finite: bool = False) -> Any:
    """JSON whose nesting is bounded.

    Parameters
    ----------
    text : str or bytes
        The text.
    finite : bool
        Whether NaN, infinities and numbers beyond the largest are refused.

    Raises
    ------
    DamagedError
        It is no JSON, nested too deeply, or a number is not finite or has more than 300 digits.

    Examples
    --------
    >>> json_of("[1, 1e999]", finite=True)
    Traceback (most recent call last):
    mascarin._io.sealed.own_files.DamagedError: it is no JSON (found the number 1e999)
    """
    number = _finite if finite else None
    try:
        content = json.loads(text, parse_constant=number, parse_float=number, parse_int=_integer)
        depth = _depth(content)
    except (ValueError, RecursionError) as error:
        raise DamagedError(f"it is no JSON ({error})") from None
    if depth > DEEPEST:
        raise DamagedError(f"its JSON has {depth} levels")
    return content


def _integer(text: str) -> int:
    """A whole number of JSON, which arithmetic must be able to turn into a float."""
    value = int(text)
    if not -_MAX_INTEGER <= value <= _MAX_INTEGER:
        raise ValueError(f"found the number {text[:20]}... of {len(text)} digits")
    return value


def _finite(text: str) -> float:
    """A number of JSON; Python writes and reads three words that are no numbers."""
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"found the number {text}")
    return value


def _depth(part: Any) -> int:
    """Levels of lists and mappings."""
    depth, level = 0, [part]
    while level:
        level = [
            value
            for item in level
            if isinstance(item, dict | list)
            for value in (item.values() if isinstance(item, dict) else item)
        ]
        depth += 1
    return depth


def read_json(path: Path) -> dict[str, Any]:
    """A mapping in a JSON file without a header, which people read as well.

    Raises
    ------
    DamagedError
        It is no regular file, no JSON or no mapping.
    OSError
        It cannot be read.
    """
    content = json_of(whole(path))
    if not isinstance(content, dict):
        raise DamagedError(f"it holds a {type(content).__name__} instead of a mapping")
    return content


def packed(notes: Any, arrays: Mapping[str, Array]) -> bytes:
    """Notes and arrays as one content.

    Parameters
    ----------
    notes : object
        What JSON can hold.
    arrays : mapping of str to ndarray
        Numbers, texts and times; no objects.

    Raises
    ------
    TypeError
        An array holds something else.
    """
    import numpy as np

    offsets, parts = [], []
    for name, array in arrays.items():
        values = np.ascontiguousarray(array)
        if values.dtype.char not in _NUMBERS:
            raise TypeError(f"{name}: cannot keep an array of {values.dtype}")
        offsets.append([name, values.dtype.newbyteorder("<").str, list(np.shape(array))])
        parts.append(values.astype(values.dtype.newbyteorder("<"), copy=False).tobytes())
    head = json.dumps({"notes": notes, "arrays": offsets}).encode()
    return len(head).to_bytes(_WORD, "little") + head + b"".join(parts)


def unpacked(content: bytes) -> tuple[Any, dict[str, Array]]:
    """Notes and arrays of `packed`.

    Raises
    ------
    DamagedError
        The content is another one; no memory is taken for what it claims.
    """
    last = _WORD + int.from_bytes(content[:_WORD], "little")
    if last > len(content):
        raise DamagedError("it is cut")
    head = json_of(content[_WORD:last])
    if not (isinstance(head, dict) and isinstance(head.get("arrays"), list)):
        raise DamagedError("it has no list of arrays")
    arrays = {}
    for entry in head["arrays"]:
        name, kind, shape = _claimed(entry)
        size = math.prod(shape) * kind.itemsize
        if last + size > len(content):
            raise DamagedError(f"{name}: it claims {size} bytes, which the file does not have")
        arrays[name] = _array(content[last : last + size], kind, shape)
        last += size
    if last != len(content):
        raise DamagedError("it has more bytes than its arrays")
    return head.get("notes"), arrays


def _array(raw: bytes, kind: np.dtype[Any], shape: tuple[int, ...]) -> Array:
    """A copy, which can be changed, as what was computed can be."""
    import numpy as np

    try:
        return np.frombuffer(raw, dtype=kind).reshape(shape).copy()
    except ValueError as error:
        raise DamagedError(str(error)) from None


def _claimed(entry: Any) -> tuple[str, np.dtype[Any], tuple[int, ...]]:
    """Name, kind and shape of an array."""
    import numpy as np

    match entry:
        case [str(name), str(code), list(shape)] if len(code) < 20:
            pass
        case _:
            raise DamagedError("an array has no name, kind and shape")
    if not all(type(size) is int and 0 <= size < 2**48 for size in shape) or len(shape) > 8:
        raise DamagedError(f"{name}: an impossible shape")
    try:
        kind = np.dtype(code)
    except (TypeError, ValueError) as error:
        raise DamagedError(f"{name}: {error}") from None
    if kind.char not in _NUMBERS or not 0 < kind.itemsize <= 4 * _LONGEST_TEXT:
        raise DamagedError(f"{name}: numbers of kind {code}")
    return name, kind, tuple(shape)


def inside(folder: Path, name: object) -> Path | None:
    """The file of a name below a folder; None for a name that leads out of it, links included.

    Parameters
    ----------
    folder : Path
        The folder.
    name : object
        What was read as a name: a relative path with ``/``.

    Examples
    --------
    >>> inside(Path("out"), "../precious/a.txt") is None
    True
    """
    if not isinstance(name, str) or not name or "\0" in name or "\\" in name:
        return None
    parts = PurePosixPath(name)
    if parts.is_absolute() or ".." in parts.parts or PureWindowsPath(name).drive:
        return None
    path = folder / name
    try:
        parent, top = path.parent.resolve(), folder.resolve()
    except (OSError, RuntimeError):  # a circle of links
        return None
    return path if parent.is_relative_to(top) else None


def require_folder(folder: Path, name: str) -> Path:
    """A folder of results below another one, which may not lead elsewhere.

    Parameters
    ----------
    folder : Path
        The folder of all results.
    name : str
        Name of the folder; there may be none.

    Raises
    ------
    InputError
        It is a link out of the folder.
    """
    file = folder / name
    if inside(folder, f"{name}/x") is None:
        raise InputError(
            f"{file}: found a link that leads out of {folder}, expected a folder; remove the link"
        )
    return file


def require(
    entries: Mapping[str, Any], keys: Mapping[str, type | tuple[type, ...]], further: Iterable[str] = ()
) -> None:
    """Refuse a mapping whose values have other types.

    Parameters
    ----------
    entries : mapping
        What was read.
    keys : mapping of str to type
        Type of each value.
    further : iterable of str
        Keys that may be missing.

    Raises
    ------
    DamagedError
        A value is missing, or of another type.
    """
    optional = set(further)
    for key, kind in keys.items():
        if key not in entries:
            if key in optional:
                continue
            raise DamagedError(f"{key}: found nothing")
        value = entries[key]
        kinds = kind if isinstance(kind, tuple) else (kind,)
        # True is a whole number for Python.
        if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
            raise DamagedError(f"{key}: found {type(value).__name__}")
