# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""The wheel of the Python package: CMake builds it, component `python` is what goes into it."""

import pathlib
import re

from skbuild import setup

folder = pathlib.Path(__file__).parent

setup(
    name="dynamic-icp",
    version=re.search(r"^project\(dynamic_icp VERSION ([0-9.]+)", (folder / "CMakeLists.txt").read_text(), re.M).group(1),
    description="Odometry and scan registration for FMCW LiDAR in highly dynamic scenes",
    license="MIT",
    python_requires=">=3.9",
    install_requires=["numpy>=1.19"],
    extras_require={"shown": ["matplotlib", "pandas"]},
    packages=["dynamic_icp"],
    package_dir={"": "python"},
    package_data={"dynamic_icp": ["py.typed", "*.pyi"]},
    entry_points={"console_scripts": ["dynamic-icp = dynamic_icp.__main__:main"]},
    cmake_install_dir="python/dynamic_icp",
    cmake_install_target="install-python",
    cmake_args=[
        "-DDYNAMIC_ICP_BUILD_PYTHON=ON",
        "-DDYNAMIC_ICP_BUILD_TESTS=OFF",
        "-DDYNAMIC_ICP_PYTHON_INSTALL_DIR=.",
        "-DCMAKE_UNITY_BUILD=ON",
        "-DCMAKE_UNITY_BUILD_BATCH_SIZE=20",
    ],
)
