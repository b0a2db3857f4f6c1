// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/dynamics/mutual_reachability.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "dynamic_icp/dynamics/disjoint_sets.hpp"
#include "dynamic_icp/spatial/kd_tree.hpp"

namespace dynamic_icp::dynamics {
namespace {

using spatial::KdTree;

constexpr std::size_t kLeafSize = KdTree::kLeafSize;
constexpr std::size_t kMaxDepth = 32;
constexpr std::size_t kRememberedNeighbours = 16;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using LeafValues = Eigen::Array<double, kLeafSize, 1>;

/// Squared distance between two boxes. Added up like the distances of points, so that rounding cannot lift it above
/// the computed distance of any two points inside.
double squared_distance(const KdTree::Box& a, const KdTree::Box& b) {
  const Eigen::Array3d gap = (b.lower - a.upper).max(a.lower - b.upper).max(0.0);
  return (gap[0] * gap[0] + gap[1] * gap[1]) + gap[2] * gap[2];
}

double squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d d = a - b;
  return (d.x() * d.x() + d.y() * d.y()) + d.z() * d.z();
}

void lower_to(std::atomic<double>& bound, double value) {
  double now = bound.load(std::memory_order_relaxed);
  while (value < now && !bound.compare_exchange_weak(now, value, std::memory_order_relaxed)) {
  }
}

/// Boruvka's algorithm: in every round each component finds the smallest edge that leaves it, by the total order of
/// edges, and all these edges belong to the tree.
///
/// Points are known by their position in the kd-tree. What makes a round cheap:
///   - no edge of a point weighs less than its core distance; a point whose nearest foreign neighbours are no sparser
///     than itself knows its smallest edge without a search;
///   - the smallest edge of a point stays the smallest until its other end has joined the component, and a search
///     that found nothing below a weight need not be repeated below that weight;
///   - nodes of the tree that lie within the component, farther than the best edge known, or are too sparse, are
///     skipped.
/// Bounds only skip work that cannot change the outcome: the tree is the same whatever the order of the searches.
class SpanningTreeSearch {
 public:
  SpanningTreeSearch(std::span<const Eigen::Vector3d> points, std::size_t min_samples, const Workers& workers)
      : points_(points),
        workers_(workers),
        tree_(points, workers),
        core_(kLeafSize * tree_.leaf_count(), kInfinity),
        lower_bound_(points.size()),
        candidates_(points.size()),
        components_(kLeafSize * tree_.leaf_count(), kNone),
        bounds_(points.size()),
        node_core_(tree_.node_count()),
        node_component_(tree_.node_count()),
        sets_(points.size()) {
    edges_.reserve(points.size() - 1);
    find_core_distances(min_samples);
    join_identical_points();
  }

  std::vector<ReachabilityEdge> run() {
    while (sets_.count() > 1) {
      start_round();
      propose_known_edges();
      workers_.for_each(tree_.leaf_count(), 4, [this](std::size_t leaf) { search_from(leaf); });
      join_components();
    }
    std::sort(edges_.begin(), edges_.end());
    return std::move(edges_);
  }

 private:
  /// An edge from a point. It is the smallest that leaves the point's component if `lower_bound_` says that there is
  /// no lighter one; else it is merely an edge that exists.
  struct Candidate {
    double squared_weight = kInfinity;
    double squared_length = kInfinity;
    std::uint32_t target = kNone;
  };

  /// The points of one leaf that search together.
  struct Group {
    std::array<std::uint32_t, kLeafSize> members{};
    std::size_t size = 0;
    std::uint32_t component = kNone;  // kNone when the members are of several components
    KdTree::Box box;
  };

  [[nodiscard]] std::uint32_t number(std::uint32_t position) const { return tree_.order()[position]; }
  [[nodiscard]] const Eigen::Vector3d& point(std::uint32_t position) const { return points_[number(position)]; }

  [[nodiscard]] ReachabilityEdge edge(std::uint32_t position) const {
    const Candidate& candidate = candidates_[position];
    const std::uint32_t a = number(position);
    const std::uint32_t b = number(candidate.target);
    return {candidate.squared_weight, candidate.squared_length, std::min(a, b), std::max(a, b)};
  }

