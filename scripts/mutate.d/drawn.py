"""The order in which mutants are drawn. It holds while the sources change: a line that is edited moves no other's turn."""

import hashlib
from collections import defaultdict

from mutants import Mutant
from rooms import room_of


def in_order(mutants: list[Mutant], seed: int) -> list[Mutant]:
    """By chance within a room, and so that of any first so many each room has its share, whatever is drawn later."""
    rooms = defaultdict(list)
    for mutant in sorted(mutants, key=lambda mutant: chance(mutant, seed)):
        rooms[room_of(mutant.file).folder].append(mutant)
    turns = [((rank + 0.5) / len(drawn), folder, mutant)
             for folder, drawn in rooms.items() for rank, mutant in enumerate(drawn)]  # fmt: skip
    return [mutant for _, _, mutant in sorted(turns)]


def chance(mutant: Mutant, seed: int) -> bytes:
    return hashlib.sha256(repr((seed, *mutant.identity)).encode()).digest()
