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
  const config::Document document = config::Document::parse(json, "commands.json");
  return read_sequence(document.root(), node_words());
}

TEST(Sequence, IsReadAsItIsWritten) {
  const SequenceSource source(node_words(), 5);
  for (std::uint64_t n = 0; n < 300; ++n) {
    const Sequence drawn = source.draw(n);
    if (drawn.empty()) continue;  // a file has at least one command
    EXPECT_EQ(sequence_of(sequence_json(drawn, node_words())), drawn) << n;
  }
}

TEST(Sequence, IsToldInWords) {
  const Sequence sequence = sequence_of(R"([
      {"do": "write", "data0": 165, "data1": 60, "silence": 45,
       "faults": [{"fault": "flip", "unit": 2, "level": 3}, {"fault": "gap", "unit": 0, "bits": 22},
                  {"fault": "drop", "unit": 4}]},
      {"do": "octets", "silence": 0, "octets": [1, 255]}])");
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
      {R"([{"do": "wirte", "data0": 1, "data1": 1, "silence": 0}])", "/0/do"},
      {R"([{"do": "write", "data0": 256, "data1": 1, "silence": 0}])", "/0/data0"},
      {R"([{"do": "write", "data0": 1, "data1": 1}])", "silence"},
      {R"([{"do": "octets", "silence": 0, "octets": []}])", "/0/octets"},
      {R"([{"do": "octets", "silence": 0, "octets": [1,2,3,4,5,6,7,8,9]}])", "/0/octets"},
      {R"([{"do": "wait", "ms": 1, "faults": []}])", "faults"},
      {R"([{"do": "read", "data0": 0, "data1": 0, "silence": 0,
             "faults": [{"fault": "drop", "unit": 0, "level": 1}]}])",
       "level"},
      {R"([{"do": "read", "data0": 0, "data1": 0, "silence": 0,
             "faults": [{"fault": "flip", "unit": -1, "level": 1}]}])",
       "/0/faults/0/unit"},
  };
  for (const BadSequence& one : bad) {
    try {
      sequence_of(one.json);
      ADD_FAILURE() << one.json << " was taken";
    } catch (const kernel::Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(one.sentence)) << one.json;
      EXPECT_THAT(error.what(), HasSubstr("commands.json")) << one.json;
    }
  }
}

}  // namespace
}  // namespace fieldproof::conformance
