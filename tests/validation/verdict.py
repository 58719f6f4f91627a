#!/usr/bin/env python3
"""Does the grade of a test predict the true error of its strength?

    tests/validation/verdict.py RESULTS [RESULTS ...] > verdict.csv

Each RESULTS is a directory of `feldspar run` on a job whose variants differ in [variant.numerics] only. Variants whose names begin with "third" or "ninth" (of the
residual target of an accuracy of 0.5 %) are the references: the true error is the strength against their mean, and that of a third against the
ninth. Prints a row for every test that has a reference, and to the standard error how often each grade stood beside each true one.
"""

import csv
import json
import sys
from collections import Counter, defaultdict
from pathlib import Path

REFERENCES = ("third", "ninth")
EVIDENCE = ("error_estimate", "residual_median", "load_per_travel_time", "imbalance_mean", "residual_mean", "kinetic_over_strain")


def true_grade(kind, error):
    limit = 0.01 if kind in ("direct-tension", "brazilian") else 0.005
    return "A" if abs(error) <= limit else "B" if abs(error) <= 0.02 else "C"


def main(directories):
    tests = [t for d in directories for t in json.loads((Path(d) / "summary.json").read_text())["tests"]]
    specimen = lambda t: (t["kind"], t["sigma3_MPa"], t["model"], t["law"], t["seed"])
    slow = defaultdict(list)
    for t in tests:
        if t["variant"].startswith(REFERENCES):
            slow[specimen(t)].append((t["variant"], t["peak_stress_MPa"]))
    found = Counter()
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["test", "sigma3_MPa", "grains", "law", "packing", "numerics", "peak_MPa", "reference_MPa", "error", *EVIDENCE, "grade", "true_grade"])
    for t in tests:
        peaks = [peak for variant, peak in slow[specimen(t)] if variant.startswith("ninth") or not t["variant"].startswith("third")]
        if t["variant"].startswith("ninth") or not peaks:
            continue
        reference = sum(peaks) / len(peaks)
        error = t["peak_stress_MPa"] / reference - 1.0
        true = true_grade(t["kind"], error)
        found[t["quasi_static"], true] += 1
        numbers = [t["peak_stress_MPa"], reference, error, *(t[name] for name in EVIDENCE)]
        out.writerow([*specimen(t), t["variant"], *("" if n is None else f"{n:.4g}" for n in numbers), t["quasi_static"], true])
    for grade in "ABC":
        print(f"grade {grade}: truly " + ", ".join(f"{true} {found[grade, true]}" for true in "ABC"), file=sys.stderr)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1:])
