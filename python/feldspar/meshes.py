"""Specimens and fields as meshes of pyvista."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional, Union

import numpy as np

from . import _core
from .files import _pyvista

if TYPE_CHECKING:
    import pyvista

__all__ = ["mesh"]


def mesh(source: Union[_core.Specimen, _core.Result], label: str = "end", *, scale: float = 0.0) -> "pyvista.UnstructuredGrid":
    """The triangles of a specimen, or the fields of a result, as a mesh of pyvista in metres.

    label: of the moment. scale: by how much displacements are enlarged in the mesh's places; 0: undeformed.
    Cell data: cell, phase; of a result stress_xx, stress_yy, stress_xy (Pa, compression positive) and damage. Point data: displacement (m). Raises MissingPackage without pyvista, InputError.
    """
    pyvista = _pyvista()
    specimen = source if isinstance(source, _core.Specimen) else source.specimen
    places = np.zeros((len(specimen.nodes), 3))
    places[:, :2] = specimen.nodes
    snapshot: Optional[_core.Snapshot] = None if isinstance(source, _core.Specimen) else source.snapshot(label)
    if snapshot is not None and scale != 0.0:
        places[:, :2] += scale * snapshot.displacement
    triangles = specimen.triangles
    grid = pyvista.UnstructuredGrid({pyvista.CellType.TRIANGLE: np.asarray(triangles)}, places)
    grid.cell_data["cell"] = specimen.triangle_cells
    grid.cell_data["phase"] = specimen.phases[specimen.triangle_cells]
    if snapshot is not None:
        displacement = np.zeros_like(places)
        displacement[:, :2] = snapshot.displacement
        grid.point_data["displacement"] = displacement
        for name in ("stress_xx", "stress_yy", "stress_xy", "damage"):
            grid.cell_data[name] = np.array(getattr(snapshot, name))
    return grid
