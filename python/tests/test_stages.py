# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""Each stage against its equation in NumPy and SciPy."""

import numpy as np
import pytest

import dynamic_icp

distances = pytest.importorskip("scipy.spatial.distance")
hierarchy = pytest.importorskip("scipy.cluster.hierarchy")
linalg = pytest.importorskip("scipy.linalg")


def test_the_velocity_solves_the_equation_of_static_points(static_scan):
    directions = static_scan.points / np.linalg.norm(static_scan.points, axis=1)[:, None]
    expected, *_ = np.linalg.lstsq(-directions, static_scan.doppler, rcond=None)
    for method in ("consensus", "huber"):
        ego = dynamic_icp.ego_velocity(static_scan, method=method, prior=[9, 0, 0] if method == "huber" else None)
        np.testing.assert_allclose(ego.velocity, expected, atol=1e-6)
        assert ego.status == "converged"
        assert ego.covariance.shape == (3, 3)


def test_the_velocity_holds_where_a_third_of_the_points_moves(static_scan):
    doppler = static_scan.doppler.copy()
    doppler[::3] += 6.0
    ego = dynamic_icp.ego_velocity(dynamic_icp.Scan(static_scan.points, doppler))
    np.testing.assert_allclose(ego.velocity, [10.0, -1.0, 0.5], atol=0.02)


def test_wrong_words_are_named(static_scan):
    with pytest.raises(ValueError, match="method is 'ransac', expected consensus or huber"):
        dynamic_icp.ego_velocity(static_scan, method="ransac")
    with pytest.raises(ValueError, match="prior has shape"):
        dynamic_icp.ego_velocity(static_scan, prior=[1.0, 2.0])
    with pytest.raises(ValueError, match="no_such_key"):
        dynamic_icp.ego_velocity(static_scan, no_such_key=1)
    with pytest.raises(dynamic_icp.UsageError, match="scan is of type ndarray, expected a Scan"):
        dynamic_icp.ego_velocity(static_scan.points)
    with pytest.raises(dynamic_icp.UsageError, match="min_samples is 2.5 of type float, expected a whole number"):
        dynamic_icp.hdbscan(static_scan.points, min_samples=2.5)


def test_the_velocity_filter_is_its_equation(static_scan):
    random = np.random.default_rng(2)
    points, doppler = static_scan.points, static_scan.doppler + random.normal(scale=0.5, size=len(static_scan))
    points[7] = np.nan
    velocity = np.array([9.5, -1.0, 0.0])
    moving, compensated = dynamic_icp.velocity_filter(dynamic_icp.Scan(points, doppler), velocity, tau_0=0.3, kappa=0.01)
    distance = np.linalg.norm(points, axis=1)
    residual = doppler + (points @ velocity) / distance
    np.testing.assert_allclose(compensated, residual, atol=1e-12)
    assert moving.dtype == bool
    np.testing.assert_array_equal(moving, np.abs(residual) > 0.3 + 0.01 * distance)


def reference_hdbscan(points, min_cluster_size, min_samples):
    """HDBSCAN by its definition, from the full matrix of distances and SciPy's single linkage: labels, probabilities."""
    distance = distances.cdist(points, points)
    core = np.sort(distance, axis=1)[:, min_samples]
    reachability = np.maximum(np.maximum(core[:, None], core[None, :]), distance)
    np.fill_diagonal(reachability, 0)
    n = len(points)
    linkage = hierarchy.linkage(distances.squareform(reachability, checks=False), "single")

    def members(node):
        if node < n:
            return [node]
        return members(int(linkage[node - n, 0])) + members(int(linkage[node - n, 1]))

    size = lambda node: 1 if node < n else int(linkage[node - n, 3])
    clusters = [{"birth": 0.0, "lambdas": {}, "children": []}]

    def descend(node, cluster):
        """Follows a cluster down until it breaks into two that are large enough, or ends."""
        while node >= n:
            left, right, height = int(linkage[node - n, 0]), int(linkage[node - n, 1]), linkage[node - n, 2]
            large = [part for part in (left, right) if size(part) >= min_cluster_size]
            if len(large) == 2:
                for part in (left, right):
                    clusters.append({"birth": 1 / height, "lambdas": {}, "children": []})
                    clusters[cluster]["children"].append(len(clusters) - 1)
                    for point in members(part):
                        clusters[cluster]["lambdas"][point] = 1 / height
                    descend(part, len(clusters) - 1)
                return
            for part in (left, right):
                if part not in large:
                    for point in members(part):
                        clusters[cluster]["lambdas"][point] = 1 / height
            if not large:
                return
            node = large[0]

    descend(2 * n - 2, 0)
    stability = [sum(value - c["birth"] for value in c["lambdas"].values()) for c in clusters]

    def select(cluster):
        """The best clusters below and including this one, with their total stability."""
        below = [select(child) for child in clusters[cluster]["children"]]
        total = sum(value for _, value in below)
        if cluster == 0 or (below and total > stability[cluster]):
            return [one for chosen, _ in below for one in chosen], total
        return [cluster], stability[cluster]

    labels, probabilities = np.full(n, -1), np.zeros(n)
    for number, cluster in enumerate(select(0)[0]):
        last = max(clusters[cluster]["lambdas"].values())

        def give(c):
            for child in clusters[c]["children"]:
                give(child)
            for point, value in clusters[c]["lambdas"].items():
                labels[point] = number
                probabilities[point] = min(value, last) / last if c == cluster else probabilities[point]

        give(cluster)
        for child_points in (clusters[child]["lambdas"] for child in clusters[cluster]["children"]):
            for point in child_points:
                probabilities[point] = 1.0
    return labels, probabilities, linkage


