#include "conformance/fieldbus_dll/ff_scene.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::conformance {

using fieldbus_dll::Priority;

void FfScene::expect_used(const std::vector<Octets>& dlsdus, const DlsduReasons& reasons) {
  const std::vector<DrivenDlpdu> all = expect_token_used(bench, judge, sent);
  expect_dlsdus(judge, all, dlsdu_of, dlsdus, reasons);
  answer = all.empty() ? bench.driven().back() : all.front();
}

namespace ff_chart {

FfStep pt(Priority least, unsigned duration) {
  return send(fmt::format("a PT {} for {} octet durations", fieldbus_dll::text_of(least), duration),
              [=](FfScene& scene) { return scene.bench.pt(least, duration); });
}

FfStep pn(const std::string& where) {
  return send("a PN for the station" + where,
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

FfStep delivered(std::string reason) {
  return expected<FfScene>("it is delivered", [reason = std::move(reason)](FfScene& scene) {
    FfUpperTester& user = scene.bench.user();
    scene.judge.expect(user.was_delivered(scene.data), reason, "what was sent to the user is delivered",
                       "it was not");
    user.data.clear();
  });
}

FfStep nothing_delivered(std::string reason) {
  return require(
      "nothing is delivered",
      [](FfScene& scene) { return scene.bench.user().data.empty() && scene.bench.user().published.empty(); },
      std::move(reason));
}

FfStep as_written() {
  return answer<FfScene>(
      "a DT3 with all that was written", "not_published",
      [](const FfScene& scene, const DrivenDlpdu& one) {
        return is_dt3(scene.bench, one) && buffer_in(one).data == scene.written.back();
      },
      "buffer_wrong");
}

FfStep published_delivered() {
  return require(
      "it is delivered",
      [](FfScene& scene) {
        const auto& all = scene.bench.user().published;
        return all.size() == 1 && all[0].data == scene.data;
      },
      "subscription_not_delivered");
}

FfStep write(std::size_t size) {
  return stimulus<FfScene>(
      fmt::format("the user writes {} octets into its buffer", size), [size](FfScene& scene) {
        scene.written.push_back(scene.bench.numbered_data(size));
        const bool is_taken = scene.bench.write(FfBench::kPublished, scene.written.back());
        scene.judge.expect(is_taken, "write_refused", "the buffer is written", "it was not");
      });
}

FfStep serve(Rounds octets) {
  return stimulus<FfScene>(
      fmt::format("all nodes return their tokens at once, for {} octet durations", octets.full),
      [octets](FfScene& scene) {
        const std::int64_t count = scene.bench.volume(octets.quick, octets.full);
        scene.driven = scene.bench.serve(scene.bench.now() + scene.bench.octets(count));
      });
}

FfStep has_driven(const std::string& what, bool (*is_one)(const FfBench&, const DrivenDlpdu&),
                  std::string reason) {
  return require(
      what,
      [is_one](FfScene& scene) {
        return std::ranges::any_of(scene.driven,
                                   [&](const DrivenDlpdu& one) { return is_one(scene.bench, one); });
      },
      std::move(reason));
}

}  // namespace ff_chart
}  // namespace fieldproof::conformance
