#pragma once

#include <array>
#include <memory>
#include <string>

#include "conformance/interbus/slave_bench.hpp"
#include "conformance/judging.hpp"

// A slave beside two references that are given the same: one that resets itself as early as it may, one as
// late. What both agree on is required: each telegram on each line, its header, octet and instant, and each
// change of an output.
namespace fieldproof::conformance {

class SlaveTwins {
 public:
  explicit SlaveTwins(SlaveBench& bench);

  SlaveBench& bench() { return bench_; }
  // `act` must not depend on what a slave does.
  template <typename Act>
  void each(Act&& act) {
    for (SlaveBench* one : {&bench_, early_.get(), late_.get()}) act(*one);
  }
  // What was driven since the views were cleared, and the changes of outputs, which it forgets. False: the
  // references do not agree, and nothing is certain from here on.
  bool agree(CaseJudge& judge, const std::string& after);

 private:
  using View = LineView& (SlaveBench::*)();

  bool is_line_certain(View view);
  void compare_line(CaseJudge& judge, std::string_view name, View view, const std::string& after);
  void compare_outputs(CaseJudge& judge, const std::string& after);

  SlaveBench& bench_;
  std::unique_ptr<SlaveBench> early_;
  std::unique_ptr<SlaveBench> late_;
};

}  // namespace fieldproof::conformance
