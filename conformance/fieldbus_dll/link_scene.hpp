#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "conformance/chart.hpp"
#include "conformance/fieldbus_dll/link_expect.hpp"
#include "conformance/user_reports.hpp"

// The words of charts that the profiles of the data link share: what the user submits and the tester sends,
// what is said under a token, in answer, or not at all. Reason codes are those of the expectations.
namespace fieldproof::conformance {

// What the steps of one round share.
struct LinkScene {
  using Priority = fieldbus_dll::Priority;

  LinkScene(LinkBench& link_, CaseJudge& judge_, unsigned round_, kernel::Duration answer_time_)
      : link(link_), judge(judge_), round(round_), answer_time(answer_time_) {}
  virtual ~LinkScene() = default;

  // False: it is refused.
  virtual bool submit(Priority priority, const Octets& dlsdu) = 0;
  // Under the token that was sent last: these DLSDUs, and that it is returned.
  virtual void expect_used(const std::vector<Octets>& dlsdus, const DlsduReasons& reasons) = 0;
  virtual void expect_serves() = 0;
  // The next DLPDU, begun between V(MID) and the time for an answer.
  const DrivenDlpdu& expect_answer(const std::string& what, std::string_view reason);
  // All that is said ends within the duration of the token that was sent last: `talks_behind_duration`.
  // Gives how much of it is left.
  kernel::Duration expect_none_after(std::string_view token, unsigned duration);
  // Data for its user that no other has: `data`.
  const Octets& fresh(std::size_t size) { return data = link.numbered_data(size); }
  // All three are walked over.
  Priority priority() const { return static_cast<Priority>(3 - round % 3); }

  LinkBench& link;
  CaseJudge& judge;
  unsigned round;     // from 0
  unsigned turn = 0;  // of steps that are repeated
  kernel::Duration answer_time;
  kernel::Time sent{};              // the end of what the tester sent last
  std::vector<Octets> submitted{};  // by the user
  Octets data{};                    // of what the tester sent last to the user
  DrivenDlpdu answer{};             // what the IUT drove last, of what was required
};

using LinkStep = ChartStep<LinkScene>;

// What an implementation must do in time.
TestCase must_in_time(std::string id, std::string purpose, std::string requirement,
                      judge::Reference reference, std::vector<MustCatch> catches,
                      std::vector<PartialSource> details = {});

namespace link_chart {

// Data that no other has, accepted by the IUT: `data_refused`. Those of a chart count from 1.
LinkStep submit(const std::vector<LinkScene::Priority>& priorities, std::size_t least, std::size_t most = 0);
LinkStep wait(std::int64_t octets);
// The DLSDUs with these numbers, 0 for the last of all, are sent under the token, in this order, and it is
// returned once.
LinkStep used(std::vector<std::size_t> numbers, DlsduReasons reasons);
LinkStep silence(std::string reason, std::string why);
// So many DLPDUs of the IUT at least, until it is silent.
LinkStep says(std::string what, std::string reason, std::size_t least = 1);
// A longer token is used for all that waits, and for what is submitted then: `does_not_recover`.
LinkStep serves();
// All that it has driven had so many octets of preamble, which is what the link has.
LinkStep preambles(unsigned octets);
// Nothing is sent for 72 minutes, which are more than 2^32 microseconds.
LinkStep long_silence();
// The longest DLSDU of the priority of the round is accepted, and none that is longer.
LinkStep submit_longest();

// The next DLPDU of the IUT, begun between V(MID) and the time for an answer: `scene.answer`. Null: any will
// do.
template <typename Scene>
ChartStep<Scene> answer(const std::string& what, std::string reason,
                        std::function<bool(const Scene&, const DrivenDlpdu&)> is_right,
                        std::string reason_wrong = "dlpdu_wrong") {
  return expected<Scene>(what + ", begun between V(MID) and V(MRD) x V(ST)",
                         [what, reason = std::move(reason), is_right = std::move(is_right),
                          reason_wrong = std::move(reason_wrong)](Scene& scene) {
                           const DrivenDlpdu one = scene.expect_answer(what, reason);
                           scene.judge.expect(!is_right || is_right(scene, one), reason_wrong,
                                              [&] { return Mismatch{{what}, one.text(), one.begin}; });
                         });
}

template <typename Scene>
ChartStep<Scene> require_of(const std::string& text, std::function<bool(Scene&)> holds, std::string reason) {
  return expected<Scene>(text, [text, holds = std::move(holds), reason = std::move(reason)](Scene& scene) {
    scene.judge.expect(holds(scene), reason, [&] {
      const auto& reports = scene.bench.user().reports;
      return Mismatch{{text}, "it is otherwise; its user got " + reports_text(reports, [](const auto& one) {
                                return one.text();
                              })};
    });
  });
}
// What the text says holds of the scene.
template <typename Holds>
auto require(const std::string& text, Holds holds, std::string reason) {
  return require_of(text, std::function(std::move(holds)), std::move(reason));
}

template <typename Scene>
ChartStep<Scene> send_octets(std::string text, std::function<Octets(Scene&)> make) {
  return stimulus<Scene>(
      std::move(text), [make = std::move(make)](Scene& scene) { scene.sent = scene.link.send(make(scene)); });
}
// `make` gives the octets from the scene of its profile.
template <typename Make>
auto send(std::string text, Make make) {
  return send_octets(std::move(text), std::function(std::move(make)));
}

template <typename Scene>
ChartStep<Scene> drive_levels(std::string text, std::function<line::Levels(Scene&)> make) {
  return stimulus<Scene>(std::move(text), [make = std::move(make)](Scene& scene) {
    scene.sent = scene.link.send_half_bits(make(scene));
  });
}
// The same with half bits, as they are.
template <typename Make>
auto drive(std::string text, Make make) {
  return drive_levels(std::move(text), std::function(std::move(make)));
}

}  // namespace link_chart

// Why octets in a whole frame are no DLPDU.
enum class DlpduIsNone : std::uint8_t { by_its_check, by_its_first_octet };
// Others drive such frames from now on, never silent for V(MID), the last just until then, and it runs until
// that is over. False: there is no room for any, and nothing is done.
bool keep_busy(LinkBench& link, kernel::Time until, DlpduIsNone kind);

// The octets of a frame with these bits of it and its check turned.
Octets with_wrong_bits(Octets frame, const std::vector<std::size_t>& bits);

}  // namespace fieldproof::conformance
