#include "cli/opencv_networks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.h"
#include "keypoints/blazepose.h"
#include "keypoints/detector.h"
#include "keypoints/view_landmarks.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace vitruvian {
namespace {

const std::string kData = std::string(VITRUVIAN_SOURCE_DIR) + "/tests/data/keypoints/";

std::string model(const std::string& name) {
  const char* folder = std::getenv("VITRUVIAN_DATA");
  return std::string(folder ? folder : VITRUVIAN_MODELS_DIR) + "/" + name;
}

OpenCvNetworks make_networks(int threads) {
  return OpenCvNetworks(model("blazepose_landmarks.opencv.onnx"), model("blazepose_detector.opencv.onnx"),
                        threads);
}

nlohmann::json read_json(const std::string& name) {
  std::ifstream file(kData + name);
  return nlohmann::json::parse(file);
}

struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

Pixels read_png(const std::string& name) {
  Pixels pixels;
  int channels = 0;
  std::uint8_t* data = stbi_load((kData + name).c_str(), &pixels.width, &pixels.height, &channels, 3);
  if (!data) throw std::runtime_error("cannot read " + kData + name);
  pixels.rgb.assign(data, data + 3 * pixels.width * pixels.height);
  stbi_image_free(data);
  return pixels;
}

/// The patterns of scripts/models/keypoints/parity.py.
Pixels make_pattern(const std::string& name, int size) {
  Pixels pixels{size, size, {}};
  for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(size); ++y) {
    for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(size); ++x) {
      for (std::uint32_t c = 0; c < 3; ++c) {
        std::uint32_t value = (x * 73856093u) ^ (y * 19349663u) ^ (c * 83492791u);
        value = (value ^ (value >> 13)) * 0x5BD1E995u;
        value = (value ^ (value >> 15)) & 255u;
        if (name == "blocks") value = (x / 16 + y / 16 + c) % 4 * 85;
        pixels.rgb.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  return pixels;
}

View view_of(const Pixels& pixels) {
  View view{};
  view.camera.width = pixels.width;
  view.camera.height = pixels.height;
  view.rgb = pixels.rgb;
  view.left = pixels.width, view.top = pixels.height;
  for (int row = 0; row < pixels.height; ++row) {
    for (int column = 0; column < pixels.width; ++column) {
      if (pixels.rgb[static_cast<std::size_t>(3 * (row * pixels.width + column))] == 190) continue;
      view.left = std::min(view.left, column), view.right = std::max(view.right, column + 1);
      view.top = std::min(view.top, row), view.bottom = std::max(view.bottom, row + 1);
    }
  }
  return view;
}

/// The fixed inputs that the reference file lists for one network.
NetworkRequest reference_request(Network network, const nlohmann::json& reference,
                                 std::vector<nlohmann::json>& runs) {
  const std::string name = network == Network::detector ? "detector" : "landmarks";
  const int size = network == Network::detector ? kDetectorSize : kLandmarkCropSize;
  NetworkRequest request{network, {}};
  for (const nlohmann::json& run : reference["runs"]) {
    if (run["network"] != name) continue;
    const std::string input = run["input"];
    const View view =
        view_of(input.find(".png") != std::string::npos ? read_png(input) : make_pattern(input, size));
    if (network == Network::detector) {
      request.inputs.push_back(detector_input(view));
    } else {
      const float side = static_cast<float>(size);
      request.inputs.push_back(landmarks_input(view, {{0.5f * side, 0.5f * side}, side, 0.0f}));
    }
    runs.push_back(run);
  }
  return request;
}

double largest_difference(const std::vector<float>& found, const std::vector<float>& expected) {
  EXPECT_EQ(found.size(), expected.size());
  double largest = 0;
  for (std::size_t k = 0; k < std::min(found.size(), expected.size()); ++k) {
    largest = std::max(largest, std::abs(static_cast<double>(found[k]) - expected[k]));
  }
  return largest;
}

TEST(OpenCvNetworks, LandmarksAgreeWithTheTfliteRuntime) {
  const nlohmann::json reference = read_json("networks.json");
  std::vector<nlohmann::json> runs;
  const NetworkRequest request = reference_request(Network::landmarks, reference, runs);
  ASSERT_EQ(runs.size(), 4u);
  OpenCvNetworks networks = make_networks(2);
  const NetworkReply reply = networks.run(request);
  const std::size_t stride = reference["heatmap_stride"];
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const std::string input = runs[k]["input"];
    const NetworkOutputs& outputs = reply.outputs[k];
    std::vector<float> heatmap;
    for (std::size_t v = 0; v < outputs[2].size(); v += stride) heatmap.push_back(outputs[2][v]);
    const double landmarks = largest_difference(outputs[0], runs[k]["landmarks"]);
    const double presence = largest_difference(outputs[1], runs[k]["presence"]);
    const double cells = largest_difference(heatmap, runs[k]["heatmap"]);
    std::cout << input << ": landmarks " << landmarks << ", presence " << presence << ", heatmap " << cells
              << "\n";
    EXPECT_LT(landmarks, 0.01) << input;
    EXPECT_LT(presence, 1e-4) << input;
    EXPECT_LT(cells, 0.005) << input;
  }
}

TEST(OpenCvNetworks, DetectorAgreesWithTheTfliteRuntime) {
  const nlohmann::json reference = read_json("networks.json");
  std::vector<nlohmann::json> runs;
  const NetworkRequest request = reference_request(Network::detector, reference, runs);
  ASSERT_EQ(runs.size(), 3u);
  OpenCvNetworks networks = make_networks(1);
  const NetworkReply reply = networks.run(request);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const std::string input = runs[k]["input"];
    std::vector<float> boxes;
    for (const std::size_t anchor : runs[k]["anchors"]) {
      const auto first = reply.outputs[k][0].begin() + static_cast<std::ptrdiff_t>(12 * anchor);
      boxes.insert(boxes.end(), first, first + 12);
    }
    const double box = largest_difference(boxes, runs[k]["boxes"]);
    const double score = largest_difference(reply.outputs[k][1], runs[k]["scores"]);
    std::cout << input << ": boxes " << box << ", scores " << score << "\n";
    EXPECT_LT(box, 0.01) << input;
    EXPECT_LT(score, 0.005) << input;
  }
}

