#include "conformance/fieldbus_dll/ff_sequence.hpp"

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_reasons.hpp"
#include "conformance/fieldbus_dll/ff_sequence_run.hpp"
#include "conformance/fieldbus_dll/ff_vocabulary.hpp"
#include "conformance/fieldbus_dll/link_sequence.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;

std::vector<PartialSource> ff_sequence_details() {
  std::vector<PartialSource> details = ff_details();
  details.push_back({link_sources::own("a token is returned by F or by RT as soon as nothing fits"),
                     {"token_not_returned", "data_held_back", "speaks_unasked"}});
  details.push_back({link_sources::own("of what is received its user is given this"),
                     {"not_delivered", "delivered_unasked", "delivered_otherwise", "last_without_final",
                      "returned_with_data"}});
  details.push_back(
      {link_sources::own("a published buffer has the number of its writes"), {"published_wrong"}});
  return details;
}

}  // namespace

const SequenceRole& ff_device_sequence_role() {
  static const SequenceRole role{
      {.id = "fieldbus_dll/ff_device/check/follows_the_model",
       .purpose = "check",
       .requirement =
           "Whatever comes in whatever order, a device says what the last token, CD or probe for it "
           "allows, in time, and nothing else.",
       .reference = link_sources::memory("functions of a basic device"),
       .details = ff_sequence_details(),
       .rules = ff_reasons(),
       .stimulus =
           "Commands at random, with half bits and bits that are flipped and octets that are missing.",
       .expected = "What a model of the rules says.",
       .tags = {},
       .catches = {}},
      with_beginnings(ff_device_vocabulary(), states_of_a_device()),
      {{DerivedKind::values, {"tells_twice", "delivered_unasked"}},
       {DerivedKind::faults, {"no_probe_response", "no_answer"}},
       {DerivedKind::words, {"subscribed_to_none", "not_delivered"}},
       {DerivedKind::states, {"returns_twice", "speaks_unasked"}},
       {DerivedKind::walks, {"returns_twice", "speaks_unasked"}},
       {DerivedKind::repetitions, {"tells_other_source", "delivered_otherwise"}},
       {DerivedKind::settings, {"tells_no_writes", "delivered_otherwise"}},
       {DerivedKind::drawn, {"subscribed_to_none", "not_delivered"}}}};
  return role;
}

FfNeeds ff_device_sequence_needs() {
  return {.change = [](fieldbus_dll::FfConfiguration& device) {
    device.published.push_back(kLongPublished);
    device.subscribed.push_back(kLongSubscribed);
    for (FfAddress n = 0; n < kMorePublished; ++n) device.published.push_back(kMoreOfDevice + n);
    for (FfAddress n = 0; n < kMoreSubscribed; ++n) device.subscribed.push_back(kMoreOfOthers + n);
    // Longer than a buffer of most links.
    constexpr std::size_t kMostUrgent = 100;
    device.rules.link.most_data[2] = kMostUrgent;
  }};
}

void run_ff_device_sequence(const Sequence& sequence, FfBench& bench, CaseJudge& judge) {
  FfSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
