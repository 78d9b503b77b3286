#include "harness/segment/stop.hpp"

#include <gtest/gtest.h>

#include "harness/segment/segment.hpp"

namespace fieldproof::segment {
namespace {

// Wants to be called every microsecond, for ever.
class Ticking final : public Station {
 public:
  void receive(PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time now) override {
    ++calls;
    next_ = now + kernel::kMicrosecond;
  }
  kernel::Time next_time() const override { return next_; }

  std::uint64_t calls = 0;

 private:
  kernel::Time next_ = kernel::kStart;
};

struct Ticker {
  Ticker() { segment.attach(ticking, "ticking"); }
  Ticking ticking;
  Segment segment;
};

TEST(StopScope, EndsWhatRunsInASegmentSoon) {
  std::stop_source source;
  Ticker run;
  const StopScope scope(source.get_token());
  run.segment.run_for(10 * kernel::kMillisecond);
  EXPECT_GE(run.ticking.calls, 10'000U) << "no stop is requested";
  source.request_stop();
  const std::uint64_t before = run.ticking.calls;
  EXPECT_THROW(run.segment.run_for(3600 * kernel::kSecond), Interrupted);
  EXPECT_LT(run.ticking.calls, before + 5'000);
}

TEST(StopScope, IsOverWithItsScope) {
  std::stop_source source;
  source.request_stop();
  {
    const StopScope scope(source.get_token());
  }
  Ticker run;
  EXPECT_NO_THROW(run.segment.run_for(10 * kernel::kMillisecond));
}

}  // namespace
}  // namespace fieldproof::segment
