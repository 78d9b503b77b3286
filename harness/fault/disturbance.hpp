#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "harness/config/document.hpp"
#include "harness/fault/channel.hpp"
#include "harness/fault/stress.hpp"
#include "harness/kernel/time.hpp"

// What a plan has besides its rules: channels of a model that decides by itself which levels it changes, as
// bursts and the channels of the textbooks do. The models lie outside of the harness; a plan knows them by
// their words.
namespace fieldproof::fault {

struct DisturbanceModel {
  std::string kind;        // "bursts"
  std::string parameters;  // a JSON value in one order, without what is as it would be anyway
  // At a receiver, from the begin of the window on.
  std::function<std::unique_ptr<Channel>(const StressPlace&)> make_channel;
  std::vector<std::string> caveats{};  // what a report must say about results under it; sentences

  // Equal words mean equal channels.
  friend bool operator==(const DisturbanceModel& a, const DisturbanceModel& b) {
    return a.kind == b.kind && a.parameters == b.parameters;
  }
};

// Rules are asked first; what they let arrive goes through the disturbances that fit, in the order of the
// plan.
struct Disturbance {
  std::string name{};
  std::string receiver = "*";  // a pattern, as in a rule
  // A transmission whose start lies in [from, to) is given to the model, another one passes.
  kernel::Time from = kernel::kStart;
  kernel::Time to = kernel::kNever;
  DisturbanceModel model{};

  friend bool operator==(const Disturbance&, const Disturbance&) = default;
};

// A model that plans can name. `read` gets the member with the word as its key, and refuses what is wrong as
// readers do; what it returns reads its own parameters again.
struct DisturbanceKind {
  std::string_view word;
  std::function<DisturbanceModel(const config::Value& value)> read;
};

}  // namespace fieldproof::fault
