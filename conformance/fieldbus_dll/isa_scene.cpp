#include "conformance/fieldbus_dll/isa_scene.hpp"

#include <fmt/format.h>

namespace fieldproof::conformance {

using fieldbus_dll::Priority;

void IsaScene::expect_used(const std::vector<Octets>& dlsdus, const DlsduReasons& reasons) {
  use = expect_token_use(bench, judge, sent);
  expect_dlsdus(judge, use.data, dlsdu_in, dlsdus, reasons);
  answer = use.data.empty() ? use.end : use.data.front();
}

void IsaScene::reply(const Octets& octets, kernel::Duration later) {
  sent = bench.send_at(answer.end + bench.least_gap() + later, octets);
  bench.run_until(sent);
}

namespace isa_chart {

IsaStep et(Priority least) {
  return send(fmt::format("an ET {}", fieldbus_dll::text_of(least)),
              [=](IsaScene& scene) { return scene.bench.et(least); });
}

IsaStep es(Priority least, unsigned duration) {
  return send(fmt::format("an ES {} for {} octet durations", fieldbus_dll::text_of(least), duration),
              [=](IsaScene& scene) { return scene.bench.es(least, duration); });
}

IsaStep cd(Priority least) {
  return send(fmt::format("a CD {}", fieldbus_dll::text_of(least)),
              [=](IsaScene& scene) { return scene.bench.cd(least); });
}

IsaStep end_reason(fieldbus_dll::EndReason reason) {
  return expected<IsaScene>(fmt::format("the EE with reason {}", static_cast<unsigned>(reason)),
                            [reason](IsaScene& scene) { expect_end_reason(scene.judge, scene.use, reason); });
}

IsaStep delivered(const std::string& what, std::string reason) {
  return expected<IsaScene>(what + " is delivered", [what, reason = std::move(reason)](IsaScene& scene) {
    IsaUpperTester& user = scene.bench.user();
    const bool is_right = user.was_delivered(scene.data);
    scene.judge.expect(is_right || user.deliveries.empty(), "told_otherwise", [&] {
      const IsaUpperTester::Delivery& one = user.deliveries.front();
      return Mismatch{{what + " is delivered as it was sent"}, describe(one.dlpdu), one.when};
    });
    scene.judge.expect(is_right, reason, what + " is delivered", "it was not");
    user.deliveries.clear();
  });
}

IsaStep delegated(const std::string& what) {
  return expected<IsaScene>(what, [what](IsaScene& scene) {
    // It is sent within V(ST) of its instant.
    const kernel::Time latest =
        scene.bench.now() + scene.bench.observation_timeout() + 2 * scene.bench.slot();
    scene.answer = expect_next(scene.bench, scene.judge, latest, "delegation_missing", what);
  });
}

}  // namespace isa_chart
}  // namespace fieldproof::conformance
