"""The section Algorithm: which optimization algorithm with which settings."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from mascarin.errors import did_you_mean
from mascarin.genopt.algorithms.catalog import ALGORITHMS, Algorithm
from mascarin.genopt.algorithms.searches import Context
from mascarin.genopt.algorithms.settings import check_groups, checked
from mascarin.genopt.files.project import Project
from mascarin.genopt.files.syntax import Block, ordered
from mascarin.optimization import Continuous, Discrete, Observer, Optimizer, Space


@dataclass
class Built:
    """An optimization algorithm and how its evaluations are run.

    Parameters
    ----------
    optimizer : Optimizer
        The search.
    name : str
        The name after ``Main =``.
    stop_at_error : bool
        Whether a failed evaluation ends the run.
    counts_equal : bool
        Whether repeated costs end the run.
    extension : bool
        Whether GenOpt has no algorithm of this name.
    """

    optimizer: Optimizer
    name: str
    stop_at_error: bool = True
    counts_equal: bool = False
    extension: bool = False


def build(project: Project, observer: Observer, workers: int) -> Built:
    """Make the optimization algorithm of a project.

    Parameters
    ----------
    project : Project
        The project.
    observer : Observer
        Is informed about the search.
    workers : int
        Number of evaluations at a time [-].

    Returns
    -------
    Built
        The algorithm with its name.

    Raises
    ------
    InputError
        Every error in the section, each with file and line.
    """
    block, report = _second_seed(project.algorithm), project.report
    name = chosen(project)
    rule = ALGORITHMS[name]
    for inner in block.blocks:
        report.error(inner.location, f"unexpected section '{inner.name}' in 'Algorithm'")
    order = ["Main", *rule.keys]
    if rule.extension:
        # GenOpt does not have this algorithm, so that any order of its keys is accepted.
        written = [e.key for e in block.entries if e.key in order]
        order = [*dict.fromkeys(written), *(k for k in order if k not in written)]
    entries = ordered(block, order, report, optional=rule.optional)
    keys = checked(entries, report, extension=rule.extension)
    check_groups(entries, report)
    report.raise_if_any()
    if rule.extension:
        report.notes.append(f"{block.location}: accepted beyond GenOpt: it has no algorithm '{name}'")
    space = _space(project, name, rule)
    _check_bounds(project, rule, bounds=rule.bounds or "MultiStart" in keys)
    context = Context(project, space, observer, workers)
    optimizer = rule.build(context, keys)
    return Built(
        optimizer,
        name,
        keys.get("StopAtError", True),
        counts_equal=name == "NelderMeadONeill",
        extension=rule.extension,
    )


def chosen(project: Project) -> str:
    """Return the name after ``Main =``.

    Parameters
    ----------
    project : Project
        The project.

    Returns
    -------
    str
        Name of a known algorithm.

    Raises
    ------
    InputError
        It is missing or not known.
    """
    main, report = project.algorithm.get("Main"), project.report
    if main is None:
        location = project.algorithm.end or project.algorithm.location
        report.error(location, "missing specification of 'Main' in 'Algorithm'")
    elif main.value not in ALGORITHMS:
        hint = did_you_mean(main.value, ALGORITHMS)
        report.error(main.location, f"algorithm '{main.value}' is not known. {hint}".rstrip())
    report.raise_if_any()
    return main.value if main is not None else ""


def _second_seed(block: Block) -> Block:
    """The section with a key of its own for the seed of a multi-start beside that of a swarm."""
    after_multi_start, entries = False, []
    for e in block.entries:
        after_multi_start = after_multi_start or e.key == "MultiStart"
        swarm = any(o.key == "NumberOfParticle" for o in block.entries)
        key = "MultiStartSeed" if e.key == "Seed" and after_multi_start and swarm else e.key
        entries.append(replace(e, key=key))
    return replace(block, entries=entries)


def _check_bounds(project: Project, rule: Algorithm, *, bounds: bool) -> None:
    """Check the bounds that the algorithm needs, and that the initial point is within them."""
    report = project.report
    for p in project.continuous:
        if bounds and (p.lower is None or p.upper is None):
            report.error(p.location, f"Parameter '{p.name}' does not have lower and upper bounds specified.")
        elif bounds and p.lower == p.upper:
            report.error(p.location, f"Parameter '{p.name}' has equal bounds; Min must be below Max")
        if rule.start:
            text = project.number_text(p.initial)
            if p.upper is not None and p.initial > p.upper:
                report.error(
                    p.location, f"Initial point not feasible: {p.name}={text}: Upper bound {p.upper!r}"
                )
            if p.lower is not None and p.initial < p.lower:
                report.error(
                    p.location, f"Initial point not feasible: {p.name}={text}: Lower bound {p.lower!r}"
                )
    report.raise_if_any()


def _space(project: Project, name: str, rule: Algorithm) -> Space:
    """Parameters of the optimization algorithm."""
    if project.discrete and rule.mixed and project.report.lenient:
        project.report.notes.append(
            f"{project.discrete[0].location}: accepted beyond GenOpt: discrete parameters with {name}; "
            "their other values are tried in turn"
        )
    elif project.discrete and not rule.discrete:
        names = [f"'{p.name}'" for p in project.discrete]
        listed = ", ".join(names[:-1]) + ", and " + names[-1] if len(names) > 1 else names[0]
        verb = "Variables" if len(names) > 1 else "Variable"
        project.report.error(
            project.discrete[0].location,
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
