"""The functions of the bench as a library of this machine, for the tool that makes the page and for tests."""

import ctypes
import struct
from pathlib import Path
from weakref import finalize


class Library:
    """A bench of a shared library. It has one run at a time; errors of its functions raise `ValueError`."""

    def __init__(self, path):
        self.functions = ctypes.CDLL(str(Path(path).resolve()))
        for name in ("new", "input", "output"):
            getattr(self.functions, f"bench_{name}").restype = ctypes.c_void_p
        self.functions.bench_output_length.restype = ctypes.c_size_t
        self.bench = ctypes.c_void_p(self.functions.bench_new())
        finalize(self, self.functions.bench_free, self.bench)

    def call(self, name, given=b"", *others):
        """Calls `bench_NAME` with bytes; returns those that come out."""
        ctypes.memmove(self.functions.bench_input(self.bench, ctypes.c_size_t(len(given))), given, len(given))
        failed = getattr(self.functions, f"bench_{name}")(self.bench, *others)
        out = ctypes.string_at(self.functions.bench_output(self.bench), self.functions.bench_output_length(self.bench))
        if failed:
            raise ValueError(out.decode("utf-8"))
        return out

    def text(self, name, given=""):
        """Calls a function with a text, and returns one."""
        return self.call(name, given.encode("utf-8")).decode("utf-8")

    def step(self, count):
        """Does steps."""
        self.call("step", b"", count)

    def frame(self):
        """Numbers of the frame."""
        out = self.call("frame")
        return struct.unpack(f"<{len(out) // 8}d", out)
