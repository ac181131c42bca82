"""A random generator whose numbers are the same on every machine and in every version."""

from __future__ import annotations

_MULTIPLIER = 0x5DEECE66D
_MASK = (1 << 48) - 1


class Lcg48:
    """Linear congruential generator of 48 bits, the one of the POSIX rand48 family and of Java.

    Parameters
    ----------
    seed : int
        Any integer [-].

    References
    ----------
    Knuth, The Art of Computer Programming, volume 2, section 3.2.1.
    """

    def __init__(self, seed: int) -> None:
        self._state = (seed ^ _MULTIPLIER) & _MASK

    def _bits(self, count: int) -> int:
        """Next `count` random bits, the highest ones of the state."""
        self._state = (self._state * _MULTIPLIER + 0xB) & _MASK
        return self._state >> (48 - count)

    def uniform(self) -> float:
        """Next number in [0, 1) with 53 random bits [-]."""
        return ((self._bits(26) << 27) + self._bits(27)) * 2.0**-53

    def below(self, bound: int) -> int:
        """Next integer in 0..bound-1, without bias [-].

        Parameters
        ----------
        bound : int
            Positive upper limit, excluded [-].
        """
        if bound & (bound - 1) == 0:
            return (bound * self._bits(31)) >> 31
        while True:
            bits = self._bits(31)
            value = bits % bound
            # The last incomplete block of the range would make small values more frequent.
            if bits - value + (bound - 1) < 1 << 31:
                return value
