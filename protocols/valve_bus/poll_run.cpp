#include "protocols/valve_bus/poll_run.hpp"

#include <fmt/format.h>

#include <array>
#include <deque>
#include <optional>

#include "harness/kernel/error.hpp"
#include "harness/segment/medium.hpp"
#include "protocols/valve_bus/host.hpp"
#include "protocols/valve_bus/node.hpp"
#include "protocols/valve_bus/timing.hpp"
#include "protocols/valve_bus/valve_block.hpp"

namespace fieldproof::valve_bus {
namespace {

class PolledBus final : private HostApplication {
 public:
  PolledBus(const Rules& rules, const PollRunSettings& settings)
      : random_(settings.seed),
        line_(segment_, "line", segment::ContentionRule::noise, random_),
        host_({.rules = rules, .dip = settings.dip}),
        host_seat_(segment_.attach(host_, "host")) {
    host_.wire(line_.attach("host/in", host_seat_, 0, {}), *this);
    for (unsigned n = 0; n < settings.nodes; ++n) add_node(rules, settings, n);
    host_.set_power(true, segment_.now());
    segment_.refresh(host_seat_);
  }

  PollRun run(unsigned cycles) {
    while (result_.cycles.size() < cycles) {
      while (host_.fifo_room() >= kCommand) ask_next();
      segment_.refresh(host_seat_);
      if (!segment_.step()) break;
    }
    return std::move(result_);
  }

 private:
  static constexpr std::size_t kCommand = 4;

  struct Seat {
    explicit Seat(const NodeConfiguration& configuration) : node(configuration) {}
    Node node;
    ValveBlock block;
  };

  void add_node(const Rules& rules, const PollRunSettings& settings, unsigned number) {
    const unsigned address = number + 1;
    Rules own = rules;
    own.bit_rate = dip_bit_rates()[settings.dip];
    Seat& seat =
        seats_.emplace_back(NodeConfiguration{.rules = own, .tens = address / 10, .units = address % 10});
    const std::size_t station = segment_.attach(seat.node, fmt::format("node {}", address));
    seat.block.set_input(0, static_cast<std::uint16_t>(random_.below(0x10000)));
    seat.node.wire(line_.attach(fmt::format("node {}/in", address), station, 0,
                                distance_of(rules, number, settings.nodes, settings.length_m)),
                   seat.block);
    seat.node.set_power(true, segment_.now());
    segment_.refresh(station);
  }

  void ask_next() {
    const std::array<std::uint8_t, kCommand> command{static_cast<std::uint8_t>(next_ + 1), 1, 0, 0};
    host_.write(command, segment_.now());
    next_ = (next_ + 1) % static_cast<unsigned>(seats_.size());
  }

  void on_response(const HostResponse& response, kernel::Time when) override {
    ++result_.responses;
    const std::uint16_t switches = seats_[response.id - 1U].block.input(0, when);
    if ((response.data0 | response.data1 << 8) != switches) ++result_.wrong_responses;
    if (response.id != 1) return;
    if (first_) result_.cycles.push_back(when - *first_);
    first_ = when;
  }
  void on_error(const HostError&, kernel::Time) override { ++result_.errors; }

  kernel::Random random_;
  segment::Segment segment_;
  segment::Medium line_;
  Host host_;
  std::size_t host_seat_;
  std::deque<Seat> seats_;  // stations keep their places
  unsigned next_ = 0;
  std::optional<kernel::Time> first_;
  PollRun result_;
};

}  // namespace

PollRun run_polls(const Rules& rules, const PollRunSettings& settings) {
  if (settings.nodes < 1 || settings.nodes > rules.last_address || settings.dip >= dip_bit_rates().size()) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("a bus of {} nodes at position {} of the switches is none; 1 to {} nodes and "
                    "positions 0 to {} are",
                    settings.nodes, settings.dip, rules.last_address, dip_bit_rates().size() - 1));
  }
  return PolledBus(rules, settings).run(settings.cycles);
}

}  // namespace fieldproof::valve_bus
