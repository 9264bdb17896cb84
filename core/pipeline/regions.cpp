#include "pipeline/regions.h"

#include <algorithm>
#include <limits>
#include <set>

#include "base/error.h"

namespace vitruvian {
namespace {

using nlohmann::ordered_json;

std::vector<int> read_indices(const JsonValue& value, std::set<int>& used) {
  std::vector<int> indices;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const JsonValue entry = value.at(i);
    const int index = static_cast<int>(entry.whole(0, std::numeric_limits<std::int32_t>::max()));
    if (!used.insert(index).second) {
      entry.fail("vertex " + std::to_string(index) +
                 " was named before: a vertex belongs to one region only");
    }
    indices.push_back(index);
  }
  if (indices.empty()) value.fail("the region is empty; paint some vertices or leave the pair out");
  return indices;
}

int largest(const RegionSet& regions, std::vector<int> RegionSet::Pair::*side) {
  int result = -1;
  for (const RegionSet::Pair& pair : regions.pairs)
    result = std::max(result, *std::max_element((pair.*side).begin(), (pair.*side).end()));
  return result;
}

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorCode::usage, "--regions: " + what); }

}  // namespace

RegionSet parse_regions(std::string_view text, const std::string& file_name) {
  const nlohmann::json json = parse_json(text, file_name);
  return regions_from_json(JsonValue(json, file_name, ""));
}

RegionSet regions_from_json(const JsonValue& value) {
  RegionSet regions;
  regions.scan_sha256 = value.at("scan_sha256").text();
  regions.model_sha256 = value.at("model_sha256").text();
  const JsonValue pairs = value.at("pairs");
  std::set<int> used_of_scan, used_of_template;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const JsonValue pair = pairs.at(i);
    regions.pairs.push_back({pair.at("name").text(), read_indices(pair.at("scan_vertices"), used_of_scan),
                             read_indices(pair.at("template_vertices"), used_of_template)});
  }
  if (regions.pairs.empty()) pairs.fail("there is no pair of regions");
  return regions;
}

ordered_json regions_to_json(const RegionSet& regions) {
  ordered_json result;
  result["scan_sha256"] = regions.scan_sha256;
  result["model_sha256"] = regions.model_sha256;
  result["pairs"] = ordered_json::array();
  for (const RegionSet::Pair& pair : regions.pairs) {
    ordered_json row;
    row["name"] = pair.name;
    row["scan_vertices"] = pair.scan_vertices;
    row["template_vertices"] = pair.template_vertices;
    result["pairs"].push_back(std::move(row));
  }
  return result;
}

void check_regions(const RegionSet& regions, const BodyModel& model) {
  if (regions.model_sha256 != model.sha256) {
    refuse("they were painted on another model than " + model.name +
           " (model_sha256 differs); give that model with --model, or paint them anew");
  }
  if (const int index = largest(regions, &RegionSet::Pair::template_vertices);
      index >= model.vertex_count()) {
    refuse("template vertex " + std::to_string(index) + " does not exist: the model has " +
           std::to_string(model.vertex_count()) + " vertices");
  }
}

RegionLabels region_labels(const RegionSet& regions, const Scan& scan, const BodyModel& model) {
  check_regions(regions, model);
  if (regions.scan_sha256 != scan.sha256) {
    refuse("they were painted on another scan than " + scan.file_name +
           " (scan_sha256 differs); register that scan alone, or paint them anew");
  }
  if (const int index = largest(regions, &RegionSet::Pair::scan_vertices); index >= scan.vertices.cols()) {
    refuse("scan vertex " + std::to_string(index) + " does not exist: " + scan.file_name + " has " +
           std::to_string(scan.vertices.cols()) + " vertices");
  }
  RegionLabels labels{static_cast<int>(regions.pairs.size()) + 1,
                      std::vector<int>(static_cast<std::size_t>(scan.vertices.cols()), 0),
                      std::vector<int>(static_cast<std::size_t>(model.vertex_count()), 0)};
  for (std::size_t k = 0; k < regions.pairs.size(); ++k) {
    const int label = static_cast<int>(k) + 1;
    for (const int i : regions.pairs[k].scan_vertices) labels.scan[static_cast<std::size_t>(i)] = label;
    for (const int v : regions.pairs[k].template_vertices)
      labels.vertices[static_cast<std::size_t>(v)] = label;
  }
  return labels;
}

}  // namespace vitruvian
