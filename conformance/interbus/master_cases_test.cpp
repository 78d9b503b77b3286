// What is the master suite's own; that references pass and mutants are caught is tested with all suites.
#include "conformance/interbus/master_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/whole_cases.hpp"
#include "protocols/interbus/master.hpp"

namespace fieldproof::conformance {
namespace {

std::string told(const judge::CaseResult& result) {
  std::string text = result.id + ": " + std::string(judge::name(result.verdict)) + " " + result.reason;
  for (const judge::Finding& finding : result.findings) {
    for (const std::string& expected : finding.expected) text += "\n  expected " + expected;
    text += "\n  actual " + finding.actual;
    for (const std::string& line : finding.decode) text += "\n    " + line;
  }
  return text;
}

TEST(MasterSuite, names_every_purpose_and_every_mutant) {
  std::set<std::string> purposes;
  std::set<std::string> ids;
  for (const MasterCase& c : master_cases()) {
    purposes.insert(c.test_case.purpose);
    EXPECT_TRUE(ids.insert(c.test_case.id).second) << c.test_case.id;
  }
  for (int n = 1; n <= 40; ++n) {
    EXPECT_TRUE(purposes.contains(n < 10 ? "IM-0" + std::to_string(n) : "IM-" + std::to_string(n))) << n;
  }
  std::set<std::string> mutants;
  for (const Mutant& mutant : master_mutants().mutants()) mutants.insert(mutant.label);
  for (int n = 1; n <= 22; ++n) EXPECT_TRUE(mutants.contains("MM" + std::to_string(n))) << n;
}

// ---- masters that do what they may do in another way than the reference ----

template <typename Right>
MasterBench::MakeMaster make() {
  return [](const interbus::MasterConfiguration& configuration) {
    return std::make_unique<Right>(configuration);
  };
}

struct RefusesShortRequest final : interbus::Master {
  using Master::Master;
  bool is_refused() const {
    const kernel::Duration asked = configuration().cycle_time;
    return asked > kernel::Duration::zero() && asked < Master::status().cycle_time;
  }
  interbus::MasterStatus status() const override {
    interbus::MasterStatus status = Master::status();
    if (!is_refused()) return status;
    status.state = interbus::MasterState::bus_stop;
    status.configuration_error = "the requested cycle time is shorter than the shortest possible";
    return status;
  }
  kernel::Time next_time() const override { return is_refused() ? kernel::kNever : Master::next_time(); }
};

// Goes on with status telegrams by a line of its own when the reference is silent.
struct StatusAfterStop final : interbus::Master {
  using Master::Master;
  void wire(segment::Port& out) override {
    out_ = &out;
    Master::wire(out);
  }
  void stop(kernel::Time now) override {
    Master::stop(now);
    is_stopping_ = true;
  }
  void start(kernel::Time now) override {
    is_stopping_ = false;
    Master::start(now);
  }
  bool is_idle() const { return is_stopping_ && Master::status().state == interbus::MasterState::off; }
  kernel::Time next_time() const override { return is_idle() ? next_ : Master::next_time(); }
  void on_time(kernel::Time now) override {
    if (!is_idle()) {
      next_ = now + kernel::kMillisecond;
      return Master::on_time(now);
    }
    line::Waveform wave;
    wave.start = now;
    wave.rate = rules().bit_rate;
    line::shared_telegram_code(rules().telegram).append(wave.levels, 0, 0);
    out_->drive(wave);
    next_ = now + kernel::kMillisecond;
  }