  void find_core_distances(std::size_t min_samples);
  void keep_dense_neighbours();
  double find_node_cores(KdTree::Node node);
  void join_identical_points();
  void start_round();
  std::uint32_t tag_nodes(KdTree::Node node);
  void propose_known_edges();
  [[nodiscard]] std::uint32_t nearest_foreign_neighbour(std::uint32_t position);
  void search_from(std::size_t leaf);
  [[nodiscard]] Group group_of(std::size_t leaf) const;
  [[nodiscard]] double limit(const Group& group) const;
  void visit(const Group& group, KdTree::Node leaf_node);
  void scan(std::uint32_t position, std::size_t leaf);
  void join_components();

  std::span<const Eigen::Vector3d> points_;
  const Workers& workers_;
  KdTree tree_;

  // By position. Padded to whole leaves: core_ with infinity, components_ with kNone.
  std::vector<double> core_;         // squared core distance
  std::vector<double> lower_bound_;  // no edge from here that leaves the component has a smaller squared weight
  std::vector<Candidate> candidates_;
  std::vector<std::uint32_t> components_;
  std::vector<std::uint32_t> neighbours_;  // kRememberedNeighbours or fewer for each, nearest first, then kNone
  std::size_t neighbours_each_ = 0;

  std::vector<std::atomic<double>> bounds_;    // by component: squared weight of an edge that leaves it
  std::vector<double> node_core_;              // by node: the smallest squared core distance within
  std::vector<std::uint32_t> node_component_;  // by node: the component of all its points, or kNone
  DisjointSets sets_;
  std::vector<ReachabilityEdge> edges_;
};

void SpanningTreeSearch::find_core_distances(std::size_t min_samples) {
  neighbours_each_ = std::min(min_samples, kRememberedNeighbours);
  neighbours_.assign(points_.size() * neighbours_each_, kNone);
  std::vector<std::uint32_t> position_of(points_.size());
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    position_of[number(p)] = p;
  }
  workers_.for_blocks(points_.size(), 256, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> found;
    for (std::size_t p = begin; p < end; ++p) {
      const std::uint32_t self = number(static_cast<std::uint32_t>(p));
      tree_.nearest_k(points_[self], min_samples + 1, kInfinity, found);
      // Among many identical points the point itself need not be found: then one of its twins takes its place.
      const auto own = std::find_if(found.begin(), found.end(), [&](const auto& f) { return f.index == self; });
      found.erase(own == found.end() ? found.end() - 1 : own);
      core_[p] = found.back().squared_distance;
      lower_bound_[p] = core_[p];
      for (std::size_t k = 0; k < neighbours_each_; ++k) {
        neighbours_[p * neighbours_each_ + k] = position_of[found[k].index];
      }
    }
  });
  keep_dense_neighbours();
  find_node_cores(tree_.root());
}

/// Of the remembered neighbours only those no sparser than the point itself matter: the edge to them weighs the core
/// distance of the point, the least that an edge of this point can weigh.
void SpanningTreeSearch::keep_dense_neighbours() {
  workers_.for_each(points_.size(), 256, [this](std::size_t p) {
    const auto begin = neighbours_.begin() + static_cast<std::ptrdiff_t>(p * neighbours_each_);
    const auto end = begin + static_cast<std::ptrdiff_t>(neighbours_each_);
    std::fill(std::remove_if(begin, end, [&](std::uint32_t q) { return core_[q] > core_[p]; }), end, kNone);
  });
}

double SpanningTreeSearch::find_node_cores(KdTree::Node node) {
  double& smallest = node_core_[node.id];
  if (node.is_leaf()) {
    const auto begin = core_.begin() + static_cast<std::ptrdiff_t>(node.first_leaf * kLeafSize);
    smallest = *std::min_element(begin, begin + kLeafSize);
  } else {
    smallest = std::min(find_node_cores(node.left()), find_node_cores(node.right()));
  }
  return smallest;
}

