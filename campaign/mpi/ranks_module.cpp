// The module over MPI. Nothing of it judges: an error of MPI ends all ranks, as MPI does it.
#include "campaign/mpi/ranks_module.h"

#include <mpi.h>

namespace {

constexpr int kTag = 1;

int begin(int* rank, int* count) {
  int level = 0;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level) != MPI_SUCCESS) return 0;
  MPI_Comm_rank(MPI_COMM_WORLD, rank);
  MPI_Comm_size(MPI_COMM_WORLD, count);
  return 1;
}

void send(int to, const char* octets, int size) {
  MPI_Send(octets, size, MPI_CHAR, to, kTag, MPI_COMM_WORLD);
}

int waiting(int* from) {
  int is_there = 0;
  int size = -1;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &is_there, &status);
  if (is_there == 0) return -1;
  MPI_Get_count(&status, MPI_CHAR, &size);
  *from = status.MPI_SOURCE;
  return size;
}

void receive(int from, char* octets, int size) {
  MPI_Recv(octets, size, MPI_CHAR, from, kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

void end() {
  MPI_Finalize();
}

constexpr fieldproof_ranks kModule = {FIELDPROOF_RANKS_VERSION, begin, send, waiting, receive, end};

}  // namespace

const fieldproof_ranks* fieldproof_ranks_module() {
  return &kModule;
}