 private:
  segment::Port* out_ = nullptr;
  bool is_stopping_ = false;
  kernel::Time next_{};
};

// Takes 5 us more in every cycle than the formula says.
struct SlightlySlow final : interbus::Master {
  using Master::Master;
  kernel::Duration shortest_cycle_time() const override {
    return Master::shortest_cycle_time() + 5 * kernel::kMicrosecond;
  }
};

struct TakesUncertainCodes final : interbus::Master {
  using Master::Master;
  std::optional<unsigned> words_of(std::uint16_t id_code) const override {
    const unsigned code = (id_code >> 8) & 0x1FU;
    return (code >= 0x08 && code <= 0x0D) || code == 0x10 ? 1 : Master::words_of(id_code);
  }
};

const MasterCase& master_case_of(std::string_view id) {
  const auto found =
      std::ranges::find(master_cases(), id, [](const MasterCase& c) { return c.test_case.id; });
  EXPECT_NE(found, master_cases().end()) << id;
  return *found;
}

constexpr std::string_view kRequest = "interbus/master/timing/request_below_the_minimum_is_clipped";
constexpr std::string_view kStop = "interbus/master/supervision/stop_clears_outputs_and_restart_identifies";
constexpr std::string_view kCut = "interbus/master/ring_change/cut_ring_is_located";

judge::CaseResult run_master_case(std::string_view id, MasterBench::MakeMaster make_master,
                                  std::string_view item = "", std::string_view answer = "",
                                  Volume volume = Volume::quick) {
  judge::Pics pics;
  if (!item.empty()) pics.declare(std::string(item), std::string(answer));
  return run_whole(master_case_of(id),
                   {.make_device = std::move(make_master), .volume = volume, .pics = std::move(pics)});
}

TEST(MasterSuite, RightMastersThatDifferFromTheReferencePass) {
  const auto expect_pass = [](const judge::CaseResult& result) {
    EXPECT_EQ(result.verdict, judge::Verdict::pass) << told(result);
  };
  expect_pass(run_master_case(kRequest, make<RefusesShortRequest>()));
  expect_pass(run_master_case(kStop, make<StatusAfterStop>()));
  expect_pass(run_master_case("interbus/master/timing/cycle_time_equals_the_formula", make<SlightlySlow>()));
  expect_pass(run_master_case("interbus/master/identification/length_codes_are_decoded",
                              make<TakesUncertainCodes>(), "", "", Volume::full));
}

TEST(MasterSuite, WhatIsDeclaredIsRequired) {
  EXPECT_EQ(run_master_case(kRequest, make<RefusesShortRequest>(), "request_below_minimum", "refused").reason,
            "");
  EXPECT_EQ(run_master_case(kRequest, make<RefusesShortRequest>(), "request_below_minimum", "clipped").reason,
            "request_not_clipped");
  EXPECT_EQ(run_master_case(kRequest, make<interbus::Master>(), "request_below_minimum", "clipped").reason,
            "");
  EXPECT_EQ(run_master_case(kRequest, make<interbus::Master>(), "request_below_minimum", "refused").reason,
            "request_not_refused");
  EXPECT_EQ(run_master_case(kStop, make<StatusAfterStop>(), "line_after_stop", "status_telegrams").reason,
            "");
  EXPECT_EQ(run_master_case(kStop, make<StatusAfterStop>(), "line_after_stop", "silent").reason,
            "not_silent");
  EXPECT_EQ(run_master_case(kStop, make<interbus::Master>(), "line_after_stop", "silent").reason, "");
  EXPECT_EQ(run_master_case(kStop, make<interbus::Master>(), "line_after_stop", "status_telegrams").reason,
            "not_silent");
  EXPECT_EQ(run_master_case(kCut, make<interbus::Master>(), "outputs_after_bus_stop", "zero").reason, "");
  EXPECT_EQ(run_master_case(kCut, make<interbus::Master>(), "outputs_after_bus_stop", "held").reason,
            "outputs_not_safe");
}

// Drives its tenth wave 20 us before it is asked.
struct DrivesEarly final : interbus::Master, private segment::Port {
  using Master::Master;
  void wire(segment::Port& out) override {
    out_ = &out;
    Master::wire(*this);
  }
  void drive(line::Waveform& wave) override {
    if (++waves_ == 10) wave.start -= 20 * kernel::kMicrosecond;
    out_->drive(wave);
  }
  segment::Port* out_ = nullptr;
  int waves_ = 0;
};

// Whatever it reports, nobody else is blamed for it, and nobody waits for it.
template <std::int64_t Seconds>
struct ReportsAnyCycleTime final : interbus::Master {
  using Master::Master;
  interbus::MasterStatus status() const override {
    interbus::MasterStatus status = Master::status();
    status.cycle_time = Seconds * kernel::kSecond;
    return status;
  }
};

TEST(MasterSuite, ACycleTimeThatCannotBeIsAFailureOfTheMaster) {
  constexpr std::string_view kOrder =
      "interbus/master/identification/order_within_an_id_cycle_is_met_by_the_next";
  for (const MasterBench::MakeMaster& make_master :
       {MasterBench::MakeMaster(make<ReportsAnyCycleTime<0>>()),
        MasterBench::MakeMaster(make<ReportsAnyCycleTime<3'600>>())}) {
    EXPECT_NE(run_master_case(kOrder, make_master).verdict, judge::Verdict::error);
    const judge::CaseResult compared =
        run_master_case("interbus/master/compared/each_value_of_each_word", make_master);
    EXPECT_EQ(compared.reason, "cycle_time_wrong") << told(compared);
  }
}

TEST(MasterSuite, AMasterThatDrivesInThePastFailsItsCase) {
  const judge::CaseResult result = run_master_case(kStop, make<DrivesEarly>());
  EXPECT_EQ(result.verdict, judge::Verdict::fail);
  EXPECT_EQ(result.reason, "implementation_misbehaves");
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_NE(result.findings[0].actual.find("ring/in"), std::string::npos) << result.findings[0].actual;
}

}  // namespace
}  // namespace fieldproof::conformance
