"""What all steps of a study share: inputs, periods, models, the folder of its work."""

from __future__ import annotations
