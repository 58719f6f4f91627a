"""Tables: columns of numbers with names, units and meanings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable, Iterator, Mapping

from numpy.typing import NDArray

from .errors import MissingPackage

if TYPE_CHECKING:
    import pandas

__all__ = ["Table"]


class Table(Mapping[str, NDArray[Any]]):
    """Columns by name, each a NumPy array; all have as many rows. Places have two numbers a row: shape (n, 2)."""

    def __init__(self, columns: Iterable[tuple[str, str, str, NDArray[Any]]]) -> None:
        self._columns: dict[str, NDArray[Any]] = {}
        self._units: dict[str, str] = {}
        self._meanings: dict[str, str] = {}
        for name, unit, meaning, values in columns:
            self._columns[name] = values
            self._units[name] = unit
            self._meanings[name] = meaning

    def __getitem__(self, name: str) -> NDArray[Any]:
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"there is no column {name!r}; columns: {', '.join(self._columns)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self._columns.values()))) if self._columns else 0

    def unit(self, name: str) -> str:
        """The unit of a column; "1" of a pure number."""
        self[name]
        return self._units[name]

    def meaning(self, name: str) -> str:
        """What a column is, in words."""
        self[name]
        return self._meanings[name]

    def frame(self) -> "pandas.DataFrame":
        """The table as a DataFrame of pandas; a place becomes two columns, name_x and name_y. Units are in ``frame.attrs["units"]``. Raises MissingPackage."""
        frame = _pandas().DataFrame({name: values for name, _, values in self._flat()})
        frame.attrs["units"] = {name: unit for name, unit, _ in self._flat()}
        return frame

    def _flat(self) -> Iterator[tuple[str, str, NDArray[Any]]]:
        for name, values in self._columns.items():
            if values.ndim == 1:
                yield name, self._units[name], values
            else:
                for axis, letter in enumerate("xy"):
                    yield f"{name}_{letter}", self._units[name], values[:, axis]

    def __repr__(self) -> str:
        return f"<feldspar.Table: {self.rows} rows of {', '.join(self._columns)}>"


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise MissingPackage("tables as DataFrames need pandas, which is not installed (Debian: python3-pandas; or pip install pandas)") from error
    return pandas
