# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""What users pass in, as the extension module takes it."""

from __future__ import annotations

import decimal
import fractions
import math
import numbers
import operator
import os
from typing import Any, Mapping, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core

FloatArray = NDArray[np.float64]
PathLike = Union[str, "os.PathLike[str]"]
Stamp = Union[float, int, decimal.Decimal, fractions.Fraction, np.datetime64]

# A stamp is a number of nanoseconds in 64 bits, and half of them are kept in hand for differences.
MAX_STAMP_NS = 2**62


def stamp_to_ns(stamp: Optional[Stamp], stamp_ns: Optional[int]) -> int:
    """A time in whole nanoseconds, from seconds or nanoseconds; 0 where neither is given."""
    if stamp is not None and stamp_ns is not None:
        raise _core.UsageError("both stamp (s) and stamp_ns (ns) are given, expected one of them")
    if stamp_ns is not None:
        ns = operator.index(stamp_ns)
    elif stamp is None:
        ns = 0
    elif isinstance(stamp, np.datetime64):
        ns = int(stamp.astype("datetime64[ns]").astype(np.int64))
    elif isinstance(stamp, (int, decimal.Decimal, fractions.Fraction)):
        ns = round(fractions.Fraction(stamp) * 10**9)
    elif not isinstance(stamp, numbers.Real):
        raise _core.UsageError(f"stamp is {stamp!r} of type {type(stamp).__name__}, expected a time in seconds")
    else:
        if not math.isfinite(stamp):
            raise _core.UsageError(f"stamp is {stamp}, expected a time in seconds")
        ns = round(fractions.Fraction(float(stamp)) * 10**9)
    if abs(ns) > MAX_STAMP_NS:
        raise _core.UsageError(f"stamp is {ns} ns, expected at most {MAX_STAMP_NS} ns; is it in seconds?")
    return ns


def as_array(name: str, values: ArrayLike) -> NDArray[Any]:
    """An array without a copy where it is one; its shape and type are checked by the extension module."""
    try:
        return np.asarray(values)
    except ValueError as error:  # rows of different lengths
        raise _core.UsageError(f"{name} is no array of numbers: {error}") from None


def as_channel(name: str, values: Optional[ArrayLike], dtype: Any) -> Optional[NDArray[Any]]:
    """One number per point in the type that the library keeps it in, checked for its range."""
    if values is None:
        return None
    array = as_array(name, values)
    if array.dtype == dtype and array.flags.c_contiguous:
        return array
    if array.dtype.kind not in "iub" and np.dtype(dtype).kind != "f":
        raise _core.UsageError(f"{name} is of type {array.dtype}, expected whole numbers")
    if np.dtype(dtype).kind == "u" and array.size > 0:
        largest = np.iinfo(dtype).max
        if array.min() < 0 or array.max() > largest:
            raise _core.UsageError(f"{name} has numbers from {array.min()} to {array.max()}, expected 0 to {largest}")
    return np.ascontiguousarray(array, dtype=dtype)


def whole_number(name: str, value: Any) -> int:
    """An argument that counts something; its range is checked by the extension module."""
    try:
        return operator.index(value)
    except TypeError:
        found = f"{value!r} of type {type(value).__name__}"
        raise _core.UsageError(f"{name} is {found}, expected a whole number") from None


def text_of(value: object) -> str:
    """A value as a configuration file writes it."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    return str(value)


def flattened(settings: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Dotted names for mappings in mappings: {"a": {"b": 1}} is {"a.b": 1}."""
    flat: dict[str, Any] = {}
    for name, value in settings.items():
        if isinstance(value, Mapping):
            flat.update(flattened(value, f"{prefix}{name}."))
        else:
            flat[prefix + name] = value
    return flat


def setting_texts(
    given: Optional[Mapping[str, Any]], more: Mapping[str, Any], known: Optional[list[str]] = None
) -> list[tuple[str, str]]:
    """Keys and texts of settings; the end of a known key stands for it where no other key ends so."""
    texts = []
    for name, value in flattened({**(given or {}), **more}).items():
        key = name
        if known is not None and name not in known:
            meant = [full for full in known if full.endswith("." + name)]
            if len(meant) > 1:
                raise _core.UsageError(f"'{name}' may be any of {', '.join(meant)}; write the one that is meant")
            key = meant[0] if meant else name
        texts.append((key, text_of(value)))
    return texts
