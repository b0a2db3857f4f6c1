"""Runs the odometry over a recording and compares it with its ground truth: recording.py RECORDING"""

import sys

import dynamic_icp

recording = dynamic_icp.open(sys.argv[1])
print(recording, recording.diagnose(), sep="\n")
run = dynamic_icp.run(recording, progress=False)
if recording.ground_truth is not None:
    print(dynamic_icp.evaluate(run, recording))
run.trajectory.save("trajectory.tum")
