# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
import decimal
import fractions

import numpy as np
import pytest

import dynamic_icp

hypothesis = pytest.importorskip("hypothesis")
numbers = hypothesis.strategies

NOTHING = np.zeros((0, 3)), np.zeros(0)


@hypothesis.given(numbers.integers(-(2**62), 2**62))
def test_exact_stamps_stay_exact(ns):
    assert dynamic_icp.Scan(*NOTHING, stamp_ns=ns).stamp_ns == ns
    assert dynamic_icp.Scan(*NOTHING, stamp=fractions.Fraction(ns, 10**9)).stamp_ns == ns
    assert dynamic_icp.Scan(*NOTHING, stamp=decimal.Decimal(ns).scaleb(-9)).stamp_ns == ns
    assert dynamic_icp.Scan(*NOTHING, stamp=np.datetime64(ns, "ns")).stamp_ns == ns


@hypothesis.given(numbers.floats(-4e9, 4e9))
def test_floats_are_rounded_to_the_nearest_nanosecond(stamp):
    exact = fractions.Fraction(stamp) * 10**9
    assert abs(dynamic_icp.Scan(*NOTHING, stamp=stamp).stamp_ns - exact) <= fractions.Fraction(1, 2)


@hypothesis.settings(deadline=None, max_examples=30)
@hypothesis.given(
    numbers.lists(numbers.tuples(*[numbers.floats(width=64)] * 4), max_size=40),
    numbers.sampled_from([np.float32, np.float64]),
)
def test_no_number_makes_a_scan_fail(rows, dtype):
    with np.errstate(over="ignore"):
        values = np.array(rows, dtype=np.float64).reshape(-1, 4).astype(dtype)
    frame = dynamic_icp.Odometry(threads=1).process(values[:, :3], values[:, 3])
    assert frame.status == "lost" or np.isfinite(frame.pose).all()
    assert len(frame.labels) == len(rows)


@pytest.mark.parametrize(
    "words, message",
    [
        ({"stamp": 1, "stamp_ns": 1}, r"both stamp \(s\) and stamp_ns \(ns\) are given"),
        ({"stamp": float("nan")}, "stamp is nan, expected a time in seconds"),
        ({"stamp": 1.7e18}, "is it in seconds"),
        ({"stamp": "1"}, "stamp is '1' of type str, expected a time in seconds"),
        ({"stamp_ns": 2**63}, "expected at most"),
    ],
)
def test_other_stamps_are_refused(words, message):
    with pytest.raises(dynamic_icp.UsageError, match=message):
        dynamic_icp.Scan(*NOTHING, **words)
    with pytest.raises(TypeError):
        dynamic_icp.Scan(*NOTHING, stamp_ns=1.5)
