# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
from __future__ import annotations

import copy
import difflib
import inspect
import os
from typing import Any, Callable, Mapping, Optional, Union

from numpy.typing import ArrayLike

from . import _core
from ._arrays import PathLike, Stamp, as_array, setting_texts, whole_number
from ._frame import Frame
from ._scan import Scan


# Options of the program that have another name as arguments.
OF_THE_PROGRAM = {
    "max_frames": "max_scans",
    "frames": "max_scans",
    "force": "replace",
    "quiet": "progress",
    "config": "settings",
}


def method_settings(
    method: str,
    preset: str,
    settings: Optional[Mapping[str, Any]],
    more: Mapping[str, Any],
    function: Callable[..., Any],
) -> list[tuple[str, str]]:
    """Configuration keys of a method with their values, as text. A name that is no key but nearly an argument of the
    function is refused with that."""
    known = [key for key, *_ in _core.configuration_keys(method, preset)]
    arguments = list(inspect.signature(function).parameters)
    for name in more:
        if any(key == name or key.endswith("." + name) for key in known):
            continue
        meant = difflib.get_close_matches(name, arguments, n=1, cutoff=0.8)
        other = OF_THE_PROGRAM.get(name) or OF_THE_PROGRAM.get(f"{name}s")
        if other in arguments:
            meant = [other]
        if meant:
            raise _core.UsageError(f"unknown argument '{name}'; did you mean '{meant[0]}'?")
    return setting_texts(settings, more, known)


def as_scan(scan: Union[Scan, ArrayLike], doppler: Optional[ArrayLike], channels: Mapping[str, Any]) -> Scan:
    """The scan that is given, whole or by its arrays."""
    given = {name: value for name, value in channels.items() if value is not None}
    if isinstance(scan, Scan):
        if doppler is not None or given:
            more = ", ".join((["doppler"] if doppler is not None else []) + list(given))
            raise _core.UsageError(f"a Scan holds all of itself, but {more} is given as well")
        return scan
    if doppler is None:
        raise _core.UsageError("doppler is missing: expected a Scan, or points (N, 3) and doppler (N,)")
    return Scan(scan, doppler, **given)


