// case.json: everything that is needed to run one case again as it ran, and what came out of it.
//
// Beside it lie the files of the case: trace.txt (the recording, one line each), timeline.json (what lies
// around the first finding, as data), trace.pcapng (the recording for Wireshark), playback.json (what the
// implementation drove), log.txt. Paths of a
// network, plan or PICS are those of copies inside the run's directory, so that a directory that is moved or
// sent still replays. Reading is strict: kernel::Error(configuration) names line and pointer. 64-bit numbers
// are texts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/stored_end.hpp"
#include "cli/verbs.hpp"
#include "conformance/runner.hpp"
#include "harness/config/document.hpp"
#include "reports/run_directory.hpp"

namespace fieldproof::cli {

struct CaseFile {
  std::string id;
  std::uint64_t case_seed = 0;
  conformance::Setup setup;  // with the seed of the run
  std::string pics_file;     // the copy of what `setup.pics` was read from; empty: none
  bool is_quiet = false;     // bursts that the case makes itself are left out: its plan has what mattered
  StoredEnd end;
  bool is_truncated = false;
  std::filesystem::path playback;  // empty: the implementation's part was not recorded
};

// Stores the case with its recording and log.
void store_case(const reports::RunDirectory& directory, const conformance::CaseRun& done,
                std::uint64_t run_seed);

// Stores the case in one file, quiet; the files of its setup stay where they are. `stored` is what it was
// before.
void write_quiet_case(const std::filesystem::path& file, const conformance::CaseRun& done,
                      const CaseFile& stored);

// What was recorded of a case, for programs of others: a pcapng capture, and a value change dump.
std::string capture_of(const conformance::Recording& recording, const std::string& id);
std::string wave_dump_of(const conformance::Recording& recording, const std::string& id);

// The case, its implementations and its PICS are looked up in the catalogue.
CaseFile load_case(const std::filesystem::path& file, const conformance::Catalogue& catalogue);

// The entry by which a stored case is run again: that of the catalogue, or of one whose cases make no bursts
// themselves.
class StoredEntry {
 public:
  StoredEntry(const CaseFile& stored, const Session& session);
  const conformance::Entry& operator*() const { return *entry_; }

 private:
  std::unique_ptr<conformance::Catalogue> quiet_;
  const conformance::Entry* entry_;
};

// The member "implementations" of files that are run again.
std::string implementations_json(std::span<const conformance::Assignment> implementations);
std::vector<conformance::Assignment> implementations_from(const config::Value& list,
                                                          const conformance::Suite& suite,
                                                          std::size_t last_position = 0);

}  // namespace fieldproof::cli
