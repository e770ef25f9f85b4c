"""Mistakes at the Python side are refused with the name, the value and what is possible."""

from types import SimpleNamespace

import pytest

from wheelrail import Fmu, Refused
from wheelrail.__main__ import rigid
from wheelrail.files import BadFile
from wheelrail.wheelset import LAW, WITHOUT_EFFECT, FrictionLaw


def test_all_that_is_set_from_python_counts_zero_creepage_too(start):
    settings = {"initial.creepage": 0.0, "model.nominal_load": 90e3}
    wheel = start(settings, {"drive.load": 100e3})
    assert wheel.get("contact.force_y") == pytest.approx(100e3)
    assert abs(wheel.get("contact.force_x")) > 500.0 and not wheel.log
    changed = start({"initial.given": "changed"} | settings, {"drive.load": 100e3})
    assert changed.get("contact.force_y") == pytest.approx(90e3)
    assert abs(changed.get("contact.force_x")) < 1.0 and len(changed.log) == 1


def test_rigid_wheelsets_refuse_unknown_parameters_and_name_those_without_effect(packed, monkeypatch, capsys):
    monkeypatch.setenv("WHEELRAIL_FMU", str(packed))
    scenario = lambda **wheel: SimpleNamespace(wheel=wheel, right_wheel={}, right_friction=1.0, temperatures={}, sweep=SimpleNamespace(wheel={}), paths={"scenario": "stop.json"})
    with pytest.raises(BadFile, match="stop.json: wheel: friction.faling_ratio is no parameter of the FMU; did you mean friction.falling_ratio"):
        rigid(scenario(**{"friction.faling_ratio": 0.4}))
    rigid(scenario(**{"friction.falling_ratio": 0.4}))
    assert capsys.readouterr().err == ""
    rigid(scenario(**{"friction.falling_ratio": 0.4, "solver.tolerance": 0.01}))
    assert capsys.readouterr().err.strip().endswith("without effect: solver.tolerance")


def test_rigid_wheelsets_know_every_parameter_of_friction_of_the_fmu_or_refuse_it(packed):
    with Fmu(packed) as fmu:
        names = {name for name, v in fmu.variables.items() if name.startswith("friction.") and v.causality == "parameter"}
        assert FrictionLaw.of({}, fmu) == FrictionLaw()
    assert names == {*LAW, *WITHOUT_EFFECT}
    assert FrictionLaw.of({"friction.falling_ratio": 0.4, "friction.softening": 0.0}) == FrictionLaw(falling_ratio=0.4)
    with pytest.raises(Refused, match="rigid wheelsets do not know friction.stribeck_velocity, only the law of friction.falling"):
        FrictionLaw.of({"friction.falling_ratio": 0.4, "friction.stribeck_velocity": 1.0})
