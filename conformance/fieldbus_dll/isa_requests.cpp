#include <fmt/format.h>

#include <array>

#include "conformance/fieldbus_dll/isa_scene.hpp"

// What the user asks for, and what there is not; the longest data of each priority, both ways.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaConfiguration;
using fieldbus_dll::IsaService;
using fieldbus_dll::Priority;

void expect_isa_refused(IsaScene& scene, bool is_taken, const std::string& what, std::string_view reason) {
  scene.judge.expect(!is_taken, reason, what + " is refused", "it was taken");
}

void expect_no_isa_request_refused(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  for (const Octets& request : {Octets{0x00}, Octets{0x02, 0x00, 0x02, 0x22, 0x41}, Octets{0x07, 0x01},
                                Octets{0xFF, 0x00, 0x02, 0x22}, Octets{0x01}, Octets{0x01, 0x00},
                                Octets{0x01, 0x00, 0x02}, Octets{0x01, 0x01, 0x02}, Octets{0x01, 0x02, 0x02}})
    expect_isa_refused(
        scene, bench.ask_user_request(request),
        fmt::format("a request of {} octets, {:02X} first, which there is not,", request.size(), request[0]),
        "unknown_request_taken");
  if (!bench.is_in_standby())
    expect_isa_refused(scene, bench.order_transfer(IsaBench::kPeer),
                       "03 of a link master, asked of a station that is none,", "unknown_request_taken");
  for (const unsigned service : {3U, 255U})
    expect_isa_refused(
        scene, bench.submit(static_cast<IsaService>(service), Priority::normal, bench.numbered_data(4)),
        fmt::format("service {}", service), "unknown_service_taken");
  for (const IsaService service : {IsaService::unit_data, IsaService::compel, IsaService::reply_data})
    for (const unsigned priority : {0U, 4U, 255U})
      expect_isa_refused(scene,
                         bench.submit(service, static_cast<Priority>(priority),
                                      service == IsaService::compel ? Octets{} : bench.numbered_data(4)),
                         fmt::format("service {} with priority {}", static_cast<unsigned>(service), priority),
                         "unknown_priority_taken");
  for (const std::size_t size : {1U, 8U})
    expect_isa_refused(scene, bench.submit(IsaService::compel, Priority::time_available, Octets(size, 0x41)),
                       fmt::format("a CD with {} octets of data", size), "data_with_cd_taken");
  expect_isa_refused(scene, bench.submit(IsaService::compel, Priority::normal, {}, bench.rules().everybody),
                     "a CD to everybody", "unknown_address_taken");
  for (const std::uint8_t node : {std::uint8_t{0x00}, std::uint8_t{0xF8}})
    for (const IsaService service : {IsaService::unit_data, IsaService::compel})
      expect_isa_refused(
          scene, bench.submit(service, Priority::normal, {}, node),
          fmt::format("service {} to {:02X}, which is no address,", static_cast<unsigned>(service), node),
          "unknown_address_taken");
}

// ---- as long as the link carries ----

void with_other_lengths(IsaConfiguration& configuration) {
  configuration.rules.link.most_data = {40, 100, 150};
}

void expect_longest_taken(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  const Priority priority = scene.priority();
  const std::size_t most = fieldbus_dll::most_data(bench.link(), priority);
  for (const IsaService service : {IsaService::unit_data, IsaService::reply_data}) {
    scene.submitted.push_back(bench.numbered_data(most));
    scene.judge.expect(bench.submit(service, priority, scene.submitted.back()), "longest_refused",
                       fmt::format("{} octets are accepted", most), "they were refused");
    expect_isa_refused(scene, bench.submit(service, priority, bench.numbered_data(most + 1)),
                       fmt::format("{} data of {} octets", fieldbus_dll::text_of(priority), most + 1),
                       "too_long_taken");
  }
}

void expect_longest_reply(IsaScene& scene) {
  const DrivenDlpdu dt = expect_next(scene.bench, scene.judge, "no_reply", "a DT");
  scene.judge.expect(dt.rest() == scene.submitted.back(), "data_wrong",
                     [&] { return Mismatch{{"a DT with all of the data"}, dt.text(), dt.begin}; });
}

IsaStep takes_the_longest() {
  return {
      "the user submits data of the most octets of a priority, for a DU and for a CD, and of an octet more",
      "the first are accepted, the others refused", expect_longest_taken};
}

// Turn by turn a DU and a DT, so much longer than its priority carries.
Octets data_of_length(IsaScene& scene, std::size_t size) {
  const auto& codes = scene.bench.rules().codes;
  const Octets& data = scene.fresh(size);
  if (scene.turn % 2 == 1) return scene.bench.dt(scene.priority(), data);
  Octets octets{scene.bench.control(codes.du, scene.priority()), scene.bench.address(), IsaBench::kPeer};
  octets.insert(octets.end(), data.begin(), data.end());
  return octets;
}

