#pragma once

#include <deque>
#include <string>
#include <utility>

#include "harness/segment/station.hpp"

// Which stations have taken part in a network so far. Figures about a station that never did say nothing:
// a network in which one is absent has not come up, however well the others do.
//
// Contract: a station has taken part when it has driven its line for the first time; a network whose station
// has nothing to drive notes by itself what else counts. What a station reports about itself does not.
namespace fieldproof::network {

class Attendance {
 public:
  class Station final : public segment::Tap {
   public:
    explicit Station(std::string name) : name_(std::move(name)) {}
    void on_wave(const line::Waveform&) override { has_taken_part_ = true; }
    void take_part() { has_taken_part_ = true; }
    bool has_taken_part() const { return has_taken_part_; }
    const std::string& name() const { return name_; }

   private:
    std::string name_;
    bool has_taken_part_ = false;
  };

  // It is waited for this station; taps what it drives. Lives as long as this.
  Station& expect(std::string name) { return stations_.emplace_back(std::move(name)); }
  bool is_complete() const;
  // Names who is absent; empty where nobody is.
  std::string complaint() const;

 private:
  std::deque<Station> stations_;
};

}  // namespace fieldproof::network
