"""The model description of a unit, as XML."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final
from xml.etree import ElementTree as ET

from mascarin import __version__
from mascarin.fmu.units import base_unit
from mascarin.fmu.variables import Variable

#: Name of the library in the unit.
LIBRARY: Final = "mascarin"
_TOOL: Final = f"Mascarin {__version__}"


@dataclass(frozen=True)
class Model:
    """What the model description says of a unit.

    Attributes
    ----------
    name : str
        Name of the building.
    description : str
        What it was made from.
    token : str
        What library and model description know each other by.
    step, stop : float
        Internal step and length of the period. [s]
    variables : sequence of Variable
        All variables but time, in the order of their value references from 1.
    """

    name: str
    description: str
    token: str
    step: float
    stop: float
    variables: Sequence[Variable]


def fmi3(model: Model) -> bytes:
    """The model description of version 3.0."""
    root = ET.Element(
        "fmiModelDescription",
        fmiVersion="3.0", modelName=model.name, instantiationToken=model.token, description=model.description,
        generationTool=_TOOL, variableNamingConvention="flat",
    )  # fmt: skip
    ET.SubElement(
        root, "CoSimulation",
        modelIdentifier=LIBRARY, canHandleVariableCommunicationStepSize="true",
        fixedInternalStepSize=repr(model.step), canGetAndSetFMUState="true", canSerializeFMUState="true",
        hasEventMode="false",
    )  # fmt: skip
    _common(root, model)
    variables = ET.SubElement(root, "ModelVariables")
    ET.SubElement(
        variables, "Float64",
        name="time", valueReference="0", causality="independent", variability="continuous", unit="s",
        description="Time since the start of the weather of this unit",
    )  # fmt: skip
    structure = []
    for reference, variable in enumerate(model.variables, start=1):
        ET.SubElement(
            variables, "Float64",
            {"name": variable.name, "valueReference": str(reference), **_attributes(variable),
             **_type(variable)},
        )  # fmt: skip
        if variable.causality == "output":
            structure.append(str(reference))
    listed = ET.SubElement(root, "ModelStructure")
    for element in ("Output", "InitialUnknown"):
        for entry in structure:
            ET.SubElement(listed, element, valueReference=entry)
    return _written(root)


def fmi2(model: Model) -> bytes:
    """The model description of version 2.0."""
    root = ET.Element(
        "fmiModelDescription",
        fmiVersion="2.0", modelName=model.name, guid=model.token, description=model.description,
        generationTool=_TOOL, variableNamingConvention="flat",
    )  # fmt: skip
    ET.SubElement(
        root, "CoSimulation",
        modelIdentifier=LIBRARY, canHandleVariableCommunicationStepSize="true",
        canGetAndSetFMUstate="true", canSerializeFMUstate="true",
    )  # fmt: skip
    _common(root, model)
    variables = ET.SubElement(root, "ModelVariables")
    structure = []
    for reference, variable in enumerate(model.variables, start=1):
        scalar = ET.SubElement(
            variables, "ScalarVariable",
            {"name": variable.name, "valueReference": str(reference), **_attributes(variable)},
        )  # fmt: skip
        ET.SubElement(scalar, "Real", _type(variable))
        if variable.causality == "output":
            structure.append(str(reference))  # counted from 1 as well
    listed = ET.SubElement(root, "ModelStructure")
    for element in ("Outputs", "InitialUnknowns") if structure else ():
        group = ET.SubElement(listed, element)
        for entry in structure:
            ET.SubElement(group, "Unknown", index=entry)
    return _written(root)


def _common(root: ET.Element, model: Model) -> None:
    """Units, categories of messages and the default experiment."""
    units = ET.SubElement(root, "UnitDefinitions")
    used = {"s", *(variable.unit for variable in model.variables)} - {"-", ""}
    for name in sorted(used):
        unit, base = ET.SubElement(units, "Unit", name=name), base_unit(name)
        if base is not None:
            attributes = {key: str(exponent) for key, exponent in base.exponents.items()}
            if base.factor != 1.0:
                attributes["factor"] = repr(base.factor)
            if base.offset != 0.0:
                attributes["offset"] = repr(base.offset)
            ET.SubElement(unit, "BaseUnit", attributes)
    categories = ET.SubElement(root, "LogCategories")
    ET.SubElement(categories, "Category", name="logStatusError", description="Why a call was refused")
    ET.SubElement(categories, "Category", name="logInfo", description="The energy balance at the end")
    ET.SubElement(
        root, "DefaultExperiment", startTime="0", stopTime=repr(model.stop), stepSize=repr(model.step)
    )


def _attributes(variable: Variable) -> dict[str, str]:
    kinds = {
        "input": {"variability": "continuous"},
        "output": {"variability": "continuous", "initial": "calculated"},
        "parameter": {"variability": "fixed", "initial": "exact"},
    }
    return {
        "causality": variable.causality,
        "description": variable.description,
        **kinds[variable.causality],
    }


def _type(variable: Variable) -> dict[str, str]:
    attributes = {} if variable.unit in ("-", "") else {"unit": variable.unit}
    if variable.low is not None:
        attributes["min"] = repr(variable.low)
    if variable.high is not None:
        attributes["max"] = repr(variable.high)
    if variable.causality != "output":
        attributes["start"] = repr(variable.start)
    return attributes


def _written(root: ET.Element) -> bytes:
    ET.indent(root)
    text: bytes = ET.tostring(root, encoding="UTF-8", xml_declaration=True)
    return text
