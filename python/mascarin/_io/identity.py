"""Inputs known by identity: no command writes onto what it has read.

A file that is opened for reading is remembered by device and inode. Hard links, symbolic links, another
spelling of its path and systems that ignore case lead to the same identity. `_io.regular` remembers inputs;
`_io.locks` (before the work) and `_io.atomic` (when a file is put in place) refuse them as outputs.

A command remembers what it has read from its start to its end. In Python, what was read is remembered for the
session, with two exceptions. A file that this session wrote is no input, also when it is read again. A
description is written back over the file of a description (``building.to_yaml``), and results over a file of
results: that is meant. To replace another input, remove it first: what does not exist has no identity.
"""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from mascarin.errors import InputError

DESCRIPTION: Final = "description"
"""What is written back over its own file in Python: a building or a study."""
RESULTS: Final = "results"
"""What is written back over its own file in Python: series of a run."""

OPTIONS: Final = frozenset({"-o", "--out", "--report", "--epw", "--plot", "--table", "--log"})
"""Options of all commands that name what is written."""

Identity = tuple[int, int]
"""Device and inode."""


@dataclass(eq=False)
class _Register:
    """Files of one command, or of the session.

    Attributes
    ----------
    inputs : dict
        Path and kind of each input, by its identity.
    own_files : dict
        Path of each file that was written here, by its identity.
    outputs : list of Path
        Files that will be written.
    words : tuple of str
        Arguments of the command, which name options; empty in a session.
    command : bool
        Whether it is that of a command.
    """

    inputs: dict[Identity, tuple[Path, str]] = field(default_factory=dict)
    own_files: dict[Identity, Path] = field(default_factory=dict)
    outputs: list[Path] = field(default_factory=list)
    words: tuple[str, ...] = ()
    command: bool = False


# Not a variable of the context: the threads of a command write as well (the page of `explore`).
_registers: Final = [_Register()]


@contextlib.contextmanager
def of_command(words: Sequence[str]) -> Iterator[None]:
    """Remember inputs for one command.

    Parameters
    ----------
    words : sequence of str
        Its arguments, for the options in messages.
    """
    register = _Register(words=tuple(words), command=True)
    _registers.append(register)
    try:
        yield
    finally:
        _registers.remove(register)


def remember(path: Path, kind: str = "") -> None:
    """Remember a file that is about to be read.

    Parameters
    ----------
    path : Path
        The file; nothing happens where there is none.
    kind : str
        `DESCRIPTION`, `RESULTS` or nothing.

    Raises
    ------
    InputError
        It is an output of this command.
    """
    file_id, register = _identity(path), _registers[-1]
    if file_id is None or _path_of(register.own_files, file_id) is not None:
        return
    register.inputs[file_id] = (path.absolute(), kind)
    for output in register.outputs:
        if _identity(output) == file_id:
            require_no_input(output)


def require_no_input(path: Path, kind: str = "") -> None:
    """Refuse to write onto an input.

    Parameters
    ----------
    path : Path
        File to write.
    kind : str
        What is written: `DESCRIPTION`, `RESULTS` or nothing.

    Raises
    ------
    InputError
        It is a file that this command has read, by any name.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "logger.csv"
    >>> size = file.write_text("time,T")
    >>> with of_command(["run", "--weather", str(file), "-o", str(file)]):
    ...     remember(file)
    ...     require_no_input(file)
    Traceback (most recent call last):
    mascarin.errors.InputError: -o: found ...logger.csv, which is an input (--weather); expected ...
    """
    file_id, register = _identity(path), _registers[-1]
    if file_id is None or file_id not in register.inputs:
        return
    source, facts = register.inputs[file_id]
    if _identity(source) != file_id:
        return  # removed or replaced since: the inode belongs to another file now
    if kind and kind == facts and not register.command:
        return
    option, input_option = _option_of_output(path, register.words), _option_of_input(file_id, register.words)
    where = f"{option}: found {path}, which is an input" if option else f"{path}: found an input"
    if input_option:
        where += f" ({input_option})"
    elif source != path.absolute():
        where += f", read as {source}"
    remedy = "choose another name" if register.command else "choose another name, or remove the file first"
    raise InputError(f"{where}; expected another file to write: {remedy}")


def require_no_inputs_in(folder: Path) -> None:
    """Refuse to clean or remove a folder that holds an input.

    Parameters
    ----------
    folder : Path
        A folder of results.

    Raises
    ------
    InputError
        A file that this command has read is inside.
    """
    register = _registers[-1]
    resolved = folder.resolve()
    for file_id, (source, _) in list(register.inputs.items()):
        if source.resolve().is_relative_to(resolved) and _identity(source) == file_id:
            where = _option_of_output(folder, register.words) or str(folder)
            raise InputError(
                f"{where}: found the input {source} in {folder}, where files are replaced; expected a folder "
                "without inputs: choose another one"
            )


@contextlib.contextmanager
def outputs(*files: Path) -> Iterator[None]:
    """Refuse inputs among output files now, and when they are read meanwhile.

    Parameters
    ----------
    files : Path
        Files that will be written.

    Raises
    ------
    InputError
        One is an input.
    """
    for file in files:
        require_no_input(file)
    register = _registers[-1]
    register.outputs.extend(files)
    try:
        yield
    finally:
        for file in files:
            register.outputs.remove(file)


def written(path: Path) -> None:
    """Remember a file that was written here: it is an own file from now on."""
    file_id, register = _identity(path), _registers[-1]
    if file_id is not None:
        register.own_files[file_id] = path.absolute()
        register.inputs.pop(file_id, None)


def _identity(path: Path) -> Identity | None:
    """Device and inode of a regular file, links followed; None where there is none."""
    try:
        facts = os.stat(path)  # noqa: PTH116 - the method of Path raises the same errors, and takes longer
    except (OSError, ValueError):
        return None
    return (facts.st_dev, facts.st_ino) if stat.S_ISREG(facts.st_mode) else None


def _path_of(paths: dict[Identity, Path], identity: Identity) -> Path | None:
    """The path of an identity that still leads to it."""
    path = paths.get(identity)
    return path if path is not None and _identity(path) == identity else None


def _options(words: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Options with their values; arguments without an option have an empty name."""
    before = ""
    for word in words:
        if word.startswith("-") and len(word) > 1:
            name, equals, value = word.partition("=")
            before = "" if equals else word
            if equals:
                yield name, value
        else:
            yield before, word
            before = ""


def _option_of_output(path: Path, words: Sequence[str]) -> str:
    """The option with an output, or with its folder; nothing where it was not given."""
    absolute = path.absolute()
    for name, value in _options(words):
        if name in OPTIONS and "\0" not in value:
            output = Path(value).absolute()
            if output == absolute or output in absolute.parents:
                return name
    return ""


def _option_of_input(identity: Identity, words: Sequence[str]) -> str:
    """The first option with an input; for an argument without an option, its word."""
    for name, value in _options(words):
        if name not in OPTIONS and _identity(Path(value)) == identity:
            return name or value
    return ""
