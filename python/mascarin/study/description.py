"""What a study file says: building, climate, measurements, periods, and what to do with them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag, model_validator

from mascarin.building.initial_state import Degrees, GivenStart
from mascarin.building.names import Name
from mascarin.building.number import problem
from mascarin.building.part import Part, fault, insist
from mascarin.calibration.rules import WITH_SQUARES, SlopesName
from mascarin.calibration.rules import MethodName as FitMethod
from mascarin.errors import InputError, did_you_mean
from mascarin.sensitivity.factors import DistributionName
from mascarin.sensitivity.methods import MethodName
from mascarin.validation.criteria import Criterion

if TYPE_CHECKING:
    from typing import Self


def _duration(text: str) -> str:
    """A length of time that can be read."""
    from mascarin.weather.times import seconds_of

    try:
        seconds_of(text)
    except InputError:
        raise problem(f"'{text}'", "a length of time", "Write 15min, 1h, 2d or 90s.") from None
    return text


def _seconds(given: Any) -> Any:
    """A bare number is a number of seconds."""
    return f"{given}s" if isinstance(given, int | float) and not isinstance(given, bool) else given


def _timezone(text: object) -> object:
    """A time zone that exists."""
    from mascarin.weather.timezones import parse_timezone

    try:
        parse_timezone(text)
    except InputError as error:
        _, _, hint = str(error).rpartition("'. ")
        expected = "an IANA name such as Europe/Paris, or a fixed offset such as UTC+4"
        raise problem(f"'{text}'", expected, hint if hint.startswith("Did") else "") from None
    return text


def _bounds(given: Any) -> Any:
    """Two numbers are bounds that were meant, and are to be written as such."""
    if isinstance(given, list) and len(given) == 2:
        raise problem(str(given), "a mapping", f"Write {{low: {given[0]}, high: {given[1]}}}.")
    if isinstance(given, int | float):
        raise problem(
            str(given), "a mapping", "A value belongs into the building; write {low: , high: } here."
        )
    return given


def _start(given: Any) -> Any:
    """A word that is one of the two."""
    if isinstance(given, str) and given not in ("repeat", "measured"):
        expected = "repeat, measured, a temperature in degC, or a mapping of temperatures"
        raise problem(f"'{given}'", expected, did_you_mean(given, ("repeat", "measured")))
    return given


def _kind_of_start(given: Any) -> str:
    if isinstance(given, str):
        return "word"
    return "given" if isinstance(given, Mapping | GivenStart) else "number"


Initial = Annotated[
    Annotated[Literal["repeat", "measured"], Tag("word")]
    | Annotated[Degrees, Tag("number")]
    | Annotated[GivenStart, Tag("given")],
    Discriminator(_kind_of_start),
    BeforeValidator(_start),
]

#: A local time, ISO 8601, with or without an offset.
Time = str
Span = tuple[Time, Time]
Duration = Annotated[str, BeforeValidator(_seconds), AfterValidator(_duration)]
TimeZone = Annotated[str, BeforeValidator(_timezone)]
Columns = str | tuple[str, ...] | dict[str, Any]

#: Names that the results give to models, metrics and series, so that no variant may bear them.
TAKEN: Final = (
    "nominal", "fitted", "unit", "n", "bias", "sd", "rmse", "mean_error", "max_error", "mean_error_percent",
    "max_error_percent", "measured_range", "measured", "band", "as described", "observed", "weather", "state",
)  # fmt: skip


class Table(Part):
    """A table of measured columns."""

    table: str = Field(description="CSV or Parquet file beside the study, or data:NAME of a known data set")
    timezone: TimeZone = Field(
        description="Time zone that the logger's clock kept: IANA name (Europe/Paris) or offset (UTC+4)"
    )
    stamps: Literal["start", "end"] = Field("start", description="Which end of its interval a stamp marks")
    mean: tuple[str, ...] = Field((), description="Columns that are means over their interval")
    separator: str | None = Field(None, description="Column separator; found when absent")
    decimal: str = Field(".", description="Decimal sign")
    time: str | tuple[str, ...] | None = Field(None, description="Time column or columns; found when absent")
    time_format: str | None = Field(None, description="How stamps are written, as in strptime")
    skip_lines: int = Field(0, ge=0, description="Lines before the header")
    missing: tuple[str | float, ...] = Field((), description="Entries that stand for no value, such as -999")
    fill_gaps: Duration | None = Field(
        None,
        description="Gaps up to this length are filled by straight lines in what drives the model, never in "
        "what it is compared with",
    )
    inspect: tuple[str, ...] = Field(
        (),
        description="Further columns whose quality is judged, though not used; every column of numbers when "
        "absent",
    )

    @property
    def options(self) -> dict[str, Any]:
        """Options that every table reader takes."""
        keys = (
            "timezone",
            "stamps",
            "separator",
            "decimal",
            "time",
            "time_format",
            "skip_lines",
            "mean",
            "missing",
        )
        return {key: getattr(self, key) for key in keys}


class MeasuredWeather(Table):
    """Weather from a measured table."""

    columns: dict[str, Columns] = Field(description="Climate channel -> column")
    absent: tuple[str, ...] = Field((), description="Channels that were not measured and get a neutral value")


class ClimateSource(Part):
    """Where the weather comes from; exactly one kind."""

    epw: str | None = Field(None, description="EPW file")
    tmy: str | None = Field(None, description="TMY3 file")
    measured: MeasuredWeather | None = Field(None, description="A measured table")

    @model_validator(mode="after")
    def _one(self) -> Self:
        given = [key for key in ("epw", "tmy", "measured") if getattr(self, key) is not None]
        if len(given) != 1:
            insist(fault((), ", ".join(given) or "nothing", "one of epw, tmy, measured", "Keep exactly one."))
        return self


class Sensor(Part):
    """A measured series and the model output that stands for it."""

    column: str | tuple[str, ...] = Field(description="Column, or several whose mean is taken")
    output: str = Field(description="Output of the model")
    uncertainty: float = Field(
        0.5, gt=0, description="Half-width of the 95 % band of the sensor [unit of the output]"
    )
    relative: float = Field(
        0.0, ge=0, lt=1, description="Further half-width as a share of the measured value, such as 0.05 [-]"
    )
    label: str | None = Field(None, description="What the report calls it")
    use: bool = Field(True, description="Whether it takes part in the identification")

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns it is made of."""
        return (self.column,) if isinstance(self.column, str) else self.column


