#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "conformance/token_bus/sides_bench.hpp"
#include "conformance/token_bus/translator_sides.hpp"
#include "protocols/token_bus/translator_device.hpp"

// The bench of one case for a translator: the implementation under test (IUT) between two testers. The lower
// tester is the IEEE 802.3 physical layer, the upper tester the MAC of IEEE 802.4. Verdicts rest on what the
// IUT drives on its two sides.
namespace fieldproof::conformance {

struct TranslatorNeeds {
  void (*adjust)(token_bus::TranslatorConfiguration&) = nullptr;
};

using TranslatorSetting = PlannedSetting<token_bus::TranslatorDevice, token_bus::TranslatorConfiguration>;

class TranslatorBench final
    : public SidesBench<token_bus::TranslatorDevice, token_bus::TranslatorConfiguration> {
 public:
  TranslatorBench(const TranslatorNeeds& needs, const TranslatorSetting& setting);

  kernel::Duration delay() const { return symbols(configuration().delay_symbols); }

  // ---- upper tester; each runs until what is requested is over ----
  void request(std::string_view symbols);
  void command(SideCommand command, std::size_t symbols);

  // ---- lower tester; each runs until what is received is over ----
  void carry(const SideBits& bits);
  // As a repeater or another station sends it.
  void carry(std::string_view bits) { carry(side_bits_of(bits)); }
  // Both at once: what the IUT receives while something is requested of it.
  void request_and_receive(std::string_view symbols, const SideBits& bits);
  void command_and_receive(SideCommand command, std::size_t symbols, const SideBits& bits);
  void set_line_clock(std::int64_t parts_per_million) { parts_per_million_ = parts_per_million; }
  void set_mac_clock(std::int64_t parts_per_million) { mac_parts_per_million_ = parts_per_million; }
  // So many symbols as the MAC counts them.
  kernel::Duration requested_symbols(std::size_t count) const;

  // Until everything that was given has come out, and what that comes too late, too.
  void settle() { wait(4 * delay() + symbols(4)); }
  void clear() {
    sent_.clear();
    indicated_.clear();
  }
  // Since the last `clear`.
  const SideLog& sent() const { return sent_; }
  const SideLog& indicated() const { return indicated_; }

  // ---- what else a bench does ----
  std::vector<std::string> decode_lines() const;
  // What it must answer: a command of the management.
  void ask();

 private:
  kernel::Time drive_request(line::Levels levels);
  kernel::Time drive_bits(const SideBits& bits);

  SideLog sent_;
  SideLog indicated_;
  segment::Link& phy_in_;
  segment::Link& mac_in_;
  segment::Link& phy_out_;
  segment::Link& mac_out_;
  std::int64_t parts_per_million_ = 0;
  std::int64_t mac_parts_per_million_ = 0;
};

}  // namespace fieldproof::conformance
