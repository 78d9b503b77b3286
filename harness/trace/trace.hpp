#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/waveform.hpp"

// The append-only history of a segment: what was driven, what a fault changed, what a station let the upper
// tester see. Every record enters the fingerprint, in order, with its time; two runs of one seed and one
// build have the same fingerprint, and so have two build types. Nothing is stored here: a `Recorder` that is
// set keeps what it wants, so a run of hours costs no memory.
namespace fieldproof::trace {

// A named place where something happens: a link, a receiver, a station.
using Channel = std::uint32_t;

class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual void on_driven(Channel channel, const line::Waveform& wave) = 0;
  virtual void on_fault(Channel channel, kernel::Time time, std::string_view what) = 0;
  virtual void on_observation(Channel channel, kernel::Time time, std::string_view what,
                              std::uint64_t value) = 0;
  // A receiver got `arrivals` instead of `sent`, which is as it would have arrived and was driven at
  // `driven_at`. No record of the trace: it does not enter the fingerprint.
  virtual void on_changed(Channel /*receiver*/, kernel::Time /*driven_at*/, const line::Waveform& /*sent*/,
                          std::span<const line::Waveform> /*arrivals*/) {}
  // The case begins its next step. No record of the trace either.
  virtual void on_step(kernel::Time /*time*/, std::string_view /*text*/) {}
};

// Is told every observation as it is made: how a fault rule waits for one. It changes nothing of the trace.
class Observer {
 public:
  Observer() = default;
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;
  virtual ~Observer() = default;
  virtual void on_observation(Channel channel, kernel::Time time, std::string_view what,
                              std::uint64_t value) = 0;
};

class Trace {
 public:
  Channel add_channel(std::string name);
  const std::string& channel_name(Channel channel) const { return names_.at(channel); }
  std::size_t channel_count() const { return names_.size(); }

  void driven(Channel channel, const line::Waveform& wave);
  void fault(Channel channel, kernel::Time time, std::string_view what);
  void observe(Channel channel, kernel::Time time, std::string_view what, std::uint64_t value = 0);
  // For the recorder alone; see Recorder::on_changed.
  void changed(Channel receiver, kernel::Time driven_at, const line::Waveform& sent,
               std::span<const line::Waveform> arrivals) {
    if (recorder_ != nullptr) recorder_->on_changed(receiver, driven_at, sent, arrivals);
  }
  // For the recorder alone; see Recorder::on_step.
  void step(kernel::Time time, std::string_view text) {
    if (recorder_ != nullptr) recorder_->on_step(time, text);
  }

  std::uint64_t fingerprint() const { return fingerprint_; }
  std::uint64_t record_count() const { return record_count_; }

  // The recorder must outlive its use; null stops recording.
  void set_recorder(Recorder* recorder) { recorder_ = recorder; }

  // Observers are told in the order in which they were added, and must be removed before they die.
  void add_observer(Observer& observer) { observers_.push_back(&observer); }
  void remove_observer(Observer& observer) { std::erase(observers_, &observer); }

 private:
  void mix(std::uint64_t word);
  void mix(std::string_view text);

  std::vector<std::string> names_;
  Recorder* recorder_ = nullptr;
  std::vector<Observer*> observers_;
  std::uint64_t fingerprint_ = 0x6669656C64707266;  // any constant but zero
  std::uint64_t record_count_ = 0;
};

}  // namespace fieldproof::trace
