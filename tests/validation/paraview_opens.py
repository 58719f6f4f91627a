#!/usr/bin/env python3
"""Exports a run for ParaView, opens every .pvd, steps through all times, looks at every block, and lets the script that lies beside each draw a picture.

usage: paraview_opens.py PROGRAM RESULTS_DIRECTORY [PICTURE_DIRECTORY]

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
CONTACT_ARRAYS = ("damage", "normal_force_N", "shear_force_N", "grain_a", "grain_b")
BLOCKS = ("grains", "grain_edges", "contacts", "cracks", "events")


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
        command = ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24 -noreset", *command]
    sys.exit(subprocess.run(command, check=False).returncode)


def blocks(reader):
    """The grids of the present time by their names."""
    from paraview import servermanager
    found = {}

    def walk(data, name):
        if data is None:
            return
        if not data.IsA("vtkMultiBlockDataSet"):
            found[name] = data
            return
        for number in range(data.GetNumberOfBlocks()):
            metadata = data.GetMetaData(number)
            own = metadata.Get(data.NAME()) if metadata is not None and metadata.Has(data.NAME()) else None
            walk(data.GetBlock(number), own if own in BLOCKS else name)

    walk(servermanager.Fetch(reader), "")
    return found


def check(pvd):
    from paraview import simple
    found = []
    reader = simple.PVDReader(FileName=str(pvd))
    times = list(reader.TimestepValues)
    written = pvd.read_text().count("<DataSet")
    if len(times) != written:
        found.append(f"{pvd.name}: {len(times)} times instead of {written}")
    if any(b <= a for a, b in zip(times, times[1:])):
        found.append(f"{pvd.name}: times do not grow")
    cracks_before, triangles, contacts = 0, 0, 0
    for time in times:
        reader.UpdatePipeline(time)
        parts = blocks(reader)
        if any(name not in parts for name in ("grains", "grain_edges", "contacts")):
            found.append(f"{pvd.name}: only the blocks {sorted(parts)} at {time}")
            continue

        def has(block, names):
            return [f"{pvd.name}: {block} without {name} at {time}" for name in names if not parts[block].GetCellData().GetArray(name)]

        triangles, contacts = parts["grains"].GetNumberOfCells(), parts["contacts"].GetNumberOfCells()
        if triangles == 0 or parts["grains"].GetCellType(0) != 5:
            found.append(f"{pvd.name}: no triangles at {time}")
        found += has("grains", GRAIN_ARRAYS)
        if contacts == 0 or parts["contacts"].GetCellType(0) != 3:
            found.append(f"{pvd.name}: no contacts at {time}")
        else:
            found += has("contacts", CONTACT_ARRAYS)
            damage = parts["contacts"].GetCellData().GetArray("damage").GetRange()
            if damage[0] < 0 or damage[1] >= 1:
                found.append(f"{pvd.name}: damage of contacts that are not broken: {damage}")
        for block in ("grains", "grain_edges", "contacts"):
            if not parts[block].GetPointData().GetArray("displacement_m"):
                found.append(f"{pvd.name}: {block} without displacement at {time}")
        lines = parts["cracks"].GetNumberOfCells() if "cracks" in parts else 0
        if lines < cracks_before:
            found.append(f"{pvd.name}: cracks vanish at {time}")
        cracks_before = lines
        if lines:
            found += has("cracks", CRACK_ARRAYS)
            modes = parts["cracks"].GetCellData().GetArray("mode").GetRange()
            if modes[0] < 0 or modes[1] > 1:
                found.append(f"{pvd.name}: crack modes {modes}")
    print(f"{pvd.name}: {len(times)} times, {triangles} triangles, {contacts} contacts, {cracks_before} cracks at the end")
    simple.Delete(reader)
    return found


def draw(pvd, pictures):
    """By the script that the program has written."""
    picture = pictures / (pvd.stem + "-paraview.png")
    picture.unlink(missing_ok=True)
    done = subprocess.run([shutil.which("pvpython"), str(pvd.with_suffix(".py")), str(picture)], check=False, capture_output=True, text=True)
    if done.returncode != 0 or not picture.exists() or picture.stat().st_size < 10_000:
        return [f"{pvd.stem}.py draws no picture: {done.stderr or done.stdout}"]
    return []


def main():
    arguments = [a for a in sys.argv[1:] if a != "--inside"]
    if len(arguments) < 2:
        raise SystemExit(__doc__)
    if "--inside" not in sys.argv:
        start_paraview()
    results = pathlib.Path(arguments[1])
    pictures = pathlib.Path(arguments[2] if len(arguments) > 2 else arguments[1])
    pictures.mkdir(parents=True, exist_ok=True)
    subprocess.run([arguments[0], "export", str(results), "--vtu"], check=True)
    collections = sorted((results / "paraview").glob("*.pvd"))
    if not collections:
        raise SystemExit(f"no .pvd in {results}")
    found = [line for pvd in collections for line in check(pvd) + draw(pvd, pictures)]
    for line in found:
        print("wrong:", line)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