IsaStep longest_heard(std::size_t more) {
  return isa_chart::send(fmt::format("a DU and a DT to the station, in turn, {}",
                                     more == 0 ? "of the most octets of their priority" : "of an octet more"),
                         [more](IsaScene& scene) {
                           return data_of_length(
                               scene, more + fieldbus_dll::most_data(scene.bench.link(), scene.priority()));
                         });
}

std::vector<IsaStep> lengths() {
  using namespace isa_chart;
  return {takes_the_longest(),
          cd(Priority::time_available),
          expected<IsaScene>("the DT with all of its data", expect_longest_reply),
          wait(32),
          es(Priority::time_available, 1'000),
          used({1}, {"longest_not_sent", "too_long_sent"}),
          repeat({2, 2}, {longest_heard(0), wait(20), delivered("what was sent", "longest_not_delivered"),
                          longest_heard(1), wait(20),
                          require(
                              "an octet more is none: nothing is delivered",
                              [](IsaScene& scene) { return scene.bench.user().deliveries.empty(); },
                              "invalid_data_delivered")})};
}

void submit_during_token(IsaScene& scene, Priority priority) {
  IsaBench& bench = scene.bench;
  bench.next_begins(bench.now() + bench.observation_timeout());
  bench.wait(bench.octets(2));
  scene.submitted.push_back(expect_submitted(bench, scene.judge, IsaService::unit_data, priority, 10));
}

IsaStep meanwhile(Priority priority) {
  return stimulus<IsaScene>(fmt::format("while the first DU is on the line, the user submits {} data",
                                        fieldbus_dll::text_of(priority)),
                            [priority](IsaScene& scene) { submit_during_token(scene, priority); });
}

}  // namespace

std::vector<IsaCase> isa_request_cases() {
  using namespace isa_chart;
  using enum Priority;
  using link_sources::memory;
  using link_sources::own;
  return {
      on_chart(must_case("fieldbus_dll/isa_dle/requests/what_there_is_not_is_refused", "ISA-27",
                         "What a station does not do for its user, it refuses, and keeps nothing of it.",
                         own("what is submitted is sent or refused"),
                         {{"unknown_requests_taken", "unknown_request_taken"},
                          {"orders_taken", "unknown_request_taken"},
                          {"unknown_service_is_unit_data", "unknown_service_taken"},
                          {"priority_zero_accepted", "unknown_priority_taken"},
                          {"priority_four_accepted", "unknown_priority_taken"},
                          {"data_of_cd_left_out", "data_with_cd_taken"},
                          {"compels_everybody", "unknown_address_taken"}}),
               {{},
                {IsaStep{"requests that there are not, an order for a link master, services 3 and 255, "
                         "priorities 0, 4 and 255, a CD with data, addresses that are none",
                         "all are refused", expect_no_isa_request_refused},
                 es(time_available, 1'000), used({}, {"", "sent_twice"}), cd(time_available),
                 answer<IsaScene>("an empty DT", "no_reply",
                                  [](const IsaScene& scene, const DrivenDlpdu& one) {
                                    return is_type(one, scene.bench.rules().codes.dt) && one.rest().empty();
                                  }),
                 wait(32), serves()}}),
      on_chart(must_case("fieldbus_dll/isa_dle/data/the_longest_is_delivered", "ISA-27",
                         "A DLSDU has at most 64, 128, 256 octets when it is urgent, normal, time-available.",
                         memory("the longest DLSDU of each priority"),
                         {{"deaf_to_long_frames", "longest_not_delivered"},
                          {"tells_128_octets", "told_otherwise"},
                          {"too_long_is_cut", "invalid_data_delivered"}}),
               {{3, 3}, lengths()}),
      on_chart(
          must_case(
              "fieldbus_dll/isa_dle/settings/data_are_as_long_as_the_link_carries", "ISA-27",
              "The longest DLSDU of each priority is that of the link.", memory("the longest DLSDU"),
              {{"lengths_of_the_usual_link", "longest_refused"}, {"one_length_for_all", "too_long_taken"}}),
          {{3, 3}, lengths()}, {.change = with_other_lengths}),
      on_chart(must_case("fieldbus_dll/isa_dle/data/without_octets_is_delivered", "ISA-28",
                         "Data of no octets are data.", own("a DLSDU may be empty"),
                         {{"empty_data_left_out", "data_not_delivered"}}),
               {{3, 3},
                {repeat({2, 2}, {send("a DU and a DT to the station without data, in turn",
                                      [](IsaScene& scene) { return data_of_length(scene, 0); }),
                                 wait(20), delivered("it", "data_not_delivered")})}}),
      on_chart(must_case("fieldbus_dll/isa_dle/sequence/what_is_urgent_meanwhile_is_next", "ISA-08",
                         "What is submitted during a token is sent in its order, too.",
                         own("what is next is decided before each frame"),
                         {{"urgent_waits_for_a_token", "wrong_order"}}),
               {{},
                {submit({normal, normal, normal}, 10), es(normal, 1'000), meanwhile(urgent),
                 used({1, 4, 2, 3}, {"frames_missing", "sent_twice", "wrong_order"})}}),
  };
}

}  // namespace fieldproof::conformance