class Periods(Part):
    """Which part of the record is for what; local time of the weather. Ends are not included."""

    warm_up: Span | None = Field(
        None, description="Start and end of what is run but not compared; the run starts here"
    )
    identification: Span = Field(description="Start and end of what the parameters are identified on")
    corroboration: Span | None = Field(
        None,
        description="Start and end of what is held back and named; all that follows the identification when "
        "absent",
    )
    end: Time | None = Field(None, description="End of the record to use; its end when absent")


class Quality(Part):
    """What to do with suspicious stretches. They are always reported."""

    mask: tuple[Literal["stuck", "forward_filled", "spike", "out_of_range"], ...] = Field(
        (), description="Kinds that are left out of all comparisons"
    )


class SensitivityPlan(Part):
    """Sensitivity to all parameters that have a range; docs/sensitivity.md says which method when."""

    method: MethodName = Field("spectral", description="Method; all but spectral need SALib")
    replicates: int = Field(8, ge=3, description="Independent repetitions of the design")
    samples: int | None = Field(
        None,
        ge=1,
        description="Size of a replicate: runs (spectral, rbd-fast), base points (sobol), trajectories "
        "(morris); what the method needs when absent",
    )
    order: int | None = Field(
        None, ge=1, description="Harmonics counted as a parameter's own (spectral, rbd-fast)"
    )
    seed: int = Field(1, description="Of the random numbers")
    interval: Duration = Field("1h", description="Spacing of the outputs that are analysed")
    ranges: dict[str, tuple[float, float]] = Field(
        default_factory=dict, description="Ranges that replace those of the building"
    )
    distributions: dict[str, DistributionName] = Field(
        default_factory=dict, description="Path -> distribution over its range; uniform when absent"
    )
    groups: dict[str, tuple[str, ...]] = Field(
        default_factory=dict, description="Name -> paths that are judged together"
    )
    leave_out: tuple[str, ...] = Field((), description="Parameters that stay at their value")


