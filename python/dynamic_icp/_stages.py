# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Single stages of the method, to use alone."""

from __future__ import annotations

import dataclasses
from typing import Any, Mapping, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import FloatArray, as_array, setting_texts, whole_number
from ._frame import EgoVelocity
from ._scan import Scan


def _a_scan(scan: object) -> Scan:
    if not isinstance(scan, Scan):
        raise _core.UsageError(f"scan is of type {type(scan).__name__}, expected a Scan: Scan(points, doppler) makes one")
    return scan


def ego_velocity(
    scan: Scan,
    *,
    method: str = "consensus",
    prior: Optional[ArrayLike] = None,
    threads: int = 0,
    settings: Optional[Mapping[str, Any]] = None,
    **more: Any,
) -> EgoVelocity:
    """The velocity of the sensor from the Doppler of one scan.

    Static points obey s_i = -u_i . v + bias; v is what most of the scene agrees on.

    Parameters
    ----------
    scan : Scan
    method : {"consensus", "huber"}
        consensus: of preset "default", also where most points move. huber: of the paper, robust least squares from
        `prior`.
    prior : array of shape (3,), optional
        m/s, what is expected.
    settings, **more
        Settings of the stage, e.g. inlier_threshold_mps; docs/configuration.md.
    """
    given = None if prior is None else as_array("prior", prior).astype(np.float64)
    count = whole_number("threads", threads)
    return EgoVelocity(**_core.ego_velocity(_a_scan(scan), method, given, setting_texts(settings, more), count))


def velocity_filter(
    scan: Scan, velocity: ArrayLike, *, tau_0: float = 0.35, kappa: float = 0.005
) -> tuple[NDArray[np.bool_], FloatArray]:
    """Tells moving points from static ones by their Doppler.

    Parameters
    ----------
    scan : Scan
    velocity : array of shape (3,)
        m/s, of the sensor over ground in its axes.
    tau_0, kappa : float
        m/s and (m/s)/m: a point at distance d moves where |r| > tau_0 + kappa d.

    Returns
    -------
    moving : array of shape (N,), bool
    compensated : array of shape (N,)
        m/s, r_i = s_i + u_i . velocity; NaN for points that are no measurements.
    """
    given = as_array("velocity", velocity).astype(np.float64)
    moving, compensated = _core.velocity_filter(_a_scan(scan), given, tau_0, kappa)
    return moving.astype(bool), compensated


@dataclasses.dataclass(eq=False)
class CondensedTree:
    """The hierarchy of clusters of HDBSCAN; density lambda is 1 / distance (1/m).

    Cluster 0 holds all points; parents come before children. Empty where there are fewer points than a cluster needs.
    """

    parent: NDArray[np.uint32]
    """(C,), number of the cluster that it broke off; of 0: 0."""
    size: NDArray[np.uint32]
    """(C,), points at birth."""
    birth: FloatArray
    """(C,), lambda at which it parted from its parent."""
    death: FloatArray
    """(C,), lambda at which its last points left it or it broke in two; may be infinite."""
    stability: FloatArray
    """(C,), sum over its points of (lambda at leaving - birth)."""
    point_cluster: NDArray[np.uint32]
    """(N,), the smallest cluster that each point was in."""
    point_lambda: FloatArray
    """(N,), lambda at which it dropped out of that; may be infinite."""


@dataclasses.dataclass(eq=False)
class Clusters:
    """What `hdbscan` finds."""

    labels: NDArray[np.int32]
    """(N,), cluster of each point, 0, 1, ...; -1: noise."""
    probabilities: FloatArray
    """(N,), how much a point belongs to its cluster, 0 to 1."""
    stabilities: FloatArray
    """Of each cluster how persistent it is, 0 to 1."""
    tree: CondensedTree


