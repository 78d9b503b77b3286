#include "reports/pcapng_writer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "harness/kernel/arbitrary_text.hpp"
#include "reports/approved_text.hpp"
#include "reports/sample_recording.hpp"
#include "reports/wireshark/third_party_reader.hpp"

namespace fieldproof::reports {
namespace {

using Table = std::vector<std::vector<std::string>>;

std::string capture_of(const trace::Recording& recording) {
  return pcapng(recording, SampleDissector(), "fieldproof 0.1.0", "a/b/c");
}

// What tshark reads: the named fields of each packet.
Reading read(const trace::Recording& recording, const std::string& fields) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "trace.pcapng";
  write_text_file(file, capture_of(recording));
  return read_with_tshark(FIELDPROOF_SOURCE_DIR, file, fields);
}

// A reader of blocks of its own: type and body of each, as the format lays them out.
struct ReadBlock {
  std::uint32_t type = 0;
  std::string body;
};

std::uint32_t number_at(const std::string& octets, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t n = 4; n > 0; --n)
    number = number << 8 | static_cast<unsigned char>(octets.at(at + n - 1));
  return number;
}

std::vector<ReadBlock> blocks_of(const std::string& capture) {
  std::vector<ReadBlock> blocks;
  for (std::size_t at = 0; at < capture.size();) {
    const std::uint32_t length = number_at(capture, at + 4);
    EXPECT_EQ(length % 4, 0U);
    EXPECT_EQ(number_at(capture, at + length - 4), length) << "the length stands at both ends";
    blocks.push_back({number_at(capture, at), capture.substr(at + 8, length - 12)});
    at += length;
  }
  return blocks;
}

TEST(PcapngWriter, HasASectionAnInterfaceForEachChannelAndAPacketForEachTransmission) {
  std::string types;
  for (const ReadBlock& block : blocks_of(capture_of(sample_recording()))) {
    types += block.type == 0x0A0D0D0A ? 'S' : block.type == 1 ? 'I' : block.type == 6 ? 'P' : '?';
  }
  // Four were driven; of the two that were changed one arrived.
  EXPECT_EQ(types, "SIIIPPPPP");
}

TEST(PcapngWriter, PayloadIsAsTheHeaderSays) {
  const ReadBlock packet = blocks_of(capture_of(sample_recording())).at(5);
  const std::string payload = packet.body.substr(20, number_at(packet.body, 12));
  const std::string expected(
      "\x02\xC8\x02\x07"
      "\x00\x00\x00\x00\x01\x31\x2D\x00"
      "\x00\x00\x00\x00\x00\x0F\x42\x40"
      "\x00\x00\x00\x00\x00\x0F\x42\x40"
      "\x00\x00\x00\x08"
      "\x00\x00\x00\x00"
      "\x6D",
      37);
  EXPECT_EQ(payload, expected);
  const ReadBlock arrived = blocks_of(capture_of(sample_recording())).at(6);
  const std::string with_mask = arrived.body.substr(20, number_at(arrived.body, 12));
  ASSERT_EQ(with_mask.size(), 38U);
  EXPECT_EQ(with_mask[2], 1 | 2 | 8);
  EXPECT_EQ(with_mask.substr(36), "\x75\x18");
}

TEST(PcapngWriter, AnotherProgramReadsWhatIsWritten) {
  const Reading reading =
      read(sample_recording(),
           "-T fields -e frame.interface_name -e frame.time_epoch -e frame.packet_flags_direction -e "
           "frame.packet_flags_crc_error -e frame.comment -e fieldproof.start_ps -e fieldproof.level");
  if (!reading.is_available) GTEST_SKIP() << reading.output;
  EXPECT_EQ(table_of(reading.output),
            (Table{{"master/in", "0.000000000", "0x00000002", "0", "", "0", "01101101"},
                   {"master/in", "0.000020000", "0x00000002", "0",
                    "changed on the way: levels 3, 4 changed\\nflip levels 3..3\\nflip levels 4..4",
                    "20000000", "01101101"},
                   {"master/in", "0.000020000", "0x00000001", "0",
                    "arrived so: levels 3, 4 changed\\nflip levels 3..3\\nflip levels 4..4", "20000000",
                    "01110101"},
                   {"slave@1/in", "0.000040000", "0x00000002", "1", "changed on the way: lost on the way",
                    "40000000", "00101101"},
                   {"slave@1/in", "0.000060000", "0x00000002", "1", "", "60000000", "00101101"}}));
}

TEST(PcapngWriter, ALongTransmissionIsCutAndSaysSo) {
  trace::Recording recording;
  recording.channels = {"line"};
  recording.records = {trace::Transmission{0, sample_wave(0, 0, 64), std::nullopt}};
  std::get<trace::Transmission>(recording.records[0]).wave.levels.append_fill(false, 1'000'000);
  const Reading reading = read(recording,
                               "-T fields -e frame.len -e frame.cap_len -e fieldproof.levels -e "
                               "_ws.expert.message");
  if (!reading.is_available) GTEST_SKIP() << reading.output;
  EXPECT_EQ(table_of(reading.output),
            (Table{{"125044", "125036", "1000064", "The transmission is longer than the packet"}}));
}

TEST(PcapngWriter, APacketOfAnotherLayoutIsNotTakenApart) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "trace.pcapng";
  std::string capture = capture_of(sample_recording());
  const std::size_t payload = capture.find("\x02\xC8");
  ASSERT_NE(payload, std::string::npos);
  capture[payload] = 1;
  write_text_file(file, capture);
  const Reading reading =
      read_with_tshark(FIELDPROOF_SOURCE_DIR, file, "-c 1 -T fields -e _ws.expert.message");
  if (!reading.is_available) GTEST_SKIP() << reading.output;
  EXPECT_EQ(reading.output, "This dissector does not know the layout of the packet\n");
}

RC_GTEST_PROP(PcapngWriterProperty, AnyTextGivesWholeBlocks, ()) {
  trace::Recording recording = sample_recording();
  recording.channels[0] = *kernel::arbitrary_text();
  std::get<trace::Fault>(recording.records[2]).text = *kernel::arbitrary_text();
  const std::string capture =
      pcapng(recording, SampleDissector(), *kernel::arbitrary_text(), *kernel::arbitrary_text());
  RC_ASSERT(blocks_of(capture).size() == 9U);
}

}  // namespace
}  // namespace fieldproof::reports
