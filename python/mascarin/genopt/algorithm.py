"""The section Algorithm: which optimiser with which settings."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

from mascarin.errors import did_you_mean
from mascarin.genopt import functions
from mascarin.genopt.numbers import double_text, parse_double
from mascarin.genopt.project import Project, single_rounding
from mascarin.genopt.syntax import Block, Entry, Report, ordered
from mascarin.optimization import (
    ArmijoGradient,
    ArmijoRules,
    Continuous,
    CoordinateSearch,
    Discrete,
    Evaluation,
    FibonacciSearch,
    GoldenSection,
    Grid,
    HookeJeeves,
    NelderMead,
    Observer,
    OneAtATime,
    Optimizer,
    ParticleSwarm,
    Space,
    SufficientDecrease,
    SwarmRules,
    SwarmThenPattern,
    uniform_starts,
)
from mascarin.optimization.line import fibonacci_points, golden_points

_MULTI = ["MultiStart", "Seed", "NumberOfInitialPoint"]
_DECREASE = ["Zeta", "Phi", "Alpha"]
_SWARM = [
    "NeighborhoodTopology",
    "NeighborhoodSize",
    "NumberOfParticle",
    "NumberOfGeneration",
    "Seed",
    "CognitiveAcceleration",
    "SocialAcceleration",
    "MaxVelocityGainContinuous",
    "MaxVelocityDiscrete",
]


@dataclass(frozen=True)
class Number:
    """What a numeric setting may be.

    Parameters
    ----------
    whole : bool
        Whether it is an integer.
    low, high : float
        Limits.
    open_low, open_high : bool
        Whether a limit itself is excluded.
    """

    whole: bool = False
    low: float = -math.inf
    high: float = math.inf
    open_low: bool = False
    open_high: bool = False

    def problem(self, value: float) -> str:
        """What is wrong with a value, empty when nothing is."""
        if value < self.low or (self.open_low and value == self.low):
            return f"expected {'more than' if self.open_low else 'at least'} {self.low:g}"
        if value > self.high or (self.open_high and value == self.high):
            return f"expected {'less than' if self.open_high else 'at most'} {self.high:g}"
        return ""


_COUNT = Number(whole=True, low=1)
_WHOLE = Number(whole=True)
_NOT_NEGATIVE = Number(low=0)
_POSITIVE = Number(low=0, open_low=True)
_FRACTION = Number(low=0, high=1, open_low=True, open_high=True)
_PULL = Number(low=0, high=4, open_low=True, open_high=True)

_NUMBERS = {
    "Seed": _WHOLE,
    "MultiStartSeed": _WHOLE,
    "NumberOfInitialPoint": _COUNT,
    "Zeta": _NOT_NEGATIVE,
    "Alpha": _FRACTION,
    "MeshSizeDivider": Number(whole=True, low=2),
    "InitialMeshSizeExponent": Number(whole=True, low=0),
    "MeshSizeExponentIncrement": _COUNT,
    "NumberOfStepReduction": _COUNT,
    "NeighborhoodSize": _COUNT,
    "NumberOfParticle": Number(whole=True, low=2),
    "NumberOfGeneration": _COUNT,
    "CognitiveAcceleration": _PULL,
    "SocialAcceleration": _PULL,
    "MaxVelocityGainContinuous": Number(),
    "MaxVelocityDiscrete": _POSITIVE,
    "ConstrictionGain": Number(low=0, high=1, open_low=True),
    "InitialInertiaWeight": _POSITIVE,
    "FinalInertiaWeight": _NOT_NEGATIVE,
    "Accuracy": _POSITIVE,
    "StepSizeFactor": _POSITIVE,
    "BlockRestartCheck": Number(whole=True, low=0),
    "Beta": _FRACTION,
    "Gamma": _POSITIVE,
    "K0": _WHOLE,
    "KStar": _WHOLE,
    "LMax": Number(whole=True, low=0),
    "Kappa": Number(whole=True, low=0),
    "EpsilonM": _POSITIVE,
    "EpsilonX": _POSITIVE,
    "AbsDiffFunction": _POSITIVE,
    "IntervalReduction": _FRACTION,
    "Sigma": _POSITIVE,
    "PopulationSize": Number(whole=True, low=4),
    "MaxEvaluations": _COUNT,
}
_BOOLEANS = {"ModifyStoppingCriterion", "StopAtError"}
_WORDS = {"MultiStart": ["Uniform"], "NeighborhoodTopology": ["gbest", "lbest", "vonNeumann"]}


class Keys(dict[str, Any]):
    """Checked settings of the section by key."""


@dataclass
class Built:
    """An optimiser and how its evaluations are run.

    Parameters
    ----------
    optimiser : Optimizer
        The search.
    name : str
        The name after ``Main =``.
    stop_at_error : bool
        Whether a failed evaluation ends the run.
    counts_equal : bool
        Whether repeated costs end the run.
    own : bool
        Whether GenOpt has no algorithm of this name.
    """

    optimiser: Optimizer
    name: str
    stop_at_error: bool = True
    counts_equal: bool = False
    own: bool = False


@dataclass(frozen=True)
class Context:
    """What a builder needs besides its keys."""

    project: Project
    space: Space
    observer: Observer
    workers: int


REMOVED = {
    "MascarinDE": "choose MascarinCMAES for continuous parameters, or PSOCC, which also takes discrete ones "
    "(docs/coming-from-genopt.md)"
}
"""Algorithms of earlier versions, and what to choose instead."""


@dataclass(frozen=True)
class Algorithm:
    """One name after ``Main =``: its keys in order, those that may be missing, and its builder."""

    keys: tuple[str, ...]
    build: Callable[[Context, Keys], Optimizer]
    optional: tuple[str, ...] = ()
    discrete: bool = False
    mixed: bool = False
    bounds: bool = False
    start: bool = True
    own: bool = False


def build(project: Project, observer: Observer, workers: int) -> Built:
    """The optimiser that a project asks for.

    Parameters
    ----------
    project : Project
        The project.
    observer : Observer
        Listens to the search.
    workers : int
        Number of evaluations at a time [-].

    Returns
    -------
    Built
        The optimiser with its name.

    Raises
    ------
    InputError
        With every error in the section, each with file and line.
    """
    block, report = _second_seed(project.algorithm), project.report
    name = chosen(project)
    rule = _known()[name]
    for inner in block.blocks:
        report.error(inner.place, f"unexpected section '{inner.name}' in 'Algorithm'")
    order = ["Main", *rule.keys]
    if rule.own:
        # GenOpt has no such algorithm, so its order of keys means nothing here.
        written = [e.key for e in block.entries if e.key in order]
        order = [*dict.fromkeys(written), *(k for k in order if k not in written)]
    found = ordered(block, order, report, optional=rule.optional)
    keys = _values(found, report, own=rule.own)
    _groups(found, report)
    report.raise_if_any()
    if rule.own:
        report.notes.append(f"{block.place}: accepted beyond GenOpt: it has no algorithm '{name}'")
    space = _space(project, name, rule)
    _check_bounds(project, rule, bounds=rule.bounds or "MultiStart" in keys)
    context = Context(project, space, observer, workers)
    optimiser = rule.build(context, keys)
    return Built(
        optimiser, name, keys.get("StopAtError", True), counts_equal=name == "NelderMeadONeill", own=rule.own
    )


def chosen(project: Project) -> str:
    """The name after ``Main =``.

    Parameters
    ----------
    project : Project
        The project.

    Returns
    -------
    str
        The name of an algorithm that there is.

    Raises
    ------
    InputError
        When it is missing or not known.
    """
    main, report = project.algorithm.get("Main"), project.report
    known = _known()
    if main is None:
        place = project.algorithm.end or project.algorithm.place
        report.error(place, "missing specification of 'Main' in 'Algorithm'")
    elif main.value in REMOVED:
        report.error(main.place, f"algorithm '{main.value}' was removed; {REMOVED[main.value]}")
    elif main.value not in known:
        hint = did_you_mean(main.value, known)
        report.error(main.place, f"algorithm '{main.value}' is not known. {hint}".rstrip())
    report.raise_if_any()
    return main.value if main is not None else ""


def _second_seed(block: Block) -> Block:
    """The section with the seed of a multi-start told apart from the one of a swarm."""
    seen, entries = False, []
    for e in block.entries:
        seen = seen or e.key == "MultiStart"
        swarm = any(o.key == "NumberOfParticle" for o in block.entries)
        key = "MultiStartSeed" if e.key == "Seed" and seen and swarm else e.key
        entries.append(replace(e, key=key))
    return replace(block, entries=entries)


def _check_bounds(project: Project, rule: Algorithm, *, bounds: bool) -> None:
    """Bounds that the algorithm needs, and an initial point within them."""
    report = project.report
    for p in project.continuous:
        if bounds and (p.lower is None or p.upper is None):
            report.error(p.place, f"Parameter '{p.name}' does not have lower and upper bounds specified.")
        elif bounds and p.lower == p.upper:
            report.error(p.place, f"Parameter '{p.name}' has equal bounds; Min must be below Max")
        if rule.start:
            text = project.number_text(p.initial)
            if p.upper is not None and p.initial > p.upper:
                report.error(p.place, f"Initial point not feasible: {p.name}={text}: Upper bound {p.upper!r}")
            if p.lower is not None and p.initial < p.lower:
                report.error(p.place, f"Initial point not feasible: {p.name}={text}: Lower bound {p.lower!r}")
    report.raise_if_any()


def _values(found: dict[str, Entry], report: Report, *, own: bool) -> Keys:
    """Checked values by key."""
    keys = Keys()
    for key, entry in found.items():
        if key in _NUMBERS:
            value = _number(entry, _NUMBERS[key], report, own=own)
            if value is not None:
                keys[key] = value
        elif key in _BOOLEANS:
            if entry.value not in ("true", "false"):
                report.error(entry.place, f"'{key}' is '{entry.value}'; expected true or false")
            keys[key] = entry.value == "true"
        else:
            if key in _WORDS and entry.value not in _WORDS[key]:
                hint = did_you_mean(entry.value, _WORDS[key])
                report.error(entry.place, f"'{key}' is '{entry.value}', which is not known. {hint}".rstrip())
            keys[key] = entry.value
    if "FinalInertiaWeight" in keys and keys["FinalInertiaWeight"] > keys.get("InitialInertiaWeight", 0.0):
        report.error(
            found["FinalInertiaWeight"].place, "'FinalInertiaWeight' is above 'InitialInertiaWeight'"
        )
    return keys


def _number(entry: Entry, rule: Number, report: Report, *, own: bool) -> float | int | None:
    """A number within its limits."""
    value = parse_double(entry.value)
    if value is None or not math.isfinite(value):
        report.error(entry.place, f"'{entry.key}' is '{entry.value}'; expected a number")
        return None
    if entry.has_exponent and not own:
        report.beyond(
            entry.place,
            f"'{entry.raw}' is read as a number with a unit in this section",
            f'write {entry.value} or "{entry.raw}"',
        )
    if rule.whole:
        if value != int(value):
            report.notes.append(f"{entry.place}: '{entry.key} = {entry.value}' is cut to {int(value)}")
        value = int(value)
    problem = rule.problem(value)
    if problem:
        report.error(entry.place, f"'{entry.key}' is {entry.value}; {problem}")
        return None
    return value


def _groups(found: dict[str, Entry], report: Report) -> None:
    """Optional keys that belong together."""
    seed = "MultiStartSeed" if "NumberOfParticle" in found else "Seed"
    for first, others in (("MultiStart", [seed, "NumberOfInitialPoint"]), ("Zeta", ["Phi"])):
        if first in found:
            for key in others:
                if key not in found:
                    report.error(found[first].place, f"'{first}' needs '{key}' too")
    for key, first in (("NumberOfInitialPoint", "MultiStart"), ("Phi", "Zeta"), ("Alpha", "Zeta")):
        if key in found and first not in found and "K0" not in found:
            report.error(found[key].place, f"'{key}' needs '{first}' in front")
    if "AbsDiffFunction" in found and "IntervalReduction" in found:
        report.error(
            found["IntervalReduction"].place, "give 'AbsDiffFunction' or 'IntervalReduction', not both"
        )


def _space(project: Project, name: str, rule: Algorithm) -> Space:
    """Parameters of the optimiser."""
    if project.discrete and rule.mixed and project.report.lenient:
        project.report.notes.append(
            f"{project.discrete[0].place}: accepted beyond GenOpt: discrete parameters with {name}; "
            "their other values are tried in turn"
        )
    elif project.discrete and not rule.discrete:
        names = [f"'{p.name}'" for p in project.discrete]
        listed = ", ".join(names[:-1]) + ", and " + names[-1] if len(names) > 1 else names[0]
        verb = "Variables" if len(names) > 1 else "Variable"
        project.report.error(
            project.discrete[0].place,
            f"Algorithm '{name}' can only have continuous variables. {verb} {listed} "
            f"{'are' if len(names) > 1 else 'is'} specified as discrete. Choose an algorithm that takes "
            "them, such as PSOCC, GPSPSOCCHJ or MascarinHookeJeeves",
        )
        project.report.raise_if_any()
    continuous = tuple(
        Continuous(
            p.name,
            p.initial,
            p.step,
            -math.inf if p.lower is None else p.lower,
            math.inf if p.upper is None else p.upper,
        )
        for p in project.continuous
    )
    discrete = tuple(Discrete(p.name, p.initial, len(p.values)) for p in project.discrete)
    return Space(continuous, discrete)


# ---------------------------------------------------------------------- builders


def _pattern(
    kind: type[HookeJeeves] | type[CoordinateSearch],
) -> Callable[[Context, Keys], Optimizer]:
    """Builder of a search on a mesh."""

    def make(context: Context, keys: Keys) -> Optimizer:
        space, settings = context.space, context.project.settings
        starts = None
        if "MultiStart" in keys:
            starts = uniform_starts(
                space,
                keys["NumberOfInitialPoint"],
                keys["Seed"],
                divider=keys["MeshSizeDivider"],
                exponent=keys["InitialMeshSizeExponent"],
                rounding=single_rounding,
            )
        return kind(
            space,
            divider=keys["MeshSizeDivider"],
            exponent=keys["InitialMeshSizeExponent"],
            increment=keys["MeshSizeExponentIncrement"],
            reductions=keys["NumberOfStepReduction"],
            starts=starts,
            max_evaluations=settings.max_iterations,
            sufficient=_sufficient(context, keys),
            penalty=settings.write_step,
            discrete_moves=bool(space.discrete),
            rounding=single_rounding,
            text=double_text,
            observer=context.observer,
            remember=False,
        )

    return make


def _sufficient(context: Context, keys: Keys) -> SufficientDecrease | None:
    """The rule of sufficient decrease that Zeta, Phi and Alpha describe."""
    if "Zeta" not in keys:
        return None
    text = cast("str", keys["Phi"])
    project = context.project
    names = [o.name for o in project.objectives]
    entry = project.algorithm.get("Phi")
    place = entry.place if entry else project.algorithm.place
    variables = [n for n in ("Delta", "stepNumber", *names) if f"%{n}%" in text]
    trial = functions.evaluate(functions.substitute(text, dict.fromkeys(variables, "1")))
    if not variables and trial != 0.0:
        project.report.error(place, "Phi without variables must be 0; use %Delta%, %stepNumber% or a cost")
        project.report.raise_if_any()

    def phi(delta: float, step: int, e: Evaluation) -> float:
        values = {"Delta": double_text(delta), "stepNumber": str(step)}
        values.update(zip(names, map(double_text, (e.cost, *e.outputs)), strict=False))
        return functions.evaluate(functions.substitute(text, values))

    return SufficientDecrease(keys["Zeta"], phi, keys.get("Alpha"), "stepNumber" in variables)


def _swarm_rules(keys: Keys) -> SwarmRules:
    """How particles move."""
    return SwarmRules(
        topology=keys["NeighborhoodTopology"],
        neighbors=keys["NeighborhoodSize"],
        particles=keys["NumberOfParticle"],
        generations=keys["NumberOfGeneration"],
        seed=keys["Seed"],
        cognitive=keys["CognitiveAcceleration"],
        social=keys["SocialAcceleration"],
        speed=keys["MaxVelocityGainContinuous"],
        discrete_speed=keys["MaxVelocityDiscrete"],
        constriction=keys.get("ConstrictionGain"),
        inertia=(keys.get("InitialInertiaWeight", 1.0), keys.get("FinalInertiaWeight", 0.0)),
    )


def _swarm(context: Context, keys: Keys) -> Optimizer:
    """A particle swarm, on a mesh when one is given."""
    mesh = (keys["MeshSizeDivider"], keys["InitialMeshSizeExponent"]) if "MeshSizeDivider" in keys else None
    return ParticleSwarm(
        context.space,
        _swarm_rules(keys),
        mesh=mesh,
        penalty=context.project.settings.write_step,
        fresh_step=0,
        rounding=single_rounding,
        observer=context.observer,
        remember=False,
    )


def _hybrid(context: Context, keys: Keys) -> Optimizer:
    """A particle swarm followed by Hooke-Jeeves."""
    settings = context.project.settings
    return SwarmThenPattern(
        context.space,
        _swarm_rules(keys),
        mesh=(keys["MeshSizeDivider"], keys["InitialMeshSizeExponent"]),
        increment=keys["MeshSizeExponentIncrement"],
        reductions=keys["NumberOfStepReduction"],
        restarts=(keys["NumberOfInitialPoint"], keys["MultiStartSeed"]) if "MultiStart" in keys else None,
        sufficient=_sufficient(context, keys),
        max_evaluations=settings.max_iterations,
        text=double_text,
        penalty=settings.write_step,
        fresh_step=0,
        rounding=single_rounding,
        observer=context.observer,
        remember=False,
    )


def _simplex(context: Context, keys: Keys) -> Optimizer:
    """Nelder and Mead's simplex."""
    settings = context.project.settings
    return NelderMead(
        context.space,
        accuracy=keys["Accuracy"],
        step_factor=keys["StepSizeFactor"],
        block=keys["BlockRestartCheck"],
        modified=keys["ModifyStoppingCriterion"],
        max_iterations=settings.max_iterations,
        penalty=settings.write_step,
        observer=context.observer,
        remember=False,
    )


