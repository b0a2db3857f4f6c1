# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Recordings as sequences of scans, and what is wrong with their numbers."""

from __future__ import annotations

import dataclasses
import operator
import os
from collections.abc import Sequence
from typing import Any, Callable, Iterator, Optional, TypeVar, Union, overload

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._arrays import FloatArray, PathLike, text_of
from ._scan import Scan
from ._show import HtmlTable, table_html
from ._trajectory import Trajectory


AnyScan = TypeVar("AnyScan", bound=Scan)


class Scans(Sequence[AnyScan]):
    """Scans that are read when they are asked for; slices of it are such sequences too."""

    def __init__(self, read: Callable[[int], AnyScan], indices: range) -> None:
        self._read = read
        self._indices = indices

    def __len__(self) -> int:
        return len(self._indices)

    @overload
    def __getitem__(self, index: int) -> AnyScan: ...

    @overload
    def __getitem__(self, index: slice) -> Scans[AnyScan]: ...

    def __getitem__(self, index: Union[int, slice]) -> Union[AnyScan, Scans[AnyScan]]:
        if isinstance(index, slice):
            return Scans(self._read, self._indices[index])
        try:
            return self._read(self._indices[operator.index(index)])
        except IndexError:
            raise IndexError(f"scan {index} of {len(self)} scans") from None

    def __iter__(self) -> Iterator[AnyScan]:
        return (self._read(index) for index in self._indices)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {len(self)} scans>"


def input_texts(options: dict[str, Any]) -> list[tuple[str, str]]:
    """What is said of an input, as names and texts that the library knows; see `open`."""
    texts = []
    for name, value in options.items():
        key = name.replace("_", "-")
        if value is None:
            continue
        if key == "field":
            texts += [(f"field.{column}", str(stored)) for column, stored in dict(value).items()]
        elif key in ("topic", "lidar"):
            names = [value] if isinstance(value, str) else list(value)
            texts += [(f"{key}.{number + 1}", str(one)) for number, one in enumerate(names)]
        elif key == "columns" and not isinstance(value, str):
            texts.append((key, ",".join(value)))
        else:
            texts.append((key, text_of(value)))
    return texts


@dataclasses.dataclass
class Finding:
    """One answer of `diagnose`."""

    question: str
    """doppler_sign, doppler_kind, doppler_units, columns, point_times, ..."""
    verdict: str
    """ok, wrong, suspicious or cannot_tell."""
    sentence: str
    fix: str
    """The arguments of `open` that correct it, e.g. "doppler_sign='towards'"; empty where nothing does."""
    evidence: dict[str, float]
    """Numbers by name; the unit ends the name."""


class Findings(tuple[Finding, ...]):
    """What `diagnose` found, question by question."""

    def _repr_html_(self) -> str:
        return table_html([(one.question, one.verdict, one.sentence) for one in self], ("question", "verdict", ""))

    def __str__(self) -> str:
        return "\n".join(f"{one.question:16} {one.verdict:12} {one.sentence}" for one in self)


