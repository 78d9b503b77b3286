// Subject: a bench of the data link ends each of its cases, whatever the station does.
#include "conformance/fieldbus_dll/link_bench.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "conformance/fieldbus_dll/suite.hpp"
#include "harness/kernel/sanitized.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/attached_isa_device.hpp"
#include "protocols/fieldbus_dll/line_end.hpp"

namespace fieldproof::conformance {
namespace {

// How a station never stops: a DLPDU after the other one, with so much silence between.
struct Babble {
  Octets octets;
  std::int64_t silence_octets;
};

// Hears nothing and takes every order.
template <typename Device>
class Babbler : public Device {
 public:
  Babbler(const fieldbus_dll::LinkRules& rules, Babble babble)
      : rules_(rules), babble_(std::move(babble)), line_(rules) {}

  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time now) override { next_ = line_.transmit(babble_.octets, now) + silence(); }
  kernel::Time next_time() const override { return next_; }
  void stop(kernel::Time) override { next_ = kernel::kNever; }

 protected:
  fieldbus_dll::LineEnd& line() { return line_; }

 private:
  kernel::Duration silence() const { return fieldbus_dll::octets(rules_, babble_.silence_octets); }

  fieldbus_dll::LinkRules rules_;
  Babble babble_;
  fieldbus_dll::LineEnd line_;
  kernel::Time next_ = kernel::kStart;
};

class FfBabbler final : public Babbler<fieldbus_dll::FfDevice> {
 public:
  using Babbler::Babbler;
  void wire(segment::Port& place, fieldbus_dll::FfUser&) override { line().wire(place); }
  bool start(kernel::Time) override { return true; }
  bool submit(const fieldbus_dll::FfRequest&, kernel::Time) override { return true; }
  bool write(fieldbus_dll::FfAddress, const Octets&, kernel::Time) override { return true; }
};

class IsaBabbler final : public Babbler<fieldbus_dll::IsaDevice> {
 public:
  using Babbler::Babbler;
  void wire(segment::Port& place, fieldbus_dll::IsaUser&) override { line().wire(place); }
  bool start(kernel::Time) override { return true; }
  bool submit(const fieldbus_dll::IsaRequest&, kernel::Time) override { return true; }
};

template <typename Station, typename Device, typename Configuration>
MakeOwn<Device, Configuration> babbling(const Babble& babble) {
  return [babble](const IutRequest&, const Configuration& configuration) {
    return std::make_unique<Station>(configuration.rules.link, babble);
  };
}

// A sequence of commands may hold an hour of silence.
constexpr kernel::Duration kLongest = 7'200 * kernel::kSecond;

class StationsThatNeverStop : public testing::TestWithParam<Babble> {};

TEST_P(StationsThatNeverStop, FailEveryCase) {
  const auto ff = babbling<FfBabbler, fieldbus_dll::FfDevice, fieldbus_dll::FfConfiguration>(GetParam());
  const auto isa = babbling<IsaBabbler, fieldbus_dll::IsaDevice, fieldbus_dll::IsaConfiguration>(GetParam());
  const auto suite = fieldbus_dll_suite({.own = OwnStations()
                                                    .add<fieldbus_dll::IsaDleRole>(isa)
                                                    .add<fieldbus_dll::IsaLasRole>(isa)
                                                    .add<fieldbus_dll::FfDeviceRole>(ff)
                                                    .add<fieldbus_dll::FfLasRole>(ff)});
  conformance::Setup setup;
  setup.volume = Volume::quick;
  const std::vector<TestCase>& cases = suite->cases();
  for (std::size_t n = 0; n < cases.size(); n += kernel::kIsSanitized ? 5 : 1) {
    const TestCase& test_case = cases[n];
    setup.implementations = {{test_case.role(), 0, "own"}};
    const judge::CaseResult result = suite->run(test_case, setup).result;
    // Who babbles keeps the line active.
    const bool may_pass = test_case.id.ends_with("/the_line_is_kept_active");
    // Only one that probes its link has one to leave.
    const bool has_nothing_to_leave = test_case.id.find("/ff_las/claim/a_second_") != std::string::npos &&
                                      result.verdict == judge::Verdict::inconclusive;
    EXPECT_TRUE(may_pass || has_nothing_to_leave || result.verdict == judge::Verdict::fail) << test_case.id;
    EXPECT_LT(result.virtual_time, kLongest) << test_case.id;
  }
}

// Nothing at all, a return of a token, a token for everybody, and what passes for data.
INSTANTIATE_TEST_SUITE_P(Babble, StationsThatNeverStop,
                         testing::Values(Babble{{0x34}, 0}, Babble{{0x34}, 8},
                                         Babble{{0x33, 0x22, 0x01, 0x00}, 8},
                                         Babble{{0xD3, 0x22, 0x30, 0x21, 0x01, 0x01}, 8}),
                         [](const auto& one) { return std::to_string(one.index); });

}  // namespace
}  // namespace fieldproof::conformance
