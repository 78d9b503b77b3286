#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <stop_token>
#include <system_error>
#include <vector>

#include "campaign/growth.hpp"
#include "cli/attachments.hpp"
#include "cli/case_file.hpp"
#include "cli/fuzz_document.hpp"
#include "cli/guarded_search.hpp"
#include "cli/run_setup.hpp"
#include "cli/searched_role.hpp"
#include "cli/sequence_corpus.hpp"
#include "cli/stored_document.hpp"
#include "cli/stored_sequence.hpp"
#include "cli/verbs.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence_octets.hpp"
#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/untrusted_text.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

// `fieldproof fuzz`: the sequences of `check`, mutated towards what the implementation has not passed yet;
// and one input of a fuzz target as a case.
namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

// The stored sequences of a search, and where those of the next one go.
struct CorpusOfCall {
  fs::path from;  // empty: none
  fs::path to;    // empty: nowhere
  SequenceCorpus stored;

  bool is_in_place() const { return from == to; }
};

CorpusOfCall corpus_of_call(Session& session, const SequenceFile& target) {
  const Settings& settings = session.settings;
  CorpusOfCall corpus;
  // Without a slash at the end a folder is the parent of its files.
  const auto folder = [&](std::string_view option) {
    const fs::path given = fs::path(settings.text(option)).lexically_normal();
    return given.has_filename() ? given : given.parent_path();
  };
  if (settings.is_set("corpus")) corpus.from = folder("corpus");
  corpus.to = settings.is_set("corpus-out") ? folder("corpus-out") : corpus.from;
  std::error_code failure;
  if (!corpus.from.empty() && !fs::is_directory(corpus.from, failure)) {
    if (!corpus.is_in_place() || fs::exists(corpus.from, failure))
      settings.refuse("corpus", fmt::format("there is no folder '{}'", corpus.from.string()));
  } else if (!corpus.from.empty()) {
    corpus.stored =
        read_corpus(corpus.from, *target.role, target.suite->vocabulary(*target.role, target.setup));
  }
  for (const LeftOutFile& one : corpus.stored.left_out)
    session.terminal.log(fmt::format("left out: {}", kernel::escaped_line(one.because)));
  if (!corpus.to.empty()) reports::check_writable(corpus.to / "new.json");
  return corpus;
}

std::uint64_t cases_of_call(const Settings& settings) {
  // With a limit in time there is none in number, unless it is given.
  if (settings.is_set("max-time") && settings.origin("cases") == Origin::fallback) return kMostSearched;
  return settings.number("cases", settings.is_set("corpus") ? 0 : 1, kMostSearched);
}

std::string found_in(const fuzz::SequenceFuzzResult& result, const CorpusOfCall& corpus) {
  if (!result.is_found_in_seed) return fmt::format("sequence {}", result.run + 1);
  return fmt::format("the stored sequence {}", corpus.stored.read.at(result.seeds_run).file.string());
}

void keep_corpus(Session& session, const SequenceFile& target, const CorpusOfCall& corpus,
                 const fuzz::SequenceFuzzResult& result) {
  if (corpus.to.empty()) return;
  write_corpus(corpus.to, result.corpus, corpus.is_in_place() ? corpus.stored : SequenceCorpus{},
               *target.role, target.suite->vocabulary(*target.role, target.setup));
  session.terminal.print(fmt::format(
      "{} of {} stored sequences run, {} left out; {} in {} now\n", result.seeds_run,
      corpus.stored.read.size(), corpus.stored.left_out.size(), result.corpus.size(), corpus.to.string()));
}

// How the implementation would report its coverage.
std::string how_to_be_guided(const conformance::Setup& setup) {
  constexpr std::string_view kCompile = "compiled with -fsanitize-coverage=trace-pc";
  const std::string uri = setup.implementations.empty() ? "" : setup.implementations.front().uri;
  if (is_in_process(uri)) return fmt::format("its library is not {}", kCompile);
  if (is_plugin_uri(uri)) {
    return fmt::format(
        "its library runs in a process of its own, where coverage is not seen; write {}?in-process, {}", uri,
        kCompile);
  }
  return fmt::format("that is seen of a library in this process alone: plugin:./library.so?in-process, {}",
                     kCompile);
}

