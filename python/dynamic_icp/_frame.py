# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
from __future__ import annotations

import dataclasses
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from ._arrays import FloatArray
from ._scan import Scan
from ._show import COLOURS, HtmlTable, axes_or_new, metres, needed


@dataclasses.dataclass(eq=False)
class EgoVelocity(HtmlTable):
    """The velocity of the sensor over ground, from the Doppler of one scan.

    The Doppler of a static point is s_i = -u_i . v + bias, u_i being its line of sight.
    """

    velocity: FloatArray
    """(3,), m/s, sensor frame; of a scan that takes its time at `reference_time` s after its stamp."""
    covariance: FloatArray
    """(3, 3), (m/s)^2; zero where none can be stated."""
    status: str
    """converged, iteration_limit, too_few_points, from_motion, degenerate, ambiguous or not_run."""
    unobservable: FloatArray
    """(3, 3), projector onto the directions that no line of sight observes; there the velocity is that of the prior."""
    acceleration: FloatArray
    """(3,), m/s^2, d(velocity)/dt during the scan."""
    reference_time: float
    """s after the stamp."""
    bias: float
    """m/s, constant error of the Doppler that was found."""
    bias_variance: float
    """(m/s)^2."""
    points: int
    inliers: int
    """Points whose residual counts as static."""
    inlier_rms: float
    """m/s, of those residuals."""
    iterations: int

    def _rows(self) -> list[tuple[str, str]]:
        return [
            ("velocity", f"{metres(self.velocity)} m/s"),
            ("sigma", f"{metres(np.sqrt(np.diag(self.covariance)))} m/s"),
            ("status", self.status),
            ("inliers", f"{self.inliers} of {self.points}"),
            ("bias", f"{self.bias:.4f} m/s"),
        ]


@dataclasses.dataclass(eq=False)
class Box:
    """An upright box around a moving object, sensor frame at the stamp."""

    center: FloatArray
    """(3,), m."""
    axes: FloatArray
    """(3, 3), columns: unit vectors along length (where it drives), width and height."""
    size: FloatArray
    """(3,), m: length, width, height."""
    center_covariance: FloatArray
    """(3, 3), m^2."""
    faces: dict[str, str]
    """front, rear, left, right, top, bottom: seen, hidden or unknown."""


@dataclasses.dataclass(eq=False)
class Prediction:
    """Where an object will be, by the models of its motion; axes of the sensor frame at the stamp."""

    after_s: float
    center: FloatArray
    """(3,), m."""
    center_covariance: FloatArray
    """(3, 3), m^2."""
    velocity: FloatArray
    """(3,), m/s."""


@dataclasses.dataclass(eq=False)
class Motion:
    """How an object moves: the probability of each model."""

    standing: float
    straight: float
    turning: float


@dataclasses.dataclass(eq=False)
class MovingObject:
    """A moving object at the stamp of a scan; vectors in the sensor frame of that scan."""

    id: int
    """The same from scan to scan with preset "default"; 1, 2, ... of this scan with preset "paper"."""
    velocity: FloatArray
    """(3,), m/s over ground."""
    velocity_covariance: FloatArray
    """(3, 3), (m/s)^2."""
    centroid: FloatArray
    """(3,), m, centre of the box."""
    extent: FloatArray
    """(3,), m, the box along the axes of the sensor frame."""
    points: int
    box: Optional[Box] = None
    """Only of methods that track objects, as is what follows."""
    prediction: Optional[Prediction] = None
    tangential_observed: bool = False
    """Whether the velocity across the line of sight was measured; where not, use the part along it only."""
    yaw_rate: float = 0.0
    """rad/s about the normal of the ground."""
    acceleration: float = 0.0
    """m/s^2, in the direction of the box."""
    motion: Optional[Motion] = None
    divided_from: Optional[int] = None
    """The id of the object it was taken for a part of until it moved otherwise, as trailers do."""
    status: str = ""
    """confirmed (seen in this scan) or coasting (without points in it)."""
    age_scans: int = 0
    scans_seen: int = 0

    def __post_init__(self) -> None:
        if isinstance(self.box, dict):
            self.box = Box(**self.box)
        if isinstance(self.prediction, dict):
            self.prediction = Prediction(**self.prediction)
        if isinstance(self.motion, dict):
            self.motion = Motion(**self.motion)

    @property
    def speed(self) -> float:
        """m/s over ground."""
        return float(np.linalg.norm(self.velocity))


