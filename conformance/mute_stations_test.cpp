// Subject: each case alone, with a station that drives nothing, or that holds its driver on. None passes,
// whatever it is about: silence counts for who drives when it is asked, and on a shared line the driver is
// off outside of what is sent.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
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
#include "harness/kernel/sanitized.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/attached_isa_device.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"
#include "protocols/fieldbus_dll/ff_station.hpp"
#include "protocols/fieldbus_dll/isa_dle.hpp"
#include "protocols/fieldbus_dll/isa_las.hpp"
#include "protocols/interbus/attached_master.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/slave.hpp"
#include "protocols/token_bus/attached_dual_channel.hpp"
#include "protocols/token_bus/attached_station.hpp"
#include "protocols/token_bus/attached_translator.hpp"
#include "protocols/token_bus/dual_channel.hpp"
#include "protocols/token_bus/token_station.hpp"
#include "protocols/token_bus/translator.hpp"
#include "protocols/valve_bus/attached_host.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/host.hpp"
#include "protocols/valve_bus/node.hpp"

namespace fieldproof::conformance {
namespace {

constexpr const char* kMuted = "muted";
constexpr const char* kDead = "dead";
constexpr const char* kHeld = "held";

// A station that does all but drive its line; or one that works, and holds its driver on for a while before
// anybody sends.
class MutedDevice final : public iut::Device, private iut::Bench {
 public:
  MutedDevice(std::unique_ptr<iut::Device> device, bool holds_driver)
      : device_(std::move(device)),
        is_mute_(!holds_driver),
        held_at_(holds_driver ? kernel::kStart : kernel::kNever) {}

  iut::UnitKind unit_kind() const override { return device_->unit_kind(); }
  iut::Capabilities capabilities() const override { return device_->capabilities(); }
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
  void on_time(kernel::Time now) override {
    if (held_at_ <= now) hold_driver(now);
    if (device_->next_time() <= now) device_->on_time(now);
  }
  kernel::Time next_time() const override { return std::min(device_->next_time(), held_at_); }
  void end() override { device_->end(); }

 private:
  void hold_driver(kernel::Time now) {
    line::Waveform idle{now, kHeldRate, {}};
    idle.levels.append_idle(kHeldLevels);
    bench_->transmit(0, idle);
    held_at_ = kernel::kNever;
  }
  // What its user gets goes this way.
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> octets) override {
    bench_->send(port, start, octets);
  }
  void transmit(unsigned port, line::Waveform& wave) override {
    if (!is_mute_) bench_->transmit(port, wave);
  }
  void write(iut::Item item, std::uint64_t value, kernel::Time when) override {
    bench_->write(item, value, when);
  }
  std::uint64_t read(iut::Item item, kernel::Time when) override { return bench_->read(item, when); }

  static constexpr std::int64_t kHeldRate = 1'000;
  static constexpr std::size_t kHeldLevels = 300;  // longer than an answer at the lowest bit rate may take

  std::unique_ptr<iut::Device> device_;
  bool is_mute_;
  kernel::Time held_at_;
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

SuiteGiven given_mute(MakeServed make) {
  SuiteGiven given;
  given.attach = [=](const iut::RoleName&, const IutRequest& request) -> std::optional<iut::Attachment> {
    std::shared_ptr<iut::Device> device;
    if (request.uri == kDead) device = std::make_shared<DeadDevice>();
    if (request.uri == kHeld) device = std::make_shared<MutedDevice>(make(), true);
    if (request.uri == kMuted) device = std::make_shared<MutedDevice>(make(), false);
    if (device == nullptr) return std::nullopt;
    return iut::Attachment{device.get(), device, {}};
  };
  return given;
}

// The cases of a role that pass, without the names of protocol and role.
std::set<std::string> passed_by(const std::string& uri, const Suite& suite, const std::string& role) {
  std::set<std::string> passed;
  const std::string prefix = std::string(suite.protocol()) + "/" + role + "/";
  for (kernel::FewerIfSanitized few(4); const TestCase& one : suite.cases()) {
    if (!one.id.starts_with(prefix) || few.leaves_out()) continue;
    Setup setup;
    setup.volume = Volume::quick;
    setup.implementations.push_back({role, 0, uri});
    if (suite.run(one, setup).result.verdict == judge::Verdict::pass)
      passed.insert(one.id.substr(prefix.size()));
  }
  return passed;
}

// All roles of all protocols.
class MuteStations : public testing::Test {
 protected:
  template <typename Kind, typename Reference>
  static void expect_no_pass(std::unique_ptr<Suite> (*suite_of)(SuiteGiven), const std::string& uri) {
    const auto suite = suite_of(given_mute(served_reference<Kind, Reference>));
    EXPECT_EQ(passed_by(uri, *suite, Kind::role), std::set<std::string>{}) << Kind::role;
  }
  static void expect_no_pass_on_a_shared_line(const std::string& uri) {
    expect_no_pass<valve_bus::NodeRole, valve_bus::Node>(valve_bus_suite, uri);
    expect_no_pass<valve_bus::HostRole, valve_bus::Host>(valve_bus_suite, uri);
    expect_no_pass<fieldbus_dll::FfDeviceRole, fieldbus_dll::FfStation>(fieldbus_dll_suite, uri);
    expect_no_pass<fieldbus_dll::FfLasRole, fieldbus_dll::FfLas>(fieldbus_dll_suite, uri);
    expect_no_pass<fieldbus_dll::IsaDleRole, fieldbus_dll::IsaDle>(fieldbus_dll_suite, uri);
    expect_no_pass<fieldbus_dll::IsaLasRole, fieldbus_dll::IsaLas>(fieldbus_dll_suite, uri);
    expect_no_pass<token_bus::StationRole, token_bus::TokenStation>(token_bus_suite, uri);
    expect_no_pass<token_bus::TranslatorRole, token_bus::Translator>(token_bus_suite, uri);
    expect_no_pass<token_bus::ChannelManagerRole, token_bus::ChannelManager>(token_bus_suite, uri);
  }
  static void expect_no_pass_in_a_ring(const std::string& uri) {
    expect_no_pass<interbus::SlaveRole, interbus::Slave>(interbus_suite, uri);
    expect_no_pass<interbus::MasterRole, interbus::Master>(interbus_suite, uri);
  }
};

TEST_F(MuteStations, ThatDoNothingPassNoCase) {
  expect_no_pass_on_a_shared_line(kDead);
  expect_no_pass_in_a_ring(kDead);
}

TEST_F(MuteStations, ThatDoAllButDrivePassNoCase) {
  expect_no_pass_on_a_shared_line(kMuted);
  expect_no_pass_in_a_ring(kMuted);
}

TEST_F(MuteStations, NodesThatHoldTheirDriverOnPassNoCase) {
  expect_no_pass<valve_bus::NodeRole, valve_bus::Node>(valve_bus_suite, kHeld);
}

}  // namespace
}  // namespace fieldproof::conformance