TEST(OpenCvNetworks, ResultsDoNotDependOnThreads) {
  std::vector<nlohmann::json> runs;
  const NetworkRequest request = reference_request(Network::landmarks, read_json("networks.json"), runs);
  OpenCvNetworks one = make_networks(1), three = make_networks(3);
  const NetworkReply first = one.run(request);
  EXPECT_EQ(first.outputs, three.run(request).outputs);
  EXPECT_EQ(first.outputs, one.run(request).outputs) << "a second run of the same networks";
}

TEST(OpenCvNetworks, FindsTheBodyInARenderedView) {
  const nlohmann::json truth = read_json("view.json");
  const std::map<std::string, int> landmark_of{
      {"left_shoulder", 11}, {"right_shoulder", 12}, {"left_elbow", 13}, {"right_elbow", 14},
      {"left_wrist", 15},    {"right_wrist", 16},    {"left_hip", 23},   {"right_hip", 24},
      {"left_knee", 25},     {"right_knee", 26},     {"left_ankle", 27}, {"right_ankle", 28}};
  const std::vector<View> views{view_of(read_png(truth["image"]))};
  OpenCvNetworks networks = make_networks(1);
  ViewLandmarkDetector detector(views);
  int requests = 0;
  while (const auto request = detector.next_request()) {
    detector.accept(networks.run(*request));
    ++requests;
  }
  EXPECT_EQ(requests, 2);
  const ViewLandmarks& found = detector.result()[0];
  EXPECT_GT(found.body_presence, 0.9f);
  double sum = 0;
  for (const auto& [joint, landmark] : landmark_of) {
    const std::vector<float> pixel = truth["joints_px"][joint];
    const Eigen::Vector2f expected(pixel[0], pixel[1]);
    const double error = (found.landmarks[static_cast<std::size_t>(landmark)].pixel - expected).norm() /
                         truth["height_px"].get<double>();
    sum += error;
    // BlazePose's own points differ from the rig's joints by up to 3 % of the body's height.
    EXPECT_LT(error, 0.06) << joint;
  }
  std::cout << "mean error " << 100 * sum / 12 << " % of the body's height\n";
  EXPECT_LT(sum / 12, 0.03);
}

