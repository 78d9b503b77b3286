#include "cli/run_setup.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <ctime>
#include <limits>

#include "cli/build_info.hpp"
#include "cli/implementations.hpp"
#include "cli/input_files.hpp"
#include "cli/pics_file.hpp"
#include "cli/pics_roles.hpp"
#include "harness/kernel/host_name.hpp"
#include "reports/run_directory.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::cli {
namespace {

constexpr std::uint64_t kMostJobs = 1024;
constexpr std::chrono::milliseconds kLongestVirtualTime{3'600'000};

// FNV-1a, 64 bit.
class Hash {
 public:
  void add(std::string_view text) {
    for (const char c : text) value_ = (value_ ^ static_cast<unsigned char>(c)) * 0x100000001B3;
    value_ = (value_ ^ 0xFF) * 0x100000001B3;  // "a", "bc" is not "ab", "c"
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325;
};

}  // namespace

conformance::Setup setup_from(const Settings& settings, const conformance::Catalogue& catalogue,
                              std::span<const conformance::Entry> selected) {
  conformance::Setup setup;
  setup.seed = settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
  setup.volume = settings.choice("volume") == 0 ? conformance::Volume::quick : conformance::Volume::full;
  setup.network_file = settings.text("network");
  setup.plan_file = settings.text("faults");
  if (settings.is_set("pics")) {
    setup.pics = load_pics(settings.text("pics"), catalogue.pics_items());
    expect_items_of(roles_of(selected), *setup.pics, settings.text("pics"), catalogue);
  }
  setup.limits = limits_from(settings);
  setup.implementations = parse_implementations(settings.list("iut"), catalogue, selected);
  expect_parts(setup.implementations, selected);
  conformance::check_setup(selected, setup);
  return setup;
}

iut::PeerLimits limits_from(const Settings& settings) {
  iut::PeerLimits limits;
  limits.call = settings.duration("call-limit").value();
  limits.whole_case = settings.duration("case-limit").value();
  return limits;
}

std::vector<std::string> roles_of(std::span<const conformance::Entry> selected) {
  std::vector<std::string> roles;
  for (const conformance::Entry& entry : selected) {
    std::string path = fmt::format("{}/{}", entry.suite->protocol(), entry.test_case->role());
    if (std::ranges::find(roles, path) == roles.end()) roles.push_back(std::move(path));
  }
  return roles;
}

unsigned jobs_from(const Settings& settings) {
  return static_cast<unsigned>(settings.number("jobs", 1, kMostJobs));
}

std::vector<conformance::Entry> shard_of(const Settings& settings, std::vector<conformance::Entry> selected) {
  if (!settings.is_set("shard")) return selected;
  const std::string written = settings.text("shard");
  unsigned number = 0;
  unsigned count = 0;
  const char* const last = written.data() + written.size();
  const auto [slash, first_failure] = std::from_chars(written.data(), last, number);
  bool is_good = first_failure == std::errc{} && slash != last && *slash == '/';
  if (is_good) {
    const auto [end, failure] = std::from_chars(slash + 1, last, count);
    is_good = failure == std::errc{} && end == last && number >= 1 && number <= count;
  }
  if (!is_good) {
    settings.refuse("shard", fmt::format("'{}' is no part of a selection; write for example 2/4", written));
  }
  std::vector<conformance::Entry> shard;
  for (std::size_t at = number - 1; at < selected.size(); at += count) shard.push_back(selected[at]);
  return shard;
}

std::string suite_version(const conformance::Catalogue& catalogue) {
  Hash hash;
  for (const conformance::Entry& entry : catalogue.entries()) {
    const conformance::TestCase& test_case = *entry.test_case;
    const judge::Reference rests_on = test_case.rests_on();
    for (const std::string* text :
         {&test_case.id, &test_case.purpose, &test_case.requirement, &test_case.stimulus, &test_case.expected,
          &rests_on.source, &rests_on.clause}) {
      hash.add(*text);
    }
    for (const conformance::MustCatch& caught : test_case.catches)
      hash.add(caught.mutant + "=" + caught.reason);
  }
  for (const conformance::MutantEntry& mutant : catalogue.mutants()) hash.add(mutant.path());
  return fmt::format("{}+{:08x}", tool_version(),
                     static_cast<std::uint32_t>(hash.value() ^ (hash.value() >> 32)));
}

std::string file_hash(const std::string& file) {
  if (file.empty()) return {};
  return judge::hash_of(reports::read_text_file(file));
}

reports::RunIdentity identity_of(const Session& session, const conformance::Setup& setup,
                                 std::size_t selected) {
  reports::RunIdentity identity;
  identity.tool_version = tool_version();
  identity.suite_version = suite_version(session.catalogue());
  identity.seed = setup.seed;
  identity.volume = conformance::name(setup.volume);
  identity.plan_hash = file_hash(setup.plan_file);
  identity.network_hash = file_hash(setup.network_file);
  if (setup.pics) identity.pics_hash = judge::hash_of(pics_text(*setup.pics));
  for (const auto& suite : session.catalogue().suites()) {
    for (std::string& caveat : suite->caveats(setup)) {
      if (std::ranges::find(identity.caveats, caveat) == identity.caveats.end())
        identity.caveats.push_back(std::move(caveat));
    }
    // One file for all suites: any of them names its parts.
    if (identity.plan.empty()) identity.plan = suite->plan_parts(setup);
  }
  identity.selectors = session.operands;
  for (const conformance::Assignment& assignment : setup.implementations) {
    identity.implementations.push_back({assignment.role, assignment.position, assignment.uri});
  }
  identity.inputs = input_files_of(session);
  identity.reproduce_options = session.settings.reproduce_options();
  identity.selected = selected;
  return identity;
}

reports::Manifest manifest_of(const Session& session, unsigned jobs) {
  reports::Manifest manifest;
  manifest.build_type = build_type();
  manifest.compiler = compiler();
  manifest.host = kernel::host_name();
  manifest.arguments = session.arguments;
  manifest.started = utc_now();
  manifest.jobs = jobs;
  return manifest;
}

std::string simulation_header(const Session& session, std::uint64_t seed, const std::string& network_file,
                              std::string_view own_network) {
  conformance::Setup setup;
  setup.seed = seed;
  setup.network_file = network_file;
  reports::RunIdentity identity = identity_of(session, setup, 0);
  if (network_file.empty()) identity.network_hash = own_network;
  return reports::run_header(identity, manifest_of(session, 1));
}

kernel::Duration virtual_time_from(const Settings& settings) {
  const auto duration = settings.duration("duration");
  if (!duration || *duration > kLongestVirtualTime) {
    settings.refuse("duration", fmt::format("'{}' is no time of 1 ms to 1 h; write for example 60s",
                                            settings.text("duration")));
  }
  return duration->count() * kernel::kMillisecond;
}

std::string utc_text(std::time_t when) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(when));
}

std::string utc_now() {
  return utc_text(std::time(nullptr));
}

}  // namespace fieldproof::cli
