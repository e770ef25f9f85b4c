"""Temporary folders that belong to the process that made them: a process that was forked from it deletes none."""

import os
import shutil
import tempfile
from pathlib import Path
from weakref import finalize


class TemporaryFolder:
    """A folder at `path` until `remove`, the end of this object, or that of the process that made it."""

    def __init__(self, prefix):
        self.path = Path(tempfile.mkdtemp(prefix=prefix))
        self.remove = finalize(self, _remove, self.path, os.getpid())


def _remove(path, owner):
    """Deletes a folder that this process owns."""
    if os.getpid() == owner:
        shutil.rmtree(path, ignore_errors=True)
