"""Makes wheelrail_ref.csv from wheelrail_in.csv with the settings of wheelrail_ref.opt: `make describe`.

    python3 examples/reference/make.py --binary target/release/wheelrail

The master is that of the command line, in one process with the slave. As in most masters inputs hold over a step the values that
the table has, linearly between its rows, at the beginning of the step.
"""

import argparse
import csv
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

HERE = Path(__file__).parent
OUTPUTS = (
    "wheel.velocity", "wheel.omega", "contact.force_x", "contact.force_y", "contact.creepage", "brake.torque_actual",
    "temperature.wheel_max",
)  # fmt: skip


def held(rows, step, stop):
    """The scenario of the command line that holds values: two rows for every step."""
    times = [row[0] for row in rows]
    for k in range(round(stop / step)):
        begin, end = k * step, (k + 1) * step
        after = next(i for i, time in enumerate(times) if time > begin + 1e-9)
        share = (begin - times[after - 1]) / (times[after] - times[after - 1])
        values = [a + share * (b - a) for a, b in zip(rows[after - 1][1:], rows[after][1:])]
        yield from ([begin, *values], [end, *values])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", type=Path, default=Path("target/release/wheelrail"))
    options = parser.parse_args()
    with open(HERE / "wheelrail_ref.opt") as file:
        settings = {name: float(value) for name, value in (line.split(",") for line in file)}
    with open(HERE / "wheelrail_in.csv") as file:
        header, *rows = csv.reader(file)
    rows = [[float(value) for value in row] for row in rows]
    step, stop = settings["StepSize"], settings["StopTime"]
    with TemporaryDirectory() as directory:
        scenario = Path(directory) / "held.csv"
        with open(scenario, "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(header)
            writer.writerows(held(rows, step, stop))
        command = [
            options.binary, "simulate", f"--scenario={scenario}", f"--step={step}", f"--stop={stop}",
            f"--outputs={','.join(OUTPUTS)}", f"--out={HERE / 'wheelrail_ref.csv'}",
        ]  # fmt: skip
        subprocess.run(command, check=True)


if __name__ == "__main__":
    main()
