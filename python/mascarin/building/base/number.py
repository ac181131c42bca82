"""A number of a description: its value, what is known about it, and its quantity.

Every numeric leaf of a description is a :class:`Number`. The :class:`Quantity` in its type annotation
is the one place for unit, meaning, limits and default range; the parser, the JSON Schema, the table of
parameters and the docstrings use it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Final, get_args

from pydantic_core import PydanticCustomError, core_schema

from mascarin.errors import did_you_mean

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic.fields import FieldInfo
    from pydantic.json_schema import JsonSchemaValue

Interval = tuple[float, float]

#: What to do about a number outside its limits.
CHECK_SIGN: Final = "Check sign and unit."
#: A number with a decimal comma.
_COMMA = re.compile(r"[-+]?\d+,\d+")


class Remark(str):
    """In place of a source: why a default was kept, or what a number was derived from; nothing to cite."""

    __slots__ = ()


class Number(float):
    """A float with a range, a source and a quantity.

    Parameters
    ----------
    value : float
        The value, in the unit of its quantity.
    range : tuple of float, optional
        Lowest and highest plausible value; none: the default range of the quantity.
    source : str, optional
        Where the value comes from.
    assumed : bool
        Whether it is an assumption, neither measured nor looked up.
    derived : bool
        Whether Mascarin derived it from the rest of the description because the user did not give it.
    quantity : Quantity, optional
        Unit and meaning; set when the description is checked.

    Examples
    --------
    >>> conductivity = Number(1.75, range=(1.5, 2.0), source="a table")
    >>> conductivity + 0.25, conductivity.range
    (2.0, (1.5, 2.0))
    """

    __slots__ = ("assumed", "derived", "quantity", "range", "source")

    range: Interval | None
    source: str | None
    assumed: bool
    derived: bool
    quantity: Quantity | None

    def __new__(
        cls,
        value: float,
        *,
        range: Interval | None = None,
        source: str | None = None,
        assumed: bool = False,
        derived: bool = False,
        quantity: Quantity | None = None,
    ) -> Number:
        """Make the number."""
        self = super().__new__(cls, value)
        self.range, self.source, self.assumed = range, source, assumed
        self.derived, self.quantity = derived, quantity
        return self

    def of(self, quantity: Quantity) -> Number:
        """The same number as a value of a quantity."""
        return Number(
            self,
            range=self.range,
            source=self.source,
            assumed=self.assumed,
            derived=self.derived,
            quantity=quantity,
        )

    @property
    def structural(self) -> bool:
        """Whether the number changes the structure of the calculation, so that it cannot vary in a run."""
        return self.quantity is not None and isinstance(self.quantity.spread, Fixed)

    @property
    def plausible(self) -> Interval:
        """Lowest and highest plausible value: as given, else by the default of the quantity."""
        if self.range is not None:
            return self.range
        if self.quantity is None:
            return (float(self), float(self))
        return self.quantity.default_range(self)

    def to_plain(self) -> Any:
        """The number as in a file: a word, a plain number, or a mapping with range and source."""
        word = self._word()
        notes: dict[str, Any] = {"value": word or _as_integer(self)}
        if self.quantity is not None:
            notes |= self.quantity.notes()
        if self.range is not None:
            notes["range"] = [_as_integer(end) for end in self.range]
        if self.source is not None and not isinstance(self.source, Remark):
            notes["source"] = str(self.source)
        if self.assumed:
            notes["assumed"] = True
        return notes if len(notes) > 1 else notes["value"]

    def _word(self) -> str | None:
        """The word that the number was given by, if it was."""
        if self.quantity is None or not isinstance(self.source, Remark):
            return None
        return next((word for word, value in self.quantity.words.items() if value == self), None)

    def with_unit(self) -> str:
        """The number with its unit, in six digits."""
        unit = "" if self.quantity is None or self.quantity.unit == "-" else f" {self.quantity.unit}"
        return f"{float(self):g}{unit}"


def _as_integer(value: float) -> float:
    """The value as an integer where it is one."""
    return int(value) if value.is_integer() and abs(value) < 1e15 else float(value)


@dataclass(frozen=True)
class Percent:
    """Default range of a quantity: a percentage of the value to each side."""

    percent: float
    reason: str

    def around(self, value: float) -> Interval:
        """Lowest and highest value."""
        half = abs(value) * self.percent / 100.0
        return (value - half, value + half)

    def schema(self) -> dict[str, Any]:
        """The rule as in the JSON Schema."""
        return {"relative": self.percent / 100.0, "reason": self.reason}


@dataclass(frozen=True)
class Within:
    """Default range of a quantity: a distance to each side of the value, in its unit."""

    half: float
    reason: str

    def around(self, value: float) -> Interval:
        """Lowest and highest value."""
        return (value - self.half, value + self.half)

    def schema(self) -> dict[str, Any]:
        """The rule as in the JSON Schema."""
        return {"absolute": self.half, "reason": self.reason}


@dataclass(frozen=True)
class Span:
    """Default range of a quantity: two fixed ends, widened where the value is outside."""

    low: float
    high: float
    reason: str

    def around(self, value: float) -> Interval:
        """Lowest and highest value."""
        return (min(self.low, value), max(self.high, value))

    def schema(self) -> dict[str, Any]:
        """The rule as in the JSON Schema."""
        return {"low": self.low, "high": self.high, "reason": self.reason}


@dataclass(frozen=True)
class Fixed:
    """No range: the number changes the structure of the calculation, for the given reason."""

    reason: str

    def around(self, value: float) -> Interval:
        """Lowest and highest value: the value."""
        return (value, value)

    def schema(self) -> dict[str, Any]:
        """The rule as in the JSON Schema."""
        return {"structural": True, "reason": self.reason}


@dataclass(frozen=True)
class OnlyGiven:
    """No default range: the number varies only where a range is given, for the given reason."""

    reason: str

    def around(self, value: float) -> Interval:
        """Lowest and highest value: the value."""
        return (value, value)

    def schema(self) -> dict[str, Any]:
        """The rule as in the JSON Schema."""
        return {"only_given": True, "reason": self.reason}


Spread = Percent | Within | Span | Fixed | OnlyGiven


SMALLEST: Final = 1e-12
"""Least distance from a limit that a value must be above. What is closer, such as 5e-324, counts as on it:
products and quotients of such numbers are zero or infinite."""


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Limits outside of which a value has no meaning."""

    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None

    @cached_property
    def lower(self) -> float:
        """Lower end, whether or not it belongs to the interval."""
        return next((x for x in (self.above, self.at_least) if x is not None), -math.inf)

    @cached_property
    def least(self) -> float:
        """Smallest value inside."""
        return self.lower if self.above is None else self.above + SMALLEST

    @cached_property
    def upper(self) -> float:
        """Upper end."""
        return math.inf if self.at_most is None else self.at_most

    def hold(self, value: float) -> bool:
        """Whether a value is inside."""
        return self.lower <= value <= self.upper and (self.above is None or value - self.above >= SMALLEST)

    def clip(self, interval: Interval) -> Interval:
        """Cut an interval to the limits; an open end is approached to a thousandth of the interval."""
        low, high = max(interval[0], self.lower), min(interval[1], self.upper)
        if self.above is not None and low <= self.above:
            low = self.above + 1e-3 * (high - self.above)
        return (low, high)

    def __str__(self) -> str:
        if self.above is None and self.at_least is None and self.at_most is None:
            return ""
        parts = [
            f"above {self.above:g}" if self.above is not None else "",
            f"at least {self.at_least:g}" if self.at_least is not None else "",
            f"at most {self.at_most:g}" if self.at_most is not None else "",
        ]
        return " and ".join(part for part in parts if part)

    def schema(self) -> dict[str, float]:
        """The limits as in the JSON Schema."""
        words = {"exclusiveMinimum": self.above, "minimum": self.at_least, "maximum": self.at_most}
        return {word: value for word, value in words.items() if value is not None}


