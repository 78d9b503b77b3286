#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "protocols/token_bus/dual_channel.hpp"
#include "protocols/token_bus/test_translator.hpp"

// For tests: a dual channel manager with somebody on its three sides.
namespace fieldproof::token_bus {

class TestChannelManager : private segment::Station, private ChannelListener {
 public:
  explicit TestChannelManager(const ChannelManagerConfiguration& configuration = {})
      : TestChannelManager(std::make_unique<ChannelManager>(configuration)) {}
  explicit TestChannelManager(std::unique_ptr<ChannelManagerDevice> manager)
      : manager_(std::move(manager)), seat_(segment_.attach(*manager_, "manager")) {
    for (unsigned n = 0; n < kManagerPorts; ++n) links_.at(n) = &segment_.connect("in", seat_, n, {});
    manager_->wire(mac_, channels_[0], channels_[1], *this);
    set_power(true);
  }

  void set_power(bool is_on) {
    manager_->set_power(is_on, segment_.now());
    segment_.refresh(seat_);
  }
  kernel::Time now() const { return segment_.now(); }
  void wait(std::int64_t symbols) { segment_.run_for(mac_symbols(Rules{}, symbols)); }

  // ---- what comes in; time stays where it is ----
  void request(std::string_view symbols) {
    line::Levels levels;
    for (const MacSymbol symbol : mac_symbols_of(symbols)) append(levels, MacRequest{symbol, {}});
    drive(kTowardsMac, std::move(levels), 0);
  }
  void manage(ManagementCommand command, std::size_t symbols) {
    line::Levels levels;
    for (std::size_t n = 0; n < symbols; ++n) append(levels, MacRequest{.command = command});
    drive(kTowardsMac, std::move(levels), 0);
  }
  // From so many symbols later on.
  void indicate(Channel channel, std::string_view symbols, std::int64_t later = 0) {
    line::Levels levels;
    for (const MacSymbol symbol : mac_symbols_of(symbols)) append(levels, MacIndication{symbol, {}});
    drive(port_of(channel), std::move(levels), later);
  }
  void answer(Channel channel, ManagementAnswer answer, std::size_t symbols) {
    line::Levels levels;
    for (std::size_t n = 0; n < symbols; ++n) append(levels, MacIndication{.answer = answer});
    drive(port_of(channel), std::move(levels), 0);
  }

  // ---- what went out since the last call ----
  std::string take_indicated() { return symbols_in(std::exchange(mac_.waves, {})); }
  std::string take_requested(Channel channel) {
    return symbols_in(std::exchange(channels_.at(static_cast<std::size_t>(channel)).waves, {}));
  }
  kernel::Time first_indicated() const { return mac_.waves.front().start; }
  std::string take_events() { return std::exchange(events_, {}); }
  bool is_in_order() const {
    return mac_.is_in_order && channels_[0].is_in_order && channels_[1].is_in_order;
  }

 private:
  void drive(segment::PortIndex port, line::Levels levels, std::int64_t later) {
    line::Waveform wave{now() + mac_symbols(Rules{}, later), mac_side_rate(Rules{}.phy_bit_rate),
                        std::move(levels)};
    links_.at(port)->drive(wave);
  }
  void on_channel_event(const ChannelEvent& event, kernel::Time) override {
    events_ += std::string(text_of(event.channel)) + " " + std::string(text_of(event.kind)) + "\n";
  }
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }

  segment::Segment segment_;
  std::unique_ptr<ChannelManagerDevice> manager_;
  std::size_t seat_;
  std::array<segment::Link*, kManagerPorts> links_{};
  KeptWaves mac_{segment_};
  std::array<KeptWaves, 2> channels_{KeptWaves{segment_}, KeptWaves{segment_}};
  std::string events_;
};

}  // namespace fieldproof::token_bus
