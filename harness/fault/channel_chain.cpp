#include "harness/fault/channel_chain.hpp"

#include <utility>

#include "harness/fault/arrivals.hpp"

namespace fieldproof::fault {

bool ChannelChain::pass(const line::Waveform& sent, line::Waveforms& arrivals) {
  bool is_changed = false;
  for (Channel* channel : channels_) {
    if (!is_changed) {
      before_.clear();
      is_changed = channel->pass(sent, before_);
      continue;
    }
    behind_.clear();
    for (line::Waveform& wave : before_) {
      if (!channel->pass(wave, behind_)) behind_.take(wave);
    }
    std::swap(before_, behind_);
  }
  if (!is_changed) return false;
  order_by_start(before_, 0);
  for (line::Waveform& wave : before_) arrivals.take(wave);
  before_.clear();
  return true;
}

}  // namespace fieldproof::fault
