#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <utility>

namespace fieldproof::kernel {

// What takes long to compute and many share: made when the first of them asks, whatever thread that is on.
template <typename Result>
class ComputedOnce {
 public:
  explicit ComputedOnce(std::function<Result()> compute) : compute_(std::move(compute)) {}

  const Result& get() {
    std::call_once(is_computed_, [this] { result_.emplace(compute_()); });
    return *result_;
  }

 private:
  std::function<Result()> compute_;
  std::once_flag is_computed_;
  std::optional<Result> result_;
};

}  // namespace fieldproof::kernel
