#include "harness/iut/server.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <string>
#include <thread>
#include <vector>

#include "harness/iut/scripted_peer.hpp"

namespace fieldproof::iut {
namespace {

using Lines = std::vector<std::string>;

std::int64_t ticks(kernel::Time time) {
  return time.time_since_epoch().count();
}

kernel::Time some_time() {
  return kernel::Time{kernel::Duration{*rc::gen::arbitrary<std::int64_t>()}};
}

line::Waveform some_wave() {
  line::Waveform wave;
  wave.start = some_time();
  wave.rate = *rc::gen::inRange<std::int64_t>(1, 1'000'000);
  for (const bool level : *rc::gen::arbitrary<std::vector<bool>>()) wave.levels.append(level ? 1 : 0, 1);
  return wave;
}

std::string text_of(const line::Waveform& wave) {
  return fmt::format("{} {} {}", ticks(wave.start), wave.rate, wave.levels.text());
}

// Writes down what it is told, and with each call does something that its bench must hear of.
class WritingDevice final : public Device {
 public:
  explicit WritingDevice(Lines& lines) : lines_(lines) {}

  UnitKind unit_kind() const override { return UnitKind::levels; }
  Capabilities capabilities() const override { return {.senses_activity = true}; }
  bool begin(const CaseBegin& begin, Bench& bench) override {
    bench_ = &bench;
    std::string text = fmt::format("begin {} {}", begin.id, begin.seed);
    for (const auto& [name, value] : begin.settings) text += fmt::format(" {}={}", name, value);
    lines_.push_back(text);
    return begin.seed != 0;
  }
  void set_power(bool is_on, kernel::Time now) override {
    lines_.push_back(fmt::format("power {} {}", is_on, ticks(now)));
    bench_->write(3, 1ULL << 63, now);
  }
  void receive(unsigned port, std::span<const Character> characters, kernel::Time now) override {
    std::string text = fmt::format("characters {} {}", port, ticks(now));
    std::vector<std::uint16_t> answer;
    for (const Character& one : characters) {
      text += fmt::format(" {} {} {:X} {:d}{:d}", ticks(one.start), ticks(one.busy_until), one.data,
                          one.is_parity_wrong, one.is_stop_missing);
      answer.push_back(one.data);
    }
    lines_.push_back(text);
    bench_->set_driver(port, answer.size() % 2 == 1, now);
    bench_->send(port, now, answer);
  }
  void receive(unsigned port, const line::Waveform& reception) override {
    lines_.push_back(fmt::format("levels {} {}", port, text_of(reception)));
    line::Waveform answer = reception;
    bench_->transmit(port + 1, answer);
    EXPECT_TRUE(answer.levels.empty()) << "who transmits gets an empty wave back";
  }
  void on_activity(unsigned port, bool begins, kernel::Time now) override {
    lines_.push_back(fmt::format("activity {} {} {}", port, begins, ticks(now)));
    next_ = now;
  }
  void on_time(kernel::Time now) override {
    lines_.push_back(fmt::format("time {}, input {}", ticks(now), bench_->read(9, now)));
    next_ = now;
  }
  kernel::Time next_time() const override { return next_; }
  void end() override { lines_.push_back("end"); }

 private:
  Lines& lines_;
  Bench* bench_ = nullptr;
  kernel::Time next_ = kernel::kNever;
};

class WritingBench final : public Bench {
 public:
  explicit WritingBench(Lines& lines) : lines_(lines) {}

  void set_driver(unsigned port, bool is_on, kernel::Time at) override {
    lines_.push_back(fmt::format("driver {} {:d} {}", port, is_on, ticks(at)));
  }
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override {
    std::string text = fmt::format("sends {} {}", port, ticks(start));
    for (const std::uint16_t character : characters) text += fmt::format(" {:X}", character);
    lines_.push_back(text);
  }
  void transmit(unsigned port, line::Waveform& wave) override {
    lines_.push_back(fmt::format("drives {} {}", port, text_of(wave)));
    wave.levels.clear();
  }
  void write(Item item, std::uint64_t value, kernel::Time when) override {
    lines_.push_back(fmt::format("writes {} {} {}", item, value, ticks(when)));
  }
  std::uint64_t read(Item item, kernel::Time when) override {
    lines_.push_back(fmt::format("reads {} {}", item, ticks(when)));
    return lines_.size() * 0x0102030405060708ULL;
  }

