#pragma once

#include <cstdlib>
#include <span>

#include "base/error.h"
#include "io/pickle.h"
#include "io/pickle_arrays.h"
#include "smpl/read_model.h"
#include "smpl/vposer.h"

namespace vitruvian::fuzz {

/// Calls something that may only end well or with an error that is not our own fault.
template <typename Reading>
bool only_typed_errors(const Reading& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal) std::abort();
    return false;
  }
}

/// Reads any bytes as a pickle and every named value in it as an array, a sparse matrix and text.
inline bool read_any_pickle(std::span<const std::byte> bytes) {
  return only_typed_errors([&] {
    const PickleFile file(bytes, "fuzz.pkl");
    bool sound = true;
    for (const std::string& key : file.root().keys()) {
      const PickleValue value = *file.root().find(key);
      sound = only_typed_errors([&] { numeric_array(value, key); }) && sound;
      only_typed_errors([&] { sparse_matrix(value, key); });
      only_typed_errors([&] { content_of(value, key); });
    }
    if (!sound) throw Error(ErrorCode::bad_file, "an array is damaged");
  });
}

/// A model that was accepted keeps its promises.
inline void check_model(const BodyModel& model) {
  const int vertices = model.vertex_count(), joints = model.joint_count();
  const bool sound = model.v_template.allFinite() && model.shapedirs.allFinite() &&
                     model.shapedirs.rows() == 3 * vertices && model.faces.minCoeff() >= 0 &&
                     model.faces.maxCoeff() < vertices && model.skin_joint.minCoeff() >= 0 &&
                     model.skin_joint.maxCoeff() < joints && model.skin_weight.allFinite() &&
                     static_cast<int>(model.segment.size()) == vertices &&
                     static_cast<int>(model.corrective_begin.size()) == vertices + 1 &&
                     model.joint_template.allFinite() && model.joint_names.size() == model.parent.size();
  if (!sound) std::abort();
}

/// Reads any bytes as body model, VPoser checkpoint and pickle; true when one of them accepts.
inline bool read_any_model(std::span<const std::byte> bytes) {
  const bool model = only_typed_errors([&] { check_model(read_any_body_model(bytes, "fuzz")); });
  const bool vposer = only_typed_errors([&] { read_vposer(bytes, "fuzz"); });
  const bool pickle = read_any_pickle(bytes);
  const bool zip = bytes.size() > 1 && bytes[0] == std::byte{'P'};
  return model || vposer || (!zip && pickle && bytes.size() < 5000);
}

}  // namespace vitruvian::fuzz
