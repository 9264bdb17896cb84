#include "anthropometry/dimensions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "anthropometry/tape.h"
#include "anthropometry/uncertainty.h"

namespace vitruvian {
namespace {

constexpr double kThighBelowCrotch = 0.020;
constexpr double kCoarseStep = 0.010, kFineStep = 0.001;

SegmentSet set_of(std::initializer_list<const char*> names) {
  SegmentSet set = 0;
  for (const char* name : names) set |= 1u << segment_named(name);
  return set;
}

SegmentSet arms() {
  return set_of({"left_arm", "right_arm", "left_forearm", "right_forearm", "left_hand", "right_hand",
                 "left_hand_index", "right_hand_index"});
}
SegmentSet legs() {
  return set_of({"left_upper_leg", "right_upper_leg", "left_leg", "right_leg", "left_foot", "right_foot",
                 "left_toe_base", "right_toe_base"});
}

/// One side's name from a name of the table.
std::string sided(std::string_view name, const std::string& side) {
  return !name.empty() && name[0] == '*' ? side + "_" + std::string(name.substr(1)) : std::string(name);
}

/// What was found, on the standing body.
struct Finding {
  double value = 0;
  std::optional<Tape> tape;
  std::vector<const SurfaceLandmark*> line;  ///< corners of a path of landmarks
  bool from_middle = false;                  ///< the line's first corner is the middle of its first and last
  SegmentSet touched = 0;                    ///< segments whose fit matters
  CourseKind kind = CourseKind::tape;
  std::vector<Vec3d> mark;  ///< of heights and extents, on the standing body
};

class Taker {
 public:
  Taker(const Figure& standing, const LandmarkSet& landmarks)
      : figure_(standing),
        landmarks_(landmarks),
        tapes_(standing),
        floor_(standing.vertices.row(1).minCoeff()) {}

  std::optional<Finding> take(const DimensionSpec& spec, const std::string& side) {
    spec_ = &spec;
    side_ = side;
    wanted_ = spec.segment.empty() ? region() : 1u << segment_named(sided(spec.segment, side));
    switch (spec.kind) {
      case DimensionKind::stature: {
        Index top;
        figure_.vertices.row(1).maxCoeff(&top);
        return height(figure_.vertices.col(top), floor_, ends());
      }
      case DimensionKind::height:
        return height(middle(), floor_, touched({spec.a, spec.b}) | ends());
      case DimensionKind::vertical:
        return height(place(spec.a), place(spec.b).y(), touched({spec.a, spec.b}));
      case DimensionKind::distance:
        return line({spec.a, spec.b}, false);
      case DimensionKind::path:
        return line({spec.a, spec.b, spec.c}, false);
      case DimensionKind::distance_middle:
        return line({spec.a, spec.b, spec.c}, true);
      case DimensionKind::foot_extent:
        return foot_extent();
      default:
        return with_tape();
    }
  }

 private:
  const SurfaceLandmark& landmark(std::string_view name) const {
    return landmarks_.named(sided(name, side_));
  }
  Vec3d place(std::string_view name) const { return landmark(name).position(figure_.vertices); }
  /// Landmark a, or the mean of a and b.
  Vec3d middle() const {
    return spec_->b.empty() ? place(spec_->a) : Vec3d((place(spec_->a) + place(spec_->b)) / 2);
  }
  double level() const { return middle().y(); }

  SegmentSet touched(std::initializer_list<std::string_view> names) const {
    SegmentSet set = 0;
    for (const std::string_view name : names) {
      if (!name.empty()) set |= 1u << landmark(name).segment;
    }
    return set;
  }
  /// Heights depend on where the feet are.
  static SegmentSet ends() { return set_of({"left_foot", "right_foot", "left_toe_base", "right_toe_base"}); }

  SegmentSet region() const {
    switch (spec_->region) {
      case DimensionRegion::body_without_arms:
        return kAllSegments & ~arms();
      case DimensionRegion::torso:
        return kAllSegments & ~arms() & ~legs();
      case DimensionRegion::leg:
        return legs();
      case DimensionRegion::arm:
        return arms();
    }
    return kAllSegments;
  }

  static Finding height(const Vec3d& top, double low, SegmentSet touched) {
    return {top.y() - low, {}, {}, false, touched, CourseKind::height, {top, Vec3d(top.x(), low, top.z())}};
  }

  /// The outermost corners of a tape along an axis (0: left-right, 2: front-back), on one line.
  static std::vector<Vec3d> extent_of(const std::vector<Vec3d>& corners, Index axis) {
    const auto less = [&](const Vec3d& a, const Vec3d& b) { return a[axis] < b[axis]; };
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end(), less);
    Vec3d from = (*low + *high) / 2, to = from;
    from[axis] = (*low)[axis];
    to[axis] = (*high)[axis];
    return {from, to};
  }

