#include "conformance/interbus/slave_expect.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::conformance {
namespace {

bool has_outputs(const SlaveBench& bench) {
  return bench.pics().supports("outputs") && bench.words() > 0;
}

std::string change_text(const interbus::TerminalBlock::Change& change) {
  return fmt::format("word {} went from {:04X}h to {:04X}h at {}", change.word, change.before, change.after,
                     kernel::describe(change.when));
}

// From when on the outputs may show a cycle, and until when they must.
struct LatchWindow {
  kernel::Time first;
  kernel::Time last;
};

LatchWindow latch_window(SlaveBench& bench, const CycleOnLine& in) {
  const SeenTelegram& last = in.telegrams.back();
  const kernel::Time start = bench.in().start_of(last);
  return {start + bench.bits(TrainWriter::kStopLevel),
          start + bench.bits(line::kDataTelegramLevels) + bench.rules().latch_limit};
}

}  // namespace

std::vector<std::uint16_t> words_held(std::span<const SeenTelegram> transfer, unsigned words) {
  std::vector<std::uint16_t> held;
  const std::size_t first = transfer.size() - std::min<std::size_t>(transfer.size(), 2 * words);
  for (std::size_t n = first; n + 1 < transfer.size(); n += 2)
    held.push_back(static_cast<std::uint16_t>(transfer[n].data << 8 | transfer[n + 1].data));
  return held;
}

std::string text_of(std::span<const std::uint16_t> words) {
  std::string text;
  for (const std::uint16_t word : words) text += fmt::format("{}{:04X}h", text.empty() ? "" : " ", word);
  return text.empty() ? "no words" : text;
}

bool is_right_data_cycle(SlaveBench& bench, const FoundCycle& found) {
  return found.is_found && !found.is_id_cycle && found.status == bench.rules().status_clean &&
         found.check == bench.model().check().of(found.octets);
}

bool left_clean(SlaveBench& bench) {
  FoundCycle cycle;
  find_last_cycle(bench.out().data_telegrams(), cycle);
  return cycle.is_found && cycle.status == bench.rules().status_clean;
}

void expect_all_telegrams(SlaveBench& bench, CaseJudge& judge) {
  const std::size_t arrived = bench.in().data_telegrams().size();
  const std::size_t left = bench.out().data_telegrams().size();
  judge.expect(left == arrived, left < arrived ? "telegram_lost" : "telegram_added", [&] {
    return Mismatch{.expected = {fmt::format("{} data telegrams leave, as many as arrived", arrived)},
                    .actual = fmt::format("{} data telegrams left", left)};
  });
}

CycleOnLine cycle_that_left(SlaveBench& bench, CaseJudge& judge, std::size_t n) {
  const std::optional<CycleOnLine> out = bench.cycle_on(bench.out(), n);
  if (out) return *out;
  expect_all_telegrams(bench, judge);
  judge.fail("telegram_lost", {{"the cycle passes the slave"}, "it did not arrive there whole"});
}

void expect_status_telegrams(SlaveBench& bench, CaseJudge& judge) {
  judge.expect_equal(bench.out().status_count(), bench.in().status_count(), "status_telegram_lost",
                     "status telegrams that left");
  const auto is_status = [](const SeenTelegram& telegram) { return !telegram.is_data(); };
  auto in = std::ranges::find_if(bench.in().telegrams(), is_status);
  for (const SeenTelegram& out : bench.out().telegrams()) {
    if (!is_status(out)) continue;
    judge.expect(out.header == in->header, "status_telegram_changed", [&] {
      return Mismatch{.expected = {describe(bench.in(), *in, bench.in().start_of(*in))},
                      .actual = describe(bench.out(), out, bench.out().start_of(out)),
                      .time = bench.out().start_of(out)};
    });
    in = std::find_if(in + 1, bench.in().telegrams().end(), is_status);
  }
}

void expect_answer(SlaveBench& bench, CaseJudge& judge, std::size_t n, std::span<const std::uint8_t> load) {
  const CycleOnLine out = cycle_that_left(bench, judge, n);
  const std::optional<CycleOnLine> in = bench.cycle_on(bench.in(), n);
  if (!in) judge.fail("telegram_added", {{"the cycle arrives, then leaves"}, "it only left"});
  std::vector<std::uint8_t> as_it_left;
  if (!in->is_id_cycle && !bench.pics().supports("inputs")) {
    for (const SeenTelegram& telegram : out.telegrams.first(std::min(load.size(), out.octets)))
      as_it_left.push_back(telegram.data);
    load = as_it_left;
  }
  SlaveModel& model = bench.model();
  model.answer(*in, load);
  if (model.is_right(out)) return;
  const AnswerDifference difference = model.difference(out, load.size());
  judge.fail(difference.reason, {.expected = {difference.expected},
                                 .actual = difference.actual,
                                 .time = bench.out().start_of(out.telegrams[0]),
                                 .first_difference = difference.place});
}

void expect_outputs(SlaveBench& bench, CaseJudge& judge, std::span<const std::uint16_t> words,
                    std::string_view reason) {
  if (!has_outputs(bench)) return;
  judge.expect(std::ranges::equal(bench.outputs(), words), reason, [&] {
    return Mismatch{.expected = {fmt::format("outputs {}", text_of(words))},
                    .actual = fmt::format("outputs {}", text_of(bench.outputs()))};
  });
}

