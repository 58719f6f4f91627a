#!/usr/bin/env python3
"""Runs a small test on processors of several ages, by an emulator: none may need instructions that its processor has not.

usage: old_processor.py PROGRAM

Compares with the portable kernels on this processor. Exit code 0: fine; 1: something is wrong (said in words); 77: qemu-x86_64 is not installed (skipped).
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
PROCESSORS = ("Nehalem", "Haswell")   # without AVX; with AVX2, without AVX-512
JOB = """
[specimen]
shape = "rectangle"
width = "40 mm"
height = "80 mm"
[specimen.grains]
diameter = { distribution = "uniform", minimum = "7 mm", maximum = "11 mm" }
[material]
elastic_preset = "augig-flexible"
strength_preset = "augig-table7"
[numerics]
accuracy = "10 %"
[[test]]
kind = "direct-tension"
"""


def strength(command, folder, name, **environment):
    done = subprocess.run([*command, "run", "-", "--json", "--quiet", "--keep", "numbers", "--threads", "1", "--out", os.path.join(folder, name)], input=JOB, check=False, capture_output=True, text=True,
                          env={**os.environ, **environment})
    if done.returncode != 0:
        print(f"wrong: {name}: exit code {done.returncode}: {done.stderr}")
        sys.exit(1)
    return json.loads(done.stdout)["properties"]["DTS_MPa"]["median"]


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    emulator = shutil.which("qemu-x86_64")
    if not emulator:
        print("skipped: qemu-x86_64 is not installed (Debian: qemu-user)")
        sys.exit(SKIPPED)
    wrong = False
    with tempfile.TemporaryDirectory() as folder:
        here = strength([sys.argv[1]], folder, "here", FELDSPAR_KERNELS="portable")
        print(f"portable kernels on this processor: DTS {here:.4f} MPa")
        for processor in PROCESSORS:
            there = strength([emulator, "-cpu", processor, sys.argv[1]], folder, processor)
            print(f"{processor}: DTS {there:.4f} MPa")
            wrong = wrong or abs(there / here - 1) > 0.01   # rounding takes a breaking specimen another way; a tensile test of 40 grains hardly
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
