# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
import pickle
import signal

import numpy as np
import pytest

import dynamic_icp


def without_times(lines):
    return [{name: value for name, value in line.items() if "ms" not in name.split("_")} for line in lines]


def test_makes_the_files_of_the_program(folder, program_run, tmp_path):
    counted, frames = [], []
    run = dynamic_icp.run(
        folder,
        tmp_path / "run",
        save_labels=True,
        save_map=tmp_path / "map.ply",
        progress=lambda done, total: counted.append((done, total)),
        on_frame=frames.append,
    )
    for name in ("trajectory.tum", "objects.jsonl", "calibration.yaml"):
        assert (run.folder / name).read_bytes() == (program_run / name).read_bytes(), name
    for file in (program_run / "labels").iterdir():
        assert (run.folder / "labels" / file.name).read_bytes() == file.read_bytes()
    assert (tmp_path / "map.ply").read_bytes() == (program_run / "map.ply").read_bytes()
    theirs = dynamic_icp.Run(program_run)
    assert without_times(run.frames) == without_times(theirs.frames)
    assert run.objects == theirs.objects
    for key in ("rte_rmse_m", "ate_rmse_m", "statuses"):
        assert run.summary[key] == theirs.summary[key]
    assert counted == [(k, 6) for k in range(7)]
    np.testing.assert_array_equal([frame.stamp_ns for frame in frames], run.trajectory.stamps_ns)
    assert run.failure == "" and len(run) == 6
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(run)).trajectory.poses, run.trajectory.poses)


def test_a_map_of_frames_is_that_of_the_run(folder, program_run, tmp_path):
    odometry, of_frames = dynamic_icp.Odometry(), dynamic_icp.Map()
    for scan in dynamic_icp.open(folder):
        of_frames.add(odometry.process(scan))
    of_frames.save(tmp_path / "map.ply")
    assert (tmp_path / "map.ply").read_bytes() == (program_run / "map.ply").read_bytes()
    assert of_frames.points.shape == (len(of_frames), 3)
    with pytest.raises(ValueError, match=r"expected a file name that ends in .ply or .pcd"):
        of_frames.save(tmp_path / "map.xyz")


def test_without_a_folder_results_last_as_long_as_the_run(folder):
    run = dynamic_icp.run(dynamic_icp.open(folder), max_scans=2, progress=False)
    where = run.folder
    assert len(run) == 2 and where.is_dir() and "RTE" in str(dynamic_icp.evaluate(run, dynamic_icp.open(folder)))
    del run
    assert not where.exists()


def test_an_earlier_run_is_replaced_only_when_that_is_said(folder, tmp_path):
    dynamic_icp.run(folder, tmp_path / "run", max_scans=1, progress=False)
    with pytest.raises(dynamic_icp.DataError, match="replace=True"):
        dynamic_icp.run(folder, tmp_path / "run", max_scans=1, progress=False)
    dynamic_icp.run(folder, tmp_path / "run", max_scans=2, progress=False, replace=True)
    assert len(dynamic_icp.Run(tmp_path / "run")) == 2


@pytest.mark.parametrize("where", ["progress", "on_frame"])
def test_an_interrupt_keeps_the_results_so_far(folder, tmp_path, where):
    calls = []

    def interrupt(*_):
        calls.append(1)
        if len(calls) == 3:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt, match="results so far in"):
        dynamic_icp.run(folder, tmp_path / "run", **{"progress": False, where: interrupt})
    run = dynamic_icp.Run(tmp_path / "run")
    assert 2 <= len(run) <= 3 and run.summary["stopped"]


def test_an_error_in_a_callback_ends_the_run_without_results(folder, tmp_path):
    with pytest.raises(ZeroDivisionError):
        dynamic_icp.run(folder, tmp_path / "run", progress=False, on_frame=lambda frame: 1 / 0)
    assert list(tmp_path.iterdir()) == []


def test_the_page_holds_the_run(program_run, tmp_path):
    try:
        page = dynamic_icp.report(program_run, tmp_path / "report.html")
    except dynamic_icp.DataError as error:
        pytest.skip(str(error))
    text = page.read_text(encoding="utf-8")
    assert text.startswith("<!") and text.rstrip().endswith("</html>")


def test_tables_and_pictures(program_run, folder):
    run = dynamic_icp.Run(program_run)
    assert "<table>" in run._repr_html_() and "6 scans" in repr(run)
    pandas = pytest.importorskip("pandas")
    table = run.to_pandas()
    assert isinstance(table, pandas.DataFrame) and len(table) == 6 and set(table["status"]) == {"ok"}
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("svg")
    axes = run.plot(ground_truth=dynamic_icp.open(folder).ground_truth)
    assert [line.get_label() for line in axes.get_lines()] == ["estimate", "ground truth"]
    scan = dynamic_icp.open(folder)[-1]
    frame = dynamic_icp.Odometry().process(scan)
    assert frame.plot(scan).get_xlabel() == "x (m)"
    assert len(frame.to_pandas()) == len(frame.objects)


def test_what_is_no_run_is_named(folder, tmp_path):
    with pytest.raises(dynamic_icp.DataError, match="trajectory.tum"):
        dynamic_icp.Run(tmp_path)
    with pytest.raises(dynamic_icp.UsageError, match="no_such_key"):
        dynamic_icp.run(folder, tmp_path / "run", no_such_key=1)
    with pytest.raises(dynamic_icp.DataError, match="none.tum"):
        dynamic_icp.run(folder, tmp_path / "run", ground_truth=tmp_path / "none.tum", progress=False)


def test_how_a_run_was_made_is_in_it(folder, tmp_path):
    run = dynamic_icp.run(folder, tmp_path / "run", preset="paper", max_scans=2, start=1, progress=False)
    assert run.settings["command"] == f"dynamic_icp.run({str(folder)!r})"
    assert run.settings["preset"] == "paper"
