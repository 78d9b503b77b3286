#include "examples/valve_node/valve_node.h"

#include <string.h>

static const fieldproof_time SECOND = (fieldproof_time)1000000 * 1000000;

const char* valve_mutant_name(valve_mutant mutant) {
  static const char* const names[MUTANTS] = {"right",
                                                "check_without_command",
                                                "answers_writes",
                                                "address_low_nibble",
                                                "any_command_reads",
                                                "read_drives_valves",
                                                "data_swapped",
                                                "response_check_with_id",
                                                "turns_round_late",
                                                "driver_not_released",
                                                "takes_long_frames"};
  return names[mutant];
}

static fieldproof_time setting(const fieldproof_case* test_case, const char* name) {
  unsigned n;
  for (n = 0; n < test_case->setting_count; ++n)
    if (strcmp(test_case->settings[n].name, name) == 0) return test_case->settings[n].value;
  return 0;
}

fieldproof_time valve_node_begin(valve_node* node, const fieldproof_case* test_case) {
  const fieldproof_time told = setting(test_case, "bit_rate"), format = setting(test_case, "characters");
  const fieldproof_time rate = told > 0 ? told : 62500; /* dip 2 */
  const fieldproof_time tens = setting(test_case, "address_tens"), units = setting(test_case, "address_units");
  node->bit = SECOND / rate;
  node->half = (format == 2 ? 10 : 11) * SECOND / (2 * rate);
  node->ninth_bit = format == 0 ? 0x100 : 0;
  node->address = tens > 9 || units > 9 ? 0 : (unsigned)(10 * tens + units);
  node->boards = setting(test_case, "boards") == 1 ? 0x00FF : 0xFFFF;
  node->answers_writes = setting(test_case, "answers_writes") != 0 || node->mutant == ANSWERS_WRITES;
  node->loss_limit = setting(test_case, "loss_limit");
  return valve_node_power(node, 0, 0);
}

/* A character that began within the delimiter is over by then, and known. */
static fieldproof_time silence_known(const valve_node* node) {
  return node->count > 0 ? node->busy_until + 9 * node->half + node->bit : FIELDPROOF_NEVER;
}

static fieldproof_time host_lost(const valve_node* node) {
  return node->loss_limit > 0 ? node->last_command + node->loss_limit : FIELDPROOF_NEVER;
}

static fieldproof_time next_time(const valve_node* node) {
  fieldproof_time next = silence_known(node);
  if (!node->is_on) return FIELDPROOF_NEVER;
  if (host_lost(node) < next) next = host_lost(node);
  if (node->has_answer && node->answer_start - node->bit < next) next = node->answer_start - node->bit;
  return next;
}

fieldproof_time valve_node_power(valve_node* node, int is_on, fieldproof_time now) {
  node->is_on = is_on;
  node->last_command = now;
  node->count = 0;
  node->is_spoilt = node->has_answer = 0;
  node->busy_until = node->driving_until = 0;
  return next_time(node);
}

static void drive_valves(valve_node* node, unsigned data0, unsigned data1, fieldproof_time now) {
  const unsigned both = node->mutant == DATA_SWAPPED ? data1 | data0 << 8 : data0 | data1 << 8;
  node->bench->write(node->bench->context, VALVES, both & node->boards, now);
}

static void answer_with(valve_node* node, unsigned data0, unsigned data1) {
  const fieldproof_time late = node->mutant == TURNS_ROUND_LATE ? SECOND / 1000 * 21 / 10 : SECOND / 10000;
  node->has_answer = 1;
  node->answer_start = node->busy_until + 7 * node->half + late;
  node->answer[0] = (unsigned char)data0;
  node->answer[1] = (unsigned char)data1;
  node->answer[2] =
      (unsigned char)(data0 ^ data1 ^ (node->mutant == RESPONSE_CHECK_WITH_ID ? node->address : 0));
}

static int is_meant(const valve_node* node, unsigned id) {
  if (node->address == 0) return 0;
  return node->mutant == ADDRESS_LOW_NIBBLE ? (id & 15) == (node->address & 15) : id == node->address;
}

static void end_frame(valve_node* node, fieldproof_time now) {
  const unsigned char* f = node->frame;
  const int has_length = node->count == 5 || (node->count == 6 && node->mutant == TAKES_LONG_FRAMES);
  const int is_whole = has_length && !node->is_spoilt;
  unsigned check = f[0] ^ f[1] ^ f[2] ^ f[3], command = f[1];
  node->count = 0;
  node->is_spoilt = 0;
  if (node->mutant == CHECK_WITHOUT_COMMAND) check ^= f[1];
  if (!is_whole || check != f[4] || !is_meant(node, f[0])) return;
  node->last_command = now;
  if (node->mutant == ANY_COMMAND_READS && command != 0) command = 1;
  if (command == 0 || (command == 1 && node->mutant == READ_DRIVES_VALVES))
    drive_valves(node, f[2], f[3], now);
  if (command == 0 && node->answers_writes) answer_with(node, f[2], f[3]);
  if (command == 1) {
    const unsigned switches =
        (unsigned)node->bench->read(node->bench->context, LIMIT_SWITCHES, now) & node->boards;
    answer_with(node, switches & 0xFF, switches >> 8);
  }
}

static void hear(valve_node* node, const fieldproof_character* character, fieldproof_time now) {
  const fieldproof_time gap = character->start - node->busy_until;
  if (!node->is_on) return;
  if (node->count > 0 && gap >= 7 * node->half) end_frame(node, now);
  node->has_answer = 0; /* somebody else talks */
  if (character->is_parity_wrong || character->is_stop_missing || character->start < node->driving_until)
    node->is_spoilt = 1;
  if (node->count > 0 && gap > 3 * node->half + 1000) node->is_spoilt = 1;
  if (node->count < 6) node->frame[node->count++] = (unsigned char)(character->data & 0xFF);
  node->busy_until = character->busy_until;
}

fieldproof_time valve_node_receive(valve_node* node, const fieldproof_character* characters, unsigned count,
                                   fieldproof_time now) {
  for (; count > 0; --count) hear(node, characters++, now);
  return next_time(node);
}

static void transmit_answer(valve_node* node, fieldproof_time now) {
  const fieldproof_time start = node->answer_start > now + node->bit ? node->answer_start : now + node->bit;
  unsigned short characters[3];
  unsigned n;
  for (n = 0; n < 3; ++n) characters[n] = (unsigned short)(node->ninth_bit | node->answer[n]);
  node->has_answer = 0;
  node->driving_until =
      start + 6 * node->half + node->bit * (node->mutant == DRIVER_NOT_RELEASED ? 20 : 2);
  /* All of it ahead: it has nothing else to do meanwhile. */
  node->bench->driver(node->bench->context, 0, 1, start - node->bit);
  node->bench->characters(node->bench->context, 0, start, characters, 3);
  node->bench->driver(node->bench->context, 0, 0, node->driving_until);
}

fieldproof_time valve_node_on_time(valve_node* node, fieldproof_time now) {
  if (now >= silence_known(node)) end_frame(node, now);
  if (node->has_answer && now >= node->answer_start - node->bit) transmit_answer(node, now);
  if (now >= host_lost(node)) {
    node->last_command = now;
    node->bench->write(node->bench->context, VALVES, 0, now);
  }
  return next_time(node);
}
