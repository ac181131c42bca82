"""Sensitivity analysis of a building: its parameters as factors, and the simulations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from mascarin._io.arguments import bounds_of, finite_number, mapping_of, names_of
from mascarin._io.durations import seconds_of
from mascarin.building.parameters.set_point_pairs import tied_set_points
from mascarin.building.parameters.ties import expanded, spread
from mascarin.errors import InputError, SolverError
from mascarin.progress import reporting
from mascarin.sensitivity.base.factors import DistributionName, Factor
from mascarin.sensitivity.base.result import Sensitivity
from mascarin.sensitivity.base.runs import Collector, batches
from mascarin.sensitivity.methods import MethodName, collector, plan
from mascarin.simulation.checks.formula_laws import member_range_warnings
from mascarin.simulation.checks.judgement import ensemble_warnings
from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind
from mascarin.simulation.nominal import of_nominal
from mascarin.simulation.preparation.options import described, require_precision
from mascarin.simulation.preparation.prepare import in_climate
from mascarin.simulation.run_warnings import of_base
from mascarin.simulation.simulation import Simulation
from mascarin.simulation.single_precision import differences, members_to_check

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.progress import ProgressOption
    from mascarin.sensitivity.methods import Plan
    from mascarin.simulation.preparation.initial import Initial
    from mascarin.simulation.preparation.options import Precision, Scheme, TimeLike
    from mascarin.simulation.preparation.run_results import EnsembleRun
    from mascarin.weather import Climate, Measurements

    Array = npt.NDArray[np.float64]

Vary = Sequence[str] | Mapping[str, tuple[float, float] | None]
"""What varies: paths, or path -> (low, high); None for the range of the building."""

_T = TypeVar("_T")
_BATCH = 256


def factors_of(
    building: Building,
    *,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    distributions: Mapping[str, DistributionName] | None = None,
    groups: Mapping[str, Sequence[str]] | None = None,
    leave_out: Sequence[str] = (),
    only: Sequence[str] | None = None,
) -> list[Factor]:
    """Make factors of all parameters of a building that are active and have a range.

    A parameter that is known to be inactive (a wind exponent where no surface heat transfer coefficient
    depends on wind) is left out: its index is zero. Equal set points of heating and cooling in a zone are
    one parameter, under the path of heating, unless the range of cooling is given as well.

    Parameters
    ----------
    building : Building
        Gives paths, ranges and units.
    ranges : mapping of str to (float, float), optional
        Ranges that replace those of the building. [unit of each]
    distributions : mapping of str to str, optional
        Distributions; default ``uniform``.
    groups : mapping of str to sequence of str, optional
        Name -> paths that are analyzed together.
    leave_out : sequence of str
        Paths that keep their value.
    only : sequence of str, optional
        Paths that vary; default all. In every path ``*`` stands for any name between two dots.

    Returns
    -------
    list of Factor
        In the order of the building's parameters.

    Raises
    ------
    InputError
        Unknown or structural path, a range beyond the limits of the parameter, a path in two groups, or no
        parameter left.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> [factor] = factors_of(box(), ranges={"materials.concrete.density": (2200, 2500)},
    ...                       only=["materials.concrete.density"])
    >>> factor.low, factor.high, factor.unit
    (2200, 2500, 'kg/m3')
    """
    spans = {path: checked_range(building, path, span) for path, span in _resolved(building, ranges).items()}
    shapes = _resolved(
        building, mapping_of("distributions", distributions, "names by path: {path: 'normal'}")
    )
    group_of = _members(building, mapping_of("groups", groups, "lists of paths by name: {name: [path]}"))
    fixed = _expanded_paths(building, names_of("leave_out", leave_out))
    chosen = None if only is None else _expanded_paths(building, only)
    tied = tied_set_points(building)
    factors: list[Factor] = []
    for parameter in building.parameters():
        path = parameter.path
        if path in tied and path not in spans and tied[path] in [factor.path for factor in factors]:
            continue  # it follows the equal set point, see VectorRuns.varied
        low, high = spans.get(path, (parameter.low, parameter.high))
        included = path not in fixed and (chosen is None or path in chosen)
        if parameter.reason is None and included and low < high:
            shape = shapes.get(path, "uniform")
            factors.append(Factor(path, low, high, parameter.unit, shape, group_of.get(path)))
    if not factors:
        raise InputError(
            "found no parameter with a range, expected at least one; give ranges: {path: [low, high]}"
        )
    return factors


@described
def sensitivity_analysis(
    building: Building,
    climate: Climate,
    *,
    vary: Vary | None = None,
    method: MethodName = "spectral",
    parameters: Mapping[str, float] | None = None,
    outputs: Sequence[str] | None = None,
    start: TimeLike | None = None,
    end: TimeLike | None = None,
    step: str | float = "15min",
    scheme: Scheme = "sdirk2",
    initial: Initial = "repeat",
    first_period: str | float = "1d",
    measurements: Measurements | None = None,
    progress: ProgressOption = None,
    precision: Precision = "double",
    interval: str | float = "1h",
    distributions: Mapping[str, DistributionName] | None = None,
    groups: Mapping[str, Sequence[str]] | None = None,
    leave_out: Sequence[str] = (),
    replicates: int = 8,
    samples: int | None = None,
    order: int | None = None,
    seed: int = 0,
    confidence: float = 0.95,
) -> Sensitivity:
    """Find which parameters of a building matter for its outputs.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        Its weather.
    vary : sequence of str, or mapping of str to (float, float) or None, optional
        Paths that vary, or path -> (low, high); None for the range of the building. Default: every active
        parameter with a range. [unit of each]
    method : str
        ``spectral`` (default), ``rbd-fast``, ``sobol`` or ``morris``; all but the first need SALib.
    <run options>
    precision : str
        ``double`` or ``single``, as in `mascarin.sweep`; the difference that it makes is among the warnings.
    interval : str or float
        Spacing of the outputs that are analyzed. [s]
    distributions : mapping of str to str, optional
        Distributions by path: ``uniform`` (default), ``sine``, ``log-uniform``, ``triangular``, ``normal``.
    groups : mapping of str to sequence of str, optional
        Name -> paths that are analyzed together.
    leave_out : sequence of str
        Paths that keep their value; those in `parameters` do so too.
    replicates : int
        Independent repetitions, at least 3; the intervals come from their spread. [-]
    samples : int, optional
        Size of a replicate, see `mascarin.sensitivity.plan`. [-]
    order : int, optional
        Harmonics that are attributed to a parameter (spectral, RBD-FAST). [-]
    seed : int
        Seed of the random numbers; the same seed gives the same result.
    confidence : float
        Of the intervals. [-]

    Returns
    -------
    Sensitivity
        Indices with intervals, and signed effects.

    Raises
    ------
    InputError
        Anything that cannot be used, before the first run.
    SolverError
        A run failed; the text names its parameters.

    References
    ----------
    Saltelli A. et al. (2008), Global Sensitivity Analysis: The Primer. https://doi.org/10.1002/9780470725184

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> found = mc.sensitivity_analysis(
    ...     box(), box_climate(), outputs=["room.air_temperature"], method="morris", step="1h",
    ...     vary={"surfaces.facade.outside.absorptance": (0.3, 0.9), "materials.concrete.density": None},
    ... )
    >>> found.ranking("room.air_temperature", 1)
    ['surfaces.facade.outside.absorptance']
    """
    fixed = mapping_of("parameters", parameters, "values by path, such as {'zones.room.volume': 30.0}")
    if vary is not None and not isinstance(vary, Mapping):
        vary = names_of("vary", vary)
    building = in_climate(building, climate, measurements=measurements, varied=[*fixed, *(vary or ())])
    fixed_values = {building.parameter(path).path: value for path, value in spread(building, fixed).items()}
    only, ranges = _chosen(building, vary, fixed_values)
    chosen = factors_of(
        building, ranges=ranges, distributions=distributions, groups=groups,
        leave_out=[*names_of("leave_out", leave_out), *fixed_values], only=only,
    )  # fmt: skip
    finite_number("confidence", confidence, 0.0, 1.0)  # before the runs
    require_precision(precision, scheme)
    runs = plan(chosen, method, replicates=replicates, samples=samples, order=order, seed=seed)
    simulation = Simulation(
        building, climate, parameters=parameters, outputs=outputs, start=start, end=end, step=step,
        scheme=scheme, initial=initial, first_period=first_period, measurements=measurements,
        ranges={factor.path: (factor.low, factor.high) for factor in chosen},
    )  # fmt: skip
    stride = max(1, round(seconds_of(interval, "interval") / simulation.step_seconds))
    taken = collector(
        runs, [output.name for output in simulation.outputs], [output.unit for output in simulation.outputs]
    )
    lines = _run_all(simulation, runs, taken, stride, precision, progress)
    analysis = taken.result(confidence=confidence)
    said = (*analysis.warnings, *lines, *of_base(of_nominal(simulation)))
    return replace(analysis, times=simulation.index[::stride], warnings=said)


def _run_all(
    simulation: Simulation,
    runs: Plan,
    taken: Collector[Any, Any],
    stride: int,
    precision: Precision,
    progress: ProgressOption,
) -> list[RunWarning]:
    """Carry out the runs of a plan; lines about members that are not sound, and about single precision."""
    remarks: list[RunWarning] = []
    residuals, outside, beyond = np.full((3, len(runs)), np.nan)
    with reporting(progress, "sensitivity analysis") as report:
        for first, x in batches(runs, _BATCH):
            run = run_samples(simulation, runs.paths, x, first, record_every=stride, precision=precision)
            taken.add(first, run.records)
            last = first + len(x)
            residuals[first:last], outside[first:last], beyond[first:last] = (
                run.residuals,
                run.outside,
                run.beyond,
            )
            if first == 0 and precision == "single":
                remarks = _single_precision(simulation, runs.paths, x, run.records, stride)
            report(last, len(runs))
    unsound = ensemble_warnings(residuals, outside, 0, precision)
    return [*unsound, *member_range_warnings(beyond), *remarks]


def _single_precision(
    simulation: Simulation, paths: Sequence[str], samples: Array, single: Array, stride: int
) -> list[RunWarning]:
    """How far outputs of some runs in single precision are from those in double precision: a line each."""
    some = members_to_check(len(samples))
    double = run_samples(simulation, paths, samples[some], 0, record_every=stride).records
    outputs = simulation.outputs
    names, units = [output.name for output in outputs], [output.unit for output in outputs]
    lines = differences(names, units, single[some], double)
    return [RunWarning(f"single precision: {line}", WarningKind.METHOD) for line in lines]


def run_samples(
    simulation: Simulation,
    paths: Sequence[str],
    samples: Array,
    first: int,
    *,
    start: int = 0,
    record_every: int = 1,
    precision: Precision = "double",
) -> EnsembleRun:
    """Run consecutive members of a plan.

    Parameters
    ----------
    simulation : Simulation
        What is run.
    paths : sequence of str, length P
        Columns of the samples.
    samples : ndarray, shape (m, P)
        Parameter values. [unit of each]
    first : int
        Number of the first run, for messages.
    start, record_every : int
        First recorded row and spacing of the recorded rows, in steps.
    precision : str
        ``double`` or ``single``.

    Returns
    -------
    EnsembleRun
        Its records have the shape (m, T, S); no member has failed.

    Raises
    ------
    SolverError
        A run failed; the text names its parameters.
    """
    vectors = simulation.varied(paths, samples)
    run = simulation.ensemble(vectors, record_from=start, record_every=record_every, precision=precision)
    if run.failures:
        failed = run.failures[0]
        raise SolverError(
            f"sensitivity analysis: run {first + failed.member} failed: {failed.reason} Its parameters: "
            + ", ".join(f"{p}={v:g}" for p, v in zip(paths, samples[failed.member], strict=True))
        )
    return run


def checked_range(building: Building, path: str, span: tuple[float, float]) -> tuple[float, float]:
    """Check a range against the limits of a parameter.

    Parameters
    ----------
    building : Building
        Knows the parameter.
    path : str
        Its path.
    span : tuple of float
        Low and high end. [unit of the parameter]

    Returns
    -------
    tuple of float
        The range.

    Raises
    ------
    InputError
        Unknown or structural path, a low end that is not below the high end, or a range beyond the limits.
    """
    parameter, (low, high) = building.parameter(path), bounds_of(path, span)
    if parameter.structural:
        raise InputError(f"{path}: is structural ({parameter.reason}) and cannot be varied; leave it out")
    low = parameter.inside(low)
    if not parameter.lower <= low < high <= parameter.upper:
        raise InputError(
            f"{path}: found [{low:g}, {high:g}] {parameter.unit}, expected a lower and a higher value, each "
            f"{parameter.allowed}; correct the range"
        )
    return low, high


def _resolved(building: Building, by_pattern: Mapping[str, _T] | None) -> dict[str, _T]:
    """The same mapping by the full paths of the building; what is given later counts."""
    return {
        building.parameter(path).path: value
        for pattern, value in (by_pattern or {}).items()
        for path in expanded(building, [pattern])
    }


def _expanded_paths(building: Building, paths: Sequence[str]) -> set[str]:
    """Full paths of all that is named, patterns included."""
    return {building.parameter(path).path for path in expanded(building, paths)}


def _members(building: Building, groups: Mapping[str, Sequence[str]]) -> dict[str, str]:
    """Group of each path that has one."""
    group_of: dict[str, str] = {}
    for name, paths in groups.items():
        for member in expanded(building, names_of(f"groups: {name}", paths)):
            path = building.parameter(member).path
            if path in group_of:
                raise InputError(
                    f"{member}: is in the groups {group_of[path]} and {name}; expected one of them"
                )
            group_of[path] = name
    return group_of


def _chosen(
    building: Building, vary: Vary | None, fixed: Mapping[str, float]
) -> tuple[list[str] | None, dict[str, tuple[float, float]]]:
    """Full paths that vary (None for all), and their ranges where given."""
    if vary is None:
        return None, {}
    if isinstance(vary, str):
        raise InputError(
            f"vary: found the text '{vary}', expected a list of paths or a mapping to (low, high)"
        )
    spans = vary if isinstance(vary, Mapping) else dict.fromkeys(vary)
    wide = {
        building.parameter(path).path: span
        for pattern, span in spans.items()
        for path in expanded(building, [pattern])
    }
    paths = list(wide)
    both = [path for path in paths if path in fixed]
    if both:
        raise InputError(f"{both[0]}: is in vary and in parameters; a fixed value does not vary: remove one")
    return paths, {path: span for path, span in wide.items() if span is not None}
