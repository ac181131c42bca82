"""Start of the command line: `mascarin` and ``python -m mascarin``.

Ctrl-C and SIGTERM end the command in one line from its first moment, also while its modules are imported.
"""

from __future__ import annotations

import os
import signal
import sys
from types import FrameType
from typing import NoReturn


def main() -> int:
    """Run the command of this process.

    Returns
    -------
    int
        Exit code.
    """
    signal.signal(signal.SIGINT, _end)
    signal.signal(signal.SIGTERM, _end)
    # Pydantic would look for plugins in all packages that are installed: a command uses none.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    from mascarin.cli import main as run  # sets handlers of its own

    return run()


def _end(number: int, _frame: FrameType | None) -> NoReturn:
    """End the process; nothing has been begun that could be lost."""
    terminated = number == signal.SIGTERM
    os.write(2, b"terminated\n" if terminated else b"interrupted\n")
    os._exit(143 if terminated else 130)


if __name__ == "__main__":
    sys.exit(main())
