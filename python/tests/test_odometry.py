# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
import json
import pickle
import sys
import threading

import numpy as np
import pytest
from conftest import run_program

import dynamic_icp


def poses_of(scans, **options):
    odometry = dynamic_icp.Odometry(**options)
    return np.array([odometry.process(scan).pose for scan in scans])


def nested(key, value):
    for word in reversed(key.split(".")):
        value = {word: value}
    return value


def same_bits(left, right):
    return np.asarray(left).tobytes() == np.asarray(right).tobytes()


@pytest.mark.parametrize("threads", [1, 3])
def test_gives_the_bits_of_the_program(folder, program_run, tmp_path, threads):
    odometry = dynamic_icp.Odometry(threads=threads)
    frames = [odometry.process(scan) for scan in dynamic_icp.open(folder)]
    dynamic_icp.Trajectory.of(frames).save(tmp_path / "trajectory.tum")
    assert (tmp_path / "trajectory.tum").read_bytes() == (program_run / "trajectory.tum").read_bytes()
    label_files = sorted((program_run / "labels").iterdir())
    assert len(label_files) == len(frames)
    for frame, label_file in zip(frames, label_files):
        assert frame.labels.dtype == np.int32
        assert frame.labels.tobytes() == label_file.read_bytes()
    lines = [json.loads(line) for line in (program_run / "frames.jsonl").read_text().splitlines()]
    assert [frame.status for frame in frames] == [line["status"] for line in lines]
    assert [frame.reason for frame in frames] == [line["reason"] for line in lines]


@pytest.mark.parametrize(
    "method, key", [("dynamic-icp", "preprocess.voxel.voxel_size_m"), ("kiss-icp", "kiss_icp.voxel_size_m")]
)
def test_keywords_are_the_settings_of_the_program(folder, tmp_path, method, key):
    run_program("run", folder, "--output", tmp_path / "run", "--method", method, "--preset", "paper", "--set", f"{key}=1.0", "--quiet")
    expected = dynamic_icp.Run(tmp_path / "run").trajectory.poses
    for words in ({"settings": {key: 1.0}}, nested(key, 1.0)):
        odometry = dynamic_icp.Odometry("paper", method=method, **words)
        assert odometry.settings[key] == 1.0
        poses = np.array([odometry.process(scan).pose for scan in dynamic_icp.open(folder)])
        np.testing.assert_allclose(poses, expected, atol=1e-14)


def test_any_layout_of_the_arrays_gives_the_same_bits(drive):
    scans = drive[:3]
    expected = poses_of(scans)

    def laid_out(change):
        return [dynamic_icp.Scan(change(s.points), change(s.doppler), change(s.times), stamp_ns=s.stamp_ns) for s in scans]

    def read_only(array):
        array = array.copy()
        array.flags.writeable = False
        return array

    assert same_bits(poses_of(laid_out(np.asfortranarray)), expected)
    assert same_bits(poses_of(laid_out(read_only)), expected)
    assert same_bits(poses_of(laid_out(lambda array: np.repeat(array, 3, axis=0)[::3])), expected)
    assert same_bits(poses_of(laid_out(lambda array: array[::-1].copy()[::-1])), expected)
    assert same_bits(poses_of(laid_out(lambda array: array.tolist())), expected)


def test_float32_stays_float32_and_gives_the_bits_of_the_same_numbers_in_float64(drive):
    singles = [
        dynamic_icp.Scan(*(array.astype(np.float32) for array in (s.points, s.doppler, s.times)), stamp_ns=s.stamp_ns)
        for s in drive[:3]
    ]
    doubles = [
        dynamic_icp.Scan(*(array.astype(np.float64) for array in (s.points, s.doppler, s.times)), stamp_ns=s.stamp_ns)
        for s in singles
    ]
    assert singles[0].points.dtype == np.float32
    assert same_bits(poses_of(singles), poses_of(doubles))


def test_columns_of_a_structured_array_are_taken_where_they_lie(drive):
    scan = drive[1]
    records = np.zeros(len(scan), dtype=[("xyz", np.float64, 3), ("pad", np.uint8, 5), ("doppler", np.float32)])
    records["xyz"], records["doppler"] = scan.points, scan.doppler
    view = dynamic_icp.Scan(records["xyz"], records["doppler"])
    assert np.shares_memory(view.points, records) and np.shares_memory(view.doppler, records)
    plain = dynamic_icp.Scan(scan.points.copy(), scan.doppler.astype(np.float32))
    assert same_bits(dynamic_icp.ego_velocity(view).velocity, dynamic_icp.ego_velocity(plain).velocity)


