#!/usr/bin/env python3
"""What a study of rocks over a numerical setting shows of true strengths: a table, and the estimated errors against the true ones.

    feldspar study table studies/true-strengths/accuracy.toml --runs > runs.csv
    tests/validation/true_strengths.py table runs.csv accuracy                     markdown: strength, grade, steps by rock and packing
    tests/validation/true_strengths.py plot runs.csv "1 %" "0.3 %" plot.svg        the strengths at 0.3 % taken for true
"""

import csv
import math
import statistics
import sys

NAMES = {"uniaxial-compression": "UCS", "direct-tension": "DTS"}
BOUND = 2.0   # error_bound over error_estimate


def runs_of(path):
    with open(path, encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(line for line in file if not line.startswith("#")) if row["state"] == "done"]
    if not rows:
        sys.exit(f"{path}: no run is done")
    return rows


def table(path, axis):
    rows = runs_of(path)
    columns = list(dict.fromkeys(row[axis] for row in rows))
    print("| rock | test | packing | " + " | ".join(columns) + " |")
    print("|---" * (3 + len(columns)) + "|")
    cells = {(row["rock"], row["test"], row["seed"], row[axis]): row for row in rows}
    for rock, test, seed in dict.fromkeys((row["rock"], row["test"], row["seed"]) for row in sorted(rows, key=lambda row: int(row["seed"]))):
        line = []
        for column in columns:
            row = cells.get((rock, test, seed, column))
            line.append("" if row is None else f"{1e-6 * float(row['strength_Pa']):.2f} {row['grade']} ({float(row['steps']):,.0f})")
        print(f"| {rock} | {NAMES.get(test, test)} | {seed} | " + " | ".join(line) + " |")


def plot(path, at, truth, out):
    rows = {(row["rock"], row["test"], row["seed"], row["accuracy"]): row for row in runs_of(path)}
    points = []
    for (rock, test, seed, accuracy), row in rows.items():
        true = rows.get((rock, test, seed, truth))
        if accuracy == at and true is not None:
            error = float(row["strength_Pa"]) / float(true["strength_Pa"]) - 1.0
            points.append((100.0 * float(row["error_estimate"]), 100.0 * error, test, f"{rock}, {NAMES.get(test, test)}, packing {seed}"))
    if not points:
        sys.exit(f"{path}: no strength at {at} that is there at {truth} too")
    count, errors = len(points), [abs(error) for _, error, _, _ in points]
    covered = sum(abs(error) <= estimate for estimate, error, _, _ in points)
    bounded = sum(abs(error) <= BOUND * estimate for estimate, error, _, _ in points)
    print(f"{count} strengths: median error {statistics.median(errors):.2f} %, largest {max(errors):.2f} %, within 1 % {sum(e <= 1.0 for e in errors)}; "
          f"the estimate covers {covered}, the bound {bounded} ({100.0 * bounded / count:.0f} %)")
    for estimate, error, _, name in sorted(points, key=lambda point: point[0] - abs(point[1])):
        if abs(error) > BOUND * estimate:
            print(f"  beyond the bound: {name}: error {error:+.2f} %, estimate {estimate:.2f} %")

    right, top, width, height = max(1.2, max(p[0] for p in points)), max(1.5, max(errors)), 520, 440
    left, bottom, x1, y1 = 60.0, 380.0, 500.0, 30.0

    def x(value):
        return left + (x1 - left) * value / right

    def y(value):
        return bottom + (y1 - bottom) * value / top

    def band(factor, colour):
        end = min(right, top / factor)
        corner = "" if end >= right else f" {x(right):.1f},{y(top):.1f}"
        return f'<polygon points="{x(0):.1f},{y(0):.1f} {x(end):.1f},{y(factor * end):.1f}{corner} {x(right):.1f},{y(0):.1f}" fill="{colour}"/>'

    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="13">',
           '<rect width="100%" height="100%" fill="white"/>', band(BOUND, "#eef4fa"), band(1.0, "#dcebdc")]
    for axis_top, is_x in ((right, True), (top, False)):
        step = next(s for s in (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0) if axis_top / s <= 8)
        for i in range(math.floor(axis_top / step) + 1):
            value, text = i * step, f"{i * step:.3g}"
            svg.append(f'<text x="{x(value):.1f}" y="{bottom + 18:.1f}" text-anchor="middle">{text}</text>' if is_x
                       else f'<text x="{left - 8:.1f}" y="{y(value) + 4:.1f}" text-anchor="end">{text}</text>')
            svg.append(f'<path d="M{x(value):.1f} {bottom}V{y1}" stroke="#ddd"/>' if is_x else f'<path d="M{left} {y(value):.1f}H{x1}" stroke="#ddd"/>')
    for estimate, error, test, name in points:
        colour = "#1f5fa8" if test == "uniaxial-compression" else "#c0541a"
        fill = colour if error >= 0.0 else "white"
        svg.append(f'<circle cx="{x(estimate):.1f}" cy="{y(abs(error)):.1f}" r="4" fill="{fill}" stroke="{colour}"><title>{name}: {error:+.2f} %</title></circle>')
    svg += [f'<text x="{0.5 * (left + x1):.1f}" y="{bottom + 40:.1f}" text-anchor="middle">estimated error, %</text>',
            f'<text x="18" y="{0.5 * (bottom + y1):.1f}" text-anchor="middle" transform="rotate(-90 18 {0.5 * (bottom + y1):.1f})">'
            f'difference from the strength at {truth}, %</text>',
            f'<text x="{left:.0f}" y="20"><tspan fill="#1f5fa8">UCS</tspan>, <tspan fill="#c0541a">DTS</tspan>; open: too low. Green: within the estimate, blue: within the bound</text>', "</svg>"]
    with open(out, "w", encoding="utf-8") as file:
        file.write("\n".join(svg) + "\n")


if len(sys.argv) == 4 and sys.argv[1] == "table":
    table(*sys.argv[2:])
elif len(sys.argv) == 6 and sys.argv[1] == "plot":
    plot(*sys.argv[2:])
else:
    sys.exit(__doc__)
