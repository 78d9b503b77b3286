#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "harness/line/telegram_receiver.hpp"
#include "harness/line/waveforms.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/rules.hpp"

// The lower tester's ears and hands on one line: a view of the telegrams that passed there, and a writer of
// trains of telegrams.
//
// A view keeps the waveforms since its last `clear` and decodes them when it is first asked, so a line that
// nobody looks at costs a copy. What a station drives ahead is there when its time has come, also after a
// `clear`. A telegram that its own waveform cuts is completed by what follows, or by the
// idle line.
namespace fieldproof::conformance {

struct SeenTelegram {
  std::uint32_t origin = 0;  // of its waveform, see LineView::start_of
  std::uint32_t level = 0;
  std::uint8_t header = 0;  // as in line::Telegram
  std::uint8_t data = 0;

  bool is_data() const { return (header & line::kDataTelegram) != 0; }
  bool is_stop_missing() const { return (header & line::kStopMissing) != 0; }
};

class LineView final : public segment::Tap {
 public:
  LineView(const segment::Segment& segment, const line::TelegramCode& code, std::int64_t bit_rate)
      : segment_(segment), bit_rate_(bit_rate), receiver_(code, bit_rate) {}

  void on_wave(const line::Waveform& wave) override;
  void clear();

  // Since the last clear, in order of time.
  std::span<const line::Waveform> waves() const { return {waves_.data(), begun()}; }
  std::span<const SeenTelegram> telegrams();
  std::span<const SeenTelegram> data_telegrams();
  std::size_t status_count() {
    decode();
    return status_count_;
  }

  kernel::Time start_of(const SeenTelegram& telegram) const;
  kernel::Time end_of(const SeenTelegram& telegram) const;

 private:
  struct Origin {
    kernel::Time start;
    std::int64_t rate;
  };
  std::size_t begun() const;
  void decode();
  void keep(const line::Waveform& wave, const line::Telegram& telegram) {
    if (&wave != origin_of_) add_origin(wave);
    telegrams_.push_back(
        {static_cast<std::uint32_t>(origins_.size() - 1), telegram.level, telegram.header, telegram.data});
    if (!telegram.is_data()) ++status_count_;
  }
  void add_origin(const line::Waveform& wave);

  const segment::Segment& segment_;
  std::int64_t bit_rate_;
  line::TelegramReceiver receiver_;
  line::Waveforms waves_;
  std::size_t decoded_ = 0;
  std::vector<Origin> origins_;
  const line::Waveform* origin_of_ = nullptr;  // of the last origin, while it is decoded
  std::vector<SeenTelegram> telegrams_;
  std::size_t status_count_ = 0;
  std::vector<SeenTelegram> data_telegrams_;  // of telegrams_, when there are others among them
  std::size_t sorted_ = 0;                    // of telegrams_, into data_telegrams_
};

// Where a cycle lies in a train.
struct CyclePlace {
  std::size_t level = 0;   // of its first telegram
  std::size_t pitch = 13;  // levels from telegram to telegram
  std::size_t octets = 0;  // transfer telegrams
  std::size_t first = 0;   // data telegrams in front of it in the train
  bool is_id_cycle = false;

  std::size_t telegrams() const { return octets + 4; }
  std::size_t level_of(std::size_t telegram, std::size_t level_in_telegram) const {
    return level + telegram * pitch + level_in_telegram;
  }
  std::size_t end() const { return level + telegrams() * pitch; }
};

// Builds the levels of a train at the bit rate of the rules.
class TrainWriter {
 public:
  explicit TrainWriter(const interbus::Rules& rules);

  void clear();
  bool empty() const { return levels_.empty(); }
  const line::Levels& levels() const { return levels_; }
  line::Levels& levels() { return levels_; }
  std::span<const CyclePlace> cycles() const { return cycles_; }
  std::size_t data_telegram_count() const { return data_telegrams_; }

  // Idle levels after each telegram that is appended from here on.
  void set_gap(unsigned bits) { gap_ = bits; }
  unsigned gap() const { return gap_; }
  // Status telegrams after each telegram of the cycles that are appended from here on.
  void set_status_between(unsigned count) { status_between_ = count; }

  void telegram(std::uint8_t header, std::uint8_t data);
  void idle(std::size_t bits) { levels_.append_idle(bits); }
  // At the pitch of the rules.
  void status(std::size_t count);
  const CyclePlace& cycle(bool is_id_cycle, std::span<const std::uint8_t> octets, std::uint16_t check,
                          std::uint16_t status_word);

  const line::TelegramCode& code() const { return code_; }
  // The level inside a telegram that carries a bit of its octet, 0 the first of the frame check; and that of
  // a header level.
  unsigned data_level(unsigned bit) const { return 4 + (is_msb_first_ ? bit : 7 - bit); }
  unsigned header_level(line::HeaderLevel which) const;
  static constexpr unsigned kStopLevel = 12;

 private:
  line::TelegramLayout layout_;
  line::TelegramCode code_;
  bool is_msb_first_;
  unsigned status_pitch_;
  unsigned gap_ = 2;
  unsigned status_between_ = 0;
  std::size_t data_telegrams_ = 0;
  line::Levels levels_;
  std::vector<CyclePlace> cycles_;
};

// "in  T3 +52.000 us data SL0 CR1 29h" for people.
std::string describe(const LineView& view, const SeenTelegram& telegram, kernel::Time from);

}  // namespace fieldproof::conformance