 private:
  Lines& lines_;
};

// One call, to be made on two devices.
using DeviceCall = std::function<void(Device&, Bench&, Lines&)>;

DeviceCall some_call() {
  const kernel::Time now = some_time();
  switch (*rc::gen::inRange(0, 6)) {
    case 0: {
      // Seed 0: a case that the device refuses. What follows goes to the one that has begun again.
      CaseBegin begin{"valve_bus/node/x", *rc::gen::inRange<std::uint64_t>(0, 3), {{"a", 1}}};
      begin.settings.emplace_back(*rc::gen::arbitrary<std::string>(), *rc::gen::arbitrary<std::int64_t>());
      return [begin](Device& device, Bench& bench, Lines& lines) {
        lines.push_back(fmt::format("served {}", device.begin(begin, bench)));
        if (begin.seed == 0) device.begin({"valve_bus/node/again", 1, {}}, bench);
      };
    }
    case 1:
      return [now](Device& device, Bench&, Lines&) { device.set_power(true, now); };
    case 2: {
      const auto data = *rc::gen::arbitrary<std::vector<std::uint16_t>>();
      std::vector<Character> characters;
      for (const std::uint16_t one : data) characters.push_back({now, now, one, one % 2 == 1, one % 3 == 1});
      return [=](Device& device, Bench&, Lines&) { device.receive(2, characters, now); };
    }
    case 3: {
      const bool begins = *rc::gen::arbitrary<bool>();
      return [=](Device& device, Bench&, Lines&) { device.on_activity(5, begins, now); };
    }
    case 4: {
      const line::Waveform wave = some_wave();
      return [wave](Device& device, Bench&, Lines&) { device.receive(4, wave); };
    }
    default:
      return [now](Device& device, Bench&, Lines& lines) {
        device.on_time(now);
        lines.push_back(fmt::format("next {}", ticks(device.next_time())));
      };
  }
}

// What both sides saw when these calls were made.
struct Seen {
  Lines device;
  Lines bench;

