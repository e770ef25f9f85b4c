"""The creep curve of a locomotive lies within the scatter of its measurement from 3 % on."""

from ex08_creep_curve import FITTED, adhesion, judged


def test_adhesion_of_the_eurosprinter_is_within_the_measured_scatter_from_3_to_21_percent(fmu):
    curve = [(creep, adhesion(fmu, creep)) for creep in (3.0, 5.0, 11.5, 16.5, 20.5)]
    rows = [row for row in judged(curve) if row[0][0] >= FITTED]
    assert len(rows) == 4
    for measured, points, inside in rows:
        print(measured, points)
        assert points and inside
