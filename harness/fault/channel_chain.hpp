#pragma once

#include <cstddef>
#include <vector>

#include "harness/fault/channel.hpp"

// Several channels in front of one receiver, in order of installation: each one is asked about what the one
// before lets arrive. An arrival that lies ahead (a delayed one) is shown to the next channel at once, with
// its later start.
namespace fieldproof::fault {

class ChannelChain final : public Channel {
 public:
  // The channel must outlive the chain.
  void add(Channel& channel) { channels_.push_back(&channel); }
  std::size_t size() const { return channels_.size(); }
  Channel* first() const { return channels_.empty() ? nullptr : channels_.front(); }

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override;

 private:
  std::vector<Channel*> channels_;
  line::Waveforms before_;
  line::Waveforms behind_;
};

}  // namespace fieldproof::fault
