"""Where results go: a directory named after the scenario's file, in which nothing is overwritten unasked."""

import errno

from .files import BadFile
from .output import Unwritten

FULL = (errno.ENOSPC, errno.EDQUOT)


def directory(out, scenario):
    """The directory of a scenario below `out`, made if it is not there."""
    path = out / scenario.paths["scenario"].stem
    try:
        path.mkdir(parents=True, exist_ok=True)
        probe = path / ".wheelrail"
        probe.touch()
        probe.unlink()
    except OSError as error:
        if error.errno in FULL:
            raise Unwritten(path, error.strerror) from None
        raise BadFile(f"--out: nothing can be written to {path}: {error.strerror}") from None
    return path


def spare(paths, force):
    """Refuses to overwrite files that are there, unless `force`."""
    there = [path for path in paths if path.exists()]
    if there and not force:
        names = ", ".join(path.name for path in there)
        raise BadFile(f"{there[0].parent} holds results already ({names}): add --force to overwrite them, or take another --out")
