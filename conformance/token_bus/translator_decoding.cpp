#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/translator_scene.hpp"

// What arrives is indicated by its two bits, the carrier, and the signal status. The paper leaves the table
// of decoding out: what follows from that of encoding is derived, the rest is this project's choice.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_sources::derived;
using token_sources::own;
using token_sources::paper;

struct PairRow {
  std::string_view pair;
  char fresh;        // carrier on, no error, no non_data open
  char within_pair;  // the same, and the second non_data is due
};
constexpr std::array<PairRow, 9> kPhyPairs{{{"10", '1', 'B'},
                                            {"01", '0', 'B'},
                                            {"11", 'N', 'B'},
                                            {"00", 'B', 'N'},
                                            {"1I", 'B', 'B'},
                                            {"0I", 'B', 'B'},
                                            {"I1", 'S', 'S'},
                                            {"I0", 'S', 'S'},
                                            {"II", 'S', 'S'}}};
constexpr unsigned kCells = 54;  // nine pairs, three states of the line, non_data open or not

struct CellOfRound {
  const PairRow& row;
  unsigned status;  // 0 carrier off, 1 on, 2 on with an error
  bool is_within_pair;

  explicit CellOfRound(unsigned round)
      : row(kPhyPairs.at(round / 6 % kPhyPairs.size())),
        status(round % 3),
        is_within_pair(round / 3 % 2 == 1) {}
  char right() const {
    if (status == 0) return 'S';
    if (status == 2) return 'B';
    return is_within_pair ? row.within_pair : row.fresh;
  }
  std::string text() const {
    constexpr std::array<std::string_view, 3> kStates{"without carrier", "with carrier",
                                                      "with carrier and a signal error"};
    return fmt::format("{} {}{}", row.pair, kStates.at(status),
                       is_within_pair ? ", the second non_data due" : "");
  }
};

std::string begin_of_frame(const CellOfRound& cell) {
  return "PPPPPPPPPPPPPPPPPPPPPPPPPPPPPPPP" + start_delimiter_text() + "0110" +
         (cell.is_within_pair ? "N" : "");
}

void receive_cell(TranslatorScene& scene) {
  const CellOfRound cell(scene.round);
  SideBits bits = side_bits_of(encoded(begin_of_frame(cell)));
  for (const char one : cell.row.pair) bits.push_back({one, cell.status > 0, cell.status == 2});
  scene.receive(bits);
}

void expect_cell(TranslatorScene& scene) {
  const CellOfRound cell(scene.round);
  scene.bench.settle();
  std::string before = begin_of_frame(cell);
  before = before.substr(before.find('N'));
  std::string seen = scene.content();
  seen.resize(std::max(seen.size(), before.size() + 1), 'S');
  scene.judge.expect(
      seen.substr(0, before.size()) == before && seen[before.size()] == cell.right(), "cell_wrong",
      [&] { return Mismatch{{fmt::format("{}: {}, after {}", cell.text(), cell.right(), before)}, seen}; });
}

// A frame with something in its middle; each half is 16 octets.
constexpr std::size_t kHalfOctets = 16;

struct Halves {
  std::string first;
  std::string second;
};
Halves halves_of(TranslatorScene& scene) {
  const std::string frame = frame_text(scene.bench.random_octets(2 * kHalfOctets));
  const std::size_t middle = 32 + 8 + 8 * kHalfOctets;
  return {frame.substr(0, middle), frame.substr(middle)};
}

void receive_with_error(TranslatorScene& scene) {
  const Halves halves = halves_of(scene);
  SideBits bits = side_bits_of(encoded(halves.first + halves.second));
  bits.at(2 * halves.first.size() + scene.round % 2).has_error = true;
  scene.requested = halves.first.substr(32) + "B" + halves.second.substr(1);
  scene.receive(bits);
}

void receive_with_swapped_non_data(TranslatorScene& scene) {
  const Halves halves = halves_of(scene);
  scene.requested = halves.first.substr(32);
  scene.receive(encoded(halves.first) + "0011" + encoded(halves.second));
}

void expect_rejected(TranslatorScene& scene) {
  scene.bench.settle();
  const std::string seen = scene.content();
  scene.judge.expect(seen.substr(0, scene.requested.size() + 1) == scene.requested + "B",
                     "swapped_non_data_taken",
                     [&] { return Mismatch{{scene.requested + "B, and so on"}, seen}; });
}

// In front of a frame whose preamble was lost but for its end.
void receive_second_non_data_first(TranslatorScene& scene) {
  scene.requested = frame_text(scene.octets);
  scene.receive("10101010101010100011" + encoded(start_delimiter_text()).substr(4) +
                encoded(scene.requested.substr(40)));
}

void receive_with_gap(TranslatorScene& scene) {
  const Halves halves = halves_of(scene);
  SideBits bits = side_bits_of(encoded(halves.first));
  for (unsigned n = 0; n < 8; ++n) bits.push_back({'I', scene.round % 2 == 1, false});
  scene.requested = halves.first;
  scene.receive(bits);
}

