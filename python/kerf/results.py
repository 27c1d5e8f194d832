"""Results that the program has written, read back."""

from __future__ import annotations

import json
import os
import re
from typing import Any, Union

from .fits import Fits
from .laws import Law
from .recordings import Recording

Path = Union[str, "os.PathLike[str]"]

#: What the name of a number ends in, and the unit that it is in.
_ENDINGS = {"s": "s", "ms": "ms", "us": "us", "ns": "ns", "hz": "Hz", "n": "N", "m": "m", "mm": "mm", "rad": "rad", "j": "J", "kg": "kg",
            "n_per_m": "N/m", "m_per_s": "m/s", "rad_s": "rad/s", "bytes": "byte"}


class Result(dict):  # type: ignore[type-arg]
    """The JSON of a verb as it stands in the file, keys in their order; `path` is the file's, `kind` its name without ending."""

    def __init__(self, values: dict[str, Any], path: str) -> None:
        super().__init__(values)
        self.path = path
        self.kind = os.path.basename(path).split(".")[0]

    def unit(self, key: str) -> str | None:
        """The unit of a number, where its name or a key beside it says so: "worst_at_s" is in s. None: not known.

        `key` may lead further in, by dots: "loop.period_s".
        """
        *outer, last = key.split(".")
        table: Any = self
        for name in outer:
            table = table[int(name)] if isinstance(table, list) else table[name]
        if last not in table:
            raise KeyError(key)
        found = re.search(r"_(%s)$" % "|".join(sorted(_ENDINGS, key=len, reverse=True)), last)
        if found:
            return _ENDINGS[found.group(1)]
        return table.get("unit") if last == "value" else table.get(last + "_unit")

    def __repr__(self) -> str:
        return "<kerf.Result %s: %s>" % (self.path, ", ".join(self))


def load(path: Path) -> Law | Recording | Fits | Result:
    """Reads what the program wrote: a law file, a recording, the fit.json of `kerf fit` (with the laws that stand beside it), or the JSON
    of any other verb.

    :raises ValueError: a file that is none of these, with what is wrong in it; OSError: it cannot be read
    """
    name = os.fspath(path)
    if name.endswith((".toml", ".so")):
        return Law.read(name)
    if name.endswith((".h5", ".partial")):
        return Recording(name)
    if not name.endswith(".json"):
        raise ValueError("%s: expected a law file (.law.toml), a recording (.h5) or a result (.json)" % name)
    with open(name, encoding="utf-8") as file:
        try:
            values = json.load(file)
        except ValueError as wrong:
            raise ValueError("%s: no JSON: %s" % (name, wrong)) from None
    if not isinstance(values, dict):
        raise ValueError("%s: expected an object, as every verb writes it" % name)
    if {"fits", "choice", "settings"} <= values.keys():
        folder = os.path.dirname(name)
        return Fits(values, [[Law.read(os.path.join(folder, law)) for law in one["law_files"]] for one in values["fits"]])
    return Result(values, name)
