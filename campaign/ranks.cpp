#include "campaign/ranks.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstdlib>

#include "campaign/mpi/ranks_module.h"
#include "harness/kernel/error.hpp"

namespace fieldproof::campaign {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModuleFile = "libfieldproof_mpi.so";

[[noreturn]] void refuse_ranks(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::usage, sentence);
}

// How many ranks mpirun has started; nothing where it has not started this process.
std::optional<int> started_by_mpirun() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    if (const char* const count = std::getenv(variable)) return std::atoi(count);
  }
  return std::nullopt;
}

fs::path module_beside(const fs::path& program) {
  const fs::path folder = program.parent_path();
  std::error_code failure;
  for (const fs::path& place :
       {folder / kModuleFile, folder.parent_path() / "lib" / "fieldproof" / kModuleFile}) {
    if (fs::exists(place, failure)) return place;
  }
  return {};
}

const fieldproof_ranks& load(const fs::path& file) {
  void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (library == nullptr) refuse_ranks(fmt::format("MPI cannot be loaded: {}", ::dlerror()));
  const auto module =
      reinterpret_cast<const fieldproof_ranks* (*)()>(::dlsym(library, "fieldproof_ranks_module"));
  if (module == nullptr || module()->version != FIELDPROOF_RANKS_VERSION)
    refuse_ranks(fmt::format("{}: this is no module of this version", file.string()));
  return *module();
}

}  // namespace

std::unique_ptr<Ranks> Ranks::of_this_process(const fs::path& program) {
  const auto count = started_by_mpirun();
  if (!count) return nullptr;
  const fs::path file = module_beside(program);
  if (!file.empty()) return std::unique_ptr<Ranks>(new Ranks(load(file)));
  if (*count <= 1) return nullptr;
  refuse_ranks(
      "this fieldproof was built without MPI, so ranks would not share their work; leave mpirun out and use "
      "--workers N, or install libopenmpi-dev and build again");
}

Ranks::Ranks(const fieldproof_ranks& module) : module_(module) {
  if (module_.begin(&rank_, &count_) == 0) refuse_ranks("MPI cannot be started on this rank");
}

Ranks::~Ranks() {
  module_.end();
}

void Ranks::send(int to, std::string_view message) {
  module_.send(to, message.data(), static_cast<int>(message.size()));
}

std::optional<std::pair<int, std::string>> Ranks::receive() {
  int from = 0;
  const int size = module_.waiting(&from);
  if (size < 0) return std::nullopt;
  std::string message(static_cast<std::size_t>(size), '\0');
  module_.receive(from, message.data(), size);
  return std::pair(from, std::move(message));
}

}  // namespace fieldproof::campaign
