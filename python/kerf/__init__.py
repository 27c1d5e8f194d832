"""Recordings, force laws and fits of Kerf, a test bench for haptic rendering of cutting.

    import kerf

    recording = kerf.Recording("punch.h5")          # opens it; columns are read when they are asked for
    fits = kerf.fit("punch.h5", ["kelvin", "maxwell"])
    law = fits.chosen.law                           # or kerf.Law.read("kelvin.law.toml")
    force = law.render(recording["position.theta"], recording["velocity.theta"], time=recording["time"])

All numbers are in SI: m, rad, s, N, N·m. They are those of the program `kerf`, bit for bit: it runs the same code.

Errors: ValueError for what was given or what a file holds, in one line that says what, where, what was expected and how to mend it;
FormatError, one of them, for a file that is no recording or a damaged one; TypeError for an argument of the wrong kind; OSError and
MemoryError for what the system refuses.

Threads: laws, recordings and fits may be used by several at once, a State by one at a time. Other threads run while rows are read, laws
rendered and fits searched.
"""

from pathlib import Path as _Path

from . import _core
from ._core import FormatError


def _helpers() -> _Path:
    """The folder of the programs that read files: of where the package is installed, or of the build that it is in."""
    package = _Path(__file__).absolute().parent
    installed = package.parents[3] / "libexec" / "kerf"
    return installed if installed.is_dir() else package.parents[1] / "bin"


_core.look_for_helpers_in(_helpers())

from .fits import Choice, Estimate, FittedLaw, Fits, fit
from .laws import Law, LawAxis, Parameter, Replay, State, models
from .recordings import FLAGS, Axis, CycleChange, CycleFlag, Cycles, Event, Phase, Recording, Violation, validate
from .results import Result, load

__version__ = _core.version

__all__ = ["FLAGS", "Axis", "Choice", "CycleChange", "CycleFlag", "Cycles", "Estimate", "Event", "Fits", "FittedLaw", "FormatError", "Law", "LawAxis",
           "Parameter", "Phase", "Recording", "Replay", "Result", "State", "Violation", "fit", "load", "models", "validate"]
