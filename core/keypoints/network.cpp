#include "keypoints/network.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace vitruvian {

std::vector<std::size_t> output_sizes(Network network) {
  if (network == Network::detector) return {2254 * 12, 2254};
  return {195, 1, 39 * 64 * 64};
}

void validate(const NetworkRequest& request, const NetworkReply& reply) {
  const std::string name = request.network == Network::detector ? "detector network" : "landmark network";
  if (reply.outputs.size() != request.inputs.size()) {
    throw Error(ErrorCode::internal, name + ": " + std::to_string(request.inputs.size()) + " images asked, " +
                                         std::to_string(reply.outputs.size()) + " answered");
  }
  const std::vector<std::size_t> sizes = output_sizes(request.network);
  for (std::size_t run = 0; run < reply.outputs.size(); ++run) {
    const NetworkOutputs& outputs = reply.outputs[run];
    const std::string place = name + ", image " + std::to_string(run);
    if (outputs.size() != sizes.size()) {
      throw Error(ErrorCode::internal, place + ": expected " + std::to_string(sizes.size()) +
                                           " outputs, found " + std::to_string(outputs.size()));
    }
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      if (outputs[k].size() != sizes[k]) {
        throw Error(ErrorCode::internal, place + ", output " + std::to_string(k) + ": expected " +
                                             std::to_string(sizes[k]) + " values, found " +
                                             std::to_string(outputs[k].size()));
      }
      if (!std::all_of(outputs[k].begin(), outputs[k].end(), [](float v) { return std::isfinite(v); })) {
        throw Error(ErrorCode::internal, place + ", output " + std::to_string(k) + ": a value is not finite");
      }
    }
  }
}

}  // namespace vitruvian
