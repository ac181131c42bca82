"""The building of a study as described and in its variants, and what is identified in each."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Final

from mascarin.building.parameters.ties import expanded, with_ties
from mascarin.study.context.forms import Choice, Forms, label
from mascarin.study.file.free_parameters import fit_parameters
from mascarin.study.file.patterns import ties_of

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.building.parameters.parameter import Parameter
    from mascarin.study.file.description import Free, IdentificationPlan, Variant
    from mascarin.study.file.study_inputs import StudyInputs

#: Standard deviation of the prior of a parameter of a law that replaces another one. [ranges]
_PRIOR: Final = 0.25


class Variants:
    """Buildings of a study by the name of their variant; None is the building as described.

    Parameters
    ----------
    inputs : StudyInputs
        What was read.
    """

    def __init__(self, inputs: StudyInputs) -> None:
        self._inputs, self._plan = inputs, inputs.plan
        self._building, self._places = inputs.building, inputs.places
        #: Variants that are combinations of alternatives, by name.
        self._combinations: dict[str, Variant] = {}

    @cached_property
    def forms(self) -> Forms:
        """Alternatives of the study."""
        return Forms(self._plan, self._building, self._places)

    def building_of(self, variant: str | None) -> Building:
        """The building of a variant; the study's own for None."""
        if variant is None:
            return self._building
        if variant in self._combinations:
            combined = self._combinations[variant]
            with self._places.blame("alternatives"):
                building = self._building.replace(combined.changes)
                return with_ties(building, ties_of(combined.parameters))
        stated = self._plan.variants[variant]
        with self._places.blame("variants", variant, "changes"):
            building = self._building.replace(stated.changes)
        with self._places.blame("variants", variant, "parameters"):
            return with_ties(building, ties_of(stated.parameters))

    def variant_of(self, choice: Choice) -> str | None:
        """Name of the variant for a choice of alternatives; None for the building as described."""
        if not choice:
            return None
        name = f"alternative {label(choice)}"
        if name not in self._combinations:
            self._combinations[name] = self.forms.variant(choice)
        return name

    def plan_of(self, variant: str | None) -> IdentificationPlan:
        """What is identified in a variant: the study's parameters that it has, and its own."""
        plan = self._inputs.calibration_plan
        if variant is None:
            return plan
        building = self.building_of(variant)
        parameters = {parameter.path: parameter for parameter in building.parameters()}
        stated = self._combinations.get(variant) or self._plan.variants[variant]
        shared = {
            path: _stated_for(parameters[self._building.parameter(path).path], free, stated)
            for path, free in plan.parameters.items()
            if not stated.alone and self._building.parameter(path).path in parameters
        }
        additional = {
            path: free
            for pattern, free in stated.parameters.items()
            for path in expanded(building, [pattern])
        }
        return plan.model_copy(update={"parameters": shared | additional})

    def ranges(self, building: Building) -> dict[str, tuple[float, float]]:
        """Ranges of the parameters; the mesh is chosen once, for the whole ranges."""
        ranges = {p.path: (p.low, p.high) for p in building.parameters() if not p.structural}
        stated = {} if self._plan.sensitivity is None else self._plan.sensitivity.ranges
        for pattern, span in stated.items():
            for name in expanded(self._building, [pattern]):
                path = self._building.parameter(name).path
                if path in ranges:
                    low, high = ranges[path]
                    ranges[path] = (min(low, span[0]), max(high, span[1]))
        identification = self._plan.identification
        for free in [] if identification is None else fit_parameters(self._building, identification):
            if free.path in ranges:
                ranges[free.path] = (free.lower, free.upper)
        return ranges


def _stated_for(parameter: Parameter, free: Free | None, variant: Variant) -> Free | None:
    """What a study states of a parameter, for a variant that may have replaced the part that it belongs to.

    A number of the same name in another law has its own range; its prior is as wide, relative to the range,
    as priors usually are.
    """
    replaced = any(
        parameter.path.startswith(f"{path}.") and not isinstance(value, int | float)
        for path, value in variant.changes.items()
    )
    if free is None or not replaced:
        return free
    prior = None if free.prior is None else _PRIOR * (parameter.high - parameter.low)
    return free.model_copy(update={"low": None, "high": None, "start": None, "prior": prior})
