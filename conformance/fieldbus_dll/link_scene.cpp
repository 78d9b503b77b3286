#include "conformance/fieldbus_dll/link_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace fieldproof::conformance {

const DrivenDlpdu& LinkScene::expect_answer(const std::string& what, std::string_view reason) {
  answer = expect_next(link, judge, reason, what);
  expect_begins(judge, answer, sent + link.least_gap(), "answers_too_early", sent + answer_time,
                "answers_too_late");
  return answer;
}

kernel::Duration LinkScene::expect_none_after(std::string_view token, unsigned duration) {
  const kernel::Time over = sent + link.octets(duration);
  kernel::Duration left = link.octets(duration);
  for (const DrivenDlpdu& one : link.listen()) {
    judge.expect(one.end <= over + kLinkRounding, "talks_behind_duration", [&] {
      return Mismatch{
          {fmt::format("silence after {}, {} octets after the {}", kernel::describe(over), duration, token)},
          fmt::format("{} until {}", one.text(), kernel::describe(one.end)),
          one.begin};
    });
    left = over - one.end;
  }
  return left;
}

Octets with_wrong_bits(Octets frame, const std::vector<std::size_t>& bits) {
  for (const std::size_t bit : bits)
    frame[bit / 8] = static_cast<std::uint8_t>(frame[bit / 8] ^ (0x80U >> bit % 8));
  return frame;
}

bool keep_busy(LinkBench& link, kernel::Time until, DlpduIsNone kind) {
  constexpr std::uint8_t kNoDlpdu = 0xFF;  // of no profile
  constexpr std::int64_t kMostOctets = 200;
  const kernel::Duration whole = until - link.now();
  const kernel::Duration around = link.frame(0);
  if (link.least_gap() <= link.octets(1) || whole <= around + link.octets(1)) return false;
  // Equal frames, in front of each an octet of silence at most.
  const std::int64_t count = whole / (around + link.octets(kMostOctets)) + 1;
  const kernel::Time begin = link.now();
  for (std::int64_t n = 0; n < count; ++n) {
    const kernel::Time from = begin + whole * n / count;
    const kernel::Time to = begin + whole * (n + 1) / count;
    const auto size = (to - from - around - link.octets(1) / 2) / link.octets(1);
    Octets octets(static_cast<std::size_t>(std::max<std::int64_t>(size, 1)), kNoDlpdu);
    Octets frame = with_frame_check(octets);
    if (kind == DlpduIsNone::by_its_check) frame.back() ^= 1;
    link.run_until(to - link.frame(octets.size()));
    link.send_half_bits(half_bits_of_frame(frame, link.link().preamble_octets));
  }
  return true;
}

TestCase must_in_time(std::string id, std::string purpose, std::string requirement,
                      judge::Reference reference, std::vector<MustCatch> catches,
                      std::vector<PartialSource> details) {
  TestCase test_case = must_case(std::move(id), std::move(purpose), std::move(requirement),
                                 std::move(reference), std::move(catches), std::move(details));
  test_case.tags.emplace_back("timing");
  return test_case;
}

