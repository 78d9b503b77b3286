#pragma once

#include <algorithm>
#include <memory>
#include <span>

#include "harness/iut/device.hpp"
#include "harness/kernel/check.hpp"
#include "harness/segment/station.hpp"

// A station of ours as an implementation, in any role: the other side of AttachedCase. It hears and says
// levels, as it does inside, so the bench sees the same to the bit.
//
// A role makes its station in `begin`, with `play`, and gives it `port(n)` to drive and what it needs of the
// process side.
namespace fieldproof::iut {

template <typename Station>
class ServedStation : public Device {
 public:
  UnitKind unit_kind() const override { return UnitKind::levels; }
  void receive(unsigned, std::span<const Character>, kernel::Time) override {
    FIELDPROOF_CHECK(false, "a served station has asked for levels");
  }
  void on_activity(unsigned port, bool begins, kernel::Time now) override {
    act(now, [&] { station_->on_activity(port, begins, now); });
  }
  void on_time(kernel::Time now) override {
    act(now, [&] { station_->on_time(now); });
  }
  kernel::Time next_time() const override { return station_ ? station_->next_time() : kernel::kNever; }
  void end() override { station_.reset(); }

 protected:
  void play(std::unique_ptr<Station> station, Bench& bench) {
    station_ = std::move(station);
    bench_ = &bench;
    now_ = kernel::kStart;
    for (Port& port : ports_) port.served = this;
    for (unsigned n = 0; n < kPorts; ++n) ports_[n].number = n;
  }
  // A call of the bench at `now`.
  template <typename Call>
  void act(kernel::Time now, Call&& call) {
    now_ = now;
    before_call();
    call();
    after_call();
  }
  virtual void before_call() {}
  virtual void after_call() {}

  Station& station() { return *station_; }
  Bench& bench() { return *bench_; }
  segment::Port& port(unsigned number) { return ports_[number]; }
  kernel::Time now() const { return now_; }
  // A station may act at the end of what it heard by its own clock, before a slower sender has ended it.
  kernel::Time not_past(kernel::Time when) const { return std::max(when, now_); }

 private:
  static constexpr unsigned kPorts = 3;

  struct Port final : segment::Port {
    void drive(line::Waveform& wave) override { served->bench_->transmit(number, wave); }

    ServedStation* served = nullptr;
    unsigned number = 0;
  };

  std::unique_ptr<Station> station_;
  Bench* bench_ = nullptr;
  kernel::Time now_{};
  Port ports_[kPorts];
};

}  // namespace fieldproof::iut
