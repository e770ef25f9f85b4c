"""The process is not ours: loading, running and closing change nothing of it, not even for a moment, and any order of closing,
copying, interrupting and threads ends in an answer or in a refusal. Each case is a process of its own: what goes wrong here kills
it. Every case is tried twenty times, with FMI 3.0 five times."""

import subprocess
import sys

import pytest

HEAD = """
import copy, ctypes, os, pickle, signal, sys, threading, time, warnings
import wheelrail
from wheelrail import Fmu, Refused, Wheel, WheelrailWarning

PACKED, FOLDER, TRIES = sys.argv[1], sys.argv[2], int(sys.argv[3])
START = {"initial.velocity": 20.0, "mesh.elements_per_half_width": 6}
warnings.simplefilter("ignore", WheelrailWarning)
signal.signal(signal.SIGINT, signal.default_int_handler)  # also behind a shell that starts the tests in its background and ignores it

def refused(call, words):
    "A call that must be refused in these words."
    try:
        call()
    except Refused as error:
        assert words in str(error), error
        return
    raise SystemExit("not refused")

def steps(wheel, ends):
    "Steps until a refusal, whose text it keeps."
    try:
        while True:
            wheel.step(1e-3)
    except Refused as error:
        ends.append(str(error))

def together(work, count):
    "Threads that do the same, each with its number."
    threads = [threading.Thread(target=work, args=(k,)) for k in range(count)]
    for thread in threads:
        thread.start()
    return threads

def load_slowly():
    "Libraries take 50 ms more to load, before and after."
    load = ctypes.CDLL.__init__
    def slowly(*arguments, **named):
        time.sleep(0.05)
        load(*arguments, **named)
        time.sleep(0.05)
    ctypes.CDLL.__init__ = slowly
"""

