#include "cli/shards.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <utility>

#include "cli/copies.hpp"
#include "cli/exit_code.hpp"
#include "cli/run_book.hpp"
#include "cli/run_setup.hpp"
#include "cli/same_run.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::cli {
namespace {

struct Part {
  std::string directory;
  reports::PageRun run;
  Settings settings;  // those that it ran with
  bool has_no_configuration = false;

  const reports::RunIdentity& identity() const { return run.stored.run.identity; }
  std::string shard() const { return settings.text("shard"); }
};

[[noreturn]] void refuse(const Part& part, const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::configuration,
                      fmt::format("{}: {}", kernel::escaped_line(part.directory), sentence));
}

bool has_configuration(const reports::RunDirectory& run) {
  return std::filesystem::exists(run.path() / kConfigurationFile);
}

Settings settings_of(const reports::RunDirectory& run) {
  Settings settings({"run", {}, {}}, [](const std::string&) { return std::nullopt; });
  if (has_configuration(run)) settings.add_file(run.path() / kConfigurationFile, Origin::stored_run);
  return settings;
}

// Nothing else tells a part from a whole: what may be a part is not whole.
void say_that_it_may_be_a_part(const reports::RunDirectory& directory, reports::RunIdentity& identity) {
  if (has_configuration(directory) || !identity.incomplete_because.empty()) return;
  identity.incomplete_because =
      fmt::format("its {} is missing, so it may be only a part of a run (--shard); copy its whole directory",
                  kConfigurationFile);
}

Part read_part(const std::string& directory) {
  const auto opened = reports::RunDirectory::open(directory);
  Part part{directory, reports::page_run(opened), settings_of(opened), !has_configuration(opened)};
  say_that_it_may_be_a_part(opened, part.run.stored.run.identity);
  return part;
}

}  // namespace

void say_that_it_is_a_part(const std::string& directory, reports::RunIdentity& identity) {
  const auto opened = reports::RunDirectory::open(directory);
  say_that_it_may_be_a_part(opened, identity);
  const std::string shard = settings_of(opened).text("shard");
  if (shard.empty() || !identity.incomplete_because.empty()) return;
  identity.incomplete_because = fmt::format(
      "it is part {} of a run; name all parts, with --junit or another format, to join them", shard);
}

