#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/sequence_check.hpp"
#include "conformance/sequence_draw.hpp"
#include "harness/kernel/sanitized.hpp"

// For tests: what must hold of the sequences of each role of the data link.
namespace fieldproof::conformance {

class SequenceChecks {
 public:
  SequenceChecks(std::string role, const SequenceRole& sequences)
      : role_(std::move(role)), sequences_(sequences) {}

  // In several seeds, and by all of them: a sequence that nobody can judge shows nothing.
  void expect_reference_follows(std::uint64_t wanted) const {
    const std::uint64_t cases = fewer_if_slow(wanted);
    for (kernel::FewerIfSanitized few(3); const std::uint64_t seed : {1U, 2U, 3U}) {
      if (few.leaves_out()) continue;
      SequenceSearch one = search_of("ref", cases);
      one.setup.seed = seed;
      const SequenceSearchResult result = search(one);
      EXPECT_EQ(result.passed, cases) << seed << "\n" << told(result);
    }
  }

  // Each mutant station that is for `check`, confirmed, and with at most so many commands.
  void expect_finds_each(std::size_t count, std::uint64_t cases, std::size_t most_commands) const {
    ASSERT_EQ(for_check().size(), count);
    for (kernel::FewerIfSanitized few(kOneOf); const std::string& name : for_check()) {
      if (few.leaves_out()) continue;
      const SequenceSearchResult result = search(search_of("mutant:" + name, cases));
      ASSERT_TRUE(result.found) << name;
      EXPECT_TRUE(result.found->is_confirmed) << name;
      EXPECT_LE(result.found->smallest.commands.size(), most_commands) << name << "\n" << told(result);
      const Sequence& smallest = result.found->smallest;
      EXPECT_TRUE(smallest.commands.size() >= 2 || !smallest.settings.empty()) << name << "\n"
                                                                               << told(result);
    }
  }

  // What cases of the catalogue name is found, too, but for what lies outside of the sequences.
  void expect_finds_all_but(const std::set<std::string>& outside, std::uint64_t cases) const {
    std::vector<std::string> catalogue;
    for (const Mutant& one : suite().mutants()) {
      if (one.role == role_ && !one.is_for_check) catalogue.push_back(one.name);
    }
    for (kernel::FewerIfSanitized few(2 * kOneOf); const std::string& name : catalogue) {
      if (few.leaves_out()) continue;
      // Who is outside passes whatever their number.
      const bool is_outside = outside.contains(name);
      const bool is_found =
          search(search_of("mutant:" + name, is_outside ? cases / 10 : cases)).found.has_value();
      EXPECT_EQ(is_found, !is_outside) << name;
    }
  }

  void expect_single_commands_pass(std::size_t count) const {
    const SequenceSource source(sequences_.vocabulary, kFixedSeed);
    std::vector<Sequence> single;
    for (std::uint64_t n = 0; single.size() < fewer_if_slow(count); ++n) {
      for (const SequenceCommand& command : source.draw(n).commands) single.push_back({{command}});
    }
    for (const std::string& name : for_check()) {
      const Setup setup = search_of("mutant:" + name, 1).setup;
      for (const Sequence& sequence : single) {
        const Outcome outcome = run_sequence(suite(), sequences_, sequence, setup);
        EXPECT_EQ(outcome.result.verdict, judge::Verdict::pass) << name << "\n" << lines(sequence);
      }
    }
  }

 private:
  static constexpr std::uint64_t kFixedSeed = 1;

  static std::uint64_t fewer_if_slow(std::uint64_t count) {
    return kernel::kIsSanitized ? count / 10 : count;
  }
  // What a sanitizer looks for does not depend on who plays.
  static constexpr unsigned kOneOf = 8;

  static const Suite& suite() {
    static const std::unique_ptr<Suite> one = fieldbus_dll_suite();
    return *one;
  }

  SequenceSearch search_of(const std::string& uri, std::uint64_t cases) const {
    SequenceSearch one;
    one.suite = &suite();
    one.role = &sequences_;
    one.setup.seed = kFixedSeed;
    one.setup.implementations = {{role_, 0, uri}};
    one.cases = cases;
    return one;
  }

  std::vector<std::string> for_check() const {
    std::vector<std::string> names;
    for (const Mutant& mutant : suite().mutants()) {
      if (mutant.is_for_check && mutant.role == role_) names.push_back(mutant.name);
    }
    return names;
  }

  std::string lines(const Sequence& sequence) const {
    std::string text;
    for (const std::string& line : sequence_lines(sequence, sequences_.vocabulary)) text += line + "\n";
    return text;
  }
  std::string told(const SequenceSearchResult& result) const {
    if (!result.found) return "";
    const judge::CaseResult& first = result.found->outcome.result;
    return first.reason + "\n" + lines(result.found->smallest);
  }

  std::string role_;
  const SequenceRole& sequences_;
};

}  // namespace fieldproof::conformance
