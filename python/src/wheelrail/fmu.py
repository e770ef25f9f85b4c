"""A wheel: an instance of wheelrail.fmu that is stepped, and recorded where that is asked for."""

from __future__ import annotations

from collections.abc import Iterable

from .opened import Fmu, Instance, default_path, instance
from .records import Recorder
from .values import Refused

__all__ = ["Fmu", "Refused", "Wheel", "default_path", "instance"]


class Wheel(Instance):
    """A wheel that is ready to step.

    `parameters` are set before and `inputs` in Initialization Mode. All of them count, those too that have their declared
    start values: `initial.given` is `written` unless given. Refused calls raise `Refused` with the FMU's own words. Use as
    a context manager, or call `close`.

    Warnings of the FMU are said as `WheelrailWarning`, each once, when the call that led to them is done: the wheel is as it is
    without them, also where a filter makes errors of them. `log` is a list of all that the FMU has said so far, texts with a
    `status`: 1 of warnings, 2 of steps that were discarded, 3 of calls that were refused.
    """

    def record(
        self,
        *outputs: str,
        profiles: bool | str | Iterable[str] = False,
        depth: bool | str | Iterable[str] = False,
        every: int = 1,
        title: str = "",
        patch: bool = False,
    ) -> Recorder:
        """A recorder of this wheel, which takes a sample now and after every `every`-th `step`: see `records.Recorder`."""
        recorder = Recorder(self, outputs or None, profiles=profiles, depth=depth, every=every, title=title, patch=patch)
        self._recorders.append(recorder)
        return recorder
