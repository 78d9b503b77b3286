#include "cli/run_book.hpp"

#include <algorithm>
#include <map>

#include "cli/case_file.hpp"
#include "reports/junit_writer.hpp"

namespace fieldproof::cli {
namespace {

reports::RunDirectory make_directory(const std::string& out, const reports::Manifest& manifest,
                                     const reports::RunIdentity& identity) {
  if (out.empty()) return reports::RunDirectory::create("runs", manifest, identity);
  return reports::RunDirectory::create_at(out, manifest, identity);
}

bool needs_case_file(judge::Verdict verdict) {
  return verdict != judge::Verdict::pass && verdict != judge::Verdict::not_applicable;
}

}  // namespace

RunBook::RunBook(const std::string& out, reports::Manifest manifest, reports::RunIdentity identity,
                 std::vector<conformance::Entry> selected, const std::string& configuration)
    : directory_(make_directory(out, manifest, identity)),
      manifest_(std::move(manifest)),
      run_{std::move(identity), {}},
      selected_(std::move(selected)),
      journal_(std::make_unique<judge::Journal>(directory_.journal())),
      begin_(std::chrono::steady_clock::now()) {
  directory_.write(kConfigurationFile, configuration);
}

RunBook::RunBook(reports::RunDirectory directory, std::unique_ptr<judge::Journal> journal,
                 reports::StoredRun stored, std::vector<conformance::Entry> selected)
    : directory_(std::move(directory)),
      manifest_(std::move(stored.manifest)),
      run_(std::move(stored.run)),
      selected_(std::move(selected)),
      journal_(std::move(journal)),
      begin_(std::chrono::steady_clock::now()) {}

std::vector<conformance::Entry> RunBook::open_cases() const {
  std::set<std::string> judged;
  for (const judge::CaseResult& result : run_.cases) judged.insert(result.id);
  std::vector<conformance::Entry> open;
  for (const conformance::Entry& entry : selected_) {
    if (!judged.contains(entry.test_case->id)) open.push_back(entry);
  }
  return open;
}

void RunBook::add(const conformance::CaseRun& done) {
  const judge::CaseResult& result = done.outcome.result;
  const bool has_recording =
      !done.outcome.recording.trace.records.empty() || done.outcome.recording.devices != nullptr;
  if (needs_case_file(result.verdict) || has_recording) store_case(directory_, done, run_.identity.seed);
  journal_->append(result);
  run_.cases.push_back(result);
}

void RunBook::hold_against(const Baseline& baseline) {
  for (judge::CaseResult& result : run_.cases) {
    result.expected_because.clear();
    baseline.mark(result);
  }
  run_.identity.stale_expectations = baseline.stale(run_);
}

void RunBook::sort_by_catalogue() {
  std::map<std::string, std::size_t> order;
  for (std::size_t i = 0; i < selected_.size(); ++i) order.emplace(selected_[i].test_case->id, i);
  std::stable_sort(
      run_.cases.begin(), run_.cases.end(),
      [&](const judge::CaseResult& a, const judge::CaseResult& b) { return order[a.id] < order[b.id]; });
}

void RunBook::close(const std::string& incomplete_because, int exit_code,
                    const reports::OutcomeRules& rules) {
  sort_by_catalogue();
  run_.identity.incomplete_because = incomplete_because;
  run_.identity.exit_code = exit_code;
  manifest_.finished = utc_now();
  const auto passed = std::chrono::steady_clock::now() - begin_;
  manifest_.wall_time_us +=
      static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(passed).count());
  directory_.store(manifest_, run_);
  reports::write_files(directory_.path() / "junit.xml", reports::junit_files(run_, manifest_, rules));
}

}  // namespace fieldproof::cli
