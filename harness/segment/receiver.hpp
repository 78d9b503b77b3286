#pragma once

#include "harness/fault/channel.hpp"

// The receiving end of a line, of whatever kind the line is: where what arrives can be changed.
namespace fieldproof::segment {

class Receiver {
 public:
  // Null: what was sent arrives. The channel must outlive its use.
  void set_channel(fault::Channel* channel) { channel_ = channel; }
  fault::Channel* channel() const { return channel_; }

 protected:
  ~Receiver() = default;

  fault::Channel* channel_ = nullptr;
};

}  // namespace fieldproof::segment
