#include "harness/iut/message_device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>

#include <array>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "harness/iut/scripted_peer.hpp"

namespace fieldproof::iut {
namespace {

using std::chrono::milliseconds;
using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

constexpr PeerLimits kPatient{milliseconds(20'000), milliseconds(20'000)};
constexpr PeerLimits kHasty{milliseconds(20'000), milliseconds(60)};
// Within a call of this length a script has come to say something, however busy the machine is.
constexpr PeerLimits kShort{milliseconds(20'000), milliseconds(1'000)};

const RoleName kNode = kScriptedRole;
const CaseBegin kCase{"valve_bus/node/a/case", 1, {{"bit_rate", 375'000}}};

// Notes what is done to it.
class Notes final : public Bench {
 public:
  void set_driver(unsigned port, bool is_on, kernel::Time) override {
    done.push_back(fmt::format("driver {} {:d}", port, is_on));
  }
  void send(unsigned, kernel::Time, std::span<const std::uint16_t> characters) override {
    done.push_back(fmt::format("send {}", characters.size()));
  }
  void transmit(unsigned, line::Waveform& wave) override { done.push_back("transmit " + wave.levels.text()); }
  void write(Item item, std::uint64_t value, kernel::Time) override {
    done.push_back(fmt::format("write {} {}", item, value));
  }
  std::uint64_t read(Item, kernel::Time) override { return 0; }

  std::vector<std::string> done;
};

MessageDevice device_of(const Script& script, const PeerLimits& limits = kPatient) {
  return {Peer::spawned("exec:script", script.command()), kNode, limits};
}

// What an implementation is told to have done; the reason is empty when it did nothing.
struct Blame {
  std::string reason;
  std::string sentence;
  std::vector<std::string> evidence;
};

Blame blame_for(const std::function<void()>& act) {
  try {
    act();
  } catch (const Misbehaviour& done) {
    return {done.reason(), done.what(), done.evidence()};
  }
  return {};
}

std::string refusal_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Misbehaviour& done) {
    return "misbehaviour: " + std::string(done.what());
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::implementation);
    return error.what();
  }
  return {};
}

// Hello, the case has begun, and what the script says to the power.
Blame blame_for_power(Script& script, const PeerLimits& limits = kPatient) {
  return blame_for([&] {
    MessageDevice device = device_of(script, limits);
    Notes notes;
    ASSERT_TRUE(device.begin(kCase, notes));
    device.set_power(true, kernel::kStart);
  });
}

Script begun() {
  Script script;
  script.answers(capabilities_message()).answers(done_message());
  return script;
}

// Each call is answered at once, and there is no end of them.
TEST(MessageDeviceCase, ThatTakesLongerThanItMayIsAHang) {
  Script script = begun();
  script.answers(done_message()).answers(done_message()).stays();
  MessageDevice device = device_of(script, {milliseconds(20'000), milliseconds(20'000), milliseconds(1'500)});
  Notes notes;
  ASSERT_TRUE(device.begin(kCase, notes));
  const auto begin = Peer::Clock::now();
  std::this_thread::sleep_until(begin + milliseconds(1'550));
  const Blame blame = blame_for([&] { device.set_power(true, kernel::kStart); });
  EXPECT_EQ(blame.reason, reasons::kHangs);
  EXPECT_THAT(blame.sentence, HasSubstr("has not come to the end of a case within 1500 ms"));
}

TEST(MessageDeviceHello, TellsUnitAndName) {
  Script script;
  script.answers(capabilities_message(kMessageVersion, 2, "a\x1b[2J\xff")).stays();
  const MessageDevice device = device_of(script);
  EXPECT_EQ(device.unit_kind(), UnitKind::levels);
  EXPECT_EQ(device.own_name(), "a\\x1B[2J\\xFF");
}

TEST(MessageDeviceHello, OtherVersionIsRefusedWithBothNumbers) {
  Script script;
  script.answers(capabilities_message(1)).stays();
  EXPECT_EQ(refusal_of([&] { device_of(script); }),
            "exec:script speaks version 1 of the messages; this program speaks version 3");
}

TEST(MessageDeviceHello, UnitThatThereIsNotIsNoMessage) {
  Script script;
  script.answers(capabilities_message(kMessageVersion, 4)).stays();
  const Blame blame = blame_for([&] { device_of(script); });
  EXPECT_EQ(blame.reason, reasons::kGarbage);
  EXPECT_THAT(blame.sentence, HasSubstr("unit 4"));
}

TEST(MessageDeviceHello, AnswerOfAnotherTypeIsNamed) {
  Script script;
  script.answers(done_message()).stays();
  const Blame blame = blame_for([&] { device_of(script); });
  EXPECT_EQ(blame.reason, reasons::kGarbage);
  EXPECT_THAT(blame.sentence, HasSubstr("'capabilities' is expected"));
  EXPECT_THAT(blame.evidence, Contains("message: 83 FF FF FF FF FF FF FF 7F"));
}

TEST(MessageDeviceHello, TextInsteadOfMessagesIsShownAsText) {
  Script script;
  script.then("echo 'Hello world'").stays();
  const Blame blame = blame_for([&] { device_of(script); });
  EXPECT_EQ(blame.reason, reasons::kGarbage);
  EXPECT_THAT(blame.evidence, Contains(HasSubstr("\"Hello world.\"")));
}

// Whether the bench or the program is faster must not decide what is told.
TEST(MessageDeviceHello, WordsOfOneThatHasEndedAreShownToo) {
  Peer peer = Peer::spawned("exec:echo", {"/bin/echo", "Hello world"});
  while (peer.is_alive()) std::this_thread::sleep_for(milliseconds(1));
  const Blame blame = blame_for([&] { const MessageDevice device(std::move(peer), kNode, kPatient); });
  EXPECT_EQ(blame.reason, reasons::kGarbage);
  EXPECT_THAT(blame.evidence, Contains(HasSubstr("\"Hello world.\"")));
}

TEST(MessageDeviceHello, LengthOfNothingIsRefused) {
  Script script;
  script.says({0, 0, 0, 0}).stays();
  EXPECT_EQ(blame_for([&] { device_of(script); }).reason, reasons::kGarbage);
}

TEST(MessageDeviceHello, SilenceIsAHang) {
  Script script;
  script.stays();
  const Blame blame = blame_for([&] { device_of(script, {milliseconds(50), milliseconds(20'000)}); });
  EXPECT_EQ(blame.reason, reasons::kHangs);
  EXPECT_THAT(blame.sentence, HasSubstr("has not answered within 50 ms"));
}

// On a busy machine it may be the bench that is held up: what has come by then is an answer.
TEST(PeerTest, AnAnswerThatWaitsIsNoHang) {
  Peer peer = Peer::spawned("exec:printf", {"/usr/bin/printf", R"(\001\000\000\000\010)"});
  while (peer.is_alive()) std::this_thread::sleep_for(milliseconds(1));
  const auto message = peer.receive(milliseconds(50), Peer::Clock::now() - std::chrono::seconds(1));
  ASSERT_EQ(message.size(), 1U);
  EXPECT_EQ(message[0], 8);
}

TEST(MessageDeviceSelfTest, PassesOneThatAnswersAsItShould) {
  Script script;
  script.tests_itself().stays();
  MessageDevice device = device_of(script);
  device.test_itself();
  EXPECT_TRUE(device.is_quiet());
}

TEST(MessageDeviceSelfTest, OctetsThatATextStreamChangesAreSeen) {
  MessageOctets changed = echoed_message();
  changed.back() = 0x20;
  Script script;
  script.answers(capabilities_message()).answers(changed).stays();
  MessageDevice device = device_of(script);
  EXPECT_THAT(refusal_of([&] { device.test_itself(); }),
              StartsWith("exec:script does not send an echo back as it came (message: 82 00 FF 0A"));
}

TEST(MessageDeviceSelfTest, WhoTakesAnyCaseIsRefused) {
  Script script;
  script.answers(capabilities_message()).answers(echoed_message()).answers(done_message()).stays();
  MessageDevice device = device_of(script);
  EXPECT_THAT(refusal_of([&] { device.test_itself(); }),
              HasSubstr("takes the case 'self_test/unknown/case'"));
}

TEST(MessageDeviceCall, ActsUntilItIsDone) {
  constexpr kernel::Time kNext{kernel::kMillisecond};
  MessageWriter writer;
  line::Waveform wave;
  wave.levels.append(0b0110, 4);
  Script script = begun();
  script.answers(write_message(0, 77, kernel::kStart))
      .says(octets_of(write_driver(writer, {0, true, kernel::kStart})))
      .says(octets_of(write_characters(writer, 0, kernel::kStart, std::array<std::uint16_t, 3>{1, 2, 3})))
      .says(octets_of(write_levels(writer, MessageType::transmit_levels, 0, wave)))
      .says(done_message(kNext))
      .answers(done_message())
      .answers(echoed_nothing_message())
      .stays();
  MessageDevice device = device_of(script);
  Notes notes;
  ASSERT_TRUE(device.begin(kCase, notes));
  EXPECT_EQ(device.next_time(), kernel::kNever);
  device.set_power(true, kernel::kStart);
  EXPECT_EQ(device.next_time(), kNext);
  EXPECT_THAT(notes.done, testing::ElementsAre("write 0 77", "driver 0 1", "send 3", "transmit 0110"));
  device.end();
  EXPECT_TRUE(device.is_quiet());
}

TEST(MessageDeviceCall, ActivityIsACallOfOneThatAsksForIt) {
  MessageWriter writer;
  const PeerCapabilities asks{.unit = 1, .name = "script", .roles = {kNode}, .senses_activity = true};
  Script script;
  script.answers(octets_of(write_capabilities(writer, asks))).answers(done_message());
  script.answers(write_message(3, 1, kernel::kStart)).says(done_message()).stays();
  MessageDevice device = device_of(script);
  EXPECT_TRUE(device.capabilities().senses_activity);
  Notes notes;
  ASSERT_TRUE(device.begin(kCase, notes));
  device.on_activity(0, true, kernel::kStart);
  EXPECT_THAT(notes.done, testing::ElementsAre("write 3 1"));
  EXPECT_FALSE(device_of(begun()).capabilities().senses_activity);
}

TEST(MessageDeviceCall, RefusedCaseIsNoMisbehaviourAndItCanBeAskedAgain) {
  Script script;
  script.answers(capabilities_message()).answers(unsupported_message()).answers(done_message()).stays();
  MessageDevice device = device_of(script);
  Notes notes;
  EXPECT_FALSE(device.begin(kCase, notes));
  EXPECT_TRUE(device.begin(kCase, notes));
}

TEST(MessageDeviceCall, UnsupportedIsNoAnswerToAnythingElse) {
  Script script = begun();
  script.answers(unsupported_message()).stays();
  const Blame blame = blame_for_power(script);
  EXPECT_EQ(blame.reason, reasons::kGarbage);
  EXPECT_THAT(blame.sentence, HasSubstr("'unsupported' is nothing that an implementation says here"));
}

TEST(MessageDeviceCall, NothingCanBeDoneWhileACaseEnds) {
  Script script = begun();
  script.answers(write_message(0, 1, kernel::kStart)).says(done_message()).stays();
  MessageDevice device = device_of(script);
  Notes notes;
  ASSERT_TRUE(device.begin(kCase, notes));
  const Blame blame = blame_for([&] { device.end(); });
  EXPECT_EQ(blame.reason, reasons::kGarbage);
  EXPECT_THAT(blame.sentence, HasSubstr("'write' is nothing that an implementation says without a case"));
  EXPECT_TRUE(notes.done.empty());
}

TEST(MessageDeviceCall, ContentThatIsTooShortOrTooLongIsShown) {
  for (const MessageOctets& wrong : {MessageOctets{4, 0, 0, 0, 131, 1, 2, 3},
                                     MessageOctets{11, 0, 0, 0, 131, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9}}) {
    Script script = begun();
    script.answers(wrong).stays();
    const Blame blame = blame_for_power(script);
    EXPECT_EQ(blame.reason, reasons::kGarbage);
    EXPECT_THAT(blame.evidence, Contains(StartsWith("message: 83 01 02 03")));
  }
}

TEST(MessageDeviceCall, MessageOfTheBenchIsNothingThatAnImplementationSays) {
  Script script = begun();
  script.answers({1, 0, 0, 0, 8}).stays();
  EXPECT_THAT(blame_for_power(script).sentence, HasSubstr("'case end' is nothing"));
}

TEST(MessageDeviceCall, SilenceIsAHang) {
  Script script = begun();
  script.stays();
  // The case has begun by then however slow the machine is.
  MessageDevice device = device_of(script, kHasty);
  Notes notes;
  const Blame blame = blame_for([&] {
    device.begin(kCase, notes);
    device.set_power(true, kernel::kStart);
  });
  EXPECT_EQ(blame.reason, reasons::kHangs);
  EXPECT_EQ(blame.sentence, "exec:script has not answered within 60 ms");
  EXPECT_FALSE(device.is_quiet());
}

TEST(MessageDeviceCall, DoingSomethingNowAndThenIsAHangToo) {
  Script script;
  script.answers(capabilities_message())
      .then("while sleep 0.01; do " + Script::saying(write_message(0, 1, kernel::kStart)) + "; done");
  MessageDevice device = device_of(script, kShort);
  Notes notes;
  EXPECT_EQ(blame_for([&] { device.begin(kCase, notes); }).reason, reasons::kHangs);
  EXPECT_FALSE(notes.done.empty());
}

TEST(MessageDeviceCall, WhoDoesNotReadHangs) {
  Script script;
  script.answers(capabilities_message()).then("sleep 1000");
  MessageDevice device = device_of(script, kHasty);
  line::Waveform wave;
  wave.levels.append_idle(4'000'000);  // more than a pipe holds
  const Blame blame = blame_for([&] { device.receive(0, wave); });
  EXPECT_EQ(blame.reason, reasons::kHangs);
  EXPECT_THAT(blame.sentence, HasSubstr("does not take what it is sent"));
}

TEST(MessageDeviceCall, ActionsWithoutEndAreAFlood) {
  Script script = begun();
  script.hears().then("while " + Script::saying(write_message(0, 1, kernel::kStart)) + "; do :; done");
  const Blame blame = blame_for_power(script);
  EXPECT_EQ(blame.reason, reasons::kFloods);
  EXPECT_THAT(blame.sentence, HasSubstr("more than 20000 things within one call"));
}

// Each of them is a message that may be: together they would fill the memory.
TEST(MessageDeviceCall, OctetsWithoutEndAreAFlood) {
  MessageWriter writer;
  const std::vector<std::uint16_t> characters(20'000, 0x155);
  const MessageOctets message = octets_of(write_characters(writer, 0, kernel::kStart, characters));
  const ScriptFolder folder;
  std::ofstream(folder.file("message"))
      .write(reinterpret_cast<const char*>(message.data()), static_cast<std::streamsize>(message.size()));
  Script script = begun();
  script.hears().then("while cat " + folder.file("message") + "; do :; done");
  const Blame blame = blame_for_power(script);
  EXPECT_EQ(blame.reason, reasons::kFloods);
  EXPECT_THAT(blame.sentence, HasSubstr("more than 8388608 octets within one call"));
}

TEST(MessageDeviceEnd, CrashIsToldWithTheEndOfTheLogAsPlainText) {
  Script script = begun();
  script.hears().then("i=0; while [ $i -lt 20 ]; do echo line $i >&2; i=$((i+1)); done");
  script.then("printf 'red\\033[2J\\n' >&2; kill -SEGV $$");
  const Blame blame = blame_for_power(script);
  EXPECT_EQ(blame.reason, reasons::kCrashed);
  EXPECT_THAT(blame.sentence, StartsWith("exec:script was ended by signal 11"));
  ASSERT_EQ(blame.evidence.size(), 12U);
  EXPECT_EQ(blame.evidence.front(), "log: line 9");
  EXPECT_EQ(blame.evidence.back(), "log: red\\x1B[2J");
}

TEST(MessageDeviceEnd, OrderlyEndWithinACaseIsACrash) {
  Script script = begun();
  script.hears().then("exit 0");
  EXPECT_EQ(blame_for_power(script).sentence, "exec:script ended with exit code 0");
}

TEST(MessageDeviceEnd, ClosedOutputOfOneThatGoesOnIsTold) {
  Script script = begun();
  script.hears().then("exec 1>&-; sleep 1000");
  const Blame blame = blame_for_power(script);
  EXPECT_EQ(blame.reason, reasons::kGone);
  EXPECT_THAT(blame.sentence, HasSubstr("closed its standard output"));
}

TEST(MessageDeviceEnd, LogWithoutEndDoesNotKeepTheBench) {
  Script script = begun();
  script.then("while echo xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx >&2; do :; done");
  MessageDevice device = device_of(script, kShort);
  Notes notes;
  const Blame blame = blame_for([&] {
    device.begin(kCase, notes);
    device.set_power(true, kernel::kStart);
  });
  EXPECT_EQ(blame.reason, reasons::kHangs);
  EXPECT_EQ(blame.evidence.size(), 12U);
}

TEST(MessageDeviceEnd, ProgramThatCannotBeStartedIsNamed) {
  EXPECT_THAT(refusal_of([] { Peer::spawned("exec:x", {"./there_is_no_such_program"}); }),
              StartsWith("'./there_is_no_such_program' cannot be started: "));
}

TEST(MessageDeviceAtSocket, SpeaksToWhoListensAtAPath) {
  const ScriptFolder folder;
  const Listener listener(folder.file("s"));
  Peer peer = Peer::at_unix_socket("unix:s", listener.path());
  Descriptor other = listener.accept_and_say({capabilities_message()});
  MessageDevice device(std::move(peer), kNode, kPatient);
  const MessageOctets done = done_message();
  ASSERT_EQ(::write(other.number(), done.data(), done.size()), static_cast<ssize_t>(done.size()));
  Notes notes;
  EXPECT_TRUE(device.begin(kCase, notes));
  EXPECT_TRUE(device.is_quiet());
  other.close();
  EXPECT_FALSE(device.peer().is_alive());
  const Blame blame = blame_for([&] { device.set_power(true, kernel::kStart); });
  EXPECT_EQ(blame.reason, reasons::kGone);
  EXPECT_FALSE(device.is_quiet());
}

TEST(MessageDeviceAtSocket, PathWhereNobodyListensIsNamed) {
  const ScriptFolder folder;
  for (const std::string& path : {folder.file("nobody"), std::string(), std::string(200, 'x')}) {
    EXPECT_THAT(refusal_of([&] { Peer::at_unix_socket("unix:" + path, path); }),
                StartsWith("unix:" + path + ": nobody can be reached there: "));
  }
}

// A port of this machine that nobody else has.
struct TcpListener {
  Descriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  std::string port;

  TcpListener() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (::bind(socket.number(), any, size) != 0 || ::listen(socket.number(), 1) != 0) std::abort();
    if (::getsockname(socket.number(), any, &size) != 0) std::abort();
    port = std::to_string(ntohs(address.sin_port));
  }
};

TEST(MessageDeviceAtSocket, SpeaksToWhoListensAtAPort) {
  const TcpListener listener;
  Peer peer = Peer::at_tcp_port("tcp:here", "127.0.0.1", listener.port, milliseconds(20'000));
  const Descriptor other(::accept4(listener.socket.number(), nullptr, nullptr, SOCK_CLOEXEC));
  const MessageOctets hello = capabilities_message(kMessageVersion, 1, "far");
  ASSERT_EQ(::write(other.number(), hello.data(), hello.size()), static_cast<ssize_t>(hello.size()));
  const MessageDevice device(std::move(peer), kNode, kPatient);
  EXPECT_EQ(device.own_name(), "far");
}

TEST(MessageDeviceAtSocket, PortWhereNobodyListensIsNamed) {
  std::string port;
  {
    const TcpListener gone;
    port = gone.port;
  }
  EXPECT_THAT(refusal_of([&] { Peer::at_tcp_port("tcp:here", "127.0.0.1", port, milliseconds(20'000)); }),
              StartsWith("tcp:here: nobody can be reached there: "));
}

}  // namespace
}  // namespace fieldproof::iut
