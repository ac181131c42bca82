"""Bytes as part of a page: small, and as text that HTML takes as it is. `live.js` reads it."""

from __future__ import annotations

import base64
import gzip
from typing import TYPE_CHECKING, Final

import numpy as np
from markupsafe import Markup

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

ALPHABET: Final = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%&()*+-;,=>?@^_`{|}~"
"""Signs of the digits 0 to 84: those of RFC 1924, but a comma for ``<``, which may begin an element."""


def text_of(content: bytes) -> Markup:
    """Bytes packed by gzip, then as text: four bytes are five signs, a sixteenth less than in base 64.

    Parameters
    ----------
    content : bytes
        What is packed. Equal content gives equal text.

    Examples
    --------
    >>> gzip.decompress(base64.b85decode(str(text_of(b"mascarin")).replace(",", "<")))
    b'mascarin'
    """
    packed = gzip.compress(content, 9, mtime=0)
    return Markup(base64.b85encode(packed).decode().replace("<", ","))  # noqa: S704  (signs of ALPHABET)


def planes(channels: Array) -> bytes:
    """Numbers of channels so that gzip packs them tightly, and gives every bit back.

    Neighbours resemble each other, so that the difference of their bits, read as integers, has many zeros in
    front. The first bytes of all differences of a channel stand together, then the second ones, and so on.

    Parameters
    ----------
    channels : ndarray, shape (channels, instants)
        Numbers. [unit of each]

    Examples
    --------
    >>> planes(np.array([[1.0, 1.0, 1.0]])).count(0)
    22
    """
    bits = np.ascontiguousarray(channels, dtype="<f8").view("<u8")
    differences = np.diff(bits, axis=1, prepend=np.zeros((len(bits), 1), "<u8"))
    single = differences.view(np.uint8).reshape(*bits.shape, 8)
    return np.ascontiguousarray(np.moveaxis(single, -1, 1)).tobytes()
