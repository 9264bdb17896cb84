#include "anthropometry/seated.h"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <utility>

#include "anthropometry/uncertainty.h"

namespace vitruvian {
namespace {

constexpr std::string_view kStandard = "ISO 7250-1:2017";

/// Lowest and highest vertex of some segments along an axis, among those that `keep` keeps.
struct Reach {
  Vec3d low = Vec3d::Zero(), high = Vec3d::Zero();
};
template <typename Keep>
Reach reach(const Figure& figure, std::initializer_list<std::string> segments, Index axis, const Keep& keep) {
  Reach found;
  bool any = false;
  for (const std::string& name : segments) {
    for (const int v : figure.model->vertices(segment_named(name))) {
      const Vec3d at = figure.vertices.col(v);
      if (!keep(at)) continue;
      if (!any || at[axis] < found.low[axis]) found.low = at;
      if (!any || at[axis] > found.high[axis]) found.high = at;
      any = true;
    }
  }
  return found;
}

bool all(const Vec3d& /*at*/) { return true; }

class Sitter {
 public:
  Sitter(const Figure& figure, const LandmarkSet& landmarks, const FitQuality& fit)
      : figure_(figure), landmarks_(landmarks), fit_(fit) {}

  std::vector<Dimension> take() {
    const double floor = figure_.vertices.row(1).minCoeff();
    const SegmentAxis& thigh = axis("left_upper_leg");
    const double mid_thigh = thigh.at(0.5).z();
    const auto seated_part = [&](const Vec3d& at) { return at.z() < mid_thigh; };
    const double seat = reach(figure_, {"hips", "left_upper_leg", "right_upper_leg"}, 1, seated_part).low.y();
    const Vec3d back = reach(figure_, {"hips", "left_upper_leg", "right_upper_leg"}, 2, seated_part).low;

    Index top;
    figure_.vertices.row(1).maxCoeff(&top);
    height("sitting_height", "sitting height", "", figure_.vertices.col(top), seat, {"head", "hips"},
           "vertical distance from the seat to the highest point of the head");
    height("cervicale_height_sitting", "cervicale height, sitting", "", place("cervicale"), seat,
           {"spine2", "hips"}, "vertical distance from the seat to the cervicale");
    bideltoid_breadth();
    const Reach hips = reach(figure_, {"hips", "left_upper_leg", "right_upper_leg"}, 0, all);
    extent("hip_breadth_sitting", "hip breadth, sitting", "", hips, 0,
           {"hips", "left_upper_leg", "right_upper_leg"},
           "left-right extent of hips and thighs, which no chair spreads");
    for (const std::string side : {"left", "right"}) {
      const std::string upper = side + "_upper_leg", lower = side + "_leg";
      height("shoulder_height_sitting", "shoulder height, sitting", side, place(side + "_acromion"), seat,
             {side + "_shoulder", "hips"}, "vertical distance from the seat to the acromion");
      height("knee_height_sitting", "knee height, sitting", side, reach(figure_, {lower}, 1, all).high, floor,
             {lower, side + "_foot"},
             "vertical distance from the floor to the highest point of the lower leg at the knee");
      const Vec3d crease = place(side + "_knee_crease");
      height("popliteal_height", "lower leg length (popliteal height)", side, crease, floor,
             {lower, side + "_foot"}, "vertical distance from the floor to the hollow of the knee");
      depth("buttock_knee_length", "buttock-knee length", side, back,
            reach(figure_, {upper, lower}, 2, all).high, {"hips", upper, lower},
            "horizontal distance from the rearmost point of the buttocks to the foremost point of the knee");
      depth("buttock_popliteal_length", "buttock-popliteal length (seat depth)", side, back, crease,
            {"hips", upper, lower},
            "horizontal distance from the rearmost point of the buttocks to the hollow of the knee");
    }
    return std::move(found_);
  }

 private:
  const SegmentAxis& axis(const char* segment) const {
    return figure_.axes[static_cast<std::size_t>(segment_named(segment))];
  }
  Vec3d place(const std::string& landmark) const {
    return landmarks_.named(landmark).position(figure_.vertices);
  }

  void add(const std::string& id, const char* name, const std::string& side, double value,
           std::initializer_list<std::string> touched, const char* definition, CourseKind kind,
           std::vector<Vec3d> course) {
    SegmentSet segments = 0;
    for (const std::string& each : touched) segments |= 1u << segment_named(each);
    Dimension dimension;
    dimension.id = id + (side.empty() ? "" : "_" + side);
    dimension.name = name;
    dimension.standard = kStandard;
    dimension.definition = definition;
    dimension.side = side;
    dimension.posture = Posture::sitting;
    dimension.value_m = value;
    dimension.fit_error_m = mean_fit_error(segments, fit_.errors);
    dimension.course_kind = kind;
    set_uncertainty(dimension, id, false, fit_.refined);
    dimension.course = std::move(course);
    found_.push_back(std::move(dimension));
  }

  void height(const std::string& id, const char* name, const std::string& side, const Vec3d& top, double low,
              std::initializer_list<std::string> touched, const char* definition) {
    add(id, name, side, top.y() - low, touched, definition, CourseKind::height,
        {top, Vec3d(top.x(), low, top.z())});
  }

  void extent(const std::string& id, const char* name, const std::string& side, const Reach& ends,
              Index along, std::initializer_list<std::string> touched, const char* definition) {
    Vec3d from = (ends.low + ends.high) / 2, to = from;
    from[along] = ends.low[along];
    to[along] = ends.high[along];
    add(id, name, side, to[along] - from[along], touched, definition, CourseKind::extent, {from, to});
  }

  void depth(const std::string& id, const char* name, const std::string& side, const Vec3d& from,
             const Vec3d& to, std::initializer_list<std::string> touched, const char* definition) {
    add(id, name, side, to.z() - from.z(), touched, definition, CourseKind::extent,
        {Vec3d(to.x(), to.y(), from.z()), to});
  }

  void bideltoid_breadth() {
    const double axilla = std::min(place("left_axilla_anterior").y(), place("right_axilla_anterior").y());
    const auto shoulder = [&](const Vec3d& at) { return at.y() > axilla; };
    extent("bideltoid_breadth", "shoulder (bideltoid) breadth", "",
           reach(figure_, {"left_arm", "right_arm", "left_shoulder", "right_shoulder"}, 0, shoulder), 0,
           {"left_arm", "right_arm"},
           "left-right extent of the deltoids above the axillae, upper arms hanging");
  }

  const Figure& figure_;
  const LandmarkSet& landmarks_;
  const FitQuality& fit_;
  std::vector<Dimension> found_;
};

}  // namespace

std::vector<Dimension> measure_seated(const Figure& seated, const LandmarkSet& landmarks,
                                      const FitQuality& fit) {
  return Sitter(seated, landmarks, fit).take();
}

}  // namespace vitruvian
