#include "conformance/interbus/compared_master.hpp"

#include <fmt/format.h>

#include <utility>

#include "conformance/interbus/master_sequence.hpp"

namespace fieldproof::conformance::compared_master {

const SequenceVocabulary& words_of_master() {
  static const SequenceVocabulary words = without_settings(master_sequence_role().vocabulary);
  return words;
}

SequenceCommand order(MasterWord word, GivenNumbers given) {
  return simple_command(words_of_master(), static_cast<std::size_t>(word), given);
}
SequenceCommand cycles(std::int64_t count) {
  return order(MasterWord::cycles, {{0, count}});
}
SequenceCommand ring(std::int64_t number) {
  return order(MasterWord::power, {{0, number}, {1, 1}, {2, 1}});
}

namespace {

Sequence between(const MasterCommands& middle) {
  Sequence sequence;
  sequence.commands = {order(MasterWord::inputs, {{0, 0x0102}, {1, 0xFEFD}}),
                       order(MasterWord::outputs, {{0, 0x00FF}, {1, 0x5AA5}}), cycles(2)};
  sequence.commands.insert(sequence.commands.end(), middle.begin(), middle.end());
  for (const SequenceCommand& one :
       {cycles(1), order(MasterWord::inputs, {{0, 0xFF00}, {1, 0}}), order(MasterWord::outputs), cycles(3),
        order(MasterWord::identify), cycles(2), order(MasterWord::start), cycles(2)})
    sequence.commands.push_back(one);
  return sequence;
}

}  // namespace

MasterFamilies each_beside(MasterFamily family, std::size_t quick, ChangeRules change_rules) {
  const auto all = [family](kernel::Random) {
    std::vector<Sequence> sequences;
    for (const MasterCommands& middle : family()) sequences.push_back(between(middle));
    return sequences;
  };
  const auto run = [change_rules](const Sequence& sequence, MasterBench& bench, CaseJudge& judge) {
    run_master_sequence(sequence, bench, judge, change_rules);
  };
  return {{.all = all, .quick = quick, .full = kAllOfFamily, .run = run}};
}

MasterCase compared(std::string_view id, std::string stimulus, std::vector<MustCatch> catches,
                    MasterFamilies families) {
  MasterCase made{master_sequence_role().test_case, nullptr};
  made.families = std::move(families);
  made.test_case.id = fmt::format("interbus/master/compared/{}", id);
  made.test_case.purpose = "compared";
  made.test_case.stimulus = std::move(stimulus);
  made.test_case.tags = {"must"};
  made.test_case.catches = std::move(catches);
  return made;
}

}  // namespace fieldproof::conformance::compared_master
