"""The packed FMU, extracted once, and instances on a coarse mesh whose start takes a fraction of a second."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "examples"))

from wheel import Fmu, Wheel  # noqa: E402

COARSE = {"mesh.elements_per_half_width": 8, "solver.modes_wheel": 20, "solver.modes_rail": 10}


@pytest.fixture(scope="session")
def fmu():
    """The FMU that `make fmu` packs."""
    with Fmu(ROOT / "target" / "wheelrail.fmu") as fmu:
        yield fmu


@pytest.fixture
def wheel(fmu):
    """Factory of instances; all are freed at the end of the test."""
    made = []

    def make(parameters=None, inputs=None):
        made.append(Wheel(fmu, parameters, inputs))
        return made[-1]

    yield make
    for instance in made:
        instance.close()
