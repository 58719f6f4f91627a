"""Feldspar from Python: a virtual laboratory for the fracture of rock.

    import feldspar

    job = feldspar.job("granite.toml")
    result = feldspar.run(job, test="uniaxial-compression", seed=1)
    print(result.properties["strength_MPa"], result.verdict)

Compression is positive in everything that a user reads. Arguments that have a unit are numbers in SI units, or text with the unit ("4 MPa"). How to use it: docs/python.md.
"""

from __future__ import annotations

import json
import os
from typing import Any, Callable, Mapping, Optional, Sequence, Union

from . import _core
from ._core import Job, Result, Snapshot, Specimen, Stage, State, Study, commit, first_job, job_schema, job_template, methods, parse_quantity, preview, summarise, template_kinds
from ._core import version as __version__
from ._toml import dumps as _dumps
from ._toml import settings_of as _settings_of
from .errors import FeldsparError, InputError, Interrupted, Mistake, MissingPackage, NumericalError, OutputError
from .files import Run, RunTest, ledger, read_run
from .progress import Line, Progress
from .progress import shown as _shown
from .results import JobResult
from .tables import Table

__all__ = [
    "FeldsparError", "InputError", "Interrupted", "Job", "JobResult", "Line", "Mistake", "MissingPackage", "NumericalError", "OutputError", "Progress", "Result", "Run", "RunTest", "Snapshot", "Specimen", "Stage", "State",
    "Study", "Table", "__version__", "calibrate", "claims", "commit", "converge", "envelope", "first_job", "job", "job_schema", "job_template", "ledger", "methods", "parse_quantity", "preview", "read_run", "run", "run_job", "run_study", "specimen",
    "study", "summarise", "template_kinds", "validate",
]

JobLike = Union[Job, str, "os.PathLike[str]", Mapping[str, Any]]
TestChoice = Union[None, int, str]
Place = Union[str, "os.PathLike[str]", None]
Settings = Union[Mapping[str, Any], Sequence[str]]
"""Keys over a file: ``{"material.contact.tau": "30 MPa", "test.BTS.plate_mu": 0.2}``, or texts such as "material.contact.tau=30MPa"."""


def job(source: JobLike, *, name: str = "", settings: Settings = ()) -> Job:
    """A job from a file, from TOML text, or from a dictionary.

    source: a path; or TOML text, which is known by its line ends; or a dictionary with the tables of a job file (docs/job.md): ``{"specimen": {"shape": "rectangle", ...}, ...}``; or a job, which is given back.
    name: stands for a text or dictionary in messages; relative paths in it count from the folder of this name.
    settings: keys over what the source says, as ``--set`` of the program: ``{"material.contact.tau": "30 MPa", "test.BTS.plate_mu": 0.2}``; not over a job that has been read.
    Raises InputError with all mistakes (``error.mistakes``): file, line, key, what is wrong, what is allowed, and what was probably meant.
    """
    given = _settings_of(settings)
    if isinstance(source, Job):
        if given:
            raise InputError("settings: the job has been read; allowed: settings over a file, TOML text or a dictionary", [Mistake("", 0, 0, "settings", "the job has been read", "settings over a file, TOML text or a dictionary", "")])
        return source
    if isinstance(source, Mapping):
        return Job.parse(_dumps(source), name or "<dict>", given)
    text = os.fspath(source)
    if "\n" in text:
        return Job.parse(text, name or "<text>", given)
    return Job.read(text, given)


def validate(source: JobLike, *, name: str = "") -> list[Mistake]:
    """The mistakes of a job, in the program's own words; an empty list if there are none. Arguments as of :func:`job`. Sentences on what is allowed but may not be meant: ``job(...).warnings()``."""
    try:
        job(source, name=name)
    except InputError as error:
        return list(error.mistakes)
    return []


def specimen(spec: Union[Mapping[str, Any], None] = None, *, seed: int = 1, threads: int = 0, **keys: Any) -> Specimen:
    """Makes a specimen without a job.

    spec, or keywords: what stands in ``[specimen]`` of a job file: ``specimen(shape="rectangle", width="40 mm", height="80 mm", grains={"diameter": {"distribution": "uniform", "minimum": "2 mm", "maximum": "4 mm"}})``.
    seed: of the packing. threads: 0 for as many as there are cores; none of them changes a bit.
    Raises InputError, NumericalError if the packing does not come to rest, Interrupted.
    """
    table = {**(spec or {}), **keys}
    return _core.make_specimen(_dumps({"specimen": table}), "<specimen>", seed, threads)


