#include <fmt/format.h>

#include "conformance/token_bus/driven_frames.hpp"
#include "conformance/token_bus/dual_channel_scene.hpp"

// What a transmission is, and what each of these on one channel, beside each on the other, does to what is
// counted: of errors and of clean ones.
namespace fieldproof::conformance {
namespace {

using namespace manager_chart;

enum class TrainIs : std::uint8_t { clean, spoiled, neither };

// Made of two frames, the first with I = 1.
struct Train {
  std::string_view text;
  TrainIs is;
  std::string (*made)(ManagerScene& scene);
};

// The last symbols of what testers drive: an end delimiter.
constexpr std::size_t kTrainEnd = 8;

// Of so many octets.
std::string frame_of(ManagerScene& scene, std::size_t octets) {
  return scene.frame(octets - token_bus::frame_octets(scene.bench.configuration().rules, 0));
}
std::size_t octets_at_most(const ManagerScene& scene) {
  return scene.bench.configuration().rules.most_octets;
}

std::string right_train(ManagerScene& scene) {
  return scene.frame(0, true) + scene.frame();
}
std::string right_and_longest(ManagerScene& scene) {
  return scene.frame(0, true) + frame_of(scene, octets_at_most(scene));
}
std::string first_octet_wrong(ManagerScene& scene) {
  return scene.frame(0, true) + flipped_at(scene.frame(), kManagerHead);
}
std::string check_of_train_wrong(ManagerScene& scene) {
  const std::string last = frame_of(scene, octets_at_most(scene));
  return scene.frame(0, true) + flipped_at(last, last.size() - kTrainEnd - 1);
}
std::string first_frame_wrong(ManagerScene& scene) {
  const std::string first = scene.frame(0, true);
  return flipped_at(first, first.size() - kTrainEnd - 1) + scene.frame();
}
std::string first_frame_endless(ManagerScene& scene) {
  const std::string first = scene.frame(0, true);
  return first.substr(0, first.size() - kTrainEnd) + std::string(kTrainEnd, '0') + scene.frame();
}
std::string cut_train(ManagerScene& scene) {
  const std::string last = scene.frame();
  return scene.frame(0, true) + last.substr(0, last.size() - kTrainEnd);
}
std::string late_bad_signal(ManagerScene& scene) {
  std::string last = frame_of(scene, octets_at_most(scene));
  last.at(kManagerHead + static_cast<std::size_t>(scene.slot_symbols()) + 20) = 'B';
  return scene.frame(0, true) + last;
}
std::string with_e_bit(ManagerScene& scene) {
  const std::string text = right_train(scene);
  return flipped_at(text, text.size() - 1);
}
std::string too_long_train(ManagerScene& scene) {
  return scene.frame(0, true) + frame_of(scene, octets_at_most(scene) + 1);
}

constexpr std::array kTrains{
    Train{"right frames", TrainIs::clean, right_train},
    Train{"right frames, one the longest", TrainIs::clean, right_and_longest},
    Train{"a wrong bit in the first octet", TrainIs::spoiled, first_octet_wrong},
    Train{"a wrong check in the longest frame", TrainIs::spoiled, check_of_train_wrong},
    Train{"a wrong check in the first frame", TrainIs::spoiled, first_frame_wrong},
    Train{"a start delimiter in a frame", TrainIs::spoiled, first_frame_endless},
    Train{"a frame without its end", TrainIs::spoiled, cut_train},
    Train{"bad_signal after a slot time", TrainIs::spoiled, late_bad_signal},
    Train{"E = 1", TrainIs::neither, with_e_bit},
    Train{"a frame that is too long", TrainIs::neither, too_long_train}};

// Each kind beside each, on each channel in turn.
const Train& here_of(const ManagerScene& scene) {
  return kTrains.at(scene.round / kTrains.size() % kTrains.size());
}
const Train& there_of(const ManagerScene& scene) {
  return kTrains.at(scene.round % kTrains.size());
}
Channel judged_of(const ManagerScene& scene) {
  const std::size_t walk = scene.round / kTrains.size() / kTrains.size();
  return token_bus::kChannels.at((scene.round / kTrains.size() + scene.round + walk) % 2);
}
Walk<ManagerScene> each_beside_each() {
  return {"each kind of transmission beside each",
          [](ManagerScene&) { return kTrains.size() * kTrains.size(); }};
}

// Long enough for what is late, and short enough for many.
template <unsigned errors, unsigned clean>
ManagerNeeds counting() {
  return {.adjust = [](token_bus::ChannelManagerConfiguration& one) {
    one.rules.slot_time_octets = 12;
    one.rules.most_octets = 64;
    one.channels.errors_in_a_row = errors;
    one.channels.clean_in_a_row = clean;
  }};
}

void carry_pair(ManagerScene& scene) {
  const std::string here = here_of(scene).made(scene);
  scene.carry_from(judged_of(scene), {here}, {there_of(scene).made(scene)});
}
void carry_error(ManagerScene& scene) {
  scene.carry_from(judged_of(scene), {check_of_train_wrong(scene)}, {right_and_longest(scene)});
}
bool is_error_here(const ManagerScene& scene) {
  return here_of(scene).is == TrainIs::spoiled && there_of(scene).is == TrainIs::clean;
}
void expect_of_judged(ManagerScene& scene, bool is_reported, std::string_view kind) {
  scene.expect_event_of(judged_of(scene), is_reported ? kind : "",
                        is_reported ? "report_wrong" : "reported_without_fault");
}

ManagerCase errors_case() {
  return on_chart(
      manager_must(
          "verdicts/count_errors", "PST-17",
          "An error is counted where a transmission is spoiled here and clean there; one that is clean "
          "here ends the row; whatever else there is changes nothing.",
          "spoiled transmissions in a row",
          {{"both_spoiled_ends_a_row", "report_wrong"},
           {"neither_ends_a_row", "report_wrong"},
           {"error_beside_neither_counts", "reported_without_fault"},
           {"knows_no_most_octets", "reported_without_fault"}}),
      {{1, 2},
       {powered_anew(),
        {"a channel has an error, the other one none", "nothing is reported",
         [](ManagerScene& scene) {
           carry_error(scene);
           expect_of_judged(scene, false, "");
         }},
        {"the channel carries one kind, the other one the other", "two errors are reported, one is not",
         [](ManagerScene& scene) {
           carry_pair(scene);
           expect_of_judged(scene, is_error_here(scene), "frame errors");
         }},
        {"the channel has an error again", "frame errors are reported now, unless the row was ended",
         [](ManagerScene& scene) {
           carry_error(scene);
           expect_of_judged(scene, !is_error_here(scene) && here_of(scene).is != TrainIs::clean,
                            "frame errors");
         }}},
       {},
       each_beside_each()},
      counting<2, 16>());
}

ManagerCase clean_case() {
  const auto carry_right = [](ManagerScene& scene) {
    scene.carry({right_train(scene)}, {right_train(scene)});
  };
  return on_chart(
      manager_must("verdicts/count_clean_ones", "",
                   "After a fault a clean transmission counts whatever the other channel carries, a spoiled "
                   "one begins anew, and what is neither changes nothing.",
                   "clean transmissions in a row",
                   {{"neither_is_clean", "reported_without_fault"},
                    {"neither_begins_clean_ones_anew", "report_wrong"}}),
      {{1, 2},
       {powered_anew(),
        does("both carry right frames", carry_right),
        does("only the other channel carries a frame",
             [](ManagerScene& scene) { scene.carry_from(judged_of(scene), {}, {right_train(scene)}); }),
        {"both carry right frames", "nothing is reported",
         [carry_right](ManagerScene& scene) {
           carry_right(scene);
           expect_of_judged(scene, false, "");
         }},
        {"the channel carries one kind, the other one the other", "it is clean again where that is clean",
         [](ManagerScene& scene) {
           carry_pair(scene);
           expect_of_judged(scene, here_of(scene).is == TrainIs::clean, "clean again");
         }},
        {"both carry right frames", "it is clean again where the last was neither",
         [carry_right](ManagerScene& scene) {
           carry_right(scene);
           expect_of_judged(scene, here_of(scene).is == TrainIs::neither, "clean again");
         }},
        {"both carry right frames", "it is clean again where the last but one was spoiled",
         [carry_right](ManagerScene& scene) {
           carry_right(scene);
           expect_of_judged(scene, here_of(scene).is == TrainIs::spoiled, "clean again");
         }}},
       {},
       each_beside_each()},
      counting<16, 2>());
}

// ---- settings ----

// As many errors as there may be, one less, and the same of clean ones.
void count_to_the_limits(ManagerScene& scene) {
  const Channel here = scene.here();
  const auto& channels = scene.bench.configuration().channels;
  scene.power_anew();
  for (unsigned n = 1; n <= channels.errors_in_a_row; ++n) {
    scene.carry_from(here, {scene.with_wrong_check()}, {scene.frame()});
    scene.expect_event_of(here, n == channels.errors_in_a_row ? "frame errors" : "", "report_wrong");
  }
  for (unsigned n = 1; n <= channels.clean_in_a_row; ++n) {
    scene.carry_on_both();
    scene.expect_event_of(here, n == channels.clean_in_a_row ? "clean again" : "", "report_wrong");
  }
  if (channels.clean_in_a_row == 1) return;
  // Clean while the other channel is silent, whose fault that is.
  scene.carry_on(other_than(here));
  for (unsigned n = 1; n <= channels.clean_in_a_row; ++n) {
    scene.carry_on(here);
    scene.expect_event_of(n == 1 ? other_than(here) : here,
                          n == 1                         ? "no start delimiter"
                          : n == channels.clean_in_a_row ? "clean again"
                                                         : "",
                          "report_wrong");
  }
}

template <unsigned count>
ManagerCase counts_case(std::vector<MustCatch> catches) {
  return on_chart(
      manager_must(fmt::format("verdicts/rows_of_{}", count), "PST-17",
                   fmt::format("A fault is found after errors_in_a_row errors and ends after "
                               "clean_in_a_row clean ones, to the transmission; here both are {}.",
                               count),
                   "spoiled transmissions in a row", std::move(catches)),
      {{2, 20},
       {{"a channel has as many errors as make a fault, then both are clean as often as end it; it has "
         "another fault, and carries clean frames alone",
         "each is reported with the last of them", count_to_the_limits}}},
      counting<count, count>());
}

// ---- neither clean ----

// Too short, or no whole octets.
std::string no_frame(ManagerScene& scene) {
  const std::size_t least = token_bus::frame_octets(scene.bench.configuration().rules, 0);
  if (scene.round % 2 == 0)
    return indicated_as(frame_text(with_crc_32(scene.bench.random_octets(least - 5))));
  std::string whole = scene.frame();
  return whole.insert(whole.size() - kTrainEnd, 1 + scene.bench.random_octet() % 7, '0');
}

template <token_bus::AddressLength length>
ManagerCase no_frame_case(std::string_view id, std::vector<MustCatch> catches) {
  return on_chart(
      manager_must(fmt::format("verdicts/no_frame_with_{}_bits", id), "",
                   "A frame that is shorter than any, or no whole octets, is not clean, though its check be "
                   "right: it neither ends a row of errors nor a fault.",
                   "spoiled transmissions in a row", std::move(catches)),
      {{4, 40},
       {powered_anew(),
        {"A has an error; both carry what is no frame; A has an error again",
         "frame errors are reported then",
         [](ManagerScene& scene) {
           scene.carry({scene.with_wrong_check()}, {scene.frame()});
           const std::string none = no_frame(scene);
           scene.carry({none}, {none});
           scene.expect_events({}, "reported_without_fault");
           scene.carry({scene.with_wrong_check()}, {scene.frame()});
           scene.expect_event_of(Channel::a, "frame errors", "report_wrong");
         }},
        {"both are clean once, then A carries what is no frame", "nothing is reported",
         [](ManagerScene& scene) {
           scene.carry_on_both();
           scene.carry({no_frame(scene)}, {scene.frame()});
           scene.expect_events({}, "reported_without_fault");
         }}}},
      {.adjust = [](token_bus::ChannelManagerConfiguration& one) {
        counting<2, 2>().adjust(one);
        one.rules.address_length = length;
      }});
}

// ---- lengths, and how far apart ----

void spoil_apart(ManagerScene& scene) {
  const std::array apart{std::int64_t{0}, std::int64_t{1}, scene.skew(), scene.skew() + 1,
                         scene.slot_symbols()};
  const std::int64_t later = apart.at(scene.round / 2 % apart.size());
  const bool is_first = scene.round / 2 / apart.size() % 2 == 0;
  const std::string wrong = scene.with_wrong_check();
  scene.power_anew();
  scene.carry_from(scene.here(), {wrong, is_first ? 0 : later}, {scene.frame(), is_first ? later : 0});
  scene.expect_event_of(scene.here(), "frame errors", "report_wrong");
  // Beside silence it is none.
  scene.power_anew();
  scene.carry_from(scene.here(), {wrong}, {});
  scene.expect_event_of(other_than(scene.here()), "no start delimiter", "reported_without_fault");
}

void spoil_a_long_frame(ManagerScene& scene) {
  constexpr std::array<std::size_t, 4> kOctets{300, 1'100, 4'100, 8'191};
  const std::string frame = frame_of(scene, kOctets.at(scene.round % kOctets.size()));
  const std::size_t at = kManagerHead + scene.bench.random().below(frame.size() - kManagerHead - kTrainEnd);
  scene.power_anew();
  scene.carry({flipped_at(frame, at)}, {frame});
  scene.expect_event_of(Channel::a, "frame errors", "report_wrong");
}

std::vector<ManagerCase> length_verdict_cases() {
  const auto needs = ManagerNeeds{.adjust = [](token_bus::ChannelManagerConfiguration& one) {
    one.rules.phy_bit_rate = token_bus::Rules{}.phy_bit_rate;
    one.rules.slot_time_octets = std::max(one.rules.slot_time_octets, 28U);
    one.rules.most_octets = token_bus::Rules{}.most_octets;
    one.channels.errors_in_a_row = 1;
  }};
  return {
      on_chart(
          manager_must("verdicts/however_far_apart", "PST-17",
                       "A transmission is compared with that of the other channel however much later it "
                       "comes, up to a slot time.",
                       "spoiled transmissions in a row", {{"errors_are_no_fault", "report_wrong"}}),
          {{20, 100},
           {{"both carry a frame, one with a wrong check, at once, a symbol, the skew, a symbol more and "
             "a slot time apart, each channel first",
             "frame errors are reported; where the other channel is silent only that it has no start "
             "delimiter",
             spoil_apart}}},
          needs),
      on_chart(manager_must("verdicts/of_long_frames", "PST-17",
                            "A wrong bit is an error wherever it is, in frames of any length.",
                            "a manager knows no length", {{"gives_up_after_50000", "report_wrong"}}),
               {{4, 20},
                {{"both carry a frame of 300, 1100, 4100 and 8191 octets, that of A with a wrong bit",
                  "frame errors are reported", spoil_a_long_frame}}},
               needs),
  };
}

}  // namespace

std::vector<ManagerCase> manager_verdict_cases() {
  std::vector<ManagerCase> all{errors_case(),
                               clean_case(),
                               counts_case<1>({{"leaves_after_2", "report_wrong"}}),
                               counts_case<16>({{"counts_in_four_bits", "report_wrong"}}),
                               no_frame_case<token_bus::AddressLength::bits_16>(
                                   "16", {{"spoiled_is_clean", "reported_without_fault"}}),
                               no_frame_case<token_bus::AddressLength::bits_48>(
                                   "48", {{"takes_all_addresses_for_short", "report_wrong"}})};
  for (ManagerCase& one : length_verdict_cases()) all.push_back(std::move(one));
  return all;
}

}  // namespace fieldproof::conformance