/// Identical points have the same core distance, and the edges between them are the smallest that any of them has:
/// they join first, each with the first of them.
void SpanningTreeSearch::join_identical_points() {
  std::vector<std::uint32_t> position_of(points_.size());
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    position_of[number(p)] = p;
  }
  std::uint32_t first = 0;
  for (std::uint32_t i = 1; i < points_.size(); ++i) {
    if (points_[i] != points_[first]) {
      first = i;
      continue;
    }
    sets_.unite(position_of[first], position_of[i]);
    edges_.push_back({core_[position_of[first]], 0.0, first, i});
  }
}

void SpanningTreeSearch::start_round() {
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    components_[p] = sets_.find(p);
    bounds_[p].store(kLargest, std::memory_order_relaxed);
  }
  tag_nodes(tree_.root());
}

std::uint32_t SpanningTreeSearch::tag_nodes(KdTree::Node node) {
  std::uint32_t& tag = node_component_[node.id];
  if (node.is_leaf()) {
    const auto begin = components_.begin() + static_cast<std::ptrdiff_t>(node.first_leaf * kLeafSize);
    const auto end =
        begin + static_cast<std::ptrdiff_t>(std::min(kLeafSize, points_.size() - node.first_leaf * kLeafSize));
    tag = std::all_of(begin, end, [&](std::uint32_t c) { return c == *begin; }) ? *begin : kNone;
  } else {
    const std::uint32_t left = tag_nodes(node.left());
    const std::uint32_t right = tag_nodes(node.right());
    tag = left == right ? left : kNone;
  }
  return tag;
}

/// The nearest remembered neighbour outside the component, or kNone.
std::uint32_t SpanningTreeSearch::nearest_foreign_neighbour(std::uint32_t position) {
  for (std::size_t k = 0; k < neighbours_each_; ++k) {
    const std::uint32_t neighbour = neighbours_[position * neighbours_each_ + k];
    if (neighbour == kNone || components_[neighbour] != components_[position]) {
      return neighbour;
    }
  }
  return kNone;
}

/// Edges known without a search bound the searches that follow, from both their ends.
void SpanningTreeSearch::propose_known_edges() {
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    Candidate& candidate = candidates_[p];
    if (candidate.target == kNone || components_[candidate.target] == components_[p]) {
      candidate = {};
      const std::uint32_t neighbour = nearest_foreign_neighbour(p);
      if (neighbour == kNone) {
        continue;
      }
      candidate = {core_[p], squared_distance(point(p), point(neighbour)), neighbour};
    }
    lower_to(bounds_[components_[p]], candidate.squared_weight);
    lower_to(bounds_[components_[candidate.target]], candidate.squared_weight);
  }
}

/// The points of a leaf that may have a smaller edge than is known of their component.
SpanningTreeSearch::Group SpanningTreeSearch::group_of(std::size_t leaf) const {
  Group group;
  const std::size_t end = std::min((leaf + 1) * kLeafSize, points_.size());
  for (std::size_t i = leaf * kLeafSize; i < end; ++i) {
    const auto p = static_cast<std::uint32_t>(i);
    const bool known = candidates_[p].squared_weight <= lower_bound_[p];
    if (known || lower_bound_[p] > bounds_[components_[p]].load(std::memory_order_relaxed)) {
      continue;
    }
    const Eigen::Array3d here = point(p).array();
    group.box =
        group.size == 0 ? KdTree::Box{here, here} : KdTree::Box{group.box.lower.min(here), group.box.upper.max(here)};
    group.component = group.size == 0 || group.component == components_[p] ? components_[p] : kNone;
    group.members[group.size++] = p;
  }
  return group;
}

/// The squared weight above which no member of the group needs an edge.
double SpanningTreeSearch::limit(const Group& group) const {
  double largest = 0.0;
  for (std::size_t i = 0; i < group.size; ++i) {
    largest = std::max(largest, bounds_[components_[group.members[i]]].load(std::memory_order_relaxed));
  }
  return largest;
}

