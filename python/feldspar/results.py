"""What a whole job has left."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterator, Optional

from . import _core

if TYPE_CHECKING:
    import pandas

__all__ = ["JobResult"]


@dataclass(repr=False)
class JobResult:
    """The results of a job, with the properties of the rock over its packings."""

    name: str
    """Name of the job."""
    results: list[_core.Result] = field(default_factory=list)
    """Results of the tests, in the job's order; also of tests that were interrupted."""
    properties: dict[str, dict[str, Any]] = field(default_factory=dict)
    """Properties of the rock: name with unit (``UCS_MPa``) to median, minimum, maximum, unit, label, seeds and values. Empty if the job has variants, each of which is a rock: see :meth:`variant`."""
    envelope: dict[str, Any] = field(default_factory=dict)
    """Strength envelopes: method (a sentence), fits (one a packing) and shear_fits."""
    failed: list[dict[str, Any]] = field(default_factory=list)
    """Tests that failed: test, seed, and the reason in words."""
    interrupted: bool = False
    """Whether the user ended the job."""
    directory: Optional[str] = None
    """Where the files are; ``None`` if none were written."""

    @property
    def report(self) -> Optional[Path]:
        """The report for the browser, if files were written."""
        return None if self.directory is None else Path(self.directory) / "report.html"

    def __len__(self) -> int:
        return len(self.results)

    def __iter__(self) -> Iterator[_core.Result]:
        return iter(self.results)

    def __getitem__(self, number: int) -> _core.Result:
        return self.results[number]

    def of(self, *, kind: Optional[str] = None, seed: Optional[int] = None, variant: Optional[str] = None) -> list[_core.Result]:
        """The results of one kind of test (or custom test of this name), on one packing, of one variant."""
        return [r for r in self.results if (kind is None or kind in (r.kind, r.name, r.title)) and (seed is None or r.seed == seed) and (variant is None or r.variant == variant)]

    def variant(self, name: str) -> "JobResult":
        """The results of one variant, with the properties of that rock."""
        results = self.of(variant=name)
        properties, envelope = _core.summarise(results)
        return JobResult(self.name, results, properties, envelope, [f for f in self.failed if f["test"].startswith(name + ": ")], self.interrupted, self.directory)

    def frame(self) -> "pandas.DataFrame":
        """A row a test: what it was, its properties, grade and costs, by names that tell the units. Raises MissingPackage without pandas."""
        from .tables import _pandas

        rows = [{"test": r.name, "variant": r.variant, "seed": r.seed, "test_sigma3_MPa": r.sigma3_MPa, **r.properties, "grade": r.grade, **r.costs} for r in self.results]
        return _pandas().DataFrame(rows)

    def properties_frame(self) -> "pandas.DataFrame":
        """A row a property: median, minimum, maximum, unit, label, seeds and values. Raises MissingPackage without pandas."""
        from .tables import _pandas

        return _pandas().DataFrame.from_dict(self.properties, orient="index")

    def __repr__(self) -> str:
        words = ", ".join(f"{name} {p['median']:.4g}" for name, p in list(self.properties.items())[:4] if p["median"] is not None)
        return f"<feldspar.JobResult '{self.name}': {len(self.results)} tests{', ' + words if words else ''}{', interrupted' if self.interrupted else ''}>"
