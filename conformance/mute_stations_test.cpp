// Subject: cases with a station that drives nothing. Who does all but drive its line passes a case about what
// it receives, or about silence, alone; who does nothing at all, a case about silence alone. Whatever else
// passes waits for nothing, and says nothing about a station that talks.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>

#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/suite.hpp"
#include "conformance/suite_given.hpp"
#include "conformance/token_bus/suite.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/attached_isa_device.hpp"
#include "protocols/fieldbus_dll/ff_station.hpp"
#include "protocols/fieldbus_dll/isa_dle.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/interbus/slave.hpp"
#include "protocols/token_bus/attached_station.hpp"
#include "protocols/token_bus/attached_translator.hpp"
#include "protocols/token_bus/token_station.hpp"
#include "protocols/token_bus/translator.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/node.hpp"

namespace fieldproof::conformance {
namespace {

constexpr const char* kMuted = "muted";
constexpr const char* kDead = "dead";

// A station whose levels do not come to the line, once it has driven so many transmissions.
class MutedDevice final : public iut::Device, private iut::Bench {
 public:
  MutedDevice(std::unique_ptr<iut::Device> device, unsigned driven_before)
      : device_(std::move(device)), left_(driven_before) {}

  iut::UnitKind unit_kind() const override { return device_->unit_kind(); }
  bool begin(const iut::CaseBegin& begin, iut::Bench& bench) override {
    bench_ = &bench;
    return device_->begin(begin, *this);
  }
  void set_power(bool is_on, kernel::Time now) override { device_->set_power(is_on, now); }
  void receive(unsigned port, std::span<const iut::Character> characters, kernel::Time now) override {
    device_->receive(port, characters, now);
  }
  void receive(unsigned port, const line::Waveform& reception) override { device_->receive(port, reception); }
  void on_activity(unsigned port, bool begins, kernel::Time now) override {
    device_->on_activity(port, begins, now);
  }
  void on_time(kernel::Time now) override { device_->on_time(now); }
  kernel::Time next_time() const override { return device_->next_time(); }
  void end() override { device_->end(); }

 private:
  // What its user gets goes this way.
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> octets) override {
    bench_->send(port, start, octets);
  }
  void transmit(unsigned port, line::Waveform& wave) override {
    if (left_ == 0) return;
    --left_;
    bench_->transmit(port, wave);
  }
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override {
    bench_->write(item, value, when);
  }
  std::uint64_t read(iut::Item item, kernel::Time when) override { return bench_->read(item, when); }

  std::unique_ptr<iut::Device> device_;
  unsigned left_;
  iut::Bench* bench_ = nullptr;
};

template <typename Kind, typename Reference>
std::unique_ptr<iut::Device> served_reference() {
  return std::make_unique<typename Kind::Served>([](const typename Kind::Configuration& configuration) {
    return std::make_unique<Reference>(configuration);
  });
}

// Does nothing at all.
class DeadDevice final : public iut::Device {
 public:
  iut::UnitKind unit_kind() const override { return iut::UnitKind::levels; }
  bool begin(const iut::CaseBegin&, iut::Bench&) override { return true; }
  void set_power(bool, kernel::Time) override {}
  void receive(unsigned, std::span<const iut::Character>, kernel::Time) override {}
  void receive(unsigned, const line::Waveform&) override {}
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }
  void end() override {}
};

using MakeServed = std::unique_ptr<iut::Device> (*)();

SuiteGiven given_mute(MakeServed make, unsigned driven_before) {
  SuiteGiven given;
  given.attach = [=](const iut::RoleName&, const IutRequest& request) -> std::optional<iut::Attachment> {
    std::shared_ptr<iut::Device> device;
    if (request.uri == kDead) device = std::make_shared<DeadDevice>();
    if (request.uri == kMuted) device = std::make_shared<MutedDevice>(make(), driven_before);
    if (device == nullptr) return std::nullopt;
    return iut::Attachment{device.get(), device, {}};
  };
  return given;
}

// The cases of a role that pass, without the names of protocol and role.
std::set<std::string> passed_by(const std::string& uri, const Suite& suite, const std::string& role) {
  std::set<std::string> passed;
  const std::string prefix = std::string(suite.protocol()) + "/" + role + "/";
  for (const TestCase& one : suite.cases()) {
    if (!one.id.starts_with(prefix)) continue;
    Setup setup;
    setup.volume = Volume::quick;
    setup.implementations.push_back({role, 0, uri});
    if (suite.run(one, setup).result.verdict == judge::Verdict::pass)
      passed.insert(one.id.substr(prefix.size()));
  }
  return passed;
}

