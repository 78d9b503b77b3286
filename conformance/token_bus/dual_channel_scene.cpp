#include "conformance/token_bus/dual_channel_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "conformance/token_bus/driven_frames.hpp"

namespace fieldproof::conformance {

std::string from_delimiter(const std::string& symbols) {
  const std::size_t at = symbols.find('N');
  return at == std::string::npos ? "" : symbols.substr(at);
}

std::string ManagerScene::frame(std::size_t more_octets, bool more_follows) {
  constexpr std::size_t kCheck = 4;
  const std::size_t least = token_bus::frame_octets(bench.configuration().rules, 0);
  const auto octets = bench.random_octets(least - kCheck + more_octets);
  return indicated_as(frame_text(with_crc_32(octets), more_follows));
}

std::string ManagerScene::longest_frame() {
  return frame(token_bus::most_data(bench.configuration().rules));
}

std::string ManagerScene::with_wrong_check() {
  std::string text = frame();
  char& last = text.at(text.size() - end_delimiter_text().size() - 1);
  last = last == '0' ? '1' : '0';
  return text;
}

void ManagerScene::request(std::string symbols) {
  bench.clear();
  begin = bench.now();
  requested = std::move(symbols);
  bench.request(requested);
}

void ManagerScene::carry(ChannelText on_a, ChannelText on_b) {
  bench.settle();
  bench.clear();
  begin = bench.now();
  a = std::move(on_a);
  b = std::move(on_b);
  bench.carry(a, b);
}

void ManagerScene::power_anew() {
  bench.settle();
  bench.set_power(false);
  bench.wait(bench.slot());
  bench.set_power(true);
  bench.clear();
}

void ManagerScene::expect_indicated(const std::string& symbols, std::string_view reason) {
  bench.settle();
  const std::string right = without_end(symbols, 'S');
  const std::string seen = without_end(bench.indicated().text(), 'S');
  judge.expect(seen == right, reason, [&] { return difference(right, seen); });
}

void ManagerScene::expect_all_of(Channel channel, std::string_view reason) {
  const ChannelText& text = channel == Channel::a ? a : b;
  expect_indicated(text.symbols, reason);
  const kernel::Time due = begin + bench.symbols(text.later) + bench.indication_delay();
  const kernel::Time seen = bench.indicated().begin();
  judge.expect(seen <= due + kernel::kNanosecond, "indicated_too_late", kernel::describe(due),
               kernel::describe(seen));
}

void ManagerScene::expect_from_delimiter_of(Channel channel, std::string_view reason) {
  expect_indicated(from_delimiter((channel == Channel::a ? a : b).symbols), reason);
}

void ManagerScene::expect_events(const std::vector<std::string>& events, std::string_view reason) {
  bench.settle();
  const auto written = [](const std::vector<std::string>& all) {
    return all.empty() ? "nothing" : fmt::format("{}", fmt::join(all, ", "));
  };
  judge.expect(bench.events() == events, reason, written(events), written(bench.events()));
}

void ManagerScene::expect_event_of(Channel channel, std::string_view kind, std::string_view reason) {
  expect_events(kind.empty() ? std::vector<std::string>{}
                             : std::vector<std::string>{fmt::format("{}: {}", text_of(channel), kind)},
                reason);
}

void ManagerScene::expect_on_both_channels(const std::string& symbols, std::string_view reason) {
  bench.settle();
  for (const Channel channel : token_bus::kChannels) {
    const std::string seen = without_end(bench.requested(channel).text(), 'S');
    judge.expect(seen == symbols, reason, [&] {
      Mismatch made = difference(symbols, seen);
      made.actual = fmt::format("channel {}, {}", text_of(channel), made.actual);
      return made;
    });
  }
}

TestCase manager_must(const std::string& id, std::string purpose, std::string requirement, std::string place,
                      std::vector<MustCatch> catches) {
  return must_case("token_bus/channel_manager/" + id, std::move(purpose), std::move(requirement),
                   token_sources::own(std::move(place)), std::move(catches), {});
}

namespace manager_chart {

ManagerStep does(std::string text, std::function<void(ManagerScene&)> run) {
  return stimulus<ManagerScene>(std::move(text), std::move(run));
}
ManagerStep requires_that(std::string text, std::function<void(ManagerScene&)> run) {
  return expected<ManagerScene>(std::move(text), std::move(run));
}
ManagerStep powered_anew() {
  return does("the supply is switched off and on", [](ManagerScene& scene) { scene.power_anew(); });
}
ManagerStep b_serves() {
  return does("B alone carries a frame", [](ManagerScene& scene) {
    scene.carry_on(Channel::b);
    scene.bench.settle();
  });
}
ManagerStep nothing_reported(std::string reason) {
  return reported({}, std::move(reason));
}
ManagerStep reported(std::vector<std::string> events, std::string reason) {
  return requires_that(
      events.empty() ? "nothing is reported"
                     : fmt::format("what is reported since then is {}", fmt::join(events, ", ")),
      [events, reason = std::move(reason)](ManagerScene& scene) { scene.expect_events(events, reason); });
}
ManagerStep indicates_of(Channel channel, std::string reason) {
  return {"A and B carry different frames", fmt::format("that of {} is indicated", text_of(channel)),
          [channel, reason = std::move(reason)](ManagerScene& scene) {
            scene.carry({scene.frame()}, {scene.frame()});
            scene.expect_all_of(channel, reason);
          }};
}
ManagerStep still_serves() {
  return {"both carry the same frame", "it is indicated", [](ManagerScene& scene) {
            scene.carry_on_both();
            scene.expect_indicated(scene.a.symbols, "does_not_recover");
          }};
}

}  // namespace manager_chart
}  // namespace fieldproof::conformance
