"""The first picture that somebody draws with fmpy: results without names, in either version of FMI."""

import fmpy
import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.util import create_plotly_figure, plot_result

graphs = pytest.importorskip("plotly.graph_objects", reason="plotly is not installed")
pytest.importorskip("narwhals", reason="narwhals, which plotly needs to draw, is not installed (requirements/browser.txt)")
MOST = 17  # curves that fmpy since 0.3.24 draws: a space of 0.06 between pictures leaves no room for more


@pytest.fixture(params=["packed", "packed3"])
def result(request):
    """What `simulate_fmu` gives without being asked for anything."""
    return simulate_fmu(str(request.getfixturevalue(request.param)), stop_time=0.01)


def test_the_default_result_has_the_outputs_and_no_points_of_profiles(result, fmu):
    scalars = {v.name for v in fmu.description.modelVariables if v.causality == "output"}
    columns = {name: result[name].ndim for name in result.dtype.names[1:]}
    arrays = {name for name, dimensions in columns.items() if dimensions == 2}
    print(f"{len(columns)} columns, {len(arrays)} of them arrays")
    assert columns.keys() - arrays == scalars and len(scalars) == 106 and not any("[" in name for name in columns)
    # FMI 3.0 has profiles as arrays.
    assert len(arrays) == (29 if result.modelDescription.fmiVersion == "3.0" else 0)


def test_fmpy_draws_the_first_columns_of_the_default_result(result, monkeypatch):
    names, shown = result.dtype.names[1 : MOST + 1], []
    figure = create_plotly_figure(result.copy(), names=names)
    assert [trace.name for trace in figure.data] == list(names)
    assert all(len(trace.y) == len(result) and np.all(np.isfinite(np.asarray(trace.y, float))) for trace in figure.data)
    monkeypatch.setattr(graphs.Figure, "show", lambda figure: shown.append(figure))
    plot_result(result.copy(), names=names)
    assert len(shown) == 1 and len(shown[0].data) == MOST


def test_the_limit_of_fmpy_is_that_of_any_fmu():
    """When this fails fmpy draws more: then `names` can be left out, and the sentence in docs/coupling.md goes."""
    assert tuple(map(int, fmpy.__version__.split("."))) >= (0, 3, 24)
    columns = lambda count: np.zeros(5, dtype=[("time", float)] + [(f"y{k}", float) for k in range(count)])
    assert len(create_plotly_figure(columns(MOST)).data) == MOST
    with pytest.raises(ValueError, match="Vertical spacing cannot be greater than"):
        create_plotly_figure(columns(MOST + 1))
