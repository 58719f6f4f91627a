#!/usr/bin/env python3
"""Share of the cracks inside crystals over the confinement, from the summaries of runs (docs/validation/uneven-rock.md).

    tests/validation/crystal_shares.py plot.svg RESULTS_DIRECTORY...     prints the shares as a table, and draws them

Each variant is a line through the means of its packings; the dots are the packings. Tests without crystals or without cracks are left out.
"""
import json
import pathlib
import sys

COLOURS = ("#22252a", "#0072b2", "#999999", "#d55e00", "#009e73")


def read(folders):
    """{variant: {sigma3 in MPa: [(seed, share)]}}, in the order of the summaries."""
    shares = {}
    for folder in folders:
        for test in json.loads((pathlib.Path(folder) / "summary.json").read_text())["tests"]:
            crystals = (test.get("rock") or {}).get("crystals")
            if crystals and crystals["cracks"]:
                pressures = shares.setdefault(test.get("variant", "rock"), {})
                pressures.setdefault(test.get("sigma3_MPa") or 0.0, []).append((test["seed"], crystals["inside_cracks"] / crystals["cracks"]))
    return shares


def draw(shares):
    left, right, top, bottom = 62, 440, 22, 300
    most = 1.05 * max(s3 for pressures in shares.values() for s3 in pressures)
    x, y = lambda s3: left + (right - left) * s3 / most, lambda share: bottom - (bottom - top) * share
    svg = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 660 350" font-family="sans-serif" font-size="13">', '<rect width="660" height="350" fill="#fff"/>']
    for n in range(0, 11, 2):
        svg += [f'<path d="M{left} {y(n / 10):.1f}H{right}" stroke="#ddd"/>', f'<text x="{left - 8}" y="{y(n / 10) + 4:.1f}" text-anchor="end">{n / 10:g}</text>']
    for s3 in sorted({s3 for pressures in shares.values() for s3 in pressures}):
        svg += [f'<path d="M{x(s3):.1f} {bottom}v5" stroke="#555"/>', f'<text x="{x(s3):.1f}" y="{bottom + 20}" text-anchor="middle">{s3:g}</text>']
    svg.append(f'<path d="M{left} {top}V{bottom}H{right}" fill="none" stroke="#555"/>')
    for k, (variant, pressures) in enumerate(shares.items()):
        colour, ordered = COLOURS[k % len(COLOURS)], sorted(pressures.items())
        points = " ".join(f"{x(s3):.1f},{y(sum(v for _, v in own) / len(own)):.1f}" for s3, own in ordered)
        svg.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
        svg += [f'<circle cx="{x(s3):.1f}" cy="{y(share):.1f}" r="4" fill="{colour}" fill-opacity=".6"><title>{variant}, packing {seed}, {s3:g} MPa: {share:.2f}</title></circle>' for s3, own in ordered for seed, share in own]
        svg += [f'<path d="M{right + 14} {top + 12 + 20 * k}h18" stroke="{colour}" stroke-width="2"/>', f'<text x="{right + 38}" y="{top + 16 + 20 * k}">{variant}</text>']
    svg += [f'<text x="{(left + right) / 2:.0f}" y="{bottom + 42}" text-anchor="middle">confining stress σ3, MPa</text>',
            f'<text transform="translate(18 {(top + bottom) / 2:.0f}) rotate(-90)" text-anchor="middle">share of the cracks inside crystals</text>', "</svg>"]
    return "\n".join(svg) + "\n"


def main():
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    shares = read(sys.argv[2:])
    if not shares:
        raise SystemExit("no test of these results has crystals and cracks")
    pressures = sorted({s3 for own in shares.values() for s3 in own})
    print("| crystals | packing | " + " | ".join(f"{s3:g}" for s3 in pressures) + " |\n|" + "---|" * (2 + len(pressures)))
    for variant, own in shares.items():
        for seed in sorted({seed for tests in own.values() for seed, _ in tests}):
            cells = [next((f"{share:.2f}" for s, share in own.get(s3, []) if s == seed), "") for s3 in pressures]
            print(f"| {variant} | {seed} | " + " | ".join(cells) + " |")
    pathlib.Path(sys.argv[1]).write_text(draw(shares))


if __name__ == "__main__":
    main()
