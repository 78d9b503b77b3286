#pragma once

#include <mutex>
#include <optional>

#include "emc/coupling.hpp"

namespace fieldproof::emc {

// The response of a line, computed when the first channel asks, whatever thread that is on.
class SharedResponse {
 public:
  explicit SharedResponse(const Coupling& coupling) : coupling_(coupling) {}

  const LineResponse& get() {
    std::call_once(is_computed_, [this] { response_.emplace(coupling_); });
    return *response_;
  }

 private:
  Coupling coupling_;
  std::once_flag is_computed_;
  std::optional<LineResponse> response_;
};

}  // namespace fieldproof::emc
