# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""`python -m dynamic_icp` is the program dynamic-icp: the one in this package, or else the one that is installed."""

import os
import pathlib
import shutil
import sys


def main() -> int:
    beside = pathlib.Path(__file__).parent / "dynamic-icp"
    program = str(beside) if beside.exists() else shutil.which("dynamic-icp")
    if program is None:
        print("dynamic_icp: the program dynamic-icp is not installed", file=sys.stderr)
        return 1
    os.execv(program, ["dynamic-icp", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
