#include <array>

#include "conformance/fieldbus_dll/isa_scene.hpp"

// DLSDUs: how long they may be, and to whom they are delivered.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;

constexpr std::uint8_t kFinal = 0x04;

struct Sent {
  std::uint8_t code;
  std::uint8_t destination;
  bool is_delivered;
  std::string_view reason;
  std::string_view what;
};

Sent sent_in(const IsaScene& scene) {
  const auto& codes = scene.bench.rules().codes;
  const std::uint8_t everybody = scene.bench.rules().everybody;
  const std::array all{
      Sent{codes.du, scene.bench.address(), true, "data_not_delivered", "a DU to the station is delivered"},
      Sent{codes.du, everybody, true, "broadcast_not_delivered", "a DU to everybody is delivered"},
      Sent{codes.du, IsaBench::kPeer, false, "others_data_delivered", "a DU to another is not delivered"},
      Sent{codes.dt, everybody, false, "invalid_data_delivered", "a DT to everybody is none"},
      Sent{codes.dt, IsaBench::kPeer, false, "others_data_delivered", "a DT to another is not delivered"},
  };
  return all[scene.round % all.size()];
}

Octets data_of_round(IsaScene& scene) {
  const Sent sent = sent_in(scene);
  Octets octets{scene.bench.control(sent.code, scene.priority()), sent.destination, IsaBench::kPeer};
  if (sent.code == scene.bench.rules().codes.dt) octets[0] |= kFinal;
  for (const std::uint8_t octet : scene.fresh(2 + scene.bench.random().below(60))) octets.push_back(octet);
  return octets;
}

void expect_delivered_to_whom_it_is_for(IsaScene& scene) {
  const Sent sent = sent_in(scene);
  scene.judge.expect(scene.bench.user().was_delivered(scene.data) == sent.is_delivered, sent.reason,
                     sent.what, "otherwise");
}

}  // namespace

std::vector<IsaCase> isa_data_cases() {
  using namespace isa_chart;
  using enum Priority;
  using link_sources::isa_paper;
  using link_sources::memory;
  using link_sources::own;
  return {
      on_chart(
          must_case("fieldbus_dll/isa_dle/data/the_longest_is_sent_and_no_longer", "ISA-27",
                    "A DLSDU has at most 64, 128, 256 octets when it is urgent, normal, time-available.",
                    memory("the longest DLSDU of each priority"),
                    {{"urgent_as_long_as_normal", "too_long_taken"}, {"one_octet_less", "longest_refused"}}),
          {{3, 3},
           {submit_longest(), es(time_available, 1'000), used({1}, {"longest_not_sent", "too_long_sent"})}}),
      on_chart(
          must_case("fieldbus_dll/isa_dle/data/is_delivered_to_whom_it_is_for", "ISA-28",
                    "Data is delivered to the station that it is for, a DU to everybody to all; it is not "
                    "answered.",
                    isa_paper("data and their stations"),
                    {{"broadcast_not_delivered", "broadcast_not_delivered"},
                     {"dt_to_everybody_delivered", "invalid_data_delivered"},
                     {"tells_other_source", "told_otherwise"},
                     {"tells_normal_priority", "told_otherwise"},
                     {"broadcast_answered", "data_answered"},
                     {"others_data_delivered", "others_data_delivered"}},
                    {{own("a DU may be for everybody, a DT for one station only"),
                      {"broadcast_not_delivered", "invalid_data_delivered"}}}),
          {{15, 150},
           {send("a DU to the station, to everybody, to another, a DT to everybody, to another, in turn "
                 "and of each priority",
                 data_of_round),
            silence("data_answered", "data is not answered"),
            expected<IsaScene>("those of the first two kinds are delivered, the others not",
                               expect_delivered_to_whom_it_is_for)}}),
  };
}

}  // namespace fieldproof::conformance
