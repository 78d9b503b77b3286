#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "harness/iut/device.hpp"

// An implementation for tests of those who attach one: it keeps what it is told, and does what the test wants
// when a time has come.
namespace fieldproof::iut {

class ActingDevice final : public Device {
 public:
  using Act = std::function<void(Bench&)>;

  struct Heard {
    unsigned port;
    Character character;
    kernel::Time now;
  };
  struct HeardLevels {
    unsigned port;
    line::Waveform wave;
  };

  explicit ActingDevice(UnitKind unit) : unit_(unit) {}

  UnitKind unit_kind() const override { return unit_; }
  Capabilities capabilities() const override { return {.senses_activity = senses_activity}; }
  bool begin(const CaseBegin& begin, Bench& bench) override {
    told = begin;
    bench_ = &bench;
    if (at_begin) at_begin(bench);
    return serves;
  }
  void set_power(bool is_on, kernel::Time) override { power.push_back(is_on); }
  void receive(unsigned port, std::span<const Character> characters, kernel::Time now) override {
    for (const Character& character : characters) heard.push_back({port, character, now});
  }
  void receive(unsigned port, const line::Waveform& reception) override {
    heard_levels.push_back({port, reception});
  }
  void on_activity(unsigned, bool begins, kernel::Time now) override {
    activity.emplace_back(begins, now);
    if (at_activity) at_activity(begins);
  }
  void on_time(kernel::Time) override {
    next = kernel::kNever;
    if (at_time) at_time(*bench_);
  }
  kernel::Time next_time() const override { return next; }
  void end() override { ++ends; }

  // What it does.
  bool serves = true;
  bool senses_activity = true;
  Act at_begin;
  Act at_time;
  std::function<void(bool begins)> at_activity;
  kernel::Time next = kernel::kNever;

  // What it was told.
  CaseBegin told;
  std::vector<bool> power;
  std::vector<Heard> heard;
  std::vector<HeardLevels> heard_levels;
  std::vector<std::pair<bool, kernel::Time>> activity;
  int ends = 0;

 private:
  UnitKind unit_;
  Bench* bench_ = nullptr;
};

}  // namespace fieldproof::iut
