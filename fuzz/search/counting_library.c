/* Libraries that report where they pass, for tests: as clang's inline-8bit-counters (_COUNTERS) and
 * trace-pc-guard (_GUARDS) do, by the calls that such code makes; with neither, compiled with trace-pc. */

/* Passes `count` times the way `edge` of eight. */
void walk(unsigned edge, unsigned count);

#if defined _COUNTERS

static unsigned char counters[8];
void __sanitizer_cov_8bit_counters_init(unsigned char* start, unsigned char* stop);
__attribute__((constructor)) static void report(void) {
  __sanitizer_cov_8bit_counters_init(counters, counters + 8);
}
__attribute__((visibility("default"))) void walk(unsigned edge, unsigned count) {
  while (count-- > 0) ++counters[edge % 8];
}

#elif defined _GUARDS

static unsigned guards[8];
void __sanitizer_cov_trace_pc_guard_init(unsigned* start, unsigned* stop);
void __sanitizer_cov_trace_pc_guard(unsigned* guard);
__attribute__((constructor)) static void report(void) {
  __sanitizer_cov_trace_pc_guard_init(guards, guards + 8);
}
__attribute__((visibility("default"))) void walk(unsigned edge, unsigned count) {
  while (count-- > 0) __sanitizer_cov_trace_pc_guard(&guards[edge % 8]);
}

#else

static volatile unsigned passed;
__attribute__((visibility("default"))) void walk(unsigned edge, unsigned count) {
  while (count-- > 0) {
    switch (edge % 8) {
      case 0:
        passed += 3;
        break;
      case 1:
        passed ^= 5;
        break;
      case 2:
        passed |= 7;
        break;
      case 3:
        passed &= 9;
        break;
      default:
        passed = 11;
    }
  }
}

#endif
