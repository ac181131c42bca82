"""Base of the parts of a description: immutable, no unknown keys, errors with what to do.

Long because everything that all parts share, from their errors to how they are shown, is one class.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn, Self, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic_core import InitErrorDetails, PydanticCustomError, core_schema

from mascarin._io import display
from mascarin.building.base.docstrings import documented, signature_of
from mascarin.building.base.error_texts import explained
from mascarin.building.base.fixed_mapping import fixed
from mascarin.building.base.nested_schema import PartJsonSchema, built, schema_of
from mascarin.building.base.number import (
    CHECK_SIGN,
    Number,
    Quantity,
    is_number,
    noted_form,
    problem,
    quantity_of,
    shown,
)
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from inspect import Signature

    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler, ModelWrapValidatorHandler
    from pydantic._internal._model_construction import ModelMetaclass
    from pydantic.json_schema import JsonSchemaValue
else:
    ModelMetaclass = type(BaseModel)

Location = tuple[int | str, ...]
Result = TypeVar("Result")

#: Names that completion leaves out: those of pydantic, and what only this package uses.
_INTERNALS = frozenset([*dir(BaseModel), "has_usual_kind", "in_short", "written"])
_ONE_LINE = 100  # characters


class PartType(ModelMetaclass):
    """Type of the classes of parts: completion of a class leaves out the names of pydantic as well."""

    def __dir__(self) -> list[str]:
        """Fields and methods, without those of pydantic."""
        names_of_class = {name for kind in self.__mro__ if isinstance(kind, PartType) for name in vars(kind)}
        names = {*names_of_class, *getattr(self, "model_fields", ())} - _INTERNALS
        return sorted(name for name in names if not name.startswith("_"))

    @property
    def __signature__(self) -> Signature:
        """Signature made from the fields, without the kind."""
        return signature_of(getattr(self, "model_fields", {}))

    @__signature__.setter
    def __signature__(self, value: object) -> None:
        """Pydantic gives a class a signature of its own when it is first used: ours stays."""


class Part(BaseModel, metaclass=PartType):
    """A piece of a description: immutable, and without unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", validate_default=True, defer_build=True)

    #: Whether a file may leave out the kind, because no other kind is as usual.
    has_usual_kind: ClassVar[bool] = False
    #: What to write instead, by a key that does not exist here or whose value is often wrong.
    advice: ClassVar[Mapping[str, str]] = {}
    #: Fields with parts or numbers by name, which stand in a file and in paths as keys of the part itself.
    inline: ClassVar[frozenset[str]] = frozenset()

    def __init__(self, /, **fields: Any) -> None:
        try:
            super().__init__(**fields)
        except ValidationError as error:
            raise explained(error, fields, type(self).__name__) from None

    def __setattr__(self, name: str, value: Any) -> None:
        try:
            super().__setattr__(name, value)
        except ValidationError:
            raise InputError(
                f"{type(self).__name__}.{name}: found an assignment, expected none: a part is immutable. "
                "Building.replace and with_values return a building with other values"
            ) from None

    # Without this mark pydantic would call __init__ for every part inside another one.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Give the class a docstring made from its fields."""
        cls.__doc__ = documented(cls.__doc__ or "", cls.model_fields)

    @classmethod
    def model_rebuild(cls, *, _parent_namespace_depth: int = 2, **options: Any) -> bool | None:
        """Build the validator of this class; those of the classes inside of it are built when they occur."""
        return built(cls, _parent_namespace_depth=_parent_namespace_depth + 2, **options)

    @classmethod
    def __get_pydantic_core_schema__(
        cls, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return schema_of(cls, source, handler)

    @classmethod
    def model_json_schema(cls, *words: Any, **options: Any) -> dict[str, Any]:
        """JSON Schema, with all parts that may be inside of this one."""
        usual = {} if len(words) > 2 else {"schema_generator": PartJsonSchema}  # it is the third word
        return super().model_json_schema(*words, **usual | options)

    def to_dict(self) -> dict[str, Any]:
        """Content of a YAML file: mappings, lists, texts and numbers.

        Returns
        -------
        dict
            Only what was given; defaults and what Mascarin derives are left out.
        """
        plain: dict[str, Any] = plain_value(self.written())
        return plain

    def written(self, *, keep_derived: bool = False) -> dict[str, Any]:
        """What was given, as mappings and lists; numbers keep their ranges and sources.

        Parameters
        ----------
        keep_derived : bool
            Whether numbers that Mascarin derived are kept as well.
        """
        fields: dict[str, Any] = {}
        keys = list(type(self).model_fields)
        if "kind" in keys and not self.has_usual_kind:
            fields["kind"] = getattr(self, "kind", None)
        for key in keys:
            if key in self.model_fields_set:
                value = written_value(getattr(self, key), keep_derived=keep_derived)
                if value is not None:
                    fields |= value if key in self.inline else {key: value}
        return fields

    def in_short(self) -> str:
        """The part in a few words, as a row of the part that it belongs to."""
        return str(getattr(self, "kind", None) or type(self).__name__)

    def __dir__(self) -> list[str]:
        """Fields and methods, without those of pydantic."""
        return dir(type(self))

    def __hash__(self) -> int:
        """Equal parts have the same hash, so that buildings can be keys and members of sets."""
        kind = type(self)
        return hash((kind, *(_hashable(getattr(self, key)) for key in kind.model_fields)))

    def __repr__(self) -> str:
        fields = ", ".join(f"{key}={value}" for key, value in self._rows())
        line = f"{type(self).__name__}({fields})"
        return line if len(line) <= _ONE_LINE else f"{line[: _ONE_LINE - 4]}...)"

    def __str__(self) -> str:
        return display.text(type(self).__name__, self._rows())

    def _repr_html_(self) -> str:
        return display.page(type(self).__name__, self._rows())

    def _rows(self) -> list[tuple[str, str]]:
        fields = ((key, getattr(self, key)) for key in type(self).model_fields if key != "kind")
        return [(key, _in_short(value)) for key, value in fields if value is not None]

    @model_validator(mode="wrap")
    @classmethod
    def _explain(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Rewrite the errors of pydantic: found, expected, what to do."""
        try:
            part = handler(data)
        except ValidationError as error:
            raise merged([*cls._explained(error)]) from None
        fixed(part.__dict__)
        return part

    @classmethod
    def _explained(cls, error: ValidationError) -> Iterator[InitErrorDetails]:
        faults = error.errors(include_url=False)
        unknown = {str(fault["loc"][-1]) for fault in faults if fault["type"] == "extra_forbidden"}
        for fault in faults:
            mistyped = fault["type"] == "missing" and did_you_mean(str(fault["loc"][-1]), unknown)
            if not mistyped or not mistyped.startswith("Did you mean"):
                yield InitErrorDetails(
                    type=cls._in_words(dict(fault)), loc=fault["loc"], input=fault.get("input")
                )

    @classmethod
    def _in_words(cls, fault: dict[str, Any]) -> PydanticCustomError:
        context, key, actual = fault.get("ctx", {}), str((*fault["loc"], "")[0]), shown(fault["input"])
        match fault["type"]:
            case "input" if "text_line" in context:
                return text_problem(context)
            case "input":
                plain = context["help"] == CHECK_SIGN
                help_ = cls.advice.get(key, CHECK_SIGN) if plain else context["help"]
                return problem(context["found"], context["expected"], help_)
            case "extra_forbidden":
                names = [name for name in cls.model_fields if name != "kind"]
                help_ = cls.advice.get(key) or did_you_mean(key, names)
                return problem(f"the key '{key}'", "a key that exists here", help_)
            case "union_tag_not_found":
                tags = cls._kinds(key)
                help_ = cls.advice.get(key) or f"Add 'kind: {tags[0]}' or another one."
                return problem(f"{actual}, without a kind", f"a kind: {', '.join(tags)}", help_)
            case "missing" if len(fault["loc"]) == 1:
                return problem("nothing", cls._meaning(key), f"Add '{key}:'.")
            case "missing" | "too_short" | "too_long":
                return problem("another number of items", cls._meaning(key), "Count them.")
            case "union_tag_invalid":
                return _choice(f"kind: {context.get('tag', 'not given')}", context.get("expected_tags", ""))
            case "literal_error":
                return _choice(actual, context["expected"])
            case "model_type" | "model_attributes_type" | "dict_type":
                return problem(actual, "a mapping (key: value)", "Write keys, one per line.")
            case "tuple_type" | "list_type":
                return problem(actual, f"a list: {cls._meaning(key)}", "Write [a, b, ...].")
            case _:
                return problem(actual, _lowered(fault["msg"]), "Correct the value.")

    @classmethod
    def _kinds(cls, key: str) -> list[str]:
        """Kinds of the parts that a field may hold."""
        kinds, pending = [], [getattr(cls.model_fields.get(key), "annotation", None)]
        while pending:
            form = pending.pop(0)
            if isinstance(form, type) and issubclass(form, Part) and "kind" in form.model_fields:
                kinds.append(str(form.model_fields["kind"].default))
            pending += get_args(form)
        return kinds or ["a kind"]

    @classmethod
    def _meaning(cls, key: str) -> str:
        """What a field is for, in words."""
        field = cls.model_fields.get(key)
        if field is None:
            return f"'{key}'"
        quantity = quantity_of(field)
        if quantity is not None:
            return quantity.expectation
        return f"{key} ({field.description})" if field.description else key

    def __getstate__(self) -> dict[Any, Any]:
        """What is pickled: the fields; what was worked out from them is worked out again when needed."""
        state: dict[Any, Any] = super().__getstate__()
        fields = type(self).model_fields
        return {**state, "__dict__": {key: value for key, value in self.__dict__.items() if key in fields}}

    def _fill(self, **values: Any) -> None:
        """Set what the user did not give; only while the part is being made."""
        for name in self.__dict__.keys() - type(self).model_fields.keys():
            del self.__dict__[name]  # a cached property, worked out without these values
        self.__dict__.update(fixed(values))


def cached_on(part: Part, key: str, make: Callable[[], Result]) -> Result:
    """What follows from a part, kept with it as a cached property is: a part is immutable.

    Parameters
    ----------
    part : Part
        The part.
    key : str
        Name of what follows, which is no field.
    make : callable
        Works it out.
    """
    attributes = part.__dict__
    if key not in attributes:
        attributes[key] = make()
    value: Result = attributes[key]
    return value


def _or_list(schema: dict[str, Any]) -> None:
    """Allow the short form of a :class:`Pair` in its JSON Schema."""
    written, values = dict(schema), list(schema["properties"].values())
    schema.clear()
    schema["anyOf"] = [written, {"type": "array", "prefixItems": values, "minItems": 2, "items": False}]


class Pair(Part):
    """Two values of one property, such as those of a solid and a liquid; short form ``[one, other]``."""

    model_config = ConfigDict(json_schema_extra=_or_list)

    @model_validator(mode="before")
    @classmethod
    def _from_list(cls, raw: Any) -> Any:
        if not isinstance(raw, list | tuple):
            return raw
        names = tuple(cls.model_fields)
        if len(raw) != len(names):
            raise problem(f"{len(raw)} values", f"[{', '.join(names)}]", "Write one value for each.")
        return dict(zip(names, raw, strict=True))


def written_value(value: Any, *, keep_derived: bool = False) -> Any:
    """A field as :meth:`Part.written` gives it; None for a number that was derived."""
    if isinstance(value, Number):
        return value if keep_derived or not value.derived else None
    if isinstance(value, Part):
        return value.written(keep_derived=keep_derived)
    if isinstance(value, Mapping):
        pieces = {key: written_value(piece, keep_derived=keep_derived) for key, piece in value.items()}
        return {key: piece for key, piece in pieces.items() if piece is not None}
    if isinstance(value, list | tuple):
        return [written_value(piece, keep_derived=keep_derived) for piece in value]
    return value


def plain_value(value: Any) -> Any:
    """The same without :class:`Number`: plain numbers, or mappings where there is a range or a source."""
    if isinstance(value, Number):
        return value.to_plain()
    if isinstance(value, Mapping):
        pieces = {key: plain_value(piece) for key, piece in value.items()}
        if list(pieces) == ["kind"]:
            return pieces["kind"]
        if "name" in pieces and pieces["name"] == pieces.get("material"):
            del pieces["name"]  # a layer has the name of its material
        return pieces["coefficient"] if list(pieces) == ["kind", "coefficient"] else pieces
    if isinstance(value, list | tuple):
        return [plain_value(piece) for piece in value]
    return value


def _hashable(value: Any) -> Any:
    """A field with mappings and lists replaced; the order of keys has no effect, as in a comparison."""
    if isinstance(value, Mapping):
        return frozenset((key, _hashable(piece)) for key, piece in value.items())
    if isinstance(value, list | tuple):
        return tuple(map(_hashable, value))
    return value


def _in_short(value: Any) -> str:
    """A field in a few words."""
    if isinstance(value, Number):
        return value.with_unit()
    if isinstance(value, Part):
        return value.in_short()
    if isinstance(value, Mapping):
        return ", ".join(map(str, value)) or "none"
    if isinstance(value, tuple):
        joined = ", ".join(_in_short(piece) for piece in value)
        return f"[{joined}]" if len(joined) <= _ONE_LINE else f"{len(value)} values"
    return str(value)


def derived_number(part: type[Part], key: str, value: float, source: str, *, assumed: bool = False) -> Number:
    """Make the value of a field that the user did not give.

    Parameters
    ----------
    part : type of Part
        Class of the part.
    key : str
        Name of the field.
    value : float
        The value. [unit of the field]
    source : str
        What the value is derived from.
    assumed : bool
        Whether it is an assumption and does not follow from the description.

    Raises
    ------
    NotDerivableError
        The value is outside the limits of the field, or no finite number.
    """
    quantity = _quantity(part, key)
    if not math.isfinite(value) or (quantity is not None and not quantity.limits.hold(value)):
        raise NotDerivableError(key, value, source, quantity)
    return Number(value, source=source, assumed=assumed, derived=True, quantity=quantity)


class NotDerivableError(ValueError):
    """A value that follows from the description and cannot be used.

    Parameters
    ----------
    key : str
        Name of the field.
    value : float
        The value. [unit of the field]
    source : str
        What it is derived from.
    quantity : Quantity, optional
        Unit and limits of the field.
    """

    def __init__(self, key: str, value: float, source: str, quantity: Quantity | None) -> None:
        unit = "" if quantity is None or quantity.unit == "-" else f" {quantity.unit}"
        limits = "a finite number" if quantity is None else str(quantity.limits) or "a finite number"
        super().__init__(f"{key}: {value:g}{unit}, {source}; expected {limits}")
        self.path: Location = (key,)
        self.found = f"{value:g}{unit} ({source})"
        meaning = "" if quantity is None else f"{quantity.description}, "
        self.expected = f"{meaning}{limits}"

    def below(self, key: str) -> NotDerivableError:
        """The same error with a key before its path."""
        self.path = (key, *self.path)
        return self

    def at(self, location: Location) -> InitErrorDetails:
        """The error as one of the description."""
        remedy = f"Write '{self.path[-1]}:', or correct what it follows from."
        return fault((*location, *self.path), self.found, self.expected, remedy)


@cache
def _quantity(part: type[Part], key: str) -> Quantity | None:
    return quantity_of(part.model_fields[key])


def merged(faults: list[InitErrorDetails]) -> ValidationError:
    """One exception with several errors of one part."""
    return ValidationError.from_exception_data("description", faults)


def fault(location: Location, actual: str, expected: str, help_: str) -> InitErrorDetails:
    """Describe one error below the part that is being checked."""
    return InitErrorDetails(type=problem(actual, expected, help_), loc=location, input=None)


def text_fault(location: Location, words: Sequence[str], where: tuple[int, int] | None) -> InitErrorDetails:
    """Describe an error inside of a text; `words`: found, expected, help; `where`: line and column."""
    actual, expected, help_ = words
    context: dict[str, Any] = {"found": actual, "expected": expected, "help": help_}
    if where is not None:
        line, column = where
        context |= {"text_line": line, "column": column}
        context["found"] = f"{actual} ({f'line {line}, ' if line > 1 else ''}column {column} of the text)"
    return InitErrorDetails(type=text_problem(context), loc=location, input=None)


def text_problem(context: dict[str, Any]) -> PydanticCustomError:
    """Make an error with what was found, what was expected, what to do, and where in a text."""
    return PydanticCustomError("input", "found {found}; expected {expected}. {help}", context)


def refuse(*faults: InitErrorDetails) -> NoReturn:
    """Raise the errors."""
    raise merged(list(faults))


def insist(*faults: InitErrorDetails) -> None:
    """Raise the errors, if there are any."""
    if faults:
        refuse(*faults)


def _choice(actual: str, options: str) -> PydanticCustomError:
    """Make the error of a word that is none of the options."""
    words = options.replace("'", "").replace(" or ", ", ").split(", ") if options else ["a kind"]
    help_ = did_you_mean(actual.removeprefix("kind: ").strip("'"), words)
    return problem(actual, f"one of {', '.join(words)}" if len(words) > 1 else words[0].lower(), help_)


def _lowered(message: str) -> str:
    text = message.removeprefix("Input should be ")
    return text[:1].lower() + text[1:]


@dataclass(frozen=True)
class Shorthand:
    """Annotation: a mapping may be written as one word, its kind, or as one number.

    Parameters
    ----------
    word : str, optional
        Key that is meant by a single word; none: no single word.
    number : str, optional
        Key that is meant by a single number; none: no single number.
    kind : str, optional
        Kind that a single number implies.
    implied : tuple of (str, str), optional
        A key that only one kind has, and that kind, which need not be written then.
    """

    word: str | None = None
    number: str | None = None
    kind: str | None = None
    implied: tuple[str, str] | None = None

    def expand(self, raw: Any) -> Any:
        """The whole mapping."""
        if self.number is not None and (is_number(raw) or (isinstance(raw, str) and self.word is None)):
            return {self.number: raw} | ({"kind": self.kind} if self.kind else {})
        if self.word is not None and isinstance(raw, str):
            return {self.word: raw}
        if self.implied is not None and isinstance(raw, Mapping) and self.implied[0] in raw:
            return {"kind": self.implied[1], **raw}
        return raw

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Expand first, then validate the mapping."""
        return core_schema.no_info_before_validator_function(self.expand, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Allow the short forms beside the mapping."""
        number, word = {"type": "number"}, {"type": "string"}
        short = [number, noted_form(number)] if self.number is not None else []
        return {"anyOf": [handler(schema), *short, *([word] if self.word is not None else [])]}
