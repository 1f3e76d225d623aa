"""Assertions for a user's tests of recorded runs."""

from __future__ import annotations

from os import PathLike
from typing import Sequence, Union

from . import Cell, ReplayCheck, check_replay

Path = Union[str, "PathLike[str]"]


def assert_min_distance(
    recording: Path,
    cell: Union[Cell, Path],
    distance: float | None = None,
    *,
    between: dict[tuple[str, str], float] | None = None,
    allow_unknown: float = 0.0,
    no_zone: Sequence[str] = (),
    tick_hz: float | None = None,
    joints: dict[str, float] | None = None,
) -> ReplayCheck:
    """Asserts that a replay certifies every pair to be at least `distance` m from each other.

    between: the same by pairs, {("arm", "table"): 0.02}: two objects or groups, or a zone and "".
    allow_unknown: the share of judged ticks in which a pair may be unknown.

    recording: as for clearance.replay(). cell: a Cell or the name of its file. no_zone: zones that
    must not become active. joints: positions that the recording lacks, by name, rad or m.

    Raises AssertionError, which names tick, pair and figure, also if no pair of the recording was ever
    known. Raises CellError or ReplayError if nothing could be judged.
    """
    __tracebackhide__ = True  # pytest shows the line of the test
    checked = cell if isinstance(cell, Cell) else Cell(cell)
    check = check_replay(
        checked,
        recording,
        distance,
        list(no_zone),
        between=between or {},
        allow_unknown=allow_unknown,
        tick_hz=tick_hz,
        joints=joints or {},
    )
    if not check.ok:
        raise AssertionError(check.text)
    if check.closest_distance is None:
        raise AssertionError(f"{recording}: in {check.ticks} ticks, no pair was known\n{check.text}")
    return check
