#pragma once

#include <string>
#include <string_view>

#include "body/model.h"
#include "fit/region_labels.h"
#include "io/scan.h"
#include "pipeline/edits.h"
#include "pipeline/result_json_value.h"

namespace vitruvian {

/// Reads a regions JSON.
/// @throws Error(bad_file) naming the place: no pair, an empty region, an index that is negative or named
/// twice on its side.
RegionSet parse_regions(std::string_view text, const std::string& file_name);
/// The same of a value inside a document.
RegionSet regions_from_json(const JsonValue& value);
nlohmann::ordered_json regions_to_json(const RegionSet& regions);

/// Refuses regions that were painted on another model. @throws Error(usage).
void check_regions(const RegionSet& regions, const BodyModel& model);

/// Labels of a scan's vertices and the model's: pair k has label k + 1, what no region names has 0.
/// @throws Error(usage) when the scan is another one or has fewer vertices than an index says.
RegionLabels region_labels(const RegionSet& regions, const Scan& scan, const BodyModel& model);

}  // namespace vitruvian
