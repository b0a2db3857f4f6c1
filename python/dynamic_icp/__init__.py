# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Odometry and scan registration for FMCW LiDAR, where every point carries its Doppler velocity.

>>> import dynamic_icp
>>> odometry = dynamic_icp.Odometry()
>>> for scan in dynamic_icp.simulate("city", frames=3):
...     frame = odometry.process(scan)
>>> frame.pose.shape, frame.status
((4, 4), 'ok')

Units are m, s, rad and m/s throughout; Doppler is positive away from the sensor; T_target_source maps points of source
into target. docs/python.md is the guide.
"""

from ._core import DataError, UsageError
from ._core import version as __version__
from ._frame import Box, EgoVelocity, Frame, Motion, MovingObject, Prediction
from ._odometry import Odometry, register
from ._recording import Finding, Findings, Recording, Scans, diagnose, open
from ._run import Map, Run, report, run
from ._scan import Scan
from ._simulation import Drive, SimulatedScan, TrueObject, Truth, scenes, sensors, simulate
from ._stages import HDBSCAN, Clusters, CondensedTree, deskew, ego_velocity, hdbscan, normals, velocity_filter
from ._trajectory import Evaluation, Trajectory, evaluate, read_trajectory, write_trajectory

__all__ = [
    "Box",
    "Clusters",
    "CondensedTree",
    "DataError",
    "Drive",
    "EgoVelocity",
    "Evaluation",
    "Finding",
    "Findings",
    "Frame",
    "HDBSCAN",
    "Map",
    "Motion",
    "MovingObject",
    "Odometry",
    "Prediction",
    "Recording",
    "Run",
    "Scan",
    "Scans",
    "SimulatedScan",
    "Trajectory",
    "TrueObject",
    "Truth",
    "UsageError",
    "__version__",
    "deskew",
    "diagnose",
    "ego_velocity",
    "evaluate",
    "hdbscan",
    "normals",
    "open",
    "read_trajectory",
    "register",
    "report",
    "run",
    "scenes",
    "sensors",
    "simulate",
    "velocity_filter",
    "write_trajectory",
]