namespace {

// What of the configuration is no matter of RunIdentity: of files only whether there is one, because each
// part may have its own path to it.
std::string configured_otherwise(const Part& part, const Part& first) {
  for (const Option& option : options()) {
    if (!is_known_to(option, "run") || option.name == "shard") continue;
    if (!option.decides_outcome && !option.decides_exit_code) continue;
    const auto& here = part.settings.list(option.name);
    const auto& there = first.settings.list(option.name);
    const bool is_same = option.value_name == "FILE" ? here.size() == there.size() : here == there;
    if (!is_same)
      return fmt::format("--{} was '{}', not '{}'", option.name, fmt::join(here, " "), fmt::join(there, " "));
  }
  if (part.identity().selectors != first.identity().selectors) return "the selectors were others";
  return {};
}

void check_parts(const std::vector<Part>& parts) {
  const Part& first = parts.front();
  std::map<std::string, const Part*> shards;
  for (const Part& part : parts) {
    if (part.has_no_configuration) {
      refuse(part, fmt::format("{} is missing in it, so nobody knows which part of a run it is; copy its "
                               "whole directory",
                               kConfigurationFile));
    }
    if (part.shard().empty()) refuse(part, "this run is no part of a whole (--shard); name it alone");
    std::string sentence = difference(part.identity(), first.identity());
    if (sentence.empty()) sentence = configured_otherwise(part, first);
    if (!sentence.empty()) {
      refuse(part, fmt::format("this is no part of the same run as {}: {}",
                               kernel::escaped_line(first.directory), kernel::escaped_line(sentence)));
    }
    const auto [other, is_new] = shards.emplace(part.shard(), &part);
    if (!is_new) {
      refuse(part,
             fmt::format("this is part {}, and so is {}; leave one of the two",
                         kernel::escaped_line(part.shard()), kernel::escaped_line(other->second->directory)));
    }
  }
  const std::string count = first.shard().substr(first.shard().find('/') + 1);
  unsigned parts_in_all = 0;
  std::from_chars(count.data(), count.data() + count.size(), parts_in_all);
  for (const Part& part : parts) {
    if (!part.shard().ends_with("/" + count))
      refuse(part, fmt::format("this is part {}, and {} is part {}; cut a run once", part.shard(),
                               kernel::escaped_line(first.directory), first.shard()));
  }
  for (unsigned n = 1; n == 1 || n <= parts_in_all; ++n) {
    const std::string shard = fmt::format("{}/{}", n, count);
    if (shards.contains(shard)) continue;
    refuse(first, fmt::format("this is part {}, and part {} is missing", kernel::escaped_line(first.shard()),
                              kernel::escaped_line(shard)));
  }
  if (parts.size() == parts_in_all) return;
  refuse(first, fmt::format("there are {} parts of {}; name each once", parts.size(), parts_in_all));
}

// Each result at the place that its case has in the whole selection.
std::vector<judge::CaseResult> cases_in_order(const Session& session, const std::vector<Part>& parts) {
  const std::string now = suite_version(session.catalogue());
  const Part& first = parts.front();
  if (first.identity().suite_version != now) {
    refuse(first,
           fmt::format(
               "the suite was {}, and this program has {}; join the parts with the program that ran them",
               kernel::escaped_line(first.identity().suite_version), now));
  }
  const auto selected = session.catalogue().select(first.identity().selectors);
  std::map<std::string, std::size_t> places;
  for (const conformance::Entry& entry : selected) places.emplace(entry.test_case->id, places.size());
  std::map<std::size_t, judge::CaseResult> cases;
  for (const Part& part : parts) {
    const std::vector<conformance::Entry> own = shard_of(part.settings, selected);
    if (own.size() != part.identity().selected) {
      refuse(part, fmt::format("it selected {} cases, and its selectors select {} for part {} now",
                               part.identity().selected, own.size(), part.shard()));
    }
    for (const judge::CaseResult& result : part.run.stored.run.cases) {
      const auto is_it = [&](const conformance::Entry& entry) { return entry.test_case->id == result.id; };
      if (std::ranges::none_of(own, is_it)) {
        refuse(part,
               fmt::format("'{}' does not belong to part {}", kernel::escaped_line(result.id), part.shard()));
      }
      cases.emplace(places.at(result.id), result);
    }
  }
  std::vector<judge::CaseResult> ordered;
  for (auto& [place, result] : cases) ordered.push_back(std::move(result));
  return ordered;
}

// Of "baseline.json:12: ...": sentences come in the order of the file.
unsigned line_of(const std::string& sentence) {
  unsigned line = 0;
  const std::size_t colon = sentence.find(": ");
  const std::size_t begin = colon == std::string::npos ? colon : sentence.rfind(':', colon - 1);
  if (begin != std::string::npos)
    std::from_chars(sentence.data() + begin + 1, sentence.data() + sentence.size(), line);
  return line;
}

int exit_code_of(const reports::Run& run, const std::vector<Part>& parts) {
  ExitRules rules;
  rules.is_strict = parts.front().settings.is_set("strict");
  rules.allows_inconclusive = parts.front().settings.is_set("allow-inconclusive");
  rules.is_incomplete = !run.is_complete();
  rules.is_stale = !run.identity.stale_expectations.empty();
  for (const Part& part : parts) {
    const int code = part.identity().exit_code;
    const bool is_of_verdicts = code <= kNothingJudged;
    if (!is_of_verdicts && code < kSignalBase) return code;  // one could not go on
    if (code > kSignalBase) rules.signal = code - kSignalBase;
    rules.differs = rules.differs || (code == kDiffers && part.identity().stale_expectations.empty());
  }
  return exit_code(run, rules);
}

void join_identity(reports::RunIdentity& whole, const std::vector<Part>& parts) {
  whole.selected = 0;
  whole.incomplete_because.clear();
  whole.stale_expectations.clear();
  for (const Part& part : parts) {
    const reports::RunIdentity& own = part.identity();
    whole.selected += own.selected;
    whole.stale_expectations.insert(whole.stale_expectations.end(), own.stale_expectations.begin(),
                                    own.stale_expectations.end());
    if (own.incomplete_because.empty()) continue;
    whole.incomplete_because += fmt::format("{}part {}: {}", whole.incomplete_because.empty() ? "" : "; ",
                                            part.shard(), own.incomplete_because);
  }
  std::ranges::stable_sort(whole.stale_expectations, {}, line_of);
}

// From the first begin to the last end.
void join_manifest(reports::Manifest& whole, const std::vector<Part>& parts) {
  whole.wall_time_us = 0;
  for (const Part& part : parts) {
    const reports::Manifest& own = part.run.stored.manifest;
    whole.started = std::min(whole.started, own.started);
    whole.finished =
        own.finished.empty() || whole.finished.empty() ? "" : std::max(whole.finished, own.finished);
    whole.wall_time_us += own.wall_time_us;
  }
}

}  // namespace

JoinedRun joined(const Session& session, const std::vector<std::string>& directories) {
  std::vector<Part> parts;
  for (const std::string& directory : directories) parts.push_back(read_part(directory));
  const reports::OutcomeRules rules = outcome_rules(parts.front().settings);
  if (parts.size() == 1 && parts.front().shard().empty()) return {std::move(parts.front().run), rules};
  check_parts(parts);
  const auto number_of = [](const Part& part) { return std::stoul(part.shard()); };
  std::ranges::sort(parts, {}, number_of);
  reports::PageRun whole = parts.front().run;
  std::vector<std::string> names;
  for (const Part& part : parts) names.push_back(part.run.name);
  whole.name = fmt::format("{}", fmt::join(names, ", "));
  whole.stored.run.cases = cases_in_order(session, parts);
  for (Part& part : parts) {
    whole.timelines.merge(part.run.timelines);
    whole.files.merge(part.run.files);
  }
  join_identity(whole.stored.run.identity, parts);
  join_manifest(whole.stored.manifest, parts);
  whole.stored.run.identity.exit_code = exit_code_of(whole.stored.run, parts);
  return {std::move(whole), rules};
}

}  // namespace fieldproof::cli
