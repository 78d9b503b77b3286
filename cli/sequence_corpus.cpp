#include "cli/sequence_corpus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <system_error>

#include <nlohmann/json.hpp>

#include "campaign/job.hpp"
#include "cli/sequence_file.hpp"
#include "harness/config/document.hpp"
#include "harness/kernel/error.hpp"
#include "reports/run_directory.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t kMostStored = 100'000;

std::string corpus_text(const conformance::Sequence& sequence, const conformance::SequenceRole& role,
                        const conformance::SequenceVocabulary& vocabulary) {
  ordered_json json = {{"schema", kCorpusSchema}, {"role", role_path(role)}};
  json.update(ordered_json::parse(conformance::sequence_json(sequence, vocabulary)));
  return json.dump(1) + "\n";
}

}  // namespace

std::vector<conformance::Sequence> SequenceCorpus::sequences() const {
  std::vector<conformance::Sequence> all;
  for (const StoredSequence& one : read) all.push_back(one.sequence);
  return all;
}

std::vector<fs::path> corpus_files(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::path> files;
  for (auto at = fs::directory_iterator(folder, failure); !failure && at != fs::directory_iterator();
       at.increment(failure)) {
    std::error_code unknown;
    if (at->path().extension() == ".json" && at->is_regular_file(unknown)) files.push_back(at->path());
  }
  if (failure) {
    throw kernel::Error(
        kernel::ErrorKind::configuration,
        fmt::format("{}: the folder of a corpus cannot be read: {}", folder.string(), failure.message()));
  }
  if (files.size() > kMostStored) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        fmt::format("{}: there are {} files; a corpus has at most {}", folder.string(),
                                    files.size(), kMostStored));
  }
  std::ranges::sort(files);
  return files;
}

conformance::Sequence read_corpus_file(const fs::path& file, const conformance::SequenceRole& role,
                                       const conformance::SequenceVocabulary& vocabulary) {
  const config::Document document = config::Document::load(file);
  return config::read_object(document.root(), [&](config::ObjectReader& reader) {
    reader.required("schema").as_choice(std::array{kCorpusSchema});
    const config::Value of = reader.required("role");
    if (of.as_string() != role_path(role))
      config::fail(of, fmt::format("this is a sequence of {}, not of {}", of.as_string(), role_path(role)));
    return conformance::read_sequence(reader, vocabulary);
  });
}

SequenceCorpus read_corpus(const fs::path& folder, const conformance::SequenceRole& role,
                           const conformance::SequenceVocabulary& vocabulary) {
  SequenceCorpus corpus;
  for (const fs::path& file : corpus_files(folder)) {
    try {
      corpus.read.push_back({file, read_corpus_file(file, role, vocabulary)});
    } catch (const kernel::Error& error) {
      corpus.left_out.push_back({file, error.what()});
    }
  }
  return corpus;
}

void write_corpus(const fs::path& folder, const std::vector<conformance::Sequence>& sequences,
                  const SequenceCorpus& before, const conformance::SequenceRole& role,
                  const conformance::SequenceVocabulary& vocabulary) {
  std::set<fs::path> written;
  for (const conformance::Sequence& sequence : sequences) {
    const std::string text = corpus_text(sequence, role, vocabulary);
    const fs::path file = folder / (judge::hash_of(text) + ".json");
    std::error_code failure;
    if (written.insert(file).second && !fs::exists(file, failure)) reports::write_text_file(file, text);
  }
  // After the new ones are there: whatever ends this, nothing is lost.
  for (const StoredSequence& one : before.read) {
    std::error_code ignored;
    if (one.file.parent_path() == folder && !written.contains(one.file)) fs::remove(one.file, ignored);
  }
}

}  // namespace fieldproof::cli
