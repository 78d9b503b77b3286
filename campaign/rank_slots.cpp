#include "campaign/rank_slots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "harness/kernel/error.hpp"
#include "harness/kernel/host_name.hpp"

namespace fieldproof::campaign {
namespace {

using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

// Between two looks for a message: MPI itself would wait at full speed, on a core that a job could have.
constexpr std::chrono::milliseconds kLook{1};

// For ranks that are still starting.
constexpr std::chrono::seconds kLongestEnd{60};

// A message is a letter and what belongs to it.
constexpr char kHello = 'h';
constexpr char kJob = 'j';
constexpr char kAbandon = 'a';
constexpr char kEnd = 'e';
constexpr char kResult = 'r';
constexpr char kSeen = 's';

std::string_view content_of(const std::string& message) {
  return std::string_view(message).substr(1);
}

}  // namespace

RankSlots::RankSlots(Ranks& ranks, std::size_t slots_of_each, std::string program)
    : ranks_(ranks),
      slots_of_each_(slots_of_each),
      program_(std::move(program)),
      own_(slots_of_each),
      others_(static_cast<std::size_t>(ranks.count() - 1)) {}

// Each says that it has seen the end: until then what it sends must be received, or it would wait for ever.
RankSlots::~RankSlots() {
  own_.abandon();
  for (int rank = 1; rank < ranks_.count(); ++rank) ranks_.send(rank, std::string(1, kEnd));
  const auto until = Clock::now() + kLongestEnd;
  for (int left = ranks_.count() - 1; left > 0 && Clock::now() < until;) {
    const auto message = ranks_.receive();
    if (!message) {
      std::this_thread::sleep_for(kLook);
    } else if (message->second.front() == kSeen) {
      --left;
    }
  }
}

std::size_t RankSlots::free() const {
  std::size_t free = own_.free();
  for (const Other& other : others_)
    if (!other.host.empty()) free += slots_of_each_ - other.running;
  return free;
}

void RankSlots::give(const Job& job) {
  const auto idle = std::ranges::find_if(
      others_, [&](const Other& other) { return !other.host.empty() && other.running < slots_of_each_; });
  if (idle == others_.end()) {
    own_.give(job);
    return;
  }
  ++idle->running;
  ranks_.send(static_cast<int>(idle - others_.begin()) + 1, kJob + to_json(job));
}

void RankSlots::on_message(int from, const std::string& message, std::vector<JobResult>& ended) {
  Other& other = others_.at(static_cast<std::size_t>(from - 1));
  if (message.front() == kHello) {
    // What mpirun sends to all of them is for rank 0 to decide.
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_IGN);
    const ordered_json hello = ordered_json::parse(content_of(message));
    other.host = hello.at("host");
    const std::string program = hello.at("program");
    if (program == program_) return;
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("rank {} on {} runs {}, and rank 0 {}; install the same on all machines",
                                    from, other.host, program, program_));
  }
  if (is_abandoned_) return;
  JobResult result = result_from_json(content_of(message));
  if (!result.obstacle.empty())
    result.obstacle = fmt::format("rank {} on {}: {}", from, other.host, result.obstacle);
  --other.running;
  ended.push_back(std::move(result));
}

bool RankSlots::take_messages(std::vector<JobResult>& ended) {
  bool has_come = false;
  while (const auto message = ranks_.receive()) {
    has_come = true;
    on_message(message->first, message->second, ended);
  }
  return has_come;
}

std::vector<JobResult> RankSlots::wait(std::chrono::milliseconds longest) {
  const auto until = Clock::now() + longest;
  std::vector<JobResult> ended;
  while (true) {
    // Who has just come can be given something: that is worth a return, too.
    if (take_messages(ended) || Clock::now() >= until) return ended;
    ended = own_.wait(kLook);
    if (!ended.empty()) return ended;
    const bool is_idle_here = own_.free() == slots_of_each_;
    if (is_idle_here) std::this_thread::sleep_for(kLook);
  }
}

void RankSlots::abandon() {
  is_abandoned_ = true;
  own_.abandon();
  for (int rank = 1; rank < ranks_.count(); ++rank) ranks_.send(rank, std::string(1, kAbandon));
}

void serve_as_rank(Ranks& ranks, std::size_t slots, const std::string& program) {
  // What mpirun sends to all of them is for rank 0 to decide.
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_IGN);
  const ordered_json hello = {{"host", kernel::host_name()}, {"program", program}};
  ranks.send(0, kHello + hello.dump());
  LocalSlots own(slots);
  while (true) {
    while (const auto message = ranks.receive()) {
      switch (message->second.front()) {
        case kJob:
          own.give(job_from_json(content_of(message->second)));
          break;
        case kAbandon:
          own.abandon();
          break;
        default:
          own.abandon();
          ranks.send(0, std::string(1, kSeen));
          return;
      }
    }
    for (const JobResult& result : own.wait(kLook)) ranks.send(0, kResult + to_json(result));
    if (own.free() == slots) std::this_thread::sleep_for(kLook);
  }
}

}  // namespace fieldproof::campaign
