#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/interbus/slave_bench.hpp"
#include "conformance/judging.hpp"

// What the cases for a slave require again and again, each with its reason codes.
namespace fieldproof::conformance {

// The words as the slave would hold them from these transfer octets: the last ones.
std::vector<std::uint16_t> words_held(std::span<const SeenTelegram> transfer, unsigned words);
std::string text_of(std::span<const std::uint16_t> words);

// Whether a found cycle is a data cycle that a right slave takes over: its check fits and its status word is
// clean. Faults in headers can, by chance, leave such a cycle of other octets.
bool is_right_data_cycle(SlaveBench& bench, const FoundCycle& found);

// Whether a cycle left since the views were cleared, and the last one with a clean status word.
bool left_clean(SlaveBench& bench);

// As many data telegrams left as arrived; `telegram_lost`, `telegram_added`.
void expect_all_telegrams(SlaveBench& bench, CaseJudge& judge);

// Cycle n of the last train, as it left. It did: else `telegram_lost`.
CycleOnLine cycle_that_left(SlaveBench& bench, CaseJudge& judge, std::size_t n);

// Each status telegram that arrived left, as it came; `status_telegram_lost`, `status_telegram_changed`.
void expect_status_telegrams(SlaveBench& bench, CaseJudge& judge);

// Cycle n of the last train left as a right slave with this register sends it; the reasons of the model.
// What the register of a slave without inputs carries in a data cycle is not judged.
void expect_answer(SlaveBench& bench, CaseJudge& judge, std::size_t n, std::span<const std::uint8_t> load);

// The outputs have these values now. Holds for a slave without outputs.
void expect_outputs(SlaveBench& bench, CaseJudge& judge, std::span<const std::uint16_t> words,
                    std::string_view reason);
// No output has changed since the changes were last forgotten.
void expect_no_change(SlaveBench& bench, CaseJudge& judge, std::string_view reason, std::string_view why_not);
// Cycle n was rejected: left marked, no output has changed (`output_changed_by_rejected_cycle`).
void expect_rejected(SlaveBench& bench, CaseJudge& judge, std::size_t n);
// Sends a clean cycle with words that differ from the outputs in each bit of one word, and requires its
// words at the outputs (`reason`) and a clean status word (`status_word_wrong`).
void expect_good_cycle(SlaveBench& bench, CaseJudge& judge, std::string_view reason);
void expect_clean_status(SlaveBench& bench, CaseJudge& judge, const CycleOnLine& out);

// The data cycles of the last train were each latched, in order and in time; `words` are theirs, one after
// the other. `valid_cycle_rejected`, `outputs_changed_before_check`, `outputs_latched_late`. Forgets changes.
void expect_latched_in_order(SlaveBench& bench, CaseJudge& judge, std::span<const std::uint16_t> words);

// Lets the status word of a cycle of the train arrive as a station in front of the slave marks it.
void mark_in_front(SlaveBench& bench, const CyclePlace& cycle);

// The ID register that came back in the last ID cycle.
std::uint16_t id_register(SlaveBench& bench, CaseJudge& judge);

}  // namespace fieldproof::conformance
