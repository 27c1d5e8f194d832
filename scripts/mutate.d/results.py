"""What became of the mutants that were tried, kept so that a draw goes on where it was interrupted."""

import json
from pathlib import Path

from mutants import Mutant

KILLED = "killed"
ENDLESS = "killed, its tests do not end"
EQUIVALENT = "equivalent"
LIVES = "LIVES"
UNCOMPILED = "does not compile"


class Results:
    """A line of JSON a mutant, the last one counts; those that are known to be equivalent are not in the file."""

    def __init__(self, path: Path, equivalents: set[tuple[str, str, str, int | None]]) -> None:
        self.path = path
        self.equivalents = equivalents
        self.verdicts: dict[tuple, str] = {}
        if path.exists():
            for line in path.read_text().splitlines():
                *identity, verdict = json.loads(line)
                self.verdicts[tuple(identity)] = verdict

    def of(self, mutant: Mutant) -> str | None:
        *same, nth = mutant.identity
        if (*same, None) in self.equivalents or (*same, nth) in self.equivalents:
            return EQUIVALENT
        return self.verdicts.get(mutant.identity)

    def add(self, mutant: Mutant, verdict: str) -> None:
        self.verdicts[mutant.identity] = verdict
        with self.path.open("a") as file:
            file.write(json.dumps([*mutant.identity, verdict]) + "\n")

    def forget(self, forgotten: str) -> None:
        self.verdicts = {identity: verdict for identity, verdict in self.verdicts.items() if verdict != forgotten}
