"""Experiments of a study: each is a study of its own whose keys are those of the file, and what differs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from pydantic import Field, ValidationError

from mascarin.building.base.names import Name
from mascarin.building.base.part import Part
from mascarin.building.base.wildcards import is_pattern
from mascarin.building.parameters.ties import expanded
from mascarin.building.reading import explained, merged, over
from mascarin.errors import InputError
from mascarin.study.file.data_sources import FILE_KEYS, Experiment
from mascarin.study.file.description import StudyFile
from mascarin.study.file.locations import Places

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mascarin.building import Building
    from mascarin.building.reading import Inherited

_EXPERIMENTS: Final = "experiments"
#: Keys of a study that are about its first experiment alone.
_OF_THE_FIRST: Final = (
    "sensitivity", "comfort", "criteria", "aims", "reference", "variants", "alternatives",
)  # fmt: skip
#: Keys that cannot stand beside several experiments that are identified, and why.
_ALONE: Final = {
    "variants": "a variant is compared in one experiment",
    "alternatives": "forms of the model are weighed by the days of one experiment",
}
#: Entries that name a data set: one that no experiment uses would be read by nobody.
_SOURCES: Final = (("building",), ("measurements", "table"), ("climate", "measured", "table"))


@dataclass(frozen=True, eq=False)
class ExperimentFile:
    """One experiment of a study file.

    Attributes
    ----------
    name : str
        Its name; empty where the study has no experiments.
    role : str
        ``identification`` or ``validation``.
    file : StudyFile
        The study of this experiment alone.
    places : Places
        Lines of its entries, for errors.
    """

    name: str
    role: str
    file: StudyFile
    places: Places


class _Names(Part):
    """The experiments of a study, before each is merged over the study."""

    experiments: dict[Name, Experiment] = Field(min_length=1)


def read_experiments(path: Path) -> list[ExperimentFile]:
    """Read a study file: one entry for each experiment, the first that is identified in front.

    Parameters
    ----------
    path : Path
        The study file.

    Raises
    ------
    InputError
        File, line, path, what was found, what was expected, what to do.
    """
    document = merged(path, "a study", blanks=True, file_keys=FILE_KEYS)
    # Without a value it removes those of a study that this one extends.
    if document.plain.get(_EXPERIMENTS, {}) is None:
        document.plain.pop(_EXPERIMENTS)
    if _EXPERIMENTS not in document.plain:
        return [
            ExperimentFile("", "identification", _valid(document.plain, path, document.lines), Places(path))
        ]
    stated, places = document.plain[_EXPERIMENTS], Places(path)
    if not stated:
        with places.blame(_EXPERIMENTS):
            raise InputError(
                "found no experiment, expected at least one of role identification: name one, or leave "
                "experiments out"
            )
    try:
        entries = _Names.model_validate({_EXPERIMENTS: stated}).experiments
    except ValidationError as error:
        raise explained(error, document.plain, str(path), document.lines) from None
    _require_consistent(document, entries, places)
    first = next(name for name, entry in entries.items() if entry.role == "identification")
    order = [first, *(name for name in entries if name != first)]
    return [_experiment(path, document, name, entries[name].role, name == first) for name in order]


def read_study(path: str | Path) -> StudyFile:
    """Read a study file, with the keys of its first experiment.

    Parameters
    ----------
    path : str or Path
        The study file.

    Raises
    ------
    InputError
        File, line, path, what was found, what was expected, what to do.
    """
    return read_experiments(Path(path))[0].file


def _valid(plain: Any, path: Path, lines: Mapping[Any, int]) -> StudyFile:
    try:
        return StudyFile.model_validate(plain)
    except ValidationError as error:
        raise explained(error, plain, str(path), lines) from None


def _experiment(path: Path, document: Inherited, name: str, role: str, first: bool) -> ExperimentFile:
    """The study of one experiment: its keys over those of the file."""
    left_out = (_EXPERIMENTS,) if first else (_EXPERIMENTS, *_OF_THE_FIRST)
    base = {key: value for key, value in document.plain.items() if key not in left_out}
    inside = (_EXPERIMENTS, name)
    own = {key: value for key, value in document.plain[_EXPERIMENTS][name].items() if key != "role"}
    own_lines = {place[2:]: line for place, line in document.lines.items() if place[:2] == inside}
    lines = {place: line for place, line in document.lines.items() if place[:1] != (_EXPERIMENTS,)}
    plain, where = over(base, own, lines, own_lines)
    where[()] = document.lines.get(inside, 0)
    if first:
        plain[_EXPERIMENTS] = document.plain[_EXPERIMENTS]
    return ExperimentFile(name, role, _valid(plain, path, where), Places(path, name, where))


def _require_consistent(document: Inherited, entries: Mapping[str, Experiment], places: Places) -> None:
    """Refuse keys of the study that contradict its experiments."""
    plain = document.plain
    identified = [name for name, entry in entries.items() if entry.role == "identification"]
    with places.blame(_EXPERIMENTS):
        if not identified:
            raise InputError(
                f"found role: validation in all of {', '.join(entries)}, expected at least one of role "
                "identification, from which parameters are estimated: change the role of one, or write a "
                "study without experiments and use 'mascarin validate'"
            )
    if plain.get("transfer"):
        with places.blame("transfer"):
            raise InputError(
                "found transfer beside experiments, expected one of the two: write each as an experiment of "
                "role validation, with what differs"
            )
    for key, why in _ALONE.items():
        if plain.get(key) and len(identified) > 1:
            with places.blame(key):
                raise InputError(
                    f"found {key} beside {len(identified)} experiments that are identified, expected one of "
                    f"role identification: {why}; leave {key} out, or change the roles"
                )
    identification = plain.get("identification")
    if isinstance(identification, Mapping) and len(identified) > 1:
        _require_supported(identification, places)
    for source in _SOURCES:
        if _at(plain, source) is not None and all(
            _at(plain[_EXPERIMENTS][name], source) is not None for name in entries
        ):
            with places.blame(*source):
                raise InputError(
                    f"found {_at(plain, source)}, which no experiment uses: each states its own; expected it "
                    "here for all, or in each: remove one of the two"
                )


def _require_supported(identification: Mapping[str, Any], places: Places) -> None:
    """Refuse methods that know one experiment only."""
    for key, value, why in (
        ("profiles", True, "a profile is made of one experiment; expected false"),
        ("posterior", "sampled", "one experiment can be sampled with the model itself; expected linearized"),
    ):
        if identification.get(key) == value:
            with places.blame("identification", key):
                raise InputError(
                    f"found {str(value).lower()} with several experiments that are identified: {why}: "
                    "leave it out"
                )


def _at(plain: Any, place: tuple[str, ...]) -> Any:
    for key in place:
        if not isinstance(plain, Mapping):
            return None
        plain = plain.get(key)
    return plain


def with_parameters_of(
    experiment: ExperimentFile, building: Building, identified: Sequence[tuple[str, Building]]
) -> StudyFile:
    """The study of an experiment with those parameters that its building has.

    Parameters
    ----------
    experiment : ExperimentFile
        One of several.
    building : Building
        Its building as described.
    identified : sequence of (str, Building)
        Names and buildings of the experiments that are identified.

    Raises
    ------
    InputError
        A parameter that none of them has.
    """
    file = experiment.file
    if file.identification is None or not experiment.name:
        return file
    parameters = {}
    for path, free in file.identification.parameters.items():
        if not any(_has(each, path) for _, each in identified):
            named = ", ".join(f"'{name}'" for name, _ in identified)
            with experiment.places.blame("identification", "parameters", path):
                try:
                    _require(identified[0][1], path)
                except InputError as error:
                    raise InputError(
                        f"no building of the experiments that are identified ({named}) has it: {error}"
                    ) from None
        if _has(building, path):
            parameters[path] = free
    if not parameters and experiment.role == "validation":
        return file.model_copy(update={"identification": None})
    if not parameters:
        with experiment.places.blame("identification", "parameters"):
            raise InputError(
                "found no parameter that the building of this experiment has, expected at least one: name "
                "one, or remove the experiment"
            )
    identification = file.identification.model_copy(update={"parameters": parameters})
    return file.model_copy(update={"identification": identification})


def _has(building: Building, path: str) -> bool:
    try:
        _require(building, path)
    except InputError:
        return False
    return True


def _require(building: Building, path: str) -> None:
    if is_pattern(path):
        expanded(building, [path])
    else:
        building.parameter(path)
