from __future__ import annotations

from pathlib import Path

import pytest

from mascarin.errors import InputError
from mascarin.genopt.files.syntax import Block, Report, ordered, read


def parse(folder: Path, text: str, *, lenient: bool = False) -> tuple[Block, Report]:
    path = folder / "a.txt"
    path.write_text(text, encoding="utf-8")
    report = Report(lenient)
    return read(path, report), report


def errors(folder: Path, text: str) -> str:
    """All errors of a file, in one text."""
    try:
        _, report = parse(folder, text)
        report.raise_if_any()
    except InputError as error:
        return str(error)
    return ""


def test_blocks_entries_and_comments(tmp_path: Path) -> None:
    root, report = parse(
        tmp_path,
        '/* first\n */ A { x = 1; // it\'s fine\n B{y="a \\"b\\"\\\\";} z = C:\\dir/f-1.txt; } /* end */\n',
    )
    a = root.block("A")
    assert a is not None
    assert [(e.key, e.value) for e in a.entries] == [("x", "1"), ("z", "C:\\dir/f-1.txt")]
    inner = a.block("B")
    assert inner is not None
    assert inner.entries[0].value == 'a "b"\\'
    assert inner.entries[0].location == f"{tmp_path / 'a.txt'}:3"
    assert not report.errors


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("A { x = 1 }", 1, "expected ';' after the value of 'x', found '}'"),
        ("A {\n x = a b; }", 2, "double quotes"),
        ("A { x = 1;\n", 2, "'A' opened in line 1 is not closed"),
        ("A { x = 1; }\n}", 2, "closing brace without an opening one"),
        ('A { x = "abc\n"; }', 1, "string without end on its line"),
        ("A { x = ; }", 1, "'x' has no value"),
        ("A { x = 1; } /* no end", 1, "comment without end"),
        ("A { x = (1); }", 1, "unexpected character '('"),
        ("A { = 1; }", 1, "found '=', expected a keyword"),
    ],
)
def test_syntax_errors_have_their_line(tmp_path: Path, text: str, line: int, message: str) -> None:
    said = errors(tmp_path, text)
    assert message in said
    assert f"a.txt:{line}: " in said


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("A { }\n/* text*/", 2, "no blank before '*/', with which GenOpt does not end"),
        ("/* \n it's */ A { }", 2, "apostrophe in a '/* */' comment"),
    ],
)
def test_comments_that_genopt_cannot_read(tmp_path: Path, text: str, line: int, message: str) -> None:
    said = errors(tmp_path, text)
    assert message in said
    assert f"a.txt:{line}: " in said
    _, report = parse(tmp_path, text, lenient=True)
    assert not report.errors
    assert "accepted beyond GenOpt" in report.notes[0]


def test_an_unquoted_exponent_is_found(tmp_path: Path) -> None:
    root, _ = parse(tmp_path, 'A { x = 1e-3; y = "1e-3"; z = 0.001; }')
    assert [(e.value, e.has_exponent) for e in root.blocks[0].entries] == [
        ("0.001", True),
        ("1e-3", False),
        ("0.001", False),
    ]


def test_order_and_names_of_keys(tmp_path: Path) -> None:
    root, report = parse(tmp_path, "A {\n b = 1;\n a = 2;\n a = 3;\n cc = 4;\n}")
    ordered(root.blocks[0], ["a", "b", "c"], report)
    said = "\n".join(report.errors)
    assert "a.txt:3: 'a' comes after 'b'" in said
    assert "a.txt:4: 'a' is written a second time" in said
    assert "a.txt:5: unknown or unexpected keyword 'cc' in 'A'. Did you mean 'c'?" in said
    assert "a.txt:6: missing specification of 'c'" in said


def test_a_missing_file_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read"):
        read(tmp_path / "none.ini", Report())
