"""Steps of a trial: what a new user does on the first day, each with what it took in 0.1.0 and its lines of code now."""

import inspect
import sys
from pathlib import Path


class Trial:
    """Steps in order. Each is a function that does one thing with the package and returns what it found, as a text."""

    def __init__(self, who):
        self.who, self.steps = who, []

    def step(self, task, before):
        """Adds a step: `task` is what the user wants, `before` what came of it in 0.1.0."""
        return lambda function: self.steps.append((task, before, function)) or function

    def run(self, out):
        """Takes all steps, prints a line for each, and returns the number of lines of code by task. A step that does not
        work raises."""
        out = Path(out)
        out.mkdir(parents=True, exist_ok=True)
        print(f"{self.who}\n\n| step | 0.1.0 | now | lines |\n|---|---|---|---|")
        counts = {}
        for task, before, function in self.steps:
            found = function(out)
            counts[task] = lines_of(function)
            print(f"| {task} | {before} | {found} | {counts[task]} |", flush=True)
        return counts

    def main(self):
        """The command: results go to the directory that the first argument names."""
        self.run(sys.argv[1] if len(sys.argv) > 1 else "results/trials")


def lines_of(function):
    """Lines of code of a step: without decorator, head, docstring, checks and what it reports."""
    body = inspect.getsource(function).split("\n")
    start = next(k for k, line in enumerate(body) if line.startswith("def ")) + 1
    told = ("assert", "return", '"""', "#")
    return sum(bool(line.strip()) and not line.strip().startswith(told) for line in body[start:])
