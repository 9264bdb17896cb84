#include "anthropometry/segment_partition.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "base/error.h"

namespace vitruvian {
namespace {

using Edge = std::pair<int, int>;

/// An edge of a border and the label that its cap belongs to on the other side.
struct BorderEdge {
  Edge edge;
  int label;
};

std::uint64_t edge_key(int a, int b) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32 | static_cast<std::uint32_t>(b);
}

/// Groups of things that are connected.
class UnionFind {
 public:
  int find(int node) {
    auto found = parent_.find(node);
    if (found == parent_.end()) return parent_.emplace(node, node).first->first;
    int root = node;
    while (parent_[root] != root) root = parent_[root];
    while (parent_[node] != root) node = std::exchange(parent_[node], root);
    return root;
  }
  void join(int a, int b) {
    const int ra = find(a), rb = find(b);
    parent_[std::max(ra, rb)] = std::min(ra, rb);
  }

 private:
  std::unordered_map<int, int> parent_;
};

/// Edges of one border between two segments, split into connected curves, in a reproducible order.
std::vector<std::vector<BorderEdge>> connected_curves(const std::vector<BorderEdge>& border) {
  UnionFind joined;
  for (const BorderEdge& b : border) joined.join(b.edge.first, b.edge.second);
  std::map<int, std::vector<BorderEdge>> curves;
  for (const BorderEdge& b : border) curves[joined.find(b.edge.first)].push_back(b);
  std::vector<std::vector<BorderEdge>> result;
  for (auto& [root, curve] : curves) result.push_back(std::move(curve));
  return result;
}

/// The order in which segments are cut off: from the ends of the limbs inwards, so that what is left stays in
/// one piece and each cut is a cross-section of a limb. The hips remain.
constexpr std::array<int, kSegmentCount> kPeelOrder = {22, 23, 20, 21, 18, 19, 16, 17, 13, 14, 15, 12,
                                                       10, 11, 7,  8,  4,  5,  1,  2,  9,  6,  3,  0};

/// Directed edges on the border between two labels of a closed surface, each with the label of its own
/// triangle.
class Front {
 public:
  /// Adds an edge; it vanishes together with its reverse when both belong to one label: that is no border.
  void add(const Edge& edge, int label) {
    const auto [begin, end] = edges_.equal_range({edge.second, edge.first});
    for (auto i = begin; i != end; ++i) {
      if (i->second != label) continue;
      edges_.erase(i);
      return;
    }
    edges_.emplace(edge, label);
  }
  /// All edges of a label, removed together with their reverses; each with the label on its other side.
  std::vector<BorderEdge> take(int label) {
    std::vector<BorderEdge> taken;
    for (auto i = edges_.begin(); i != edges_.end();) {
      if (i->second == label) {
        taken.push_back({i->first, -1});
        i = edges_.erase(i);
      } else {
        ++i;
      }
    }
    for (BorderEdge& border : taken) {
      const auto reverse = edges_.find({border.edge.second, border.edge.first});
      if (reverse == edges_.end())
        throw Error(ErrorCode::internal, "the body's triangles are not oriented alike");
      border.label = reverse->second;
      edges_.erase(reverse);
    }
    return taken;
  }

 private:
  std::multimap<Edge, int> edges_;
};

}  // namespace

SegmentPartition::SegmentPartition(const Faces& faces, std::span<const std::uint8_t> segment) {
  node_begin_.resize(segment.size() + 1);
  std::iota(node_begin_.begin(), node_begin_.end(), 0);
  node_source_.resize(segment.size());
  std::iota(node_source_.begin(), node_source_.end(), 0);
  for (const std::uint8_t s : segment) {
    if (s >= kSegmentCount) throw Error(ErrorCode::internal, "a vertex belongs to no segment");
  }
  cut_faces(faces, segment);
  make_caps();
}

int SegmentPartition::add_node(std::vector<int> mean_of) {
  node_source_.insert(node_source_.end(), mean_of.begin(), mean_of.end());
  node_begin_.push_back(static_cast<int>(node_source_.size()));
  return node_count() - 1;
}

void SegmentPartition::add_skin(int segment, int a, int b, int c) {
  skin_[static_cast<std::size_t>(segment)].push_back({a, b, c});
}

void SegmentPartition::cut_faces(const Faces& faces, std::span<const std::uint8_t> segment) {
  std::unordered_map<std::uint64_t, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [found, is_new] = middles.try_emplace(edge_key(std::min(a, b), std::max(a, b)), 0);
    if (is_new) found->second = add_node({a, b});
    return found->second;
  };
  for (Index f = 0; f < faces.cols(); ++f) {
    std::array<int, 3> v{}, label{};
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = faces(static_cast<Index>(k), f);
      label[k] = segment[static_cast<std::size_t>(v[k])];
    }
    if (label[0] == label[1] && label[1] == label[2]) {
      add_skin(label[0], v[0], v[1], v[2]);
      continue;
    }
    if (label[0] != label[1] && label[1] != label[2] && label[2] != label[0]) {
      const int centre = add_node({v[0], v[1], v[2]});
      for (std::size_t k = 0; k < 3; ++k) {
        const int next = middle(v[k], v[(k + 1) % 3]), last = middle(v[k], v[(k + 2) % 3]);
        add_skin(label[k], v[k], next, centre);
        add_skin(label[k], v[k], centre, last);
      }
      continue;
    }
    // The corner that stands alone gets the tip.
    std::size_t tip = 0;
    while (label[tip] == label[(tip + 1) % 3] || label[tip] == label[(tip + 2) % 3]) ++tip;
    const int a = v[tip], b = v[(tip + 1) % 3], c = v[(tip + 2) % 3], ab = middle(a, b), ac = middle(a, c);
    add_skin(label[tip], a, ab, ac);
    add_skin(label[(tip + 1) % 3], ab, b, c);
    add_skin(label[(tip + 1) % 3], ab, c, ac);
  }
}