  std::optional<Finding> line(std::initializer_list<std::string_view> names, bool from_middle) const {
    Finding finding;
    finding.kind = CourseKind::line;
    for (const std::string_view name : names) {
      finding.line.push_back(&landmark(name));
      finding.touched |= 1u << landmark(name).segment;
    }
    finding.from_middle = from_middle;
    return finding;
  }

  std::optional<Finding> foot_extent() const {
    Vec3d along = place(spec_->b) - place(spec_->a);
    along.y() = 0;
    along.normalize();
    Finding finding;
    double low = 1e30, high = -1e30;
    for (const char* name : {"foot", "toe_base"}) {
      const int segment = segment_named(side_ + "_" + name);
      finding.touched |= 1u << segment;
      for (const int v : figure_.model->vertices(segment)) {
        const double d = along.dot(figure_.vertices.col(v));
        low = std::min(low, d);
        high = std::max(high, d);
      }
    }
    finding.value = high - low;
    finding.kind = CourseKind::extent;
    const Vec3d heel = place(spec_->a);
    finding.mark = {heel + (low - along.dot(heel)) * along, heel + (high - along.dot(heel)) * along};
    return finding;
  }

  std::optional<Finding> with_tape() {
    std::optional<Tape> tape = lay();
    if (!tape) return std::nullopt;
    Finding finding;
    finding.touched = wanted_;
    const bool breadth =
        spec_->kind == DimensionKind::level_breadth || spec_->kind == DimensionKind::widest_breadth;
    const bool depth = spec_->kind == DimensionKind::level_depth;
    finding.value = breadth ? tape->section.breadth : depth ? tape->section.depth : tape->length;
    if (breadth || depth) {
      finding.kind = CourseKind::extent;
      finding.mark = extent_of(tape->course(figure_), breadth ? 0 : 2);
    } else {
      finding.tape = std::move(tape);
    }
    return finding;
  }

  std::optional<Tape> horizontal(double height) {
    return tapes_.girth({Vec3d(0, height, 0), Vec3d::UnitY()}, region(), wanted_, Vec3d::UnitX());
  }

  std::optional<Tape> across_limb(const Vec3d& through) {
    const SegmentAxis& axis = figure_.axes[static_cast<std::size_t>(segment())];
    return tapes_.girth({through, -axis.body_from_segment.col(1)}, region(), wanted_,
                        axis.body_from_segment.col(2));
  }

  std::optional<Tape> arc_over(const Vec3d& over) {
    const Vec3d a = place(spec_->a), b = place(spec_->b);
    return tapes_.arc({over, (b - a).cross(over - a).normalized()}, region(), wanted_, a, b, over);
  }

  /// From a to b over the left side's c, and back over the right side's.
  std::optional<Tape> neck_base() {
    std::optional<Tape> whole;
    for (const char* side : {"left", "right"}) {
      side_ = side;
      std::optional<Tape> part = arc_over(place(spec_->c));
      if (!part) return std::nullopt;
      if (!whole) {
        whole = std::move(part);
        continue;
      }
      whole->corners.insert(whole->corners.end(), part->corners.rbegin() + 1, part->corners.rend() - 1);
      whole->closed = true;
    }
    side_.clear();
    whole->length = whole->length_on(figure_);
    return whole;
  }

  int segment() const { return segment_named(sided(spec_->segment, side_)); }

  /// The place in [low, high] whose tape is best, coarse then fine. `better` compares two tapes.
  template <typename At, typename Better>
  std::optional<Tape> search(double low, double high, double metres_per_unit, const At& at,
                             const Better& better) {
    std::optional<Tape> best;
    double best_place = low;
    const auto scan = [&](double from, double to, double step) {
      const int steps = std::max(1, static_cast<int>(std::ceil((to - from) * metres_per_unit / step)));
      for (int i = 0; i <= steps; ++i) {
        const double place = from + (to - from) * i / steps;
        std::optional<Tape> tape = at(place);
        if (tape && (!best || better(*tape, *best))) best = std::move(tape), best_place = place;
      }
    };
    scan(low, high, kCoarseStep);
    const double around = kCoarseStep / metres_per_unit;
    scan(std::max(low, best_place - around), std::min(high, best_place + around), kFineStep);
    return best;
  }

