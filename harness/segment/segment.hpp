#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "harness/kernel/scheduler.hpp"
#include "harness/segment/link.hpp"
#include "harness/segment/station.hpp"
#include "harness/trace/trace.hpp"

// Stations, the lines between them, one scheduler and one trace: the world of one case. Everything in it
// happens in virtual time and in one thread; two segments share nothing, so cases run on as many threads as
// there are.
namespace fieldproof::segment {

class Segment {
 public:
  Segment() = default;
  Segment(const Segment&) = delete;
  Segment& operator=(const Segment&) = delete;

  kernel::Scheduler& scheduler() { return scheduler_; }
  trace::Trace& trace() { return trace_; }
  kernel::Time now() const { return scheduler_.now(); }

  // The station must outlive the segment's last run. Gives its number. One that asks for the same instant for
  // ever ends the run by a kernel::Error (implementation) with its name.
  std::size_t attach(Station& station, std::string name);

  // A one-way link to receiver number `receiver`, heard there as `port`.
  Link& connect(std::string name, std::size_t receiver, PortIndex port, kernel::Duration delay);

  // Runs everything up to and including `end`.
  void run_until(kernel::Time end) { scheduler_.run_until(end); }
  void run_for(kernel::Duration duration) { run_until(now() + duration); }
  bool step() { return scheduler_.step(); }

  // Asks the station for its next time again; needed after something outside the segment changed it.
  void refresh(std::size_t station) { seats_[station].refresh(); }

  void deliver(std::size_t station, PortIndex port, const line::Waveform& wave) {
    seats_[station].receive(port, wave);
  }
  void tell_activity(std::size_t station, PortIndex port, bool begins) {
    seats_[station].tell_activity(port, begins);
  }

 private:
  // A station and its timer. The timer is armed lazily: when the wanted time moves later, as a supervision
  // time does with every reception, the early firing costs one look instead of a new arming each time.
  class Seat final : public kernel::Timer {
   public:
    Seat(Segment& segment, Station& station, trace::Channel name);
    void receive(PortIndex port, const line::Waveform& wave) {
      station_.receive(port, wave);
      refresh();
    }
    void tell_activity(PortIndex port, bool begins) {
      station_.on_activity(port, begins, segment_.now());
      refresh();
    }
    void refresh();
    void on_time(kernel::Time now) override;

   private:
    Segment& segment_;
    Station& station_;
    kernel::SlotId slot_;
    trace::Channel name_;
    kernel::Time armed_ = kernel::kNever;
    kernel::Time called_at_ = kernel::kNever;  // on_time, the last time
    unsigned calls_ = 0;                       // at that instant
  };

  kernel::Scheduler scheduler_;
  trace::Trace trace_;
  std::deque<Seat> seats_;
  std::deque<Link> links_;
};

}  // namespace fieldproof::segment
