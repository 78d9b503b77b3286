#include "conformance/answer_pairs.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "conformance/covering_array.hpp"
#include "conformance/runner.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

std::vector<judge::Pics::Answer> answers_to_try(const judge::PicsItem& item) {
  std::vector<judge::Pics::Answer> answers;
  if (item.kind == judge::PicsKind::truth) answers = {false, true};
  if (item.kind == judge::PicsKind::text) answers.assign(item.words.begin(), item.words.end());
  if (item.kind != judge::PicsKind::number && item.kind != judge::PicsKind::duration) return answers;
  for (const std::int64_t one : std::set{item.least, item.least + 1, item.most - 1, item.most}) {
    if (one < item.least || one > item.most) continue;
    if (item.kind == judge::PicsKind::number) answers.emplace_back(one);
    if (item.kind == judge::PicsKind::duration) answers.emplace_back(kernel::Duration{one});
  }
  return answers;
}

constexpr std::size_t kSequencesOfAnswers = 15;  // of each derived case: there are many declarations
// Of so many declarations one is asked derived cases, which draw their settings, too.
constexpr std::size_t kDeclarationsPerDerived = 3;

class RoleWithAnswers {
 public:
  RoleWithAnswers(const Suite& suite, const RoleRow& role, const PlaysDeclared& plays)
      : suite_(suite), name_(role.name), plays_(plays) {
    for (const TestCase& one : suite.cases())
      if (one.role() == role.name && !is_canary(one)) cases_.push_back(&one);
    for (const judge::PicsItem& item : role.pics_items) {
      auto answers = answers_to_try(item);
      if (!answers.empty()) items_.emplace_back(item.name, std::move(answers));
    }
  }

  std::vector<std::size_t> values() const {
    std::vector<std::size_t> counts;
    for (const auto& [name, answers] : items_) counts.push_back(answers.size());
    return counts;
  }

  // Whether each case can be run with this PICS.
  bool may_be(const ValueRow& row) const {
    try {
      for (const TestCase* one : cases_) suite_.check(*one, setup_of(row));
      return true;
    } catch (const kernel::Error& error) {
      if (error.kind() != kernel::ErrorKind::configuration) throw;
      return false;
    }
  }

  void run(const ValueRow& row, bool has_derived, AnswerPairs& pairs) const {
    for (const TestCase* one : cases_) {
      if (!has_derived && has_tag(*one, "derived")) continue;
      const judge::CaseResult result = run_case({&suite_, one}, setup_of(row)).outcome.result;
      if (result.verdict == judge::Verdict::inconclusive) pairs.left_open.insert(one->id);
      if (result.verdict >= judge::Verdict::fail)
        pairs.accused.push_back(fmt::format("{}: {} with {}", one->id, result.reason, text_of(row)));
    }
  }

 private:
  Setup setup_of(const ValueRow& row) const {
    Setup setup;
    setup.volume = Volume::quick;
    setup.sequences = kSequencesOfAnswers;
    setup.pics.emplace();
    for (std::size_t n = 0; n < row.size(); ++n)
      setup.pics->declare(items_[n].first, items_[n].second.at(row[n]));
    if (!plays_) return setup;
    if (auto who = plays_(name_, *setup.pics)) setup.implementations.push_back(std::move(*who));
    return setup;
  }

  std::string text_of(const ValueRow& row) const {
    std::string text;
    for (std::size_t n = 0; n < row.size(); ++n)
      text += fmt::format("{}{} {}", n == 0 ? "" : ", ", items_[n].first,
                          judge::answer_text(items_[n].second.at(row[n])));
    return text;
  }

  const Suite& suite_;
  std::string name_;
  const PlaysDeclared& plays_;
  std::vector<const TestCase*> cases_{};
  std::vector<std::pair<std::string, std::vector<judge::Pics::Answer>>> items_{};
};

}  // namespace

std::vector<AnswerPairs> pairs_of_answers(const Suite& suite, unsigned one_of,
                                          const PlayersOfAnswers& players) {
  std::vector<AnswerPairs> all;
  for (const RoleRow& row : suite.role_rows()) {
    if (row.name == players.left_out) continue;
    const RoleWithAnswers role(suite, row, players.plays);
    if (role.values().size() < 2) continue;
    const auto may_be = [&role](const ValueRow& values) { return role.may_be(values); };
    const CoveringArray array = covering_array(role.values(), may_be, kernel::Random(1));
    AnswerPairs& pairs = all.emplace_back(row.name, std::size_t{0}, array.pairs, array.left_out);
    for (std::size_t n = 0; n < array.rows.size(); n += one_of) {
      role.run(array.rows[n], n % kDeclarationsPerDerived == 0, pairs);
      ++pairs.declarations;
    }
  }
  return all;
}

}  // namespace fieldproof::conformance
