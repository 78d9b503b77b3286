#include "conformance/fieldbus_dll/ff_scene.hpp"

#include <fmt/format.h>

namespace fieldproof::conformance {

using fieldbus_dll::Priority;

void FfScene::expect_used(const std::vector<Octets>& data, const Reasons& reasons) {
  const std::vector<DrivenDlpdu> all = expect_token_used(bench, judge, sent);
  expect_dlsdus(judge, all, data, reasons.missing, reasons.more, reasons.others);
  answer = all.empty() ? bench.driven().back() : all.front();
}

namespace ff_chart {

FfStep pt(Priority least, unsigned duration) {
  return send(fmt::format("a PT {} for {} octet durations", fieldbus_dll::text_of(least), duration),
              [=](FfScene& scene) { return scene.bench.pt(least, duration); });
}

FfStep pn() {
  return send("a PN for the station",
              [](FfScene& scene) { return Octets{scene.bench.rules().codes.pn, scene.bench.node()}; });
}

FfStep cd() {
  return send("a CD for its buffer", [](FfScene& scene) { return scene.bench.cd(FfBench::kPublished); });
}

FfStep activation() {
  return send("an activation of the station",
              [](FfScene& scene) { return scene.bench.activation(scene.bench.node()); });
}

FfStep probe_response(const std::string& reason, const std::string& reason_wrong) {
  return answer<FfScene>(
      "a PR with the station's node", reason,
      [](const FfScene& scene, const DrivenDlpdu& one) {
        return one.octets == Octets{scene.bench.rules().codes.pr, scene.bench.node()};
      },
      reason_wrong);
}

FfStep write(std::size_t size) {
  return stimulus<FfScene>(
      fmt::format("the user writes {} octets into its buffer", size), [size](FfScene& scene) {
        scene.written.push_back(scene.bench.numbered_data(size));
        const bool is_taken = scene.bench.write(FfBench::kPublished, scene.written.back());
        scene.judge.expect(is_taken, "write_refused", "the buffer is written", "it was not");
      });
}

}  // namespace ff_chart
}  // namespace fieldproof::conformance
