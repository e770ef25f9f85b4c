"""The process is not ours: loading, running and closing change nothing of it, not even for a moment, and any order of closing,
copying, interrupting and threads ends in an answer or in a refusal. Each case is a process of its own: what goes wrong here kills
it. Every case is tried ten times, with FMI 3.0 three times; those that load slowly or write files three times and
once."""

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
import xarray, h5netcdf, scipy.interpolate  # which change filters of warnings
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
    "FMUs are opened by threads at once, also by a process that is forked meanwhile": """
opened = []
threads = together(lambda _: [opened.append(Fmu(PACKED)) for _ in range(TRIES)], 3)
child = os.fork()
if child == 0:
    signal.alarm(60)
    Fmu(PACKED).close()
    os._exit(7)
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
for thread in threads:
    thread.join()
assert len(opened) == 3 * TRIES and all(fmu.variables for fmu in opened)
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
                within += bool(wheel._moves)
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
    "who hears what the FMU says may call it on any thread": """
import logging
class Asks(logging.Filter):
    "Reads the wheel, and steps another one, on another thread."
    def filter(self, record):
        thread = threading.Thread(target=lambda: answers.append((wheel.time, other.step(1e-3))), daemon=True)
        thread.start()
        thread.join(10.0)
        late.append(thread.is_alive())
        heard.append(record.getMessage().removeprefix("wheel: "))

logger = logging.getLogger("wheelrail.fmu")
logger.setLevel(logging.INFO)
logger.addFilter(Asks())
with Fmu(PACKED) as fmu:
    for k in range(TRIES):
        heard, late, answers = [], [], []
        other = Wheel(fmu, START, name="other")
        with Wheel(fmu, START) as wheel:
            wheel.record("wheel.omega")
            saved = wheel.save()
            for call in (
                lambda: wheel.set({"drive.load": -1.0}), lambda: wheel.set({"drive.omega": 3.0}), lambda: wheel.step(1e-3),
                lambda: wheel.step(-1.0), lambda: other.restore(saved), lambda: wheel.set({"drive.load": 1e2}), lambda: wheel.step(1e-3),
            ):
                try:
                    call()
                except Refused:
                    pass
        assert not any(late) and len(answers) == len(heard) >= 4, (late, heard)
        said = [str(message) for message in wheel.log]
        assert [text for text in heard if not text.startswith("other: ")] == said and len(said) >= 3, (heard, said)
        other.close()
print(*heard, sep="\\n")
""",
    "Ctrl-C at any line of a restore": """
import wheelrail.instances, wheelrail.fmu, wheelrail.records
FILES = {module.__file__ for module in (wheelrail.instances, wheelrail.fmu, wheelrail.records)}

def interrupted(call, line):
    "True if Ctrl-C came before the line of that number of the call."
    def count(frame, event, _):
        nonlocal line
        if frame.f_code.co_filename in FILES and event in ("line", "return"):
            line -= 1
            if line == 0:
                raise KeyboardInterrupt
        return count
    sys.settrace(count)
    try:
        call()
    except KeyboardInterrupt:
        return True
    finally:
        sys.settrace(None)
    return False

with Fmu(PACKED) as fmu, Wheel(fmu, START) as plain:
    recorder = plain.record("wheel.omega")
    for _ in range(6):
        plain.step(1e-3)
    expected, back, line = recorder.dataset(), 0, 0
    going = True
    while going:
        line += 1
        with Wheel(fmu, START) as wheel:
            recorder = wheel.record("wheel.omega")
            wheel.step(1e-3)
            saved = wheel.save()
            for _ in range(3):
                wheel.step(1e-3)
            wheel.set_rates({"drive.load": 1e6})
            going = interrupted(lambda: wheel.restore(saved), line)
            reached = wheel.slave.reached()
            assert abs(wheel.time - reached) < 1e-12, (line, wheel.time, reached)
            assert recorder.dataset().time.values[-1] == wheel.time
            back += wheel.time == 1e-3
            if wheel.time > 1e-3:  # where it was; a state that is set has its own rates
                wheel.set_rates({"drive.load": 0.0})
            while wheel.time < 5.5e-3:
                wheel.step(1e-3)
            assert recorder.dataset().identical(expected), line
    print(f"{line - 1} lines, {back - 1} of them after the state was set")
    assert line > 20 and back > 3
""",
    "a file lies where it was when it was named": """
os.chdir(FOLDER)
for folder in ("here", "there"):
    os.makedirs(folder, exist_ok=True)