class Free(Part):
    """A parameter to identify."""

    low: float | None = Field(None, description="Lowest value; that of the building's range when absent")
    high: float | None = Field(None, description="Highest value; that of the building's range when absent")
    prior: float | None = Field(
        None, gt=0, description="Standard deviation of a normal prior about the value"
    )
    start: float | None = Field(None, description="Where the search begins; the building's value when absent")
    scale: Literal["linear", "log"] = Field(
        "linear", description="How distances are measured in the search; log for what spans decades"
    )
    at_bound: str | None = Field(None, description="Why an estimate on a bound would be right")
    reference: tuple[float, float] | None = Field(
        None, description="Before and after in a publication, shown beside ours"
    )


#: What is known of a parameter; nothing for the usual.
Stated = Annotated[Free | None, BeforeValidator(_bounds)]


class IdentificationPlan(Part):
    """Which parameters to identify, and how."""

    parameters: dict[str, Stated] = Field(
        min_length=1, description="Path -> what is known of it; nothing after the colon for the usual"
    )
    method: FitMethod = Field("least-squares", description="Optimiser; docs/calibration.md says which when")
    slopes: SlopesName = Field(
        "differences",
        description="Derivatives of least squares and of the intervals: differences of runs side by side, or "
        "exact from the engine, which costs more (docs/calibration.md has numbers)",
    )
    starts: int = Field(4, ge=1, description="Starts of least squares and of a coupled GenOpt project")
    sequences: int = Field(
        100, ge=1, description="Most sequences of the other methods; they end when enough of them agree"
    )
    agree: int | None = Field(
        None,
        ge=1,
        description="Sequences that must have reached the same minimum; 10 for hooke-jeeves and 2 for the "
        "others when absent",
    )
    moves: int = Field(500, ge=50, description="How often the walkers of emcee move")
    profiles: bool = Field(
        False, description="Whether the profile likelihood of every parameter is made and drawn"
    )
    seed: int = Field(1, description="Of all random numbers")
    lead: Duration = Field("3d", description="Run before the identification period starts to be compared")
    budget: int | None = Field(None, ge=1, description="Largest number of evaluations of all sequences")
    cost: Literal["nll", "sd", "rmse", "cv_rmse"] = Field(
        "nll", description="What is minimised; least-squares and emcee know nll only, priors need it"
    )
    independent: Duration | None = Field(
        None,
        description="Time after which residuals of a model count as independent; samples closer together "
        "share one weight, so that priors are not drowned by an error that lasts",
    )

    @model_validator(mode="after")
    def _together(self) -> Self:
        if self.cost == "nll":
            return self
        if self.profiles:
            expected = "nll, the likelihood of which profiles are made"
            insist(fault(("profiles",), self.cost, expected, "Write cost: nll, or leave profiles out."))
        if self.method in WITH_SQUARES:
            expected = f"nll, the only cost that {self.method} knows"
            insist(fault(("cost",), self.cost, expected, "Write method: hooke-jeeves, or leave cost out."))
        weighed = [path for path, free in self.parameters.items() if free is not None and free.prior]
        if weighed:
            found = f"{self.cost} and a prior on {weighed[0]}"
            insist(fault(("cost",), found, "nll, which weighs priors", "Write cost: nll, or leave it out."))
        return self


class Limit(Criterion, Part):
    """One limit on one metric, for some or all sensors and periods."""


class Published(Part):
    """One sensor and period of a publication."""

    sd: float = Field(ge=0.0, description="Standard deviation of the error [degC]")
    max_error: float = Field(description="Largest error, with its sign [degC]")
    max_error_percent: float = Field(description="The same as a share of the measured range [%]")
    mean_error_percent: float = Field(description="Mean of the magnitudes as a share of the range [%]")


class Influential(Part):
    """A parameter that a publication found to matter."""

    parameter: str = Field(description="What stands for it here")
    symbol: str = Field(description="What it is called there")
    frequency: int | None = Field(None, ge=1, description="At which frequency it was heard there")


