"""The notebook runs from top to bottom, what it prints is true, and it is stored with what a run gives."""

import re
from contextlib import suppress

import nbformat
import pytest
from conftest import ROOT
from nbclient import NotebookClient

NOTEBOOK = ROOT / "examples" / "ex10_notebook.ipynb"
PICTURES = 4


def outputs(notebook):
    """All outputs of the cells."""
    return [output for cell in notebook.cells for output in cell.get("outputs", [])]


def printed(notebook):
    """What the cells print: words, and the numbers among them."""
    words = "".join(output.get("text", "") for output in outputs(notebook)).split()
    numbers = []
    for word in words:
        with suppress(ValueError):
            numbers.append(float(word.strip(",")))
    return words, numbers


def pictures(notebook):
    """Number of pictures."""
    return sum("image/png" in output.get("data", {}) for output in outputs(notebook))


@pytest.fixture(scope="module")
def stored():
    """The notebook as it is committed."""
    return nbformat.read(NOTEBOOK, as_version=4)


def test_the_notebook_is_stored_with_all_its_outputs_and_small(stored):
    code = [cell for cell in stored.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1)), "run it from top to bottom"
    assert pictures(stored) == PICTURES and not any(output.output_type == "error" for output in outputs(stored))
    assert NOTEBOOK.stat().st_size < 250_000


def test_the_notebook_runs_from_top_to_bottom(packed, monkeypatch, stored):
    monkeypatch.setenv("WHEELRAIL_FMU", str(packed.resolve()))
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    for cell in (cell for cell in notebook.cells if cell.cell_type == "code"):
        cell.outputs = []
    NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(NOTEBOOK.parent)}}).execute()
    text = "".join(output.get("text", "") for output in outputs(notebook))
    print(text)
    assert "locked: True" in text and "twice the same: True" in text
    adhesion = float(re.search(r"adhesion now ([\d.]+)", text)[1])
    low, high = map(float, re.search(r"shear over pressure ([\d.]+) to ([\d.]+)", text).groups())
    assert 0.02 < adhesion < 0.12 and low <= high < 1.01 * low and abs(low - adhesion) < 0.01 * adhesion
    assert pictures(notebook) == PICTURES
    (words, numbers), (kept, stored_numbers) = printed(notebook), printed(stored)
    assert len(words) == len(kept) and numbers == pytest.approx(stored_numbers, rel=0.02), "store the outputs of a new run"