// At powers of ten, the last of them, and at the end.
std::string growth_text(std::span<const fuzz::GrowthPoint> growth) {
  std::vector<campaign::JointGrowth> points;
  for (const fuzz::GrowthPoint& one : growth) points.push_back({one.run, one.run, one.edges});
  return campaign::text_of(points);
}

std::string fuzzed_text(const fuzz::SequenceFuzzResult& result, const conformance::Setup& setup,
                        const Interruption& interruption) {
  const std::string why = interruption.reason();
  std::string text = fmt::format("{} sequences without a finding; {} of them passed new edges",
                                 result.run + result.seeds_run, result.kept);
  if (!result.has_coverage) {
    text = fmt::format(
        "{} sequences without a finding; the implementation reports no coverage ({}), so they were drawn as "
        "check draws them",
        result.run + result.seeds_run, kernel::escaped_line(how_to_be_guided(setup)));
  }
  if (result.has_coverage && !result.growth.empty()) text += "; " + growth_text(result.growth);
  if (result.inconclusive > 0) text += fmt::format("; {} are inconclusive", result.inconclusive);
  if (is_silent(result)) text += kDroveNothing;
  return text + (why.empty() ? "" : "; " + why) + "\n";
}

fuzz::SequenceFuzzResult searched(Session& session, const SequenceFile& target, const CorpusOfCall& corpus,
                                  const Interruption& interruption, GuardedSearch* guard) {
  fuzz::SequenceFuzz search;
  search.suite = target.suite;
  search.role = target.role;
  search.setup = target.setup;
  search.seeds = corpus.stored.sequences();
  search.runs = cases_of_call(session.settings);
  search.stop = interruption.token();
  search.on_begin = [&](const fuzz::SequenceFuzzResult& before, std::span<const std::uint8_t> octets) {
    if (guard != nullptr) guard->begins(before, octets);
    session.terminal.progress(static_cast<std::size_t>(before.run));
  };
  if (guard != nullptr) {
    search.on_kept = [&](std::span<const std::uint8_t> octets) { guard->keeps(octets); };
    search.on_found = [&] { guard->has_found(); };
  }
  session.terminal.begin_progress(static_cast<std::size_t>(search.runs), "sequences");
  fuzz::SequenceFuzzResult result = fuzz::search(search);
  session.terminal.end_progress();
  return result;
}

// The number of sequences and the corpus say what to do now; without them the same would not be tried.
std::string options_of_the_moment(const Settings& settings) {
  std::string words;
  for (const char* name : {"cases", "corpus", "corpus-out"}) {
    if (settings.origin(name) == Origin::fallback) continue;
    words +=
        fmt::format("{}--{} {}", words.empty() ? "" : " ", name, reports::shell_quoted(settings.text(name)));
  }
  return words;
}

void keep_document(const Session& session, const SequenceFile& target, const CorpusOfCall& corpus,
                   const fuzz::SequenceFuzzResult& result, const FuzzEnd& end) {
  write_document(
      session, "fuzz",
      fuzz_json(result, target, implementations_json(target.setup.implementations), corpus.stored, end),
      options_of_the_moment(session.settings));
}