void SpanningTreeSearch::search_from(std::size_t leaf) {
  const Group group = group_of(leaf);
  if (group.size == 0) {
    return;
  }
  struct Waiting {
    KdTree::Node node;
    double reach;  // no edge from the group into the node has a smaller squared weight
  };
  const auto reach = [&](KdTree::Node node) {
    return Waiting{node, std::max(squared_distance(group.box, tree_.box(node)), node_core_[node.id])};
  };
  std::array<Waiting, kMaxDepth> waiting;  // the nearer child is opened first: one stays behind at each level
  std::size_t count = 0;
  double largest = limit(group);
  waiting[count++] = reach(tree_.root());
  while (count > 0) {
    const auto [node, node_reach] = waiting[--count];
    const bool inside = group.component != kNone && node_component_[node.id] == group.component;
    if (inside || node_reach > largest) {
      continue;
    }
    if (node.is_leaf()) {
      visit(group, node);
      largest = limit(group);
      continue;
    }
    const Waiting left = reach(node.left());
    const Waiting right = reach(node.right());
    waiting[count++] = left.reach <= right.reach ? right : left;
    waiting[count++] = left.reach <= right.reach ? left : right;
  }
  for (std::size_t i = 0; i < group.size; ++i) {
    // All edges up to the bound have been looked at.
    const std::uint32_t p = group.members[i];
    const double bound = bounds_[components_[p]].load(std::memory_order_relaxed);
    lower_bound_[p] = std::max(lower_bound_[p], std::min(bound, candidates_[p].squared_weight));
  }
}

void SpanningTreeSearch::visit(const Group& group, KdTree::Node leaf_node) {
  for (std::size_t i = 0; i < group.size; ++i) {
    const std::uint32_t p = group.members[i];
    const Eigen::Array3d here = point(p).array();
    const double reach = std::max(squared_distance({here, here}, tree_.box(leaf_node)), node_core_[leaf_node.id]);
    if (node_component_[leaf_node.id] != components_[p] &&
        std::max(reach, core_[p]) <= bounds_[components_[p]].load(std::memory_order_relaxed)) {
      scan(p, leaf_node.first_leaf);
    }
  }
}

/// Looks at the edges from one point to all points of a leaf.
void SpanningTreeSearch::scan(std::uint32_t position, std::size_t leaf) {
  const LeafValues lengths = spatial::squared_distances(tree_.leaf(leaf), point(position));
  const Eigen::Map<const LeafValues> core(&core_[leaf * kLeafSize]);
  const LeafValues weights = lengths.max(core).max(core_[position]);
  const std::uint32_t component = components_[position];
  std::atomic<double>& bound = bounds_[component];
  Candidate& best = candidates_[position];
  for (std::size_t i = 0; i < kLeafSize; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto target = static_cast<std::uint32_t>(leaf * kLeafSize + i);
    if (weights[row] > bound.load(std::memory_order_relaxed) || components_[target] == component) {
      continue;
    }
    const auto key = [this](const Candidate& c) {
      return std::tuple(c.squared_weight, c.squared_length, c.target == kNone ? kNone : number(c.target));
    };
    const Candidate candidate{weights[row], lengths[row], target};
    if (key(candidate) < key(best)) {
      best = candidate;
      lower_to(bound, candidate.squared_weight);
      lower_to(bounds_[components_[target]], candidate.squared_weight);
    }
  }
}

void SpanningTreeSearch::join_components() {
  std::vector<std::uint32_t> best(points_.size(), kNone);
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    std::uint32_t& chosen = best[components_[p]];
    if (candidates_[p].target != kNone && (chosen == kNone || edge(p) < edge(chosen))) {
      chosen = p;
    }
  }
  for (const std::uint32_t p : best) {
    if (p != kNone && sets_.unite(p, candidates_[p].target)) {
      edges_.push_back(edge(p));
    }
  }
}

}  // namespace

std::vector<ReachabilityEdge> mutual_reachability_tree(std::span<const Eigen::Vector3d> points, int min_samples,
                                                       const Workers& workers) {
  const bool ordered = std::is_sorted(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
  });
  if (!ordered || min_samples < 1 || points.size() <= static_cast<std::size_t>(min_samples)) {
    throw std::invalid_argument("mutual reachability needs ordered points, more than min_samples >= 1");
  }
  return SpanningTreeSearch(points, static_cast<std::size_t>(min_samples), workers).run();
}

}  // namespace dynamic_icp::dynamics
