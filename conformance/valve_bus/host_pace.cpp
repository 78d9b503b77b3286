#include "conformance/valve_bus/host_pace.hpp"

#include <fmt/format.h>

namespace fieldproof::conformance {
namespace {

constexpr unsigned kMostRefreshesInTurn = 2;

}  // namespace

bool HostPace::awaits_response(const valve_bus::Command& command) const {
  return command.command == bench_.rules().read_command || bench_.rules().answers_writes;
}

void HostPace::on_frame(const HostFrame& frame, bool is_refresh) {
  if (frame.sent.characters.size() != valve_bus::kCommandOctets) return;
  const valve_bus::Command command = frame.command();
  const bool is_same = last_ && last_->command == command && awaits_response(command);
  // What the answer was to the host decides what the same command is now.
  const bool is_attempt =
      is_same && !was_answered_ && attempt_ > 0 && attempt_ < bench_.rules().read_attempts;
  if (judge_ != nullptr && last_) {
    expect_rest_after_write(frame);
    expect_time_out(frame, is_attempt);
  }
  expect_turns(is_refresh, command.command == bench_.rules().write_command);
  if (is_attempt) {
    ++attempt_;
  } else {
    attempt_ = is_same && (was_answered_ || attempt_ == 0) ? 0 : 1;
  }
  if (command.command == bench_.rules().write_command) written_at_[command.id] = frame.start;
  last_ = {command, frame.start, frame.end};
  was_answered_ = false;
}

void HostPace::expect_rest_after_write(const HostFrame& frame) {
  if (awaits_response(last_->command)) return;
  const kernel::Duration least = bench_.delimiter() + bench_.rules().write_distance;
  const kernel::Duration rest = frame.start - last_->end;
  judge_->expect(rest + bench_.doubt_of(frame).later + kernel::kNanosecond >= least,
                 "write_distance_too_short", [&] {
                   return Mismatch{{fmt::format("{} or more after a write", kernel::describe(least))},
                                   kernel::describe(rest),
                                   frame.start};
                 });
}

void HostPace::expect_time_out(const HostFrame& frame, bool is_attempt) {
  if (!awaits_response(last_->command) || was_answered_) return;
  const iut::TimingUncertainty doubt = bench_.doubt_of(frame);
  const kernel::Duration waited = frame.start - last_->end;
  const auto sighting = [&](std::string_view text, kernel::Duration limit) {
    return Mismatch{
        {fmt::format("the next frame {} {} after a read that nobody answers", text, kernel::describe(limit))},
        kernel::describe(waited),
        frame.start};
  };
  const kernel::Duration least = earliest_repetition(bench_);
  judge_->expect(waited + doubt.later >= least, "time_out_too_short",
                 [&] { return sighting("at least", least); });
  if (!is_attempt) return;
  const kernel::Duration most = latest_repetition(bench_);
  judge_->expect(waited - doubt.earlier <= most, "time_out_too_long",
                 [&] { return sighting("at most", most); });
}

void HostPace::expect_turns(bool is_refresh, bool is_write) {
  refreshes_ = is_refresh ? refreshes_ + 1 : 0;
  if (!is_refresh && is_write && writes_waiting_ > 0) --writes_waiting_;
  // One more may be under way when the last of the writes is given.
  if (judge_ == nullptr || writes_waiting_ <= 1) return;
  judge_->expect(refreshes_ <= kMostRefreshesInTurn, "command_waits_for_refreshes",
                 "refreshes and commands take turns", "three refreshes were sent while a command waited");
}

void HostPace::on_error(const valve_bus::HostError& error, kernel::Time when) {
  const bool is_due = error.kind == valve_bus::HostErrorKind::no_response && last_ && !was_answered_ &&
                      attempt_ == bench_.rules().read_attempts && last_->command.id == error.id;
  if (judge_ == nullptr || !is_due) return;
  const kernel::Time latest = last_->end + latest_repetition(bench_);
  judge_->expect(when <= latest, "error_late", [&] {
    return Mismatch{{fmt::format("an error at {} at the latest", kernel::describe(latest))},
                    kernel::describe(when),
                    when};
  });
}

void HostPace::on_noise() {
  was_answered_ = true;
  attempt_ = 0;
  for (auto& [id, when] : written_at_) when = bench_.now();
}

void HostPace::on_power() {
  last_.reset();
  written_at_.clear();
  attempt_ = 0;
  writes_waiting_ = 0;
  refreshes_ = 0;
}

kernel::Duration HostPace::longest_refresh() const {
  const valve_bus::Rules& rules = bench_.rules();
  const kernel::Duration read = rules.read_attempts * (bench_.time_out() * 11 / 10 + bench_.characters(10));
  const kernel::Duration write = bench_.characters(10) + bench_.delimiter() + rules.write_distance;
  // Each of the nodes may wait for the others and, with each, for what the PC has ordered.
  const auto nodes = static_cast<int>(written_at_.size());
  return rules.refresh * 11 / 10 + nodes * (read + 2 * write);
}

void HostPace::expect_refreshed() {
  if (judge_ == nullptr || bench_.rules().answers_writes) return;
  const kernel::Duration longest = longest_refresh();
  for (const auto& [id, when] : written_at_) {
    judge_->expect(bench_.now() - when <= longest, "no_refresh", [&] {
      return Mismatch{{fmt::format("node {} is written to again within {}", id, kernel::describe(longest))},
                      fmt::format("not since {}", kernel::describe(when)),
                      bench_.now()};
    });
  }
}

}  // namespace fieldproof::conformance
