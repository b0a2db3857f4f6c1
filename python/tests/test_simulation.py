# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
import pickle

import numpy as np
import pytest
from conftest import run_program

import dynamic_icp


def files_in(folder):
    return {file.relative_to(folder): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def test_writes_the_bytes_of_the_program(folder, tmp_path):
    words = ["--frames", 6, "--set", "lidar.columns=300", "--set", "lidar.rows=32", "--quiet"]
    run_program("simulate", "city", "--output", tmp_path / "city", *words)
    assert files_in(folder) == files_in(tmp_path / "city")


def test_the_doppler_is_its_equation():
    drive = dynamic_icp.simulate("city", frames=2, noise_free=True, instant=True, lidar={"columns": 200, "rows": 16})
    scan = drive[1]
    truth = scan.truth
    directions = scan.points / np.linalg.norm(scan.points, axis=1)[:, None]
    static = truth.bodies == 0
    np.testing.assert_allclose(scan.doppler[static], -(directions @ truth.velocity)[static], atol=2e-3)
    np.testing.assert_allclose(np.linalg.norm(scan.points, axis=1), truth.true_range, atol=2e-3)
    moving = {one.id: one for one in truth.objects}
    assert set(np.unique(truth.bodies)) - {0} >= set(moving)
    for number, one in moving.items():
        assert np.count_nonzero(truth.bodies == number) == one.points
    np.testing.assert_allclose(drive.ground_truth.poses[1], truth.pose, atol=1e-15)


def test_the_scans_are_those_of_the_recording(drive, folder):
    recording = dynamic_icp.open(folder)
    assert len(drive) == len(recording)
    for made, read in zip(drive, recording):
        np.testing.assert_array_equal(made.points.astype(np.float32), read.points)
        np.testing.assert_array_equal(made.doppler.astype(np.float32), read.doppler)
        assert made.stamp_ns == read.stamp_ns


def test_a_rig_has_several_sensors():
    name = next(name for name in dynamic_icp.sensors() if len(dynamic_icp.simulate("city", frames=1, sensor=name).sensors) > 1)
    drive = dynamic_icp.simulate("city", frames=1, sensor=name)
    clouds = [drive.of(sensor)[0].points for sensor in drive.sensors]
    assert len({cloud.tobytes() for cloud in clouds}) == len(clouds)
    with pytest.raises(ValueError, match="sensor is 'none', expected one of"):
        drive.of("none")


def test_drives_can_be_pickled_and_shown(drive):
    again = pickle.loads(pickle.dumps(drive))
    np.testing.assert_array_equal(again[2].points, drive[2].points)
    assert "6 scans" in repr(drive) and "<table>" in drive._repr_html_()


def test_seeds_differ_and_names_are_checked():
    one, other = (dynamic_icp.simulate("city", frames=1, seed=seed, lidar={"columns": 50, "rows": 8})[0] for seed in (1, 2))
    assert one.points.tobytes() != other.points.tobytes()
    assert "city" in dynamic_icp.scenes() and "aeries-ii" in dynamic_icp.sensors()
    for arguments, message in (
        ({"scene": "moon"}, "moon"),
        ({"scene": "city", "sensor": "radar-9"}, "radar-9"),
        ({"scene": "city", "frames": 0}, "frames"),
        ({"scene": "city", "lidar": {"rows": -1}}, "rows"),
        ({"scene": "city", "no_such_key": 1}, "no_such_key"),
    ):
        with pytest.raises(dynamic_icp.UsageError, match=message):
            dynamic_icp.simulate(**arguments)


def test_an_earlier_drive_is_replaced_only_when_that_is_said(drive, tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(dynamic_icp.DataError):
        drive.save(tmp_path, replace=True)
    assert (tmp_path / "mine.txt").read_text() == "mine"
