#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include "harness/fault/stress.hpp"
#include "harness/segment/receiver.hpp"

// The receiver of an implementation under the stresses of a case: one at a time, between quiet times. While
// it is quiet it is as it was.
namespace fieldproof::conformance {

// The tag of a case that cannot be run without stresses; a suite that was given none leaves it out.
inline constexpr std::string_view kStressTag = "bursts";

class StressedReceiver final : private fault::Channel {
 public:
  explicit StressedReceiver(std::span<const fault::Stress> stresses) : stresses_(stresses) {}

  std::span<const fault::Stress> stresses() const { return stresses_; }

  // From now on. Equal streams give equal disturbances.
  void begin(const fault::Stress& stress, segment::Receiver& receiver, const fault::StressPlace& place) {
    end();
    channel_ = stress.make_channel(place);
    if (channel_ == nullptr) return;
    receiver_ = &receiver;
    before_ = receiver.channel();
    receiver.set_channel(this);
  }
  void end() {
    if (receiver_ != nullptr) receiver_->set_channel(before_);
    receiver_ = nullptr;
  }

  // Transmissions that arrived otherwise than they were sent, under all stresses.
  std::uint64_t changed() const { return changed_; }

 private:
  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override {
    const bool is_changed = channel_->pass(sent, arrivals);
    if (is_changed) ++changed_;
    return is_changed;
  }

  std::span<const fault::Stress> stresses_;
  std::unique_ptr<fault::Channel> channel_;
  segment::Receiver* receiver_ = nullptr;
  fault::Channel* before_ = nullptr;
  std::uint64_t changed_ = 0;
};

}  // namespace fieldproof::conformance
