# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Inputs with the names that the documents use, made of short simulated drives."""

import pathlib
import re
import shutil
import subprocess
from collections.abc import Callable

import numpy as np

SMALL = ["--set", "lidar.columns=300", "--set", "lidar.rows=32", "--quiet"]


class Inputs:
    """Makes what commands name. Made once; each page gets a copy."""

    def __init__(self, folder: pathlib.Path, program: pathlib.Path) -> None:
        self.folder, self.program = folder, program
        folder.mkdir()
        self.makers: dict[str, Callable[[pathlib.Path], None]] = {
            "RECORDING": lambda path: self.simulate(path, "city", 20),
            "DRIVE": lambda path: self.simulate(path, "street", 12),
            "TUNNEL": lambda path: self.simulate(path, "tunnel", 10),
            "FOLDER": lambda path: self.run("convert", self.get("RECORDING"), "--to", "pcd", "--output", path),
            "RECORDING_TOWARDS": self.towards,
            "RECORDING_5": self.five_columns,
            "RECORDING_6": self.six_columns,
            "RECORDING_SPHERICAL": self.spherical,
            "RUN": lambda path: self.run("run", self.get("DRIVE"), "--output", path),
            "RUN1": lambda path: self.run("run", self.get("RECORDING"), "--output", path),
            "RUN2": lambda path: self.run("run", self.get("RECORDING"), "--preset", "paper", "--output", path),
            "BENCHMARK": self.benchmark,
            "RECORDING_NO_TIMES": self.without_times,
            "TRUTH.tum": lambda path: shutil.copyfile(self.get("RECORDING") / "ref_poses.txt", path),
            "drive.mcap": lambda path: self.run("convert", self.get("RECORDING"), "--to", "mcap", "--output", path),
        }

    def make(self, commands: str, sandbox: pathlib.Path) -> None:
        """Puts what the commands name into a sandbox, where it is not there yet."""
        for name in self.makers:
            target = sandbox / name
            word = rf"(?<![\w./-]){re.escape(name)}(?![\w.-])"
            if re.search(word, commands) and not re.search("--output " + word, commands) and not target.exists():
                made = self.get(name)
                (shutil.copytree if made.is_dir() else shutil.copyfile)(made, target)

    def get(self, name: str) -> pathlib.Path:
        path = self.folder / name
        if not path.exists():
            self.makers[name](path)
        return path

    def run(self, *words: object) -> None:
        subprocess.run([str(self.program), *map(str, words)], check=True, capture_output=True)

    def simulate(self, path: pathlib.Path, scene: str, frames: int) -> None:
        self.run("simulate", scene, "--frames", frames, "--output", path, *SMALL)

    def records(self, path: pathlib.Path, change: Callable[[np.ndarray], np.ndarray]) -> None:
        """The recording with other records x, y, z, Doppler."""
        shutil.copytree(self.get("RECORDING"), path)
        for file in (path / "point_clouds").glob("*.bin"):
            change(np.fromfile(file, "<f4").reshape(-1, 4)).astype("<f4").tofile(file)

    def towards(self, path: pathlib.Path) -> None:
        self.records(path, lambda rows: rows * np.float32([1, 1, 1, -1]))

    def five_columns(self, path: pathlib.Path) -> None:
        self.records(path, lambda rows: np.insert(rows, 3, 0.5, axis=1))

    def spherical(self, path: pathlib.Path) -> None:
        def change(rows: np.ndarray) -> np.ndarray:
            x, y, z, doppler = rows.T
            azimuth, elevation = np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))
            return np.column_stack([np.degrees(azimuth), np.degrees(elevation), np.linalg.norm(rows[:, :3], axis=1), doppler])

        self.records(path, change)

    def six_columns(self, path: pathlib.Path) -> None:
        shutil.copytree(self.get("RECORDING"), path)
        for file in (path / "point_clouds").glob("*.bin"):
            rows = np.fromfile(file, "<f4").reshape(-1, 4)
            times = np.fromfile(path / "times" / file.name, "<f4")
            np.column_stack([rows[:, :3], np.ones(len(rows)), rows[:, 3], times]).astype("<f8").tofile(file)
        shutil.rmtree(path / "times")

    def benchmark(self, path: pathlib.Path) -> None:
        self.run("benchmark", self.get("RECORDING"), "--methods", "dynamic-icp,gicp", "--output", path)

    def without_times(self, path: pathlib.Path) -> None:
        self.records(path, lambda rows: rows)
        shutil.rmtree(path / "times")