def _gradient(context: Context, keys: Keys) -> Optimizer:
    """Gradient descent with Armijo line search."""
    rules = ArmijoRules(
        alpha=keys["Alpha"],
        beta=keys["Beta"],
        gamma=keys["Gamma"],
        k0=keys["K0"],
        k_star=keys["KStar"],
        l_max=keys["LMax"],
        kappa=keys["Kappa"],
        epsilon_m=keys["EpsilonM"],
        epsilon_x=keys["EpsilonX"],
    )
    return ArmijoGradient(
        context.space,
        rules,
        max_evaluations=context.project.settings.max_iterations,
        text=double_text,
        observer=context.observer,
        remember=False,
    )


def _golden(context: Context, keys: Keys) -> Optimizer:
    """Golden section."""
    limit = context.project.settings.max_iterations
    points = golden_points(keys["IntervalReduction"]) if "IntervalReduction" in keys else limit
    return GoldenSection(
        context.space,
        points,
        difference=keys.get("AbsDiffFunction"),
        text=double_text,
        observer=context.observer,
        remember=False,
    )


def _fibonacci(context: Context, keys: Keys) -> Optimizer:
    """Fibonacci search."""
    limit = context.project.settings.max_iterations
    points = fibonacci_points(keys["IntervalReduction"]) if "IntervalReduction" in keys else limit
    return FibonacciSearch(context.space, points, text=double_text, observer=context.observer, remember=False)


