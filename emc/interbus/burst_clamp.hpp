#pragma once

#include <deque>
#include <vector>

#include "emc/burst_channel.hpp"
#include "emc/generator.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/time.hpp"
#include "harness/measure/phase.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/ring.hpp"

// Bursts on an INTERBUS ring: all cables of the remote bus lie in the clamp, local buses do not.
namespace fieldproof::emc {

class BurstClamp {
 public:
  // The phases of a run: each burst, and how long the bus has to recover behind it.
  BurstClamp(const BurstSettings& bursts, WrongOutput wrong, const BurstReceiver& receiver,
             const kernel::Random& random, kernel::Duration recovery = {});

  // Puts a channel on each cable of a ring; what was coupled before is forgotten. Bursts may come from `on`
  // on and before `off`. The ring must not run any more once the clamp is gone.
  void couple(interbus::Ring& ring, segment::Segment& segment, kernel::Time on,
              kernel::Time off = kernel::kNever);

  // Whether an interval meets a burst, or else a recovery.
  measure::Phase phase_during(kernel::Time from, kernel::Time to);

  const std::deque<BurstChannel>& channels() const { return channels_; }

 private:
  BurstSettings bursts_;
  WrongOutput wrong_;
  BurstReceiver receiver_;
  kernel::Random random_;
  kernel::Duration recovery_;
  BurstSchedule schedule_;
  std::deque<BurstChannel> channels_;
};

}  // namespace fieldproof::emc
