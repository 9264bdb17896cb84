#pragma once

#include <cstddef>
#include <vector>

namespace vitruvian {

/// The two BlazePose networks (models/README.md). Their inputs and outputs are plain float tensors so that
/// any runtime can run them: OpenCV DNN natively, onnxruntime-web in the page.
enum class Network {
  detector,   ///< input `image` 1x3x224x224, RGB in [-1, 1]; outputs `boxes` 1x2254x12, `scores` 1x2254x1
              ///< (logits)
  landmarks,  ///< input `image` 1x3x256x256, RGB in [0, 1]; outputs `landmarks` 1x195, `presence` 1x1,
              ///< `heatmap` 1x39x64x64
};

/// Runs of one network that can go in one batch (each input is one image; the networks have batch size 1).
struct NetworkRequest {
  Network network;
  std::vector<std::vector<float>> inputs;  ///< each 3 x S x S, channel-major
};

/// Outputs of one run in the order of Network's comment.
using NetworkOutputs = std::vector<std::vector<float>>;

/// Outputs of each input of a request, in its order.
struct NetworkReply {
  std::vector<NetworkOutputs> outputs;
};

/// Number of floats that each output of a network must have.
std::vector<std::size_t> output_sizes(Network network);

/// Checks a reply against its request. @throws Error(internal) when a size is wrong or a value is not finite.
void validate(const NetworkRequest& request, const NetworkReply& reply);

}  // namespace vitruvian
