"""How far work is, shown on one line that is written over, in terminals and notebooks."""

from __future__ import annotations

import sys
from typing import Any, Callable, Mapping, Optional, TextIO, Union

__all__ = ["Line", "Progress"]

Progress = Union[None, bool, Callable[[Mapping[str, Any]], None]]
"""What functions take as ``progress``: nothing, ``True`` for a :class:`Line`, or a function that is called with a dictionary. Its ``event`` is "progress" (label, number, count, stage, step, axial_strain,
axial_stress_MPa, peak_stress_MPa, cracks, steps_per_second, seconds_left), "finished" (label, text) or "note" (text)."""


class Line:
    """Writes events to a stream: what is finished stays, what runs is written over."""

    def __init__(self, stream: Optional[TextIO] = None) -> None:
        self._stream = stream if stream is not None else sys.stderr
        self._shown = 0

    def __call__(self, event: Mapping[str, Any]) -> None:
        if event["event"] == "progress":
            left = event["seconds_left"]
            text = f"{event['number']}/{event['count']} {event['stage']}: {event['axial_stress_MPa']:.1f} MPa, {event['cracks']} cracks"
            text += f", about {left:.0f} s left" if left is not None else ""
            self._write(f"{text}  [{event['label']}]"[:120])
        else:
            number = f"{event['number']}/{event['count']} " if "count" in event and event["event"] == "finished" else ""
            self.clear()
            self._stream.write(number + event["text"] + "\n")
            self._stream.flush()

    def clear(self) -> None:
        """Takes back the line that is shown."""
        if self._shown:
            self._stream.write("\r" + " " * self._shown + "\r")
            self._stream.flush()
            self._shown = 0

    def _write(self, text: str) -> None:
        self._stream.write("\r" + text.ljust(self._shown))
        self._stream.flush()
        self._shown = len(text)


class shown:
    """Gives the function that the library calls, and cleans up behind it."""

    def __init__(self, progress: Progress) -> None:
        self._line = Line() if progress is True else None
        self._function = self._line if progress is True else (None if progress is None or progress is False else progress)

    def __enter__(self) -> Optional[Callable[[Mapping[str, Any]], None]]:
        return self._function

    def __exit__(self, *error: object) -> None:
        if self._line is not None:
            self._line.clear()
