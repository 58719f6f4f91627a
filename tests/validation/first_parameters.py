#!/usr/bin/env python3
"""The rules of first contact parameters: from the runs of studies/first-parameters/design.toml to coefficients and their errors.

    tests/validation/first_parameters.py build/release/feldspar     asks the study for its runs, writes docs/validation/first-parameters.csv, fits
    tests/validation/first_parameters.py                            fits to that file as it is

Prints each rule with its coefficients, the scatter of the fit, and the scatter when each packing is left out in turn (all points on it), which is
what a rock on a packing that the rules have not seen may expect. The rules themselves stand in src/feldspar/lab/scaling_rules.cpp.
"""

import csv
import math
import subprocess
import sys
import tomllib
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
STUDY = TOP / "studies/first-parameters/design.toml"
TABLE = TOP / "docs/validation/first-parameters.csv"
GRAIN_M = 3e-3
COLUMNS = ["point", "packing", "E_GPa", "nu", "Kn_GPa_m", "eta", "sigma_nt_MPa", "tau_MPa", "mu", "Gfn_N_m", "Gfs_N_m", "weibull_modulus",
           "UCS_MPa", "DTS_MPa", "BTS_MPa", "sigma3_MPa", "sigma1_MPa", "E_rock_GPa", "nu_rock", "grades"]


def number(text):
    return float(str(text).split()[0])


def gather(program):
    """One row a point: parameters, and what the tests of it have shown; empty where a test shows no strength."""
    design = {v["label"]: v for v in tomllib.loads(STUDY.read_text())["axis"][0]["value"]}
    text = subprocess.run([program, "study", "table", "--runs", str(STUDY)], check=True, capture_output=True, text=True, cwd=TOP).stdout
    runs = {}
    for run in csv.DictReader(line for line in text.splitlines() if not line.startswith("#")):
        if run["state"] == "done":
            runs.setdefault(run["point"], {})[run["test"]] = run
    rows = []
    for label, value in design.items():
        material, mine = value["set"]["material"], runs.get(label, {})
        grain, contact = material["grain"], material["contact"]
        row = {"point": label, "packing": value["seeds"][0], "E_GPa": number(grain["E"]), "nu": grain["nu"], "Kn_GPa_m": number(contact["Kn"]), "eta": contact["eta"],
               "sigma_nt_MPa": number(contact["sigma_nt"]), "tau_MPa": number(contact["tau"]), "mu": contact["mu"], "Gfn_N_m": number(contact["Gfn"]), "Gfs_N_m": number(contact["Gfs"]),
               "weibull_modulus": material.get("scatter", {}).get("strength", {}).get("modulus", "")}
        for test, name in (("uniaxial-compression", "UCS_MPa"), ("direct-tension", "DTS_MPa"), ("brazilian", "BTS_MPa"), ("biaxial", "sigma1_MPa")):
            run = mine.get(test)
            row[name] = f"{float(run['strength_Pa']) / 1e6:.4g}" if run and run["strength_Pa"] and run["peak_reached"] == "1" else ""
        row["sigma3_MPa"] = row["sigma_nt_MPa"]
        compression = mine.get("uniaxial-compression")
        row["E_rock_GPa"] = f"{float(compression['E_initial_Pa']) / 1e9:.4g}" if compression and compression["E_initial_Pa"] else ""
        row["nu_rock"] = f"{float(compression['nu_initial']):.4g}" if compression and compression["nu_initial"] else ""
        row["grades"] = "".join(mine[t]["grade"] if t in mine else "-" for t in ("uniaxial-compression", "direct-tension", "brazilian", "biaxial"))
        rows.append(row)
    return rows


def solve(a, b):
    """Gaussian elimination."""
    n = len(b)
    m = [list(row) + [b[i]] for i, row in enumerate(a)]
    for i in range(n):
        p = max(range(i, n), key=lambda r: abs(m[r][i]))
        m[i], m[p] = m[p], m[i]
        for r in range(i + 1, n):
            f = m[r][i] / m[i][i]
            for c in range(i, n + 1):
                m[r][c] -= f * m[i][c]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (m[i][n] - sum(m[i][c] * x[c] for c in range(i + 1, n))) / m[i][i]
    return x


def least_squares(features, values):
    n = len(features[0])
    a = [[sum(f[i] * f[j] for f in features) for j in range(n)] for i in range(n)]
    return solve(a, [sum(f[i] * v for f, v in zip(features, values)) for i in range(n)])


