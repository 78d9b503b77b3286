#include "conformance/interbus/master_side_notes.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fieldproof::conformance {
namespace {

using Values = std::vector<std::int64_t>;

TEST(MasterSideNotes, EachNumberOfAReportHasItsName) {
  EXPECT_EQ(
      master_report_text(Values{1, 0, 2, 1, 3, 0, 4, 1, -1, 0, 0x0101, 0}),
      "run, quality bit 0, peripheral fault of station 1, 3, no request for a reconfiguration, 4 bad cycles "
      "in a row, place of the last fault from the output to station 0, output words 0101h 0000h");
  EXPECT_EQ(master_report_text(Values{0, 0, 0x0101}), "not in run, output words 0101h");
}

TEST(MasterSideNotes, EachNumberOfAStateHasItsName) {
  EXPECT_EQ(master_state_text(Values{5, 0, 8, 0, 1, 1, 3, -1, 0x0101}),
            "bus_stop, cycles in run, place of the fault from station 3 to the input, output words 0101h");
  EXPECT_EQ(master_state_text(Values{3, 0, 0, 2, 0x0008, 0, -1, 0, 0x01BE, 1, 0, 1, 0}),
            "run, station 0 0008h of 0 words on OUT1 of the master, station 1 01BEh of 1 words on OUT2 of "
            "station 0");
  EXPECT_EQ(master_state_text(Values{5, 1, 0, 0, 0}), "bus_stop, configuration refused");
}

TEST(MasterSideNotes, EachNumberOfACycleHasItsName) {
  EXPECT_EQ(
      master_cycle_text(Values{0, 6, 1, 3, 0xA55A, 0x1234, 0, 0, 255}),
      "data cycle of 6 octets, 1 cycle times after the one before, words as sent A55Ah 1234h 0000h, end "
      "telegrams 00h FFh");
  EXPECT_EQ(master_cycle_text(Values{1, 6, -1, 0}),
            "ID cycle of 6 octets, no whole number of cycle times after the one before");
  EXPECT_EQ(master_inputs_text(Values{1, 0x0102}), "accepted, input words 0102h");
}

}  // namespace
}  // namespace fieldproof::conformance