def run(
    source: JobLike,
    test: TestChoice = None,
    *,
    sigma3: Union[float, str, None] = None,
    seed: Optional[int] = None,
    variant: Optional[str] = None,
    threads: int = 0,
    callback: Optional[Callable[[State], Optional[bool]]] = None,
    every: int = 1,
    begins: Optional[Stage] = None,
    progress: Progress = None,
) -> Result:
    """Runs one test on one packing, in memory. The interpreter is free for other threads meanwhile.

    source: as of :func:`job`. test: its kind, name, title ("biaxial at 4 MPa") or number in ``job.tests``; not needed if the job has one.
    sigma3: of a test at several pressures, Pa or text. seed: of the packing; default the first of the job. variant: not needed without variants.
    threads: 0 for as many as there are cores and the specimen can use; the result has the same bits for any number.
    callback: is called with a :class:`State`, which it may look at and by which it may stop the test or change its load; giving back False ends the test.
    every: steps between two calls; the test records every 10 steps with adaptive numerics, every 50 with others, and calls are made then. A stage that ends is told at once.
    begins: the stage with which the loading begins, if the callback is to lead the test by stages (``state.begin``); adaptive numerics only.
    progress: True to see how far it is, or a function (see :data:`feldspar.progress.Progress`).
    Raises InputError, NumericalError (``error.result`` is the record until then), Interrupted after Ctrl-C (``error.result``), and what the callback raises.
    """
    with _shown(progress) as function:
        return _core.run(job(source), test, sigma3=sigma3, seed=seed, variant=variant, threads=threads, callback=callback, every=every, begins=begins, progress=function)


def run_job(
    source: JobLike,
    directory: Union[str, "os.PathLike[str]", bool, None] = None,
    *,
    tests: Sequence[Union[int, str]] = (),
    variants: Sequence[str] = (),
    seeds: Sequence[int] = (),
    fresh: bool = False,
    threads: int = 0,
    at_once: int = 0,
    progress: Progress = None,
) -> JobResult:
    """Runs a whole job, tests side by side: results, properties over the packings, strength envelope.

    source: as of :func:`job`. tests, variants, seeds: only these; empty for all.
    directory: where the files of ``feldspar run`` go (report, summary, histories, fields); it must not exist, or have an unfinished run of the same job, which is then gone on with. True: ``results/<name>-<n>``.
    None: nothing is written. fresh: a new directory, even if there is an unfinished run.
    threads: of all tests together, 0 as the job says, else as many as there are cores. at_once: tests side by side, 0 as the job says, else as suits their size.
    progress: as of :func:`run`. Tests that fail are in ``failed`` of the result.
    Raises InputError, OutputError, Interrupted with the results so far (``error.result``).
    """
    place = os.fspath(directory) if directory is not None and not isinstance(directory, bool) else None
    write = directory is not None and directory is not False
    with _shown(progress) as function:
        return _core.run_job(job(source), tests=list(tests), variants=list(variants), seeds=list(seeds), write=write, directory=place, fresh=fresh, threads=threads, at_once=at_once, progress=function)


def _place(directory: Place) -> Optional[str]:
    return None if directory is None else os.fspath(directory)


def study(file: Union[str, "os.PathLike[str]"], *, results: Place = None, settings: Settings = ()) -> Study:
    """Reads a study file.

    results: directory of ledger and runs in place of the file's. settings: keys over the study's job, its ``[set]`` and its axes, as of :func:`job`: its runs are others than those without them.
    Raises InputError, also for a setting of a key that an axis varies.
    """
    return Study.read(os.fspath(file), _place(results), _settings_of(settings))


def run_study(
    source: Union[Study, str, "os.PathLike[str]"],
    *,
    results: Union[str, "os.PathLike[str]", None] = None,
    threads: int = 0,
    at_once: int = 0,
    retry_failed: bool = False,
    progress: Progress = True,
) -> dict[str, Any]:
    """Runs what is not done yet of a study; goes on where it was interrupted. :func:`ledger` reads what came out.

    source: a study, or its file. results: as of :func:`study`. threads: of all runs together, 0 for as many as there are cores. at_once: runs side by side, 0 as suits their size.
    retry_failed: also runs that failed for good. progress: True for a line a run, or a function.
    Returns counts: found_done, found_failed, done, failed, left, and run_s and wall_s (s). Raises InputError, OutputError, Interrupted.
    """
    what = source if isinstance(source, Study) else study(source, results=results)
    with _shown(progress) as function:
        return what.run(threads=threads, at_once=at_once, retry_failed=retry_failed, progress=function)