// Why a case passes, by its name.
using Reasons = std::map<std::string, std::string>;

std::set<std::string> cases_in(const std::vector<Reasons>& all) {
  std::set<std::string> names;
  for (const Reasons& some : all) {
    for (const auto& [name, reason] : some) names.insert(name);
  }
  return names;
}

struct Passing {
  Reasons are_about_silence;
  Reasons are_about_reception;
};

void expect_all_fail_but(const Suite& suite, const std::string& role, const Passing& passing) {
  EXPECT_EQ(passed_by(kMuted, suite, role),
            cases_in({passing.are_about_silence, passing.are_about_reception}));
  EXPECT_EQ(passed_by(kDead, suite, role), cases_in({passing.are_about_silence}));
}

TEST(MuteStations, OfTheFoundationFieldbusPassNothing) {
  // The one that is activated answers a probe before.
  for (const unsigned driven_before : {0U, 1U}) {
    const auto suite = fieldbus_dll_suite(
        given_mute(served_reference<fieldbus_dll::FfDeviceRole, fieldbus_dll::FfStation>, driven_before));
    expect_all_fail_but(
        *suite, "ff_device",
        {.are_about_silence = {},
         .are_about_reception = {{"probe/impossible_rules_are_refused",
                                  "it reports that it refuses the settings of its link, and is silent"}}});
  }
}

TEST(MuteStations, OfTheIsaLinkPassWhatIsAboutReception) {
  const auto suite =
      fieldbus_dll_suite(given_mute(served_reference<fieldbus_dll::IsaDleRole, fieldbus_dll::IsaDle>, 0));
  const std::string delivered = "each DU has to come to its user";
  expect_all_fail_but(*suite, "isa_dle",
                      {.are_about_silence = {},
                       .are_about_reception = {{"data/is_delivered_to_whom_it_is_for", delivered},
                                               {"line/jitter_is_taken", delivered},
                                               {"line/other_clocks_are_taken", delivered}}});
}

// Whatever is judged of a station is judged of one that has driven something before.
TEST(MuteStations, OfTheTokenBusPassNothing) {
  const auto suite =
      token_bus_suite(given_mute(served_reference<token_bus::StationRole, token_bus::TokenStation>, 0));
  expect_all_fail_but(*suite, "station", {.are_about_silence = {}, .are_about_reception = {}});
}

TEST(MuteStations, OfTheTranslatorPassNothing) {
  const auto suite =
      token_bus_suite(given_mute(served_reference<token_bus::TranslatorRole, token_bus::Translator>, 0));
  expect_all_fail_but(*suite, "translator", {.are_about_silence = {}, .are_about_reception = {}});
}

TEST(MuteStations, OfTheValveBusPassWhatIsAboutWrites) {
  const auto suite = valve_bus_suite(given_mute(served_reference<valve_bus::NodeRole, valve_bus::Node>, 0));
  const std::string moved = "each write has to move its valves, and is not answered";
  expect_all_fail_but(
      *suite, "node",
      {.are_about_silence = {{"address/switches_00_never_answer", "a node without an address is silent"}},
       .are_about_reception = {{"framing/own_frame_behind_a_response_is_taken", moved},
                               {"line/ninth_bit_is_not_looked_at", moved},
                               {"write/drives_the_valves", moved},
                               {"write/every_value_is_driven_at_once", moved},
                               {"write/repeated_write_does_not_glitch", moved}}});
}

TEST(MuteStations, OfTheRingPassWhatIsAboutOutputs) {
  const auto suite = interbus_suite(given_mute(served_reference<interbus::SlaveRole, interbus::Slave>, 0));
  const std::string latched = "the words of a valid cycle have to come to the outputs";
  expect_all_fail_but(
      *suite, "slave",
      {.are_about_silence = {{"power_up/is_silent_and_safe", "nothing is sent to it, and it sends nothing"}},
       .are_about_reception = {{"data_cycle/outputs_change_after_the_check_phase", latched},
                               {"supervision/another_silence_limit_counts", latched},
                               {"supervision/silence_of_26_ms_clears_outputs", latched}}});
}

}  // namespace
}  // namespace fieldproof::conformance
