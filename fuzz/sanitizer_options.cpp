// Options of AddressSanitizer for every fuzz target. Targets make and drop whole stations for each input:
// with the default quarantine each of them is made of memory that no cache holds, and with long call stacks
// of every allocation an input costs twice as much. Findings stay the same; ASAN_OPTIONS still overrides.

extern "C" const char* __asan_default_options();

extern "C" const char* __asan_default_options() {
  return "malloc_context_size=6:quarantine_size_mb=8";
}
