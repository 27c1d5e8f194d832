"""Recordings: opened without their rows, read by column."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Iterable, NamedTuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _core

if TYPE_CHECKING:
    import pandas

Path = Union[str, "os.PathLike[str]"]


#: What a bit of the column "flags" is called, and what it says of its row: FLAGS["law_fault"] is (16, "the law gave no ...").
FLAGS: dict[str, tuple[int, str]] = {name: (bit, meaning) for name, bit, meaning in _core.flags}


class Axis(NamedTuple):
    """An axis of a recording."""

    name: str
    position_unit: str  #: "m" or "rad"
    force_unit: str  #: "N" or "N·m"
    lever: float  #: travel of the point where the force acts, per unit of position
    contact_position: float  #: where contact begins; NaN: unknown
    contact_direction: float  #: +1 or -1, into the tissue; NaN: unknown
    contact_error: float = float("nan")  #: standard error of the contact position; NaN: unknown


class Event(NamedTuple):
    """Something that happened during a recording."""

    time: float  #: [s]
    kind: str
    text: str


class Phase(NamedTuple):
    """One phase of a cycle: rows begin up to, but without, end."""

    cycle: int
    phase: str  #: "opening", "open_to_close", "closing" or "close_to_open"
    begin: int
    end: int


class CycleFlag(NamedTuple):
    """One thing that is said of a cycle."""

    cycle: int
    fault: str
    reason: str


class CycleChange(NamedTuple):
    """One change of the cycles by hand. Rows and cycles are numbered as they were when it was saved."""

    edit: int  #: from 1; changes that were saved together have one number
    cycle: int  #: 0: of all of them
    phase: str  #: whose boundary it is, as in Phase; "": of none
    row_before: int | None  #: where the boundary was; None: there was none
    row_after: int | None  #: where it is since; None: there is none
    time: str  #: when it was saved: ISO 8601, UTC
    author: str
    kind: str  #: "found", "begin", "end", "split", "merged", "divided", "left_out", "taken", "as_found"
    text: str  #: in a sentence, with times and reasons


class Cycles(NamedTuple):
    """What `kerf segment` found. Curves are over `grid`; NaN where a cycle did not reach."""

    axis: str
    closing_direction: float  #: +1 if the position grows while closing
    contact_position: float  #: [m or rad]
    filter_corner_hz: float
    phases: tuple[Phase, ...]
    grid: NDArray[np.float64]  #: (G,) positions [m or rad]
    closing: NDArray[np.float64]  #: (cycles, G) forces [N or N·m]
    opening: NDArray[np.float64]  #: (cycles, G)
    closing_mean: NDArray[np.float64]  #: (G,)
    opening_mean: NDArray[np.float64]  #: (G,)


_PHASES = ("", "opening", "open_to_close", "closing", "close_to_open")


class Violation(NamedTuple):
    """One way in which a file departs from the schema."""

    where: str
    found: str
    expected: str


class Recording:
    """An open recording. Its rows stay in the file until a column is asked for, which reads that column of these rows, each time anew.

        recording = kerf.Recording("cut.h5")
        recording["time"]                  # (N,)
        recording["position"]              # (N, axes), as the file has it
        recording["position.theta"]        # (N,), one axis
        recording.units["position.theta"]  # "rad"
        recording[1000:2000]["time"]       # reads 1000 rows
        recording.frame()                  # all columns as a pandas.DataFrame

    A file is read by a process of its own, `kerf-reader`, as the program does it: a damaged file ends that one and is a FormatError
    here. It lives until the recording is closed: by `with`, by close(), or when nobody holds it any more. A process that is forked off
    starts another. Also the NAME.partial of a recording that is still written can be opened: it holds the rows that it has then.

    :raises ValueError: there is no such file; FormatError: it is no recording, or a damaged one
    """

    def __init__(self, path: Path) -> None:
        self.path: str = os.fspath(path)
        self._held = _core.HeldRecording(self.path)
        self._about: dict[str, Any] = self._held.about()
        self._first = 0
        self._count: int = self._about["rows"]

    # What it says of itself.

    def __len__(self) -> int:
        """How many rows there are."""
        return self._count

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns of a number a row, as `kerf convert` names them: "time", "position.theta", "channel.grip", ..."""
        return tuple(name for _, _, name, _, _ in self._about["columns"])

    @property
    def units(self) -> dict[str, str]:
        """The unit of each column: "s", "rad", "N·m"; "1" of a number without one."""
        return {name: unit for _, _, name, unit, _ in self._about["columns"]}

    @property
    def meanings(self) -> dict[str, str]:
        """What each column is, in a sentence."""
        return {name: meaning for _, _, name, _, meaning in self._about["columns"]}

    @property
    def axes(self) -> tuple[Axis, ...]:
        return tuple(Axis(*axis) for axis in self._about["axes"])

    @property
    def header(self) -> dict[str, Any]:
        """created, software, uuid, status, source, history, device_uri, device_toml, scene_toml, device, scene, ..."""
        return dict(self._about["header"])

    @property
    def events(self) -> tuple[Event, ...]:
        return tuple(Event(*event) for event in self._about["events"])

    @property
    def cycles(self) -> Cycles | None:
        """None if nobody looked for cycles; rows of their phases are those of the whole file."""
        found = self._about["cycles"]
        if found is None:
            return None
        phases = tuple(Phase(cycle, _PHASES[phase], begin, end) for cycle, phase, begin, end in found["phases"])
        values: dict[str, Any] = {**found, "phases": phases}
        return Cycles(**values)

    @property
    def cycle_flags(self) -> tuple[CycleFlag, ...]:
        """What is wrong with the cycles, as `kerf segment` found it and people said since."""
        return tuple(CycleFlag(*flag) for flag in self._about["cycle_flags"])

    @property
    def cycle_edits(self) -> tuple[CycleChange, ...]:
        """What people changed of the cycles by hand, the oldest first: in the studio, or by `kerf segment`."""
        return tuple(
            CycleChange(edit, cycle, _PHASES[phase], None if before < 0 else before, None if after < 0 else after, *rest)
            for edit, cycle, phase, before, after, *rest in self._about["cycle_edits"]
        )

    @property
    def period(self) -> float:
        """Median time between two rows, at the begin, in the middle and at the end of the file [s]; 0 if time does not grow there."""
        return self._about["period_s"]

    @property
    def is_live(self) -> bool:
        """Whether the recording is still written, or was left by a writer that died."""
        return self._about["is_live"]

    @property
    def is_whole(self) -> bool:
        """Whether it has all rows of the file: it is no slice of them."""
        return self._count == self._about["rows"]

    # Its rows.

    def __getitem__(self, key: str | slice) -> Any:
        """A column by its name, as an array; rows of a slice, as a Recording that has these alone.

        :raises KeyError: there is no such column; FormatError: the file is damaged there
        """
        if isinstance(key, slice):
            return self._rows(key)
        if not isinstance(key, str):
            raise TypeError("a recording is indexed by the name of a column, or by a slice of rows")
        for quantity, part, name, _, _ in self._about["columns"]:
            if name == key and part and quantity != "channel":
                place = [axis.name for axis in self.axes].index(part)
                return np.ascontiguousarray(self._read(quantity)[:, place])
            if name == key or quantity == key != "channel":
                return self._read(key)
        raise KeyError("%s has no column %r; it has %s" % (self.path, key, ", ".join(self.columns)))

    __iter__ = None  # by numbers of rows, as Python would try otherwise

    def __contains__(self, key: object) -> bool:
        return key in self.columns or any(key == quantity != "channel" for quantity, *_ in self._about["columns"])

    def arrays(self, columns: Iterable[str] | None = None) -> dict[str, NDArray[Any]]:
        """Columns of a number a row by their names, by default all; what has several axes is read once for all of them."""
        wanted = self._named(columns)
        datasets: dict[str, NDArray[Any]] = {}
        arrays: dict[str, NDArray[Any]] = {}
        places = {axis.name: place for place, axis in enumerate(self.axes)}
        for quantity, part, name, _, _ in self._about["columns"]:
            if name not in wanted:
                continue
            if not part or quantity == "channel":
                arrays[name] = self._read(name)
                continue
            if quantity not in datasets:
                datasets[quantity] = self._read(quantity)
            arrays[name] = np.ascontiguousarray(datasets[quantity][:, places[part]])
        return {name: arrays[name] for name in wanted}

    def frame(self, columns: Iterable[str] | None = None) -> pandas.DataFrame:
        """Columns as a pandas.DataFrame, by default all; frame.attrs has "units" (by column), "recording" (path) and "uuid".

        :raises ImportError: pandas is not installed (python3-pandas)
        """
        import pandas

        frame = pandas.DataFrame(self.arrays(columns), copy=False)
        units = self.units
        frame.attrs = {"units": {name: units[name] for name in frame.columns}, "recording": self.path,
                       "uuid": self._about["header"]["uuid"]}
        return frame

    def close(self) -> None:
        """Ends the process that reads it, of all slices too; what was read stays."""
        self._held.close()

    def __enter__(self) -> Recording:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        rows = "%d rows" % self._count
        if not self.is_whole:
            rows += " of %d" % self._about["rows"]
        return "<kerf.Recording %r: %s; %s>" % (self.path, rows, ", ".join(self.columns))

    def _read(self, dataset: str) -> NDArray[Any]:
        return self._held.read(dataset, self._first, self._count)

    def _rows(self, rows: slice) -> Recording:
        first, stop, step = rows.indices(self._count)
        if step != 1:
            raise ValueError("rows are read as they follow each other: give a slice without a step, and take every nth of its arrays")
        part = object.__new__(Recording)
        part.path, part._held, part._about = self.path, self._held, self._about
        part._first, part._count = self._first + first, max(stop - first, 0)
        return part

    def _named(self, columns: Iterable[str] | None) -> tuple[str, ...]:
        if columns is None:
            return self.columns
        if isinstance(columns, str):
            raise TypeError("columns: expected several names; one column is recording[%r]" % columns)
        wanted = tuple(columns)
        for name in wanted:
            if name not in self.columns:
                raise KeyError("%s has no column %r; it has %s" % (self.path, name, ", ".join(self.columns)))
        return wanted


def validate(path: Path) -> list[Violation]:
    """Checks a file against the schema that it names, as `kerf validate` does; an empty list: it is valid.

    :raises ValueError: there is no such file; FormatError: it is no HDF5 file at all
    """
    return [Violation(*one) for one in _core.validate(os.fspath(path))]