namespace link_chart {

using Priority = LinkScene::Priority;

LinkStep submit(const std::vector<Priority>& priorities, std::size_t least, std::size_t most) {
  std::vector<std::string> kinds;
  for (auto one = priorities.begin(); one != priorities.end();) {
    const auto other = std::find_if(one, priorities.end(), [&](Priority next) { return next != *one; });
    kinds.push_back(fmt::format("{} {}", other - one, fieldbus_dll::text_of(*one)));
    one = other;
  }
  const std::string size = most > least ? fmt::format("{} to {}", least, most) : fmt::format("{}", least);
  return stimulus<LinkScene>(
      fmt::format("the user submits DLSDUs of {} octets: {}", size, fmt::join(kinds, ", ")),
      [priorities, least, most](LinkScene& scene) {
        for (const Priority one : priorities) {
          const std::size_t more = most > least ? scene.link.random().below(most - least + 1) : 0;
          scene.submitted.push_back(scene.link.numbered_data(least + more));
          scene.judge.expect(scene.submit(one, scene.submitted.back()), "data_refused", "data is accepted",
                             "it was refused");
        }
      });
}

LinkStep wait(std::int64_t octets) {
  return stimulus<LinkScene>(fmt::format("{} octet durations pass", octets),
                             [octets](LinkScene& scene) { scene.link.wait(scene.link.octets(octets)); });
}

LinkStep used(std::vector<std::size_t> numbers, DlsduReasons reasons) {
  std::string text = "no data";
  if (!numbers.empty())
    text = numbers[0] == 0 ? "the DLSDU submitted last"
                           : fmt::format("DLSDU {} of the user", fmt::join(numbers, ", "));
  return expected<LinkScene>(text + ", and the token returned once, each within V(MRD) x V(ST)",
                             [numbers = std::move(numbers), reasons = std::move(reasons)](LinkScene& scene) {
                               std::vector<Octets> data;
                               for (const std::size_t n : numbers)
                                 data.push_back(n == 0 ? scene.submitted.back() : scene.submitted.at(n - 1));
                               scene.expect_used(data, reasons);
                             });
}

LinkStep silence(std::string reason, std::string why) {
  const std::string text = "silence: " + why;
  return expected<LinkScene>(text, [reason = std::move(reason), why = std::move(why)](LinkScene& scene) {
    expect_silence(scene.link, scene.judge, reason, why);
  });
}

LinkStep says(std::string what, std::string reason, std::size_t least) {
  const std::string text = what;
  return expected<LinkScene>(
      text, [what = std::move(what), reason = std::move(reason), least](LinkScene& scene) {
        const std::size_t count = scene.link.listen().size();
        scene.judge.expect(count >= least, reason, what, fmt::format("{} DLPDUs", count));
      });
}

LinkStep serves() {
  return {"more data, and a right token for all that waits", "all of it is sent",
          [](LinkScene& scene) { scene.expect_serves(); }};
}

LinkStep preambles(unsigned octets) {
  return expected<LinkScene>(
      fmt::format("each of its DLPDUs has {} octets of preamble", octets), [octets](LinkScene& scene) {
        scene.judge.expect(!scene.link.driven().empty(), "frame_length_wrong", "a DLPDU", "none");
        for (const DrivenDlpdu& one : scene.link.driven()) {
          const kernel::Duration length = one.end - one.begin;
          const kernel::Duration right = scene.link.frame(one.octets.size());
          scene.judge.expect(
              length + kLinkRounding >= right && length <= right + kLinkRounding, "frame_length_wrong", [&] {
                return Mismatch{{fmt::format("{}: {} octets of preamble", kernel::describe(right), octets)},
                                fmt::format("{} of {}", one.text(), kernel::describe(length)),
                                one.begin};
              });
        }
      });
}

LinkStep long_silence() {
  return expected<LinkScene>("nothing is sent while 72 minutes pass", [](LinkScene& scene) {
    const kernel::Time end = scene.link.now() + 72 * 60 * kernel::kSecond;
    scene.judge.expect(!scene.link.next_begins(end), "speaks_unasked", "silence: nothing asks for it",
                       "the station spoke");
  });
}

LinkStep submit_longest() {
  return {
      "the user submits an urgent DLSDU of 64 octets, a normal one of 128, a time-available one of 256, "
      "and each of an octet more",
      "the first are accepted, the others refused", [](LinkScene& scene) {
        const std::size_t most = fieldbus_dll::most_data(scene.link.link(), scene.priority());
        scene.submitted = {scene.link.numbered_data(most)};
        scene.judge.expect(scene.submit(scene.priority(), scene.submitted[0]), "longest_refused",
                           fmt::format("{} octets are accepted", most), "they were refused");
        scene.judge.expect(!scene.submit(scene.priority(), scene.link.numbered_data(most + 1)),
                           "too_long_taken", fmt::format("{} octets are refused", most + 1),
                           "they were accepted");
      }};
}

}  // namespace link_chart
}  // namespace fieldproof::conformance
