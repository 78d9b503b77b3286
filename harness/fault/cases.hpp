#pragma once

// One function object out of several lambdas, for std::visit over a closed variant.
namespace fieldproof::fault {

template <typename... Functions>
struct Cases : Functions... {
  using Functions::operator()...;
};
template <typename... Functions>
Cases(Functions...) -> Cases<Functions...>;

}  // namespace fieldproof::fault