def groups(row):
    """Logarithms of the dimensionless groups, as in scaling_rules.cpp, about the values of Table 7 and its neighbourhood."""
    E, s, tau, mu = number(row["E_GPa"]) * 1e9, number(row["sigma_nt_MPa"]) * 1e6, number(row["tau_MPa"]) * 1e6, number(row["mu"])
    return {"t": math.log(tau / s / 3.5), "N": math.log(mu + math.hypot(1.0, mu)), "k": math.log(number(row["Kn_GPa_m"]) * 1e9 * GRAIN_M / E / 20.0), "eta": math.log(number(row["eta"]) / 0.28),
            "bn": math.log(E * number(row["Gfn_N_m"]) / (s * s * GRAIN_M)), "bs": math.log(E * number(row["Gfs_N_m"]) / (tau * tau * GRAIN_M)), "nu": number(row["nu"]) - 0.23,
            "s": math.log(s / E / 3e-4), "m": 1.0 / number(row["weibull_modulus"]) if row["weibull_modulus"] else 0.0}


def term(g, name):
    """"1", "t", or a product such as "t*bn"."""
    value = 1.0
    for factor in name.split("*"):
        value *= 1.0 if factor == "1" else g[factor]
    return value


def angle(row):
    """Friction angle of the line through UCS and the strength at sigma3 (P12), degrees; none without both."""
    if not row["UCS_MPa"] or not row["sigma1_MPa"]:
        return None
    N = (number(row["sigma1_MPa"]) - number(row["UCS_MPa"])) / number(row["sigma3_MPa"])
    return math.degrees(math.asin((N - 1) / (N + 1))) if N > 1 else None


def ratio(over, under):
    return lambda r: math.log(number(r[over]) / number(r[under])) if r[over] and r[under] else None


def expected_E(r):
    return math.log(number(r["E_GPa"]) / number(r["E_rock_GPa"]) - 1.0) if r["E_rock_GPa"] and number(r["E_GPa"]) > number(r["E_rock_GPa"]) else None


MOST_FRICTION = 0.9   # even rocks above it fail in another way, slowly, and are left out of the fit

# name, value, terms of an even rock, terms that strengths which scatter add
RULES = [
    ("ln UCS/sigma_nt", ratio("UCS_MPa", "sigma_nt_MPa"), ["1", "t", "N", "bn", "bs", "k", "eta"], ["m"]),
    ("ln DTS/sigma_nt", ratio("DTS_MPa", "sigma_nt_MPa"), ["1", "t", "bn", "k", "eta"], ["m", "m*m"]),
    ("ln BTS/sigma_nt", ratio("BTS_MPa", "sigma_nt_MPa"), ["1", "t", "N", "t*N", "bn", "bs", "k", "eta"], ["m", "m*m"]),
    ("phi, degrees", angle, ["1", "N", "t", "bs"], []),
    ("ln(E_grain/E - 1)", expected_E, ["1", "k", "eta", "nu"], []),
    ("nu", lambda r: number(r["nu_rock"]) if r["nu_rock"] else None, ["1", "nu", "k", "eta", "k*eta"], []),
]


def spread(errors):
    return math.sqrt(sum(e * e for e in errors) / len(errors))


def coefficients_of(data, terms):
    return least_squares([[term(g, t) for t in terms] for g, _, _ in data], [v for _, v, _ in data])


def error_of(row, coefficients, terms):
    g, v, _ = row
    return v - sum(c * term(g, t) for c, t in zip(coefficients, terms))


def tell(name, data, terms):
    c = coefficients_of(data, terms)
    left_out = sorted((abs(error_of(row, coefficients_of([d for d in data if d[2] != row[2]], terms), terms)) for row in data))
    print(f"{name}: {len(data)} points, scatter {spread([error_of(d, c, terms) for d in data]):.3g}, packing left out {spread(left_out):.3g} "
          f"(half of them within {left_out[len(left_out) // 2]:.2g}, nine of ten within {left_out[9 * len(left_out) // 10]:.2g})")
    print("    " + "  ".join(f"{t} {x:+.4f}" for t, x in zip(terms, c)))
    return c


def fit(rows, name, value, terms, of_scatter):
    data = [(groups(r), value(r), r["packing"], number(r["mu"])) for r in rows]
    data = [(g, v, p) for g, v, p, mu in data if v is not None and mu <= MOST_FRICTION]
    c = tell(name, [d for d in data if d[0]["m"] == 0.0], terms)
    if of_scatter:   # what is left of the strength of the even rock
        uneven = [(d[0], error_of(d, c, terms), d[2]) for d in data if d[0]["m"] > 0.0]
        tell("    strengths that scatter, ln of what is left", uneven, of_scatter)


def main(arguments):
    if arguments:
        with TABLE.open("w", newline="") as out:
            table = csv.DictWriter(out, COLUMNS, lineterminator="\n")
            table.writeheader()
            table.writerows(gather(arguments[0]))
    rows = list(csv.DictReader(TABLE.open()))
    for rule in RULES:
        fit(rows, *rule)


if __name__ == "__main__":
    main([str(Path(a).resolve()) for a in sys.argv[1:]])
