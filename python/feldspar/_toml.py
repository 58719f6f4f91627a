"""Dictionaries as TOML text. Python reads TOML (3.11 and later) and does not write it."""

from __future__ import annotations

import math
import os
import re
from typing import Any, Mapping, Sequence, Union

from .errors import InputError, Mistake

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def dumps(table: Mapping[str, Any]) -> str:
    """TOML text of nested dictionaries. Raises InputError, with the dotted key, for what TOML cannot hold."""
    lines: list[str] = []
    _write(lines, table, ())
    return "\n".join(lines) + "\n"


def settings_of(settings: Union[Mapping[str, Any], Sequence[str]]) -> list[str]:
    """Keys over a file, as the program takes them: "key=value"."""
    if isinstance(settings, Mapping):
        return [f"{key}={_inline(value, (key,))}" for key, value in settings.items()]
    return [settings] if isinstance(settings, str) else list(settings)


def _key(word: str) -> str:
    return word if _BARE.fullmatch(word) else _text(word)


def _text(text: str) -> str:
    escapes = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r"}
    return '"' + "".join(escapes.get(c, c if c.isprintable() else f"\\U{ord(c):08x}") for c in text) + '"'


def _wrong(path: tuple[str, ...], problem: str) -> InputError:
    key = ".".join(path)
    allowed = "text, a number, true or false, a list, or a dictionary"
    return InputError(f"{key}: {problem}; allowed: {allowed}", [Mistake("<dict>", 0, 0, key, problem, allowed, "")])


def _plain(value: Any) -> Any:
    """NumPy's numbers and arrays as Python's own."""
    if hasattr(value, "tolist") and hasattr(value, "dtype"):
        return value.tolist()
    return value


def _is_table(value: Any) -> bool:
    return isinstance(value, Mapping)


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and len(value) > 0 and all(_is_table(v) for v in value)


def _inline(value: Any, path: tuple[str, ...]) -> str:
    value = _plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, os.PathLike):
        return _text(os.fspath(value))
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if math.isfinite(value):
            return repr(value)
        return "nan" if math.isnan(value) else ("inf" if value > 0 else "-inf")
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_inline(v, path) for v in value) + "]"
    if _is_table(value):
        return "{ " + ", ".join(f"{_key(k)} = {_inline(v, path + (k,))}" for k, v in value.items() if v is not None) + " }"
    raise _wrong(path, f"{value!r} is {type(value).__name__}, which TOML cannot hold")


def _write(lines: list[str], table: Mapping[str, Any], path: tuple[str, ...]) -> None:
    later: list[tuple[str, Any]] = []
    for key, value in table.items():
        if not isinstance(key, str):
            raise _wrong(path + (str(key),), f"{key!r} is no text, and keys are")
        if value is None:
            continue
        if _is_table(value) or _is_tables(value):
            later.append((key, value))
        else:
            lines.append(f"{_key(key)} = {_inline(value, path + (key,))}")
    for key, value in later:
        name = ".".join(_key(word) for word in path + (key,))
        if _is_table(value):
            lines.append(f"\n[{name}]")
            _write(lines, value, path + (key,))
        else:
            for one in value:
                lines.append(f"\n[[{name}]]")
                _write(lines, one, path + (key,))
