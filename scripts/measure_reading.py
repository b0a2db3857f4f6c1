#!/usr/bin/env python3
"""What reading a recording costs beside processing it: processor time of each, one thread.

    PYTHONPATH=build/python scripts/measure_reading.py RECORDING... [--columns LIST]

Processor time, so that other work on the machine counts little. Reading is from the opened file to float64 arrays, the
files in the system's cache; processing is preset default. With --columns recordings of *.bin and *.npy are read so.
"""
import argparse
import os
import time

import dynamic_icp

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("recordings", nargs="+", metavar="RECORDING")
parser.add_argument("--columns", help="names of the numbers of records and arrays without names")
options = parser.parse_args()


def is_bare(path):
    return os.path.isdir(path) and any(name.endswith((".bin", ".npy")) for name in os.listdir(path))


def opened(path):
    given = {"columns": options.columns} if options.columns and is_bare(path) else {}
    if given and "float64" in os.path.basename(path):
        given["dtype"] = "float64"
    return dynamic_icp.open(path, **given)


print("| recording | points a scan | reading, ms a scan | processing, ms a scan | share |")
print("|---|---|---|---|---|")
for path in options.recordings:
    recording = opened(path)
    scans = [recording[k] for k in range(len(recording))]  # and warms the cache
    began = time.process_time()
    for k in range(len(recording)):
        recording[k]
    reading = time.process_time() - began
    odometry = dynamic_icp.Odometry(threads=1)
    began = time.process_time()
    for scan in scans:
        odometry.process(scan)
    processing = time.process_time() - began
    each = 1e3 / len(scans)
    points = sum(len(scan.points) for scan in scans) // len(scans)
    print("| %s | %d | %.2f | %.2f | %.2f |" % (os.path.basename(path.rstrip("/")), points, each * reading, each * processing,
                                              reading / processing), flush=True)
