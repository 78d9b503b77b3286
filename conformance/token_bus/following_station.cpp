#include "conformance/token_bus/following_station.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "conformance/token_bus/station_bench.hpp"

namespace fieldproof::conformance {
namespace {

constexpr unsigned kMostTokensMore = 4;  // two low bits are drawn, and the token of the window may count

bool is_window(const DrivenFrame& one) {
  return one.is(TokenControl::solicit_1) || one.is(TokenControl::solicit_2);
}

}  // namespace

bool FollowingStation::start(kernel::Time now) {
  has_opened_window_ = has_passed_ = is_count_unsure_ = has_lost_request_ = false;
  has_group_answered_ = false;
  is_desired_ = is_desired_at_start_;
  tokens_ = tokens_more_ = 0;
  tokens_to_windows_.clear();
  last_claims_.clear();
  return TokenStation::start(now);
}

// While it drives its receiver is off, and what goes on after that is a rest of something. The same is a
// frame whose preamble ends in the time of blanking.
void FollowingStation::receive(segment::PortIndex port, const line::Waveform& reception) {
  constexpr std::int64_t kSymbolsToLose = 7;  // of a preamble
  const kernel::Time hidden_until = line().blanked_until();
  const bool is_hidden = reception.end() <= hidden_until;
  const bool is_cut = hidden_until > reception.start + token_bus::mac_symbols(rules(), kSymbolsToLose);
  const bool answers =
      state() == token_bus::AccessState::demand_in || state() == token_bus::AccessState::idle;
  // Nor is it said whether the wait for the token of one that has answered goes on while others send.
  const kernel::Time demand_until = std::exchange(demand_until_, kernel::kNever);
  const bool is_over_meanwhile = reception.start <= demand_until && demand_until != kernel::kNever &&
                                 demand_until <= reception.end() + token_bus::octets(rules(), 1);
  if (line().is_of_own_time(reception) || is_over_meanwhile || (!is_hidden && is_cut) ||
      (answers && has_pending()))
    is_doubtful_ = true;
  TokenStation::receive(port, reception);
}

namespace {

bool awaits_others(token_bus::AccessState state) {
  using token_bus::AccessState;
  constexpr std::array kWaiting{AccessState::demand_in, AccessState::await_ifm_response,
                                AccessState::check_token_pass, AccessState::await_response};
  return std::ranges::find(kWaiting, state) != kWaiting.end();
}

}  // namespace

void FollowingStation::on_time(kernel::Time now) {
  const token_bus::AccessState before = state();
  TokenStation::on_time(now);
  if (awaits_others(before) && state() != before) wait_ended_ = now;
}

// Who begins when a slot time ends, or within the gap after it, is in time for one station and late for
// another.
bool FollowingStation::is_at_an_end(kernel::Time now) const {
  const kernel::Duration slot = token_bus::slots(rules(), 1);
  const kernel::Duration octet = token_bus::octets(rules(), 1);
  const kernel::Duration gap = token_bus::octets(rules(), rules().response_gap_octets);
  if (wait_ended_ != kernel::kNever && now - wait_ended_ <= gap + octet + octet) return true;
  const kernel::Time since = line().silent_since();
  if (since == kernel::kNever || !awaits_others(state())) return false;
  const kernel::Duration after = (now - since + octet) % slot;
  return now - since + octet >= slot && after <= gap + octet + octet;
}

// Others begin: what is pending has been driven by then, or waits for them.
void FollowingStation::note_before(kernel::Time now) {
  if (is_doubtful() || has_lost_request_ || early_begin_ || overdue_ || !has_pending()) return;
  const DrivenFrame* const next = next_followed();
  const bool has_begun = next != nullptr && next->begin < now;
  if (has_begun && next->begin + kTokenRounding < due_) early_begin_ = EarlyBegin{next->begin, due_};
  if (!has_begun && span_of_due().latest < now) overdue_ = span_of_due().latest;
}

void FollowingStation::on_activity(segment::PortIndex port, bool begins, kernel::Time now) {
  if (begins) {
    note_before(now);
    // Before its windows are open, or its request is sent, others are neither answers nor responses.
    const bool asks = state() == token_bus::AccessState::await_response ||
                      state() == token_bus::AccessState::await_ifm_response;
    is_doubtful_ = is_doubtful_ || is_at_an_end(now) || (asks && has_pending());
    const bool demands =
        state() == token_bus::AccessState::demand_in && line().silent_since() != kernel::kNever;
    demand_until_ = demands ? line().silent_since() + token_bus::slots(rules(), rules().demand_wait_slots)
                            : kernel::kNever;
  }
  TokenStation::on_activity(port, begins, now);
}

// Noise in place of a response, noise that is over before a claim is, and several frames at once for a
// station that holds the token, or gets it by one of them.
std::vector<token_bus::Reception> FollowingStation::received(const line::Waveform& wave) const {
  using token_bus::AccessState;
  auto all = TokenStation::received(wave);
  const bool is_noise =
      std::ranges::none_of(all, [](const auto& one) { return one.kind == token_bus::ReceptionKind::frame; });
  const bool is_waiting = state() == AccessState::await_ifm_response || state() == AccessState::claim_token;
  // Noise may put off the end of the wait of one that has answered.
  const bool is_put_off =
      is_noise && state() == AccessState::demand_in &&
      rules().demand_wait_slots + 1 >= std::min(rules().bus_idle_slots, rules().lowest_bus_idle_slots);
  // What comes within the gap before a token is passed may cost it, or shows that the pass has succeeded.
  const bool is_passing = state() == AccessState::check_token_pass || state() == AccessState::pass_token;
  const bool is_within_gap = !is_noise && is_passing && has_pending();
  const auto is_token = [this](const token_bus::Reception& one) {
    const auto frame = TokenStation::understood(one.octets);
    return frame && frame->kind == token_bus::FrameKind::token && frame->destination == address();
  };
  const bool may_hold = state() != AccessState::idle || std::ranges::any_of(all, is_token);
  if ((is_noise && is_waiting) || is_put_off || is_within_gap || (all.size() > 1 && may_hold))
    is_doubtful_ = true;
  return all;
}

// A successor for a station that is in no ring. Whether a group that answers costs the token is open, too,
// but not that it is no successor.
bool FollowingStation::is_unsaid(const Frame& frame) const {
  using token_bus::AccessState;
  if (frame.kind != token_bus::FrameKind::set_successor || frame.destination != address()) return false;
  if (state() == AccessState::await_response) {
    has_group_answered_ = has_group_answered_ || token_bus::is_group(token_bus::address_of(frame.data));
    return false;
  }
  return frame.source != address() && !is_in_ring();
}

// What is no frame though its check is right is nothing for a station that listens: what it is in place of a
// response, after a token, or from the station's own address nothing says.
std::optional<token_bus::Frame> FollowingStation::understood(const Octets& octets) const {
  auto frame = TokenStation::understood(octets);
  if (has_passed_ && !is_in_ring()) {
    is_count_unsure_ = true;
    tokens_ = 0;
  }
  if (frame) {
    is_doubtful_ = is_doubtful_ || is_unsaid(*frame);
    return frame;
  }
  const std::size_t size = token_bus::address_octets(rules());
  const bool has_source = octets.size() >= 1 + 2 * size;
  const bool is_own =
      has_source && token_bus::address_of(std::span(octets).subspan(1 + size, size)) == address();
  if (is_own || state() != token_bus::AccessState::idle) is_doubtful_ = true;
  return frame;
}

const DrivenFrame* FollowingStation::next_followed() const {
  return followed_.all().size() > spans_.size() ? &followed_.all()[spans_.size()] : nullptr;
}

kernel::Time FollowingStation::begin_of(const Frame&, kernel::Time due) const {
  due_ = due;
  const DrivenFrame* const next = next_followed();
  return next == nullptr || due == kernel::kNever ? kernel::kNever : std::max(due, next->begin);
}

// What comes at once, or in a window, has a slot time from the end of what was before; what a timer begins
// has an octet before it, and a gap and an octet after it.
BeginSpan FollowingStation::span_of_due() const {
  const kernel::Duration gap = token_bus::octets(rules(), rules().response_gap_octets);
  const bool is_answer =
      state() == token_bus::AccessState::demand_in || state() == token_bus::AccessState::idle;
  const kernel::Time since = line().silent_since();
  const bool is_at_once = since != kernel::kNever && due_ <= since + gap;
  if (is_answer || is_at_once)
    return {due_ - kTokenRounding, due_ - gap + token_bus::slots(rules(), 1) + kTokenRounding};
  const kernel::Duration octet = token_bus::octets(rules(), 1);
  return {due_ - octet - kTokenRounding, due_ + gap + octet + kTokenRounding};
}

bool FollowingStation::has_pending() const {
  due_ = kernel::kNever;
  next_time();
  return due_ != kernel::kNever;
}

std::optional<kernel::Time> FollowingStation::awaited_until(kernel::Time now) const {
  if (!has_pending() || due_ > now) return std::nullopt;
  return span_of_due().latest;
}

// Destination and data of a claim are any.
bool FollowingStation::may_be(const DrivenFrame& claim, const Frame& own) const {
  if (!claim.is(TokenControl::claim) || claim.source() != own.source) return false;
  const std::size_t size = claim.data().size();
  if (!is_last_claim_) return size == own.data.size();
  const std::size_t step = 2 * std::size_t{rules().slot_time_octets};
  return size % step == 0 && size <= 3 * step;
}

line::Levels FollowingStation::written(const Frame& frame, kernel::Time begin) const {
  const DrivenFrame* const next = next_followed();
  if (has_lost_request_ && frame.kind == token_bus::FrameKind::data) is_doubtful_ = true;
  // A station keeps its token or drops it; what it does not is pass it to another than its successor.
  if (std::exchange(has_group_answered_, false))
    is_doubtful_ = is_doubtful_ || next == nullptr || !next->is(TokenControl::token) ||
                   next->destination() == successor();
  spans_.push_back(span_of_due());
  if (!is_doubtful_) sure_frames_ = spans_.size();
  const bool is_claim = frame.kind == token_bus::FrameKind::claim_token;
  if (!is_claim || next == nullptr || !may_be(*next, frame)) return TokenStation::written(frame, begin);
  Frame claim = frame;
  claim.destination = next->destination();
  claim.data = next->data();
  if (is_last_claim_) last_claims_.push_back(claim.data.size());
  return TokenStation::written(claim, begin);
}

// Who is alone is the lowest of its ring, too.
unsigned FollowingStation::bus_idle_slots() const {
  const unsigned slots = TokenStation::bus_idle_slots();
  const unsigned lowest = rules().lowest_bus_idle_slots;
  const DrivenFrame* const next = next_followed();
  if (!is_in_ring() || successor() != address()) return slots;
  if (next == nullptr) return std::max(slots, lowest);
  const kernel::Time later = line().silent_since() + token_bus::slots(rules(), std::max(slots, lowest));
  const bool is_sooner = next->begin < later - token_bus::octets(rules(), 1);
  return is_sooner ? std::min(slots, lowest) : std::max(slots, lowest);
}

unsigned FollowingStation::claim_bits(unsigned pass) {
  is_last_claim_ = pass + 1 >= claim_passes();
  return TokenStation::claim_bits(pass);
}

// In the last pass of a contest the delay is drawn.
unsigned FollowingStation::demand_bits(unsigned pass) {
  const unsigned bits = TokenStation::demand_bits(pass);
  if (pass + 1 < token_bus::contest_passes(rules())) return bits;
  const DrivenFrame* const next = next_followed();
  const kernel::Time since = line().silent_since();
  if (next == nullptr || since == kernel::kNever) return bits;
  unsigned delay = 0;
  while (delay < 3 && next->begin >= since + token_bus::slots(rules(), delay + 1)) ++delay;
  return 3 - delay;
}

// Whether a request is sent again whose response was another frame nothing says.
bool FollowingStation::drops_token_on(const Frame& frame) const {
  if (state() == token_bus::AccessState::await_ifm_response) has_lost_request_ = true;
  return TokenStation::drops_token_on(frame);
}

// A request that was lost with its token may keep it in the ring.
bool FollowingStation::wants_ring() const {
  if (has_lost_request_ && !is_desired_) is_doubtful_ = true;
  return TokenStation::wants_ring();
}

void FollowingStation::set_in_ring_desired(bool is_desired, kernel::Time now) {
  is_desired_ = is_desired;
  TokenStation::set_in_ring_desired(is_desired, now);
}

// What one that has answered does when a contest goes on and on nothing says.
bool FollowingStation::resolves(unsigned passes) const {
  const bool does = TokenStation::resolves(passes);
  if (!does && state() == token_bus::AccessState::demand_in) is_doubtful_ = true;
  return does;
}

// What a timer begins may come a gap later, and then find its time over.
bool FollowingStation::may_begin(unsigned place, kernel::Time begin) const {
  const bool may = TokenStation::may_begin(place, begin);
  const DrivenFrame* const next = next_followed();
  const kernel::Duration gap = token_bus::octets(rules(), rules().response_gap_octets);
  const bool is_at_once = begin <= line().silent_since() + gap;
  const bool is_near = begin < hold_until() && begin + gap + token_bus::octets(rules(), 1) >= hold_until();
  if (is_at_once || !is_near || next == nullptr) return may;
  return next->is_data() && token_bus::access_class(next->priority()) == 6 - 2 * place;
}

bool FollowingStation::opens_window(kernel::Time now) {
  has_passed_ = true;
  if (successor() == address()) is_count_unsure_ = true;
  return TokenStation::opens_window(now);
}

// One token less is right as well.
bool FollowingStation::is_window_due(unsigned count) {
  const DrivenFrame* const next = next_followed();
  const bool opens = next != nullptr && is_window(*next);
  const unsigned most = rules().max_inter_solicit_count + kMostTokensMore;
  ++tokens_;
  bool is_due = count == 0 || (count == 1 && opens);
  if (is_count_unsure_) {
    is_due = opens || tokens_ > most;
  } else if (count == 0 && has_opened_window_ && !opens && tokens_more_ < kMostTokensMore) {
    ++tokens_more_;
    is_due = false;
  }
  if (!is_due) return false;
  if (has_opened_window_ && !is_count_unsure_) tokens_to_windows_.push_back(tokens_);
  has_opened_window_ = true;
  is_count_unsure_ = false;
  tokens_ = tokens_more_ = 0;
  return true;
}

}  // namespace fieldproof::conformance
