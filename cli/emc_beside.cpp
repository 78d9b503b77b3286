#include "cli/emc_beside.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "cli/networks.hpp"

namespace fieldproof::cli {
namespace {

// Of all tests that ran both ways.
struct Beside {
  std::size_t tests = 0;
  std::size_t worse = 0;
  std::size_t better = 0;
  std::size_t same = 0;  // to the last exchange
  network::ErrorStatistics counts;
  std::uint64_t longest_bad_run = 0;
  std::uint64_t stops = 0;

  void add(const emc::ImmunityResult& result) {
    counts += result.counts;
    longest_bad_run = std::max(longest_bad_run, result.longest_bad_run);
    stops += result.stops;
  }
};

}  // namespace

std::shared_ptr<const conformance::PlannedNetwork> plan_references(
    const ProtocolEntry& protocol, const conformance::NetworkRequest& request) {
  if (std::ranges::none_of(request.implementations, is_no_reference)) return nullptr;
  conformance::NetworkRequest references = request;
  // Which network it is can follow from a role that is named.
  for (conformance::Assignment& one : references.implementations) one.uri = conformance::kReferenceUri;
  return protocol.network.plan(references);
}

std::string beside_text(const EmcCampaign& campaign) {
  Beside device;
  Beside references;
  for (const EmcTest& test : campaign.tests) {
    if (!test.reference || !test.result.came_up || !test.reference->came_up) continue;
    ++device.tests;
    if (test.result.criterion > test.reference->criterion) ++device.worse;
    if (test.result.criterion < test.reference->criterion) ++device.better;
    if (is_as_references(test)) ++device.same;
    device.add(test.result);
    references.add(*test.reference);
  }
  if (device.tests == 0) return "";
  const auto row = [](std::string_view who, const Beside& one) {
    return fmt::format("  {:<18} {:>10} {:>10} {:>8} {:>12} {:>6}\n", who, one.counts.sent,
                       one.counts.refused, one.counts.wrong_exchanges, one.longest_bad_run, one.stops);
  };
  return fmt::format(
             "beside references alone, under bursts of the same seeds: the same to the last exchange in {} "
             "of {} "
             "tests, a worse criterion in {}, a better one in {}\n"
             "  {:<18} {:>10} {:>10} {:>8} {:>12} {:>6}\n",
             device.same, device.tests, device.worse, device.better, "", "exposed", "rejected", "wrong",
             "longest run", "stops") +
         row("with yours", device) + row("references alone", references);
}

bool is_as_references(const EmcTest& test) {
  return reference_json(test.result) == reference_json(*test.reference);
}

nlohmann::ordered_json reference_json(const emc::ImmunityResult& reference) {
  const network::ErrorStatistics& counts = reference.counts;
  return {{"came_up", reference.came_up},
          {"criterion", emc::name(reference.criterion)},
          {"exposed", counts.sent},
          {"rejected", counts.refused},
          {"accepted_wrong", counts.wrong_exchanges},
          {"longest_bad_run", reference.longest_bad_run},
          {"recovered_by_itself", reference.recovered_by_itself},
          {"recovered_after_start", reference.recovered_after_start},
          {"recovery_cycles", reference.recovery_exchanges},
          {"bus_stops", reference.stops}};
}

}  // namespace fieldproof::cli
