"""The field's plots, with matplotlib. Each function draws into axes (new ones unless they are given) and gives them back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from .errors import InputError, MissingPackage, Mistake
from .files import Run, RunTest
from .results import JobResult
from .tables import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["acoustic_emission", "crack_map", "field", "mohr_circles", "specimen", "stress_strain"]

_TENSILE, _SHEAR, _GRAY = "#c0392b", "#2471a3", "#7f8c8d"


def _matplotlib() -> Any:
    try:
        import matplotlib.pyplot
    except ImportError as error:
        raise MissingPackage("plots need matplotlib, which is not installed (Debian: python3-matplotlib; or pip install matplotlib)") from error
    return matplotlib.pyplot


def _axes(ax: Optional["Axes"]) -> "Axes":
    return ax if ax is not None else _matplotlib().subplots()[1]


def _numbers(result: Union[_core.Result, RunTest]) -> dict[str, Any]:
    """Properties by the names of a live result."""
    if isinstance(result, _core.Result):
        return dict(result.properties)
    return {"strength_MPa": result.summary.get("peak_stress_MPa"), **{k: v for k, v in result.summary.items() if not isinstance(v, (dict, list))}}


def _first_at(stress: NDArray[Any], value: float) -> Optional[int]:
    """The row that first reaches a stress (magnitudes), if any does."""
    reached = np.flatnonzero(stress >= value * (1.0 - 1e-9))
    return int(reached[0]) if len(reached) else None


def stress_strain(result: Union[_core.Result, RunTest], ax: Optional["Axes"] = None, *, points: bool = True, label: Optional[str] = None) -> "Axes":
    """Stress over strain, with the points where numbers are read off: strength, first crack, crack initiation and crack damage, and the secant of E.

    result: of a run, or a test of an earlier run. points: whether to mark them. Strain in %, stress in MPa; compression positive.
    """
    ax = _axes(ax)
    history = result.history
    strain, stress = 100.0 * history["axial_strain"], history["axial_stress_MPa"]
    (line,) = ax.plot(strain, stress, lw=1.2, label=label)
    name = result.title if isinstance(result, _core.Result) else result.name
    ax.set_xlabel("axial strain, %")
    ax.set_ylabel("axial stress, MPa")
    ax.set_title(f"{name}, seed {result.seed}", fontsize=10)
    ax.grid(alpha=0.25)
    if not points:
        return ax
    numbers = _numbers(result)
    strength = numbers.get("strength_MPa")
    peak = int(np.argmax(np.abs(stress)))
    rising = np.abs(stress[: peak + 1])
    sign = -1.0 if stress[peak] < 0.0 else 1.0
    marks = (("strength_MPa", "strength", "o"), ("sigma_cd_MPa", r"$\sigma_{cd}$", "s"), ("sigma_ci_crack_volume_MPa", r"$\sigma_{ci}$", "^"), ("first_crack_MPa", "first crack", "x"))
    for key, words, marker in marks:
        value = numbers.get(key)
        if value is None:
            continue
        row = _first_at(rising, abs(value))
        if row is not None:
            ax.plot(strain[row], sign * abs(value), marker, color=line.get_color() if key == "strength_MPa" else _GRAY, ms=6, label=f"{words} {abs(value):.4g} MPa")
    if numbers.get("E_GPa") is not None and strength is not None and abs(strength) > 0.0:
        half = 0.5 * abs(strength)
        start = abs(strain[_first_at(rising, half) or 0]) - 100.0 * half / (1e3 * numbers["E_GPa"])
        ends = np.array([start, start + 100.0 * 0.75 * abs(strength) / (1e3 * numbers["E_GPa"])])
        ax.plot(sign * ends, sign * np.array([0.0, 0.75 * abs(strength)]), "--", color=_GRAY, lw=0.8, label=f"E {numbers['E_GPa']:.4g} GPa")
    ax.legend(fontsize=8)
    return ax


def mohr_circles(source: Union[JobResult, Run, Mapping[str, Any]], ax: Optional["Axes"] = None, *, seed: Optional[int] = None) -> "Axes":
    """Mohr's circles of the strengths of one packing, with the lines of Mohr and Coulomb and of Hoek and Brown.

    source: a job's result, an earlier run, or the dictionary ``envelope`` of one. seed: of the packing; default the first. Stresses in MPa. Raises InputError if there is no envelope.
    """
    envelope = source if isinstance(source, Mapping) else source.envelope
    fits = [fit for fit in envelope.get("fits", []) if seed is None or fit["seed"] == seed]
    if not fits:
        problem = "there is no strength envelope" + (f" of seed {seed}" if seed is not None else "")
        raise InputError(problem, [Mistake("", 0, 0, "seed", problem, "tests at two lateral pressures or more on one packing", "")])
    fit = fits[0]
    ax = _axes(ax)
    angle = np.linspace(0.0, np.pi, 181)
    for low, high in zip(fit["sigma3_MPa"], fit["sigma1_MPa"]):
        middle, radius = 0.5 * (low + high), 0.5 * (high - low)
        ax.plot(middle + radius * np.cos(angle), radius * np.sin(angle), color=_TENSILE, lw=1.0)
    most = max(fit["sigma1_MPa"])
    c, phi = fit["cohesion_MPa"], fit["friction_angle_deg"]
    if c is not None and phi is not None:
        normal = np.array([-c / np.tan(np.radians(phi)) if phi > 0.0 else 0.0, 0.6 * most])
        normal[0] = max(normal[0], -0.2 * most)
        ax.plot(normal, c + normal * np.tan(np.radians(phi)), color=_SHEAR, lw=1.4, label=f"Mohr–Coulomb: c {c:.3g} MPa, φ {phi:.3g}°")
    mi, sigma_ci = fit.get("hoek_brown_mi"), fit.get("hoek_brown_UCS_MPa")
    if mi is not None and sigma_ci is not None and mi > 0.0:
        sigma3 = np.linspace(-sigma_ci / mi, max(max(fit["sigma3_MPa"]), 0.1 * sigma_ci), 300)[1:]
        root = np.sqrt(mi * sigma3 / sigma_ci + 1.0)
        slope = 1.0 + 0.5 * mi / root   # d sigma1 / d sigma3: the envelope of the circles follows from it
        sigma1 = sigma3 + sigma_ci * root
        normal, shear = sigma3 + (sigma1 - sigma3) / (slope + 1.0), (sigma1 - sigma3) * np.sqrt(slope) / (slope + 1.0)
        ax.plot(normal, shear, "--", color=_GRAY, lw=1.2, label=f"Hoek–Brown: $m_i$ {mi:.3g}, $\\sigma_{{ci}}$ {sigma_ci:.4g} MPa")
    ax.set_aspect("equal")
    ax.set_ylim(bottom=0.0)
    ax.set_xlabel("normal stress, MPa")
    ax.set_ylabel("shear stress, MPa")
    ax.set_title(f"seed {fit['seed']}", fontsize=10)
    ax.grid(alpha=0.25)
    ax.legend(fontsize=8, loc="upper left")
    return ax


def _bare(ax: "Axes", specimen_: _core.Specimen) -> None:
    ax.set_aspect("equal")
    outline = 1e3 * specimen_.outline
    (left, bottom), (right, top) = outline.min(axis=0), outline.max(axis=0)
    margin = 0.03 * max(right - left, top - bottom)
    ax.set_xlim(left - margin, right + margin)
    ax.set_ylim(bottom - margin, top + margin)
    ax.set_xlabel("x, mm")
    ax.set_ylabel("y, mm")


def specimen(source: Union[_core.Specimen, _core.Result], ax: Optional["Axes"] = None, *, phases: bool = True) -> "Axes":
    """The cells of a specimen, in mm. phases: whether cells are coloured by their minerals, if there are several."""
    _matplotlib()
    from matplotlib.collections import PolyCollection

    ax = _axes(ax)
    it = source if isinstance(source, _core.Specimen) else source.specimen
    cells = PolyCollection([1e3 * polygon for polygon in it.polygons], edgecolors="#555555", linewidths=0.4, facecolors="#efe9df")
    if phases and len(it.phase_names) > 1:
        cells.set_array(it.phases)
        cells.set_cmap("Set3")
        cells.set_clim(-0.5, 11.5)
    ax.add_collection(cells)
    _bare(ax, it)
    return ax


def crack_map(result: _core.Result, ax: Optional["Axes"] = None, *, label: Optional[str] = None, cells: bool = True) -> "Axes":
    """The broken bonds on the undeformed specimen, in mm: tensile red, shear blue. label: of the moment ("peak", ...); default the end. cells: whether the cells are drawn beneath."""
    _matplotlib()
    from matplotlib.collections import LineCollection

    ax = _axes(ax)
    if cells:
        specimen(result, ax, phases=False)
        ax.collections[-1].set_alpha(0.35)
    cracks = result.cracks
    count = len(cracks["step"]) if label is None else result.snapshot(label).cracks
    lines = 1e3 * np.stack([cracks["from"][:count], cracks["to"][:count]], axis=1)
    mode = cracks["mode"][:count]
    for number, colour, words in ((0, _TENSILE, "tensile"), (1, _SHEAR, "shear")):
        chosen = lines[mode == number]
        ax.add_collection(LineCollection(list(chosen), colors=colour, linewidths=1.2, label=f"{words}: {len(chosen)}"))
    _bare(ax, result.specimen)
    ax.set_title(f"{result.title}, seed {result.seed}", fontsize=10)
    ax.legend(fontsize=8, loc="upper right")
    return ax


def field(result: _core.Result, name: str = "damage", ax: Optional["Axes"] = None, *, label: str = "end", scale: float = 0.0) -> "Axes":
    """A field on the triangles, in mm and MPa.

    name: "stress_xx", "stress_yy", "stress_xy" (MPa, compression positive) or "damage". label: of the moment. scale: by how much displacements are enlarged. Raises InputError.
    """
    names = ("stress_xx", "stress_yy", "stress_xy", "damage")
    if name not in names:
        raise InputError(f"there is no field {name!r}; fields: {', '.join(names)}", [Mistake("", 0, 0, "name", f"there is no field {name!r}", ", ".join(names), "")])
    plt = _matplotlib()
    ax = _axes(ax)
    it, moment = result.specimen, result.snapshot(label)
    places = 1e3 * (it.nodes + scale * moment.displacement)
    values = np.asarray(getattr(moment, name)) * (1.0 if name == "damage" else 1e-6)
    drawn = ax.tripcolor(places[:, 0], places[:, 1], it.triangles, facecolors=values, cmap="inferno_r" if name == "damage" else "viridis", shading="flat")
    plt.colorbar(drawn, ax=ax, label=name if name == "damage" else f"{name}, MPa", shrink=0.8)
    _bare(ax, it)
    ax.set_title(f"{result.title}, seed {result.seed}: {label}", fontsize=10)
    return ax


def acoustic_emission(result: Union[_core.Result, RunTest], ax: Optional["Axes"] = None) -> "Axes":
    """Acoustic events over the strain: magnitudes as dots, and their number beside the stress. Strain in %, stress in MPa."""
    ax = _axes(ax)
    events: Table = result.emission["events"] if isinstance(result, _core.Result) else result.events
    history = result.history
    strain = 100.0 * np.abs(events["axial_strain"])
    ax.plot(100.0 * np.abs(history["axial_strain"]), np.abs(history["axial_stress_MPa"]), color=_GRAY, lw=1.0, label="stress, MPa")
    order = np.argsort(strain, kind="stable")
    ax.plot(strain[order], np.arange(1, len(strain) + 1), color=_SHEAR, lw=1.2, label="events so far")
    ax.set_xlabel("axial strain, %")
    ax.set_ylabel("stress, MPa; number of events")
    ax.grid(alpha=0.25)
    beside = ax.twinx()
    beside.scatter(strain, events["magnitude"], s=8 + 3 * events["cracks"], c=_TENSILE, alpha=0.5, lw=0)
    beside.set_ylabel("magnitude of the energy (dots)")
    b = result.emission["b_value"] if isinstance(result, _core.Result) else result.summary.get("acoustic_emission", {}).get("b_value")
    ax.set_title(f"{len(strain)} events" + (f", b = {b:.2f}" if isinstance(b, (int, float)) else ""), fontsize=10)
    ax.legend(fontsize=8, loc="upper left")
    return ax
