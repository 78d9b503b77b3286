#include "fuzz/isa_dle_model.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::fuzz {
namespace {

using fieldbus_dll::IsaService;
using kernel::Duration;
using kernel::Time;

// The upper half of the first octet.
constexpr unsigned kCd = 1;
constexpr unsigned kDt = 2;
constexpr unsigned kDu = 3;
constexpr unsigned kEt = 4;
constexpr unsigned kEs = 5;
constexpr unsigned kEe = 6;
constexpr unsigned kTl = 7;

constexpr std::uint8_t kIsaFinal = 0x04;
constexpr std::size_t kIsaHeader = 3;
constexpr std::uint8_t kLastNode = 0xF7;
constexpr std::uint8_t kAllNodes = 0xFF;

bool is_node(std::uint8_t address) {
  return address >= 1 && address <= kLastNode;
}

// The queue of the most urgent that is there, of this priority at least.
template <typename Queues>
auto* most_urgent(Queues& queues, unsigned least) {
  for (unsigned priority = 3; priority >= least; --priority) {
    if (!queues.at(priority).empty()) return &queues.at(priority);
  }
  return static_cast<decltype(&queues.at(0))>(nullptr);
}

}  // namespace

std::size_t IsaDleModel::most_data(unsigned priority) const {
  return configuration_.rules.link.most_data[priority - 1];
}

Duration IsaDleModel::times(std::int64_t octets) const {
  return fieldbus_dll::octets(configuration_.rules.link, octets);
}

Duration IsaDleModel::frame_of(std::size_t octets_without_check) const {
  constexpr std::size_t kCheckAndDelimiters = 4;
  return times(static_cast<std::int64_t>(octets_without_check + kCheckAndDelimiters +
                                         configuration_.rules.link.preamble_octets));
}

bool IsaDleModel::submit(const fieldbus_dll::IsaRequest& request) {
  const auto priority = static_cast<unsigned>(request.priority);
  const bool is_reply = request.service == IsaService::reply_data;
  const bool compels = request.service == IsaService::compel;
  const bool is_to_all = request.destination == kAllNodes && !compels;
  if (!is_reply && !is_node(request.destination) && !is_to_all) return false;
  if (request.data.size() > most_data(priority)) return false;
  (is_reply ? replies_ : to_send_)
      .at(priority)
      .push_back({compels, priority, request.destination, request.data});
  return true;
}

// ---- when ----

Time IsaDleModel::may_begin() const {
  if (is_line_busy_) return kernel::kNever;
  return std::max(heard_until_, driven_until_) + times(configuration_.rules.link.inter_pdu_delay_octets);
}

Time IsaDleModel::next_action() const {
  Time at = kernel::kNever;
  if (awaited_) {
    if (!is_line_busy_) at = awaited_->until;
  } else if (token_) {
    at = std::min(may_begin(), token_->ends);
  } else if (compelled_) {
    const bool has_what_to_say =
        !compelled_->waits_for_user || most_urgent(replies_, compelled_->least) != nullptr;
    at = has_what_to_say ? std::min(may_begin(), compelled_->until) : compelled_->until;
  }
  return std::max(at, clock_);
}

void IsaDleModel::run_until(Time now) {
  for (Time at = next_action(); at <= now && at != kernel::kNever; at = next_action()) {
    clock_ = at;
    act(at);
    if (!awaited_ && !token_ && !compelled_) break;
  }
  clock_ = now;
}

void IsaDleModel::act(Time now) {
  if (awaited_) {
    told_.push_back({IsaIndication::Kind::reply_missing, now, {awaited_->node}});
    awaited_.reset();
  } else if (token_) {
    use_token(now);
  } else if (compelled_) {
    reply(now);
  }
}

void IsaDleModel::say(const LinkOctets& octets, Time now) {
  said_.push_back({now, octets});
  driven_until_ = now + frame_of(octets.size());
}

// ---- the token ----

bool IsaDleModel::fits(const Request& request, Time now) const {
  if (token_->is_single) return true;
  constexpr std::size_t kEnd = kIsaHeader + 1;
  Duration needed = times(configuration_.rules.link.inter_pdu_delay_octets) + frame_of(kEnd);
  if (request.compels) {
    needed += frame_of(kIsaHeader) + times(configuration_.rules.reply_wait_octets) +
              frame_of(kIsaHeader + most_data(request.priority));
  } else {
    needed += frame_of(kIsaHeader + request.data.size());
  }
  return now + needed <= token_->ends;
}

