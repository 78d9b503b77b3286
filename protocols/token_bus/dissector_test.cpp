#include "protocols/token_bus/dissector.hpp"

#include <gtest/gtest.h>

#include "protocols/token_bus/frame.hpp"

namespace fieldproof::token_bus {
namespace {

std::string in_words(std::span<const std::uint8_t> octets, const Delimiting& delimiting = {}) {
  MacSymbols symbols;
  append_framed(symbols, octets, delimiting);
  return BusDissector(Rules{}).brief({{}, 20'000'000, half_bits_of(symbols)});
}

TEST(TokenBusDissector, WritesFramesInWords) {
  const Rules rules;
  const auto line = [&](const Frame& frame) { return in_words(with_check(octets_of(frame, rules))); };
  EXPECT_EQ(line({.destination = 4, .source = 10}), "token, 000A -> 0004");
  EXPECT_EQ(line({.kind = FrameKind::set_successor, .destination = 10, .source = 6, .data = {6, 0}}),
            "set_successor, 0006 -> 000A: 0006");
  EXPECT_EQ(line({.kind = FrameKind::claim_token, .source = 10, .data = Octets(56)}),
            "claim_token, 000A -> 0000, 56 octets");
  EXPECT_EQ(line({.kind = FrameKind::data,
                  .action = Action::response,
                  .priority = 6,
                  .destination = 4,
                  .source = 10,
                  .data = {1, 0xAB}}),
            "data, response, priority 6, 000A -> 0004: 01 AB");
  EXPECT_TRUE(line({.kind = FrameKind::data, .destination = 4, .source = 10, .data = Octets(40)})
                  .ends_with("00 and 8 more"));
}

TEST(TokenBusDissector, NamesWhatIsNoFrame) {
  const Rules rules;
  Octets token = with_check(octets_of(Frame{.destination = 4, .source = 10}, rules));
  EXPECT_EQ(in_words(token, {.has_error = true}), "E bit error: 10 04 00 0A 00 42 1F 4F D3");
  token.back() ^= 1;
  EXPECT_EQ(in_words(token), "FCS error: 10 04 00 0A 00 42 1F 4F D2");
  EXPECT_EQ(in_words({}), "frame fragment: ");
  EXPECT_EQ(BusDissector(rules).brief({{}, 20'000'000, line::Levels::of_text("0110")}), "non-silence");
  const Octets unknown = with_check(Octets{0xFF, 4, 0, 10, 0});
  EXPECT_TRUE(in_words(unknown).starts_with("no frame of this network: FF 04"));
}

}  // namespace
}  // namespace fieldproof::token_bus