class Recording(Scans[Scan], HtmlTable):
    """A recording, made by `open`. Scans are read when they are asked for, also from several threads."""

    def __init__(self, path: PathLike, **options: Any) -> None:
        self.path = os.fspath(path)
        self.options = options
        self._core = _core.Recording(self.path, input_texts(options))
        super().__init__(lambda index: Scan(**self._core.scan(index)), range(self._core.__len__()))

    def __reduce__(self) -> tuple[Any, ...]:
        return (_reopened, (self.path, self.options))

    @property
    def format(self) -> str:
        """The name of the layout."""
        return self._core.format()

    @property
    def stamps_ns(self) -> NDArray[np.int64]:
        """(N,), ns, when each scan begins."""
        return self._core.stamps_ns()

    @property
    def ground_truth(self) -> Optional[Trajectory]:
        """What the recording brings along, or None."""
        stamps_ns, poses = self._core.ground_truth()
        return Trajectory(stamps_ns, poses) if len(poses) > 0 else None

    @property
    def T_vehicle_sensor(self) -> Optional[FloatArray]:
        """(4, 4), mounting of the sensor, or None."""
        return self._core.T_vehicle_sensor()

    @property
    def doppler_kind(self) -> str:
        """relative, or compensated: what the layout says."""
        return self._core.doppler_kind()

    @property
    def assumptions(self) -> list[str]:
        """What was taken for granted because the recording does not say it, in sentences."""
        return self._core.assumptions()

    def scan_file(self, index: int) -> str:
        """The file of a scan."""
        return self._core.scan_file(self._indices[index])

    def diagnose(self, probes: int = 10, threads: int = 0) -> Findings:
        """See `dynamic_icp.diagnose`."""
        return Findings(Finding(**members) for members in self._core.diagnose(probes, threads))

    def __repr__(self) -> str:
        return f"<Recording {self.path!r}: {len(self)} scans, {self.format}>"

    def _rows(self) -> list[tuple[str, str]]:
        rows = [("path", self.path), ("layout", self.format), ("scans", str(len(self)))]
        rows.append(("ground truth", "none" if self.ground_truth is None else f"{len(self.ground_truth)} poses"))
        return rows + [("assumed", one) for one in self.assumptions]


def _reopened(path: str, options: dict[str, Any]) -> Recording:
    return Recording(path, **options)


def open(
    path: PathLike,
    *,
    format: Optional[str] = None,
    field: Optional[dict[str, str]] = None,
    lidar: Union[str, list[str], None] = None,
    topic: Union[str, list[str], None] = None,
    truth_topic: Optional[str] = None,
    period: Optional[float] = None,
    columns: Union[str, list[str], None] = None,
    dtype: Optional[str] = None,
    doppler_sign: Optional[str] = None,
    doppler_kind: Optional[str] = None,
    doppler_scale: Optional[float] = None,
    point_scale: Optional[float] = None,
    time_scale: Optional[float] = None,
) -> Recording:
    """Opens a recording: a folder, a bag (ROS 1, ROS 2, MCAP) or a file of any form that docs/formats.md lists.

    Parameters
    ----------
    path : path
    format : str, optional
        Layout; found by its content where it is not given.
    field : mapping, optional
        Which stored column holds x, y, z, doppler or time: {"doppler": "velocity"}.
    lidar, topic : str or list of str, optional
        Sensors of a recording with several, topics of a bag.
    truth_topic : str, optional
        Topic of a bag whose poses are ground truth.
    period : float, optional
        s from scan to scan where the recording has no times.
    columns : str or list of str, optional
        What the numbers of a record without names are: "x,y,z,_,doppler"; "azimuth_deg,elevation_deg,range,doppler"
        (or azimuth_rad, elevation_rad) of spherical coordinates.
    dtype : str, optional
        Type of these numbers.
    doppler_sign : {"away", "towards"}, optional
        What a positive Doppler means.
    doppler_kind : {"relative", "compensated"}, optional
        As measured, or with the sensor's own motion taken out.
    doppler_scale, point_scale, time_scale : float, optional
        Factors that make it m/s, m and s.

    Returns
    -------
    Recording
        A sequence of `Scan`: len(), indices, slices, iteration.

    Raises
    ------
    DataError (an OSError and a ValueError)
        The recording cannot be read; the message names the file and, where something must be stated, the argument.
    UsageError (a ValueError)
        An argument cannot be meant.
    """
    options = {name: value for name, value in locals().items() if name != "path" and value is not None}
    return Recording(path, **options)


def diagnose(recording: Union[Recording, PathLike], *, probes: int = 10, threads: int = 0) -> Findings:
    """Looks for what is wrong with a recording: sign, kind and units of the Doppler, columns, times, mounting.

    Parameters
    ----------
    recording : Recording or path
    probes : int
        Stretches of the recording looked at, evenly spread.

    Returns
    -------
    Findings
        A tuple of `Finding`; those with verdict "wrong" come with the arguments of `open` that correct them.
    """
    opened = recording if isinstance(recording, Recording) else open(recording)
    return opened.diagnose(probes, threads)