void IsaDleModel::use_token(Time now) {
  constexpr unsigned kNothingToSend = 0;
  constexpr unsigned kNoTime = 1;
  constexpr unsigned kSingleDone = 2;
  if (token_->ends <= now) return token_.reset();
  if (token_->is_single && token_->is_used) return return_token(kSingleDone, now);
  auto* const queue = most_urgent(to_send_, token_->least);
  if (queue == nullptr) return return_token(kNothingToSend, now);
  if (!fits(queue->front(), now)) return return_token(kNoTime, now);
  const Request request = queue->front();
  queue->pop_front();
  token_->is_used = true;
  LinkOctets octets{static_cast<std::uint8_t>((request.compels ? kCd : kDu) << 4 | request.priority),
                    request.destination, configuration_.address};
  octets.insert(octets.end(), request.data.begin(), request.data.end());
  say(octets, now);
  if (request.compels)
    awaited_ = Awaited{request.destination, driven_until_ + times(configuration_.rules.reply_wait_octets)};
}

void IsaDleModel::return_token(unsigned reason, Time now) {
  const LinkOctets ee{static_cast<std::uint8_t>(kEe << 4 | kIsaFinal), token_->from, configuration_.address,
                      static_cast<std::uint8_t>(reason)};
  const bool fits_too = now + frame_of(ee.size()) <= token_->ends;
  token_.reset();
  if (fits_too) say(ee, now);
}

// ---- replies ----

void IsaDleModel::reply(Time now) {
  auto* const queue = most_urgent(replies_, compelled_->least);
  const bool waits = compelled_->waits_for_user && queue == nullptr;
  if (may_begin() > now || waits) return compelled_.reset();  // V(FD) is over
  if (queue == nullptr && works_on_reply_) {
    compelled_->waits_for_user = true;
    return;
  }
  const unsigned priority = queue == nullptr ? compelled_->least : queue->front().priority;
  LinkOctets dt{static_cast<std::uint8_t>(kDt << 4 | kIsaFinal | priority), compelled_->by,
                configuration_.address};
  if (queue != nullptr) {
    dt.insert(dt.end(), queue->front().data.begin(), queue->front().data.end());
    queue->pop_front();
  }
  compelled_.reset();
  say(dt, now);
}

// ---- what is heard ----

void IsaDleModel::on_begin(Time now) {
  run_until(now);
  is_line_busy_ = true;
}

void IsaDleModel::on_wave(const line::Waveform& wave) {
  run_until(wave.end());
  if (wave.start >= driven_until_) {
    for (const LinkOctets& octets : link_frames_in(wave, configuration_.rules.link)) {
      if (is_dlpdu(octets)) hear(octets, wave.end());
    }
  }
  is_line_busy_ = false;
  heard_until_ = wave.end();
}

bool IsaDleModel::is_dlpdu(std::span<const std::uint8_t> octets) const {
  if (octets.size() < kIsaHeader) return false;
  const unsigned control = octets[0];
  const unsigned type = control >> 4;
  const unsigned priority = control & 0x03U;
  const bool is_final = (control & kIsaFinal) != 0;
  const bool carries_data = type == kDt || type == kDu;
  if (type < kCd || type > kTl || (control & 0x08U) != 0) return false;
  if ((priority != 0) != (type <= kEs)) return false;
  if (type == kEe ? !is_final : is_final && !carries_data) return false;
  if (!is_node(octets[1]) && !(type == kDu && octets[1] == kAllNodes)) return false;
  if (!is_node(octets[2])) return false;
  const auto rest = octets.subspan(kIsaHeader);
  if (carries_data) return rest.size() <= most_data(priority);
  if (type == kEe) return rest.size() == 1 && rest[0] <= 2;
  if (type == kTl) return rest.size() == 2;
  if (type == kEs) return rest.size() == 2 && (rest[0] != 0 || rest[1] != 0);
  return rest.empty();
}

void IsaDleModel::hear_while_waiting(const LinkOctets& octets, Time end) {
  const bool is_reply =
      octets[0] >> 4 == kDt && octets[1] == configuration_.address && octets[2] == awaited_->node;
  awaited_.reset();
  if (is_reply) return told_.push_back({IsaIndication::Kind::data, end, octets});
  token_.reset();
  told_.push_back({IsaIndication::Kind::token_dropped, end, {octets[2]}});
}

void IsaDleModel::hear(const LinkOctets& octets, Time end) {
  if (awaited_) return hear_while_waiting(octets, end);
  const unsigned type = octets[0] >> 4;
  const unsigned priority = octets[0] & 0x03U;
  if (type == kEt || type == kEs || type == kTl) token_.reset();
  compelled_.reset();
  const bool is_mine = octets[1] == configuration_.address;
  if (is_mine && type == kEt) {
    token_ = Token{octets[2], priority, true, kernel::kNever};
  } else if (is_mine && type == kEs) {
    token_ = Token{octets[2], priority, false, end + times(octets[3] << 8 | octets[4])};
  } else if (is_mine && type == kCd && !token_) {
    compelled_ = Compelled{octets[2], priority, end + times(configuration_.rules.reply_forming_octets)};
  } else if ((type == kDt || type == kDu) && (is_mine || octets[1] == kAllNodes)) {
    told_.push_back({IsaIndication::Kind::data, end, octets});
  }
}

}  // namespace fieldproof::fuzz
