#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_scene.hpp"

// What the user asks for, beside what its settings carry and beside what the station does at that time.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr FfAddress kBuffers = 40;
constexpr FfAddress kSubscriptions = 70;
constexpr std::uint8_t kHighNode = 0x81;
constexpr FfAddress kFarPeer = 0x0001'2230;
constexpr std::size_t kLongBuffer = 100;

void with_many_buffers(FfConfiguration& configuration) {
  configuration.published.clear();
  configuration.subscribed.clear();
  for (FfAddress n = 0; n < kBuffers; ++n) configuration.published.push_back(FfBench::kPublished + n);
  for (FfAddress n = 0; n < kSubscriptions; ++n) configuration.subscribed.push_back(FfBench::kSubscribed + n);
}
void without_urgent_data(FfConfiguration& configuration) {
  configuration.rules.link.most_data[2] = 0;
}
void with_long_buffers(FfConfiguration& configuration) {
  configuration.rules.link.most_data[2] = kLongBuffer;
}
void with_high_node(FfConfiguration& configuration) {
  configuration.node = kHighNode;
}

void expect_refused(FfScene& scene, bool is_taken, const std::string& what, std::string_view reason) {
  scene.judge.expect(!is_taken, reason, what + " is refused", "it was taken");
}

void expect_no_request_refused(FfScene& scene) {
  FfBench& bench = scene.bench;
  for (const Octets& request : {Octets{0x07, 0x01}, Octets{0x00}, Octets{0x04, 0x00, 0x00, 0x22, 0x30, 0x41},
                                Octets{0xFF, 0x02, 0x00, 0x00, 0x22, 0x30}, Octets{0x01},
                                Octets{0x01, 0x02, 0x00, 0x00, 0x22}, Octets{0x02, 0x00, 0x00, 0x21}})
    expect_refused(scene, bench.ask_user_request(request),
                   fmt::format("request {:02X}, which there is not,", request[0]), "unknown_request_taken");
  if (!bench.is_link_master())
    expect_refused(scene, bench.order_transfer(FfBench::kPeer), "03 of a link master, asked of a device,",
                   "unknown_request_taken");
  for (const unsigned priority : {0U, 4U, 255U})
    expect_refused(scene, bench.submit(static_cast<Priority>(priority), bench.numbered_data(4)),
                   fmt::format("data of priority {}", priority), "unknown_priority_taken");
  expect_refused(scene, bench.write(FfBench::kPublished + 2, bench.numbered_data(4)),
                 "a buffer that is not published", "unknown_buffer_taken");
}

void expect_no_urgent_data(FfScene& scene) {
  FfBench& bench = scene.bench;
  expect_refused(scene, bench.submit(Priority::urgent, bench.numbered_data(1)), "urgent data of an octet",
                 "too_long_taken");
  expect_refused(scene, bench.write(FfBench::kPublished, bench.numbered_data(1)), "a buffer of an octet",
                 "too_long_taken");
  scene.submitted.push_back(bench.numbered_data(8));
  scene.judge.expect(bench.submit(Priority::normal, scene.submitted.back()), "data_refused",
                     "normal data is accepted", "it was refused");
}

// The last one first: what a list is cut to shows at once.
void expect_each_buffer(FfScene& scene) {
  FfBench& bench = scene.bench;
  std::vector<Octets> all;
  for (FfAddress n = 0; n < kBuffers; ++n) {
    all.push_back(bench.numbered_data(8 + n));
    scene.judge.expect(bench.write(FfBench::kPublished + n, all.back()), "write_refused",
                       fmt::format("buffer {} of {} is written", n + 1, kBuffers), "it was refused");
  }
  for (FfAddress n = kBuffers; n-- > 0;) {
    scene.sent = bench.send(bench.cd(FfBench::kPublished + n));
    const DrivenDlpdu one = expect_next(bench, scene.judge, "not_published", "a DT3");
    scene.judge.expect(is_dt3(bench, one) && buffer_in(one).data == all[n], "buffer_wrong", [&] {
      return Mismatch{{fmt::format("the DT3 of buffer {} of {}, as it was written", n + 1, kBuffers)},
                      bench.words(one),
                      one.begin};
    });
  }
}

