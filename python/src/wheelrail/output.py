"""Files that this package writes: beside what is there, and put in its place when all of it is safe on the disk."""

from __future__ import annotations

import csv
import errno
import logging
import os
import secrets
import shutil
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryFile
from threading import Lock

from .tables import BadFile

log = logging.getLogger(__name__)
_lock, _owned = Lock(), set()


class Unwritten(OSError):
    """A file that could not be written; what was there before is unchanged."""

    def __init__(self, path: str | Path, why: str, kept: bool = False) -> None:
        super().__init__(f"{path} cannot be written: {why}" + ("; the file that was there is unchanged" if kept else ""))
        self.why = why


@contextmanager
def fresh(path: str | Path) -> Iterator[Path]:
    """The path of a file beside `path`, with the same ending, which takes its place in the end. What goes wrong removes it."""
    if _is_stream(path):
        with _failing(path, False):
            yield Path(path)
        return
    target = Path(os.path.realpath(path))
    with _owner(target, path), _failing(path, target.is_file()):
        target.parent.mkdir(parents=True, exist_ok=True)
        beside = target.with_name(f".wheelrail-{secrets.token_hex(6)}{target.suffix}")
        try:
            beside.touch(exist_ok=False)
            if target.is_file():
                shutil.copymode(target, beside)
            yield beside
            with open(beside, "rb+") as file:
                os.fsync(file.fileno())
            os.replace(beside, target)
            log.info("written: %s", path)
        finally:
            beside.unlink(missing_ok=True)


def _is_stream(path):
    """Whether a path is a device or a pipe, such as /dev/stdout, which has no place that a file could take."""
    return Path(path).exists() and not (Path(path).is_file() or Path(path).is_dir())


@contextmanager
def asked(path: Path, problem: str) -> Iterator[None]:
    """What the system refuses meanwhile of a path that a user has named is a wrong argument, unless the disk is full."""
    try:
        yield
    except OSError as error:
        full = error.errno in (errno.ENOSPC, errno.EDQUOT)
        raise (Unwritten(path, error.strerror) if full else BadFile(f"{problem}: {error.strerror}")) from None


def check_place(path: Path, option: str) -> None:
    """Refuses, before anything is computed, the path that an option of a command names, if no file can be written there."""
    place = Path(os.path.realpath(path))
    with asked(path, f"{option}: {path} cannot be written"):
        if place.is_dir():
            raise IsADirectoryError(errno.EISDIR, "it is a folder: name a file in it")
        if not _is_stream(path):
            TemporaryFile(dir=next(above for above in place.parents if above.exists())).close()


def results_folder(out: Path, name: str) -> Path:
    """The folder of a name below `--out`, made if it is not there, in which files can be written."""
    path = out / name
    with asked(path, f"--out: nothing can be written to {path}"):
        path.mkdir(parents=True, exist_ok=True)
        TemporaryFile(dir=path).close()
    return path


def spare(paths: list[Path], force: bool) -> None:
    """Refuses to overwrite files that are there, unless `force`."""
    there = [path for path in paths if path.exists()]
    if there and not force:
        names = ", ".join(path.name for path in there)
        raise BadFile(f"{there[0].parent} holds results already ({names}): add --force to overwrite them, or take another --out")


def write(path: str | Path, content: str | bytes | memoryview) -> None:
    """Writes text or bytes."""
    with fresh(path) as new:
        new.write_bytes(content.encode() if isinstance(content, str) else content)


def write_rows(path: str | Path, rows: Iterable[Iterable[object]]) -> None:
    """Writes a CSV file."""
    with fresh(path) as new, open(new, "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(rows)


def beside(path: Path, what: str) -> Path:
    """The path of a CSV beside another one, such as run_columns.csv beside run.csv."""
    return path.with_name(f"{path.stem}_{what}.csv")


def write_columns(path: str | Path, rows: Iterable[Iterable[object]]) -> None:
    """Writes what the columns of other files are: name, unit, description."""
    write_rows(path, [("column", "unit", "description"), *rows])


def append(path: Path, text: str) -> None:
    """Adds text to the end of a file, all of it or nothing."""
    size = path.stat().st_size if path.is_file() else None
    with _owner(Path(os.path.realpath(path)), path), _failing(path, size is not None):
        try:
            with open(path, "ab") as file:
                file.write(text.encode())
        except BaseException:
            if size is None:
                path.unlink(missing_ok=True)
            else:
                os.truncate(path, size)
            raise


@contextmanager
def _owner(target, path):
    """Nobody else in this process writes the file meanwhile."""
    with _lock:
        if target in _owned:
            raise Unwritten(path, "another run in this process is writing it now; give each a path of its own", kept=True)
        _owned.add(target)
    try:
        yield
    finally:
        with _lock:
            _owned.discard(target)


@contextmanager
def _failing(path, kept):
    """What the system refuses is said of the path that was asked for."""
    try:
        yield
    except OSError as failure:
        why = getattr(failure, "why", None) or failure.strerror or (str(failure).splitlines() or [type(failure).__name__])[0]
        raise Unwritten(path, why, kept) from failure
