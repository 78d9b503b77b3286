#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/trace/trace.hpp"
#include "protocols/interbus/rules.hpp"

// Writes the trace of a case in lines for people, one record a line:
//
//   20.130000 ms  slave@1/in  id A55A 0003 | id check 1D0F 0000  [0100…]
//   20.130000 ms  slave@1/in  fault: flip of level 17
//
// Levels are shown for transmissions of at most kMostLevels levels. At most kMostLines lines are kept.
namespace fieldproof::conformance {

class LineRecorder final : public trace::Recorder {
 public:
  static constexpr std::size_t kMostLines = 20'000;
  static constexpr std::size_t kMostLevels = 400;

  LineRecorder(const trace::Trace& trace, const interbus::Rules& rules) : trace_(trace), rules_(rules) {}

  void on_driven(trace::Channel channel, const line::Waveform& wave) override;
  void on_fault(trace::Channel channel, kernel::Time time, std::string_view what) override;
  void on_observation(trace::Channel channel, kernel::Time time, std::string_view what,
                      std::uint64_t value) override;

  std::vector<std::string> take_lines() { return std::move(lines_); }
  bool is_truncated() const { return is_truncated_; }

 private:
  bool has_room();
  void add(trace::Channel channel, kernel::Time time, std::string_view text);

  const trace::Trace& trace_;
  interbus::Rules rules_;
  std::vector<std::string> lines_;
  bool is_truncated_ = false;
};

}  // namespace fieldproof::conformance