void expect_each_subscription(FfScene& scene) {
  FfBench& bench = scene.bench;
  for (FfAddress n = kSubscriptions; n-- > 0;) {
    auto& published = bench.user().published;
    const std::size_t before = published.size();
    bench.send(bench.dt3(FfBench::kSubscribed + n, scene.fresh(8)));
    bench.wait(bench.octets(20));
    scene.judge.expect(published.size() == before + 1 && published.back().data == scene.data,
                       "subscription_not_delivered",
                       fmt::format("subscription {} of {} is delivered", n + 1, kSubscriptions),
                       fmt::format("{} DT3s were delivered", published.size() - before));
  }
}

// While the next DT1 of the station is on the line.
FfStep submit_meanwhile(Priority priority) {
  return stimulus<FfScene>(fmt::format("while the first DT1 is on the line, the user submits {} data",
                                       fieldbus_dll::text_of(priority)),
                           [priority](FfScene& scene) {
                             FfBench& bench = scene.bench;
                             bench.next_begins(bench.now() + bench.observation_timeout());
                             bench.wait(bench.octets(2));
                             scene.submitted.push_back(bench.numbered_data(10));
                             scene.judge.expect(bench.submit(priority, scene.submitted.back()),
                                                "data_refused", "data is accepted", "it was refused");
                           });
}

void expect_source(FfScene& scene, FfAddress to, FfAddress source) {
  FfBench& bench = scene.bench;
  scene.submitted = {bench.numbered_data(8)};
  scene.judge.expect(bench.submit(Priority::normal, scene.submitted[0], to), "data_refused",
                     "data is accepted", "it was refused");
  scene.sent = bench.send(bench.pt(Priority::normal, 500));
  const DrivenDlpdu one = expect_next(bench, scene.judge, "token_not_returned", "a DT1");
  scene.judge.expect(is_dt1(bench, one) && addresses_in(one).to == to && addresses_in(one).from == source,
                     "source_wrong", [&] {
                       return Mismatch{
                           {fmt::format("a DT1 to {:X} from {:X}", to, source)}, bench.words(one), one.begin};
                     });
}

}  // namespace