TEST(OpenCvNetworks, DetectorFindsTheRollOfATurnedView) {
  const View upright = view_of(read_png("view.png"));
  const int size = upright.camera.width;
  ASSERT_EQ(size, upright.camera.height);
  OpenCvNetworks networks = make_networks(2);
  NetworkRequest request{Network::detector, {}};
  std::vector<View> views;
  for (int quarter = 0; quarter < 4; ++quarter) {
    Pixels turned{size, size, std::vector<std::uint8_t>(upright.rgb.size())};
    for (int row = 0; row < size; ++row) {
      for (int column = 0; column < size; ++column) {
        int r = row, c = column;
        for (int k = 0; k < quarter; ++k) {
          const int previous_row = r;
          r = c;  // clockwise: the top goes to the right
          c = size - 1 - previous_row;
        }
        for (int channel = 0; channel < 3; ++channel) {
          turned.rgb[static_cast<std::size_t>(3 * (r * size + c) + channel)] =
              upright.rgb[static_cast<std::size_t>(3 * (row * size + column) + channel)];
        }
      }
    }
    views.push_back(view_of(turned));
    request.inputs.push_back(detector_input(views.back()));
  }
  const NetworkReply reply = networks.run(request);
  for (int quarter = 0; quarter < 4; ++quarter) {
    const auto detection = decode_detection(reply.outputs[static_cast<std::size_t>(quarter)],
                                            views[static_cast<std::size_t>(quarter)]);
    ASSERT_TRUE(detection) << quarter << " quarter turns";
    const double expected = quarter * 1.5707963267948966;
    std::cout << quarter << " quarter turns: score " << detection->score << ", roll " << detection->roll
              << "\n";
    EXPECT_LT(std::abs(std::remainder(detection->roll - expected, 6.283185307179586)), 0.35) << quarter;
  }
}

class OpenCvNetworksErrors : public testing::Test {
 protected:
  static Error error_of(OpenCvNetworks& networks, const NetworkRequest& request) {
    try {
      networks.run(request);
    } catch (const Error& error) {
      return error;
    }
    return Error(ErrorCode::usage, "nothing was thrown");
  }

  const NetworkRequest landmarks_{Network::landmarks, {std::vector<float>(3 * 256 * 256, 0.5f)}};
};

TEST_F(OpenCvNetworksErrors, MissingFile) {
  OpenCvNetworks networks("/no/such/landmarks.onnx", model("blazepose_detector.opencv.onnx"), 1);
  const Error error = error_of(networks, landmarks_);
  EXPECT_EQ(error.code(), ErrorCode::cannot_read);
  EXPECT_NE(std::string(error.what()).find("/no/such/landmarks.onnx"), std::string::npos);
  // The other network is not touched by it.
  const NetworkRequest detector{Network::detector, {std::vector<float>(3 * 224 * 224, 0.5f)}};
  EXPECT_EQ(networks.run(detector).outputs.size(), 1u);
}

TEST_F(OpenCvNetworksErrors, DamagedOrWrongFile) {
  const std::string path = testing::TempDir() + "vitruvian_opencv_networks_test.onnx";
  std::ifstream whole(model("blazepose_landmarks.opencv.onnx"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(whole), std::istreambuf_iterator<char>()};
  ASSERT_GT(bytes.size(), 1000000u);
  for (const std::string& damaged :
       {std::string("not a network"), bytes.substr(0, 300000), std::string(5000, '\xff')}) {
    std::ofstream(path, std::ios::binary) << damaged;
    OpenCvNetworks networks(path, path, 2);
    EXPECT_EQ(error_of(networks, landmarks_).code(), ErrorCode::bad_model) << damaged.size() << " bytes";
  }
  std::remove(path.c_str());

  OpenCvNetworks exchanged(model("blazepose_detector.opencv.onnx"), model("blazepose_landmarks.opencv.onnx"),
                           1);
  EXPECT_EQ(error_of(exchanged, landmarks_).code(), ErrorCode::bad_model);
}

TEST_F(OpenCvNetworksErrors, WrongInputSize) {
  OpenCvNetworks networks = make_networks(1);
  NetworkRequest request = landmarks_;
  request.inputs.push_back(std::vector<float>(3 * 224 * 224));
  EXPECT_EQ(error_of(networks, request).code(), ErrorCode::internal);
  EXPECT_TRUE(networks.run({Network::landmarks, {}}).outputs.empty());
}

}  // namespace
}  // namespace vitruvian
