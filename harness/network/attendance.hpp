#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "harness/kernel/time.hpp"
#include "harness/segment/station.hpp"

// Which stations have taken part in a network so far. Figures about a station that never did say nothing:
// a network in which one is absent has not come up, however well the others do.
//
// Contract: a station has taken part when it has driven its line since `begin`; a network whose station
// has nothing to drive notes by itself what else counts. What a station reports about itself does not. Who
// has taken part, and then nothing for longer than the network can leave it alone, is gone.
namespace fieldproof::network {

class Attendance {
 public:
  class Station final : public segment::Tap {
   public:
    Station(std::string name, std::string why_silent)
        : name_(std::move(name)), why_silent_(std::move(why_silent)) {}
    void on_wave(const line::Waveform& wave) override { take_part(wave.start); }
    void take_part(kernel::Time when) { last_ = when; }
    bool has_taken_part() const { return last_.has_value(); }

   private:
    friend class Attendance;

    std::string name_;
    std::string why_silent_;
    std::optional<kernel::Time> last_{};
  };

  // It is waited for this station; taps what it drives. Lives as long as this. Where nothing in this network
  // calls for it, `why_silent` says so: it is right to be silent, and still nothing is known of it.
  Station& expect(std::string name, std::string why_silent = {}) {
    return stations_.emplace_back(std::move(name), std::move(why_silent));
  }
  // The network is powered up again: who has taken part before has to do so again.
  void begin();
  bool is_complete() const;
  // Nobody has done nothing for so long.
  bool is_lasting(kernel::Time now, kernel::Duration longest_absence) const;
  // Names who is absent, or gone; empty where nobody is.
  std::string complaint() const;
  std::string complaint_about_gone(kernel::Time now, kernel::Duration longest_absence) const;

 private:
  static bool is_gone(const Station& station, kernel::Time now, kernel::Duration longest_absence) {
    return station.last_ && now - *station.last_ > longest_absence;
  }

  std::deque<Station> stations_;
};

}  // namespace fieldproof::network