void receive_two_frames(TranslatorScene& scene) {
  scene.requested = frame_text(scene.octets, true) + frame_text(scene.bench.random_octets(5));
  scene.receive(encoded(scene.requested));
}

TranslatorStep is_indicated(std::string text, std::string reason) {
  return requires_that(std::move(text), [reason = std::move(reason)](TranslatorScene& scene) {
    const std::string right = indicated_as(scene.requested);
    scene.expect_content(right.substr(right.find('N')), reason);
  });
}

void receive_collision(TranslatorScene& scene) {
  SideBits bits;
  for (unsigned n = 0; n < 96; ++n) {
    const std::uint8_t any = scene.bench.random_octet();
    bits.push_back({any % 2 == 0 ? '1' : '0', true, n > 10});
  }
  scene.receive(bits);
}

}  // namespace

std::vector<TranslatorCase> translator_decoding_cases() {
  return {
      on_chart(translator_must("decoding/each_pair_by_carrier_and_signal", "PST-05",
                               "Each of the nine pairs of bits is indicated as the table of decoding says, "
                               "by carrier and signal status, and by whether a non_data is open.",
                               own("table of decoding"),
                               {{"carrier_ignored", "cell_wrong"},
                                {"error_is_silence", "cell_wrong"},
                                {"cut_pair_is_silence", "cell_wrong"},
                                {"idle_is_bad_signal", "cell_wrong"},
                                {"data_after_non_data_taken", "cell_wrong"}}),
               {{kCells, kCells},
                {does("a frame that ends in each pair, without and with carrier, and with a signal error",
                      receive_cell),
                 requires_that("the symbol of the table", expect_cell), pause()},
                {on_line()}}),
      on_chart(
          translator_must("decoding/swapped_non_data_is_bad_signal", "PST-07",
                          "CD0,CD0 in front of CD1,CD1 is no non_data.", own("non_data is an ordered pair"),
                          {{"non_data_in_any_order", "swapped_non_data_taken"},
                           {"non_data_pair_read_swapped", "swapped_non_data_taken"}}),
          {{3, 30},
           {does("a frame with CD0,CD0,CD1,CD1 in its data", receive_with_swapped_non_data),
            requires_that("bad_signal", expect_rejected), receives()},
           {on_line()}}),
      on_chart(translator_must("decoding/swapped_start_delimiter_is_none", "PST-07",
                               "A start delimiter whose first two non_data are exchanged begins no frame.",
                               own("non_data is an ordered pair"),
                               {{"non_data_in_any_order", "swapped_delimiter_taken"}}),
               {{3, 30},
                {does("a frame with CD0,CD0,CD1,CD1 in front", receive_second_non_data_first),
                 requires_that("no start delimiter is indicated",
                               [](TranslatorScene& scene) {
                                 scene.bench.settle();
                                 const std::string& seen = scene.bench.indicated().text();
                                 scene.judge.expect(seen.find(start_delimiter_text()) == std::string::npos,
                                                    "swapped_delimiter_taken", "no NN0NN000", seen);
                               }),
                 receives()},
                {on_line()}}),
      on_chart(
          translator_must("decoding/a_signal_error_is_bad_signal", "PST-08",
                          "One bit with a signal error is a bad_signal, and costs no other symbol.",
                          paper("carrier status and signal status are considered"),
                          {{"error_is_silence", "error_not_indicated"},
                           {"error_not_looked_at", "error_not_indicated"},
                           {"error_loses_the_lock", "error_not_indicated"}},
                          {{own("the phase is kept"), {"error_not_indicated"}}}),
          {{4, 40},
           {does("a frame with a signal error in the first or second bit of one symbol", receive_with_error),
            is_indicated("bad_signal in its place, and the rest of the frame", "error_not_indicated"),
            receives()},
           {on_line()}}),
      on_chart(
          translator_must("decoding/a_lost_carrier_is_silence", "PST-09",
                          "When the line falls silent within a frame, silence is indicated.",
                          paper("silence is IDL,IDL"), {{"idle_is_bad_signal", "silence_not_indicated"}}),
          {{4, 40},
           {does("a frame that ends in its middle, with and without the carrier for eight more bits",
                 receive_with_gap),
            is_indicated("its symbols, then silence", "silence_not_indicated"), receives()},
           {on_line()}}),
      on_chart(translator_must("decoding/frames_of_one_transmission_follow_each_other", "PST-12",
                               "After an end delimiter with I = 1 the next frame is indicated at once.",
                               token_sources::standard("I: more follows in this transmission"),
                               {{"blanks_after_every_frame", "second_frame_lost"}}),
               {{3, 30},
                {does("two frames in one transmission", receive_two_frames),
                 is_indicated("both, and the preamble between them", "second_frame_lost"), pause()},
                {on_line()}}),
      on_chart(
          translator_must("decoding/a_collision_is_forgotten", "",
                          "After a fragment of a collision, which repeaters make 96 bits long, the next "
                          "frame is received.",
                          derived("fragments of a repeater"), {{"deaf_after_error", "does_not_recover"}}),
          {{3, 30}, {does("96 bits with signal errors", receive_collision), receives()}, {on_line()}}),
  };
}

}  // namespace fieldproof::conformance
