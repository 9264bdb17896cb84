#include "keypoints/network.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "base/error.h"

namespace vitruvian {
namespace {

NetworkReply reply_of_zeros(Network network, std::size_t runs) {
  NetworkOutputs outputs;
  for (const std::size_t size : output_sizes(network)) outputs.emplace_back(size, 0.0f);
  return {std::vector<NetworkOutputs>(runs, outputs)};
}

TEST(Network, OutputSizesAreThoseOfTheHeader) {
  EXPECT_EQ(output_sizes(Network::detector), (std::vector<std::size_t>{27048, 2254}));
  EXPECT_EQ(output_sizes(Network::landmarks), (std::vector<std::size_t>{195, 1, 159744}));
}

TEST(Network, ValidateAcceptsWhatFits) {
  for (const Network network : {Network::detector, Network::landmarks}) {
    for (const std::size_t runs : {0u, 1u, 3u}) {
      const NetworkRequest request{network, std::vector<std::vector<float>>(runs)};
      EXPECT_NO_THROW(validate(request, reply_of_zeros(network, runs)));
    }
  }
}

TEST(Network, ValidateNamesWhatIsWrong) {
  const NetworkRequest request{Network::landmarks, std::vector<std::vector<float>>(2)};
  const auto message_of = [&](const NetworkReply& reply) -> std::string {
    try {
      validate(request, reply);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::internal);
      return error.what();
    }
    return "accepted";
  };
  NetworkReply reply = reply_of_zeros(Network::landmarks, 1);
  EXPECT_NE(message_of(reply).find("2 images asked, 1 answered"), std::string::npos);

  reply = reply_of_zeros(Network::landmarks, 2);
  reply.outputs[1].pop_back();
  EXPECT_NE(message_of(reply).find("image 1: expected 3 outputs, found 2"), std::string::npos);

  reply = reply_of_zeros(Network::landmarks, 2);
  reply.outputs[0][2].push_back(0);
  EXPECT_NE(message_of(reply).find("image 0, output 2: expected 159744 values, found 159745"),
            std::string::npos);

  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    reply = reply_of_zeros(Network::landmarks, 2);
    reply.outputs[1][0][194] = bad;
    EXPECT_NE(message_of(reply).find("image 1, output 0: a value is not finite"), std::string::npos);
  }
}

}  // namespace
}  // namespace vitruvian
