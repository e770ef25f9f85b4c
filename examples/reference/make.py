"""Makes wheelrail_ref.csv from wheelrail_in.csv with the settings of wheelrail_ref.opt: `make describe`.

    .venv/bin/python examples/reference/make.py --fmu target/wheelrail.fmu

As in most masters inputs hold over a step the values that the table has, linearly between its rows, at the beginning of the step.
"""

import argparse
from pathlib import Path

import numpy as np
import pandas as pd

import wheelrail
from wheelrail.fmu import default_path
from wheelrail.times import at

HERE = Path(__file__).parent
OUTPUTS = (
    "wheel.velocity", "wheel.omega", "contact.force_x", "contact.force_y", "contact.creepage", "brake.torque_actual",
    "temperature.wheel_max",
)  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fmu", type=Path, default=default_path(), help="default: %(default)s")
    options = parser.parse_args()
    settings = pd.read_csv(HERE / "wheelrail_ref.opt", header=None, index_col=0)[1]
    table = pd.read_csv(HERE / "wheelrail_in.csv", index_col="time")
    step, stop = settings["StepSize"], settings["StopTime"]
    begins = np.array([at(k, step) for k in range(round(stop / step))])
    # Two samples for every step, which holds its value.
    times = np.column_stack([begins, [*begins[1:], stop]]).ravel()
    inputs = {name: (times, np.repeat(np.interp(begins, table.index, table[name]), 2)) for name in table}
    run = wheelrail.simulate({}, inputs, stop=stop, step=step, outputs=OUTPUTS, fmu=options.fmu, progress=False)
    wheelrail.table(run)[list(OUTPUTS)].to_csv(HERE / "wheelrail_ref.csv", lineterminator="\n")


if __name__ == "__main__":
    main()
