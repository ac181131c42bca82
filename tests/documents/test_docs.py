"""What the documentation shows is run.

In each page the fenced blocks are taken in order, in one empty folder and one Python namespace:

- ``python`` is executed;
- ``console``: lines ``$ mascarin ...`` run on the command line and must succeed, and every line
  shown beneath must be in what the command prints (``...`` matches any text);
- ``yaml`` must be YAML.

A comment directly above a fence changes that:

- ``<!-- file: building.yaml -->`` writes the block to that file;
- ``<!-- data: weather/x.epw as site.epw -->`` copies a file from the data folder before the block;
- ``<!-- exit: 2 -->`` says how the command ends;
- ``<!-- not run: reason -->`` leaves the block alone.
"""

from __future__ import annotations

import re
import shlex
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from ruamel.yaml import YAML

from mascarin import cli

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]

_FENCE = re.compile(
    r"(?P<comments>(?:^<!--[^\n]*-->\n+)*)^```(?P<language>\w+)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL
)
_COMMENT = re.compile(r"<!--\s*(?P<key>file|data|exit|not run):\s*(?P<value>.*?)\s*-->")


class Block(NamedTuple):
    line: int
    language: str
    text: str
    marks: dict[str, str]


def blocks(page: Path) -> Iterator[Block]:
    text = page.read_text(encoding="utf-8")
    for found in _FENCE.finditer(text):
        marks = {m["key"]: m["value"] for m in _COMMENT.finditer(found["comments"])}
        line = text.count("\n", 0, found.start("language")) + 1
        yield Block(line, found["language"], found["text"], marks)


def run_console(block: Block, capsys: pytest.CaptureFixture[str]) -> None:
    """Run each ``$ mascarin`` line and compare the lines below it with its output."""
    text = block.text.replace("\\\n", " ")
    for chunk in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        command, *shown = chunk.splitlines()
        program, *words = shlex.split(command)
        if program != "mascarin":
            continue
        capsys.readouterr()
        code = cli.main(words)
        out, err = capsys.readouterr()
        assert code == int(block.marks.get("exit", "0")), f"$ {command}\n{out}{err}"
        printed = {" ".join(line.split()) for line in (out + err).splitlines()}
        for line in shown:
            assert line.strip() in ("", "...") or " ".join(line.split()) in printed, (
                f"{line}\nnot in\n{out}{err}"
            )


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.stem)
def test_page(
    page: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    request: pytest.FixtureRequest,
) -> None:
    monkeypatch.chdir(tmp_path)
    namespace: dict[str, object] = {"__name__": "__main__"}
    for block in blocks(page):
        if "not run" in block.marks:
            assert block.marks["not run"], f"{page.name}:{block.line}: give the reason"
            continue
        if "data" in block.marks:
            source, target = block.marks["data"].split(" as ")
            shutil.copy(request.getfixturevalue("data_dir") / source, target)
        if "file" in block.marks:
            Path(block.marks["file"]).write_text(block.text, encoding="utf-8")
        if block.language == "python":
            # Empty lines in front: a traceback names the line of the page.
            code = compile("\n" * block.line + block.text, str(page), "exec")
            exec(code, namespace)  # noqa: S102
        elif block.language == "console":
            run_console(block, capsys)
        elif block.language == "yaml":
            assert YAML(typ="safe").load(block.text) is not None, f"{page.name}:{block.line}: empty"


def test_links_between_pages_lead_somewhere() -> None:
    for page in PAGES:
        for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
            if "://" not in target:
                assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_the_blocks_of_a_page_are_found(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(
        "# Page\n\n<!-- file: a.yaml -->\n\n```yaml\na: 1\n```\n\n<!-- not run: takes an hour -->\n"
        "```python\nx = 1\n\ny = 2\n```\n",
        encoding="utf-8",
    )
    assert list(blocks(page)) == [
        Block(5, "yaml", "a: 1\n", {"file": "a.yaml"}),
        Block(10, "python", "x = 1\n\ny = 2\n", {"not run": "takes an hour"}),
    ]
