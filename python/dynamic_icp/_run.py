# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Odometry over a recording with the files of a run, their report, and maps."""

from __future__ import annotations

import inspect
import json
import os
import pathlib
import sys
import tempfile
import warnings
from functools import partial
from typing import Any, Callable, Mapping, Optional, Union

from . import _core
from ._arrays import FloatArray, PathLike, whole_number
from ._frame import Frame
from ._odometry import method_settings
from ._recording import Recording, input_texts
from ._recording import open as open_recording
from ._show import COLOURS, HtmlTable, needed
from ._trajectory import Trajectory, read_trajectory


class Run(HtmlTable):
    """The results of `run`, or of the command `run`: a folder of files (docs/outputs.md).

    Parameters
    ----------
    folder : path
        Folder of a finished run.
    """

    def __init__(self, folder: PathLike) -> None:
        self.folder = pathlib.Path(folder)
        self.trajectory: Trajectory = read_trajectory(self.folder / "trajectory.tum")
        """T_world_sensor of each scan."""
        self.summary: dict[str, Any] = self._json("summary.json")
        """Errors against ground truth and statistics, by the keys of summary.json."""
        self.settings: dict[str, Any] = self._json("run.json")
        """How it was made: recording, settings, assumptions, warnings."""
        self._kept: Optional[tempfile.TemporaryDirectory[str]] = None

    def _json(self, name: str) -> dict[str, Any]:
        path = self.folder / name
        try:
            content: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise _core.DataError(f"{path}: cannot be read: {error}") from None
        return content

    def _lines(self, name: str) -> list[dict[str, Any]]:
        with (self.folder / name).open(encoding="utf-8") as lines:
            return [json.loads(line) for line in lines]

    def __reduce__(self) -> tuple[Any, ...]:
        if self._kept is not None:
            raise _core.UsageError("a run without a folder of its own cannot be pickled: give run() an output")
        return (Run, (str(self.folder),))

    @property
    def frames(self) -> list[dict[str, Any]]:
        """frames.jsonl: per scan status, ego velocity, twist, covariance, times."""
        return self._lines("frames.jsonl")

    @property
    def objects(self) -> list[dict[str, Any]]:
        """objects.jsonl: per scan the moving objects."""
        return self._lines("objects.jsonl")

    @property
    def failure(self) -> str:
        """Why the trajectory is a guess, where most scans are lost; else empty."""
        return str(self.summary.get("failure") or "")

    def report(self, path: Optional[PathLike] = None, *, threads: int = 0) -> pathlib.Path:
        """Writes the interactive HTML page, one file that opens offline; report.html in the folder of the run if no
        other place is named. It shows labels where the run has them (save_labels=True)."""
        html = self.folder / "report.html" if path is None else pathlib.Path(path)
        _core.write_report(str(self.folder), str(html), threads)
        return html

    def to_pandas(self) -> Any:
        """frames.jsonl as a pandas.DataFrame, one row a scan; nested values with a point in their names."""
        return needed("pandas", "to_pandas()").json_normalize(self.frames)

    def plot(self, ax: Any = None, ground_truth: Optional[Trajectory] = None) -> Any:
        """Draws the trajectory from above with matplotlib, beside a ground truth in the same world frame."""
        ax = self.trajectory.plot(ax, label="estimate")
        if ground_truth is not None:
            ground_truth.plot(ax, label="ground truth", color=COLOURS["ground_truth"], linestyle="--")
        ax.legend()
        return ax

    def __len__(self) -> int:
        return len(self.trajectory)

    def __repr__(self) -> str:
        return f"<Run {str(self.folder)!r}: {len(self)} scans, {self.trajectory.length:.1f} m>"

    def _rows(self) -> list[tuple[str, str]]:
        rows = [("folder", str(self.folder)), ("scans", str(len(self)))]
        rows.append(("statuses", ", ".join(f"{n} {word}" for word, n in self.summary["statuses"].items())))
        for key in ("rte_rmse_m", "rre_rmse_deg", "ate_rmse_m", "ms_median"):
            if self.summary.get(key) is not None:
                rows.append((key, f"{self.summary[key]:.4g}"))
        return rows + ([("failure", self.failure)] if self.failure else [])


def _show_progress(done: int, total: int) -> None:
    """One line on a terminal or in a notebook that counts up."""
    end = "\n" if done == total else ""
    print(f"\rscan {done} of {total}", end=end, file=sys.stderr, flush=True)


