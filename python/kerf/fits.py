"""Fits of force laws to recordings."""

from __future__ import annotations

import json
import os
from typing import Any, Iterator, Mapping, NamedTuple, Sequence, Union

from . import _core
from .laws import Law
from .recordings import Recording

Path = Union[str, "os.PathLike[str]"]
Source = Union[Path, Recording]


class Estimate(NamedTuple):
    """A parameter as it was found."""

    value: float
    unit: str
    std_error: float | None  #: None where the data do not determine it
    lower: float | None  #: of the interval; None where the data set no limit
    upper: float | None
    interval_by: str | None  #: "wald", "profile", "held"


class Choice(NamedTuple):
    """The simplest law that serves, and why, in a sentence."""

    model: str  #: empty: none
    why: str
    within_jnd: bool | None  #: whether its held-out error is below what a hand can feel; None: nothing was held out


class FittedLaw:
    """One law as it was fitted: errors [N or N·m] as attributes, all else in `json`."""

    def __init__(self, json: Mapping[str, Any], laws: Sequence[Law], interval: str) -> None:
        self.json = dict(json)  #: what fit.json says of it
        self.laws = tuple(laws)  #: a law for each recording where their parameters or contacts differ, else one
        self._interval = interval

    @property
    def law(self) -> Law:
        """The law as it is rendered, with the aids of laws with branches."""
        return self.laws[0]

    @property
    def model(self) -> str:
        return self.json["model"]

    @property
    def parameters(self) -> dict[str, Estimate]:
        return {name: Estimate(one["value"], one["unit"], one["std_error"], one[self._interval][0], one[self._interval][1],
                               one["interval_by"]) for name, one in self.json["parameters"].items()}

    @property
    def rmse(self) -> float:
        """Root mean square error on the rows that it was fitted to."""
        return self.json["rmse"]

    @property
    def cv_rmse(self) -> float | None:
        """On rows that were held out; None without folds."""
        return self.json["cv_rmse"]

    @property
    def cv_rmse_rendered(self) -> float | None:
        """On rows that were held out, as a loop renders the law."""
        return self.json["cv_rmse_rendered"]

    @property
    def r2(self) -> float:
        return self.json["r2"]

    @property
    def converged(self) -> bool:
        return self.json["converged"]

    @property
    def warnings(self) -> list[str]:
        return list(self.json["warnings"])

    @property
    def blame(self) -> str:
        """What is to blame for its error, in a sentence; empty where nothing is."""
        return self.json.get("blame", "")

    def __repr__(self) -> str:
        return "<kerf.FittedLaw %s: rmse %.4g%s>" % (self.model, self.rmse, "" if self.converged else ", not converged")


class Fits(Mapping[str, FittedLaw]):
    """All laws that were fitted to a recording, by name, and the choice among them.

    `json` is what fit.json says; numbers are those of `kerf fit --json`, bit for bit.
    """

    def __init__(self, json: Mapping[str, Any], laws: Sequence[Sequence[Law]], held: _core.HeldFit | None = None) -> None:
        self.json = dict(json)
        self._held = held
        interval = "ci%g" % (100.0 * self.json["settings"]["confidence"])
        self._laws = {one["model"]: FittedLaw(one, files, interval) for one, files in zip(self.json["fits"], laws)}

    def __getitem__(self, model: str) -> FittedLaw:
        return self._laws[model]

    def __iter__(self) -> Iterator[str]:
        return iter(self._laws)

    def __len__(self) -> int:
        return len(self._laws)

    @property
    def choice(self) -> Choice:
        return Choice(**self.json["choice"])

    @property
    def chosen(self) -> FittedLaw:
        """The law of the choice. :raises ValueError: none serves; the message says why"""
        if self.choice.model not in self._laws:
            raise ValueError("no law is chosen: " + self.choice.why)
        return self._laws[self.choice.model]

    @property
    def refused(self) -> dict[str, str]:
        """Laws that could not be fitted, and why."""
        return {one["model"]: one["why"] for one in self.json["refused"]}

    @property
    def warnings(self) -> list[str]:
        """What the data gave cause to warn of."""
        return list(self.json["warnings"])

    @property
    def force_unit(self) -> str:
        """Of all errors: "N" or "N·m"."""
        return self.json["force_unit"]

    def write(self, folder: Path, *, replace: bool = False) -> None:
        """Writes law files, fit.json and fit.csv as `kerf fit -o FOLDER` does: all of them or none.

        :raises ValueError: a fit stands there already; OSError: it cannot be written
        """
        if self._held is None:
            raise ValueError("these fits were read from a file: there is nothing to write that is not there")
        self._held.write(os.fspath(folder), replace)

    def __repr__(self) -> str:
        return "<kerf.Fits %s; choice: %s>" % (", ".join(self._laws) or "of no law", self.choice.model or "none")


