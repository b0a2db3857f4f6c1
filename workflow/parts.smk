# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
#
# One long recording on many machines: it is cut into parts that overlap, each is a run of its own, and their trajectories are
# joined. docs/many-machines.md tells how to use it, and what a seam costs.
import json
import shlex
import subprocess
import sys

PROGRAM = config.get("program", "dynamic-icp")
if "recording" not in config or "output" not in config:
    sys.exit("expected --config recording=PATH output=DIR")
RECORDING, OUTPUT = config["recording"], config["output"]
PART, OVERLAP = int(config.get("part", 3000)), int(config.get("overlap", 100))
if not 0 < OVERLAP < PART:
    sys.exit(f"expected 0 < overlap < part, got {OVERLAP} and {PART}")
THREADS = int(config.get("threads", 1))


def first_scans():
    with open(checkpoints.recording.get().output[0], encoding="utf-8") as info:
        scans = json.load(info)["scans"]
    return list(range(0, max(scans - OVERLAP, 1), PART - OVERLAP))


localrules:
    all,
    recording,
    join,


wildcard_constraints:
    start="[0-9]+",


rule all:
    input:
        f"{OUTPUT}/trajectory.tum",


checkpoint recording:
    output:
        f"{OUTPUT}/recording.json",
    shell:
        "{PROGRAM:q} info {RECORDING:q} --json > {output:q}"


rule part:
    output:
        f"{OUTPUT}/parts/{{start}}/trajectory.tum",
    log:
        f"{OUTPUT}/parts/{{start}}.log",
    threads: THREADS
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * 2 ** (attempt - 1),
        runtime=lambda wildcards, attempt: int(10 + PART / 60) * 2 ** (attempt - 1),
    params:
        folder=lambda wildcards: f"{OUTPUT}/parts/{wildcards.start}",
        arguments=config.get("arguments", ""),
    retries: 3
    shell:
        # Status 3: most scans were lost. The part is there, and says so.
        "{PROGRAM:q} run {RECORDING:q} --start {wildcards.start} --max-frames {PART} --threads {THREADS} --force --quiet"
        " {params.arguments} --output {params.folder:q} > {log:q} 2>&1 || [ $? -eq 3 ]"


rule join:
    input:
        lambda wildcards: [f"{OUTPUT}/parts/{start}/trajectory.tum" for start in first_scans()],
    output:
        f"{OUTPUT}/trajectory.tum",
    params:
        script=f"{workflow.basedir}/join_trajectories.py",
    shell:
        "{params.script:q} {input:q} > {output:q}"
