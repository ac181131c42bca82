"""Linear algebra of numpy and scipy on one thread, and inverses of symmetric matrices.

The matrices here are small. Two threads that share one wait for each other: on a machine with other work a
factorization of 200 columns then takes a thousand times as long as on one thread.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt
    from threadpoolctl import ThreadpoolController

    Array = npt.NDArray[np.float64]


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


def inverted(blocks: Array) -> Array:
    """Invert symmetric matrices (k, n, n).

    Parameters
    ----------
    blocks : ndarray, shape (k, n, n)
        Positive definite.

    Returns
    -------
    ndarray, shape (k, n, n)
        Symmetric.

    Examples
    --------
    >>> import numpy as np
    >>> inverted(np.diag([2.0, 4.0])[None])[0]
    array([[0.5 , 0.  ],
           [0.  , 0.25]])
    """
    from scipy.linalg import lapack

    inverse = np.empty(blocks.shape)
    for k, block in enumerate(blocks):
        root, failed = lapack.dpotrf(block, lower=True)
        lower, singular = lapack.dpotri(root, lower=True) if not failed else (root, failed)
        if failed or singular:  # not positive definite to round-off
            general = np.linalg.inv(block)
            inverse[k] = 0.5 * (general + general.T)
        else:
            inverse[k] = lower + lower.T  # what is above the diagonal was set to zero
            inverse[k].flat[:: len(block) + 1] *= 0.5
    return inverse
