"""Validators of parts inside of other parts, which are built when such a part occurs in a description.

Pydantic builds the validator of a class together with those of all classes that its fields can hold. A
building can hold each of 150 classes and has a dozen of them, so that three quarters of this work would be
done for nothing. Here the field of a part holds a call in place of a validator: the class builds its own
when it is first called. The JSON Schema of a part has all classes, as without this.
"""

from __future__ import annotations

from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, Final, get_args

from pydantic import BaseModel
from pydantic.json_schema import GenerateJsonSchema
from pydantic_core import PydanticSerializationUnexpectedValue, core_schema

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler
    from pydantic.json_schema import JsonSchemaValue

#: What a serialization passes on to the parts inside of a part.
_WORDS: Final = (
    "mode", "include", "exclude", "by_alias", "exclude_unset", "exclude_defaults", "exclude_none",
    "round_trip",
)  # fmt: skip
#: The class whose own validator is about to be built.
_BUILT: Final[ContextVar[type[BaseModel] | None]] = ContextVar("built", default=None)


def built(part: type[BaseModel], **options: Any) -> bool | None:
    """Build the validator of a class, as `pydantic.BaseModel.model_rebuild` does.

    Parameters
    ----------
    part : type
        The class.
    **options
        Words of `pydantic.BaseModel.model_rebuild`.
    """
    token = _BUILT.set(part)
    try:
        return BaseModel.model_rebuild.__func__(part, **options)  # type: ignore[attr-defined,no-any-return]
    finally:
        _BUILT.reset(token)


def schema_of(part: type[BaseModel], source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
    """Schema of the class that is built, and of each class inside of it a call of its validator.

    Parameters
    ----------
    part : type
        The class.
    source : type
        The same, as pydantic names it.
    handler : callable
        Makes the schema with all fields.
    """
    if _BUILT.get() is part:
        _BUILT.set(None)  # the same class inside of itself is called
        return handler(source)

    kind = part.model_fields.get("kind")
    fields = {} if kind is None else {"kind": core_schema.literal_schema([*get_args(kind.annotation)])}
    inner = core_schema.typed_dict_schema({
        name: core_schema.typed_dict_field(field) for name, field in fields.items()
    })  # fmt: skip
    call = Call(part)
    # Only a union reads the inner schema, for the kind.
    return core_schema.no_info_wrap_validator_function(
        call,
        inner,
        serialization=core_schema.plain_serializer_function_ser_schema(call.serialized, info_arg=True),
    )


class Call:
    """Validation of a part by the validator of its class, and its serialization.

    Parameters
    ----------
    part : type
        The class.
    """

    def __init__(self, part: type[BaseModel]) -> None:
        self.part = part

    def __call__(self, value: Any, _: Any) -> Any:
        """The part that is described by a value."""
        return self.part.__pydantic_validator__.validate_python(value)

    def serialized(self, value: Any, info: core_schema.SerializationInfo) -> Any:
        """A part as its own class writes it."""
        if not isinstance(value, self.part):
            raise PydanticSerializationUnexpectedValue(type(value).__name__)  # a union tries another class
        words = {word: getattr(info, word) for word in _WORDS}
        return value.__pydantic_serializer__.to_python(value, **words)


class PartJsonSchema(GenerateJsonSchema):
    """JSON Schema with all parts inside of a part."""

    def generate_inner(self, schema: Any) -> JsonSchemaValue:
        """The class of a part in place of a call."""
        function = schema.get("function")
        call = function.get("function") if isinstance(function, dict) else None
        if isinstance(call, Call):
            call.part.model_rebuild()
            return super().generate_inner(call.part.__pydantic_core_schema__)
        return super().generate_inner(schema)
