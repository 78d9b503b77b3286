#include "harness/network/polled_bus.hpp"

#include <gtest/gtest.h>

#include <array>

#include "harness/line/octet_line.hpp"
#include "harness/network/quiet_run.hpp"

namespace fieldproof::network {
namespace {

constexpr std::int64_t kRate = 19'200;
constexpr kernel::Duration kSlot = 10 * kernel::kMillisecond;

// Answers its number with its value, an octet, after 1 ms.
class Answerer final : public segment::Station {
 public:
  explicit Answerer(std::uint8_t number) : number_(number) {}
  void wire(segment::Port& line, std::function<std::uint16_t(kernel::Time)> value) {
    line_ = &line;
    value_ = std::move(value);
  }
  void receive(segment::PortIndex, const line::Waveform& wave) override {
    if (uart_.octets_in(wave) != std::vector<std::uint8_t>{number_}) return;
    next_ = wave.end() + kernel::kMillisecond;
  }
  void on_time(kernel::Time now) override {
    if (now < next_) return;
    next_ = kernel::kNever;
    if (is_mute) return;
    line::Waveform wave = uart_.wave_of(std::array{static_cast<std::uint8_t>(value_(now))}, now);
    line_->drive(wave);
  }
  kernel::Time next_time() const override { return next_; }

  bool is_mute = false;

 private:
  std::uint8_t number_;
  line::OctetLine uart_{kRate};
  segment::Port* line_ = nullptr;
  std::function<std::uint16_t(kernel::Time)> value_;
  kernel::Time next_ = kernel::kNever;
};

class Bus final : public PolledBus {
 public:
  Bus() : PolledBus({.name = "two answerers", .bit_rate = kRate, .slot = kSlot, .bits = 8}, 1) {
    for (std::size_t n = 0; n < answerers.size(); ++n) {
      segment::Port& line = add("answerer@" + std::to_string(n + 1), answerers[n]);
      answerers[n].wire(line, [this, n](kernel::Time now) { return source(n, now); });
    }
  }

  std::array<Answerer, 2> answerers{Answerer(1), Answerer(2)};

 private:
  line::Waveform request(std::size_t n, kernel::Time now) override {
    return uart_.wave_of(std::array{static_cast<std::uint8_t>(n + 1)}, now);
  }
  std::optional<std::uint16_t> word_in(std::size_t, const line::Waveform& answer) override {
    const auto octets = uart_.octets_in(answer);
    return octets && octets->size() == 1 ? std::optional<std::uint16_t>(octets->front()) : std::nullopt;
  }

  line::OctetLine uart_{kRate};
};

TEST(PolledBus, EachWordArrivesAndEachCycleLastsItsSlots) {
  Bus bus;
  const QuietRun run = run_quietly(bus, 20, 1);
  ASSERT_TRUE(run.came_up);
  ASSERT_EQ(run.cycles.size(), 20U);
  for (const kernel::Duration cycle : run.cycles) EXPECT_EQ(cycle, 2 * kSlot);
  EXPECT_GE(run.counts.sent, 38U);
  EXPECT_EQ(run.counts.detected, 0U);
  EXPECT_EQ(run.counts.accepted_wrong(), 0U);
}

class Outcomes final : public ExchangeWatcher {
 public:
  void on_exchange(const Exchange& exchange) override {
    ++(exchange.outcome == Outcome::served ? served : missing).at(exchange.first_signal);
  }
  void on_shown(std::size_t, std::uint16_t, kernel::Time) override {}
  void on_cycle_begin(std::size_t, kernel::Time) override {}

  std::array<int, 2> served{};
  std::array<int, 2> missing{};
};

TEST(PolledBus, DoesNotComeUpWithoutAResponder) {
  Bus bus;
  bus.answerers[1].is_mute = true;
  EXPECT_FALSE(run_quietly(bus, 5, 1).came_up);
  EXPECT_NE(bus.complaint().find("answerer@2 did not"), std::string::npos) << bus.complaint();
}

TEST(PolledBus, AResponderThatIsMuteIsMissedAndOneThatIsNotKeepsItRunning) {
  Bus bus;
  Outcomes outcomes;
  bus.watch(outcomes);
  bus.start();
  bus.segment().run_for(2 * kSlot);
  bus.answerers[1].is_mute = true;
  bus.segment().run_for(20 * kSlot);
  EXPECT_EQ(outcomes.served, (std::array{11, 1}));
  EXPECT_EQ(outcomes.missing, (std::array{0, 10}));
  EXPECT_EQ(bus.state(), State::exchanging);
  bus.answerers[0].is_mute = true;
  bus.segment().run_for(5 * kSlot);
  EXPECT_EQ(bus.state(), State::stopped);
  bus.start();
  EXPECT_EQ(bus.state(), State::coming_up);
  bus.answerers[0].is_mute = false;
  bus.segment().run_for(3 * kSlot);
  // What the other did before this start says nothing about it now.
  EXPECT_EQ(bus.state(), State::coming_up);
  bus.answerers[1].is_mute = false;
  bus.segment().run_for(2 * kSlot);
  EXPECT_EQ(bus.state(), State::exchanging);
}

}  // namespace
}  // namespace fieldproof::network
