#include "cli/measure_arguments.h"

#include <fast_float/fast_float.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "base/error.h"

namespace vitruvian {
namespace {

[[noreturn]] void fail(const std::string& option, const std::string& text, const std::string& what) {
  throw Error(ErrorCode::usage, option + " " + text + ": " + what + "\nRun: vitruvian help measure");
}

int segment_of(const std::string& option, const std::string& text) {
  const std::string name = text.substr(0, text.find(':'));
  const int segment = segment_named(name);
  if (segment >= 0) return segment;
  std::string names;
  for (const std::string_view known : kSegmentNames) names += " " + std::string(known);
  fail(option, text, "there is no segment \"" + name + "\", only" + names);
}

double number_of(const std::string& option, const std::string& text, std::string_view digits) {
  double value = 0;
  const auto result = fast_float::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (result.ec != std::errc() || result.ptr != digits.data() + digits.size() || !std::isfinite(value)) {
    fail(option, text, "\"" + std::string(digits) + "\" is no number");
  }
  return value;
}

}  // namespace

SectionRequest parse_section(const std::string& text) {
  const std::string option = "--section";
  SectionRequest request;
  request.segment = segment_of(option, text);
  const std::size_t colon = text.find(':');
  std::string_view place =
      colon == std::string::npos ? std::string_view() : std::string_view(text).substr(colon + 1);
  if (place.substr(0, 2) == "t=") {
    request.value = number_of(option, text, place.substr(2));
    if (request.value < 0 || request.value > 1) fail(option, text, "t goes from 0 to 1");
    return request;
  }
  if (place.substr(0, 2) != "d=")
    fail(option, text, "after the segment :t=F, :d=MM or :d=MM@distal is expected");
  request.from = SectionRequest::From::proximal;
  place.remove_prefix(2);
  if (const std::size_t at = place.find('@'); at != std::string_view::npos) {
    const std::string_view end = place.substr(at + 1);
    if (end != "distal" && end != "proximal") fail(option, text, "after @ comes distal or proximal");
    if (end == "distal") request.from = SectionRequest::From::distal;
    place = place.substr(0, at);
  }
  request.value = 1e-3 * number_of(option, text, place);
  if (request.value < 0) fail(option, text, "the distance must not be negative");
  return request;
}

ProfileRequest parse_profile(const std::string& text) {
  const std::string option = "--profile";
  ProfileRequest request;
  request.segment = segment_of(option, text);
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos)
    fail(option, text, "after the segment : and the number of sections are expected");
  const double count = number_of(option, text, std::string_view(text).substr(colon + 1));
  if (count != std::floor(count) || count < 2 || count > 10000) {
    fail(option, text, "the number of sections is a whole number from 2 to 10000");
  }
  request.count = static_cast<int>(count);
  return request;
}

void add_measure_options(CLI::App& command, MeasureArguments& a) {
  command.add_option("REGISTRATION", a.registration_file, "a registration.json")->required()->type_name("");
  command
      .add_option("--out", a.out,
                  "measurements.json and measurements.csv go to DIR (default: the JSON to stdout)")
      ->type_name("DIR");
  command.add_option("--model", a.model_file, "body model that the registration was made with")
      ->type_name("FILE");
  command.add_option("--dmpl", a.dmpl_file, "soft-tissue model that the registration was made with")
      ->type_name("FILE");
  command.add_option("--scan", a.scan_file, "the registered scan")->type_name("FILE");
  command
      .add_option_function<std::vector<std::string>>(
          "--section",
          [&a](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) a.sections.push_back(parse_section(text));
          },
          "a section at a fraction of the segment or at a distance from its proximal or distal joint")
      ->type_name("SEGMENT:t=F|SEGMENT:d=MM[@distal]")
      ->expected(1)
      ->take_all();
  command
      .add_option_function<std::vector<std::string>>(
          "--profile",
          [&a](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) a.profiles.push_back(parse_profile(text));
          },
          "N sections from joint to joint")
      ->type_name("SEGMENT:N")
      ->expected(1)
      ->take_all();
  command
      .add_option(
          "--export", a.exports,
          "more files into DIR, separated by commas: glb (with skeleton), npz (AMASS), smpl, trc (OpenSim), "
          "landmarks (CSV), ply and obj (coloured by segment and error), html (report)")
      ->delimiter(',')
      ->check(CLI::IsMember({"glb", "npz", "smpl", "trc", "landmarks", "ply", "obj", "html"}).description(""))
      ->type_name("FORMAT,...");
}

}  // namespace vitruvian
