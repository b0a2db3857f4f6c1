# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
from __future__ import annotations

from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import Stamp, as_array, as_channel, stamp_to_ns
from ._show import HtmlTable


class Scan(HtmlTable):
    """One scan of an FMCW LiDAR: points with the Doppler velocity of each.

    Arrays are kept as they are, not copied: float32 and float64 are taken, with any strides. What cannot be a
    measurement (NaN, infinity, a point at the origin) may be in them: it is dropped where the scan is processed, and
    counted in `Frame.dropped`.

    Parameters
    ----------
    points : array of shape (N, 3)
        m, sensor frame (x, y, z in any mounting).
    doppler : array of shape (N,)
        m/s, range rate of each point, **positive away from the sensor**: s_i = u_i . (v_object - v_sensor) with the line
        of sight u_i = p_i / |p_i|.
    times : array of shape (N,), optional
        s after the stamp, per point. Without them a scan counts as taken in an instant.
    stamp : float, int, Decimal, Fraction or numpy.datetime64
        When the scan begins, s. A float holds today's Unix time to 238 ns only: use `stamp_ns` where that matters.
    stamp_ns : int
        The same in whole nanoseconds, instead of `stamp`.
    line, face, return_number : arrays of shape (N,), optional
        Whole numbers: scan line or beam, face of a rotating mirror, number of the return (0: first or only).
    sensor : array of shape (N,), optional
        Of a rig of several sensors: which of `mountings` measured the point.
    mountings : array of shape (K, 4, 4), optional
        T_scan_sensor of the sensors of a rig.
    intensity : array of shape (N,), optional
        In the unit of the sensor.
    directions : array of shape (N, 3), optional
        Lines of sight where they are not p_i / |p_i|.
    is_unusable : array of shape (N,), optional
        True where the sensor itself says that a point is no measurement.
    doppler_kind : {"relative", "compensated"}
        relative: as measured. compensated: the sensor's own motion was taken out before, s_i = u_i . v_object.
    """

    def __init__(
        self,
        points: ArrayLike,
        doppler: ArrayLike,
        times: Optional[ArrayLike] = None,
        *,
        stamp: Optional[Stamp] = None,
        stamp_ns: Optional[int] = None,
        line: Optional[ArrayLike] = None,
        face: Optional[ArrayLike] = None,
        sensor: Optional[ArrayLike] = None,
        mountings: Optional[ArrayLike] = None,
        intensity: Optional[ArrayLike] = None,
        return_number: Optional[ArrayLike] = None,
        directions: Optional[ArrayLike] = None,
        is_unusable: Optional[ArrayLike] = None,
        doppler_kind: str = "relative",
        warning: str = "",
    ) -> None:
        self.points: NDArray[Any] = as_array("points", points)
        self.doppler: NDArray[Any] = as_array("doppler", doppler)
        self.times: Optional[NDArray[Any]] = None if times is None else as_array("times", times)
        self.stamp_ns = stamp_to_ns(stamp, stamp_ns)
        self.line = as_channel("line", line, np.uint16)
        self.face = as_channel("face", face, np.uint8)
        self.sensor = as_channel("sensor", sensor, np.uint8)
        self.mountings = None if mountings is None else as_array("mountings", mountings)
        self.intensity = as_channel("intensity", intensity, np.float32)
        self.return_number = as_channel("return_number", return_number, np.uint8)
        self.directions = None if directions is None else as_array("directions", directions)
        self.is_unusable = as_channel("is_unusable", is_unusable, np.uint8)
        self.doppler_kind = doppler_kind
        self.warning = warning
        """What its reader found odd but could live with."""

    @property
    def stamp(self) -> float:
        """When the scan begins, s."""
        return self.stamp_ns * 1e-9

    def __len__(self) -> int:
        return len(self.points)

    def __repr__(self) -> str:
        times = "no times" if self.times is None else "times"
        return f"<Scan at {self.stamp:.6f} s: {len(self)} points, Doppler {self.doppler_kind}, {times}>"

    def _rows(self) -> list[tuple[str, str]]:
        rows = [("stamp", f"{self.stamp:.9f} s"), ("points", str(len(self))), ("Doppler", self.doppler_kind)]
        if self.times is not None and len(self) > 0:
            rows.append(("times", f"{np.nanmin(self.times):g} to {np.nanmax(self.times):g} s"))
        return rows
