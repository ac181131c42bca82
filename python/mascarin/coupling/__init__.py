"""Studies as GenOpt projects, so that a program outside of Mascarin can identify their parameters.

`mascarin.coupling.export` writes the project, `mascarin.coupling.case` is the compiled study that its every
evaluation runs. Nothing is imported here: an evaluation is a process of its own and must start quickly.
"""

from __future__ import annotations
