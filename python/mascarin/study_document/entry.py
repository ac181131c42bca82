"""What all parts of the results of a study have in common."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict

#: A number as JSON has it: whole numbers stay whole.
Num = int | float


class ResultEntry(BaseModel):
    """A part of the results: what is not stated has a default, keys of other versions are carried along."""

    model_config = ConfigDict(extra="allow", frozen=True, defer_build=True, protected_namespaces=())

    def to_dict(self) -> dict[str, Any]:
        """Plain values for a JSON file: what was stated, and nothing else."""
        return self.model_dump(exclude_unset=True)

    def states(self, *keys: str) -> bool:
        """Whether at least one of some keys was stated."""
        return not self.model_fields_set.isdisjoint(keys)
