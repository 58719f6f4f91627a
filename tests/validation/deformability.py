#!/usr/bin/env python3
"""What figures 8 and 9 of the paper say, evaluated on the results of examples/deformability.

    tests/validation/deformability.py RESULTS [RESULTS ...]

Each RESULTS is a directory of `feldspar run` (job.toml or short.toml, whole or in parts). Differences are paired: the same packing with two
models. Prints, for every variant, the strengths over the packings, and for every statement the numbers packing by packing.
"""

import csv
import json
import statistics
import sys
from collections import defaultdict
from pathlib import Path


def read(directories):
    """(variant, kind) -> {seed: test}, with the test's directory."""
    tests = defaultdict(dict)
    for directory in map(Path, directories):
        for test in json.loads((directory / "summary.json").read_text())["tests"]:
            test["directory"] = directory
            tests[test["variant"], test["kind"]][test["seed"]] = test
    return tests


def history(test):
    lines = (test["directory"] / test["files"]["history"]).read_text().splitlines()
    rows = csv.DictReader(line for line in lines if not line.startswith("#"))
    return [(float(r["axial_strain"]), float(r["axial_stress_MPa"])) for r in rows if r["axial_stress_MPa"]]


def strain_of_drop(test):
    """Strain from the peak to 80 % of it, over the strain at the peak: 0 drops at once. A record that ends earlier has its last row."""
    curve = history(test)
    at = max(range(len(curve)), key=lambda i: curve[i][1])
    peak_strain, peak = curve[at]
    after = next((strain for strain, stress in curve[at:] if stress <= 0.8 * peak), curve[-1][0])
    return after / peak_strain - 1.0


def spread(values):
    return f"{statistics.median(values):.4g} ({min(values):.4g} to {max(values):.4g})"


def by_seed(pairs, digits=3):
    return ", ".join(f"{seed}: {value:.{digits}g}" for seed, value in pairs)


def paired(tests, kind, a, b, value=lambda t: t["peak_stress_MPa"]):
    left, right = tests[a, kind], tests[b, kind]
    return [(seed, value(left[seed]) / value(right[seed])) for seed in sorted(left) if seed in right]


def statement(text, pairs, holds):
    if pairs:
        kept = sum(holds(ratio) for _, ratio in pairs)
        print(f"  {text}\n      {by_seed(pairs)}   holds on {kept} of {len(pairs)} packings")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    tests = read(sys.argv[1:])
    ucs, dts, bts = "uniaxial-compression", "direct-tension", "brazilian"
    print("Strengths, MPa: median (range); E before damage, GPa; ms a step")
    for (variant, kind), found in tests.items():
        strengths = [t["peak_stress_MPa"] for t in found.values()]
        grades = "".join(t["quasi_static"] for t in found.values())
        elastic = [t["E_initial_GPa"] for t in found.values() if t.get("E_initial_GPa")]
        cost = statistics.median(t["ms_per_step"] for t in found.values())
        print(f"  {variant:42} {kind:21} {spread(strengths):28} grades {grades:6} "
              f"{'E ' + spread(elastic) if elastic else '':32} {cost:.3g} ms, largest energy residual "
              f"{100 * max(t['energy_residual'] for t in found.values()):.2g} %")
    for law in ("brittle", "bilinear"):
        rigid, flexible = f"rigid, {law}", f"flexible 25.8, {law}"
        rough, smooth = f"inner particles, {law}", f"inner particles, edge normal, {law}"
        print(f"\n{law} law")
        statement("figure 8: UCS, flexible over inner particles with the edge's normal: above 1", paired(tests, ucs, flexible, smooth), lambda r: r > 1)
        statement("figure 8: UCS, flexible over inner particles with the normal of the centres: below 1", paired(tests, ucs, flexible, rough), lambda r: r < 1)
        for inner in (smooth, rough):
            statement(f"figure 8: strain of the drop after the peak, {inner} over flexible: above 1 (less brittle)",
                      paired(tests, ucs, inner, flexible, strain_of_drop), lambda r: r > 1)
        statement("figure 9: strain of the drop after the peak, flexible over rigid: about 1", paired(tests, ucs, flexible, rigid, strain_of_drop), lambda r: 0.5 < r < 2)
        if law == "brittle":
            statement("figure 9: UCS, flexible over rigid: unchanged, within 5 %", paired(tests, ucs, flexible, rigid), lambda r: abs(r - 1) < 0.05)
        else:
            statement("figure 9: UCS, flexible over rigid: above 1", paired(tests, ucs, flexible, rigid), lambda r: r > 1)
        statement("figure 9: stress of crack initiation (1 % of the cracks at the peak), flexible over rigid: above 1",
                  paired(tests, ucs, flexible, rigid, lambda t: t["sigma_ci_crack_count_MPa"]), lambda r: r > 1)
        for variant in (rigid, flexible):
            slopes = [(s, t["E_tangent_GPa"] / t["E_initial_GPa"]) for s, t in sorted(tests[variant, ucs].items()) if t.get("E_initial_GPa")]
            statement(f"figure 9: slope at half the peak over the initial one, {variant}: {'below 0.95' if variant == rigid else 'above 0.95'}", slopes,
                      (lambda r: r < 0.95) if variant == rigid else (lambda r: r > 0.95))
        for variant in (rigid, flexible, rough, smooth):
            pairs = [(s, t["peak_stress_MPa"] / tests[variant, dts][s]["peak_stress_MPa"]) for s, t in sorted(tests[variant, bts].items()) if s in tests[variant, dts]]
            statement(f"figure 11: BTS over DTS, {variant}: {'below' if law == 'brittle' else 'above'} 1", pairs, (lambda r: r < 1) if law == "brittle" else (lambda r: r > 1))


if __name__ == "__main__":
    main()
