#include "harness/line/frame_check.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <boost/crc.hpp>
#include <cctype>
#include <ostream>
#include <set>
#include <sstream>

#include "harness/kernel/check.hpp"

namespace fieldproof::line {

// GoogleTest names a row by its name instead of printing its memory.
void PrintTo(const FrameCheckParameters& parameters, std::ostream* out);
void PrintTo(const FrameCheckParameters& parameters, std::ostream* out) {
  *out << parameters.name;
}

namespace {

constexpr std::array<std::uint8_t, 9> kDigits = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};

class EveryFrameCheck : public testing::TestWithParam<FrameCheckParameters> {};

std::string name_of(const testing::TestParamInfo<FrameCheckParameters>& info) {
  std::string name(info.param.name);
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

// The bits of octets in line order.
std::vector<bool> bits_of(std::span<const std::uint8_t> octets, bool least_first) {
  std::vector<bool> bits;
  for (const std::uint8_t octet : octets) {
    for (unsigned bit = 0; bit < 8; ++bit)
      bits.push_back(((octet >> (least_first ? bit : 7 - bit)) & 1) != 0);
  }
  return bits;
}

// Long division on paper: the message with the initial register on top, `width` zeros after.
FrameCheckValue by_long_division(const FrameCheckParameters& p, std::vector<bool> bits) {
  const std::size_t message = bits.size();
  bits.resize(message + p.width);
  for (unsigned k = 0; k < p.width; ++k) bits[k] = bits[k] != (((p.init >> (p.width - 1 - k)) & 1) != 0);
  for (std::size_t at = 0; at < message; ++at) {
    if (!bits[at]) continue;
    for (unsigned k = 0; k < p.width; ++k) {
      bits[at + 1 + k] = bits[at + 1 + k] != (((p.poly >> (p.width - 1 - k)) & 1) != 0);
    }
  }
  FrameCheckValue value = 0;
  for (std::size_t at = message; at < bits.size(); ++at) value = (value << 1) | (bits[at] ? 1 : 0);
  return (p.refout ? reflect(value, p.width) : value) ^ p.xorout;
}

TEST_P(EveryFrameCheck, GivesTheCatalogueValueForTheNineDigits) {
  const FrameCheck check(GetParam());
  EXPECT_TRUE(check.compute(kDigits) == GetParam().check);
  EXPECT_TRUE(by_long_division(GetParam(), bits_of(kDigits, GetParam().refin)) == GetParam().check);
}

TEST_P(EveryFrameCheck, HoldsTheResidueAfterAnErrorFreeCodeWordOnly) {
  const FrameCheck check(GetParam());
  const FrameCheck::State message = check.update(check.start(), kDigits);
  const unsigned width = GetParam().width;
  for (unsigned flipped = 0; flipped <= width; ++flipped) {
    FrameCheck::State state = message;
    for (unsigned k = 0; k < width; ++k) {
      state = check.update_bit(state, check.check_bit(message, k) != (k == flipped));
    }
    const bool is_error_free = flipped == width;
    EXPECT_EQ(check.is_residue(state), is_error_free) << flipped;
    // The residue as the catalogue prints it: the register without the final XOR.
    EXPECT_EQ((check.finish(state) ^ GetParam().xorout) == GetParam().residue, is_error_free) << flipped;
  }
}

TEST_P(EveryFrameCheck, IsTheSameByBitsOctetsSlicesAndInPieces) {
  const FrameCheck check(GetParam());
  const auto holds =
      rc::detail::checkTestable([&](const std::vector<std::uint8_t>& message, std::uint8_t cut) {
        const std::span<const std::uint8_t> octets = message;
        FrameCheck::State by_bits = check.start();
        for (const bool bit : bits_of(octets, GetParam().refin)) by_bits = check.update_bit(by_bits, bit);
        FrameCheck::State by_octets = check.start();
        for (const std::uint8_t octet : octets) by_octets = check.update_octet(by_octets, octet);
        const std::size_t at = octets.empty() ? 0 : cut % octets.size();
        const FrameCheck::State in_pieces =
            check.update(check.update(check.start(), octets.first(at)), octets.subspan(at));
        RC_ASSERT(by_bits == by_octets);
        RC_ASSERT(by_bits == in_pieces);
        RC_ASSERT(by_bits == check.update(check.start(), octets));
      });
  std::ostringstream told;
  rc::detail::printResultMessage(holds, told);
  EXPECT_TRUE(holds.template is<rc::detail::SuccessResult>()) << told.str();
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryFrameCheck,
                         testing::ValuesIn(frame_check_catalogue().begin(), frame_check_catalogue().end()),
                         name_of);

TEST(FrameCheckCatalogue, HasEveryRowOnceAndFindsNamesAndAliases) {
  EXPECT_EQ(frame_check_catalogue().size(), 113U);
  std::set<std::string_view> names;
  for (const std::string_view name : frame_check_names()) {
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_NE(find_frame_check(name), nullptr) << name;
  }
  ASSERT_NE(find_frame_check("modbus"), nullptr);
  EXPECT_EQ(find_frame_check("modbus")->name, "CRC-16/MODBUS");
  EXPECT_EQ(find_frame_check("X-25")->name, "CRC-16/IBM-SDLC");
  EXPECT_EQ(find_frame_check("CRC-16/IEC-61158-2")->check, 0xA819U);
  EXPECT_EQ(find_frame_check("CRC-16/NOBODY"), nullptr);
  EXPECT_EQ(find_frame_check(""), nullptr);
}

TEST(FrameCheckCatalogue, SaysWhichRowsOnlyOneCatalogueLists) {
  std::set<std::string_view> only_one;
  for (const FrameCheckParameters& row : frame_check_catalogue()) {
    if (!row.is_in_both_catalogues) only_one.insert(row.name);
  }
  const std::set<std::string_view> expected = {"CRC-8/HITAG", "CRC-16/M17",  "CRC-32/MEF",
                                               "CRC-64/MS",   "CRC-64/NVME", "CRC-64/REDIS"};
  EXPECT_EQ(only_one, expected);
}

TEST(FrameCheck, RefusesImpossibleParameters) {
  FrameCheckParameters row = frame_check_named("CRC-16/ARC");
  row.width = 2;
  EXPECT_THROW(FrameCheck{row}, kernel::BrokenInvariant);
  row.width = 129;
  EXPECT_THROW(FrameCheck{row}, kernel::BrokenInvariant);
  row.width = 15;  // the polynomial no longer fits
  EXPECT_THROW(FrameCheck{row}, kernel::BrokenInvariant);
  row = frame_check_named("CRC-16/ARC");
  row.poly = 0x8004;
  EXPECT_THROW(FrameCheck{row}, kernel::BrokenInvariant);
}

RC_GTEST_PROP(FrameCheck, AppendedCheckMakesACodeWordAndAnyOtherTailDoesNot,
              (std::vector<std::uint8_t> message, std::uint8_t flip)) {
  for (const char* name : {"CRC-16/IBM-3740", "CRC-16/PROFIBUS", "CRC-16/MODBUS", "CRC-32", "CRC-24/BLE"}) {
    const FrameCheck check(frame_check_named(name));
    std::vector<std::uint8_t> word = message;
    check.append_check(word);
    RC_ASSERT(word.size() == message.size() + check.parameters().width / 8);
    RC_ASSERT(check.is_code_word(word));
    word.back() = static_cast<std::uint8_t>(word.back() ^ flip);
    RC_ASSERT(check.is_code_word(word) == (flip == 0));
  }
}

template <unsigned kWidth>
FrameCheckValue by_boost(const FrameCheckParameters& p, std::span<const std::uint8_t> octets) {
  using Basic = boost::crc_basic<kWidth>;
  using Value = typename Basic::value_type;
  Basic basic(static_cast<Value>(p.poly), static_cast<Value>(p.init), static_cast<Value>(p.xorout), p.refin,
              p.refout);
  basic.process_bytes(octets.data(), octets.size());
  return basic.checksum();
}

RC_GTEST_PROP(FrameCheck, AgreesWithBoost, (std::vector<std::uint8_t> message)) {
  for (const FrameCheckParameters& p : frame_check_catalogue()) {
    const FrameCheck check(p);
    if (p.width == 8) RC_ASSERT(check.compute(message) == by_boost<8>(p, message));
    if (p.width == 15) RC_ASSERT(check.compute(message) == by_boost<15>(p, message));
    if (p.width == 16) RC_ASSERT(check.compute(message) == by_boost<16>(p, message));
    if (p.width == 24) RC_ASSERT(check.compute(message) == by_boost<24>(p, message));
    if (p.width == 32) RC_ASSERT(check.compute(message) == by_boost<32>(p, message));
    if (p.width == 64) RC_ASSERT(check.compute(message) == by_boost<64>(p, message));
  }
}

}  // namespace
}  // namespace fieldproof::line