class Odometry:
    """Odometry over a stream of scans: give it one scan after the other.

    The same scans give the same bits for any number of threads, and the same as the C++ library and the program.

    Parameters
    ----------
    preset : {"default", "paper"}
        default: the best there is. paper: the published method, nothing added.
    method : str
        dynamic-icp, or one of the baselines: doppler-icp, point-to-point, point-to-plane, gicp, kiss-icp.
    threads : int
        0: as many as the machine has.
    ablation : str
        Part of dynamic-icp to switch off, e.g. "no-dr".
    T_vehicle_sensor : array of shape (4, 4), optional
        Mounting of the sensor, for doppler-icp.
    doppler_kind : {"relative", "compensated"}
        What the Doppler of the scans will be.
    calibration : path, optional
        calibration.yaml of another run with this sensor.
    settings : mapping, optional
        Configuration keys, dotted or as mappings in mappings: {"preprocess.voxel.voxel_size_m": 0.5}. `Odometry.keys`
        and docs/configuration.md list them.
    **more
        The same as keywords: voxel_size_m=0.5, the end of a key, or preprocess={"voxel": {"voxel_size_m": 0.5}}.

    Raises
    ------
    UsageError (a ValueError)
        For an unknown method or key (with the nearest known one) and values out of range (with the range).

    Examples
    --------
    >>> import dynamic_icp
    >>> odometry = dynamic_icp.Odometry()
    >>> for scan in dynamic_icp.simulate("city", frames=3):
    ...     frame = odometry.process(scan)
    >>> frame.status
    'ok'
    """

    def __init__(
        self,
        preset: str = "default",
        *,
        method: str = "dynamic-icp",
        threads: int = 0,
        ablation: str = "none",
        T_vehicle_sensor: Optional[ArrayLike] = None,
        doppler_kind: str = "relative",
        calibration: Optional[PathLike] = None,
        settings: Optional[Mapping[str, Any]] = None,
        **more: Any,
    ) -> None:
        threads = whole_number("threads", threads)
        self._words = f"preset={preset!r}, method={method!r}, threads={threads}"
        self._core = _core.Odometry(
            method=method,
            preset=preset,
            ablation=ablation,
            settings=method_settings(method, preset, settings, more, Odometry),
            threads=threads,
            T_vehicle_sensor=None if T_vehicle_sensor is None else as_array("T_vehicle_sensor", T_vehicle_sensor),
            doppler_kind=doppler_kind,
            calibration=None if calibration is None else os.fspath(calibration),
        )

    @staticmethod
    def keys(method: str = "dynamic-icp", preset: str = "default") -> dict[str, str]:
        """The configuration keys of a method: default, range, unit and meaning of each, in words."""
        return {
            key: f"{meaning} (default {default} {unit}, {allowed})".replace(" ,", ",")
            for key, default, allowed, unit, meaning in _core.configuration_keys(method, preset)
        }

    @property
    def settings(self) -> dict[str, Union[float, int, bool]]:
        """All configuration keys with their values."""
        return self._core.settings()

    @property
    def assumptions(self) -> list[str]:
        """What the method takes for granted because it was not told, in sentences."""
        return self._core.assumptions()

    def process(
        self,
        points: Union[Scan, ArrayLike],
        doppler: Optional[ArrayLike] = None,
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
        doppler_kind: Optional[str] = None,
    ) -> Frame:
        """Takes the next scan.

        Arrays are looked at where they lie, float32 or float64 with any strides, and not kept. Other Python threads run
        in the meantime. No number makes it fail: what cannot be a measurement (NaN, infinity, the origin) is dropped
        and counted, and a scan that cannot be aligned has status "lost".

        Parameters
        ----------
        points : Scan, or array of shape (N, 3)
            m, sensor frame.
        doppler : array of shape (N,)
            m/s, positive away from the sensor.
        times : array of shape (N,), optional
            s after the stamp, per point.
        stamp, stamp_ns
            When the scan begins, s or ns; later than that of the scan before. Default 0.
        line, face, sensor, mountings, intensity, return_number, directions, is_unusable, doppler_kind
            See `Scan`.

        Returns
        -------
        Frame

        Raises
        ------
        UsageError (a ValueError)
            An array has another shape or type than expected; another thread is in this very call.
        DataError (a ValueError)
            The stamp is not later than that of the scan before.
        """
        channels = {
            "times": times,
            "stamp": stamp,
            "stamp_ns": stamp_ns,
            "line": line,
            "face": face,
            "sensor": sensor,
            "mountings": mountings,
            "intensity": intensity,
            "return_number": return_number,
            "directions": directions,
            "is_unusable": is_unusable,
            "doppler_kind": doppler_kind,
        }
        return Frame(**self._core.process(as_scan(points, doppler, channels)))

    def save_calibration(self, path: PathLike) -> None:
        """Writes what was learned of the sensor, for `calibration` of another Odometry (preset "default")."""
        self._core.save_calibration(os.fspath(path))

    def __repr__(self) -> str:
        return f"Odometry({self._words})"


def register(source: Scan, target: Scan, *, dt: Optional[float] = None, **options: Any) -> Frame:
    """Aligns two scans.

    Parameters
    ----------
    source, target : Scan
        The earlier and the later scan.
    dt : float, optional
        Time between them, s; by their stamps where it is not given.
    **options
        As of `Odometry`: preset, method, threads, settings, ...

    Returns
    -------
    Frame
        Of the later scan: `motion` is T_target_source, p_target = motion @ p_source, with its `covariance`.
    """
    if dt is not None:
        if not 1e-9 <= dt <= 3600.0:
            raise _core.UsageError(f"dt is {dt}, expected 1e-9 to 3600 s")
        source, target = _at(source, 0), _at(target, round(dt * 1e9))
    odometry = Odometry(**options)
    first = odometry.process(source)
    frame = odometry.process(target)
    if first.reason != "first":  # nothing to align from: the pair is no better than its source
        frame.status, frame.reason = first.status, first.reason
    return frame


def _at(scan: Scan, stamp_ns: int) -> Scan:
    moved = copy.copy(scan)
    moved.stamp_ns = stamp_ns
    return moved
