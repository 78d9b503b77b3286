/* A local node of the RS-485 valve bus as firmware would have it: no clock, no line, no allocation of its
 * own. */
#ifndef VALVE_NODE_H
#define VALVE_NODE_H

#include "harness/iut/fieldproof_plugin.h"

enum { VALVES = 0, LIMIT_SWITCHES = 1 }; /* items of the process side */

/* What can be wrong with it, for trying the bench out. */
typedef enum {
  RIGHT,
  CHECK_WITHOUT_COMMAND,
  ANSWERS_WRITES,
  ADDRESS_LOW_NIBBLE,
  ANY_COMMAND_READS,
  READ_DRIVES_VALVES,
  DATA_SWAPPED,
  RESPONSE_CHECK_WITH_ID,
  TURNS_ROUND_LATE,
  DRIVER_NOT_RELEASED,
  TAKES_LONG_FRAMES,
  MUTANTS
} valve_mutant;

typedef struct {
  const fieldproof_bench* bench; /* where it acts */
  valve_mutant mutant;
  fieldproof_time bit, half; /* half a character */
  fieldproof_time loss_limit;
  unsigned address, boards, ninth_bit, answers_writes;
  int is_on, is_spoilt, has_answer;
  unsigned char frame[6];
  unsigned count;
  fieldproof_time busy_until, answer_start, driving_until, last_command;
  unsigned char answer[3];
} valve_node;

const char* valve_mutant_name(valve_mutant mutant);

/* Each returns when valve_node_on_time is wanted next. */
fieldproof_time valve_node_begin(valve_node* node, const fieldproof_case* test_case);
fieldproof_time valve_node_power(valve_node* node, int is_on, fieldproof_time now);
fieldproof_time valve_node_receive(valve_node* node, const fieldproof_character* characters, unsigned count,
                                   fieldproof_time now);
fieldproof_time valve_node_on_time(valve_node* node, fieldproof_time now);

#endif
