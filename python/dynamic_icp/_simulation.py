# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Simulated drives with their ground truth."""

from __future__ import annotations

import dataclasses
import os
from typing import Any, Mapping, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._arrays import FloatArray, PathLike, setting_texts
from ._recording import Scans
from ._scan import Scan
from ._show import HtmlTable
from ._trajectory import Trajectory


@dataclasses.dataclass(eq=False)
class TrueObject:
    """A moving body that gave returns; vectors in the sensor frame when the scan begins."""

    id: int
    name: str
    T_sensor_object: FloatArray
    """(4, 4)."""
    center: FloatArray
    """(3,), m, of its box."""
    size: FloatArray
    """(3,), m, of its box along the axes of the body."""
    velocity: FloatArray
    """(3,), m/s over ground, of the centre of the box."""
    yaw_rate: float
    """rad/s about the vertical of the world."""
    points: int


@dataclasses.dataclass(eq=False)
class Truth:
    """What is true of a simulated scan when it begins."""

    pose: FloatArray
    """(4, 4), T_world_sensor; the world is the frame of the scene."""
    velocity: FloatArray
    """(3,), m/s, of the sensor over ground in its axes."""
    angular_velocity: FloatArray
    """(3,), rad/s, in its axes."""
    objects: tuple[TrueObject, ...]
    bodies: NDArray[np.int32]
    """(N,), the moving body that each point is on by its id, 0: static, negative: no surface (rain, spray, ...)."""
    true_range: FloatArray
    """(N,), m."""
    true_doppler: FloatArray
    """(N,), m/s."""

    def __post_init__(self) -> None:
        self.objects = tuple(TrueObject(**one) if isinstance(one, dict) else one for one in self.objects)


class SimulatedScan(Scan):
    """A `Scan` with its ground truth in `truth`."""

    truth: Truth


class Drive(Scans[SimulatedScan], HtmlTable):
    """A simulated drive, made by `simulate`: a sequence of `SimulatedScan`, each made when it is asked for."""

    def __init__(
        self, scene: str, sensor: str, settings: list[tuple[str, str]], instant: bool, noise_free: bool, threads: int
    ) -> None:
        self._arguments = (scene, sensor, settings, instant, noise_free, threads)
        self._core = _core.Drive(*self._arguments)
        self.scene = scene
        self.sensors: list[str] = self._core.sensors()
        """Names of the sensors; the sequence is that of the first."""
        kept = self._core.scans(0)
        super().__init__(lambda index: self._scan(kept[index], 0), range(len(kept)))

    def __reduce__(self) -> tuple[Any, ...]:
        return (Drive, self._arguments)

    def of(self, sensor: str) -> Scans[SimulatedScan]:
        """The scans of one sensor of the rig."""
        number = self._number(sensor)
        kept = self._core.scans(number)
        return Scans(lambda index: self._scan(kept[index], number), range(len(kept)))

    def _number(self, sensor: str) -> int:
        if sensor not in self.sensors:
            raise _core.UsageError(f"sensor is '{sensor}', expected one of: {', '.join(self.sensors)}")
        return self.sensors.index(sensor)

    def _scan(self, index: int, sensor: int) -> SimulatedScan:
        members = self._core.scan(index, sensor)
        scan = SimulatedScan(**members.pop("scan"))
        scan.truth = Truth(**members)
        return scan

    @property
    def ground_truth(self) -> Trajectory:
        """T_world_sensor of the first sensor when each scan begins; the world is the frame of the scene."""
        return Trajectory(*self._core.ground_truth(0))

    def save(self, folder: PathLike, *, layout: str = "dicp", point_truth: bool = False, replace: bool = False) -> None:
        """Writes the drive as a recording with its truth, as the command `simulate` does: the same bytes.

        Parameters
        ----------
        folder : path
            New or empty; with `replace` an earlier simulated drive, which may hold nothing else.
        layout : {"dicp", "hercules", "helipr", "boreas", "aevascenes"}
        point_truth : bool
            Also true range and Doppler of every point.
        """
        self._core.write(os.fspath(folder), layout, point_truth, replace)

    def __repr__(self) -> str:
        return f"<Drive through {self.scene!r}: {len(self)} scans, sensors {', '.join(self.sensors)}>"

    def _rows(self) -> list[tuple[str, str]]:
        truth = self.ground_truth
        return [
            ("scene", self.scene),
            ("scans", str(len(self))),
            ("sensors", ", ".join(self.sensors)),
            ("length", f"{truth.length:.1f} m"),
        ]


def simulate(
    scene: Union[str, PathLike],
    *,
    frames: Optional[int] = None,
    seed: Optional[int] = None,
    sensor: Union[str, PathLike] = "aeries-ii",
    instant: bool = False,
    noise_free: bool = False,
    threads: int = 0,
    settings: Optional[Mapping[str, Any]] = None,
    **more: Any,
) -> Drive:
    """Simulates a drive with an FMCW LiDAR, all ground truth known (docs/simulator.md).

    Parameters
    ----------
    scene : str
        Name of a scene, see `scenes`, or a scene file (*.yaml).
    frames : int, optional
        Number of scans; default 60.
    seed : int, optional
        Decides on layout, traffic and noise; default 1.
    sensor : str
        Sensor or rig, see `sensors`, or a file (*.yaml).
    instant : bool
        All rays of a scan at its stamp.
    noise_free : bool
        No error of measurement or time.
    settings, **more
        Settings by the names of `dynamic-icp simulate --help`: {"lidar.rows": 32}, lidar={"rows": 32}.

    Returns
    -------
    Drive
        The same arguments give the same bits, and those of the command `simulate`.
    """
    given = {"frames": frames, "seed": seed}
    texts = setting_texts(settings, {**more, **{name: value for name, value in given.items() if value is not None}})
    return Drive(os.fspath(scene), os.fspath(sensor), texts, instant, noise_free, threads)


def scenes() -> dict[str, str]:
    """The scenes that come with the package, with what they show."""
    return {name: description for name, description, *_ in _core.scene_names()}


def sensors() -> list[str]:
    """The sensors and rigs that come with the package."""
    return _core.sensor_names()
