// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/mutual_reachability.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "dynamic_icp/method/dynamics/core_distances.hpp"
#include "dynamic_icp/method/spatial/disjoint_sets.hpp"
#include "dynamic_icp/method/spatial/kd_tree.hpp"
#include "dynamic_icp/method/spatial/tree_walk.hpp"

namespace dynamic_icp::dynamics {
namespace {

using spatial::KdTree;

constexpr std::size_t kLeafSize = KdTree::kLeafSize;
constexpr std::uint32_t kNone = CoreDistances::kNone;
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using LeafValues = Eigen::Array<double, kLeafSize, 1>;

/// A number that several threads may lower.
class Bound {
 public:
  void set(double value) { value_.store(value, std::memory_order_relaxed); }
  [[nodiscard]] double get() const { return value_.load(std::memory_order_relaxed); }
  /// While no other thread does anything to it: a fraction of the time.
  void lower_alone_to(double value) { set(std::min(value, get())); }
  void lower_to(double value) {
    double now = get();
    while (value < now && !value_.compare_exchange_weak(now, value, std::memory_order_relaxed)) {
    }
  }

 private:
  std::atomic<double> value_{kLargest};
};

/// Boruvka's algorithm: in every round each component but the largest finds the smallest edge that leaves it, by the
/// total order of edges. All these edges belong to the tree, and they leave at most half as many components.
///
/// Points are known by their position in the kd-tree. What makes a round cheap:
///   - the largest component, where the most work would be, does not search;
///   - no edge of a point weighs less than its core distance: with a remembered neighbour outside its component
///     (CoreDistances::neighbours) it knows its smallest edge without a search;
///   - the smallest edge of a point stays the smallest until its other end has joined the component, and a search
///     that found nothing up to a weight need not be repeated up to that weight;
///   - nodes of the tree are left out that are too far away or, outside the component, too sparse to beat the best edge
///     known.
/// Bounds only leave out work that cannot change the outcome: the tree is the same in whatever order the searches run.
class SpanningTreeSearch {
 public:
  SpanningTreeSearch(std::span<const Eigen::Vector3d> points, std::size_t min_samples, const Workers& workers)
      : workers_(workers),
        tree_(points, workers),
        cores_(core_distances(tree_, points, min_samples, workers)),
        lower_bounds_(cores_.squared.begin(), cores_.squared.begin() + static_cast<std::ptrdiff_t>(points.size())),
        candidates_(points.size()),
        neighbours_passed_(points.size(), 0),
        components_(cores_.squared.size(), kNone),
        bounds_(points.size()),
        summaries_(tree_.node_count()),
        sets_(points.size()) {
    points_.reserve(points.size());
    for (const std::uint32_t number : tree_.order()) {
      points_.push_back(points[number]);
    }
    edges_.reserve(points.size() - 1);
    join_identical_points(points);
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
  /// An edge that leaves the component of a point. It is the smallest of that point if `lower_bounds_` says that there
  /// is no lighter one; else merely an edge that exists.
  struct Candidate {
    double squared_weight = kInfinity;
    double squared_length = kInfinity;
    std::uint32_t target = kNone;
  };

  /// What a search needs to know of the points of a node.
  struct NodeSummary {
    std::uint32_t component = kNone;    // of the densest point
    double squared_core = kInfinity;    // the smallest; that of the densest point
    double squared_others = kInfinity;  // none in another component has a smaller one
  };

  /// Points of one leaf that search together.
  struct Group {
    std::array<std::uint32_t, kLeafSize> members;
    std::size_t size = 0;
    std::uint32_t component = kNone;  // kNone when the members are of several components
    KdTree::Box box;
  };

  void join_identical_points(std::span<const Eigen::Vector3d> points);
  void start_round();
  void summarize(KdTree::Node node);
  void summarize_leaf(KdTree::Node leaf);
  [[nodiscard]] double least_core_outside(KdTree::Node node, std::uint32_t component) const;
  void propose_known_edges();
  [[nodiscard]] std::uint32_t remembered_neighbour_outside(std::uint32_t position);
  [[nodiscard]] bool must_search(std::uint32_t position) const;
  [[nodiscard]] Group group_in(std::size_t leaf) const;
  [[nodiscard]] double limit(const Group& group) const;
  void search_from(std::size_t leaf);
  void look_at(const Group& group, KdTree::Node leaf);
  void look_at(std::uint32_t position, std::size_t leaf);
  void join_components();
  [[nodiscard]] bool is_smaller(const Candidate& a, const Candidate& b) const;
  [[nodiscard]] ReachabilityEdge edge(std::uint32_t position) const;

  [[nodiscard]] std::uint32_t number(std::uint32_t position) const { return tree_.order()[position]; }
  [[nodiscard]] Bound& bound(std::uint32_t position) { return bounds_[components_[position]]; }
  [[nodiscard]] const Bound& bound(std::uint32_t position) const { return bounds_[components_[position]]; }

  const Workers& workers_;
  KdTree tree_;

  // By position; components_, like the core distances, to the end of the last leaf.
  CoreDistances cores_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> lower_bounds_;  // no edge that leaves the component from here has a smaller squared weight
  std::vector<Candidate> candidates_;
  std::vector<std::uint8_t> neighbours_passed_;  // so many of the remembered neighbours are in the component
  std::vector<std::uint32_t> components_;

  std::vector<Bound> bounds_;           // by component: squared weight of an edge that leaves it
  std::vector<NodeSummary> summaries_;  // by node
  std::uint32_t largest_component_ = kNone;
  spatial::DisjointSets sets_;
  std::vector<ReachabilityEdge> edges_;
};

/// Identical points have the same core distance, and the edges between them are the smallest that any of them has:
/// each joins the first of them.
void SpanningTreeSearch::join_identical_points(std::span<const Eigen::Vector3d> points) {
  if (std::adjacent_find(points.begin(), points.end()) == points.end()) {
    return;
  }
  std::vector<std::uint32_t> positions(points.size());
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    positions[number(p)] = p;
  }
  std::uint32_t first = 0;
  for (std::uint32_t i = 1; i < points.size(); ++i) {
    if (points[i] != points[first]) {
      first = i;
    } else {
      sets_.unite(positions[first], positions[i]);
      edges_.push_back({cores_.squared[positions[first]], 0.0, first, i});
    }
  }
}

void SpanningTreeSearch::start_round() {
  largest_component_ = sets_.find(0);
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    components_[p] = sets_.find(p);
    bounds_[p].set(kLargest);
    if (sets_.size(components_[p]) > sets_.size(largest_component_)) {
      largest_component_ = components_[p];
    }
  }
  summarize(tree_.root());
}

void SpanningTreeSearch::summarize(KdTree::Node node) {
  if (node.is_leaf()) {
    summarize_leaf(node);
    return;
  }
  summarize(node.left());
  summarize(node.right());
  const NodeSummary& left = summaries_[node.left().id];
  const NodeSummary& right = summaries_[node.right().id];
  NodeSummary& summary = summaries_[node.id];
  summary = left.squared_core <= right.squared_core ? left : right;
  summary.squared_others = std::min(least_core_outside(node.left(), summary.component),  //
                                    least_core_outside(node.right(), summary.component));
}

void SpanningTreeSearch::summarize_leaf(KdTree::Node leaf) {
  const std::size_t begin = leaf.first_leaf * kLeafSize;
  const std::size_t end = std::min(begin + kLeafSize, points_.size());
  NodeSummary& summary = summaries_[leaf.id] = {};
  for (std::size_t p = begin; p < end; ++p) {
    if (cores_.squared[p] < summary.squared_core) {
      summary.squared_core = cores_.squared[p];
      summary.component = components_[p];
    }
  }
  for (std::size_t p = begin; p < end; ++p) {
    if (components_[p] != summary.component) {
      summary.squared_others = std::min(summary.squared_others, cores_.squared[p]);
    }
  }
}

/// No point of the node outside `component` has a smaller squared core distance; infinite when there is none.
double SpanningTreeSearch::least_core_outside(KdTree::Node node, std::uint32_t component) const {
  const NodeSummary& summary = summaries_[node.id];
  return summary.component == component ? summary.squared_others : summary.squared_core;
}

/// The nearest one. Those that have joined the component stay in it: they are never looked at again.
std::uint32_t SpanningTreeSearch::remembered_neighbour_outside(std::uint32_t position) {
  const std::span<const std::uint32_t> neighbours = cores_.neighbours_of(position);
  for (std::size_t i = neighbours_passed_[position]; i < neighbours.size(); ++i) {
    const std::uint32_t neighbour = neighbours[i];
    if (neighbour == kNone || components_[neighbour] != components_[position]) {
      neighbours_passed_[position] = static_cast<std::uint8_t>(i);
      return neighbour;
    }
  }
  neighbours_passed_[position] = static_cast<std::uint8_t>(neighbours.size());
  return kNone;
}

/// Edges known without a search bound the searches that follow, those from their other end as well.
void SpanningTreeSearch::propose_known_edges() {
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    Candidate& candidate = candidates_[p];
    if (candidate.target == kNone || components_[candidate.target] == components_[p]) {
      candidate = {};
      const std::uint32_t neighbour = remembered_neighbour_outside(p);
      if (neighbour == kNone) {
        continue;
      }
      candidate = {cores_.squared[p], spatial::squared_length(points_[p] - points_[neighbour]), neighbour};
    }
    bound(p).lower_alone_to(candidate.squared_weight);
    bound(candidate.target).lower_alone_to(candidate.squared_weight);
  }
}

