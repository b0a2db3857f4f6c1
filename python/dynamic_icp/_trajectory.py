# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Trajectories, their files, and how far one is from another."""

from __future__ import annotations

import dataclasses
import json
import os
from typing import TYPE_CHECKING, Any, Iterable, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import FloatArray, PathLike, as_array
from ._show import COLOURS, HtmlTable, axes_or_new, needed

if TYPE_CHECKING:
    from ._frame import Frame


class Trajectory(HtmlTable):
    """Poses of a sensor with their stamps.

    Parameters
    ----------
    stamps_ns : array of shape (N,)
        ns, whole numbers.
    poses : array of shape (N, 4, 4)
        T_world_sensor: p_world = pose @ p_sensor.
    """

    def __init__(self, stamps_ns: ArrayLike, poses: ArrayLike) -> None:
        stamps = as_array("stamps_ns", stamps_ns)
        if stamps.dtype.kind not in "iu" and stamps.size > 0:
            raise _core.UsageError(f"stamps_ns is of type {stamps.dtype}, expected whole numbers of nanoseconds")
        self.stamps_ns: NDArray[np.int64] = stamps.astype(np.int64, copy=False)
        self.poses: FloatArray = as_array("poses", poses).astype(np.float64, copy=False)
        if self.poses.ndim != 3 or self.poses.shape[1:] != (4, 4):
            raise _core.UsageError(f"poses has shape {self.poses.shape}, expected (N, 4, 4)")
        if self.stamps_ns.shape != self.poses.shape[:1]:
            raise _core.UsageError(
                f"stamps_ns has shape {self.stamps_ns.shape}, expected ({len(self.poses)},): one for each pose"
            )

    @classmethod
    def of(cls, frames: Iterable[Frame]) -> Trajectory:
        """The poses of frames in their order."""
        given = list(frames)
        return cls(
            np.array([frame.stamp_ns for frame in given], dtype=np.int64),
            np.array([frame.pose for frame in given], dtype=np.float64).reshape(-1, 4, 4),
        )

    @property
    def stamps(self) -> FloatArray:
        """(N,), s; exact in `stamps_ns`."""
        return self.stamps_ns * 1e-9

    @property
    def positions(self) -> FloatArray:
        """(N, 3), m, of the sensor in the world."""
        return self.poses[:, :3, 3]

    @property
    def length(self) -> float:
        """m, along the positions."""
        return float(np.linalg.norm(np.diff(self.positions, axis=0), axis=1).sum())

    def save(self, path: PathLike, format: str = "tum") -> None:
        """Writes a file, see `write_trajectory`."""
        _core.write_trajectory(os.fspath(path), self.stamps_ns, self.poses, format)

    def __len__(self) -> int:
        return len(self.poses)

    def __repr__(self) -> str:
        return f"<Trajectory of {len(self)} poses, {self.length:.1f} m>"

    def _rows(self) -> list[tuple[str, str]]:
        rows = [("poses", str(len(self))), ("length", f"{self.length:.3f} m")]
        if len(self) > 0:
            rows.append(("duration", f"{(self.stamps_ns[-1] - self.stamps_ns[0]) * 1e-9:.3f} s"))
        return rows

    def to_pandas(self) -> Any:
        """A pandas.DataFrame of stamp_ns, x, y, z (m): one row a pose."""
        x, y, z = self.positions.T
        return needed("pandas", "to_pandas()").DataFrame({"stamp_ns": self.stamps_ns, "x": x, "y": y, "z": z})

    def plot(self, ax: Any = None, **line: Any) -> Any:
        """Draws the positions from above (x, y) with matplotlib; `line` as matplotlib's plot takes it."""
        ax = axes_or_new(ax, figsize=(8, 6))
        ax.plot(self.positions[:, 0], self.positions[:, 1], **{"color": COLOURS["trajectory"], **line})
        ax.set(xlabel="x (m)", ylabel="y (m)")
        ax.set_aspect("equal")
        return ax


