"""Forms of the model and errors of sensors and model, as the report shows them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.numbers import in_percent
from mascarin._io.units import difference
from mascarin.calibration.base.joined_problem import shares_of
from mascarin.calibration.errors.pseudo_bma_weights import LARGEST_LOSS, SMALL_ON_A_DAY
from mascarin.study.steps.error_model import stated_sizes, statement
from mascarin.study_document.analysis import TableEntry
from mascarin.study_document.document import StudyDocument
from mascarin.study_document.estimates import FormEntry, ModelErrorEntry, SensorErrorEntry

if TYPE_CHECKING:
    from mascarin.study.context.context import StudyContext
    from mascarin.study.steps.findings import Combination

#: Weight from which a form is named beside the best one. [-]
_NAMED: Final = 0.05
#: Part of its limit from which the size of an error is said to reach it. [-]
_REACHED: Final = 0.98


def error_entries(study: StudyContext, combination: Combination | None) -> StudyDocument:
    """Weights of the forms, estimated errors of the sensors, and sizes of the errors of the model."""
    if combination is None:
        return StudyDocument()
    return StudyDocument(
        alternatives=_forms(combination),
        sensor_errors=_of_sensors(study, combination),
        model_errors=_of_model(study, combination),
    )


def error_tables(study: StudyContext, combination: Combination | None) -> list[TableEntry]:
    """The same as tables of the report."""
    if combination is None:
        return []
    tables = [_table_of_sensors(study, combination), _table_of_model(study, combination)]
    return [_table_of_forms(combination), *tables] if len(combination.forms) > 1 else tables


def mixed_forms(combination: Combination | None) -> int:
    """How many forms of the model the intervals of parameters and predictions mix."""
    return 1 if combination is None else len(combination.kept)


def error_words(study: StudyContext, combination: Combination | None) -> list[str]:
    """What the identification can tell of the form of the model, and errors that reach their limit."""
    if combination is None:
        return []
    words = [] if len(combination.forms) == 1 else [_words_of_forms(combination)]
    for name, entry in _of_model(study, combination).items():
        full = [part for part in _PARTS if getattr(entry, part) >= _REACHED * entry.limit]
        unit = difference(_unit(study, name))
        words += [
            f"{_label(study, name)}: the error of the model ({_PARTS[part]}) reaches the limit of "
            f"{entry.limit:.2g} {unit}; the model misses more than an error of the model may absorb."
            for part in full
        ]
    return words


def _words_of_forms(combination: Combination) -> str:
    """Which form is used, and what the days left out say of the others."""
    used, alike = combination.forms[0], combination.alike
    alike_labels = {form.label for form, _ in alike}
    behind = used.joint.by_day.sum() - combination.by_day.sum(axis=1)
    pairs = zip(combination.forms[1:], combination.weights[1:], behind[1:], strict=True)
    worse = [
        f"'{form.label}' ({in_percent(weight)}, log density {abs(less):.1f} "
        f"{'lower' if less > 0 else 'higher'})"
        for form, weight, less in pairs
        if weight >= _NAMED and form.label not in alike_labels
    ]
    weight_used = in_percent(float(combination.weights[0]))
    said = [f"Form of the model: '{used.label}' is used (weight {weight_used})."]
    if alike:
        same = ", ".join(f"'{form.label}' ({in_percent(weight)})" for form, weight in alike)
        said.append(f"The identification does not tell it from {same}.")
    if worse:
        said.append(f"Less likely over all days left out, but not excluded: {', '.join(worse)}.")
    if not alike and not worse:
        said.append(f"None of the other {len(combination.forms) - 1} forms comes near.")
    if len(combination.kept) > 1:
        said.append(
            "The intervals of parameters and predictions are those of the mixture of "
            f"{len(combination.kept)} forms."
        )
    return " ".join(said)


def _forms(combination: Combination) -> list[FormEntry]:
    return [
        FormEntry(
            label=form.label,
            choice=dict(form.choice),
            free_numbers=form.complexity[0],
            weight=float(f"{weight:.6g}"),
            left_out=[float(f"{value:.6g}") for value in form.joint.by_day],
        )
        for form, weight in zip(combination.forms, combination.weights, strict=True)
    ]


def _of_sensors(study: StudyContext, combination: Combination) -> dict[str, SensorErrorEntry]:
    """Estimate and standard uncertainty of each error, with that stated."""
    joint, count = combination.forms[0].joint, combination.forms[0].fit.x.size
    stated = stated_sizes(study)
    sd = np.sqrt(np.diag(joint.covariance))
    entries = {}
    for k, name in enumerate(joint.names):
        if name in stated:
            size = stated[name]
            entries[name] = SensorErrorEntry(
                estimate=float(f"{size * joint.mean[count + k]:.6g}"),
                standard_uncertainty=float(f"{size * sd[count + k]:.6g}"),
                stated=size,
            )
    return entries


_PARTS: Final = {
    "repeating": "repeats every day",
    "day": "constant of a day",
    "within_day": "correlated within a day",
    "independent": "independent from value to value",
}


def _of_model(study: StudyContext, combination: Combination) -> dict[str, ModelErrorEntry]:
    best = combination.forms[0]
    sizes, limit = best.joint.error_covariances, statement(study, shares_of(best.fit.problem)[0]).limit
    columns = {
        "repeating": np.sqrt(np.diag(sizes.hour)),
        "day": np.sqrt(np.diag(sizes.day)),
        "within_day": np.sqrt(np.diag(sizes.drift)),
        "independent": np.sqrt(sizes.white + sizes.within),
        "limit": limit,
    }
    names = [sensor.name for sensor in best.fit.problem.sensors]
    return {
        name: ModelErrorEntry(**{what: float(f"{values[s]:.6g}") for what, values in columns.items()})
        for s, name in enumerate(names)
    }


def _table_of_forms(combination: Combination) -> TableEntry:
    best = float(combination.forms[0].joint.by_day.sum())
    return TableEntry(
        title="Forms of the model",
        caption=(
            "Each form is calibrated; each day of the identification is predicted from the other days. The "
            "density is the logarithm of the probability density of the days left out, relative to the first "
            "form. The weights (pseudo Bayesian model averaging with a bootstrap over the days) are those "
            "with which parameters and prediction intervals combine the forms. The first form is used for "
            "curves, criteria and the calibrated building: it has the highest weight of those whose "
            "density is "
            f"within {LARGEST_LOSS:g} of the highest, or is a simpler one that predicts each day as well "
            f"(within {SMALL_ON_A_DAY:g})."
        ),
        columns=["form", "free numbers", "weight [%]", "density of the days left out"],
        rows=[
            [
                form.label,
                form.complexity[0],
                100.0 * float(weight),
                float(form.joint.by_day.sum()) - best,
            ]
            for form, weight in zip(combination.forms, combination.weights, strict=True)
        ],
        section="parameters",
    )


def _table_of_sensors(study: StudyContext, combination: Combination) -> TableEntry:
    entries = _of_sensors(study, combination)
    gains = any(name.endswith(" gain") for name in entries)
    return TableEntry(
        title="Errors of the sensors",
        caption=(
            "Estimated together with the parameters: what the readings of a sensor have in common beside the "
            "model, with its standard uncertainty, beside the standard uncertainty that the study states."
            + (" A gain is a ratio." if gains else "")
        ),
        columns=["error", "unit", "estimate", "standard uncertainty", "stated standard uncertainty"],
        rows=[_row_of_sensor(study, name, entry) for name, entry in entries.items()],
        uncertainty={"estimate": "standard uncertainty"},
        section="parameters",
    )


def _row_of_sensor(study: StudyContext, name: str, entry: SensorErrorEntry) -> list[Any]:
    """Name and unit for readers, estimate and uncertainties."""
    sensor, _, what = name.rpartition(" ")
    is_sensor = sensor in study.plan.sensors
    unit = {"gain": "-", "clock": "s"}.get(what) or (_unit(study, sensor) if is_sensor else "degC")
    label = f"{_label(study, sensor)}: {what}" if is_sensor else name
    return [label, difference(unit), entry.estimate, entry.standard_uncertainty, entry.stated]


def _label(study: StudyContext, name: str) -> str:
    return study.plan.sensors[name].label or name.replace("_", " ")


def _unit(study: StudyContext, name: str) -> str:
    return study.building.output(study.plan.sensors[name].output).unit


def _table_of_model(study: StudyContext, combination: Combination) -> TableEntry:
    return TableEntry(
        title="Errors of the model",
        caption=(
            "Standard deviation of what no values of the parameters explain, estimated by marginal "
            "likelihood in the identification period, with a correlation time of "
            f"{combination.forms[0].joint.error_covariances.correlation_hours:g} h within a day. The limit "
            "is what each part may absorb at most."
        ),
        columns=["sensor", "unit", *_PARTS.values(), "limit"],
        rows=[
            [
                _label(study, name),
                difference(_unit(study, name)),
                *(getattr(entry, part) for part in _PARTS),
                entry.limit,
            ]
            for name, entry in _of_model(study, combination).items()
        ],
        section="comparison",
    )