def fit(recording: Source | Sequence[Source], laws: str | Sequence[str] | None = None, *, axis: str | None = None,
        contact: float | None = None, direction: str | None = None, rows: str = "contact", cycles: str = "good", rate: float = 1000.0,
        noise: float | Sequence[float] | None = None, per_recording: Sequence[str] = (), segments: int | str = 5,
        points_per_segment: int = 4, breakpoints: Sequence[float | str] = (), arms: int | None = None, memberships: int | None = None,
        thickness: float | None = None, options: Mapping[str, bool | float | str] | None = None, folds: int = 5,
        test_share: float = 0.0, loss: str = "squares", loss_scale: float | None = None, confidence: float = 0.95, profile: bool = False,
        weber: float | None = None, threshold: float | None = None, jnd_source: str | None = None) -> Fits:
    """Fits force laws to a recording, or to several at once that share their parameters: `kerf fit`, whose options have the same names.

    :param recording: path or kerf.Recording (all its rows), or several
    :param laws: a name, several, or "all"; None: those that say something of any recording along an axis
    :param axis: name of the axis; None: that of the cycles, or the first
    :param contact, direction: where the penetration is zero [m or rad], and "increasing" or "decreasing"; None: as the recording says
    :param rows: "contact" or "all"; cycles: "good", "all" or "2-8,10"
    :param rate: of the loop that errors as rendered are of, 100 to 10000 [Hz]
    :param noise: standard deviation of the force, one or one a recording [N]
    :param per_recording: parameters that each of several recordings has of its own
    :param segments: of the piecewise law: 1 to 16, "bic" or "jnd"; points_per_segment: fewest samples in one; breakpoints: by hand,
        positions in mm or degrees, or with a unit: "0.3cm"
    :param arms: of the Maxwell law, 1 to 6; memberships: of the fuzzy laws, 1 to 5; thickness: of the sample [m or rad]
    :param options: of the laws that have them, by name
    :param folds: of the cross-validation, 2 to 100; 0: none. test_share: last share that no fit sees, 0 to 0.9
    :param loss: "squares", "huber", "soft_l1" or "cauchy"; loss_scale: of a robust one [N]
    :param confidence: of the intervals, 0.5 to 0.9999; profile: also from the profile of the sum of squares
    :param weber, threshold, jnd_source: the JND in place of what is known of forces and torques
    :returns: the fits; a law that did not converge says so, one that could not be fitted is in `refused`
    :raises ValueError: an option out of its range, that no law has or that excludes another; a recording without force. Ctrl-C ends it
        after the law that is underway.
    """
    sources = [recording] if isinstance(recording, (str, bytes, os.PathLike, Recording)) else list(recording)
    if not sources:
        raise ValueError("recording: expected a recording to fit, or several")
    asked: dict[str, Any] = {
        "laws": [laws] if isinstance(laws, str) else None if laws is None else list(laws),
        "axis": axis, "contact": contact, "direction": direction, "rows": rows, "cycles": cycles, "rate": rate,
        "noise": None if noise is None else [noise] if isinstance(noise, (int, float)) else list(noise),
        "per_recording": list(per_recording), "segments": str(segments), "points_per_segment": points_per_segment,
        "breakpoints": [str(one) for one in breakpoints], "arms": arms, "memberships": memberships, "thickness": thickness,
        "option": ["%s=%s" % (name, _as_word(value)) for name, value in (options or {}).items()], "folds": folds,
        "test_share": test_share, "loss": loss, "loss_scale": loss_scale, "confidence": confidence, "profile": profile, "weber": weber,
        "threshold": threshold, "jnd_source": jnd_source}
    held = _core.fit([_path_of(one) for one in sources], {name: value for name, value in asked.items() if value is not None})
    return Fits(json.loads(held.json()), [[Law.parse(text) for text in files] for files in held.laws()], held)


def _as_word(value: bool | float | str) -> str:
    return str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, float) else str(value)


def _path_of(source: Source) -> str:
    if not isinstance(source, Recording):
        return os.fspath(source)
    if not source.is_whole:
        raise ValueError("%s: rows of a slice are not fitted; choose them by rows and cycles, or write them by 'kerf prepare'" % source.path)
    return source.path
