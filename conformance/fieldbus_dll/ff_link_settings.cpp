#include <fmt/format.h>

#include <array>

#include "conformance/fieldbus_dll/ff_scene.hpp"

// A link whose numbers are not the usual ones, and numbers and lengths at the end of their range.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::FfCodes;
using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr FfAddress kFarPublisher = 0x1000'2230;
constexpr FfAddress kNodeAndSelector = 0xFFFF;
constexpr FfAddress kOtherLink = 0x2000'0000;

void with_long_preamble(FfConfiguration& configuration) {
  configuration.rules.link.preamble_octets = 8;
}
void with_far_publisher(FfConfiguration& configuration) {
  configuration.subscribed = {kFarPublisher};
}

// The first that it drives until it is silent.
FfStep answered(const std::string& what, const std::string& reason,
                bool (*is_right)(FfScene&, const DrivenDlpdu&)) {
  return expected<FfScene>(what, [=](FfScene& scene) {
    const std::vector<DrivenDlpdu> all = scene.bench.listen();
    scene.judge.expect(!all.empty(), reason, what, "silence");
    scene.judge.expect(is_right(scene, all.front()), "dlpdu_wrong",
                       [&] { return Mismatch{{what}, all.front().text(), all.front().begin}; });
  });
}

}  // namespace

void with_other_codes(FfConfiguration& configuration) {
  FfCodes& codes = configuration.rules.codes;
  codes.cd = 0xC0;
  codes.dt1 = 0xE0;
  codes.dt3 = 0x60;
  codes.sr = 0x1B;
  codes.pn = 0x2E;
  codes.pr = 0x2F;
  codes.pt = 0x40;
  codes.rt = 0x44;
  codes.ri = 0x28;
  codes.td = 0x19;
  codes.ct = 0x1C;
  codes.cl = 0x09;
  codes.tl = 0x0E;
  codes.idle = 0x18;
}

std::vector<FfCase> ff_link_settings_cases() {
  using namespace ff_chart;
  using enum Priority;
  // All that a device of a link does, once.
  const FfStep all_served =
      repeat({}, {pn(),
                  answered("a PR with the station's node", "no_probe_response",
                           [](FfScene& scene, const DrivenDlpdu& one) {
                             return one.octets == Octets{scene.bench.rules().codes.pr, scene.bench.node()};
                           }),
                  activation(), wait(20), cd(),
                  answered("a SR: nothing was written", "not_published",
                           [](FfScene& scene, const DrivenDlpdu& one) {
                             return (one.octet(0) & ~fieldbus_dll::kFinalBit) == scene.bench.rules().codes.sr;
                           }),
                  write(8), cd(),
                  answered("a DT3 with the buffer", "not_published",
                           [](FfScene& scene, const DrivenDlpdu& one) {
                             return is_dt3(scene.bench, one) && buffer_in(one).data == scene.written.back();
                           }),
                  submit({normal}, 10), pt(normal, 500), used({1}, {"frames_missing", "sent_twice"}),
                  pt(normal, 500), used({}, {"", "sent_twice"})});
  using link_sources::ff_paper;
  using link_sources::line;
  using link_sources::memory;
  using link_sources::own;
  return {
      on_chart(must_case("fieldbus_dll/ff_device/settings/a_long_preamble_is_sent", "FF-43",
                         "A station sends as many octets of preamble as its link has.",
                         line("preamble and delimiters"),
                         {{"preamble_of_the_usual_link", "frame_length_wrong"},
                          {"mute_after_activation", "not_published"}}),
               {{}, {all_served, preambles(8)}}, {.change = with_long_preamble, .is_live = false}),
      on_chart(must_case("fieldbus_dll/ff_device/settings/other_codes_are_used", "FF-43",
                         "The first octets of DLPDUs are those of the link.",
                         own("codes are settings, because their standard was not at hand"),
                         {{"codes_of_the_usual_link", "no_probe_response"},
                          {"mute_after_activation", "not_published"}}),
               {{}, {all_served}}, {.change = with_other_codes, .is_live = false}),
      on_chart(must_case("fieldbus_dll/ff_device/token/a_long_duration_is_used", "FF-44",
                         "The duration of a PT has 16 bits, of which none is a sign.",
                         ff_paper("duration of the token"),
                         {{"duration_of_12_bits", "token_not_returned"},
                          {"duration_with_sign", "token_not_returned"},
                          {"duration_in_ns_of_32_bits", "frames_missing"},
                          {"mute_after_activation", "token_not_returned"}},
                         {{memory("the size of the duration"), {"frames_missing", "token_not_returned"}}}),
               {{8, 8},
                {submit({time_available, time_available, time_available}, 200),
                 send("a PT for 4096, 4100, 8192, 16384, 16800, 32768, 32780, 65535 octet durations, in turn",
                      [](FfScene& scene) {
                        constexpr std::array kDurations{4'096U,  4'100U,  8'192U,  16'384U,
                                                        16'800U, 32'768U, 32'780U, 65'535U};
                        return scene.bench.pt(time_available, kDurations[scene.round]);
                      }),
                 used({1, 2, 3}, {"frames_missing", "sent_twice"})}}),
      on_chart(must_case("fieldbus_dll/ff_device/frame/the_longest_is_delivered", "FF-39",
                         "A DLSDU has at most 64, 128, 256 octets when it is urgent, normal, time-available.",
                         memory("the longest DLSDU of each priority"),
                         {{"deaf_to_long_frames", "longest_not_delivered"},
                          {"mute_after_activation", "does_not_recover"}}),
               {{3, 3},
                {send("a DT1 to the station, urgent with 64, normal with 128, time-available with 256 "
                      "octets, in turn",
                      [](FfScene& scene) {
                        const Priority priority = scene.priority();
                        return scene.bench.dt1(
                            priority, fieldbus_dll::address_of(scene.bench.node(), 0x30),
                            FfBench::kPeersAddress,
                            scene.fresh(fieldbus_dll::most_data(scene.bench.link(), priority)));
                      }),
                 wait(20), delivered("longest_not_delivered"), serves()}}),
      on_chart(must_case("fieldbus_dll/ff_device/publisher/one_of_another_link_is_another", "FF-45",
                         "A publisher is known by its whole address, the link with it.",
                         own("subscription by address"),
                         {{"subscribed_without_link", "other_buffer_delivered"},
                          {"mute_after_activation", "does_not_recover"}}),
               {{},
                {repeat({2, 2}, {send("a DT3 with the node and selector of a publisher of another link, of a "
                                      "third link and then without one",
                                      [](FfScene& scene) {
                                        return scene.bench.dt3((scene.turn == 0 ? kOtherLink : FfAddress{0}) |
                                                                   (kFarPublisher & kNodeAndSelector),
                                                               scene.bench.numbered_data(8));
                                      }),
                                 wait(20), nothing_delivered("other_buffer_delivered")}),
                 send("a DT3 of the publisher",
                      [](FfScene& scene) { return scene.bench.dt3(kFarPublisher, scene.fresh(8)); }),
                 wait(20), published_delivered(), serves()}},
               {.change = with_far_publisher}),
  };
}

}  // namespace fieldproof::conformance