std::vector<FfCase> ff_request_cases() {
  using namespace ff_chart;
  using enum Priority;
  using link_sources::memory;
  using link_sources::own;
  return {
      on_chart(must_case("fieldbus_dll/ff_device/requests/what_there_is_not_is_refused", "FF-48",
                         "What a station does not do for its user, it refuses, and keeps nothing of it.",
                         own("what is submitted is sent or refused"),
                         {{"unknown_requests_taken", "unknown_request_taken"},
                          {"short_requests_taken", "unknown_request_taken"},
                          {"orders_taken", "unknown_request_taken"},
                          {"priority_zero_accepted", "unknown_priority_taken"},
                          {"priority_four_accepted", "unknown_priority_taken"}}),
               {{},
                {FfStep{"requests that there are not, or cut off in their address, an order for a link "
                        "master, data of priority 0, 4 and "
                        "255, a buffer that is not published",
                        "all are refused", expect_no_request_refused},
                 pt(time_available, 500), used({}, {"", "sent_twice"}), serves()}}),
      on_chart(must_case("fieldbus_dll/ff_device/requests/no_data_where_none_is_carried", "FF-39",
                         "A link may carry no data of a priority.", memory("the longest DLSDU"),
                         {{"no_data_is_the_usual_data", "too_long_taken"}}),
               {{},
                {FfStep{"urgent data and a buffer of an octet on a link that carries none; normal data",
                        "the first are refused, the last is accepted", expect_no_urgent_data},
                 pt(time_available, 500), used({1}, {"frames_missing", "sent_twice"})}},
               {.change = without_urgent_data}),
      on_chart(
          must_case("fieldbus_dll/ff_device/publisher/is_as_long_as_its_link_carries", "FF-39",
                    "A buffer has as many octets as the link carries.", memory("the longest DLSDU"),
                    {{"buffers_of_64", "buffer_wrong"}}),
          {{},
           {repeat({3, 36}, {stimulus<FfScene>(
                                 "the user writes 70 octets and 100, in turn, on a link that carries 100",
                                 [](FfScene& scene) {
                                   scene.written = {
                                       scene.bench.numbered_data(scene.turn % 2 == 0 ? 70 : kLongBuffer)};
                                   const bool is_taken =
                                       scene.bench.write(FfBench::kPublished, scene.written[0]);
                                   scene.judge.expect(is_taken, "write_refused", "the buffer is written",
                                                      "it was refused");
                                 }),
                             cd(), as_written()})}},
          {.change = with_long_buffers}),
      on_chart(
          must_case("fieldbus_dll/ff_device/publisher/each_of_many_is_published", "FF-13",
                    "A station publishes all buffers that it is set to.", own("lists of addresses"),
                    {{"four_buffers", "write_refused"}, {"thirty_two_buffers", "write_refused"}}),
          {{}, {FfStep{"forty buffers are written, a CD for each", "a DT3 of each", expect_each_buffer}}},
          {.change = with_many_buffers}),
      on_chart(
          must_case("fieldbus_dll/ff_device/publisher/each_of_many_is_delivered", "FF-11",
                    "A station delivers all buffers to which it has subscribed.", own("lists of addresses"),
                    {{"eight_subscriptions", "subscription_not_delivered"},
                     {"sixty_four_subscriptions", "subscription_not_delivered"}}),
          {{},
           {FfStep{"a DT3 of each of seventy publishers, to which it has subscribed", "all are delivered",
                   expect_each_subscription},
            serves()}},
          {.change = with_many_buffers}),
      on_chart(must_case("fieldbus_dll/ff_device/token/what_is_urgent_meanwhile_is_next", "FF-04",
                         "What is submitted during a token is sent in its order, too.",
                         own("what is next is decided before each DT1"),
                         {{"urgent_behind_those_of_the_token", "wrong_order"}}),
               {{},
                {submit({normal, normal, normal}, 10), pt(normal, 1'000), submit_meanwhile(urgent),
                 used({1, 4, 2, 3}, {"frames_missing", "sent_twice", "wrong_order"})}}),
      on_chart(must_case("fieldbus_dll/ff_device/token/what_comes_beside_the_last_waits", "FF-08",
                         "What is submitted while the last DT1 is sent waits for the next token.",
                         own("what is submitted is sent or refused"),
                         {{"lost_beside_the_last", "frames_missing"}}),
               {{2, 20},
                {submit({normal}, 10), pt(normal, 1'000), submit_meanwhile(normal), wait(40),
                 stimulus<FfScene>("the first DT1 is over", [](FfScene& scene) { scene.bench.listen(); }),
                 pt(normal, 1'000), used({0}, {"frames_missing", "sent_twice"})}}),
      on_chart(must_case("fieldbus_dll/ff_device/settings/a_node_above_7f_has_no_sign", "FF-38",
                         "The source of what a user submits is the link of its destination, with the node.",
                         own("addresses"), {{"node_with_sign", "source_wrong"}}),
               {{},
                {FfStep{"node 81; data for 00012230", "a DT1 from 00018101",
                        [](FfScene& scene) { expect_source(scene, kFarPeer, 0x0001'8101); }},
                 FfStep{"data for 2230", "a DT1 from 8101",
                        [](FfScene& scene) { expect_source(scene, FfBench::kPeersAddress, 0x8101); }}}},
               {.change = with_high_node}),
  };
}

}  // namespace fieldproof::conformance
