"""Which classes of EnergyPlus the conversion reads: each is declared by the function that reads it."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, Final, Protocol, TypeVar, cast

_Handler = TypeVar("_Handler", bound=Callable[..., Any])

#: Functions that read a class, by its name in small letters.
HANDLERS: Final[dict[str, list[str]]] = {}


class HasModel(Protocol):
    """A conversion, or a part of it."""

    @property
    def model(self) -> Any:
        """The file, an `IdfModel`."""


def reads(*classes: str) -> Callable[[_Handler], _Handler]:
    """Declare that a function reads classes of EnergyPlus; they count as read once it has been called.

    Looking at a class is not enough: what no handler has read is reported to the user.

    Parameters
    ----------
    *classes : str
        Names of the classes, such as ``Material:NoMass``.

    Returns
    -------
    callable
        Decorator of a function whose first argument has the ``model``.

    Examples
    --------
    >>> @reads("Site:Location")
    ... def latitude(context): ...
    >>> "site:location" in HANDLERS
    True
    """

    def declare(handler: _Handler) -> _Handler:
        for name in classes:
            HANDLERS.setdefault(name.casefold(), []).append(f"{handler.__module__}.{handler.__qualname__}")

        @wraps(handler)
        def handled(context: HasModel, *args: Any, **kwargs: Any) -> Any:
            context.model.count_as_read(classes)
            return handler(context, *args, **kwargs)

        return cast(_Handler, handled)

    return declare
