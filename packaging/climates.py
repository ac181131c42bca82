"""Pack EPW files for the package: ``python packaging/climates.py FILE.epw ...``.

Values of a column are alike and those of a line are not: columns compress a third better than lines. The
bytes that `mascarin.weather.shipped.content` reads from the packed file are those of the EPW file.
"""

from __future__ import annotations

import lzma
import sys
from pathlib import Path

from mascarin.weather.shipped import FOLDER, PACKED, by_rows


def packed(content: bytes) -> bytes:
    """The header of an EPW file, an empty line, and a line for each column; compressed."""
    lines = content.removesuffix(b"\n").split(b"\n")
    columns = zip(*(line.split(b",") for line in lines[8:]), strict=True)
    text = b"\n".join([*lines[:8], b"", *(b",".join(column) for column in columns)])
    if by_rows(text) != content:
        raise SystemExit("not an EPW file of eight lines and a table")
    return lzma.compress(text, preset=9 | lzma.PRESET_EXTREME)


def main() -> None:
    """Pack the files of the command line."""
    for name in sys.argv[1:]:
        target = FOLDER / f"{Path(name).name}{PACKED}"
        target.write_bytes(packed(Path(name).read_bytes()))
        sys.stdout.write(f"{target.name}: {target.stat().st_size / 1e3:.0f} kB\n")


if __name__ == "__main__":
    main()
