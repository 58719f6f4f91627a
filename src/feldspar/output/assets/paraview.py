# Shows a test of Feldspar in ParaView: grains coloured by a stress, contacts by their normal force, cracks by their mode, acoustic events by their magnitude.
#
#   paraview --script={{stem}}.py               opens the window
#   pvpython {{stem}}.py picture.png [TIME]     draws a picture of the last moment, or of the one at TIME
#
# In a window that is open: Tools > Python Shell > Run Script. Made by `feldspar export`, and made again by it: keep changes under another name.
import os
import sys

from paraview import servermanager
from paraview import simple as pv
from paraview.vtk.numpy_interface import dataset_adapter
import numpy

FIELD = "sigma_1_MPa"     # of the grains: also sigma_3_MPa, mean_stress_MPa, damage, stress_yy_MPa, grain
FIELD_TITLE = "sigma_1, MPa"
MAGNIFIED = 1.0           # the displacements

STEM = "{{stem}}"
FOLDER = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() and os.path.exists(os.path.join(os.path.dirname(os.path.abspath(__file__)), STEM + ".pvd")) else "{{folder}}"


def values(source, name):
    """All finite numbers of a field of the cells at the present time."""
    data = dataset_adapter.WrapDataObject(servermanager.Fetch(source)).CellData[name]
    parts = data.Arrays if hasattr(data, "Arrays") else [data]
    parts = [numpy.asarray(part, dtype=float).ravel() for part in parts if part is not None and hasattr(part, "__len__")]
    joined = numpy.concatenate(parts) if parts else numpy.zeros(0)
    return joined[numpy.isfinite(joined)]


def middle_range(source, name, symmetric=False):
    """From the 2nd to the 98th of a hundred values, so that a few at the tips of cracks do not take all colours."""
    found = values(source, name)
    if len(found) == 0:
        return 0.0, 1.0
    low, high = numpy.percentile(found, [2.0, 98.0])
    if symmetric:
        high = max(abs(low), abs(high))
        low = -high
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def coloured(source, view, field, preset, limits, title, width=None):
    shown = pv.Show(source, view)
    pv.ColorBy(shown, ("CELLS", field), separate=True)
    table = pv.GetColorTransferFunction(field, shown, separate=True)
    table.ApplyPreset(preset, True)
    table.RescaleTransferFunction(*limits)
    bar = pv.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    bar.TitleFontSize = bar.LabelFontSize = 11
    shown.SetScalarBarVisibility(view, True)
    if width:
        shown.LineWidth = width
    return shown, table, bar


def place(bar, height):
    bar.WindowLocation = "Any Location"
    bar.Position = [0.84, height]
    bar.ScalarBarLength = 0.28
    bar.RangeLabelFormat = bar.LabelFormat = "%-#6.4g"


def show():
    reader = pv.PVDReader(registrationName=STEM, FileName=os.path.join(FOLDER, STEM + ".pvd"))
    times = list(reader.TimestepValues) if hasattr(reader.TimestepValues, "__len__") else [reader.TimestepValues]
    time = times[-1]
    view = pv.GetActiveViewOrCreate("RenderView")
    view.CameraParallelProjection = 1
    view.InteractionMode = "2D"
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.ViewTime = time
    reader.UpdatePipeline(time)

    def block(name):
        part = pv.ExtractBlock(registrationName=name, Input=reader, Selectors=["//" + name])
        part.UpdatePipeline(time)
        if not part.PointData.GetArray("displacement_m"):
            return part
        warped = pv.WarpByVector(registrationName=name + " moved", Input=part, Vectors=["POINTS", "displacement_m"], ScaleFactor=MAGNIFIED)
        warped.UpdatePipeline(time)
        return warped

    grains, edges, contacts, cracks, events = (block(name) for name in ("grains", "grain_edges", "contacts", "cracks", "events"))
    triangles, _, bar = coloured(grains, view, FIELD, "Viridis (matplotlib)", middle_range(grains, FIELD), FIELD_TITLE)
    place(bar, 0.5)
    box = grains.GetDataInformation().GetBounds()
    triangles.Position = [0.0, 0.0, -1e-3 * (box[3] - box[2])]   # behind the lines that lie in their plane
    outline = pv.Show(edges, view)
    outline.ColorArrayName = [None, ""]
    outline.AmbientColor = outline.DiffuseColor = [0.25, 0.25, 0.25]
    outline.LineWidth = 1.0
    if len(values(contacts, "damage")):
        lines, _, _ = coloured(contacts, view, "normal_force_N", "Cool to Warm", middle_range(contacts, "normal_force_N", symmetric=True), "contact force, N (> 0: compression)", 2.0)
        pv.Hide(contacts, view)   # one click away: the eye beside "contacts moved"
        lines.SetScalarBarVisibility(view, False)
    if len(values(cracks, "mode")):
        lines, table, bar = coloured(cracks, view, "mode", "Cool to Warm", (0.0, 1.0), "crack", 3.0)
        table.InterpretValuesAsCategories = 1
        table.Annotations = ["0", "tensile", "1", "shear"]
        table.IndexedColors = [0.85, 0.10, 0.10, 1.0, 0.60, 0.0]
        place(bar, 0.15)
    if len(values(events, "magnitude")):
        points, _, _ = coloured(events, view, "magnitude", "Plasma (matplotlib)", middle_range(events, "magnitude"), "magnitude of events")
        points.PointSize = 8.0
        pv.Hide(events, view)
        points.SetScalarBarVisibility(view, False)
    pv.ResetCamera(view)
    scene = pv.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.AnimationTime = time
    return view, times


def main(arguments):
    view, times = show()
    if not arguments:
        pv.Render(view)
        return
    if len(arguments) > 1:
        wanted = float(arguments[1])
        view.ViewTime = min(times, key=lambda one: abs(one - wanted))
    view.ViewSize = [1400, 1200]
    pv.ResetCamera(view)
    pv.Render(view)
    pv.SaveScreenshot(arguments[0], view)


main([argument for argument in sys.argv[1:] if not argument.startswith("-")] if __name__ == "__main__" and os.path.basename(sys.argv[0]).endswith(".py") else [])
