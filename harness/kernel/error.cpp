#include "harness/kernel/error.hpp"

namespace fieldproof::kernel {

int Error::exit_code() const noexcept {
  switch (kind_) {
    case ErrorKind::usage:
      return 64;
    case ErrorKind::configuration:
      return 65;
    case ErrorKind::implementation:
      return 5;
    case ErrorKind::output:
      return 74;
  }
  return 70;
}

}  // namespace fieldproof::kernel
