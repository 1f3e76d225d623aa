"""Certified distances of robots, live and offline.

The help of each name states shapes, units and errors. Lengths are in m, angles in rad, times in s
unless a name ends in _ns. Quaternions are x, y, z, w. An unknown bound is infinite, any other unknown
figure is NaN.
"""

from typing import TYPE_CHECKING

try:
    import numpy as _numpy  # the extension loads it only when it makes the first array
except ImportError as error:
    raise ImportError(
        "clearance needs NumPy: 'sudo apt install python3-numpy', or 'pip install numpy' in a virtual environment"
    ) from error

from . import _clearance
from ._clearance import (
    Body,
    Cell,
    CellError,
    Distance,
    DistanceBatch,
    DistancePath,
    Distances,
    DistanceStatus,
    MarginAnswer,
    MotionAnswer,
    PairStatus,
    Pose,
    Question,
    QuestionStatus,
    RelativePose,
    ReplayCheck,
    ReplayError,
    ShapeError,
    TimeLimit,
    TrackingState,
    Verdict,
    ask,
    box,
    check_replay,
    cone,
    cylinder,
    distance,
    ellipsoid,
    point,
    polyhedron_from_halfspaces,
    polyhedron_from_vertices,
    prism,
    replay,
    rounded_by,
    segment,
    truncated_cone,
)
from ._clearance import __version__ as __version__

__all__ = [
    "Body",
    "Cell",
    "CellError",
    "ClosedError",
    "CommandResult",
    "CommandStatus",
    "Commands",
    "Connection",
    "DdsError",
    "Distance",
    "DistanceBatch",
    "DistancePath",
    "DistanceStatus",
    "Distances",
    "JointWriter",
    "MarginAnswer",
    "MotionAnswer",
    "PairStatus",
    "Pose",
    "PoseWriter",
    "Question",
    "Questions",
    "QuestionStatus",
    "RelativePose",
    "ReplayCheck",
    "ReplayError",
    "Report",
    "ReportError",
    "Reports",
    "ShapeError",
    "ShareState",
    "SharedCell",
    "TimeLimit",
    "TrackingState",
    "Verdict",
    "ask",
    "box",
    "check_replay",
    "cone",
    "cylinder",
    "distance",
    "ellipsoid",
    "point",
    "polyhedron_from_halfspaces",
    "polyhedron_from_vertices",
    "prism",
    "replay",
    "rounded_by",
    "segment",
    "truncated_cone",
]

if TYPE_CHECKING or hasattr(_clearance, "Connection"):
    from ._clearance import (
        ClosedError,
        CommandResult,
        Commands,
        CommandStatus,
        Connection,
        DdsError,
        JointWriter,
        PoseWriter,
        Questions,
        Report,
        ReportError,
        Reports,
        SharedCell,
        ShareState,
    )
else:
    _live = {name for name in __all__ if not hasattr(_clearance, name)}
    __all__ = [name for name in __all__ if name not in _live]

    def __getattr__(name):
        if name not in _live:
            raise AttributeError(f"module 'clearance' has no attribute '{name}'")
        raise ImportError(
            f"clearance.{name} talks to a daemon over DDS, and this wheel has no DDS: install the package "
            "python3-clearance, or run 'pip install tools/python' in a source tree"
        )