@dataclasses.dataclass(eq=False)
class Frame(HtmlTable):
    """All that the odometry says of one scan. It can be pickled."""

    stamp_ns: int
    status: str
    """ok; degenerate: some directions are not known; lost: the pose is only predicted."""
    reason: str
    """More exactly: first, converged, iteration_limit, time_gap, ambiguous, ... (docs/evaluation.md)."""
    pose: FloatArray
    """(4, 4), T_world_sensor: p_world = pose @ p_sensor, at the stamp. The world is the frame of the first scan."""
    motion: FloatArray
    """(4, 4), T_target_source: maps points of the last usable scan into this one, p_this = motion @ p_last."""
    covariance: Optional[FloatArray]
    """(6, 6), of xi = [rotation (rad); translation (m)] in T_true = exp(xi) T_target_source, axes of this scan; None
    where none can be stated."""
    ego: EgoVelocity
    twist: Optional[FloatArray]
    """(6,), [angular (rad/s); linear (m/s)] of the sensor over ground at the stamp, in its axes; None where the method
    states none."""
    twist_covariance: Optional[FloatArray]
    """(6, 6)."""
    objects: tuple[MovingObject, ...]
    labels: NDArray[np.int32]
    """(N,), per point as given: -1 not used (dropped, thinned out, or moving without an object), 0 static, k > 0 the id
    of its object."""
    static_points: FloatArray
    """(M, 3), m, sensor frame at the stamp: static, thinned, deskewed. Empty for methods that do not tell."""
    unobservable: FloatArray
    """(K, 6), unit vectors [rotation; translation] along which the motion is not known."""
    information_ratio: float
    """Least over best constrained direction."""
    iterations: int
    fitness: float
    """Share of the points with a correspondence."""
    inlier_rmse: float
    """m."""
    correspondences: int
    points: int
    """As given."""
    points_used: int
    """After range crop and voxel grid."""
    dropped: dict[str, int]
    """Points that are no measurements: non_finite, implausible, zero_range, out_of_range, flagged."""
    dynamic_candidates: int
    dynamic_clustered: int
    dynamic_refined: int
    deskewed: bool
    milliseconds: dict[str, float]
    """Per stage, and total."""

    def __post_init__(self) -> None:
        if isinstance(self.ego, dict):
            self.ego = EgoVelocity(**self.ego)
        self.objects = tuple(MovingObject(**one) if isinstance(one, dict) else one for one in self.objects)

    @property
    def stamp(self) -> float:
        """s; exact in `stamp_ns`."""
        return self.stamp_ns * 1e-9

    @property
    def ego_velocity(self) -> FloatArray:
        """(3,), m/s, velocity of the sensor over ground in its axes; more of it in `ego`."""
        return self.ego.velocity

    @property
    def position(self) -> FloatArray:
        """(3,), m, of the sensor in the world."""
        return self.pose[:3, 3]

    def __repr__(self) -> str:
        speed = float(np.linalg.norm(self.ego_velocity))
        return (
            f"<Frame at {self.stamp:.6f} s: {self.status} ({self.reason}), position {metres(self.position)} m, "
            f"{speed:.2f} m/s, {len(self.objects)} objects>"
        )

    def _rows(self) -> list[tuple[str, str]]:
        return [
            ("stamp", f"{self.stamp:.9f} s"),
            ("status", f"{self.status} ({self.reason})"),
            ("position", f"{metres(self.position)} m"),
            ("velocity", f"{metres(self.ego_velocity)} m/s"),
            ("points", f"{self.points_used} of {self.points} used"),
            ("moving objects", str(len(self.objects))),
            ("time", f"{self.milliseconds['total']:.1f} ms"),
        ]

    def to_pandas(self) -> Any:
        """The moving objects as a pandas.DataFrame, one a row: speed (m/s), velocity, centroid, extent, points."""
        pandas = needed("pandas", "to_pandas()")
        rows = []
        for one in self.objects:
            row: dict[str, Any] = {"id": one.id, "speed": one.speed, "points": one.points, "status": one.status}
            for name in ("velocity", "centroid", "extent"):
                row.update({f"{name}_{axis}": value for axis, value in zip("xyz", getattr(one, name))})
            rows.append(row)
        return pandas.DataFrame(rows)

    def plot(self, scan: Optional[Scan] = None, ax: Any = None) -> Any:
        """Draws the scan from above, sensor frame: static points grey, moving objects with their velocities.

        Parameters
        ----------
        scan : Scan, optional
            What was processed: its points are coloured by `labels`. Without it the thinned static points are shown.
        ax : matplotlib axes, optional

        Returns
        -------
        matplotlib axes
        """
        ax = axes_or_new(ax, figsize=(8, 6))
        static = self.static_points if scan is None else scan.points[self.labels == 0]
        ax.scatter(static[:, 0], static[:, 1], s=0.5, color=COLOURS["static"], label="static")
        if scan is not None:
            moving = scan.points[self.labels > 0]
            ax.scatter(moving[:, 0], moving[:, 1], s=1, color=COLOURS["moving"], label="moving")
        for one in self.objects:
            ax.annotate(
                "",
                xy=(one.centroid[0] + one.velocity[0], one.centroid[1] + one.velocity[1]),
                xytext=(one.centroid[0], one.centroid[1]),
                arrowprops={"arrowstyle": "->", "color": COLOURS["moving"]},
            )
        ax.set(xlabel="x (m)", ylabel="y (m)", title=f"scan at {self.stamp:.2f} s (arrows: way in 1 s)")
        ax.set_aspect("equal")
        ax.legend(loc="upper right")
        return ax
