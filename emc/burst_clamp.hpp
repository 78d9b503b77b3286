#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "emc/burst_channel.hpp"
#include "emc/generator.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/time.hpp"
#include "harness/measure/phase.hpp"
#include "harness/measure/time_course.hpp"
#include "harness/network/network.hpp"

// Bursts on an installation: all cables that are exposed lie in the clamp, and one generator drives it.
namespace fieldproof::emc {

class BurstClamp {
 public:
  // `recovery` is how long the installation has to recover after a burst: the phases of a run are told apart
  // by it.
  BurstClamp(const BurstSettings& bursts, WrongOutput wrong, const kernel::Random& random,
             kernel::Duration recovery = {});

  // Puts a channel on each exposed receiver; what was coupled before is forgotten. Bursts may come from `on`
  // on and before `off`. The network must not run any more once the clamp is gone.
  void couple(network::Network& network, kernel::Time on, kernel::Time off = kernel::kNever);

  // Whether an interval meets a burst, or else a recovery.
  measure::Phase phase_during(kernel::Time from, kernel::Time to);

  // The first burst that ends after an instant, from its first pulse to one pitch after its last.
  std::optional<measure::Span> burst_after(kernel::Time after);

  // How many bursts have a pulse in an interval.
  std::uint64_t bursts_between(kernel::Time from, kernel::Time to);

  const std::deque<BurstChannel>& channels() const { return channels_; }

 private:
  BurstSettings bursts_;
  WrongOutput wrong_;
  kernel::Random random_;
  kernel::Duration recovery_;
  BurstSchedule schedule_;
  std::deque<BurstChannel> channels_;
};

// As a burst channel needs to know the receiver of a place.
BurstReceiver burst_receiver_of(const network::Place& place);

}  // namespace fieldproof::emc
