"""Force laws: read, made, stepped, rendered along a trajectory."""

from __future__ import annotations

import json
import os
from typing import Any, Iterable, Mapping, NamedTuple, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core

Path = Union[str, "os.PathLike[str]"]
OptionValue = Union[bool, float, str]


class LawAxis(NamedTuple):
    """An axis that a law acts on."""

    name: str
    position_unit: str  #: "m" or "rad"
    force_unit: str  #: "N" or "N·m"


class Parameter(NamedTuple):
    """A parameter of a law with its unit and the range that the law takes."""

    value: float
    unit: str
    meaning: str
    lower: float
    upper: float
    std_error: float  #: NaN where the law's file has none


class Replay(NamedTuple):
    """What a law gives on the rows of a recording, and how it compares with the recorded force."""

    time: NDArray[np.float64]  #: (N,) [s]
    force: NDArray[np.float64]  #: (N, axes of the recording) [N or N·m], in the sense of the axis, as a loop commands it
    flags: NDArray[np.uint32]  #: (N,); bits of kerf.FLAGS
    figures: dict[str, Any]  #: what `kerf replay --json` says


def models() -> list[str]:
    """The names of the laws that there are; `kerf laws NAME` describes one."""
    return list(_core.models())


class Law:
    """A force law with its parameters and its place on an axis. It never changes.

    A law along one axis sees the penetration

        x = direction (position - contact)

    with direction +1 ("increasing") or -1 ("decreasing"), and gives the force F with which the tissue resists; on the axis it is
    -direction F. A law in space sees its own axes; docs/laws.md has the equations, `equation` the one of this law.

    Law("kelvin", {"parallel_stiffness": 300, "series_stiffness": 900, "damping": 20}) makes one by hand, Law.read() and Law.parse() take
    one from a law file, kerf.fit() finds one.

    :param model: name of the law, one of kerf.models()
    :param parameters: value of each parameter in SI, by name; "points": [...] stands for points[0], points[1], ...
    :param options: settings that are chosen and not fitted, by name (`kerf laws NAME` lists them)
    :param contact: position where the penetration is zero [m or rad]
    :param direction: into the tissue, "increasing" or "decreasing"
    :param axis: name of the axis that it belongs to; empty: any
    :param position_unit: "m" or "rad"
    :param force_unit: "N" or "N·m"
    :raises ValueError: an unknown law, parameter or option; one that is missing; a value outside its range
    """

    __slots__ = ("_held",)
    _held: _core.HeldLaw

    def __init__(self, model: str, parameters: Mapping[str, Union[float, Sequence[float]]],
                 options: Mapping[str, OptionValue] | None = None, *, contact: float = 0.0, direction: str = "increasing",
                 axis: str = "", position_unit: str = "m", force_unit: str = "N") -> None:
        if direction not in ("increasing", "decreasing"):
            raise ValueError("direction: %r is neither 'increasing' nor 'decreasing'" % (direction,))
        self._held = _core.make_law(model, _one_by_one(parameters), dict(options or {}), contact,
                                    1.0 if direction == "increasing" else -1.0, axis, position_unit, force_unit)

    @classmethod
    def _of(cls, held: _core.HeldLaw) -> Law:
        law = cls.__new__(cls)
        law._held = held
        return law

    @classmethod
    def read(cls, path: Path) -> Law:
        """Reads a law file, NAME.law.toml, or the law of a plug-in, NAME.so.

        :raises ValueError: file, line, what was found and what was expected
        """
        return cls._of(_core.read_law(os.fspath(path)))

    @classmethod
    def parse(cls, text: str, name: str = "a law") -> Law:
        """A law file as text; `name` stands for the file in messages."""
        return cls._of(_core.parse_law(text, name))

    def write(self, path: Path, *, replace: bool = False) -> None:
        """Writes a law file, whole or not at all. :raises OSError: the file exists and may not be replaced, or cannot be written"""
        self._held.write(os.fspath(path), replace)

    @property
    def model(self) -> str:
        """Name of the law: "kelvin"."""
        return self._held.model

    @property
    def equation(self) -> str:
        return self._held.equation

    @property
    def axes(self) -> tuple[LawAxis, ...]:
        """What it acts on: one axis, or those of a law in space, in the order of the columns of position and force."""
        return tuple(LawAxis(*axis) for axis in self._held.axes)

    @property
    def is_spatial(self) -> bool:
        return self._held.spatial

    @property
    def parameters(self) -> dict[str, Parameter]:
        """Parameters by name, in the order of the law."""
        return {one[0]: Parameter(*one[1:]) for one in self._held.parameters}

    @property
    def options(self) -> dict[str, OptionValue]:
        """Every option of the law, those that were not given with their standard value."""
        return dict(self._held.options)

    @property
    def contact(self) -> float:
        """Position where the penetration is zero [m or rad]."""
        return self._held.contact[0]

    @property
    def direction(self) -> str:
        """Into the tissue: "increasing" or "decreasing"."""
        return "increasing" if self._held.contact[1] > 0 else "decreasing"

    @property
    def fit(self) -> dict[str, Any]:
        """What the law was fitted to: recording_uuid, rmse [N], date, ...; empty of one that was made by hand."""
        return dict(self._held.fit)

    @property
    def toml(self) -> str:
        """The law as the text of a law file."""
        return self._held.toml

    def state(self) -> State:
        """A state before the first tick, to be stepped by step() or by several calls of render()."""
        return State(_core.HeldState(self._held))

    def step(self, state: State, position: ArrayLike, velocity: ArrayLike | None, elapsed: float, *, resisting: bool = False,
             on_fault: str = "nan") -> Any:
        """One tick: the force [N or N·m], a float for a law along one axis, else an array with a number an axis.

        Arguments as of render(), of one row.
        """
        self._require_own(state)
        row = np.asarray(position)[np.newaxis]
        speed = None if velocity is None else np.asarray(velocity)[np.newaxis]
        force = state._held.render(row, speed, None, elapsed, resisting, on_fault)[0]
        return float(force) if force.ndim == 0 else force

    def render(self, position: ArrayLike, velocity: ArrayLike | None = None, *, time: ArrayLike | None = None,
               elapsed: ArrayLike | None = None, state: State | None = None, resisting: bool = False,
               on_fault: str = "nan") -> NDArray[np.float64]:
        """The force along a trajectory, tick by tick, bit for bit as a loop commands it before any safety.

        :param position: on the axis [m or rad]: (N,) or (N, 1) of a law along one axis, (N, axes) of a law in space, in the order of
            `axes`. Any real numbers in any layout that NumPy knows; what float64 does not hold exactly is refused.
        :param velocity: its derivative, of the same shape [m/s or rad/s]; None: derived from the positions as libkerf does for a host
            without velocities, low-passed at 20 Hz
        :param time: (N,), increasing [s]; each row takes the time since the one before, the first as much as the second
        :param elapsed: instead, the time before each row: one number, or (N,) [s], above 0
        :param state: goes on from there, and leaves it after the last row; None: a fresh state
        :param resisting: of a law along one axis the force F itself, positive where the tissue resists, instead of -direction F
        :param on_fault: what a row gives where a position or velocity is not finite or the law has no finite force: "nan", "zero" (as
            a loop commands it), or "raise"
        :returns: an array of the shape of position [N or N·m]; other threads run meanwhile
        :raises ValueError: a shape that does not fit, a time that does not grow, a state that another thread is stepping
        :raises TypeError: no array of real numbers
        """
        if state is not None:
            self._require_own(state)
        held = _core.HeldState(self._held) if state is None else state._held
        return held.render(position, velocity, time, elapsed, resisting, on_fault)

    def replay(self, recording: Any, *, start: float | None = None, stop: float | None = None, cycles: Iterable[int] = (),
               bridge: bool = False, speed: float = 1.0) -> Replay:
        """Feeds the rows of a recording to the law and compares the forces, as `kerf replay RECORDING --through LAW` does.

        :param recording: a kerf.Recording or the path of one, with the axes of the law
        :param start: first time [s]; stop: last time [s]; cycles: numbers of cycles; by default all rows
        :param bridge: fill gaps by straight lines
        :param speed: relative to the recording's, 0.1 to 10
        :raises ValueError: rows that cannot be replayed, with row and time; an axis that is not there
        """
        path = os.fspath(getattr(recording, "path", recording))
        time, force, flags, figures = _core.replay(path, self._held, self.model, start, stop, list(cycles), bridge, speed)
        return Replay(time, force, flags, json.loads(figures))

    def _require_own(self, state: State) -> None:
        if state._held.law is not self._held:
            raise ValueError("the state belongs to another law; take one from state() of this law")

    def __reduce__(self) -> tuple[Any, ...]:
        return Law.parse, (self.toml, self._held.name or "a law")

    def __repr__(self) -> str:
        values = ", ".join("%s=%.6g %s" % (name, one.value, one.unit) for name, one in list(self.parameters.items())[:8])
        return "<kerf.Law %s: %s>" % (self.model, values)


class State:
    """What one tool has lived through with a law. For one thread at a time: another one is refused."""

    __slots__ = ("_held",)
    _held: _core.HeldState

    def __init__(self, held: _core.HeldState) -> None:
        self._held = held

    def copy(self) -> State:
        """A state of its own that goes on from here."""
        return State(self._held.copy())

    @property
    def stored_energy(self) -> float:
        """What the law can give back at most [J for a position in m, N·rad for rad]; NaN where the law does not say."""
        return self._held.stored_energy


def _one_by_one(parameters: Mapping[str, Union[float, Sequence[float]]]) -> dict[str, float]:
    values: dict[str, float] = {}
    for name, value in parameters.items():
        if np.ndim(value) == 0:
            values[name] = float(value)  # type: ignore[arg-type]
        elif np.ndim(value) == 1:
            values.update(("%s[%d]" % (name, place), float(one)) for place, one in enumerate(value))  # type: ignore[arg-type]
        else:
            raise ValueError("parameter %r: expected a number or a row of them" % name)
    return values
