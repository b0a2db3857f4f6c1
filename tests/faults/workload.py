"""The commands of the program that write, each with its input, its result, and what a clean run of it gives."""
import hashlib
import json
import os
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

LONGEST_S = 120


@dataclass
class Command:
    """A command line in which {out} stands for the result."""

    name: str
    words: list
    result: str = "out"  # a folder or file; appears whole or not at all
    grows: bool = False  # results are put into a folder one by one, and what is done before a failure stays
    resumes: bool = False  # goes on where it was ended; for part resume alone
    clean: dict = field(default_factory=dict)  # of a clean run: file -> checksum, of those that are always the same
    names: set = field(default_factory=set)  # all files of a clean run
    seconds: float = 0.0  # that a clean run takes


@dataclass
class Outcome:
    status: int  # below 0: ended by that signal
    text: str


def checksums(path):
    """Of a file, or of all files in a folder."""
    files = [path] if path.is_file() else sorted(file for file in path.rglob("*") if file.is_file())
    return {str(file.relative_to(path)): hashlib.sha256(file.read_bytes()).hexdigest() for file in files}


TIMES = ("ms", "ms_mean", "ms_median", "ms_p95", "fps")


def without_times(value):
    return {key: part for key, part in value.items() if key not in TIMES}


def contents(path):
    """Of all files in the folder of a run, without times of computation."""
    files = {}
    for file in sorted(file for file in path.rglob("*") if file.is_file()):
        data = file.read_bytes()
        if file.name == "frames.jsonl":
            data = [without_times(json.loads(line)) for line in data.splitlines()]
        elif file.name == "summary.json":
            data = without_times(json.loads(data))
        files[str(file.relative_to(path))] = data
    return files


def remove(path):
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


class Workload:
    """Inputs in a folder of their own, and a folder `place` for results that is empty between commands."""

    def __init__(self, program, folder):
        self.program = str(program)
        self.folder = Path(folder)
        self.place = self.folder / "place"
        self.place.mkdir(parents=True)
        drive, run, longer = self.folder / "drive", self.folder / "run", self.folder / "longer"
        size = ["--frames", "4", "--set", "lidar.columns=90", "--set", "lidar.rows=12", "--quiet"]
        self._make(["simulate", "street", *size, "--output", drive])
        self._make(["simulate", "street", "--frames", "16", *size[2:], "--output", longer])
        self._make(["run", drive, "--quiet", "--output", run])
        self.commands = [
            Command("simulate", ["simulate", "street", *size, "--output", "{out}"]),
            Command("run", ["run", drive, "--quiet", "--threads", "1", "--save-labels", "--save-map", "{out}/map.pcd", "--report", "--output", "{out}"]),
            Command("run-resume", ["run", longer, "--quiet", "--threads", "1", "--save-labels", "--save-map", "{out}/map.pcd", "--save-kitti",
                                   "{out}/poses.txt", "--checkpoint", "0", "--resume", "--output", "{out}"], resumes=True),
            Command("run-live", ["run", drive, "--quiet", "--threads", "1", "--live", "0", "--output", "{out}"]),
            Command("run-mcap", ["run", drive, "--quiet", "--threads", "1", "--mcap", "{out}/run.mcap", "--output", "{out}"]),
            Command("convert-npz", ["convert", drive, "--to", "npz", "--quiet", "--output", "{out}"]),
            Command("convert-pcd", ["convert", drive, "--to", "pcd", "--quiet", "--output", "{out}"]),
            Command("report", ["report", run, "--output", "{out}"], "out.html"),
            Command("plot", ["plot", run, "--output", "{out}"], grows=True),
            Command("evaluate", ["evaluate", run / "trajectory.tum", drive / "ref_poses.txt"], ""),
            Command("benchmark", ["benchmark", drive, "--quiet", "--methods", "point-to-plane", "--ablations", "none", "--output", "{out}"],
                    grows=True),
        ]

    def _make(self, words):
        subprocess.run([self.program, *map(str, words)], check=True, capture_output=True, timeout=LONGEST_S)

    def line(self, command, place=None):
        out = (place or self.place) / (command.result or "out")
        return [self.program] + [str(word).replace("{out}", str(out)) for word in command.words]

    def run(self, command, environment=None, place=None, before=None):
        """Runs a command to its end. `before` is called in the child."""
        done = subprocess.run(self.line(command, place), env={**os.environ, **(environment or {})}, capture_output=True, text=True,
                              errors="replace", timeout=LONGEST_S, preexec_fn=before)
        return Outcome(done.returncode, done.stdout + done.stderr)

    def clear(self):
        for entry in self.place.iterdir():
            remove(entry)

    def result(self, command, place=None):
        return (place or self.place) / command.result if command.result else None

    def differs(self, command, place=None):
        """What is wrong with a result that is there; '' if nothing is."""
        there = self.result(command, place)
        if there is None:
            return ""
        if not there.exists():
            return "no result"
        got = {name: value for name, value in checksums(there).items() if not command.grows or ".partial-" not in name}
        if set(got) != command.names:
            return f"files {sorted(set(got) ^ command.names)} too few or too many"
        wrong = [name for name, value in command.clean.items() if got[name] != value]
        return f"other bytes in {wrong}" if wrong else ""

    def leftovers(self, command):
        """Names in the folder of results that are not of the result."""
        return sorted(entry.name for entry in self.place.iterdir() if entry.name != command.result)
