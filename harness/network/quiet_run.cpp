#include "harness/network/quiet_run.hpp"

#include <optional>

#include "harness/kernel/random.hpp"

namespace fieldproof::network {
namespace {

constexpr kernel::Duration kStep = 5 * kernel::kMillisecond;

class Run final : private ExchangeWatcher {
 public:
  Run(Network& network, std::size_t cycles, std::uint64_t seed)
      : statistics_(network, kernel::Random(seed).split("process data")), wanted_(cycles) {
    segment::Segment& segment = network.segment();
    network.watch(*this);
    network.start();
    const kernel::Time end = segment.now() + network.bring_up_limit();
    while (segment.now() < end && network.state() != State::exchanging) segment.run_for(kStep);
    run_.came_up = network.state() == State::exchanging;
    // What the sources had before is not known: their words of before the start come first.
    statistics_.begin_recovery();
    while (run_.came_up && !statistics_.is_recovered() && segment.now() < end) segment.run_for(kStep);
    statistics_.begin();
    is_counting_ = run_.came_up;
    while (is_counting_ && run_.cycles.size() < wanted_ && network.state() == State::exchanging) {
      if (!segment.step()) break;
    }
    run_.counts = statistics_.counts();
    network.end();
  }

  QuietRun result() const { return run_; }

 private:
  void on_exchange(const Exchange& exchange) override {
    statistics_.on_exchange(exchange, LineEffect::untouched);
  }
  void on_shown(std::size_t signal, std::uint16_t word, kernel::Time when) override {
    statistics_.on_shown(signal, word, when);
  }
  void on_cycle_begin(std::size_t kind, kernel::Time when) override {
    if (kind != 0 || !is_counting_) return;
    if (last_) run_.cycles.push_back(when - *last_);
    last_ = when;
  }

  ExchangeStatistics statistics_;
  std::size_t wanted_;
  bool is_counting_ = false;
  std::optional<kernel::Time> last_;
  QuietRun run_;
};

}  // namespace

QuietRun run_quietly(Network& network, std::size_t cycles, std::uint64_t seed) {
  return Run(network, cycles, seed).result();
}

}  // namespace fieldproof::network