def _mesh(context: Context, keys: Keys) -> Optimizer:
    """All combinations."""
    _check_logarithms(context)
    return Grid(
        context.space,
        batch=context.workers,
        rounding=single_rounding,
        fresh_step=0,
        observer=context.observer,
        remember=False,
    )


def _parametric(context: Context, keys: Keys) -> Optimizer:
    """One parameter at a time."""
    _check_logarithms(context)
    return OneAtATime(context.space, observer=context.observer, remember=False)


def _check_logarithms(context: Context) -> None:
    """Logarithmic spacing needs positive bounds."""
    report = context.project.report
    for p in context.project.continuous:
        if p.step < 0 and not (p.lower is not None and p.lower > 0 and p.upper is not None and p.upper > 0):
            report.error(p.place, f"'{p.name}': logarithmic spacing needs Min and Max above zero")
        if p.step != int(p.step):
            report.notes.append(
                f"{p.place}: Step of '{p.name}' is a number of intervals, cut to {int(p.step)}"
            )
    report.raise_if_any()


_GPS_TAIL = (
    "MeshSizeDivider",
    "InitialMeshSizeExponent",
    "MeshSizeExponentIncrement",
    "NumberOfStepReduction",
)
_GPS_KEYS = (*_MULTI, *_DECREASE, *_GPS_TAIL)
_GPS_OPTIONAL = (*_MULTI, *_DECREASE)
_DAG_KEYS = ("Alpha", "Beta", "Gamma", "K0", "KStar", "LMax", "Kappa", "EpsilonM", "EpsilonX")