@dataclass(frozen=True)
class Quantity:
    """Unit and meaning of a number; an annotation of :class:`Number` that pydantic understands.

    Parameters
    ----------
    unit : str
        Unit of the value; ``-`` where there is none.
    description : str
        What the number is.
    spread : Percent, Within, Span, Fixed or OnlyGiven
        The default range and the physical reason for it.
    limits : Limits
        Limits of the value.
    words : mapping of str to float
        Words that may replace a number.
    integer : bool
        Whether only whole numbers have a meaning.
    """

    #: What may stand beside a value.
    KEYS: ClassVar[tuple[str, ...]] = ("value", "range", "source", "assumed")

    unit: str
    description: str
    spread: Spread
    limits: Limits = field(default=Limits())
    words: Mapping[str, float] = field(default_factory=dict, hash=False)
    integer: bool = False

    def notes(self) -> dict[str, Any]:
        """What a file has of the quantity beside the value: nothing, where its key says what it is."""
        return {}

    def default_range(self, value: float) -> Interval:
        """Range of a value for which the user gave none."""
        return self.limits.clip(self.spread.around(float(value)))

    def read(self, raw: object) -> Number:
        """Turn what a description has into a number.

        Raises
        ------
        PydanticCustomError
            If it is no number, is not finite or is outside the limits.
        """
        if isinstance(raw, Number):
            number = raw
        elif isinstance(raw, Mapping):
            number = self._noted(raw)
        else:
            number = self._bare(raw)
        return self._held(number).of(self)

    def _noted(self, raw: Mapping[Any, Any]) -> Number:
        for key in raw:
            if key not in self.KEYS:
                raise problem(f"key '{key}'", f"{', '.join(self.KEYS)}", did_you_mean(str(key), self.KEYS))
        if "value" not in raw:
            raise problem("no value", f"value: {self.expectation}", "Write {value: ..., range: [low, high]}.")
        source, assumed = raw.get("source"), raw.get("assumed", False)
        if not isinstance(source, str | None):
            raise problem(f"source: {shown(source)}", "a text", "Put the source in quotes.")
        if not isinstance(assumed, bool):
            raise problem(f"assumed: {shown(assumed)}", "true or false", "")
        value = self._bare(raw["value"])
        plausible = self._range(raw["range"], value) if raw.get("range") is not None else None
        return Number(value, range=plausible, source=source or value.source, assumed=assumed)

    def _range(self, raw: object, value: float) -> Interval:
        expected = (
            f"range: [low, high] with low < high around {value:g}, each {str(self.limits) or 'a number'}"
        )
        help_ = "Write the lowest and the highest plausible value."
        if not isinstance(raw, list | tuple) or len(raw) != 2:
            raise problem(f"range: {shown(raw)}", expected, help_)
        low, high = (self._held(self._bare(end)) for end in raw)
        if not low < high or not low <= value <= high:
            raise problem(f"range: [{low:g}, {high:g}]", expected, help_)
        return (float(low), float(high))

    def _bare(self, raw: object) -> Number:
        if isinstance(raw, str) and raw in self.words:
            return Number(self.words[raw], source=Remark(f"'{raw}'"))
        if isinstance(raw, bool) or not isinstance(raw, int | float):
            raise problem(shown(raw), self.expectation, self._advice(raw))
        try:
            return raw if isinstance(raw, Number) else Number(raw)
        except OverflowError:
            raise problem("a whole number beyond 1e308", self.expectation, "Check the exponent.") from None

    def _advice(self, raw: object) -> str:
        if isinstance(raw, str) and _COMMA.fullmatch(raw):
            return f"Write decimals with a point: {raw.replace(',', '.')}."
        if isinstance(raw, str) and raw[:1].isdigit():
            return f"Write the bare number; the unit is always {self.unit}."
        if isinstance(raw, str) and self.words:
            return did_you_mean(raw, self.words)
        return "Write a number."

    def _held(self, number: Number) -> Number:
        if not math.isfinite(number):
            raise problem(shown(float(number)), self.expectation, "Write a finite number.")
        if not self.limits.hold(number):
            raise problem(shown(float(number)), self.expectation, CHECK_SIGN)
        if self.integer and not float(number).is_integer():
            raise problem(shown(float(number)), self.expectation, "Round it.")
        return number

    @property
    def expectation(self) -> str:
        """What is expected here, as a phrase."""
        kind = "a whole number" if self.integer else "a number"
        words = f" or one of {', '.join(self.words)}" if self.words else ""
        limits = f" {self.limits}" if str(self.limits) else ""
        return f"{kind}{limits}{self._bracketed()}{words} ({self.description})"

    def _bracketed(self) -> str:
        return f" [{self.unit}]"

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Read the value by :meth:`read`."""
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """The plain form, the form with range and source, and the facts about the quantity."""
        plain: dict[str, Any] = {"type": "integer" if self.integer else "number", **self.limits.schema()}
        words = [{"enum": list(self.words)}] if self.words else []
        return {
            "description": self.description,
            "anyOf": [plain, *words, noted_form(plain, words)],
            "unit": self.unit,
            "default_range": self.spread.schema(),
        }


def noted_form(plain: dict[str, Any], words: Sequence[dict[str, Any]] = ()) -> dict[str, Any]:
    """JSON Schema of a number with range and source, from those of the plain number and of its words."""
    return {
        "type": "object",
        "properties": {
            "value": {"anyOf": [plain, *words], "description": "The value"},
            "range": {
                "type": "array",
                "items": plain,
                "minItems": 2,
                "maxItems": 2,
                "description": "Smallest and largest plausible value",
            },
            "source": {"type": "string", "description": "Where the value comes from"},
            "assumed": {"type": "boolean", "description": "Whether the value is an assumption"},
        },
        "required": ["value"],
        "additionalProperties": False,
    }


def quantity_of(field: FieldInfo) -> Quantity | None:
    """Quantity in the annotation of a numeric field; None for any other field."""
    annotations = [field, *get_args(field.annotation)]
    metadata = [note for annotation in annotations for note in getattr(annotation, "metadata", ())]
    metadata += [note for annotation in annotations for note in getattr(annotation, "__metadata__", ())]
    return next((note for note in metadata if isinstance(note, Quantity)), None)


def problem(actual: str, expected: str, help_: str) -> PydanticCustomError:
    """Make an error with what was found, what was expected and what to do."""
    return PydanticCustomError(
        "input",
        "found {found}; expected {expected}. {help}",
        {"found": actual, "expected": expected, "help": help_},
    )


def shown(raw: object) -> str:
    """A piece of a description, short enough for a message."""
    if raw is None:
        return "nothing"
    text = repr(raw)
    return text if len(text) <= 60 else f"{text[:57]}..."


def is_number(raw: object) -> bool:
    """Whether a piece of a description is one number, plain or with range and source."""
    return isinstance(raw, int | float) or (isinstance(raw, Mapping) and "value" in raw)
