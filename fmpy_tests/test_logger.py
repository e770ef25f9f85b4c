"""Messages of a wheel reach it whatever else uses fmpy, and no callback outlives what it belongs to. Each case is a process of
its own: what goes wrong here kills it."""

import os
import subprocess
import sys

import pytest

HEAD = """
import gc, importlib, os, sys, threading, warnings
import fmpy, wheelrail

PACKED = sys.argv[1]
warnings.simplefilter("ignore", wheelrail.WheelrailWarning)
heard = []

def other():
    "Another user of fmpy with a logger that nothing keeps."
    start = {"initial.velocity": 20.0, "rail.temperature": 20.0}
    logger = lambda *message: heard.append(message[-1])
    fmpy.simulate_fmu(PACKED, stop_time=2e-3, output_interval=1e-3, start_values=start, logger=logger, output=["wheel.omega"])
    gc.collect()

def refused(wheel):
    "A message of the wheel."
    try:
        wheel.set({"drive.load": 1e30})
    except wheelrail.Refused as error:
        assert "drive.load" in str(error) and "fmi2" not in str(error), error
        return
    raise SystemExit("not refused")
"""

CASES = {
    "wheel first": """
with wheelrail.Fmu(PACKED) as fmu, wheelrail.Wheel(fmu, {"initial.velocity": 20.0}) as wheel:
    other()
    refused(wheel)
    wheel.step(1e-3)
""",
    "wheel last": """
other()
with wheelrail.Fmu(PACKED) as fmu, wheelrail.Wheel(fmu, {"initial.velocity": 20.0}) as wheel:
    refused(wheel)
    other()
    refused(wheel)
""",
    "wheelrail reloaded": """
fmu = wheelrail.Fmu(PACKED)
wheel = wheelrail.Wheel(fmu)
for name in ("calls", "fmu", "values"):
    importlib.reload(importlib.import_module(f"wheelrail.{name}"))
importlib.reload(wheelrail)
gc.collect()
try:
    wheel.set({"drive.load": 1e30})
except Exception as error:
    assert type(error).__name__ == "Refused" and "drive.load" in str(error)
refused(wheelrail.Wheel(wheelrail.Fmu(PACKED)))
wheel.close()
""",
    "fmpy reloaded": """
fmu = wheelrail.Fmu(PACKED)
wheel = wheelrail.Wheel(fmu)
for name in ("fmpy", "fmpy.fmi1", "fmpy.fmi2", "fmpy.logging", "fmpy.simulation"):
    importlib.reload(importlib.import_module(name))
gc.collect()
other()
refused(wheel)
second = wheelrail.Wheel(fmu)
refused(second)
wheel.close()
refused(second)
second.close()
""",
    "the FMU goes first": """
fmu = wheelrail.Fmu(PACKED)
wheel, folder = wheelrail.Wheel(fmu), fmu.directory
del fmu
gc.collect()
assert os.path.isdir(folder)
other()
refused(wheel)
wheel.close()
del wheel
gc.collect()
assert not os.path.isdir(folder), folder
""",
    "the FMU is closed first": """
with wheelrail.Fmu(PACKED) as fmu:
    wheel = wheelrail.Wheel(fmu)
other()
refused(wheel)
wheel.close()
wheel.close()
""",
    "collected without close": """
with wheelrail.Fmu(PACKED) as fmu:
    wheels = [wheelrail.Wheel(fmu) for _ in range(3)]
    del wheels[1]
    gc.collect()
    other()
    for wheel in wheels:
        refused(wheel)
    assert all(len(wheel.log) == 1 for wheel in wheels)
    del wheels, wheel
    gc.collect()
""",
    "left open at the end of Python": """
fmu = wheelrail.Fmu(PACKED)
wheel = wheelrail.Wheel(fmu)
other()
refused(wheel)
""",
    "threads that speak while Python ends": """
import time
def work(wheel):
    while True:
        refused(wheel)
fmu = wheelrail.Fmu(PACKED)
for _ in range(4):
    threading.Thread(target=work, args=(wheelrail.Wheel(fmu),), daemon=True).start()
time.sleep(0.3)
other()
""",
    "threads": """
def work(fmu):
    with wheelrail.Wheel(fmu, {"initial.velocity": 20.0}) as wheel:
        for _ in range(20):
            refused(wheel)
            wheel.step(1e-3)
        assert len(wheel.log) == 20, wheel.log
        done.append(wheel)
done = []
with wheelrail.Fmu(PACKED) as fmu:
    team = [threading.Thread(target=work, args=(fmu,)) for _ in range(3)]
    for thread in team:
        thread.start()
    other()
    for thread in team:
        thread.join()
assert len(done) == 3
""",
    "forked": """
with wheelrail.Fmu(PACKED) as fmu, wheelrail.Wheel(fmu, {"initial.velocity": 20.0}) as wheel:
    child = os.fork()
    if child == 0:
        refused(wheel)
        sys.exit(7)  # through both context managers, and through what Python does at its end
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
    assert os.path.isfile(os.path.join(fmu.directory, "modelDescription.xml"))
    refused(wheel)
    with wheelrail.Wheel(fmu) as second:
        second.step(1e-3)
assert not os.path.exists(fmu.directory)
""",
}


@pytest.mark.parametrize("name", CASES)
def test_a_wheel_and_other_users_of_fmpy_live_side_by_side(name, packed, tmp_path):
    if name == "forked" and not hasattr(os, "fork"):
        pytest.skip("this system does not fork")
    (tmp_path / "case.py").write_text(f"{HEAD}{CASES[name]}print(len(heard), flush=True)\n")
    done = subprocess.run([sys.executable, "case.py", packed.resolve()], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    print(f"{name}: ended with {done.returncode}, others heard {done.stdout.strip()} messages")
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert int(done.stdout) == CASES[name].count("other()")
