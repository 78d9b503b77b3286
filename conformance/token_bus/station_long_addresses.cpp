#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/station_life.hpp"
#include "conformance/token_bus/station_listening.hpp"

// Addresses of 48 bits.
namespace fieldproof::conformance {
namespace {

using namespace token_chart;
using token_bus::StationConfiguration;
using token_sources::memory;
using token_sources::standard;

void long_addresses(StationConfiguration& configuration, kernel::Random&) {
  configuration.rules.address_length = token_bus::AddressLength::bits_48;
}
// All pairs of bits, in both orders, in the high octets as well as in the low ones.
void long_address_with_all_pairs(StationConfiguration& configuration, kernel::Random& random) {
  long_addresses(configuration, random);
  configuration.address = 0x1BE4'2D72'C6B8;
}

constexpr std::uint64_t kOwn = 0x0012'0000'000A;
void address_in_high_octets(StationConfiguration& configuration, kernel::Random& random) {
  long_addresses(configuration, random);
  configuration.address = kOwn;
}

struct Range {
  std::uint64_t destination;
  std::uint64_t source;
};
constexpr std::array kWithin{Range{0x0011'0000'0010, 0x0013'0000'0002},
                             Range{0x0012'0000'0004, 0x0100'0000'0000},
                             Range{0x0000'0000'000C, 0x0012'0000'000E}};
constexpr std::array kOutside{Range{0x0000'0000'0004, 0x0000'0000'000E},
                              Range{0x0013'0000'0004, 0x0014'0000'000E},
                              Range{0x0012'0000'000A, 0x0013'0000'000E}};

TokenStep solicitation(const std::string& text, const std::array<Range, 3>& all) {
  return send(text, [all](TokenScene& scene) {
    const Range& one = all.at(scene.turn % all.size());
    return scene.bench.frame(TokenControl::solicit_1, one.destination, one.source);
  });
}

constexpr std::size_t kMostData = 8'174;
constexpr unsigned kContests = 25;

}  // namespace

std::vector<TokenCase> token_long_address_cases() {
  return {
      on_chart(token_must("long_addresses/claims_in_25_passes", "TB-02",
                          "With addresses of 48 bits a station claims in 25 passes, the most significant "
                          "pair of bits first.",
                          memory("max_pass_count"), {{"passes_of_short_addresses", "claim_wrong"}}),
               {{}, {claims()}}, {.adjust = long_address_with_all_pairs}),
      on_chart(token_must("long_addresses/a_life", "TB-02",
                          "With addresses of 48 bits a ring forms, the token goes round, and is sought.",
                          standard("addresses"), {{"passes_of_short_addresses", "claim_wrong"}}),
               {{}, life()}, {.adjust = long_addresses}),
      on_chart(token_must("long_addresses/contest_of_24_pairs", "TB-19",
                          "In a contest a station answers by each of its 24 pairs of bits, the most "
                          "significant first.",
                          memory("resolve_contention"),
                          {{"low_pairs_first", "begins_too_early"},
                           {"passes_of_short_addresses", "answer_missing"}}),
               {{},
                {wait(10),
                 send("F000 solicits anybody",
                      [](TokenScene& scene) {
                        return scene.bench.frame(TokenControl::solicit_2, 0x0002, 0xF000);
                      }),
                 says("set_successor to F000 in the second window", {TokenControl::set_successor, 0xF000},
                      in_window(1), "answer_missing", "answer_wrong"),
                 contest()}},
               {.adjust = long_address_with_all_pairs}),
      on_chart(
          token_must("long_addresses/25_contests_are_given_up", "TB-15",
                     "After 25 contests the token goes to the successor of before.", memory("max_pass_count"),
                     {{"passes_of_short_addresses", "contention_not_resolved"}}),
          {{},
           {joined(), until_window(), wait(6),
            repeat({kContests, kContests}, {noise(17),
                                            says("resolve_contention", {TokenControl::resolve}, at_once(),
                                                 "contention_not_resolved", "contention_not_resolved"),
                                            wait(6)}),
            noise(17), passes_below(at_once())}},
          {.adjust = long_addresses}),
      on_chart(token_must("long_addresses/ranges_have_48_bits", "TB-17",
                          "A station answers a solicitation whose range has its address, of all 48 bits.",
                          standard("addresses"), {{"range_of_low_bits", "answer_missing"}}),
               {{},
                {wait(10),
                 repeat({3, 3},
                        {solicitation("a solicitation whose range has the station, each of three", kWithin),
                         expected<TokenScene>("set_successor with its own address",
                                              [](TokenScene& scene) {
                                                scene.expect_frame({TokenControl::set_successor,
                                                                    kWithin.at(scene.turn).source, kOwn},
                                                                   scene.at_once(), "set_successor",
                                                                   "answer_missing", "answer_wrong");
                                              }),
                         wait(40), noise(8)}),
                 repeat({3, 3},
                        {solicitation("a solicitation whose range does not have it, each of three", kOutside),
                         silence(2 * 28 + 10, "answers_unasked", "its address is not solicited")})}},
               {.adjust = address_in_high_octets}),
      on_chart(token_must("long_addresses/data_have_8174_octets_at_most", "TB-07",
                          "With addresses of 48 bits a frame holds 8174 octets of data; more are refused.",
                          token_sources::paper("8191 octets between SD and ED"),
                          {{"length_of_short_addresses", "data_not_refused"}}),
               {{},
                {joined(), submit({6}, kMostData),
                 require(
                     "8175 octets are refused",
                     [](TokenScene& scene) {
                       return !scene.bench.submit(
                           {.destination = TokenBench::kBelow, .data = Octets(kMostData + 1)});
                     },
                     "data_not_refused"),
                 token(),
                 expected<TokenScene>("the data, whole",
                                      [](TokenScene& scene) {
                                        scene.expect_frame({TokenControl{0x62}, TokenBench::kBelow},
                                                           scene.at_once(), "data to 0004", "data_missing",
                                                           "data_wrong");
                                        scene.judge.expect(scene.answer.data() == scene.data, "data_wrong",
                                                           "the data of the user", scene.answer.text());
                                      }),
                 passes_below(at_once())}},
               {.adjust = long_addresses}),
      on_chart(
          token_must("long_addresses/short_addresses_are_left", "TB-33",
                     "In a network with addresses of 48 bits a token with those of 16 is ignored.",
                     standard("addresses"), {{"shorter_tokens_taken", "acts_on_other_length"}}),
          {{},
           {joined(),
            send("a token for 000A from 000E", [](TokenScene&) { return Octets{0x10, 0x0A, 0, 0x0E, 0}; }),
            ignored("acts_on_other_length", "its addresses have another length"), serves()}},
          {.adjust = long_addresses}),
  };
}

}  // namespace fieldproof::conformance
