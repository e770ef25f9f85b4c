"""The braking stop of examples/ex01_braking_stop.py, from a lower speed."""

import pytest

from ex01_braking_stop import brake_to_standstill, column, results
from wheelrail import Wheel

MOMENT = 0.6 * 0.3 * 1e5 * 0.46


@pytest.fixture(scope="module")
def stops(fmu):
    """Stops from 5 m/s with communication steps of 2 and 1 ms."""
    tables = []
    for step in (2e-3, 1e-3):
        with Wheel(fmu, {"initial.velocity": 5.0}) as wheel:
            tables.append(brake_to_standstill(wheel, MOMENT, step))
    return tables


def test_stop_ends_at_rest(stops):
    for table in stops:
        assert column(table, "wheel.omega")[-1] == 0.0
        assert abs(column(table, "wheel.velocity")[-200:]).max() < 0.01
        assert column(table, "contact.creepage").max() < 0.1


def test_energy_is_balanced(stops):
    for table in stops:
        assert abs(column(table, "solver.energy_residual")[-1]) < 0.01


def test_stopping_distance_does_not_depend_on_the_communication_step(stops):
    coarse, fine = (results(table)[0] for table in stops)
    assert coarse[0] == fine[0] == "stopping distance"
    assert coarse[1] == pytest.approx(fine[1], rel=1e-3)


def test_brake_beyond_adhesion_locks_the_wheel_and_slides_to_rest(start):
    wheel = start({"initial.velocity": 8.0})
    table = brake_to_standstill(wheel, 2.0 * MOMENT, 1e-3)
    sliding = (column(table, "wheel.omega") == 0.0) & (column(table, "wheel.velocity") > 0.5)
    assert sliding.sum() > 100
    assert column(table, "contact.utilisation")[sliding].min() == pytest.approx(1.0, abs=1e-6)
    assert column(table, "contact.creepage")[sliding].max() == 2.0
    assert abs(column(table, "wheel.velocity")[-1]) < 0.1
    assert abs(column(table, "solver.energy_residual")[-1]) < 0.01
