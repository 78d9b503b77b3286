// A configuration with a member of each kind, for the tests of this folder.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "harness/field/field.hpp"

namespace fieldproof::field {

enum class SampleColour : std::uint8_t { red, green };

struct SampleInside {
  std::uint8_t code = 0xA0;
  unsigned half_bits = 3;
};

struct SampleItem {
  unsigned at = 7;
  kernel::Duration lasts = 1 * kernel::kMillisecond;
  friend bool operator==(const SampleItem&, const SampleItem&) = default;
};

struct Sample {
  SampleInside inside;
  std::int64_t bit_rate = 500'000;
  kernel::Duration limit = 25 * kernel::kMillisecond;
  bool is_loud = false;
  SampleColour colour = SampleColour::red;
  std::array<std::uint16_t, 2> pair{1, 2};
  std::vector<std::uint8_t> live{};
  std::vector<SampleItem> items{};
  std::string note = "nobody is given this";
};

inline constexpr std::array kColours{Choice{"red", 0}, Choice{"green", 1}};
inline constexpr std::array kFast{Alternative{2'000'000, "another paper", judge::Standing::searched}};

inline constexpr auto kInsideRows =
    rows<SampleInside>(row<&SampleInside::code>({kHexadecimal, {0, 0xF0}, "of a frame", "memory"}),
                       row<&SampleInside::half_bits>({kHalfBits, {1, 9}, "of delay", "a paper"}));
inline constexpr Table<SampleInside> kInsideTable = table<SampleInside>(kInsideRows);

inline constexpr auto kItemRows =
    rows<SampleItem>(row<&SampleItem::at>({{}, {0, 99}, "instant"}),
                     row<&SampleItem::lasts>({kTime, {0, 5'000'000'000}, "duration"}));
inline constexpr Table<SampleItem> kItemTable = table<SampleItem>(kItemRows);
inline constexpr std::array kNodeRow{item<std::uint8_t>({kHexadecimal, {0x10, 0xF7}, "a node"})};
inline constexpr Table<std::uint8_t> kNodeItem = table<std::uint8_t>(kNodeRow);
inline constexpr std::array kPairRow{item<std::uint16_t>({{}, {0, 100}, "a number"})};
inline constexpr Table<std::uint16_t> kPairItem = table<std::uint16_t>(kPairRow);

inline constexpr auto kSampleRows = rows<Sample>(
    part<&Sample::inside>(kInsideTable, {}, "inside_"),
    row<&Sample::bit_rate>(
        {kBitRate, {1'200, 10'000'000}, "on the line", "a paper", judge::Standing::seed, {}, kFast}),
    row<&Sample::limit>({kTime, {0, 1'000'000'000'000}, "of silence", "a manual", judge::Standing::searched}),
    row<&Sample::is_loud>({{}, {}, "it is loud", "own"}),
    row<&Sample::colour>({{}, {}, "of the case", "own", judge::Standing::own, kColours}),
    list<&Sample::pair>(kPairItem, 2, {{}, {}, "two numbers", "own"}, 1),
    list<&Sample::live>(kNodeItem, 4, {{}, {}, "nodes that live", "own"}),
    list<&Sample::items>(kItemTable, 3, {{}, {}, "what happens when", "own"}), internal<&Sample::note>());
inline constexpr Table<Sample> kSampleTable = table<Sample>(kSampleRows);

}  // namespace fieldproof::field
