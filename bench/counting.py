"""Instructions and arithmetic of a program, counted by callgrind.

Callgrind counts how often every instruction is executed, objdump says which it is. Additions, subtractions,
multiplications, divisions and square roots of double precision count one for each number in the register;
anything else (moves, comparisons, indices) counts none. Only the program's own code is counted, not that of
the system's libraries.
"""

from __future__ import annotations

import os
import platform
import re
import shutil
import subprocess
import tempfile
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

#: `vaddpd %ymm1,%ymm2,%ymm3`: with one number or as many as a register holds, and in which registers.
_ARITHMETIC = re.compile(r"v?(?:add|sub|mul|div|sqrt)([sp])d\s+(.*)")
_NUMBERS = {"x": 2, "y": 4, "z": 8}


@dataclass(frozen=True)
class Count:
    """Instructions, operations of arithmetic among them, and instructions with those in libraries."""

    instructions: float
    flops: float
    everywhere: float = 0.0

    def less(self, other: Count, shares: int) -> Count:
        """Difference of two counts, divided by a number of shares."""
        return Count(
            (self.instructions - other.instructions) / shares,
            (self.flops - other.flops) / shares,
            (self.everywhere - other.everywhere) / shares,
        )


def at_hand() -> bool:
    """Whether the tools are installed and this module knows the instructions of this processor."""
    known = platform.machine() in ("x86_64", "AMD64")
    return known and all(shutil.which(tool) for tool in ("valgrind", "objdump"))


def disassembled(program: Path) -> dict[int, int]:
    """Address -> operations of double precision, of every instruction of a program that has some."""
    command = ["objdump", "--disassemble", "--no-show-raw-insn", str(program)]
    return operations(subprocess.run(command, check=True, capture_output=True, text=True).stdout)  # noqa: S603


def operations(listing: str) -> dict[int, int]:
    """The same from the text that objdump prints."""
    found = {}
    for line in listing.splitlines():
        address, _, instruction = line.partition(":\t")
        if meant := _ARITHMETIC.match(instruction):
            # Registers of one instruction are of one width; a place in memory does not show it.
            width = re.findall(r"%([xyz])mm", meant[2])[-1]
            found[int(address, 16)] = 1 if meant[1] == "s" else _NUMBERS[width]
    return found


def executed(profile: str, program: str) -> Counter[int]:
    """Address -> number of executions, from the file of callgrind, for one program."""
    counts: Counter[int] = Counter()
    ours = call = False
    for line in profile.splitlines():
        if line.startswith("ob="):
            ours = line.endswith(f"/{program}")
        elif line.startswith("calls="):
            call = True  # the next line has the count of the called function, which is counted there
        elif line.startswith("0x"):
            if ours and not call:
                address, _, count = line.partition(" ")
                counts[int(address, 16)] += int(count)
            call = False
    return counts


def total(profile: str) -> int:
    """Number of executed instructions, libraries included, from the file of callgrind."""
    found = re.search(r"^totals: (\d+)", profile, flags=re.MULTILINE)
    if found is None:
        raise ValueError("callgrind wrote no totals: it did not end as it should")
    return int(found[1])


def count(program: Path, words: list[str], worth: Mapping[int, int], environment: Mapping[str, str]) -> Count:
    """Run a program under callgrind."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "callgrind"
        command = ["valgrind", "--tool=callgrind", "--dump-instr=yes", "--dump-line=no"]
        command += ["--compress-strings=no", "--compress-pos=no", f"--callgrind-out-file={file}"]
        subprocess.run(  # noqa: S603
            [*command, str(program), *words],
            env={**os.environ, **environment},
            check=True,
            capture_output=True,
        )
        profile = file.read_text(encoding="utf-8")
    counts = executed(profile, program.name)
    flops = sum(number * worth.get(address, 0) for address, number in counts.items())
    return Count(sum(counts.values()), flops, total(profile))
