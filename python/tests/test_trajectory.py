# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
import pickle

import numpy as np
import pytest

import dynamic_icp

Rotation = pytest.importorskip("scipy.spatial.transform").Rotation


def random_trajectory(seed, n=60):
    random = np.random.default_rng(seed)
    poses = np.tile(np.eye(4), (n, 1, 1))
    for k in range(1, n):
        step = np.eye(4)
        step[:3, :3] = Rotation.from_rotvec(random.normal(scale=0.05, size=3)).as_matrix()
        step[:3, 3] = [1.0, 0.0, 0.0] + random.normal(scale=0.05, size=3)
        poses[k] = poses[k - 1] @ step
    return dynamic_icp.Trajectory(np.arange(n, dtype=np.int64) * 100_000_000 + 1_700_000_000_000_000_007, poses)


def test_tum_files_give_the_same_numbers_back(tmp_path):
    trajectory = random_trajectory(1)
    dynamic_icp.write_trajectory(tmp_path / "a.tum", trajectory)
    again = dynamic_icp.read_trajectory(tmp_path / "a.tum")
    np.testing.assert_array_equal(again.stamps_ns, trajectory.stamps_ns)
    np.testing.assert_array_equal(again.positions, trajectory.positions)
    np.testing.assert_allclose(again.poses, trajectory.poses, atol=1e-14)


def test_kitti_files_have_no_stamps(tmp_path):
    trajectory = random_trajectory(2)
    trajectory.save(tmp_path / "a.txt", "kitti")
    np.testing.assert_array_equal(np.loadtxt(tmp_path / "a.txt").reshape(-1, 3, 4), trajectory.poses[:, :3])
    again = dynamic_icp.read_trajectory(tmp_path / "a.txt")
    np.testing.assert_array_equal(again.poses[:, :3, 3], trajectory.positions)
    assert again.stamps_ns[:3].tolist() == [0, 10**9, 2 * 10**9]


def test_a_bad_line_is_named(tmp_path):
    (tmp_path / "a.tum").write_text("1.0 0 0 0 0 0 0 1\n2.0 0 0 nan 0 0 0 1\n")
    with pytest.raises(dynamic_icp.DataError, match="a.tum.*2"):
        dynamic_icp.read_trajectory(tmp_path / "a.tum")
    with pytest.raises(OSError):
        dynamic_icp.read_trajectory(tmp_path / "none.tum")


def test_the_errors_are_their_equations():
    truth, estimate = random_trajectory(3), random_trajectory(4)
    result = dynamic_icp.evaluate(estimate, truth)
    a, b = truth.poses, estimate.poses
    steps = [np.linalg.inv(np.linalg.inv(a[i]) @ a[i + 1]) @ np.linalg.inv(b[i]) @ b[i + 1] for i in range(len(a) - 1)]
    np.testing.assert_allclose(result.rte, [np.linalg.norm(step[:3, 3]) for step in steps], atol=1e-12)
    angles = [np.degrees(np.linalg.norm(Rotation.from_matrix(step[:3, :3]).as_rotvec())) for step in steps]
    np.testing.assert_allclose(result.rre, angles, atol=1e-9)
    assert result["rte_rmse_m"] == pytest.approx(np.sqrt(np.mean(result.rte**2)))

    centred_truth = truth.positions - truth.positions.mean(axis=0)
    centred = estimate.positions - estimate.positions.mean(axis=0)
    rotation, _ = Rotation.align_vectors(centred_truth, centred)
    np.testing.assert_allclose(result.ate, np.linalg.norm(rotation.apply(centred) - centred_truth, axis=1), atol=1e-9)
    np.testing.assert_allclose(result.T_reference_estimate[:3, :3], rotation.as_matrix(), atol=1e-9)
    assert "RTE" in str(result) and "<table>" in result._repr_html_()
    unmoved = dynamic_icp.evaluate(estimate, truth, align="none")
    np.testing.assert_allclose(unmoved.ate, np.linalg.norm(estimate.positions - truth.positions, axis=1), atol=1e-12)


def test_what_cannot_be_compared_is_refused():
    truth = random_trajectory(3)
    later = dynamic_icp.Trajectory(truth.stamps_ns + 10**15, truth.poses)
    with pytest.raises(dynamic_icp.DataError, match="time stamp|timestamp"):
        dynamic_icp.evaluate(later, truth)
    with pytest.raises(dynamic_icp.UsageError, match="align is 'sim2'"):
        dynamic_icp.evaluate(truth, truth, align="sim2")
    with pytest.raises(dynamic_icp.UsageError, match="gap_unit is 'hours'"):
        dynamic_icp.evaluate(truth, truth, gap_unit="hours")


@pytest.mark.parametrize(
    "stamps, poses, message",
    [
        (np.arange(3), np.zeros((3, 4, 3)), r"poses has shape \(3, 4, 3\), expected \(N, 4, 4\)"),
        (np.arange(2), np.zeros((3, 4, 4)), r"stamps_ns has shape \(2,\), expected \(3,\)"),
        (np.arange(3.0), np.zeros((3, 4, 4)), "stamps_ns is of type float64, expected whole numbers"),
    ],
)
def test_shapes_are_checked(stamps, poses, message):
    with pytest.raises(dynamic_icp.UsageError, match=message):
        dynamic_icp.Trajectory(stamps, poses)


def test_trajectories_can_be_pickled_and_shown():
    trajectory = random_trajectory(5)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(trajectory)).poses, trajectory.poses)
    assert "60 poses" in repr(trajectory)
    pytest.importorskip("pandas")
    table = trajectory.to_pandas()
    assert list(table.columns) == ["stamp_ns", "x", "y", "z"] and len(table) == 60
