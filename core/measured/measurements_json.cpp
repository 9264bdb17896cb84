#include "measured/measurements_json.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "pipeline/result_json_value.h"

namespace vitruvian {
namespace {

using nlohmann::ordered_json;

/// By Posture: the body that was measured.
constexpr std::array<const char*, 3> kFigureNames = {"standing", "scanned", "sitting"};

/// Six significant digits below the unit's fourth decimal are noise; what is not finite becomes null.
double rounded(double value, double steps_per_unit) {
  return std::round(value * steps_per_unit) / steps_per_unit;
}

double millimetres(double metres) { return rounded(1e3 * metres, 1e3); }
double square_centimetres(double square_metres) { return rounded(1e4 * square_metres, 1e4); }
double cubic_centimetres(double cubic_metres) { return rounded(1e6 * cubic_metres, 1e4); }

ordered_json row_of(const Vec3d& v) { return {rounded(v[0], 1e7), rounded(v[1], 1e7), rounded(v[2], 1e7)}; }

ordered_json rows_of(const Mat3d& m) {
  ordered_json result = ordered_json::array();
  for (int r = 0; r < 3; ++r) {
    ordered_json row = ordered_json::array();
    for (int c = 0; c < 3; ++c) row.push_back(rounded(m(r, c), 1e9));
    result.push_back(std::move(row));
  }
  return result;
}

ordered_json segment_json(const BodyMeasures& body, int s) {
  const auto i = static_cast<std::size_t>(s);
  const SegmentMeasure& m = body.segments[i];
  const double uniform = kUniformDensity / segment_density(s);
  ordered_json row;
  row["segment"] = kSegmentNames[i];
  row["length_mm"] = millimetres(m.length_m);
  row["volume_closed_cm3"] = cubic_centimetres(m.volume_m3);
  row["volume_hull_cm3"] = cubic_centimetres(body.published[i].volume_m3);
  if (!body.published[i].reason.empty()) row["volume_hull_reason"] = body.published[i].reason;
  row["area_cm2"] = square_centimetres(m.area_m2);
  row["mass_kg"] = rounded(m.mass_kg, 1e6);
  row["com_m"] = row_of(m.com_m);
  row["inertia_kgm2"] = rows_of(m.inertia_kgm2);
  row["density_kgm3"] = segment_density(s);
  row["mass_uniform_kg"] = rounded(uniform * m.mass_kg, 1e6);
  row["inertia_uniform_kgm2"] = rows_of(uniform * m.inertia_kgm2);
  return row;
}

ordered_json dimension_json(const Dimension& dimension) {
  ordered_json row;
  row["id"] = dimension.id;
  row["name"] = dimension.name;
  row["standard"] = dimension.standard;
  row["definition"] = dimension.definition;
  row["side"] = dimension.side;
  row["value_mm"] = millimetres(dimension.value_m);
  row["uncertainty_mm"] =
      dimension.uncertainty_m ? ordered_json(millimetres(*dimension.uncertainty_m)) : ordered_json();
  row["uncertainty_source"] = !dimension.uncertainty_m            ? ordered_json()
                              : dimension.uncertainty_is_measured ? ordered_json("measured")
                                                                  : ordered_json("estimated");
  row["fit_error_mm"] =
      dimension.fit_error_m ? ordered_json(millimetres(*dimension.fit_error_m)) : ordered_json();
  row["posture"] = dimension.posture == Posture::scanned ? "scanned" : "standard";
  row["figure"] = kFigureNames[static_cast<std::size_t>(dimension.posture)];
  return row;
}

ordered_json landmark_json(const LandmarkReport& landmark) {
  ordered_json row;
  row["name"] = landmark.name;
  row["body_m"] = row_of(landmark.body_m);
  row["scan"] = {landmark.scan[0], landmark.scan[1], landmark.scan[2]};
  row["confidence"] = landmark.confidence ? ordered_json(rounded(*landmark.confidence, 1e4)) : ordered_json();
  return row;
}

ordered_json section_json(const SectionResult& section) {
  ordered_json row;
  row["segment"] = kSegmentNames[static_cast<std::size_t>(section.segment)];
  row["t"] = rounded(section.t, 1e6);
  const SectionMeasure* m = section.measured ? &*section.measured : nullptr;
  const auto value = [&](double SectionMeasure::*member, auto convert) {
    return m ? ordered_json(convert(m->*member)) : ordered_json();
  };
  row["area_cm2"] = value(&SectionMeasure::area, square_centimetres);
  row["area_hull_cm2"] = square_centimetres(section.published_area_m2);
  row["perimeter_mm"] = value(&SectionMeasure::perimeter, millimetres);
  row["perimeter_hull_mm"] = value(&SectionMeasure::hull_perimeter, millimetres);
  row["breadth_mm"] = value(&SectionMeasure::breadth, millimetres);
  row["depth_mm"] = value(&SectionMeasure::depth, millimetres);
  return row;
}

std::string number(double value, int decimals) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

/// "left_upper_leg" -> {"upper_leg", "left"}.
std::pair<std::string, std::string> split_side(std::string_view segment) {
  for (const std::string_view side : {"left", "right"}) {
    if (segment.substr(0, side.size()) == side) {
      return {std::string(segment.substr(side.size() + 1)), std::string(side)};
    }
  }
  return {std::string(segment), ""};
}

std::string spaced(std::string text) {
  for (char& c : text) {
    if (c == '_') c = ' ';
  }
  return text;
}

std::string quoted(const std::string& text) {
  return text.find(',') == std::string::npos ? text : '"' + text + '"';
}

/// One row; no text holds a quote.
void add_csv(std::string& out, const std::string& id, const std::string& name, const std::string& standard,
             const std::string& side, const std::string& value, const std::string& unit,
             const std::string& uncertainty = "") {
  out += id + "," + quoted(name) + "," + quoted(standard) + "," + side + "," + value + "," + unit + "," +
         uncertainty + "\n";
}

}  // namespace

double landmark_confidence(double observed, double mean_error_m) {
  return observed / (1 + mean_error_m / 0.010);
}

std::string measurements_json(const MeasurementReport& report, JsonStyle style) {
  ordered_json document;
  document["registration_sha256"] = report.registration_sha256;
  document["body"] = {{"volume_cm3", cubic_centimetres(report.body.volume_m3)},
                      {"area_cm2", square_centimetres(report.body.area_m2)},
                      {"mass_kg", rounded(report.body.mass_kg, 1e6)},
                      {"mass_uniform_kg", rounded(kUniformDensity * report.body.volume_m3, 1e6)}};
  document["segments"] = ordered_json::array();
  for (int s = 0; s < kSegmentCount; ++s) document["segments"].push_back(segment_json(report.body, s));
  document["dimensions"] = ordered_json::array();
  for (const Dimension& dimension : report.dimensions)
    document["dimensions"].push_back(dimension_json(dimension));
  document["landmarks"] = ordered_json::array();
  for (const LandmarkReport& landmark : report.landmarks)
    document["landmarks"].push_back(landmark_json(landmark));
  document["sections"] = ordered_json::array();
  for (const SectionResult& section : report.sections) document["sections"].push_back(section_json(section));
  return json_text(document, style);
}

std::string measurements_csv(const MeasurementReport& report) {
  std::string out = "id,name,standard,side,value,unit,uncertainty\n";
  for (const Dimension& d : report.dimensions) {
    const bool scanned = d.posture == Posture::scanned;
    add_csv(out, d.id + (scanned ? "_as_scanned" : ""), d.name + (scanned ? " (as scanned)" : ""), d.standard,
            d.side, number(1e3 * d.value_m, 2), "mm",
            d.uncertainty_m ? number(1e3 * *d.uncertainty_m, 2) : "");
  }
  add_csv(out, "body_volume", "body volume", "", "", number(1e6 * report.body.volume_m3, 1), "cm3");
  add_csv(out, "body_area", "body surface area", "", "", number(1e4 * report.body.area_m2, 1), "cm2");
  add_csv(out, "body_mass", "body mass with segment densities", "", "", number(report.body.mass_kg, 3), "kg");
  for (int s = 0; s < kSegmentCount; ++s) {
    const auto i = static_cast<std::size_t>(s);
    const auto [segment, side] = split_side(kSegmentNames[i]);
    const SegmentMeasure& m = report.body.segments[i];
    const std::string id = std::string(kSegmentNames[i]) + "_segment", name = spaced(segment) + " segment";
    add_csv(out, id + "_length", name + " length", "", side, number(1e3 * m.length_m, 2), "mm");
    add_csv(out, id + "_volume", name + " volume", "", side, number(1e6 * m.volume_m3, 2), "cm3");
    add_csv(out, id + "_volume_hull", name + " hull volume", "", side,
            number(1e6 * report.body.published[i].volume_m3, 2), "cm3");
    add_csv(out, id + "_area", name + " surface area", "", side, number(1e4 * m.area_m2, 2), "cm2");
    add_csv(out, id + "_mass", name + " mass", "", side, number(m.mass_kg, 4), "kg");
  }
  return out;
}

}  // namespace vitruvian
