"""The contact patch for ParaView: a series of images over x and z (VTK XML, `.vti`) and its index over time (`.pvd`).

    python -m wheelrail export run.nc --out film    # open film/patch.pvd

Displacement, stress and temperature of the whole bodies: `cargo run --release --example fields` in a checkout.
"""

from __future__ import annotations

import base64
import struct
from argparse import Namespace
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import numpy as np

from .files import BadFile
from .grid import patch
from .output import write
from .records import made_of

if TYPE_CHECKING:
    import xarray

HEAD = '<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt32">\n'


def image(values: Mapping[str, np.ndarray], x: np.ndarray, z: np.ndarray) -> str:
    """Text of an image: arrays (z, x) by name over evenly spaced places `x` and `z` [m], in the plane y = 0."""
    extent = f"0 {len(x) - 1} 0 0 0 {len(z) - 1}"
    spacing = f"{(x[-1] - x[0]) / (len(x) - 1):.9g} 1 {(z[-1] - z[0]) / (len(z) - 1):.9g}"
    arrays = "".join(
        f'<DataArray type="Float32" Name={quoteattr(name)} format="binary">{_packed(array)}</DataArray>\n' for name, array in values.items()
    )
    return (
        HEAD.format(kind="ImageData")
        + f'<ImageData WholeExtent="{extent}" Origin="{x[0]:.9g} 0 {z[0]:.9g}" Spacing="{spacing}">\n<Piece Extent="{extent}">\n'
        + f"<PointData>\n{arrays}</PointData>\n</Piece>\n</ImageData>\n</VTKFile>\n"
    )


def _packed(array: np.ndarray) -> str:
    """Numbers as VTK has them in its text: their length in bytes, then they, in base64. The first axis of an image runs fastest."""
    content = np.ascontiguousarray(array, "<f4").tobytes()
    return base64.b64encode(struct.pack("<I", len(content)) + content).decode()


def index(times: np.ndarray, names: list[str]) -> str:
    """Text of the index of a series: file names and their times [s]."""
    sets = "".join(f'<DataSet timestep="{time:.9g}" file={quoteattr(name)}/>\n' for time, name in zip(times, names))
    return HEAD.format(kind="Collection") + f"<Collection>\n{sets}</Collection>\n</VTKFile>\n"


def export(run: xarray.Dataset, folder: str | Path) -> Path:
    """Writes the patch of a record made with `patch=True` into a folder; returns the path of the index, `patch.pvd`."""
    folder, place = Path(folder), Path(folder).absolute()  # the process may go elsewhere meanwhile
    grid = patch(run)
    names = [f"patch_{k:05d}.vti" for k in range(grid.sizes["time"])]
    x, z = grid["x"].values, grid["z"].values
    for k, name in enumerate(names):
        write(place / name, image({f"{key} [{grid[key].attrs['units']}]": grid[key].values[k] for key in grid.data_vars}, x, z))
    write(place / "patch.pvd", index(grid["time"].values, names))
    return folder / "patch.pvd"


def add_command(commands: Any) -> None:
    """Adds the command to those of `wheelrail`."""
    command = commands.add_parser("export", help="the contact patch of a record over time, for ParaView")
    command.add_argument("run", type=Path, help="NetCDF record of a run with patch=True")
    command.add_argument("--out", type=Path, help="folder; default: beside RUN, with its name")


def run(options: Namespace) -> None:
    """Writes the files and says where they are."""
    if options.run.suffix != ".nc":
        raise BadFile(f"{options.run}: expected a record, .nc")
    folder = options.out or options.run.with_suffix("")
    written = made_of(options.run, lambda run: export(run, folder))
    print(f"written: {written}, to be opened in ParaView")
