"""Files for Arrow, which reads them on threads of its own.

A file object of Python needs the interpreter for each read, and to be let go. A thread of Arrow may still
hold one when the interpreter ends: it cannot get the interpreter any more, is ended by it, and the C++
library ends the whole process ("terminate called"). A file that Arrow opens itself needs no interpreter.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mascarin.errors import InputError


@contextlib.contextmanager
def opened(path: Path) -> Iterator[Any]:
    """A file to read, as Arrow opens it itself.

    Parameters
    ----------
    path : Path
        The file. One whose name is no text is opened by Python: Arrow takes no such names.

    Raises
    ------
    InputError
        It is gone: a finished sweep whose table was removed.
    OSError
        It cannot be opened.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "a"
    >>> size = file.write_bytes(b"abc")
    >>> with opened(file) as content:
    ...     content.read()
    b'abc'
    """
    import pyarrow as pa

    if not path.exists():
        raise InputError(
            f"{path}: found no such file; expected what an earlier run wrote there. Run it again into the "
            "same folder"
        )
    try:
        name = str(path)
        name.encode()
    except UnicodeEncodeError:
        with path.open("rb") as file:
            yield file
        return
    with pa.OSFile(name, "rb") as file:
        yield file
