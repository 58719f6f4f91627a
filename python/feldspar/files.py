"""Results of earlier runs: a run's directory, and the ledger of a study."""

from __future__ import annotations

import io
import json
import os
import tempfile
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterator, Optional, Union

import numpy as np

from . import _core
from .errors import InputError, MissingPackage, Mistake
from .tables import Table, _pandas

if TYPE_CHECKING:
    import pandas
    import pyvista

__all__ = ["Run", "RunTest", "ledger", "read_run"]

PathLike = Union[str, "os.PathLike[str]"]


def _wrong(file: PathLike, problem: str, allowed: str = "") -> InputError:
    return InputError(f"{os.fspath(file)}: {problem}" + (f"; allowed: {allowed}" if allowed else ""), [Mistake(os.fspath(file), 0, 0, "", problem, allowed, "")])


def _pyvista() -> Any:
    try:
        import pyvista
    except ImportError as error:
        raise MissingPackage("meshes need pyvista, which is not installed (pip install pyvista)") from error
    return pyvista


def _h5py() -> Any:
    try:
        import h5py
    except ImportError as error:
        raise MissingPackage("archives (.h5) need h5py, which is not installed (Debian: python3-h5py; or pip install h5py)") from error
    return h5py


def read_csv(file: PathLike) -> Table:
    """Reads a history-....csv or events-....csv: columns with the units and meanings that its head tells. Raises InputError if it is no such file."""
    path = Path(file)
    if not path.is_file():
        raise _wrong(path, "there is no such file")
    described: dict[str, tuple[str, str]] = {}
    with path.open(encoding="utf-8") as lines:
        head = ""
        for line in lines:
            if not line.startswith("#"):
                head = line.strip()
                break
            words = line[1:].strip()
            name, bracket, rest = words.partition(" [")
            unit, end, meaning = rest.partition("] ")
            if bracket and end and " " not in name:
                described[name] = (unit, meaning)
        names = head.split(",")
        rows = [line.strip().split(",") for line in lines if line.strip()]
    if not head or any(len(row) != len(names) for row in rows):
        raise _wrong(path, "is no table that Feldspar has written", "history-<test>.csv or events-<test>.csv")
    columns = []
    for i, name in enumerate(names):
        unit, meaning = described.get(name, ("", ""))
        text = [row[i] for row in rows]
        whole = all(word.lstrip("-").isdigit() for word in text) and bool(text)
        try:
            values = np.array([int(w) for w in text], dtype=np.int64) if whole else np.array([float(w) if w else np.nan for w in text])
        except ValueError:
            raise _wrong(path, f"column {name!r} has what is no number", "history-<test>.csv or events-<test>.csv") from None
        columns.append((name, unit, meaning, values))
    return Table(columns)


class RunTest:
    """One test of an earlier run."""

    def __init__(self, directory: Path, summary: dict[str, Any]) -> None:
        self._directory = directory
        self.summary = summary
        """What summary.json says of the test, in its words and units."""

    @property
    def kind(self) -> str:
        """The test method."""
        return str(self.summary["kind"])

    @property
    def name(self) -> str:
        """The method, or the name of a custom test."""
        return str(self.summary.get("name", self.summary["kind"]))

    @property
    def seed(self) -> int:
        """Seed of the packing."""
        return int(self.summary["seed"])

    @property
    def variant(self) -> str:
        """The job's variant; empty if it has none."""
        return str(self.summary.get("variant", ""))

    @property
    def grade(self) -> str:
        """A, B or C."""
        return str(self.summary["quasi_static"])

    @property
    def verdict(self) -> str:
        """The grade in a sentence."""
        return str(self.summary["verdict"])

    def _file(self, what: str) -> Path:
        files = self.summary.get("files", {})
        if what not in files or not (self._directory / files[what]).exists():
            raise _wrong(self._directory, f"has no {what} of {self.name}, seed {self.seed}", ", ".join(files))
        return self._directory / str(files[what])

    @property
    def history(self) -> Table:
        """The history, with the columns of its CSV file. Raises InputError if the file is not there."""
        return read_csv(self._file("history"))

    @property
    def events(self) -> Table:
        """Acoustic events, SI units. Raises InputError if the file is not there: a test without cracks has none."""
        return read_csv(self._file("events"))

    @property
    def cracks(self) -> Table:
        """The bonds that broke, SI units, from the archive. Raises MissingPackage without h5py, InputError."""
        h5py = _h5py()
        columns = []
        with h5py.File(self._file("archive"), "r") as archive:
            if "cracks" in archive:
                for name, data in archive["cracks"].items():
                    unit, meaning = (_words(data.attrs.get(word, "")) for word in ("unit", "meaning"))
                    columns.append((name, unit, meaning, data[()]))
        return Table(columns)

    def archive(self) -> Any:
        """The archive as an open h5py.File, to be closed by the caller. Raises MissingPackage without h5py, InputError."""
        return _h5py().File(self._file("archive"), "r")

    def fields(self, number: int = -1) -> "pyvista.DataSet":
        """The fields at one of the moments that were kept, in their order (0 the start, -1 the end), as a mesh of pyvista. Raises MissingPackage without pyvista, InputError."""
        pyvista = _pyvista()
        archive = self._file("archive")
        with tempfile.TemporaryDirectory() as folder:
            _core.export_paraview(str(archive), folder)
            files = sorted(Path(folder).glob("*/grains-*.vtu"))
            if not -len(files) <= number < len(files):
                raise _wrong(archive, f"has no fields number {number}", f"{-len(files)} ... {len(files) - 1}")
            return pyvista.read(str(files[number]))

    def export_paraview(self, directory: PathLike) -> None:
        """Writes the fields for ParaView into a directory, as `feldspar export`. Raises InputError if the run kept none, OutputError."""
        Path(directory).mkdir(parents=True, exist_ok=True)
        _core.export_paraview(str(self._file("archive")), os.fspath(directory))

    def __repr__(self) -> str:
        return f"<feldspar.RunTest: {self.name}, seed {self.seed}, grade {self.grade}>"


