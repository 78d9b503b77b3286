#include <fmt/format.h>

#include <algorithm>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"

// DLSDUs: how long they may be, and to whom they are delivered.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;

constexpr std::uint8_t kFinal = 0x04;

void the_longest_is_sent_and_no_longer(IsaBench& bench, CaseJudge& judge) {
  for (const Priority priority : {Priority::urgent, Priority::normal, Priority::time_available}) {
    const std::size_t most = fieldbus_dll::most_data(bench.rules().link, priority);
    const Octets longest = bench.numbered_data(most);
    judge.expect(bench.submit_unit_data(priority, longest), "longest_refused",
                 fmt::format("{} octets are accepted", most), "they were refused");
    judge.expect(!bench.submit_unit_data(priority, bench.numbered_data(most + 1)), "too_long_taken",
                 fmt::format("{} octets are refused", most + 1), "they were accepted");
    const kernel::Time end = bench.send(bench.es(Priority::time_available, 1'000));
    expect_data(judge, expect_token_use(bench, judge, end), {longest}, "longest_not_sent", "too_long_sent");
  }
}

struct Sent {
  std::uint8_t code;
  std::uint8_t destination;
  bool is_delivered;
  std::string_view reason;
  std::string_view what;
};

void data_is_delivered_to_whom_it_is_for(IsaBench& bench, CaseJudge& judge) {
  const auto& codes = bench.rules().codes;
  const std::uint8_t everybody = bench.rules().everybody;
  const std::array sents{
      Sent{codes.du, bench.address(), true, "data_not_delivered", "a DU to the station is delivered"},
      Sent{codes.du, everybody, true, "broadcast_not_delivered", "a DU to everybody is delivered"},
      Sent{codes.du, IsaBench::kPeer, false, "others_data_delivered", "a DU to another is not delivered"},
      Sent{codes.dt, everybody, false, "invalid_data_delivered", "a DT to everybody is none"},
      Sent{codes.dt, IsaBench::kPeer, false, "others_data_delivered", "a DT to another is not delivered"},
  };
  for (int n = 0; n < bench.volume(1, 10); ++n) {
    for (const Priority priority : {Priority::urgent, Priority::normal, Priority::time_available}) {
      for (const Sent& sent : sents) {
        const Octets data = bench.numbered_data(2 + bench.random().below(60));
        Octets octets{bench.control(sent.code, priority), sent.destination, IsaBench::kPeer};
        if (sent.code == codes.dt) octets[0] |= kFinal;
        octets.insert(octets.end(), data.begin(), data.end());
        bench.send(octets);
        expect_silence(bench, judge, "data_answered", "data is not answered");
        judge.expect(bench.user().was_delivered(data) == sent.is_delivered, sent.reason, sent.what,
                     "otherwise");
      }
    }
  }
}

}  // namespace

std::vector<IsaCase> isa_data_cases() {
  using link_sources::isa_paper;
  using link_sources::memory;
  using link_sources::own;
  return {
      {{.id = "fieldbus_dll/isa_dle/data/the_longest_is_sent_and_no_longer",
        .purpose = "ISA-27",
        .requirement = "A DLSDU has at most 64, 128, 256 octets when it is urgent, normal, time-available.",
        .reference = memory("the longest DLSDU of each priority"),
        .stimulus = "DLSDUs of these lengths and of one octet more are submitted.",
        .expected = "The first are accepted and sent, the others refused.",
        .tags = {"must"},
        .catches = {{"urgent_as_long_as_normal", "too_long_taken"}, {"one_octet_less", "longest_refused"}}},
       the_longest_is_sent_and_no_longer},
      {{.id = "fieldbus_dll/isa_dle/data/is_delivered_to_whom_it_is_for",
        .purpose = "ISA-28",
        .requirement = "Data is delivered to the station that it is for, a DU to everybody to all; it is not "
                       "answered.",
        .reference = isa_paper("data and their stations"),
        .details = {{own("a DU may be for everybody, a DT for one station only"),
                     {"broadcast_not_delivered", "invalid_data_delivered"}}},
        .stimulus = "DU and DT to the station, to another, to everybody.",
        .expected = "Those for the station and DU for everybody are delivered, with source and priority.",
        .tags = {"must"},
        .catches = {{"broadcast_not_delivered", "broadcast_not_delivered"},
                    {"dt_to_everybody_delivered", "invalid_data_delivered"},
                    {"tells_other_source", "told_otherwise"},
                    {"tells_normal_priority", "told_otherwise"},
                    {"broadcast_answered", "data_answered"},
                    {"others_data_delivered", "others_data_delivered"}}},
       data_is_delivered_to_whom_it_is_for},
  };
}

}  // namespace fieldproof::conformance
