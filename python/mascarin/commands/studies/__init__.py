"""Commands of studies, designs and GenOpt projects."""

from __future__ import annotations
