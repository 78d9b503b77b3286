/* What the program needs of MPI, as a module that it loads only when it was started by mpirun: so it starts
   as fast without, and runs where no MPI is installed. Messages are octets; one that is sent arrives whole.
 */
#ifndef FIELDPROOF_RANKS_MODULE_H
#define FIELDPROOF_RANKS_MODULE_H

#ifdef __cplusplus
extern "C" {
#endif

struct fieldproof_ranks {
  unsigned version;
  /* Joins the others; 0 when it cannot. */
  int (*begin)(int* rank, int* count);
  void (*send)(int to, const char* octets, int size);
  /* The size of the next message and its sender; -1 when there is none. */
  int (*waiting)(int* from);
  void (*receive)(int from, char* octets, int size);
  /* Waits until all others call it, too. */
  void (*end)(void);
};

#define FIELDPROOF_RANKS_VERSION 1u

const struct fieldproof_ranks* fieldproof_ranks_module(void);

#ifdef __cplusplus
}
#endif
#endif
