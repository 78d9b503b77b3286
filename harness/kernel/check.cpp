#include "harness/kernel/check.hpp"

#include <utility>

namespace fieldproof::kernel {
namespace {

thread_local CheckContext* innermost = nullptr;

}  // namespace

CheckContext::CheckContext(std::function<std::string()> describe)
    : describe_(std::move(describe)), outer_(std::exchange(innermost, this)) {}

CheckContext::~CheckContext() {
  innermost = outer_;
}

std::string CheckContext::describe_all() {
  std::string text;
  for (const CheckContext* context = innermost; context != nullptr; context = context->outer_) {
    text = text.empty() ? context->describe_() : context->describe_() + "; " + text;
  }
  return text;
}

void throw_broken_invariant(const char* expression, const std::string& sentence, const char* file, int line) {
  std::string text(file);
  text += ':' + std::to_string(line) + ": " + sentence + " (" + expression + " does not hold)";
  const std::string context = CheckContext::describe_all();
  if (!context.empty()) text += " [" + context + ']';
  throw BrokenInvariant(text);
}

}  // namespace fieldproof::kernel