/// Whether a point may have a smaller edge than is known of its component.
bool SpanningTreeSearch::must_search(std::uint32_t position) const {
  const bool knows_its_smallest = candidates_[position].squared_weight <= lower_bounds_[position];
  return components_[position] != largest_component_ && !knows_its_smallest &&
         lower_bounds_[position] <= bound(position).get();
}

SpanningTreeSearch::Group SpanningTreeSearch::group_in(std::size_t leaf) const {
  Group group;
  const std::size_t end = std::min((leaf + 1) * kLeafSize, points_.size());
  for (std::size_t i = leaf * kLeafSize; i < end; ++i) {
    const auto p = static_cast<std::uint32_t>(i);
    if (!must_search(p)) {
      continue;
    }
    const bool first = group.size == 0;
    const Eigen::Array3d point = points_[p].array();
    group.box.lower = first ? point : group.box.lower.min(point);
    group.box.upper = first ? point : group.box.upper.max(point);
    group.component = first || group.component == components_[p] ? components_[p] : kNone;
    group.members[group.size++] = p;
  }
  return group;
}

/// The squared weight above which no member of the group needs an edge.
double SpanningTreeSearch::limit(const Group& group) const {
  double largest = 0.0;
  for (std::size_t i = 0; i < group.size; ++i) {
    largest = std::max(largest, bound(group.members[i]).get());
  }
  return largest;
}