void expect_no_change(SlaveBench& bench, CaseJudge& judge, std::string_view reason,
                      std::string_view why_not) {
  judge.expect(bench.changes().empty(), reason, [&] {
    const auto& change = bench.changes().front();
    return Mismatch{.expected = {fmt::format("no output changes: {}", why_not)},
                    .actual = change_text(change),
                    .time = change.when};
  });
}

void expect_rejected(SlaveBench& bench, CaseJudge& judge, std::size_t n) {
  const CycleOnLine out = cycle_that_left(bench, judge, n);
  const std::uint16_t marked = bench.rules().status_marked;
  judge.expect((out.status() & marked) == marked, "error_not_marked", [&] {
    return Mismatch{.expected = {fmt::format("status word {:04X}h, marked", marked)},
                    .actual = fmt::format("status word {:04X}h", out.status()),
                    .time = bench.out().start_of(out.telegrams[out.octets + 2]),
                    .first_difference = fmt::format("status word of cycle {}", n)};
  });
  expect_no_change(bench, judge, "output_changed_by_rejected_cycle", "the cycle does not pass its check");
}

void expect_good_cycle(SlaveBench& bench, CaseJudge& judge, std::string_view reason) {
  std::vector<std::uint16_t> words = bench.random_words();
  if (!words.empty()) words[0] = static_cast<std::uint16_t>(~bench.outputs()[0]);
  bench.data_cycle(words);
  const std::optional<CycleOnLine> out = bench.cycle_on(bench.out(), 0);
  judge.expect(out.has_value(), reason, "a clean cycle passes", "its telegrams did not pass");
  expect_outputs(bench, judge, words, reason);
  expect_clean_status(bench, judge, *out);
  bench.terminals().forget_changes();
}

void expect_clean_status(SlaveBench& bench, CaseJudge& judge, const CycleOnLine& out) {
  judge.expect(out.status() == bench.rules().status_clean, "status_word_wrong", [&] {
    return Mismatch{.expected = {"an accepted cycle leaves with a clean status word"},
                    .actual = fmt::format("status word {:04X}h", out.status()),
                    .time = bench.out().start_of(out.telegrams[out.octets + 2])};
  });
}

void expect_latched_in_order(SlaveBench& bench, CaseJudge& judge, std::span<const std::uint16_t> words) {
  if (!has_outputs(bench)) return;
  const auto& changes = bench.changes();
  const std::size_t per_cycle = bench.words();
  std::vector<std::uint16_t> held = bench.terminals().outputs();  // with those that lie ahead
  for (auto change = changes.rbegin(); change != changes.rend(); ++change)
    held[change->word] = change->before;
  std::size_t next = 0;
  for (std::size_t n = 0; n * per_cycle < words.size(); ++n) {
    const std::optional<CycleOnLine> in = bench.cycle_on(bench.in(), n);
    if (!in) judge.fail("telegram_lost", {{"the cycle arrives at the slave"}, "it did not"});
    const LatchWindow window = latch_window(bench, *in);
    const auto wanted = words.subspan(n * per_cycle, per_cycle);
    const auto shows = [&] { return std::ranges::equal(held, wanted); };
    for (; next < changes.size() && changes[next].when <= window.last; ++next) {
      const auto& change = changes[next];
      judge.expect(change.when >= window.first, "outputs_changed_before_check", [&] {
        return Mismatch{.expected = {fmt::format("outputs change at or after {}, the end of the check phase",
                                                 kernel::describe(window.first))},
                        .actual = change_text(change),
                        .time = change.when};
      });
      held[change.word] = change.after;
    }
    if (shows()) continue;
    const std::optional<CycleOnLine> following =
        (n + 1) * per_cycle < words.size() ? bench.cycle_on(bench.in(), n + 1) : std::nullopt;
    const kernel::Time until = following ? latch_window(bench, *following).first : kernel::kNever;
    std::vector<std::uint16_t> later = held;
    for (std::size_t k = next; k < changes.size() && changes[k].when < until; ++k)
      later[changes[k].word] = changes[k].after;
    const bool comes_late = std::ranges::equal(later, wanted);
    judge.fail(
        comes_late ? "outputs_latched_late" : "valid_cycle_rejected",
        {.expected = {fmt::format("outputs {} until {}", text_of(wanted), kernel::describe(window.last))},
         .actual = comes_late && next < changes.size() ? change_text(changes[next])
                                                       : fmt::format("outputs {}", text_of(held)),
         .time = window.last,
         .first_difference = fmt::format("data cycle {} of the train", n)});
  }
  judge.expect(next == changes.size(), "outputs_changed_without_cycle", [&] {
    return Mismatch{.expected = {"no output changes after the last cycle"},
                    .actual = change_text(changes[next]),
                    .time = changes[next].when};
  });
  bench.terminals().forget_changes();
}

void mark_in_front(SlaveBench& bench, const CyclePlace& cycle) {
  const auto flips = static_cast<std::uint16_t>(~bench.rules().status_clean & bench.rules().status_marked);
  bench.channel().on_next();
  for (unsigned bit = 0; bit < 16; ++bit) {
    if ((flips << bit & 0x8000) == 0) continue;
    bench.channel().flip(cycle.level_of(cycle.octets + 2 + bit / 8, bench.train().data_level(bit % 8)));
  }
}

std::uint16_t id_register(SlaveBench& bench, CaseJudge& judge) {
  return cycle_that_left(bench, judge, 0).word(0);
}

}  // namespace fieldproof::conformance
