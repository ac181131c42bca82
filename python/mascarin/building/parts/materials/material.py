"""Materials: solids, thermal resistances, phase-change materials."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any, ClassVar, Literal

from pydantic import ConfigDict, Discriminator, Field, Tag, model_validator
from pydantic_core import InitErrorDetails

from mascarin.building import quantities as q
from mascarin.building.base.leaves import leaves
from mascarin.building.base.number import Fixed, Number
from mascarin.building.base.part import Part, fault, insist, written_value
from mascarin.building.parts.materials import phase_change_checks as rules
from mascarin.building.parts.materials.melting import Melting
from mascarin.building.parts.materials.phase_change import (
    CapacityLaw,
    FractionLaw,
    FractionsLaw,
    Hysteresis,
    Law,
    TableLaw,
)
from mascarin.building.parts.materials.products import DEFAULT_CURVE, expand
from mascarin.building.parts.materials.text_law import ConductivityLaw


class Solid(Part):
    """A material with constant properties.

    Examples
    --------
    >>> concrete = Solid(conductivity=1.75, density=2240, specific_heat=900, source="EN ISO 10456:2007")
    >>> float(concrete.density)
    2240.0
    """

    has_usual_kind: ClassVar[bool] = True
    kind: Literal["solid"] = "solid"
    conductivity: q.Conductivity
    density: q.Density
    specific_heat: q.SpecificHeat
    source: str | None = Field(None, description="Where the properties come from")


class VariableSolid(Part):
    """A material whose conductivity changes with its temperature.

    Examples
    --------
    >>> foam = VariableSolid(conductivity={"formula": "0.023 + 1e-4*T"}, density=35, specific_heat=1400)
    >>> round(float(foam.conductivity), 4)
    0.025
    """

    kind: Literal["variable"] = "variable"
    conductivity: ConductivityLaw = Field(description="Conductivity as a formula of the temperature T [degC]")
    density: q.Density
    specific_heat: q.SpecificHeat
    source: str | None = Field(None, description="Where the properties come from")


class Resistance(Part):
    """A layer with a thermal resistance and without heat capacity, such as an air space.

    Examples
    --------
    >>> air_space = Resistance(resistance=0.15)
    >>> float(air_space.resistance)
    0.15
    """

    kind: Literal["resistance"] = "resistance"
    resistance: q.Resistance
    source: str | None = Field(None, description="Where the value comes from")


def _or_product(schema: dict[str, Any]) -> None:
    """Allow a product of the library, with whatever differs from it, in the JSON Schema."""
    written = dict(schema)
    name = {"type": "string", "description": "Product of the library: 'mascarin materials' lists them"}
    schema.clear()
    schema["anyOf"] = [
        written,
        {"type": "object", "properties": {"product": name}, "required": ["product"]},
    ]


class PhaseChangeMaterial(Melting):
    """A material that melts and freezes; each property may differ between solid and liquid.

    A layer keeps its mass: the density of the solid times the thickness of the layer. The liquid is thicker
    by the ratio of the densities. With `product`, whatever is not given comes from the library
    (`mascarin.materials`).

    Examples
    --------
    >>> board = PhaseChangeMaterial(
    ...     conductivity=[0.22, 0.18],
    ...     density=855,
    ...     specific_heat=[3134, 2833],
    ...     latent_heat=71000,
    ...     melting_temperature=23.4,
    ...     law={"kind": "tanh", "width": 1.0},
    ... )
    >>> board.melting[0] < 23.4 < board.melting[1]
    True
    """

    model_config = ConfigDict(json_schema_extra=_or_product)

    kind: Literal["pcm"] = "pcm"
    product: str | None = Field(None, description="Product of the library that the rest comes from")
    source: str | None = Field(None, description="Where the properties come from")

    @classmethod
    def from_product(cls, product: str, **properties: Any) -> PhaseChangeMaterial:
        """Take a product of the library.

        Parameters
        ----------
        product : str
            Its name; see `mascarin.materials.search`.
        **properties
            What differs from the product, such as ``conductivity=0.2`` or ``law="cooling"``.

        Returns
        -------
        PhaseChangeMaterial
            The material.

        Raises
        ------
        InputError
            If there is no such product, or neither it nor `properties` give a property.

        Examples
        --------
        >>> PhaseChangeMaterial.from_product("RT25HC", law="cooling").melting
        (14.0, 28.0)
        """
        return cls(**{"product": product, **properties})

    @model_validator(mode="before")
    @classmethod
    def _from_library(cls, raw: Any) -> Any:
        """Take what is not given from the product."""
        return expand(raw)

    @model_validator(mode="after")
    def _law_fits(self) -> PhaseChangeMaterial:
        insist(*rules.missing_or_inactive(self), *self._curve_of_nothing())
        insist(*rules.unit_errors(self))
        insist(*rules.falling_enthalpy(self))
        insist(*rules.no_heat_of_crystallisation(self))
        insist(*rules.contradicted_latent_heat(self))
        insist(*rules.crossing_curves(self))
        if self.latent_heat is not None and isinstance(self.law, TableLaw | CapacityLaw):
            self._fill(latent_heat=_only_compared(self.latent_heat))
        return self

    def _curve_of_nothing(self) -> list[InitErrorDetails]:
        laws: dict[tuple[str, ...], Law | FractionLaw] = {("law",): self.law}
        if self.two_curves is not None and self.two_curves.law is not None:
            laws["hysteresis", "law"] = self.two_curves.law
        return [
            fault(
                (*path, "curve"),
                f"'{law.curve}'",
                "none: there is no 'product:' beside it",
                "Remove 'curve:'.",
            )
            for path, law in laws.items()
            # Derived numbers: the law of a material with a product, used in another one.
            if self.product is None
            and isinstance(law, TableLaw | FractionsLaw)
            and law.curve is not None
            and not any(number.derived for _, number, _ in leaves(law))
        ]

    def written(self, *, keep_derived: bool = False) -> dict[str, Any]:
        """Content of a file: the product, and only what differs from it."""
        if self.product is None:
            # A law taken from a material with a product keeps its numbers.
            return super().written(keep_derived=True)
        # What comes from the product is read again, so that it follows when the product is replaced.
        fields: dict[str, Any] = {"product": self.product}
        for key in type(self).model_fields:
            if key in ("kind", "product") or key not in self.model_fields_set:
                continue
            if key == "law":
                value = _beside_product(self.law, DEFAULT_CURVE)
            elif key == "hysteresis" and self.two_curves is not None:
                value = _hysteresis_beside_product(self.two_curves)
            else:
                value = written_value(getattr(self, key))
            if value not in (None, {}):
                fields[key] = value
        return fields


def _hysteresis_beside_product(hysteresis: Hysteresis) -> Any:
    """Content of a file for a hysteresis beside a product, whose cooling curve is that of the product."""
    fields = hysteresis.written()
    if hysteresis.law is not None:
        fields["law"] = _beside_product(hysteresis.law, "cooling")
    return {key: value for key, value in fields.items() if value not in (None, {})}


def _beside_product(law: Law | FractionLaw, usual: str) -> Any:
    """Content of a file for a law beside a product: the whole law, or what differs from the product."""
    if not any(number.derived for _, number, _ in leaves(law)):
        return law.written()
    fields = {key: written_value(getattr(law, key)) for key in law.model_fields_set - {"kind", "curve"}}
    fields = {
        key: value
        for key, value in fields.items()
        if value is not None and not (isinstance(value, list) and None in value)
    }
    curve = law.curve if isinstance(law, TableLaw | FractionsLaw) else None
    if curve in (None, usual):
        return fields
    return {"curve": curve, **fields} if fields else curve


def _only_compared(number: Number) -> Number:
    """Mark a number that the engine does not use."""
    if number.quantity is None:
        return number
    return number.of(
        replace(
            number.quantity,
            spread=Fixed("the table includes it; this value is only a check"),
        )
    )


def _kind(raw: Any) -> str:
    if not isinstance(raw, Mapping):
        return str(getattr(raw, "kind", "solid"))
    conductivity = raw.get("conductivity")
    if "kind" not in raw and isinstance(conductivity, Mapping) and "formula" in conductivity:
        return "variable"
    return "pcm" if raw.get("product") is not None else str(raw.get("kind", "solid"))


Material = Annotated[
    Annotated[Solid, Tag("solid")]
    | Annotated[VariableSolid, Tag("variable")]
    | Annotated[Resistance, Tag("resistance")]
    | Annotated[PhaseChangeMaterial, Tag("pcm")],
    Discriminator(_kind),
]
