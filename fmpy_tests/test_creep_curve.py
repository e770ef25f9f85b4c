"""The creep curve of a locomotive lies within the scatter of its measurement: with the elastic layer everywhere, of clean steel
from 3 % on."""

from ex08_creep_curve import FITTED, LAYER, adhesion, judged


def test_adhesion_of_the_eurosprinter_is_within_the_measured_scatter_from_3_to_21_percent(fmu):
    curve = [(creep, adhesion(fmu, creep)) for creep in (3.0, 5.0, 11.5, 16.5, 20.5)]
    rows = [row for row in judged(curve) if row[0][0] >= FITTED]
    assert len(rows) == 4
    for measured, points, inside in rows:
        print(measured, points)
        assert points and inside


def test_an_elastic_layer_lowers_the_beginning_of_the_curve_into_the_measured_scatter(fmu):
    creeps = (0.02, 0.5, 0.75, 1.0, 1.6, 3.0, 11.5)
    clean, layered = ([(creep, adhesion(fmu, creep, layer)) for creep in creeps] for layer in (0.0, LAYER))
    rows = [row for row in judged(layered) if row[1]]
    assert len(rows) == 4
    for measured, points, inside in rows:
        print(measured, points)
        assert inside
    assert any(not inside for _, points, inside in judged(clean) if points), "clean steel is steeper than the measurement"
    assert layered[0][1] < 0.4 * clean[0][1]
