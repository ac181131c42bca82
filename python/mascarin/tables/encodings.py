"""Encodings of text that is neither UTF-8 nor western: Chinese, Japanese and Cyrillic."""

from __future__ import annotations

import re
from typing import Final

_LETTERS: Final = re.compile(rb"[\x80-\xff]+")
_WORDS: Final = re.compile(rb"[A-Za-z\x80-\xff]{3,}")
_WORD: Final = re.compile("[\u3040-\u30ff\u4e00-\u9fff]{2,}")
_SEARCHED: Final = 20_000


def encodings_of(raw: bytes) -> list[str]:
    """Encodings other than western ones that the letters of a text suggest, the likeliest first.

    Letters of western languages stand alone among plain ones. Those of Chinese stand in pairs of bytes above
    160 alone, those of Japanese have bytes that are no letters in Windows-1252, and words of Cyrillic have
    no plain letter.

    Parameters
    ----------
    raw : bytes
        Content of a file.

    Examples
    --------
    >>> [encodings_of(text.encode(code)) for text, code in (
    ...     ("Zeit;Außen °C;Büro °C", "cp1252"), ("时间,温度(℃)", "gb18030"),
    ...     ("日時,気温(℃)", "shift_jis"), ("Дата;Время;Темп", "cp1251"))]
    [[], ['gb18030'], ['shift_jis'], ['cp1251']]
    >>> encodings_of("Room’s T °C, probe’s T °F".encode("cp1252"))
    []
    """
    head = raw[:_SEARCHED]
    runs = _LETTERS.findall(head)
    if not runs:
        return []
    if all(len(run) % 2 == 0 and min(run) > 0xA0 for run in runs) and _reads(head, "gb18030"):
        pairs = sum(len(run) // 2 for run in runs)
        if pairs >= 2 and not _are_cyrillic(head):
            return ["gb18030"]
    if any(0x81 <= byte <= 0x9F for run in runs for byte in run) and _reads(head, "shift_jis"):
        return ["shift_jis"]
    return ["cp1251"] if _are_cyrillic(head) else []


def _reads(head: bytes, code: str) -> bool:
    """Whether a text can be read, with a word of the language in it; its last letter may be cut.

    The apostrophe of Windows-1252 and the letter behind it are one sign of Japanese.
    """
    for end in (len(head), len(head) - 1):
        try:
            return _WORD.search(head[:end].decode(code)) is not None
        except UnicodeDecodeError:
            continue
    return False


def _are_cyrillic(head: bytes) -> bool:
    """Whether most words with a letter above 127 have these letters alone, some of them small ones."""
    words = [word for word in _WORDS.findall(head) if any(byte > 127 for byte in word)]
    cyrillic = [word for word in words if all(byte >= 0xC0 or byte in (0xA8, 0xB8) for byte in word)]
    small = [word for word in cyrillic if sum(byte >= 0xE0 for byte in word) >= len(word) - 1]
    return len(small) >= 2 and len(cyrillic) > 0.6 * len(words)
