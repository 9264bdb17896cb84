#include "base/execution.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace vitruvian {
namespace {

TEST(Execution, RangesCoverEverythingOnceAndDoNotDependOnTiming) {
  for (const int threads : {1, 2, 3, 6}) {
    const Execution execution(threads);
    for (const std::ptrdiff_t count : {0, 1, 2, 5, 97, 1000}) {
      for (const std::ptrdiff_t minimum : {1, 10, 400}) {
        std::set<std::pair<std::ptrdiff_t, std::ptrdiff_t>> first_ranges;
        for (int repeat = 0; repeat < 20; ++repeat) {
          std::vector<std::atomic<int>> visits(static_cast<std::size_t>(count));
          std::mutex mutex;
          std::set<std::pair<std::ptrdiff_t, std::ptrdiff_t>> ranges;
          execution.parallel_for(count, minimum, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
            for (std::ptrdiff_t i = begin; i < end; ++i) ++visits[static_cast<std::size_t>(i)];
            const std::lock_guard<std::mutex> lock(mutex);
            ranges.insert({begin, end});
          });
          for (const auto& visit : visits) ASSERT_EQ(visit.load(), 1);
          EXPECT_LE(ranges.size(), static_cast<std::size_t>(threads));
          if (repeat == 0) first_ranges = ranges;
          EXPECT_EQ(ranges, first_ranges);
        }
      }
    }
  }
}

TEST(Execution, FirstRangeRunsOnTheCallingThread) {
  const Execution execution(3);
  const std::thread::id caller = std::this_thread::get_id();
  execution.parallel_for(3, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t) {
    EXPECT_EQ(begin == 0, std::this_thread::get_id() == caller);
  });
}

TEST(Execution, AnExceptionOfAnyRangeArrivesAndThePoolGoesOn) {
  const Execution execution(4);
  for (std::ptrdiff_t bad = 0; bad < 4; ++bad) {
    std::atomic<int> ended{0};
    try {
      execution.parallel_for(4, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t) {
        if (begin == bad) throw Error(ErrorCode::bad_file, "range " + std::to_string(begin));
        ++ended;
      });
      FAIL() << "no exception";
    } catch (const Error& error) {
      EXPECT_EQ(error.what(), "range " + std::to_string(bad));
    }
    EXPECT_EQ(ended.load(), 3);
  }
}

TEST(Execution, CancelFromAnotherThreadStopsALoopThatChecks) {
  Execution execution(2);
  execution.check();
  std::atomic<bool> running{false};
  std::thread canceller([&] {
    while (!running) std::this_thread::yield();
    execution.cancel();
  });
  try {
    for (;;) {
      running = true;
      execution.check();
    }
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
  canceller.join();
  EXPECT_TRUE(execution.cancelled());
  execution.reset_cancel();
  EXPECT_NO_THROW(execution.check());
}

TEST(Execution, ProgressReachesTheCallback) {
  Execution execution;
  execution.progress("read", 0.5);
  std::vector<std::pair<std::string, double>> reports;
  execution.on_progress(
      [&](std::string_view stage, double fraction) { reports.emplace_back(stage, fraction); });
  execution.progress("read", 0.25);
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0], (std::pair<std::string, double>("read", 0.25)));
}

}  // namespace
}  // namespace vitruvian