def test_points_and_doppler_may_be_given_without_a_scan(drive):
    odometry = dynamic_icp.Odometry()
    poses = [odometry.process(s.points, s.doppler, s.times, stamp_ns=s.stamp_ns, line=s.line).pose for s in drive[:3]]
    assert same_bits(poses, poses_of([dynamic_icp.Scan(s.points, s.doppler, s.times, stamp_ns=s.stamp_ns, line=s.line) for s in drive[:3]]))


@pytest.mark.parametrize(
    "points, doppler, message",
    [
        (np.zeros((5, 2)), np.zeros(5), r"points has shape \(5, 2\), expected \(N, 3\)"),
        (np.zeros(15), np.zeros(5), r"points has shape \(15,\), expected \(N, 3\)"),
        (np.zeros((5, 3)), np.zeros((5, 1)), r"doppler has shape \(5, 1\), expected \(N,\)"),
        (np.zeros((5, 3)), np.zeros(4), r"4.*5|5.*4"),
        (np.zeros((5, 3), np.int32), np.zeros(5), r"points is of type int32, expected float32 or float64"),
        (np.zeros((5, 3), ">f8"), np.zeros(5), r"points is of type >f8, expected float32 or float64"),
        (np.zeros((5, 3)), np.array(["a"] * 5), r"doppler is of type <U1, expected float32 or float64"),
        (np.zeros((5, 3)), np.array([None] * 5), r"doppler is of type object, expected float32 or float64"),
        ([[1.0, 2.0], [1.0]], [1.0, 2.0], r"points is no array of numbers"),
    ],
)
def test_arrays_of_the_wrong_kind_are_named(points, doppler, message):
    with pytest.raises(ValueError, match=message):
        dynamic_icp.Odometry().process(points, doppler)


def test_channels_are_checked(drive):
    scan = drive[0]
    with pytest.raises(ValueError, match="line has numbers from 0 to 70000, expected 0 to 65535"):
        dynamic_icp.Scan(scan.points, scan.doppler, line=np.linspace(0, 70000, len(scan)).astype(int))
    with pytest.raises(ValueError, match="sensor is of type float64, expected whole numbers"):
        dynamic_icp.Scan(scan.points, scan.doppler, sensor=np.zeros(len(scan)))
    with pytest.raises(ValueError, match="doppler_kind is 'raw', expected relative or compensated"):
        dynamic_icp.Odometry().process(dynamic_icp.Scan(scan.points, scan.doppler, doppler_kind="raw"))


def test_what_is_no_measurement_is_dropped_and_counted(drive):
    scan = drive[0]
    points = np.array(scan.points)
    points[3] = np.nan
    points[4, 1] = np.inf
    points[5] = 0.0
    doppler = np.array(scan.doppler)
    doppler[6] = np.nan
    frame = dynamic_icp.Odometry().process(points, doppler)
    assert frame.status == "ok"
    assert frame.dropped["non_finite"] == 3 and frame.dropped["zero_range"] == 1
    assert all(frame.labels[3:7] == -1)


def test_a_scan_without_points_is_lost():
    frame = dynamic_icp.Odometry().process(np.zeros((0, 3)), np.zeros(0))
    assert (frame.status, frame.reason, frame.points) == ("lost", "too_few_points", 0)
    assert frame.labels.shape == (0,) and frame.static_points.shape == (0, 3)


def test_messages_are_those_of_the_program(folder, tmp_path):
    for words, settings in (("a.b=1", {"a.b": 1}), ("preprocess.voxel.voxel_size_m=-1", {"preprocess.voxel.voxel_size_m": -1})):
        _, stderr = run_program("run", folder, "--output", tmp_path / "none", "--set", words, status=2)
        with pytest.raises(dynamic_icp.UsageError) as error:
            dynamic_icp.Odometry(settings=settings)
        assert str(error.value).split("; did you mean")[0] in stderr  # the program knows more keys to mean
    with pytest.raises(ValueError, match="unknown method 'icp'|icp"):
        dynamic_icp.Odometry(method="icp")
    with pytest.raises(dynamic_icp.UsageError, match="unknown argument 'thread'; did you mean 'threads'"):
        dynamic_icp.Odometry(thread=2)
    with pytest.raises(dynamic_icp.UsageError, match="unknown argument 'save_label'; did you mean 'save_labels'"):
        dynamic_icp.run(folder, tmp_path / "none", save_label=True)
    with pytest.raises(dynamic_icp.UsageError, match="unknown argument 'max_frames'; did you mean 'max_scans'"):
        dynamic_icp.run(folder, tmp_path / "none", max_frames=3)
    with pytest.raises(dynamic_icp.UsageError, match="'doppler_sign' is said of the recording"):
        dynamic_icp.run(folder, tmp_path / "none", doppler_sign="towards")
    with pytest.raises(dynamic_icp.UsageError, match="threads is '4' of type str, expected a whole number"):
        dynamic_icp.Odometry(threads="4")
    with pytest.raises(ValueError, match="may be any of"):
        dynamic_icp.Odometry("paper", max_iterations=5)


