#pragma once

#include <cstdint>

#include "conformance/token_bus/station_tester.hpp"
#include "conformance/token_bus/station_twin.hpp"

// The ring around the station under test in a sequence, as the tester plays it: rounds of the token, and what
// takes several transmissions of both, until the station has nothing more to say.
namespace fieldproof::conformance {

class RingAround {
 public:
  RingAround(TokenBench& bench, TokenTester& tester, TokenTwin& twin)
      : bench_(bench), tester_(tester), twin_(twin) {}

  // Time goes by, and the tester does what its neighbours do.
  void live(kernel::Duration duration);
  // Until the station has nothing more to say. One that is alone solicits for ever.
  void settle();
  // At the last settling it had solicited again and again, and nobody had answered.
  bool is_alone() const { return is_alone_; }

  // The station is passed the token, until its successor has passed on the token that it got; false: it did
  // not come to that.
  bool goes_round();
  // The same after so many slot times in which others talk now and then.
  bool goes_slowly(std::int64_t slots);
  // The station joins and is passed the token, and from then on nobody is there.
  void fail(std::int64_t times);
  // On an idle bus the station claims the token; then another has one, too.
  void claim(std::int64_t times);

 private:
  // Longer than any wait of a station of the table that is no multiple of it.
  kernel::Duration quiet() const { return bench_.slots(5) + bench_.octets(10); }

  TokenBench& bench_;
  TokenTester& tester_;
  TokenTwin& twin_;
  bool is_alone_ = false;
};

}  // namespace fieldproof::conformance