run = wheelrail.simulate(START, stop=2e-3, fmu=PACKED)
to_netcdf = type(run).to_netcdf
def elsewhere(*arguments, **named):
    os.chdir(FOLDER + "/there")
    return to_netcdf(*arguments, **named)
type(run).to_netcdf = elsewhere
from wheelrail import page
draw = page.run_page
page.run_page = lambda *given: os.chdir(FOLDER + "/there") or draw(*given)
os.chdir(FOLDER + "/here")
assert str(page.write("run.html", run)) == "run.html"
with Fmu(PACKED) as fmu:
    for k in range(TRIES):
        os.chdir(FOLDER + "/here")
        wheelrail.save(run, f"run{k}.nc")
        os.chdir(FOLDER + "/here")
        with Wheel(fmu, START | {"wheel.profile_save": f"worn{k}.csv"}) as wheel:
            wheel.step(1e-3)
            os.chdir(FOLDER + "/there")
            assert wheel.get("wheel.profile_save") == f"worn{k}.csv"
assert len(os.listdir(FOLDER + "/here")) == 2 * TRIES + 1 and not os.listdir(FOLDER + "/there"), os.listdir(FOLDER + "/there")
""",
    "pictures and classes of one's own are drawn and loaded beside a notebook": """
import builtins, importlib, pathlib
import matplotlib
matplotlib.use("svg")
import matplotlib.pyplot as plt
from wheelrail import analysis, own, plots, plots_sweep
from wheelrail.sweep_table import DRY, EXTENSION
matplotlib.rcParams["lines.linewidth"] = 5.0
mine = plt.figure()

def state():
    return {
        "style": dict(matplotlib.rcParams), "backend": plt.get_backend(), "figures": plt.get_fignums(), "path": list(sys.path),
        "modules": [name for name in ("mine", "helper", "deeper") if name in sys.modules], "import": builtins.__import__,
    }

def watch():
    while not done:
        seen.append({name: value for name, value in state().items() if value != before[name]})

for name, text in (
    ("mine", "import helper\\nimport time\\ntime.sleep(0.02)\\nclass P:\\n    def step(self, h):\\n        import deeper, packed.inner"
     "\\n        return helper.value + deeper.value + packed.inner.value"),
    ("helper", "from deeper import value\\nimport time\\ntime.sleep(0.02)"), ("deeper", "import dataclasses\\n@dataclasses.dataclass\\nclass D:\\n    a: 'int' = 2\\nvalue = D().a"),
    ("packed/__init__", "from . import inner"), ("packed/inner", "value = 3"),
):
    pathlib.Path(FOLDER, name).parent.mkdir(exist_ok=True)
    pathlib.Path(FOLDER, f"{name}.py").write_text(text)

class Protocol:
    def step(self, h):
        pass

row = {"speed": 10.0, "stopping distance": 50.0, DRY: 40.0, EXTENSION: 25.0}
done, seen, before = False, [], state()
sampler = threading.Thread(target=watch)
sampler.start()
for k in range(max(TRIES // 4, 2)):
    assert plots_sweep.draw_sweep(FOLDER + "/sweep.png", [row, row | {"speed": 20.0}], ["speed"], "stops") is None
    analysis.save(FOLDER + "/line.png", lambda axis: axis.semilogx([1, 2], [3, 4]))
    assert own.find("mine:P", FOLDER, "brake.protection", Protocol).load()().step(0.0) == 7
done = True
sampler.join()
print(len(seen), "samples")
assert len(seen) > 30 and not any(seen), [change for change in seen if change][:1]
assert plots.subplots(figsize=(2, 2))[1].plot([1, 2])[0].get_linewidth() == 1.3 and plt.plot([1, 2])[0].get_linewidth() == 5.0
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


# Cases that load for a tenth of a second or more at every try.
SLOW = (
    "nothing changes while it loads, runs and closes", "records of threads that open FMUs are where they were meant",
    "a file lies where it was when it was named",
)  # fmt: skip


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("version", ["FMI 2.0", "FMI 3.0"])
def test_the_process_stays_as_it_was_and_every_call_is_answered(case, version, request, tmp_path):
    file = request.getfixturevalue("packed" if version == "FMI 2.0" else "packed3")
    for needed in ("xarray", "h5netcdf", "plotly"):
        pytest.importorskip(needed)
    tries = (10, 3) if case not in SLOW else (3, 1)
    command = [sys.executable, "-c", HEAD + CASES[case], str(file.resolve()), str(tmp_path), str(tries[version == "FMI 3.0"])]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    print(done.stdout, done.stderr)
    assert done.returncode == 0, f"{done.returncode}: {done.stderr[-2000:]}"
