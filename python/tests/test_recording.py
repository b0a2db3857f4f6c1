# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
import pathlib
import pickle
import shutil

import numpy as np
import pytest
from conftest import run_program

import dynamic_icp


def test_a_recording_is_a_sequence_of_scans(folder):
    recording = dynamic_icp.open(folder)
    assert len(recording) == 6
    assert recording.format == "dicp"
    records = np.fromfile(recording.scan_file(2), dtype=np.float32).reshape(-1, 4)
    np.testing.assert_array_equal(recording[2].points, records[:, :3])
    np.testing.assert_array_equal(recording[2].doppler, records[:, 3])
    np.testing.assert_array_equal(recording[-1].points, recording[5].points)
    assert [scan.stamp_ns for scan in recording[4:1:-2]] == [recording.stamps_ns[4], recording.stamps_ns[2]]
    assert [scan.stamp_ns for scan in recording] == recording.stamps_ns.tolist()
    assert len(recording[1:3][1:]) == 1
    with pytest.raises(IndexError, match="scan 6 of 6 scans"):
        recording[6]
    with pytest.raises(TypeError):
        recording["a"]


def test_the_ground_truth_is_that_of_the_file(folder):
    poses = dynamic_icp.open(folder).ground_truth
    lines = np.loadtxt(folder / "ref_poses.txt")
    np.testing.assert_allclose(poses.positions, lines[:, 1:4], atol=1e-12)
    assert poses.poses.shape == (6, 4, 4)


def test_recordings_can_be_pickled(folder):
    recording = pickle.loads(pickle.dumps(dynamic_icp.open(folder, doppler_sign="towards")))
    np.testing.assert_array_equal(recording[0].doppler, -dynamic_icp.open(folder)[0].doppler)


def test_the_diagnosis_says_what_to_change(folder, tmp_path):
    turned = tmp_path / "turned"
    shutil.copytree(folder, turned)
    for file in (turned / "point_clouds").glob("*.bin"):
        records = np.fromfile(file, dtype=np.float32).reshape(-1, 4)
        records[:, 3] *= -1
        records.tofile(file)
    wrong = [one for one in dynamic_icp.diagnose(turned) if one.verdict == "wrong"]
    assert [one.question for one in wrong] == ["doppler_sign"]
    assert wrong[0].fix == "doppler_sign='towards'"
    corrected = dynamic_icp.open(turned, doppler_sign="towards")
    np.testing.assert_array_equal(corrected[0].doppler, dynamic_icp.open(folder)[0].doppler)
    assert all(one.verdict != "wrong" for one in corrected.diagnose())
    with pytest.raises(dynamic_icp.DataError, match="doppler_sign='towards'"):
        dynamic_icp.run(turned, progress=False)
    assert "doppler_sign" in str(dynamic_icp.diagnose(turned))


def test_options_reach_the_reader(folder, tmp_path):
    plain = tmp_path / "plain"
    plain.mkdir()
    records = np.fromfile(dynamic_icp.open(folder).scan_file(0), dtype=np.float32).reshape(-1, 4)
    wide = np.column_stack([records[:, :3], np.zeros(len(records)), records[:, 3]])
    for index in range(2):
        np.savez(plain / f"{index}.npz", cloud=wide[:, :3], speed_of_points=wide[:, 4])
    scan = dynamic_icp.open(plain, field={"points": "cloud", "doppler": "speed_of_points"}, period=0.2)[1]
    np.testing.assert_array_equal(scan.doppler, records[:, 3])
    assert scan.stamp_ns == 200_000_000


def test_errors_are_those_of_the_program(folder, tmp_path):
    with pytest.raises(OSError) as error:
        dynamic_icp.open(tmp_path / "none")
    assert isinstance(error.value, ValueError) and isinstance(error.value, dynamic_icp.DataError)
    assert str(error.value) in run_program("info", tmp_path / "none", status=1)[1]
    with pytest.raises(dynamic_icp.UsageError, match="doppler_sign is 'up', expected away or towards"):
        dynamic_icp.open(folder, doppler_sign="up")
    with pytest.raises(dynamic_icp.UsageError, match="period is '-1"):
        dynamic_icp.open(folder, period=-1)
    recording = dynamic_icp.open(shutil.copytree(folder, tmp_path / "copy"))
    file = pathlib.Path(recording.scan_file(0))
    file.unlink()
    with pytest.raises(dynamic_icp.DataError, match=file.name):
        recording[0]
