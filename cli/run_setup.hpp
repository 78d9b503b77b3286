// From the settings of a call to what the suites are given and what the reports say about it.
#pragma once

#include <ctime>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/verbs.hpp"
#include "conformance/runner.hpp"
#include "harness/kernel/time.hpp"
#include "reports/results.hpp"

namespace fieldproof::cli {

// Seed, implementations, network, plan, PICS and volume of `run` and `verify`. Throws kernel::Error, also for
// what the suites of the selected cases cannot serve.
conformance::Setup setup_from(const Settings& settings, const conformance::Catalogue& catalogue,
                              std::span<const conformance::Entry> selected);

// Paths of the roles of these cases, PROTOCOL/ROLE, in their order.
std::vector<std::string> roles_of(std::span<const conformance::Entry> selected);

// Of implementations in other processes: `--call-limit`, `--case-limit`.
iut::PeerLimits limits_from(const Settings& settings);

unsigned jobs_from(const Settings& settings);

// What `--shard I/N` leaves of a selection: each N-th entry from the I-th on. All N are the whole, and each
// is part of one only.
std::vector<conformance::Entry> shard_of(const Settings& settings, std::vector<conformance::Entry> selected);

reports::RunIdentity identity_of(const Session& session, const conformance::Setup& setup,
                                 std::size_t selected);
reports::Manifest manifest_of(const Session& session, unsigned jobs);

// The first line of what a verb prints that simulates without a suite; `own_network` is what it simulates
// where no file says otherwise.
std::string simulation_header(const Session& session, std::uint64_t seed, const std::string& network_file,
                              std::string_view own_network);

// The virtual time of `--duration`, 1 ms to 1 h.
kernel::Duration virtual_time_from(const Settings& settings);

// Version of the tool and a hash over everything that the cases declare: "0.1.0+1f2e3d4c".
std::string suite_version(const conformance::Catalogue& catalogue);

// 16 hexadecimal digits over the content; empty for an empty name.
std::string file_hash(const std::string& file);

std::string utc_text(std::time_t when);  // "2026-11-21T05:18:28Z"
std::string utc_now();

}  // namespace fieldproof::cli