def test_a_stamp_that_is_not_later_is_refused(drive):
    odometry = dynamic_icp.Odometry()
    odometry.process(drive[1])
    with pytest.raises(dynamic_icp.DataError):
        odometry.process(drive[0])


def test_a_frame_holds_what_it_says(drive):
    odometry = dynamic_icp.Odometry()
    frames = [odometry.process(scan) for scan in drive]
    last = frames[-1]
    assert last.pose.shape == (4, 4) and last.motion.shape == (4, 4)
    np.testing.assert_allclose(frames[-2].pose @ np.linalg.inv(last.motion), last.pose, atol=1e-9)
    assert last.covariance.shape == (6, 6) and last.twist.shape == (6,)
    truth = drive[-1].truth
    assert np.linalg.norm(last.ego_velocity - truth.velocity) < 0.1
    assert set(np.unique(last.labels)) - {-1, 0} <= {one.id for one in last.objects}
    assert "<table>" in last._repr_html_() and "ok" in repr(last)


def test_results_can_be_pickled(drive):
    odometry = dynamic_icp.Odometry()
    frames = [odometry.process(scan) for scan in drive[:4]]
    again = pickle.loads(pickle.dumps(frames[-1]))
    for name, value in vars(frames[-1]).items():
        if isinstance(value, np.ndarray):
            assert same_bits(getattr(again, name), value), name
    assert again.milliseconds == frames[-1].milliseconds
    assert [vars(one)["id"] for one in again.objects] == [one.id for one in frames[-1].objects]
    scan = pickle.loads(pickle.dumps(drive[0]))
    assert same_bits(scan.points, drive[0].points) and same_bits(scan.truth.true_doppler, drive[0].truth.true_doppler)


def test_other_threads_run_while_a_scan_is_processed(drive):
    inside = threading.Event()

    def is_seen_inside():
        odometry, scan = dynamic_icp.Odometry(threads=1), drive[0]

        def work():
            inside.set()
            odometry.process(scan)
            inside.clear()

        worker = threading.Thread(target=work)
        worker.start()
        inside.wait(timeout=10)
        seen = inside.is_set()
        worker.join()
        return seen

    interval = sys.getswitchinterval()
    sys.setswitchinterval(100.0)  # nobody takes the lock of the interpreter away: it has to be given up
    try:
        assert any(is_seen_inside() for _ in range(20))
    finally:
        sys.setswitchinterval(interval)


def test_two_threads_process_two_sequences(drive):
    expected = poses_of(drive)
    found = {}
    workers = [threading.Thread(target=lambda k=k: found.update({k: poses_of(drive, threads=1)})) for k in range(2)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert same_bits(found[0], expected) and same_bits(found[1], expected)


def test_registers_two_scans_as_the_program(folder):
    scans = dynamic_icp.open(folder)
    frame = dynamic_icp.register(scans[0], scans[1])
    stdout, _ = run_program("register", scans.scan_file(0), scans.scan_file(1), "--dt", "0.1")
    pair = json.loads(stdout)
    same = dynamic_icp.register(scans[0], scans[1], dt=0.1)
    np.testing.assert_allclose(same.motion.ravel(), np.ravel(pair["T_target_source"]), atol=1e-12)
    truth = scans.ground_truth.poses
    expected = np.linalg.inv(truth[1]) @ truth[0]
    np.testing.assert_allclose(frame.motion, expected, atol=0.01)
    with pytest.raises(ValueError, match="dt is 0"):
        dynamic_icp.register(scans[0], scans[1], dt=0)


def test_nothing_is_kept_of_what_was_given_or_given_back(drive):
    scan = drive[0]
    references = sys.getrefcount(scan.points)
    odometry = dynamic_icp.Odometry()
    frame = odometry.process(scan)
    afterwards = sys.getrefcount(scan.points)
    assert afterwards == references
    assert not frame.labels.flags.owndata and frame.labels.base is not None


def test_memory_does_not_grow():
    def resident_mb():
        with open("/proc/self/status", encoding="ascii") as lines:
            return next(int(line.split()[1]) / 1024 for line in lines if line.startswith("VmRSS"))

    points = np.random.default_rng(1).normal(size=(200_000, 3))
    scan = dynamic_icp.Scan(points, np.zeros(len(points)))
    for _ in range(5):
        dynamic_icp.velocity_filter(scan, [0.0, 0.0, 0.0])
    before = resident_mb()
    for _ in range(100):  # 2 MB each, if any were kept
        dynamic_icp.velocity_filter(scan, [0.0, 0.0, 0.0])
    assert resident_mb() - before < 50
