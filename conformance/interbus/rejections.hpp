#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/interbus/slave_bench.hpp"
#include "conformance/interbus/slave_expect.hpp"
#include "harness/line/waveform.hpp"

// Many error patterns at a slave's receiver, each of which its frame check must see.
namespace fieldproof::conformance {

// Positions in the code word of loopback word, register and check.
using BitPattern = std::span<const std::uint32_t>;

inline std::string text_of_pattern(BitPattern pattern) {
  return fmt::format("bits {} of the code word flipped", fmt::join(pattern, ", "));
}

// Collects patterns and sends them, one a cycle, in trains of equal cycles; each must be rejected.
class Rejections {
 public:
  Rejections(SlaveBench& bench, CaseJudge& judge, std::string_view reason)
      : bench_(bench), judge_(judge), reason_(reason) {
    bench_.bring_up();
    expect_good_cycle(bench_, judge_, "valid_cycle_rejected");
    std::vector<std::uint16_t> words = bench_.random_words();
    if (!words.empty()) words[0] = static_cast<std::uint16_t>(~bench_.outputs()[0]);
    bench_.train().set_gap(1);
    bench_.begin();
    for (std::size_t n = 0; n < kCyclesOfTrain; ++n) bench_.append_data_cycle(words);
    levels_ = bench_.train().levels();
    for (std::size_t bit = 0; bit < bench_.code_word_bits(); ++bit)
      places_.push_back(bench_.code_word_level(bench_.train().cycles()[0], bit));
    pitch_ = bench_.train().cycles()[1].level - bench_.train().cycles()[0].level;
  }

  void add(BitPattern pattern) {
    if (ends_.empty()) bench_.channel().on_next();
    const std::size_t offset = pitch_ * ends_.size();
    for (const std::uint32_t bit : pattern) bench_.channel().flip(offset + places_[bit]);
    flipped_.insert(flipped_.end(), pattern.begin(), pattern.end());
    ends_.push_back(flipped_.size());
    ++count_;
    if (ends_.size() == kCyclesOfTrain) send();
  }

  // Fills the last train with its last pattern, and sends a good cycle.
  void finish() {
    while (!ends_.empty()) {
      const std::size_t first = ends_.size() == 1 ? 0 : ends_[ends_.size() - 2];
      add(std::vector<std::uint32_t>(flipped_.begin() + static_cast<std::ptrdiff_t>(first), flipped_.end()));
      --count_;
    }
    bench_.train().set_gap(2);
    expect_good_cycle(bench_, judge_, "no_recovery");
    judge_.measure("error patterns", "", static_cast<double>(count_));
  }

 private:
  static constexpr std::size_t kCyclesOfTrain = 32;  // sent as one waveform

  void send() {
    bench_.train().levels().clear();
    bench_.train().levels().append(levels_);
    bench_.send();
    judge_.expect_equal(bench_.out().data_telegrams().size(), bench_.train().data_telegram_count(),
                        "telegram_lost", "data telegrams that left");
    const std::uint16_t marked = bench_.rules().status_marked;
    std::size_t first = 0;
    for (std::size_t n = 0; n < ends_.size(); first = ends_[n++]) {
      const std::optional<CycleOnLine> out = bench_.cycle_on(bench_.out(), n);
      const bool is_marked = out && (out->status() & marked) == marked;
      judge_.expect(is_marked, reason_, [&] {
        return Mismatch{
            .expected = {"the cycle is rejected: its status word leaves marked"},
            .actual = "the cycle was accepted: its status word left unmarked",
            .time = out ? bench_.out().start_of(out->telegrams[out->octets + 2]) : bench_.now(),
            .first_difference = text_of_pattern(BitPattern(flipped_).subspan(first, ends_[n] - first))};
      });
    }
    expect_no_change(bench_, judge_, "output_changed_by_rejected_cycle", "no cycle passes its check");
    flipped_.clear();
    ends_.clear();
  }

  SlaveBench& bench_;
  CaseJudge& judge_;
  std::string_view reason_;
  line::Levels levels_;              // of the whole train
  std::vector<std::size_t> places_;  // level of each bit of the first cycle's code word
  std::size_t pitch_ = 0;            // levels from cycle to cycle
  std::vector<std::uint32_t> flipped_;
  std::vector<std::size_t> ends_;
  std::uint64_t count_ = 0;
};

}  // namespace fieldproof::conformance
