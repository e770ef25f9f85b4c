"""The notebook runs from top to bottom, and what it prints is true."""

import re

import nbformat
from conftest import ROOT
from nbclient import NotebookClient

NOTEBOOK = ROOT / "examples" / "ex10_notebook.ipynb"


def test_the_notebook_runs_from_top_to_bottom(packed, monkeypatch):
    monkeypatch.setenv("WHEELRAIL_FMU", str(packed.resolve()))
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    assert all(not cell.get("outputs") for cell in notebook.cells), "commit it without outputs"
    NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(NOTEBOOK.parent)}}).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    text = "".join(output.get("text", "") for output in outputs)
    print(text)
    assert "locked: True" in text and "twice the same: True" in text
    adhesion = float(re.search(r"adhesion now ([\d.]+)", text)[1])
    low, high = map(float, re.search(r"shear over pressure ([\d.]+) to ([\d.]+)", text).groups())
    assert 0.02 < adhesion < 0.12 and low <= high < 1.01 * low and abs(low - adhesion) < 0.01 * adhesion
    assert sum("image/png" in output.get("data", {}) for output in outputs) == 2
