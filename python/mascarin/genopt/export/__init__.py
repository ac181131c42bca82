"""A study as a GenOpt project, so that another program can identify its parameters.

`writing` writes the project; `case` is the compiled study that each evaluation runs. Nothing is imported
here, because each evaluation is a new process and must start quickly.
"""

from __future__ import annotations
