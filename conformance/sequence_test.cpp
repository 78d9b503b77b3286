#include "conformance/sequence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "conformance/sequence_draw.hpp"
#include "conformance/valve_bus/node_sequence.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

using testing::HasSubstr;

const SequenceVocabulary& node_words() {
  return node_sequence_role().vocabulary;
}

Sequence sequence_of(const std::string& json) {
  const config::Document document = config::Document::parse(json, "case.json");
  return config::read_object(
      document.root(), [](config::ObjectReader& reader) { return read_sequence(reader, node_words()); });
}

TEST(Sequence, IsReadAsItIsWritten) {
  const SequenceSource source(node_words(), 5);
  for (std::uint64_t n = 0; n < 300; ++n) {
    const Sequence drawn = source.draw(n);
    EXPECT_EQ(sequence_of(sequence_json(drawn, node_words())), drawn) << n;
  }
}

TEST(Sequence, IsToldInWords) {
  const Sequence sequence = sequence_of(R"({"commands": [
      {"do": "write", "data0": 165, "data1": 60, "silence": 45,
       "faults": [{"fault": "flip", "unit": 2, "level": 3}, {"fault": "gap", "unit": 0, "bits": 22},
                  {"fault": "drop", "unit": 4}]},
      {"do": "octets", "silence": 0, "octets": [1, 255]}]})");
  EXPECT_EQ(
      sequence_lines(sequence, node_words()),
      (std::vector<std::string>{
          "write data0 165 data1 60 silence 45; level 3 of character 2 flipped; 22 bits of silence after "
          "character 0; character 4 dropped",
          "octets silence 0 octets 01 FF"}));
  EXPECT_EQ(faults_in(sequence), 3U);
  EXPECT_EQ(flips_in(sequence), 1U);
}

struct BadSequence {
  const char* json;
  const char* sentence;
};

TEST(Sequence, RefusesWhatIsWrongAtItsPlace) {
  const BadSequence bad[] = {
      {R"({"commands": [{"do": "wirte", "data0": 1, "data1": 1, "silence": 0}]})", "/commands/0/do"},
      {R"({"commands": [{"do": "write", "data0": 256, "data1": 1, "silence": 0}]})", "/commands/0/data0"},
      {R"({"commands": [{"do": "write", "data0": 1, "data1": 1}]})", "silence"},
      {R"({"commands": [{"do": "octets", "silence": 0, "octets": []}]})", "/commands/0/octets"},
      {R"({"commands": [{"do": "octets", "silence": 0, "octets": [1,2,3,4,5,6,7,8,9]}]})",
       "/commands/0/octets"},
      {R"({"commands": [{"do": "wait", "ms": 1, "faults": []}]})", "faults"},
      {R"({"commands": [{"do": "read", "data0": 0, "data1": 0, "silence": 0,
             "faults": [{"fault": "drop", "unit": 0, "level": 1}]}]})",
       "level"},
      {R"({"commands": [{"do": "read", "data0": 0, "data1": 0, "silence": 0,
             "faults": [{"fault": "flip", "unit": -1, "level": 1}]}]})",
       "/commands/0/faults/0/unit"},
      {R"({"settings": {"boards": 3}, "commands": []})", "/settings/boards"},
      {R"({"settings": {"slot_time_octets": 8}, "commands": []})", "slot_time_octets"},
      {R"({"settings": {"address_units": 16}, "commands": []})", "/settings"},
  };
  for (const BadSequence& one : bad) {
    try {
      sequence_of(one.json);
      ADD_FAILURE() << one.json << " was taken";
    } catch (const kernel::Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(one.sentence)) << one.json;
      EXPECT_THAT(error.what(), HasSubstr("case.json")) << one.json;
    }
  }
}

}  // namespace
}  // namespace fieldproof::conformance
