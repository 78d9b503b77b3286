/*
 * For plugin_test: a shared library that does what the role says by which it was asked for, when the supply
 * comes. Compiled with OTHER_VERSION, LEAVES_OUT or NO_ENTRY it is none that can be used; with LEVELS_ONLY it
 * has no function for characters.
 */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "harness/iut/fieldproof_plugin.h"

typedef struct odd {
  const fieldproof_bench* bench;
  char does[32];
  fieldproof_time next;
} odd;

static void* create(const char* protocol, const char* role, const fieldproof_bench* bench) {
  odd* self = 0;
  if (strcmp(protocol, "odd") != 0 || strlen(role) >= sizeof(self->does)) return 0;
  self = (odd*)calloc(1, sizeof(odd));
  if (self == 0) return 0;
  strcpy(self->does, role);
  self->bench = bench;
  self->next = FIELDPROOF_NEVER;
  return self;
}

static int begin(void* self, const fieldproof_case* test_case, fieldproof_time* next_time) {
  /* What it was told is what it wants, now and when the supply comes. */
  ((odd*)self)->next = test_case->setting_count > 0 ? test_case->settings[0].value : FIELDPROOF_NEVER;
  if (test_case->setting_count > 0) *next_time = ((odd*)self)->next;
  return strcmp(test_case->id, "odd/refused") != 0;
}

static fieldproof_time set_power(void* context, int is_on, fieldproof_time now) {
  const odd* self = (const odd*)context;
  const fieldproof_bench* bench = self->bench;
  static const unsigned short characters[2] = {0x1AA, 0x155};
  static const unsigned char levels[2] = {0x5A, 0x01};
  unsigned n;
  if (!is_on) return FIELDPROOF_NEVER;
  if (strcmp(self->does, "acts") == 0) {
    bench->driver(bench->context, 1, 1, now);
    bench->characters(bench->context, 1, now + 1, characters, 2);
    bench->driver(bench->context, 1, 0, now + 2);
    bench->transmit_levels(bench->context, 2, now, 1000, levels, 9);
    bench->write(bench->context, 3, bench->read(bench->context, 4, now) + 1, now);
  }
  if (strcmp(self->does, "writes item 65536") == 0) bench->write(bench->context, 65536, 1, now);
  if (strcmp(self->does, "reads item 65537") == 0) bench->read(bench->context, 65537, now);
  if (strcmp(self->does, "drives at rate 0") == 0)
    bench->transmit_levels(bench->context, 0, now, 0, levels, 1);
  for (n = 0; n <= 20000 && strcmp(self->does, "floods") == 0; ++n) bench->write(bench->context, 0, n, now);
  return self->next;
}

static fieldproof_time receive(void* context, unsigned port, const fieldproof_character* characters,
                               unsigned count, fieldproof_time now) {
  const odd* self = (const odd*)context;
  unsigned n;
  for (n = 0; n < count; ++n)
    self->bench->write(self->bench->context, port,
                       (fieldproof_word)characters[n].data << 8 |
                           (fieldproof_word)characters[n].is_stop_missing << 1 |
                           characters[n].is_parity_wrong,
                       now);
  return now + (fieldproof_time)count;
}

static fieldproof_time receive_levels(void* self, unsigned port, fieldproof_time start, fieldproof_time rate,
                                      const unsigned char* levels, unsigned count, fieldproof_time now) {
  (void)self, (void)port, (void)start, (void)rate, (void)levels, (void)count;
  return now;
}

static fieldproof_time on_activity(void* context, unsigned port, int begins, fieldproof_time now) {
  const odd* self = (const odd*)context;
  self->bench->write(self->bench->context, port, (fieldproof_word)begins, now);
  return begins ? now + 7 : FIELDPROOF_NEVER;
}

static fieldproof_time on_time(void* self, fieldproof_time now) {
  (void)self;
  return now;
}

static void end(void* context) {
  const odd* self = (const odd*)context;
  self->bench->write(self->bench->context, 0, 0, 0); /* not heard: the case is over */
}

#ifdef OTHER_VERSION
#define VERSION (FIELDPROOF_PLUGIN_VERSION + 1)
#else
#define VERSION FIELDPROOF_PLUGIN_VERSION
#endif
#ifdef LEAVES_OUT
#define ON_TIME 0
#else
#define ON_TIME on_time
#endif

#ifdef LEVELS_ONLY
/* Its table ends where it ended before there was activity. */
#define TABLE_SIZE ((unsigned)offsetof(fieldproof_implementation, on_activity))
#define ON_ACTIVITY 0
#define UNIT FIELDPROOF_LEVELS
#define RECEIVE 0
#else
#define TABLE_SIZE sizeof(fieldproof_implementation)
#define ON_ACTIVITY on_activity
#define UNIT FIELDPROOF_CHARACTERS
#define RECEIVE receive
#endif

#ifdef NO_ENTRY
#define fieldproof_plugin another_name
FIELDPROOF_EXPORT const fieldproof_implementation* another_name(unsigned version);
#endif
const fieldproof_implementation* fieldproof_plugin(unsigned version) {
  static const fieldproof_implementation implementation = {VERSION, TABLE_SIZE,
                                                           "odd",   UNIT,
                                                           create,  free,
                                                           begin,   set_power,
                                                           RECEIVE, receive_levels,
                                                           ON_TIME, end,
                                                           ON_ACTIVITY};
  (void)version;
  (void)on_time;
  (void)receive;
  (void)on_activity;
  return &implementation;
}