def envelope(
    source: JobLike,
    *,
    seeds: Optional[int] = None,
    sigma3: Sequence[Union[float, str]] = (),
    with_tension: bool = False,
    results: Place = None,
    threads: int = 0,
    at_once: int = 0,
    retry_failed: bool = False,
    progress: Progress = True,
) -> dict[str, Any]:
    """Strength envelope of a job's rock: uniaxial, biaxial, direct tension and Brazilian tests on several packings, with Mohr-Coulomb and Hoek-Brown through them (docs/study.md). Goes on where it was interrupted.

    source: as of :func:`job`. seeds: number of packings; default the job's seeds if there are several, else 5. sigma3: confining stresses, Pa or text; default the job's biaxial tests, else 2.5, 5, 10 and 15 % of the
    expected strength. with_tension: the Hoek-Brown parabola goes through the direct tensile strengths, too. results: directory of ledger, runs and files; default ``results/<job>-envelope``.
    threads, at_once, retry_failed, progress: as of :func:`run_study`.
    Returns what stands in envelope.json: ``envelopes`` (one a variant: constants with intervals, strengths, fits of each packing), and directory, page and ``executed``, the counts of run_study().
    Raises InputError, OutputError, Interrupted.
    """
    with _shown(progress) as function:
        found, text = _core.run_envelope(job(source), seeds=seeds, sigma3=list(sigma3), with_tension=with_tension, results=_place(results), threads=threads, at_once=at_once, retry_failed=retry_failed, progress=function)
    return {**found, **json.loads(text)}


def converge(
    source: JobLike,
    *,
    seeds: Optional[int] = None,
    tests: Sequence[str] = (),
    within: float = 0.05,
    results: Place = None,
    threads: int = 0,
    at_once: int = 0,
    retry_failed: bool = False,
    progress: Progress = True,
) -> dict[str, Any]:
    """Does the answer of a job depend on grain size, specimen size, mesh, loading rate or the number of packings (docs/study.md)? Varies them one at a time. Goes on where it was interrupted.

    source: as of :func:`job`. seeds: number of packings; default the job's seeds if there are several, else 3. tests: kinds, or UCS, DTS, BTS; default the job's uniaxial, direct tension and Brazilian tests.
    within: a change that does not matter, relative; more than 0 and less than 1. results: directory of ledger, runs and files; default ``results/<job>-converge``.
    threads, at_once, retry_failed, progress: as of :func:`run_study`.
    Returns what stands in converge.json: ``axes`` (values, changes and a verdict of each property) and ``overall``, a sentence, and directory, page and ``executed``, the counts of run_study().
    Raises InputError, OutputError, Interrupted.
    """
    with _shown(progress) as function:
        found, text = _core.run_convergence(job(source), seeds=seeds, tests=list(tests), within=within, results=_place(results), threads=threads, at_once=at_once, retry_failed=retry_failed, progress=function)
    return {**found, **json.loads(text)}


def claims(folder: Union[str, "os.PathLike[str]"], *, results: Place = None) -> list[dict[str, Any]]:
    """Holds what a source says of a model, written down in claims.toml, against what its studies have found (docs/claims.md). Runs nothing.

    folder: with claims.toml and the study files. results: directory of the ledger in place of the studies' own.
    Returns a dictionary a claim: id, figure, says, verdict ("reproduced", "contradicted", "in part", "undecided", "not run", "not evaluated") and statements: each with says, study, verdict, votes, runs, missing, failed
    and comparisons (what, unit, mean, low, high of the 95 % interval, packings, verdict). Raises InputError.
    """
    return _core.claims(os.fspath(folder), results=_place(results))


def calibrate(
    file: Union[str, "os.PathLike[str]"],
    *,
    results: Union[str, "os.PathLike[str]", None] = None,
    budget: Optional[int] = None,
    threads: int = 0,
    at_once: int = 0,
    insist: bool = False,
    progress: Progress = True,
    settings: Settings = (),
) -> dict[str, Any]:
    """Finds the contact parameters with which the model shows a laboratory's numbers (docs/calibration.md); an hour or two on two cores. Goes on where it was interrupted.

    file: a calibration file. results: directory in place of the file's. budget: runs, confirmation included, in place of the file's.
    threads, at_once: as of :func:`run_study`. insist: also for targets that contradict each other. progress: True for a line a run, or a function.
    settings: keys over the calibration's job and its ``[set]``, as of :func:`job`.
    Returns what stands in calibration.json; calibrated.toml and the page stand beside it. Raises InputError, OutputError, Interrupted.
    """
    with _shown(progress) as function:
        text = _core.run_calibration(os.fspath(file), results=_place(results), budget=budget, threads=threads, at_once=at_once, insist=insist, progress=function, settings=_settings_of(settings))
    found: dict[str, Any] = json.loads(text)
    return found