def _known() -> dict[str, Algorithm]:
    """All algorithms by name."""
    from mascarin.genopt.modern import ALGORITHMS

    return {
        "GPSHookeJeeves": Algorithm(_GPS_KEYS, _pattern(HookeJeeves), _GPS_OPTIONAL, mixed=True),
        "GPSCoordinateSearch": Algorithm(_GPS_KEYS, _pattern(CoordinateSearch), _GPS_OPTIONAL, mixed=True),
        "NelderMeadONeill": Algorithm(
            ("Accuracy", "StepSizeFactor", "BlockRestartCheck", "ModifyStoppingCriterion"), _simplex
        ),
        "DiscreteArmijoGradient": Algorithm(_DAG_KEYS, _gradient),
        "PSOCC": Algorithm((*_SWARM, "ConstrictionGain"), _swarm, discrete=True, bounds=True),
        "PSOIW": Algorithm(
            (*_SWARM, "InitialInertiaWeight", "FinalInertiaWeight"), _swarm, discrete=True, bounds=True
        ),
        "PSOCCMesh": Algorithm(
            (*_SWARM, "ConstrictionGain", "MeshSizeDivider", "InitialMeshSizeExponent"),
            _swarm,
            discrete=True,
            bounds=True,
        ),
        "GPSPSOCCHJ": Algorithm(
            (
                *_SWARM,
                "ConstrictionGain",
                "MeshSizeDivider",
                "InitialMeshSizeExponent",
                "MultiStart",
                "MultiStartSeed",
                "NumberOfInitialPoint",
                *_DECREASE,
                "MeshSizeExponentIncrement",
                "NumberOfStepReduction",
            ),
            _hybrid,
            ("MultiStart", "MultiStartSeed", "NumberOfInitialPoint", *_DECREASE),
            discrete=True,
            bounds=True,
        ),
        "GoldenSection": Algorithm(
            ("AbsDiffFunction", "IntervalReduction"),
            _golden,
            ("AbsDiffFunction", "IntervalReduction"),
            bounds=True,
            start=False,
        ),
        "Fibonacci": Algorithm(
            ("IntervalReduction",), _fibonacci, ("IntervalReduction",), bounds=True, start=False
        ),
        "Mesh": Algorithm(("StopAtError",), _mesh, discrete=True, bounds=True, start=False),
        "Parametric": Algorithm(("StopAtError",), _parametric, discrete=True, bounds=True, start=False),
        "MascarinHookeJeeves": Algorithm(
            _GPS_KEYS, _pattern(HookeJeeves), _GPS_OPTIONAL, discrete=True, own=True
        ),
        **ALGORITHMS,
    }


def algorithm_names() -> Sequence[str]:
    """Names that may follow ``Main =``, GenOpt's own first."""
    return list(_known())
