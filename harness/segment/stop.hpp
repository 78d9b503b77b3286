#pragma once

#include <stop_token>

// How a case hears that its run is to end: what runs in a segment on this thread is given up at one of its
// next events.
//
// Contract: within the life of a scope, and on its thread only, an event of a segment throws Interrupted some
// thousand events after the stop was requested at the latest. Nothing else depends on it: a case that is not
// interrupted is the same with and without. Interrupted is no error, so it is none of the exceptions that a
// verdict is made of.
namespace fieldproof::segment {

struct Interrupted {};

class StopScope {
 public:
  explicit StopScope(std::stop_token stop);
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  std::stop_token stop_;
  const std::stop_token* before_;
};

// Called by lines and stations at each of their events.
void give_up_if_stopped();

}  // namespace fieldproof::segment
