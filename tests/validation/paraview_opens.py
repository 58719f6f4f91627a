#!/usr/bin/env python3
"""Opens every .pvd of a results directory in ParaView, steps through all times and renders grains and cracks.

usage: paraview_opens.py RESULTS_DIRECTORY [PICTURE_DIRECTORY]

Runs itself again under pvpython (and xvfb-run where there is no display). Saves one picture a test. Exit code 0: fine; 1:
something is wrong (said in words); 77: ParaView is not installed (skipped).
"""
import os
import pathlib
import shutil
import subprocess
import sys

SKIPPED = 77
GRAIN_ARRAYS = ("damage", "stress_xx_MPa", "stress_yy_MPa", "stress_xy_MPa", "sigma_1_MPa", "sigma_3_MPa", "mean_stress_MPa", "grain")
CRACK_ARRAYS = ("mode", "time", "step", "opening_m", "energy_J")


def start_paraview():
    pvpython = shutil.which("pvpython")
    if not pvpython:
        print("skipped: pvpython is not installed (Debian: paraview and python3-paraview)")
        sys.exit(SKIPPED)
    command = [pvpython, os.path.abspath(__file__), "--inside", *sys.argv[1:]]
    if not os.environ.get("DISPLAY"):
        if not shutil.which("xvfb-run"):
            print("skipped: no display and no xvfb-run")
            sys.exit(SKIPPED)
        command = ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", *command]
    sys.exit(subprocess.run(command, check=False).returncode)


def parts(reader):
    """The two grids of the present time: triangles and lines."""
    from paraview import servermanager
    data = servermanager.Fetch(reader)

    def grid(block):   # ParaView wraps each part once more
        while block is not None and block.IsA("vtkMultiBlockDataSet"):
            block = block.GetBlock(0) if block.GetNumberOfBlocks() else None
        return block

    return grid(data.GetBlock(0)), grid(data.GetBlock(1))


def check(pvd, pictures):
    from paraview import simple
    found = []
    reader = simple.PVDReader(FileName=str(pvd))
    times = list(reader.TimestepValues)
    written = pvd.read_text().count('part="0"')
    if len(times) != written:
        found.append(f"{pvd.name}: {len(times)} times instead of {written}")
    if any(b <= a for a, b in zip(times, times[1:])):
        found.append(f"{pvd.name}: times do not grow")
    cracks_before, triangles = 0, 0
    for time in times:
        reader.UpdatePipeline(time)
        grains, cracks = parts(reader)
        triangles = grains.GetNumberOfCells()
        if triangles == 0 or grains.GetCellType(0) != 5:
            found.append(f"{pvd.name}: no triangles at {time}")
        for name in GRAIN_ARRAYS:
            if not grains.GetCellData().GetArray(name):
                found.append(f"{pvd.name}: no {name} at {time}")
        if not grains.GetPointData().GetArray("displacement_m"):
            found.append(f"{pvd.name}: no displacement at {time}")
        lines = cracks.GetNumberOfCells() if cracks else 0
        if lines < cracks_before:
            found.append(f"{pvd.name}: cracks vanish at {time}")
        cracks_before = lines
        if lines:
            for name in CRACK_ARRAYS:
                if not cracks.GetCellData().GetArray(name):
                    found.append(f"{pvd.name}: cracks without {name} at {time}")
            modes = cracks.GetCellData().GetArray("mode").GetRange()
            if modes[0] < 0 or modes[1] > 1:
                found.append(f"{pvd.name}: crack modes {modes}")
    if times:
        render(reader, times, pictures / (pvd.stem + "-paraview.png"))
    print(f"{pvd.name}: {len(times)} times, {triangles} triangles, {cracks_before} cracks at the end")
    simple.Delete(reader)
    return found


def render(reader, times, file):
    """Grains by major principal stress and cracks by mode at the last time."""
    from paraview import simple
    view = simple.CreateRenderView(ViewSize=[900, 1000], Background=[1, 1, 1], UseColorPaletteForBackground=0, OrientationAxesVisibility=0)
    view.CameraParallelProjection = 1
    warped = simple.WarpByVector(Input=reader, Vectors=["POINTS", "displacement_m"], ScaleFactor=1.0)
    warped.UpdatePipeline(times[-1])
    view.ViewTime = times[-1]
    grains = simple.ExtractBlock(Input=warped, Selectors=["/Root/Block0"])
    cracks = simple.ExtractBlock(Input=warped, Selectors=["/Root/Block1"])
    shown = simple.Show(grains, view)
    simple.ColorBy(shown, ("CELLS", "sigma_1_MPa"))
    simple.GetColorTransferFunction("sigma_1_MPa").ApplyPreset("Grayscale", True)
    shown.RescaleTransferFunctionToDataRange(False, True)
    bar = simple.GetScalarBar(simple.GetColorTransferFunction("sigma_1_MPa"), view)
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    shown.SetScalarBarVisibility(view, True)
    lines = simple.Show(cracks, view)
    simple.ColorBy(lines, ("CELLS", "mode"))
    simple.GetColorTransferFunction("mode").RGBPoints = [0.0, 0.0, 0.45, 0.70, 1.0, 0.84, 0.37, 0.0]
    lines.LineWidth = 3.0
    simple.ResetCamera(view)
    simple.Render(view)
    simple.SaveScreenshot(str(file), view)
    for proxy in (cracks, grains, warped, view):
        simple.Delete(proxy)


def main():
    arguments = [a for a in sys.argv[1:] if a != "--inside"]
    if not arguments:
        raise SystemExit(__doc__)
    if "--inside" not in sys.argv:
        start_paraview()
    results = pathlib.Path(arguments[0])
    pictures = pathlib.Path(arguments[1] if len(arguments) > 1 else arguments[0])
    pictures.mkdir(parents=True, exist_ok=True)
    collections = sorted(results.glob("*.pvd"))
    if not collections:
        raise SystemExit(f"no .pvd in {results}")
    found = [line for pvd in collections for line in check(pvd, pictures)]
    for line in found:
        print("wrong:", line)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
