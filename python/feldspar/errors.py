"""The errors of Feldspar. The library never ends the program: it raises one of these."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Optional, Sequence

if TYPE_CHECKING:
    from ._core import Result

__all__ = ["FeldsparError", "InputError", "Interrupted", "Mistake", "MissingPackage", "NumericalError", "OutputError"]


class FeldsparError(Exception):
    """What all errors of Feldspar are, but for :class:`Interrupted`."""


class Mistake(NamedTuple):
    """One mistake in what was given, with the program's own words."""

    file: str
    """The file, or ``<dict>``, ``<text>`` or the name that was given to the text."""
    line: int
    """Counted from 1; 0 if the mistake has no place."""
    column: int
    """Counted from 1; 0 if the mistake has no place."""
    key: str
    """The full dotted key, such as ``material.contact.Kn``; empty for a syntax error."""
    problem: str
    """What is wrong, with the value that was given."""
    allowed: str
    """What would be accepted; may be empty."""
    suggestion: str
    """What was probably meant; may be empty."""


class InputError(FeldsparError, ValueError):
    """Mistakes in a job, a study, a calibration or an argument. Found before anything runs, and nothing was written."""

    def __init__(self, message: str, mistakes: Sequence[Mistake] = ()) -> None:
        super().__init__(message)
        self.mistakes: tuple[Mistake, ...] = tuple(mistakes)
        """All mistakes, in the order of files and lines."""


class NumericalError(FeldsparError, ArithmeticError):
    """The computation went wrong: a force is not a number, a relaxation does not converge."""

    def __init__(self, message: str, result: Optional["Result"] = None) -> None:
        super().__init__(message)
        self.result: Optional["Result"] = result
        """The record of the test until then, without properties; ``None`` if there is none."""


class OutputError(FeldsparError, OSError):
    """A result could not be written. Finished files stay whole."""


class MissingPackage(FeldsparError, ImportError):
    """A package that only a part of this library needs is not installed."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C, or the stop button of a notebook, ended a run. It ended cleanly: what was done until then is kept."""

    def __init__(self, message: str = "interrupted by the user", result: object = None) -> None:
        super().__init__(message)
        self.result: object = result
        """What there is: a :class:`Result` of one test, a :class:`JobResult` of a job, or ``None``."""
