"""Fixtures: the packed FMU, extracted once, and wheels that are closed after each test; what becomes of printed figures."""

import os
import sys
from collections import defaultdict
from pathlib import Path

import pytest

from wheelrail import Fmu, Wheel

ROOT = Path(__file__).parent.parent
sys.path.append(str(ROOT / "tools"))
import figures  # noqa: E402

PACKED = Path(os.environ.get("WHEELRAIL_FMU", ROOT / "target" / "wheelrail.fmu"))
PACKED3 = ROOT / "target" / "wheelrail-fmi3.fmu"


class Figures:
    """Keeps the figures of the pages that tests print (tools/figures.py), those of each file when all of it has run."""

    def __init__(self):
        self.said = defaultdict(str)

    def pytest_runtest_logreport(self, report):
        self.said[f"fmpy_tests/{Path(report.nodeid.split('::')[0]).name}"] += report.capstdout if report.when == "call" else ""

    def pytest_sessionfinish(self):
        for program, text in self.said.items():
            figures.keep(text, program)


def pytest_configure(config):
    """The process that collects the reports, of all workers if there are any, keeps the figures."""
    if not hasattr(config, "workerinput"):
        config.pluginmanager.register(Figures())


@pytest.fixture(scope="session")
def packed():
    """Path of wheelrail.fmu."""
    if not PACKED.is_file():
        pytest.exit(f"{PACKED} does not exist: build it with `make fmu`", returncode=2)
    return PACKED


@pytest.fixture(scope="session")
def packed3():
    """Path of the FMU of FMI 3.0."""
    if not PACKED3.is_file():
        pytest.exit(f"{PACKED3} does not exist: build it with `make fmu`", returncode=2)
    return PACKED3


@pytest.fixture(scope="session")
def fmu3(packed3):
    """The extracted FMU of FMI 3.0."""
    with Fmu(packed3) as extracted:
        yield extracted


@pytest.fixture(scope="session")
def fmu(packed):
    """The extracted FMU."""
    with Fmu(packed) as extracted:
        yield extracted


@pytest.fixture
def start(fmu):
    """Makes wheels: start(parameters, inputs)."""
    wheels = []

    def make(parameters=None, inputs=None):
        wheels.append(Wheel(fmu, parameters, inputs, name=f"wheel{len(wheels)}"))
        return wheels[-1]

    yield make
    for wheel in wheels:
        wheel.close()


@pytest.fixture(scope="session")
def outputs(fmu):
    """Names of all real outputs, and of the points of profiles."""
    return [v.name for v in fmu.description.modelVariables if v.causality in ("output", "local") and v.type == "Real"]
