"""The braking stop of examples/ex01_braking_stop.py, from a lower speed and on a coarser mesh."""

import numpy as np
import pytest

from ex01_braking_stop import COLUMNS, Film, brake_to_standstill, column, results
from ex01_picture import draw
from wheelrail import Wheel

MOMENT = 0.6 * 0.3 * 1e5 * 0.46
COARSE = {"mesh.elements_per_half_width": 8}


@pytest.fixture(scope="module")
def stops(fmu):
    """Stops from 3 m/s with communication steps of 2 and 1 ms."""
    tables = []
    for step in (2e-3, 1e-3):
        with Wheel(fmu, COARSE | {"initial.velocity": 3.0}) as wheel:
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
    wheel = start(COARSE | {"initial.velocity": 3.0})
    table = brake_to_standstill(wheel, 2.0 * MOMENT, 1e-3)
    sliding = (column(table, "wheel.omega") == 0.0) & (column(table, "wheel.velocity") > 0.5)
    assert sliding.sum() > 100
    assert column(table, "contact.utilisation")[sliding].min() == pytest.approx(1.0, abs=1e-6)
    assert column(table, "contact.creepage")[sliding].max() == 2.0
    assert abs(column(table, "wheel.velocity")[-1]) < 0.1
    assert abs(column(table, "solver.energy_residual")[-1]) < 0.01


def test_a_wheel_that_locks_on_leaves_is_released_and_its_picture_is_legible(fmu, start, tmp_path):
    """At a width of 800 px, as README shows it, the smallest type is 11 px high."""
    from matplotlib.text import Text

    wheel, film = start(COARSE | {"initial.velocity": 8.0}), Film(fmu)
    table = brake_to_standstill(wheel, MOMENT, 2e-3, film.see, leaves=(6.0, 7.0), patience=0.3)
    time, peripheral, speed = (column(table, name) for name in ("time", "wheel.omega", "wheel.velocity"))
    locked = np.flatnonzero((peripheral == 0.0) & (speed > 1.0))
    assert time[locked[-1]] - time[locked[0]] == pytest.approx(0.3, abs=0.01)
    assert column(table, "rail.friction")[locked[-1]] == 0.3, "it stays locked on dry rail"
    assert column(table, "contact.friction")[locked[-1]] < 0.15, "for it is hot"
    assert 0.46 * peripheral[locked[-1] :].max() > 0.9 * speed[locked[-1]], "it rolls again"
    assert film.profile("temperature_wheel").max() > 500.0
    picture = tmp_path / "stop.png"
    figure = draw(picture, {name: column(table, name) for name in ("time", *COLUMNS)}, film, 0.46)
    shown = [text.get_fontsize() for text in figure.findobj(Text) if text.get_text()]
    assert len(shown) > 50 and min(shown) * 800.0 / (72.0 * figure.get_figwidth()) > 11.0
    assert picture.stat().st_size < 200_000