def hdbscan(
    points: ArrayLike,
    *,
    min_cluster_size: int = 30,
    min_samples: int = 10,
    allow_single_cluster: bool = False,
    threads: int = 0,
) -> Clusters:
    """HDBSCAN (Campello et al. 2013) with excess of mass: clusters of any number and density, without a radius.

    Parameters
    ----------
    points : array of shape (N, 3) or (N, 2)
        m; all finite.
    min_cluster_size : int
        Fewest points of a cluster.
    min_samples : int
        The core distance of a point is that to its neighbour of this number, the point itself not counted.
    allow_single_cluster : bool
        Whether all points together may be one cluster.
    threads : int
        0: all. The result does not depend on it.

    Raises
    ------
    DataError (a ValueError)
        Names a point that is not finite.
    """
    given = as_array("points", points)
    if given.ndim == 2 and given.shape[1] == 2 and given.dtype in (np.float32, np.float64):
        given = np.column_stack([given, np.zeros(len(given), given.dtype)])
    members = _core.hdbscan(
        given,
        whole_number("min_cluster_size", min_cluster_size),
        whole_number("min_samples", min_samples),
        allow_single_cluster,
        whole_number("threads", threads),
    )
    tree = CondensedTree(**members.pop("tree"))
    return Clusters(**members, tree=tree)


class HDBSCAN:
    """`hdbscan` as an estimator with the interface of scikit-learn, which it does not need.

    After `fit`: labels_, probabilities_, stabilities_, condensed_tree_.
    """

    labels_: NDArray[np.int32]
    probabilities_: FloatArray
    stabilities_: FloatArray
    condensed_tree_: CondensedTree

    def __init__(
        self,
        min_cluster_size: int = 30,
        min_samples: int = 10,
        allow_single_cluster: bool = False,
        threads: int = 0,
    ) -> None:
        self.min_cluster_size = min_cluster_size
        self.min_samples = min_samples
        self.allow_single_cluster = allow_single_cluster
        self.threads = threads

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """The parameters by name; `deep` means nothing here."""
        names = ("min_cluster_size", "min_samples", "allow_single_cluster", "threads")
        return {name: getattr(self, name) for name in names}

    def set_params(self, **params: Any) -> HDBSCAN:
        """Changes parameters by name."""
        for name, value in params.items():
            if name not in self.get_params():
                raise _core.UsageError(f"unknown parameter '{name}', expected one of {', '.join(self.get_params())}")
            setattr(self, name, value)
        return self

    def fit(self, X: ArrayLike, y: object = None) -> HDBSCAN:
        """Clusters points of shape (N, 3) or (N, 2); `y` is ignored."""
        found = hdbscan(X, **self.get_params())
        self.labels_ = found.labels
        self.probabilities_ = found.probabilities
        self.stabilities_ = found.stabilities
        self.condensed_tree_ = found.tree
        return self

    def fit_predict(self, X: ArrayLike, y: object = None) -> NDArray[np.int32]:
        """Clusters points and gives their labels."""
        return self.fit(X).labels_

    def __repr__(self) -> str:
        return f"HDBSCAN({', '.join(f'{name}={value!r}' for name, value in self.get_params().items())})"


def normals(points: ArrayLike, *, radius: float = 2.0, max_neighbours: int = 30, threads: int = 0) -> FloatArray:
    """Surface normals of points: planes through their nearest neighbours.

    Parameters
    ----------
    points : array of shape (N, 3)
        m.
    radius : float
        m, how far neighbours may be.
    max_neighbours : int
        How many at most; the point itself counts.

    Returns
    -------
    array of shape (N, 3)
        Unit vectors of either sign; NaN where the neighbourhood is no plane or the point is not finite.
    """
    count = whole_number("max_neighbours", max_neighbours)
    return _core.normals(as_array("points", points), radius, count, whole_number("threads", threads))


def deskew(points: ArrayLike, times: ArrayLike, twist: ArrayLike) -> FloatArray:
    """Where points of a sensor in motion would have been measured at the stamp.

    Parameters
    ----------
    points : array of shape (N, 3)
        m, each in the sensor frame at its time.
    times : array of shape (N,)
        s after the stamp.
    twist : array of shape (6,)
        [angular (rad/s); linear (m/s)] of the sensor over ground, in its axes, constant: `Frame.twist`.

    Returns
    -------
    array of shape (N, 3)
        m, sensor frame at the stamp: p' = exp(time * twist) p. Points that are not finite stay so.
    """
    return _core.deskew(as_array("points", points), as_array("times", times), as_array("twist", twist).astype(np.float64))