class Reference(Part):
    """What a publication reached: a scale to read the numbers by, shown beside them."""

    label: str = Field(description="What the report calls it")
    note: str = Field(description="What it was compared with, and what the two can say of each other")
    tables: dict[Literal["influential", "parameters", "identification", "corroboration", "blind"], str] = (
        Field(default_factory=dict, description="Which of its tables ours are laid out after")
    )
    influential: tuple[Influential, ...] = Field((), description="The parameters that matter there")
    sensors: dict[str, dict[Literal["identification", "corroboration", "blind"], Published]] = Field(
        description="Sensor -> period -> numbers"
    )


class Variant(Part):
    """Another choice of model, compared on the blind days."""

    changes: dict[str, Any] = Field(description="Path -> value or part")
    identify: bool = Field(True, description="Whether its parameters are identified too")
    candidate: bool = Field(
        False,
        description="Whether it may become the fitted model: of all candidates and the building as "
        "described, the one with the lowest cost on the identification period does",
    )
    alone: bool = Field(
        False, description="Whether only its own parameters are identified, all others as in the building"
    )
    parameters: dict[str, Stated] = Field(
        default_factory=dict,
        description="Path -> bounds of what it adds to the identification; what it has not is left out",
    )
    note: str | None = Field(None, description="What it is")

    @model_validator(mode="after")
    def _identified(self) -> Self:
        if not self.identify and (self.candidate or self.parameters):
            what = "candidate" if self.candidate else "parameters"
            insist(fault((what,), "identify: false", "identify: true", "A candidate has to be identified."))
        if self.alone and not self.parameters:
            insist(fault(("alone",), "no parameters", "parameters: of its own", "Name what is identified."))
        return self


class StudyFile(Part):
    """A study: compare, find what matters, identify, compare again, corroborate."""

    name: str = Field(description="Title of the study")
    about: str = Field("", description="A few sentences for the report")
    observed: str = Field(
        "measurement", description="What the data are called: measurement, virtual experiment"
    )
    observed_note: str = Field("", description="What whoever reads the numbers must know of the data")
    building: str = Field(description="Building file, beside the study")
    set: dict[str, Any] = Field(
        default_factory=dict, description="Path -> value, on top of the building file"
    )
    climate: ClimateSource = Field(description="The weather")
    measurements: Table = Field(description="The measured table")
    sensors: dict[Name, Sensor] = Field(min_length=1, description="Sensors by name")
    step: Duration = Field("15min", description="Time step")
    scheme: Literal["sdirk2", "backward-euler", "apparent-capacity"] = Field("sdirk2", description="Scheme")
    initial: Initial = Field(
        "repeat",
        description="State that a run starts from: its first day repeated until it settles (repeat), the "
        "first values of the sensors (measured), one temperature everywhere [degC], or those that are given",
    )
    periods: Periods = Field(description="Which part of the record is for what")
    quality: Quality = Field(default_factory=lambda: Quality(mask=()), description="Suspicious stretches")
    criteria: tuple[Limit, ...] = Field((), description="Limits on metrics; exit 1 when one is missed")
    aims: tuple[Limit, ...] = Field(
        (),
        description="Limits that one would like to reach: where one is missed the report says what would "
        "take the rest of the error away, and nothing fails",
    )
    sensitivity: SensitivityPlan | None = Field(None, description="Which parameters matter")
    identification: IdentificationPlan | None = Field(
        None, description="Which parameters to identify; without it the building can only be compared"
    )
    reference: Reference | None = Field(None, description="Numbers of a publication, shown as a scale")
    variants: dict[str, Variant] = Field(default_factory=dict, description="Other model choices")

    @model_validator(mode="before")
    @classmethod
    def _no_building(cls, data: Any) -> Any:
        if isinstance(data, dict) and "surfaces" in data and "building" not in data:
            expected = "a study: building, climate, measurements, sensors, periods, identification"
            insist(fault((), "a building", expected, "A study names a building; see docs/your-own-wall.md."))
        return data

    @model_validator(mode="after")
    def _named(self) -> Self:
        insist(
            *(
                fault(("variants", name), f"'{name}'", "another name", "Results use this one already.")
                for name in self.variants
                if name in TAKEN
            )
        )
        return self


def read_study(path: str | Path) -> StudyFile:
    """Read a study file.

    Raises
    ------
    InputError
        File, line, path, what was found, what was expected, what to do.
    """
    from mascarin.building.reading import read

    return read(path, StudyFile, "a study")
