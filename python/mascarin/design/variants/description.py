"""The keys of a design file: building, climates, variables, uncertainty, objectives and search."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

from pydantic import Field, StringConstraints, model_validator

from mascarin.building.base.names import Name
from mascarin.building.base.part import Part, fault, insist
from mascarin.design.evaluation.objectives import AnyObjective
from mascarin.measurements.time_fields import RunStep, Shift, Time

if TYPE_CHECKING:
    from typing import Self

#: Keys that name files.
FILE_KEYS: Final = ("building", "epw", "tmy")
#: Names of columns in the tables of results.
RESERVED_NAMES: Final = frozenset(
    {"design", "climate", "sample", "rank", "closure", "outside", "failure", "tied", "tied_before"}
)
#: Designs of one grid; the tables and the page are made of all of them.
MAX_DESIGNS: Final = 100_000

Label = Annotated[str, StringConstraints(min_length=1, max_length=60)]
Paths = Name | tuple[str, ...]


class ClimateFile(Part):
    """Weather of one place, and the period that is simulated there."""

    epw: str | None = Field(None, description="EPW file, or shipped:NAME of a climate of Mascarin")
    tmy: str | None = Field(None, description="TMY3 file")
    check_sun: bool = Field(True, description="Refuse radiation that does not follow the sun of the place")
    shift: Shift | None = Field(None, description="Added to all times of the file, such as -30min")
    start: Time | None = Field(
        None, description="Start: 12-01 or 2023-12-01, local time; by default that of `period`"
    )
    end: Time | None = Field(
        None, description="End, not included: 04-01 or 2023-04-01; by default that of `period`"
    )
    set: dict[str, Any] = Field(
        default_factory=dict,
        description="Path -> value that the building has in this climate only, such as other orientations",
    )

    @model_validator(mode="after")
    def _single_source(self) -> Self:
        keys = [key for key in ("epw", "tmy") if getattr(self, key) is not None]
        if len(keys) != 1:
            insist(fault((), ", ".join(keys) or "nothing", "one of epw, tmy", "Keep exactly one."))
        return self


class Period(Part):
    """The period that is simulated, local time of each climate."""

    start: Time = Field(description="Start, such as 06-01 or 2023-06-01")
    end: Time = Field(description="End, not included")


class Variable(Part):
    """What the designer chooses: numbers, products of a material, or variants of the description."""

    path: str | tuple[str, ...] | None = Field(
        None, description="Path of a number, or several that get the same value; * stands for any name"
    )
    values: tuple[float, ...] = Field((), description="Values to try [unit of the parameter]")
    range: tuple[float, float] | None = Field(
        None, description="Smallest and largest value, instead of values [unit of the parameter]"
    )
    steps: int = Field(5, ge=2, le=1000, description="Number of values of a range in a grid")
    material: str | None = Field(None, description="Material whose product is chosen")
    products: Literal["all"] | tuple[str, ...] = Field(
        "all", description="Products of the library: all, or their names"
    )
    melting: tuple[float, float] | None = Field(
        None, description="Only products that melt between these temperatures [degC]"
    )
    variants: dict[Label, dict[str, Any]] = Field(
        default_factory=dict,
        description="Name -> path -> value: parts of the description; {} is as described",
    )

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        kinds = [key for key in ("path", "material", "variants") if getattr(self, key)]
        if len(kinds) != 1:
            insist(
                fault(
                    (),
                    " and ".join(kinds) or "nothing to choose",
                    "one of path (numbers), material (products), variants (parts of the description)",
                    "Write a variable for each.",
                )
            )
        if self.path and bool(self.values) == (self.range is not None):
            insist(fault((), "a path", "either values or a range beside it", "Write values: [0.3, 0.6]."))
        if self.path is None and (self.values or self.range is not None):
            insist(fault((), "values without a path", "the path of a number", "Add path:."))
        if self.range is not None and not self.range[0] < self.range[1]:
            insist(fault(("range",), str(list(self.range)), "[smallest, largest]", "Swap or correct them."))
        if len(set(self.values)) != len(self.values):
            insist(fault(("values",), "a value twice", "each value once", "Remove one."))
        return self


class Uncertainty(Part):
    """What is not known of the rest: the best designs are compared over samples of these parameters."""

    parameters: tuple[str, ...] = Field(
        min_length=1, description="Paths of uncertain parameters, drawn from their ranges; * for any name"
    )
    samples: int = Field(24, ge=4, le=100_000, description="Samples, the same for all designs")
    designs: int = Field(8, ge=2, le=1000, description="How many of the best designs are compared")
    seed: int = Field(1, ge=0, description="Seed of the random numbers")


class Search(Part):
    """How designs are chosen: all of a grid, or a search."""

    method: Literal["grid", "swarm", "cma", "nsga2"] = Field(
        "grid",
        description="grid: all combinations; swarm: any variables, one objective; cma: ranges only, one "
        "objective; nsga2: any variables, several objectives",
    )
    objectives: tuple[str, ...] = Field(
        (), description="Objectives of nsga2; by default all of them. Others minimize `rank_by`"
    )
    evaluations: int = Field(400, ge=8, le=1_000_000, description="Largest number of designs that are run")
    population: int = Field(24, ge=4, le=10_000, description="Designs that are run at once")
    seed: int = Field(1, ge=0, description="Seed of the random numbers")


class DesignFile(Part):
    """A design study: variables times climates, objectives, and how the best are compared."""

    name: str = Field("design", description="Title of the report")
    about: str = Field("", description="A few sentences for the report")
    building: str = Field(description="Building file, its path starting at the folder of this file")
    climates: dict[Name, ClimateFile] = Field(min_length=1, description="Name -> weather file and period")
    period: Period | None = Field(None, description="Period of all climates; by default the whole files")
    step: RunStep = Field(
        "15min",
        description="Time step, or `auto 0.05K every 1h`: steps that are chosen, with a tolerance",
    )
    scheme: Literal["sdirk2", "linearly-implicit", "backward-euler"] = Field(
        "sdirk2", description="Time-stepping scheme"
    )
    set: dict[str, Any] = Field(default_factory=dict, description="Path -> value for all designs")
    variables: dict[Label, Variable] = Field(min_length=1, description="Name -> what is chosen")
    objectives: dict[Label, AnyObjective] = Field(min_length=1, description="Name -> what is good")
    rank_by: str | None = Field(None, description="Objective of the ranking; by default the first")
    negligible: float = Field(
        0.005,
        ge=0.0,
        lt=1.0,
        description="Part of the best value below which a difference is called a tie, as errors of the "
        "model are larger [-]",
    )
    reference: dict[str, Any] = Field(
        default_factory=dict, description="Path -> value of the design that all are compared with"
    )
    uncertainty: Uncertainty | None = Field(None, description="Uncertainty of the rest")
    search: Search = Field(default_factory=lambda: Search(), description="Grid or search")

    @model_validator(mode="after")
    def _names(self) -> Self:
        for section in ("variables", "objectives"):
            for name in getattr(self, section):
                if name in RESERVED_NAMES:
                    insist(
                        fault(
                            (section, name),
                            f"'{name}'",
                            "a name that no column of the tables has",
                            "Rename it.",
                        )
                    )
        both = set(self.variables) & set(self.objectives)
        if both:
            name = sorted(both)[0]
            insist(
                fault(("objectives", name), f"'{name}' also under variables", "different names", "Rename it.")
            )
        for location, chosen in (
            (("rank_by",), [self.rank_by] if self.rank_by else []),
            (("search", "objectives"), list(self.search.objectives)),
        ):
            for name in chosen:
                if name not in self.objectives:
                    insist(
                        fault(
                            location,
                            f"'{name}'",
                            f"one of the objectives {', '.join(self.objectives)}",
                            "Correct the name.",
                        )
                    )
        return self

    @property
    def ranked_by(self) -> str:
        """The objective of the ranking."""
        return self.rank_by or next(iter(self.objectives))

    @model_validator(mode="before")
    @classmethod
    def _no_other_file(cls, data: Any) -> Any:
        if isinstance(data, Mapping) and "objectives" not in data:
            for key, what, command in (
                ("surfaces", "a building", "mascarin run FILE --weather CLIMATE"),
                ("measurements", "a study", "mascarin study FILE -o FOLDER"),
                ("sensors", "a study", "mascarin study FILE -o FOLDER"),
                ("identification", "a study", "mascarin study FILE -o FOLDER"),
            ):
                if key in data:
                    expected = "a design study: building, climates, variables, objectives"
                    insist(fault((), what, expected, f"Run it with '{command}'."))
        return data
