#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/case_bench.hpp"
#include "conformance/running_case.hpp"
#include "conformance/token_bus/judgeable_rules.hpp"
#include "conformance/token_bus/translator_sides.hpp"
#include "harness/field/pics.hpp"
#include "protocols/token_bus/rules.hpp"

// The bench of an implementation whose ports are circuits between two chips: testers at the other end of
// each, so that what goes into a port and what comes out of it are links of their own.
namespace fieldproof::conformance {

// As declared, completed by the reference, and what a case needs otherwise.
template <typename Configuration, typename Needs, typename Setting>
Configuration sides_configuration(const Needs& needs, const Setting& setting,
                                  const field::Table<Configuration>& table) {
  const judge::Pics reference = field::declared_by(table, Configuration{});
  Configuration configuration =
      field::declared_in(table, setting.pics.value_or(judge::Pics{}).completed_by(reference));
  if (needs.adjust != nullptr) needs.adjust(configuration);
  return configuration;
}

// Throws kernel::Error for declared numbers that cannot be judged.
template <typename Case, typename Setting>
void expect_judgeable_sides(const Case&, const Setting& setting, const RunningCase&) {
  token_bus::Rules rules;
  rules.phy_bit_rate = setting.pics.value_or(judge::Pics{}).number("phy_bit_rate", rules.phy_bit_rate);
  expect_whole_half_bits(rules);
}

template <typename Device, typename Configuration>
class SidesBench : public CaseBench, private segment::Station {
 public:
  const Configuration& configuration() const { return configuration_; }
  kernel::Duration symbols(std::int64_t count) const {
    return token_bus::mac_symbols(configuration_.rules, count);
  }
  void set_power(bool is_on) {
    device_->set_power(is_on, now());
    segment().refresh(seat_);
  }
  std::vector<std::uint8_t> random_octets(std::size_t count) {
    std::vector<std::uint8_t> octets;
    while (octets.size() < count) octets.push_back(random_octet());
    return octets;
  }
  void finish() { device_->end(); }

 protected:
  // Nothing that is sent is shorter than a symbol.
  template <typename Setting>
  SidesBench(const Configuration& configuration, const Setting& setting, const std::string& name)
      : CaseBench(setting.seed, setting.volume, setting.stresses,
                  LineWatch(token_bus::mac_symbols(configuration.rules, 1) / 2)),
        configuration_(configuration),
        device_(setting.make_device(configuration)),
        tester_(segment().attach(*this, "tester")),
        seat_(segment().attach(*device_, name)) {}
  ~SidesBench() = default;

  Device& device() { return *device_; }
  segment::Link& into(const std::string& name, segment::PortIndex port) {
    return segment().connect(name, seat_, port, {});
  }
  segment::Link& out_of(const std::string& name, segment::PortIndex port) {
    return segment().connect(name, tester_, port, {});
  }
  // Gives its end.
  kernel::Time drive(segment::Link& link, kernel::Time start, std::int64_t rate, line::Levels levels,
                     std::int64_t parts_per_million = 0) {
    constexpr std::int64_t kMillion = 1'000'000;
    line::Waveform wave{start, rate + rate / kMillion * parts_per_million, std::move(levels)};
    const kernel::Time end = wave.end();
    driven_.push_back({&link, wave});
    link.drive(wave);
    if (driven_.size() > kMostDrivenShown) driven_.pop_front();
    return end;
  }
  // A tester is given what comes out of a port.
  virtual void on_driven(segment::PortIndex /*port*/, const line::Waveform& /*wave*/) {}
  // What was seen last of one side, for a report.
  static std::string shown_end(std::string_view what, const SideLog& log) {
    const std::string& text = log.last_text();
    const std::size_t first = text.size() - std::min(text.size(), kMostUnitsShown);
    return fmt::format("{}: {}{}", what, first > 0 ? "..." : "",
                       text.empty() ? "nothing" : text.substr(first));
  }
  // What testers drove last, as the side of each link reads it, with the rate of its units.
  template <typename SideOf>
  std::vector<std::string> driven_lines(SideOf side_of) const {
    std::vector<std::string> lines;
    for (const Driven& one : driven_) {
      SideLog log = side_of(*one.link);
      log.on_wave(one.wave);
      const std::string& text = log.text();
      lines.push_back(fmt::format("tester drove {} at {}: {}{}", one.link->name(),
                                  kernel::describe(one.wave.start), text.substr(0, kMostUnitsShown),
                                  text.size() > kMostUnitsShown ? "..." : ""));
    }
    return lines;
  }

 private:
  struct Driven {
    const segment::Link* link;
    line::Waveform wave;
  };
  static constexpr std::size_t kMostDrivenShown = 4;
  static constexpr std::size_t kMostUnitsShown = 160;

  void receive(segment::PortIndex port, const line::Waveform& wave) override { on_driven(port, wave); }
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }

  Configuration configuration_;
  std::unique_ptr<Device> device_;
  std::size_t tester_;
  std::size_t seat_;
  std::deque<Driven> driven_;
};

}  // namespace fieldproof::conformance
