"""What can go wrong, as one exception for each exit code of the command line."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class MascarinError(Exception):
    """Root of the errors that Mascarin raises on purpose.

    The text states where (file and line, path in the description, column), what was found, what
    was expected and what to do: it is shown to the user as it stands.
    """

    exit_code: int = 1


class CriterionFailed(MascarinError):
    """The work was done, and its result does not meet a stated criterion."""

    exit_code = 1


class InputError(MascarinError):
    """Something given by the user cannot be used; nothing has been run or written."""

    exit_code = 2


class InUse(InputError):
    """Another process is writing to the same output; nothing has been run or written."""


class SolverError(MascarinError):
    """A calculation did not converge; the text states when, where and with which residual."""

    exit_code = 3


def did_you_mean(name: str, names: Iterable[str], *, known: bool = True) -> str:
    """Sentence that helps with a name that is not known.

    Parameters
    ----------
    name : str
        The name as it was given.
    names : iterable of str
        The names that would have been understood.
    known : bool
        Whether a short list may be given in full: not where the message has it already.

    Returns
    -------
    str
        The closest names, or the whole list where it is short, or an empty string.
    """
    sorted_names = sorted(set(names))
    # What was given may be anything: None, a number.
    close = difflib.get_close_matches(str(name), sorted_names, n=3, cutoff=0.6)
    if close:
        return f"Did you mean {_either(close)}?"
    if known and sorted_names and len(sorted_names) <= 20:
        return f"Known: {', '.join(sorted_names)}."
    return ""


def _either(names: list[str]) -> str:
    quoted = [f"'{name}'" for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} or {quoted[-1]}"
