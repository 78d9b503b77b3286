#pragma once

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
  bool empty() const { return channels_.empty(); }

  bool pass(const line::Waveform& sent, std::vector<line::Waveform>& arrivals) override;

 private:
  std::vector<Channel*> channels_;
  std::vector<line::Waveform> before_;  // kept for their buffers
  std::vector<line::Waveform> behind_;
};

}  // namespace fieldproof::fault