  friend bool operator==(const Seen&, const Seen&) = default;
};

void make_calls(const std::vector<DeviceCall>& calls, Device& device, Seen& seen) {
  WritingBench bench(seen.bench);
  seen.bench.push_back(fmt::format("served {}", device.begin({"valve_bus/node/first", 1, {}}, bench)));
  for (const DeviceCall& call : calls) call(device, bench, seen.bench);
  device.end();
}

Seen seen_directly(const std::vector<DeviceCall>& calls) {
  Seen seen;
  WritingDevice device(seen.device);
  make_calls(calls, device, seen);
  return seen;
}

const RoleName kServed{"valve_bus", "node"};

Seen seen_through_messages(const std::vector<DeviceCall>& calls) {
  Seen seen;
  const ScriptFolder folder;
  const Listener listener(folder.file("s"));
  std::thread server([&] {
    const Descriptor connection = listener.accept();
    serve(
        connection.number(), connection.number(), kServed,
        [&](const RoleName&) { return std::make_unique<WritingDevice>(seen.device); }, "writing device");
  });
  {
    constexpr std::chrono::milliseconds kPatience{20'000};
    MessageDevice device(Peer::at_unix_socket("unix:s", listener.path()), {"valve_bus", "node"},
                         {kPatience, kPatience});
    EXPECT_EQ(device.own_name(), "writing device");
    EXPECT_EQ(device.unit_kind(), UnitKind::levels);
    device.test_itself();
    make_calls(calls, device, seen);
  }
  server.join();
  return seen;
}

RC_GTEST_PROP(ServerThreads, BothSidesSeeTheSameCallsAsWithoutMessages, ()) {
  std::vector<DeviceCall> calls;
  const auto count = *rc::gen::inRange(0, 12);
  for (int n = 0; n < count; ++n) calls.push_back(some_call());
  RC_ASSERT(seen_through_messages(calls) == seen_directly(calls));
}

// All that the bench says is there before the server begins, so nobody waits for anybody.
std::string refusal_of_server(const std::vector<MessageOctets>& words, const MakeDevice& make_device) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return "no sockets";
  const Descriptor bench(ends[0]);
  const Descriptor server(ends[1]);
  for (const MessageOctets& octets : words) {
    if (::write(bench.number(), octets.data(), octets.size()) < 0) return "not written";
  }
  ::shutdown(bench.number(), SHUT_WR);
  try {
    serve(server.number(), server.number(), kServed, make_device, "server");
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::implementation);
    return error.what();
  }
  return {};
}

std::string refusal_of_server(const std::vector<MessageOctets>& words) {
  Lines lines;
  return refusal_of_server(words, [&](const RoleName&) { return std::make_unique<WritingDevice>(lines); });
}

MessageOctets hello_message() {
  MessageWriter writer;
  return octets_of(
      writer.begin(MessageType::hello).u16(kMessageVersion).text("valve_bus").text("node").finish());
}
MessageOctets begin_message(const std::string& id) {
  MessageWriter writer;
  return octets_of(write_case_begin(writer, {id, 1, {}}));
}
MessageOctets power_message() {
  MessageWriter writer;
  return octets_of(writer.begin(MessageType::power).u8(1).time(kernel::kStart).finish());
}
MessageOctets end_message() {
  MessageWriter writer;
  return octets_of(writer.begin(MessageType::case_end).finish());
}

TEST(ServerTest, EndsWithTheBench) {
  EXPECT_EQ(refusal_of_server({}), "");
  EXPECT_EQ(refusal_of_server({hello_message(), begin_message("valve_bus/node/x"), power_message()}), "");
}

TEST(ServerTest, BenchThatDoesNotKeepToTheOrderIsRefused) {
  const std::string prefix = "what comes from the bench is no message: ";
  EXPECT_EQ(refusal_of_server({power_message()}), prefix + "the first one is 'hello'");
  EXPECT_EQ(refusal_of_server({hello_message(), power_message()}),
            prefix + "'power' is for a case that has begun");
  EXPECT_EQ(refusal_of_server({hello_message(), begin_message("other/node/x"), power_message()}),
            prefix + "'power' is for a case that has begun");
  EXPECT_EQ(
      refusal_of_server({hello_message(), begin_message("valve_bus/node/x"), end_message(), power_message()}),
      prefix + "'power' is for a case that has begun");
  EXPECT_EQ(refusal_of_server({hello_message(), begin_message("valve_bus/node/x"), done_message()}),
            prefix + "'done' is nothing that a bench says here");
}

TEST(ServerTest, MessageThatIsNoneIsRefused) {
  EXPECT_NE(refusal_of_server({{0, 0, 0, 0}}).find("a length of 0 octets"), std::string::npos);
  EXPECT_NE(refusal_of_server({{0, 0, 0, 1}}).find("a length of 16777216 octets"), std::string::npos);
  MessageOctets half = hello_message();
  half.resize(half.size() / 2);
  EXPECT_NE(refusal_of_server({half}).find("it ends in the middle"), std::string::npos);
  half.resize(2);
  EXPECT_NE(refusal_of_server({half}).find("it ends in the middle"), std::string::npos);
}

TEST(ServerTest, RoleThatIsNotServedIsAnsweredUnsupported) {
  const std::string refusal = refusal_of_server(
      {hello_message()}, [](const RoleName&) -> std::unique_ptr<Device> { return nullptr; });
  EXPECT_EQ(refusal, "");  // the bench is told, and may ask for another one
}

}  // namespace
}  // namespace fieldproof::iut
