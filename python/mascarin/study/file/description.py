"""The keys of a study file: building, climate, measurements, periods, and the steps of the study."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from mascarin.building.base.names import Name
from mascarin.building.base.part import Part, fault, insist
from mascarin.building.parts.weather import Weather
from mascarin.calibration.base.search_options import WITH_SQUARES, PosteriorName, SlopesName
from mascarin.calibration.base.search_options import MethodName as FitMethod
from mascarin.comfort import ComfortSettings
from mascarin.measurements.sensor import Sensor as Sensor
from mascarin.measurements.sensor import SensorPeriods as SensorPeriods
from mascarin.measurements.sensor import with_output
from mascarin.measurements.time_fields import Duration, Hours, RunStep, Span, Spans, Stretch, Time
from mascarin.sensitivity.base.factors import DistributionName
from mascarin.sensitivity.methods import MethodName
from mascarin.study.file.data_sources import (
    ClimateSource,
    Experiment,
    MeasuredTable,
    Transfer,
    with_shared_table,
)
from mascarin.study.file.field_types import Initial, require_bounds
from mascarin.validation.comparison import METRICS
from mascarin.validation.criteria import Criterion

if TYPE_CHECKING:
    from typing import Self


#: Names of models, metrics and series in the results; variants need other names.
TAKEN: Final = (
    "nominal", "fitted", "unit", "n", *METRICS, "measured_range",
    "measured", "band", "expected", "as described", "observed", "weather", "state",
)  # fmt: skip


class Periods(Part):
    """Parts of the record, in local time of the weather data. The end of a period is not included."""

    warm_up: Span | None = Field(
        None,
        description="Start and end of the warm-up, which is simulated but not compared; the run starts here",
    )
    identification: Spans = Field(
        description="Start and end of the period used to identify the parameters, or a list of such pairs; "
        "one run covers all of them"
    )
    corroboration: Spans | None = Field(
        None,
        description="Start and end of the validation period, or a list of such pairs; by default everything "
        "after the identification",
    )
    exclude: tuple[Stretch, ...] = Field(
        (), description="Days (2013-09-05) and pairs of times that are compared in no period"
    )
    exclude_hours: tuple[Hours, ...] = Field(
        (),
        description='Pairs of hours of the day, such as ["22:00", "06:00"], that are compared in no period',
    )
    end: Time | None = Field(
        None, description="End of the used part of the record; by default the end of the record"
    )


class Quality(Part):
    """Treatment of suspicious values. They are always reported."""

    mask: tuple[
        Literal["stuck", "forward_filled", "interpolated", "copied", "spike", "out_of_range"], ...
    ] = Field(
        ("stuck", "forward_filled", "interpolated", "copied"),
        description="Kinds that are excluded from all comparisons; [] excludes nothing",
    )


class SensitivityPlan(Part):
    """Sensitivity analysis of all parameters with a range; docs/sensitivity.md compares the methods."""

    method: MethodName = Field("spectral", description="Method; all but spectral need SALib")
    replicates: int = Field(8, ge=3, description="Independent repetitions of the design")
    samples: int | None = Field(
        None,
        ge=1,
        description="Size of a replicate: runs (spectral, rbd-fast), base points (sobol), trajectories "
        "(morris); by default what the method needs",
    )
    order: int | None = Field(
        None, ge=1, description="Number of harmonics assigned to a parameter (spectral, rbd-fast)"
    )
    seed: int = Field(1, description="Seed of the random numbers")
    interval: Duration = Field("1h", description="Interval of the analyzed outputs")
    step: RunStep | None = Field(
        None,
        description="Time step of these runs, and of those that derive the effects of all parameters for the "
        "analysis of the residuals, where errors of the model are not estimated; a whole part of the "
        "interval. By default that of the study",
    )
    ranges: dict[str, tuple[float, float]] = Field(
        default_factory=dict, description="Ranges that replace those of the building"
    )
    distributions: dict[str, DistributionName] = Field(
        default_factory=dict, description="Path -> distribution over its range; uniform by default"
    )
    groups: dict[str, tuple[str, ...]] = Field(
        default_factory=dict, description="Name -> paths of parameters that are analyzed as a group"
    )
    only: tuple[str, ...] | None = Field(
        None,
        min_length=1,
        description="Parameters that are varied; by default all with a range. In every path * stands for any "
        "name between two dots, or for a part of one",
    )
    leave_out: tuple[str, ...] = Field((), description="Parameters that are not varied")
    tie: dict[str, Literal["factor", "value"]] = Field(
        default_factory=dict,
        description="Path with * -> how all numbers that it matches vary as one, as in `identification`",
    )


class Free(Part):
    """A parameter to identify."""

    low: float | None = Field(None, description="Lower bound; by default that of the range in the building")
    high: float | None = Field(None, description="Upper bound; by default that of the range in the building")
    prior: float | None = Field(
        None,
        gt=0,
        description="Standard deviation of a normal prior distribution around the value of the building",
    )
    start: float | None = Field(
        None, description="Initial value of the search; by default the value of the building"
    )
    scale: Literal["linear", "log"] = Field(
        "linear", description="Scale of the search; log for parameters that span several decades"
    )
    tie: bool | Literal["factor", "value"] = Field(
        False,
        description="Whether all numbers that a path with * matches vary as one: by a common factor (true or "
        "factor; bounds, prior and start are factors, 1 is the building), or by a common value (value); "
        "false: each varies alone",
    )
    per_experiment: bool = Field(
        False, description="Whether each of several `experiments` has its own value; false: one for all"
    )
    at_bound: str | None = Field(None, description="Why an estimate at a bound would be plausible")
    reference: tuple[float, float] | None = Field(
        None, description="Published values before and after calibration, shown for comparison"
    )


#: What is known of a parameter; None for the defaults.
Stated = Annotated[Free | None, BeforeValidator(require_bounds)]


class DiscrepancyPlan(Part):
    """Errors of the model that no values of the parameters explain."""

    limit: float = Field(
        0.1,
        gt=0,
        le=1,
        description="Largest standard deviation of each part of the error, relative to the measured range "
        "of the sensor in the identification period [-]",
    )
    persistence: Duration = Field(
        "5d",
        description="Correlation time of the errors of days: consecutive days differ less than days of other "
        "weeks will",
    )


class IdentificationPlan(Part):
    """Parameters to identify, and the method."""

    parameters: dict[str, Stated] = Field(
        min_length=1, description="Path -> bounds, prior and more; nothing after the colon for the defaults"
    )
    method: FitMethod = Field("least-squares", description="Method; docs/calibration.md compares the methods")
    slopes: SlopesName = Field(
        "differences",
        description="Derivatives for least squares and the intervals: finite differences, or exact "
        "derivatives of the "
        "engine, which take more time (see docs/calibration.md)",
    )
    starts: int = Field(4, ge=1, description="Starts of least squares and of a coupled GenOpt project")
    sequences: int = Field(
        100,
        ge=1,
        description="Largest number of searches of the other methods; they end when enough of them agree",
    )
    agree: int | None = Field(
        None,
        ge=1,
        description="Number of searches that must reach the same minimum; by default 10 for hooke-jeeves "
        "and 2 for "
        "the others",
    )
    moves: int = Field(500, ge=50, description="Number of moves of the walkers of emcee")
    profiles: bool = Field(False, description="Whether the profile likelihood of every parameter is computed")
    seed: int = Field(1, description="Seed of all random numbers")
    lead: Duration = Field("3d", description="Length of the warm-up before the identification period")
    budget: int | None = Field(None, ge=1, description="Largest number of evaluations of all searches")
    cost: Literal["nll", "sd", "rmse", "rmse_over_range", "cv_rmse"] = Field(
        "nll",
        description="Cost function; least-squares, emcee and priors need nll; cv_rmse is that of ASHRAE "
        "Guideline 14, read as rmse_over_range where a sensor is in degC",
    )
    discrepancy: DiscrepancyPlan | None = Field(
        None,
        description="Errors of the model, estimated together with the parameters: one that repeats at the "
        "same hour of every day and one that changes from day to day; on, with its defaults, unless all "
        "sensors state `offset: 0` or only a `repeatability`",
    )
    posterior: PosteriorName = Field(
        "linearized",
        description="Distribution of parameters and errors: linearized about the estimates, or sampled with "
        "the model itself (see docs/calibration.md)",
    )
    draws: int = Field(500, ge=50, description="Draws of each of the 16 chains of a sampled posterior")
    independent: Duration | None = Field(
        None,
        description="Time after which residuals are considered independent; samples closer together share "
        "the "
        "weight of one sample, so that correlated errors do not outweigh the priors",
    )

    @model_validator(mode="after")
    def _together(self) -> Self:
        if self.cost == "nll":
            return self
        if self.profiles:
            expected = "nll, the likelihood of which profiles are made"
            insist(fault(("profiles",), self.cost, expected, "Write cost: nll, or leave profiles out."))
        if self.method in WITH_SQUARES:
            expected = f"nll, the only cost that {self.method} supports"
            insist(fault(("cost",), self.cost, expected, "Write method: hooke-jeeves, or leave cost out."))
        weighed = [path for path, free in self.parameters.items() if free is not None and free.prior]
        if weighed:
            found = f"{self.cost} and a prior on {weighed[0]}"
            insist(fault(("cost",), found, "nll, which weighs priors", "Write cost: nll, or leave it out."))
        return self


class Limit(Criterion, Part):
    """One limit on one metric, for some or all sensors and periods."""


class PublishedScores(Part):
    """One sensor and period of a publication."""

    sd: float = Field(ge=0.0, description="Standard deviation of the error [degC]")
    max_error: float = Field(description="Error of the largest magnitude, with its sign [degC]")
    max_error_percent: float = Field(description="The same, relative to the measured range [%]")
    mean_error_percent: float = Field(
        description="Mean of the magnitudes, relative to the measured range [%]"
    )


class Influential(Part):
    """An influential parameter of a publication."""

    parameter: str = Field(description="Path of the corresponding parameter")
    symbol: str = Field(description="Its symbol in the publication")
    frequency: int | None = Field(None, ge=1, description="Its frequency in the publication")


class PublishedParameter(Part):
    """A parameter that a publication identified, with its values."""

    symbol: str = Field(description="Its symbol in the publication")
    parameter: str = Field(description="Path of the parameter of this study")
    before: float | str = Field(description="Value before the identification; a text for a law")
    after: float | str = Field(description="Value after the identification; a text for a law")
    unit: str = Field("-", description="Unit of the two values")
    delta_t: float | None = Field(
        None,
        gt=0.0,
        description="The values are gamma for this delta_t, and the parameter is the half-width of the "
        "melting range, 4 delta_t / gamma [K]",
    )


class Publication(Part):
    """Results of a publication, shown beside those of the study."""

    label: str = Field(description="Name in the report")
    note: str = Field(description="What the publication compares with, and limits of the comparison")
    tables: dict[Literal["influential", "parameters", "identification", "corroboration", "blind"], str] = (
        Field(default_factory=dict, description="Its tables with the same layout as tables of the report")
    )
    influential: tuple[Influential, ...] = Field((), description="Its influential parameters")
    parameters: tuple[PublishedParameter, ...] = Field(
        (), description="Its identified parameters, for a table in the form of the publication"
    )
    parameter_note: str = Field("", description="Remark below the title of that table")
    sensors: dict[str, dict[Literal["identification", "corroboration", "blind"], PublishedScores]] = Field(
        description="Sensor -> period -> numbers"
    )


class Variant(Part):
    """Another choice of model."""

    changes: dict[str, Any] = Field(description="Path -> value or part of the building")
    identify: bool = Field(True, description="Whether its parameters are identified")
    candidate: bool = Field(
        False,
        description="Whether it may become the fitted model, which is the one with the lowest cost in the "
        "identification period among all candidates and the building as described",
    )
    alone: bool = Field(False, description="Whether only its own parameters are identified")
    parameters: dict[str, Stated] = Field(
        default_factory=dict,
        description="Path -> bounds of its additional parameters",
    )
    note: str | None = Field(None, description="Description for the report")

    @model_validator(mode="after")
    def _identified(self) -> Self:
        if not self.identify and (self.candidate or self.parameters):
            what = "candidate" if self.candidate else "parameters"
            insist(fault((what,), "identify: false", "identify: true", "A candidate must be identified."))
        if self.alone and not self.parameters:
            insist(fault(("alone",), "no parameters", "parameters: of its own", "Name its parameters."))
        return self


class Alternative(Part):
    """Another form of a part of the model, which replaces the one in the building."""

    changes: dict[str, Any] = Field(
        min_length=1,
        description="Path -> value or part of the building; * stands for any name between two dots, or for "
        "a part of it",
    )
    parameters: dict[str, Stated] = Field(
        default_factory=dict, description="Path -> bounds and prior of its additional parameters"
    )
    note: str | None = Field(None, description="Description for the report")


#: What a part of the model may be: forms by name, or the values of one path.
Alternatives = dict[str, Alternative] | tuple[Any, ...]


class StudyPlan(Part):
    """What is done in a study; the building, the weather and the measurements come beside it."""

    name: str = Field("study", description="Title of the study")
    about: str = Field("", description="A few sentences for the report")
    observed: str = Field(
        "measurement", description="What the data are called: measurement, virtual experiment"
    )
    observed_note: str = Field("", description="What readers of the report must know about the data")
    sensors: dict[Name, Annotated[Sensor, AfterValidator(with_output)]] = Field(
        min_length=1, description="Sensors by name"
    )
    weather: Weather | None = Field(
        None,
        description="Gain, offset and clock of columns of the weather, in place of those of the building",
    )
    step: RunStep = Field(
        "15min",
        description="Time step, or `auto 0.05K every 30min`: steps that are chosen, with a tolerance",
    )
    scheme: Literal["sdirk2", "linearly-implicit", "backward-euler", "apparent-capacity"] = Field(
        "sdirk2", description="Time integration scheme"
    )
    initial: Initial = Field(
        "repeat",
        description="Initial state of a run: its first period repeated until the state converges (repeat), "
        "the first values of the sensors (measured), one temperature everywhere [degC], or temperatures of "
        "zones and surfaces",
    )
    periods: Periods = Field(description="Which part of the record is used for what")
    quality: Quality = Field(default_factory=Quality, description="What to do with suspicious values")
    criteria: tuple[Limit, ...] = Field((), description="Limits on metrics; exit code 1 if one is not met")
    aims: tuple[Limit, ...] = Field(
        (),
        description="Limits that are desired but not required: if one is not met, the report shows the "
        "sources of the remaining error, and the exit code does not change",
    )
    sensitivity: SensitivityPlan | None = Field(
        None, description="Sensitivity analysis of all parameters with a range"
    )
    identification: IdentificationPlan | None = Field(
        None, description="Parameters to identify; without it the building can only be compared"
    )
    reference: Publication | None = Field(
        None, description="Numbers of a publication, shown beside the results"
    )
    variants: dict[str, Variant] = Field(default_factory=dict, description="Other choices of model")
    comfort: dict[Name, ComfortSettings] = Field(
        default_factory=dict,
        description="Zone -> how its comfort is rated, before and after the calibration over the record",
    )
    alternatives: dict[str, Alternatives] = Field(
        default_factory=dict,
        description="Parts of the model whose form is not known: name -> forms beside that of the building, "
        "each with `changes`; or path -> list of values. All are calibrated, weighed by days left out of the "
        "identification, and combined",
    )

    @model_validator(mode="after")
    def _named(self) -> Self:
        insist(
            *(
                fault(("variants", name), f"'{name}'", "another name", "Results use this name already.")
                for name in self.variants
                if name in TAKEN
            )
        )
        return self


class StudyFile(StudyPlan):
    """A study as a file: the plan, and the files of the building, the weather and the measurements."""

    name: str = Field(description="Title of the study")
    building: str = Field(description="Building file; its path starts at the folder of the study")
    set: dict[str, Any] = Field(
        default_factory=dict, description="Path -> value that replaces the one of the building file"
    )
    climate: ClimateSource = Field(description="Weather data")
    measurements: MeasuredTable = Field(
        description="Table of measurements. Keys of the same table that are given for the weather need not "
        "be "
        "repeated, and the other way round; without an entry: the table of the weather"
    )

    transfer: dict[Name, Transfer] = Field(
        default_factory=dict,
        description="Name -> study of another house, season or phase, compared as described and calibrated",
    )

    experiments: dict[Name, Experiment] = Field(
        default_factory=dict,
        description="Name -> data set that is identified together with others, or validated; keys of the "
        "study hold for all, and those of an experiment are merged over them as by `extends`",
    )

    @model_validator(mode="before")
    @classmethod
    def _one_table(cls, data: Any) -> Any:
        return with_shared_table(data)

    @model_validator(mode="before")
    @classmethod
    def _no_building(cls, data: Any) -> Any:
        if isinstance(data, dict) and "surfaces" in data and "building" not in data:
            expected = "a study: building, climate, measurements, sensors, periods, identification"
            remedy = "Run it with 'mascarin run FILE --weather CLIMATE'; a study names a building."
            insist(fault((), "a building", expected, remedy))
        if isinstance(data, dict) and "objectives" in data:
            remedy = "Run it with 'mascarin design FILE -o FOLDER'."
            insist(fault((), "a design study", "a study: measurements, sensors, periods", remedy))
        return data
