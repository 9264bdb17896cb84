#pragma once

#include <array>
#include <memory>
#include <string>

#include "keypoints/network.h"

namespace vitruvian {

/// Runs the keypoint networks with OpenCV's DNN module on the CPU.
///
/// A network is loaded when it is first asked for, once for each thread that runs it. Results do not depend
/// on the number of threads. Not for use from two threads at once. Silences OpenCV's log and error output and
/// sets OpenCV's own thread count to 1, for the whole process.
class OpenCvNetworks {
 public:
  /// @param landmarks_path  blazepose_landmarks.opencv.onnx
  /// @param detector_path   blazepose_detector.opencv.onnx
  /// @param threads         threads that share a request's images, at least 1 (lower values count as 1)
  OpenCvNetworks(std::string landmarks_path, std::string detector_path, int threads);
  ~OpenCvNetworks();
  OpenCvNetworks(const OpenCvNetworks&) = delete;
  OpenCvNetworks& operator=(const OpenCvNetworks&) = delete;

  /// Outputs of each of the request's images.
  /// @throws Error(cannot_read) when the network's file cannot be read, Error(bad_model) when it is not the
  /// expected
  ///         network, Error(internal) when an input has the wrong size or the network fails on it.
  NetworkReply run(const NetworkRequest& request);

 private:
  struct Loaded;

  std::array<std::string, 2> paths_;  // indexed by Network
  std::array<std::unique_ptr<Loaded>, 2> loaded_;
  int threads_;
};

}  // namespace vitruvian
