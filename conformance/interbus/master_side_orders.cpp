#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "conformance/interbus/master_side.hpp"
#include "protocols/interbus/master.hpp"

// What an application orders of a master in other states than run, and what must come of it.
namespace fieldproof::conformance {

using interbus::MasterState;

void MasterSide::order_in(MasterState state, EarlyOrder order) {
  if (!is_running() || !is_ring_right_) return;
  const bool is_before_run = state == MasterState::ready || state == MasterState::identification;
  if (is_before_run) {
    stop(false);
    is_stopped_ = false;
    bench_.start();
  } else {
    bench_.ring().cut_after(-1);
    // One that takes silence for a good cycle never leaves.
    constexpr int kMost = 1'000;
    for (int n = 0; n < kMost && is_running() && bench_.run_cycle(); ++n) {
    }
  }
  const bool is_there =
      bench_.run_until([&] { return bench_.status().state == state; }, longest_recognition());
  expect(is_there, "state_missing", fmt::format("the state {}", interbus::name(state)), "another one");
  driven_->forget_silence();
  give(order);
  if (order == EarlyOrder::stop) {
    await_stop();
  } else if (is_before_run || (state == MasterState::bus_stop && order == EarlyOrder::start)) {
    bench_.ring().mend();
    await_outputs_of_run();
    if (state == MasterState::identification && is_running()) expect_no_start();
  } else {
    settle();
  }
  bench_.ring().mend();
  // Before the recognition it was silent, as it must.
  bench_.ring().forget_statistics();
  states_seen_ = 0;
  is_running() ? enter_run() : note_state(false);
}

void MasterSide::give(EarlyOrder order) {
  switch (order) {
    case EarlyOrder::start:
      return bench_.start();
    case EarlyOrder::stop:
      return bench_.stop();
    case EarlyOrder::id_cycle:
      return bench_.request_id_cycle();
    case EarlyOrder::output:
      return bench_.write_output(0, 0xFFFF);
  }
}

// With the silence before it. Who does not know the ring may wait for an answer as long as the longest one
// takes, as often as stops the bus.
kernel::Duration MasterSide::longest_recognition() const {
  const interbus::Rules& rules = bench_.rules();
  const kernel::Duration half_bit = kernel::levels_duration(1, 2 * rules.bit_rate);
  const kernel::Duration stations =
      rules.max_stations * (rules.forward_delay_half_bits + rules.return_delay_half_bits) * half_bit;
  const kernel::Duration cable =
      kernel::Duration{2 * static_cast<std::int64_t>(rules.max_cable_m) * rules.cable_delay_ps_per_m};
  return kernel::kSecond + bench_.cycles_of_recognition() * bench_.longest_cycle() +
         2 * (rules.silence_limit + 2 * rules.silence_tolerance) +
         rules.stop_after_bad_cycles * (stations + cable);
}

// A station has answered: the silence of the start is over, and no order brings another one.
void MasterSide::expect_no_start() {
  const kernel::Duration longest = driven_->longest_silence();
  expect(longest <= bench_.rules().silence_limit, "order_starts_again",
         "the recognition goes on, whatever is ordered within it", kernel::describe(longest));
}

// No data cycle with outputs 0 is owed: it ends at once.
void MasterSide::await_stop() {
  bench_.run_until([this] { return bench_.status().state == MasterState::off; }, kernel::kMillisecond);
  bench_.run_for(kernel::kMillisecond);
  is_stopped_ = true;
  const std::uint64_t cycles = bench_.ring().cycle_count();
  bench_.run_for(kIdle);
  expect(bench_.ring().cycle_count() == cycles && bench_.status().state == MasterState::off, "not_silent",
         "off, and no cycle, when it is stopped before it runs", "it goes on");
}

// What was written before has no effect, on the line and in the image.
void MasterSide::await_outputs_of_run() {
  bool is_zero = true;
  bench_.ring().on_outputs([&is_zero](std::span<const std::uint16_t> latched, kernel::Time) {
    is_zero = is_zero && std::ranges::all_of(latched, [](std::uint16_t word) { return word == 0; });
  });
  await_three_cycles_of_run();
  bench_.ring().on_outputs(nullptr);
  for (unsigned word = 0; word < bench_.ring().word_count(); ++word)
    is_zero = is_zero && bench_.master().output(word) == 0;
  expect(!is_running() || is_zero || !bench_.configuration().copy.empty(), "early_output_kept",
         "outputs of 0 until the application writes some in run", "others");
}

void MasterSide::await_three_cycles_of_run() {
  bench_.run_until([this] { return is_running(); }, longest_recognition());
  if (!bench_.wait_for_run()) return settle();
  constexpr int kUntilWritten = 3;
  for (int n = 0; n < kUntilWritten && bench_.run_cycle(); ++n) {
  }
}

}  // namespace fieldproof::conformance