  std::optional<Tape> lay() {
    const auto larger = [](const Tape& a, const Tape& b) { return a.length > b.length; };
    const auto smaller = [](const Tape& a, const Tape& b) { return a.length < b.length; };
    const auto wider = [](const Tape& a, const Tape& b) { return a.section.breadth > b.section.breadth; };
    const auto at_height = [&](double height) { return horizontal(height); };
    const auto at_fraction = [&](double t) {
      return across_limb(figure_.axes[static_cast<std::size_t>(segment())].at(t));
    };
    const auto limb_length = [&] { return figure_.axes[static_cast<std::size_t>(segment())].length(); };
    switch (spec_->kind) {
      case DimensionKind::level_girth:
      case DimensionKind::level_breadth:
      case DimensionKind::level_depth:
        return horizontal(level() - (spec_->id == "thigh_girth" ? kThighBelowCrotch : 0));
      case DimensionKind::widest_girth:
        return search(place(spec_->a).y(), place(spec_->b).y(), 1, at_height, larger);
      case DimensionKind::narrowest_girth:
        return search(place(spec_->a).y(), place(spec_->b).y(), 1, at_height, smaller);
      case DimensionKind::widest_breadth:
        return search(place(spec_->a).y(), place(spec_->b).y(), 1, at_height, wider);
      case DimensionKind::limb_girth:
        return across_limb(middle());
      case DimensionKind::limb_widest:
        return search(spec_->low, spec_->high, limb_length(), at_fraction, larger);
      case DimensionKind::limb_narrowest:
        return search(spec_->low, spec_->high, limb_length(), at_fraction, smaller);
      case DimensionKind::tilted_girth: {
        const Vec3d normal = (place(spec_->b) - place(spec_->a)).cross(Vec3d::UnitX()).normalized();
        return tapes_.girth({place(spec_->a), normal}, region(), wanted_, Vec3d::UnitX());
      }
      case DimensionKind::sagittal_arc: {
        const Vec3d a = place(spec_->a), b = place(spec_->b);
        const Vec3d over = spec_->c.empty() ? Vec3d((a + b) / 2) : place(spec_->c);
        return tapes_.arc({a, Vec3d::UnitX()}, region(), wanted_, a, b, over);
      }
      case DimensionKind::coronal_arc:
        return arc_over(place(spec_->c));
      case DimensionKind::neck_base:
        return neck_base();
      default:
        return std::nullopt;
    }
  }

  const Figure& figure_;
  const LandmarkSet& landmarks_;
  TapeMeasure tapes_;
  double floor_;
  const DimensionSpec* spec_ = nullptr;
  std::string side_;
  SegmentSet wanted_ = 0;
};

std::vector<Vec3d> line_course(const Finding& finding, const Figure& figure) {
  std::vector<Vec3d> corners;
  for (const SurfaceLandmark* landmark : finding.line) corners.push_back(landmark->position(figure.vertices));
  if (!finding.from_middle) return corners;
  return {(corners.front() + corners.back()) / 2, corners[1]};
}

double line_length(const std::vector<Vec3d>& corners) {
  double sum = 0;
  for (std::size_t i = 1; i < corners.size(); ++i) sum += (corners[i] - corners[i - 1]).norm();
  return sum;
}

}  // namespace

std::vector<Dimension> measure_dimensions(const Figure& standing, const Figure& scanned,
                                          const LandmarkSet& landmarks, const FitQuality& fit) {
  std::vector<Dimension> result;
  Taker taker(standing, landmarks);
  for (const DimensionSpec& spec : dimension_specs()) {
    const std::vector<std::string> sides =
        spec.paired ? std::vector<std::string>{"left", "right"} : std::vector<std::string>{""};
    for (const std::string& side : sides) {
      const std::optional<Finding> finding = taker.take(spec, side);
      if (!finding) continue;
      Dimension dimension;
      dimension.id = std::string(spec.id) + (side.empty() ? "" : "_" + side);
      dimension.name = spec.name;
      dimension.standard = spec.standard;
      dimension.definition = spec.definition;
      dimension.side = side;
      dimension.fit_error_m = mean_fit_error(finding->touched, fit.errors);
      dimension.course_kind = finding->kind;
      set_uncertainty(dimension, spec.id, finding->tape && finding->tape->closed, fit.refined);
      const bool on_landmarks = !finding->line.empty();
      for (const Posture posture : {Posture::standing, Posture::scanned}) {
        const Figure& figure = posture == Posture::standing ? standing : scanned;
        dimension.posture = posture;
        if (on_landmarks) {
          dimension.course = line_course(*finding, figure);
          dimension.value_m = line_length(dimension.course);
        } else if (finding->tape) {
          dimension.course = finding->tape->course(figure);
          if (finding->tape->closed) dimension.course.push_back(dimension.course.front());
          dimension.value_m =
              posture == Posture::standing ? finding->value : finding->tape->length_on(figure);
        } else if (posture == Posture::scanned) {
          continue;
        } else {
          dimension.value_m = finding->value;
          dimension.course = finding->mark;
        }
        result.push_back(dimension);
      }
    }
  }
  return result;
}

}  // namespace vitruvian