def blobs(seed, dimension=3):
    random = np.random.default_rng(seed)
    centres = random.uniform(-20, 20, size=(4, dimension))
    spread = random.uniform(0.2, 2.0, size=4)
    noise = random.uniform(-30, 30, size=(30, dimension))
    return np.vstack([random.normal(centre, scale, size=(60, dimension)) for centre, scale in zip(centres, spread)] + [noise])


def agreement(found, order, expected, probabilities):
    """Of which points label, but for the numbers of clusters, and probability are as expected of them in some order."""
    labels = found.labels[order]
    names = {-1: -1}
    for number in set(expected.tolist()) - {-1}:
        inside = labels[(expected == number) & (labels >= 0)]
        names[number] = np.bincount(inside).argmax() if inside.size else -2
    agrees = np.empty(len(order), dtype=bool)
    agrees[order] = ([names[label] for label in expected.tolist()] == labels) & (
        np.abs(found.probabilities[order] - probabilities) < 1e-9
    )
    return agrees


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("min_samples, orders", [(1, 1), (5, 16)])
def test_hdbscan_is_its_definition(seed, dimension, min_samples, orders):
    # With more samples many distances are the same core distance. Where a point joins two clusters at one of these, the
    # order of equal steps decides whose it is, of the reference, too: each point must be as in one of some orders.
    points = blobs(seed, dimension)
    found = dynamic_icp.hdbscan(points, min_cluster_size=15, min_samples=min_samples)
    agrees = np.zeros(len(points), dtype=bool)
    for k in range(orders):
        order = np.arange(len(points)) if k == 0 else np.random.default_rng(k).permutation(len(points))
        agrees |= agreement(found, order, *reference_hdbscan(points[order], 15, min_samples)[:2])
    assert agrees.all()


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_tree_of_hdbscan_steps_where_its_definition_does(seed, dimension):
    points = blobs(seed, dimension)
    _, _, linkage = reference_hdbscan(points, 15, 5)
    tree = dynamic_icp.hdbscan(points, min_cluster_size=15, min_samples=5).tree
    assert tree.point_cluster.shape == (len(points),) and tree.size[0] == len(points)
    heights = np.append(linkage[:, 2], np.inf)  # every birth and every leaving is a step of the single linkage
    for density in (tree.birth[1:], tree.point_lambda):
        assert np.min(np.abs(1 / density[:, None] - heights[None, :]), axis=1).max() < 1e-9


def test_hdbscan_as_an_estimator():
    points = blobs(3)
    estimator = dynamic_icp.HDBSCAN(min_cluster_size=20, min_samples=5)
    labels = estimator.fit_predict(points)
    np.testing.assert_array_equal(labels, dynamic_icp.hdbscan(points, min_cluster_size=20, min_samples=5).labels)
    np.testing.assert_array_equal(estimator.labels_, labels)
    assert estimator.set_params(min_samples=7).get_params()["min_samples"] == 7
    with pytest.raises(ValueError, match="unknown parameter 'eps'"):
        estimator.set_params(eps=1)
    base = pytest.importorskip("sklearn.base")
    assert base.clone(estimator).get_params() == estimator.get_params()


def test_hdbscan_names_what_it_cannot_take():
    points = blobs(1)
    points[17, 2] = np.nan
    with pytest.raises(ValueError, match="17"):
        dynamic_icp.hdbscan(points)
    with pytest.raises(ValueError, match="min_cluster_size"):
        dynamic_icp.hdbscan(blobs(1), min_cluster_size=1)
    nothing = dynamic_icp.hdbscan(np.zeros((0, 3)))
    assert len(nothing.labels) == 0 and len(nothing.tree.size) == 0


def test_normals_are_those_of_a_sphere():
    random = np.random.default_rng(5)
    outward = random.normal(size=(20000, 3))
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    points = 10.0 * outward
    points[11] = np.inf
    found = dynamic_icp.normals(points, radius=1.0, max_neighbours=20)
    assert np.isnan(found[11]).all()
    there = np.isfinite(found[:, 0])
    assert there.sum() > 19000
    np.testing.assert_allclose(np.linalg.norm(found[there], axis=1), 1.0, atol=1e-12)
    assert np.median(np.abs(np.sum(found[there] * outward[there], axis=1))) > 0.999


def test_deskewing_is_the_exponential_of_the_twist():
    random = np.random.default_rng(6)
    points, times = random.normal(scale=20, size=(200, 3)), random.uniform(0, 0.1, size=200)
    twist = np.array([0.1, -0.2, 0.5, 12.0, 0.3, -0.1])
    found = dynamic_icp.deskew(points, times, twist)
    (a, b, c), velocity = twist[:3], twist[3:]
    generator = np.zeros((4, 4))
    generator[:3, :3] = [[0, -c, b], [c, 0, -a], [-b, a, 0]]
    generator[:3, 3] = velocity
    for point, time, moved in zip(points, times, found):
        expected = linalg.expm(generator * time) @ np.append(point, 1.0)
        np.testing.assert_allclose(moved, expected[:3], atol=1e-4)
    with pytest.raises(ValueError, match="times has 199 entries"):
        dynamic_icp.deskew(points, times[1:], twist)
    with pytest.raises(ValueError, match="twist has numbers that are not finite"):
        dynamic_icp.deskew(points, times, [np.nan] * 6)
