#pragma once

#include <vector>

#include "conformance/interbus/slave_words.hpp"
#include "conformance/sequence.hpp"

// Families of sequences for a slave: each is about one class of what may happen to it. Whoever runs one puts
// it between a beginning and what shows the state that it left.
namespace fieldproof::conformance::slave_families {

using Commands = std::vector<SequenceCommand>;

const SequenceVocabulary& vocabulary();
SequenceCommand command(SlaveWord word, GivenNumbers given = {});
// An ID cycle with these orders.
SequenceCommand id(std::int64_t orders);
// Two data telegrams come back after OUT1, or OUT2.
SequenceCommand returns(bool on_branch);

std::vector<Commands> each_value();
std::vector<Commands> each_fault_of_a_data_cycle();
std::vector<Commands> each_fault_of_an_id_cycle();
std::vector<Commands> two_faults_of_a_data_cycle();
std::vector<Commands> one_after_another();
std::vector<Commands> around_a_reset();
std::vector<Commands> silence_after_a_long_life();
std::vector<Commands> within_a_cycle();
std::vector<Commands> within_a_reset();
std::vector<Commands> rare_orders();
std::vector<Commands> each_header_keeps_alive();
std::vector<Commands> many_errors();
std::vector<Commands> at_the_end_of_a_reset();
std::vector<Commands> many_cycles();
std::vector<Commands> stop_missing_after_a_cut();
std::vector<Commands> data_after_many_id_cycles();
std::vector<Commands> all_codings();
std::vector<Commands> edges_at_both_limits();
std::vector<Commands> each_cut();
std::vector<Commands> other_cuts();
std::vector<Commands> other_glitches();
std::vector<Commands> returned_edges_at_both_limits();
std::vector<Commands> clock_at_the_inputs();
std::vector<Commands> other_signs_of_life();

}  // namespace fieldproof::conformance::slave_families