def run(
    path: Union[PathLike, Recording],
    output: Optional[PathLike] = None,
    *,
    preset: str = "default",
    method: str = "dynamic-icp",
    threads: int = 0,
    ablation: str = "none",
    settings: Optional[Mapping[str, Any]] = None,
    input: Optional[Mapping[str, Any]] = None,
    start: int = 0,
    max_scans: Optional[int] = None,
    ground_truth: Optional[PathLike] = None,
    calibration: Optional[PathLike] = None,
    save_labels: bool = False,
    save_map: Optional[PathLike] = None,
    map_voxel: float = 0.1,
    mcap: Optional[PathLike] = None,
    save_kitti: Optional[PathLike] = None,
    replace: bool = False,
    progress: Union[bool, Callable[[int, int], object]] = True,
    on_frame: Optional[Callable[[Frame], object]] = None,
    **more: Any,
) -> Run:
    """Odometry over a recording, as the command `run`: the same files with the same bits.

    Ctrl-C ends it after the scan at hand: the results so far are written, then KeyboardInterrupt is raised, and
    `Run(output)` opens them.

    Parameters
    ----------
    path : path or Recording
    output : path, optional
        Folder for the results, new or empty. Without it they are kept as long as the Run is.
    preset, method, threads, ablation, settings, **more
        As of `Odometry`.
    input : mapping, optional
        What is said of the recording, by the arguments of `open`; a Recording has said it already.
    start, max_scans : int
        First scan, and how many.
    ground_truth : path, optional
        Poses to compare with; what the recording brings along where it is not given.
    calibration : path, optional
        calibration.yaml of another run with this sensor.
    save_labels : bool
        Write the class or object of every point.
    save_map, mcap, save_kitti : path, optional
        Also write the static points (.ply, .pcd; one of each voxel of `map_voxel` m), the run for Foxglove, or the poses
        as KITTI has them.
    replace : bool
        Replace an earlier run in the folder, which may hold nothing else.
    progress : bool or callable
        Count the scans on standard error, or call progress(done, total).
    on_frame : callable, optional
        Is called with the `Frame` of each scan.

    Returns
    -------
    Run

    Raises
    ------
    DataError (an OSError and a ValueError)
        The recording cannot be read, its numbers are wrong beyond doubt, or something asked for beside the run could
        not be made.
    UsageError (a ValueError)
        Settings that cannot be meant.

    Warns
    -----
    UserWarning
        For what is odd about the recording, and where most scans are lost.
    """
    said = dict(input or {})
    if isinstance(path, Recording):
        said = {**path.options, **said}
        path = path.path
    kept = tempfile.TemporaryDirectory(prefix="dynamic-icp-") if output is None else None
    folder = os.path.join(kept.name, "run") if kept is not None else os.fspath(output or "")
    for name in more:
        if name in inspect.signature(open_recording).parameters:
            raise _core.UsageError(
                f"'{name}' is said of the recording: run(open(path, {name}=...)) or input={{'{name}': ...}}"
            )
    options = {
        "method": method,
        "preset": preset,
        "ablation": ablation,
        "settings": method_settings(method, preset, settings, more, run),
        "output": folder,
        "ground_truth": _text(ground_truth),
        "replace": replace,
        "threads": whole_number("threads", threads),
        "start": whole_number("start", start),
        "max_scans": None if max_scans is None else whole_number("max_scans", max_scans),
        "save_labels": save_labels,
        "map_file": _text(save_map),
        "map_voxel": map_voxel,
        "mcap_file": _text(mcap),
        "kitti_file": _text(save_kitti),
        "calibration": _text(calibration),
        "command": f"dynamic_icp.run({os.fspath(path)!r})",
    }
    count = progress if callable(progress) else (_show_progress if progress else None)
    came = _core.run(
        os.fspath(path),
        input_texts(said),
        options,
        count,
        lambda text: warnings.warn(text, stacklevel=3),
        None if on_frame is None else partial(_give_frame, on_frame),
    )
    if came["interrupted"]:
        raise KeyboardInterrupt(f"stopped; results so far in {folder}" if output is not None else "stopped")
    if came["failures"]:
        raise _core.DataError(f"{folder}: the run is there, but {'; '.join(came['failures'])}")
    if came["failure"]:
        warnings.warn(came["failure"], stacklevel=2)
    result = Run(folder)
    result._kept = kept
    return result


def _give_frame(on_frame: Callable[[Frame], object], members: dict[str, Any]) -> None:
    on_frame(Frame(**members))


def _text(path: Optional[PathLike]) -> Optional[str]:
    return None if path is None else os.fspath(path)


def report(run: Union[Run, PathLike], path: Optional[PathLike] = None, *, threads: int = 0) -> pathlib.Path:
    """Writes the interactive HTML page of a run, see `Run.report`."""
    return (run if isinstance(run, Run) else Run(run)).report(path, threads=threads)


class Map:
    """The static scene as one cloud of points: give it the frames of an `Odometry` in their order.

    Points that turn out to lie on moving objects are taken out again.

    Parameters
    ----------
    voxel_size : float
        m, edge of the voxels of which the first point is kept.
    """

    def __init__(self, voxel_size: float = 0.1) -> None:
        self._core = _core.Map(voxel_size)

    def add(self, frame: Frame) -> None:
        """Adds the static points of a frame."""
        self._core.add(frame)

    @property
    def points(self) -> FloatArray:
        """(N, 3), m, world frame, in the order in which they came."""
        return self._core.points()

    def save(self, path: PathLike) -> None:
        """Writes a point cloud, .ply or .pcd."""
        self._core.save(os.fspath(path))

    def __len__(self) -> int:
        return self._core.__len__()

    def __repr__(self) -> str:
        return f"<Map of {len(self)} points>"