def _words(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


class Run:
    """A run's directory."""

    def __init__(self, directory: PathLike) -> None:
        self.directory = Path(directory)
        """The directory."""
        file = self.directory / "summary.json"
        if not file.is_file():
            raise _wrong(self.directory, "is no directory of a run: it has no summary.json", "a directory that `feldspar run` or run_job() has written")
        try:
            self.summary: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        except json.JSONDecodeError as error:
            raise _wrong(file, f"cannot be read: {error}") from None
        self.tests: list[RunTest] = [RunTest(self.directory, test) for test in self.summary["tests"]]
        """The tests that are in it."""

    @property
    def name(self) -> str:
        """Name of the job."""
        return str(self.summary["job"]["name"])

    @property
    def report(self) -> Path:
        """The report for the browser. A notebook shows it by ``IPython.display.IFrame(run.report, "100%", 600)``; :meth:`view` opens it."""
        return self.directory / "report.html"

    def view(self) -> bool:
        """Opens the report in the browser. Whether one was found. Raises InputError if the run has no report."""
        if not self.report.is_file():
            raise _wrong(self.report, "there is no such file", "the directory of a run with its report.html")
        return webbrowser.open(self.report.resolve().as_uri())

    def export_paraview(self, directory: Optional[PathLike] = None) -> Path:
        """Writes the fields of all tests for ParaView, as `feldspar export --vtu`: into the directory ``paraview`` of the run, or another one, which is given back. Raises InputError if the run kept none, OutputError."""
        place = self.directory / "paraview" if directory is None else Path(directory)
        for test in self.tests:
            test.export_paraview(place)
        return place

    @property
    def complete(self) -> bool:
        """Whether all tests of the job are in it."""
        return bool(self.summary["complete"])

    @property
    def properties(self) -> dict[str, dict[str, Any]]:
        """Properties of the rock: name with unit to median, minimum, maximum and seeds."""
        return dict(self.summary["properties"])

    @property
    def envelope(self) -> dict[str, Any]:
        """Strength envelopes: method and fits."""
        return dict(self.summary["envelope"])

    @property
    def job(self) -> _core.Job:
        """The job that was run, with every default written out."""
        return _core.Job.parse(self.summary["job"]["resolved"], str(self.directory / "job-resolved.toml"))

    def test(self, name: str, *, seed: Optional[int] = None) -> RunTest:
        """The first test of this kind or name, on this packing. Raises InputError with the tests that there are."""
        for test in self.tests:
            if name in (test.kind, test.name) and (seed is None or test.seed == seed):
                return test
        raise _wrong(self.directory, f"has no test {name!r}" + (f" with seed {seed}" if seed is not None else ""), ", ".join(f"{t.name} (seed {t.seed})" for t in self.tests))

    def frame(self) -> "pandas.DataFrame":
        """A row a test with all its plain numbers and words, in the units of summary.json. Raises MissingPackage without pandas."""
        return _pandas().DataFrame([{k: v for k, v in test.summary.items() if not isinstance(v, (dict, list))} for test in self.tests])

    def histories(self) -> "pandas.DataFrame":
        """The histories of all tests, one below the other, with the columns test, variant and seed before them. Raises MissingPackage without pandas."""
        pandas = _pandas()
        frames = []
        for test in self.tests:
            frame = test.history.frame()
            for i, (name, value) in enumerate((("test", test.name), ("variant", test.variant), ("seed", test.seed))):
                frame.insert(i, name, value)
            frames.append(frame)
        return pandas.concat(frames, ignore_index=True) if frames else pandas.DataFrame()

    def __iter__(self) -> Iterator[RunTest]:
        return iter(self.tests)

    def __len__(self) -> int:
        return len(self.tests)

    def __repr__(self) -> str:
        return f"<feldspar.Run '{self.name}': {len(self.tests)} tests in {self.directory}>"


def read_run(directory: PathLike) -> Run:
    """What `feldspar run` or run_job() has left in a directory. Raises InputError if it is no such directory."""
    return Run(directory)


def ledger(source: Union[_core.Study, PathLike], *, runs: bool = False) -> "pandas.DataFrame":
    """What came out of a study, as a DataFrame.

    source: a study, or its file. A row a point: its axes, then mean, bounds of the 95 % interval and number of packings of each property, user units. runs: a row a run instead, SI units.
    Raises MissingPackage without pandas, InputError if the study has no ledger yet.
    """
    pandas = _pandas()
    study = source if isinstance(source, _core.Study) else _core.Study.read(os.fspath(source))
    text = study.runs_csv() if runs else study.points_csv()
    return pandas.read_csv(io.StringIO(text), comment="#")
