#!/usr/bin/env python3
"""What fuzzing has tried so far, as a table: executions and findings of each target as scripts/fuzz.sh notes them in
build-fuzz, and how many lines of the readers the inputs it kept reach (a build of its own by clang, build-coverage).

usage: scripts/fuzz_table.py [TARGET...]
       scripts/fuzz_table.py --speed SECONDS [TARGET...]    instead: executions a second of a processor in so many seconds,
                                                            of those programs that scripts/fuzz.sh has built
"""

import json
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
RESULTS = ROOT / "build-fuzz"
BUILD = ROOT / "build-coverage"

# What each target is there for: sources under dynamic_icp, by the beginnings of their names.
READERS = {
    "npy": ["recording/formats/npy"],
    "npz": ["recording/formats/npz"],
    "pcd": ["recording/formats/pcd_read", "recording/formats/pcd_header"],
    "ply": ["recording/formats/ply"],
    "tum": ["recording/formats/tum"],
    "xyzd": ["recording/formats/xyzd_bin"],
    "records": ["recording/datasets/record_guess"],
    "aevascenes": ["recording/datasets/aevascenes_sequence"],
    "columns": ["recording/datasets/column_file", "recording/datasets/column_scan"],
    "csv": ["recording/formats/csv", "recording/datasets/pose_file"],
    "texts": ["recording/datasets/calibration"],
    "rosbag": ["recording/bags/ros1_"],
    "mcap": ["recording/bags/mcap_file", "recording/bags/mcap_records"],
    "db3": ["recording/bags/sqlite_bag"],
    "messages": ["recording/messages/" + name
                 for name in ("messages", "cloud_columns", "ros_messages", "foxglove_protobuf", "foxglove_json",
                              "wire_cursor", "protobuf_cursor")],
    "settings": ["recording/formats/config_file", "recording/formats/yaml_", "recording/runs/calibration_file",
                 "tools/benchmark/manifest"],
    "live": ["recording/live/access", "recording/live/protocol"],
    "scans": ["method/"],
    "states": ["method/"],
}


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, text=True, **options)


def told(log):
    """The executions of a run that has not ended, or was killed: what it told last."""
    return max((int(number) for number in re.findall(r"^#(\d+)\t", log.read_text(errors="replace"), re.MULTILINE)), default=0)


def executions_of(target):
    """Executions over all runs of scripts/fuzz.sh, with sanitizers and without."""
    counts = {"sanitized": 0, "plain": 0}
    for line in (RESULTS / "executions.tsv").read_text().splitlines():
        name, executions, kind = (line.split("\t") + ["sanitized"])[:3]  # runs of earlier versions
        counts[kind] += int(executions) if name == target else 0
    for kind in counts:
        log = RESULTS / "running" / f"{target}.{kind}.log"
        counts[kind] += told(log) if log.exists() else 0
    return counts["sanitized"], counts["plain"]


def findings_of(target):
    return len(list((RESULTS / "findings").glob(f"{target}-*")))


def covered_lines(target):
    """Lines of the readers that are reached, and all that have code."""
    program = BUILD / "fuzz" / f"fuzz_{target}"
    raw, data = BUILD / f"{target}.profraw", BUILD / f"{target}.profdata"
    inputs = [folder for folder in (RESULTS / "corpus" / target, RESULTS / "seeds" / target) if folder.is_dir()]
    run(program, "-runs=0", *inputs, env={"LLVM_PROFILE_FILE": str(raw)}, stderr=subprocess.DEVNULL)
    run("llvm-profdata", "merge", "-sparse", raw, "-o", data)
    export = json.loads(run("llvm-cov", "export", "-summary-only", f"-instr-profile={data}", program,
                            stdout=subprocess.PIPE).stdout)
    reached = lines = 0
    for file in export["data"][0]["files"]:
        name = file["filename"].partition(f"{ROOT}/dynamic_icp/")[2]
        if any(name.startswith(reader) for reader in READERS[target]):
            reached += file["summary"]["lines"]["covered"]
            lines += file["summary"]["lines"]["count"]
    return reached, lines


def speed_of(program, target, seconds):
    """Executions a second of a processor from the inputs that were kept, which it reads first; "-" without the program."""
    if not program.exists():
        return "-"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory(dir="/dev/shm") as memory:
        inputs = [folder for folder in (RESULTS / "corpus" / target, RESULTS / "seeds" / target) if folder.is_dir()]
        log = run(program, "-seed=1", "-max_len=8192", "-entropic_feature_frequency_threshold=20", "-print_final_stats=1",
                  f"-max_total_time={seconds}", memory, *inputs, env={"TMPDIR": memory}, stderr=subprocess.PIPE).stderr
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    executions = int(re.search(r"^stat::number_of_executed_units: *(\d+)", log, re.MULTILINE).group(1))
    return f"{executions / (after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime):,.0f}"


def print_speeds(targets, seconds):
    print("| target | executions a second with sanitizers | without |")
    print("|---|---|---|")
    for target in targets:
        speeds = [speed_of(ROOT / build / "fuzz" / f"fuzz_{target}", target, seconds) for build in ("build-method", "build-deep")]
        print(f"| {target} | {speeds[0]} | {speeds[1]} |", flush=True)


def main():
    words = sys.argv[1:]
    seconds = None
    if words[:1] == ["--speed"]:
        if not words[1:2] or not re.fullmatch("[1-9][0-9]*", words[1]):
            sys.exit("usage: scripts/fuzz_table.py [--speed SECONDS] [TARGET...]")
        seconds, words = words[1], words[2:]
    targets = words or list(READERS)
    if unknown := [target for target in targets if target not in READERS]:
        sys.exit(f"unknown target '{unknown[0]}'; known are: {', '.join(READERS)}")
    if seconds:
        return print_speeds(targets, seconds)
    run("cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_COMPILER=clang++",
        "-DCMAKE_CXX_FLAGS_DEBUG=-O1", "-DCMAKE_CXX_FLAGS=-fprofile-instr-generate -fcoverage-mapping",
        "-DCMAKE_UNITY_BUILD=ON", "-DDYNAMIC_ICP_BUILD_FUZZERS=ON", "-DDYNAMIC_ICP_PRECOMPILED_HEADERS=OFF",
        stdout=subprocess.DEVNULL)
    run("cmake", "--build", BUILD, "--target", *(f"fuzz_{target}" for target in targets), stdout=subprocess.DEVNULL)
    print("| target | executions with sanitizers | without | findings | lines reached |")
    print("|---|---|---|---|---|")
    for target in targets:
        sanitized, plain = executions_of(target)
        reached, lines = covered_lines(target)
        print(f"| {target} | {sanitized:,} | {plain:,} | {findings_of(target)} | {reached} of {lines} "
              f"({100 * reached / lines:.0f} %) |")


if __name__ == "__main__":
    main()
