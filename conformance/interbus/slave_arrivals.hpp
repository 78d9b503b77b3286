#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "conformance/interbus/slave_bench.hpp"
#include "conformance/interbus/slave_expect.hpp"

// What arrives at a slave while its line is disturbed: which cycles it may take over, and their words.
namespace fieldproof::conformance {

// Follows what arrives at the slave's receiver from cycle to cycle: telegrams that a broken cycle left open
// belong to what comes next, as they do in the slave.
class SlaveArrivals {
 public:
  explicit SlaveArrivals(SlaveBench& bench) : bench_(bench) {}

  // Takes in the last train; gives whether a cycle that may be taken over ended in it.
  bool take() {
    const std::span<const SeenTelegram> telegrams = bench_.in().data_telegrams();
    open_.insert(open_.end(), telegrams.begin(), telegrams.end());
    bool has_words = false;
    for (find_first_cycle(open_, cycle_); cycle_.is_found; find_first_cycle(open_, cycle_)) {
      if (is_right_data_cycle(bench_, cycle_) && cycle_.octets.size() >= 2 * bench_.words()) {
        has_words = true;
        keep_words();
      }
      open_.erase(open_.begin(), open_.begin() + static_cast<std::ptrdiff_t>(cycle_.end));
    }
    return has_words;
  }

  // Of the last of these cycles.
  const std::vector<std::uint16_t>& words() const { return words_; }

 private:
  void keep_words() {
    words_.clear();
    for (std::size_t n = cycle_.octets.size() - 2 * bench_.words(); n < cycle_.octets.size(); n += 2)
      words_.push_back(static_cast<std::uint16_t>(cycle_.octets[n] << 8 | cycle_.octets[n + 1]));
  }

  SlaveBench& bench_;
  FoundCycle cycle_;
  std::vector<std::uint16_t> words_;
  std::vector<SeenTelegram> open_;
};

}  // namespace fieldproof::conformance
