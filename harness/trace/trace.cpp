#include "harness/trace/trace.hpp"

namespace fieldproof::trace {
namespace {

// First words of a record tell its kind, so that no two kinds of records look alike.
enum Kind : std::uint64_t { kDriven = 1, kFault = 2, kObservation = 3 };

std::uint64_t ticks(kernel::Time time) {
  return static_cast<std::uint64_t>(time.time_since_epoch().count());
}

}  // namespace

Channel Trace::add_channel(std::string name) {
  names_.push_back(std::move(name));
  return static_cast<Channel>(names_.size() - 1);
}

void Trace::mix(std::uint64_t word) {
  // A 64 x 64 multiplication whose halves are folded: each bit of the word reaches the whole state.
  __extension__ using Wide = unsigned __int128;
  const Wide product = static_cast<Wide>(fingerprint_ ^ word) * 0x9E3779B97F4A7C15U + word;
  fingerprint_ = static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
}

void Trace::mix(std::string_view text) {
  mix(text.size());
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    word = word << 8 | static_cast<unsigned char>(text[i]);
    if (i % 8 == 7) mix(word);
  }
  mix(word);
}

void Trace::driven(Channel channel, const line::Waveform& wave) {
  ++record_count_;
  mix(kDriven << 32 | channel);
  mix(ticks(wave.start));
  mix(static_cast<std::uint64_t>(wave.rate));
  mix(wave.levels.size());
  const std::uint64_t* words = wave.levels.words();
  for (std::size_t i = 0; i < wave.levels.word_count(); ++i) mix(words[i]);
  if (recorder_ != nullptr) recorder_->on_driven(channel, wave);
}

void Trace::fault(Channel channel, kernel::Time time, std::string_view what) {
  ++record_count_;
  mix(kFault << 32 | channel);
  mix(ticks(time));
  mix(what);
  if (recorder_ != nullptr) recorder_->on_fault(channel, time, what);
}

void Trace::observe(Channel channel, kernel::Time time, std::string_view what, std::uint64_t value) {
  ++record_count_;
  mix(kObservation << 32 | channel);
  mix(ticks(time));
  mix(what);
  mix(value);
  if (recorder_ != nullptr) recorder_->on_observation(channel, time, what, value);
  for (Observer* observer : observers_) observer->on_observation(channel, time, what, value);
}

}  // namespace fieldproof::trace
