#pragma once

#include <functional>
#include <string>
#include <vector>

#include "protocols/token_bus/mac_symbol.hpp"
#include "protocols/token_bus/token_station.hpp"

// A station of a running ring as the MAC of a tester: the reference of a station, whose line is the symbols
// that it requests and that it is indicated.
namespace fieldproof::conformance {

class MacPlayer final : public segment::Station, private segment::Port, private token_bus::StationUser {
 public:
  // Symbols go out from an instant on.
  using Request = std::function<void(const token_bus::MacSymbols& symbols, kernel::Time start)>;

  MacPlayer(const token_bus::StationConfiguration& configuration, Request request);

  // Forgets what it knew; begins outside of a ring.
  void start_anew(kernel::Time now);
  // Levels of the MAC side, when they begin.
  void indicate(const line::Waveform& wave);

  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

 private:
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void drive(line::Waveform& wave) override;
  void on_data(const token_bus::Frame&, kernel::Time) override {}
  void on_event(const token_bus::Event&, kernel::Time) override {}
  kernel::Time heard_at() const;
  void hear(kernel::Time now);

  token_bus::Rules rules_;
  token_bus::TokenStation station_;
  Request request_;
  token_bus::MacSymbols indicated_;  // of a transmission that is not over
  kernel::Time begin_{};
  kernel::Time end_{};
};

}  // namespace fieldproof::conformance