def read_trajectory(path: PathLike) -> Trajectory:
    """Reads poses from a file: TUM, KITTI (12 numbers a line) or CSV with a header.

    A file without stamps, as KITTI's, gives 0, 1, 2, ... s.

    Raises
    ------
    DataError (an OSError and a ValueError)
        Naming file, line and what was expected.
    """
    stamps_ns, poses, has_stamps = _core.read_trajectory(os.fspath(path))
    return Trajectory(stamps_ns if has_stamps else np.arange(len(poses), dtype=np.int64) * 10**9, poses)


def write_trajectory(path: PathLike, trajectory: Trajectory, format: str = "tum") -> None:
    """Writes poses so that reading gives the same numbers, whole or not at all.

    Parameters
    ----------
    format : {"tum", "kitti"}
        tum: stamp (s), x y z (m), quaternion x y z w. kitti: the first three rows of the pose, without stamps.
    """
    trajectory.save(path, format)


@dataclasses.dataclass(eq=False)
class Evaluation(HtmlTable):
    """How far an estimated trajectory is from a reference (docs/evaluation.md)."""

    numbers: dict[str, Any]
    """All numbers by the keys of docs/evaluation.md, e.g. rte_rmse_m, rre_mean_deg, ate_rmse_m, segments; None where a
    number cannot be told."""
    table: str
    """The same to read."""
    rte: FloatArray
    """m, relative translation error of each step."""
    rre: FloatArray
    """deg, relative rotation error of each step."""
    ate: FloatArray
    """m, absolute error of each matched pose after the alignment."""
    T_reference_estimate: FloatArray
    """(4, 4), the alignment; of sim3 its scale is in the rotation."""

    def __getitem__(self, key: str) -> Any:
        return self.numbers[key]

    def __str__(self) -> str:
        return self.table

    def _rows(self) -> list[tuple[str, str]]:
        keys = ("matched", "path_length_m", "rte_rmse_m", "rte_median_m", "rre_rmse_deg", "ate_rmse_m")
        return [(key, f"{self.numbers[key]:.6g}") for key in keys if self.numbers.get(key) is not None]


def as_trajectory(given: Any) -> Trajectory:
    """The trajectory of a file, of whatever has one, or of frames."""
    if isinstance(given, Trajectory):
        return given
    if isinstance(given, (str, os.PathLike)):
        return read_trajectory(given)
    for name in ("trajectory", "ground_truth"):
        if hasattr(given, name):
            found: Optional[Trajectory] = getattr(given, name)
            if found is None:
                raise _core.UsageError(f"{given!r} has no ground truth")
            return found
    return Trajectory.of(given)


def evaluate(
    estimate: Union[Trajectory, PathLike, Iterable[Frame], Any],
    reference: Union[Trajectory, PathLike, Any],
    *,
    align: str = "se3",
    gap: float = 1,
    gap_unit: str = "frames",
    max_gap: float = 0.2,
) -> Evaluation:
    """Compares an estimated trajectory with a reference; poses are paired by their stamps.

    Parameters
    ----------
    estimate : Trajectory, file, Run, or frames of an Odometry
    reference : Trajectory, file, or what has a `ground_truth`: Recording, Drive
    align : {"se3", "sim3", "first", "none"}
        What moves the estimate before the absolute error is taken.
    gap, gap_unit : float, {"frames", "seconds", "meters"}
        Length of the steps of the relative errors.
    max_gap : float
        s; between references further apart none is interpolated.

    Returns
    -------
    Evaluation
        With A the reference and B the estimate, the error of a step from i to j is
        E = (inv(A_i) A_j)^-1 (inv(B_i) B_j): RTE the length of its translation, RRE the angle of its rotation.

    Raises
    ------
    DataError
        No stamp of the one is a time of the other (with a guess why).
    """
    given, truth = as_trajectory(estimate), as_trajectory(reference)
    members = _core.evaluate(
        given.stamps_ns, given.poses, truth.stamps_ns, truth.poses, align, gap_unit, float(gap), float(max_gap)
    )
    return Evaluation(
        numbers=json.loads(members["json"]),
        table=members["table"],
        rte=members["rte_m"],
        rre=members["rre_deg"],
        ate=members["ate_m"],
        T_reference_estimate=members["T_reference_estimate"],
    )
