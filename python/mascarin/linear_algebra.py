"""Linear algebra of numpy and scipy on one thread.

The matrices here are small. Two threads that share one wait for each other: on a machine with other work a
factorization of 200 columns then takes a thousand times as long as on one thread.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from threadpoolctl import ThreadpoolController


@contextmanager
def one_thread() -> Iterator[None]:
    """Hold numpy and scipy at one thread; also a decorator of functions.

    Examples
    --------
    >>> import numpy as np
    >>> with one_thread():
    ...     float(np.linalg.det(np.eye(2)))
    1.0
    """
    with _controller().limit(limits=1, user_api="blas"):
        yield


@cache
def _controller() -> ThreadpoolController:
    import scipy.linalg  # noqa: F401 (loads the libraries that the controller finds)
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()
