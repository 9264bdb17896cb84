#include "cli/opencv_networks.h"

#include <algorithm>
#include <exception>
#include <fstream>
#include <iterator>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <thread>
#include <vector>

#include "base/error.h"
#include "keypoints/blazepose.h"
#include "keypoints/detector.h"

namespace vitruvian {
namespace {

struct Interface {
  int input_size;  // pixels
  std::vector<cv::String> outputs;
};

Interface interface_of(Network network) {
  if (network == Network::detector) return {kDetectorSize, {"boxes", "scores"}};
  return {kLandmarkCropSize, {"landmarks", "presence", "heatmap"}};
}

std::size_t index_of(Network network) { return network == Network::detector ? 0 : 1; }

std::vector<char> read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file || bytes.empty()) {
    throw Error(ErrorCode::cannot_read,
                path +
                    ": the keypoint network cannot be read. Make it with scripts/start, or "
                    "set VITRUVIAN_DATA to the folder that holds it.");
  }
  return bytes;
}

cv::dnn::Net parse(const std::vector<char>& bytes, Network network, const std::string& path) {
  try {
    cv::dnn::Net net = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
    net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    std::vector<cv::String> found = net.getUnconnectedOutLayersNames(),
                            expected = interface_of(network).outputs;
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    if (found != expected)
      throw Error(ErrorCode::bad_model, path + ": not the expected network: its outputs differ.");
    return net;
  } catch (const cv::Exception& error) {
    throw Error(ErrorCode::bad_model, path + ": not a network that OpenCV can read (" + error.err +
                                          "). Make it again with scripts/models/make_keypoint_networks.py.");
  }
}

NetworkOutputs run_one(cv::dnn::Net& net, Network network, const std::vector<float>& input) {
  const Interface interface = interface_of(network);
  const int shape[] = {1, 3, interface.input_size, interface.input_size};
  // OpenCV takes a non-const pointer but only reads the input.
  const cv::Mat blob(4, shape, CV_32F, const_cast<float*>(input.data()));
  std::vector<cv::Mat> results;
  net.setInput(blob, "image");
  net.forward(results, interface.outputs);
  NetworkOutputs outputs;
  for (const cv::Mat& result : results) {
    const cv::Mat flat = result.isContinuous() ? result : result.clone();
    outputs.emplace_back(flat.ptr<float>(), flat.ptr<float>() + flat.total());
  }
  return outputs;
}

}  // namespace

struct OpenCvNetworks::Loaded {
  std::vector<char> bytes;
  std::vector<cv::dnn::Net> nets;  // one a thread
};

OpenCvNetworks::OpenCvNetworks(std::string landmarks_path, std::string detector_path, int threads)
    : threads_(std::max(1, threads)) {
  paths_[index_of(Network::landmarks)] = std::move(landmarks_path);
  paths_[index_of(Network::detector)] = std::move(detector_path);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
  cv::setNumThreads(1);
}

OpenCvNetworks::~OpenCvNetworks() = default;

NetworkReply OpenCvNetworks::run(const NetworkRequest& request) {
  const std::size_t count = request.inputs.size();
  const int side = interface_of(request.network).input_size;
  for (const std::vector<float>& input : request.inputs) {
    if (input.size() != static_cast<std::size_t>(3 * side * side)) {
      throw Error(ErrorCode::internal, "OpenCvNetworks: an input has " + std::to_string(input.size()) +
                                           " values, expected " + std::to_string(3 * side * side));
    }
  }
  NetworkReply reply;
  if (count == 0) return reply;

  const std::string& path = paths_[index_of(request.network)];
  std::unique_ptr<Loaded>& loaded = loaded_[index_of(request.network)];
  if (!loaded) {
    auto fresh = std::make_unique<Loaded>();
    fresh->bytes = read_file(path);
    loaded = std::move(fresh);
  }
  const std::size_t workers = std::min(static_cast<std::size_t>(threads_), count);
  if (loaded->nets.size() < workers) loaded->nets.resize(workers);

  reply.outputs.resize(count);
  std::vector<std::exception_ptr> failures(workers);
  const auto work = [&](std::size_t worker) {
    try {
      cv::dnn::Net& net = loaded->nets[worker];
      if (net.empty()) net = parse(loaded->bytes, request.network, path);
      for (std::size_t k = worker; k < count; k += workers) {
        reply.outputs[k] = run_one(net, request.network, request.inputs[k]);
      }
    } catch (const cv::Exception& error) {
      failures[worker] = std::make_exception_ptr(
          Error(ErrorCode::internal, path + ": OpenCV failed to run the network (" + error.err + ")"));
    } catch (...) {
      failures[worker] = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t worker = 1; worker < workers; ++worker) threads.emplace_back(work, worker);
  work(0);
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
  validate(request, reply);
  return reply;
}

}  // namespace vitruvian
