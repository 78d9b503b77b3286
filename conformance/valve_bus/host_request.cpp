#include <fmt/format.h>

#include "conformance/valve_bus/host_scene.hpp"

// What the PC orders and what stands on the line for it.
namespace fieldproof::conformance {
namespace {

using valve_bus::HostErrorKind;

// With random data.
void order_command(HostScene& scene, unsigned id, unsigned number) {
  valve_bus::Command command = scene.bench.write_to(id);
  command.command = static_cast<std::uint8_t>(number);
  scene.order(command);
}

void expect_refused_order(HostScene& scene, HostErrorKind kind, std::string_view sent_reason) {
  // What is refused is refused when its turn comes: after the distance of a write and a refresh.
  expect_no_request(scene.bench, scene.judge, scene.bench.characters(20) + 3 * kernel::kMillisecond,
                    sent_reason, fmt::format("{} is no command", text_of_command(scene.command)));
  expect_error(scene.bench, scene.judge, {scene.command.id, kind});
}

void order_for_each_id(HostScene& scene) {
  const auto& rules = scene.bench.rules();
  order_command(scene, scene.round / 2, scene.round % 2 == 0 ? rules.read_command : rules.write_command);
}

void expect_sent_for_ids_1_to_99(HostScene& scene) {
  const auto& rules = scene.bench.rules();
  scene.id = scene.command.id;
  if (scene.id < rules.first_address || scene.id > rules.last_address) {
    expect_refused_order(scene, HostErrorKind::refused_id, "refused_id_sent");
    return;
  }
  scene.expect_sent();
  if (scene.command.command == rules.write_command) return;
  host_chart::response().run(scene);
  host_chart::reported().run(scene);
}

void order_undefined_command(HostScene& scene) {
  order_command(scene, scene.id, 2 + scene.round);
  expect_refused_order(scene, HostErrorKind::refused_command, "undefined_command_sent");
}

}  // namespace

std::vector<HostCase> host_request_cases() {
  using namespace host_chart;
  return {
      on_chart({.id = "valve_bus/host/request/write_is_sent_with_its_check",
                .purpose = "RH-01",
                .requirement = "A write of the PC goes out as ID, 0, DATA0, DATA1 and the block check, "
                               "which the module adds, in five octets at most 1.5 characters apart.",
                .reference = valve_sources::paper("frame of the host; check made in the module"),
                .tags = {"must"},
                .catches = {{"data_exchanged", "request_wrong"},
                            {"gap_in_request", "gap_in_frame"},
                            {"requests_without_ninth_bit", "ninth_bit_wrong"}},
                .not_applicable = for_plain_writes()},
               {{10, 1'000}, {write()}}),
      on_chart(
          {.id = "valve_bus/host/request/check_is_the_exclusive_or",
           .purpose = "RH-05",
           .requirement = "The block check of a request is the exclusive or of its four octets.",
           .reference = valve_sources::paper("block check"),
           .tags = {"must", "long"},
           .catches = {{"request_check_without_id", "check_wrong"}, {"request_check_is_sum", "check_wrong"}},
           .not_applicable = for_plain_writes()},
          {{30, 50'000}, {write(), served_read()}}),
      on_chart({.id = "valve_bus/host/request/ids_1_to_99_are_sent",
                .purpose = "RH-03",
                .requirement = "Commands for the IDs 1 to 99 are sent; those for 0 and 100 to 255 are "
                               "refused, and this is reported to the PC.",
                .reference = valve_sources::paper("ID 1 to 99"),
                .details = {{valve_sources::own("refusal is reported as an error"),
                             {"error_not_told", "error_wrong"}}},
                .tags = {"must"},
                .catches = {{"sends_id_100", "refused_id_sent"},
                            {"sends_id_0", "refused_id_sent"},
                            {"refuses_id_99", "no_request"},
                            {"refuses_silently", "error_not_told"}},
                .not_applicable = for_plain_writes()},
               {{512, 512},
                {stimulus("the PC orders a read and a write for the IDs 0 to 255, one in each round",
                          order_for_each_id),
                 expected("it is sent for the IDs 1 to 99, and the read is served; for others nothing is "
                          "sent, and the PC gets an error: ID refused",
                          expect_sent_for_ids_1_to_99)}}),
      on_chart({.id = "valve_bus/host/request/undefined_commands_are_refused",
                .purpose = "RH-04",
                .requirement = "Commands 2 to 255 are refused, and this is reported to the PC.",
                .reference = valve_sources::own("only commands 0 and 1 are defined"),
                .tags = {"must"},
                .catches = {{"sends_any_command", "undefined_command_sent"}}},
               {{254, 254},
                {{"the PC orders the commands 2 to 255, one in each round",
                  "nothing is sent, and the PC gets an error: command refused", order_undefined_command},
                 served_read()}}),
  };
}

}  // namespace fieldproof::conformance