int search_role(Session& session, SequenceFile& target, const std::string& path, const CorpusOfCall& corpus,
                GuardedSearch* guard) {
  const Settings& settings = session.settings;
  const Interruption interruption(settings.duration("max-time"));
  const fuzz::SequenceFuzzResult result = searched(session, target, corpus, interruption, guard);
  keep_document(session, target, corpus, result,
                {result.found ? found_in(result, corpus) : "", replay_command(path), interruption.reason(),
                 interruption.signal() != 0});
  keep_corpus(session, target, corpus, result);
  if (result.found)
    return keep_found(session, target, path, *result.found, found_in(result, corpus), interruption);
  session.terminal.print(fuzzed_text(result, target.setup, interruption));
  if (interruption.signal() != 0) return kSignalBase + interruption.signal();
  // To make a corpus smaller is no search.
  const bool is_minimising = cases_of_call(settings) == 0 && result.seeds_run == 0;
  return is_minimising ? kAllAsExpected : code_of_search(result);
}

// What the library did to the search is a verdict where it has a process of its own. One that does it only
// after other sequences does not do it again there: then what was seen here is the finding.
conformance::SequenceFound found_by_its_end(const SequenceFile& target, const BrokenSearch& broken,
                                            const conformance::SequenceVocabulary& vocabulary,
                                            const std::stop_token& stop) {
  conformance::Sequence sequence = conformance::sequence_of_octets(broken.octets, vocabulary);
  auto found = conformance::shrink(*target.suite, *target.role, sequence, target.setup, stop);
  if (found) return std::move(*found);
  conformance::CaseJudge judge(target.role->test_case);
  judge::CaseResult seen = judge.run_procedure([&](conformance::CaseJudge&) {
    throw iut::Misbehaviour(broken.hangs ? iut::reasons::kHangs : iut::reasons::kCrashed,
                            "in the process of the search it " + broken.how);
  });
  return {sequence, sequence, {}, std::move(seen), 0, false};
}

// The kept sequences are not made fewer: their coverage went with the library.
int keep_broken(Session& session, SequenceFile& target, const std::string& path, const CorpusOfCall& corpus,
                const BrokenSearch& broken) {
  for (conformance::Assignment& one : target.setup.implementations) one.uri = in_own_process(one.uri);
  const auto vocabulary = target.suite->vocabulary(*target.role, target.setup);
  fuzz::SequenceFuzzResult result = broken.before;
  const std::vector<conformance::Sequence> seeds = corpus.stored.sequences();
  for (const auto& octets : broken.kept)
    result.corpus.push_back(conformance::sequence_of_octets(octets, vocabulary));
  result.corpus.insert(result.corpus.end(), seeds.begin() + static_cast<std::ptrdiff_t>(result.seeds_run),
                       seeds.end());
  result.is_found_in_seed = result.seeds_run < seeds.size();
  session.terminal.print(fmt::format("the library {} in {}; this one in a process of its own:\n", broken.how,
                                     found_in(result, corpus)));
  const Interruption interruption(std::nullopt);
  result.found = found_by_its_end(target, broken, vocabulary, interruption.token());
  keep_document(session, target, corpus, result, {found_in(result, corpus), replay_command(path), "", false});
  keep_corpus(session, target, corpus, result);
  return keep_found(session, target, path, *result.found, found_in(result, corpus), interruption);
}

bool is_in_this_process(const SequenceFile& target) {
  return std::ranges::any_of(target.setup.implementations, is_in_process, &conformance::Assignment::uri);
}

}  // namespace

int fuzz_role(Session& session) {
  SequenceFile target = searched_role(session);
  const std::string path = found_path(session, target);
  reports::check_writable(path);
  const Settings& settings = session.settings;
  if (settings.is_set("input")) return case_of_input(session, target, path);
  if (settings.is_set("json")) reports::check_writable(settings.text("json"));
  const CorpusOfCall corpus = corpus_of_call(session, target);
  session.terminal.print(reports::run_header(identity_of(session, target.setup, 1), manifest_of(session, 1)));
  if (!is_in_this_process(target)) return search_role(session, target, path, corpus, nullptr);
  GuardedSearch guard;
  const auto code = guard.run([&] { return search_role(session, target, path, corpus, &guard); });
  return code ? *code : keep_broken(session, target, path, corpus, guard.broken());
}

}  // namespace fieldproof::cli
