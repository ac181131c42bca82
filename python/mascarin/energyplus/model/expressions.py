"""Fields that are expressions of the parametric preprocessor, with the values of its first run."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Iterable, Mapping
from typing import Any, Final

_OPERATIONS: Final[Mapping[type[ast.AST], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}
_FUNCTIONS: Final[Mapping[str, Any]] = {
    "abs": abs, "sqrt": math.sqrt, "exp": math.exp, "ln": math.log, "sin": math.sin, "cos": math.cos,
    "tan": math.tan, "min": min, "max": max, "int": math.trunc,
}  # fmt: skip
_NAME: Final = re.compile(r"\$(\w+)")
_ASSIGNED: Final = re.compile(r"\s*\$(\w+)\s*=\s*(.+)")
#: Deepest expression that is read.
_DEPTH: Final = 50


def values_of_first_run(objects: Iterable[tuple[str, str, Mapping[str, Any]]]) -> dict[str, float]:
    """Values of the parameters of a file in its first run.

    Parameters
    ----------
    objects : iterable of (str, str, mapping)
        Class, name and fields of the objects.

    Returns
    -------
    dict of str to float
        Values by name in small letters, without ``$``; those that conditions set are not there.
    """
    values: dict[str, float] = {}
    lines: list[str] = []
    for kind, name, fields in objects:
        rows = [str(value) for row in _rows(fields) for value in row.values()]
        if kind == "Parametric:SetValueForRun" and rows:
            number = evaluated(rows[0], values)
            values |= {} if number is None else {name.strip().lstrip("$").casefold(): number}
        elif kind == "Parametric:Logic":
            lines += rows
    for line in lines:
        if re.match(r"\s*(if|else|elseif|endif|select)\b", line, re.IGNORECASE):
            # What follows depends on a condition.
            break
        match = _ASSIGNED.fullmatch(line)
        number = None if match is None else evaluated(match[2], values)
        if match is not None and number is not None:
            values[match[1].casefold()] = number
    return values


def _rows(fields: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return [row for rows in fields.values() if isinstance(rows, list) for row in rows]


def evaluated(text: str, values: Mapping[str, float]) -> float | None:
    """Value of an expression; None where it has none.

    Parameters
    ----------
    text : str
        Numbers, ``$names``, ``+ - * /``, brackets and functions.
    values : dict of str to float
        Values of the names in small letters.

    Examples
    --------
    >>> evaluated("sqrt($area / 2)", {"area": 32.0})
    4.0
    """
    plain = _NAME.sub(lambda match: f"({values.get(match[1].casefold(), '?')!r})", text.strip())
    if "?" in plain or len(plain) > 1000:
        return None
    try:
        return float(_value(ast.parse(plain.casefold(), mode="eval").body, 0))
    except (SyntaxError, ValueError, TypeError, KeyError, ArithmeticError, RecursionError):
        return None


def _value(node: ast.AST, depth: int) -> float:
    if depth > _DEPTH:
        raise ValueError("too deep")
    if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
        return float(node.value)
    if isinstance(node, ast.BinOp):
        operation = _OPERATIONS[type(node.op)]
        return float(operation(_value(node.left, depth + 1), _value(node.right, depth + 1)))
    if isinstance(node, ast.UnaryOp):
        return float(_OPERATIONS[type(node.op)](_value(node.operand, depth + 1)))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        return float(_FUNCTIONS[node.func.id](*(_value(part, depth + 1) for part in node.args)))
    raise ValueError("no expression")


def with_values(value: Any, values: Mapping[str, float]) -> Any:
    """A field with the values of its expressions, as far as they have one."""
    if isinstance(value, list):
        return [
            {key: with_values(part, values) for key, part in row.items()} if isinstance(row, Mapping) else row
            for row in value
        ]
    if isinstance(value, str) and value.lstrip().startswith("="):
        number = evaluated(value.lstrip()[1:], values)
        return value if number is None else number
    return value
