#include "reports/document_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "reports/campaign_content.hpp"
#include "reports/detection_verdict.hpp"

namespace fieldproof::reports {

std::string several(std::size_t count, std::string_view one) {
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

void add_words(std::string& sentence, const std::string& words, std::string_view between) {
  if (!sentence.empty() && !words.empty()) sentence += between;
  sentence += words;
}

namespace {

using judge::Verdict;
using Document = nlohmann::json;

bool works_again(const Document& test) {
  return test.at("recovered_by_itself").get<bool>() || test.at("recovered_after_start").get<bool>();
}

// Without it there is nothing that the count could refute.
bool has_theory(const Document& channel) {
  return std::ranges::any_of(channel.items(),
                             [](const auto& item) { return item.key().starts_with("undetected_by_"); });
}

template <typename IsSo>
std::size_t tests_that(const Document& tests, IsSo&& is_so) {
  return static_cast<std::size_t>(std::ranges::count_if(tests, std::forward<IsSo>(is_so)));
}

// One that crashed or hung has accepted nothing wrong: its D is another one.
bool has_gone(const Document& test) {
  return test.at("came_up") == true && !test.value("complaint", std::string()).empty();
}

// The tests under bursts: a bus that stopped is said before anything else.
void judge_bursts(const Document& tests, char worst_allowed, Said& said) {
  const auto has_criterion = [&](char criterion) {
    return tests_that(tests, [criterion](const Document& test) {
      return test.at("came_up") == true && test.at("criterion") == std::string(1, criterion);
    });
  };
  const auto add = [&](std::size_t count, Verdict verdict, const std::string& words) {
    if (count == 0) return;
    said.verdict = std::max(said.verdict, verdict);
    add_words(said.sentence,
              fmt::format("{} in {} of {}", words, count, several(tests.size(), "burst test")));
  };
  if (!tests.empty()) said.verdict = std::max(said.verdict, Verdict::pass);
  const auto beyond = [worst_allowed](char criterion) {
    return criterion > worst_allowed ? Verdict::fail : Verdict::warn;
  };
  // A stop is a C at least.
  add(tests_that(tests, [](const Document& test) { return test.at("bus_stops") > 0; }), beyond('C'),
      "the bus stopped");
  add(tests_that(tests, has_gone), beyond('D'), "an implementation crashed, hung or broke its contract");
  add(tests_that(tests,
                 [](const Document& test) {
                   return test.at("came_up") == true && test.at("criterion") == "D" && !has_gone(test);
                 }),
      beyond('D'), "criterion D");
  add(has_criterion('C'), beyond('C'), "criterion C");
  if (worst_allowed < 'B') add(has_criterion('B'), Verdict::fail, "criterion B");
  add(tests_that(tests, [](const Document& test) { return test.at("came_up") == false; }),
      Verdict::inconclusive, "the network did not come up");
  add(tests_that(tests,
                 [](const Document& test) {
                   return test.at("came_up") == true && test.at("evidence").at("text") == "" &&
                          !has_gone(test);
                 }),
      Verdict::inconclusive, "no burst met a receiver");
  if (said.sentence.empty()) add(has_criterion('B'), Verdict::warn, "criterion B at worst,");
}

void judge_channels(const Document& channels, Said& said) {
  constexpr double kRefuted = 1e-3;
  constexpr std::uint64_t kFewExchanges = 100;
  if (!channels.empty()) said.verdict = std::max(said.verdict, Verdict::pass);
  const auto add = [&](std::size_t count, Verdict verdict, const std::string& words) {
    if (count == 0) return;
    said.verdict = std::max(said.verdict, verdict);
    add_words(said.sentence,
              fmt::format("{} on {} of {}", words, count, several(channels.size(), "channel")));
  };
  add(tests_that(channels, has_gone), Verdict::fail, "an implementation crashed, hung or broke its contract");
  add(tests_that(channels, [](const Document& test) { return test.at("bus_stops") > 0; }), Verdict::fail,
      "the bus stopped");
  add(tests_that(channels,
                 [](const Document& test) {
                   return !has_gone(test) &&
                          (test.at("came_up") == false || test.at("ledger").at("sent") < kFewExchanges ||
                           !has_theory(test));
                 }),
      Verdict::inconclusive, "too little to tell");
  const std::size_t refuted = tests_that(channels, [](const Document& test) {
    return test.at("came_up") == true && !has_gone(test) &&
           ((has_theory(test) && test.at("chance_of_count") < kRefuted) || !works_again(test));
  });
  if (refuted == 0) return;
  said.verdict = Verdict::fail;
  add_words(said.sentence, fmt::format("it went worse than the theory of the frame check allows in {} of {}",
                                       refuted, several(channels.size(), "channel")));
}

Said said_by_emc(const Document& document) {
  Said said;
  judge_bursts(document.at("tests"), document.value("worst_allowed", std::string("B")).front(), said);
  judge_channels(document.at("channels"), said);
  const bool is_whole = document.at("is_complete").get<bool>() && said.verdict != Verdict::none;
  if (!is_whole) {
    said.verdict = std::max(said.verdict, Verdict::inconclusive);
    add_words(said.sentence, "the campaign under bursts is incomplete");
  }
  if (said.sentence.empty()) {
    const std::size_t tests = document.at("tests").size();
    said.sentence = tests > 0 ? fmt::format("criterion A in {}", several(tests, "burst test"))
                              : fmt::format("no more wrong words than theory lets pass on {}",
                                            several(document.at("channels").size(), "channel"));
  }
  return said;
}

Said said_by_measurement(const Document& document) {
  if (const Document failures = document.value("failures", Document::array()); !failures.empty()) {
    return {Verdict::fail, fmt::format("the measurement failed: {}", failures.at(0).get<std::string>())};
  }
  std::size_t compared = 0;
  std::size_t differs = 0;
  for (const Document& series : document.at("series")) {
    for (const Document& one : series.at("comparisons")) {
      ++compared;
      differs += one.at("agreement") == "differs" ? 1U : 0U;
    }
  }
  const std::string of = fmt::format("of {}", several(compared, "comparison"));
  if (document.at("agreement") == "holds") return {Verdict::pass, "the measurement agrees with the theory"};
  const auto is_quiet = [](const Document& one) { return one.value("phase", "quiet") == "quiet"; };
  const auto has_quiet = [&](const Document& series) {
    return std::ranges::any_of(series.at("comparisons"), is_quiet);
  };
  if (std::ranges::none_of(document.at("series"), has_quiet))
    return {Verdict::inconclusive,
            "nothing was measured while the network was quiet, so no theory was tested"};
  if (document.at("agreement") == "open") {
    return {
        Verdict::inconclusive,
        document.contains("implementations")
            ? "the measurement leaves open whether it agrees with the theory of reference stations: too few "
              "samples, or the implementation is faster or slower than they are, which may be right"
            : "too few samples tell whether the measurement agrees with the theory"};
  }
  if (document.contains("implementations")) {
    return {Verdict::inconclusive,
            fmt::format(
                "the measurement differs in {} {} from the theory of reference stations, which may be right "
                "for others",
                differs, of)};
  }
  return {Verdict::fail, fmt::format("the measurement differs from the theory in {} {}", differs, of)};
}

Said said_by_matrix(const Document& document) {
  Said said{Verdict::pass, "every mutant is caught"};
  const Document& holes = document.at("holes");
  if (!holes.empty()) {
    const std::size_t survivors =
        tests_that(holes, [](const Document& hole) { return hole.at("kind") == "surviving-mutant"; });
    said = {Verdict::fail,
            survivors == 0 ? "" : several(survivors, "mutant") + (survivors == 1 ? " survives" : " survive")};
    if (const std::size_t others = holes.size() - survivors; others > 0) {
      add_words(said.sentence,
                fmt::format("the matrix has {}", several(others, survivors > 0 ? "other hole" : "hole")));
    }
  }
  if (document.at("complete") == false) {
    said = {std::max(said.verdict, Verdict::inconclusive),
            holes.empty() ? "the matrix is incomplete" : said.sentence + ", the matrix is incomplete"};
  }
  return said;
}

Said said_by_publication(const Document& document) {
  const Document& rows = document.at("rows");
  const auto differs = rows.at("DIFFERS").get<std::size_t>();
  const auto open = rows.at("inconclusive").get<std::size_t>();
  const auto compared =
      rows.at("agrees").get<std::size_t>() + rows.at("own").get<std::size_t>() + differs + open;
  const std::string of = fmt::format("of {}", several(compared, "compared row"));
  if (differs > 0)
    return {Verdict::fail,
            fmt::format("{} {} of a publication {}", differs, of, differs == 1 ? "differs" : "differ")};
  if (open > 0)
    return {Verdict::inconclusive, fmt::format("{} {} of a publication cannot be told", open, of)};
  if (compared == 0) return {Verdict::inconclusive, "no row of a publication is compared"};
  return {Verdict::pass, "a publication is reproduced"};
}

// Counts of a laboratory against the burst model.
Said said_by_fit(const Document& document) {
  const auto rows = document.at("rows").size();
  const std::string counts = fmt::format("the counts of {}", several(rows, "condition"));
  if (document.at("verdict") == "consistent")
    return {Verdict::pass, fmt::format("{} follow the burst model", counts)};
  if (document.at("verdict") == "contradicts")
    return {Verdict::fail, fmt::format("{} contradict the burst model", counts)};
  return {Verdict::inconclusive, fmt::format("{} are too few to put the burst model to the test", counts)};
}

// What a search of `fuzz` comes to, as its exit code: what cannot be repeated, or was not tried, is no pass.
Said said_by_fuzz(const Document& document) {
  const auto role = document.at("role").get<std::string>();
  const auto run = document.at("run").get<std::size_t>() + document.at("stored").at("run").get<std::size_t>();
  const std::string tried = fmt::format("{} of fuzzing {}", several(run, "sequence"), role);
  if (const auto found = document.find("found"); found != document.end()) {
    const std::string reason = found->value("reason", "a failure");
    if (found->at("is_confirmed") == true) {
      const auto where = found->at("found_in").get<std::string>();
      return {Verdict::fail, fmt::format("fuzzing {} found {} in {}", role, reason, where)};
    }
    return {Verdict::inconclusive, fmt::format("fuzzing {} found {} once and not again", role, reason)};
  }
  if (document.value("is_interrupted", false))
    return {Verdict::inconclusive, fmt::format("the search was interrupted after {}", tried)};
  const auto passed = document.at("passed").get<std::size_t>();
  if (passed == 0) return {Verdict::inconclusive, fmt::format("none of {} was judged", tried)};
  if (document.at("silent").get<std::size_t>() == passed)
    return {Verdict::inconclusive, fmt::format("the implementation drove nothing in {}", tried)};
  if (const auto open = document.at("inconclusive").get<std::size_t>(); open > 0)
    return {Verdict::inconclusive, fmt::format("{} of {} could not be told; none failed", open, tried)};
  return {Verdict::pass, fmt::format("no finding in {}{}", tried,
                                     document.at("has_coverage") == true ? "" : ", without coverage")};
}

}  // namespace

Said said_by_document(const Document& document) {
  const auto schema = document.at("schema").get<std::string>();
  if (schema.starts_with("fieldproof/campaign/")) return said_by_campaign(document);
  if (schema.starts_with("fieldproof/emc_fit/")) return said_by_fit(document);
  if (schema.starts_with("fieldproof/emc/")) return said_by_emc(document);
  if (schema.starts_with("fieldproof/measurement/")) return said_by_measurement(document);
  if (schema.starts_with("fieldproof/fuzz/")) return said_by_fuzz(document);
  if (schema.starts_with("fieldproof/detection/")) return said_by_detection(document);
  if (schema.starts_with("fieldproof/matrix/")) return said_by_matrix(document);
  if (schema.starts_with("fieldproof/publication/")) return said_by_publication(document);
  return {Verdict::none, "holds numbers and no verdict"};
}

}  // namespace fieldproof::reports
