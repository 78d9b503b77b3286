// Frame checks of single messages beside Boost.CRC. Every message differs, as on a line; all rows check the
// same ones.
#include <array>
#include <span>
#include <vector>

#include "bench/rows.hpp"
#include "harness/kernel/random.hpp"
#include "harness/line/frame_check.hpp"
#include "harness/line/frame_check_16.hpp"

#ifdef FIELDPROOF_HAVE_BOOST_CRC
#include <boost/crc.hpp>
#endif

namespace fieldproof::bench {
namespace {

constexpr std::size_t kBufferOctets = 16'384;  // fits the first-level cache
constexpr std::size_t kBatchOctets = 1 << 20;

// Calls check(message) for one message after the other until a batch is done. `sum` keeps the results alive.
template <typename Check>
Batch batch_of(std::size_t size, Check check) {
  kernel::Random random(1);
  std::vector<std::uint8_t> buffer(kBufferOctets);
  for (std::uint8_t& octet : buffer) octet = static_cast<std::uint8_t>(random.next());
  return [size, check, buffer, sum = std::uint64_t{0}]() mutable {
    std::size_t done = 0;
    while (done < kBatchOctets) {
      for (std::size_t at = 0; at + size <= buffer.size(); at += size, done += size) {
        sum += check(std::span<const std::uint8_t>(buffer.data() + at, size));
      }
    }
    return std::uint64_t{done} + (sum == 1 ? 1U : 0U);
  };
}

const line::FrameCheck16& profibus() {
  return line::shared_frame_check_16("CRC-16/PROFIBUS");
}

std::vector<Row> rows_of_16_bits(std::size_t size, double target) {
  const std::string group = "frame check CRC-16/PROFIBUS, " + std::to_string(size) + " octets";
  std::vector<Row> rows;
#ifdef FIELDPROOF_HAVE_BOOST_CRC
  rows.push_back({group, "Boost.CRC", "octets", "", 0, [size] {
                    return batch_of(size, [](std::span<const std::uint8_t> message) {
                      boost::crc_optimal<16, 0x1DCF, 0xFFFF, 0xFFFF, false, false> crc;
                      crc.process_bytes(message.data(), message.size());
                      return std::uint64_t{crc.checksum()};
                    });
                  }});
#endif
  rows.push_back({group, "one table", "octets", "Boost.CRC", 0, [size] {
                    return batch_of(size, [&check = profibus()](std::span<const std::uint8_t> message) {
                      return std::uint64_t{check.finish(check.update_by_table(check.start(), message))};
                    });
                  }});
  rows.push_back({group, "eight tables", "octets", "Boost.CRC", 0, [size] {
                    return batch_of(size, [&check = profibus()](std::span<const std::uint8_t> message) {
                      return std::uint64_t{check.finish(check.update_by_slices(check.start(), message))};
                    });
                  }});
  rows.push_back({group, "fieldproof", "octets", "Boost.CRC", target, [size] {
                    return batch_of(size, [&check = profibus()](std::span<const std::uint8_t> message) {
                      return std::uint64_t{check.compute(message)};
                    });
                  }});
  return rows;
}

std::vector<Row> rows_of_32_bits() {
  const std::string group = "frame check CRC-32, 256 octets";
  std::vector<Row> rows;
#ifdef FIELDPROOF_HAVE_BOOST_CRC
  rows.push_back({group, "Boost.CRC", "octets", "", 0, [] {
                    return batch_of(256, [](std::span<const std::uint8_t> message) {
                      boost::crc_32_type crc;
                      crc.process_bytes(message.data(), message.size());
                      return std::uint64_t{crc.checksum()};
                    });
                  }});
#endif
  rows.push_back({group, "fieldproof, any width", "octets", "Boost.CRC", 0, [] {
                    const line::FrameCheck check(line::frame_check_named("CRC-32"));
                    return batch_of(256, [check](std::span<const std::uint8_t> message) {
                      return static_cast<std::uint64_t>(check.compute(message));
                    });
                  }});
  return rows;
}

const Rows kEight(rows_of_16_bits(8, 2.5));
const Rows kSixtyFour(rows_of_16_bits(64, 4.5));
const Rows kTwoHundred(rows_of_16_bits(256, 4.5));
const Rows kFourThousand(rows_of_16_bits(4096, 4.5));
const Rows kWide(rows_of_32_bits());

}  // namespace
}  // namespace fieldproof::bench