CASES = {
    "nothing changes while it loads, runs and closes": """
import decimal, locale, logging, multiprocessing
import xarray, h5netcdf
MAIN = os.getpid()  # the number of the first thread, too

def state():
    lines = open("/proc/self/status").read().splitlines() + open(f"/proc/self/task/{MAIN}/status").read().splitlines()
    return {
        "directory": os.getcwd(),
        # The C library blocks all signals for the moment in which a thread begins.
        "signals": {line for line in lines if line.startswith(("SigBlk", "SigIgn", "SigCgt", "Umask")) and ":\\tfffffff" not in line},
        "handlers": [signal.getsignal(number) for number in signal.valid_signals()],
        "environment": dict(os.environ),
        "path": list(sys.path),
        "streams": (sys.stdin, sys.stdout, sys.stderr),
        "warnings": (list(warnings.filters), warnings.showwarning),
        "numbers": (locale.setlocale(locale.LC_ALL), str(decimal.getcontext())),
        "log": (logging.root.level, list(logging.root.handlers)),
        "hooks": (sys.excepthook, threading.excepthook, sys.unraisablehook),
        "other processes": multiprocessing.get_start_method(allow_none=True),
        "threads": [thread.name for thread in threading.enumerate()],
    }

def watch():
    while not done:
        now = state()
        now["signals"] |= before["signals"] if len(now["signals"]) == 3 else set()
        seen.append({name: value for name, value in now.items() if value != before[name]})

load_slowly()
done, seen = False, []
sampler = threading.Thread(target=watch, name="sampler")
before = state() | {"threads": ["MainThread", "sampler"]}
sampler.start()
for k in range(TRIES):
    with Fmu(PACKED) as fmu, Wheel(fmu, START) as wheel:
        wheel.step(1e-3)
wheelrail.save(wheelrail.simulate(START, stop=5e-3, fmu=PACKED), FOLDER + "/run.nc")
done = True
sampler.join()
print(len(seen), "samples")
assert len(seen) > 100 and not any(seen), [change for change in seen if change][:3]
""",
    "records of threads that open FMUs are where they were meant": """
def work(k):
    for n in range(TRIES):
        run = wheelrail.simulate(START, stop=3e-3, fmu=PACKED, outputs="wheel.omega", title=f"{k} {n}")
        wheelrail.save(run, f"runs/{k}-{n}.nc")

load_slowly()
os.chdir(FOLDER)
for thread in together(work, 3):
    thread.join()
names = [f"{k}-{n}" for k in range(3) for n in range(TRIES)]
found = [name for name in names if wheelrail.load(f"{FOLDER}/runs/{name}.nc").title == name.replace("-", " ")]
print(f"{len(found)} of {len(names)} records; in {os.getcwd()}")
assert found == names and os.path.samefile(os.getcwd(), FOLDER)
""",
    "a wheel is closed while threads step it": """
with Fmu(PACKED) as fmu:
    for k in range(TRIES):
        wheel, ends = Wheel(fmu, START), []
        threads = together(lambda _: steps(wheel, ends), 2)
        time.sleep(0.02)
        wheel.close()
        for thread in threads:
            thread.join()
        assert len(ends) == 2 and all("the wheel is closed" in end for end in ends), ends
""",
    "an FMU is closed while a wheel of it steps": """
for k in range(TRIES):
    fmu, ends = Fmu(PACKED), []
    wheel = Wheel(fmu, START)
    (thread,) = together(lambda _: steps(wheel, ends), 1)
    fmu.close()
    fmu.close()
    refused(lambda: Wheel(fmu), "the FMU is closed")
    before = wheel.time
    while wheel.time < before + 5e-3:
        pass
    wheel.close()
    thread.join()
    assert "the wheel is closed" in ends[0]
""",
    "copies": """
with Fmu(PACKED) as fmu, Wheel(fmu, START) as wheel:
    for one in (wheel, fmu):
        for copied in (copy.copy, copy.deepcopy, pickle.dumps):
            refused(lambda: copied(one), f"a {type(one).__name__} can be neither copied nor pickled: ")
    wheel.step(1e-3)
    assert wheel.time == 1e-3
""",
    "saved states of another wheel, freed twice, or of a wheel that is closed": """
with Fmu(PACKED) as fmu:
    for k in range(TRIES):
        wheel, other = Wheel(fmu, START), Wheel(fmu, START)
        saved = wheel.save()
        wheel.step(1e-3)
        refused(lambda: other.restore(saved), "not a state of this instance")
        wheel.restore(saved)
        assert wheel.time == wheel.slave.reached() == 0.0
        for _ in range(2):
            wheel.forget(saved)
        refused(lambda: wheel.restore(saved), "has been freed")
        wheel.step(1e-3)
        saved = wheel.save()
        recorder, read = wheel.record("wheel.omega"), wheel.slave.getReal
        for _ in range(2):
            wheel.close()
        calls = [lambda: wheel.restore(saved), lambda: wheel.forget(saved), wheel.save, wheel.record, recorder.sample]
        calls += [lambda: wheel.step(1e-3), lambda: wheel.get("wheel.omega"), lambda: wheel.set({"drive.load": 8e4})]
        for call in [*calls, lambda: read([fmu.variable("wheel.omega").valueReference])]:
            refused(call, "the wheel is closed")
        refused(lambda: other.restore(saved), "not a state of this instance")
        assert wheel.time == 1e-3 and len(recorder.dataset().time) == 1
        other.close()
""",
    "Ctrl-C in a loop of steps": """
within = 0
with Fmu(PACKED) as fmu:
    for k in range(TRIES):
        with Wheel(fmu, START) as wheel:
            recorder = wheel.record("wheel.omega")
            alarm = threading.Timer(0.005 + 2e-4 * k, lambda: os.kill(os.getpid(), signal.SIGINT))
            try:
                alarm.start()
                while True:
                    wheel.step(1e-3)
            except KeyboardInterrupt:
                within += wheel._moves
            alarm.join()
            assert abs(wheel.time - wheel.slave.reached()) < 1e-12
            reached = wheel.time
            wheel.step(1e-3)
            run = recorder.dataset()
            assert abs(wheel.time - reached - 1e-3) < 1e-12 and run.time[-1] == wheel.time
            assert abs(run.time.diff("time") - 1e-3).max() < 1e-9  # no step is missing
print(within, "within a call")
assert within
""",
    "a fork, and threads that step at the end of Python": """
fmu = Fmu(PACKED)
for k in range(TRIES):
    with Wheel(fmu, START) as wheel:
        child = os.fork()
        if child == 0:
            wheel.step(1e-3)
            wheel.close()
            refused(lambda: wheel.step(1e-3), "the wheel is closed")
            os._exit(7)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
        wheel.step(1e-3)
        assert wheel.time == 1e-3
wheels = [Wheel(fmu, START) for _ in range(3)]
for wheel in wheels:
    threading.Thread(target=steps, args=(wheel, []), daemon=True).start()
""",
    "a bar on a terminal leaves neither a thread nor a lock that settles how processes begin": """
import fcntl, multiprocessing, struct, termios
terminal, end = os.openpty()
fcntl.ioctl(end, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 100, 0, 0))
console, sys.stderr = sys.stderr, open(end, "w")
wheelrail.simulate(START, stop=5e-3, fmu=PACKED)
sys.stderr, shown = console, sys.stderr
shown.flush()
assert b"100 %" in os.read(terminal, 100000)
assert multiprocessing.get_start_method(allow_none=True) is None
assert [thread.name for thread in threading.enumerate()] == ["MainThread"]
""",
    "no console": """
from wheelrail.__main__ import main
report, sys.stdout, sys.stderr = sys.stderr, None, None
try:
    warnings.simplefilter("default", WheelrailWarning)
    for progress in (True, False):
        run = wheelrail.simulate({"initial.velocity": 20.0}, {"drive.load": 100.0}, stop=3e-3, fmu=PACKED, progress=progress)
        assert len(run.time) == 4 and len(eval(run.attrs["warnings"])) > 0
    wheelrail.save(run, FOLDER + "/run.nc")
    for arguments, code in ((["schema", "track"], None), (["report", FOLDER + "/run.nc"], None), (["train", "none"], 2), (["who"], 2)):
        try:
            main(arguments)
            assert code is None
        except SystemExit as end:
            assert end.code == code, (arguments, end.code)
    from wheelrail.progress import Progress
    with Progress(10, "stops") as bar:
        bar.advance(5)
    assert sys.stdout is None and sys.stderr is None
finally:
    sys.stderr = report
""",
}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("version", ["FMI 2.0", "FMI 3.0"])
def test_the_process_stays_as_it_was_and_every_call_is_answered(case, version, request, tmp_path):
    file = request.getfixturevalue("packed" if version == "FMI 2.0" else "packed3")
    for needed in ("xarray", "h5netcdf", "plotly"):
        pytest.importorskip(needed)
    command = [sys.executable, "-c", HEAD + CASES[case], str(file.resolve()), str(tmp_path), "20" if version == "FMI 2.0" else "5"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    print(done.stdout, done.stderr)
    assert done.returncode == 0, f"{done.returncode}: {done.stderr[-2000:]}"
