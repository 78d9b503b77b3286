#include "reports/vcd_writer.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "reports/approved_text.hpp"
#include "reports/sample_recording.hpp"
#include "reports/wireshark/third_party_reader.hpp"

namespace fieldproof::reports {
namespace {

std::string dump_of(const trace::Recording& recording) {
  return vcd(recording, "fieldproof 0.1.0", "a/b/c");
}

// Everything after the definitions.
std::string values_of(const std::string& dump) {
  constexpr std::string_view kEnd = "$enddefinitions $end\n";
  return dump.substr(dump.find(kEnd) + kEnd.size());
}

TEST(VcdWriter, WritesTheApprovedDump) {
  expect_approved("trace.vcd", dump_of(sample_recording()));
}

TEST(VcdWriter, IsIdleOutsideOfTransmissionsAndHasOneValueAnInstant) {
  trace::Recording recording;
  recording.channels = {"line"};
  recording.records = {trace::Transmission{0, sample_wave(2, 0b0010, 4), std::nullopt},
                       // Begins where the one before ends: no glitch to idle between them.
                       trace::Transmission{0, sample_wave(6, 0b10, 2), std::nullopt},
                       trace::Transmission{0, sample_wave(10, 0b0, 1), std::nullopt}};
  EXPECT_EQ(values_of(dump_of(recording)),
            "#0\n$dumpvars\n1!\n$end\n#2000000\n0!\n#3000000\n1!\n#4000000\n0!\n#7000000\n1!\n#10000000\n0!\n"
            "#11000000\n1!\n");
}

TEST(VcdWriter, NamesAreDistinctAndPlain) {
  trace::Recording recording;
  recording.channels = {"a b", "a_b", "$end"};
  for (trace::Channel n = 0; n < 3; ++n) {
    recording.records.emplace_back(trace::Observation{n, kernel::kStart, "x\ny", n});
  }
  const std::string dump = dump_of(recording);
  for (const char* name : {" a_b/x_y $end", " a_b/x_y_2 $end", " _end/x_y $end"}) {
    EXPECT_NE(dump.find(name), std::string::npos) << dump;
  }
}

TEST(VcdWriter, HasMoreVariablesThanOneCharacterCanName) {
  trace::Recording recording;
  for (trace::Channel n = 0; n < 200; ++n) {
    recording.channels.push_back("c" + std::to_string(n));
    recording.records.emplace_back(trace::Observation{n, kernel::kStart, "x", n});
  }
  std::set<std::string> codes;
  std::istringstream lines(dump_of(recording));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("$var wire 64 ")) codes.insert(line.substr(13, line.find(' ', 13) - 13));
  }
  EXPECT_EQ(codes.size(), 200U);
}

// Value changes by variable name, for dumps whose identifiers and order may differ.
std::map<std::string, std::string> changes_by_name(const std::string& dump) {
  std::map<std::string, std::string> names;
  std::map<std::string, std::string> changes;
  std::map<std::string, std::string> values;
  std::istringstream lines(dump);
  std::string time;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first == "$var") {
      std::string type;
      std::string width;
      std::string code;
      words >> type >> width >> code >> names[code];
    } else if (first.starts_with('#')) {
      time = first;
    } else if (!names.empty() && !first.empty() && (first[0] == '0' || first[0] == '1' || first[0] == 'b')) {
      std::string code = first.substr(1);
      std::string value = first.substr(0, 1);
      if (first[0] == 'b') {
        const std::size_t one = first.find('1');
        value = one == std::string::npos ? "0" : first.substr(one);
        words >> code;
      }
      if (std::exchange(values[code], value) != value) changes[names.at(code)] += time + "=" + value + " ";
    }
  }
  return changes;
}

TEST(VcdWriter, AnotherProgramReadsEveryChange) {
  const TemporaryFolder folder;
  const std::string dump = dump_of(sample_recording());
  const std::filesystem::path file = folder.path() / "trace.vcd";
  const std::filesystem::path fst = folder.path() / "trace.fst";
  write_text_file(file, dump);
  // GTKWave's own format and back: what it did not understand is lost on the way.
  const Reading there = read_with("vcd2fst", shell_word(file.string()) + " " + shell_word(fst.string()));
  if (!there.is_available) GTEST_SKIP() << there.output;
  ASSERT_EQ(there.exit_code, 0) << there.output;
  const Reading back = read_with("fst2vcd", shell_word(fst.string()));
  ASSERT_EQ(back.exit_code, 0) << back.output;
  EXPECT_NE(back.output.find("1ps"), std::string::npos) << "the timescale";
  EXPECT_EQ(changes_by_name(back.output), changes_by_name(dump));
  EXPECT_EQ(changes_by_name(dump).size(), 6U);
}

}  // namespace
}  // namespace fieldproof::reports