int SegmentPartition::add_apex(std::vector<int> around) {
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  std::vector<int> sources;
  for (const int node : around) {
    sources.insert(sources.end(), node_source_.begin() + node_begin_[static_cast<std::size_t>(node)],
                   node_source_.begin() + node_begin_[static_cast<std::size_t>(node) + 1]);
  }
  return add_node(std::move(sources));
}

void SegmentPartition::make_caps() {
  std::unordered_map<std::uint64_t, int> owner;
  for_each_skin_edge([&](int s, int a, int b) { owner.emplace(edge_key(a, b), s); });
  Front front;
  std::vector<BorderEdge> holes;
  for_each_skin_edge([&](int s, int a, int b) {
    const auto found = owner.find(edge_key(b, a));
    if (found == owner.end()) {
      holes.push_back({Edge(a, b), s});
    } else if (found->second != s) {
      front.add({a, b}, s);
    }
  });
  std::map<std::pair<int, int>, std::vector<Triangle>> caps;
  const auto close = [&](const std::vector<BorderEdge>& border, const auto& add_triangle) {
    for (const std::vector<BorderEdge>& curve : connected_curves(border)) {
      std::vector<int> around;
      for (const BorderEdge& b : curve) around.push_back(b.edge.first), around.push_back(b.edge.second);
      const int apex = add_apex(std::move(around));
      for (const BorderEdge& b : curve) add_triangle(b.edge, apex, b.label);
    }
  };
  // The skin runs along an edge, so the cap that continues it runs against the edge.
  close(holes, [&](const Edge& edge, int apex, int s) {
    caps[{s, kHole}].push_back({edge.second, edge.first, apex});
    front.add({edge.first, apex}, s);
    front.add({apex, edge.second}, s);
  });
  for (const int s : kPeelOrder) {
    close(front.take(s), [&](const Edge& edge, int apex, int other) {
      caps[{s, other}].push_back({edge.second, edge.first, apex});
      // What is left of the body sees the cap from its other side, as part of the neighbouring segment.
      front.add({edge.second, apex}, other);
      front.add({apex, edge.first}, other);
    });
  }
  for (auto& [sides, triangles] : caps) caps_.push_back({sides.first, sides.second, std::move(triangles)});
}

Points3d SegmentPartition::nodes(const Points3d& vertices) const {
  Points3d result(3, node_count());
  for (int i = 0; i < node_count(); ++i) {
    const int begin = node_begin_[static_cast<std::size_t>(i)],
              end = node_begin_[static_cast<std::size_t>(i) + 1];
    Vec3d sum = Vec3d::Zero();
    for (int k = begin; k < end; ++k) sum += vertices.col(node_source_[static_cast<std::size_t>(k)]);
    result.col(i) = sum / (end - begin);
  }
  return result;
}

Faces SegmentPartition::skin(SegmentSet segments) const {
  std::vector<Triangle> triangles;
  for (int s = 0; s < kSegmentCount; ++s) {
    if (segments >> s & 1) {
      const auto& own = skin_[static_cast<std::size_t>(s)];
      triangles.insert(triangles.end(), own.begin(), own.end());
    }
  }
  return triangles.empty() ? Faces(3, 0)
                           : Faces(Eigen::Map<const Faces>(triangles.front().data(), 3,
                                                           static_cast<Index>(triangles.size())));
}

SegmentPartition::ClosedSurface SegmentPartition::closed(SegmentSet segments) const {
  const auto has = [&](int s) { return s != kHole && (segments >> s & 1); };
  std::vector<Triangle> triangles;
  ClosedSurface surface;
  for (int s = 0; s < kSegmentCount; ++s) {
    if (!has(s)) continue;
    const auto& own = skin_[static_cast<std::size_t>(s)];
    triangles.insert(triangles.end(), own.begin(), own.end());
    surface.segment.insert(surface.segment.end(), own.size(), static_cast<std::int8_t>(s));
  }
  for (const Cap& cap : caps_) {
    if (has(cap.inside) == has(cap.outside)) continue;
    for (const Triangle& t : cap.triangles) {
      if (has(cap.inside)) {
        triangles.push_back(t);
      } else {
        triangles.push_back({t[0], t[2], t[1]});
      }
    }
    surface.segment.insert(surface.segment.end(), cap.triangles.size(), -1);
  }
  surface.faces =
      triangles.empty()
          ? Faces(3, 0)
          : Faces(Eigen::Map<const Faces>(triangles.front().data(), 3, static_cast<Index>(triangles.size())));
  return surface;
}

}  // namespace vitruvian
