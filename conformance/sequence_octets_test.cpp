#include "conformance/sequence_octets.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/sequence_draw.hpp"
#include "conformance/token_bus/suite.hpp"
#include "conformance/valve_bus/suite.hpp"

namespace fieldproof::conformance {
namespace {

std::vector<SequenceRole> all_roles() {
  std::vector<SequenceRole> roles;
  for (const auto& suite : {valve_bus_suite(), interbus_suite(), fieldbus_dll_suite(), token_bus_suite()}) {
    for (const SequenceRole& role : suite->sequence_roles()) roles.push_back(role);
  }
  return roles;
}

// What is drawn can be said in octets, so a search by octets reaches all that a search by drawing does.
TEST(SequenceOctets, EachDrawnSequenceIsItsOctets) {
  for (const SequenceRole& role : all_roles()) {
    const SequenceSource source(role.vocabulary, 7);
    for (std::uint64_t n = 0; n < 300; ++n) {
      const Sequence drawn = source.draw(n);
      const auto octets = octets_of_sequence(drawn, role.vocabulary);
      ASSERT_EQ(sequence_of_octets(octets, role.vocabulary), drawn) << role.test_case.id << " " << n;
    }
  }
}

// Stored inputs begin with a word: they have no settings, and mean what they did.
TEST(SequenceOctets, OnlyAnOctetFromF0OnBringsSettings) {
  for (const SequenceRole& role : all_roles()) {
    ASSERT_LT(role.vocabulary.words.size(), 0xF0U);
    for (unsigned first = 0; first < 0x100; ++first) {
      const std::vector<std::uint8_t> octets{static_cast<std::uint8_t>(first), 0x01, 0x00};
      const Sequence sequence = sequence_of_octets(octets, role.vocabulary);
      EXPECT_TRUE(first >= 0xF0 || sequence.settings.empty()) << role.test_case.id << " " << first;
      EXPECT_FALSE(role.vocabulary.objection_to(sequence.settings));
    }
  }
}

TEST(SequenceOctets, AnOctetEFBeginsWithASituationWhereThereAreAny) {
  for (const SequenceRole& role : all_roles()) {
    const SequenceVocabulary& vocabulary = role.vocabulary;
    ASSERT_LT(vocabulary.words.size(), 0xEFU);
    if (vocabulary.situations.empty()) {
      const std::vector<std::uint8_t> octets{0xEF, 0x00};
      EXPECT_EQ(sequence_of_octets(octets, vocabulary).commands.front().word, 0xEF % vocabulary.words.size());
      continue;
    }
    ASSERT_LE(vocabulary.situations.size(), 0x100U);
    for (std::size_t n = 0; n < vocabulary.situations.size(); ++n) {
      Sequence sequence{vocabulary.situations[n].commands, {}};
      const std::vector<std::uint8_t> octets{0xEF, static_cast<std::uint8_t>(n)};
      EXPECT_EQ(sequence_of_octets(octets, vocabulary), sequence) << role.test_case.id << " " << n;
      sequence.commands.push_back(simple_command(vocabulary, 0));
      EXPECT_EQ(sequence_of_octets(octets_of_sequence(sequence, vocabulary), vocabulary), sequence);
    }
  }
}

// A number outside of its limits would be refused by the reader of case files.
RC_GTEST_PROP(SequenceOctets, EachInputIsASequenceThatCanBeStored, (std::vector<std::uint8_t> octets)) {
  static const std::vector<SequenceRole> roles = all_roles();
  for (const SequenceRole& role : roles) {
    const Sequence sequence = sequence_of_octets(octets, role.vocabulary);
    RC_ASSERT(sequence.commands.size() <= kMostFuzzedCommands);
    RC_ASSERT(!octets.empty() || sequence.commands.empty());
    const config::Document document =
        config::Document::parse(sequence_json(sequence, role.vocabulary), "sequence");
    const Sequence again = config::read_object(document.root(), [&](config::ObjectReader& reader) {
      return read_sequence(reader, role.vocabulary);
    });
    RC_ASSERT(again == sequence);
  }
}

}  // namespace
}  // namespace fieldproof::conformance