void SpanningTreeSearch::search_from(std::size_t leaf) {
  const Group group = group_in(leaf);
  if (group.size == 0) {
    return;
  }
  double largest = limit(group);
  visit_nearest_first(
      tree_,
      [&](KdTree::Node node) {
        return std::max(squared_distance(group.box, tree_.box(node)), least_core_outside(node, group.component));
      },
      [&](KdTree::Node, double squared_reach) { return squared_reach <= largest; },
      [&](KdTree::Node other) {
        look_at(group, other);
        largest = limit(group);
      });
  for (std::size_t i = 0; i < group.size; ++i) {
    // All edges up to the bound have been looked at.
    const std::uint32_t p = group.members[i];
    lower_bounds_[p] = std::max(lower_bounds_[p], std::min(bound(p).get(), candidates_[p].squared_weight));
  }
}

/// Looks at the edges from the members of a group to the points of a leaf.
void SpanningTreeSearch::look_at(const Group& group, KdTree::Node leaf) {
  for (std::size_t i = 0; i < group.size; ++i) {
    const std::uint32_t p = group.members[i];
    const double squared_reach = std::max(
        {squared_distance(tree_.box(leaf), points_[p]), cores_.squared[p], least_core_outside(leaf, components_[p])});
    if (squared_reach <= bound(p).get()) {
      look_at(p, leaf.first_leaf);
    }
  }
}

void SpanningTreeSearch::look_at(std::uint32_t position, std::size_t leaf) {
  const LeafValues lengths = spatial::squared_distances(tree_.leaf(leaf), points_[position]);
  const Eigen::Map<const LeafValues> cores(&cores_.squared[leaf * kLeafSize]);
  const LeafValues weights = lengths.max(cores).max(cores_.squared[position]);
  const spatial::LeafRows near = spatial::rows_within(weights, bound(position).get());
  Candidate& best = candidates_[position];
  for (std::size_t i = 0; i < near.count; ++i) {
    const std::uint32_t row = near.rows[i];
    const auto target = static_cast<std::uint32_t>(leaf * kLeafSize + row);
    const Candidate candidate{weights[row], lengths[row], target};
    if (components_[target] != components_[position] && is_smaller(candidate, best)) {
      best = candidate;
      bound(position).lower_to(candidate.squared_weight);
      bound(target).lower_to(candidate.squared_weight);
    }
  }
}

/// Adds the smallest edge of every component that searched.
void SpanningTreeSearch::join_components() {
  std::vector<std::uint32_t> chosen(points_.size(), kNone);  // by component: the point that has the edge
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    std::uint32_t& best = chosen[components_[p]];
    const bool light_enough = candidates_[p].squared_weight <= bound(p).get();
    if (components_[p] != largest_component_ && light_enough && (best == kNone || edge(p) < edge(best))) {
      best = p;
    }
  }
  for (const std::uint32_t p : chosen) {
    if (p != kNone && sets_.unite(p, candidates_[p].target)) {
      edges_.push_back(edge(p));
    }
  }
}

/// The order of edges among those of one point.
bool SpanningTreeSearch::is_smaller(const Candidate& a, const Candidate& b) const {
  if (a.squared_weight != b.squared_weight) {
    return a.squared_weight < b.squared_weight;
  }
  if (a.squared_length != b.squared_length) {
    return a.squared_length < b.squared_length;
  }
  return number(a.target) < number(b.target);
}

ReachabilityEdge SpanningTreeSearch::edge(std::uint32_t position) const {
  const Candidate& candidate = candidates_[position];
  const std::uint32_t a = number(position);
  const std::uint32_t b = number(candidate.target);
  return {candidate.squared_weight, candidate.squared_length, std::min(a, b), std::max(a, b)};
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
