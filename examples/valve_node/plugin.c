/*
 * The node as a shared library:
 *
 *   cc -O2 -flto -shared -fPIC -fvisibility=hidden -I. -o libvalve_node.so examples/valve_node/plugin.c \
 *     examples/valve_node/valve_node.c
 *
 * The environment variable VALVE_NODE names a mutant.
 */
#include <stdlib.h>
#include <string.h>

#include "examples/valve_node/valve_node.h"

static valve_mutant wanted_mutant(void) {
  const char* name = getenv("VALVE_NODE");
  int n;
  for (n = 0; name != 0 && n < MUTANTS; ++n)
    if (strcmp(valve_mutant_name((valve_mutant)n), name) == 0) return (valve_mutant)n;
  return RIGHT;
}

static void* create(const char* protocol, const char* role, const fieldproof_bench* bench) {
  valve_node* node = 0;
  if (strcmp(protocol, "valve_bus") != 0 || strcmp(role, "node") != 0) return 0;
  node = (valve_node*)calloc(1, sizeof(valve_node));
  if (node == 0) return 0;
  node->bench = bench;
  node->mutant = wanted_mutant();
  return node;
}

static int begin(void* self, const fieldproof_case* test_case, fieldproof_time* next_time) {
  const char* prefix = "valve_bus/node/";
  if (strncmp(test_case->id, prefix, strlen(prefix)) != 0) return 0;
  *next_time = valve_node_begin((valve_node*)self, test_case);
  return 1;
}

static fieldproof_time set_power(void* self, int is_on, fieldproof_time now) {
  return valve_node_power((valve_node*)self, is_on, now);
}

static fieldproof_time receive(void* self, unsigned port, const fieldproof_character* characters,
                               unsigned count, fieldproof_time now) {
  (void)port; /* it has one */
  return valve_node_receive((valve_node*)self, characters, count, now);
}

static fieldproof_time on_time(void* self, fieldproof_time now) {
  return valve_node_on_time((valve_node*)self, now);
}

static void end(void* self) {
  (void)self;
}

const fieldproof_implementation* fieldproof_plugin(unsigned version) {
  static const fieldproof_implementation implementation = {FIELDPROOF_PLUGIN_VERSION,
                                                           sizeof(fieldproof_implementation),
                                                           "valve node in C",
                                                           FIELDPROOF_CHARACTERS,
                                                           create,
                                                           free,
                                                           begin,
                                                           set_power,
                                                           receive,
                                                           0,
                                                           on_time,
                                                           end,
                                                           0};
  return version == FIELDPROOF_PLUGIN_VERSION ? &implementation : 0;
}
