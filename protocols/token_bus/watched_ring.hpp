#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "harness/kernel/random.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/token_bus/ring_recovery.hpp"
#include "protocols/token_bus/token_station.hpp"

// The ring of the recovery experiment: reference stations along a cable whose states are looked at whenever
// they have been called, and a tester on the line that disturbs it.
namespace fieldproof::token_bus {

class WatchedRing;

// Tells the ring whenever it has been called: its state may be another one.
class WatchedStation final : public TokenStation, public StationUser {
 public:
  WatchedStation(WatchedRing& ring, std::size_t number, const StationConfiguration& configuration,
                 bool drops_tokens)
      : TokenStation(configuration), ring_(ring), number_(number), drops_tokens_(drops_tokens) {}

  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_activity(segment::PortIndex port, bool begins, kernel::Time now) override;
  void on_time(kernel::Time now) override;
  void on_token_taken(kernel::Time now) override;
  bool drops_token_on(const Frame&) const override { return drops_tokens_; }
  void on_data(const Frame& frame, kernel::Time when) override;
  void on_event(const Event&, kernel::Time) override {}

  bool is_member() const { return is_on && is_wanted; }

  bool is_on = false;
  bool is_wanted = true;  // in the ring
  bool has_had_token = false;
  std::uint32_t sent = 0;
  std::uint32_t received = 0;  // the number of the last datum

 private:
  WatchedRing& ring_;
  std::size_t number_;
  bool drops_tokens_;
};

class WatchedRing final : private segment::Station, private segment::Tap {
 public:
  explicit WatchedRing(const RecoverySettings& settings)
      : rules_(settings.rules),
        reader_(rules_),
        random_(settings.seed),
        line_(segment_, "line", segment::ContentionRule::noise, random_) {
    line_.tap_driven(*this);
    tester_number_ = segment_.attach(*this, "tester");
    tester_ = &line_.attach("tester/in", tester_number_, 0, {});
    for (unsigned n = 0; n < settings.stations; ++n) add(n, settings);
  }

  // Until it is whole; kNever: not within `limit`.
  kernel::Time run_until_whole(kernel::Duration limit);
  // What is looked for is done since then.
  kernel::Time watched_since() const { return watched_since_; }
  void run_for(kernel::Duration duration) { segment_.run_for(duration); }
  kernel::Time now() const { return segment_.now(); }
  kernel::Random& random() { return random_; }
  std::size_t size() const { return stations_.size(); }
  Address address(std::size_t n) const { return 2 * Address{n % stations_.size()} + 2; }

  void set_power(std::size_t n, bool is_on);
  void set_wanted(std::size_t n, bool is_wanted);
  void destroy_next_token() { destroys_token_ = true; }
  void give_second_token(Address to) { second_token_to_ = to; }
  bool is_done() const { return !destroys_token_ && !second_token_to_ && pulses_ == 0; }
  // 75 pulses at 100 kHz, of one half bit each.
  void begin_burst();
  void begin_watch();

  void on_station(kernel::Time now);
  void on_datum(std::size_t at, const Frame& frame);
  void submit_next(std::size_t n, kernel::Time now);

  RecoveryFigures figures;

 private:
  void add(unsigned n, const RecoverySettings& settings);
  bool is_whole() const;
  void drive_at(kernel::Time when, unsigned pulses);
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override { return wakes_at_; }
  void on_wave(const line::Waveform& wave) override;

  Rules rules_;
  FrameReader reader_;
  kernel::Random random_;
  segment::Segment segment_;
  segment::Medium line_;
  std::size_t tester_number_ = 0;
  segment::MediumPort* tester_ = nullptr;
  std::deque<WatchedStation> stations_;
  std::vector<std::size_t> seats_;
  bool destroys_token_ = false;
  std::optional<Address> second_token_to_{};
  unsigned pulses_ = 0;
  line::Waveform due_{};  // what the tester drives next
  kernel::Time wakes_at_ = kernel::kNever;
  std::optional<kernel::Time> double_since_{};
  kernel::Time whole_at_ = kernel::kNever;
  kernel::Time watched_since_ = kernel::kStart;
};

}  // namespace fieldproof::token_bus
