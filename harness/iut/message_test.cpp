#include "harness/iut/message.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace fieldproof::iut {
namespace {

using Octets = std::vector<std::uint8_t>;

// What a reader is given: the message without its length.
Octets body_of(std::span<const std::uint8_t> message) {
  return {message.begin() + kMessageHead, message.end()};
}

kernel::Time any_time() {
  return kernel::Time{kernel::Duration{*rc::gen::arbitrary<std::int64_t>()}};
}

std::vector<Character> any_characters() {
  std::vector<Character> characters(*rc::gen::inRange<std::size_t>(0, 40));
  for (Character& one : characters) {
    one = {any_time(), any_time(), *rc::gen::arbitrary<std::uint16_t>(), *rc::gen::arbitrary<bool>(),
           *rc::gen::arbitrary<bool>()};
  }
  return characters;
}

CaseBegin any_case_begin() {
  CaseBegin begin;
  begin.id = *rc::gen::arbitrary<std::string>();
  begin.seed = *rc::gen::arbitrary<std::uint64_t>();
  begin.settings.resize(*rc::gen::inRange<std::size_t>(0, 12));
  for (auto& [name, value] : begin.settings) {
    name = *rc::gen::arbitrary<std::string>();
    value = *rc::gen::arbitrary<std::int64_t>();
  }
  return begin;
}

std::vector<std::uint16_t> any_sent() {
  return *rc::gen::arbitrary<std::vector<std::uint16_t>>();
}

DriverSwitch any_driver() {
  return {*rc::gen::arbitrary<std::uint8_t>(), *rc::gen::arbitrary<bool>(), any_time()};
}

line::Waveform any_wave() {
  line::Waveform wave;
  wave.start = any_time();
  wave.rate = *rc::gen::inRange<std::int64_t>(1, 100'000'000'001);
  for (const bool level : *rc::gen::arbitrary<std::vector<bool>>()) wave.levels.append(level ? 1 : 0, 1);
  return wave;
}

// Each reader of a whole content, for what all of them must refuse.
struct ContentReader {
  const char* name;
  std::function<Octets()> any_body;
  std::function<void(MessageReader&)> read;
};

void read_into_wave(MessageReader& reader) {
  line::Waveform wave;
  read_levels(reader, wave);
}

const std::vector<ContentReader>& content_readers() {
  static const std::vector<ContentReader> all = {
      {"case begin",
       [] {
         MessageWriter writer;
         return body_of(write_case_begin(writer, any_case_begin()));
       },
       [](MessageReader& reader) { read_case_begin(reader); }},
      {"reception",
       [] {
         MessageWriter writer;
         return body_of(write_reception(writer, 0, any_characters(), any_time()));
       },
       [](MessageReader& reader) { read_reception(reader); }},
      {"characters",
       [] {
         MessageWriter writer;
         return body_of(write_characters(writer, 3, any_time(), any_sent()));
       },
       [](MessageReader& reader) { read_characters(reader); }},
      {"activity",
       [] {
         MessageWriter writer;
         return body_of(write_activity(writer, {3, true, any_time()}));
       },
       [](MessageReader& reader) { read_activity(reader); }},
      {"driver",
       [] {
         MessageWriter writer;
         return body_of(write_driver(writer, any_driver()));
       },
       [](MessageReader& reader) { read_driver(reader); }},
      {"levels",
       [] {
         MessageWriter writer;
         return body_of(write_levels(writer, MessageType::transmit_levels, 0, any_wave()));
       },
       read_into_wave},
  };
  return all;
}

RC_GTEST_PROP(MessageTest, CaseBeginComesBack, ()) {
  const CaseBegin begin = any_case_begin();
  MessageWriter writer;
  const Octets body = body_of(write_case_begin(writer, begin));
  MessageReader reader(body);
  RC_ASSERT(reader.type() == MessageType::case_begin);
  const CaseBegin read = read_case_begin(reader);
  RC_ASSERT(read.id == begin.id);
  RC_ASSERT(read.seed == begin.seed);
  RC_ASSERT(read.settings == begin.settings);
}

RC_GTEST_PROP(MessageTest, ReceptionComesBack, ()) {
  const auto characters = any_characters();
  const auto port = *rc::gen::arbitrary<std::uint8_t>();
  const kernel::Time now = any_time();
  MessageWriter writer;
  const Octets body = body_of(write_reception(writer, port, characters, now));
  MessageReader reader(body);
  RC_ASSERT(reader.type() == MessageType::receive_characters);
  const ReceivedCharacters read = read_reception(reader);
  RC_ASSERT(read.port == port);
  RC_ASSERT(read.now == now);
  RC_ASSERT(read.characters == characters);
}

RC_GTEST_PROP(MessageTest, CharactersComeBack, ()) {
  const SentCharacters sent{*rc::gen::arbitrary<std::uint8_t>(), any_time(), any_sent()};
  MessageWriter writer;
  const Octets body = body_of(write_characters(writer, sent.port, sent.start, sent.characters));
  MessageReader reader(body);
  RC_ASSERT(reader.type() == MessageType::characters);
  RC_ASSERT(read_characters(reader) == sent);
}

RC_GTEST_PROP(MessageTest, DriverComesBack, ()) {
  const DriverSwitch driver = any_driver();
  MessageWriter writer;
  const Octets body = body_of(write_driver(writer, driver));
  MessageReader reader(body);
  RC_ASSERT(reader.type() == MessageType::driver);
  RC_ASSERT(read_driver(reader) == driver);
}

RC_GTEST_PROP(MessageTest, ActivityComesBack, (bool begins, std::uint8_t port)) {
  const LineActivity activity{port, begins, any_time()};
  MessageWriter writer;
  const Octets body = body_of(write_activity(writer, activity));
  MessageReader reader(body);
  RC_ASSERT(reader.type() == MessageType::activity);
  RC_ASSERT(read_activity(reader) == activity);
}

TEST(MessageTest, ActivityThatNeitherBeginsNorEndsIsRefused) {
  MessageWriter writer;
  const Octets body = body_of(writer.begin(MessageType::activity).u8(0).u8(2).time(kernel::kStart).finish());
  MessageReader reader(body);
  EXPECT_THROW(read_activity(reader), MessageError);
}

// Who asks for activity says so after its roles; who does not may be older than that.
TEST(MessageTest, CapabilitiesAskForActivityWithOneOctet) {
  MessageWriter writer;
  PeerCapabilities asks{.unit = 1, .name = "a", .roles = {{"p", "r"}}, .senses_activity = true};
  const Octets with = body_of(write_capabilities(writer, asks));
  asks.senses_activity = false;
  const Octets without = body_of(write_capabilities(writer, asks));
  EXPECT_EQ(with.size(), without.size() + 1);
  EXPECT_EQ(with.back(), 1);
  MessageReader asking(with);
  EXPECT_TRUE(read_capabilities(asking).senses_activity);
  MessageReader older(without);
  EXPECT_FALSE(read_capabilities(older).senses_activity);
  for (const std::uint8_t wrong : std::array<std::uint8_t, 2>{0, 2}) {
    Octets other = with;
    other.back() = wrong;
    MessageReader reader(other);
    EXPECT_THROW(read_capabilities(reader), MessageError);
  }
}

TEST(MessageTest, DriverThatIsNeitherOnNorOffIsRefused) {
  MessageWriter writer;
  const Octets body = body_of(writer.begin(MessageType::driver).u8(0).u8(2).time(kernel::kStart).finish());
  MessageReader reader(body);
  try {
    read_driver(reader);
    FAIL() << "is taken";
  } catch (const MessageError& error) {
    EXPECT_STREQ(error.what(), "'on' of a driver is 2; there are 0 (off) and 1 (on)");
  }
}

RC_GTEST_PROP(MessageTest, LevelsComeBackIntoAUsedWave, ()) {
  const line::Waveform sent = any_wave();
  const auto type = *rc::gen::element(MessageType::receive_levels, MessageType::transmit_levels);
  MessageWriter writer;
  const Octets body = body_of(write_levels(writer, type, 7, sent));
  MessageReader reader(body);
  RC_ASSERT(reader.type() == type);
  line::Waveform read = any_wave();
  RC_ASSERT(read_levels(reader, read) == 7U);
  RC_ASSERT(read.start == sent.start);
  RC_ASSERT(read.rate == sent.rate);
  RC_ASSERT(read.levels == sent.levels);
}

RC_GTEST_PROP(MessageTest, NumbersComeBackLowestOctetFirst, ()) {
  const auto word = *rc::gen::arbitrary<std::uint64_t>();
  const auto half = static_cast<std::uint32_t>(word);
  const auto signed_word = *rc::gen::arbitrary<std::int64_t>();
  const auto text = *rc::gen::arbitrary<std::string>();
  MessageWriter writer;
  const Octets body =
      body_of(writer.begin(MessageType::value).u64(word).u32(half).i64(signed_word).text(text).finish());
  RC_ASSERT(body[1] == (word & 0xFF));
  RC_ASSERT(body[8] == word >> 56);
  MessageReader reader(body);
  RC_ASSERT(reader.u64() == word);
  RC_ASSERT(reader.u32() == half);
  RC_ASSERT(reader.i64() == signed_word);
  RC_ASSERT(reader.text() == text);
  reader.finish();
}

RC_GTEST_PROP(MessageTest, ShorterMessageIsRefused, ()) {
  const ContentReader& one = *rc::gen::elementOf(content_readers());
  const Octets body = one.any_body();
  const auto kept = *rc::gen::inRange<std::size_t>(1, body.size());
  RC_LOG() << one.name << ", " << kept << " of " << body.size() << " octets\n";
  const Octets part(body.begin(), body.begin() + static_cast<std::ptrdiff_t>(kept));
  MessageReader reader(part);
  RC_ASSERT_THROWS_AS(one.read(reader), MessageError);
}

RC_GTEST_PROP(MessageTest, LongerMessageIsRefused, ()) {
  const ContentReader& one = *rc::gen::elementOf(content_readers());
  Octets body = one.any_body();
  body.resize(body.size() + *rc::gen::inRange<std::size_t>(1, 20));
  RC_LOG() << one.name << "\n";
  MessageReader reader(body);
  RC_ASSERT_THROWS_AS(one.read(reader), MessageError);
}

// Under AddressSanitizer that is the whole claim: neither a crash nor an octet beyond the end.
RC_GTEST_PROP(MessageTest, AnyOctetsAreReadOrRefused, (Octets body)) {
  body.push_back(0);
  for (const ContentReader& one : content_readers()) {
    MessageReader reader(body);
    try {
      one.read(reader);
    } catch (const MessageError& error) {
      RC_ASSERT(!std::string(error.what()).empty());
    }
  }
}

TEST(MessageTest, LengthCountsWhatStandsBehindIt) {
  MessageWriter writer;
  const auto message = writer.begin(MessageType::done).time(kernel::Time{kernel::Duration{0x0102}}).finish();
  EXPECT_EQ(Octets(message.begin(), message.end()), (Octets{9, 0, 0, 0, 131, 2, 1, 0, 0, 0, 0, 0, 0}));
  const auto next = writer.begin(MessageType::unsupported).finish();
  EXPECT_EQ(Octets(next.begin(), next.end()), (Octets{1, 0, 0, 0, 132}));
}

TEST(MessageTest, EmptyMessageHasNoType) {
  EXPECT_THROW(MessageReader({}), MessageError);
}

TEST(MessageTest, LongTextIsCutAtWhatItsLengthCanSay) {
  MessageWriter writer;
  const Octets body = body_of(writer.begin(MessageType::hello).text(std::string(70'000, 'a')).u8(7).finish());
  MessageReader reader(body);
  EXPECT_EQ(reader.text(), std::string(0xFFFF, 'a'));
  EXPECT_EQ(reader.u8(), 7);
}

TEST(MessageTest, RateThatNoLineHasIsRefused) {
  line::Waveform wave;
  wave.levels.append(1, 1);
  for (const std::int64_t rate : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{100'000'000'001}}) {
    wave.rate = rate;
    MessageWriter writer;
    const Octets body = body_of(write_levels(writer, MessageType::transmit_levels, 0, wave));
    MessageReader reader(body);
    EXPECT_THROW(read_into_wave(reader), MessageError) << rate;
  }
}

TEST(MessageTest, ListOfSettingsMayBeLong) {
  CaseBegin begin{"a/b/c", 1, {}};
  for (int n = 1; n <= 5000; ++n) begin.settings.emplace_back("schedule_items_" + std::to_string(n), n);
  MessageWriter writer;
  const Octets body = body_of(write_case_begin(writer, begin));
  MessageReader reader(body);
  EXPECT_EQ(read_case_begin(reader).settings, begin.settings);
}

TEST(MessageTest, MoreSettingsThanFollowAreRefused) {
  MessageWriter writer;
  writer.begin(MessageType::case_begin).text("a/b/c").u64(1).u16(0xFFFF);
  writer.text("x").i64(1);
  const Octets body = body_of(writer.finish());
  MessageReader reader(body);
  EXPECT_THROW(read_case_begin(reader), MessageError);
}

TEST(MessageTest, TypesHaveNames) {
  EXPECT_EQ(name(MessageType::characters), "characters");
  EXPECT_EQ(name(static_cast<MessageType>(77)), "type 77");
}

}  // namespace
}  // namespace fieldproof::iut
